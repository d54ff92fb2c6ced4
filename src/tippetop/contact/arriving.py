"""How slip ends on a patch once its direction has come to rest: at once, by power series about the
end.

On a small patch drilling ends much more slowly than friction turns the direction of slip, which
soon is the one in which all of it ends. With t the time since the end, less than zero, it then is,
in the words of `slip_onset`,

    zeta = t (s_0 + s_1 t + ...) e(t),        A(e_0) = s_0 e_0,        s_0 < 0,

slip that begins with the time reversed. Its state at the end is not known: from a guess, the series
tell how far off they are now, and moving the guess by that makes it as much better as little time
is left. Early series need no more terms than they have digits.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

from tippetop.contact.growth import growth
from tippetop.integrators.base import Integrator
from tippetop.mechanics.ending import Closing, Vanishing, rates_in_time
from tippetop.mechanics.series import horner
from tippetop.mechanics.slip_onset import Growth, onset, turned_slopes
from tippetop.mechanics.stick_slip import inner, plus, scaled, size, tangents
from tippetop.mechanics.top import Top
from tippetop.mechanics.unsolved import Unsolved
from tippetop.mechanics.vectors import Scalar, Vector, solve
from tippetop.mechanics.wrench import Slip

DEGREE, ACCURACY = 12, 1e-13
"""Degree of the series of speed and direction, one less than of the others, and the size of the
last terms in natural units, or relative to zeta's.
"""

FIRST, MORE = 3, 2
"""Degree of the first series, and by how much that of the next is higher."""

MOST, TURNS = 16, 8
"""Improvements of the state at the end, and of the direction there, at most."""

SETTLED, CLOSE = 1e-14, 1e-7
"""Error of the state, in natural units, that counts as none, and that of a direction which Newton's
method makes none, since it squares it.
"""

AT_REST, UNSEEN = 1e-12, 1e-15
"""How far the direction may be from the series' at most, times the time that is left, in natural
units; or times the speed, which is rounding of the state. An integrator leaves it no nearer than
its tolerance.
"""

TURNING = 1.0
"""How far it may be, over that time, in any of the series: there is no hope beyond."""


class Arrival(NamedTuple):
    """The end of slip."""

    left: float
    """The time until it ends."""
    rows: Sequence[list[Scalar]]
    """Coefficients of n, L and zeta in powers of the time since then, which is negative."""

    def at(self, part: float) -> list[Scalar]:
        """The numbers where a part of the time is left."""
        return [horner(row, -part * self.left) for row in self.rows]

    @property
    def serves(self) -> bool:
        """Whether the last two terms are small, those of zeta beside zeta."""
        whole = size(tuple(self.at(1.0)[6:]))
        return all(
            size(tuple(row[k] * self.left**k for row in rows)) < ACCURACY * unit
            for rows, unit in ((self.rows[:6], 1.0), (self.rows[6:], whole))
            for k in range(len(rows[0]) - 2, len(rows[0]))
        )

    @property
    def onwards(self) -> list[list[Scalar]]:
        """Coefficients in powers of the time since the start."""
        rows = []
        for row in self.rows:
            shifted = list(row)
            for first in range(len(row) - 1):
                for k in range(len(row) - 2, first - 1, -1):
                    shifted[k] = shifted[k] - self.left * shifted[k + 1]
            rows.append(shifted)
        return rows


def arriving(here: Closing, ending: Vanishing, top: Top, integrator: Integrator) -> Arrival | None:
    """The end of slip from a state on; None where its direction has not come to rest.

    Parameters
    ----------
    here
        The state.
    ending
        That slip ends, and nothing beside it.
    top
        The body, on the branch of its law that holds.
    integrator
        Who expands solutions.
    """
    rates = rates_in_time(here, ending, top)
    along = inner(rates.xi, here.direction)
    if along >= 0.0:
        return None
    left, now = -here.speed / along, (*here.axis, *here.momentum)
    end, way = plus(now, scaled(left, (*rates.axis, *rates.momentum))), here.direction
    at_rest = max(AT_REST, getattr(integrator, "tolerance", 0.0))
    try:
        for turn in range(MOST):
            axis, momentum = (end[0], end[1], end[2]), (end[3], end[4], end[5])
            if not abs(axis[2]) < 1.0:
                # So far off that there is no such tilt, and no shape to ask.
                return None
            known = resting_way(axis, momentum, way, ending, top, integrator)
            degree = min(FIRST + MORE * turn, DEGREE)
            begin, way = onset(known, 1, degree), known.first
            found = Arrival(time_to(here.speed, begin.rows, left), begin.rows)
            left, then = found.left, found.at(1.0)
            off, speed = plus(now, scaled(-1.0, tuple(then[:6]))), size(tuple(then[6:]))
            aside = math.dist(here.direction, scaled(1.0 / speed, tuple(then[6:])))
            rounding = aside * here.speed < UNSEEN
            if not (aside < TURNING * left or rounding):
                return None
            if degree == DEGREE and max(size(off), abs(speed - here.speed)) < SETTLED:
                return found if (aside * left < at_rest or rounding) and found.serves else None
            end = plus(end, off)
    except ArithmeticError:
        return None
    return None


def resting_way(
    axis: Vector, momentum: Vector, way: Slip, ending: Vanishing, top: Top, integrator: Integrator
) -> Growth:
    """The series at the end, in the direction in which slip ends there, by Newton's method from
    another one.

    Raises
    ------
    ArithmeticError
        If there is none near it.
    """
    for _ in range(TURNS):
        known = growth((axis, momentum, way), top, ending, (), DEGREE, integrator)
        rate, across = known.accelerations(0), tangents(way)
        along = inner(rate, way)
        slopes = turned_slopes(known, across)
        matrix = [
            [inner(a, g) - (along if a is b else 0.0) for b, g in zip(across, slopes, strict=True)]
            for a in across
        ]
        turned = solve(matrix, [-inner(a, rate) for a in across])
        if not math.hypot(*turned) < 1.0:
            raise Unsolved("slip does not end near this direction")
        if along < 0.0 and math.hypot(*turned) < SETTLED:
            return known
        for amount, b in zip(turned, across, strict=True):
            way = plus(way, scaled(amount, b))
        way = scaled(1.0 / size(way), way)
        if along < 0.0 and math.hypot(*turned) < CLOSE:
            return growth((axis, momentum, way), top, ending, (), DEGREE, integrator)
    raise Unsolved("no direction is found in which slip ends")


def time_to(speed: float, rows: Sequence[list[Scalar]], guess: float) -> float:
    """How long before its end slip had this speed."""
    left = guess
    for _ in range(MOST):
        then = size(tuple(horner(row, -left) for row in rows[6:]))
        better = left * speed / then
        if abs(better - left) <= SETTLED * left:
            return better
        left = better
    return left
