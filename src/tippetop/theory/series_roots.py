"""All roots of a smooth function between two bounds, by piecewise Chebyshev series.

An interval on which a series of low degree does not equal the function to rounding is halved.
Between two neighbouring roots of the derivative of a series there is at most one root of the
series; applied from degree to degree, this misses none, however close two of them are (Boyd,
*Solving Transcendental Equations*, 2014, chapter 3). Plain operators only.
"""

import math
from collections.abc import Callable
from itertools import pairwise

from tippetop.mechanics.roots import crossing

DEGREE, HALVINGS = 16, 12
"""Degree of the series on an interval, and how often the bounds are halved at most."""

SERIES_ROUNDING = 1e-13
"""Size of the last terms of a series, relative to the largest value, that is rounding: smaller
limits halve intervals in vain, larger ones lose digits.
"""


def roots_between(
    function: Callable[[float], float], low: float, high: float, noise: float
) -> list[float]:
    """Return the roots of a function between two bounds, in order.

    The function is not evaluated at the bounds. Its values up to `noise` count as 0.
    """
    least = max(noise, SERIES_ROUNDING * largest(series_of(function, low, high)))
    roots: list[float] = []
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
        roots += [start + 0.5 * (end - start) * (1.0 + place) for place in roots_of(series)]
    return roots


def series_of(function: Callable[[float], float], low: float, high: float) -> list[float]:
    """Return the coefficients of the Chebyshev series that interpolates a function."""
    count = DEGREE + 1
    angles = [math.pi * (place + 0.5) / count for place in range(count)]
    values = [function(low + 0.5 * (high - low) * (1.0 + math.cos(angle))) for angle in angles]
    coefficients = []
    for term in range(count):
        total = sum(
            value * math.cos(term * angle) for value, angle in zip(values, angles, strict=True)
        )
        coefficients.append((2.0 if term else 1.0) / count * total)
    return coefficients


def value_of(series: list[float], place: float) -> float:
    """Return the value of a Chebyshev series at a place in [-1, 1], by Clenshaw's recurrence."""
    after, now = 0.0, 0.0
    for term in reversed(series[1:]):
        now, after = term + 2.0 * place * now - after, now
    return series[0] + place * now - after


def derivative_of(series: list[float]) -> list[float]:
    """Return the coefficients of the derivative of a Chebyshev series of degree 1 or more."""
    coefficients = [0.0] * (len(series) + 1)
    for term in range(len(series) - 1, 0, -1):
        coefficients[term - 1] = coefficients[term + 1] + 2.0 * term * series[term]
    coefficients[0] *= 0.5
    return coefficients[: len(series) - 1]


def roots_of(series: list[float]) -> list[float]:
    """Return the places in [-1, 1) at which a Chebyshev series changes its sign, in order."""
    if len(series) < 2:
        return []
    places = [-1.0, *roots_of(derivative_of(series)), 1.0]
    roots = []
    for start, end in pairwise(places):
        if (value_of(series, start) < 0.0) != (value_of(series, end) < 0.0):
            roots.append(crossing(lambda place: value_of(series, place), start, end))
    return roots


def largest(series: list[float]) -> float:
    """Return a bound of the absolute values of a Chebyshev series."""
    return sum(abs(term) for term in series)
