"""The top touches the table and slides."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, ClassVar

from tippetop.contact.mode import IntegratedMode, Reaction, Transition
from tippetop.contact.surfaces import follow_surface, surface_guards
from tippetop.integrators.base import Function, Guard, Motion
from tippetop.mechanics.motion import along_table, angular_velocity, contact, on_table, sliding_rates
from tippetop.mechanics.rolling import is_set_valued, sliding_law, with_sliding_law
from tippetop.mechanics.state import SlidingState, State
from tippetop.mechanics.stick_slip import HORIZON, slip_of, stopping_guard
from tippetop.mechanics.top import Kind, Top
from tippetop.mechanics.vectors import Row, Scalar

LIFT_OFF, STOPPING, BRANCH = "lift-off", "stopping", "branch"


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
        """What the rules say of lift-off, or of slip that is about to end; or the law's other branch."""
        if guard == LIFT_OFF:
            return self.rules.lift_off(time, state)
        if guard == STOPPING:
            return self.rules.stopping(time, state)
        found = follow_surface(self, guard, time, state)
        if found is not None:
            return found
        law: Any = sliding_law(self.top.friction)
        return Transition((), replace(self, top=with_sliding_law(self.top, law.other_branch())), state)


@lru_cache
def sliding_motion(kind: Kind, guarded: bool) -> Motion:
    """Equations of motion of a sliding top of this kind; if `guarded`, the first guard is of lift-off."""

    def rates(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> tuple[Scalar, ...]:
        return sliding_rates(SlidingState.unpack(y), kind.top(tuple(numbers))).pack()

    def stops(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> Scalar:
        state, top = SlidingState.unpack(y), kind.top(tuple(numbers))
        return stopping(state, top)

    def on_branch(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> Scalar:
        state, top = SlidingState.unpack(y), kind.top(tuple(numbers))
        law: Any = sliding_law(top.friction)
        slip = slip_of(state.axis, state.momentum, state.velocity, top)
        return law.branch_guard(slip[:2], angular_velocity(state.axis, state.momentum, top))

    guards = [Guard(LIFT_OFF, normal_force(kind))] if guarded else []
    law = kind.example.friction
    if is_set_valued(law):
        guards.append(Guard(STOPPING, stops))
    if hasattr(sliding_law(law), "branch_guard"):
        guards.append(Guard(BRANCH, on_branch))
    guards += surface_guards(kind)
    return Motion(rates, size=8, parameters=kind.numbers, guards=tuple(guards))


def stopping(state: SlidingState, top: Top) -> Scalar:
    """Value of the guard of slip that is about to end: positive as long as it goes on."""
    return stopping_guard(state, sliding_rates(state, top), top, HORIZON)


@lru_cache
def normal_force(kind: Kind) -> Function:
    """Normal force on a sliding top of this kind as a function of its state and numbers."""

    def value(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> Scalar:
        state = SlidingState.unpack(y)
        return contact(state.axis, state.momentum, state.velocity, kind.top(tuple(numbers))).normal_force

    return value
