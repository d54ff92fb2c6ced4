"""The digits of an account's times are those that a minute change of the launch leaves."""

import math

import numpy as np
import pytest

import tippetop as tt
from tippetop.results.time_digits import digits_left


def test_the_uncertainty_of_a_smooth_time_is_its_derivative_times_the_change():
    problem = tt.presets.report_problem(spin=155.0)
    run = tt.simulate(problem, 7.0, samples=2)
    fields = ["launch.spin", "launch.tilt", "friction.mu"]
    slopes = tt.sensitivities(problem, 7.0, fields, samples=2)["turnover_time"].values
    launch = abs(slopes[0] * 155.0 + slopes[1] * problem.launch.tilt) * 1e-6
    friction = abs(slopes[2] * problem.friction.mu) * 1e-6
    moved = tt.time_uncertainties(run)["turnover_time"]
    assert moved == pytest.approx(max(launch, friction), rel=1e-3)


def test_a_bouncing_ball_whose_jumps_chance_decides_gets_no_digits():
    # A tilted disk that falls on its rim bounces at random: each impact multiplies a change.
    run = tt.simulate(rattling(), 3.0, samples=2)
    moved = tt.time_uncertainties(run)
    chance = [name for name, change in moved.items() if not np.isfinite(change)]
    assert chance, moved
    text = str(tt.describe(run).rounded(moved))
    assert "a time that chance decides" in text
    assert "chance" not in str(tt.describe(run))


def rattling():
    """Return an egg with much spin and restitution, dropped obliquely on dry friction."""
    return tt.Problem(
        body=tt.Body(
            mass=0.02, shape=tt.EccentricSphere(radius=0.02, eccentricity=0.3), I1=2.9e-6, I3=3.1e-6
        ),
        friction=tt.CoulombFriction(mu=0.4),
        contact=tt.Contact(liftoff="fly", restitution=0.9),
        launch=tt.Launch(tilt=1.0, spin=120.0, gap=0.05, velocity=(0.0, -2.4 * math.sin(1.0), 0.0)),
    )


def test_digits_end_where_the_uncertainty_begins():
    assert digits_left(2.7321, 0.08, 3) == 2
    assert digits_left(2.7321, 0.0, 3) == 3
    assert digits_left(2.7321, 1e-9, 3) == 3
    assert digits_left(27.321, 0.9, 4) == 2
    assert digits_left(2.7321, 2.0, 3) == 0
    assert digits_left(2.7321, np.inf, 3) == 0
