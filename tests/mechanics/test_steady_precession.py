"""Steady precession: the relative equilibria of the eccentric sphere, which friction leaves
alone.
"""

import math

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.optimize import brentq

from strategies import numbers, spheres, tops
from tippetop.mechanics.euler import published_rates
from tippetop.mechanics.invariants import jellett
from tippetop.mechanics.laws.friction import ViscousLaw
from tippetop.mechanics.motion import on_table, sliding_contact, sliding_rates
from tippetop.mechanics.surfaces.surface import SphereSurface
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import cross, length
from tippetop.mechanics.view import Angles, state_from_angles

ORIGIN = (0.0, 0.0)
VISCOUS_SPHERES = tops(shapes=spheres(), friction_laws=(ViscousLaw,))


def steady_precession(top, tilt):
    """phi' = sqrt(m g R alpha / (I1 c + I3 (alpha - c))), where that is not too fast to be told
    from none.
    """
    radius, center = top.surface
    alpha = center / radius
    cosine = math.cos(tilt)
    inertia = top.transverse_inertia * cosine + top.axial_inertia * (alpha - cosine)
    if inertia < 0.02 * top.transverse_inertia:
        return None
    return math.sqrt(top.mass * top.gravity * radius * alpha / inertia)


@st.composite
def steady_precessions(draw):
    """An eccentric sphere that precesses steadily without slip, at a tilt where it can."""
    top = draw(VISCOUS_SPHERES)
    tilt = draw(numbers(0.05, math.pi - 0.05))
    precession = steady_precession(top, tilt)
    assume(precession is not None)
    precession *= draw(st.sampled_from([1.0, -1.0]))
    azimuth = draw(numbers(-math.pi, math.pi))
    spin = precession * (math.cos(tilt) - top.surface.center / top.surface.radius)
    return top, Angles(tilt, 0.0, azimuth, precession, spin, (0.0, 0.0))


@given(steady_precessions())
def test_steady_precession_is_an_equilibrium_of_the_published_equations(case):
    """theta'', phi'', omega3' (printed as phi3' in the report) and both slip rates vanish."""
    top, motion = case
    y = (motion.tilt, 0.0, motion.azimuth, motion.precession, motion.spin, 0.0, 0.0)
    tilt_rate, nodding, _, precessing, spinning, *slipping = published_rates(y, top, math)
    unit = motion.precession**2 + top.gravity / top.surface.radius
    assert tilt_rate == precessing == spinning == 0.0
    assert nodding == pytest.approx(0.0, abs=1e-12 * unit)
    assert slipping == pytest.approx([0.0, 0.0], abs=1e-12 * unit * top.surface.radius)


@given(steady_precessions())
def test_steady_precession_only_turns_about_the_vertical(case):
    """n' = phi' z x n and L' = phi' z x L; the centre of mass stays where it is, and the table
    bears m g.
    """
    top, motion = case
    state = state_from_angles(motion, top, math)
    turning = (0.0, 0.0, motion.precession)
    rates = sliding_rates(state, top)
    weight = top.mass * top.gravity
    momentum_rate = abs(motion.precession) * length(state.momentum)
    assert state.velocity == pytest.approx(
        ORIGIN, abs=1e-13 * abs(motion.precession) * top.surface.radius
    )
    touch = sliding_contact(state.axis, state.momentum, state.velocity, top)
    assert touch.normal_force == pytest.approx(weight, rel=1e-11)
    assert rates.axis == pytest.approx(
        cross(turning, state.axis), abs=1e-13 * abs(motion.precession)
    )
    assert rates.momentum == pytest.approx(
        cross(turning, state.momentum), abs=1e-11 * (weight * top.surface.radius + momentum_rate)
    )
    assert rates.velocity == pytest.approx(ORIGIN, abs=1e-12 * top.gravity)


@given(steady_precessions())
def test_jelletts_integral_of_a_steady_precession(case):
    """lambda = R phi' (I1 s^2 + I3 (c - alpha)^2)."""
    top, motion = case
    radius, center = top.surface
    alpha = center / radius
    s, c = math.sin(motion.tilt), math.cos(motion.tilt)
    inertia = top.transverse_inertia * s**2 + top.axial_inertia * (c - alpha) ** 2
    whole = on_table(state_from_angles(motion, top, math), top)
    assert jellett(whole, top) == pytest.approx(radius * motion.precession * inertia, rel=1e-12)


def test_the_half_inverted_end_state_is_the_steady_precession_with_the_launchs_jellett_integral():
    """The tippe top launched at rest in tilt at 0.1 rad with 50 rad/s; the converged end state is
    known.
    """
    mass, radius = 0.02, 0.02
    shape = SphereSurface(radius, 0.3 * radius)
    top = Top.of(
        mass, 131 / 350 * mass * radius**2, 2 / 5 * mass * radius**2, shape, ViscousLaw(0.3), 9.8
    )
    launch = Angles(0.1, 0.0, 0.0, 0.0, 50.0, (0.0, 0.0))
    kept = jellett(on_table(state_from_angles(launch, top, math), top), top)
    assert kept == pytest.approx(
        radius * top.axial_inertia * 50.0 * (math.cos(0.1) - 0.3), rel=1e-13
    )

    def steady(tilt):
        precession = steady_precession(top, tilt)
        return Angles(tilt, 0.0, 0.0, precession, precession * (math.cos(tilt) - 0.3), (0.0, 0.0))

    def excess(tilt):
        return jellett(on_table(state_from_angles(steady(tilt), top, math), top), top) - kept

    end = steady(brentq(excess, 1.3, 1.7, xtol=1e-14))
    assert end.tilt == pytest.approx(1.503553858228, abs=1e-11)
    assert end.precession == pytest.approx(35.254723275, abs=1e-8)
    assert end.spin == pytest.approx(-8.207588432, abs=1e-8)
