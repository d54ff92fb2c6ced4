"""Dormand and Prince's steps as arcs: how a motion is followed with functions that are compiled for it."""

from collections.abc import Callable, Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from tippetop.integrators.base import NO_START, NO_STEP, Arc, Array, Guard, Motion
from tippetop.integrators.dense import DenseSolution
from tippetop.integrators.dormand_prince import FULL, POWERS, ROWS, SINGULAR, STUCK, SUSPECT
from tippetop.integrators.falls import first_fall
from tippetop.mechanics.vectors import Scalar

FEW, WIDER, MANY = 16, 4, 4096
"""Steps for which there is room at first, how many times as many there is room for then, and in an arc."""

FAILURES = {SINGULAR: NO_START, STUCK: NO_STEP}
"""Why there may be no solution, or no more of it."""


class Machinery(NamedTuple):
    """What a motion is followed with."""

    advance: Callable[..., tuple[int, int, int]]
    within: Callable[[Array, int, float, Array], None]
    """Of `dormand_prince`."""
    rates: Any
    guards: Any
    """The motion's as that takes them."""
    number: int
    """How many guards there are."""
    width: int
    """How long a row of the motion's numbers is, with zeros at its end."""
    values: Callable[[Array, Array, Array], None]
    """The guards as functions (y, p, out) for Python."""
    kept: Any = None
    """What has to last as long as these."""

    def guard(self, guard: Guard, number: int) -> Guard:
        """A guard that is evaluated by the compiled function."""
        found = np.empty(self.number)

        def value(y: Sequence[Scalar], p: Any) -> Scalar:
            self.values(np.array(y), p, found)
            return found[number]

        return Guard(guard.name, value)


def stepped(
    motion: Motion,
    functions: Machinery,
    parameters: Sequence[float],
    start: tuple[float, Array],
    end: float,
    tolerance: float,
) -> Iterator[Arc]:
    """Follow a motion; see `tippetop.integrators.base.Integrator`."""
    going = Stepping(functions, np.array(parameters), start, end, tolerance)
    while going.time < end:
        ended = going.advance()
        fall = going.fall(motion.guards) if ended == SUSPECT else None
        if fall is not None:
            guard, time, state = fall
            going.end_at(time, state)
            yield going.arc(guard.name)
            return
        if ended in FAILURES:
            yield going.arc(None, FAILURES[ended])
            return
        if going.steps == MANY or going.time >= end:
            yield going.arc()
        elif ended == FULL:
            going.widen()


class Stepping:
    """A motion under way: the state, and the steps of the arc that is being made."""

    def __init__(
        self,
        functions: Machinery,
        parameters: Array,
        start: tuple[float, Array],
        end: float,
        tolerance: float,
    ) -> None:
        self.functions, self.parameters = functions, parameters
        self.tolerance, self.size = np.array([tolerance, tolerance]), len(start[1])
        width = functions.width
        self.row, self.lost = longer(start[1], width), np.zeros(width)
        self.stages, self.span = np.zeros((ROWS, width)), np.array([start[0], end, 0.0])
        self.steps, self.calls = 0, 0
        self.other: Stepping | None = None
        self.knots, self.terms = np.empty(FEW + 1), np.empty(FEW * POWERS * width)
        self.knots[0] = start[0]

    @property
    def time(self) -> float:
        """Where it is."""
        return float(self.span[0])

    @property
    def state(self) -> Array:
        """The state there."""
        return np.array(self.row[: self.size])

    def widen(self) -> None:
        """Make room for more steps."""
        steps = min(WIDER * self.steps, MANY)
        self.knots = longer(self.knots, steps + 1)
        self.terms = longer(self.terms, steps * POWERS * len(self.row))

    def advance(self, *, guarded: bool = True) -> int:
        """Take steps until something is to be done; tell what."""
        functions = self.functions
        steps, calls, ended = functions.advance(
            functions.rates,
            functions.guards,
            functions.number if guarded else 0,
            self.parameters,
            self.row,
            self.lost,
            self.stages,
            self.span,
            self.tolerance,
            self.knots,
            self.terms,
            self.steps,
            self.size,
        )
        self.steps, self.calls = steps, self.calls + calls
        return ended

    def arc(self, guard: str | None = None, failure: str | None = None) -> Arc:
        """The arc that has been made; the next one begins."""
        width = len(self.row)
        solution = DenseSolution.of_steps(self.knots, self.terms, self.size, self.steps, width)
        arc = Arc(solution, self.state, guard, failure, self.steps, self.calls)
        self.knots[0] = self.time
        self.steps, self.calls = 0, 0
        return arc

    def fall(self, guards: Sequence[Guard]) -> tuple[Guard, float, Array] | None:
        """The guard that first falls through zero in the last step, when, and the state there."""
        begin, reach = float(self.knots[self.steps - 1]), self.time
        first, row = (self.steps - 1) * len(self.row) * POWERS, np.empty(len(self.row))

        def dense(at: float) -> Array:
            self.functions.within(self.terms, first, (at - begin) / (reach - begin), row)
            return np.array(row[: self.size])

        def advance(at: float) -> Array:
            return self.beside().landed(begin, state, at)

        state = dense(begin)

        parameters: Any = self.parameters
        known = [self.functions.guard(guard, number) for number, guard in enumerate(guards)]
        found = first_fall(known, parameters, dense, advance, (begin, reach))
        return None if found is None else (known[found[0]], *found[1:])

    def end_at(self, time: float, state: Array) -> None:
        """End within the last step."""
        begin, end = self.knots[self.steps - 1], self.knots[self.steps]
        part, last = (time - begin) / (end - begin), self.steps * len(self.row) * POWERS
        for number in range(last - len(self.row) * POWERS, last):
            self.terms[number] *= part ** (number % POWERS)
        self.knots[self.steps] = time
        self.span[0] = time
        self.row = longer(state, len(self.row))

    def beside(self) -> "Stepping":
        """Another motion of the same kind, for trial."""
        if self.other is None:
            begin, end = float(self.span[0]), float(self.span[1])
            self.other = Stepping(
                self.functions, self.parameters, (begin, self.state), end, float(self.tolerance[0])
            )
        return self.other

    def landed(self, time: float, state: Array, end: float) -> Array:
        """The state after a step from another, or some, that end at exactly this time."""
        self.row, self.lost = longer(state, len(self.row)), np.zeros(len(self.row))
        self.span = np.array([time, end, time - end])
        ended = FULL
        while ended == FULL and end > time:
            self.steps = 0
            ended = self.advance(guarded=False)
        return self.state


def longer(numbers: Array, count: int) -> Array:
    """So many numbers: these, and zeros."""
    return np.concatenate([numbers, np.zeros(count - len(numbers))])
