"""Collocation at Radau's points: an implicit method of high order, for stiff motions.

A step's solution is the polynomial that starts where the step does and satisfies the equations of
motion at the points, the last of which is the step's end: Radau IIA, which damps what stiff
friction damps however long the step (Hairer and Wanner 1996, Solving Ordinary Differential
Equations II, IV.5 and IV.8). Its coefficients in Chebyshev's polynomials fall off as fast as the
motion is smooth, and say how good a solution it is.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cache
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.polynomial.chebyshev import chebval
from scipy.special import roots_jacobi

from tippetop.integrators.base import NO_START, NO_STEP, TOLERANCES, Array
from tippetop.integrators.rates import RightHandSide
from tippetop.integrators.sampling import Accepted, StepByStep

STAGES = 12
"""Points in a step: order 23 at its end."""

PARTS = 4
"""Parts of a step, each with a polynomial that stands for it in a solution."""

ORDERS = np.arange(STAGES + 1.0)
"""Orders of Chebyshev's polynomials in a step."""

LAST, SMOOTH = 2, 8
"""How many of the last coefficients tell the error of a step, and how many of the first guess at
the next.
"""

FLAT, FALLING = 0.1, (2, 6)
"""Part of those before them that the last coefficients are at least where they fall off no more;
and which of the first tell how they do.
"""

STAGE_CORRECTIONS, SETTLED, ROUGH = 10, 1e-15, 1e-9
"""Newton's iterations; the correction, relatively, after which there is none; and the largest
correction by rounding alone, which does not get smaller any more.
"""

SLOWER, FASTER, STEP_SAFETY = 0.25, 3.0, 0.8
"""How much shorter or longer the next step may be, and how much shorter it is than it should."""

FIRST = 1e-3
"""How far the state goes, relatively, in the first step."""

LEAST_STEP = 1e-15
"""A step shorter than this part of the time gets nowhere."""

TINY = 1e-300
"""Added to an error that may be zero."""

TOO_SHORT = "the step size fell below what it may be"
"""Why the method gives up where another is to go on."""


class Points(NamedTuple):
    """Radau's points and what belongs to them."""

    places: Array
    """0 and the points, as parts of a step, shape (s + 1,)."""
    integrals: Array
    """Integrals, from 0 to each point, of Lagrange's polynomials on the points, shape (s, s)."""
    transform: Array
    """From values at the places to coefficients in Chebyshev's polynomials, shape (s + 1, s + 1).
    """


@cache
def radau_points() -> Points:
    """Return Radau's points in (0, 1], `STAGES` of them."""
    inner = roots_jacobi(STAGES - 1, 1.0, 0.0)[0]
    points = np.append(0.5 + 0.5 * inner, 1.0)
    legendre = np.polynomial.legendre
    values = legendre.legvander(2.0 * points - 1.0, STAGES - 1)
    sums = [
        legendre.legval(2.0 * points - 1.0, legendre.legint(row, lbnd=-1)) for row in np.eye(STAGES)
    ]
    integrals = np.asarray(0.5 * np.array(sums).T @ np.linalg.inv(values), dtype=float)
    places = np.append(0.0, points)
    transform = np.linalg.inv(np.polynomial.chebyshev.chebvander(2.0 * places - 1.0, STAGES))
    return Points(places, integrals, np.asarray(transform, dtype=float))


@dataclass(frozen=True)
class Collocation(StepByStep):
    """Collocation at Radau's points with adaptive steps."""

    tolerance: float = TOLERANCES["collocation"]
    """Relative and absolute size of the last coefficients of a step's polynomials, at most."""
    shortest: float = 0.0
    """The method gives up where its steps would be shorter than this, and begins with such steps.
    """
    name: str = field(default="collocation", init=False)
    degree: ClassVar[int] = 11

    def steps(
        self, rates: RightHandSide, start: tuple[float, Array], end: float
    ) -> Iterator[Accepted | str]:
        """Yield the steps; see `StepByStep`."""
        (time, state), before, slope = start, None, rates(*start)
        if not np.all(np.isfinite(slope)):
            yield NO_START
            return
        step = self.shortest or FIRST / float(np.max(np.abs(slope) / scale(state)) + FIRST)
        while time < end:
            if step < max(self.shortest, LEAST_STEP * max(1.0, abs(time))):
                yield TOO_SHORT if self.shortest else NO_STEP
                return
            reach = end if step >= end - time else time + step
            solution, factor = self._step(rates, (time, state), reach, before)
            step, before = factor * (reach - time), solution
            if solution is None:
                continue

            def advance(at: float, base: Array = state, step: Step = solution) -> Array:
                return _landed(rates, base, step, at)

            for until in np.linspace(time, reach, PARTS + 1)[1:].tolist():
                state = solution.end_state if until == reach else solution(until)
                yield Accepted(until, state, solution, advance)
            time = reach

    def _step(
        self, rates: RightHandSide, start: tuple[float, Array], end: float, before: "Step | None"
    ) -> "tuple[Step | None, float]":
        """Return a step, None if none converges, and the factor for the length of the next."""
        places, _, transform = radau_points()
        times = start[0] + places[1:] * (end - start[0])
        guess = np.tile(start[1], (STAGES, 1)) if before is None else before.beyond(times)
        states = solved(rates, start[1], end - start[0], guess)
        if states is None:
            return None, SLOWER
        step = Step(start[0], end, transform @ np.vstack((start[1], states)), states[-1])
        sizes = np.max(np.abs(step.terms) / scale(np.vstack((start[1], states))), axis=1) + TINY
        error = float(np.max(sizes[-LAST:]))
        if error > self.tolerance:
            return None, max(STEP_SAFETY * (self.tolerance / error) ** (1.0 / STAGES), SLOWER)
        if error > FLAT * float(np.max(sizes[-2 * LAST : -LAST])):
            # Rounding, that is, in stiff motion: the first ones tell how they would fall off but
            # for that.
            (low, a), (high, b) = ((k, float(sizes[k])) for k in FALLING)
            error = min(error, b * (b / a) ** ((STAGES - high) / (high - low)) + TINY)
        return step, min(STEP_SAFETY * (self.tolerance / error) ** (1.0 / STAGES), FASTER)


@dataclass(frozen=True)
class Step:
    """The polynomial of a step, a function of time."""

    start: float
    end: float
    """Where it begins and ends."""
    terms: Array
    """Coefficients in Chebyshev's polynomials, shape (degree + 1, size)."""
    end_state: Array
    """The state at its end."""

    def __call__(self, time: Any) -> Array:
        """Return the solution at a time within the step, shape (size,), or at m times, shape (m,
        size).
        """
        # For one time the cosines take an eighth of what Clenshaw's recurrence takes.
        angle = np.arccos(np.clip(self._place(time), -1.0, 1.0))
        values: Array = np.cos(np.multiply.outer(angle, ORDERS)) @ self.terms
        return values

    def beyond(self, times: Array) -> Array:
        """Return the polynomial without its last terms at times after the step, shape (m, size)."""
        return np.asarray(chebval(self._place(times), self.terms[:SMOOTH])).T

    def _place(self, time: Any) -> Any:
        return 2.0 * (time - self.start) / (self.end - self.start) - 1.0


def solved(rates: RightHandSide, start: Array, span: float, guess: Array) -> Array | None:
    """Return the states at the points of a step, shape (s, size), by Newton's method; None if it
    does not converge.

    Of variational equations all directions and the numbers have one matrix, as if the derivatives
    did not depend on the numbers: they converge an iteration after these.
    """
    integrals, states, last = span * radau_points().integrals, guess, np.inf
    for _ in range(STAGE_CORRECTIONS):
        values, slopes = rates.linearized(states)
        if not (np.all(np.isfinite(values)) and np.all(np.isfinite(slopes))):
            return None
        size = slopes.shape[1]
        matrix = -np.einsum("ij,jab->iajb", integrals, slopes).reshape(STAGES * size, STAGES * size)
        matrix[np.diag_indices_from(matrix)] += 1.0
        errors = (start + integrals @ values - states).reshape(STAGES, -1, size)
        try:
            columns = np.linalg.solve(matrix, errors.swapaxes(1, 2).reshape(STAGES * size, -1))
        except np.linalg.LinAlgError:
            return None
        change = columns.reshape(STAGES, size, -1).swapaxes(1, 2).reshape(states.shape)
        states = states + change
        moved = float(np.max(np.abs(change) / scale(states)))
        if moved <= SETTLED or ROUGH >= moved >= 0.5 * last:
            return states
        last = moved
    return None


def _landed(rates: RightHandSide, start: Array, step: Step, end: float) -> Array:
    """Return the state after a step that begins as another does, and ends at exactly this time."""
    span = end - step.start
    states = solved(rates, start, span, step(step.start + span * radau_points().places[1:]))
    return step(end) if states is None else states[-1]


def scale(states: Array) -> Array:
    """Return the scale of relative errors: the size of each number, at least 1, over one or more
    states.
    """
    sizes: Array = np.maximum(1.0, np.max(np.abs(np.atleast_2d(states)), axis=0))
    return sizes
