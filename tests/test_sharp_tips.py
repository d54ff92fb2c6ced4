"""Tops on a sharp tip: a sphere of radius 0, and the heavy top of textbooks where it sticks.

With its tip fixed, u = cos(theta) follows u'^2 = beta (u - u1) (u - u2) (u - u3), an elliptic
function, and the precession is phi' = (b - a u) / (1 - u^2) (Goldstein, Classical Mechanics,
section 5.7), with a = I3 omega3 / J, b = p_phi / J, beta = 2 m g l / J and J = I1 + m l^2.
"""

import math

import mpmath
import numpy as np
import pytest

import tippetop as tt

MASS, LENGTH, I1, I3 = 0.1, 0.04, 6e-5, 3e-5
ABOUT_TIP = I1 + MASS * LENGTH**2
PEG = tt.Body(mass=MASS, shape=tt.Sphere(radius=0, center=-LENGTH), I1=I1, I3=I3)


def heavy_top(spin, tilt=0.3, precession=0.0, **changes):
    launch = tt.Launch(tilt=tilt, spin=spin, precession=precession)
    problem = tt.Problem(body=PEG, friction=tt.CoulombFriction(mu=50.0), launch=launch)
    return problem.replace(changes) if changes else problem


def elliptic(problem):
    """Return u(t), the period of nutation and the precession in a period, for a launch with no
    tilt rate.
    """
    mpmath.mp.dps = 30
    launch = problem.launch
    spin, rate, tilt = (mpmath.mpf(x) for x in (launch.spin, launch.precession, launch.tilt))
    u0 = mpmath.cos(tilt)
    a = I3 * spin / mpmath.mpf(ABOUT_TIP)
    b = (1 - u0**2) * rate + a * u0
    beta = 2 * mpmath.mpf(MASS) * problem.gravity * LENGTH / ABOUT_TIP
    alpha = (1 - u0**2) * rate**2 + beta * u0
    # (alpha - beta u) (1 - u^2) - (b - a u)^2
    roots = sorted(
        mpmath.re(root)
        for root in mpmath.polyroots(
            [beta, -alpha - a**2, 2 * a * b - beta, alpha - b**2], maxsteps=200, extraprec=200
        )
    )
    low, high, beyond = roots
    modulus = (high - low) / (beyond - low)
    omega = mpmath.sqrt(beta * (beyond - low)) / 2
    quarter = mpmath.ellipk(modulus)
    shift = quarter if abs(u0 - high) < abs(u0 - low) else 0

    def u(t):
        return low + (high - low) * mpmath.ellipfun("sn", shift + omega * t, m=modulus) ** 2

    def turn(phase):
        value = low + (high - low) * mpmath.sin(phase) ** 2
        return (b - a * value) / (1 - value**2) / mpmath.sqrt(1 - modulus * mpmath.sin(phase) ** 2)

    precession = 2 * mpmath.quad(turn, mpmath.linspace(0, mpmath.pi / 2, 9)) / omega
    return u, float(2 * quarter / omega), float(precession)


@pytest.mark.parametrize(("spin", "precession"), [(300.0, 0.0), (200.0, 3.0), (250.0, -6.0)])
def test_the_heavy_top_nutates_and_precesses_as_the_elliptic_functions_say(spin, precession):
    problem = heavy_top(spin, precession=precession)
    u, period, turn = elliptic(problem)
    times = np.array([0.13, 0.37, 1.0, 3.0]) * period
    cycles = 6
    run, solution = tt.simulate(problem, (cycles + 0.01) * period, samples=3, dense=True)
    assert run.attrs["status"] == "completed"
    axis = solution(np.append(times, cycles * period)).axis
    assert axis[2, :-1] == pytest.approx([float(u(t)) for t in times], abs=1e-10)
    # After whole periods the tilt is as at launch, and the axis has turned as often.
    assert axis[2, -1] == pytest.approx(math.cos(problem.launch.tilt), abs=1e-10)
    apart = math.atan2(axis[1, -1], axis[0, -1]) - cycles * turn
    assert math.remainder(apart, math.tau) == pytest.approx(0.0, abs=1e-10 * cycles)
    states = solution.sample(np.linspace(0.0, cycles * period, 40))
    momentum, axes = states["angular_momentum"].values, states["axis"].values
    along = np.sum(momentum * axes, axis=1)
    assert along == pytest.approx(I3 * spin, rel=1e-13)
    velocity = states["velocity"].values
    about_tip = momentum[:, 2] + MASS * LENGTH * np.cross(axes, velocity)[:, 2]
    assert np.ptp(about_tip) < 1e-13 * abs(along[0])
    assert float(run["energy_error"]) < 1e-13
    assert float(run["min_normal_force"]) > 0.0


def test_regular_precession_at_the_rates_of_the_textbook():
    """J cos(theta) phi'^2 - I3 omega3 phi' + m g l = 0, slow and fast."""
    spin, tilt = 400.0, 0.5
    weight = MASS * 9.8 * LENGTH
    for rate in np.roots(
        [(ABOUT_TIP - I3) * math.cos(tilt) + I3 * math.cos(tilt), -I3 * spin, weight]
    ):
        problem = heavy_top(spin, tilt, float(rate), gravity=9.8)
        tilts = tt.simulate(problem, 1.0, samples=21)["tilt"].values
        assert tilts == pytest.approx(tilt, abs=1e-10)


def test_a_sleeping_top_on_a_point():
    """It sleeps above omega3^2 = 4 J m g l / I3^2 where the tip sticks."""
    least = math.sqrt(4.0 * ABOUT_TIP * MASS * 9.8 * LENGTH) / I3
    for factor, stays in ((1.02, True), (0.98, False)):
        problem = heavy_top(factor * least, 1e-5, gravity=9.8)
        run = tt.simulate(problem, 4.0, samples=3)
        assert (float(run["max_tilt"]) < 1e-3) == stays


def test_a_tip_is_the_limit_of_small_balls():
    """The end of a run is smooth in the radius down to 0."""
    for friction in (
        tt.ViscousFriction(mu=0.3),
        tt.RegularizedCoulombFriction(mu=0.1, eps=1e-2),
    ):
        sharp = tt.Problem(body=PEG, friction=friction, launch=tt.Launch(tilt=0.2, spin=150.0))
        ends = [
            float(tt.simulate(sharp.replace({"body.shape.radius": r}), 0.2)["final_tilt"])
            for r in (0.0, 1e-7, 2e-7)
        ]
        assert ends[0] == pytest.approx(2.0 * ends[1] - ends[2], abs=1e-8)
        assert ends[0] != ends[1]


def test_l3_is_jelletts_integral_of_a_point():
    run = tt.simulate(
        tt.Problem(
            body=PEG,
            friction=tt.ViscousFriction(mu=0.3),
            launch=tt.Launch(tilt=0.2, spin=150.0),
        ),
        0.5,
    )
    along = np.sum(run["angular_momentum"].values * run["axis"].values, axis=1)
    assert along == pytest.approx(150.0 * I3, rel=1e-12)


CONE = [(0, 0), (20, 12), (20, 14), (3, 35), (3, 50), (0, 50)]


def test_a_drawn_tip_is_a_body():
    body = tt.Body.turned(CONE, 7800.0, unit="mm")
    tip = body.shapes[0]
    assert (tip.kind, tip.radius) == ("sphere", 0.0)
    assert [shape.kind for shape in body.shapes] == ["sphere", "ring", "ring", "ring"]
    problem = tt.Problem(
        body=body, friction=tt.CoulombFriction(mu=0.3), launch=tt.Launch(tilt=0.05, spin=60.0)
    )
    run = tt.simulate(problem, 1.0)
    assert run.attrs["status"] == "completed"
    assert float(run["energy_error"]) < 1e-11
    assert float(run["gap"].min()) > -1e-13
    swept = tt.sweep(problem, {"launch.spin": [40.0, 60.0]}, duration=1.0, tolerance=1e-12)
    assert float(swept["final_tilt"][1]) == pytest.approx(float(run["final_tilt"]), abs=1e-7)
    assert tt.summarize(run)


def test_what_a_sharp_tip_cannot_have_is_said():
    with pytest.raises(tt.InvalidInput, match="sharp tip is not at the centre of mass"):
        tt.Sphere(radius=0, center=0)
    with pytest.raises(tt.InvalidInput, match="sharp tip does not roll"):
        tt.predict(heavy_top(100.0, friction=tt.ViscousFriction(mu=0.3)))
    assert tt.plot(tt.simulate(heavy_top(100.0), 0.05)) is not None
