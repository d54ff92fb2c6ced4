"""Derivatives of the last state of a run alone: a ball that bounces, in closed form."""

import numpy as np
import pytest

import tippetop as tt
from tippetop.fit.end_slopes import end_slopes, known_end_slopes
from tippetop.fit.linearized_run import LinearizedRun
from tippetop.fit.problem_numbers import Direction

HEIGHT, GRAVITY, END = 0.02, 9.8, 0.12
FIELDS = ("launch.gap", "contact.restitution", "body.mass")


def slopes_of(restitution, end):
    """Return the derivatives of height and vertical velocity at the end, by field."""
    problem = tt.Problem(
        body=tt.Body(mass=0.02, shape=tt.Sphere(radius=0.01, center=0.0), I1=8e-7, I3=8e-7),
        friction=tt.ViscousFriction(mu=0.1),
        launch=tt.Launch(tilt=0.3, spin=0.0, gap=HEIGHT),
        contact=tt.Contact(liftoff="fly", restitution=restitution),
        gravity=GRAVITY,
    )
    directions = [Direction.of(problem, name) for name in FIELDS]
    run = LinearizedRun(problem, end, np.array([0.0, end]), directions)

    def read(state, _, units):
        return np.array([units.length * state.height, units.speed * state.velocity[2]])

    return {name: end_slopes(run, place, read) for place, name in enumerate(FIELDS)}


def test_a_ball_that_bounced_once():
    restitution = 0.6
    slopes, first = slopes_of(restitution, END), (2.0 * HEIGHT / GRAVITY) ** 0.5
    # z = e g t1 (T - t1) - g (T - t1)^2 / 2 after the first impact at t1.
    after, later = END - first, first / (2.0 * HEIGHT)
    by_time = restitution * (END - 2.0 * first) + after, restitution + 1.0
    for field, expected in {
        "launch.gap": [GRAVITY * later * one for one in by_time],
        "contact.restitution": [GRAVITY * first * after, GRAVITY * first],
        "body.mass": [0.0, 0.0],
    }.items():
        assert slopes[field] == pytest.approx(expected, rel=1e-8, abs=1e-7), field


def test_a_field_at_its_bound_has_none_after_the_impact():
    assert slopes_of(1.0, END)["contact.restitution"] is None
    before = slopes_of(1.0, 0.05)
    assert before["contact.restitution"] == pytest.approx([0.0, 0.0], abs=1e-9)
    assert before["launch.gap"] == pytest.approx([1.0, 0.0], abs=1e-9)


def test_derivatives_of_which_rounding_leaves_few_digits_are_missing():
    """An egg jumps without friction and without spin. By its spin the axis leaves the plane, and
    the tilt does not change: rounding of that is ten times as much after every jump.
    """
    problem = tt.Problem(
        body=tt.Body(mass=0.05, shape=tt.Spheroid(across=0.02, along=0.03), I1=1.3e-5, I3=8e-6),
        friction=tt.ViscousFriction(mu=0.0),
        launch=tt.Launch(tilt=0.7, spin=0.0, gap=0.01),
        contact=tt.Contact(liftoff="fly", restitution=1.0),
    )

    def known(end):
        directions = [Direction.of(problem, "launch.spin")]
        return known_end_slopes(
            problem, end, directions, lambda state, *_: np.array(state.axis), np.ones(3)
        )

    # One jump is followed to rounding: x and z do not change.
    assert known(0.1)[0, [0, 2]] == pytest.approx([0.0, 0.0], abs=1e-9)
    late = known(1.0)[0]
    assert np.isnan(late).tolist() == [True, False, True]
    step = 1e-4  # The axis leaves the plane the other way by the opposite spin.
    spun = tt.simulate(problem.replace({"launch.spin": step}), 1.0, samples=2)
    assert late[1] == pytest.approx(spun["axis"].values[-1, 1] / step, rel=1e-4)
