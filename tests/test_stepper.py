"""Steps of one's own: the motion of a run, and pushes that change momenta by what they are."""

import numpy as np
import pytest

import tippetop as tt
from tippetop.problem.presets import report_problem

TOPS = {
    "slides": (report_problem(spin=155.0), 0.5),
    "jumps": (report_problem(spin=180.0, tilt=1.0), 0.6),
    "sticks": (
        report_problem(spin=50.0, tilt=0.3).replace({"friction": tt.CoulombFriction(mu=0.3)}),
        0.3,
    ),
    "bounces": (
        report_problem(spin=50.0, tilt=0.3).replace(
            {"launch.gap": 0.01, "contact.restitution": 0.5}
        ),
        0.3,
    ),
    "rocks": (
        tt.Problem(
            body=tt.presets.LEINE_GLOCKER,
            friction=tt.ContensouFriction(mu=0.3, patch_radius=5e-4),
            launch=tt.Launch(tilt=0.1, spin=180.0),
        ),
        0.2,
    ),
}


@pytest.mark.parametrize("name", TOPS)
def test_steps_are_the_motion_of_a_run(name):
    problem, duration = TOPS[name]
    stepper, count = tt.Stepper(problem), 40
    run = tt.simulate(problem, duration, samples=count + 1)
    events = []
    for place in range(1, count + 1):
        now = stepper.step(duration / count)
        events += now.events
        at = run.isel(time=place)
        assert now.time == pytest.approx(float(at["time"]), rel=1e-12)
        assert now.state.axis == pytest.approx(at["axis"].values, abs=1e-8)
        expected = [float(at[field]) for field in ("x", "y", "height")]
        assert now.position == pytest.approx(expected, abs=1e-9)
        turned = at["orientation"].values
        assert abs(now.orientation @ turned) == pytest.approx(1.0, abs=1e-14)
        assert np.abs(now.orientation * np.sign(now.orientation @ turned) - turned).max() < 1e-7
        assert now.mode == str(at["mode"].values)
    happened = list(zip(run["event_time"].values, run["event_kind"].values, strict=True))
    assert [kind for _, kind in events] == [str(kind) for _, kind in happened]
    assert [time for time, _ in events] == pytest.approx([time for time, _ in happened], abs=1e-8)


def test_a_push_in_flight_changes_the_momenta_by_what_it_is():
    problem = report_problem(spin=100.0, tilt=0.5).replace({"launch.gap": 0.5})
    stepper = tt.Stepper(problem)
    before, nudge, twist = stepper.step(0.01), np.array([1e-3, -2e-3, 5e-4]), [1e-6, 2e-6, -1e-6]
    after = stepper.step(0.01, nudge=nudge, twist=twist)
    fallen = np.array([0.0, 0.0, -problem.gravity * 0.01])
    change = after.state.velocity - before.state.velocity - fallen
    assert change == pytest.approx(nudge / problem.body.mass, rel=1e-10)
    change = after.state.angular_momentum - before.state.angular_momentum
    assert change == pytest.approx(twist, rel=1e-9)
    assert after.position[0] - before.position[0] == pytest.approx(after.state.velocity[0] * 0.01)


def test_a_push_down_strikes_the_table_and_one_up_lifts_the_top():
    stepper = tt.Stepper(report_problem(spin=100.0, tilt=0.3))
    stepper.step(0.01)
    assert "impact" in [kind for _, kind in stepper.step(1e-4, nudge=(0.0, 0.0, -1e-3)).events]
    assert stepper.step(1e-3, nudge=(0.0, 0.0, 1e-2)).mode == "flight"


def test_a_top_at_rest_stays_and_time_passes_until_it_is_pushed():
    problem = report_problem(spin=0.0, tilt=0.0).replace({"friction": tt.CoulombFriction(mu=0.3)})
    stepper = tt.Stepper(problem)
    first, second = stepper.step(0.1), stepper.step(0.1)
    assert second.time == pytest.approx(0.2)
    assert second.position == pytest.approx(first.position)
    pushed = stepper.step(0.1, nudge=(1e-3, 0.0, 0.0))
    assert pushed.position[0] > 1e-4


def test_a_reset_begins_anew_with_the_same_or_another_launch():
    problem = report_problem(spin=120.0)
    stepper = tt.Stepper(problem)
    start, first = stepper.reset(), stepper.step(0.05)
    assert start.time == 0.0
    assert start.orientation == pytest.approx([np.cos(0.05), 0.0, np.sin(0.05), 0.0])
    stepper.step(0.05)
    stepper.reset()
    again = stepper.step(0.05)
    assert again.position.tolist() == first.position.tolist()
    assert again.state.axis.tolist() == first.state.axis.tolist()
    other = problem.replace({"launch.spin": 60.0})
    assert stepper.reset(other).state.spin == pytest.approx(60.0)
    assert stepper.problem == other


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        ({"dt": 0.0}, "dt: 0 is not a number of seconds greater than 0"),
        ({"dt": float("nan")}, "dt"),
        ({"dt": 0.1, "nudge": (1.0, 2.0)}, "nudge: .* is not three finite numbers"),
        ({"dt": 0.1, "twist": "up"}, "twist: 'up' is not three finite numbers"),
    ],
)
def test_what_is_no_step_is_refused(arguments, sentence):
    with pytest.raises(tt.InvalidInput, match=sentence):
        tt.Stepper(report_problem()).step(**arguments)


def test_events_of_a_push_have_the_time_of_the_push():
    stepper = tt.Stepper(tt.presets.report_problem())
    stepper.step(0.1)
    pushed = stepper.step(0.01, nudge=(0.0, 0.0, -0.01))
    assert pushed.events
    assert min(time for time, _ in pushed.events) == pytest.approx(0.1)
