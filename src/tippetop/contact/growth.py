"""Series of what begins to slip, or to roll, by an integrator that expands solutions in powers of
time.
"""

import math
from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import Any

from tippetop.contact.closed import split
from tippetop.integrators.base import NOT_FINITE, Expansion, Integrator, Motion
from tippetop.mechanics.ending import Closing, Vanishing, rates_in_time
from tippetop.mechanics.slip_onset import Growing, Growth, rates_of
from tippetop.mechanics.stick_slip import scaled
from tippetop.mechanics.top import Kind, Top
from tippetop.mechanics.unsolved import Unsolved
from tippetop.mechanics.vectors import Scalar, Vector
from tippetop.mechanics.wrench import Slip

FEW = 11
"""Degree up to which the first coefficients of the direction are expanded: half the others', for a
third of the price.
"""


class Driven:
    """Series from the motion of a body whose direction of slip is given, and found order by order.

    Attributes
    ----------
    first
        The direction in which slip, or rolling, begins.
    """

    def __init__(
        self,
        start: tuple[Vector, Vector, Slip],
        velocity: Slip,
        degree: int,
        expand: Sequence[Expansion],
    ):
        self.first, self._expand, self._chain = start[2], expand, degree + 1
        self._free = len(velocity) + 6
        self._arguments = [*start[0], *start[1], *velocity, *scaled(0.0, start[2])]
        self._given = len(self._arguments)
        for e in start[2]:
            self._arguments += [e, *[0.0] * degree]

    @property
    def state(self) -> Sequence[Sequence[float]]:
        """Coefficients of n, L, and u where that is free."""
        rows = [
            [float(term) for term in row] for row in self._expand[-1](self._arguments)[: self._free]
        ]
        if not math.isfinite(sum(sum(row) for row in rows)):
            raise Unsolved(NOT_FINITE)
        return rows

    def turn(self, j: int, direction: Sequence[Scalar]) -> None:
        """Set the j-th coefficient of the direction."""
        factor = math.factorial(j)
        for i, number in enumerate(direction):
            self._arguments[self._given + i * self._chain + j] = number * factor

    def accelerations(self, j: int) -> Slip:
        """Coefficient of order j of A, expanded no further than to the first of the degrees that
        has it.
        """
        rows = self._expand[0 if j < FEW else -1](self._arguments)[self._free :]
        return tuple([(j + 1) * float(row[j + 1]) for row in rows])


def growth(
    start: tuple[Vector, Vector, Slip],
    top: Top,
    ending: Vanishing,
    velocity: Slip,
    degree: int,
    integrator: Integrator,
) -> Growth:
    """The series where slip, or rolling, begins, by an integrator that expands solutions, or
    without.

    Parameters
    ----------
    start
        Axis, angular momentum, and the direction in which it begins.
    top
        The body.
    ending
        Which velocity begins, and whether the other is held.
    velocity
        Horizontal velocity of the centre of mass where that is free beside it.
    degree
        Of the accelerations that will be asked for.
    integrator
        Who follows the motion.
    """
    expansion: Callable[[Motion, Sequence[float], int, int], Expansion] | None
    expansion = getattr(integrator, "expansion", None)
    if expansion is None:
        return Growing((*start[0], *start[1], *velocity), start[2], rates_of(top, ending))
    motion = driven_motion(top.kind, ending, len(start[2]), degree)
    count = motion.size - len(start[2]) * (degree + 1)
    degrees = [FEW, degree + 1] if degree >= FEW else [degree + 1]
    expand = [expansion(motion, top.numbers, highest, count) for highest in degrees]
    return Driven(start, velocity, degree, expand)


@lru_cache
def driven_motion(kind: Kind, ending: Vanishing, components: int, degree: int) -> Motion:
    """Equations of motion in which a direction is given: it, and its derivatives, are the last
    numbers.

    The velocity that begins comes before them: it is what the acceleration adds up to.
    """
    free = 8 if ending.moves else 6
    chain = degree + 1

    def rates(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> tuple[Scalar, ...]:
        given = y[free + components :]
        direction = tuple(given[i * chain] for i in range(components))
        state = Closing(*split(y), tuple(y[6:free]), direction, 0.0, 0.0)
        rate = rates_in_time(state, ending, kind.top(tuple(numbers)))
        turning = list[Any]()
        for i in range(components):
            turning += [*given[i * chain + 1 : (i + 1) * chain], 0.0]
        return (*rate.axis, *rate.momentum, *rate.velocity, *rate.xi, *turning)

    return Motion(rates, free + components * (chain + 1), kind.numbers, lasting=False)
