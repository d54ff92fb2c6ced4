"""The end of slip on a patch whose direction has come to rest, in one step of collocation.

On a small patch drilling ends much more slowly than friction turns the direction of slip, which
soon is the one in which all of it ends. The rest of the turning, the term s^kappa of
`tippetop.mechanics.contacts.slip_collocation`, is below rounding then, and the solution is smooth
up to the end: one step of collocation goes from a known speed to zero, with its length unknown.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from tippetop.contact.slip_step import SlipStep
from tippetop.integrators.base import Array
from tippetop.integrators.dense import DenseSolution
from tippetop.mechanics.contacts.gauss_points import PARTS, STAGES
from tippetop.mechanics.contacts.slip_clock import SlipEndRates, SlipEndState
from tippetop.mechanics.contacts.slip_collocation import SlipMotion
from tippetop.mechanics.contacts.slip_variables import inner, scaled, size
from tippetop.mechanics.series import horner
from tippetop.mechanics.vectors import Scalar

SMOOTH = 1e-11
"""Largest last coefficients of the step, over the speed at its start."""

SLOWEST = 1e-5
"""The same over this speed, in natural units, where slip is slower: the rounding of the other
numbers is as large there.
"""

STEADY = 1e-12
"""Largest angle between the direction of slip and that of the step, times the time that is left, in
natural units.
"""

STATE_ROUNDING = 1e-15
"""The same angle times the speed, in natural units, which is the rounding of a state."""


@dataclass(frozen=True)
class CollocatedEnd:
    """The end of slip."""

    time_left: float
    """The time until slip ends."""
    start: list[Scalar]
    """The numbers of the mode and the slip now."""
    free: int
    """How many of them come before the slip."""
    terms: Array
    """Coefficients of their polynomials, as of `SlipStep.pieces`."""

    def at(self, part: float) -> list[Scalar]:
        """Return the numbers where a part of the time is left; slip is exactly zero at the end."""
        return self.rows([part])[0]

    def rows(self, parts: Sequence[float]) -> list[list[Scalar]]:
        """Return the numbers at several parts of the time that are left, one row each."""
        terms = self.terms.tolist()
        return [self._row(terms, part) for part in parts]

    def _row(self, terms: Sequence[float], part: float) -> list[Scalar]:
        count, place = len(self.start), PARTS * (1.0 - part)
        full, numbers = min(int(place), PARTS - 1), list[Scalar]()
        for number, begin in enumerate(self.start):
            value = begin
            for earlier in range(full + 1):
                first = (earlier * count + number) * STAGES
                elapsed = min(place - earlier, 1.0)
                value = value + elapsed * horner(terms[first : first + STAGES], elapsed)
            numbers.append(value)
        zeros = [0.0 for _ in numbers[self.free :]]
        return numbers if part > 0.0 else [*numbers[: self.free], *zeros]

    def solution(self, time: float) -> DenseSolution:
        """Return the numbers as polynomials in time from an instant on."""
        knots = [self.time_left * part / PARTS for part in range(PARTS + 1)]
        return DenseSolution.of_rows(knots, self.start, [self.terms]).moved(
            time, time + self.time_left
        )


def collocated_end(
    state: SlipEndState,
    rates: SlipEndRates,
    motion: SlipMotion,
    parameters: tuple[float, ...],
    tolerance: float,
) -> CollocatedEnd | None:
    """Return the end of slip from a state on; None where its direction has not come to rest.

    Parameters
    ----------
    state, rates
        The state, and its rates in time.
    motion, parameters
        The equations of motion while slip begins or ends, and their parameters.
    tolerance
        Error of the directions that an integrator has left.
    """
    along = inner(rates.xi, state.direction)
    if along >= 0.0:
        return None
    step = SlipStep(motion, parameters, from_end=True)
    now, free = [*state.numbers], len(state.numbers)
    start, guess = [*now, *[0.0 for _ in state.direction]], [-state.speed / along]
    if not step.solve(start, [state.direction], state.speed, guess):
        return None
    slip = tuple([-change for change in step.changes[free:]])
    aside = math.dist(state.direction, scaled(1.0 / size(slip), slip))
    steady = aside * step.length < max(STEADY, tolerance)
    if not (steady or aside * state.speed < STATE_ROUNDING):
        return None
    smooth = step.error < (SMOOTH * max(state.speed, SLOWEST)) ** 2
    if not smooth or step.least_speed <= 0.0:
        return None
    return CollocatedEnd(step.length, [*now, *slip], free, step.pieces(float(PARTS)))
