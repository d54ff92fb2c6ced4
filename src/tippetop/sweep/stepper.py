"""One step of Taylor's method for many launches at once, with what happens inside it.

The equations of motion are those of `tippetop.mechanics.motion`, evaluated on power series. heyoka compiles
the whole step, with its dense output, into one function that works on eight launches an instruction; without
heyoka NumPy makes the same step, much slower. Order and step size are chosen as by heyoka's own integrators
(Biscani and Izzo 2021, MNRAS 504; Jorba and Zou 2005, Experimental Mathematics 14): the order p from the
tolerance, and the step from the last two coefficients, so that what is left out is below the tolerance.

A launch's step depends on nothing but its own numbers: arrays are filled up to a multiple of `LANES`, so that
every launch is computed by the same instructions wherever it stands in them.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, NamedTuple, Protocol

import numpy as np

from tippetop.integrators import has_taylor
from tippetop.integrators.base import Array
from tippetop.interrupts import deferred
from tippetop.mechanics.motion import contact, sliding_rates
from tippetop.mechanics.state import SlidingState
from tippetop.mechanics.top import Kind
from tippetop.mechanics.vectors import Scalar
from tippetop.sweep.series import Arithmetic, Series, horner, solution

SIZE = 8
"""Numbers of a sliding state that the motion depends on: axis, angular momentum and horizontal velocity."""

LEFT, LOW, DOWN, UP, STEPS = range(SIZE, SIZE + 5)
"""Rows after those of the state, which a step brings up to date: the time that is left to go; the least
normal force so far; the least and the largest n_z so far; how many steps were taken."""

KEPT = SIZE + 5

TAKEN, PAUSE = KEPT, KEPT + 1
"""Rows that tell of a step: the time it took, and whether something may happen in it. Then it was not taken,
and no time is left, so that the launch waits."""

ROWS = KEPT + 2

LETS_GO, TURNS, BAND_LOW, BAND_HIGH = range(4)
"""What to pause for, in rows after the dimensionless numbers: whether the table lets go, whether the top is
yet to turn over, and the least and the largest n_z of a band (inf and -inf for none)."""

CARES = 4

FORCE_LOOKS, TIP_LOOKS = 32, 12
"""Intervals of a step at whose ends the normal force, and n_z, are looked at."""

TINY = 1e-300
"""Stands for zero where a number that is zero is to count as below it."""

LANES = 16
"""Arrays are filled up to a multiple of this many launches."""


class Stepper(Protocol):
    """Taylor's method for one kind of top and one tolerance."""

    def step(self, before: Array, after: Array, numbers: Array) -> None:
        """Take a step from the rows of `before` to those of `after`, both of shape (ROWS, n).

        The numbers have shape (kind.numbers + CARES, n). A launch with no time left stays as it is.
        """

    def jet(self, before: Array, numbers: Array) -> "Jet":
        """The polynomials in time of the steps that start from `before`."""


class Jet(NamedTuple):
    """Coefficients of polynomials in time, in increasing order, for n launches.

    Attributes
    ----------
    state
        Those of the state, shape (SIZE, order + 1, n).
    force
        Those of the normal force, shape (order, n).
    """

    state: Array
    force: Array

    def at(self, time: Array) -> Array:
        """The states at one time for every launch, shape (SIZE, n)."""
        return np.array([horner(series, time) for series in self.state])


def sliding_jet(kind: Kind, start: Sequence[Scalar], numbers: Sequence[Scalar], plain: Arithmetic) -> Any:
    """Series of the state and of the normal force of a sliding top."""
    top = kind.top(tuple(numbers[: kind.numbers]))
    still = ((0.0, 0.0), (0.0, 0.0, 0.0), 0.0)

    def read(y: Sequence[Any]) -> SlidingState:
        return SlidingState((y[0], y[1], y[2]), (y[3], y[4], y[5]), (y[6], y[7]), *still)

    def rates(y: Sequence[Series]) -> tuple[Any, ...]:
        rate = sliding_rates(read(y), top)
        return (*rate.axis, *rate.momentum, *rate.velocity)

    y = solution(start, rates, plain)
    state = read(y)
    return y, contact(state.axis, state.momentum, state.velocity, top).normal_force


def stride(
    kind: Kind, order: int, before: Sequence[Scalar], numbers: Sequence[Scalar], plain: Arithmetic
) -> list[Scalar]:
    """What `Stepper.step` makes of the rows that are kept: all rows."""
    start, (left, least, down, up, steps) = before[:SIZE], before[SIZE:]
    cares = numbers[kind.numbers :]
    y, normal = sliding_jet(kind, start, numbers, plain)
    state = [[series[k] for k in range(order + 1)] for series in y]
    force = [normal[k] for k in range(order)]
    taken = step_size(state, left, plain)

    part = taken * (1.0 / FORCE_LOOKS)
    forces = [horner(force, part * float(look)) for look in range(FORCE_LOOKS + 1)]
    heights = [horner(state[2], taken * (look / TIP_LOOKS)) for look in range(TIP_LOOKS + 1)]
    low = lowest(forces, plain)
    # Between two looks a function lies at most (interval)^2 / 8 max |f''| below both of them.
    bends = [float(k * (k - 1)) * plain.size(force[k]) for k in range(2, order)]
    slack = part * part * (1.0 / 8.0) * horner(bends, taken)
    floor, ceiling = lowest(heights, plain), -lowest([-height for height in heights], plain)

    events = (
        plain.below(low - slack, TINY) * cares[LETS_GO]
        + plain.below(floor, 0.0) * plain.below(0.0, ceiling) * cares[TURNS]
        + (1.0 - plain.below(cares[BAND_HIGH], floor)) * (1.0 - plain.below(ceiling, cares[BAND_LOW]))
    )
    moves = plain.below(0.0, taken)
    pause = events * moves
    after = [
        *(horner(series, taken) for series in state),
        left - taken,
        plain.least(low, least),
        plain.least(floor, down),
        -plain.least(-ceiling, -up),
        steps + moves,
    ]
    stays = [plain.choose(pause, old, new) for old, new in zip(before, after, strict=True)]
    stays[LEFT] = plain.choose(pause, 0.0 * left, after[LEFT])
    return [*stays, taken, pause]


def step_size(state: Sequence[Sequence[Scalar]], left: Scalar, plain: Arithmetic) -> Scalar:
    """Step for which the last terms of the polynomials are below the tolerance, or all that is left."""
    order = len(state[0]) - 1

    def square(k: int) -> Scalar:
        return plain.total([series[k] * series[k] for series in state])

    whole = square(0)
    radii = [(whole / square(k)) ** (0.5 / k) for k in (order - 1, order)]
    safety = math.exp(-2.0 - 0.7 / (order - 1))
    return plain.least(safety * plain.least(*radii), left)


def lowest(values: Sequence[Scalar], plain: Arithmetic) -> Scalar:
    """The least of many."""
    least = values[0]
    for value in values[1:]:
        least = plain.least(value, least)
    return least


def order_for(tolerance: float) -> int:
    """Degree of the polynomials for a tolerance, as heyoka chooses it."""
    return max(2, math.ceil(1.0 - 0.5 * math.log(tolerance)))


@lru_cache(maxsize=16)
def stepper(kind: Kind, tolerance: float) -> Stepper:
    """Taylor's method for a kind of top: compiled where heyoka is installed."""
    order = order_for(tolerance)
    if not has_taylor():
        return NumPyStepper(kind, order)
    # An interrupted import of heyoka leaves it in pieces.
    with deferred():
        from tippetop.sweep.compiled import CompiledStepper  # noqa: PLC0415 - optional, and slow to import

    return CompiledStepper(kind, order)


class NumPyArithmetic:
    """Coefficients that are arrays."""

    def total(self, terms: Sequence[Array]) -> Array:
        """Sum of terms."""
        return sum(terms[1:], terms[0])

    def least(self, a: Array, b: Array) -> Array:
        """The smaller of two."""
        return np.where(a < b, a, b)

    def size(self, a: Array) -> Array:
        """Absolute value."""
        return np.abs(a)

    def below(self, a: Any, b: Any) -> Any:
        """1 where the first is less than the second, else 0."""
        return np.where(a < b, 1.0, 0.0)

    def choose(self, condition: Array, a: Any, b: Any) -> Any:
        """The first where a condition is not 0, else the second."""
        return np.where(condition != 0.0, a, b)


@dataclass(frozen=True)
class NumPyStepper:
    """Taylor's method without a compiler; see `Stepper`."""

    kind: Kind
    order: int

    def step(self, before: Array, after: Array, numbers: Array) -> None:
        """Take a step."""
        with np.errstate(all="ignore"):
            rows = stride(self.kind, self.order, list(before[:KEPT]), list(numbers), NumPyArithmetic())
        for row, value in zip(after, rows, strict=True):
            row[:] = value

    def jet(self, before: Array, numbers: Array) -> Jet:
        """The polynomials of the steps."""
        with np.errstate(all="ignore"):
            y, normal = sliding_jet(self.kind, list(before[:SIZE]), list(numbers), NumPyArithmetic())
            state = [[series[k] for k in range(self.order + 1)] for series in y]
            force = [normal[k] for k in range(self.order)]
        return Jet(np.array(state), np.array(force))
