"""Solutions as polynomials in time, one a step: what every integrator gives, whatever its method."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

Array: TypeAlias = NDArray[np.float64]

LEAST = 1e-280
"""Power of the length of a step that is as good as none: a very short step gets fewer terms."""


@dataclass(frozen=True)
class DenseSolution:
    """A solution over k steps.

    Attributes
    ----------
    knots
        Ends of the steps, increasing, shape (k + 1,).
    terms
        Coefficients in increasing powers of the time since the start of a step, shape (k, size, degree + 1).
    """

    knots: Array
    terms: Array

    @property
    def end(self) -> float:
        """Where it ends."""
        return float(self.knots[-1])

    def __call__(self, times: Array) -> Array:
        """The solution at times between the first and the last knot, shape (m, size)."""
        step = np.searchsorted(self.knots[1:-1], times, side="left")
        return evaluated(self.terms[step], times - self.knots[step])

    def until(self, time: float) -> "DenseSolution":
        """The solution up to a time in its last step."""
        return DenseSolution(np.append(self.knots[:-1], time), self.terms)

    @classmethod
    def joined(cls, parts: Sequence["DenseSolution"]) -> "DenseSolution":
        """Solutions that follow one another, of one degree, as one."""
        if len(parts) == 1:
            return parts[0]
        knots = np.concatenate([parts[0].knots, *(part.knots[1:] for part in parts[1:])])
        return cls(knots, np.concatenate([part.terms for part in parts]))

    @classmethod
    def fitted(cls, function: Callable[[Array], Array], knots: Array, degree: int) -> "DenseSolution":
        """Polynomials that agree with a function at Chebyshev's points of every step.

        Parameters
        ----------
        function
            Takes times, shape (m,), and returns values, shape (m, size).
        knots
            Ends of the steps, shape (k + 1,).
        degree
            Of the polynomials.
        """
        places, transform, to_powers = chebyshev(degree)
        spans = np.diff(knots)
        values = function((knots[:-1, None] + places * spans[:, None]).ravel())
        values = values.reshape(len(spans), degree + 1, values.shape[-1])
        scales = powers(spans, degree + 1)
        kept = scales > LEAST
        # Through Chebyshev's polynomials, whose coefficients fall off, so that no digits are lost.
        waves = np.where(kept[:, :, None], transform @ values, 0.0)
        unit = np.swapaxes(to_powers @ waves, 1, 2)
        return cls(knots, unit / np.where(kept, scales, 1.0)[:, None, :])


def evaluated(terms: Array, times: Array) -> Array:
    """Values of m polynomials, terms of shape (m, size, degree + 1), at one time each, shape (m, size)."""
    found: Array = (terms @ powers(times, terms.shape[2])[:, :, None])[:, :, 0]
    return found


def at_fractions(terms: Array, spans: Array, fractions: Array) -> Array:
    """Values of k polynomials at fractions, shape (m,), of their spans, shape (k,); of shape (size, m, k)."""
    unit = terms * powers(spans, terms.shape[2])[:, None, :]
    values = unit.reshape(-1, terms.shape[2]) @ powers(fractions, terms.shape[2]).T
    return np.ascontiguousarray(values.reshape(*terms.shape[:2], len(fractions)).transpose(1, 2, 0))


def powers(numbers: Array, count: int) -> Array:
    """The first powers of n numbers, shape (n, count)."""
    return np.vander(numbers, count, increasing=True)


@lru_cache
def chebyshev(degree: int) -> tuple[Array, Array, Array]:
    """Chebyshev's points in [0, 1], and the matrices from values there to his coefficients and to powers."""
    angles = np.pi * (np.arange(degree + 1) + 0.5) / (degree + 1)
    places: Array = 0.5 - 0.5 * np.cos(angles)
    transform = np.linalg.inv(np.polynomial.chebyshev.chebvander(2.0 * places - 1.0, degree))
    to_powers = np.zeros((degree + 1, degree + 1))
    for k in range(degree + 1):
        basis = np.polynomial.Chebyshev.basis(k, domain=[0.0, 1.0])
        terms = basis.convert(kind=np.polynomial.Polynomial, domain=[-1.0, 1.0], window=[-1.0, 1.0]).coef
        to_powers[: len(terms), k] = terms
    return places, np.asarray(transform, dtype=float), to_powers
