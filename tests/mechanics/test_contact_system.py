"""The multiplier system of contacts, against Newton and Euler about the centre of mass."""

import math

import numpy as np
import pytest

from tippetop.mechanics.contacts.contact_forces import forces_on_two
from tippetop.mechanics.contacts.contact_point import ContactPoint, contact_points
from tippetop.mechanics.contacts.forces import (
    constraints_of,
    directions_of,
    forces_and_accelerations,
    sum_at,
)
from tippetop.mechanics.contacts.pair import slips_of
from tippetop.mechanics.contacts.slip_variables import velocity_of
from tippetop.mechanics.contacts.sticking import sticking_forces
from tippetop.mechanics.contacts.system import free_rates, solve_constraints
from tippetop.mechanics.laws.contensou import EllipsoidalLaw
from tippetop.mechanics.laws.contensou_hertz import HertzSlidingLaw
from tippetop.mechanics.laws.coulomb import CoulombLaw, RollingResistance
from tippetop.mechanics.laws.friction import RegularizedCoulombLaw, ViscousLaw
from tippetop.mechanics.motion import axis_rate, sliding_contact, sliding_rates
from tippetop.mechanics.state import SlidingState
from tippetop.mechanics.surfaces.hull import Hull
from tippetop.mechanics.surfaces.surface import RingSurface, SphereSurface, SpheroidSurface
from tippetop.mechanics.top import Top

SURFACES = {
    "sphere": SphereSurface(1.0, 0.3),
    "spheroid": SpheroidSurface(1.0, 1.6, 0.1),
    "ring": RingSurface(1.0, 0.2, 0.1),
}
LAWS = {
    "viscous": ViscousLaw(0.3),
    "regularized": RegularizedCoulombLaw(0.3, 0.01),
    "coulomb": CoulombLaw(0.3),
    "ellipsoidal": EllipsoidalLaw(0.3, 0.02),
    "hertz": HertzSlidingLaw(0.3, 0.02),
}
SET_VALUED = [name for name, law in LAWS.items() if hasattr(law, "reserve")]
STEP = 1e-6


def state(seed, lowest=0.2):
    """A random axis and angular momentum."""
    random = np.random.default_rng(seed)
    tilt, azimuth = random.uniform(lowest, math.pi - lowest), random.uniform(0.0, 2.0 * math.pi)
    sine = math.sin(tilt)
    axis = (sine * math.cos(azimuth), sine * math.sin(azimuth), math.cos(tilt))
    return axis, tuple(random.uniform(-3.0, 3.0, 3).tolist())


def top_of(surface, law, resists):
    return Top.of(1.0, 0.45, 0.38, surface, law, 1.0, RollingResistance(1e-2) if resists else None)


def by_centre_of_mass(points, constraints):
    """Total force, and moment about the centre of mass, from D p + b = 0 in those coordinates.

    With a wrench (f, c) at arm a, F = f and M = a x f + c: D_rc = F_r.F_c / m + M_r.J M_c and
    b_r = F_r.(-g z + omega x a') + M_r.(k omega3 n'). The rate of the arm is a difference quotient.
    """
    top, axis = points[0].top, np.array(points[0].axis)
    one, three = top.transverse_inertia, top.axial_inertia
    rate = np.array(axis_rate(points[0].axis, points[0].momentum, top))
    inverse = np.eye(3) / one + (1.0 / three - 1.0 / one) * np.outer(axis, axis)
    omega = inverse @ np.array(points[0].momentum)
    gyration = (one - three) / one * (omega @ axis) * rate
    gravity = np.array([0.0, 0.0, -top.gravity])

    def load(contact, wrench):
        arm = np.array(points[contact].arm)
        return np.array(wrench.force), np.cross(arm, wrench.force) + np.array(wrench.torque)

    def arm_rate(point):
        ahead, behind = (
            ContactPoint.of(tuple((axis + sign * STEP * rate).tolist()), point.momentum, point.top)
            for sign in (1.0, -1.0)
        )
        return (np.array(ahead.arm) - np.array(behind.arm)) / (2.0 * STEP)

    rows = [load(c.component.contact, c.component.wrench) for c in constraints]
    columns = [load(c.component.contact, c.wrench) for c in constraints]
    delassus = [
        [f @ force / top.mass + m @ inverse @ moment for force, moment in columns] for f, m in rows
    ]
    free = [
        f @ (gravity + np.cross(omega, arm_rate(points[c.component.contact]))) + m @ gyration
        for (f, m), c in zip(rows, constraints, strict=True)
    ]
    sizes = np.linalg.solve(np.array(delassus), -np.array(free))
    total = [size * np.concatenate(column) for size, column in zip(sizes, columns, strict=True)]
    return np.sum(total, axis=0)


def total(points, wrenches):
    """Total force, and moment about the centre of mass, of wrenches at contacts."""
    return np.sum(
        [[*wrench.force, *points[number].moment(wrench)] for number, wrench in wrenches], axis=0
    )


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("resists", [False, True])
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("surface", SURFACES)
def test_one_contact(surface, law, resists, seed):
    """Slip or sticking, and rolling that goes on or is held, by all ways to compute them."""
    axis, momentum = state(seed)
    top = top_of(SURFACES[surface], LAWS[law], resists)
    point = ContactPoint.of(axis, momentum, top)
    for slip in ((0.3, -0.2), None)[: 1 + (law in SET_VALUED)]:
        for rolling in (point.turning[:2], None)[: 1 + resists]:
            held = constraints_of((point,), (slip,), rolling)
            wrenches, rates = solve_constraints((point,), held, free_rates((point,)))
            found = total((point,), wrenches)
            scale = np.abs(found).max()
            expected = by_centre_of_mass((point,), held)
            np.testing.assert_allclose(found, expected, rtol=0, atol=1e-8 * scale)
            wrench, acceleration = forces_and_accelerations(point, slip, rolling)
            np.testing.assert_allclose(
                total((point,), [(0, wrench)]), found, rtol=0, atol=1e-12 * scale
            )
            np.testing.assert_allclose(acceleration.turning, rates.turning, atol=1e-11 * scale)


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("surface", SURFACES)
def test_the_fast_paths_of_one_contact(surface, law, seed):
    """`sliding_rates`, the normal force of `contact`, and `sticking_forces`."""
    axis, momentum = state(seed)
    top = top_of(SURFACES[surface], LAWS[law], resists=False)
    point, slip = ContactPoint.of(axis, momentum, top), (0.3, -0.2)
    slides = SlidingState(axis, momentum, velocity_of(axis, momentum, slip, top))
    wrench, _ = forces_and_accelerations(point, slip)
    assert sliding_contact(*slides, top).normal_force == pytest.approx(wrench.force[2], rel=1e-11)
    rates = sliding_rates(slides, top)
    np.testing.assert_allclose(rates.momentum, point.moment(wrench), rtol=1e-10, atol=1e-11)
    np.testing.assert_allclose(rates.velocity, wrench.force[:2], rtol=1e-10, atol=1e-11)
    if law in SET_VALUED:
        held = constraints_of((point,), (None,), None)
        wrenches, _ = solve_constraints((point,), held, free_rates((point,)))
        wrench, _ = sticking_forces(point, drills=law == "coulomb")
        expected, scale = sum_at(0, wrenches), max(map(abs, wrench.force))
        np.testing.assert_allclose(wrench.force, expected.force, rtol=0, atol=1e-12 * scale)
        np.testing.assert_allclose(wrench.torque, expected.torque, rtol=0, atol=1e-12 * scale)


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("resists", [False, True])
@pytest.mark.parametrize("law", LAWS)
def test_two_contacts(law, resists, seed):
    """Each slips or sticks, and rolling goes on one way, or the other, or is held."""
    axis, momentum = state(seed, lowest=0.4)
    hull = Hull.of((SphereSurface(1.0, 0.3), SphereSurface(0.2, 1.5)))
    tops = top_of(hull, LAWS[law], resists).body.contacts
    pair = contact_points(axis, momentum, tops)
    one, other = (slip[:2] for slip in slips_of(pair, (0.3, -0.2, 0.4)))
    cases = [(one, other)]
    if law in SET_VALUED:
        cases.append((None, None))
    if law == "coulomb":
        cases += [(None, other), (one, None)]
    along = directions_of(axis)[0][:2]
    for slips in cases:
        for rolls in (1.0, -1.0, 0.0)[: 1 + 2 * resists]:
            rolling = None if resists and not rolls else (rolls * along[0], rolls * along[1])
            held = constraints_of(pair, slips, rolling)
            found = forces_on_two(pair, slips, rolls)
            acting = total(pair, list(enumerate(found.wrenches)))
            np.testing.assert_allclose(
                acting, by_centre_of_mass(pair, held), rtol=0, atol=1e-7 * np.abs(acting).max()
            )
            size = np.abs(found.force).max()
            for constraint in held:
                assert abs(constraint.component.rate(found.rates)) < 1e-11 * size
