"""Two surfaces touch the table at once."""

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, ClassVar

from tippetop.contact.mode import Event, EventKind, IntegratedMode, Reaction, Transition
from tippetop.contact.sliding import ROLLING, ROLLING_STOPPING
from tippetop.contact.surfaces import number_of
from tippetop.integrators.base import Function, Guard, Motion
from tippetop.mechanics.contact_pair import (
    PairMotion,
    Tops,
    sliding_pair,
    sliding_pair_rates,
    turning_along,
)
from tippetop.mechanics.motion import along_table, on_table
from tippetop.mechanics.pair_resolver import rolling_way
from tippetop.mechanics.rolling import (
    Slip,
    is_branched,
    is_set_valued,
    on_numbered_branch,
    on_other_branch,
    slip_length,
    without_rolling,
)
from tippetop.mechanics.state import SlidingState, State
from tippetop.mechanics.stick_slip import branch_guard, inner, slip_of
from tippetop.mechanics.top import Kind, Top
from tippetop.mechanics.vectors import Row, Scalar, Vector, dot

OPENING, ENDING, BRANCHING = "opening ", "ending ", "branching "

SLOWEST_SLIP = 1e-9
"""Slip in natural units at which it ends on one of two contacts, or on both where drilling is resisted too,
and is not followed further."""


@dataclass(frozen=True)
class OnTwo(IntegratedMode):
    """Two surfaces touch."""

    other: Top
    """The top with the second surface active."""
    rolls: float = 0.0
    """Sign of omega_e (see `tippetop.mechanics.contact_pair`); 0 where rolling is held, or not resisted."""

    @property
    def form(self) -> str:
        """How it rolls decides what its numbers say of the couple."""
        return f"{self.name} {self.rolls}"

    @property
    def label(self) -> str:
        """Its name, and the numbers of the surfaces."""
        first, second = sorted((number_of(self.top), number_of(self.other)))
        return f"{self.name}{self.held}_on_{first}_and_{second}"

    @property
    def held(self) -> str:
        """What its name says where rolling is held."""
        return "_without_rolling" if self.stopped else ""

    @property
    def stopped(self) -> bool:
        """Whether rolling is held."""
        return self.top.resists_rolling and not self.rolls

    @property
    def stuck(self) -> tuple[int, ...]:
        """Numbers of the surfaces that stick: none, where a mode does not say otherwise."""
        return ()

    @abstractmethod
    def found(self, y: Row) -> tuple[PairMotion, tuple[Slip, Slip]]:
        """What the table does, and how both contacts slip, from the numbers of the mode."""

    def reaction(self, y: Row) -> Reaction:
        """Force of both contacts, and their torque about the first contact point."""
        found, slips = self.found(y)
        power: Any = dot(found.couple, found.pair.first.turning)
        for slip, wrench in zip(slips, found.wrenches, strict=True):
            power = power + (wrench.force[0] * slip[0] + wrench.force[1] * slip[1])
        return Reaction(found.force, found.torque, power, found.couple)

    def stilled(self, axis: Vector, momentum: Vector) -> Vector:
        """The angular momentum, without rolling where that is held."""
        return without_rolling(axis, momentum, self.top) if self.stopped else momentum

    def settled(self, time: float, state: State, rolls: float) -> Transition:
        """What the resolver finds where slip, or rolling, has ended, or begins as signed."""
        return self.rules.settled_on_two(time, state, self.tops, self.stuck, (self.rolls, rolls))

    def follow_rolling(self, guard: str, time: float, state: State) -> Transition:
        """What follows where rolling ends, or can be held no longer: there are no other guards."""
        ends = guard == ROLLING_STOPPING
        return self.settled(time, state, 0.0 if ends else rolling_way(self.found(self.numbers(state))[0]))

    @property
    def tops(self) -> Tops:
        """The top with either surface active."""
        return self.top, self.other

    @property
    def parameters(self) -> tuple[Scalar, ...]:
        """The numbers of the top on either surface: the branches of their laws may differ."""
        return (*self.top.numbers, *self.other.numbers)

    def opening(self, number: int, time: float, state: State, *, slips: bool) -> Transition:
        """One of both surfaces opens, while the other goes on, slipping or not."""
        left, kept = (self.tops, self.tops[::-1])[number]
        event = Event(EventKind.OPENING, time, surface=number_of(left))
        state = state._replace(momentum=self.stilled(state.axis, state.momentum))
        return Transition((event,), self.rules.on(number_of(kept)).going_on(state, slips=slips), state)


@dataclass(frozen=True)
class SlidingOnTwo(OnTwo):
    """Sliding on two surfaces, as long as both normal forces are positive."""

    name: ClassVar[str] = "sliding"

    @property
    def motion(self) -> Motion:
        """Equations of motion, with the guards of both contacts."""
        return motion_on_two(self.top.kind, self.other.kind, self.rolls)

    def numbers(self, state: State) -> tuple[Scalar, ...]:
        """The 8 numbers of a sliding state."""
        return along_table(state).pack()

    def state(self, y: Row) -> State:
        """The state, with its height."""
        return on_table(SlidingState.unpack(y), self.top)

    def found(self, y: Row) -> tuple[PairMotion, tuple[Slip, Slip]]:
        """What the table does, and how both contacts slip."""
        return sliding_pair(SlidingState.unpack(y), self.tops, self.rolls)

    def follow(self, guard: str, time: float, state: State) -> Transition:
        """One surface opens, while the other goes on; or slip or rolling ends."""
        kind, _, number = guard.rpartition(" ")
        if f"{kind} " == OPENING:
            return self.opening(int(number), time, state, slips=True)
        if f"{kind} " == BRANCHING:
            tops = list(self.tops)
            tops[int(number)] = on_other_branch(tops[int(number)])
            return Transition((), replace(self, top=tops[0], other=tops[1]), state)
        if f"{kind} " == ENDING:
            return self.settled(time, state, self.rolls)
        return self.follow_rolling(guard, time, state)


def on_two(state: State, rules: Any, other: Top, rolls: float) -> SlidingOnTwo:
    """The mode of a body that slides on the surface of some rules and on another."""
    tops: Tops = (rules.top, other)
    if is_branched(other.friction):
        one, two = (on_numbered_branch(top, slip_of(*along_table(state), top)) for top in tops)
        tops = one, two
    return SlidingOnTwo(tops[0], rules, tops[1], rolls)


def tops_of(first: Kind, second: Kind, numbers: Sequence[Scalar]) -> Tops:
    """The top on either surface."""
    cut = first.numbers
    return first.top(tuple(numbers[:cut])), second.top(tuple(numbers[cut : cut + second.numbers]))


@lru_cache
def motion_on_two(first: Kind, second: Kind, rolls: float) -> Motion:
    """Equations of motion of a top of these kinds: of another active surface and branch of the law each."""

    def rates(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> tuple[Scalar, ...]:
        return sliding_pair_rates(SlidingState.unpack(y), tops_of(first, second, numbers), rolls).pack()

    def found(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> PairMotion:
        return sliding_pair(SlidingState.unpack(y), tops_of(first, second, numbers), rolls)[0]

    def slip(number: int) -> Function:
        def value(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> Scalar:
            found = slip_of(*SlidingState.unpack(y), tops_of(first, second, numbers)[number])
            return inner(found, found) - SLOWEST_SLIP * SLOWEST_SLIP

        return value

    def both_slips(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> Scalar:
        one, other = (slip_of(*SlidingState.unpack(y), top) for top in tops_of(first, second, numbers))
        return inner(one, one) + inner(other, other) - SLOWEST_SLIP * SLOWEST_SLIP

    def branch(number: int) -> Function:
        def value(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> Scalar:
            return branch_guard(*SlidingState.unpack(y), tops_of(first, second, numbers)[number])

        return value

    guards = pair_guards(first, found, rolls)
    if slip_length(first.example.friction) is not None:
        guards.append(Guard(f"{ENDING}both", both_slips))
    elif is_set_valued(first.example.friction):
        guards += [Guard(f"{ENDING}{number}", slip(number)) for number in (0, 1)]
    if is_branched(first.example.friction):
        guards += [Guard(f"{BRANCHING}{number}", branch(number)) for number in (0, 1)]
    return Motion(
        rates, size=8, parameters=first.numbers + second.numbers, guards=tuple(guards), lasting=False
    )


def pair_guards(first: Kind, found: Any, rolls: float) -> list[Guard]:
    """The guards of normal forces, and of rolling, from what the table does.

    While both contacts stay closed the tilt does not change, and no further surface comes to the table.
    """

    def normal(number: int) -> Function:
        return lambda y, numbers: found(y, numbers).normal[number]

    def rolling(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> Scalar:
        return rolls * turning_along(found(y, numbers).pair)

    def reserve(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> Scalar:
        return found(y, numbers).rolling_reserve

    guards = [Guard(f"{OPENING}{number}", normal(number)) for number in (0, 1)]
    if first.example.resists_rolling:
        guards.append(Guard(ROLLING_STOPPING, rolling) if rolls else Guard(ROLLING, reserve))
    return guards
