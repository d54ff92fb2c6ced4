"""Static friction above sliding friction: slopes, rods that fall, and what fits make of it."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import tippetop as tt

G, RADIUS, MASS = 9.81, 0.02, 0.05
SLIDING, HOLDING = 0.1, 0.3


def stiction(mu=SLIDING, static_mu=HOLDING):
    return tt.StaticCoulombFriction(mu=mu, static_mu=static_mu)


def ball_on_slope(slope, slip=(0.0, 0.0), **coefficients):
    inertia = 0.4 * MASS * RADIUS**2
    body = tt.Body(mass=MASS, shape=tt.Sphere(radius=RADIUS, center=0.0), I1=inertia, I3=inertia)
    return tt.Problem(
        body=body,
        friction=stiction(**coefficients),
        table=tt.Table(slope=slope),
        launch=tt.Launch(tilt=1.0, spin=0.0, slip=slip),
        gravity=G,
    )


SLOPE = math.radians(20.0)
"""Rolling needs 2/7 tan(SLOPE) = 0.104 of the normal force."""


@pytest.mark.parametrize(
    ("static_mu", "slip", "rolls"),
    [(0.105, 0.0, True), (0.103, 0.0, False), (0.3, 0.2, False), (0.3, 0.0, True)],
)
def test_a_ball_on_a_slope_rolls_if_it_sticks_and_else_slides_on(static_mu, slip, rolls):
    """5/7 g sin(beta), or g (sin(beta) - mu cos(beta)): from 0.103 to 0.3 of N both are motions."""
    time = 0.4
    run = tt.simulate(ball_on_slope(SLOPE, (slip, 0.0), static_mu=static_mu), time)
    rate = 5.0 / 7.0 * G * math.sin(SLOPE)
    if not rolls:
        rate = G * (math.sin(SLOPE) - SLIDING * math.cos(SLOPE))
    assert float(run["velocity"][-1, 0]) == pytest.approx(slip + rate * time, rel=1e-12)
    assert set(run["mode"].values.tolist()) == {"sticking" if rolls else "sliding"}
    assert float(run["energy_error"]) < 1e-12


def disk(friction, tilt=math.pi / 2 + 0.1):
    inertia = 0.25 * MASS * RADIUS**2
    return tt.Problem(
        body=tt.Body(mass=MASS, shape=tt.Ring(radius=RADIUS), I1=inertia, I3=2.0 * inertia),
        friction=friction,
        launch=tt.Launch(tilt=tilt, spin=0.0),
        gravity=G,
    )


def falling_disk(after, mu, static_mu):
    """Return when a disk that falls over in its plane begins to slip, and its tilts after that.

    About the edge (I + m R^2) psi'' = m g R sin(psi) from the vertical until friction over the
    normal force is static_mu; then I psi'' = N R (sin(psi) - mu cos(psi)) with N = m (g + z'').
    """
    inertia, lever = 0.25 * MASS * RADIUS**2, MASS * RADIUS**2
    pace = MASS * G * RADIUS / (inertia + lever)

    def forces(psi):
        turning, square = pace * math.sin(psi), 2.0 * pace * (math.cos(0.1) - math.cos(psi))
        along = turning * math.cos(psi) - square * math.sin(psi)
        return along, G / RADIUS - turning * math.sin(psi) - square * math.cos(psi)

    slips = brentq(lambda psi: forces(psi)[0] - static_mu * forces(psi)[1], 0.1, 0.6, xtol=1e-15)

    def held(t, y):
        return [y[1], pace * math.sin(y[0])]

    def reached(t, y):
        return y[0] - slips

    reached.terminal = True
    options = {"method": "DOP853", "rtol": 1e-13, "atol": 1e-15}
    first = solve_ivp(held, (0.0, 1.0), [0.1, 0.0], events=reached, **options)

    def sliding(t, y):
        psi, rate = y
        lift = math.sin(psi) - mu * math.cos(psi)
        normal = MASS * (G - RADIUS * rate**2 * math.cos(psi))
        normal /= 1.0 + MASS * RADIUS**2 * math.sin(psi) * lift / inertia
        return [rate, normal * RADIUS * lift / inertia]

    begun = float(first.t[-1])
    second = solve_ivp(sliding, (0.0, after[-1]), first.y[:, -1], t_eval=after, **options)
    return begun, math.pi / 2 + second.y[0]


def test_a_disk_that_falls_slips_at_the_static_coefficient_and_slides_at_the_other():
    """The tilt follows an independent planar integration, across the jump of friction."""
    after = np.array([1e-6, 1e-4, 1e-3, 5e-3])
    begun, expected = falling_disk(after, 0.2, 0.3)
    times = begun + after
    run = tt.simulate(disk(stiction(0.2, 0.3)), float(times[-1]), times=times)
    assert run["event_kind"].values.tolist() == ["stick", "slip"]
    assert float(run["event_time"][1]) == pytest.approx(begun, rel=1e-11)
    assert run["tilt"].values == pytest.approx(expected, abs=1e-10)
    slower = tt.simulate(disk(tt.CoulombFriction(mu=0.3)), float(times[-1]), times=times)
    assert abs(float(slower["tilt"][-1]) - expected[-1]) > 1e-4


def test_with_one_coefficient_it_is_coulombs_law():
    both = [disk(friction) for friction in (stiction(0.3, 0.3), tt.CoulombFriction(mu=0.3))]
    first, second = (tt.simulate(problem, 0.05, samples=7) for problem in both)
    for name in ("tilt", "angular_momentum", "velocity"):
        np.testing.assert_array_equal(first[name], second[name])


def test_a_puck_on_a_slope_is_held_by_static_friction_and_slides_by_the_other():
    rings = [tt.Ring(radius=RADIUS, center=side * 0.002) for side in (-1, 1)]
    puck = ball_on_slope(math.atan(0.2)).replace(
        {
            "body": tt.Body(mass=MASS, shape=rings, I1=6e-6, I3=1e-5),
            "launch": {"tilt": 0.0, "spin": 0.0},
        }
    )
    assert str(tt.simulate(puck, 1.0)["outcome"].values) == "at_rest"
    pushed = tt.simulate(puck.replace({"launch.slip": [0.01, 0.0]}), 0.5)
    rate = G * (math.sin(math.atan(0.2)) - SLIDING * math.cos(math.atan(0.2)))
    assert float(pushed["velocity"][-1, 0]) == pytest.approx(0.01 + 0.5 * rate, rel=1e-10)


def test_derivatives_by_the_static_coefficient_are_those_of_differences():
    problem, times, step = disk(stiction(0.2, 0.3)), np.array([0.11, 0.12]), 1e-5
    found = tt.sensitivities(
        problem, times[-1], times=times, vary=["friction.static_mu", "friction.mu"]
    )
    for name in ("static_mu", "mu"):
        below, above = (
            tt.simulate(
                problem.replace({f"friction.{name}": getattr(problem.friction, name) + change}),
                times[-1],
                times=times,
            )["tilt"].values
            for change in (-step, step)
        )
        difference = (above - below) / (2.0 * step)
        exact = found["tilt"].sel(parameter=f"friction.{name}").values
        assert exact == pytest.approx(difference, rel=1e-5)


def test_less_static_friction_than_sliding_friction_is_refused():
    with pytest.raises(tt.InvalidInput, match="at least mu"):
        stiction(0.3, 0.2)
    with pytest.raises(tt.InvalidInput, match="at least mu"):
        ball_on_slope(0.1).replace({"friction.mu": 0.4})
