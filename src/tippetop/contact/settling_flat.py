"""The mode in which a body on an edge comes to lie flat, in closed form."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

from tippetop.contact.contact_mode import ContactMode
from tippetop.contact.mode import COMPLETED, Mode, ModeEnd, Segment, split
from tippetop.integrators.base import Array, Integrator
from tippetop.integrators.dense import DenseSolution
from tippetop.mechanics.lying_down import (
    Wobble,
    scaled_wobble,
    slaps_soon,
    time_to_slap,
    wobble_guard,
)
from tippetop.mechanics.motion import along_table
from tippetop.mechanics.state import State
from tippetop.mechanics.vectors import Row, Scalar

FLAT = "flat"
"""Cause of the end of `SettlingFlat`: the body lies flat."""

REMAINS = 1e-6
"""Part of the time left at which the motion is followed no further: at zero tilt the contact point
is undefined.
"""

DEGREE = 14
"""Degree of the polynomial that stands for the motion, whose highest power is 5."""


@dataclass(frozen=True)
class SettlingFlat(Mode):
    """A face closes onto the table in so short a time that the law of its end gives it."""

    reported_mode: ContactMode
    """The mode that a result reports for it."""
    slaps: bool
    """Whether the face slaps onto the table; else the body wobbles down."""

    name: ClassVar[str] = "settling flat"

    def state(self, y: Row) -> State:
        """Return the state as in the reported mode."""
        return self.reported_mode.state(y)

    def segments(
        self, time: float, state: State, end: float, integrator: Integrator
    ) -> Iterator[Segment]:
        """Follow the law to the end of the motion, or of the run."""
        duration = self._duration(state)
        elapsed = min(duration, end - time)

        def numbers_at(times: Array) -> Row:
            return self._numbers_at(state, times, duration)

        solution = DenseSolution.fitted(numbers_at, [0.0, elapsed], DEGREE)
        last = self.state(self._numbers_at(state, elapsed, duration))
        cause = FLAT if duration <= end - time else COMPLETED
        moved = solution.moved(time, time + elapsed)
        yield Segment(self.reported_mode, moved, last, ModeEnd(cause, last))

    def _duration(self, state: State) -> float:
        """Return the time until the body lies flat."""
        mode, numbers = self.reported_mode, self.reported_mode.numbers(state)
        if self.slaps:
            moment = split(mode.rates(numbers))[1]
            return float(time_to_slap(state.axis, state.momentum, moment, self.top))
        normal = mode.contacts(numbers).normal_if_stuck()
        return float(Wobble.of(state.axis, state.momentum, normal, self.top).time_left)

    def _numbers_at(self, state: State, elapsed: Scalar, duration: float) -> Row:
        """Return the numbers of the reported mode after a time.

        Towards a slap they change at the rates they have, and the tilt falls straight to zero.
        """
        mode, part = self.reported_mode, 1.0 - (1.0 - REMAINS) * elapsed / duration
        if not self.slaps:
            sliding = scaled_wobble(along_table(state), part, mode.sticks[0], self.top)
            return sliding.pack()[: mode.count]
        numbers = mode.numbers(state)
        moved = [a + elapsed * b for a, b in zip(numbers, mode.rates(numbers), strict=True)]
        return (part * numbers[0], part * numbers[1], *moved[2:])


def settling_flat(mode: ContactMode, state: State) -> SettlingFlat | None:
    """Return the mode in which a body on an edge comes to lie flat; None if it does not soon."""
    if slaps_soon(state.axis, state.momentum, mode.top):
        return SettlingFlat(mode.top, mode, slaps=True)
    normal = mode.contacts(mode.numbers(state)).normal_if_stuck()
    if wobble_guard(state.axis, state.momentum, normal, mode.top) <= 0.0:
        return SettlingFlat(mode.top, mode, slaps=False)
    return None
