"""The top touches the table and slides."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import ClassVar

from tippetop.contact.mode import IntegratedMode, Reaction, Transition
from tippetop.integrators.base import Function, Guard, Motion
from tippetop.mechanics.motion import along_table, contact, on_table, sliding_rates
from tippetop.mechanics.state import SlidingState, State
from tippetop.mechanics.top import Kind
from tippetop.mechanics.vectors import Row, Scalar

LIFT_OFF = "lift-off"


@dataclass(frozen=True)
class Sliding(IntegratedMode):
    """Sliding, as long as the normal force is positive or the table may pull."""

    name: ClassVar[str] = "sliding"

    @property
    def motion(self) -> Motion:
        """Equations of motion, and the lift-off guard where the table cannot pull."""
        return sliding_motion(self.top.kind, self.rules is not None)

    def numbers(self, state: State) -> tuple[Scalar, ...]:
        """The 8 numbers of a sliding state."""
        return along_table(state).pack()

    def state(self, y: Row) -> State:
        """The state, with its height and sinking."""
        return on_table(SlidingState.unpack(y), self.top)

    def reaction(self, y: Row) -> Reaction:
        """The contact force and torque."""
        state = SlidingState.unpack(y)
        touch = contact(state.axis, state.momentum, state.velocity, self.top)
        return Reaction(touch.force, touch.torque, touch.power)

    def follow(self, guard: str, time: float, state: State) -> Transition:
        """What the rules say of lift-off."""
        assert self.rules is not None, "a table that may pull has no guard"
        return self.rules.lift_off(time, state)


@lru_cache
def sliding_motion(kind: Kind, guarded: bool) -> Motion:
    """Equations of motion of a sliding top of this kind, with the lift-off guard if wanted."""

    def rates(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> tuple[Scalar, ...]:
        return sliding_rates(SlidingState.unpack(y), kind.top(tuple(numbers))).pack()

    guards = (Guard(LIFT_OFF, normal_force(kind)),) if guarded else ()
    return Motion(rates, size=8, parameters=kind.numbers, guards=guards)


@lru_cache
def normal_force(kind: Kind) -> Function:
    """Normal force on a sliding top of this kind as a function of its state and numbers."""

    def value(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> Scalar:
        state = SlidingState.unpack(y)
        return contact(state.axis, state.momentum, state.velocity, kind.top(tuple(numbers))).normal_force

    return value
