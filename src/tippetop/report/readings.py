"""Readings of a run: when it has turned over, where phi' changes sign, when the table begins to
pull.

All functions take times and values of a run with enough samples to show them.
"""

import numpy as np
from numpy.typing import NDArray

from tippetop.integrators.base import Array

SETTLED = 0.01
"""Distance from the last tilt within which a top has arrived, rad: the report's own measure."""


SHOWN = 0.01
"""Smallest difference that a plot can show, as a share of its range."""


def flip_time(times: Array, theta: Array, within: float = SETTLED) -> float:
    """Return the first time (s) at which theta is within a distance (rad) of its last value.

    This is the definition of the report's section 3.3.
    """
    return float(times[np.argmax(np.abs(theta - theta[-1]) < within)])


def crossings(times: Array, values: Array) -> Array:
    """Return the times at which values change sign, by linear interpolation, s."""
    finite = np.isfinite(values)
    times, values = times[finite], values[finite]
    index = np.flatnonzero(np.signbit(values[1:]) != np.signbit(values[:-1]))
    before, after = values[index], values[index + 1]
    return np.asarray(times[index] + (times[index + 1] - times[index]) * before / (before - after))


def turning_points(values: Array) -> NDArray[np.intp]:
    """Return the indices at which values turn from rising to falling or the other way."""
    return np.flatnonzero(np.diff(np.sign(np.diff(values)))) + 1


def longest_quiet(times: Array, values: Array) -> tuple[float, float]:
    """Return the ends of the longest time between two changes of sign, s; nan if there are fewer
    than two.
    """
    changes = crossings(times, values)
    if len(changes) < 2:
        return np.nan, np.nan
    k = int(np.argmax(np.diff(changes)))
    return float(changes[k]), float(changes[k + 1])


def first_below_zero(times: Array, values: Array) -> float:
    """Return the first time at which values are negative, s; nan if they never are."""
    if values[0] < 0:
        return float(times[0])
    changes = crossings(times, values)
    return float(changes[0]) if len(changes) else float("nan")
