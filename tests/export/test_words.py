"""The sentences about a run state the events and the end that its numbers have."""

import numpy as np
import pytest

import tippetop as tt
from tippetop.export.words import end_in_words, known_end, known_spins, steady_in_words, tell
from tippetop.theory.prediction import predict
from tippetop.theory.thresholds import critical_spins


def told(spin: float, duration: float = 20.0, **changes: object) -> str:
    problem = tt.presets.report_problem(spin=spin).replace(changes)
    return tell(tt.simulate(problem, duration)).headline


def test_a_slow_top_stays_upright_and_is_told_why() -> None:
    spins = critical_spins(tt.presets.report_problem())
    assert told(0.8 * spins.upright) == f"stays upright: spin below {spins.upright:.1f} rad/s"
    assert "still moving" in told(1.1 * spins.upright)


def test_a_fast_top_inverts_when_its_tilt_arrives() -> None:
    problem = tt.presets.report_problem(spin=155.0)
    coarse, fine = (tt.simulate(problem, 20.0, samples=count) for count in (2001, 20001))
    assert tell(fine).headline == f"inverts at {float(fine['arrives']):.2f} s"
    assert float(coarse["arrives"]) == pytest.approx(float(fine["arrives"]), rel=1e-9)


def test_in_between_it_settles_where_theory_says() -> None:
    problem = tt.presets.report_problem(spin=50.0)
    story = tell(tt.simulate(problem, 20.0))
    final = predict(problem).final
    assert story.headline.startswith(f"settles at {final.tilt * 180 / 3.141592653589793:.1f}°")
    assert f"θ = {final.tilt:.3f} rad" in story.details[0]


def test_flights_are_counted_from_the_first() -> None:
    run = tt.simulate(tt.presets.report_problem(spin=175.0), 20.0)
    first = float(run["flight_start"][0])
    assert tell(run).headline.endswith(
        f"leaves the table {run.sizes['flight']} times from {first:.2f} s"
    )
    bilateral = tell(
        tt.simulate(
            tt.presets.report_problem(spin=175.0).replace({"contact.liftoff": "stop"}), 20.0
        )
    )
    assert "would have to pull" in bilateral.headline
    assert bilateral.details[0].startswith(tt.Outcome.LIFTED_OFF.value[:30])


def test_where_no_theory_holds_the_motion_alone_is_told() -> None:
    egg = tt.Body(mass=0.02, shape=tt.Spheroid(across=0.015, along=0.025), I1=4e-6, I3=2e-6)
    problem = tt.presets.report_problem(spin=10.0).model_copy(update={"body": egg})
    assert known_spins(problem) is None
    run = tt.simulate(problem, 1.0)
    assert tell(run).details == ()
    assert tell(run.isel(time=[0])).headline.endswith("and still moving"), "it ended where it began"


def test_a_top_set_on_its_stem_stays_there() -> None:
    assert told(155.0, **{"launch.tilt": 3.1}) == "stays inverted"


def test_only_what_was_near_a_pole_all_along_stays_there() -> None:
    problem = tt.presets.report_problem(spin=10.0, tilt=1.2)
    run = tt.simulate(problem, 20.0)
    headline = tell(run).headline
    assert headline.startswith("comes upright at ")
    since = float(headline.split()[3])
    assert np.all(run["theta"].values[run["time"].values > since + 0.01] < 0.05)
    assert told(100.0, **{"launch.tilt": 2.5}).startswith("inverts at ")
    assert told(20.0, **{"launch.tilt": 2.0}).startswith("falls back upright at ")


def test_near_a_pole_it_cannot_stay_at_is_not_there() -> None:
    problem = tt.presets.report_problem(spin=100.0, tilt=0.5, mu=0.02)
    assert known_end(problem).final.tilt == np.pi  # type: ignore[union-attr]
    run = tt.simulate(problem, 12.0)
    assert run["theta"][-1] < 0.05
    assert tell(run).headline.endswith("still moving")


def test_without_friction_there_is_nothing_to_head_for() -> None:
    problem = tt.presets.report_problem(spin=155.0, mu=0.0)
    assert known_end(problem) is None
    run = tt.simulate(problem, 20.0)
    story = tell(run)
    assert np.ptp(run["theta"].values) < 0.02
    assert story.headline == f"stays at {np.degrees(float(run['theta'][-1])):.1f}°"
    assert story.details == ("There is no friction: nothing makes it settle.",)


def test_a_swing_through_a_steady_state_is_not_settled_there() -> None:
    problem = tt.presets.report_problem(spin=70.0, tilt=2.0, mu=0.01)
    final = predict(problem).final.tilt
    run = tt.simulate(problem, 4.6)
    assert run["theta"][-1] == pytest.approx(final, abs=0.02), "as if it were there"
    assert np.ptp(run["theta"].values[run["time"].values > 4.2]) > 0.05, "but it swings"
    assert tell(run).headline.endswith("still moving")
    # Nor is what ends before it could have swung, or is stopped.
    settled = tt.simulate(tt.presets.report_problem(spin=50.0), 20.0)
    assert tell(settled.isel(time=slice(-5, None))).headline.endswith("still moving")
    assert tell(settled).headline.startswith("settles at 86.1°")
    assert "still moving" in tell(settled.assign_attrs(outcome="too_many_phases")).headline


def test_what_settles_has_stayed_since() -> None:
    run = tt.simulate(tt.presets.report_problem(spin=20.0, tilt=3.1), 20.0)
    final = predict(tt.Problem.from_json(run.attrs["problem"])).final.tilt
    headline = tell(run).headline
    since = float(headline.split()[4])
    assert np.all(np.abs(run["theta"].values[run["time"].values > since] - final) < 0.021)
    assert since > 2 * float(run["arrives"]), "it swings through its last tilt long before"


def test_a_dropped_top_is_told_to_bounce() -> None:
    drop = (2 * 0.1 / tt.presets.report_problem().gravity) ** 0.5
    dropped = {"launch.gap": 0.1, "contact.restitution": 1.0}
    run = tt.simulate(tt.presets.report_problem(spin=50.0).replace(dropped), 3.0)
    headline = tell(run).headline
    assert f"comes down on the table at {drop:.2f} s" in headline
    assert f"leaves the table {run.sizes['flight'] - 1} times from {drop:.2f} s" in headline
    assert told(50.0, 0.9 * drop, **dropped).endswith("never touches the table")
    once = told(50.0, 1.1 * drop, **dropped)
    assert f"leaves the table once, at {drop:.2f} s" in once


def test_numbers_have_a_true_minus_sign_and_zero_none() -> None:
    assert "ω₃ = −82.87 rad/s" in steady_in_words(
        predict(tt.presets.report_problem(spin=155.0)).final
    )
    still = predict(tt.presets.report_problem(spin=0.0, tilt=1.0)).final
    assert steady_in_words(still) == "upright spin with ω₃ = 0.00 rad/s"


def test_where_the_launch_decides_all_ends_are_told() -> None:
    sphere = tt.EccentricSphere(
        radius=0.02, eccentricity=0.3
    )  # slender: both upright and tilted are stable
    body = tt.Body(mass=0.02, shape=sphere, I1=0.6 * 3.2e-6, I3=3.2e-6)
    launch = tt.presets.report_problem(spin=150.0, tilt=1.0).model_copy(update={"body": body})
    prediction = predict(launch)
    said = end_in_words(prediction)
    assert len(prediction.reachable) == 2
    for state in prediction.reachable:
        assert steady_in_words(state) in said
    assert said.endswith("each is stable, and the launch's details decide")
    assert end_in_words(predict(tt.presets.report_problem())).endswith("rad/s")
