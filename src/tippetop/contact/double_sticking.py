"""Two surfaces touch the table at once, and one does not slip, or both; and how slip begins there."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import ClassVar, Self

from tippetop.contact.closed import GuardValue, split
from tippetop.contact.double import OPENING, OnTwo, SlidingOnTwo
from tippetop.contact.mode import Outcome, Segment, Transition
from tippetop.contact.surfaces import number_of
from tippetop.integrators import make_integrator
from tippetop.integrators.base import Integrator
from tippetop.mechanics.contact_pair import (
    ContactPair,
    PairMotion,
    directions_of,
    pair_motion,
    slip_apart,
    slips_of,
)
from tippetop.mechanics.motion import along_table, on_table
from tippetop.mechanics.rolling import Slip, slip_length, velocity_without_slip, without_drilling
from tippetop.mechanics.state import SlidingState, State
from tippetop.mechanics.stick_slip import scaled, slip_of, velocity_of
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Row, Scalar

SLIP, ENDING = "slip ", "ending"

BEGINNING = 0.02
"""How long slip that begins is followed by the implicit method, in natural units of time: afterwards its
direction is damped no faster than the body moves."""

TOLERANCE = 1e-13
"""Relative error per step of that method."""


@dataclass(frozen=True)
class HeldOnTwo(OnTwo):
    """The first contact sticks, if not both: axis and angular momentum say how the body rolls on it."""

    def numbers(self, state: State) -> tuple[Scalar, ...]:
        """Axis and angular momentum."""
        return (*state.axis, *state.momentum)

    def state(self, y: Row) -> State:
        """The state, whose velocity is that of rolling on the first contact."""
        axis, momentum = split(y)
        momentum = self.stilled(axis, momentum)
        velocity = velocity_without_slip(axis, momentum, self.top)
        return on_table(SlidingState(axis, momentum, velocity), self.top)

    def follow(self, guard: str, time: float, state: State) -> Transition:
        """Slip begins; or rolling ends or begins."""
        if guard.startswith(SLIP):
            which = guard.removeprefix(SLIP)
            return self.rules.slipping_on_two(time, state, self.tops, which, self.rolls)
        return self.follow_rolling(guard, time, state)


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

    def found(self, y: Row) -> tuple[PairMotion, tuple[Slip, Slip]]:
        """What the table does, and how both contacts slip."""
        pair = ContactPair.of(*split(y), self.tops)
        zeta, way = slip_apart(pair), scaled(self.sign, directions_of(pair.first.axis)[1][:2])
        return pair_motion(pair, (None, way), self.rolls), slips_of(pair, (0.0 * zeta, 0.0 * zeta, zeta))

    def guard_values(self) -> list[GuardValue]:
        """The guards of what holds the first, and of slip on the second, too."""
        own: list[GuardValue] = [
            (f"{SLIP}first", lambda mode, y: mode.found(y)[0].reserve(0)),
            (ENDING, lambda mode, y: mode.sign * slip_apart(ContactPair.of(*split(y), mode.tops))),
        ]
        return own + super().guard_values()

    def follow(self, guard: str, time: float, state: State) -> Transition:
        """A contact opens; or slip ends on the second, or begins on the first."""
        if guard.startswith(OPENING):
            number = int(guard.removeprefix(OPENING))
            return self.opening(number, time, state, slips=number == 0)
        if guard == ENDING:
            return self.settled(time, state, self.rolls)
        return super().follow(guard, time, state)


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
                (f"{SLIP}0", lambda mode, y: mode.found(y)[0].left(0)),
                (f"{SLIP}1", lambda mode, y: mode.found(y)[0].left(1)),
                (f"{SLIP}both", lambda mode, y: mode.found(y)[0].both_reserve),
            ]
        elif self.rolls:
            found.append((f"{SLIP}both", lambda mode, y: mode.rolls * mode.found(y)[0].rolling - mode.least))
        return found

    def state(self, y: Row) -> State:
        """The state, without turning about the vertical, whose velocity is that of rolling."""
        axis, momentum = split(y)
        return super().state((*axis, *without_drilling(axis, momentum, self.top)))

    def found(self, y: Row) -> tuple[PairMotion, tuple[Slip, Slip]]:
        """What the table does, and that neither contact slips."""
        pair = ContactPair.of(*split(y), self.tops)
        return pair_motion(pair, (None, None), self.rolls), ((0.0, 0.0), (0.0, 0.0))

    def follow(self, guard: str, time: float, state: State) -> Transition:
        """A contact opens, or one slips, or both."""
        if guard.startswith(OPENING):
            return self.opening(int(guard.removeprefix(OPENING)), time, state, slips=False)
        return super().follow(guard, time, state)


@dataclass(frozen=True)
class SlipBeginningOnTwo(SlidingOnTwo):
    """The first moments of slip at a contact, or at both: slip itself is what moves, and loses no digits."""

    begin: tuple[float, ...] = ()
    """Its numbers at the start: axis, angular momentum, and xi (see `tippetop.mechanics.contact_pair`)."""

    size: ClassVar[int] = 9

    def without_tops(self) -> Self:
        """Without the numbers at the start, too."""
        return replace(super().without_tops(), begin=())

    def numbers(self, state: State) -> tuple[Scalar, ...]:
        """Those it begins with."""
        return self.begin

    def state(self, y: Row) -> State:
        """The state, with its height."""
        axis, momentum = split(y)
        momentum = self.stilled(axis, momentum)
        velocity = velocity_of(axis, momentum, (y[6], y[7]), self.top)
        return on_table(SlidingState(axis, momentum, velocity), self.top)

    def follow(self, guard: str, time: float, state: State) -> Transition:
        """As where it has begun; on another branch of the law it goes on as it is."""
        found = super().follow(guard, time, state)
        if not isinstance(found.then, SlipBeginningOnTwo):
            return found
        slip = slip_of(*along_table(state), self.top)
        apart = slip_apart(ContactPair.of(state.axis, state.momentum, self.tops))
        begin = (*state.axis, *state.momentum, slip[0], slip[1], apart)
        return replace(found, then=replace(found.then, begin=begin))

    def found(self, y: Row) -> tuple[PairMotion, tuple[Slip, Slip]]:
        """What the table does, and how both contacts slip."""
        pair = ContactPair.of(*split(y), self.tops)
        slips = slips_of(pair, (y[6], y[7], y[8]))
        return pair_motion(pair, slips, self.rolls), slips

    def slipping(self, now: PairMotion) -> Slip:
        """Rate of xi."""
        return now.rate

    def endings(self) -> list[GuardValue]:
        """It has just begun."""
        return []

    def segments(self, time: float, state: State, end: float, integrator: Integrator) -> Iterator[Segment]:
        """Follow it by an implicit method: its direction is damped the faster the slower it is."""
        reach, method = min(time + BEGINNING, end), make_integrator("collocation", TOLERANCE)
        for segment in super().segments(time, state, reach, method):
            found = segment.transition
            if found is not None and found.then is Outcome.COMPLETED and reach < end:
                then = SlidingOnTwo(self.top, self.rules, self.other, self.rolls)
                found = Transition((), then, found.state)
            yield replace(segment, transition=found, method=method)
