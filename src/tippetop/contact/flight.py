"""The top flies, in closed form."""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from tippetop.contact.mode import Mode, Outcome, Segment, Transition
from tippetop.integrators.base import Array, Integrator
from tippetop.integrators.dense import DenseSolution
from tippetop.mechanics.flight import fly
from tippetop.mechanics.motion import along_table, on_table
from tippetop.mechanics.state import State
from tippetop.mechanics.touchdown import Start, highest_gap, touchdown
from tippetop.mechanics.vectors import Row, length

DEGREE = 14
"""Degree of the polynomials that stand for a flight in a solution."""

TURN = 0.25
"""Angle through which the axis turns in each of them, rad: what they leave out is below rounding."""

MOST_STEPS = 4096
"""Polynomials in a segment at most."""


@dataclass(frozen=True)
class Flight(Mode):
    """Free flight, until the body's lowest point touches the table again.

    Attributes
    ----------
    start
        How the flight starts: thrown, rebounding, released or lifting off.
    """

    start: Start = Start.AIRBORNE

    name: ClassVar[str] = "flight"
    touching: ClassVar[bool] = False

    def state(self, y: Row) -> State:
        """The numbers of a flight are those of the state."""
        return State.unpack(y)

    def segments(self, time: float, state: State, end: float, integrator: Integrator) -> Iterator[Segment]:
        """Evaluate the flight, which needs no integrator."""
        landing = touchdown(state, self.top, end - time, self.start)
        duration = end - time if landing is None else landing
        rate = length(state.momentum) / self.top.transverse_inertia
        count = 1 + int(duration * rate / TURN)
        highest = highest_gap(state, self.top, duration)
        for first in range(0, count, MOST_STEPS):
            last = min(first + MOST_STEPS, count)
            elapsed: Array = duration / count * np.arange(first, last + 1.0)
            elapsed[-1] = duration if last == count else elapsed[-1]
            here = fly(state, float(elapsed[-1]), self.top, math)
            transition = None
            knots: Array = time + elapsed
            if last == count:
                knots[-1] = end if landing is None else knots[-1]
                transition = self._transition(float(knots[-1]), here, landing is not None)
            solution = DenseSolution.fitted(self._numbers(state), elapsed, DEGREE)
            yield Segment(self, replace(solution, knots=knots), here, transition, highest_gap=highest)

    def _numbers(self, state: State) -> Callable[[Array], Array]:
        """The numbers of the flight as a function of the time since its start."""

        def numbers(elapsed: Array) -> Array:
            return np.stack(np.broadcast_arrays(*fly(state, elapsed, self.top, np).pack()), axis=-1)

        return numbers

    def _transition(self, time: float, state: State, landed: bool) -> Transition:
        if not landed:
            return Transition((), Outcome.COMPLETED, state)
        return self.rules.touchdown(
            time, state._replace(height=on_table(along_table(state), self.top).height)
        )
