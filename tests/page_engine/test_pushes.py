"""A run that is pushed on the way goes on as the launch of its state, pushed, does in Python."""

import math
from typing import Any

import numpy as np
import pytest

import tippetop as tt
from launches import TOLERANCE, in_javascript
from tippetop.results.catalogue import METRICS

VISCOUS = tt.presets.report_problem(spin=155.0)
PATCH = VISCOUS.replace(
    {"friction.kind": "contensou", "friction.mu": 0.3, "friction.patch_radius": 5e-4}
)
DRY = VISCOUS.replace({"friction.kind": "coulomb", "friction.mu": 0.3})
LEFT = 0.5 * math.pi
REST = {"impulse": 0.0, "direction": 0.0}
"""Numbers of a push that does not strike the body."""


def question(
    problem: tt.Problem, pushes: list[dict[str, Any]], times: Any, end: float
) -> dict[str, Any]:
    """Return what the page's engine is asked of a launch with pushes."""
    return {
        "problem": problem.model_dump(mode="json"),
        "duration": end,
        "pushes": pushes,
        "tolerance": TOLERANCE,
        "times": np.asarray(times).tolist(),
    }


def followed(problem: tt.Problem, pushes: list[dict[str, Any]], times: Any, end: float) -> Any:
    """Return what the page's engine finds of a launch with pushes."""
    (found,) = in_javascript([question(problem, pushes, times, end)])
    return found


def begun_at(problem: tt.Problem, time: float) -> tt.Problem:
    """Return the problem that is launched in the state at a time of a run."""
    _, solution = tt.simulate(problem, time, dense=True)
    return solution.problem_at(time)


def struck(problem: tt.Problem, impulse: float, direction: float) -> tt.Problem:
    """Return a problem with an impulse at one radius from the centre of mass, by the inertia
    tensor.
    """
    body, launch = problem.body, problem.launch
    _, _, axis = map(np.array, launch.frame)
    inertia = body.I1 * np.eye(3) + (body.I3 - body.I1) * np.outer(axis, axis)
    azimuth = launch.azimuth + direction
    along = impulse * np.array([math.cos(azimuth), math.sin(azimuth), 0.0])
    turned = np.linalg.solve(inertia, np.cross(body.shape.radius * axis, along))
    state = problem.start()
    return problem.replace(
        {
            "launch": tt.Launch.from_angular_velocity(
                np.array(launch.angular_velocity()) + turned,
                tilt=launch.tilt,
                azimuth=launch.azimuth,
                velocity=tuple(np.array(state.velocity, float) + along / body.mass),
                gap=launch.gap,
            )
        }
    )


@pytest.mark.parametrize(
    ("problem", "impulse", "direction", "mu"),
    [
        (VISCOUS, 0.0, 0.0, 0.05),
        pytest.param(VISCOUS, 4e-4, LEFT, None, marks=pytest.mark.slow),
        pytest.param(VISCOUS, 1e-3, 0.0, None, marks=pytest.mark.slow),
        (PATCH, 5e-4, 2.0, 0.1),
        (DRY, 5e-4, -LEFT, None),
    ],
)
def test_a_pushed_run_goes_on_as_its_state_launched(
    problem: tt.Problem, impulse: float, direction: float, mu: float | None
) -> None:
    at, end = 1.5, 3.0
    later = np.linspace(0.01, end - at, 40)
    push = {"time": at, "impulse": impulse, "direction": direction, "mu": mu}
    found = followed(problem, [push], at + later, end)
    begun = begun_at(problem, at)
    if impulse:
        begun = struck(begun, impulse, direction)
    if mu is not None:
        begun = begun.replace({"friction.mu": mu})
    run, solution = tt.simulate(begun, end - at, dense=True)
    assert run.attrs["status"] == found["status"]["name"] == "completed"
    expected = solution.sample(later)
    for name, most in {"tilt": 1e-7, "spin": 1e-5, "energy": 1e-8, "height": 1e-8}.items():
        np.testing.assert_allclose(found["track"][name], expected[name], rtol=0, atol=most)
    kinds = [event["kind"] for event in found["events"] if event["time"] > at]
    assert kinds == [str(kind) for kind in run["event_kind"].values[run["event_time"].values > 0.0]]
    assert found["metrics"]["final_tilt"] == pytest.approx(float(run["final_tilt"]), abs=1e-7)


@pytest.mark.parametrize(
    "problem",
    [
        pytest.param(VISCOUS, marks=pytest.mark.slow),
        DRY,
        VISCOUS.replace({"table.slope": 0.2}),
    ],
)
def test_a_lifted_table_goes_on_as_its_state_launched_on_the_slope(problem: tt.Problem) -> None:
    at, end, slope = 1.5, 3.0, 0.1
    later = np.linspace(0.01, end - at, 40)
    push = {"time": at, **REST, "slope": slope}
    found = followed(problem, [push], at + later, end)
    begun = begun_at(problem, at).replace({"table.slope": slope})
    run, solution = tt.simulate(begun, end - at, dense=True)
    assert run.attrs["status"] == found["status"]["name"] == "completed"
    expected = solution.sample(later)
    most = {"tilt": 1e-7, "spin": 1e-5, "height": 1e-8, "normal_force": 1e-6}
    for name, apart in most.items():
        np.testing.assert_allclose(found["track"][name], expected[name], rtol=0, atol=apart)
    assert found["metrics"]["final_tilt"] == pytest.approx(float(run["final_tilt"]), abs=1e-7)
    kinds = [event["kind"] for event in found["events"] if event["time"] > at]
    assert kinds == [str(kind) for kind in run["event_kind"].values[run["event_time"].values > 0.0]]
    assert "meets_slope" in [clause["name"] for clause in found["account"]]


def test_what_happened_before_the_table_is_lifted_stays_as_it_was() -> None:
    times = np.linspace(0.0, 8.0, 41)
    grippy = VISCOUS.replace({"friction.mu": 0.9})
    without = followed(grippy, [], times, 8.0)
    push = {"time": 7.0, **REST, "slope": 0.25}
    found = followed(grippy, [push], times, 8.0)
    before = times < 7.0
    for name in ("tilt", "x", "energy", "work", "normal_force"):
        np.testing.assert_allclose(
            np.array(found["track"][name])[before], np.array(without["track"][name])[before]
        )
    for name in ("turnover_time", "min_normal_force"):
        assert found["metrics"][name] == pytest.approx(without["metrics"][name], rel=1e-6), name
    # Gravity acts at the centre of mass, whatever its direction.
    assert found["metrics"]["jellett_change"] < 1e-7


def test_a_table_that_is_lifted_turns_about_the_place_of_launch() -> None:
    at, slope = 1.0, 0.2
    push = {"time": at, **REST, "slope": slope}
    found = followed(VISCOUS, [push], [0.0, at, at + 1e-9, 2.0], 2.0)
    track, weight = found["track"], VISCOUS.body.mass * VISCOUS.gravity
    start, before, after, end = track["energy"]
    x, height = track["x"][1], track["height"][1]
    lifted = weight * (height * math.cos(slope) - x * math.sin(slope) - height)
    assert after - before == pytest.approx(lifted, abs=1e-9)
    lost = found["metrics"]["energy_lost"]
    assert lost == pytest.approx(start + lifted - end, abs=1e-9)
    assert track["work"][-1] == pytest.approx(-lost, abs=1e-9)


def test_a_push_of_nothing_changes_nothing() -> None:
    times = np.linspace(0.0, 8.0, 81)
    without = followed(VISCOUS, [], times, 8.0)
    pushes = [{"time": time, **REST, "mu": None} for time in (0.7, 5.0)]
    pushed = followed(VISCOUS, pushes, times, 8.0)
    for name in METRICS:
        if name != "steps":
            expected, value = without["metrics"][name], pushed["metrics"][name]
            if expected is None:  # what is no number
                assert value is None
            else:
                assert value == pytest.approx(expected, rel=1e-7, abs=1e-9), name
    for name in ("tilt", "x", "orientation", "work"):
        np.testing.assert_allclose(pushed["track"][name], without["track"][name], atol=1e-6)


def test_times_of_a_run_are_counted_from_its_launch() -> None:
    push = {"time": 2.0, **REST, "mu": 0.6}
    found = followed(VISCOUS, [push], [0.0], 10.0)
    run = tt.simulate(begun_at(VISCOUS, 2.0).replace({"friction.mu": 0.6}), 8.0)
    turns = float(run["turnover_time"])
    assert found["metrics"]["turnover_time"] == pytest.approx(2.0 + turns, abs=1e-7)
    assert [clause["part"] for clause in found["account"]].count("theory") == 0
    names = [clause["name"] for clause in found["account"]]
    assert names.index("meets_friction") < names.index("turns_over")


def test_energy_lost_counts_what_a_push_gives() -> None:
    at = 1.0
    push = {"time": at, "impulse": 1e-3, "direction": 0.3, "mu": None}
    found = followed(VISCOUS, [push], [0.0, at, at + 1e-9, 2.0], 2.0)
    start, before, after, end = found["track"]["energy"]
    struck_lost = sum(event["energy_lost"] for event in found["events"])
    given = after - before + struck_lost
    lost = found["metrics"]["energy_lost"]
    assert lost == pytest.approx(start + given - end, abs=1e-9)
    sliding = found["metrics"]["energy_lost_sliding"]
    assert sliding == pytest.approx(lost - struck_lost, abs=1e-9)
    assert found["track"]["work"][-1] == pytest.approx(-lost, abs=1e-9)


def test_a_top_that_rolls_slips_once_it_is_pushed() -> None:
    push = {"time": 1.0, "impulse": 2e-3, "direction": 0.0, "mu": None}
    found = followed(DRY, [push], [0.5, 1.0 + 1e-6], 1.2)
    assert found["track"]["slip_x"][0] == pytest.approx(0.0, abs=1e-9)
    slip = math.hypot(*(found["track"][name][1] for name in ("slip_x", "slip_y")))
    assert slip > 1e-2 or found["track"]["normal_force"][1] == 0.0


REFUSED = [
    ([{"time": 0.0, **REST}], "push.time"),
    ([{"time": 1.0, **REST}, {"time": 0.5, **REST}], "push.time"),
    ([{"time": 1.0, "impulse": -1.0, "direction": 0.0}], "push.impulse"),
    ([{"time": 1.0, "impulse": 0.0, "direction": None}], "push.direction"),
    ([{"time": 1.0, **REST, "mu": -1.0}], "friction.mu"),
    ([{"time": 1.0, **REST, "slope": 1.6}], "table.slope"),
]


def test_pushes_that_are_none_are_refused() -> None:
    answers = in_javascript([question(VISCOUS, pushes, [0.0], 2.0) for pushes, _ in REFUSED])
    for (_, field), found in zip(REFUSED, answers, strict=True):
        assert field.rpartition(".")[2] in found["refused"]
