"""Gauss's points in a step, and the numbers of collocation at them."""

import math
from collections.abc import Callable, Sequence
from operator import mul
from typing import NamedTuple

STAGES = 16
"""Points in a step: order 32 at its end."""

PARTS = 3
"""Pieces of polynomials that a step becomes in a solution: a few samples of a shorter piece cost
less.
"""

ROOTS = 12
"""Newton's iterations for a point, which converge in five."""


class GaussPoints(NamedTuple):
    """Gauss's points in a step of length 1, and what belongs to them."""

    places: list[float]
    """The points."""
    integrals: list[list[float]]
    """Integrals of Lagrange's polynomial of every point, from 0 to each."""
    weights: list[float]
    """The same integrals from 0 to 1: the quadrature's weights."""
    units: list[list[float]]
    """Lagrange's polynomials at the points."""
    terms: list[list[float]]
    """Matrix from values at the points to coefficients of Legendre's polynomials."""
    powers: list[list[list[float]]]
    """For every part of a step and every degree, the coefficients of the integral of Legendre's
    polynomial in powers of the elapsed fraction of the part, from the first power on.
    """


def gauss_points(stages: int) -> GaussPoints:
    """Return Gauss's points and matrices for a number of stages."""
    roots = [_root(stages, number) for number in range(stages)]
    values = [legendre(stages + 1, x) for x in roots]
    weights = [2.0 / sum([(2 * k + 1) * at[k] * at[k] for k in range(stages)]) for at in values]
    terms = [
        [0.5 * (2 * k + 1) * weight * at[k] for weight, at in zip(weights, values, strict=True)]
        for k in range(stages)
    ]
    integrals = [
        [
            sum([0.5 * _integral(k, x, at) * terms[k][j] for k in range(stages)])
            for x, at in zip(roots, values, strict=True)
        ]
        for j in range(stages)
    ]
    return GaussPoints(
        [0.5 + 0.5 * x for x in roots],
        integrals,
        [0.5 * weight for weight in weights],
        [[1.0 if i == j else 0.0 for j in range(stages)] for i in range(stages)],
        terms,
        [_in_powers(stages, part) for part in range(PARTS)],
    )


def interpolated(values: Sequence[float]) -> Callable[[float], float]:
    """Return the polynomial through values at the points of a step, as a function of the elapsed
    fraction of the step.
    """
    terms = [sum(map(mul, row, values)) for row in GAUSS.terms]

    def value(place: float) -> float:
        return float(sum(map(mul, terms, legendre(STAGES - 1, 2.0 * place - 1.0))))

    return value


def legendre(count: int, x: float) -> list[float]:
    """Return the values of Legendre's polynomials of degrees 0 to `count` at a place."""
    values = [1.0, x]
    for k in range(1, count):
        values.append(((2 * k + 1) * x * values[k] - k * values[k - 1]) / (k + 1))
    return values


def _root(stages: int, number: int) -> float:
    """Return a root of Legendre's polynomial, by Newton's method from a Chebyshev point."""
    x = -math.cos(math.pi * (number + 0.75) / (stages + 0.5))
    for _ in range(ROOTS):
        at = legendre(stages, x)
        x = x - at[stages] * (x * x - 1.0) / (stages * (x * at[stages] - at[stages - 1]))
    return x


def _integral(k: int, x: float, at: Sequence[float]) -> float:
    """Return the integral of Legendre's polynomial of a degree from -1 to x."""
    return (at[k + 1] - at[k - 1]) / (2 * k + 1) if k else x + 1.0


def _in_powers(stages: int, part: int) -> list[list[float]]:
    """Return coefficients of the integrals of Legendre's polynomials in powers of the elapsed
    fraction of a part.
    """
    begin, slope = 2.0 * part / PARTS - 1.0, 2.0 / PARTS
    none = [0.0] * stages
    rows = [[1.0, *none[1:]], [begin, slope, *none[2:]]]
    for k in range(1, stages - 1):
        times = [
            begin * a + slope * b
            for a, b in zip(rows[k], [0.0, *rows[k][: stages - 1]], strict=True)
        ]
        rows.append(
            [((2 * k + 1) * a - k * b) / (k + 1) for a, b in zip(times, rows[k - 1], strict=True)]
        )
    return [[number / (PARTS * (power + 1)) for power, number in enumerate(row)] for row in rows]


GAUSS = gauss_points(STAGES)

CONSTANTS = [number for row in [*GAUSS.integrals, *GAUSS.units] for number in row]
TERMS = [
    number
    for row in [*GAUSS.terms, *[row for part in GAUSS.powers for row in part]]
    for number in row
]
"""Parameters of `sweep`, and of `step_terms`, that belong to the method, row after row."""
