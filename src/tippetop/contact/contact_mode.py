"""The mode of one closed contact, by its status, and what all stated modes have in common."""

from abc import abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, ClassVar, Self, TypeAlias

from tippetop.contact.mode import IntegratedMode, Reaction
from tippetop.contact.surfaces import WOBBLE, SurfaceGuard, surface_guards
from tippetop.integrators.base import Guard, Motion
from tippetop.mechanics.contacts.branches import has_limit_branches, limit_guard
from tippetop.mechanics.contacts.contact_point import Acceleration, ContactPoint, flat
from tippetop.mechanics.contacts.forces import (
    forces_and_accelerations,
    is_set_valued,
    rolling_reserve,
    slip_length,
    slip_reserve,
    velocity_without_slip,
    without_rolling,
)
from tippetop.mechanics.contacts.slip_variables import (
    branch_guard,
    nearing_guard,
    parting_guard,
    remaining,
    rolling_stopping_guard,
    scaled,
    slip_of,
    slip_part,
)
from tippetop.mechanics.contacts.wrench import Slip, Wrench
from tippetop.mechanics.lying_down import LEFT_OUT, Wobble
from tippetop.mechanics.motion import along_table, axis_rate, on_table, sliding_rates
from tippetop.mechanics.state import SlidingState, State
from tippetop.mechanics.surfaces.hull import is_edge
from tippetop.mechanics.top import Kind, Top
from tippetop.mechanics.vectors import Row, Scalar, Vector, dot

LIFT_OFF, STOPPING, SLIP, BRANCH, LIMIT_BRANCH = (
    "lift-off",
    "stopping",
    "slip",
    "branch",
    "limit branch",
)
ROLLING, ROLLING_STOPPING = "rolling", "rolling stopping"
NEARING, PARTING = "nearing", "parting"

SLIPS, STICKS = "sliding", "sticking"
"""Status of a contact in the names of modes."""

GuardValue: TypeAlias = tuple[str, Callable[[Any, Row], Scalar]]
"""Name of a guard, and its value from a mode and the numbers of that."""


@dataclass(frozen=True)
class StatedMode(IntegratedMode):
    """A mode that states its rates and guards for its own tops: others of their kinds have them
    too.
    """

    size: ClassVar[int] = 8
    """How many numbers the mode has, unless `count` says otherwise."""

    @property
    def count(self) -> int:
        """How many numbers the mode has."""
        return self.size

    @property
    def further_count(self) -> int:
        """How many parameters there are beside the numbers of the tops."""
        return 0

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

    def with_tops(self, tops: Sequence[Top], further: Sequence[Scalar]) -> Self:
        """Return the mode with tops, and with further parameters."""
        return replace(self, top=tops[0])

    @abstractmethod
    def rates(self, y: Row) -> tuple[Scalar, ...]:
        """Time derivatives of the numbers."""

    @abstractmethod
    def guard_values(self) -> list[GuardValue]:
        """Return the guards."""


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
        values: tuple[Scalar, ...] = mode(numbers).rates(y)
        return values

    example = form.with_tops([kind.example for kind in kinds], (0.0,) * form.further_count)
    guards = tuple(guard(name, value) for name, value in example.guard_values())
    count = sum(kind.numbers for kind in kinds) + form.further_count
    return Motion(rates, form.count, count, guards, form.lasting)


@dataclass(frozen=True)
class ContactMode(StatedMode):
    """One contact is closed: it slips or sticks, and rolling goes on or is held."""

    sticks: bool = False
    """Whether it sticks, and does not drill where the law resists that; else it slips."""
    holds_rolling: bool = False
    """Whether rolling resistance holds the top, which turns about the vertical, or not at all."""
    near: bool = False
    """Whether slip is so small that it may be about to end, which then is guarded."""
    pulls: bool = False
    """Whether the table may pull; else slip ends where it would have to."""

    name: ClassVar[str] = "contact"

    @property
    def status(self) -> str:
        """Name of the motion in a result, without the surfaces that touch."""
        return (STICKS if self.sticks else SLIPS) + ("_without_rolling" * self.holds_rolling)

    @property
    def slides_freely(self) -> bool:
        """Whether it slips, and nothing holds rolling."""
        return not self.sticks and not self.holds_rolling

    @property
    def lasting(self) -> bool:
        """Whether runs may spend most of their steps in it."""
        return self.slides_freely and not self.near

    @property
    def count(self) -> int:
        """How many numbers the mode has: axis, angular momentum, and velocity if it slips."""
        return 6 if self.sticks else 8

    def contact_forces(self, y: Row) -> tuple[ContactPoint, Slip | None, Wrench, Acceleration]:
        """Return the contact point, its slip, the wrench of the table, and the acceleration."""
        point = ContactPoint.of(*split(y), self.top)
        slip = None if self.sticks else slip_of(*split(y), (y[6], y[7]), self.top)[:2]
        rolling = None if self.holds_rolling else point.turning[:2]
        return point, slip, *forces_and_accelerations(point, slip, rolling)

    def numbers(self, state: State) -> tuple[Scalar, ...]:
        """Axis, angular momentum, and velocity if it slips."""
        return along_table(state).pack()[: self.count]

    def state(self, y: Row) -> State:
        """Return the state, with its height and sinking; what is held is zero."""
        axis, momentum = split(y)
        if self.holds_rolling:
            momentum = without_rolling(axis, momentum, self.top)
        velocity = velocity_without_slip(axis, momentum, self.top) if self.sticks else (y[6], y[7])
        return on_table(SlidingState(axis, momentum, velocity), self.top)

    def rates(self, y: Row) -> tuple[Scalar, ...]:
        """Rates of axis and angular momentum, and of the velocity if it slips."""
        if self.slides_freely:
            return sliding_rates(SlidingState.unpack(y), self.top).pack()
        point, slip, wrench, _ = self.contact_forces(y)
        drawn = () if slip is None else scaled(1.0 / self.top.mass, wrench.force[:2])
        return (*axis_rate(*split(y), self.top), *point.moment(wrench), *drawn)

    def reaction(self, y: Row) -> Reaction:
        """Return the contact force and torque."""
        point, slip, wrench, _ = self.contact_forces(y)
        power = dot(wrench.torque, point.turning)
        if slip is not None:
            power = wrench.force[0] * slip[0] + wrench.force[1] * slip[1] + power
        return Reaction(wrench.force, wrench.torque, power)

    def guard_values(self) -> list[GuardValue]:
        """Return the guards of what holds the contact, or of slip; of rolling; and of the body's
        shape.
        """
        guards = self._sticking_guards() if self.sticks else self._slip_guards()
        if self.holds_rolling:
            guards.append((ROLLING, lambda mode, y: mode.rolling_reserve(y)))
        elif self.top.resists_rolling:
            guards.append((ROLLING_STOPPING, lambda mode, y: mode.rolling_left(y)))
        if is_edge(self.top.surface):
            guards.append((WOBBLE, lambda mode, y: mode.wobble(y).reserve(LEFT_OUT)))
        return guards + [(name, _of_top(value)) for name, value in surface_guards(self.top)]

    def _sticking_guards(self) -> list[GuardValue]:
        guards: list[GuardValue] = [
            (SLIP, lambda mode, y: slip_reserve(mode.top, mode.contact_forces(y)[2]))
        ]
        if has_limit_branches(self.top.friction):
            guards.append(
                (LIMIT_BRANCH, lambda mode, y: limit_guard(mode.top, mode.contact_forces(y)[2]))
            )
        return guards

    def _slip_guards(self) -> list[GuardValue]:
        law, guards = self.top.friction, list[GuardValue]()
        if not self.pulls:
            guards.append((LIFT_OFF, lambda mode, y: mode.contact_forces(y)[2].force[2]))
        if is_set_valued(law) and self.near:
            guards.append((STOPPING, lambda mode, y: mode.slip_left(y)))
            guards.append(
                (PARTING, lambda mode, y: parting_guard(SlidingState.unpack(y), mode.top))
            )
        elif is_set_valued(law):
            guards.append(
                (NEARING, lambda mode, y: nearing_guard(SlidingState.unpack(y), mode.top))
            )
        if hasattr(law, "branch_guard"):
            guards.append((BRANCH, lambda mode, y: mode.on_branch(y)))
        return guards

    def on_branch(self, y: Row) -> Scalar:
        """Positive as long as the branch of the law holds."""
        return branch_guard(slip_of(*SlidingState.unpack(y), self.top), self.top)

    def slip_left(self, y: Row) -> Scalar:
        """Positive while slip goes on for a while."""
        change = slip_part(flat(self.contact_forces(y)[3]), slip_length(self.top.friction))
        return remaining(slip_of(*SlidingState.unpack(y), self.top), change)

    def wobble(self, y: Row) -> Wobble:
        """Return the wobble of a body on an edge."""
        _, slip, wrench, acceleration = self.contact_forces(y)
        return Wobble.of(along_table(self.state(y)), self.top, wrench, acceleration, slip)

    def rolling_reserve(self, y: Row) -> Scalar:
        """Positive while the table can exert the couple that holds rolling."""
        point, slip, wrench, _ = self.contact_forces(y)
        return rolling_reserve(point, wrench, slip)

    def rolling_left(self, y: Row) -> Scalar:
        """Positive while rolling goes on for a while."""
        if self.slides_freely:
            rates = SlidingState.unpack(self.rates(y))
            return rolling_stopping_guard(SlidingState.unpack(y), rates, self.top)
        point, _, _, acceleration = self.contact_forces(y)
        return remaining(point.turning[:2], acceleration.turning[:2])


def sliding_motion(kind: Kind, guarded: bool, held: bool = False) -> Motion:
    """Return the equations of motion of a sliding top of a kind, whose rolling may be held.

    If `guarded`, the first guard is of lift-off. Where slip can end, another tells whether it may
    be soon.
    """
    no_top: Any = None
    return motion_of(ContactMode(no_top, holds_rolling=held, pulls=not guarded), (kind,))


def _of_top(value: SurfaceGuard) -> Callable[[Any, Row], Scalar]:
    return lambda mode, y: value(mode.top, *split(y))


def split(y: Row) -> tuple[Vector, Vector]:
    """Axis and angular momentum, the first numbers of every mode in contact."""
    return (y[0], y[1], y[2]), (y[3], y[4], y[5])
