"""Dry friction: Contensou's laws against the patch itself, and what every such law must do."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

from strategies import numbers
from tippetop.mechanics.laws.contensou import EllipsoidalLaw
from tippetop.mechanics.laws.contensou_hertz import HertzDrillingLaw, HertzLaw, HertzSlidingLaw
from tippetop.mechanics.laws.coulomb import CoulombLaw, RollingResistance
from tippetop.mechanics.laws.friction import ViscousLaw
from tippetop.mechanics.series import Series, solved, unknown
from tippetop.mechanics.surfaces.surface import SphereSurface
from tippetop.mechanics.top import Top, natural, natural_units
from tippetop.problem.hertz_patch import MATERIALS, Material, hertz_patch_radius
from tippetop.theory.derivatives import jacobian

LAWS = [EllipsoidalLaw, HertzDrillingLaw, HertzSlidingLaw]
KAPPAS = [1e-3, 0.3, 0.9, 0.999, 1.001, 1.1, 2.0, 7.0]


def hertz(kappa):
    """Force and torque of the Hertz patch of radius 1 with mu = 1 that drills at the rate 1."""
    force, torque = HertzLaw(1.0, 1.0).traction((kappa, 0.0), (0.0, 0.0, 1.0))
    return -force[0], -torque[2]


def patch(kappa):
    """The same by quadrature: polar coordinates about the point at (0, kappa) that stands still.

    There the velocity of the patch has the direction of the angle, and the integrand is smooth.
    """

    def integral(weight):
        def along(angle):
            middle, square = -kappa * math.sin(angle), 1.0 - (kappa * math.cos(angle)) ** 2
            if square <= 0.0 or middle + math.sqrt(square) <= 0.0:
                return 0.0
            half = math.sqrt(square)
            low, high = max(0.0, middle - half), middle + half
            # r = middle + half sin(x): the pressure's square root is half cos(x)
            ends = [math.asin(max(-1.0, min(1.0, (r - middle) / half))) for r in (low, high)]

            def ring(x):
                r = middle + half * math.sin(x)
                return (half * math.cos(x)) ** 2 * r * weight(r, angle)

            return quad(ring, *ends, epsabs=1e-13, epsrel=1e-12)[0]

        corners = [-math.pi / 2, math.pi / 2]
        if kappa > 1.0:
            corners = [-math.pi / 2 - math.asin(1.0 / kappa), -math.pi / 2 + math.asin(1.0 / kappa)]
            return quad(along, *corners, epsabs=1e-12, epsrel=1e-11)[0] * 1.5 / math.pi
        return 2.0 * quad(along, *corners, epsabs=1e-12, epsrel=1e-11)[0] * 1.5 / math.pi

    force = integral(lambda r, angle: -math.sin(angle))
    torque = integral(lambda r, angle: r + kappa * math.sin(angle))
    return force, torque


@pytest.mark.parametrize("kappa", KAPPAS)
def test_hertz_friction_is_that_of_its_pressure(kappa):
    assert hertz(kappa) == pytest.approx(patch(kappa), rel=3e-9, abs=1e-11)


@pytest.mark.parametrize("kappa", [1.5, 30.0, 1e3, 1e6])
def test_hertz_friction_keeps_its_digits_in_fast_slip(kappa):
    """F = 1 - 1/(10 kappa^2) - 3/(280 kappa^4), T = 1/(5 kappa) + 1/(70 kappa^3): the pressure's
    moments.
    """
    force, torque = hertz(kappa)
    x = kappa**-2
    assert force == pytest.approx(1.0 - x / 10.0 - 3.0 * x**2 / 280.0, abs=1e-15 + 0.01 * x**3)
    assert torque * kappa == pytest.approx(0.2 + x / 70.0, abs=1e-15 + 0.01 * x**2)


@pytest.mark.parametrize("law", [EllipsoidalLaw, HertzLaw])
@pytest.mark.parametrize("kappa", [0.4, 1.1, 30.0])
@pytest.mark.parametrize("speed", [1e-140, 1e-90, 1e80, 1e140])
def test_friction_of_a_patch_depends_on_no_speed_alone(law, kappa, speed):
    """Slip and drilling are resisted as hard if both are as many times as fast."""
    force, torque = law(0.3, 1.0).traction((0.6 * kappa, -0.8 * kappa), (0.0, 0.0, -1.0))
    slip, turning = (0.6 * kappa * speed, -0.8 * kappa * speed), (0.0, 0.0, -speed)
    assert law(0.3, 1.0).traction(slip, turning) == (
        pytest.approx(force, rel=4e-15),
        pytest.approx(torque),
    )


def test_hertz_friction_in_slow_slip_is_viscous_with_3_pi_mu_over_8_w_r():
    slip, turning, mu, radius = (2e-9, -1e-9), (3.0, 4.0, 50.0), 0.3, 5e-4
    force, torque = HertzDrillingLaw(mu, radius).traction(slip, turning)
    viscous = ViscousLaw(3.0 * math.pi * mu / (8.0 * turning[2] * radius)).traction(slip, turning)
    assert force == pytest.approx(viscous.force, rel=1e-12)
    assert torque == pytest.approx((0.0, 0.0, -3.0 * math.pi / 16.0 * mu * radius), rel=1e-12)


def test_the_two_branches_join_with_two_derivatives():
    """What differs is odd in (kappa^2 - 1)^(1/2), and starts with its fifth power."""
    gaps = []
    for excess in (1e-2, 1e-3):
        args = ((1.0 + excess, 0.0), (0.0, 0.0, 1.0))
        here, there = (
            HertzSlidingLaw(1.0, 1.0).traction(*args),
            HertzDrillingLaw(1.0, 1.0).traction(*args),
        )
        gaps.append((here.force[0] - there.force[0], here.torque[2] - there.torque[2]))
    (f1, t1), (f2, t2) = gaps
    assert f1 / f2 == pytest.approx(10**2.5, rel=0.03)
    assert t1 / t2 == pytest.approx(10**2.5, rel=0.03)


MOTIONS = st.tuples(numbers(-2.0, 2.0), numbers(-2.0, 2.0), numbers(-2.0, 2.0))


def at(law, motion):
    """Generalized friction force (f, torque) at (v, w)."""
    force, torque = law.traction(motion[:2], (0.0, 0.0, motion[2]))
    return np.array([*force, torque[2]])


def gradient(law, motion):
    """Derivative of that by (v, w)."""
    if isinstance(law, HertzLaw):
        law = law.branch((*motion[:2], law.patch_radius * motion[2]))
    return jacobian(lambda z: at_list(law, z), motion)


def at_list(law, z):
    force, torque = law.traction((z[0], z[1]), (0.0, 0.0, z[2]))
    return [*force, torque[2]]


@given(st.sampled_from([EllipsoidalLaw, HertzLaw]), MOTIONS, numbers(0.1, 2.0))
def test_contensou_friction_derives_from_a_convex_potential(law, motion, radius):
    """The derivative of the force is symmetric and not positive, and has no part along the
    motion.
    """
    x, y, w = motion
    if math.hypot(x, y, w) < 0.01 or abs(math.hypot(x, y) - radius * abs(w)) < 1e-3:
        return
    slope = gradient(law(0.4, radius), motion)
    scale = np.abs(slope).max()
    assert slope == pytest.approx(slope.T, abs=1e-11 * scale)
    assert np.linalg.eigvalsh(0.5 * (slope + slope.T)).max() < 1e-11 * scale
    assert slope @ motion == pytest.approx(np.zeros(3), abs=1e-11 * scale)


@given(st.sampled_from([EllipsoidalLaw, HertzLaw]), MOTIONS, MOTIONS, numbers(0.1, 2.0))
def test_contensou_friction_takes_the_most_power_its_limit_surface_allows(
    law, motion, other, radius
):
    law = law(0.4, radius)
    if min(math.hypot(*motion), math.hypot(*other)) < 0.01:
        return
    assert at(law, motion) @ motion <= at(law, other) @ motion + 1e-12


@given(MOTIONS, numbers(0.1, 2.0))
def test_the_ellipsoidal_law_lies_on_its_limit_surface(motion, radius):
    law = EllipsoidalLaw(0.4, radius)
    if math.hypot(*motion) < 0.01:
        return
    x, y, torque = 3.0 * at(law, motion)
    assert law.reserve(3.0, (x, y), torque) == pytest.approx(0.0, abs=1e-14)
    assert law.reserve(3.0, (0.9 * x, 0.9 * y), 0.9 * torque) == pytest.approx(0.19 * 1.44)


@given(MOTIONS, numbers(0.1, 2.0))
def test_hertz_s_law_lies_on_its_limit_surface(motion, radius):
    law = HertzLaw(0.4, radius)
    if math.hypot(*motion) < 0.01:
        return
    x, y, torque = 3.0 * at(law, motion)
    # near pure drilling the surface is steep in the torque
    assert law.reserve(3.0, (x, y), torque) == pytest.approx(0.0, abs=1e-12)
    for share, sign in ((0.99, 1.0), (1.01, -1.0)):
        assert sign * law.reserve(3.0, (share * x, share * y), share * torque) > 0.0


def test_coulomb_friction_opposes_slip_and_has_its_cone():
    force, torque = CoulombLaw(0.5).traction((3.0, -4.0), (1.0, 2.0, 3.0))
    assert force == pytest.approx((-0.3, 0.4))
    assert torque == (0.0, 0.0, 0.0)
    assert CoulombLaw(0.5).reserve(2.0, (0.6, -0.8), 7.0) == pytest.approx(0.0, abs=1e-15)
    assert CoulombLaw(0.5).reserve(2.0, (0.0, 0.5), 7.0) == pytest.approx(0.75)


def test_rolling_resistance_opposes_rolling_beside_any_law():
    law, resistance = EllipsoidalLaw(0.3, 1e-3), RollingResistance(2e-5)
    turning = (3.0, -4.0, 5.0)
    force, torque = on(law, resistance).traction((0.1, 0.2), turning)
    beside = law.traction((0.1, 0.2), turning)
    assert force == beside.force
    assert torque == pytest.approx((-1.2e-5, 1.6e-5, beside.torque[2]))
    assert resistance.reserve(2.0, (2.4e-5, 3.2e-5)) == pytest.approx(0.0, abs=1e-24)


def on(law, resistance):
    """A top on a table."""
    return Top.of(0.02, 3.0e-6, 3.2e-6, SphereSurface(0.02, 0.006), law, 9.8, resistance)


@pytest.mark.parametrize("law", [CoulombLaw(0.3), *(law(0.3, 2e-3) for law in LAWS)])
def test_laws_are_the_same_in_any_units(law):
    top = on(law, RollingResistance(3e-5))
    units = natural_units(top)
    slip, turning = (0.3, -0.2), (10.0, 20.0, 170.0)
    force, torque = top.traction(slip, turning)
    scaled = natural(top).traction(
        tuple(v / units.speed for v in slip), tuple(w * units.time for w in turning)
    )
    assert scaled.force == pytest.approx(force, rel=1e-13)
    assert tuple(t * units.length for t in scaled.torque) == pytest.approx(
        torque, rel=1e-13, abs=1e-20
    )


class Floats:
    """Sums of numbers."""

    def total(self, terms):
        return sum(terms)


@pytest.mark.parametrize("law", [CoulombLaw(0.3), *(law(0.3, 1.0) for law in LAWS)])
def test_laws_run_on_arrays_and_power_series(law):
    slip, turning = (0.7, 0.6), (1.0, 2.0, 0.9)
    value = law.traction(slip, turning)
    arrays = law.traction(tuple(np.full(3, v) for v in slip), tuple(np.full(3, w) for w in turning))
    assert arrays.force[1] == pytest.approx(np.full(3, value.force[1]), rel=1e-15)

    def rates(y):
        force, torque = law.traction((y[0], y[1]), (0.0, 0.0, y[2]))
        return [force[0], force[1], torque[2] + 0.0 * y[2]]

    start, step = (*slip, turning[2]), 0.01
    series = solved([Series(unknown, Floats()) for _ in start], start, rates)
    later = [sum(y[k] * step**k for k in range(12)) for y in series]
    slope = [sum(k * y[k] * step ** (k - 1) for k in range(1, 13)) for y in series]
    assert slope == pytest.approx(rates(later), rel=1e-11, abs=1e-13)


# Hertz's patch
# ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", sorted(MATERIALS))
def test_the_patch_carries_its_load_and_has_the_shape_of_the_sphere(name):
    """Pressure p0 (1 - r^2/a^2)^(1/2) sinks a half-space by pi p0 (2 a^2 - r^2) / (4 a E*)."""
    load, radius, material = 0.2, 0.015, MATERIALS[name]
    a = hertz_patch_radius(load, radius, material)
    peak = 1.5 * load / (math.pi * a**2)
    stiffness = material.modulus / (1.0 - material.poisson**2)
    assert math.pi * peak / (4.0 * a * stiffness) == pytest.approx(1.0 / (2.0 * radius), rel=1e-12)
    carried = quad(lambda r: 2.0 * math.pi * r * peak * math.sqrt(1.0 - (r / a) ** 2), 0.0, a)[0]
    assert carried == pytest.approx(load, rel=1e-9)


def test_two_like_bodies_are_twice_as_compliant_as_one_on_a_rigid_table():
    material = Material(modulus=3e9, poisson=0.35)
    ratio = hertz_patch_radius(0.1, 0.02, material, material) / hertz_patch_radius(
        0.1, 0.02, material
    )
    assert ratio == pytest.approx(2.0 ** (1.0 / 3.0), rel=1e-13)
