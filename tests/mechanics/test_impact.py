"""Impacts that are known exactly, impacts integrated independently, and what no impact can do."""

import math
from itertools import product
from typing import NamedTuple

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from campaigns import among, examples
from strategies import numbers, slides, spheres, tops
from tippetop.contact.impact import Impact, impact
from tippetop.mechanics.flight.free_motion import gap, gap_rate
from tippetop.mechanics.invariants import jellett
from tippetop.mechanics.laws.friction import RegularizedCoulombLaw, Traction, ViscousLaw
from tippetop.mechanics.motion import on_table
from tippetop.mechanics.state import State
from tippetop.mechanics.surfaces.surface import SphereSurface, SpheroidSurface, contact_vector
from tippetop.mechanics.top import Top

RESTITUTIONS = st.sampled_from([0.0, 0.3, 0.8, 1.0])


def speed_unit(top):
    return math.sqrt(top.gravity * top.surface.size)


@st.composite
def collisions(draw, top_strategy=None, roughest=100.0):
    """A top that comes down on the table, and a coefficient of restitution."""
    top, sliding = draw(slides(top_strategy))
    mu = 10.0 ** draw(numbers(-4.0, math.log10(roughest))) / speed_unit(top)
    if isinstance(top.friction, ViscousLaw) and top.friction.mu:
        top = top.altered(friction=ViscousLaw(mu))
    state = on_table(sliding, top)
    falling = 10.0 ** draw(numbers(-4.0, 0.5)) * speed_unit(top)
    velocity = (*state.velocity[:2], state.velocity[2] - falling)
    return state._replace(velocity=velocity), draw(RESTITUTIONS), top


def viscous():
    return tops(friction_laws=(ViscousLaw,))


def coulomb():
    return tops(friction_laws=(RegularizedCoulombLaw,))


class Rigid:
    """The body in an impact by matrices: its inertia, and what an impulse does to its contact
    point.
    """

    def __init__(self, state, top):
        n = np.array(state.axis)
        I1, I3 = top.transverse_inertia, top.axial_inertia
        self.mass, self.momentum = top.mass, np.array(state.momentum)
        self.inverse_inertia = np.linalg.inv(I1 * np.eye(3) + (I3 - I1) * np.outer(n, n))
        self.arm = np.array(contact_vector(state.axis, top.surface))
        x, y, z = self.arm
        self.lever = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
        self.delassus = np.eye(3) / top.mass - self.lever @ self.inverse_inertia @ self.lever
        self.omega = self.inverse_inertia @ self.momentum
        self.point = self.velocity_of_point(state)
        self.speed = np.linalg.norm(state.velocity) + np.linalg.norm(self.omega) * np.linalg.norm(
            self.arm
        )

    def velocity_of_point(self, state):
        return np.array(state.velocity) + np.cross(
            self.inverse_inertia @ np.array(state.momentum), self.arm
        )

    def integrate(self, law, impulse, method, rtol):
        """Velocity of the contact point, impulses of friction and torque, and normal work, by p."""

        def rates(_, y):
            force, torque = law.traction(
                (y[0], y[1]), tuple(self.omega + self.inverse_inertia @ self.angular_impulse(y))
            )
            turning = np.cross(self.inverse_inertia @ np.array(torque), self.arm)
            return [*(self.delassus @ [*force, 1.0] + turning), *force, 1.0, *torque, y[2]]

        self.angular_impulse = lambda y: np.cross(self.arm, y[3:6]) + y[6:9]
        # absolute tolerance far below the slip at which a steep law turns
        atol = rtol * np.array(
            [1e-3] * 3 + [impulse + 1e-300] * 6 + [impulse * self.speed + 1e-300]
        )
        start = [*self.point, *[0.0] * 7]
        return solve_ivp(
            rates, (0.0, impulse), start, method=method, rtol=rtol, atol=atol, dense_output=True
        )


def kinetic_energy_lost(before, after, top):
    """Return -(m dv.(v- + v+) + dL.(omega- + omega+)) / 2, in which nothing large cancels.

    The difference of two energies is off by the rounding of each, and the potential energy, which
    an impact does not change, may be 10^8 times what a slow impact takes.
    """
    inverse_inertia = Rigid(before, top).inverse_inertia
    v, V = np.array(before.velocity), np.array(after.velocity)
    L, M = np.array(before.momentum), np.array(after.momentum)
    return -0.5 * (top.mass * (V - v) @ (V + v) + (M - L) @ inverse_inertia @ (M + L))


# What no impact can do
# ----------------------------------------------------------------------------------


def check_laws_of_impact(state, restitution, top):
    """Energy is not gained, momentum is balanced, the body is not moved, and it does not go on
    sinking.
    """
    result = impact(state, restitution, top)
    after, rigid = result.state, Rigid(state, top)
    scale = rigid.mass * rigid.speed**2

    assert result.energy_lost >= 0.0
    assert result.energy_lost == pytest.approx(
        kinetic_energy_lost(state, after, top), rel=1e-11, abs=1e-13 * scale
    )
    assert (after.axis, after.height) == (state.axis, state.height)
    assert gap(after, top) == gap(state, top)

    impulse = top.mass * (np.array(after.velocity) - np.array(state.velocity))
    fuzz = 1e-13 * (np.linalg.norm(impulse) + top.mass * rigid.speed)
    assert impulse[2] == pytest.approx(result.impulse, rel=1e-12, abs=fuzz)
    turned = np.array(after.momentum) - rigid.momentum
    assert turned == pytest.approx(
        np.cross(rigid.arm, impulse), rel=1e-11, abs=fuzz * top.surface.size * 10
    )

    sinking = gap_rate(after, top)
    assert sinking > -1e-13 * rigid.speed
    assert 0.0 < result.compression <= result.impulse
    if restitution == 0.0:
        assert result.impulse == result.compression
        assert sinking == pytest.approx(0.0, abs=1e-13 * rigid.speed)
    return result


SLOW = (
    State((0.6, 0.0, 0.8), (0.0, 0.0, 0.0), (0.0, 0.0, -1e-5), 0.0152),
    0.3,
    Top.of(0.02, 3e-6, 3.2e-6, SphereSurface(0.02, 0.006), ViscousLaw(0.3), 9.8),
)
"""A fall whose kinetic energy is 10^-9 of its potential energy."""


@example(SLOW)
@settings(max_examples=examples(check=60, claim=3000))
@given(collisions(viscous()))
def test_impacts_obey_the_laws_of_mechanics_with_viscous_friction(collision):
    check_laws_of_impact(*collision)


@settings(max_examples=examples(check=20, claim=600))
@given(collisions(coulomb()))
def test_impacts_obey_the_laws_of_mechanics_with_coulomb_friction(collision):
    check_laws_of_impact(*collision)


@given(collisions(tops(spheres())))
def test_impacts_conserve_jelletts_integral(collision):
    state, restitution, top = collision
    size = math.hypot(*state.momentum) * math.hypot(*contact_vector(state.axis, top.surface))
    after = impact(state, restitution, top).state
    size += math.hypot(*after.momentum) * math.hypot(*contact_vector(state.axis, top.surface))
    assert jellett(after, top) == pytest.approx(jellett(state, top), rel=1e-13, abs=1e-15 * size)


@pytest.mark.parametrize("restitution", [-0.1, 1.1, math.nan])
def test_restitution_outside_of_zero_and_one_is_refused(restitution):
    top = Top.of(0.02, 3e-6, 3.2e-6, SphereSurface(0.02, 0.006), ViscousLaw(0.3), 9.8)
    state = State((0.0, 0.0, 1.0), (0.0,) * 3, (0.0, 0.0, -1.0), 0.014)
    with pytest.raises(ValueError, match="restitution must lie between 0 and 1"):
        impact(state, restitution, top)


@given(slides(), numbers(0.0, 1.0))
def test_a_body_that_does_not_approach_is_not_struck(slide, rising):
    top, sliding = slide
    state = on_table(sliding, top)
    rising = state._replace(
        velocity=(*state.velocity[:2], state.velocity[2] + rising * speed_unit(top))
    )
    assert impact(rising, 0.5, top) == Impact(rising, 0.0, 0.0, 0.0)


# Exact solutions
# ----------------------------------------------------------------------------------------


ON_THE_POLE = (
    State(
        (5.66553889764798e-16, 0.0, -1.0), (0.0, 0.0, 0.0), (0.0, 0.0, -0.3535533905932738), 0.09375
    ),
    0.0,
    Top.of(1.0, 0.00390625, 0.00390625, SphereSurface(0.0625, 0.03125), ViscousLaw(0.0), 2.0),
)
"""A fall onto a point that is off the axis by rounding."""


@example(ON_THE_POLE, RegularizedCoulombLaw(0.0, 1e-3))
@given(collisions(tops()), st.sampled_from([ViscousLaw(0.0), RegularizedCoulombLaw(0.0, 1e-3)]))
def test_without_friction_the_normal_velocity_is_reversed_and_nothing_else_happens(collision, law):
    """v_n+ = -e v_n-, p = -(1 + e) v_n- / M_nn, and the energy lost is (1 - e^2) v_n-^2 / (2
    M_nn).
    """
    state, restitution, top = collision
    top = top.altered(friction=law)
    result, rigid = impact(state, restitution, top), Rigid(state, top)
    falling, m_nn = rigid.point[2], rigid.delassus[2, 2]
    assert result.state.velocity[:2] == state.velocity[:2]
    assert result.impulse == pytest.approx(-(1 + restitution) * falling / m_nn, rel=1e-8)
    assert gap_rate(result.state, top) == pytest.approx(
        -restitution * falling, rel=1e-7, abs=1e-12 * rigid.speed
    )
    lost = 0.5 * (1 - restitution**2) * falling**2 / m_nn
    assert result.energy_lost == pytest.approx(
        lost, rel=1e-7, abs=1e-13 * rigid.speed * result.impulse
    )


@given(collisions(viscous()))
def test_very_rough_bodies_stick(collision):
    """With mu -> infinity slip ends at once; what is left is a bounce of a body held at its contact
    point.
    """
    state, restitution, top = collision
    top = top.altered(friction=ViscousLaw(1e12 / speed_unit(top)))
    rigid = Rigid(state, top)
    grip, coupling = rigid.delassus[:2, :2], rigid.delassus[:2, 2]
    stopping = -np.linalg.solve(grip, rigid.point[:2])
    falling = rigid.point[2] + coupling @ stopping
    assume(falling < -1e-3 * speed_unit(top))
    held = rigid.delassus[2, 2] - coupling @ np.linalg.solve(grip, coupling)
    result = impact(state, restitution, top)
    point = rigid.velocity_of_point(result.state)
    assert result.impulse == pytest.approx(-(1 + restitution) * falling / held, rel=1e-6)
    assert point == pytest.approx(
        np.array([0.0, 0.0, -restitution * falling]), abs=1e-6 * rigid.speed
    )
    if restitution == 0.0:
        impulse = -np.linalg.solve(rigid.delassus, rigid.point)
        lost = 0.5 * impulse @ rigid.delassus @ impulse
        assert result.energy_lost == pytest.approx(lost, rel=1e-6)


def planar(slip, falling, law, tilt=0.9):
    """A body that moves in a vertical plane, x z, with this velocity of its contact point."""
    shape = SphereSurface(0.02, 0.006)
    top = Top.of(0.02, 3.0e-6, 3.3e-6, shape, law, 9.8)
    axis = (math.sin(tilt), 0.0, math.cos(tilt))
    momentum = (0.0, 2e-4, 0.0)
    arm = np.array(contact_vector(axis, shape))
    velocity = np.array([slip, 0.0, falling]) - np.cross(
        np.array(momentum) / top.transverse_inertia, arm
    )
    return State(axis, momentum, tuple(velocity.tolist()), 0.02), top


@pytest.mark.parametrize("restitution", [0.0, 0.4])
@pytest.mark.parametrize("slip", [5.0, -5.0])
def test_coulomb_friction_in_a_plane_slides_all_through_at_high_slip(slip, restitution):
    """dP_t = -mu sign(slip) dp throughout (Whittaker), so that p_c = -v_n / (M_nn - mu sign(slip)
    M_tn).
    """
    mu = 0.2
    state, top = planar(slip, -0.3, RegularizedCoulombLaw(mu, 1e-6))
    delassus = Rigid(state, top).delassus
    friction = math.copysign(mu, -slip)
    compression = 0.3 / (delassus[2, 2] + friction * delassus[0, 2])
    result = impact(state, restitution, top)
    assert result.compression == pytest.approx(compression, rel=1e-9)
    assert result.impulse == pytest.approx((1 + restitution) * compression, rel=1e-9)
    gained = top.mass * (result.state.velocity[0] - state.velocity[0])
    assert gained == pytest.approx(friction * result.impulse, rel=1e-9)


@pytest.mark.parametrize("restitution", [0.0, 0.4])
@pytest.mark.parametrize("eps", [1e-3, 1e-4, 1e-5])
def test_coulomb_friction_in_a_plane_sticks_once_slip_has_ended(eps, restitution):
    """Slip ends at p_s = slip / (mu M_tt - M_tn); then f = -M_tn / M_tt, but for errors of order
    eps.
    """
    mu, slip, falling = 0.9, 0.3, -1.0
    state, top = planar(slip, falling, RegularizedCoulombLaw(mu, eps))
    delassus = Rigid(state, top).delassus
    m_tt, m_tn, m_nn = delassus[0, 0], delassus[0, 2], delassus[2, 2]
    assert abs(m_tn) < mu * m_tt
    stop = slip / (mu * m_tt - m_tn)
    left = falling + stop * (m_nn - mu * m_tn)
    assert left < 0.0
    compression = stop - left / (m_nn - m_tn**2 / m_tt)
    result = impact(state, restitution, top)
    assert result.compression == pytest.approx(compression, rel=20.0 * eps)
    assert result.impulse == pytest.approx((1 + restitution) * compression, rel=20.0 * eps)
    after = Rigid(state, top).velocity_of_point(result.state)
    assert abs(after[0]) < 5.0 * eps
    friction = -mu * stop - m_tn / m_tt * (result.impulse - stop)
    gained = top.mass * (result.state.velocity[0] - state.velocity[0])
    assert gained == pytest.approx(friction, abs=20.0 * eps * result.impulse)


# Independent integration
# --------------------------------------------------------------------------------


def check_against_integration(state, restitution, top, method, rtol, tolerance):
    """Velocity after, end of compression and work of the normal impulse, from equations in the
    impulse p.
    """
    result, rigid = impact(state, restitution, top), Rigid(state, top)
    trajectory = rigid.integrate(top.friction, result.impulse, method, rtol)
    end = trajectory.y[:, -1]
    after = rigid.velocity_of_point(result.state)
    assert after == pytest.approx(end[:3], abs=tolerance * rigid.speed)
    assert trajectory.sol(result.compression)[2] == pytest.approx(0.0, abs=tolerance * rigid.speed)
    inside = np.linspace(0.0, result.compression, 50)[1:-1]
    assert np.all(trajectory.sol(inside)[2] < tolerance * rigid.speed)
    fuzz = tolerance * rigid.speed * result.impulse
    assert end[9] < fuzz
    full = result.impulse == pytest.approx((1 + restitution) * result.compression, rel=1e-6)
    assert full or end[9] == pytest.approx(0.0, abs=fuzz)
    return result, end


@settings(max_examples=examples(check=20, claim=600))
@given(collisions(viscous()))
def test_viscous_friction_against_integration(collision):
    check_against_integration(*collision, "DOP853", 1e-12, 1e-9)


SHAPES = [SphereSurface(0.02, 0.006), SpheroidSurface(0.02, 0.034)]


@pytest.mark.parametrize(
    ("shape", "mu", "restitution", "eps"),
    among(list(product(SHAPES, (0.2, 0.7), (0.0, 0.8, 1.0), (1e-3, 1e-5))), check=3),
)
def test_steep_coulomb_friction_against_integration(shape, mu, restitution, eps):
    top = Top.of(0.02, 3.0e-6, 3.3e-6, shape, RegularizedCoulombLaw(mu, eps), 9.8)
    axis = (0.6, 0.48, 0.64)
    for velocity in ((0.3, -0.2, -0.7), (0.0, 0.5, -0.3), (-0.4, 0.1, -1.5)):
        state = State(axis, (2e-4, -1e-4, 3e-4), velocity, 0.02)
        if gap_rate(state, top) < 0.0:
            check_against_integration(state, restitution, top, "Radau", 1e-9, 1e-6)


class Unnamed(NamedTuple):
    """Viscous friction that the impact does not know as such."""

    mu: float
    torque_free = True

    def traction(self, slip, angular_velocity):
        return ViscousLaw(self.mu).traction(slip, angular_velocity)

    def coefficients(self, units):
        return ViscousLaw(self.mu).coefficients(units)


@settings(max_examples=examples(check=15, claim=400))
@given(collisions(viscous(), roughest=3.0))
def test_the_closed_form_and_the_general_way_agree(collision):
    state, restitution, top = collision
    exact = impact(state, restitution, top)
    general = impact(state, restitution, top.altered(friction=Unnamed(top.friction.mu)))
    speed = Rigid(state, top).speed
    assert general.impulse == pytest.approx(exact.impulse, rel=1e-6, abs=1e-7 * top.mass * speed)
    assert general.state.velocity == pytest.approx(exact.state.velocity, abs=1e-7 * speed)


class Drilling(NamedTuple):
    """Friction with a torque against drilling, both of them smoothed: it depends on slip and on
    spin.
    """

    mu: float
    radius: float
    eps: float
    torque_free = False

    def traction(self, slip, angular_velocity):
        drill = self.radius * angular_velocity[2]
        factor = -self.mu * (slip[0] ** 2 + slip[1] ** 2 + drill**2 + self.eps**2) ** -0.5
        return Traction(
            (factor * slip[0], factor * slip[1]), (0.0, 0.0, factor * drill * self.radius)
        )

    def coefficients(self, units):
        return (self.mu, self.radius / units.length, self.eps / units.speed)


@pytest.mark.parametrize("restitution", [0.0, 0.7])
@pytest.mark.parametrize("spin", [1e-4, 5e-4])
def test_a_law_with_torque_against_integration(spin, restitution):
    top = Top.of(0.02, 3.0e-6, 3.3e-6, SphereSurface(0.02, 0.006), Drilling(0.3, 0.002, 0.02), 9.8)
    state = State((0.6, 0.0, 0.8), (0.0, 1e-5, spin), (0.3, 0.1, -0.5), 0.02)
    result, end = check_against_integration(state, restitution, top, "DOP853", 1e-12, 1e-7)
    rigid = Rigid(state, top)
    turned = np.array(result.state.momentum) - rigid.momentum
    assert turned == pytest.approx(np.cross(rigid.arm, end[3:6]) + end[6:9], rel=1e-6, abs=1e-10)
    assert abs(end[8]) > 1e-8
    assert result.energy_lost == pytest.approx(
        kinetic_energy_lost(state, result.state, top), rel=1e-10
    )


class SteadyDrilling(NamedTuple):
    """Steep Coulomb friction and a torque against drilling whose size is given."""

    mu: float
    eps: float
    lever: float
    torque_free = False

    def traction(self, slip, angular_velocity):
        force = RegularizedCoulombLaw(self.mu, self.eps).traction(slip, angular_velocity).force
        return Traction(force, (0.0, 0.0, -self.lever))

    def coefficients(self, units):
        return (self.mu, self.eps / units.speed, self.lever / units.length)


@pytest.mark.parametrize("restitution", [0.0, 0.7])
def test_slip_that_is_held_against_a_torque_stays_held(restitution):
    """The body sticks early, with f = -M_tt^-1 (M_tn + what the torque does); drilling goes on."""
    law = SteadyDrilling(0.9, 1e-4, 1e-4)
    top = Top.of(0.02, 3.0e-6, 3.3e-6, SphereSurface(0.02, 0.006), law, 9.8)
    state = State((0.6, 0.0, 0.8), (0.0, 1e-5, 2e-4), (0.1, 0.1, -0.5), 0.02)
    result, end = check_against_integration(state, restitution, top, "Radau", 1e-9, 1e-6)
    rigid = Rigid(state, top)
    torque = rigid.inverse_inertia @ np.array([0.0, 0.0, -1e-4])
    pull = (rigid.delassus[:, 2] + np.cross(torque, rigid.arm))[:2]
    holding = -np.linalg.solve(rigid.delassus[:2, :2], pull)
    assert top.friction.traction((end[0], end[1]), (0.0, 0.0, 1.0)).force == pytest.approx(
        holding, abs=1e-3
    )
    turned = np.array(result.state.momentum) - rigid.momentum
    impulse = top.mass * (np.array(result.state.velocity) - np.array(state.velocity))
    angular_impulse = np.array([0.0, 0.0, -1e-4 * result.impulse])
    assert turned == pytest.approx(
        np.cross(rigid.arm, impulse) + angular_impulse, rel=1e-9, abs=1e-15
    )
    assert result.energy_lost == pytest.approx(
        kinetic_energy_lost(state, result.state, top), rel=1e-10
    )


# Painleve's paradox and Poisson's hypothesis
# ---------------------------------------------------------------


def jammed(law):
    """A slender egg on its side edge that slides into its own lean: friction presses it onto the
    table.
    """
    shape = SpheroidSurface(0.01, 0.03)
    top = Top.of(0.02, 3.0e-7, 3.0e-7, shape, law, 9.8)
    axis = (math.sin(0.5), 0.0, math.cos(0.5))
    arm = np.array(contact_vector(axis, shape))
    slip = math.copysign(1.0, arm[0] * arm[2])
    return State(axis, (0.0,) * 3, (-slip, 0.0, 0.0), 0.02), top


@pytest.mark.parametrize("law", [ViscousLaw(3.0), RegularizedCoulombLaw(2.0, 1e-4)])
@pytest.mark.parametrize("approach", [0.0, 1e-17, -1e-17, -1e-3])
def test_a_jam_is_an_impact_even_without_approach(law, approach):
    """The normal velocity sinks before it rises; the impact ends when it is zero again, with energy
    lost.
    """
    state, top = jammed(law)
    state = state._replace(velocity=(state.velocity[0], 0.0, approach))
    rigid = Rigid(state, top)
    force = law.traction((state.velocity[0], 0.0), (0.0,) * 3).force
    assert rigid.delassus[2, 2] + force[0] * rigid.delassus[2, 0] < 0.0
    result, _ = check_against_integration(state, 0.0, top, "Radau", 1e-9, 1e-6)
    assert result.impulse > 0.01 * top.mass * 1.0
    assert result.energy_lost > 0.0
    assert gap_rate(result.state, top) == pytest.approx(0.0, abs=1e-13)


def test_restitution_ends_before_it_gives_back_more_than_compression_took():
    """Slip that ends with compression: from S to S' > S goes the slope of v_n, and Poisson would
    gain energy.

    Compression takes S p_c^2 / 2, restitution over q gives S' q^2 / 2: it must end at q = p_c (S /
    S')^1/2.
    """
    mu, slip = 0.9, 0.3
    law = RegularizedCoulombLaw(mu, 1e-6)
    delassus = Rigid(*planar(slip, -1.0, law)).delassus
    m_tt, m_tn, m_nn = delassus[0, 0], delassus[0, 2], delassus[2, 2]
    sliding, sticking = m_nn - mu * m_tn, m_nn - m_tn**2 / m_tt
    compression = slip / (mu * m_tt - m_tn)
    assert 0.0 < sliding < 0.9 * sticking
    state, top = planar(slip, -sliding * compression, law)
    result, end = check_against_integration(state, 1.0, top, "Radau", 1e-9, 1e-6)
    assert result.compression == pytest.approx(compression, rel=1e-4)
    assert result.impulse == pytest.approx(
        compression * (1.0 + math.sqrt(sliding / sticking)), rel=1e-4
    )
    assert end[9] == pytest.approx(0.0, abs=1e-6 * result.impulse)
    sooner = impact(state, 0.5, top)
    assert sooner.impulse == pytest.approx(1.5 * sooner.compression, rel=1e-12)
