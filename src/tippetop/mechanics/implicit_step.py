"""Implicit steps for stiff rates: Euler's linearly implicit method, extrapolated.

Deuflhard 1983, Numerische Mathematik 41; Hairer and Wanner 1996, Solving Ordinary Differential Equations II,
section IV.9.
"""

from collections.abc import Callable, Sequence

from tippetop.mechanics.runge_kutta import Point, RungeKuttaStep, moved
from tippetop.mechanics.vectors import solve

COUNTS = (2, 3, 4, 5, 6, 7)
"""Into how many parts a step is divided; the order is how many such divisions there are."""


def implicit_step(
    here: Point,
    slope: Point,
    size: float,
    rates: Callable[[Point], Point],
    jacobian: Sequence[Sequence[float]],
) -> RungeKuttaStep:
    """A step from a point with known rates, and known derivatives of each by all numbers, at least nearly."""
    rougher: list[Point] = []
    found = rougher
    for count in COUNTS:
        part, point = size / count, here
        matrix = [
            [(1.0 if i == j else 0.0) - part * entry for j, entry in enumerate(row)]
            for i, row in enumerate(jacobian)
        ]
        for taken in range(count):
            point = moved(point, part, tuple(solve(matrix, list(rates(point) if taken else slope))))
        rougher, found = found, [point]
        for fewer, rough in zip(reversed(COUNTS[: len(rougher)]), rougher, strict=True):
            finer = found[-1]
            off = moved(finer, -1.0, rough)
            found.append(moved(finer, fewer / (count - fewer), off))
    there = found[-1]
    return RungeKuttaStep(here, there, [slope, rates(there)], size, moved(there, -1.0, found[-2]))
