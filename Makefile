# Needs Python 3.11 or later and make; everything else is fetched into .venv.
PYTHON ?= $(shell command -v python3.11 || command -v python3)
VENV ?= .venv
BIN = $(VENV)/bin
OUT ?= tippetop-report

# Tests start hundreds of processes: none is to compile the sources again.
unexport PYTHONDONTWRITEBYTECODE

BUILT = src/tippetop/export/built/lab.html

.PHONY: reproduce page test test-all campaigns test-browser test-docs doctest map chromium check lint types contract docs bench quick dist review clean

reproduce: $(VENV)/.installed ## Redo the whole report into $(OUT)
	$(BIN)/tippetop reproduce --out $(OUT) --force

page: $(BUILT) ## Build what runs in browsers; node comes from this machine, or else from a wheel

# The page's engine is translated from the package's modules, so that it is built anew with any of them.
$(BUILT): $(shell find web src/tippetop -name node_modules -prune -o -name built -prune -o \
  -name mechanics.js -o -name tables.js -o -name __pycache__ -prune -o -type f -print) | $(VENV)/.installed
	$(BIN)/python -m tippetop.page_engine
	web/run.sh "$(abspath $(BIN)/python)" node web/build.mjs

# With xdist's `worksteal` no worker is left with a queue of long tests when the others are done.
PYTEST = $(BIN)/python -m pytest -n auto --dist worksteal

test: $(VENV)/.installed-dev ## Run the tests
	@echo "This takes four to five minutes on two processors that have nothing else to do."
	$(PYTEST)

test-all: $(VENV)/.installed-dev ## Run the tests, and a sample of every campaign
	@echo "This takes about fourteen minutes on two processors that have nothing else to do."
	$(PYTEST) -m "not (browser or campaign)"

campaigns: $(VENV)/.installed-dev ## Run every campaign in the size that is claimed, and search at random
	@echo "This takes hours."
	$(PYTEST) -m "slow or campaign or hypothesis" --hypothesis-profile=search

test-browser: $(BUILT) $(VENV)/.installed-dev ## Run the tests of the laboratory's page; they need Debian's chromium
	$(BIN)/python -m pytest -m browser

doctest: $(VENV)/.installed-dev ## Run the examples of the docstrings and every block of code of the pages
	NOTEBOOKS=1 $(BIN)/python -m pytest -n auto tests/test_documents.py

docs: $(BUILT) $(VENV)/.installed-docs ## Build the documentation into docs/_build/html, with every notebook run
	$(BIN)/python -m sphinx -W --keep-going -q -j auto -b html docs docs/_build/html

map: $(VENV)/.installed-dev ## Draw the rooms of CONTRIBUTING.md anew from the imports
	$(BIN)/python docs/house.py

test-docs: $(BUILT) $(VENV)/.installed-docs ## Look at every page of the documentation that is built, in a browser
	DOCS=docs/_build/html $(BIN)/python -m pytest -m browser tests/test_site.py

chromium: ## Install Debian's chromium, as root, unless it is there
	command -v chromium >/dev/null || { apt-get update -qq && \
	  DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends chromium >/dev/null; }

check: lint types contract test ## All that a change must pass

lint: $(VENV)/.installed-dev
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	web/run.sh $(BIN)/python biome check --error-on-warnings
	$(BIN)/codespell
	$(BIN)/python tools/plain_words.py

types: $(VENV)/.installed-dev
	$(BIN)/mypy

contract: $(VENV)/.installed-dev
	$(BIN)/lint-imports

quick: $(VENV)/.installed ## A coarse report in half a minute
	$(BIN)/tippetop reproduce --quick --out $(OUT) --force

bench: $(VENV)/.installed-bench ## Measure what is promised of speed and memory; takes half an hour
	$(BIN)/python -m benchmarks --json benchmarks.json

dist: $(BUILT) $(VENV)/.installed-release ## Build the sdist, and the wheel from it, into dist/
	rm -rf dist
	$(BIN)/python -m build
	$(BIN)/python -m zipfile -l dist/*.whl | grep -q export/built/lab.html
	$(BIN)/python -m zipfile -l dist/*.whl | grep -q licenses/web/notices.txt
	$(BIN)/twine check --strict dist/*

review: $(VENV)/.installed-release ## Review the repository as the Scientific Python guide asks
	$(BIN)/repo-review .

$(VENV)/bin/python:
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --upgrade pip

$(VENV)/.installed: pyproject.toml | $(VENV)/bin/python
	$(BIN)/python -m pip install --quiet --editable .
	touch $@

$(VENV)/.installed-dev: pyproject.toml | $(VENV)/bin/python
	$(BIN)/python -m pip install --quiet --editable '.[test,lint]'
	touch $@ $(VENV)/.installed

$(VENV)/.installed-docs: pyproject.toml | $(VENV)/bin/python
	$(BIN)/python -m pip install --quiet --editable '.[test,docs]'
	touch $@ $(VENV)/.installed

$(VENV)/.installed-release: pyproject.toml | $(VENV)/bin/python
	$(BIN)/python -m pip install --quiet --group release
	touch $@

$(VENV)/.installed-bench: pyproject.toml | $(VENV)/bin/python
	$(BIN)/python -m pip install --quiet --editable '.[bench]'
	touch $@

clean:
	rm -rf $(VENV) $(OUT) dist docs/_build web/node_modules src/tippetop/export/built
