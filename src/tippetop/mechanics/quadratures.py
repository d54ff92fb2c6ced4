"""What follows from the motion and does not move it: place, orientation and the work of friction.

The orientation of a body whose axis is n is the least rotation that takes a pole to n, after a turn
about the axis by an angle psi. The least rotation from a pole is smooth everywhere but at the other
one, so there are two charts, one a pole. With Euler angles, psi is chi + phi in the chart of z, and
chi - phi in that of -z, where the body is first turned over about y. The rate of psi is omega3 less
that of the chart's frame.
"""

from typing import NamedTuple

from tippetop.mechanics.motion import angular_velocity, axial_spin, axis_rate
from tippetop.mechanics.state import State
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Functions, Scalar, Vector, either


class Quadratures(NamedTuple):
    """What the motion is integrated to; as rates, their time derivatives."""

    x: Scalar
    y: Scalar
    """Horizontal position of the centre of mass, m."""
    turn: Scalar
    """Angle psi about the axis in one of the two charts, rad."""
    work: Scalar
    """Work of friction since the start, J."""


def nearer_pole(n_z: Scalar) -> Scalar:
    """Return the pole, 1 (z) or -1 (-z), nearer to an axis of a vertical component n_z: of floats
    and arrays.
    """
    return either(n_z < 0.0, -1.0, 1.0)


def turn_at_launch(azimuth: Scalar, pole: Scalar) -> Scalar:
    """Return psi in the chart of a pole, rad, where chi is zero and the axis has this azimuth."""
    return pole * azimuth


def turn_in_chart(turn: Scalar, azimuth: Scalar, pole: Scalar, opposite: Scalar) -> Scalar:
    """Return psi in the chart of the opposite pole, rad, from that in the chart of `pole`, for the
    axis's azimuth.
    """
    return turn + (opposite - pole) * azimuth


def turn_rate(axis: Vector, momentum: Vector, pole: Scalar, top: Top) -> Scalar:
    """Rate of psi in the chart of a pole (1: z, -1: -z), rad/s."""
    rate = axis_rate(axis, momentum, top)
    area = axis[0] * rate[1] - axis[1] * rate[0]
    return axial_spin(axis, momentum, top) + pole * area / (1.0 + pole * axis[2])


def quadrature_rates(state: State, power: Scalar, pole: Scalar, top: Top) -> Quadratures:
    """Rates of the quadratures, given the power of friction (W) and the chart of psi."""
    turning = turn_rate(state.axis, state.momentum, pole, top)
    return Quadratures(state.velocity[0], state.velocity[1], turning, power)


def resistance_powers(state: State, torque: Vector, top: Top) -> tuple[Scalar, Scalar]:
    """Powers of drilling and of rolling friction, W, for the table's torque, N m."""
    turning = angular_velocity(state.axis, state.momentum, top)
    return torque[2] * turning[2], torque[0] * turning[0] + torque[1] * turning[1]


def orientation(
    axis: Vector, turn: Scalar, pole: Scalar, functions: Functions
) -> tuple[Scalar, ...]:
    """Unit quaternion, scalar first, of a body whose axis is n and whose psi in a chart is `turn`,
    rad.

    It turns the body from axis up, with its marker along x, to where it is.
    """
    cosine, sine = functions.cos(0.5 * turn), functions.sin(0.5 * turn)
    size = (0.5 * (1.0 + pole * axis[2])) ** 0.5
    x, y = 0.5 * axis[0] / size, 0.5 * axis[1] / size
    up = 0.5 * (1.0 + pole)
    down = 1.0 - up
    # The least rotation is (size, -y, x, 0) from z, and (x, 0, size, y) from -z after half a turn
    # about y.
    w, i, j, k = up * size + down * x, -up * y, down * size + up * x, down * y
    return (
        w * cosine - k * sine,
        i * cosine + j * sine,
        j * cosine - i * sine,
        k * cosine + w * sine,
    )
