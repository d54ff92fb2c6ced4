"""Modes in which one contact is closed: what all have in common, whether it slips or sticks, and
rolls.
"""

from abc import abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, ClassVar, Self, TypeAlias

from tippetop.contact.mode import IntegratedMode, Reaction
from tippetop.contact.surfaces import surface_guards
from tippetop.integrators.base import Guard, Motion
from tippetop.mechanics.contacts.contact_point import Acceleration, ContactPoint
from tippetop.mechanics.motion import along_table, axis_rate, on_table
from tippetop.mechanics.rolling import (
    contact_motion,
    rolling_reserve,
    velocity_without_slip,
    without_rolling,
)
from tippetop.mechanics.state import SlidingState, State
from tippetop.mechanics.stick_slip import remaining, scaled, slip_of
from tippetop.mechanics.top import Kind, Top
from tippetop.mechanics.vectors import Row, Scalar, Vector, dot
from tippetop.mechanics.wrench import Slip, Wrench

LIFT_OFF, STOPPING, SLIP, BRANCH, LIMIT_BRANCH = (
    "lift-off",
    "stopping",
    "slip",
    "branch",
    "limit branch",
)
ROLLING, ROLLING_STOPPING = "rolling", "rolling stopping"

GuardValue: TypeAlias = tuple[str, Callable[[Any, Row], Scalar]]
"""Name of a guard, and its value from a mode and the numbers of that."""


@dataclass(frozen=True)
class StatedMode(IntegratedMode):
    """A mode that states its rates and guards for its own tops: others of their kinds have them
    too.
    """

    size: ClassVar[int] = 8
    """How many numbers the mode has."""
    further: ClassVar[int] = 0
    """How many parameters, beside the numbers of its tops."""

    @property
    def lasting(self) -> bool:
        """No run stays in it for long, where a mode does not say otherwise."""
        return False

    @property
    def motion(self) -> Motion:
        """Equations of motion and guards."""
        return motion_of(self.without_tops(), tuple(top.kind for top in self.tops))

    @property
    def parameters(self) -> tuple[Scalar, ...]:
        """The numbers of its tops."""
        return tuple(number for top in self.tops for number in top.numbers)

    def with_tops(self, tops: Sequence[Top], more: Sequence[Scalar]) -> Self:
        """The same with tops, and with its further parameters."""
        return replace(self, top=tops[0])

    @abstractmethod
    def rates(self, y: Row) -> tuple[Scalar, ...]:
        """Time derivatives of the numbers."""

    @abstractmethod
    def guard_values(self) -> list[GuardValue]:
        """The guards."""


@lru_cache
def motion_of(form: Any, kinds: tuple[Kind, ...]) -> Motion:
    """Equations of motion of a mode without tops, for tops of these kinds."""

    def mode(numbers: Sequence[Scalar]) -> Any:
        tops, first = list[Top](), 0
        for kind in kinds:
            tops.append(kind.top(tuple(numbers[first : first + kind.numbers])))
            first += kind.numbers
        return form.with_tops(tops, numbers[first:])

    def guard(name: str, value: Callable[[Any, Row], Scalar]) -> Guard:
        return Guard(name, lambda y, numbers: value(mode(numbers), y))

    def rates(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> tuple[Scalar, ...]:
        found: tuple[Scalar, ...] = mode(numbers).rates(y)
        return found

    example = form.with_tops([kind.example for kind in kinds], (0.0,) * form.further)
    guards = tuple(guard(name, value) for name, value in example.guard_values())
    count = sum(kind.numbers for kind in kinds) + form.further
    return Motion(rates, form.size, count, guards, form.lasting)


@dataclass(frozen=True)
class ClosedMode(StatedMode):
    """One contact is closed."""

    sticks: ClassVar[bool] = False
    held: ClassVar[bool] = False
    """Whether slip is held, and whether rolling is."""

    def found(self, y: Row) -> tuple[ContactPoint, Slip | None, Wrench, Acceleration]:
        """The contact point, its slip, what the table does, and the acceleration, from the
        numbers.
        """
        point = ContactPoint.of(*split(y), self.top)
        slip = None if self.sticks else slip_of(*split(y), (y[6], y[7]), self.top)[:2]
        return point, slip, *contact_motion(point, slip, None if self.held else point.turning[:2])

    def numbers(self, state: State) -> tuple[Scalar, ...]:
        """Axis, angular momentum, and velocity if it slips."""
        return along_table(state).pack()[: self.size]

    def state(self, y: Row) -> State:
        """The state, with its height and sinking; what is held is zero."""
        axis, momentum = split(y)
        if self.held:
            momentum = without_rolling(axis, momentum, self.top)
        velocity = velocity_without_slip(axis, momentum, self.top) if self.sticks else (y[6], y[7])
        return on_table(SlidingState(axis, momentum, velocity), self.top)

    def rates(self, y: Row) -> tuple[Scalar, ...]:
        """Rates of axis and angular momentum, and of the velocity if it slips."""
        point, slip, wrench, _ = self.found(y)
        drawn = () if slip is None else scaled(1.0 / self.top.mass, wrench.force[:2])
        return (*axis_rate(*split(y), self.top), *point.moment(wrench), *drawn)

    def reaction(self, y: Row) -> Reaction:
        """The contact force and torque."""
        point, slip, wrench, _ = self.found(y)
        power = dot(wrench.torque, point.turning)
        if slip is not None:
            power = wrench.force[0] * slip[0] + wrench.force[1] * slip[1] + power
        return Reaction(wrench.force, wrench.torque, power)

    def guard_values(self) -> list[GuardValue]:
        """The guards of rolling, and of what the body's shape makes happen."""
        found = list[GuardValue]()
        if self.held:
            found.append((ROLLING, lambda mode, y: mode.rolling_reserve(y)))
        elif self.top.resists_rolling:
            found.append((ROLLING_STOPPING, lambda mode, y: mode.rolling_left(y)))
        return found + [(name, _of_top(value)) for name, value in surface_guards(self.top)]

    def rolling_reserve(self, y: Row) -> Scalar:
        """Positive while the table can exert the couple that holds rolling."""
        point, slip, wrench, _ = self.found(y)
        return rolling_reserve(point, wrench, slip)

    def rolling_left(self, y: Row) -> Scalar:
        """Positive while rolling goes on for a while."""
        point, _, _, acceleration = self.found(y)
        return remaining(point.turning[:2], acceleration.turning[:2])


def _of_top(value: Callable[[Top, Vector], Scalar]) -> Callable[[Any, Row], Scalar]:
    return lambda mode, y: value(mode.top, (y[0], y[1], y[2]))


def split(y: Row) -> tuple[Vector, Vector]:
    """Axis and angular momentum, the first numbers of every mode in contact."""
    return (y[0], y[1], y[2]), (y[3], y[4], y[5])
