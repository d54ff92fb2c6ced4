"""Solutions as polynomials in time, one a step: what every integrator gives, whatever its
method.
"""

# translate module: by hand in dense.js

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tippetop.mechanics.vectors import Row

Array: TypeAlias = NDArray[np.float64]

TIME_CORRECTIONS = 6
"""Improvements of a time at which a component has some value."""

TIME_FOUND = 3e-9
"""Improvement of a time by Newton's method, as part of a step, at which the method stops: the next
one, of the order of its square, would be rounding.
"""

SHORTEST = 1e-8
"""Distance to the end, relative to the end, within which a knot is left out, so that the last step
is not tiny.
"""

ALONE = 2**17
"""Multiplications of a product of matrices that one thread does: several wait for each other, and
for other programs.
"""

FEW_NUMBERS = 64
"""Numbers whose powers are made one after another, and not all at once."""

BATCH = 1024
"""Polynomials that are evaluated at a time, so that their coefficients stay in the processor's
cache.
"""

KEPT = 2**24
"""Size of memory, in bytes, that an allocator is to keep for the next arrays where these are freed.
"""

# That of GNU's C library gives all back to the system that is larger than the largest it has seen
# freed, and fetching it again page by page takes a third as long as a run.
np.empty(KEPT, dtype=np.uint8)


@dataclass(frozen=True)
class DenseSolution:
    """A solution over k steps."""

    knots: Array
    """Ends of the steps, increasing, shape (k + 1,)."""
    terms: Array
    """Coefficients in increasing powers of the part of a step that has passed, shape (k, size,
    degree + 1).
    """

    @property
    def size(self) -> int:
        """How many numbers it has."""
        return int(self.terms.shape[1])

    @property
    def unresolved(self) -> float:
        """Size of the largest last term of its polynomials, in Chebyshev's."""
        largest = float(np.abs(self.terms[:, :, -1]).max(initial=0.0))
        return float(largest * 2.0 ** (3 - 2 * self.terms.shape[2]))

    @property
    def end(self) -> float:
        """Where it ends."""
        return float(self.knots[-1])

    def __call__(self, times: Array) -> Array:
        """Return the solution at times between the first and the last knot, shape (m, size)."""
        step = np.minimum(np.searchsorted(self.knots[1:], times, side="left"), len(self.terms) - 1)
        return evaluated(self.terms, step, parts_of(times, self.knots[step], self.knots[step + 1]))

    def rows(self, times: Array) -> Sequence[Array]:
        """Return the numbers of the solution at times, each of shape (m,)."""
        return tuple(self(times).T)

    def until(self, step: int, part: float) -> "DenseSolution":
        """Return the solution up to an instant, told by its step and the part of it that has
        passed; a step of which nothing has passed is left out.
        """
        if part == 0.0:
            return DenseSolution(self.knots[: step + 1], self.terms[:step])
        knots, terms = self.knots[: step + 2].copy(), self.terms[: step + 1].copy()
        knots[-1] = knots[-2] + part * (knots[-1] - knots[-2])
        terms[-1] *= part ** np.arange(terms.shape[2])
        return DenseSolution(knots, terms)

    def moved(self, start: float, end: float) -> "DenseSolution":
        """Return the solution, whose time begins at zero, from `start` on; it ends exactly at
        `end`.
        """
        knots = start + self.knots
        knots[-1] = end
        return DenseSolution(knots, self.terms)

    def in_units(
        self, start: float, time_unit: float, units: Sequence[float], end: float
    ) -> "DenseSolution":
        """Return the solution, whose time begins at zero in some unit, from `start` on, with every
        number times its own unit; it ends exactly at `end`.
        """
        knots = start + time_unit * self.knots
        knots[-1] = end
        return DenseSolution(knots, self.terms * np.asarray(units)[:, None])

    def subdivided(self, parts: int) -> "DenseSolution":
        """Return the same solution with every step in so many of equal length."""
        if parts == 1 or not len(self.terms):
            return self
        count, (size, powers_) = len(self.terms), self.terms.shape[1:]
        terms = np.einsum("sni,jim->sjnm", self.terms, _parts(powers_, parts))
        begins = self.knots[:-1, None] + np.diff(self.knots)[:, None] * (np.arange(parts) / parts)
        knots = np.append(begins.ravel(), self.knots[-1])
        return DenseSolution(knots, terms.reshape(count * parts, size, powers_))

    def knots_of(self, number: int, end: float) -> list[float]:
        """Values of a component that grows, where every other step begins before it reaches `end`;
        and `end`.

        A step is short beside the radius of convergence, and two still are.
        """
        shown = self.terms[::2, number, 0]
        return [*shown[shown < end * (1.0 - SHORTEST)].tolist(), end]

    def when(self, number: int, values: Array) -> Array:
        """Times at which a component that grows has some values, by Newton's method, shape (m,)."""
        begins, lasts = self.terms[:, number, 0], self.terms[:, number, 1:].sum(axis=1)
        step = np.clip(np.searchsorted(begins, values, side="right") - 1, 0, len(begins) - 1)
        terms, part = self.terms[step, number], (values - begins[step]) / lasts[step]
        slopes = terms[:, 1:] * np.arange(1, terms.shape[1])
        for _ in range(TIME_CORRECTIONS):
            places = powers(part, terms.shape[1])
            error = values - np.einsum("mk,mk->m", terms, places)
            better = np.clip(part + error / np.einsum("mk,mk->m", slopes, places[:, :-1]), 0.0, 1.0)
            moved, part = np.abs(better - part).max(initial=0.0), better
            if moved <= TIME_FOUND:
                break
        times: Array = self.knots[step] + part * (self.knots[step + 1] - self.knots[step])
        return times

    @classmethod
    def empty(cls, time: float, size: int) -> "DenseSolution":
        """No solution at all."""
        return cls(np.array([time]), np.empty((0, size, 1)))

    @classmethod
    def of_steps(
        cls, knots: Array, terms: Array, size: int, count: int, width: int
    ) -> "DenseSolution":
        """Return the solution of the first `count` steps, from rows that hold further numbers
        beside it.
        """
        steps = terms.reshape(len(knots) - 1, width, -1)
        return cls(knots[: count + 1].copy(), steps[:count, :size].copy())

    @classmethod
    def of_rows(
        cls, knots: Sequence[float], start: Sequence[float], rows: Sequence[Array]
    ) -> "DenseSolution":
        """Steps whose coefficients from the first on lie in rows, from the numbers with which they
        begin.
        """
        later = np.concatenate(rows).reshape(len(knots) - 1, len(start), -1)
        terms = np.empty((*later.shape[:2], later.shape[2] + 1))
        terms[:, :, 1:], terms[0, :, 0] = later, start
        terms[1:, :, 0] = later[:-1].sum(axis=2)
        np.add.accumulate(terms[:, :, 0], axis=0, out=terms[:, :, 0])
        return cls(np.array(knots), terms)

    @classmethod
    def joined(cls, parts: Sequence["DenseSolution"]) -> "DenseSolution":
        """Solutions that follow one another as one."""
        if len(parts) == 1:
            return parts[0]
        knots = np.concatenate([parts[0].knots, *(part.knots[1:] for part in parts[1:])])
        terms = np.zeros(
            (len(knots) - 1, parts[0].terms.shape[1], max(p.terms.shape[2] for p in parts))
        )
        first = 0
        for part in parts:
            terms[first : first + len(part.terms), :, : part.terms.shape[2]] = part.terms
            first += len(part.terms)
        return cls(knots, terms)

    @classmethod
    def in_time(cls, knots: ArrayLike, terms: ArrayLike) -> "DenseSolution":
        """Return the solution by coefficients in powers of the time since a step's start."""
        ends, coefficients = np.array(knots, dtype=float), np.asarray(terms, dtype=float)
        with np.errstate(over="ignore"):  # the step of a motion that stands still has no bound
            lengths = powers(ends[1:] - ends[:-1], coefficients.shape[2])
        if not np.isfinite(lengths[:, -1]).all():
            lengths = np.nan_to_num(lengths)
        # Rows as long as those of the terms are multiplied in half the time.
        scaled = np.repeat(lengths[:, None, :], coefficients.shape[1], axis=1)
        scaled *= coefficients
        return cls(ends, scaled)

    @classmethod
    def fitted(
        cls, function: Callable[[Array], Row], knots: Sequence[float] | Array, degree: int
    ) -> "DenseSolution":
        """Polynomials that agree with a function at Chebyshev's points of every step.

        Parameters
        ----------
        function
            Takes times, shape (m,), and returns numbers, each of shape (m,), or one for all.
        knots
            Ends of the steps, shape (k + 1,).
        degree
            Of the polynomials.
        """
        places, transform, to_powers = chebyshev(degree)
        knots = np.asarray(knots, dtype=float)
        rows = function((knots[:-1, None] + places * np.diff(knots)[:, None]).ravel())
        values = table(rows, places.size * (len(knots) - 1)).reshape(
            len(knots) - 1, degree + 1, len(rows)
        )
        # Through Chebyshev's polynomials, whose coefficients fall off, so that no digits are lost.
        return cls(knots, np.swapaxes(to_powers @ (transform @ values), 1, 2))


def table(rows: Row, count: int) -> Array:
    """Numbers, of so many values each, or of one for all, beside one another: shape (count, n)."""
    columns = np.empty((len(rows), count))
    for place, row in enumerate(rows):
        columns[place] = row
    return columns.T


def as_array(numbers: Sequence[float]) -> Array:
    """Numbers as integrators take them."""
    return np.array(numbers, dtype=float)


def longer(numbers: Array, count: int) -> Array:
    """So many numbers: these, and zeros."""
    return np.concatenate([numbers, np.zeros(count - len(numbers))])


def parts_of(times: Array, starts: Array, ends: Array) -> Array:
    """Return the part of their steps that has passed at some times; 0 in steps of no length."""
    spans = ends - starts
    parts: Array = (times - starts) / np.where(spans > 0.0, spans, 1.0)
    return parts


def evaluated(terms: Array, which: NDArray[np.intp], parts: Array) -> Array:
    """Values of polynomials, terms of shape (k, size, degree + 1), at one place each, shape (m,
    size).
    """
    values = np.empty((len(parts), terms.shape[1]))
    for first in range(0, len(parts), BATCH):
        batch = slice(first, first + BATCH)
        places = np.ascontiguousarray(powers(parts[batch], terms.shape[2]))
        np.matmul(terms.take(which[batch], axis=0), places[:, :, None], out=values[batch, :, None])
    return values


def at_fractions(terms: Array, fractions: Array) -> Array:
    """Values of k polynomials at fractions of their steps, shape (m,); of shape (size, m, k)."""
    values = np.empty((terms.shape[1], len(fractions), len(terms)))
    places = powers(fractions, terms.shape[2])
    most = max(ALONE // max(places.size, 1), 1)
    for first in range(0, len(terms), most):
        batch = slice(first, first + most)
        np.matmul(places, terms[batch].transpose(1, 2, 0), out=values[:, :, batch])
    return values


def powers(numbers: Array, count: int) -> Array:
    """Return the first powers of n numbers, shape (n, count)."""
    if len(numbers) <= FEW_NUMBERS:
        return np.vander(numbers, count, increasing=True)
    rows = np.ones((count, len(numbers)))
    for power in range(1, count):
        np.multiply(rows[power - 1], numbers, out=rows[power])
    return rows.T


@lru_cache
def _parts(count: int, parts: int) -> Array:
    """Return the matrices from coefficients in powers of a place in [0, 1] to those in powers of a
    place in each of its equal parts, shape (parts, count, count).
    """
    matrices = np.zeros((parts, count, count))
    for part in range(parts):
        for power in range(count):
            for place in range(power + 1):
                matrices[part, power, place] = (
                    math.comb(power, place) * part ** (power - place) / parts**power
                )
    return matrices


@lru_cache
def chebyshev(degree: int) -> tuple[Array, Array, Array]:
    """Chebyshev's points in [0, 1], and the matrices from values there to his coefficients and to
    powers.
    """
    size = degree + 1
    angles = np.pi * (np.arange(size) + 0.5) / size
    places: Array = 0.5 - 0.5 * np.cos(angles)
    # Orthogonal on these points: the inverse of the matrix of values is its transposed one, scaled.
    # Angles are whole parts of a turn, and reduced as such: no rounding is multiplied.
    turns = np.outer(np.arange(size), 2 * np.arange(size)[::-1] + 1) % (4 * size)
    quarters = 1.0 - np.minimum(turns, 4 * size - turns) / size
    transform: Array = np.sin(np.pi / 2.0 * quarters) * (2.0 / size)
    transform[0] = 1.0 / size
    to_powers = np.zeros((size, size))
    for k in range(size):
        basis = np.polynomial.Chebyshev.basis(k, domain=[0.0, 1.0])
        terms = basis.convert(
            kind=np.polynomial.Polynomial, domain=[-1.0, 1.0], window=[-1.0, 1.0]
        ).coef
        to_powers[: len(terms), k] = terms
    return places, transform, to_powers
