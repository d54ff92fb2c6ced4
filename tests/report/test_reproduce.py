"""Redoing the report from end to end: files, page, refusals and interruptions."""

import json
import os
import re
from html.parser import HTMLParser
from pathlib import Path

import pytest
from typer import Typer
from typer.testing import CliRunner

from judging import made_up_judgement, made_up_page
from tippetop.cli.reproduce import _show as show
from tippetop.cli.reproduce import reproduce as command
from tippetop.report.claim import Verdict, in_words
from tippetop.report.claims.registry import CLAIMS
from tippetop.report.experiments.registry import EXPERIMENTS
from tippetop.report.gallery import PLATES
from tippetop.report.outline import REPORT_TITLE
from tippetop.report.page import render
from tippetop.report.reproduce import Reproduction, reproduce
from tippetop.results.netcdf import read_run
from tippetop.support.errors import FileTrouble, InvalidInput

FIELDS = {
    "id",
    "source",
    "statement",
    "reported",
    "listing",
    "converged",
    "unit",
    "verdict",
    "note",
    "quick",
}


class Links(HTMLParser):
    """Everything a page loads, links to, and can be linked at, and what it says of its pictures."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.loaded: list[str] = []
        self.links: list[str] = []
        self.names: list[str] = []
        self.tags: set[str] = set()
        self.silent: list[str] = []
        self.feed(page)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.add(tag)
        values = dict(attrs)
        self.loaded += [values["src"]] if values.get("src") else []
        self.links += [values["href"]] if values.get("href") else []
        self.names += [values["id"]] if values.get("id") else []
        if not values.get({"img": "alt", "svg": "aria-label"}.get(tag, ""), "no picture"):
            self.silent.append(str(values))


def check_page(folder: Path) -> Links:
    """The page is whole by itself, and none of its links leads nowhere."""
    text = (folder / "index.html").read_text(encoding="utf-8")
    page = Links(text)
    assert all(
        source.startswith(("data:image/svg+xml;", "data:image/webp;")) for source in page.loaded
    )
    assert not page.tags & {"link", "iframe"}
    assert "@import" not in text
    assert "url(" not in text
    assert page.silent == []
    assert len(page.names) == len(set(page.names))
    for link in page.links:
        if link.startswith("#"):
            assert link[1:] in page.names, link
        else:
            assert (folder / link).is_file(), link
    return page


@pytest.fixture(scope="module")
def fig13(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder, told = tmp_path_factory.mktemp("report") / "out", list[float]()
    result = reproduce(
        folder,
        only="fig13",
        quick=True,
        workers=1,
        progress=lambda done, total, _: told.append(done / total),
    )
    assert told == sorted(told)
    assert told[-1] == pytest.approx(1.0)
    assert sum(result.counts.values()) == 2
    return folder


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The whole report in its quick version: that which REPORT names, of this code, or a new
    one.
    """
    if made := os.environ.get("REPORT"):
        return Path(made)
    folder = tmp_path_factory.mktemp("whole") / "out"
    reproduce(folder, quick=True, workers=2)
    return folder


def test_one_figure_with_its_data_and_claims(fig13: Path) -> None:
    files = sorted(str(path.relative_to(fig13)) for path in fig13.rglob("*") if path.is_file())
    assert files == [
        "claims.json",
        "data/fig13.nc",
        "figures/fig13.png",
        "figures/fig13.svg",
        "index.html",
    ]
    records = json.loads((fig13 / "claims.json").read_text(encoding="utf-8"))
    assert [record["id"] for record in records] == ["fig13-upright", "eq-2.17-exception"]
    assert (fig13 / "figures/fig13.png").read_bytes().startswith(b"\x89PNG")
    data = read_run(fig13 / "data/fig13.nc")
    assert {"tilt", "tilt_listing"} <= set(data.data_vars)
    assert data["tilt"].attrs["units"] == "rad"


def test_page_stands_alone(fig13: Path) -> None:
    assert "script" not in check_page(fig13).tags


def test_page_opens_with_what_is_wrong_and_what_is_right(fig13: Path) -> None:
    text = (fig13 / "index.html").read_text(encoding="utf-8")
    wrong, right, rest = (
        text.index(f'<div id="{name}"') for name in ("errors", "sound", "section-2.3")
    )
    assert wrong < right < rest
    assert "0\\neq\\theta\\neq\\pi" in text[wrong:right]
    assert 'href="#claim-fig13-upright"' in text[right:rest]
    assert "(its residual for a top" not in text[wrong:right]
    assert "(its residual for a top" in text[rest:]


def test_claim_and_figure_and_experiment_link_to_each_other(fig13: Path) -> None:
    text = (fig13 / "index.html").read_text(encoding="utf-8")
    claim = text[text.index('id="claim-eq-2.17-exception"') :]
    claim = claim[: claim.index("</article>")]
    assert 'href="#fig13"' in claim
    assert 'href="#experiment-run-10"' in claim
    assert "--only eq-2.17-exception" in claim
    assert 'aria-label="\\omega_3=' in claim
    figure = text[text.index('<figure id="fig13"') : text.index("</figure>")]
    assert 'href="#claim-eq-2.17-exception"' in figure, "it stands in another section"
    assert 'href="#experiment-run-10"' in figure
    row = text[text.index('<tr id="experiment-run-10"') :]
    row = row[: row.index("</tr>")]
    assert 'href="#fig13"' in row
    assert 'href="#claim-fig13-upright"' in row


def test_every_verdict_has_a_filter(fig13: Path) -> None:
    text = (fig13 / "index.html").read_text(encoding="utf-8")
    for verdict in Verdict:
        name = verdict.name.lower()
        assert f'type="radio" name="only" id="only-{name}"' in text
        assert f"#only-{name}:checked) :is(.claim:not(.is-{name})" in text


def test_quick_run_says_so(fig13: Path) -> None:
    assert "Quick run" in (fig13 / "index.html").read_text(encoding="utf-8")
    assert all(
        record["quick"]
        for record in json.loads((fig13 / "claims.json").read_text(encoding="utf-8"))
    )


def test_results_are_not_overwritten_unasked(tmp_path: Path) -> None:
    out = tmp_path / "out"
    reproduce(out, only="fig08-block", workers=1)
    (out / "claims.json").write_text("mine", encoding="utf-8")
    with pytest.raises(FileTrouble, match="overwrite=True"):
        reproduce(out, only="fig08-block", workers=1)
    assert (out / "claims.json").read_text(encoding="utf-8") == "mine"
    reproduce(out, only="fig08-block", workers=1, overwrite=True)
    assert json.loads((out / "claims.json").read_text(encoding="utf-8"))[0]["id"] == "fig08-block"


def test_interrupted_run_leaves_nothing(tmp_path: Path) -> None:
    def interrupt(done: float, total: float, what: str) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        reproduce(tmp_path / "out", only="fig08-block", workers=1, progress=interrupt)
    assert list(tmp_path.iterdir()) == []


def test_file_in_the_way_is_named(tmp_path: Path) -> None:
    (tmp_path / "out").write_text("", encoding="utf-8")
    with pytest.raises(FileTrouble, match="out is not a folder"):
        reproduce(tmp_path / "out", only="fig08-block", workers=1)


def test_unknown_name_is_refused_before_any_work(tmp_path: Path) -> None:
    with pytest.raises(InvalidInput, match="fig99"):
        reproduce(tmp_path / "out", only="fig99")
    assert list(tmp_path.iterdir()) == []


def test_command_prints_json_for_programs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tippetop.report.reproduce.processors", lambda: 1)
    app = Typer()
    app.command()(command)
    out = tmp_path / "out"
    result = CliRunner().invoke(app, ["--only", "fig08-block", "--out", str(out), "--json"])
    assert result.exit_code == 0
    told = json.loads(result.stdout)
    assert {name for name, count in told["counts"].items() if count} == {
        told["claims"][0]["verdict"]
    }
    assert Path(told["page"]).is_file()
    again = CliRunner().invoke(app, ["--only", "fig08-block", "--out", str(out)])
    assert isinstance(again.exception, FileTrouble)


def test_the_command_line_and_the_page_count_alike(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    judgements = tuple(
        made_up_judgement(claim, is_true=k % 3 > 0) for k, claim in enumerate(CLAIMS.values())
    )
    page = render([], judgements, tmp_path, quick=False)
    show(Reproduction(tmp_path, judgements, (), quick=False, seconds=1.0))
    tally = re.findall(r'<div class="(\w+)"><strong>(\d+)</strong>', page)
    counts = {name: int(number) for name, number in tally}
    assert sum(counts.values()) == sum(bool(claim.is_of_report) for claim in CLAIMS.values())
    printed = " ".join(capsys.readouterr().out.split())
    assert f"statements of the report: {in_words(counts)}" in printed
    others = re.search(r"statements of others, on friction and real tops:\s(.*)\.</p>", page)
    assert others
    assert f"statements of others: {others[1]}" in printed
    shown = dict(re.findall(r'id="only-(\w+)"[^>]*> \w+ \((\d+)\)', page))
    assert sum(int(number) for name, number in shown.items() if name != "all") == len(CLAIMS)


def test_the_story_is_told_with_the_numbers_of_this_run(tmp_path: Path) -> None:
    page = made_up_page(tmp_path)
    story = page[page.index('<ol class="story">') : page.index("</ol>")]
    assert story.count("<img ") == 5
    assert "26.3 and 78.6 rad/s" in story
    assert not re.search(r"[{}]", story)
    assert Links(page).silent == []
    assert REPORT_TITLE in page[: page.index('<ol class="story">')]


@pytest.mark.slow
def test_whole_report_in_its_quick_version(whole: Path) -> None:
    records = json.loads((whole / "claims.json").read_text(encoding="utf-8"))
    assert [record["id"] for record in records] == list(CLAIMS)
    for record in records:
        assert set(record) >= FIELDS
        assert record["verdict"] in {"reproduced", "upheld", "explained", "corrected"}
        assert record["converged"] is not None
        assert record["reported"] is not None
        assert record["note"]
        assert "nan" not in record["note"]
        assert record["quick"]
    assert {path.stem for path in (whole / "figures").glob("*.png")} == set(PLATES)
    page = check_page(whole)
    assert {f"claim-{name}" for name in CLAIMS} | set(PLATES) <= set(page.names)
    assert {f"experiment-{name}" for name in EXPERIMENTS} <= set(page.names)
