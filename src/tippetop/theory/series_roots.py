"""All roots of a smooth function between two bounds, by Chebyshev series that follow it piece by
piece.

A piece on which a series of low degree is not the function to rounding is halved. The roots of a
series lie between those of its derivative, one at most between two, and so from degree to degree:
none is missed, however close two of them are (Boyd, *Solving Transcendental Equations*, 2014,
chapter 3). Plain operators.
"""

import math
from collections.abc import Callable
from itertools import pairwise

from tippetop.mechanics.roots import crossing

DEGREE, HALVINGS = 16, 12
"""Degree of the series of a piece, and how often the whole is halved at most."""

ROUNDING = 1e-13
"""What the last terms of a series may be, relative to the largest value there is."""


def roots_between(
    function: Callable[[float], float], low: float, high: float, noise: float
) -> list[float]:
    """Roots of a function between two bounds, at which it is not asked, in order; values to `noise`
    are 0.
    """
    least = max(noise, ROUNDING * largest(series_of(function, low, high)))
    found: list[float] = []
    waiting = [(low, high, 0)]
    while waiting:
        start, end, depth = waiting.pop()
        series = series_of(function, start, end)
        if max(abs(series[-1]), abs(series[-2])) > least and depth < HALVINGS:
            middle = 0.5 * (start + end)
            waiting += [(middle, end, depth + 1), (start, middle, depth + 1)]
            continue
        while series and abs(series[-1]) <= least:
            series.pop()
        found += [start + 0.5 * (end - start) * (1.0 + place) for place in roots_of(series)]
    return found


def series_of(function: Callable[[float], float], low: float, high: float) -> list[float]:
    """Coefficients of the Chebyshev series that is the function at Chebyshev's points of a
    piece.
    """
    count = DEGREE + 1
    angles = [math.pi * (place + 0.5) / count for place in range(count)]
    values = [function(low + 0.5 * (high - low) * (1.0 + math.cos(angle))) for angle in angles]
    found = []
    for term in range(count):
        total = sum(
            value * math.cos(term * angle) for value, angle in zip(values, angles, strict=True)
        )
        found.append((2.0 if term else 1.0) / count * total)
    return found


def value_of(series: list[float], place: float) -> float:
    """Value of a Chebyshev series at a place in [-1, 1], by Clenshaw's recurrence."""
    after, now = 0.0, 0.0
    for term in reversed(series[1:]):
        now, after = term + 2.0 * place * now - after, now
    return series[0] + place * now - after


def derivative_of(series: list[float]) -> list[float]:
    """Coefficients of the derivative of a Chebyshev series of degree 1 or more."""
    found = [0.0] * (len(series) + 1)
    for term in range(len(series) - 1, 0, -1):
        found[term - 1] = found[term + 1] + 2.0 * term * series[term]
    found[0] *= 0.5
    return found[: len(series) - 1]


def roots_of(series: list[float]) -> list[float]:
    """Places in [-1, 1) at which a Chebyshev series changes its sign, in order."""
    if len(series) < 2:
        return []
    places = [-1.0, *roots_of(derivative_of(series)), 1.0]
    found = []
    for start, end in pairwise(places):
        if (value_of(series, start) < 0.0) != (value_of(series, end) < 0.0):
            found.append(crossing(lambda place: value_of(series, place), start, end))
    return found


def largest(series: list[float]) -> float:
    """Bound of the values of a Chebyshev series."""
    return sum(abs(term) for term in series)
