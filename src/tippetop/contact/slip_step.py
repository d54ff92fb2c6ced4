"""Steps of collocation along slip, compiled once for a kind of top."""

import math
from collections.abc import Sequence
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from tippetop.contact.surfaces import clearance, passes_flat
from tippetop.integrators.base import Array
from tippetop.integrators.iteration import (
    Iteration,
    copied,
    first_of,
    iterated,
    put_from,
    put_rows,
    room,
)
from tippetop.mechanics.ending import Vanishing
from tippetop.mechanics.hull import Hull
from tippetop.mechanics.roots import crossing
from tippetop.mechanics.series import horner
from tippetop.mechanics.slip_phase import (
    CONSTANTS,
    GAUSS,
    PARTS,
    STAGES,
    TERMS,
    StepRows,
    Values,
    step_terms,
    sweep,
)
from tippetop.mechanics.stick_slip import inner
from tippetop.mechanics.top import Kind, Top
from tippetop.mechanics.vectors import Scalar
from tippetop.mechanics.wrench import Slip

ENOUGH, MOST = 1e-28, 50
"""Sum of the squares of changes that are rounding, and sweeps of a step at most."""

PRESSED, CLEAR = 0.1, 1e-2
"""Normal force, and gap of another surface, in natural units, at points of a step, which neither
falls to zero between.
"""


class _Machinery(NamedTuple):
    """What steps are made with."""

    better: Iteration
    terms: Iteration
    given: Any
    measured: Any
    """What they are given, but for the numbers of a step."""


@lru_cache(maxsize=64)
def compiled_step(kind: Kind, ending: Vanishing) -> tuple[Iteration, Iteration]:
    """What makes steps of a kind of top better, and their polynomials."""
    layout = StepRows.of(ending)

    def better(y: Sequence[Scalar], p: Sequence[Scalar], points: Values) -> list[Scalar]:
        return sweep(y, p, ending, kind, points)

    def terms(y: Sequence[Scalar], p: Sequence[Scalar], points: Values) -> list[Scalar]:
        return [*y, *step_terms(y, p, points)]

    given = layout.given + kind.numbers + len(CONSTANTS) // STAGES
    return (
        iterated(better, layout.size, given, STAGES),
        iterated(terms, layout.size, 1 + len(TERMS) // STAGES, STAGES),
    )


@lru_cache(maxsize=64)
def machinery_of(top: Top, ending: Vanishing) -> _Machinery:
    """What steps of a top are made with."""
    first, numbers = StepRows.of(ending).given, top.numbers
    given = room((first + len(numbers)) * STAGES + len(CONSTANTS))
    put_rows(given, first, numbers, STAGES)
    put_from(given, (first + len(numbers)) * STAGES, CONSTANTS)
    measured = room(STAGES + len(TERMS))
    put_from(measured, STAGES, TERMS)
    return _Machinery(*compiled_step(top.kind, ending), given, measured)


def row_of(numbers: Sequence[float], row: int) -> list[float]:
    """What a number is at every point, by its row."""
    return [*numbers[row * STAGES : (row + 1) * STAGES]]


class SlipStep:
    """A step of collocation."""

    def __init__(self, top: Top, ending: Vanishing) -> None:
        self.machinery, self.layout = machinery_of(top, ending), StepRows.of(ending)
        layout = self.layout
        self.given, self.measured = copied(self.machinery.given), copied(self.machinery.measured)
        self.unknowns, self.found = room(layout.size * STAGES), room(layout.found * STAGES)
        self.rows = room(((PARTS + 1) * layout.size + 1) * STAGES)
        self.sweeps = 0

    def solve(self, now: Sequence[float], way: Slip, length: float) -> bool:
        """Find what solves the equations of a step of some length; tell whether that is found."""
        put_rows(self.given, 0, [*now, length], STAGES)
        put_rows(self.unknowns, 0, [*now[: self.layout.free], *way], STAGES)
        self.sweeps += self.machinery.better(self.unknowns, self.given, self.found, ENOUGH, MOST)
        if not self.found[len(self.found) - 1] < ENOUGH:
            return False
        put_rows(self.measured, 0, [length], STAGES)
        self.machinery.terms(self.found, self.measured, self.rows, 0.0, 1)
        return True

    @property
    def error(self) -> float:
        """A measure of its error."""
        return float(self.rows[len(self.rows) - 1])

    @property
    def speeds(self) -> list[float]:
        """S at its points."""
        return row_of(self.found, self.layout.speed)

    @property
    def last_way(self) -> Slip:
        """The direction at its last point."""
        free = self.layout.free
        return row_of(self.unknowns, free)[STAGES - 1], row_of(self.unknowns, free + 1)[STAGES - 1]

    @property
    def changes(self) -> list[float]:
        """By how much y and xi change."""
        size = self.layout.size
        return [row_of(self.rows, row)[0] for row in range(PARTS * size, (PARTS + 1) * size)]

    def pieces(self, parts: float) -> Array:
        """Coefficients of y and xi in so many of its parts, of the last of which it may be a
        share.
        """
        return pieces_of(self.rows, self.layout.size, parts)

    def goes_on(
        self, top: Top, ends: tuple[Sequence[float], Sequence[float]], *, pulls: bool
    ) -> bool:
        """Whether nothing else comes near the table, and that is far from pulling if it may not.

        By its points, and the numbers at its ends.
        """
        several = isinstance(top.surface, Hull)
        if several and not min([clearance(top, c) for c in row_of(self.unknowns, 2)]) > CLEAR:
            return False
        points = zip(row_of(self.unknowns, 0), row_of(self.unknowns, 1), strict=True)
        if passes_flat(top, [ends[0], *points, ends[1]]):
            return False
        return pulls or bool(min(row_of(self.found, self.layout.normal)) > PRESSED)

    def speed(self, number: int, begin: float, way: Slip) -> list[float]:
        """Coefficients of s in a part of it, at whose start it is this; beyond slip s is less than
        zero.
        """
        first = number * self.layout.size + self.layout.free
        x, y = row_of(self.rows, first), row_of(self.rows, first + 1)
        return [begin, *[way[0] * a + way[1] * b for a, b in zip(x, y, strict=True)]]

    def end_of_slip(self, xi: Slip, speeds: Sequence[float]) -> float | None:
        """After how many parts of it slip ends, that is xi at its start; None if that is not
        told.
        """
        below = [number for number, speed in enumerate(speeds) if speed <= 0.0]
        point = below[0] if below else STAGES
        if point == 0:
            return None
        way, polynomials = self.last_way, list[list[float]]()
        begin = inner(xi, way)
        for number in range(PARTS):
            polynomials.append(self.speed(number, begin, way))
            begin = sum(polynomials[number])

        def speed(place: float) -> float:
            number = min(int(place), PARTS - 1)
            return float(horner(polynomials[number], place - number))

        high = GAUSS.places[point] if point < STAGES else 1.0
        return crossing(speed, PARTS * GAUSS.places[point - 1], PARTS * high)


def pieces_of(rows: Any, size: int, parts: float) -> Array:
    """Polynomials of so many numbers in the first parts of a step, of the last of which it may be a
    share.

    Part after part, and one number after the other: coefficients from the first power on.
    """
    whole, count = math.ceil(parts), size * STAGES
    if parts == whole:
        return first_of(rows, whole * count)
    before, shares = (whole - 1) * count, [(parts - whole + 1) ** (k + 1) for k in range(STAGES)]
    last = [
        term * share
        for term, share in zip(rows[before : before + count], shares * size, strict=True)
    ]
    return np.array([*first_of(rows, before), *last])
