"""Where the top is between the samples of a run, to the fourth order of their distance.

The axis is interpolated with its rate L x n / I1, and the turn about it with omega3 = L.n / I3, counting
whole turns: between samples a fast top may turn more than once. The turn is what is left after the axis is
carried over by the shortest rotation, so that the samples themselves are exact. The player in the browser
does the same (`track.js`).
"""

from typing import NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from tippetop.problem import Problem

Array = NDArray[np.float64]


class Poses(NamedTuple):
    """Positions of the centre of mass, m, shape (k, 3), and unit quaternions, scalar first, shape (k, 4)."""

    positions: Array
    quaternions: Array


class _Ends(NamedTuple):
    """The two samples around every time, the fraction of the way between them, and their distance, s."""

    before: NDArray[np.intp]
    fraction: Array
    step: Array


def poses_at(run: xr.Dataset, times: ArrayLike) -> Poses:
    """The poses of a run at any times within it, s, shape (k,)."""
    ends = _ends(run["time"].values, np.asarray(times, dtype=float))
    position = _hermite(run[["x", "y", "height"]].to_array().values.T, run["velocity"].values, ends)
    return Poses(position, _orientation(run, ends))


def _ends(samples: Array, times: Array) -> _Ends:
    before = np.clip(np.searchsorted(samples, times, side="right") - 1, 0, max(len(samples) - 2, 0))
    after = np.minimum(before + 1, len(samples) - 1)
    step = samples[after] - samples[before]
    fraction = np.divide(times - samples[before], step, out=np.zeros_like(times), where=step > 0)
    return _Ends(before, np.clip(fraction, 0.0, 1.0), step)


def _hermite(values: Array, rates: Array, ends: _Ends) -> Array:
    """Cubic through the values with the rates at both ends, shape (k, m)."""
    u, h = ends.fraction[:, None], ends.step[:, None]
    after = np.minimum(ends.before + 1, len(values) - 1)
    v = 1.0 - u
    by_value = v * v * (1 + 2 * u) * values[ends.before] + u * u * (3 - 2 * u) * values[after]
    by_rate = u * v * h * (v * rates[ends.before] - u * rates[after])
    return np.asarray(by_value + by_rate)


def _orientation(run: xr.Dataset, ends: _Ends) -> Array:
    body = Problem.from_json(run.attrs["problem"]).body
    axes, momenta, turns = run["axis"].values, run["angular_momentum"].values, run["orientation"].values
    rates = np.cross(momenta, axes) / body.I1
    spins = np.einsum("ij,ij->i", momenta, axes) / body.I3
    axis = _hermite(axes, rates, ends)
    axis /= np.linalg.norm(axis, axis=1)[:, None]
    before, after = ends.before, np.minimum(ends.before + 1, len(axes) - 1)
    carried = multiply(shortest(axes[before], axes[after]), turns[before])
    left = multiply(conjugate(carried), turns[after])
    twist = 2 * np.arctan2(left[:, 3], left[:, 0])
    first, last = spins[before], spins[after] - _carrying_spin(axes[before], axes[after], rates[after])
    expected = 0.5 * ends.step * (first + last)
    twist += 2 * np.pi * np.round((expected - twist) / (2 * np.pi))
    u, h = ends.fraction, ends.step
    v = 1.0 - u
    turned = u * u * (3 - 2 * u) * twist + u * v * h * (v * first - u * last)
    about_axis = np.stack([np.cos(turned / 2), 0 * turned, 0 * turned, np.sin(turned / 2)], axis=1)
    return multiply(multiply(shortest(axes[before], axis), turns[before]), about_axis)


def _carrying_spin(start: Array, axis: Array, rate: Array) -> Array:
    """How fast the shortest rotation from `start` to a moving axis turns about that axis, rad/s."""
    turning = np.einsum("ij,ij->i", np.cross(start, axis), rate)
    return np.asarray(-turning / np.maximum(1.0 + np.einsum("ij,ij->i", start, axis), 1e-9))


def shortest(start: Array, end: Array) -> Array:
    """The shortest rotation from one unit vector to another, as a quaternion."""
    cosine = np.einsum("ij,ij->i", start, end)
    quaternion = np.concatenate([1 + cosine[:, None], np.cross(start, end)], axis=1)
    length = np.linalg.norm(quaternion, axis=1)
    opposite = length < 1e-9
    quaternion[opposite] = (0.0, 1.0, 0.0, 0.0)
    length[opposite] = 1.0
    return np.asarray(quaternion / length[:, None])


def multiply(a: Array, b: Array) -> Array:
    """The quaternion of turning by b, then by a."""
    scalar = a[:, :1] * b[:, :1] - np.einsum("ij,ij->i", a[:, 1:], b[:, 1:])[:, None]
    vector = a[:, :1] * b[:, 1:] + b[:, :1] * a[:, 1:] + np.cross(a[:, 1:], b[:, 1:])
    return np.concatenate([scalar, vector], axis=1)


def conjugate(a: Array) -> Array:
    """The opposite turn."""
    opposite: Array = a * np.array([1.0, -1.0, -1.0, -1.0])
    return opposite


def turned(quaternions: Array, vectors: Array) -> Array:
    """Vectors turned by quaternions, both of shape (k, ...)."""
    axis = quaternions[:, 1:]
    twice = 2 * np.cross(axis, vectors)
    return np.asarray(vectors + quaternions[:, :1] * twice + np.cross(axis, twice))
