"""What is read off a run: when it has turned over, where phi' changes sign, when the table begins
to pull.

All functions take the times and values of a run that is sampled finely enough to show them.
"""

import numpy as np

from tippetop.integrators.base import Array

SETTLED = 0.01
"""How near the tilt must be to its last value to have arrived, rad: the report's own measure."""


SHOWN = 0.01
"""What a plot can show, as a part of its range."""


def flip_time(times: Array, theta: Array, within: float = SETTLED) -> float:
    """Return the first time at which theta is within this of its last value (the report's section
    3.3), s.
    """
    return float(times[np.argmax(np.abs(theta - theta[-1]) < within)])


def crossings(times: Array, values: Array) -> Array:
    """Return times at which the values change sign, by linear interpolation, s."""
    finite = np.isfinite(values)
    times, values = times[finite], values[finite]
    here = np.flatnonzero(np.signbit(values[1:]) != np.signbit(values[:-1]))
    before, after = values[here], values[here + 1]
    return np.asarray(times[here] + (times[here + 1] - times[here]) * before / (before - after))


def longest_quiet(times: Array, values: Array) -> tuple[float, float]:
    """Return the longest time between two changes of sign, s; nan where there are fewer than
    two.
    """
    changes = crossings(times, values)
    if len(changes) < 2:
        return np.nan, np.nan
    k = int(np.argmax(np.diff(changes)))
    return float(changes[k]), float(changes[k + 1])


def first_below_zero(times: Array, values: Array) -> float:
    """Return the first time at which the values are negative, s; nan if they never are."""
    if values[0] < 0:
        return float(times[0])
    changes = crossings(times, values)
    return float(changes[0]) if len(changes) else float("nan")
