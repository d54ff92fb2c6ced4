"""First zeros and extremes of many polynomials at once, each on its own interval from zero."""

# translate module: skip

import math
from collections.abc import Callable, Sequence
from functools import cached_property, lru_cache
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from tippetop.integrators.dense import Array, powers
from tippetop.integrators.polynomial_zeros import bernstein, first_fall
from tippetop.mechanics.vectors import Row, Scalar

Choice: TypeAlias = Callable[[Any, Any, Any], Any]
"""What chooses between two by a flag: of numbers, or of arrays."""

INTERVALS = 32
"""Intervals at whose ends a polynomial is looked at; between them its second derivative bounds it.
"""

ONE_BY_ONE = 4
"""So many polynomials at most are taken one by one in plain numbers, quicker than arrays so short.
"""

TOGETHER = 256
"""Columns that are multiplied at once: of a few hundred more, threads cost several times what they
save.
"""


@lru_cache
def _places(count: int) -> Array:
    """Return the first powers of the places of the looks, shape (INTERVALS + 1, count)."""
    return powers(np.linspace(0.0, 1.0, INTERVALS + 1), count)


@lru_cache
def _of_the_rest(count: int) -> Array:
    """Return the matrix that takes powers of u to those of 1 - u, shape (count, count)."""
    signed = [
        [(-1) ** row * math.comb(power, row) for power in range(count)] for row in range(count)
    ]
    return np.array(signed, dtype=float)


@lru_cache
def _bernstein_matrix(count: int) -> Array:
    """Return the matrix from coefficients in powers to Bernstein's, shape (count, count)."""
    return np.array([bernstein(row) for row in np.eye(count).tolist()]).T


class Polynomials:
    """Polynomials on intervals.

    Parameters
    ----------
    terms
        Coefficients in increasing order, shape (degree + 1, n).
    span
        Ends of the intervals, from 0, shape (n,).
    """

    def __init__(self, terms: Array, span: Array) -> None:
        self.span = span
        self.unit = terms * powers(span, len(terms)).T

    @classmethod
    def of_unit(cls, unit: Array, span: Array) -> "Polynomials":
        """Polynomials whose coefficients are in powers of the part of their intervals that has
        passed.
        """
        polynomials = cls.__new__(cls)
        polynomials.span, polynomials.unit = span, unit
        return polynomials

    @property
    def sag(self) -> Array:
        """How far a polynomial can go beyond its values at Gauss's eight points, shape (n,)."""
        k = np.arange(len(self.unit))
        # Between two of them by interval^2 / 8 max |f''|, and beyond the outer ones by distance max
        # |f'|.
        return times(np.maximum(k * (k - 1) * (0.19**2 / 8.0), k * 0.02), np.abs(self.unit))

    @cached_property
    def values(self) -> Array:
        """Values at the looks, shape (INTERVALS + 1, n)."""
        return times(_places(len(self.unit)), self.unit)

    @cached_property
    def bending(self) -> Array:
        """How far a polynomial can lie below two neighbouring looks: interval^2 / 8 max |f''|,
        shape (n,).
        """
        k = np.arange(len(self.unit))
        return times(k * (k - 1) / (8.0 * INTERVALS**2), np.abs(self.unit))

    @cached_property
    def lowest(self) -> Array:
        """Least values at the looks, shape (n,)."""
        least: Array = self.values.min(axis=0)
        return least

    @property
    def floor(self) -> Array:
        """Numbers below which no polynomial goes, a little below its looks, shape (n,)."""
        return self.lowest - self.bending

    def some(
        self, which: NDArray[np.intp], sign: Array | float = 1.0, shift: Array | float = 0.0
    ) -> "Polynomials":
        """Return some of the polynomials, times signs and plus numbers."""
        unit = sign * self.unit.take(which, axis=1)
        unit[0] += shift
        return Polynomials.of_unit(unit, self.span.take(which))

    def backward(self) -> "Polynomials":
        """Return the polynomials as functions of the time that is left of their intervals."""
        return Polynomials.of_unit(times(_of_the_rest(len(self.unit)), self.unit), self.span)

    def first_fall(
        self, from_above: bool = False, after_rise: bool | NDArray[np.bool_] = False
    ) -> Array:
        """First times at which the polynomials fall to zero from above, nan where they do not,
        shape (n,).

        See `tippetop.integrators.polynomial_zeros`; `after_rise` is of all, or of each.
        """
        zeros = np.full(len(self.span), np.nan)
        bounds = times(_bernstein_matrix(len(self.unit)), self.unit)
        which = np.flatnonzero((bounds <= 0.0).any(axis=0))
        rising = np.broadcast_to(after_rise, zeros.shape)[which].tolist()
        each = zip(self.unit[:, which].T.tolist(), rising, strict=True)
        zeros[which] = [first_fall(terms, from_above, rises) for terms, rises in each]
        return zeros * self.span

    def refined_least(self) -> tuple[Array, Array]:
        """Times at which the least values are taken, and those values, by Newton's method; of shape
        (n,).
        """
        best = self.values.argmin(axis=0)
        place, value = best / INTERVALS, self.lowest.copy()
        # At an end away from which it rises there is nothing to find.
        rises = (best == 0) & (self.unit[1] >= 0.0)
        rises |= (best == INTERVALS) & (times(np.arange(float(len(self.unit))), self.unit) <= 0.0)
        dips = np.flatnonzero(~rises)
        if len(dips):
            # The parabola through the least look and its neighbours is near it.
            inside = np.minimum(np.maximum(best[dips], 1), INTERVALS - 1)
            before, middle, after = (self.values[inside + k, dips] for k in (-1, 0, 1))
            bend = before - 2.0 * middle + after
            vertex = inside + 0.5 * (before - after) / np.where(bend > 0.0, bend, np.inf)
            guess = np.where(np.abs(vertex - best[dips]) <= 1.0, vertex, best[dips]) / INTERVALS
            places, low = of_each(_least_near, self.unit[:, dips], guess)
            better = (places >= 0.0) & (places <= 1.0) & (low < value[dips])
            place[dips[better]], value[dips[better]] = places[better], low[better]
        return place * self.span, value

    def negative(self) -> "Polynomials":
        """Return the polynomials times -1."""
        polynomials = Polynomials.of_unit(-self.unit, self.span)
        polynomials.values, polynomials.bending = -self.values, self.bending
        return polynomials


def times(matrix: Array, columns: Array) -> Array:
    """Return a matrix, or a row, times columns: so few at once that NumPy's library has no use for
    threads.
    """
    count = columns.shape[1]
    if count <= TOGETHER:
        return np.asarray(matrix @ columns)
    parts = [matrix @ columns[:, first : first + TOGETHER] for first in range(0, count, TOGETHER)]
    return np.concatenate(parts, axis=-1)


class Least(NamedTuple):
    """The least value of a lot of polynomials, and where it is taken."""

    value: float
    """The value; inf of a lot without any."""
    row: int = -1
    """Number of the polynomial, counted over the lot."""
    time: float = np.nan
    """Time since the begin of that polynomial."""


def least_of_each(*lots: Sequence["Polynomials"]) -> list[Least]:
    """Return the least values of several lots of polynomials."""
    every = [one for lot in lots for one in lot]
    counts = [sum(len(one.span) for one in lot) for lot in lots]
    owner = np.repeat(np.arange(len(lots)), counts)
    unit, first = np.zeros((max((len(one.unit) for one in every), default=2), len(owner))), 0
    for one in every:
        unit[: len(one.unit), first : first + len(one.span)] = one.unit
        first += len(one.span)
    spans = np.concatenate([one.span for one in every]) if every else np.empty(0)
    joined = Polynomials.of_unit(unit, spans)
    least = np.full(len(lots), np.inf)
    np.fmin.at(least, owner, joined.lowest)
    lower = np.flatnonzero(joined.floor <= least[owner])
    times, values = joined.some(lower).refined_least()
    results = list[Least]()
    for lot, begin in enumerate(np.cumsum([0, *counts[:-1]])):
        which = np.flatnonzero(owner[lower] == lot)
        if not len(which):
            results.append(Least(float(least[lot])))
            continue
        best = which[np.argmin(values[which])]
        results.append(Least(float(values[best]), int(lower[best] - begin), float(times[best])))
    return results


def of_each(find: Callable[..., Any], unit: Array, *numbers: Array) -> Array:
    """Apply a function to many polynomials at once, or, where they are few, to one after the other.

    Either way it does not depend on the others: each stands still where it has arrived.
    """
    if len(numbers[0]) > ONE_BY_ONE:
        return np.asarray(find(unit, *numbers, np.where, np.any))
    each = zip(unit.T.tolist(), *(column.tolist() for column in numbers), strict=True)
    return np.array([find(*one, _chosen, bool) for one in each]).T


def _least_near(
    terms: Row, guess: Scalar, where: Choice, some: Callable[[Any], Any]
) -> tuple[Scalar, Scalar]:
    """Return the place of a least value no further than a look from a guess, and that value, by
    Newton's method.
    """
    slopes = [power * term for power, term in enumerate(terms)][1:]
    first, last, place, moving = guess - 1.0 / INTERVALS, guess + 1.0 / INTERVALS, guess, True
    for _ in range(5):
        slope, bend = _horner(slopes, place)
        move = where(moving, slope / where(bend > 0.0, bend, np.inf), 0.0)
        place = where(place - move < first, first, where(place - move > last, last, place - move))
        moving = abs(move) > 1e-9
        if not some(moving):
            break
    return place, _horner(terms, place)[0]


def _chosen(flag: bool, yes: float, no: float) -> float:
    """Return what `numpy.where` chooses, of plain numbers."""
    return yes if flag else no


def _horner(terms: Row, place: Scalar) -> tuple[Scalar, Scalar]:
    """Return the value and first derivative of a polynomial."""
    value, slope = terms[-1], 0.0 * place
    for term in terms[-2::-1]:
        slope = slope * place + value
        value = value * place + term
    return value, slope
