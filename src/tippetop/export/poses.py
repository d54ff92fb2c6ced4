"""Poses of the top between the samples of a run, with errors of fourth order in their distance.

The axis is interpolated with its rate L x n / I1. The turn about the axis is interpolated with
omega3 = L.n / I3, full turns counted: between two samples a fast top may turn more than once. This
turn is what remains of the rotation between two samples after the shortest rotation of the axis, so
that the pose at each sample is exact. The player in the browser does the same (`track.js`).
"""

from typing import NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray
from scipy.spatial.transform import Rotation

from tippetop.contact.lowest_surface import lowest_contact_vector
from tippetop.problem.problem import Problem, top_of

Array = NDArray[np.float64]


class Poses(NamedTuple):
    """Positions of the centre of mass, m, shape (k, 3), and k rotations of the body.

    The body that is not rotated has its axis along z and its marker along x.
    """

    positions: Array
    turns: Rotation


def poses_at(run: xr.Dataset, times: ArrayLike) -> Poses:
    """Return the poses of a run at times (s) within it, shape (k,)."""
    samples, at = run["time"].values, np.asarray(times, dtype=float)
    i = np.clip(np.searchsorted(samples, at, side="right") - 1, 0, max(len(samples) - 2, 0))
    j = np.minimum(i + 1, len(samples) - 1)
    h = samples[j] - samples[i]
    u = np.clip(np.divide(at - samples[i], h, out=np.zeros_like(at), where=h > 0), 0.0, 1.0)

    def between(values: Array, rates: Array) -> Array:
        return _cubic(u[:, None], h[:, None], values[i], values[j], rates[i], rates[j])

    body = Problem.from_json(run.attrs["problem"]).body
    axes, momenta = run["axis"].values, run["angular_momentum"].values
    rates = np.cross(momenta, axes) / body.I1
    spins = np.einsum("ij,ij->i", momenta, axes) / body.I3
    axis = between(axes, rates)
    axis /= np.linalg.norm(axis, axis=1)[:, None]
    turns = Rotation.from_quat(run["orientation"].values, scalar_first=True)
    about_axis_alone = (shortest(axes[i], axes[j]) * turns[i]).inv() * turns[j]
    _, _, z, w = about_axis_alone.as_quat().T
    first, last = spins[i], spins[j] + _carrying_spin(axes[i], axes[j], rates[j])
    turn = 2 * np.arctan2(z, w)
    turn += 2 * np.pi * np.round((0.5 * h * (first + last) - turn) / (2 * np.pi))
    about_axis = _cubic(u, h, 0.0 * turn, turn, first, last)[:, None] * np.array([0.0, 0.0, 1.0])
    turned = shortest(axes[i], axis) * turns[i] * Rotation.from_rotvec(about_axis)
    return Poses(
        between(run[["x", "y", "height"]].to_array().values.T, run["velocity"].values), turned
    )


def contact_path(run: xr.Dataset) -> Array:
    """Return the lowest point of the body at every sample, m, shape (k, 2)."""
    arm = lowest_contact_vector(
        tuple(run["axis"].values.T), top_of(Problem.from_json(run.attrs["problem"])).surface
    )
    return np.stack([run["x"].values + arm[0], run["y"].values + arm[1]], axis=1)


def _cubic(u: Array, h: Array, a: Array, b: Array, rate_a: Array, rate_b: Array) -> Array:
    """Return the cubic with these values and rates at both ends, at the share u of the time h."""
    v = 1.0 - u
    by_value = v * v * (1 + 2 * u) * a + u * u * (3 - 2 * u) * b
    return np.asarray(by_value + u * v * h * (v * rate_a - u * rate_b))


def _carrying_spin(start: Array, axis: Array, rate: Array) -> Array:
    """Return the spin (rad/s) about a moving axis in its shortest rotation from `start`."""
    turning = np.einsum("ij,ij->i", np.cross(start, axis), rate)
    return np.asarray(turning / np.maximum(1.0 + np.einsum("ij,ij->i", start, axis), 1e-9))


def shortest(start: Array, end: Array) -> Rotation:
    """Return the shortest rotations that turn unit vectors `start` to unit vectors `end`."""
    cosine = np.einsum("ij,ij->i", start, end)
    quaternion = np.concatenate([np.cross(start, end), 1 + cosine[:, None]], axis=1)
    opposite = np.linalg.norm(quaternion, axis=1) < 1e-9
    # Opposite vectors: half a turn about an axis that is perpendicular to both.
    quaternion[opposite, :3] = np.cross(start, np.eye(3)[np.abs(start).argmin(axis=1)])[opposite]
    return Rotation.from_quat(quaternion)
