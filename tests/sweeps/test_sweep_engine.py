"""The engine against itself, and against what must hold."""

import math

import numpy as np
import pytest
from sweep_cases import lively, problem_of, same, truth

from tippetop.contact.contact_mode import sliding_motion
from tippetop.mechanics.motion import along_table
from tippetop.mechanics.series import horner
from tippetop.problem.bodies import Body
from tippetop.problem.frictions import RegularizedCoulombFriction
from tippetop.problem.presets import report_problem
from tippetop.problem.shapes import Spheroid
from tippetop.results.catalogue import METRICS
from tippetop.run import simulate
from tippetop.support.errors import InvalidInput
from tippetop.sweeps import (
    SWEPT,
    Axis,
    Fault,
    Outcome,
    Product,
    Sweep,
    compute,
    ensemble,
    flights,
    lane_executor,
    taylor_step,
    transitions,
)
from tippetop.sweeps.cells import cells_of
from tippetop.sweeps.ensemble import follow_cells
from tippetop.sweeps.single_launches import follow_each
from tippetop.sweeps.taylor_step import Layout, expansion, order_for, stride
from tippetop.sweeps.taylor_stepper import NumPyArithmetic, stepper

EGG = Body(mass=0.05, shape=Spheroid(across=0.02, along=0.03), I1=9e-6, I3=5e-6)


def test_a_cell_does_not_depend_on_its_neighbours():
    sweep = lively(tolerance=1e-9)
    cells = np.arange(sweep.cells)
    together = follow_cells(sweep, cells)
    alone = [follow_cells(sweep, cells[k : k + 1]) for k in (0, 7, 14)]
    for k, one in zip((0, 7, 14), alone, strict=True):
        for name, values in one.items():
            assert values[0] == pytest.approx(
                together[name][k], rel=1e-11, abs=1e-12, nan_ok=True
            ), name
    backwards = follow_cells(sweep, cells[::-1])
    for name, values in backwards.items():
        assert values[::-1] == pytest.approx(together[name], rel=1e-11, abs=1e-12, nan_ok=True), (
            name
        )


def test_a_cell_does_not_depend_on_lanes_waits_and_windows(monkeypatch):
    sweep = lively(tolerance=1e-9)
    cells = np.arange(sweep.cells)
    usual = follow_cells(sweep, cells)
    monkeypatch.setattr(ensemble, "LANES_AT_ONCE", 4)
    monkeypatch.setattr(lane_executor, "LOST", 0.1)
    monkeypatch.setattr(lane_executor, "WINDOW", 12)
    monkeypatch.setattr(lane_executor, "CROWDED", 1.5)
    other = follow_cells(sweep, cells)
    for name, values in other.items():
        assert values == pytest.approx(usual[name], rel=1e-11, abs=1e-12, nan_ok=True), name


def test_arrays_make_the_steps_that_are_compiled():
    sweep = lively("ignore", 4, 4)
    cells = cells_of(sweep.problem, sweep.grid.values(np.arange(16)))
    launches = cells.launches(np.arange(16), 1.0)
    state = launches.state
    motion = sliding_motion(launches.kind, guarded=True)
    layout = Layout.of(motion)
    before = np.zeros((layout.rows, 16))
    for row, number in enumerate((*state.axis, *state.momentum, *state.velocity[:2])):
        before[row] = number
    before[layout.remaining] = launches.end
    pauses = np.tile([[1.0], [1.0], [np.inf], [-np.inf]], 16)
    numbers = np.concatenate((launches.numbers, pauses))
    compiled, order, plain = stepper(motion, 1e-9), order_for(1e-9), NumPyArithmetic()
    one = np.empty_like(before)
    compiled.step(before, one, numbers)
    jet = expansion(motion, order, list(before[: layout.size]), list(numbers), plain)
    other = stride(layout, jet, list(before[: layout.carried_rows]), list(numbers), plain)
    assert one == pytest.approx(np.array(other), rel=1e-11, abs=1e-13)
    for ours, theirs in zip(compiled.jet(before, numbers), map(np.array, jet), strict=True):
        assert ours == pytest.approx(theirs, rel=1e-9, abs=1e-9 * np.abs(theirs).max())
    assert np.all(one[layout.step_time] > 0)


@pytest.mark.parametrize("field", ["launch.spin", "launch.slip.0"])
def test_a_step_of_a_fast_top_leaves_little_out_of_its_axis(field):
    """Beside polynomials of far higher degree over the same step."""
    tolerance, count = 1e-9, 16
    friction = RegularizedCoulombFriction(mu=0.3, eps=0.1)
    cells = cells_of(
        report_problem(spin=100.0).replace({"friction": friction}),
        {field: np.geomspace(1e2, 1e6, count)},
    )
    launches = cells.launches(np.arange(count), 1.0)
    motion = sliding_motion(launches.kind, guarded=True)
    usual, finer = stepper(motion, tolerance), stepper(motion, 1e-16)
    before, after = np.zeros((2, usual.layout.rows, count))
    for row, number in enumerate(along_table(launches.state).pack()):
        before[row] = number
    before[usual.layout.remaining] = np.inf
    numbers = np.concatenate(
        (launches.numbers, np.tile([[0.0], [0.0], [np.inf], [-np.inf]], count))
    )
    usual.step(before, after, numbers)
    exact = [
        horner(terms, after[usual.layout.step_time])
        for terms in finer.jet(before, numbers).state[:3]
    ]
    off = np.linalg.norm(after[:3] - exact, axis=0)
    assert off.max() <= taylor_step.FAST * tolerance
    assert off.max() > 1e-16


@pytest.mark.parametrize("tolerance", [1e-9, 1e-12])
def test_weaker_gravity_is_no_singular_motion(tolerance):
    """Where there is hardly any, the motion does not depend on it: only how short its steps are
    beside 1.
    """
    problem = report_problem(spin=155.0, tilt=1.0)
    problem = problem.replace(
        {"contact.liftoff": "ignore", "launch.precession": -20.0, "gravity": 1e-10}
    )
    run = truth(problem, 0.3, 2)
    axis = Axis.of("gravity", [1e-10, 1e-20, 1e-26, 1e-30])
    found = follow_cells(Sweep(problem, Product((axis,)), 0.3, tolerance), np.arange(4))
    assert np.all(found["outcome"] == Outcome.MOVING_TILTED)
    for name in ("final_tilt", "final_spin", "max_height"):
        assert found[name] == pytest.approx(np.full(4, float(run[name])), rel=1e-8), name
    assert abs(found["final_tilt"][0] - 1.0) > 0.01


@pytest.mark.parametrize(
    "changes",
    [
        {"launch.spin": 1e150},
        {"friction.mu": 1e300},
        {"launch.spin": 1e150, "launch.gap": 0.01},
        {"launch.spin": 1e80, "launch.gap": 0.01},
        {"launch.slip": (0.0, -1e120), "contact.restitution": 1.0},
    ],
)
def test_what_is_no_number_is_not_followed(changes):
    """The rest of a run is no step, and of a launch that breaks down at once the launch is the
    result.
    """
    problem = report_problem(spin=155.0).replace(changes)
    alone = simulate(problem, 0.5, samples=2)
    found = follow_cells(Sweep(problem, Product((Axis.of("gravity", [9.81]),)), 0.5), np.arange(1))
    assert found["outcome"] == Outcome.FAILED
    assert alone.attrs["status"] == "failed"
    assert found["end_time"] == float(alone["end_time"]) == 0.0
    assert found["final_tilt"] == pytest.approx(problem.launch.tilt)


def test_lift_off_is_not_left_to_looks(monkeypatch):
    """Seen at its ends only, a step in which the force dips below zero often shows nothing of
    it.
    """
    sweep = lively("stop", 8, 4, tolerance=1e-9)
    usual = follow_cells(sweep, np.arange(32))
    monkeypatch.setattr(taylor_step, "PROBES", 1)
    stepper.cache_clear()
    found = follow_cells(sweep, np.arange(32))
    stepper.cache_clear()
    assert np.isfinite(usual["liftoff_time"]).sum() >= 5
    assert found["liftoff_time"] == pytest.approx(usual["liftoff_time"], rel=1e-12, nan_ok=True)


def test_a_flight_that_cannot_be_followed_is_said_to_have_failed(monkeypatch):
    monkeypatch.setattr(flights, "STEP_LIMIT", 2)
    problem = report_problem(spin=2000.0, tilt=1.0).replace({"launch.precession": 3000.0})
    axis = Axis.of("launch.gap", [1.0])
    found = follow_cells(Sweep(problem, Product((axis,)), 0.3, 1e-9), np.arange(1))
    assert found["outcome"][0] == Outcome.FAILED
    assert found["end_time"][0] == pytest.approx(found["airborne_time"][0])
    assert 0.0 < found["end_time"][0] < 0.3


def settling(settled):
    """Launches that end upright, inverted and between, some of them after flights, over a long
    time.
    """
    axes = (
        Axis.of("launch.spin", [15.0, 45.0, 60.0, 120.0, 190.0]),
        Axis.of("friction.mu", [0.3, 0.8]),
    )
    return Sweep(report_problem(), Product(axes), 60.0, 1e-9, settled)


def test_launches_that_have_settled_end_early_and_where_they_would_have_ended():
    cells = np.arange(10)
    whole, short = (follow_cells(settling(settled), cells) for settled in (None, 1e-3))
    assert np.all(whole["end_time"] == 60.0)
    assert np.sum(short["end_time"] < 40.0) >= 8
    assert np.abs(short["final_tilt"] - whole["final_tilt"]).max() <= 1e-3
    ended = short["end_time"] < 60.0
    assert set(whole["outcome"][ended]) == {Outcome.UPRIGHT, Outcome.TILTED, Outcome.INVERTED}
    for name in ("outcome", "flights", "turnover_time", "liftoff_time", "min_normal_force"):
        assert short[name] == pytest.approx(whole[name], rel=1e-9, nan_ok=True), name


def test_a_tilt_that_is_held_never_leaves():
    """The whole run after the moment at which the engine ended it, looked at by single runs."""
    sweep = settling(1e-2)
    short = follow_cells(sweep, np.arange(10))
    for cell in (1, 2, 5):
        run = truth(problem_of(sweep, cell), 60.0)
        later = run["tilt"].values[run["time"].values >= short["end_time"][cell]]
        assert len(later) > 100
        assert np.abs(later - short["final_tilt"][cell]).max() <= 1e-2


def test_launches_followed_one_by_one_end_too_when_they_have_settled():
    sweep = settling(1e-3)
    cells = cells_of(sweep.problem, sweep.grid.values(np.arange(3, 5)))
    launches = cells.launches(np.arange(2), 60.0)
    batch = follow_cells(sweep, np.arange(3, 5))
    ends = follow_each(launches, sweep.tolerance, settled=1e-3)
    assert ((ends.time < launches.end) == (batch["end_time"] < 60.0)).all()
    assert (ends.time < launches.end).any()
    tilts = np.arctan2(np.hypot(ends.state.axis[0], ends.state.axis[1]), ends.state.axis[2])
    assert np.abs(tilts - batch["final_tilt"]).max() <= 1e-3


def test_a_launch_that_swings_has_not_settled():
    """Without friction nothing settles, and a top that stands where it is unstable does not count
    as held.
    """
    axes = Axis.of("launch.tilt", [0.0, 0.3]), Axis.of("friction.mu", [0.0, 0.01])
    found = follow_cells(Sweep(report_problem(), Product(axes), 1.0, 1e-9, 1e-2), np.arange(4))
    assert np.all(found["end_time"] == 1.0)


def test_only_eccentric_spheres_are_known_to_settle():
    egg = report_problem().replace({"body": EGG.model_dump()})
    grid = Product((Axis.of("launch.spin", [1.0]),))
    assert Sweep(egg, grid).settled is None
    with pytest.raises(InvalidInput, match="sphere"):
        Sweep(egg, grid, settled=1e-3)


def test_bad_cells_are_labelled_and_harm_no_other():
    axes = Axis.of("body.I3", [3.2e-6, 1.0, -1.0]), Axis.of("launch.tilt", [1.0, 4.0])
    problem = report_problem(spin=200.0)
    sweep = Sweep(problem, Product(axes), 0.2, 1e-9)
    dataset = compute(sweep)
    assert (dataset["outcome"] == Outcome.INVALID).values.tolist() == [
        [False, True],
        [True, True],
        [True, True],
    ]
    assert dataset["fault"].values.tolist() == [
        [Fault.NONE, Fault.VALUE_OUT_OF_RANGE],
        [Fault.NO_SUCH_BODY, Fault.VALUE_OUT_OF_RANGE],
        [Fault.VALUE_OUT_OF_RANGE, Fault.VALUE_OUT_OF_RANGE],
    ]
    one = Sweep(
        problem.replace({"body.I3": 3.2e-6}), Product((Axis.of("launch.tilt", [1.0]),)), 0.2, 1e-9
    )
    good, alone = follow_cells(sweep, np.array([0])), follow_cells(one, np.array([0]))
    assert same(good, alone)
    bad = follow_cells(sweep, np.array([1, 2]))
    assert bad["fault"].tolist() == [Fault.VALUE_OUT_OF_RANGE, Fault.NO_SUCH_BODY]
    assert bad["outcome"].tolist() == [Outcome.INVALID] * 2
    for name in METRICS:
        assert np.array_equal(bad[name], [METRICS[name].missing] * 2, equal_nan=True), name


def test_a_motion_that_becomes_singular_is_labelled():
    """With a table that may pull, much friction leads to Painleve's paradox: no bound on the
    force.
    """
    problem = report_problem(spin=200.0, tilt=1.0).replace(
        {"contact.liftoff": "ignore", "launch.slip": (-0.3, 0.0)}
    )
    sweep = Sweep(problem, Product((Axis.of("friction.mu", [0.3, 40.0]),)), 1.0, 1e-9)
    found = follow_cells(sweep, np.arange(2))
    runs = [truth(problem_of(sweep, k), 1.0, 11) for k in range(2)]
    assert [outcome == Outcome.FAILED for outcome in found["outcome"]] == [
        run.attrs["status"] == "failed" for run in runs
    ]


def test_a_launch_that_takes_too_long_is_given_up(monkeypatch):
    monkeypatch.setattr(lane_executor, "STEP_LIMIT", 50)
    found = follow_cells(lively("ignore", 2, 2), np.arange(4))
    assert np.all(found["outcome"] == Outcome.FAILED)
    monkeypatch.undo()
    monkeypatch.setattr(transitions, "FLIGHT_LIMIT", 2)
    found = follow_cells(lively("fly", 2, 2), np.arange(4))
    assert np.array_equal(found["outcome"] == Outcome.FAILED, found["flights"] == 2)
    assert (found["outcome"] == Outcome.FAILED).any()


def test_a_smaller_tolerance_is_a_smaller_error():
    exact = follow_cells(lively("ignore", tolerance=1e-12), np.arange(15))
    errors = []
    for tolerance in (1e-6, 1e-9):
        found = follow_cells(lively("ignore", tolerance=tolerance), np.arange(15))
        errors.append(np.abs(found["final_tilt"] - exact["final_tilt"]).max())
    assert errors[0] > 10 * errors[1] > 0
    assert errors[1] < 1e-7


def test_upright_launches_stay_where_they_are():
    axes = Axis.of("launch.tilt", [0.0, math.pi]), Axis.of("launch.spin", [0.0, 100.0])
    found = follow_cells(Sweep(report_problem(), Product(axes), 1.0), np.arange(4))
    assert found["final_tilt"] == pytest.approx([0, 0, math.pi, math.pi], abs=1e-12)
    # The upright spin is not stable at 100 rad/s, and the inverted one at none.
    assert found["is_settled"].tolist() == [True, False, False, True]
    assert found["arrival_time"] == pytest.approx([0.0, math.nan, math.nan, 0.0], nan_ok=True)
    assert np.all(np.isnan(found["final_precession"]))
    assert found["energy_lost"] == pytest.approx(0, abs=1e-15)
    assert found["min_normal_force"] == pytest.approx(0.02 * 9.8)


def test_every_variable_is_described():
    dataset = compute(lively(duration=0.1))
    for name, kind in SWEPT.items():
        variable = dataset[name]
        assert variable.attrs["long_name"]
        is_flag = "flag_meanings" in variable.attrs or variable.dtype == bool
        assert "units" in variable.attrs or is_flag
        assert variable.dtype == kind.dtype
        if "flag_meanings" in variable.attrs:
            assert len(variable.attrs["flag_meanings"].split()) == len(
                variable.attrs["flag_values"]
            )


@pytest.mark.parametrize("spin", [1e6, 1e7, 1e8])
def test_a_top_however_fast_presses_on_the_table_as_in_a_single_run(spin):
    """What its axis is off changes the force by as much times the square of the spin."""
    problem, duration = report_problem(), 1e3 / spin
    swept = compute(Sweep(problem, Product.of({"launch.spin": [spin]}), duration))
    run = simulate(problem.replace({"launch.spin": spin}), duration, samples=2)
    assert int(run["flights"]) == 0
    assert int(swept["flights"][0]) == 0
    assert float(swept["final_tilt"][0]) == pytest.approx(float(run["tilt"][-1]), abs=1e-9)
