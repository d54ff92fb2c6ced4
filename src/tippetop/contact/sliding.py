"""The top touches the table and slides, rolling or not."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import ClassVar

from tippetop.contact.mode import EventKind, IntegratedMode, Reaction, Transition
from tippetop.contact.surfaces import follow_surface, surface_guards
from tippetop.integrators.base import Guard, Motion
from tippetop.mechanics.ending import Vanishing
from tippetop.mechanics.motion import (
    along_table,
    axis_rate,
    contact,
    on_table,
    sliding_rates,
)
from tippetop.mechanics.rolling import (
    ContactPoint,
    Wrench,
    contact_motion,
    is_set_valued,
    on_other_branch,
    rolling_reserve,
    sliding_law,
    without_rolling,
)
from tippetop.mechanics.state import SlidingState, State
from tippetop.mechanics.stick_slip import (
    branch_guard,
    nearing_guard,
    parting_guard,
    rolling_stopping_guard,
    scaled,
    slip_of,
    stopping_guard,
)
from tippetop.mechanics.top import Kind, Top
from tippetop.mechanics.vectors import Row, Scalar, dot

LIFT_OFF, NEARING, PARTING, STOPPING, ROLLING_STOPPING, ROLLING, BRANCH = (
    "lift-off",
    "nearing",
    "parting",
    "stopping",
    "rolling stopping",
    "rolling",
    "branch",
)


@dataclass(frozen=True)
class Sliding(IntegratedMode):
    """Sliding, as long as the normal force is positive or the table may pull, and slip does not end."""

    near: bool = False
    """Whether slip is so small that it may be about to end."""

    name: ClassVar[str] = "sliding"
    held: ClassVar[bool] = False

    @property
    def motion(self) -> Motion:
        """Equations of motion, with the guards of lift-off and of ending velocities where there are such."""
        return sliding_motion(self.top.kind, not self.rules.pulls, self.near, self.held)

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
        if guard in (NEARING, PARTING):
            return Transition((), self.rules.going_on(state, slips=True), state)
        if guard in (STOPPING, ROLLING_STOPPING):
            return self.rules.stopping(time, state)
        found = follow_surface(self, guard, time, state)
        if found is not None:
            return found
        return Transition((), replace(self, top=on_other_branch(self.top)), state)


@dataclass(frozen=True)
class SlidingWithoutRolling(Sliding):
    """Sliding while rolling resistance holds the top: it turns about the vertical, or not at all."""

    name: ClassVar[str] = "sliding_without_rolling"
    held: ClassVar[bool] = True

    def state(self, y: Row) -> State:
        """The state, with its height and sinking, and without rolling."""
        sliding = SlidingState.unpack(y)
        momentum = without_rolling(sliding.axis, sliding.momentum, self.top)
        return on_table(sliding._replace(momentum=momentum), self.top)

    def reaction(self, y: Row) -> Reaction:
        """The contact force and torque."""
        state = SlidingState.unpack(y)
        point, wrench = holding(state, self.top)
        slip = slip_of(*state, self.top)
        power = wrench.force[0] * slip[0] + wrench.force[1] * slip[1] + dot(wrench.torque, point.turning)
        return Reaction(wrench.force, wrench.torque, power)

    def follow(self, guard: str, time: float, state: State) -> Transition:
        """Rolling begins; or what follows sliding."""
        if guard == ROLLING:
            if self.reaction(self.numbers(state)).force[2] <= 0.0 and not self.rules.pulls:
                return self.rules.lift_off(time, state)
            return self.rules.giving_way(
                state, (self.rules.event(EventKind.ROLL, time),), Vanishing(slip=False)
            )
        return super().follow(guard, time, state)


def holding(state: SlidingState, top: Top) -> tuple[ContactPoint, Wrench]:
    """The contact point of a sliding body whose rolling is held, and what the table does."""
    point = ContactPoint.of(state.axis, state.momentum, top)
    return point, contact_motion(point, slip_of(*state, top), None)[0]


def held_rates(state: SlidingState, top: Top) -> SlidingState:
    """Time derivative of the state of a sliding body whose rolling is held."""
    point, wrench = holding(state, top)
    x, y = scaled(1.0 / top.mass, wrench.force[:2])
    return SlidingState(axis_rate(state.axis, state.momentum, top), point.moment(wrench), (x, y))


@lru_cache
def sliding_motion(kind: Kind, guarded: bool, near: bool = False, held: bool = False) -> Motion:
    """Equations of motion of a sliding top of this kind, whose rolling may be held.

    If `guarded`, the first guard is of lift-off. Where slip can end, it is watched how long it lasts if that
    may be soon (`near`), and else whether it may.
    """
    law, rate, guards = kind.example.friction, held_rates if held else sliding_rates, list[Guard]()

    def rates(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> tuple[Scalar, ...]:
        return rate(SlidingState.unpack(y), kind.top(tuple(numbers))).pack()

    def add_guard(name: str, value: Callable[[SlidingState, Top], Scalar]) -> None:
        guards.append(Guard(name, lambda y, numbers: value(SlidingState.unpack(y), kind.top(tuple(numbers)))))

    def force(state: SlidingState, top: Top) -> Scalar:
        return holding(state, top)[1].force[2] if held else contact(*state, top).normal_force

    if guarded:
        add_guard(LIFT_OFF, force)
    if is_set_valued(law) and near:
        add_guard(STOPPING, lambda state, top: stopping_guard(state, rate(state, top), top))
        add_guard(PARTING, parting_guard)
    elif is_set_valued(law):
        add_guard(NEARING, nearing_guard)
    if hasattr(sliding_law(law), "branch_guard"):
        add_guard(BRANCH, lambda state, top: branch_guard(slip_of(*state, top), top))
    if held:
        add_guard(ROLLING, lambda state, top: rolling_reserve(*holding(state, top), slip_of(*state, top)))
    elif kind.example.resists_rolling:
        add_guard(ROLLING_STOPPING, lambda state, top: rolling_stopping_guard(state, rate(state, top), top))
    return Motion(rates, 8, kind.numbers, (*guards, *surface_guards(kind)), lasting=not held)
