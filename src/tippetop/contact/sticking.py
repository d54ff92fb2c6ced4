"""The contact sticks: the top rolls without slipping, or is held altogether."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import ClassVar

from tippetop.contact.mode import EventKind, IntegratedMode, Reaction, Transition
from tippetop.contact.sliding import ROLLING, ROLLING_STOPPING
from tippetop.contact.surfaces import follow_surface, surface_guards
from tippetop.integrators.base import Guard, Motion
from tippetop.mechanics.ending import Vanishing
from tippetop.mechanics.motion import axis_rate, on_table
from tippetop.mechanics.rolling import (
    ContactPoint,
    Wrench,
    contact_motion,
    has_limit_branches,
    limit_guard,
    on_other_branch,
    rolling_reserve,
    slip_reserve,
    velocity_without_slip,
    without_rolling,
)
from tippetop.mechanics.state import SlidingState, State
from tippetop.mechanics.stick_slip import remaining
from tippetop.mechanics.top import Kind, Top
from tippetop.mechanics.vectors import Row, Scalar, Vector, dot

SLIP, LIMIT_BRANCH = "slip", "limit branch"


@dataclass(frozen=True)
class Sticking(IntegratedMode):
    """Rolling without slipping, and without drilling where the law resists that."""

    name: ClassVar[str] = "sticking"
    held: ClassVar[bool] = False

    @property
    def motion(self) -> Motion:
        """Equations of motion of axis and angular momentum, and the guards of what holds the contact."""
        return sticking_motion(self.top.kind, self.held)

    def numbers(self, state: State) -> tuple[Scalar, ...]:
        """Axis and angular momentum."""
        return (*state.axis, *state.momentum)

    def state(self, y: Row) -> State:
        """The state, whose velocity is that of rolling."""
        axis, momentum = split(y)
        velocity = velocity_without_slip(axis, momentum, self.top)
        return on_table(SlidingState(axis, momentum, velocity), self.top)

    def reaction(self, y: Row) -> Reaction:
        """The contact force and torque that hold the contact point."""
        point, wrench = sticking_wrench(*split(y), self.top, self.held)
        return Reaction(wrench.force, wrench.torque, dot(wrench.torque, point.turning))

    def follow(self, guard: str, time: float, state: State) -> Transition:
        """Slip begins, or rolling; or rolling is about to end; or the limit surface's other branch holds."""
        if guard == ROLLING_STOPPING:
            return self.rules.stopping(time, state, slips=False)
        if guard == LIMIT_BRANCH:
            return Transition((), replace(self, top=on_other_branch(self.top)), state)
        found = follow_surface(self, guard, time, state)
        if found is not None:
            return found
        _, wrench = sticking_wrench(state.axis, state.momentum, self.top, self.held)
        if wrench.force[2] <= 0.0 and not self.rules.pulls:
            return self.rules.lift_off(time, state)
        kind = EventKind.ROLL if guard == ROLLING else EventKind.SLIP
        beginning = (
            Vanishing(slip=False, held=True) if guard == ROLLING else Vanishing(slip=True, held=self.held)
        )
        return self.rules.giving_way(state, (self.rules.event(kind, time),), beginning, wrench)


@dataclass(frozen=True)
class StickingWithoutRolling(Sticking):
    """Neither slip nor rolling: the top turns about the vertical, or not at all."""

    name: ClassVar[str] = "sticking_without_rolling"
    held: ClassVar[bool] = True

    def state(self, y: Row) -> State:
        """The state, without rolling."""
        axis, momentum = split(y)
        return super().state((*axis, *without_rolling(axis, momentum, self.top)))


def sticking_wrench(axis: Vector, momentum: Vector, top: Top, held: bool) -> tuple[ContactPoint, Wrench]:
    """The contact point of a sticking body, whose rolling may be held too, and what the table does."""
    point = ContactPoint.of(axis, momentum, top)
    return point, contact_motion(point, None, None if held else point.turning[:2])[0]


@lru_cache
def sticking_motion(kind: Kind, held: bool) -> Motion:
    """Equations of motion of a sticking top of this kind, whose rolling may be held too."""
    guards = list[Guard]()

    def here(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> tuple[ContactPoint, Wrench]:
        return sticking_wrench(*split(y), kind.top(tuple(numbers)), held)

    def rates(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> tuple[Scalar, ...]:
        point, wrench = here(y, numbers)
        return (*axis_rate(*split(y), point.top), *point.moment(wrench))

    def add_guard(name: str, value: Callable[[ContactPoint, Wrench], Scalar]) -> None:
        guards.append(Guard(name, lambda y, numbers: value(*here(y, numbers))))

    add_guard(SLIP, lambda point, wrench: slip_reserve(point.top, wrench))
    if has_limit_branches(kind.example.friction):
        add_guard(LIMIT_BRANCH, lambda point, wrench: limit_guard(point.top, wrench))
    if held:
        add_guard(ROLLING, lambda point, wrench: rolling_reserve(point, wrench, None))
    elif kind.example.resists_rolling:
        add_guard(ROLLING_STOPPING, lambda point, _: rolling_lasts(point))
    guards += surface_guards(kind)
    return Motion(rates, size=6, parameters=kind.numbers, guards=tuple(guards), lasting=False)


def rolling_lasts(point: ContactPoint) -> Scalar:
    """Positive while a body that rolls without slipping does so for a while."""
    rolling = point.turning[:2]
    return remaining(rolling, contact_motion(point, None, rolling)[1].turning[:2])


def split(y: Row) -> tuple[Vector, Vector]:
    """Axis and angular momentum, the first numbers of every mode in contact."""
    return (y[0], y[1], y[2]), (y[3], y[4], y[5])
