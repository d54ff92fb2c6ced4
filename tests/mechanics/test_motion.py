"""Motions of a sliding body that are known exactly, and what no sliding can change."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from strategies import numbers, slides, tops
from tippetop.mechanics.laws.friction import ViscousLaw
from tippetop.mechanics.motion import (
    along_table,
    angular_velocity,
    axis_rate,
    on_table,
    point_velocity,
    sliding_contact,
    sliding_rates,
)
from tippetop.mechanics.state import SlidingState
from tippetop.mechanics.vectors import cross, length

AT_REST = (0.0, 0.0)


def normal_force(state, top):
    return sliding_contact(state.axis, state.momentum, state.velocity, top).normal_force


def force_unit(state, top):
    """A force large enough to compare rounding with: weight, and what the spin can do."""
    return top.mass * top.gravity + length(state.momentum) ** 2 / (
        top.transverse_inertia * top.surface.size
    )


def frictionless(top):
    return top.altered(friction=ViscousLaw(0.0))


@st.composite
def vertical_spins(draw):
    """A top that spins about a vertical axis, upright or upside down, while it slides in any
    direction.
    """
    top = draw(tops())
    pole, spin = draw(st.sampled_from([1.0, -1.0])), draw(numbers(-500.0, 500.0))
    velocity = (draw(numbers(-1.0, 1.0)), draw(numbers(-1.0, 1.0)))
    return top, SlidingState((0.0, 0.0, pole), (0.0, 0.0, top.axial_inertia * spin), velocity)


@given(vertical_spins())
def test_the_table_carries_the_weight_of_a_vertical_spin(case):
    top, state = case
    assert normal_force(state, top) == pytest.approx(top.mass * top.gravity, rel=1e-14)


@given(vertical_spins())
def test_a_vertical_spin_in_place_lasts(case):
    """Nothing changes, and friction takes nothing; the body turns at the rate of the spin."""
    top, state = case
    still = state._replace(velocity=AT_REST)
    assert sliding_rates(still, top).pack() == (0.0,) * 8
    touch = sliding_contact(still.axis, still.momentum, still.velocity, top)
    assert touch.power == 0.0
    assert touch.spin == pytest.approx((0.0, 0.0, state.momentum[2] / top.axial_inertia), rel=1e-14)


@given(vertical_spins())
def test_friction_brakes_a_sliding_vertical_spin_and_tips_it_with_the_lever_of_its_height(case):
    """The slip is the velocity; u' = f g, and the moment of the force f N is -h z x f N."""
    top, state = case
    rates = sliding_rates(state, top)
    force = top.friction.traction(state.velocity, (0.0, 0.0, 0.0)).force
    height, weight = top.surface.height(state.axis[2]), top.mass * top.gravity
    assert rates.velocity == pytest.approx(
        (top.gravity * force[0], top.gravity * force[1]), rel=1e-12
    )
    moment = (height * weight * force[1], -height * weight * force[0], 0.0)
    assert rates.momentum == pytest.approx(moment, rel=1e-12, abs=0.0)


@given(slides())
def test_without_friction_nothing_pushes_the_centre_of_mass_sideways(slide):
    top, state = slide
    top = frictionless(top)
    assert sliding_rates(state, top).velocity == (0.0, 0.0)
    assert sliding_contact(state.axis, state.momentum, state.velocity, top).power == 0.0


@given(slides())
def test_the_contact_point_does_not_leave_or_enter_the_table(slide):
    """Its velocity is the slip: horizontal."""
    top, state = slide
    whole = on_table(state, top)
    touch = sliding_contact(state.axis, state.momentum, state.velocity, top)
    omega = angular_velocity(state.axis, state.momentum, top)
    velocity = point_velocity(whole.velocity, omega, touch.arm)
    fastest = length(whole.velocity) + length(omega) * length(touch.arm)
    assert velocity == pytest.approx((*touch.slip, 0.0), abs=1e-13 * fastest)
    assert whole.height + touch.arm[2] == pytest.approx(0.0, abs=1e-16)


@given(slides())
def test_the_normal_force_is_what_accelerates_the_centre_of_mass_along_its_support(slide):
    """m (z'' + g) = N, with z = h(c(t)) differentiated twice along the motion by finite steps."""
    top, state = slide
    rates = sliding_rates(state, top)
    omega = angular_velocity(state.axis, state.momentum, top)
    quickest = length(omega) + math.sqrt(top.gravity / top.surface.size)
    quickest += (
        length(rates.momentum) * quickest / (length(state.momentum) + top.axial_inertia * quickest)
    )
    step = 1e-5 / quickest

    def sinking(side):
        moved = [y + side * step * rate for y, rate in zip(state.pack(), rates.pack(), strict=True)]
        return on_table(SlidingState.unpack(moved), top).velocity[2]

    acceleration = (sinking(1.0) - sinking(-1.0)) / (2.0 * step)
    unit = force_unit(state, top) + abs(normal_force(state, top))
    assert top.mass * (acceleration + top.gravity) == pytest.approx(
        normal_force(state, top), abs=1e-6 * unit
    )


@given(slides(), numbers(-math.pi, math.pi))
def test_motion_does_not_know_where_north_is(slide, turn):
    top, state = slide
    cosine, sine = math.cos(turn), math.sin(turn)

    def turned(vector):
        x, y, *z = vector
        return (cosine * x - sine * y, sine * x + cosine * y, *z)

    def all_turned(a):
        return SlidingState(*map(turned, a))

    assert_same_rates(
        sliding_rates(all_turned(state), top), all_turned(sliding_rates(state, top)), state, top
    )


@given(slides())
def test_motion_does_not_know_left_from_right(slide):
    """In a mirror the angular momentum, an axial vector, turns the other way round."""
    top, state = slide

    def polar(vector):
        x, y, *z = vector
        return (x, -y, *z)

    def mirrored(a):
        x, y, z = a.momentum
        return SlidingState(polar(a.axis), (-x, y, -z), polar(a.velocity))

    assert_same_rates(
        sliding_rates(mirrored(state), top), mirrored(sliding_rates(state, top)), state, top
    )


def assert_same_rates(actual, expected, state, top):
    """Equal to rounding of the largest forces and velocities in them."""
    touch = sliding_contact(state.axis, state.momentum, state.velocity, top)
    rubbing = length((*touch.traction.force, 0.0))
    force = force_unit(state, top) + abs(touch.normal_force) * (1.0 + rubbing)
    omega = length(angular_velocity(state.axis, state.momentum, top))
    scales = SlidingState(omega, force * top.surface.size, force / top.mass)
    for a, b, scale in zip(actual, expected, scales, strict=True):
        assert a == pytest.approx(b, abs=1e-11 * scale)


@given(slides())
def test_the_sliding_part_of_a_body_on_the_table_is_what_it_was_made_from(slide):
    top, state = slide
    assert along_table(on_table(state, top)) == state


@given(slides())
def test_the_axis_turns_with_the_body(slide):
    """n' = omega x n."""
    top, state = slide
    omega = angular_velocity(state.axis, state.momentum, top)
    turning = axis_rate(state.axis, state.momentum, top)
    assert turning == pytest.approx(cross(omega, state.axis), abs=1e-13 * length(omega))
