"""The first fall of a polynomial through zero, by bounds and bisection.

Bernstein's coefficients of a polynomial on an interval enclose its values there, and their changes
of sign are at least as many as its roots (Farouki 2012, Computer Aided Geometric Design 29). An
interval without a change has no root, one with a single change has exactly one, and any other is
halved. So no fall is passed over and none is invented, but for rounding.

`first_fall` is that search, of floats. `single_fall` is its first halving without branches, for
arrays and for what is compiled: it decides all that has one change of sign or none, and leaves the
rest to `first_fall`.
"""

# translate module: numbers

import math
from collections.abc import Sequence

from tippetop.mechanics.roots import crossing
from tippetop.mechanics.series import Arithmetic, horner
from tippetop.mechanics.vectors import Scalar

BRACKETED, LAST_MOVE = 10, 1e-12
"""Improvements of a single root, from where Bernstein's polygon crosses zero, and the last of them,
over the root, beyond which it is not found: beside another root, which may be complex, an
improvement is not the square of the one before.
"""

LARGEST_POWER = 1e300
"""Largest power of a step's length."""

FINEST = 0.5**40
"""Part of the whole interval below which none is halved: a dip as narrow is decided by its value.
"""

RISE_PROBE = 1.0 / 32.0
"""Place up to which a polynomial that starts at zero or below has to rise, if it does."""

RISEN = 1e-15
"""What a polynomial that starts at zero must reach before it falls: less is rounding."""


def first_fall(terms: Sequence[float], from_above: bool = False, after_rise: bool = False) -> float:
    """Return where in [0, 1] a polynomial first falls to zero from above; nan where it does not.

    Parameters
    ----------
    terms
        Coefficients in increasing powers, floats.
    from_above
        Whether a polynomial that starts below zero falls no sooner than it has been positive. One
        that does not rise falls at 0.
    after_rise
        Whether that holds of one that starts at zero, too.
    """
    coefficients = bernstein(terms)
    start = coefficients[0]
    begins_low = start <= 0.0
    may_begin = begins_low and not after_rise and (start == 0.0 or not from_above)
    if may_begin and horner(terms, RISE_PROBE) <= 0.0:
        return 0.0
    waiting = [(0.0, 1.0, coefficients)]
    while len(waiting) > 0:
        low, width, part = waiting.pop()
        changes = sign_changes(part)
        if changes == 0 or (changes == 1 and part[0] <= 0.0):
            continue
        if changes == 1 or width <= FINEST:
            place = _root(terms, low, low + width)
            if changes > 1 and horner(terms, place) > 0.0:
                continue
            # Between the rise of what begins low and its fall the middle is high.
            if begins_low and horner(terms, 0.5 * place) <= RISEN and part[0] <= RISEN:
                continue
            return place
        earlier, later = halves(part)
        half = 0.5 * width
        waiting.append((low + half, half, later))
        waiting.append((low, half, earlier))
    return math.nan


# translate: skip
def single_fall(
    terms: Sequence[Scalar], length: Scalar, plain: Arithmetic
) -> tuple[Scalar, Scalar]:
    """Return the time in a step of some length at which a polynomial falls through zero, inf if it
    does not, and whether that is undecided.

    It is undecided if the polynomial begins at or below zero, if it may have more roots than one,
    or if the iteration for its root does not converge.
    """
    unit, power = [terms[0]], length
    for term in terms[1:]:
        unit.append(term * power)
        # A long step of what hardly moves has powers beyond all floats; 0 times inf is none.
        power = plain.least(power * length, LARGEST_POWER)
    earlier, later = halves(bernstein(unit))
    bounds = [*earlier, *later[1:]]
    positive = [plain.below(0.0, bound) for bound in bounds]
    changes, guess, last = 0.0 * positive[0], 1.0, len(bounds) - 1
    for place in range(last - 1, -1, -1):
        before, after = positive[place], positive[place + 1]
        changes = changes + plain.size(before - after)
        beyond = bounds[place] / (bounds[place] - bounds[place + 1])
        zero = (float(place) + beyond) * (1.0 / last)
        guess = plain.choose(before * (1.0 - after), zero, guess)
    single = positive[0] * plain.below(changes, 1.5) * plain.below(0.5, changes)
    slopes = [float(power) * unit[power] for power in range(1, len(unit))]
    low, high, at, moved = 0.0 * guess, 0.0 * guess + 1.0, guess, 0.0 * guess
    for _ in range(BRACKETED):
        value = horner(unit, at)
        above, better = plain.below(0.0, value), at - value / horner(slopes, at)
        low, high = plain.choose(above, at, low), plain.choose(above, high, at)
        outside = plain.below(better, low) + plain.below(high, better)
        better = plain.choose(outside, 0.5 * (low + high), better)
        at, moved = better, plain.size(better - at)
    converged = plain.below(moved, LAST_MOVE * at)
    fall = plain.choose(single, at * length, math.inf + 0.0 * length)
    several = plain.below(1.5, changes) + (1.0 - positive[0])
    return fall, several + single * (1.0 - converged)


def bernstein(terms: Sequence[float]) -> list[float]:
    """Return Bernstein's coefficients on [0, 1] of a polynomial by those of its powers."""
    degree, binomial = len(terms) - 1, 1.0
    coefficients = list[float]()
    for power in range(degree + 1):
        coefficients.append(terms[power] / binomial)
        binomial = binomial * (degree - power) / (power + 1.0)
    for first in range(1, degree + 1):
        for place in range(degree, first - 1, -1):
            coefficients[place] += coefficients[place - 1]
    return coefficients


def sign_changes(coefficients: Sequence[float]) -> int:
    """Return how often coefficients change between positive and not positive."""
    changes, positive = 0, coefficients[0] > 0.0
    for coefficient in coefficients:
        if (coefficient > 0.0) != positive:
            changes, positive = changes + 1, not positive
    return changes


def halves(coefficients: Sequence[float]) -> tuple[list[float], list[float]]:
    """Return Bernstein's coefficients on both halves of an interval, by de Casteljau's means."""
    row, earlier, later = list(coefficients), list[float](), list[float]()
    while len(row) > 0:
        earlier.append(row[0])
        later.append(row[len(row) - 1])
        row = [0.5 * (row[i] + row[i + 1]) for i in range(len(row) - 1)]
    return earlier, later[::-1]


def _root(terms: Sequence[float], low: float, high: float) -> float:
    """Return where a polynomial falls between two places, or the one at which rounding sees it."""
    if horner(terms, low) <= 0.0:
        return low
    if horner(terms, high) > 0.0:
        return high
    return crossing(lambda place: horner(terms, place), low, high)
