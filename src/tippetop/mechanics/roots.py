"""Roots of functions of one number: the first one, with proof, and the one between two signs."""

# translate module: numbers

from collections.abc import Callable
from typing import TypeAlias

from tippetop.mechanics.unsolved import Unsolved

FINEST = 1e-10
"""Step, relative to its piece, below which a gap that is neither open nor closing counts as closed.
"""

GOLDEN = 0.5 * (3.0 - 5.0**0.5)
"""Smaller part of an interval in the golden ratio."""

DIVISIONS = 29
"""How often an interval is divided for a least value."""

Triple: TypeAlias = tuple[float, float, float]
"""A function's value and its first two derivatives."""


def first_root(
    function: Callable[[float], Triple], low: float, high: float, jerk: float
) -> float | None:
    """First root from `low` to `high`, or `low` if not positive there; `jerk` bounds the third
    derivative.

    Raises `Unsolved` where it takes steps that are lost in rounding.
    """
    time, step, finest = low, high - low, FINEST * (high - low)
    value, rate, acceleration = function(time)
    while value > 0.0:
        step = min(step, high - time)
        end = high if step == high - time else time + step
        if end == time:
            raise Unsolved("steps of time are lost in its rounding")
        positive = stays_positive(value, rate, acceleration, jerk, step)
        if positive or is_one_way(rate, acceleration, jerk, step):
            if end == high and positive:
                return None
            later = function(end)
            if later[0] <= 0.0 and not positive:
                return crossing(lambda t: function(t)[0], time, end)
            if end == high and later[0] > 0.0:
                return None
            time, step = end, 2.0 * step
            value, rate, acceleration = later
        else:
            step *= 0.5
            if step < finest:
                break
    return time


def stays_positive(
    value: float, rate: float, acceleration: float, jerk: float, step: float
) -> bool:
    """Return whether value + rate s + acceleration s^2/2 - jerk s^3/6 is positive for all s in [0,
    step].
    """

    def cubic(s: float) -> float:
        return value + s * (rate + s * (acceleration / 2.0 - s * jerk / 6.0))

    if cubic(step) <= 0.0:
        return False
    discriminant = acceleration * acceleration + 2.0 * jerk * rate
    if rate >= 0.0 or acceleration <= 0.0 or discriminant <= 0.0:
        return True
    dip = -2.0 * rate / (acceleration + discriminant**0.5)
    return dip >= step or cubic(dip) > 0.0


def is_one_way(rate: float, acceleration: float, jerk: float, step: float) -> bool:
    """Return whether a function falls, or is concave, all along a step, so that it has at most one
    root.
    """
    falls = rate < 0.0 and rate + step * (acceleration + 0.5 * step * jerk) < 0.0
    return falls or acceleration + step * jerk < 0.0


def dip(function: Callable[[float], float], low: float, high: float) -> tuple[float, float]:
    """Place and value of a function's least value between two points, or of one that is not
    positive.

    By golden section; the place is found to a millionth of the interval.
    """
    a, b = low, high
    x, y = a + GOLDEN * (b - a), b - GOLDEN * (b - a)
    f, g = function(x), function(y)
    for _ in range(DIVISIONS):
        if f <= 0.0 or g <= 0.0:
            break
        if f < g:
            b, y, g = y, x, f
            x = a + GOLDEN * (b - a)
            f = function(x)
        else:
            a, x, f = x, y, g
            y = b - GOLDEN * (b - a)
            g = function(y)
    return (x, f) if f < g else (y, g)


def crossing(function: Callable[[float], float], low: float, high: float) -> float:
    """Root of a function between two points where its signs differ, by the method of Chandrupatla
    (1997).
    """
    x1, x2, part = high, low, 0.5
    y1, y2 = function(x1), function(x2)
    if y1 == 0.0 or y2 == 0.0:
        return x2 if y2 == 0.0 else x1
    best = x1
    for _ in range(400):
        x = x1 + part * (x2 - x1)
        y = function(x)
        if (y > 0.0) == (y1 > 0.0):
            x3, y3 = x1, y1
        else:
            x3, y3, x2, y2 = x2, y2, x1, y1
        x1, y1 = x, y
        best = x1 if abs(y1) < abs(y2) else x2
        fuzz = 2.3e-16 * abs(best) / abs(x2 - x1)
        if fuzz > 0.5 or y == 0.0:
            break
        xi, phi = (x1 - x2) / (x3 - x2), (y1 - y2) / (y3 - y2)
        part = 0.5
        if phi * phi < xi and (1.0 - phi) ** 2 < 1.0 - xi:
            part = y1 / (y2 - y1) * y3 / (y2 - y3)
            part += (x3 - x1) / (x2 - x1) * y1 / (y3 - y1) * y2 / (y3 - y2)
        part = min(max(part, fuzz), 1.0 - fuzz)
    return best
