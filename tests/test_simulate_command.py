"""What `tippetop simulate` prints and writes."""

import json
import sys
from pathlib import Path
from types import ModuleType

import pandas as pd
import pytest
from typer.main import get_command
from typer.testing import CliRunner

import tippetop as tt
from tippetop.cli.commands import app
from tippetop.integrators import DEFAULT, NAMES
from tippetop.results.summary import summarize
from tippetop.theory.averaging import arrival_time_limit


def said(*words: str) -> str:
    done = CliRunner().invoke(app, ["simulate", *words], env={"COLUMNS": "200", "TERM": "dumb"})
    assert done.exit_code == 0, done.output
    return done.stdout


def test_people_and_programs_are_told_what_summarize_returns() -> None:
    run = tt.simulate(tt.presets.report_problem(spin=175.0), 8.0)
    summary = json.loads(json.dumps(summarize(run)))
    told = json.loads(said("--spin", "175", "--duration", "8", "--json"))
    assert {name: told[name] for name in summary} == summary
    lines = said("--spin", "175", "--duration", "8").splitlines()
    found = {line.rsplit(maxsplit=2)[0] for line in lines[1:]}
    assert {
        "turns over at",
        "first within 0.01 rad of its settled tilt at",
        "energy lost in impacts",
    } <= found
    (line,) = [line for line in lines if line.startswith("turns over at")]
    assert float(line.split()[-2]) == pytest.approx(summary["turnover_time"], rel=1e-6)


def test_what_there_is_not_is_said_in_words(monkeypatch: pytest.MonkeyPatch) -> None:
    without = ("turnover_time", "arrival_time", "jellett_drift", "energy_error")
    monkeypatch.setattr(tt, "summarize", lambda run: summarize(run) | dict.fromkeys(without, None))
    lines = said("--spin", "20", "--duration", "0.1")
    assert lines.count("not within the run") == 1
    assert lines.count("not settled") == 1
    assert lines.count("undefined") == 2
    assert "leaves the table" not in lines


def test_the_drift_of_jellett_is_told_where_it_is_conserved_alone() -> None:
    brief = ("--duration", "0.1", "--integrator", "dop853")
    told = [said(*brief, "--preset", name) for name in ("report", "egg", "report-stem")]
    assert ["Jellett" in words for words in told] == [True, False, False]
    assert "Jellett" not in said(*brief, "--set", "rolling_resistance=1e-4")


def test_every_file_asked_for_is_written(tmp_path: Path) -> None:
    kinds = {
        **{"out": "nc", "plot": "png", "csv": "csv", "parquet": "parquet"},
        **{"glb": "glb", "html": "html", "gif": "gif"},
    }
    files = {kind: f"run.{end}" for kind, end in kinds.items()}
    files |= {"events-table": "events.csv", "flights-table": "flights.parquet"}
    options = [word for kind, name in files.items() for word in (f"--{kind}", str(tmp_path / name))]
    told = said("--duration", "0.1", *options)
    assert {path.name for path in tmp_path.iterdir()} == set(files.values())
    assert told.count("wrote ") == len(files)
    events = (tmp_path / "events.csv").read_text().splitlines()
    assert events[0] == "time (s),kind,impulse (N s),energy_lost (J),surface"
    flights = pd.read_parquet(tmp_path / "flights.parquet")
    assert list(flights.columns) == ["start", "end", "max_gap"]


def test_a_workbook_is_written_where_openpyxl_is_installed(tmp_path, monkeypatch) -> None:
    names = {"--csv": "run.xlsx", "--events-table": "ev.xlsx"}
    words = [word for option, name in names.items() for word in (option, str(tmp_path / name))]
    monkeypatch.setitem(sys.modules, "openpyxl", None)
    done = CliRunner().invoke(app, ["simulate", "--duration", "1e9", *words])
    assert isinstance(done.exception, tt.Unavailable)  # before the run
    monkeypatch.setitem(sys.modules, "openpyxl", ModuleType("openpyxl"))
    written = []

    def to_excel(frame, file, **options):
        written.append(list(frame))

    monkeypatch.setattr(pd.DataFrame, "to_excel", to_excel)
    said("--duration", "0.1", *words)
    assert {path.name for path in tmp_path.iterdir()} == set(names.values())
    samples, events = written
    assert "tilt" in samples
    assert events == ["time", "kind", "impulse", "energy_lost", "surface"]


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (
            ["--csv", "run.txt"],
            "--csv: 'run.txt' is not a file name that ends in .csv or .xlsx",
        ),
        (
            ["--csv", "a.csv", "--events-table", "a.csv"],
            "--events-table: 'a.csv' is not another file than that of --csv",
        ),
        (
            ["--html", "a.html", "--out", "a.html"],
            "--out: 'a.html' is not a file name that ends in .nc",
        ),
    ],
)
def test_names_that_cannot_be_are_refused(words: list[str], sentence: str) -> None:
    done = CliRunner().invoke(app, ["simulate", *words])
    assert isinstance(done.exception, tt.InvalidInput)
    assert sentence in str(done.exception)


@pytest.mark.parametrize(
    ("command", "sentence"),
    [
        (
            "simulate --spin fast",
            "--spin: 'fast' is not a number (write a number in rad/s, or with its unit)",
        ),
        ("simulate --samples 2.5", "--samples: 2.5 is not a whole number"),
        ("simulate --tolerance 1,5", "--tolerance: 1,5 is not a finite number (write 1.5)"),
        ("engines --step x", "--step: 'x' is not a number (write a number in s, or with its unit)"),
        ("sweep --workers many", "--workers: 'many' is not a whole number"),
        (
            "lab --port 99999",
            "--port: 99999 is not a number at least 0 and at most 65535",
        ),
    ],
)
def test_what_is_no_number_is_refused_as_everything_else(command: str, sentence: str) -> None:
    done = CliRunner().invoke(app, command.split())
    assert isinstance(done.exception, tt.InvalidInput)
    assert str(done.exception) == sentence


def test_paragraphs_of_the_help_are_wrapped_by_the_terminal() -> None:
    for command in get_command(app).commands.values():
        assert all(paragraph.count("\n") == 0 for paragraph in command.help.split("\n\n"))


def test_the_help_offers_the_integrators_that_there_are() -> None:
    command = get_command(app).commands["simulate"]
    (option,) = [one for one in command.params if "--integrator" in one.opts]
    offered, _, default = option.help.partition("; ")
    assert offered.split(", ") == NAMES
    assert default == f"by default {DEFAULT}, and collocation where friction is stiff."


@pytest.mark.parametrize(
    ("command", "sentence"),
    [
        ("simulate --nope", "no such option: --nope"),
        ("--nope", "no such option: --nope"),
        ("simulate --duration", "--duration"),
        ("simulat", "no such command 'simulat'"),
        ("simulate one.toml two.toml", "two.toml"),
    ],
)
def test_a_command_line_that_is_none_is_refused_in_one_sentence(
    command: str, sentence: str
) -> None:
    done = CliRunner().invoke(app, command.split())
    assert isinstance(done.exception, tt.TippetopError)
    assert sentence in str(done.exception)
    assert "\n" not in str(done.exception)


@pytest.mark.parametrize(
    "twice", ["--spin 2 --set launch.spin=1", "--set launch.spin=1 --set launch.spin=1"], ids=str
)
def test_a_field_is_given_once(twice: str) -> None:
    done = CliRunner().invoke(app, ["problem", *twice.split()])
    assert str(done.exception).startswith("--set launch.spin: 1 is given beside ")


@pytest.mark.parametrize(
    "twice",
    [
        ["--set", "launch.slip=[1, 2]", "--set", "launch.slip.0=3"],
        ["--set", "launch.slip.0=3", "--set", "launch.slip=[1, 2]"],
        ["--set", 'launch={"tilt": 0.1, "spin": 3}', "--set", "launch.slip.0=3"],
    ],
    ids=str,
)
def test_a_field_is_not_given_beside_its_whole(twice: list[str]) -> None:
    done = CliRunner().invoke(app, ["problem", *twice])
    assert str(done.exception).startswith("launch.slip.0: 3 is given beside a value of ")


def test_a_place_is_written_in_one_way() -> None:
    for place in ("00", "\u0660", "2", "-1", "9" * 5000):
        with pytest.raises(
            tt.InvalidInput, match=r"^launch\.slip\..*: 3 is given for an unknown field"
        ):
            tt.presets.report_problem().replace({f"launch.slip.{place}": 3.0})


def test_critical_says_what_is_known_where_a_dry_point_sticks() -> None:
    done = CliRunner().invoke(app, ["critical", "--set", "friction.kind=coulomb"])
    assert done.exit_code == 0, done.output
    said = " ".join(done.output.split())
    assert "sticks as soon as friction can hold it, and the top then rolls without loss" in said
    assert "no critical spins" in said
    assert "ω_c1" not in said
    assert "Group" not in said


def test_critical_tells_why_it_leaves_out_how_long_a_launch_takes() -> None:
    """One so fast that the limit of small friction needs a pull of the table."""
    with pytest.raises(tt.InvalidInput) as refusal:
        arrival_time_limit(tt.presets.report_problem(spin=1000.0))
    done = CliRunner().invoke(app, ["critical", "--spin", "1000"])
    assert "so at this friction about" not in done.output
    assert refusal.value.accepted in " ".join(done.output.split())
