"""The reference suite: two methods agree on it, and its files say the same in three formats."""

import csv
import json
import math

import numpy as np
import pytest
import xarray as xr
from typer.testing import CliRunner

import tippetop as tt
from independent_motions import disk_friction
from independent_reference import computed
from independent_solver import Solver, hertz
from tippetop.cli.commands import app
from tippetop.engines import derivatives
from tippetop.engines import reference as suite
from tippetop.engines.cases import CASES

BRIEF = ("restitution", "painleve", "rest", "ball")
"""Cases that take about a second."""

WHOLE = [
    case.name if case.name in BRIEF else pytest.param(case.name, marks=pytest.mark.slow)
    for case in CASES
]

LONG = ("viscous", "flights", "stem", "stick-slip", "disk-end")
AGAIN = [
    pytest.param(case.name, marks=pytest.mark.campaign)
    if case.name in LONG
    else pytest.param(case.name, marks=pytest.mark.slow)
    if case.name not in BRIEF
    else case.name
    for case in CASES
]


@pytest.mark.parametrize("name", WHOLE)
def test_the_program_agrees_with_the_independent_solver(name):
    found = suite.reference(suite.case_of(name))
    assert found.agrees, (found.event_agreement, found.state_agreement)
    assert found.energy_error < 1e-12
    late = [event for event in found.events if math.isnan(event[3])]
    assert len(late) <= len(found.events) // 2, "events without a second method are few"


@pytest.mark.parametrize("name", AGAIN)
def test_the_stored_numbers_are_the_independent_solvers(name):
    case = suite.case_of(name)
    states, events, _ = computed(case)
    stored = suite.independent(case)
    scale = np.abs(stored["states"]).max(axis=0) + 1e-300
    assert np.abs((np.array(states) - stored["states"]) / scale).max() < 1e-8
    assert [(kind, i) for _, kind, i in events] == [(kind, i) for _, kind, i in stored["events"]]
    apart = [abs(a[0] - b[0]) for a, b in zip(events, stored["events"], strict=True)]
    assert max(apart, default=0.0) < 1e-10


@pytest.mark.slow
def test_the_solvers_agree_on_a_top_that_sticks_and_slips_again_and_again():
    """Slip hardly grows, and its direction is stiff: the second solver has polynomials for it."""
    problem = tt.Problem(
        body=tt.presets.REPORT,
        friction=tt.CoulombFriction(mu=0.02985),
        launch=tt.Launch(tilt=0.1, spin=155.0),
    )
    times = np.array([0.04, 0.08, 0.12])
    run = tt.simulate(problem, times[-1], times=[0.0, *times])
    solver = Solver(problem).follow(times)
    assert len(solver.events) == len(run["event_time"]) == 9
    assert solver.methods == {"DOP853", "collocation"}
    for (time, kind, _), event, name in zip(
        solver.events, run["event_time"].values, run["event_kind"].values, strict=True
    ):
        assert kind == name
        assert abs(time - event) < 1e-11
    states = np.array(solver.samples)
    assert np.abs(states[:, 1:4] - run["axis"].values[1:]).max() < 1e-12
    assert np.abs(states[:, 4:7] - run["angular_velocity"].values[1:]).max() < 1e-10


def test_a_wrong_number_does_not_agree(monkeypatch):
    case = suite.case_of("painleve")
    stored = suite.independent(case)
    stored["states"][7][10] *= 1.0 + 1e-6
    monkeypatch.setattr(suite, "independent", lambda _: stored)
    assert not suite.reference(case).agrees
    stored = json.loads(json.dumps(stored))
    stored["states"][7][10] /= 1.0 + 1e-6
    stored["events"][0][0] += 1e-9
    assert not suite.reference(case).agrees


@pytest.fixture(scope="module")
def agreed():
    """A case on which both methods agree."""
    return suite.reference(suite.case_of("painleve"))


@pytest.mark.parametrize(
    ("name", "apart", "code"),
    [("painleve", 2e-10, 1), ("painleve", 0.9e-10, 0), ("stem", 5e-7, 0), ("stem", 2e-6, 1)],
)
def test_the_command_fails_beyond_the_limits_that_it_lists(
    monkeypatch, tmp_path, agreed, name, apart, code
):
    """A sequence of rebounds that is cut off allows more than 1e-10 s."""
    found = agreed._replace(case=suite.case_of(name), events=((0.1, "impact", 0, apart),))
    monkeypatch.setattr(suite, "write_suite", lambda *_: [found])
    words = ["reference", "--out", str(tmp_path / "suite")]
    done = CliRunner().invoke(app, [*words, "--json"])
    assert done.exit_code == code
    told = json.loads(done.stdout)["cases"][name]
    assert (told["event_agreement"] > told["event_limit"]) == bool(code)
    shown = CliRunner().invoke(app, words, env={"COLUMNS": "200"})
    assert shown.exit_code == code
    assert f"{apart:.0e} of {told['event_limit']:.0e}" in shown.stdout


def test_the_limits_are_those_of_the_text():
    for name, event, state in [("viscous", 1e-10, 1e-8), ("stem", 1.0001e-6, 1.001e-5)]:
        one = suite.Reference(suite.case_of(name), None, (), "", 0.0, 0.0, "")
        assert one.event_limit == pytest.approx(event, rel=1e-12)
        assert one.state_limit == pytest.approx(state, rel=1e-12)


def test_every_case_has_its_independent_numbers():
    for case in CASES:
        stored = suite.independent(case)
        rows = np.array(stored["states"])
        assert rows.shape == (len(case.times), len(stored["columns"]))
        assert np.allclose(rows[:, 0], case.times, rtol=1e-14)
        assert np.allclose(np.linalg.norm(rows[:, 1:4], axis=1), 1.0, atol=1e-11)


def test_the_suite_says_the_same_in_all_formats(tmp_path, monkeypatch):
    """Without derivatives, which take seconds; `test_suite_in_use.py` compares their files."""
    monkeypatch.setattr(derivatives, "independent_slopes", lambda _: None)
    suite.write_suite(tmp_path / "suite", ["painleve"])
    folder = tmp_path / "suite"
    told = json.loads((folder / "painleve.json").read_text())
    schema = json.loads((folder / "schema.json").read_text())
    assert set(schema["required"]) <= set(told)
    assert set(schema["properties"]["states"]["required"]) == set(told["states"])
    assert tt.Problem(**told["problem"]) == suite.case_of("painleve").problem
    with (folder / "painleve_states.csv").open() as file:
        rows = list(csv.DictReader(file))
    read = xr.open_dataset(folder / "painleve.nc", engine="h5netcdf").load()
    for name, column in told["states"].items():
        assert column["values"] == [float(row[name]) for row in rows] == read[name].values.tolist()
        assert column["agreement"] == [float(row[f"{name}_agreement"]) for row in rows]
    with (folder / "painleve_events.csv").open() as file:
        events = [(float(row["time"]), row["kind"]) for row in csv.DictReader(file)]
    assert events == [(event["time"], event["kind"]) for event in told["events"]]
    assert read["event_time"].values.tolist() == [time for time, _ in events]
    assert "| [`painleve`](painleve.html) |" in (folder / "README.md").read_text()
    with pytest.raises(tt.FileTrouble, match="exists"):
        suite.write_suite(folder, ["painleve"])
    with pytest.raises(tt.FileTrouble, match="cannot be written"):
        suite.write_suite(folder / "README.md" / "inside", ["painleve"])
    twice = suite.write_suite(tmp_path / "twice", ["painleve", "painleve"])
    assert [one.case.name for one in twice] == ["painleve"]


def test_energy_and_jellett_of_states_are_those_of_the_run():
    case = suite.case_of("rest")
    found = suite.reference(case).states
    run = tt.simulate(case.problem, 1.0, times=[0.0, *case.times[case.times <= 1.0]])
    count = run.sizes["time"] - 1
    assert np.allclose(found["energy"][:count], run["energy"][1:], rtol=1e-13)
    spun = suite.case_of("painleve")
    found, run = (
        suite.reference(spun).states,
        tt.simulate(spun.problem, 2e-3, times=[0, *spun.times]),
    )
    assert np.allclose(found["jellett"], run["jellett"][1:], rtol=1e-9, atol=1e-18)


def test_no_case_of_this_name(tmp_path):
    result = CliRunner().invoke(app, ["reference", "--out", str(tmp_path / "s"), "--case", "tops"])
    assert isinstance(result.exception, tt.InvalidInput)
    assert "painleve" in str(result.exception)
    assert not (tmp_path / "s").exists()


@pytest.mark.parametrize("ratio", [0.05, 0.653, 1.0, 1.0001, 3.0])
def test_the_second_methods_face_is_coulomb_friction_all_over_it(ratio):
    """Each part slides with its own velocity under the same pressure."""
    count, radius = 1500, 0.02
    middles = (np.arange(count) + 0.5) / count
    r, angle = np.meshgrid(radius * np.sqrt(middles), 2.0 * math.pi * middles)
    x, y = r * np.cos(angle), r * np.sin(angle)
    vx, vy = ratio * radius - y, x
    size = np.hypot(vx, vy)
    force, torque = disk_friction(ratio * radius, 1.0, radius)
    assert np.mean(vx / size) == pytest.approx(force, abs=1e-5)
    assert np.mean((x * vy - y * vx) / size) == pytest.approx(torque, abs=1e-5 * radius)


def test_a_ball_on_a_slope_ends_as_its_closed_solution():
    """Slip changes by (7/2) times friction plus gravity along the table, and rolling down takes
    five sevenths of that.
    """
    case = suite.case_of("slope")
    rows = np.array(suite.independent(case)["states"])
    ((stop, *_),) = suite.independent(case)["events"]
    late = rows[rows[:, 0] > stop]
    slope, azimuth = case.problem.table.slope, case.problem.table.azimuth
    down = 5.0 / 7.0 * case.problem.gravity * math.sin(slope)
    change = (late[-1] - late[0])[7:9] / (late[-1] - late[0])[0]
    expected = [down * math.cos(azimuth), down * math.sin(azimuth)]
    assert change == pytest.approx(expected, rel=1e-11)


@pytest.mark.parametrize("kappa", [0.3, 0.9, 1.4, 4.0])
def test_the_second_solvers_patch_is_coulomb_friction_all_over_it(kappa):
    """Each part slides with its own velocity under the pressure (3/2) sqrt(1 - r^2) / pi."""
    count = 1500
    middles = (np.arange(count) + 0.5) / count
    # r = sin(a) takes the pressure's edge away.
    a, angle = np.meshgrid(0.5 * math.pi * middles, 2.0 * math.pi * middles)
    r = np.sin(a)
    weight = 1.5 / math.pi * np.cos(a) ** 2 * r * math.pi**2 / count**2
    vx, vy = kappa - r * np.sin(angle), r * np.cos(angle)
    size = np.hypot(vx, vy)
    moment = r * (np.cos(angle) * vy - np.sin(angle) * vx)
    force, torque = hertz(1.0, 1.0)(np.array([kappa, 0.0]), 1.0)
    assert weight.sum() == pytest.approx(1.0, abs=1e-6)
    assert (weight * vx / size).sum() == pytest.approx(-force[0], abs=2e-5)
    assert (weight * moment / size).sum() == pytest.approx(-torque, abs=2e-5)
