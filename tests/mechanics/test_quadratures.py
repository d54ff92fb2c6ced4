"""Orientation and place as quadratures: against the angular velocity, and a marker moved with the
body.
"""

import cmath
import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from strategies import numbers, slides, unit_vectors
from tippetop.mechanics.laws.friction import ViscousLaw
from tippetop.mechanics.motion import angular_velocity, on_table, sliding_contact, sliding_rates
from tippetop.mechanics.quadratures import orientation, quadrature_rates, turn_rate
from tippetop.mechanics.state import SlidingState
from tippetop.mechanics.surfaces.surface import SphereSurface, SpheroidSurface
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import length
from tippetop.mechanics.view import Angles, state_from_angles

POLES = st.sampled_from([1.0, -1.0])
TURNS = numbers(-20.0, 20.0)
NEAREST = 0.02
"""How near 1 + pole n_z comes to zero in these tests: charts are changed at 1."""


def rotation(axis, turn, pole):
    """The rotation that a body with this axis and angle has made."""
    return Rotation.from_quat(orientation(axis, turn, pole, math), scalar_first=True)


def least_rotation(pole, axis):
    """The rotation by the least angle that takes a pole to an axis, by its axis and angle."""
    normal = np.cross([0.0, 0.0, pole], axis)
    angle = math.atan2(np.linalg.norm(normal), pole * axis[2])
    return Rotation.from_rotvec(angle * normal / (np.linalg.norm(normal) or 1.0))


@given(unit_vectors(), TURNS, POLES)
def test_the_orientation_is_a_unit_quaternion_that_carries_the_vertical_to_the_axis(
    axis, turn, pole
):
    assume(1.0 + pole * axis[2] > NEAREST)
    # Near the other pole rounding of the axis is divided by the square root of 1 + pole n_z.
    fuzz = 4e-16 + 4e-16 / (1.0 + pole * axis[2])
    assert np.linalg.norm(orientation(axis, turn, pole, math)) == pytest.approx(1.0, abs=fuzz)
    assert rotation(axis, turn, pole).apply([0.0, 0.0, 1.0]) == pytest.approx(axis, abs=4.0 * fuzz)


@given(unit_vectors(), TURNS, POLES)
def test_the_orientation_is_a_turn_about_the_axis_and_the_least_rotation_from_the_pole(
    axis, turn, pole
):
    assume(1.0 + pole * axis[2] > NEAREST)
    over = Rotation.identity() if pole > 0 else Rotation.from_rotvec([0.0, math.pi, 0.0])
    expected = least_rotation(pole, axis) * over * Rotation.from_rotvec([0.0, 0.0, turn])
    fuzz = 1e-14 / (1.0 + pole * axis[2])
    assert rotation(axis, turn, pole).as_matrix() == pytest.approx(expected.as_matrix(), abs=fuzz)


@given(unit_vectors(shortest_sine=0.2), TURNS)
def test_the_charts_agree_where_both_are_good(axis, turn):
    """chi + phi in one is chi - phi in the other."""
    azimuth = math.atan2(axis[1], axis[0])
    upper, lower = rotation(axis, turn, 1.0), rotation(axis, turn - 2.0 * azimuth, -1.0)
    assert upper.as_matrix() == pytest.approx(lower.as_matrix(), abs=1e-13)


@given(numbers(0.0, math.pi), numbers(-3.0, 3.0), numbers(-3.0, 3.0), POLES)
def test_the_turn_is_the_sum_or_difference_of_eulers_angles(tilt, azimuth, own, pole):
    axis = (math.sin(tilt) * math.cos(azimuth), math.sin(tilt) * math.sin(azimuth), math.cos(tilt))
    assume(1.0 + pole * axis[2] > NEAREST)
    expected = Rotation.from_euler("ZYZ", [azimuth, tilt, own]).as_matrix()
    found = rotation(axis, own + pole * azimuth, pole).as_matrix()
    assert found == pytest.approx(expected, abs=1e-14 / (1.0 + pole * axis[2]))


@given(slides(), TURNS, POLES)
def test_the_orientation_changes_by_the_angular_velocity(slide, turn, pole):
    """2 q' q* is the angular velocity, with q' by a complex step along the motion."""
    top, state = slide
    near = 1.0 + pole * state.axis[2]
    assume(near > NEAREST)
    turning = sliding_rates(state, top).axis
    rate = turn_rate(state.axis, state.momentum, pole, top)
    axis = tuple(n + 1e-30j * r for n, r in zip(state.axis, turning, strict=True))
    moved = np.array(orientation(axis, turn + 1e-30j * rate, pole, cmath))
    (w, *v), (w_rate, *v_rate) = moved.real, moved.imag / 1e-30
    v, v_rate = np.array(v), np.array(v_rate)
    twice = 2.0 * (w * v_rate - w_rate * v - np.cross(v_rate, v))
    omega = angular_velocity(state.axis, state.momentum, top)
    assert twice == pytest.approx(omega, abs=1e-13 * (length(omega) + abs(rate)) / near)
    assert w * w_rate + v @ v_rate == pytest.approx(
        0.0, abs=1e-13 * (length(omega) + abs(rate)) / near
    )


SPHERE = Top.of(0.02, 3.0e-6, 3.2e-6, SphereSurface(0.02, 0.006), ViscousLaw(0.3), 9.8)
EGG = Top.of(0.02, 3.0e-6, 2.5e-6, SpheroidSurface(0.02, 0.028), ViscousLaw(0.3), 9.8)


FALLING = Angles(1.5, 60.0, 0.5, 30.0, 60.0, (0.1, -0.2))
RISING = Angles(1.65, -60.0, -2.0, -40.0, 50.0, (0.0, 0.3))


@pytest.mark.parametrize(
    ("top", "motion"),
    [
        pytest.param(SPHERE, FALLING, id="sphere-falling"),
        pytest.param(SPHERE, RISING, marks=pytest.mark.slow, id="sphere-rising"),
        pytest.param(EGG, FALLING, marks=pytest.mark.slow, id="egg-falling"),
        pytest.param(EGG, RISING, id="egg-rising"),
    ],
)
def test_both_charts_follow_a_marker_that_moves_with_the_body(top, motion):
    """Against k' = omega x k, through the equator and several turns; place and work are integrals
    too.
    """
    start = state_from_angles(motion, top, math)
    poles = (1.0, -1.0)

    def rates(_, y):
        state = SlidingState.unpack(y[:8].tolist())
        omega = angular_velocity(state.axis, state.momentum, top)
        power = sliding_contact(state.axis, state.momentum, state.velocity, top).power
        x, y_, _, work = quadrature_rates(on_table(state, top), power, 1.0, top)
        assert (x, y_, work) == (*state.velocity, power)
        turns = [turn_rate(state.axis, state.momentum, pole, top) for pole in poles]
        return [*sliding_rates(state, top).pack(), *np.cross(omega, y[8:11]), *turns]

    marker = Rotation.from_euler("ZYZ", [motion.azimuth, motion.tilt, 0.0]).apply([1.0, 0.0, 0.0])
    begin = [*start.pack(), *marker, *(pole * motion.azimuth for pole in poles)]
    size = np.array([1.0] * 3 + [1e-4] * 3 + [0.1] * 2 + [1.0] * 5)
    run = solve_ivp(rates, (0.0, 0.15), begin, method="DOP853", rtol=1e-12, atol=1e-12 * size)
    tips = run.y[2]
    assert tips.min() < -0.05 < 0.05 < tips.max()
    for pole, turns in zip(poles, run.y[11:], strict=True):
        # Where the axis has come too near the other pole, the angle is lost for good.
        good = np.minimum.accumulate(1.0 + pole * tips) > 0.2
        assert np.ptp(np.sign(tips[good])) == 2.0
        for y, turn in zip(run.y.T[good], turns[good], strict=True):
            found = rotation(tuple(y[:3]), turn, pole).apply([1.0, 0.0, 0.0])
            assert found == pytest.approx(y[8:11], abs=1e-9)
