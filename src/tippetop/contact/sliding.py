"""The top touches the table and slides."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import ClassVar

from tippetop.contact.mode import IntegratedMode, Reaction, Transition
from tippetop.integrators.base import Function, Guard, Motion
from tippetop.mechanics.motion import along_table, contact, on_table, sliding_rates
from tippetop.mechanics.rolling import is_set_valued
from tippetop.mechanics.state import SlidingState, State
from tippetop.mechanics.stick_slip import HORIZON, slip_of, stopping_guard
from tippetop.mechanics.top import Kind, Top
from tippetop.mechanics.vectors import Row, Scalar

LIFT_OFF, STOPPING = "lift-off", "stopping"


@dataclass(frozen=True)
class Sliding(IntegratedMode):
    """Sliding, as long as the normal force is positive or the table may pull, and slip does not end."""

    name: ClassVar[str] = "sliding"

    @property
    def motion(self) -> Motion:
        """Equations of motion, with the guards of lift-off and of the end of slip where there are such."""
        return sliding_motion(self.top.kind, not self.rules.pulls)

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
        """What the rules say of lift-off, or of slip that is about to end."""
        if guard == LIFT_OFF:
            return self.rules.lift_off(time, state)
        return self.rules.stopping(time, state)


@lru_cache
def sliding_motion(kind: Kind, guarded: bool) -> Motion:
    """Equations of motion of a sliding top of this kind; if `guarded`, the first guard is of lift-off."""

    def rates(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> tuple[Scalar, ...]:
        return sliding_rates(SlidingState.unpack(y), kind.top(tuple(numbers))).pack()

    def stops(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> Scalar:
        state, top = SlidingState.unpack(y), kind.top(tuple(numbers))
        return stopping_guard(state, sliding_rates(state, top), top, HORIZON)

    guards = [Guard(LIFT_OFF, normal_force(kind))] if guarded else []
    if is_set_valued(kind.example.friction):
        guards.append(Guard(STOPPING, stops))
    return Motion(rates, size=8, parameters=kind.numbers, guards=tuple(guards))


@lru_cache
def normal_force(kind: Kind) -> Function:
    """Normal force on a sliding top of this kind as a function of its state and numbers."""

    def value(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> Scalar:
        state = SlidingState.unpack(y)
        return contact(state.axis, state.momentum, state.velocity, kind.top(tuple(numbers))).normal_force

    return value


def is_slipping(state: State, top: Top) -> bool:
    """Whether the contact of a body on the table slips, or drills where its law resists that."""
    slip = slip_of(state.axis, state.momentum, state.velocity[:2], top)
    scale = sum(abs(number) for number in (*state.momentum, *state.velocity))
    return any(abs(number) > ROUNDING * scale for number in slip)


def is_stopping(state: State, top: Top) -> bool:
    """Whether slip is so near to its end that the guard of that has already fallen through zero."""
    sliding = along_table(state)
    return bool(stopping_guard(sliding, sliding_rates(sliding, top), top, HORIZON) < 0.0)


ROUNDING = 1e-14
"""Slip, relative to the velocities it is made of, that is rounding."""
