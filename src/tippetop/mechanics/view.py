"""The report's variables as a view of the state: singular where the axis is vertical, and only
there.

With X the horizontal direction into which the axis leans, Y = z x X, 3 = n, 2 = Y and 1 = 2 x 3,
the angular velocity is -phi' sin(theta) 1 + theta' 2 + omega3 3, where theta is the tilt and phi
the azimuth of the axis.
"""

import math
from typing import NamedTuple

from tippetop.mechanics.state import SlidingState
from tippetop.mechanics.surfaces.surface import contact_vector
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Functions, Horizontal, Scalar, Vector, add, cross, scale


class Angles(NamedTuple):
    """The state of a sliding body in Euler angles."""

    tilt: Scalar
    tilt_rate: Scalar
    """theta, rad, and theta', rad/s."""
    azimuth: Scalar
    precession: Scalar
    """phi, rad, and phi', rad/s."""
    spin: Scalar
    """Axial spin omega3, rad/s."""
    slip: Horizontal
    """Slip velocity along X and Y, m/s."""


def axis_sine(axis: Vector) -> Scalar:
    """Sine of the tilt, from the horizontal part of the axis: accurate near the poles."""
    return (axis[0] ** 2 + axis[1] ** 2) ** 0.5


def precession_rate(axis: Vector, momentum: Vector, top: Top) -> Scalar:
    """Precession phi' = (L_z - I3 omega3 c) / (I1 sin^2 theta), rad/s, from the horizontal parts
    alone.

    L_z - (L.n) n_z = L_z s^2 - n_z (L_x n_x + L_y n_y), which does not cancel near the poles.
    """
    sine_squared = axis[0] ** 2 + axis[1] ** 2
    leaning = momentum[0] * axis[0] + momentum[1] * axis[1]
    return (momentum[2] - axis[2] * leaning / sine_squared) / top.transverse_inertia


def tilt_rate(axis: Vector, momentum: Vector, top: Top) -> Scalar:
    """Rate of the tilt theta' = (n_x n_x' + n_y n_y') / (sin(theta) cos(theta)) = L.Y / I1,
    rad/s.
    """
    return (momentum[1] * axis[0] - momentum[0] * axis[1]) / (
        axis_sine(axis) * top.transverse_inertia
    )


def slip_along_tilt(axis: Vector, slip: Horizontal) -> Horizontal:
    """Slip velocity along X, into which the axis leans, and Y = z x X, m/s."""
    sine = axis_sine(axis)
    return (
        (slip[0] * axis[0] + slip[1] * axis[1]) / sine,
        (slip[1] * axis[0] - slip[0] * axis[1]) / sine,
    )


class PoleExact(NamedTuple):
    """Sine and cosine with sin(pi) = 0, so that a launch at tilt pi is exactly vertical."""

    functions: Functions
    """Where sin and cos come from: `math` for floats, `numpy` for arrays."""

    def sin(self, angle: Scalar) -> Scalar:
        """Sine of an angle in radians, zero at the floating-point numbers nearest to pi and -pi."""
        return self.functions.sin(angle) * (abs(angle) != math.pi)

    def cos(self, angle: Scalar) -> Scalar:
        """Cosine of an angle in radians."""
        return self.functions.cos(angle)


def state_from_angles(angles: Angles, top: Top, functions: Functions) -> SlidingState:
    """Return the state of a sliding body from Euler angles.

    Parameters
    ----------
    angles
        Tilt, azimuth, their rates, axial spin and slip.
    top
        The body.
    functions
        Where sin and cos come from: `math`, `numpy`, `sympy`, ...
    """
    sin_tilt, cos_tilt = functions.sin(angles.tilt), functions.cos(angles.tilt)
    sin_azimuth, cos_azimuth = functions.sin(angles.azimuth), functions.cos(angles.azimuth)
    axis = (sin_tilt * cos_azimuth, sin_tilt * sin_azimuth, cos_tilt)
    second = (-sin_azimuth, cos_azimuth, 0.0)
    first = cross(second, axis)
    across = add(scale(-angles.precession * sin_tilt, first), scale(angles.tilt_rate, second))
    omega = add(across, scale(angles.spin, axis))
    # I1 omega + (I3 - I1) omega3 n would lose the axial part where I1 is many times I3.
    momentum = add(
        scale(top.transverse_inertia, across), scale(top.axial_inertia * angles.spin, axis)
    )
    swing = cross(omega, contact_vector(axis, top.surface))
    velocity = (
        angles.slip[0] * cos_azimuth - angles.slip[1] * sin_azimuth - swing[0],
        angles.slip[0] * sin_azimuth + angles.slip[1] * cos_azimuth - swing[1],
    )
    return SlidingState(axis, momentum, velocity)
