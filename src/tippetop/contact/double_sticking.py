"""Two surfaces touch the table at once, and one does not slip, or both; and how slip begins there."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, ClassVar

from tippetop.contact.double import BRANCHING, OPENING, OnTwo, SlidingOnTwo, pair_guards, tops_of
from tippetop.contact.mode import Outcome, Segment, Transition
from tippetop.contact.sticking import split
from tippetop.contact.surfaces import number_of
from tippetop.integrators import make_integrator
from tippetop.integrators.base import Function, Guard, Integrator, Motion
from tippetop.mechanics.contact_pair import (
    ContactPair,
    PairMotion,
    directions_of,
    pair_motion,
    slip_apart,
    slips_of,
    turning_along,
)
from tippetop.mechanics.motion import along_table, axis_rate, on_table
from tippetop.mechanics.rolling import Slip, is_branched, slip_length, velocity_without_slip, without_drilling
from tippetop.mechanics.state import SlidingState, State
from tippetop.mechanics.stick_slip import slip_branch_guard, slip_of, velocity_of
from tippetop.mechanics.top import Kind
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

    @property
    def motion(self) -> Motion:
        """Equations of motion of axis and angular momentum, and guards."""
        return turning_motion(self.top.kind, self.other.kind, self.sign, self.rolls)

    def found(self, y: Row) -> tuple[PairMotion, tuple[Slip, Slip]]:
        """What the table does, and how both contacts slip."""
        pair = ContactPair.of(*split(y), self.tops)
        zeta = slip_apart(pair)
        return turned(pair, self.sign, self.rolls), slips_of(pair, (0.0 * zeta, 0.0 * zeta, zeta))

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

    @property
    def parameters(self) -> tuple[Scalar, ...]:
        """The numbers of the top on either surface, and when patches slip."""
        return (*self.top.numbers, *self.other.numbers, self.least)

    @property
    def stuck(self) -> tuple[int, ...]:
        """Both surfaces."""
        return number_of(self.top), number_of(self.other)

    @property
    def motion(self) -> Motion:
        """Equations of motion of axis and angular momentum, and the guards of what holds the contacts."""
        return held_motion_on_two(self.top.kind, self.other.kind, self.rolls)

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

    @property
    def motion(self) -> Motion:
        """Equations of motion, with the guards of both contacts."""
        return beginning_on_two(self.top.kind, self.other.kind, self.rolls)

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

    def segments(self, time: float, state: State, end: float, integrator: Integrator) -> Iterator[Segment]:
        """Follow it by an implicit method: its direction is damped the faster the slower it is."""
        reach, method = min(time + BEGINNING, end), make_integrator("collocation", TOLERANCE)
        for segment in super().segments(time, state, reach, method):
            found = segment.transition
            if found is not None and found.then is Outcome.COMPLETED and reach < end:
                then = SlidingOnTwo(self.top, self.rules, self.other, self.rolls)
                found = Transition((), then, found.state)
            yield replace(segment, transition=found, method=method)


def turned(pair: ContactPair, sign: Scalar, rolls: float) -> PairMotion:
    """What the table does while the first contact sticks, and the second slips so across the axis."""
    across = directions_of(pair.first.axis)[1]
    return pair_motion(pair, (None, (sign * across[0], sign * across[1])), rolls)


@lru_cache
def turning_motion(first: Kind, second: Kind, sign: float, rolls: float) -> Motion:
    """Equations of motion while the first contact sticks and the second slips across the axis, as signed."""

    def found(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> PairMotion:
        return turned(ContactPair.of(*split(y), tops_of(first, second, numbers)), sign, rolls)

    def slides(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> Scalar:
        return sign * slip_apart(ContactPair.of(*split(y), tops_of(first, second, numbers)))

    def holds(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> Scalar:
        return found(y, numbers).reserve(0)

    guards = [Guard(f"{SLIP}first", holds), Guard(ENDING, slides)]
    return _of_momentum(first, second, found, [*guards, *pair_guards(first, found, rolls)])


@lru_cache
def held_motion_on_two(first: Kind, second: Kind, rolls: float) -> Motion:
    """Equations of motion while both contacts stick; the last parameter is when patches slip."""

    def found(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> PairMotion:
        return pair_motion(ContactPair.of(*split(y), tops_of(first, second, numbers)), (None, None), rolls)

    guards = pair_guards(first, found, rolls)
    if slip_length(first.example.friction) is None:
        guards += [
            Guard(f"{SLIP}0", lambda y, numbers: found(y, numbers).left(0)),
            Guard(f"{SLIP}1", lambda y, numbers: found(y, numbers).left(1)),
            Guard(f"{SLIP}both", lambda y, numbers: found(y, numbers).both_reserve),
        ]
    elif rolls:
        guards.append(
            Guard(
                f"{SLIP}both",
                lambda y, numbers: rolls * turning_along(found(y, numbers).pair) - numbers[-1],
            )
        )
    return _of_momentum(first, second, found, guards, 1)


@lru_cache
def beginning_on_two(first: Kind, second: Kind, rolls: float) -> Motion:
    """Equations of motion while both contacts slip, with xi, of which a part may have just begun."""

    def found(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> PairMotion:
        pair = ContactPair.of(*split(y), tops_of(first, second, numbers))
        return pair_motion(pair, slips_of(pair, (y[6], y[7], y[8])), rolls)

    def rates(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> tuple[Scalar, ...]:
        now = found(y, numbers)
        axis, momentum = split(y)
        return (*axis_rate(axis, momentum, now.pair.first.top), *now.moment, *now.rate)

    def branch(number: int) -> Function:
        def value(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> Scalar:
            point = found(y, numbers).pair[number]
            return slip_branch_guard(slips_of(found(y, numbers).pair, (y[6], y[7], y[8]))[number], point.top)

        return value

    guards = pair_guards(first, found, rolls)
    if is_branched(first.example.friction):
        guards += [Guard(f"{BRANCHING}{number}", branch(number)) for number in (0, 1)]
    return Motion(rates, 9, first.numbers + second.numbers, tuple(guards), lasting=False)


def _of_momentum(first: Kind, second: Kind, found: Any, guards: Sequence[Guard], further: int = 0) -> Motion:
    """Equations of motion of axis and angular momentum, with so many further parameters."""

    def rates(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> tuple[Scalar, ...]:
        now = found(y, numbers)
        return (*axis_rate(*split(y), now.pair.first.top), *now.moment)

    return Motion(rates, 6, first.numbers + second.numbers + further, tuple(guards), lasting=False)
