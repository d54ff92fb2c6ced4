"""The top flies, in closed form."""

# translate module: numbers

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import ClassVar

from tippetop.contact.mode import COMPLETED, FAILURE, Mode, ModeEnd, Segment, explanation
from tippetop.integrators.base import Integrator
from tippetop.integrators.dense import ELEMENTARY, DenseSolution
from tippetop.mechanics.flight.free_motion import flight_rates, fly, gap, gap_rate, precession
from tippetop.mechanics.flight.touchdown import Start, highest_gap, touchdown
from tippetop.mechanics.state import State
from tippetop.mechanics.surfaces.surface import support_at
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Row, Scalar

DEGREE = 14
"""Degree of the polynomials that stand for a flight in a solution."""

TURN = 0.5
"""Angle through which the axis turns in each of them, rad: what they leave out is below rounding.

It is TURN^(DEGREE + 1) / (DEGREE + 1)!, 2e-17. The marker's angle is a quadrature over each,
whose rate is singular at the farther pole: longer ones would come near that.
"""

MOST_STEPS = 4096
"""Polynomials in a segment at most."""

LANDING = "landing"
"""Cause of the end of a flight on the table."""

TOUCHING = 1e-12
"""Gap, and gap rate, in natural units, up to which a surface touches, and neither opens nor closes.
"""


@dataclass(frozen=True)
class Flight(Mode):
    """Free flight, until the body's lowest point touches the table again."""

    start: Start = Start.AIRBORNE
    """How the flight starts: thrown, rebounding, released or lifting off."""

    name: ClassVar[str] = "flight"
    touching: ClassVar[bool] = False

    def state(self, y: Row) -> State:
        """Return the state, whose numbers are those of a flight."""
        return State.unpack(y)

    def segments(
        self, time: float, state: State, end: float, integrator: Integrator
    ) -> Iterator[Segment]:
        """Evaluate the flight, which needs no integrator."""
        try:
            landing, lowest = self._landing(state, end - time)
        except ArithmeticError as error:
            empty = DenseSolution.empty(time, len(state.pack()))
            why = explanation("The end of the flight", error)
            yield Segment(self, empty, state, ModeEnd(FAILURE, state, detail=why))
            return
        duration = end - time if landing is None else landing
        count = 1 + int(duration * precession(state, self.top) / TURN)
        for first in range(0, count, MOST_STEPS):
            last = min(first + MOST_STEPS, count)
            elapsed = [duration / count * step for step in range(first, last + 1)]
            elapsed[-1] = duration if last == count else elapsed[-1]
            later = fly(state, elapsed[-1], self.top, math)
            how, reach = None, time + elapsed[-1]
            if last == count:
                reach = end if landing is None else reach
                how = self._end(later, None if landing is None else lowest)
            solution = self._solution(state, elapsed).moved(time, reach)
            highest = highest_gap(state, self.top, elapsed[-1])
            yield Segment(self, solution, later, how, highest_gap=highest)

    def _solution(self, state: State, elapsed: Sequence[float]) -> DenseSolution:
        """Return the flight from a state on, in steps of equal length."""

        def moving(time: Scalar) -> tuple[Row, Row, Row]:
            later = fly(state, time, self.top, ELEMENTARY)
            rate, second = flight_rates(later, self.top)
            return later.pack(), rate.pack(), second.pack()

        swinging = precession(state, self.top), elapsed, DEGREE, len(state.axis)
        return DenseSolution.swinging(moving, *swinging)

    def _landing(self, state: State, horizon: float) -> tuple[float | None, Top]:
        """Return when the first surface touches the table, and the top with that surface active."""
        first_time = touchdown(state, self.top, horizon, self.start)
        lowest = self.top
        for top in self.top.each:
            if top != self.top:
                limit = horizon if first_time is None else first_time
                sooner = touchdown(state, top, limit, start_of(state, top))
                if sooner is not None and (first_time is None or sooner < first_time):
                    first_time, lowest = sooner, top
        return first_time, lowest

    def _end(self, state: State, lowest: Top | None) -> ModeEnd:
        """Return how the flight ends: on a surface, or with the run."""
        if lowest is None:
            return ModeEnd(COMPLETED, state)
        later = state._replace(height=support_at(state.axis, lowest.surface)[0])
        return ModeEnd(LANDING, later, lowest.active)


def start_of(state: State, top: Top) -> Start:
    """Return how a flight starts for a surface: open, or just opened."""
    rate = gap_rate(state, top)
    if gap(state, top) > TOUCHING or rate < -TOUCHING:
        return Start.AIRBORNE
    return Start.REBOUND if rate > TOUCHING else Start.RELEASE
