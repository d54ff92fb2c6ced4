"""Files in other encodings, or that lack what options state; full outputs; units nobody knows."""

import json
import os
import subprocess
import sys

import pytest

import tippetop as tt
from children import posix_only
from misused import commanded, misused
from tippetop.cli.options import Choice

PROBLEM = tt.presets.report_problem(spin=155.0)
CONE = "0,0\n20,30\n0,30\n"


def without(*lines):
    """The problem's TOML without the lines that begin so."""
    text = PROBLEM.to_toml()
    return "\n".join(line for line in text.splitlines() if not line.startswith(lines))


def test_options_state_what_a_file_lacks(tmp_path):
    path = tmp_path / "top.toml"
    path.write_text(without("spin"))
    assert "launch.spin in top.toml is missing" in misused(tmp_path, "simulate", "top.toml")
    for choice in (
        Choice(path, settings={"launch.spin": 0}),
        Choice(path, None, {}, ["launch.spin=0"]),
    ):
        assert choice.problem() == PROBLEM.replace({"launch.spin": 0.0})
    path.write_text(without("spin", "tilt"))
    told = misused(tmp_path, "simulate", "top.toml", "--spin", "0")
    assert told == "tippetop: launch.tilt is missing (write a number in rad)\n"
    told = misused(tmp_path, "simulate", "top.toml", "--spin", "fast", "--tilt", "0.1")
    assert told.startswith("tippetop: --spin: 'fast' is not")


@pytest.mark.parametrize("encoding", ["cp1252", "latin-1", "utf-8", "utf-8-sig"])
def test_texts_of_windows_are_read(tmp_path, encoding):
    (tmp_path / "a.toml").write_bytes(("# größe µ\n" + PROBLEM.to_toml()).encode(encoding))
    assert tt.Problem.read(tmp_path / "a.toml") == PROBLEM
    (tmp_path / "a.csv").write_bytes(("größe (mm),höhe (mm)\n" + CONE).encode(encoding))
    assert tt.read_workpiece(tmp_path / "a.csv", density=700).unit == "mm"


def test_bytes_that_are_no_text_are_refused(tmp_path):
    (tmp_path / "a.toml").write_bytes(bytes(range(256)))
    with pytest.raises(tt.FileTrouble, match="not a text file"):
        tt.Problem.read(tmp_path / "a.toml")


@posix_only
@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="a full device")
@pytest.mark.parametrize("arguments", [("problem",), ("--help",)])
def test_a_full_output_is_told_in_one_sentence(arguments):
    with open("/dev/full", "w") as full:
        command = [sys.executable, "-m", "tippetop", *arguments]
        ended = subprocess.run(
            command, stdout=full, stderr=subprocess.PIPE, check=False, timeout=120
        )
    said = "tippetop: the output cannot be written: No space left on device\n"
    assert (ended.returncode, ended.stderr.decode()) == (2, said)


@posix_only
@pytest.mark.parametrize(
    "arguments",
    [
        "simulate --duration 0.1 --csv run.csv",
        pytest.param(
            "sweep --over launch.spin=100,150 --duration 0.1 --workers 1 --out s.zarr --no-maps",
            marks=pytest.mark.slow,
        ),
    ],
)
def test_a_file_that_the_disk_has_no_room_for_leaves_nothing(tmp_path, arguments):
    """A limit on the size of files stands for a full disk: writing fails in the same place."""
    program = (
        "import resource, signal\n"
        "signal.signal(signal.SIGXFSZ, signal.SIG_IGN)\n"
        "from tippetop.cli.main import main\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096))\n"
        "main()\n"
    )
    command = [sys.executable, "-c", program, *arguments.split()]
    ended = subprocess.run(command, cwd=tmp_path, capture_output=True, check=False, timeout=120)
    said = ended.stderr.decode()
    assert (ended.returncode, said.count("\n")) == (2, 1), said
    assert "cannot be written: File too large" in said
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("unit", ["furlong", "px", "µm"])
def test_units_that_nobody_knows_are_not_taken_for_metres(tmp_path, unit):
    for heading in (f"r ({unit}),z ({unit})", f"r [{unit}],z [{unit}]", f"r/{unit},z/{unit}"):
        (tmp_path / "a.csv").write_text(f"{heading}\n{CONE}", encoding="utf-8")
        with pytest.raises(tt.InvalidInput, match="a unit of m, cm, mm or in") as caught:
            tt.read_workpiece(tmp_path / "a.csv", density=700)
        assert caught.value.field == "heading"
    (tmp_path / "a.csv").write_text(f"r,z\n{CONE}")
    assert tt.read_workpiece(tmp_path / "a.csv", density=700).unit == "m"


def test_a_problem_is_told_from_a_workpiece(tmp_path):
    PROBLEM.write(tmp_path / "top.toml")
    told = misused(tmp_path, "body", "top.toml")
    assert told.startswith("tippetop: top.toml is a problem, and not a workpiece in TOML")


def test_a_profile_is_told_from_a_problem(tmp_path):
    told = misused(tmp_path, "simulate", "top.csv")
    assert told.startswith("tippetop: problem: 'top.csv' is not a problem in TOML or JSON")
    assert "tippetop body" in told


@pytest.mark.parametrize("words", ["--spin 2200 rpm", "top.toml --spin 2200 rpm"])
def test_a_unit_without_quotes_is_no_file(tmp_path, words):
    PROBLEM.write(tmp_path / "top.toml")
    told = misused(tmp_path, "simulate", *words.split())
    assert "rpm is a unit" in told.replace("'rpm'", "rpm")
    assert "in quotes, as in '2200 rpm'" in told
    assert "no such file" in misused(tmp_path, "simulate", "xyzzy").lower()


def test_a_surface_has_no_thresholds_where_another_touches(tmp_path):
    """The spins on an edge or a stem are not those of a cut ball below them."""
    (tmp_path / "top.csv").write_text(
        "r (mm),z (mm),arc\n0,-15\n12,9,15\n2.5,9\n2.5,18\n0,20.5,2.5\n"
    )
    body = tt.Body.turned(tt.read_workpiece(tmp_path / "top.csv", density="beech"))
    PROBLEM.replace({"body": body}).write(tmp_path / "top.toml")
    said, _, code = commanded(tmp_path, "critical", "top.toml")
    assert not code
    assert "upright changes at" in said
    assert "inverted changes at" not in said
    assert "e+" not in said
    said, _, code = commanded(tmp_path, "critical", "--preset", "report-stem")
    assert not code
    assert "upright spin unstable above" in said
    assert "inverted spin stable above" not in said


def test_a_data_set_makes_no_folder_around_it(tmp_path):
    told = misused(tmp_path, "dataset", "--out", "missing/runs.zarr", "--count", "1")
    assert told == ("tippetop: missing/runs.zarr cannot be written: No such file or directory\n")
    assert list(tmp_path.iterdir()) == []


def test_a_parameter_of_a_distribution_stands_once(tmp_path):
    draw = "launch.spin=norm:loc=150:loc=100:scale=5"
    told = misused(tmp_path, "sweep", "--draw", draw, "--count", "3")
    assert "has the parameter loc twice" in told


def test_separators_that_cannot_be_are_refused_for_what_they_are(tmp_path):
    run = tt.simulate(PROBLEM, 0.01, samples=3)
    for sep, why in (
        (",", "separates the decimals"),
        (";;", "one character"),
        ('"', "one character"),
    ):
        with pytest.raises(tt.InvalidInput, match=why):
            tt.write_csv(run, tmp_path / "a.csv", sep=sep, decimal="," if sep == "," else ".")
    assert list(tmp_path.iterdir()) == []


def test_a_run_that_keeps_nothing_tells_nothing_and_ends_with_code_1(tmp_path):
    command = "simulate --integrator rk4 --step 1 --duration 10"
    for form in ((), ("--json",)):
        said, _, code = commanded(tmp_path, *command.split(), *form)
        assert code == 1
        if form:
            assert json.loads(said)["status"] == "inaccurate"
        else:
            assert "nothing is told of it" in " ".join(said.split())
            assert "error of the energy balance" in said
            assert not any(word in said for word in ("final tilt", "turns over", "flights"))


def test_losses_that_are_rounding_are_zero():
    from tippetop.cli.simulate import _rows  # noqa: PLC0415 - private

    summary = tt.summarize(tt.simulate(PROBLEM, 0.01, samples=3))
    summary |= {"uncertainties": {}, "energy_lost_drilling": 1e-9, "energy_lost_sliding": -1.9e-18}
    rows = {name: value for name, value, _ in _rows(summary, True)}
    assert rows["of it to sliding"] == "0"
    assert float(rows["of it to drilling"]) == 1e-9
