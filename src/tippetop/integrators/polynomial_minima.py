"""Where polynomials of many launches at once fall to zero, and how low they come: by looks in a
step.

It is written in plain operators and a few choices, for arrays and for what is compiled.
"""

import math
from collections.abc import Sequence

from tippetop.mechanics.series import Arithmetic, horner
from tippetop.mechanics.vectors import Scalar

PLACE_CORRECTIONS, BRACKETED = 3, 8
"""Improvements of a least value, by Newton's method from the least look, which cube its small
distance, and of a zero between two looks.
"""

CONVERGED = 1e-9
"""Last improvement of a zero, over it, beyond which it is not found: the next would be the square
of that.
"""

TINY = 1e-300
"""Stands for zero where a number that is zero is to count as below it."""


def looked_at(terms: Sequence[Scalar], length: Scalar, count: int) -> list[Scalar]:
    """Values of a polynomial at the looks of a step."""
    part = length * (1.0 / count)
    return [horner(terms, part * float(probe)) for probe in range(count + 1)]


def slack(terms: Sequence[Scalar], length: Scalar, count: int, plain: Arithmetic) -> Scalar:
    """Return how far a polynomial may go beyond its looks: between two by (interval)^2 / 8 max
    |f''| at most.
    """
    part = length * (1.0 / count)
    bends = [float(k * (k - 1)) * plain.size(terms[k]) for k in range(2, len(terms))]
    return part * part * (1.0 / 8.0) * horner(bends, length)


def lower_bound(terms: Sequence[Scalar], length: Scalar, plain: Arithmetic) -> Scalar:
    """Return a lower bound of a polynomial in a step: its tangent's ends less all that bends."""
    bends = horner([plain.size(term) for term in terms[2:]], length)
    return plain.least(terms[0], terms[0] + length * terms[1]) - length * length * bends


def lowest(values: Sequence[Scalar], plain: Arithmetic) -> Scalar:
    """Return the least of many numbers."""
    least = values[0]
    for value in values[1:]:
        least = plain.least(value, least)
    return least


def may_fall(
    terms: Sequence[Scalar], values: Sequence[Scalar], length: Scalar, plain: Arithmetic
) -> Scalar:
    """Return whether a guard may fall through zero in a step, from its values at the probes."""
    return plain.below(lowest(values, plain) - slack(terms, length, len(values) - 1, plain), TINY)


def first_fall(
    terms: Sequence[Scalar], length: Scalar, count: int, plain: Arithmetic
) -> tuple[Scalar, Scalar]:
    """Return the time in a step at which a polynomial first falls through zero, and whether that is
    undecided.

    The time is inf if no probe is negative. It is undecided if the polynomial begins at or below
    zero, if it may dip between probes first, or if the iteration for its root does not converge.
    """
    values, part = looked_at(terms, length, count), length * (1.0 / count)
    falls = high = late = 0.0 * length
    nearest = before = math.inf + 0.0 * length
    for k in range(count, 0, -1):
        under = plain.below(values[k], TINY)
        falls, high = plain.choose(under, under, falls), plain.choose(under, part * float(k), high)
        before = plain.choose(under, values[k - 1], before)
        nearest = plain.choose(
            under + late, math.inf + 0.0 * length, plain.least(values[k], nearest)
        )
        late = under
    nearest = plain.choose(late, nearest, plain.least(values[0], nearest))
    slopes = [float(k) * terms[k] for k in range(1, len(terms))]
    first = low = high - part
    place = high - 0.5 * part
    for _ in range(BRACKETED):
        value = horner(terms, place)
        above, better = plain.below(0.0, value), place - value / horner(slopes, place)
        low, high = plain.choose(above, place, low), plain.choose(above, high, place)
        outside = plain.below(better, low) + plain.below(high, better)
        better = plain.choose(outside, 0.5 * (low + high), better)
        place, moved = better, plain.size(better - place)
    # Where it rises at the look before its fall, it may have dipped before that, too.
    rises = plain.below(0.0, horner(slopes, first))
    nearest = plain.choose(rises, plain.least(before, nearest), nearest)
    before_fall = nearest - slack(terms, length, count, plain)
    least = plain.choose(falls, before_fall, least_value(terms, values, length, plain))
    begins, converged = plain.below(values[0], TINY), plain.below(moved, CONVERGED * place)
    fall = plain.choose(falls * (1.0 - begins), place, math.inf + 0.0 * length)
    return fall, begins + plain.below(least, TINY) + falls * (1.0 - converged)


def least_value(
    terms: Sequence[Scalar], values: Sequence[Scalar], length: Scalar, plain: Arithmetic
) -> Scalar:
    """Return the least value of a polynomial in a step, sought from the least of its values at the
    looks.
    """
    part = length * (1.0 / (len(values) - 1))
    least, place = values[0], 0.0 * length
    for probe, value in enumerate(values[1:], start=1):
        lower = plain.below(value, least)
        least, place = (
            plain.choose(lower, value, least),
            plain.choose(lower, part * float(probe), place),
        )
    slopes = [float(k) * terms[k] for k in range(1, len(terms))]
    bends = [float(k) * slopes[k] for k in range(1, len(slopes))]
    low, high = -plain.least(0.0 * part, part - place), plain.least(place + part, length)
    for _ in range(PLACE_CORRECTIONS):
        bend = horner(bends, place)
        better = place - horner(slopes, place) / bend
        better = plain.choose(plain.below(0.0, bend), better, place)
        place = plain.least(-plain.least(-better, -low), high)
    return plain.least(horner(terms, place), least)
