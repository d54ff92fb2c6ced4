"""Events of the user's own, runs that end at events, and the dense solution of a run."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import xarray as xr

import tippetop as tt
from tippetop.extend import EventFunction, MotionState

PROBLEM = tt.presets.report_problem(spin=155.0, tilt=0.6)
RISE, GRAVITY = 1.0, PROBLEM.gravity
THROWN = PROBLEM.replace({"launch.gap": 0.01, "launch.velocity": (0.2, 0.0, RISE)})
SUMMIT = RISE / GRAVITY
ROUNDING = 1e-14
"""Rounding of times below a second, and of what they are computed from."""


def times_of(run: xr.Dataset, kind: str) -> Any:
    return run["event_time"].values[run["event_kind"].values == kind]


def thrown_height(time: float) -> float:
    start = float(tt.simulate(THROWN, 0.01, samples=2)["height"][0])
    return start + RISE * time - 0.5 * GRAVITY * time**2


def test_events_of_a_throw_are_where_the_parabola_has_them() -> None:
    """The centre of mass flies on a parabola, whatever the body does about it."""
    level = thrown_height(SUMMIT - 0.03)
    events: dict[str, Callable[[MotionState], Any]] = {
        "summit": lambda s: s.velocity[2],
        "level": lambda s: s.height - level,
        "rises": EventFunction(lambda s: s.height - level, direction=1),
        "falls": EventFunction(lambda s: s.height - level, direction=-1),
        "time": lambda s: s.time - 0.0371,
    }
    run = tt.simulate(THROWN, 0.19, events=events)
    both = [SUMMIT - 0.03, SUMMIT + 0.03]
    expected = {"summit": [SUMMIT], "level": both, "rises": both[:1], "falls": both[1:]}
    for kind, times in {**expected, "time": [0.0371]}.items():
        np.testing.assert_allclose(times_of(run, kind), times, rtol=0, atol=ROUNDING, err_msg=kind)
    assert run["event_time"].values.tolist() == sorted(run["event_time"].values)


def test_an_event_on_the_table_is_where_the_function_is_zero() -> None:
    events = {"level": lambda s: s.axis[2], "east": lambda s: s.axis[1]}
    run, solution = tt.simulate(PROBLEM, 8.0, events=events, dense=True)
    np.testing.assert_array_equal(times_of(run, "level")[0], run["turnover_time"])
    east = times_of(run, "east")
    # The axis turns at up to 100 rad/s, and a time of 8 s is rounded to 2e-15 s.
    assert np.abs(solution(east).axis[1]).max() < 1e-12
    fine = solution(np.linspace(1e-6, 8.0, 100_001)).axis[1]
    assert len(east) == np.count_nonzero(fine[1:] * fine[:-1] < 0.0) > 100


@pytest.mark.parametrize("spin", [100.0, 155.0])
def test_a_run_that_ends_as_the_top_turns_over_has_turned_over(spin: float) -> None:
    """The end is rounded to either side of the horizontal: of these spins to one side each."""
    problem = tt.presets.report_problem(spin=spin)
    run = tt.simulate(problem, 8.0, until=lambda s: s.axis[2])
    assert float(run["turnover_time"]) == pytest.approx(float(run["end_time"]), rel=1e-15)
    earlier = tt.simulate(problem, float(run["end_time"]) * (1.0 - 1e-14), samples=2)
    assert np.isnan(earlier["turnover_time"])
    beyond = tt.simulate(problem.replace({"launch.tilt": 2.0}), 0.05, samples=2)
    assert np.isnan(beyond["turnover_time"])


@pytest.mark.parametrize("gap", [1e-5, 1e-7])
def test_two_crossings_close_together_are_both_found(gap: float) -> None:
    """Much closer than the function is evaluated; one that does not come down to zero has none."""
    dips, stays = (lambda s, c=c: (s.time - 0.3) ** 2 - c for c in (gap**2, -(gap**2)))
    run = tt.simulate(PROBLEM, 0.5, events={"dips": dips, "stays": stays})
    expected = [0.3 - gap, 0.3 + gap]
    # Rounding of the function over its slope.
    np.testing.assert_allclose(times_of(run, "dips"), expected, rtol=0, atol=1e-16 / gap)
    assert len(times_of(run, "stays")) == 0


def test_a_function_of_plain_numbers_is_as_good_as_one_of_arrays() -> None:
    events: dict[str, Callable[[MotionState], Any]] = {
        "arrays": lambda s: np.cos(s.tilt) - 0.7,
        "numbers": lambda s: math.cos(s.tilt) - 0.7,
        "branches": lambda s: 1.0 if s.axis[2] > 0.7 else -1.0,
    }
    run = tt.simulate(PROBLEM, 8.0, events=events)
    arrays = times_of(run, "arrays")
    assert len(arrays) > 0
    for kind in ("numbers", "branches"):
        np.testing.assert_allclose(times_of(run, kind), arrays, rtol=1e-12, err_msg=kind)


def test_an_impact_that_turns_a_velocity_round_is_an_event() -> None:
    bouncing = THROWN.replace({"contact.restitution": 0.5})
    run = tt.simulate(bouncing, 0.3, events={"turns": lambda s: s.velocity[2]})
    impacts = times_of(run, "impact")
    assert len(impacts) > 0
    assert set(impacts) <= set(times_of(run, "turns"))


def test_blocks_of_steps_are_not_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    events = {"nods": lambda s: s.tilt_rate}
    whole = tt.simulate(PROBLEM, 1.0, events=events)
    monkeypatch.setattr("tippetop.contact.block.STEPS", 3)
    parts = tt.simulate(PROBLEM, 1.0, events=events)
    np.testing.assert_allclose(parts["event_time"], whole["event_time"], rtol=1e-14)
    assert len(times_of(whole, "nods")) > 3


def test_functions_do_not_change_the_run() -> None:
    usual = tt.simulate(PROBLEM, 2.0)
    asked, _ = tt.simulate(PROBLEM, 2.0, events={"level": lambda s: s.axis[2]}, dense=True)
    xr.testing.assert_identical(
        usual.drop_dims("event"), asked.drop_dims("event").assign_attrs(usual.attrs)
    )


FLIES = tt.presets.report_problem(spin=175.0)
STICKS = PROBLEM.replace({"friction.kind": "coulomb", "launch.slip": (0.3, 0.0)})


@pytest.mark.parametrize(
    ("problem", "until", "kind"),
    [
        (PROBLEM, lambda s: s.axis[2] - 0.75, "until"),
        (PROBLEM, "low", "low"),
        (STICKS, "stick", "stick"),
        (FLIES, "liftoff", "liftoff"),
    ],
)
def test_a_run_ends_at_the_event_asked_for(problem: tt.Problem, until: Any, kind: str) -> None:
    """As one does whose duration is the time of the event."""
    events = {"low": lambda s: s.axis[2] - 0.75}
    run = tt.simulate(problem, 6.0, events=events, until=until)
    assert run.attrs["status"] == "stopped"
    assert repr(kind) in run.attrs["message"]
    assert kind in run["event_kind"].values
    end = float(run["end_time"])
    assert end == float(run["time"][-1]) == float(run["event_time"].max()) < 6.0
    short = tt.simulate(problem, end, samples=3)
    for name in ("final_tilt", "final_spin", "energy_lost", "energy_lost_sliding"):
        np.testing.assert_allclose(run[name], short[name], rtol=1e-9, err_msg=name)
    for name in ("tilt", "x", "spin"):
        np.testing.assert_allclose(run[name][-1], short[name][-1], rtol=1e-9, err_msg=name)
    assert float(run["energy_error"]) < 1e-12


def test_a_run_that_ends_in_the_air_has_the_gap_that_it_reached() -> None:
    upright = THROWN.replace({"launch.tilt": 0.0, "launch.spin": 0.0})
    run = tt.simulate(upright, 1.0, until=lambda s: s.time - 0.05)
    assert float(run["max_gap"]) == pytest.approx(
        0.01 + RISE * 0.05 - 0.5 * GRAVITY * 0.05**2, rel=1e-12
    )
    assert float(run["airborne_time"]) == pytest.approx(0.05, rel=1e-12)


def test_a_run_may_end_where_it_begins() -> None:
    rolls = PROBLEM.replace({"friction.kind": "coulomb"})
    run, solution = tt.simulate(rolls, 1.0, until="stick", dense=True)
    assert float(run["end_time"]) == 0.0
    assert solution(0.0).tilt == solution.sample(0.0)["tilt"][0] == pytest.approx(0.6, rel=1e-15)
    assert run["event_kind"].values.tolist() == ["stick"]
    assert run.attrs["status"] == "stopped"


def test_a_run_without_the_event_is_completed() -> None:
    run = tt.simulate(PROBLEM, 0.1, until="touchdown")
    assert run.attrs["status"] == "completed"


@pytest.mark.parametrize("problem", [PROBLEM, FLIES, STICKS])
def test_the_dense_solution_is_what_samples_are(problem: tt.Problem) -> None:
    """At times of their own, as a run that is sampled there has them."""
    duration = 5.5
    times = np.sort(np.random.default_rng(1).uniform(0.0, duration, 50))
    run, solution = tt.simulate(problem, duration, dense=True)
    expected, found = tt.simulate(problem, duration, times=times), solution.sample(times)
    # The sign of a unit quaternion is free, and settled from the first sample on.
    sign = np.sign(np.sum(expected["orientation"] * found["orientation"], axis=-1))
    found["orientation"] = sign * found["orientation"]
    xr.testing.assert_allclose(found.drop_vars("mode"), expected.drop_vars("mode"), rtol=1e-12)
    states = solution(times)
    for name in ("height", "tilt", "azimuth", "spin", "energy", "normal_force"):
        scale = np.abs(expected[name].values).max()
        np.testing.assert_allclose(
            getattr(states, name), expected[name], rtol=0, atol=1e-12 * scale, err_msg=name
        )
    for name in ("axis", "velocity", "angular_momentum"):
        np.testing.assert_allclose(getattr(states, name).T, expected[name], rtol=1e-12, atol=1e-15)
    one = solution(float(times[7]))
    assert one.axis.shape == (3,)
    assert one.height == pytest.approx(states.height[7], rel=1e-14)
    assert solution(float(run["end_time"])).tilt == pytest.approx(float(run["final_tilt"]))


def test_own_events_are_written_and_read(tmp_path: Any) -> None:
    run = tt.simulate(PROBLEM, 8.0, events={"level": lambda s: s.axis[2]})
    assert "level" in run["event_kind"].values
    assert tt.read_run(tt.write_run(run, tmp_path / "run.nc")).equals(run)
    assert {"kind": "level", "time": float(run["turnover_time"])} in tt.summarize(run)["events"]


def raising(_: MotionState) -> float:
    raise KeyError("spin")


def backwards(s: MotionState) -> float:
    return float(s.tilt)


backwards.direction = 2  # type: ignore[attr-defined]


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        ({"events": {"e": raising}}, r"events\['e'\]: KeyError\('spin'\) is not a function"),
        ({"events": {"e": lambda s: s.tilt * np.nan}}, r"events\['e'\]: nan .* also at 0 s"),
        ({"events": {"e": lambda s: "high"}}, "'high' is not a function"),
        ({"events": {"e": lambda s: s.tilt > 1.0}}, "finite number"),
        ({"until": lambda s: s.axis}, "until: array"),
        ({"events": {"e": 3.0}}, "a function of the state"),
        ({"events": {"e": backwards}}, r"events\['e'\].direction: 2"),
        ({"events": {"stick": backwards}}, "a name other than those of the run's events"),
        ({"events": [backwards]}, "a table of functions"),
        ({"until": "lifts"}, "did you mean liftoff"),
        ({"dense": "yes"}, "dense: 'yes'"),
    ],
)
def test_what_cannot_be_is_told_in_a_sentence(arguments: dict[str, Any], sentence: str) -> None:
    with pytest.raises(tt.InvalidInput, match=sentence):
        tt.simulate(PROBLEM, 0.1, **arguments)


@pytest.mark.parametrize("times", [-0.1, 0.2, [0.05, math.nan], "soon", [[0.0]]])
def test_a_solution_has_no_other_times(times: Any) -> None:
    _, solution = tt.simulate(PROBLEM, 0.1, dense=True)
    with pytest.raises(tt.InvalidInput, match="a time from 0 to the end of the run"):
        solution(times)


@pytest.mark.parametrize("argument", ["events", "until"])
def test_sweeps_refuse_functions(argument: str) -> None:
    with pytest.raises(tt.InvalidInput, match="is not followed in sweeps"):
        tt.sweep(PROBLEM, {"launch.spin": [100.0]}, **{argument: backwards})


def test_a_run_may_end_where_a_block_of_steps_does(monkeypatch: pytest.MonkeyPatch) -> None:
    """An impact at the end of a block makes a velocity jump through zero."""
    monkeypatch.setattr("tippetop.contact.block.STEPS", 1)
    bouncing = THROWN.replace({"contact.restitution": 0.5})
    up = EventFunction(lambda s: s.velocity[2], direction=1)
    run = tt.simulate(bouncing, 0.5, events={"up": up}, until="up")
    assert float(run["end_time"]) == times_of(run, "touchdown")[0]
    assert float(run["velocity"][-1, 2]) < 0.0


DRY_TOP = tt.presets.report_problem(spin=155.0).replace({"friction.kind": "coulomb"})
RESTARTED = {
    "slides": (tt.presets.report_problem(spin=155.0), 2.0),
    "sticks": (DRY_TOP, 0.3),
    "flies": (tt.presets.report_problem(spin=50.0, tilt=0.4).replace({"launch.gap": 0.05}), 0.05),
    "upright": (tt.presets.report_problem(spin=155.0, tilt=0.0), 0.5),
    "a stem": (tt.presets.leine_glocker_problem(), 1.0),
}


@pytest.mark.parametrize("name", RESTARTED)
def test_a_restart_goes_on_as_the_run_does(name: str) -> None:
    problem, time = RESTARTED[name]
    later = np.linspace(0.0, 0.1, 11)
    run, solution = tt.simulate(problem, time + 0.1, times=[0.0, *(time + later)], dense=True)
    again = tt.simulate(solution.problem_at(time), 0.1, times=later)
    for field in ("axis", "angular_momentum", "velocity", "height", "contact_force"):
        expected = run[field].values[1:]
        scale = np.abs(expected).max()
        np.testing.assert_allclose(again[field], expected, rtol=0, atol=1e-9 * scale, err_msg=field)
    assert len(again["flight_start"]) == len(run["flight_start"])


def test_a_restart_needs_one_time_within_the_run() -> None:
    _, solution = tt.simulate(tt.presets.report_problem(), 1.0, dense=True)
    for time in (1.5, [0.1, 0.2], "soon"):
        with pytest.raises(tt.InvalidInput, match="time"):
            solution.problem_at(time)


def test_at_an_impact_the_solution_is_after_it_and_on_request_before_it() -> None:
    problem = tt.presets.report_problem(spin=50.0, tilt=0.3).replace(
        {"launch.gap": 0.01, "contact.restitution": 0.5}
    )
    run, solution = tt.simulate(problem, 1.0, dense=True)
    struck = run["event_kind"].values == "impact"
    times, lost = run["event_time"].values[struck], run["event_energy_lost"].values[struck]
    assert len(times) > 10
    after, before = solution(times), solution(times, side="left")
    assert before.energy - after.energy == pytest.approx(lost, rel=1e-6, abs=1e-14)
    assert np.all(after.velocity[2] > before.velocity[2])
    stopped, ended = tt.simulate(problem, 1.0, until="impact", dense=True)
    end = float(stopped["end_time"])
    assert ended(end).velocity[2] == ended(end, side="left").velocity[2] < 0.0
    with pytest.raises(tt.InvalidInput, match="side"):
        solution(0.1, side="middle")  # type: ignore[call-overload,arg-type]
