"""Two surfaces touch the table at once."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, ClassVar

from tippetop.contact.mode import Event, EventKind, IntegratedMode, Reaction, Transition
from tippetop.contact.surfaces import follow_surface, number_of, surface_guards
from tippetop.integrators.base import Function, Guard, Motion
from tippetop.mechanics.double_contact import Tops, double_contact, double_rates
from tippetop.mechanics.motion import along_table, on_table
from tippetop.mechanics.rolling import (
    is_branched,
    is_set_valued,
    on_numbered_branch,
    on_other_branch,
    slip_length,
)
from tippetop.mechanics.state import SlidingState, State
from tippetop.mechanics.stick_slip import branch_guard, inner, slip_of
from tippetop.mechanics.top import Kind, Top
from tippetop.mechanics.vectors import Row, Scalar

OPENING, ENDING, BRANCHING = "opening ", "ending ", "branching "

SLOWEST_SLIP = 1e-9
"""Slip in natural units at which it ends on one of two contacts, or on both where drilling is resisted too,
and is not followed further."""


@dataclass(frozen=True)
class OnTwo(IntegratedMode):
    """Two surfaces touch.

    Attributes
    ----------
    other
        The top with the second surface active.
    """

    other: Top

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
        return Transition((event,), self.rules.on(number_of(kept)).going_on(state, slips=slips), state)


@dataclass(frozen=True)
class SlidingOnTwo(OnTwo):
    """Sliding on two surfaces, as long as both normal forces are positive."""

    name: ClassVar[str] = "sliding"

    @property
    def motion(self) -> Motion:
        """Equations of motion, with the guards of both contacts and of further surfaces."""
        return motion_on_two(self.top.kind, self.other.kind)

    def numbers(self, state: State) -> tuple[Scalar, ...]:
        """The 8 numbers of a sliding state."""
        return along_table(state).pack()

    def state(self, y: Row) -> State:
        """The state, with its height."""
        return on_table(SlidingState.unpack(y), self.top)

    def reaction(self, y: Row) -> Reaction:
        """Force of both contacts, and their torque about the first contact point."""
        both = double_contact(SlidingState.unpack(y), self.tops)
        return Reaction(both.force, both.torque, both.power, both.couple)

    def follow(self, guard: str, time: float, state: State) -> Transition:
        """One surface opens, while the other goes on; or slip ends on one; or a further one touches."""
        kind, _, number = guard.rpartition(" ")
        if f"{kind} " == OPENING:
            return self.opening(int(number), time, state, slips=True)
        if f"{kind} " == BRANCHING:
            tops = list(self.tops)
            tops[int(number)] = on_other_branch(tops[int(number)])
            return Transition((), replace(self, top=tops[0], other=tops[1]), state)
        if f"{kind} " == ENDING:
            return self.rules.settled_on_two(time, state, self.tops, ())
        found = follow_surface(self, guard, time, state)
        assert found is not None, "there are no other guards"
        return found


def on_two(state: State, rules: Any, other: Top) -> SlidingOnTwo:
    """The mode of a body that slides on the surface of some rules and on another."""
    tops: Tops = (rules.top, other)
    if is_branched(other.friction):
        one, two = (on_numbered_branch(top, slip_of(*along_table(state), top)) for top in tops)
        tops = one, two
    return SlidingOnTwo(tops[0], rules, tops[1])


@lru_cache
def motion_on_two(first: Kind, second: Kind) -> Motion:
    """Equations of motion of a top of these kinds: of another active surface and branch of the law each."""

    def tops(numbers: Sequence[Scalar]) -> Tops:
        cut = first.numbers
        return first.top(tuple(numbers[:cut])), second.top(tuple(numbers[cut : 2 * cut]))

    def rates(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> tuple[Scalar, ...]:
        return double_rates(SlidingState.unpack(y), tops(numbers)).pack()

    def normal(number: int) -> Function:
        return lambda y, numbers: double_contact(SlidingState.unpack(y), tops(numbers)).normal[number]

    def slip(number: int) -> Function:
        def value(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> Scalar:
            found = slip_of(*SlidingState.unpack(y), tops(numbers)[number])
            return inner(found, found) - SLOWEST_SLIP * SLOWEST_SLIP

        return value

    def both_slips(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> Scalar:
        one, other = (slip_of(*SlidingState.unpack(y), top) for top in tops(numbers))
        return inner(one, one) + inner(other, other) - SLOWEST_SLIP * SLOWEST_SLIP

    def branch(number: int) -> Function:
        def value(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> Scalar:
            return branch_guard(*SlidingState.unpack(y), tops(numbers)[number])

        return value

    guards = [Guard(f"{OPENING}{number}", normal(number)) for number in (0, 1)]
    if slip_length(first.example.friction) is not None:
        guards.append(Guard(f"{ENDING}both", both_slips))
    elif is_set_valued(first.example.friction):
        guards += [Guard(f"{ENDING}{number}", slip(number)) for number in (0, 1)]
    if is_branched(first.example.friction):
        guards += [Guard(f"{BRANCHING}{number}", branch(number)) for number in (0, 1)]
    guards += surface_guards(first, (number_of(second.example),))
    return Motion(rates, size=8, parameters=2 * first.numbers, guards=tuple(guards), lasting=False)
