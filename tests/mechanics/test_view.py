"""Euler angles as a view of the state: what they mean, and that nothing is lost on the way there
and back.
"""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from strategies import angles, numbers, slides, tops, unit_vectors
from tippetop.mechanics import view
from tippetop.mechanics.laws.friction import ViscousLaw
from tippetop.mechanics.motion import angular_velocity, axial_spin, axis_rate, sliding_contact
from tippetop.mechanics.surfaces.surface import SphereSurface
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import cross, dot, length
from tippetop.mechanics.view import Angles, state_from_angles


def angles_of(state, top):
    """The Euler angles of a sliding state, by the functions of the view."""
    axis, momentum = state.axis, state.momentum
    return Angles(
        tilt=math.atan2(view.axis_sine(axis), axis[2]),
        tilt_rate=view.tilt_rate(axis, momentum, top),
        azimuth=math.atan2(axis[1], axis[0]),
        precession=view.precession_rate(axis, momentum, top),
        spin=axial_spin(axis, momentum, top),
        slip=view.slip_along_tilt(axis, sliding_contact(axis, momentum, state.velocity, top).slip),
    )


def close(actual, expected, tolerance):
    return actual == pytest.approx(expected, rel=1e-12, abs=tolerance)


@st.composite
def launches(draw, tilts):
    """A top, and a motion of it at one of these tilts."""
    top = draw(tops())
    return top, draw(angles(top))._replace(tilt=draw(tilts))


SMALL_TOP = Top.of(0.02, 3.0e-6, 3.2e-6, SphereSurface(0.02, 0.006), ViscousLaw(0.3), 9.8)
POLES = (1e-9, 1e-5, 0.01, math.pi - 0.01, math.pi - 1e-5, math.pi - 1e-9)


@given(launches(st.one_of(st.sampled_from(POLES), numbers(0.01, math.pi - 0.01))))
def test_angles_survive_the_way_to_the_state_and_back(launch):
    """Rates at rounding of the fastest of them; what rounding does to a precession grows as
    1/sin(theta).
    """
    top, given_angles = launch
    back = angles_of(state_from_angles(given_angles, top, math), top)
    sine = math.sin(given_angles.tilt)
    fastest = max(map(abs, (given_angles.tilt_rate, given_angles.precession, given_angles.spin)))
    swing = (
        abs(given_angles.tilt_rate) + (abs(given_angles.precession) + abs(given_angles.spin)) * sine
    )
    reach = 2.0 * max(map(top.surface.height, (-1.0, 0.0, 1.0)))
    assert back.tilt == pytest.approx(given_angles.tilt, rel=1e-14)
    assert close(back.azimuth, given_angles.azimuth, 1e-14)
    assert close(
        back.tilt_rate,
        given_angles.tilt_rate,
        1e-14 * (fastest * sine + abs(given_angles.tilt_rate)),
    )
    assert close(
        back.precession,
        given_angles.precession,
        1e-14 * (fastest + abs(given_angles.tilt_rate) / sine),
    )
    assert close(back.spin, given_angles.spin, 1e-14 * fastest)
    assert close(
        back.slip[0], given_angles.slip[0], 1e-13 * (reach * swing + math.hypot(*given_angles.slip))
    )
    assert close(
        back.slip[1], given_angles.slip[1], 1e-13 * (reach * swing + math.hypot(*given_angles.slip))
    )


@pytest.mark.parametrize("tilt", POLES)
def test_precession_close_to_the_vertical_is_as_precise_as_the_spin(tilt):
    """At 1e-9 rad the difference L_z - I3 omega3 c taken directly would miss by 1e4 rad/s."""
    for azimuth in (-2.0, 0.3, 1.0):
        launch = Angles(tilt, 0.0, azimuth, precession=3.0, spin=155.0, slip=(0.0, 0.0))
        state = state_from_angles(launch, SMALL_TOP, math)
        assert view.precession_rate(state.axis, state.momentum, SMALL_TOP) == pytest.approx(
            3.0, abs=1e-12
        )


@given(launches(numbers(0.01, math.pi - 0.01)))
def test_angles_are_what_they_say(launch):
    """Tilt and azimuth of the axis, their rates as it moves, and the spin about it."""
    top, given_angles = launch
    state = state_from_angles(given_angles, top, math)
    tilt, azimuth = given_angles.tilt, given_angles.azimuth
    axis = (math.sin(tilt) * math.cos(azimuth), math.sin(tilt) * math.sin(azimuth), math.cos(tilt))
    assert state.axis == pytest.approx(axis, abs=1e-15)
    towards = np.array(
        [math.cos(tilt) * math.cos(azimuth), math.cos(tilt) * math.sin(azimuth), -math.sin(tilt)]
    )
    around = np.array([-math.sin(azimuth), math.cos(azimuth), 0.0])
    expected = given_angles.tilt_rate * towards + given_angles.precession * math.sin(tilt) * around
    fastest = max(map(abs, (given_angles.tilt_rate, given_angles.precession, given_angles.spin)))
    assert axis_rate(state.axis, state.momentum, top) == pytest.approx(
        expected, abs=1e-13 * fastest
    )
    omega = angular_velocity(state.axis, state.momentum, top)
    assert dot(omega, state.axis) == pytest.approx(given_angles.spin, abs=1e-13 * fastest)
    inclined = np.array([math.cos(azimuth), math.sin(azimuth), 0.0])
    slip = given_angles.slip[0] * inclined + given_angles.slip[1] * around
    touch = sliding_contact(state.axis, state.momentum, state.velocity, top)
    reach = 2.0 * max(map(top.surface.height, (-1.0, 0.0, 1.0)))
    assert touch.slip == pytest.approx(
        slip[:2], abs=1e-13 * (reach * fastest + math.hypot(*given_angles.slip))
    )


@given(slides())
def test_momentum_is_inertia_times_angular_velocity(slide):
    top, state = slide
    omega = angular_velocity(state.axis, state.momentum, top)
    along = dot(omega, state.axis)
    difference = (top.axial_inertia - top.transverse_inertia) * along
    momentum = [
        top.transverse_inertia * w + difference * n for w, n in zip(omega, state.axis, strict=True)
    ]
    assert momentum == pytest.approx(state.momentum, rel=1e-12, abs=1e-13 * length(state.momentum))
    assert axial_spin(state.axis, state.momentum, top) == pytest.approx(
        along, abs=1e-13 * length(omega)
    )


@given(unit_vectors(shortest_sine=1e-9), numbers(-1.0, 1.0), numbers(-1.0, 1.0))
def test_slip_along_the_tilt_keeps_its_size_and_turns_with_the_axis(axis, slip_x, slip_y):
    assume(math.hypot(slip_x, slip_y) > 1e-6)
    along, across = view.slip_along_tilt(axis, (slip_x, slip_y))
    azimuth = math.atan2(axis[1], axis[0])
    assert math.hypot(along, across) == pytest.approx(math.hypot(slip_x, slip_y), rel=1e-13)
    turned = complex(along, across) * complex(math.cos(azimuth), math.sin(azimuth))
    assert abs(turned - complex(slip_x, slip_y)) < 1e-13 * abs(turned)


@given(slides())
def test_precession_is_the_rate_of_the_azimuth_of_the_axis(slide):
    """phi' = (n x n')_z / sin(theta)^2, and theta' = -c' / sin(theta)."""
    top, state = slide
    sine = view.axis_sine(state.axis)
    assume(sine > 1e-3)
    moving = axis_rate(state.axis, state.momentum, top)
    fastest = length(state.momentum) / top.transverse_inertia
    precession = view.precession_rate(state.axis, state.momentum, top)
    assert precession * sine**2 == pytest.approx(cross(state.axis, moving)[2], abs=1e-12 * fastest)
    assert -view.tilt_rate(state.axis, state.momentum, top) * sine == pytest.approx(
        moving[2], abs=1e-13 * fastest
    )
