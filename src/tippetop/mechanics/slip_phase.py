"""Slip from where it begins to where it ends, by collocation at Gauss's points in time.

In the words of `ending`, xi = s e and xi' = A(y, e): away from s = 0 the direction e is so much
faster than all else that it follows it, at the rate 1 / s, from the moment in which slip begins to
that in which it ends. An implicit method of high order sees neither as special. Its unknowns are y
and e at the points of a step; with y known, e is where what A adds up to goes along e: one linear
equation a point by Newton's method. What follows for y is put in, and so on: the error of y falls
as in Picard's iteration, by more each time. What is found is smooth where slip ends, and beyond:
the end is where its polynomial s falls to zero.

All numbers here have a value for each point of a step, which is one instruction's work; those of
the whole step have the same for all.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple, Protocol

from tippetop.mechanics.contacts.contact_point import Acceleration, ContactPoint
from tippetop.mechanics.ending import Closing, Vanishing, slip_beside
from tippetop.mechanics.friction import NO_TORQUE
from tippetop.mechanics.motion import axis_rate
from tippetop.mechanics.stick_slip import inner, plus, scaled
from tippetop.mechanics.top import Kind, Top
from tippetop.mechanics.vectors import Scalar, add, scale
from tippetop.mechanics.wrench import Slip, Wrench

STAGES = 16
"""Points in a step: order 32 at its end."""

PARTS = 3
"""Parts of a step that stand for it in a solution: what is read off them needs fewer points in
each.
"""

ROOTS = 12
"""Newton's iterations for a point."""


class Values(Protocol):
    """What can be done with numbers that have a value for each point, beside plain operators."""

    def spread(self, a: Scalar, point: int) -> Scalar:
        """The value at a point, for all."""

    def total(self, a: Scalar) -> Scalar:
        """The sum of all values, for all."""


class GaussPoints(NamedTuple):
    """Gauss's points in a step of length 1, and what belongs to them."""

    places: list[float]
    """The points."""
    integrals: list[list[float]]
    """Integrals of Lagrange's polynomial of every point, from 0 to each."""
    units: list[list[float]]
    """Lagrange's polynomials at the points."""
    terms: list[list[float]]
    """Of Legendre's polynomial of every degree, what a value at each point adds to its coefficient.
    """
    powers: list[list[list[float]]]
    """For every part of a step, and Legendre's polynomial of every degree, the coefficients of its
    integral in powers of what has passed of the part, from the first on.
    """


def gauss_points(stages: int) -> GaussPoints:
    """The points of a step with so many stages."""
    roots = [_root(stages, number) for number in range(stages)]
    values = [legendre(stages + 1, x) for x in roots]
    weights = [2.0 / sum([(2 * k + 1) * at[k] * at[k] for k in range(stages)]) for at in values]
    terms = [
        [0.5 * (2 * k + 1) * weight * at[k] for weight, at in zip(weights, values, strict=True)]
        for k in range(stages)
    ]
    integrals = [
        [
            sum([0.5 * _integral(k, x, at) * terms[k][j] for k in range(stages)])
            for x, at in zip(roots, values, strict=True)
        ]
        for j in range(stages)
    ]
    return GaussPoints(
        [0.5 + 0.5 * x for x in roots],
        integrals,
        [[1.0 if i == j else 0.0 for j in range(stages)] for i in range(stages)],
        terms,
        [_in_powers(stages, part) for part in range(PARTS)],
    )


def legendre(count: int, x: float) -> list[float]:
    """Legendre's polynomials of degrees 0 to `count`."""
    found = [1.0, x]
    for k in range(1, count):
        found.append(((2 * k + 1) * x * found[k] - k * found[k - 1]) / (k + 1))
    return found


def _root(stages: int, number: int) -> float:
    """A root of Legendre's polynomial of a degree, by Newton's method from Chebyshev's points."""
    x = -math.cos(math.pi * (number + 0.75) / (stages + 0.5))
    for _ in range(ROOTS):
        at = legendre(stages, x)
        x = x - at[stages] * (x * x - 1.0) / (stages * (x * at[stages] - at[stages - 1]))
    return x


def _integral(k: int, x: float, at: Sequence[float]) -> float:
    """Integral of Legendre's polynomial from -1."""
    return (at[k + 1] - at[k - 1]) / (2 * k + 1) if k else x + 1.0


def _in_powers(stages: int, part: int) -> list[list[float]]:
    """Coefficients of the integrals of Legendre's polynomials in powers of what has passed of a
    part.
    """
    begin, slope = 2.0 * part / PARTS - 1.0, 2.0 / PARTS
    none = [0.0] * stages
    rows = [[1.0, *none[1:]], [begin, slope, *none[2:]]]
    for k in range(1, stages - 1):
        times = [
            begin * a + slope * b
            for a, b in zip(rows[k], [0.0, *rows[k][: stages - 1]], strict=True)
        ]
        rows.append(
            [((2 * k + 1) * a - k * b) / (k + 1) for a, b in zip(times, rows[k - 1], strict=True)]
        )
    return [[number / (PARTS * (power + 1)) for power, number in enumerate(row)] for row in rows]


GAUSS = gauss_points(STAGES)

CONSTANTS = [number for row in [*GAUSS.integrals, *GAUSS.units] for number in row]
TERMS = [
    number
    for row in [*GAUSS.terms, *[row for part in GAUSS.powers for row in part]]
    for number in row
]
"""What a sweep, and `step_terms`, are given of the method: row after row."""


class StepRows(NamedTuple):
    """Which rows the numbers of a step are, each with a value for every point."""

    free: int
    """How many numbers y has: n, L, and u where that is free."""

    @classmethod
    def of(cls, ending: Vanishing) -> "StepRows":
        """For what begins or ends."""
        return cls(8 if ending.moves else 6)

    @property
    def size(self) -> int:
        """How many numbers y and xi have, and so y and e, which a sweep makes better."""
        return self.free + 2

    @property
    def given(self) -> int:
        """What is given of a step before the numbers of the top: y and xi at its start, and its
        length.
        """
        return self.size + 1

    @property
    def normal(self) -> int:
        """Which of what a sweep makes besides, after rates of y and xi, is the normal force."""
        return self.size

    @property
    def speed(self) -> int:
        """And which is s."""
        return self.size + 1

    @property
    def found(self) -> int:
        """What that is in all; its change is last."""
        return self.size + 3


def sweep(
    y: Sequence[Scalar], p: Sequence[Scalar], ending: Vanishing, kind: Kind, points: Values
) -> list[Scalar]:
    """Make the unknowns of a step better.

    Parameters
    ----------
    y
        The unknowns: y and e.
    p
        y and xi at the start, the length of the step, the numbers of the top, and `CONSTANTS`.
    ending
        What slips or rolls.
    kind
        The kind of top.
    points
        What is done with values at points.

    Returns
    -------
    list
        The unknowns; the rates of y and xi; the normal force; s; and the sum of the squares of all
        changes.
    """
    layout = StepRows.of(ending)
    free, given = layout.free, layout.given
    last = given + kind.numbers
    top, integrals, units = (
        kind.top(tuple(p[given:last])),
        p[last : last + STAGES],
        p[last + STAGES :],
    )
    way, step = (y[free], y[free + 1]), p[layout.size]
    across = (-way[1], way[0])
    rates, slopes, normal = _rates_and_slopes(y[:free], way, across, ending, top)
    xi = _moved(tuple(p[free : layout.size]), step, rates[free:], integrals, points)
    speed = inner(xi, way)
    columns = []
    for j, (integral, unit) in enumerate(zip(integrals, units, strict=True)):
        slope = tuple([points.spread(number, j) for number in slopes[free:]])
        columns.append(step * integral * inner(across, slope) - speed * unit)
    turned = _solved(columns, -inner(xi, across), units, points)
    rates = plus(rates, scaled(turned, slopes))
    after = _moved(tuple(p[:free]), step, rates[:free], integrals, points)
    to = plus(way, scaled(turned, across))
    changes = (*[new - old for new, old in zip(after, y, strict=False)], turned)
    changed = points.total(inner(changes, changes))
    return [*after, *scaled(inner(to, to) ** -0.5, to), *rates, normal, speed, changed]


def step_terms(y: Sequence[Scalar], p: Sequence[Scalar], points: Values) -> list[Scalar]:
    """What a step makes of numbers, from their rates y.

    For every part of the step and every number, a row of the coefficients in powers of what has
    passed of the part, from the first on; for every number, by how much it changes; and the sum of
    the squares of the last two coefficients of the rates in Legendre's polynomials, times the step.
    p is the length of the step, and `TERMS`.
    """
    step, legendre_rows = p[0], p[1 : STAGES + 1]
    series = [tuple([step * points.total(rate * row) for row in legendre_rows]) for rate in y]
    found = list[Scalar]()
    for part in range(1, PARTS + 1):
        powers = tuple(p[part * STAGES + 1 : (part + 1) * STAGES + 1])
        found += [inner(terms, powers) for terms in series]
    squares = [terms[k] * terms[k] for terms in series for k in (STAGES - 2, STAGES - 1)]
    return [*found, *[terms[0] for terms in series], sum(squares[1:], squares[0])]


def _moved(
    start: Slip, step: Scalar, rates: Slip, integrals: Sequence[Scalar], points: Values
) -> Slip:
    """Numbers at the points, from their rates there and where they begin."""
    found = []
    for begin, rate in zip(start, rates, strict=True):
        total = points.spread(rate, 0) * integrals[0]
        for j in range(1, STAGES):
            total = total + points.spread(rate, j) * integrals[j]
        found.append(begin + step * total)
    return tuple(found)


def _solved(
    columns: list[Scalar], right: Scalar, units: Sequence[Scalar], points: Values
) -> Scalar:
    """Solution of as many linear equations as there are points, by Gauss and Jordan's
    elimination.
    """
    diagonal: Scalar = 0.0
    for k, unit in enumerate(units):
        pivot = columns[k]
        diagonal = diagonal + pivot * unit
        factor = pivot * (1.0 / points.spread(pivot, k)) * (1.0 - unit)
        right = right - factor * points.spread(right, k)
        for j in range(k + 1, len(columns)):
            columns[j] = columns[j] - factor * points.spread(columns[j], k)
    return right / diagonal


def _rates_and_slopes(
    y: Sequence[Scalar], way: Slip, beside: Slip, ending: Vanishing, top: Top
) -> tuple[Slip, Slip, Scalar]:
    """Rates of y and xi, their derivatives as the direction turns, and the normal force.

    Friction that turns is another one that is added, and the contact responds to it as it does to
    gravity.
    """
    here = Closing((y[0], y[1], y[2]), (y[3], y[4], y[5]), tuple(y[6:]), way, 0.0, 0.0)
    point, slip = ContactPoint.of(here.axis, here.momentum, top), slip_beside(here, ending, top)
    wrench, acceleration = ending.contact(point, way, slip)
    normal, force, torque = wrench.force[2], NO_TORQUE, NO_TORQUE
    for share, unit in zip(ending.shares(beside, top), ending.wrenches(top), strict=True):
        force, torque = add(force, scale(share, unit.force)), add(torque, scale(share, unit.torque))
    turned = Wrench(scale(normal, force), scale(normal, torque))
    (more, couple), change = ending.contact(point._replace(free=point.response(turned)), way, slip)
    added = Wrench(add(turned.force, more), add(turned.torque, couple))

    def rates(wrench: Wrench, acceleration: Acceleration) -> Slip:
        drawn = scaled(1.0 / top.mass, wrench.force[: len(here.velocity)])
        return (*point.moment(wrench), *drawn, *ending.rate(acceleration, top))

    tilting = axis_rate(here.axis, here.momentum, top)
    return (*tilting, *rates(wrench, acceleration)), (0.0, 0.0, 0.0, *rates(added, change)), normal
