"""Slip from its beginning to its end, step by step of collocation (see `tippetop.mechanics.slip_phase`)."""

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
from tippetop.mechanics.stick_slip import APART, inner, scaled, size
from tippetop.mechanics.top import Kind, Top
from tippetop.mechanics.vectors import Scalar
from tippetop.mechanics.wrench import Slip

FIRST, LEAST = 0.5, 0.005
"""The first step, in natural units of time, and the least that a step is shortened to: where shorter ones are
asked for, slip does not follow what drives it, and other methods are quicker."""

ENOUGH, MOST = 1e-28, 50
"""Sum of the squares of changes that are rounding, and sweeps of a step at most."""

ACCURACY = 1e-22
"""Sum of the squares of the last coefficients of a step, in natural units, that is small: in the solution
they are divided by thirty and more, and the error of what a step ends with is of the order of their product.
"""

BEYOND = 1.05
"""How much longer a step is than slip seems to last, so that its end lies within."""

DIP, NONE = 0.1, 1e-11
"""Slip within a step, as part of the most in it, that may be none between two points; and slip, in natural
units, that is none where it ends."""

PRESSED, CLEAR = 0.1, 1e-2
"""Normal force, and gap of another surface, in natural units, at points of a step, which neither falls to
zero between."""

LONGER, SHORTER, SHORTEST, SAFETY = 1.5, 0.8, 0.3, 0.9
"""How much longer the next step may be; how much shorter one is at most, and at least, that is tried again;
and how much shorter than it should."""

TINY = 1e-300
"""Added to an error that may be zero."""


class SlipPhase(NamedTuple):
    """Slip that began, and how far it was followed."""

    knots: list[float]
    """Ends of pieces since then."""
    rows: list[Array]
    """Of the pieces of every step the coefficients of y and xi in powers of what has passed of each, from the
    first on, in a row."""
    last: list[float]
    """y and xi where that ends."""
    ended: bool
    """Whether slip has ended there."""
    sweeps: int
    """Sweeps that it took."""


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
        """Coefficients of y and xi in so many of its parts, of the last of which it may be a share."""
        return pieces_of(self.rows, self.layout.size, parts)

    def goes_on(self, top: Top, ends: tuple[Sequence[float], Sequence[float]], *, pulls: bool) -> bool:
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
        """Coefficients of s in a part of it, at whose start it is this; beyond slip s is less than zero."""
        first = number * self.layout.size + self.layout.free
        x, y = row_of(self.rows, first), row_of(self.rows, first + 1)
        return [begin, *[way[0] * a + way[1] * b for a, b in zip(x, y, strict=True)]]

    def end_of_slip(self, xi: Slip, speeds: Sequence[float]) -> float | None:
        """After how many parts of it slip ends, that is xi at its start; None if that is not told."""
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


def slip_phase(
    y: Sequence[float], way: Slip, top: Top, ending: Vanishing, longest: float, *, pulls: bool
) -> SlipPhase:
    """Follow slip, or rolling, that begins, as far as the method goes, which may be nowhere.

    Parameters
    ----------
    y
        Axis, angular momentum, and velocity where that is free.
    way
        The direction in which it begins.
    top
        The body.
    ending
        What begins.
    longest
        How long it is followed at most, in natural units of time.
    pulls
        Whether the table may pull.
    """
    step = SlipStep(top, ending)
    now, length, free = [*y, *[0.0 for _ in way]], FIRST, len(y)
    knots, rows, ended = [0.0], list[Array](), False
    while not ended and knots[-1] < longest and size(tuple(now[free:])) < APART:
        begin, known, before = knots[-1], len(knots), now
        length = min(length, longest - begin)
        solved = step.solve(now, way, length)
        factor = SAFETY * (ACCURACY / (step.error + TINY)) ** (0.5 / STAGES) if solved else 0.0
        after = [a + b for a, b in zip(now, step.changes, strict=True)]
        last, speeds = step.last_way, step.speeds
        lasts = min(speeds) > 0.0 and after[free] * last[0] + after[free + 1] * last[1] > 0.0
        part = float(PARTS) if lasts or factor < SAFETY else step.end_of_slip(tuple(now[free:]), speeds)
        if factor < SAFETY or part is None or dips(speeds):
            length *= max(min(factor, SHORTER), SHORTEST)
            if length < LEAST:
                break
            continue
        if not step.goes_on(top, (now, after), pulls=pulls):
            break
        ended = not lasts
        pieces = step.pieces(part)
        ends = [min(part, number + 1.0) / PARTS for number in range(PARTS) if part > number]
        knots += [begin + length * end for end in ends]
        if ended:
            now = [a + b for a, b in zip(now, change_over(pieces, len(now)), strict=True)]
            if not size(tuple(now[free:])) < NONE:
                # Its direction turned by so much that it ends elsewhere.
                return SlipPhase(knots[:known], rows, before, False, step.sweeps)
        else:
            if length == longest - begin:
                knots[len(knots) - 1] = longest
            now, way = after, scaled(1.0 / size(tuple(after[free:])), tuple(after[free:]))
            speed = step.speed(PARTS - 1, 0.0, last)
            speed[0] = inner(tuple(after[free:]), last) - sum(speed)
            length = min(length * min(factor, LONGER), BEYOND * length / PARTS * parts_left(speed))
        rows.append(pieces)
    return SlipPhase(knots, rows, now, ended, step.sweeps)


def pieces_of(rows: Any, size: int, parts: float) -> Array:
    """Polynomials of so many numbers in the first parts of a step, of the last of which it may be a share.

    Part after part, and one number after the other: coefficients from the first power on.
    """
    whole, count = math.ceil(parts), size * STAGES
    if parts == whole:
        return first_of(rows, whole * count)
    before, shares = (whole - 1) * count, [(parts - whole + 1) ** (k + 1) for k in range(STAGES)]
    last = [term * share for term, share in zip(rows[before : before + count], shares * size, strict=True)]
    return np.concatenate([first_of(rows, before), np.array(last)])


def change_over(pieces: Array, size: int) -> list[float]:
    """By how much so many numbers change over these polynomials."""
    terms = pieces.tolist()
    places = [range(number * STAGES, len(terms), size * STAGES) for number in range(size)]
    return [sum([sum(terms[first : first + STAGES]) for first in each]) for each in places]


def parts_left(terms: Sequence[float]) -> float:
    """How far beyond 1 a polynomial is zero, by its value and two derivatives there."""
    value = sum(terms)
    slope = sum([k * term for k, term in enumerate(terms)])
    bend = sum([k * (k - 1) * term for k, term in enumerate(terms)])
    rest = slope * slope - 2.0 * bend * value
    if slope >= 0.0 and bend >= 0.0:
        return math.inf
    return 2.0 * value / (-slope + rest**0.5) if rest > 0.0 else -slope / bend


def dips(speeds: Sequence[float]) -> bool:
    """Whether s comes near zero within a step, perhaps to it between two points."""
    least = min(speeds[1 : STAGES - 1])
    return min(speeds[0], speeds[STAGES - 1]) > least and 0.0 < least < DIP * max(speeds)
