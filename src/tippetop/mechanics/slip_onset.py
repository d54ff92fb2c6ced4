"""How slip, or rolling, begins where the table cannot hold it: power series in time since the
onset.

In the words of `ending`, with zeta for the velocity that begins, it does so as zeta = t^p (s_0 +
s_1 t + ...) e(t) along e(0) = e_0. Where holding it has just reached the limit of what the table
can, A(e_0) = 0 and p = 2; where that is inadmissible from the start, A = R e_0 and p = 1. For p = 2
the equation for e is stiff with the rate 1/s and has an irregular singular point at t = 0: the
series of the slow solution is asymptotic, with coefficients that grow like k!, and is used up to a
time at which its last terms are small. Solutions nearby decay to it like exp(-1/t), and an ordinary
integrator goes on.
"""

# translate module: series

import math
from collections.abc import Callable, Sequence
from operator import mul
from typing import Any, NamedTuple, Protocol, TypeAlias

from tippetop.mechanics.ending import Closing, Vanishing, rates_in_time
from tippetop.mechanics.series import PLAIN, Series, horner, solved, unknown
from tippetop.mechanics.stick_slip import inner, plus, scaled, tangents
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Scalar, solve
from tippetop.mechanics.wrench import Slip

LOST, SHORTER = 0.5, 0.9
"""Part of what a speed grows by at first that it may lose, and the factor by which times are tried.
"""


class Onset(NamedTuple):
    """The beginning of slip, or rolling, as polynomials in time: lists of coefficients, in
    increasing order.

    The speed and the direction go up to some order, and the others to as many more as there are
    powers.
    """

    axis: tuple[list[Scalar], ...]
    momentum: tuple[list[Scalar], ...]
    velocity: tuple[list[Scalar], ...]
    direction: tuple[list[Scalar], ...]
    """n, L, u where that is free beside what begins (else nothing), and e."""
    speed: list[Scalar]
    """s / t^power."""
    power: int
    """2 where it starts from the limit of being held, 1 where it starts beyond it."""

    def valid_until(self, error: float) -> float:
        """Time up to which the last two terms of each series are below an error relative to the
        first.

        And up to which the speed, from what it grows by at first, has not lost as much as `LOST`:
        through its end series go on with the friction of before.
        """
        vectors = [self.axis, self.momentum, self.velocity, self.direction, (self.speed,)]
        times = [1e300]
        for rows in vectors:
            whole = error * math.hypot(*(row[0] for row in rows))
            if not whole:
                continue
            for k in range(len(self.speed) - 2, len(self.speed)):
                term = math.hypot(*(row[k] for row in rows))
                if k > 0 and term > 0.0:
                    times.append((whole / term) ** (1.0 / k))
        shortest = min(times)
        losses = [min(term, 0.0) for term in self.speed]
        while shortest > 1e-300 and -horner(losses, shortest) > LOST * self.speed[0]:
            shortest *= SHORTER
        return shortest

    @property
    def rows(self) -> list[list[Scalar]]:
        """Coefficients of n, L, u where that is free, and zeta."""
        begun, count = [0.0] * self.power, len(self.speed)
        zeta = [
            begun + [sum(map(mul, self.speed, row[k::-1])) for k in range(count)]
            for row in self.direction
        ]
        return [*self.axis, *self.momentum, *self.velocity, *zeta]


class Growth(Protocol):
    """Series in time of y and A while the direction e is being found, from the first order on."""

    first: Slip
    """The direction e_0 in which slip, or rolling, begins: along it A = R e_0."""

    @property
    def state(self) -> Sequence[Any]:
        """Coefficients of n, L, and u where that is free, each to be indexed."""

    def turn(self, j: int, direction: Sequence[Scalar]) -> None:
        """Set the j-th coefficient of the direction; those after it are not known."""

    def accelerations(self, j: int) -> Slip:
        """Coefficient of order j of A."""


def turned_slopes(known: Growth, across: Sequence[Slip]) -> list[Slip]:
    """Derivatives of A along directions across e_0, at the start: its order 1 is linear in that of
    e.
    """
    known.turn(1, scaled(0.0, across[0]))
    straight, found = known.accelerations(1), list[Slip]()
    for b in across:
        known.turn(1, b)
        found.append(plus(known.accelerations(1), scaled(-1.0, straight)))
    return found


def onset(known: Growth, power: int, order: int) -> Onset:
    """The beginning of slip, or rolling, order by order.

    Parameters
    ----------
    known
        The series where it begins.
    power
        How it grows with time: 2 where R = 0 at the start, 1 where R > 0.
    order
        Degree of the polynomials.

    Notes
    -----
    The k-th coefficients of y follow from those before. With j = k + power - 1 the unknowns in
    zeta' = A at t^j are s_k and the part of e_j across e_0 (|e| = 1 gives the other); A is linear
    in e_j, with the derivative G.
    """
    first = known.first
    across = tangents(first)
    slopes = turned_slopes(known, across)
    aside = [[inner(b, g) for g in slopes] for b in across]
    ahead = [inner(first, g) for g in slopes]
    e, s = [[number] for number in first], list[Scalar]()
    if power == 1:
        s.append(inner(known.accelerations(0), first))
    for j in range(1, order + power):
        k = j - power + 1
        factor, along = k + power, 0.0
        for row in e:
            along -= 0.5 * sum(map(mul, row[1:], row[:0:-1]))
        turned = [along * number for number in first]
        known.turn(j, turned)
        for row, number in zip(e, turned, strict=True):
            row.append(number)
        # (k + power) zeta_k = A_j, where zeta_k has s_k e_0, known terms, and for power 1 also s_0
        # e_j.
        rates = known.accelerations(j)
        rest = [a - factor * sum(map(mul, s, row[k:0:-1])) for a, row in zip(rates, e, strict=True)]
        lag = factor * s[0] if power == 1 else 0.0
        matrix = [
            [g - lag if a == b else g for b, g in enumerate(row)] for a, row in enumerate(aside)
        ]
        parts = solve(matrix, [-sum(map(mul, b, rest)) for b in across])
        for part, b in zip(parts, across, strict=True):
            turned = [number + part * beside for number, beside in zip(turned, b, strict=True)]
        known.turn(j, turned)
        for row, number in zip(e, turned, strict=True):
            row[j] = number
        s.append((sum(map(mul, first, rest)) + sum(map(mul, parts, ahead))) / factor)
    rows = [[y[k] for k in range(order + power + 1)] for y in known.state]
    turning = tuple(row[: order + 1] for row in e)
    return Onset(tuple(rows[:3]), tuple(rows[3:6]), tuple(rows[6:]), turning, s[: order + 1], power)


Rates: TypeAlias = Callable[[Any, Any], tuple[Sequence[Any], Sequence[Any]]]
"""From y and the direction e to Y and A, in plain operators."""


def rates_of(top: Top, ending: Vanishing) -> Rates:
    """How y and xi change, for the words of `ending`."""

    def rates(y: Sequence[Any], direction: Slip) -> tuple[Sequence[Any], Slip]:
        state = Closing((y[0], y[1], y[2]), (y[3], y[4], y[5]), tuple(y[6:]), direction, 0.0, 0.0)
        found = rates_in_time(state, ending, top)
        return (*found.axis, *found.momentum, *found.velocity), found.xi

    return rates


class Growing:
    """Series that are made in plain operators: the state follows from the directions known so far.

    Made of y where slip, or rolling, begins, e_0, and how y and xi change.
    """

    def __init__(self, begin: Sequence[Scalar], first: Slip, rates: Rates) -> None:
        self.first, self._made = first, list[Series]()
        self._direction = tuple(Revisable(unknown, self._made) for _ in first)
        self.turn(0, first)

        def changing(y: Sequence[Series]) -> Sequence[Any]:
            found, grows = rates(y, self._direction)
            self._rates = grows
            return found

        self.state = solved([Revisable(unknown, self._made) for _ in begin], begin, changing)

    def turn(self, j: int, direction: Sequence[Scalar]) -> None:
        """Set the j-th coefficient of the direction, and forget what was made of another."""
        for series in self._made:
            series.known = series.known[:j]
        for series, number in zip(self._direction, direction, strict=True):
            series.known.append(number)

    def accelerations(self, j: int) -> Slip:
        """Coefficient of order j of A."""
        return tuple(rate[j] for rate in self._rates)


class Revisable(Series):
    """A series, and all that are made of it, whose last coefficients can be forgotten."""

    def __init__(self, rule: Callable[[int], Scalar], made: list[Series]) -> None:
        super().__init__(rule, PLAIN)
        self.made = made
        made.append(self)

    def _made(self, rule: Callable[[int], Scalar]) -> "Revisable":
        return Revisable(rule, self.made)
