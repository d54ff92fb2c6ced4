"""Dormand and Prince's steps as arcs: how a motion is followed with functions that are compiled for
it.
"""

# translate module: numbers

from collections.abc import Callable, Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from tippetop.integrators.base import NO_START, NO_STEP, Arc, Array, Motion
from tippetop.integrators.dense import DenseSolution, longer
from tippetop.integrators.dormand_prince import FULL, POWERS, ROWS, SINGULAR, STUCK, SUSPECT
from tippetop.integrators.zero_crossings import first_fall

FEW, WIDER, MANY = 128, 4, 4096
"""Steps for which there is room at first, how many times as many there is room for then, and in an
arc.
"""

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
    owner: Any = None
    """What has to last as long as these."""


def stepped(
    motion: Motion,
    functions: Machinery,
    parameters: Sequence[float],
    start: tuple[float, Array],
    end: float,
    tolerance: float,
) -> Iterator[Arc]:
    """Follow a motion; see `tippetop.integrators.base.Integrator`."""
    going = Stepping(functions, np.array(parameters), start, end, tolerance, FEW)
    while going.time < end:
        ended = going.advance()
        fall = going.fall() if ended == SUSPECT else None
        if fall is not None:
            number, time, state = fall
            going.end_at(time, state)
            yield going.arc(motion.guards[number].name)
            return
        if ended in FAILURES:
            yield going.arc(None, FAILURES[ended])
            return
        if going.steps == MANY or going.time >= end:
            yield going.arc()
            going.make_room(FEW)
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
        room: int,
    ) -> None:
        self.functions, self.parameters = functions, parameters
        self.tolerance, self.size = np.array([tolerance, tolerance]), len(start[1])
        width = functions.width
        self.row, self.lost = longer(start[1], width), np.zeros(width)
        self.stages, self.span = np.zeros((ROWS, width)), np.array([start[0], end, 0.0])
        self.steps, self.calls = 0, 0
        self.trial: Stepping | None = None
        self.make_room(room)

    @property
    def time(self) -> float:
        """Where it is."""
        return float(self.span[0])

    @property
    def state(self) -> Array:
        """The state there."""
        return np.array(self.row[: self.size])

    def make_room(self, steps: int) -> None:
        """Begin an arc, with room for so many steps."""
        self.knots, self.terms = np.empty(steps + 1), np.empty(steps * POWERS * len(self.row))
        self.knots[0] = self.time

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
        """Return the arc that has been made, whose solution may keep the room there was for it."""
        width = len(self.row)
        solution = DenseSolution.of_steps(self.knots, self.terms, self.size, self.steps, width)
        arc = Arc(solution, self.state, guard, failure, self.steps, self.calls)
        self.steps, self.calls = 0, 0
        return arc

    def fall(self) -> tuple[int, float, Array] | None:
        """Return the guard that first falls through zero in the last step, when, and the state
        then.
        """
        begin, reach = float(self.knots[self.steps - 1]), self.time
        first, row = (self.steps - 1) * len(self.row) * POWERS, np.empty(len(self.row))
        functions, values = self.functions, np.empty(self.functions.number)

        def dense(at: float) -> Array:
            if at >= reach:
                return self.state
            functions.within(self.terms, first, (at - begin) / (reach - begin), row)
            return np.array(row[: self.size])

        def advance(at: float) -> Array:
            return self.beside().landed(begin, state, at)

        def guard(number: int) -> Callable[[Array], float]:
            def value(state: Array) -> float:
                functions.values(state, self.parameters, values)
                return float(values[number])

            return value

        state = dense(begin)
        return first_fall(
            [guard(number) for number in range(functions.number)], dense, advance, (begin, reach)
        )

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
        if self.trial is None:
            start, end, tolerance = (
                (self.time, self.state),
                float(self.span[1]),
                float(self.tolerance[0]),
            )
            self.trial = Stepping(self.functions, self.parameters, start, end, tolerance, 1)
        return self.trial

    def landed(self, time: float, state: Array, end: float) -> Array:
        """Return the state after one step or several from another state, which end at exactly this
        time.
        """
        self.row, self.lost = longer(state, len(self.row)), np.zeros(len(self.row))
        self.span = np.array([time, end, time - end])
        ended = FULL
        while ended == FULL and end > time:
            self.steps = 0
            ended = self.advance(guarded=False)
        return self.state
