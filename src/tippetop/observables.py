"""What is read off a run: the report's variables, forces and invariants at every sample."""

import numpy as np
from numpy.typing import NDArray

from tippetop.integrators.base import Array
from tippetop.mechanics.invariants import energy, jellett
from tippetop.mechanics.motion import along_table, angular_velocity, axial_spin, contact, point_velocity
from tippetop.mechanics.state import State
from tippetop.mechanics.surface import contact_vector
from tippetop.mechanics.top import Top
from tippetop.mechanics.units import Units
from tippetop.mechanics.view import axis_sine, precession_rate, slip_along_tilt, tilt_rate


def si_factors(units: Units) -> Array:
    """The SI values of the units of the 16 numbers of a state."""
    vectors = (1.0, units.angular_momentum, units.speed, units.length, 1.0)
    return np.array([*np.repeat(vectors, 3), units.energy])


def in_si(states: Array, units: Units) -> State:
    """The states of a run, shape (k, 16) in natural units, as arrays of shape (k,) in SI."""
    return State.unpack(tuple((states * si_factors(units)).T))


def observe(state: State, touching: NDArray[np.bool_], top: Top) -> dict[str, Array]:
    """Every variable of a result but the phase, by name.

    Parameters
    ----------
    state
        States in SI, each number an array of shape (k,).
    touching
        Where the top is in contact with the table, shape (k,).
    top
        The body and the table, SI.
    """
    axis, momentum = state.axis, state.momentum
    sliding = along_table(state)
    omega = angular_velocity(axis, momentum, top)
    arm = contact_vector(axis, top.surface)
    point = point_velocity(state.velocity, omega, arm)
    touch = contact(axis, momentum, sliding.velocity, top)
    sine = axis_sine(axis)
    upright = sine == 0.0
    with np.errstate(divide="ignore", invalid="ignore"):
        slip_x, slip_y = slip_along_tilt(axis, (point[0], point[1]))
        precession = precession_rate(axis, momentum, top)
        tilting = tilt_rate(axis, momentum, top)
    if upright.any():
        # Where the axis is vertical it leans nowhere; X is then the space axis x, and theta' the rate at
        # which the axis leaves the pole.
        slip_x, slip_y = np.where(upright, point[0], slip_x), np.where(upright, point[1], slip_y)
        leaving = np.hypot(momentum[0], momentum[1]) / top.transverse_inertia
        tilting = np.where(upright, np.copysign(leaving, axis[2]), tilting)
    return {
        "theta": np.arctan2(sine, axis[2]),
        "theta_dot": tilting,
        "phi": np.arctan2(axis[1], axis[0]),
        "phi_dot": precession,
        "omega3": axial_spin(axis, momentum, top),
        "slip_x": slip_x,
        "slip_y": slip_y,
        "normal_force": np.where(touching, touch.normal_force, 0.0),
        "energy": energy(state, top),
        "work": np.asarray(state.work),
        "jellett": jellett(state, top),
        "height": np.asarray(state.position[2]),
        "gap": state.position[2] + arm[2],
        "x": np.asarray(state.position[0]),
        "y": np.asarray(state.position[1]),
        "axis": np.stack(axis, axis=1),
        "velocity": np.stack(state.velocity, axis=1),
        "angular_momentum": np.stack(momentum, axis=1),
        "orientation": orientation(state),
    }


def orientation(state: State) -> Array:
    """Unit quaternions that turn the body from axis up and marker along x to where it is, shape (k, 4).

    Scalar first, and without jumps of sign from sample to sample.
    """
    axis, marker = np.stack(state.axis, axis=1), np.stack(state.marker, axis=1)
    frames = np.stack((marker, np.cross(axis, marker), axis), axis=2)
    quaternions = _quaternions(frames)
    jumps = np.einsum("ij,ij->i", quaternions[1:], quaternions[:-1]) < 0
    signs = np.concatenate(([1.0], np.cumprod(np.where(jumps, -1.0, 1.0))))
    return np.asarray(quaternions * signs[:, None])


def _quaternions(frames: Array) -> Array:
    """Unit quaternions, scalar first, of rotation matrices of shape (k, 3, 3)."""
    (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = np.moveaxis(frames, 0, 2)
    # Four times the products of every two components; the row of the largest loses no digits.
    products = np.array(
        [
            [1.0 + xx + yy + zz, zy - yz, xz - zx, yx - xy],
            [zy - yz, 1.0 + xx - yy - zz, yx + xy, zx + xz],
            [xz - zx, yx + xy, 1.0 - xx + yy - zz, zy + yz],
            [yx - xy, zx + xz, zy + yz, 1.0 - xx - yy + zz],
        ]
    )
    largest = np.argmax(np.einsum("iik->ik", products), axis=0)
    rows = products[largest, :, np.arange(len(largest))]
    return np.asarray(rows / np.linalg.norm(rows, axis=1, keepdims=True))
