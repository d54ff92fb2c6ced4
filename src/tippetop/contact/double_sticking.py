"""The first moments of slip at one of two closed contacts, or at both."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import ClassVar

from tippetop.contact.closed import GuardValue, split
from tippetop.contact.double import TwoContactMode
from tippetop.contact.loosening import ACCURACY, ORDER, nothing, piece
from tippetop.contact.mode import Segment, explanation
from tippetop.contact.passing import LOOKS
from tippetop.integrators.base import Integrator
from tippetop.mechanics.contact_pair import ContactPair, slips_of
from tippetop.mechanics.motion import axis_rate, on_table
from tippetop.mechanics.pair_motion import PairMotion, pair_motion
from tippetop.mechanics.slip_onset import Growing, onset
from tippetop.mechanics.state import SlidingState, State
from tippetop.mechanics.stick_slip import velocity_of
from tippetop.mechanics.vectors import Row
from tippetop.mechanics.wrench import Slip


@dataclass(frozen=True)
class SlipBeginningOnTwo(TwoContactMode):
    """The first moments of slip at a contact, or at both, as power series in time.

    Slip itself is told, and loses no digits.
    """

    begin: tuple[float, ...] = ()
    """Its numbers at the start: axis, angular momentum, and xi (see
    `tippetop.mechanics.contact_pair`).
    """
    direction: Slip = ()
    """Direction of what begins: of the slip of the first contact, or of xi."""
    growing: int = 1
    """With which power of time it does; see `tippetop.mechanics.slip_onset`."""

    free: ClassVar[int] = 6
    """How many numbers come before what begins."""

    def state(self, y: Row) -> State:
        """The state, with its height."""
        axis, momentum = split(y)
        momentum = self.stilled(axis, momentum)
        velocity = velocity_of(axis, momentum, (y[6], y[7]), self.top)
        return on_table(SlidingState(axis, momentum, velocity), self.top)

    def found(self, y: Row) -> tuple[PairMotion, tuple[Slip, Slip]]:
        """What the table does, and how both contacts slip."""
        pair = ContactPair.of(*split(y), self.tops)
        slips = slips_of(pair, (y[6], y[7], y[8]))
        return pair_motion(pair, slips, self.rolls), slips

    def growth(self, y: Row, way: Slip) -> tuple[Row, Row]:
        """How its numbers, and what begins, change where that goes this way."""
        axis, momentum = split(y)
        pair = ContactPair.of(axis, momentum, self.tops)
        slips = (
            slips_of(pair, way) if len(way) == 3 else (way, slips_of(pair, (y[6], y[7], y[8]))[1])
        )
        now = pair_motion(pair, slips, self.rolls)
        return (*axis_rate(axis, momentum, self.top), *now.moment, *now.rate), now.rate[: len(way)]

    def endings(self) -> list[GuardValue]:
        """It has just begun."""
        return []

    def goes_on(self, at: Callable[[int], Row], pressed: Sequence[int]) -> bool:
        """Whether no guard has fallen at any look."""
        looks = [at(look) for look in range(1, LOOKS + 1)]
        return all(value(self, y) > 0.0 for _, value in self.guard_values() for y in looks)

    def segments(
        self, time: float, state: State, end: float, integrator: Integrator
    ) -> Iterator[Segment]:
        """Evaluate the series."""
        try:
            begun = onset(Growing(self.begin, self.direction, self.growth), self.growing, ORDER)
            rows = [*begun.axis, *begun.momentum, *begun.velocity]
            duration = min(begun.valid_until(ACCURACY), end - time)
            yield piece(self, rows, self.direction, (time, duration, end))
        except ArithmeticError as error:
            yield nothing(self, time, state, explanation("How slip begins on two surfaces", error))
