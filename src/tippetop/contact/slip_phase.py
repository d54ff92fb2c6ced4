"""Slip, or rolling, followed from its beginning by steps of collocation (see
`tippetop.mechanics.contacts.slip_collocation`).
"""

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple, TypeAlias

from tippetop.contact.slip_step import SlipStep
from tippetop.contact.surfaces import passes_flat
from tippetop.integrators.base import Array
from tippetop.mechanics.contacts.gauss_points import PARTS, STAGES
from tippetop.mechanics.contacts.slip_collocation import SlipMotion
from tippetop.mechanics.contacts.slip_variables import APART, inner, scaled, size
from tippetop.mechanics.contacts.wrench import Slip
from tippetop.mechanics.top import Top

FIRST_LENGTH = 0.7
"""Length of the first step that is tried, in natural units of time, about as long as the error
allows where slip recurs: a shorter one costs steps, a longer one fails.
"""

LEAST = 0.005
"""Shortest step, in natural units of time, below which slip does not follow what drives it and
other methods are quicker.
"""

LEAST_PART = 0.05
"""The same over the length of the first step, where all of the motion is fast."""

LEAST_FIRST = 1e-13
"""Shortest step at the beginning or the end of slip, in natural units of time, below which rounding
of the numbers hides what begins.
"""

ACCURACY = 1e-22
"""Largest sum of the squares of the last coefficients of a step, in natural units. The solution
divides them by thirty and more, and the error at the end of a step is of the order of their
product.
"""

ROUNDING = 1e-28
"""The same, over the sum of the squares of the changes of the numbers, that rounding of them makes.
"""

BEYOND = 1.05
"""Length of a step over the time that slip seems to last, so that the end lies within."""

DIP = 0.1
"""Fraction of the largest speed in a step below which the speed may vanish between two points."""

NO_SPEED = 1e-11
"""Speed, in natural units, that counts as zero at the end of slip."""

LONGER = 1.5
"""Largest ratio of a step to the one before."""

SHORTER, SHORTEST = 0.8, 0.3
"""Largest and smallest ratio of a step to the one that failed."""

HALF = 0.5
"""Ratio of a step to the one in which a margin falls."""

SAFETY = 0.9
"""Ratio of a step to the one that the error allows."""

LEAST_ERROR = 1e-300
"""Added to an error that may be zero."""


LongestStep: TypeAlias = Callable[[Sequence[float], Slip], float]
"""From the numbers and the direction of the first velocity to the length of a step, in natural
units of time, at most.
"""


class SlipPhase(NamedTuple):
    """Motion since velocities began, as far as it was followed."""

    knots: list[float]
    """Ends of its polynomials since then."""
    rows: list[Array]
    """For every step, coefficients of the numbers in powers of the elapsed fraction of each
    polynomial, from the first power on, in a row.
    """
    last: list[float]
    """The numbers where it ends."""
    ended: bool
    """Whether slip has ended there."""
    sweeps: int
    """Sweeps of all its steps."""


def follow_slip(
    motion: SlipMotion,
    top: Top,
    start: tuple[Sequence[float], Sequence[Slip]],
    longest: float,
    *,
    to_end: bool = False,
    longest_step: LongestStep | None = None,
    numbers: tuple[float, ...],
) -> SlipPhase:
    """Follow velocities that begin: for one step, or as far as the method goes.

    No polynomials are returned where no step succeeds.

    Parameters
    ----------
    motion
        The equations of motion.
    top
        The body.
    start
        The numbers where the velocities, the last of them, are zero; and their directions.
    longest
        For how long they are followed at most, in natural units of time.
    to_end
        Whether the one velocity, in a plane, is followed to its end if it stays slow.
    longest_step
        How long a step may be at most.
    numbers
        The parameters of the motion.
    """
    step = SlipStep(motion, numbers)
    now, directions, length = [*start[0]], [*start[1]], FIRST_LENGTH
    first, count = motion.velocities[0]
    knots, rows, ended = [0.0], list[Array](), False

    def velocity(numbers: Sequence[float]) -> Slip:
        return tuple(numbers[first : first + count])

    least, goes_on = LEAST_FIRST, longest > 0.0
    while goes_on:
        begin, finished, before = knots[-1], len(knots), now
        length = min(length, longest - begin)
        if longest_step is not None:
            length = min(length, longest_step(now, directions[0]))
        solved = step.solve(now, directions, length)
        changes = step.changes
        accuracy = ACCURACY + ROUNDING * inner(tuple(changes), tuple(changes))
        factor = (
            SAFETY * (accuracy / (step.error + LEAST_ERROR)) ** (0.5 / STAGES) if solved else 0.0
        )
        after, part = [a + b for a, b in zip(now, changes, strict=True)], float(PARTS)
        last, speeds = step.last_direction, step.speeds
        lasts = step.least_speed > 0.0 and inner(velocity(after), last) > 0.0
        bad = factor < SAFETY or (not lasts and not to_end) or (to_end and dips(speeds))
        ratio = max(min(factor, SHORTER), SHORTEST)
        if not bad and not lasts:
            end = step.end_of_slip(velocity(now), speeds)
            bad, part = end is None, part if end is None else end
        if not bad and (step.margin_falls() or passes_flat(top, [now, *step.axes, after])):
            bad, ratio = True, HALF
        if bad:
            length *= ratio
            if length < least:
                break
            continue
        if not rows:
            least = min(LEAST, LEAST_PART * length)
        ended, goes_on = not lasts, False
        pieces = step.pieces(part)
        ends = [min(part, number + 1.0) / PARTS for number in range(PARTS) if part > number]
        knots += [begin + length * end for end in ends]
        if ended:
            now = [a + b for a, b in zip(now, change_over(pieces, len(now)), strict=True)]
            if not size(velocity(now)) < NO_SPEED:
                # Its direction turned by so much that it ends elsewhere.
                return SlipPhase(knots[:finished], rows, before, False, step.sweeps)
        else:
            if length == longest - begin:
                knots[len(knots) - 1] = longest
            now, directions = after, [scaled(1.0 / size(velocity(after)), velocity(after))]
            if to_end:
                speed = step.speed(PARTS - 1, 0.0, last)
                speed[0] = inner(velocity(after), last) - sum(speed)
                remaining = length / PARTS * parts_left(speed)
                allowed = length * min(factor, LONGER)
                # The end of slip may be nearer than the shortest step that the error asks for.
                length = min(allowed, BEYOND * remaining)
                slow = size(velocity(now)) < APART
                goes_on = slow and allowed >= least and length >= LEAST_FIRST
                goes_on = goes_on and knots[-1] < longest
        rows.append(pieces)
    return SlipPhase(knots, rows, now, ended, step.sweeps)


def change_over(pieces: Array, size: int) -> list[float]:
    """Return the changes of so many numbers over polynomials."""
    terms = pieces.tolist()
    places = [range(number * STAGES, len(terms), size * STAGES) for number in range(size)]
    return [sum([sum(terms[first : first + STAGES]) for first in each]) for each in places]


def parts_left(terms: Sequence[float]) -> float:
    """Return how far beyond 1 a polynomial is zero, by its value and two derivatives there: where
    it is nowhere, how far its least value is, and infinity where it grows.
    """
    value = sum(terms)
    slope = sum([k * term for k, term in enumerate(terms)])
    bend = sum([k * (k - 1) * term for k, term in enumerate(terms)])
    square = slope * slope - 2.0 * bend * value
    if slope >= 0.0 and bend >= 0.0:
        return math.inf
    return 2.0 * value / (-slope + square**0.5) if square > 0.0 else -slope / bend


def dips(speeds: Sequence[float]) -> bool:
    """Return whether the speed comes near zero within a step, perhaps to it between two points."""
    least = min(speeds[1 : STAGES - 1])
    return min(speeds[0], speeds[STAGES - 1]) > least and 0.0 < least < DIP * max(speeds)
