"""Where the top is between the samples of a run, to the fourth order of their distance.

The axis is interpolated with its rate L x n / I1, and the turn about it with omega3 = L.n / I3,
counting whole turns: between samples a fast top may turn more than once. The turn is what is left
after the axis is carried over by the shortest rotation, so that the samples themselves are exact.
The player in the browser does the same (`track.js`).
"""

from typing import NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray
from scipy.spatial.transform import Rotation

from tippetop.contact.lowest_surface import lowest_contact_vector
from tippetop.problem.problem import Problem

Array = NDArray[np.float64]


class Poses(NamedTuple):
    """Positions of the centre of mass, m, shape (k, 3), and k turns from axis up and marker along
    x.
    """

    positions: Array
    turns: Rotation


def poses_at(run: xr.Dataset, times: ArrayLike) -> Poses:
    """Return the poses of a run at any times within it, s, shape (k,)."""
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
    left = (shortest(axes[i], axes[j]) * turns[i]).inv() * turns[j]
    _, _, z, w = left.as_quat().T
    first, last = spins[i], spins[j] + _carrying_spin(axes[i], axes[j], rates[j])
    turn = 2 * np.arctan2(z, w)
    turn += 2 * np.pi * np.round((0.5 * h * (first + last) - turn) / (2 * np.pi))
    about_axis = _cubic(u, h, 0.0 * turn, turn, first, last)[:, None] * np.array([0.0, 0.0, 1.0])
    turned = shortest(axes[i], axis) * turns[i] * Rotation.from_rotvec(about_axis)
    return Poses(
        between(run[["x", "y", "height"]].to_array().values.T, run["velocity"].values), turned
    )


def contact_path(run: xr.Dataset) -> Array:
    """Where the lowest point of the body is on the table at every sample, m, shape (k, 2)."""
    arm = lowest_contact_vector(
        tuple(run["axis"].values.T), Problem.from_json(run.attrs["problem"]).top.surface
    )
    return np.stack([run["x"].values + arm[0], run["y"].values + arm[1]], axis=1)


def _cubic(u: Array, h: Array, a: Array, b: Array, rate_a: Array, rate_b: Array) -> Array:
    """Return the cubic through two values with the rates at both ends, at a share u of the time h
    between them.
    """
    v = 1.0 - u
    by_value = v * v * (1 + 2 * u) * a + u * u * (3 - 2 * u) * b
    return np.asarray(by_value + u * v * h * (v * rate_a - u * rate_b))


def _carrying_spin(start: Array, axis: Array, rate: Array) -> Array:
    """How fast the shortest rotation from `start` to a moving axis turns backwards about it,
    rad/s.
    """
    turning = np.einsum("ij,ij->i", np.cross(start, axis), rate)
    return np.asarray(turning / np.maximum(1.0 + np.einsum("ij,ij->i", start, axis), 1e-9))


def shortest(start: Array, end: Array) -> Rotation:
    """Return the shortest rotations from unit vectors to others."""
    cosine = np.einsum("ij,ij->i", start, end)
    quaternion = np.concatenate([np.cross(start, end), 1 + cosine[:, None]], axis=1)
    opposite = np.linalg.norm(quaternion, axis=1) < 1e-9
    # About the coordinate axis that is most nearly across.
    quaternion[opposite, :3] = np.cross(start, np.eye(3)[np.abs(start).argmin(axis=1)])[opposite]
    return Rotation.from_quat(quaternion)
