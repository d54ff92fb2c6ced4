"""The moments in which slip, or rolling, begins, and slip that ends as it began: in one piece."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

from tippetop.contact.growth import growth
from tippetop.contact.mode import COMPLETED, FAILURE, Mode, ModeEnd, Segment, explanation
from tippetop.contact.passing import LOOKS, SETTLED, Passing
from tippetop.contact.slipping import slip_phase
from tippetop.integrators.base import Integrator
from tippetop.integrators.dense import DenseSolution
from tippetop.mechanics.beginning import beginning
from tippetop.mechanics.branches import on_branch
from tippetop.mechanics.contacts.contact_point import ContactPoint
from tippetop.mechanics.ending import Vanishing
from tippetop.mechanics.rolling import is_set_valued
from tippetop.mechanics.series import horner
from tippetop.mechanics.slip_onset import onset
from tippetop.mechanics.state import State
from tippetop.mechanics.stick_slip import scaled, size, slip_of
from tippetop.mechanics.vectors import Scalar
from tippetop.mechanics.wrench import Slip, Wrench

PRESSED = 5
"""Which of the looks along a beginning look at the normal force, too."""

ORDER, ACCURACY = 20, 1e-13
"""Degree of the series with which slip begins, and the size of its last terms relative to the
first.
"""

INSTANT = 1e-9
"""How long slip and rolling that begin at once go on at their first rates, in natural units of
time.
"""

PART = 0.25
"""Part of the time in which another velocity could end at its first rate that such a beginning
lasts.
"""

TINY = 1e-100
"""What begins at zero, and has no direction there, in natural units: nothing, but for that."""

BEGUN, ENDED = "begun", "slip ended"
"""Causes of the end of such a mode: what begins is followed like anything else from here on, or
slip has ended.
"""

UNSEEN = "slip, or rolling, cannot be told from its beginning"
"""Why a run fails where what begins is lost in rounding."""


@dataclass(frozen=True)
class Loosening(Passing):
    """The first moments of slip, or of rolling, as a power series in time."""

    power: int = 1
    """How it grows with time: 2 from the limit of what can be held, 1 from beyond it."""
    wrench: Wrench | None = None
    """What has held it until now, if that is known."""

    def segments(
        self, time: float, state: State, end: float, integrator: Integrator
    ) -> Iterator[Segment]:
        """Evaluate the series."""
        try:
            passing, direction, longest = self._directed(state)
            velocity = state.velocity[:2] if self.ending.moves else ()
            if self.ending.recurs(self.top):
                found = passing.slips(time, state, direction, end)
                if found is not None:
                    yield found
                    return
            start, degree = (state.axis, state.momentum, direction), ORDER + self.power - 1
            known = growth(start, passing.top, self.ending, velocity, degree, integrator)
            begin = onset(known, self.power, ORDER)
        except ArithmeticError as error:
            what = "slip" if self.ending.slip else "rolling"
            why = explanation(f"The direction in which {what} begins", error)
            yield nothing(self.told, time, state, why)
            return
        duration = min(begin.valid_until(ACCURACY), longest, end - time)
        if duration <= 1e-299:
            yield nothing(self.told, time, state, UNSEEN)
            return
        yield piece(passing, begin.rows, direction, (time, duration, end))

    def slips(self, time: float, state: State, direction: Slip, end: float) -> Segment | None:
        """Slip to its end, or as far as it follows what drives it; None if it does not from the
        beginning.
        """
        begin = (*state.axis, *state.momentum)
        phase = slip_phase(begin, direction, self.top, self.ending, end - time, pulls=self.pulls)
        if not phase.rows:
            return None
        start = [*begin, *scaled(TINY, direction)]
        last = self.state([*phase.last[:-2], 0.0, 0.0] if phase.ended else phase.last)
        duration = phase.knots[-1]
        reach = end if duration >= end - time else time + duration
        solution = DenseSolution.of_rows(phase.knots, start, phase.rows).moved(time, reach)
        cause = COMPLETED if reach >= end else BEGUN
        how = ModeEnd(ENDED if phase.ended else cause, last)
        return Segment(self, solution, last, how, len(phase.knots) - 1, phase.sweeps)

    def _directed(self, state: State) -> "tuple[Loosening, tuple[float, ...], float]":
        """The mode on its law's branch, the direction of what begins, and how long it lasts at
        most.

        In planar motion what ends meanwhile passes through zero, which series do not see.
        """
        ending, other = self.ending, Vanishing(not self.ending.slip)
        point = ContactPoint.of(state.axis, state.momentum, self.top)
        slip, rolling = None, None
        if ending.moves:
            slip = slip_of(state.axis, state.momentum, state.velocity[:2], self.top)
        if ending.slip and not ending.held:
            rolling = point.turning[:2]
        found = beginning(point, slip, rolling, (ending.slip, not ending.slip), self.wrench)
        top = on_branch(self.top, found.slip) if found.slip is not None else self.top
        way = found.slip if ending.slip else found.rolling
        assert way is not None
        beside, ends = rolling, top.resists_rolling
        if ending.moves:
            beside, ends = slip, is_set_valued(top.friction)
        longest = math.inf
        if beside is not None and ends and size(beside) > 0.0:
            longest = PART * size(beside) / size(other.rate(found.acceleration, top))
        return replace(self, top=top), way, longest

    @property
    def stuck(self) -> bool:
        """Whether the contact sticks meanwhile."""
        return not self.ending.slip and self.ending.held


@dataclass(frozen=True)
class BothLoosening(Loosening):
    """Slip and rolling begin at once: an instant at their first rates, to which what follows
    settles.
    """

    ending: Vanishing = Vanishing(slip=True)  # noqa: RUF009

    def segments(
        self, time: float, state: State, end: float, integrator: Integrator
    ) -> Iterator[Segment]:
        """Go on at the first rates."""
        point = ContactPoint.of(state.axis, state.momentum, self.top)
        try:
            found = beginning(point, None, None, (True, True))
        except ArithmeticError as error:
            why = explanation("The direction in which slip and rolling begin", error)
            yield nothing(self.told, time, state, why)
            return
        assert found.slip is not None
        passing, pace = (
            replace(self, top=on_branch(self.top, found.slip)),
            scaled(found.rates[0], found.slip),
        )
        still, growing = (
            (*state.axis, *state.momentum),
            (0.0, 0.0, 0.0, *point.moment(found.wrench)),
        )
        rows = [[number, rate] for number, rate in zip(still, growing, strict=True)]
        rows += [[0.0, rate] for rate in pace]
        yield piece(passing, rows, found.slip, (time, min(INSTANT, end - time), end))


def piece(
    mode: Any, rows: Sequence[list[Scalar]], direction: Slip, times: tuple[float, float, float]
) -> Segment:
    """The segment in which the numbers of a mode are polynomials in the time since its start.

    Parameters
    ----------
    mode
        What begins.
    rows
        The coefficients.
    direction
        That of what begins, which is zero, from the number on at which a mode has it.
    times
        When it begins, how long the polynomials are good, and when the run ends.
    """
    time, duration, end = times

    def at(look: int) -> list[Scalar]:
        return [horner(row, duration * look / LOOKS) for row in rows]

    while duration > SETTLED and not mode.goes_on(at, range(1 + PRESSED, LOOKS + 1, PRESSED)):
        duration *= 0.5
    # What is zero has no direction, and friction none to be against.
    first = mode.free
    past = first + len(direction)
    apart = [[TINY * e, *row[1:]] for e, row in zip(direction, rows[first:past], strict=True)]
    reach = min(time + duration, end)
    solution = DenseSolution.in_time(
        [0.0, duration], [[*rows[:first], *apart, *rows[past:]]]
    ).moved(time, reach)
    last = mode.state([horner(row, duration) for row in rows])
    how = ModeEnd(COMPLETED if reach >= end else BEGUN, last)
    return Segment(mode, solution, last, how, steps=1)


def nothing(mode: Mode, time: float, state: State, why: str) -> Segment:
    """Return a segment without any motion, after which a run fails."""
    return Segment(mode, DenseSolution.nothing(time, 8), state, ModeEnd(FAILURE, state, detail=why))
