"""The root of a function of one number between two signs, and its least value."""

# translate module: numbers

from collections.abc import Callable

GOLDEN = 0.5 * (3.0 - 5.0**0.5)
"""Smaller part of an interval in the golden ratio."""

DIVISIONS = 29
"""How often an interval is divided for a least value."""


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
