"""Slip from its beginning to its end, step by step of collocation (see
`tippetop.mechanics.slip_phase`).
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

from tippetop.contact.slip_step import SlipStep
from tippetop.integrators.base import Array
from tippetop.mechanics.ending import Vanishing
from tippetop.mechanics.slip_phase import PARTS, STAGES
from tippetop.mechanics.stick_slip import APART, inner, scaled, size
from tippetop.mechanics.top import Top
from tippetop.mechanics.wrench import Slip

FIRST, LEAST = 0.5, 0.005
"""The first step, in natural units of time, and the least that a step is shortened to: where
shorter ones are asked for, slip does not follow what drives it, and other methods are quicker.
"""

ACCURACY = 1e-22
"""Sum of the squares of the last coefficients of a step, in natural units, that is small: in the
solution they are divided by thirty and more, and the error of what a step ends with is of the order
of their product.
"""

BEYOND = 1.05
"""How much longer a step is than slip seems to last, so that its end lies within."""

DIP, NONE = 0.1, 1e-11
"""Slip within a step, as part of the most in it, that may be none between two points; and slip, in
natural units, that is none where it ends.
"""

LONGER, SHORTER, SHORTEST, SAFETY = 1.5, 0.8, 0.3, 0.9
"""How much longer the next step may be; how much shorter one is at most, and at least, that is
tried again; and how much shorter than it should.
"""

TINY = 1e-300
"""Added to an error that may be zero."""


class SlipPhase(NamedTuple):
    """Slip that began, and how far it was followed."""

    knots: list[float]
    """Ends of pieces since then."""
    rows: list[Array]
    """Of the pieces of every step the coefficients of y and xi in powers of what has passed of
    each, from the first on, in a row.
    """
    last: list[float]
    """y and xi where that ends."""
    ended: bool
    """Whether slip has ended there."""
    sweeps: int
    """Sweeps that it took."""


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
        part = (
            float(PARTS)
            if lasts or factor < SAFETY
            else step.end_of_slip(tuple(now[free:]), speeds)
        )
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
