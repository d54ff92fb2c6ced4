"""The equations of motion of the tippe top, derived once more by computer algebra, against the
package's.

The derivation shares nothing with the package: Euler angles and sympy's vectors, the momentum
balance and the angular momentum balance written down in space, and the height of the centre of mass
kept on the sphere for good by differentiating it twice. The six balances are linear in the five
accelerations and the normal force.
"""

import functools
import math
from typing import NamedTuple

import numpy as np
import pytest
import sympy as sp
from sympy.physics.mechanics import ReferenceFrame, dynamicsymbols

from tippetop.mechanics.euler import published_normal_force, published_rates
from tippetop.mechanics.laws.friction import ViscousLaw
from tippetop.mechanics.motion import sliding_contact, sliding_rates
from tippetop.mechanics.surfaces.surface import SphereSurface
from tippetop.mechanics.top import Top
from tippetop.mechanics.view import Angles, state_from_angles


class Balances(NamedTuple):
    """The balances as functions of (parameters, motion), and what follows from the
    accelerations.
    """

    matrix: object
    right_hand_side: object
    rates_in_space: object
    sinking_of_the_contact_point: sp.Expr


def moment_of_the_contact_force(arm, contact_force, weight):
    return arm.cross(contact_force)


def moment_as_printed(arm, contact_force, weight):
    return (contact_force + weight).cross(arm)


def moment_as_printed_without_the_weight(arm, contact_force, weight):
    return contact_force.cross(arm)


def moment_as_printed_in_the_right_order(arm, contact_force, weight):
    return arm.cross(contact_force + weight)


@functools.cache
def derive(moment=moment_of_the_contact_force) -> Balances:
    """Newton's and Euler's laws for a sphere with its centre of mass off its centre."""
    parameters = m, I1, I3, R, alpha, mu, g = sp.symbols("m I1 I3 R alpha mu g", positive=True)
    theta, phi, spin, slip_x, slip_y = coordinates = dynamicsymbols("theta phi omega3 v_x v_y")
    rates = sp.symbols("dtheta dphi")
    normal, *accelerations = unknowns = sp.symbols("N ddtheta ddphi domega3 dv_x dv_y")

    space = ReferenceFrame("space")
    leaning = space.orientnew("leaning", "Axis", [phi, space.z])
    principal = leaning.orientnew("principal", "Axis", [theta, leaning.y])
    vertical, axis = space.z, principal.z

    swing = principal.ang_vel_in(space)
    omega_1, omega_2 = swing.dot(principal.x), swing.dot(principal.y)
    omega = omega_1 * principal.x + omega_2 * principal.y + spin * axis
    momentum = I1 * omega_1 * principal.x + I1 * omega_2 * principal.y + I3 * spin * axis

    arm = alpha * R * axis - R * vertical  # to the centre of the sphere, then down to the table
    height = R - alpha * R * sp.cos(theta)
    slip = slip_x * leaning.x + slip_y * leaning.y
    turning = omega.cross(arm)
    horizontal_velocity = (
        slip - turning.dot(leaning.x) * leaning.x - turning.dot(leaning.y) * leaning.y
    )
    velocity = horizontal_velocity + height.diff(dynamicsymbols._t) * vertical

    contact_force = normal * vertical - mu * normal * slip
    weight = -m * g * vertical
    newton = m * velocity.dt(space) - contact_force - weight
    euler = momentum.dt(space) - moment(arm, contact_force, weight)
    balances = [newton.dot(e) for e in (leaning.x, leaning.y, vertical)]
    balances += [euler.dot(e) for e in (principal.x, principal.y, axis)]
    in_space = [
        v.dt(space).dot(e) for v in (axis, momentum, velocity) for e in (space.x, space.y, space.z)
    ]

    time = dynamicsymbols._t
    plain = dict(zip(coordinates, sp.symbols("theta_ phi_ omega3_ v_x_ v_y_"), strict=True))
    names = {theta.diff(time, 2): accelerations[0], phi.diff(time, 2): accelerations[1]}
    names |= dict(
        zip([spin.diff(time), slip_x.diff(time), slip_y.diff(time)], accelerations[2:], strict=True)
    )
    slower = {theta.diff(time): rates[0], phi.diff(time): rates[1]}

    def rename(expression):
        return expression.subs(names).subs(slower).subs(plain)

    system = sp.Matrix([rename(balance) for balance in balances])
    motion = (
        plain[theta],
        rates[0],
        plain[phi],
        rates[1],
        plain[spin],
        plain[slip_x],
        plain[slip_y],
    )
    known = (*parameters, *motion)
    return Balances(
        sp.lambdify(known, system.jacobian(unknowns), "numpy", cse=True),
        sp.lambdify(known, -system.subs(dict.fromkeys(unknowns, 0)), "numpy", cse=True),
        sp.lambdify((*known, *unknowns), [rename(rate) for rate in in_space], "numpy", cse=True),
        sp.simplify((velocity + turning).dot(vertical)),
    )


def solve(top: Top, motion, moment=moment_of_the_contact_force):
    """Normal force and rates of (theta, theta', phi, phi', omega3, v_x, v_y), by the balances."""
    balances = derive(moment)
    known = (*numbers_of(top), *motion)
    matrix = np.array(balances.matrix(*known), dtype=float)
    right_hand_side = np.array(balances.right_hand_side(*known), dtype=float)[:, 0]
    size = np.abs(matrix).max(axis=1)
    unknowns = np.linalg.solve(matrix / size[:, None], right_hand_side / size)
    normal, ddtheta, ddphi, *others = unknowns
    return normal, np.array([motion[1], ddtheta, motion[3], ddphi, *others]), unknowns


def numbers_of(top: Top):
    return (
        top.mass,
        top.transverse_inertia,
        top.axial_inertia,
        top.surface.radius,
        top.surface.center / top.surface.radius,
        top.friction.mu,
        top.gravity,
    )


def as_angles(motion) -> Angles:
    tilt, tilt_rate, azimuth, precession, spin, slip_x, slip_y = motion
    return Angles(tilt, tilt_rate, azimuth, precession, spin, (slip_x, slip_y))


def random_motions(count: int):
    """Tops of random numbers and random motions of them that a contact force can bring about."""
    random = np.random.default_rng(20130408)
    while count:
        mass, radius, gravity = (
            random.uniform(0.005, 0.5),
            random.uniform(0.01, 0.1),
            random.uniform(1.6, 20.0),
        )
        transverse = random.uniform(0.2, 1.0) * mass * radius**2
        axial = random.uniform(0.3, 2.0) * transverse
        shape = SphereSurface(radius, radius * random.uniform(0.05, 0.6))
        top = Top.of(mass, transverse, axial, shape, ViscousLaw(random.uniform(0.0, 2.0)), gravity)
        motion = tuple(
            float(number)
            for number in (
                random.uniform(0.05, math.pi - 0.05),
                random.uniform(-20.0, 20.0),
                random.uniform(-3.0, 3.0),
                *random.uniform(-60.0, 60.0, 2),
                *random.uniform(-0.5, 0.5, 2),
            )
        )
        state = state_from_angles(as_angles(motion), top, math)
        if (
            top.mass * sliding_contact(state.axis, state.momentum, state.velocity, top).delassus
            > 0.1
        ):
            count -= 1
            yield top, motion


MOTIONS = list(random_motions(150))


def distance(actual, expected) -> float:
    """Largest difference of two vectors, relative to the larger of them."""
    actual, expected = np.asarray(actual, dtype=float), np.asarray(expected, dtype=float)
    return np.abs(actual - expected).max() / max(np.abs(expected).max(), np.abs(actual).max())


def disagreement(actual, expected) -> float:
    """Relative distance of rates of (theta, theta', phi, phi', omega3, v_x, v_y): the worst
    kind.
    """
    kinds = ([0, 2], [1, 3, 4], [5, 6])
    return max(distance([actual[i] for i in kind], [expected[i] for i in kind]) for kind in kinds)


def test_the_contact_point_of_the_derivation_stays_on_the_table():
    assert derive().sinking_of_the_contact_point == 0


@pytest.mark.parametrize("azimuth_offset", [0.0, 2.5])
def test_rates_of_axis_momentum_and_velocity_follow_from_newton_and_euler(azimuth_offset):
    for top, motion in MOTIONS:
        turned = (*motion[:2], motion[2] + azimuth_offset, *motion[3:])
        *_, unknowns = solve(top, turned)
        expected = derive().rates_in_space(*numbers_of(top), *turned, *unknowns)
        rates = sliding_rates(state_from_angles(as_angles(turned), top, math), top)
        assert distance(rates.axis, expected[:3]) < 1e-11
        assert distance(rates.momentum, expected[3:6]) < 1e-11
        assert (
            np.abs(np.subtract(rates.velocity, expected[6:8])).max()
            < 1e-11 * np.abs(expected[6:]).max()
        )


def test_normal_force_keeps_the_sphere_on_the_table():
    for top, motion in MOTIONS:
        expected, *_ = solve(top, motion)
        state = state_from_angles(as_angles(motion), top, math)
        touch = sliding_contact(state.axis, state.momentum, state.velocity, top)
        scale = abs(expected) + top.mass * top.gravity
        assert abs(touch.normal_force - expected) < 1e-11 * scale
        assert abs(published_normal_force(motion, top, math) - expected) < 1e-11 * scale


def test_published_equations_follow_from_newton_and_euler():
    for top, motion in MOTIONS:
        _, expected, _ = solve(top, motion)
        assert disagreement(published_rates(motion, top, math), expected) < 1e-11


@pytest.mark.parametrize(
    "moment",
    [
        pytest.param(moment_as_printed, id="F x a, with the weight in F", marks=pytest.mark.slow),
        pytest.param(moment_as_printed_without_the_weight, id="F x a", marks=pytest.mark.slow),
        pytest.param(moment_as_printed_in_the_right_order, id="a x F, with the weight in F"),
    ],
)
def test_moment_as_printed_in_equation_2_7_contradicts_the_equations_derived_from_it(moment):
    """Only a x F of the contact force gives (2.8)-(2.15); the weight acts at the centre of mass."""
    for top, motion in MOTIONS:
        _, expected, _ = solve(top, motion, moment)
        assert disagreement(published_rates(motion, top, math), expected) > 1e-3


@pytest.mark.parametrize(
    "reading",
    [
        pytest.param(
            lambda I1, numerator, sine: I1 * numerator / (I1 * sine), id="I1 times the numerator"
        ),
        pytest.param(
            lambda I1, numerator, sine: (I1 / numerator) / (I1 * sine), id="I1 over the numerator"
        ),
    ],
)
def test_precession_acceleration_as_printed_in_equation_2_9_is_not_the_derived_one(reading):
    """The printed (2.9) carries an I1 too many; without it, the same terms are right."""
    for top, motion in MOTIONS:
        tilt, tilt_rate, _, precession, spin, _, slip_y = motion
        normal, expected, _ = solve(top, motion)
        _, I1, I3, R, alpha, mu, _ = numbers_of(top)
        sine, cosine = math.sin(tilt), math.cos(tilt)
        terms = (
            I3 * tilt_rate * spin,
            -2.0 * I1 * tilt_rate * precession * cosine,
            -mu * normal * slip_y * R * (alpha - cosine),
        )
        size = max(map(abs, terms)) / (I1 * sine)
        assert abs(sum(terms) / (I1 * sine) - expected[3]) < 1e-11 * (size + abs(expected[1]))
        assert abs(reading(I1, sum(terms), sine) - expected[3]) > 1e-3 * abs(expected[3])
