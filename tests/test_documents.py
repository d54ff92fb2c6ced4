"""What the docstrings, the README and the pages of the documentation show, run."""

import doctest
import importlib
import itertools
import os
import re
import shlex
import sys
from pathlib import Path

import click
import matplotlib as mpl
import pytest
from typer.main import get_command
from typer.testing import CliRunner

import tippetop as tt
from package_kinds import forget_own_kinds
from tippetop.cli.commands import app
from tippetop.sweeps import Sweep

ROOT = Path(__file__).parents[1]
PAGES = [
    path
    for path in [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
    if "_build" not in path.parts and "jupyter_execute" not in path.parts
]
PUBLIC = [*(getattr(tt, name) for name in tt.__all__), *vars(tt.extend).values()]
HOMES = sorted(
    {
        home
        for value in PUBLIC
        if (home := str(getattr(value, "__module__", ""))).startswith("tippe")
    }
)
BLOCK = re.compile(
    r"^(?P<fence>`{3,})(?:(?P<python>python|\{code-cell\}"
    r" python|\{player\}[^\n]*)|(?P<console>console))\n"
    r"(?P<code>.*?)^(?P=fence)$",
    re.MULTILINE | re.DOTALL,
)
OPTIONS = re.compile(r"^(:[\w-]+:[^\n]*\n)+|^---\n.*?^---\n", re.MULTILINE | re.DOTALL)
FLAGS = doctest.NORMALIZE_WHITESPACE | doctest.ELLIPSIS
WITHOUT_DOCSTRING = {"MATERIALS", "presets"}


SLOW = {"README.md", "docs/howto/sweep.md", "docs/howto/units.md", "tippetop.fit.fit_result"}
"""Pages, and modules with examples, that take seconds."""


def maybe(page):
    """A page, left out where it is a notebook: the build of the documentation runs that."""
    text = page.read_text(encoding="utf-8")
    notebook = "{code-cell}" in text and "NOTEBOOKS" not in os.environ
    reason = "a notebook: run by `make docs` and by `make doctest`"
    name = page.relative_to(ROOT).as_posix()
    marks = [pytest.mark.skipif(notebook, reason=reason), *[pytest.mark.slow] * (name in SLOW)]
    return pytest.param(page, id=name, marks=marks)


@pytest.fixture(autouse=True)
def _elsewhere(tmp_path, monkeypatch):
    """What examples write is written into an empty folder, and what they define is forgotten."""
    monkeypatch.chdir(tmp_path)
    forget_own_kinds(monkeypatch)
    with mpl.rc_context():
        mpl.use("agg")
        yield
    if plt := sys.modules.get("matplotlib.pyplot"):
        plt.close("all")


@pytest.mark.parametrize(
    "home", [pytest.param(home, marks=[pytest.mark.slow] * (home in SLOW)) for home in HOMES]
)
def test_the_examples_of_docstrings_are_true(home):
    found = doctest.testmod(importlib.import_module(home), optionflags=FLAGS)
    assert found.failed == 0


@pytest.mark.parametrize("name", sorted(set(tt.__all__) - WITHOUT_DOCSTRING))
def test_every_public_name_has_an_example(name):
    assert ">>> " in getattr(tt, name).__doc__


@pytest.mark.parametrize("name", tt.__all__)
def test_every_public_name_has_an_entry(name):
    entries = "\n".join(
        path.read_text(encoding="utf-8") for path in (ROOT / "docs" / "api").glob("*.md")
    )
    assert re.search(rf"^\.\. (auto|py:)\w+:: tippetop\.{name}$", entries, re.MULTILINE)


@pytest.mark.filterwarnings("ignore:FigureCanvasAgg is non-interactive")
@pytest.mark.parametrize("page", [maybe(page) for page in PAGES])
def test_the_blocks_of_a_page_run(page):
    """In order, in one namespace, as a reader would type them."""
    names = {"__name__": "__main__", "tt": tt}
    for block in BLOCK.finditer(page.read_text(encoding="utf-8")):
        code = OPTIONS.sub("", block["code"], count=1)
        if block["console"]:
            for line in re.findall(r"^\$ tippetop (.*)$", code, re.MULTILINE):
                told = CliRunner().invoke(app, shlex.split(line, comments=True))
                assert told.exit_code == 0, (line, told.output)
        else:
            exec(compile(code, str(page), "exec"), names)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_what_the_blocks_of_a_page_import_exists(page):
    """Notebooks run elsewhere: here a name that is gone is noticed, of the package and of `tt`."""
    text = page.read_text(encoding="utf-8")
    blocks = [OPTIONS.sub("", block["code"], count=1) for block in BLOCK.finditer(text)]
    code = "\n".join(
        line.strip() for block in blocks for line in block.splitlines() if "import " in line
    )
    for origin, names in re.findall(r"^from (tippetop[\w.]*) import ([\w, ]+)$", code, re.M):
        module = importlib.import_module(origin)
        assert [name for name in names.split(", ") if not hasattr(module, name.split()[0])] == []
    used = {name for block in blocks for name in re.findall(r"\btt\.(\w+)", block)}
    assert {name for name in used if not hasattr(tt, name)} == set()


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_no_heading_of_a_page_skips_a_level(page):
    text = re.sub(r"^(`{3,}).*?^\1$", "", page.read_text(encoding="utf-8"), flags=re.M | re.S)
    levels = [len(marks) for marks in re.findall(r"^(#+) ", text, re.M)]
    assert [b for a, b in itertools.pairwise(levels) if b > a + 1] == []


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_every_picture_of_a_page_has_a_text_alternative(page):
    """Those that cells of notebooks draw state it as an option, others in their brackets."""
    text = page.read_text(encoding="utf-8")
    drawn = [block["code"] for block in BLOCK.finditer(text) if "plt.show()" in block["code"]]
    if "{code-cell}" in text:
        assert [code for code in drawn if not re.search(r'alt: "[A-Z][^"]+\."', code)] == []
    assert "![](" not in text


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_the_commands_of_a_page_are_understood(page):
    """Those that would take too long to run here, with all their options."""
    group = get_command(app)
    for block in re.findall(
        r"^```(?:sh)?\n(.*?)^```$", page.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL
    ):
        for line in re.findall(r"^tippetop (.*)$", block.replace("\\\n", " "), re.MULTILINE):
            words = shlex.split(line, comments=True)
            above = click.Context(group, info_name="tippetop")
            name, command, rest = group.resolve_command(above, words)
            command.make_context(name, rest, parent=above)


def test_the_files_of_pages_are_accepted():
    """The sweep that a page shows, and the piece to be turned."""
    shown = {
        name: re.search(
            r"^```toml\n(.*?)^```$",
            (ROOT / "docs/howto" / name).read_text(encoding="utf-8"),
            re.M | re.S,
        )[1]
        for name in ("sweep.md", "print.md")
    }
    Path("top.toml").write_text(tt.presets.report_problem().to_toml(), encoding="utf-8")
    Path("sweep.toml").write_text(shown["sweep.md"], encoding="utf-8")
    assert Sweep.read("sweep.toml").cells == 1000 * 1000 * 2
    Path("turned.toml").write_text(shown["print.md"], encoding="utf-8")
    assert tt.Body.turned("turned.toml").mass > 0.0


def test_blocks_are_found():
    """The README has both kinds."""
    found = list(BLOCK.finditer((ROOT / "README.md").read_text(encoding="utf-8")))
    assert any(block["python"] for block in found)
