"""Energy, Jellett's integral and the power of friction: their meaning, and what cannot change
them.
"""

import math
from typing import NamedTuple

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from strategies import slides, spheres, tops
from tippetop.mechanics.invariants import energy, jellett
from tippetop.mechanics.laws.friction import NO_TORQUE, Traction, ViscousLaw
from tippetop.mechanics.motion import angular_velocity, on_table, sliding_contact, sliding_rates
from tippetop.mechanics.state import SlidingState
from tippetop.mechanics.surfaces.surface import SphereSurface
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Vector, dot, length
from tippetop.mechanics.view import Angles, state_from_angles


def rate_along_motion(quantity, state, top):
    """Rate of a quantity of state and top, by a complex step along the motion."""
    rates = sliding_rates(state, top)
    moved = SlidingState.unpack(
        [y + 1e-30j * r for y, r in zip(state.pack(), rates.pack(), strict=True)]
    )
    return complex(quantity(on_table(moved, top), top)).imag / 1e-30


def normal_force(state, top):
    return sliding_contact(state.axis, state.momentum, state.velocity, top).normal_force


@given(slides())
def test_friction_takes_energy_while_the_table_pushes_and_gives_it_while_the_table_pulls(slide):
    """A bilateral contact that is let pull turns friction into a source of energy."""
    top, state = slide
    touch = sliding_contact(state.axis, state.momentum, state.velocity, top)
    assert touch.power <= 0.0 if touch.normal_force >= 0.0 else touch.power >= 0.0


@given(slides())
def test_the_power_is_that_of_the_contact_force_and_the_change_of_energy(slide):
    """dE/dt, E' by a complex step along the motion, and F.v + M.omega of the body's point of
    contact.
    """
    top, state = slide
    touch = sliding_contact(state.axis, state.momentum, state.velocity, top)
    unit = abs(touch.normal_force) * (
        length((*touch.slip, 0.0)) + top.surface.size * length(touch.spin)
    )
    force = dot(touch.force, (*touch.slip, 0.0)) + dot(touch.torque, touch.spin)
    assert touch.power == pytest.approx(force, abs=1e-13 * unit)
    unit += top.mass * top.gravity * top.surface.size * length(touch.spin)
    unit += length(state.momentum) * length(touch.spin) ** 2
    assert touch.power == pytest.approx(rate_along_motion(energy, state, top), abs=1e-12 * unit)


def test_a_fast_tilted_spin_would_have_to_be_pulled_down():
    """Energy gain does occur: at 45 degrees and 300 rad/s, precessing at 100 rad/s and slipping."""
    top = Top.of(0.02, 3.0e-6, 3.2e-6, SphereSurface(0.02, 0.006), ViscousLaw(0.3), 9.8)
    state = state_from_angles(Angles(math.pi / 4, 0.0, 0.0, 100.0, 300.0, (0.0, 0.1)), top, math)
    assert normal_force(state, top) < 0.0
    assert sliding_contact(state.axis, state.momentum, state.velocity, top).power > 0.0


@given(slides())
def test_energy_is_the_sum_over_six_point_masses_that_make_up_the_body(slide):
    """Pairs of masses on the three principal axes have any inertia that a body can have."""
    top, state = slide
    assume(2.0 * top.transverse_inertia > 1.0001 * top.axial_inertia)
    whole = on_table(state, top)
    omega = angular_velocity(state.axis, state.momentum, top)
    third = np.array(state.axis)
    across_axis = np.cross(third, np.eye(3)[np.argmin(np.abs(third))])
    first = across_axis / np.linalg.norm(across_axis)
    second = np.cross(third, first)
    mass = top.mass / 6.0
    across = math.sqrt(top.axial_inertia / (4.0 * mass))
    along = math.sqrt((top.transverse_inertia - top.axial_inertia / 2.0) / (2.0 * mass))
    total = 0.0
    for arm in (across * first, across * second, along * third):
        for side in (1.0, -1.0):
            velocity = np.array(whole.velocity) + np.cross(omega, side * arm)
            height = whole.height + side * arm[2]
            total += 0.5 * mass * velocity @ velocity + mass * top.gravity * height
    assert energy(whole, top) == pytest.approx(total, rel=1e-12)


@given(slides(tops(shapes=spheres())))
def test_jelletts_integral_is_the_angular_momentum_against_the_contact_vector(slide):
    """For the eccentric sphere lambda = R (L_z - alpha L.n)."""
    top, state = slide
    radius, center = top.surface
    alpha = center / radius
    expected = radius * (state.momentum[2] - alpha * dot(state.momentum, state.axis))
    assert jellett(on_table(state, top), top) == pytest.approx(
        expected, abs=1e-14 * radius * length(state.momentum)
    )


class SteadyTorque(NamedTuple):
    """A torque that the table exerts on whatever slides on it, per unit normal force."""

    torque: Vector

    @property
    def torque_free(self):
        return self.torque == NO_TORQUE

    def traction(self, slip, angular_velocity):
        return Traction((-slip[0], -slip[1]), self.torque)


@given(slides(), st.sampled_from([NO_TORQUE, (0.0, 0.0, 1e-3), (2e-3, -1e-3, 0.0)]), st.booleans())
def test_a_top_conserves_jelletts_integral_where_its_body_and_its_friction_say_so(
    slide, torque, acts
):
    top, state = slide
    top = top.altered(friction=SteadyTorque(torque)) if acts else top
    moment = (abs(normal_force(state, top)) + top.mass * top.gravity) * top.surface.size
    turning = length(state.momentum) ** 2 / top.transverse_inertia
    unit = (moment + turning) * top.surface.size
    rate = rate_along_motion(jellett, state, top)
    if top.conserves_jellett:
        assert rate == pytest.approx(0.0, abs=1e-12 * unit)
    assert top.conserves_jellett == (top.surface.spherical and (not acts or torque == NO_TORQUE))


def test_drilling_takes_from_jelletts_integral_at_the_rate_of_its_moment_times_the_height():
    top = Top.of(
        0.02, 3.0e-6, 3.2e-6, SphereSurface(0.02, 0.006), SteadyTorque((0.0, 0.0, -1e-3)), 9.8
    )
    state = state_from_angles(Angles(0.7, 0.0, 0.0, 5.0, 100.0, (0.0, 0.1)), top, math)
    moment = 1e-3 * normal_force(state, top)
    assert rate_along_motion(jellett, state, top) == pytest.approx(
        -moment * top.surface.height(math.cos(0.7)), rel=1e-10
    )


@given(slides())
def test_without_friction_the_vertical_and_the_axial_angular_momentum_are_constant(slide):
    top, state = slide
    rates = sliding_rates(state, top.altered(friction=ViscousLaw(0.0)))
    turning = dot(state.momentum, rates.axis)
    axial = dot(rates.momentum, state.axis) + turning
    moment = (abs(normal_force(state, top)) + top.mass * top.gravity) * top.surface.size
    assert rates.momentum[2] == pytest.approx(0.0, abs=1e-13 * moment)
    assert axial == pytest.approx(
        0.0, abs=1e-12 * (moment + length(state.momentum) * length(rates.axis))
    )
