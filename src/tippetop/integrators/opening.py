"""The first step of a motion whose guards begin at zero, as the gap of a body that leaves the
table.

A gap opens with t, t^2 or t^3, after an impact, a release or a lift-off: what ended the mode before
says which. In a number that is zero but for rounding that could be seen neither at once nor in a
flight as short as rounding lets it appear. So the Taylor coefficients of a guard that vanish by
construction are left out, and it is divided by the power of time that it then has: what remains is
positive at the start, and its first fall is that of the guard.
"""

# translate module: numbers

import math
from collections.abc import Sequence

from tippetop.integrators.base import NOT_FINITE, Arc, Array, Motion
from tippetop.integrators.dense import DenseSolution, as_array
from tippetop.integrators.expansion import expanded
from tippetop.integrators.polynomial_zeros import LARGEST_POWER, first_fall
from tippetop.mechanics.series import horner


def opening(
    motion: Motion,
    parameters: Sequence[float],
    start: tuple[float, Array],
    end: float,
    vanishing: Sequence[int],
) -> Arc:
    """Follow a motion for one step of Taylor's method, or until a guard falls in it.

    Parameters
    ----------
    motion, parameters, start, end
        As `tippetop.integrators.base.Integrator.integrate` takes them.
    vanishing
        How many of the first Taylor coefficients of each guard are zero by construction. A guard
        whose next one is not positive falls at once.
    """
    time, state = start
    numbers, guards, margins = expanded(motion, parameters, state)
    span = min(step_length([*numbers, *guards]), end - time)
    if not span > 0.0:
        empty = DenseSolution.empty(time, len(numbers))
        return Arc(empty, state, None, NOT_FINITE, 0, 1)
    reach = end if span == end - time else time + span
    fallen = None
    for number in range(len(guards)):
        guard = powers_of_part(divided(guards[number], vanishing[number]), span)
        if guard[0] <= 0.0:
            empty = DenseSolution.empty(time, len(numbers))
            return Arc(empty, state, motion.guards[number].name, None, 0, 1)
        fall = span * first_fall(guard)
        if fall <= span and (fallen is None or time + fall < reach):
            fallen, span, reach = motion.guards[number].name, fall, min(time + fall, end)
    for margin in margins:
        # Beyond its fall a law's choice goes the other way, and so does the next step.
        fall = span * first_fall(powers_of_part(margin, span))
        if 0.0 < fall < span:
            fallen, span, reach = None, fall, time + fall
    solution = DenseSolution.in_time([time, reach], [numbers])
    last = as_array([horner(terms, span) for terms in numbers])
    return Arc(solution, last, fallen, None, 1, 1)


def step_length(rows: Sequence[Sequence[float]]) -> float:
    """Return the step in which the last terms of power series are below rounding (Jorba and Zou
    2005, Experimental Mathematics 14); 0 where they are no numbers.
    """
    radius = math.inf
    for terms in rows:
        size = max(abs(terms[0]), 1.0)
        for power in range(len(terms) - 2, len(terms)):
            ratio = abs(terms[power]) / size
            if not ratio < math.inf:
                return 0.0
            if ratio > 0.0:
                radius = min(radius, ratio ** (-1.0 / power))
    return math.exp(-2.0 - 0.7 / (len(rows[0]) - 2)) * radius


def divided(terms: Sequence[float], vanishing: int) -> list[float]:
    """Return a power series whose first coefficients vanish, divided by the power of time that it
    has; zero where all vanish.
    """
    first = vanishing
    while first < len(terms) - 1 and terms[first] == 0.0:
        first += 1
    return list(terms[first:])


def powers_of_part(terms: Sequence[float], span: float) -> list[float]:
    """Return coefficients in powers of the part of a step by those in powers of time."""
    scaled, power = list[float](), 1.0
    for term in terms:
        scaled.append(term * power)
        power = min(power * span, LARGEST_POWER)
    return scaled
