# Needs Python 3.11 or later and make; everything else is fetched into .venv.
PYTHON ?= $(shell command -v python3.11 || command -v python3)
VENV ?= .venv
BIN = $(VENV)/bin
OUT ?= tippetop-report

.PHONY: reproduce test test-browser chromium check lint types contract bench quick clean

reproduce: $(VENV)/.installed ## Redo the whole report into $(OUT)
	$(BIN)/tippetop reproduce --out $(OUT) --force

test: $(VENV)/.installed-dev ## Run the tests
	$(BIN)/python -m pytest -n auto

test-browser: $(VENV)/.installed-dev ## Run the tests of the laboratory's page; they need Debian's chromium
	$(BIN)/python -m pytest -m browser

chromium: ## Install Debian's chromium, as root, unless it is there
	command -v chromium >/dev/null || { apt-get update -qq && \
	  DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends chromium >/dev/null; }

check: lint types contract test ## All that a change must pass

lint: $(VENV)/.installed-dev
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .

types: $(VENV)/.installed-dev
	$(BIN)/mypy

contract: $(VENV)/.installed-dev
	$(BIN)/lint-imports

quick: $(VENV)/.installed ## A coarse report in half a minute
	$(BIN)/tippetop reproduce --quick --out $(OUT) --force

bench: $(VENV)/.installed-bench ## Measure what is promised of speed and memory; takes half an hour
	$(BIN)/python -m benchmarks --json benchmarks.json

$(VENV)/bin/python:
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --upgrade pip

$(VENV)/.installed: pyproject.toml | $(VENV)/bin/python
	$(BIN)/python -m pip install --quiet --editable .
	touch $@

$(VENV)/.installed-dev: pyproject.toml | $(VENV)/bin/python
	$(BIN)/python -m pip install --quiet --editable '.[test,lint]'
	touch $@ $(VENV)/.installed

$(VENV)/.installed-bench: pyproject.toml | $(VENV)/bin/python
	$(BIN)/python -m pip install --quiet --editable '.[bench]'
	touch $@

clean:
	rm -rf $(VENV) $(OUT)
