"""Disks that wobble down until they lie flat: when, and with what energy."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq

import tippetop as tt
from tippetop.contact import contact_mode, slip_end_motion, slip_onset
from tippetop.contact.natural_launch import NaturalLaunch
from tippetop.engines.reference import case_of, independent
from tippetop.mechanics import lying_down
from tippetop.mechanics.motion import along_table, contact_swing, sliding_contact

R, MASS, G = 0.04, 0.4, 9.81
I1 = MASS * R * R / 4
STICKS = tt.CoulombFriction(mu=20.0)


def disk(height: float = 0.0) -> tt.Body:
    """A thin disk, or one whose edge is at a depth below its centre of mass."""
    return tt.Body(
        mass=MASS, shape=tt.Ring(radius=R, center=-height), I1=I1, I3=2.0 * I1 * (1.0 - 1e-15)
    )


def decay(arm: float) -> tuple[float, float]:
    """Return sigma and beta of s = (sigma T)^2 and Omega s = beta T, at the time T before the end.

    The equations of motion of a thin disk without slip, about the horizontal part of its axis and
    across it, as s goes to zero:

        3 I1 beta = N arm beta / w,
        I1 (2 sigma^2 - beta^2 / sigma^2) = -N (R - 2 arm sigma^2 / w),

    with N = m (g + 2 R sigma^2) and w^2 = beta^2 + 4 sigma^4.
    """

    def rate(sigma: float) -> tuple[float, float]:
        normal = MASS * (G + 2 * R * sigma**2)
        return normal, normal * arm / (3 * I1)

    def missing(sigma: float) -> float:
        normal, w = rate(sigma)
        square = w**2 - 4 * sigma**4
        balance = I1 * (2 * sigma**2 - square / sigma**2) - 2 * normal * arm * sigma**2 / w
        return balance / (normal * R) + 1

    slow = 2 / 3 * arm / R * math.sqrt(G / R)
    sigma = float(brentq(missing, 0.9 * slow, 1.1 * slow, xtol=1e-17 * slow, rtol=1e-15))
    return sigma, math.sqrt(rate(sigma)[1] ** 2 - 4 * sigma**4)


def decaying(arm: float, sine: float) -> tuple[tt.Problem, float]:
    """Return a thin disk that decays so, and the time left to it."""
    sigma, beta = decay(arm)
    left = math.sqrt(sine) / sigma
    circling = beta * left / sine
    launch = tt.Launch(
        tilt=math.asin(sine),
        tilt_rate=-2 * sigma**2 * left,
        precession=circling,
        spin=-circling * sine**2,
    )
    problem = tt.Problem(
        body=disk(), friction=STICKS, launch=launch, gravity=G, rolling_resistance=arm
    )
    return problem, left


def test_a_slow_decay_is_that_of_eulers_disk() -> None:
    sigma, _ = decay(1e-6)
    assert sigma == pytest.approx(2 / 3 * 1e-6 / R * math.sqrt(G / R), rel=1e-6)


@pytest.mark.parametrize("arm", [1e-3, 4e-3, 1e-2])
def test_rolling_resistance_lays_a_disk_flat_when_it_is_derived_to(arm: float) -> None:
    problem, left = decaying(arm, 1e-7)
    run = tt.simulate(problem, 10.0 * left, samples=2)
    assert run.attrs["status"] == "at_rest"
    assert run["event_kind"].values[-2:].tolist() == ["lies down", "rests"]
    assert float(run["event_time"][-2]) == pytest.approx(left, rel=1e-9)
    assert float(run["end_time"]) == pytest.approx(left, rel=1e-9)
    assert float(run["final_tilt"]) < 1e-12
    assert float(run["energy"][-1]) == pytest.approx(0.0, abs=1e-15)


FALLING = tt.Problem(
    body=disk(),
    friction=tt.CoulombFriction(mu=1.0),
    launch=tt.Launch(tilt=0.3, precession=2 * math.sqrt(G / (R * math.sin(0.3))), spin=0.0),
    gravity=G,
    rolling_resistance=4e-3,
)


def test_the_end_does_not_depend_on_where_the_law_takes_over(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    ends, energies = list[float](), list[float]()
    for left_out in (1e-7, 1e-8, 1e-10):
        monkeypatch.setattr(lying_down, "LEFT_OUT", left_out)
        for cached in (
            contact_mode.motion_of,
            slip_end_motion.slip_end_motion,
            slip_onset.onset_motion,
        ):
            cached.cache_clear()
        run = tt.simulate(FALLING, 2.0, samples=2)
        assert run.attrs["status"] == "at_rest"
        ends.append(float(run["end_time"]))
        energies.append(float(run["energy"][-1]))
    assert ends[0] == pytest.approx(ends[2], abs=1e-8)
    assert ends[1] == pytest.approx(ends[2], abs=1e-9)
    assert energies == pytest.approx(3 * [energies[2]], abs=1e-14)


def test_the_end_does_not_depend_on_the_tolerance() -> None:
    ends = [
        float(tt.simulate(FALLING, 2.0, samples=2, tolerance=tolerance)["end_time"])
        for tolerance in (1e-10, 1e-15)
    ]
    assert ends[0] == pytest.approx(ends[1], abs=1e-9)


def test_a_wobble_takes_few_steps() -> None:
    run = tt.simulate(FALLING, 2.0, samples=20_001)
    turns = np.abs(np.diff(run["azimuth"].values)).sum() / (2 * np.pi)
    assert turns > 10.0
    assert int(run["steps"]) < 1.2 * 50 * 120  # of 120 wobbles; samples show but the first


@pytest.mark.parametrize("spin", [20.0, -20.0])
def test_friction_of_a_spinning_disk_brings_its_edge_down_or_lifts_it(spin: float) -> None:
    """On the slip R spin at the depth H it has a moment about the horizontal part of the axis."""
    height, mu, sine = 0.005, 0.05, 1e-10
    circling = 2 * math.sqrt(G / (R * sine))
    launch = tt.Launch(tilt=sine, precession=circling, spin=spin, velocity=(0.0, 0.0, 0.0))
    problem = tt.Problem(
        body=disk(height), friction=tt.ViscousFriction(mu=mu), launch=launch, gravity=G
    )
    # 3 I1 beta = m g H mu R spin and beta^2 = sigma^2 m g R / I1.
    beta = MASS * G * height * mu * R * abs(spin) / (3 * I1)
    left = math.sqrt(sine) * math.sqrt(MASS * G * R / I1) / beta
    run = tt.simulate(problem, 3.0 * left, samples=2)
    if spin < 0.0:
        assert run["event_kind"].values[-1] == "lies down"
        assert float(run["event_time"][-1]) == pytest.approx(left, rel=1e-3)
    else:
        assert run.attrs["status"] == "completed"
        assert float(run["final_tilt"]) > 2.0 * sine


@pytest.mark.parametrize("friction", [tt.ViscousFriction(mu=3.0), STICKS])
def test_without_rolling_resistance_a_thin_disk_wobbles_on(friction: tt.Friction) -> None:
    """The power that the table takes falls faster than the root of the wobble's energy."""
    problem = FALLING.replace({"friction": friction, "rolling_resistance": 0.0})
    run = tt.simulate(problem, 5.0, samples=2)
    assert run.attrs["status"] == "completed"
    assert 1e-3 < float(run["final_tilt"]) < float(run["tilt"][0]) * (1.0 + 1e-14)


def test_a_ring_whose_slip_ends_with_its_rate_sticks() -> None:
    """It swings near its face without loss: slip ends where it and its rate are rounding."""
    ring = tt.Ring(radius=0.01565891365093795, tube=0.00313178273018759)
    problem = tt.Problem(
        body=tt.Body(
            mass=0.004468335593083395,
            shape=ring,
            I1=4.711383500378491e-07,
            I3=6.734569111020975e-07,
        ),
        friction=tt.CoulombFriction(mu=0.387944595046632),
        launch=tt.Launch(
            tilt=0.056001556722740944, spin=-2.0664179971447316, azimuth=0.20951869617563634
        ),
        contact=tt.Contact(liftoff="fly", restitution=0.0),
    )
    run = tt.simulate(problem, 0.12, samples=3, mode_limit=200)
    assert run.attrs["status"] == "completed"
    assert float(run["energy_error"]) < 1e-12


@pytest.mark.parametrize("part", [0.3, 1e-3, 1e-6])
def test_the_law_of_the_end_keeps_the_force_of_what_creeps(part: float) -> None:
    """Friction on slip far slower than the wobble has a direction, on which the normal force
    depends: both keep.
    """
    friction = tt.ContensouFriction(mu=0.3, patch_radius=0.02 * R)
    launch = tt.Launch(tilt=1e-6, spin=0.0, precession=900.0)
    problem = tt.Problem(body=disk(0.2 * R), friction=friction, launch=launch, gravity=G)
    natural = NaturalLaunch.of(problem)
    top, state = natural.top, along_table(natural.state)
    swing = contact_swing(state.axis, state.momentum, top)
    slip = (3e-7, -8e-7)
    state = state._replace(velocity=(slip[0] - swing[0], slip[1] - swing[1]))
    before = sliding_contact(*state, top)
    after = sliding_contact(*lying_down.scaled_wobble(state, part, False, top), top)
    assert after.slip == pytest.approx(before.slip, rel=1e-6)
    assert after.normal_force == pytest.approx(before.normal_force, rel=1e-4)


@pytest.mark.parametrize("part", [0.3, 1e-3, 1e-6])
def test_a_film_keeps_the_velocity_of_the_centre_of_mass_through_the_law_of_the_end(
    part: float,
) -> None:
    launch = tt.Launch(tilt=1e-6, spin=0.0, precession=900.0, slip=(2e-3, -1e-3))
    friction = tt.ViscousFriction(mu=2.0)
    problem = tt.Problem(body=disk(0.2 * R), friction=friction, launch=launch, gravity=G)
    natural = NaturalLaunch.of(problem)
    state = along_table(natural.state)
    swing = contact_swing(state.axis, state.momentum, natural.top)
    assert math.hypot(*swing) > 1e-5
    after = lying_down.scaled_wobble(state, part, False, natural.top)
    assert after.velocity == pytest.approx(state.velocity, rel=1e-15)


def test_a_disk_slides_on_upon_a_film_as_an_independent_solver_finds() -> None:
    """The wobble of its edge before the end, 1e-10 m/s, adds nothing to its velocity."""
    case = case_of("disk-end")
    rows = np.array(independent(case)["states"])
    run = tt.simulate(case.problem, case.duration, times=[0.0, *case.times])
    lies = case.times > run["event_time"].values[-1]
    assert lies.sum() == 7
    velocity = run["velocity"].values[1:][lies, :2]
    assert np.abs(velocity - rows[lies, 7:9]).max() < 2e-12
