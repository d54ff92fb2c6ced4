"""A run is held against what every motion keeps."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import tippetop as tt
from tippetop.contact import contact_mode, flight
from tippetop.contact.lowest_surface import lowest_jellett
from tippetop.mechanics.invariants import energy
from tippetop.mechanics.state import State
from tippetop.mechanics.top import natural, natural_state, natural_units
from tippetop.mechanics.vectors import length
from tippetop.problem.problem import top_of
from tippetop.results.accumulation import before_launch
from tippetop.results.accuracy_monitor import Monitor
from tippetop.results.metrics import STATUSES
from tippetop.sweeps.cells import cells_of
from tippetop.sweeps.ensemble import judge

PROBLEM = tt.presets.report_problem()
STEMMED = PROBLEM.replace({"body": tt.presets.REPORT_STEM})
TOP = natural(top_of(PROBLEM))
START = natural_state(PROBLEM.start(), natural_units(top_of(PROBLEM)))
ENERGY = float(energy(START, TOP))


def seen(problem: tt.Problem = PROBLEM, **changes: Any) -> Monitor:
    """A monitor that saw three instants as the first, but for some changes to the last."""
    top, start = (
        natural(top_of(problem)),
        natural_state(problem.start(), natural_units(top_of(problem))),
    )
    monitor = Monitor(top, start)
    ones = np.array([1.0, 1.0, 1.0])
    told = {
        "size": length(start.axis) * ones,
        "energy": energy(start, top) * ones,
        "jellett": lowest_jellett(start, top) * ones,
        "work": 0.0 * ones,
    }
    conditions = {"gap": 0.0 * ones, "force": ones, "reserve": ones}
    for name, change in changes.items():
        numbers = told if name in told else conditions
        numbers[name] = numbers[name] + np.array([0.0, 0.0, change])
    monitor.check(**told)
    monitor.check_gap(conditions["gap"])
    monitor.check_force(conditions["force"])
    monitor.check_reserve(conditions["reserve"])
    return monitor


def test_what_stays_as_it_was_is_exact() -> None:
    assert seen().inaccuracy < 1e-15


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_energy_that_no_work_explains_is_an_error(sign: float) -> None:
    assert seen(energy=sign * 1e-3 * ENERGY).energy_error == pytest.approx(1e-3)
    assert seen(energy=-1e-3 * ENERGY, work=-1e-3 * ENERGY).energy_error < 1e-15
    assert not seen(work=sign * 1e-3 * ENERGY).is_trusted(1e-12)


def test_jellett_s_integral_may_not_drift() -> None:
    assert TOP.conserves_jellett
    assert seen(jellett=1e-3).inaccuracy > 1e-5
    assert seen(jellett=1e-3).jellett_drift == pytest.approx(seen(jellett=-1e-3).jellett_drift)


def test_a_launch_that_hardly_turns_has_no_integral_to_drift() -> None:
    """What rounding does to 1e-8 of a moment says nothing of a run."""
    slow = PROBLEM.replace({"launch.spin": 1e-8, "launch.tilt": 0.0})
    assert seen(slow, jellett=1e-12).jellett_drift > 1e-6
    assert seen(slow, jellett=1e-12).is_trusted(1e-12)
    assert not seen(jellett=1e-3).is_trusted(1e-12)


@pytest.mark.parametrize("problem", [PROBLEM, STEMMED])
def test_a_body_may_not_be_in_the_table(problem: tt.Problem) -> None:
    assert seen(problem).inaccuracy < 1e-15
    assert seen(problem, gap=-1e-3).inaccuracy == pytest.approx(1e-3)
    assert seen(problem, gap=1e-3).inaccuracy < 1e-15, "it may be above it"


def test_the_table_may_not_pull_and_friction_not_hold_more_than_it_can() -> None:
    assert seen(force=-1.0 - 1e-3).inaccuracy == pytest.approx(1e-3)
    assert seen(reserve=-1.0 - 1e-3).inaccuracy == pytest.approx(1e-3)
    assert seen(force=1e3, reserve=-1.0 - 1e-3).is_trusted(1e-12), "rounding of large forces"
    pulls = Monitor(TOP, START, pulls=True)
    pulls.check_force(np.array([-1.0]))
    assert pulls.inaccuracy < 1e-15


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"energy": 1e-3 * ENERGY}, "The energy differs"),
        ({"size": 1e-3}, "The axis is no unit vector: its length is off by 0.001 of itself."),
        ({"gap": -0.0123}, "The body sinks into the table by 0.012 of its size."),
        ({"force": -1.5}, "the table would have to pull with 0.5 of the weight."),
        ({"reserve": -1.25}, "What friction holds needs more than it can exert, by 0.25 of N^2."),
    ],
)
def test_what_a_run_does_not_keep_is_named(change: dict[str, float], words: str) -> None:
    assert words in seen(**change).breach(1e-12)
    assert seen().breach(1e-12) == ""


TWO_MAXIMA = tt.Problem(
    body=tt.Body(
        mass=0.02,
        shape=tt.Oval(support=[0.0212, 0.0, -0.0096, 0.0, 0.0096, *[0.0] * 12]),
        I1=3.2e-6,
        I3=3.2e-6,
    ),
    friction=tt.ViscousFriction(mu=0.3),
    launch=tt.Launch(tilt=math.acos(0.8), spin=188.0, precession=-188.0 * 0.8 / 0.36, gap=5e-4),
)
"""A body whose support function has two maxima, dropped so that either may strike first."""


def test_the_monitor_looks_at_gaps_of_a_body_of_one_surface(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A flight that nothing ends goes through the table: the run says so, and by how much."""
    monkeypatch.setattr(flight, "surface_gap", lambda _, state: 1.0 + 0.0 * state.height)
    flight.flight_motion.cache_clear()
    for simulated in (tt.presets.report_problem().replace({"launch.gap": 1e-3}), TWO_MAXIMA):
        run = tt.simulate(simulated, 0.05, samples=3)
        assert run.attrs["status"] == "inaccurate"
        assert "The body sinks into the table by " in run.attrs["message"]
    flight.flight_motion.cache_clear()


@pytest.mark.parametrize(
    ("problem", "guard", "words"),
    [
        (tt.presets.report_problem(spin=175.0), "lift-off", "have to pull"),
        (
            PROBLEM.replace(
                {
                    "friction": tt.CoulombFriction(mu=0.2),
                    "launch": tt.Launch(tilt=1.2, spin=20.0, precession=60.0),
                }
            ),
            "slip",
            "What friction holds needs more",
        ),
    ],
)
def test_a_guard_that_is_missed_is_named(
    monkeypatch: pytest.MonkeyPatch, problem: tt.Problem, guard: str, words: str
) -> None:
    """Without the guard of lift-off, or of the limit of sticking, the mode goes on beyond it."""
    guards = contact_mode.guards_on_one
    monkeypatch.setattr(
        contact_mode,
        "guards_on_one",
        lambda mode: [one for one in guards(mode) if one[0] != guard],
    )
    contact_mode.motion_of.cache_clear()
    try:
        run = tt.simulate(problem, 6.5, samples=3)
    finally:
        contact_mode.motion_of.cache_clear()
    assert run.attrs["status"] == "inaccurate"
    assert words in run.attrs["message"]


def test_coarser_steps_may_be_further_off() -> None:
    slightly = seen(energy=5e-5 * ENERGY)
    assert slightly.is_trusted(1e-8)
    assert not slightly.is_trusted(1e-9)


@pytest.mark.parametrize("number", [np.nan, np.inf, -np.inf])
def test_what_is_no_number_is_not_trusted(number: float) -> None:
    for name in ("size", "energy", "jellett", "work"):
        assert not seen(**{name: number}).is_trusted(1e-2), name
    for name in ("gap", "force", "reserve"):
        assert not seen(**{name: -abs(number)}).is_trusted(1e-2), name


def test_many_launches_are_held_against_what_each_keeps() -> None:
    problems = [PROBLEM.replace({"launch.spin": spin}) for spin in (1e-8, 50.0, 155.0)]
    starts = [natural_state(one.start(), natural_units(top_of(one))) for one in problems]
    many = State.unpack(
        [np.array(numbers) for numbers in zip(*(one.pack() for one in starts), strict=True)]
    )
    monitor = Monitor(TOP, many)
    for off in (0.0, 1e-3):
        told = (
            length(many.axis),
            energy(many, TOP),
            lowest_jellett(many, TOP),
        )
        size, *others, jellett = (number[None] for number in told)
        size[0, 2] += off
        jellett[0, :2] += off
        monitor.check(size, *others, jellett, np.zeros((1, 3)))
        assert monitor.is_trusted(1e-9).tolist() == [True, not off, not off]


@pytest.mark.parametrize("liftoff", ["fly", "ignore"])
def test_launches_of_a_sweep_are_called_inaccurate_for_what_they_do_not_keep(liftoff: str) -> None:
    """By their last states and least forces; an end that is no number breaches nothing where the
    launch failed, and makes any other inaccurate.
    """
    problem = PROBLEM.replace({"contact.liftoff": liftoff})
    cells = cells_of(problem, {"launch.spin": np.full(8, 155.0)})
    launches = cells.launches(np.arange(8), 1.0)
    start = [np.array(numbers) for numbers in np.broadcast_arrays(*launches.state.pack())]
    axis, momentum, height = start[:3], start[3:6], start[9]
    names = ["COMPLETED"] * 6 + ["FAILED", "TOO_MANY_STEPS"]
    ends = before_launch(8)
    ends.status[:] = [STATUSES.index(tt.Status[name]) for name in names]
    ends.least_force[:] = 1.0
    height[1] -= 1e-3
    ends.least_force[2] = -1e-3
    axis[2][3] += 1e-3
    momentum[2][4] *= 1.0 + 1e-3
    height[5], height[6] = np.nan, np.nan
    axis[2][7] += 1e-3
    judge(replace(ends, state=State.unpack(start)), launches, 1e-9)
    told = [STATUSES[status].name for status in ends.status]
    pulled = "COMPLETED" if liftoff == "ignore" else "INACCURATE"
    assert told[:3] == ["COMPLETED", "INACCURATE", pulled]
    assert told[3:] == ["INACCURATE"] * 3 + ["FAILED", "INACCURATE"]


def test_the_end_of_a_run_is_seen() -> None:
    """A run of a single step begins nowhere but at its launch."""
    run = tt.simulate(PROBLEM, 0.05, samples=2, integrator="rk4", step=0.05)
    assert int(run["steps"]) == 1
    assert run.attrs["status"] == "inaccurate"
    assert "shorter steps" in run.attrs["message"]


def test_fixed_steps_are_warned_of() -> None:
    advice = [
        tt.simulate(PROBLEM, 0.01, samples=2, **method).attrs["message"]
        for method in ({"integrator": "rk4", "step": 1e-3}, {"integrator": "dop853"})
    ]
    assert ["half the step" in one for one in advice] == [True, False]


def test_steps_that_are_too_long_are_told() -> None:
    outcomes = [
        tt.simulate(PROBLEM, 0.5, samples=2, integrator="rk4", step=step).attrs["status"]
        for step in (1e-2, 1e-3)
    ]
    assert outcomes == ["inaccurate", "completed"]


def test_what_a_motion_seemed_to_come_to_is_not_told_of_one_that_cannot_be_trusted() -> None:
    off, kept = seen(energy=1e-3 * ENERGY), seen()
    for outcome in tt.Status:
        assert kept.trusted_status(outcome, 1e-12) is outcome
        assert off.trusted_status(outcome, 1e-12) is tt.Status.INACCURATE


@pytest.mark.slow
def test_a_lift_off_that_steps_too_long_find_is_not_told() -> None:
    problem = tt.presets.report_problem(spin=175.0).replace({"contact.liftoff": "stop"})
    methods: list[dict[str, Any]] = [{"integrator": "rk4", "step": 3e-3}, {"integrator": "dop853"}]
    runs = [tt.simulate(problem, 6.5, samples=2, **method) for method in methods]
    assert [run.attrs["status"] for run in runs] == ["inaccurate", "lifted_off"]
    assert all(run["end_time"] < 6.5 for run in runs)


def test_a_run_that_breaks_its_balance_is_inaccurate_before_anything_else_is_said():
    run = tt.simulate(tt.presets.report_problem(), 20.0, integrator="rk4", step=1.0)
    assert float(run["energy_error"]) > 1.0
    assert run.attrs["status"] == run["outcome"].item() == "inaccurate"
    account = str(tt.describe(run))
    assert account.count(".") == 1
    assert "nothing is told of it" in account


def test_a_run_that_fails_and_keeps_its_balance_is_not_called_inaccurate():
    bouncing = PROBLEM.replace({"launch.gap": 0.01, "contact.restitution": 0.5})
    run = tt.simulate(bouncing, 20.0, mode_limit=4)
    assert run.attrs["status"] == "too_many_modes"
