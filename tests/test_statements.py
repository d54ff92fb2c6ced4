"""What pages, messages and files state about the program is true."""

import re
import tomllib
from fnmatch import fnmatch
from pathlib import Path

import numpy as np
import pytest

import tippetop as tt
from tippetop.integrators import sealed_folders
from tippetop.lathe import files

ROOT = Path(__file__).parents[1]


def text(name: str) -> str:
    return (ROOT / name).read_text(encoding="utf-8")


def table(document: str, heading: str) -> list[list[str]]:
    """Rows of the table below a heading, without the line of dashes."""
    lines = document[document.index(heading) :].splitlines()[2:]
    rows = lines[: next(k for k, line in enumerate([*lines, ""]) if not line.startswith("|"))]
    return [[cell.strip() for cell in row.strip("|").split("|")] for row in rows]


@pytest.mark.parametrize(
    ("path", "value"),
    [
        ("friction.mu", 0.1),
        ("launch.spin", "2200 rpm"),
        ("body.mass", 0.03),
        ("contact.restitution", 0.5),
        ("body.shape.eccentricity", 0.25),
        ("launch.slip", (0.1, 0.0)),
        ("gravity", 3.7),
    ],
)
def test_the_advice_to_who_sets_a_field_works_as_it_is_written(path, value) -> None:
    problem = tt.presets.report_problem()
    where, _, name = path.rpartition(".")
    part = problem.get(where) if where else problem
    with pytest.raises(tt.InvalidInput, match="cannot be set") as caught:
        setattr(part, name, value)
    (of_problem,) = re.findall(r"by (problem\.replace\(\{.*?\}\))", caught.value.hint)
    assert eval(of_problem, {"problem": problem}) == problem.replace({path: value})
    of_part = re.findall(r"alone by (model_copy\(.*\))$", caught.value.hint)
    assert len(of_part) == bool(where)
    for advice in of_part:
        copied = eval(f"part.{advice}", {"part": part})
        assert copied == problem.replace({path: value}).get(where)


def test_a_part_of_no_problem_is_copied_by_itself() -> None:
    drawn = tt.Material(modulus=2e11, poisson=0.3)
    with pytest.raises(tt.InvalidInput, match="cannot be set") as caught:
        drawn.poisson = 0.25
    advice = caught.value.hint.removeprefix("make a changed copy by ")
    assert eval(f"drawn.{advice}", {"drawn": drawn}).poisson == 0.25


def test_the_energy_error_counts_impacts_once() -> None:
    """`work` has what impacts took in it: the energy less the work stays as at launch."""
    problem = tt.presets.report_problem().replace(
        {
            "friction": {"kind": "coulomb", "mu": 0.2},
            "launch.gap": 0.02,
            "launch.velocity": (0.0, 0.0, 0.0),
            "contact.liftoff": "fly",
            "contact.restitution": 0.5,
        }
    )
    run = tt.simulate(problem, 0.2)
    energy, work = run["energy"].values, run["work"].values
    imbalance = np.abs(energy - energy[0] - work).max()
    assert imbalance <= 1.001 * float(run["energy_error"]) * energy[0] + 1e-15 * energy[0]
    assert float(run["energy_lost_impacts"]) > 1e9 * imbalance
    definition = dict(row[:2] for row in table(text("docs/theory/numbers.md"), "| monitor |"))
    assert definition["`energy_error`"] == (
        "largest change of $E$ less the work of the table, relative to $E$ at launch; `work`"
        " counts that of impacts"
    )


def test_the_glossary_defines_the_times_as_the_page_of_numbers() -> None:
    glossary = " ".join(text("docs/glossary.md").split())
    numbers = dict(row[:2] for row in table(text("docs/theory/numbers.md"), "| number |"))
    settles = "within 0.01 rad of the tilt at which it settles"
    assert settles in numbers["`arrival_time`"]
    assert settles in glossary[glossary.rindex("`arrival_time`") :][:120]
    assert "of its final value" not in glossary


def test_no_page_says_what_happens_without_the_compiler() -> None:
    """It is no optional library: no function misses an integrator."""
    dependencies = tomllib.loads(text("pyproject.toml"))["project"]["dependencies"]
    assert any(one.startswith("llvmlite") for one in dependencies)
    pages = [ROOT / "README.md", *(ROOT / "docs").rglob("*.md")]
    for page in pages:
        assert not re.search(r"[Ww]ithout llvmlite", page.read_text(encoding="utf-8")), page
    assert "Unavailable" not in tt.simulate.__doc__


def test_the_page_on_security_names_the_files_that_are_read() -> None:
    page = text("SECURITY.md")
    read = " ".join(page[page.index("reads") : page.index("can serve")].split())
    workpieces = re.search(r"workpieces \((.*?)\)", read)[1].split(", ")
    assert {f".{kind.lower()}" for kind in workpieces} == {".toml", ".csv", *files.DRAWINGS}
    for kind in ("problems (TOML, JSON, MJCF)", "runs (NetCDF)", "sweeps (TOML, Zarr)"):
        assert kind in read
    cache = page[page.index("The cache") :].partition(".")[0]
    assert "pickle" not in cache
    assert "pickle" not in Path(sealed_folders.__file__).read_text(encoding="utf-8")


GENERATED_KINDS = {".json", ".svg", ".png", ".gif", ".ipynb", ".txt"}
WRITTEN_BY_HAND = {
    ".binder/requirements.txt",
    "docs/_static/top.svg",
    "src/tippetop/engines/suite/test_suite.py.txt",
    "src/tippetop/results/account_en.json",
    "web/notices.txt",
    "web/package.json",
    "web/texts/de.json",
    "web/texts/en.json",
}
MADE = {"_build", "jupyter_execute", "built", "node_modules", "__pycache__", "_players"}


def test_what_is_generated_and_committed_is_listed_with_what_writes_it() -> None:
    rows = table(text("CONTRIBUTING.md"), "| generated and committed |")
    patterns = [name for row in rows for name in re.findall(r"`(.*?)`", row[0])]
    assert len(patterns) > 5
    present = {
        path.relative_to(ROOT).as_posix()
        for folder in (".binder", "docs", "notebooks", "src", "tests", "web")
        for path in (ROOT / folder).rglob("*.*")
        if path.suffix in GENERATED_KINDS and MADE.isdisjoint(path.parts)
    }
    for pattern in patterns:
        assert any(fnmatch(name, pattern) for name in present), pattern
    listed = {name for name in present if any(fnmatch(name, one) for one in patterns)}
    assert present - listed <= WRITTEN_BY_HAND
    for _, _, comparison in rows:
        assert comparison == "the reader" or (ROOT / comparison.strip("`")).exists()


def test_the_citation_has_the_version_and_the_date_of_the_release() -> None:
    citation = text("CITATION.cff")
    version = re.search(r"^version: (\S+)$", citation, re.MULTILINE)[1]
    date = re.search(r'^date-released: "(20\d\d-\d\d-\d\d)"$', citation, re.MULTILINE)[1]
    heading = re.search(r"^## (\S+) \((.*)\)$", text("CHANGELOG.md"), re.MULTILINE)
    assert heading[1] == version == tt.__version__
    assert heading[2] in ("unreleased", date)
