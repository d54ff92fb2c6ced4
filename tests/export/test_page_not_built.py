"""Without what `make page` builds, commands and functions say what to run, and write no file."""

import subprocess
import sys

import pytest

import tippetop as tt
from tippetop.export import bundle

SENTENCE = "the page and the player were not built when tippetop was installed"

LAB = """
import sys
from pathlib import Path
from tippetop.export import bundle
bundle.BUILT = Path(sys.argv.pop(1))
import tippetop.lab.serve
from tippetop.cli.main import main
main()
"""


@pytest.fixture
def unbuilt(tmp_path, monkeypatch):
    """A folder without a built page, in the place of the package's."""
    monkeypatch.setattr(bundle, "BUILT", tmp_path / "built")
    for function in (bundle.built, bundle.player_packed):
        function.cache_clear()
    yield tmp_path / "built"
    for function in (bundle.built, bundle.player_packed):
        function.cache_clear()


def test_a_run_is_not_written_as_a_page(unbuilt, tmp_path):
    run = tt.simulate(tt.presets.report_problem(), duration=0.05, samples=11)
    with pytest.raises(tt.Unavailable, match=SENTENCE):
        tt.write_html(run, tmp_path / "run.html")
    assert [*tmp_path.iterdir()] == []


@pytest.mark.parametrize(
    "options",
    [
        ["--no-browser"],
        pytest.param(["--host", "127.0.0.1", "--no-browser"], marks=pytest.mark.slow),
        ["--out"],
    ],
)
def test_the_laboratory_does_not_open(unbuilt, tmp_path, options):
    page = tmp_path / "page.html"
    options = [*options, str(page)] if options == ["--out"] else options
    command = [sys.executable, "-c", LAB, str(unbuilt), "lab", *options]
    ended = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    said = " ".join(ended.stderr.split())
    assert ended.returncode != 0
    assert SENTENCE in said
    assert "Traceback" not in said
    assert not page.exists()
