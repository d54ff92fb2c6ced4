"""How low polynomials of many launches at once come: by looks in a step.

It is written in plain operators and a few choices, for arrays and for what is compiled.
"""

from collections.abc import Sequence

from tippetop.mechanics.series import Arithmetic, horner
from tippetop.mechanics.vectors import Scalar

PLACE_CORRECTIONS = 3
"""Improvements of a least value, by Newton's method from the least look, which cube its small
distance.
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
