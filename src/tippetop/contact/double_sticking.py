"""Two surfaces touch the table at once, and one does not slip, or both; and how slip begins
there.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import ClassVar, Self

from tippetop.contact.closed import SLIP, GuardValue, split
from tippetop.contact.double import ENDING, OnTwo, SlidingOnTwo
from tippetop.contact.loosening import ACCURACY, ORDER, nothing, piece
from tippetop.contact.mode import Segment, explanation, numbered
from tippetop.contact.passing import LOOKS
from tippetop.contact.surfaces import number_of
from tippetop.integrators.base import Integrator
from tippetop.mechanics.contact_pair import ContactPair, slip_apart, slips_of
from tippetop.mechanics.motion import axis_rate, on_table
from tippetop.mechanics.pair_motion import PairMotion, pair_motion
from tippetop.mechanics.rolling import (
    directions_of,
    slip_length,
    velocity_without_slip,
    without_drilling,
)
from tippetop.mechanics.slip_onset import Growing, onset
from tippetop.mechanics.state import SlidingState, State
from tippetop.mechanics.stick_slip import scaled, velocity_of
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Row, Scalar
from tippetop.mechanics.wrench import Slip


@dataclass(frozen=True)
class HeldOnTwo(OnTwo):
    """The first contact sticks, if not both: axis and angular momentum say how the body rolls on
    it.
    """

    def numbers(self, state: State) -> tuple[Scalar, ...]:
        """Axis and angular momentum."""
        return (*state.axis, *state.momentum)

    def state(self, y: Row) -> State:
        """The state, whose velocity is that of rolling on the first contact."""
        axis, momentum = split(y)
        momentum = self.stilled(axis, momentum)
        velocity = velocity_without_slip(axis, momentum, self.top)
        return on_table(SlidingState(axis, momentum, velocity), self.top)


@dataclass(frozen=True)
class StickingAndSliding(HeldOnTwo):
    """The first contact sticks and the second slips across the axis: along t of `contact_pair`."""

    name: ClassVar[str] = "sticking_and_sliding"
    sign: ClassVar[float] = 1.0

    @property
    def label(self) -> str:
        """Its name, with the numbers of the surface that sticks, and of that which slips."""
        return f"sticking{self.held}_on_{number_of(self.top)}_sliding_on_{number_of(self.other)}"

    @property
    def stuck(self) -> tuple[int, ...]:
        """The first surface."""
        return (number_of(self.top),)

    def slips_on(self, contact: int) -> bool:
        """Return that the second does."""
        return contact == 1

    def found(self, y: Row) -> tuple[PairMotion, tuple[Slip, Slip]]:
        """What the table does, and how both contacts slip."""
        pair = ContactPair.of(*split(y), self.tops)
        zeta, way = slip_apart(pair), scaled(self.sign, directions_of(pair.first.axis)[1][:2])
        return pair_motion(pair, (None, way), self.rolls), slips_of(
            pair, (0.0 * zeta, 0.0 * zeta, zeta)
        )

    def guard_values(self) -> list[GuardValue]:
        """The guards of what holds the first, and of slip on the second, too."""
        own: list[GuardValue] = [
            (numbered(SLIP, 0), lambda mode, y: mode.found(y)[0].reserve(0)),
            (ENDING, lambda mode, y: mode.sign * slip_apart(ContactPair.of(*split(y), mode.tops))),
        ]
        return own + super().guard_values()


@dataclass(frozen=True)
class StickingAndSlidingBack(StickingAndSliding):
    """The same where the second contact slips the other way."""

    name: ClassVar[str] = "sticking_and_sliding_back"
    sign: ClassVar[float] = -1.0


@dataclass(frozen=True)
class StickingOnTwo(HeldOnTwo):
    """Both contacts stick: the body rolls about the line that joins them, or is at rest."""

    least: float = -1.0
    """The |omega_e| at which patches slip that stick while the body rolls."""

    name: ClassVar[str] = "sticking"
    further: ClassVar[int] = 1

    @property
    def parameters(self) -> tuple[Scalar, ...]:
        """The numbers of the top on either surface, and when patches slip."""
        return (*self.top.numbers, *self.other.numbers, self.least)

    @property
    def stuck(self) -> tuple[int, ...]:
        """Both surfaces."""
        return number_of(self.top), number_of(self.other)

    def slips_on(self, contact: int) -> bool:
        """Return that none does."""
        return False

    def without_tops(self) -> Self:
        """Without what is a parameter, too."""
        return replace(super().without_tops(), least=0.0)

    def with_tops(self, tops: Sequence[Top], more: Sequence[Scalar]) -> Self:
        """With that."""
        return replace(super().with_tops(tops, more), least=more[0])

    def guard_values(self) -> list[GuardValue]:
        """The guards of what holds the contacts, too."""
        found = super().guard_values()
        if slip_length(self.top.friction) is None:
            found += [
                (numbered(SLIP, 0), lambda mode, y: mode.found(y)[0].left(0)),
                (numbered(SLIP, 1), lambda mode, y: mode.found(y)[0].left(1)),
                (SLIP, lambda mode, y: mode.found(y)[0].both_reserve),
            ]
        elif self.rolls:
            found.append((SLIP, lambda mode, y: mode.rolls * mode.found(y)[0].rolling - mode.least))
        return found

    def state(self, y: Row) -> State:
        """The state, without turning about the vertical, whose velocity is that of rolling."""
        axis, momentum = split(y)
        return super().state((*axis, *without_drilling(axis, momentum, self.top)))

    def found(self, y: Row) -> tuple[PairMotion, tuple[Slip, Slip]]:
        """What the table does, and that neither contact slips."""
        pair = ContactPair.of(*split(y), self.tops)
        return pair_motion(pair, (None, None), self.rolls), ((0.0, 0.0), (0.0, 0.0))


@dataclass(frozen=True)
class SlipBeginningOnTwo(SlidingOnTwo):
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
