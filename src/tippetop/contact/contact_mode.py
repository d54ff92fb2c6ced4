"""The mode of closed contacts, one or two, by the status of each, and its equations of motion."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, ClassVar, Self

from tippetop.contact.conditions import held_reserve, least
from tippetop.contact.guards import GuardValue, guards_on_one, guards_on_two
from tippetop.contact.mode import BOTH, IntegratedMode, Reaction, split
from tippetop.integrators.base import Guard, Motion
from tippetop.mechanics.contacts.branches import is_branched, on_numbered_branch
from tippetop.mechanics.contacts.contact_forces import ContactForces, forces_on_one, forces_on_two
from tippetop.mechanics.contacts.contact_point import contact_points, flat
from tippetop.mechanics.contacts.forces import (
    Slips,
    directions_of,
    slip_length,
    velocity_without_slip,
    without_drilling,
    without_rolling,
)
from tippetop.mechanics.contacts.pair import Tops, slip_apart, slips_of
from tippetop.mechanics.contacts.pair_resolver import rolling_direction
from tippetop.mechanics.contacts.slip_variables import remaining, scaled, slip_of, slip_part
from tippetop.mechanics.contacts.wrench import Slip
from tippetop.mechanics.lying_down import Wobble
from tippetop.mechanics.motion import along_table, axis_rate, on_table, sliding_rates
from tippetop.mechanics.state import SlidingState, State
from tippetop.mechanics.top import Kind, Top
from tippetop.mechanics.vectors import Row, Scalar, Vector, dot

SLIPS, STICKS = "sliding", "sticking"
"""Status of a contact in the names of modes."""


@dataclass(frozen=True)
class ContactMode(IntegratedMode):
    """One or two contacts are closed: each slips or sticks, and rolling goes on or is held.

    Of two contacts of which one sticks, the first does, and the second slips across the axis, along
    t of `tippetop.mechanics.contacts.pair`.
    """

    sticks: tuple[bool, ...] = (False,)
    """Whether each contact sticks, and does not drill where the law resists that; else it slips."""
    prevents_rolling: bool = False
    """Whether rolling resistance holds the top, which turns about the vertical, or not at all."""
    near: bool = False
    """Whether slip on one contact is so small that it may be about to end, which then is guarded.
    """
    pulls: bool = False
    """Whether the table may pull; else slip on one contact ends where it would have to."""
    beside: tuple[Top, ...] = ()
    """The top with the second surface active, where two contacts are closed."""
    rolls: float = 0.0
    """On two contacts, the sign of omega_e (see `tippetop.mechanics.contacts.pair`); 0 where
    rolling is held, or not resisted.
    """
    sense: float = 1.0
    """Where the first of two contacts sticks alone: the sign of the slip of the second along t."""
    slowest_rolling: float = -1.0
    """Where two contacts stick: the |omega_e| at which patches slip that stick while the body
    rolls.
    """

    name: ClassVar[str] = "contact"

    @property
    def is_single(self) -> bool:
        """Whether one contact is closed."""
        return len(self.sticks) == 1

    @property
    def is_mixed(self) -> bool:
        """Whether the first of two contacts sticks, and the second slips."""
        return any(self.sticks) and not all(self.sticks)

    @property
    def slides_freely(self) -> bool:
        """Whether one contact is closed and slips, and nothing holds rolling."""
        return self.is_single and not self.sticks[0] and not self.prevents_rolling

    @property
    def status(self) -> str:
        """Name of the motion in a result, without the surfaces that touch."""
        rolling = "_without_rolling" if self.prevents_rolling else ""
        if self.is_mixed:
            return f"{STICKS}_and_{SLIPS}{rolling}"
        return (STICKS if self.sticks[0] else SLIPS) + rolling

    @property
    def form(self) -> str:
        """Modes of the same form and tops read the same from their numbers."""
        return f"{self.status} {self.rolls:g} {self.sense:g}"

    @property
    def label(self) -> str:
        """Its status, and the numbers of the surfaces if the body has several."""
        if not self.is_mixed:
            return self.status + self._place
        rolling = "_without_rolling" if self.prevents_rolling else ""
        first, second = (top.active for top in self.tops)
        return f"{STICKS}{rolling}_on_{first}_{SLIPS}_on_{second}"

    @property
    def stuck(self) -> tuple[int, ...]:
        """Numbers of the surfaces that stick."""
        pairs = zip(self.tops, self.sticks, strict=True)
        return tuple([top.active for top, sticks in pairs if sticks])

    @property
    def lasting(self) -> bool:
        """Whether runs may spend most of their steps in it."""
        return self.slides_freely and not self.near

    # The tops are parameters of the equations, as are numbers of the status.

    @property
    def tops(self) -> tuple[Top, ...]:
        """The top with each surface active that touches: the branches of their laws may differ."""
        return (self.top, *self.beside)

    @property
    def further(self) -> tuple[Scalar, ...]:
        """What the status needs beside the numbers of the tops."""
        if self.is_single or not any(self.sticks):
            return ()
        return (self.sense,) if self.is_mixed else (self.slowest_rolling,)

    @property
    def parameters(self) -> tuple[Scalar, ...]:
        """The numbers of the tops, and what the status needs beside them."""
        return (*[number for top in self.tops for number in top.numbers], *self.further)

    def without_tops(self) -> Self:
        """Return the mode without its tops and parameters."""
        no_top: Any = None
        return replace(self, top=no_top, beside=(), sense=1.0, slowest_rolling=0.0)

    def with_tops(self, tops: Sequence[Top], further: Sequence[Scalar]) -> Self:
        """Return the mode with tops, and with further parameters."""
        mode = replace(self, top=tops[0], beside=tuple(tops[1:]))
        if not self.further:
            return mode
        return (
            replace(mode, sense=further[0])
            if self.is_mixed
            else replace(mode, slowest_rolling=further[0])
        )

    @property
    def motion(self) -> Motion:
        """Equations of motion and guards."""
        return motion_of(self.without_tops(), tuple([top.kind for top in self.tops]))

    # Numbers and states.

    @property
    def count(self) -> int:
        """How many numbers the mode has: axis, angular momentum, and velocity if nothing sticks."""
        return 6 if any(self.sticks) else 8

    def numbers(self, state: State) -> tuple[Scalar, ...]:
        """Axis, angular momentum, and velocity if nothing sticks."""
        return along_table(state).pack()[: self.count]

    def state(self, y: Row) -> State:
        """Return the state, with its height and sinking; what is held is zero."""
        axis, momentum = split(y)
        if not self.is_single and all(self.sticks):
            momentum = without_drilling(axis, momentum, self.top)
        momentum = self.stilled(axis, momentum)
        slides = not any(self.sticks)
        velocity = (y[6], y[7]) if slides else velocity_without_slip(axis, momentum, self.top)
        return on_table(SlidingState(axis, momentum, velocity), self.top)

    def stilled(self, axis: Vector, momentum: Vector) -> Vector:
        """Return the angular momentum, without rolling where that is held."""
        return without_rolling(axis, momentum, self.top) if self.prevents_rolling else momentum

    # Forces and rates.

    def contact_forces(self, y: Row) -> tuple[ContactForces, Slips]:
        """Return the forces and accelerations, and the slip of each contact, from the numbers.

        The slip of one contact that sticks is None, and that of two is zero.
        """
        points = contact_points(*split(y), self.tops)
        if self.is_single:
            slip = None if self.sticks[0] else slip_of(*split(y), (y[6], y[7]), self.top)[:2]
            rolling = None if self.prevents_rolling else points[0].turning[:2]
            return forces_on_one(points[0], slip, rolling), (slip,)
        if self.is_mixed:
            zeta = slip_apart(points)
            direction = scaled(self.sense, directions_of(points[0].axis)[1][:2])
            slips = slips_of(points, (0.0 * zeta, 0.0 * zeta, zeta))
            return forces_on_two(points, (None, direction), self.rolls), slips
        if self.sticks[0]:
            return forces_on_two(points, (None, None), self.rolls), ((0.0, 0.0), (0.0, 0.0))
        first, second = (slip_of(*SlidingState.unpack(y), top) for top in self.tops)
        return forces_on_two(points, (first, second), self.rolls), (first, second)

    def rates(self, y: Row) -> tuple[Scalar, ...]:
        """Rates of axis and angular momentum, and of the velocity if nothing sticks."""
        if self.slides_freely:
            return sliding_rates(SlidingState.unpack(y), self.top).pack()
        forces = self.contact_forces(y)[0]
        drawn = () if any(self.sticks) else scaled(1.0 / self.top.mass, forces.force[:2])
        return (*axis_rate(*split(y), self.top), *forces.moment, *drawn)

    def reaction(self, y: Row) -> Reaction:
        """Force of all contacts, and their torque about the first contact point."""
        forces, slips = self.contact_forces(y)
        power = dot(forces.couple, forces.points[0].turning)
        for slip, wrench in zip(slips, forces.wrenches, strict=True):
            if slip is not None:
                power = power + (wrench.force[0] * slip[0] + wrench.force[1] * slip[1])
        pressing = None if self.is_single else least(forces.normal)
        held = held_reserve(self, forces, slips)
        return Reaction(forces.force, forces.torque, power, forces.couple, pressing, held)

    def slip_left(self, y: Row) -> Scalar:
        """Positive while slip on one contact goes on for a while."""
        acceleration = self.contact_forces(y)[0].acceleration(0)
        change = slip_part(flat(acceleration), slip_length(self.top.friction))
        return remaining(slip_of(*SlidingState.unpack(y), self.top), change)

    def slip_and_rate(self, y: Row, number: int) -> tuple[Slip, Slip]:
        """Return the slip of one of two contacts that slip, or xi of both (-1), and its rate."""
        forces, slips = self.contact_forces(y)
        if number == BOTH:
            first: Any = slips[0]
            return (first[0], first[1], slip_apart(forces.points)), forces.rate
        slip: Any = slips[number]
        return slip, forces.rates.points[number][:2]

    def wobble(self, y: Row) -> Wobble:
        """Return the wobble of a body on an edge."""
        forces, slips = self.contact_forces(y)
        sliding, acceleration = along_table(self.state(y)), forces.acceleration(0)
        return Wobble.of(sliding, self.top, forces.wrenches[0], acceleration, slips[0])

    def rolling_direction(self, state: State) -> float:
        """Return the sign of omega_e with which rolling begins on two contacts that can be held no
        longer.
        """
        return rolling_direction(self.contact_forces(self.numbers(state))[0])

    def guard_values(self) -> list[GuardValue]:
        """Return the guards."""
        return guards_on_one(self) if self.is_single else guards_on_two(self)


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

    example = form.with_tops([kind.example for kind in kinds], form.further)
    guards = tuple(guard(name, value) for name, value in example.guard_values())
    count = sum(kind.numbers for kind in kinds) + len(form.further)
    return Motion(rates, form.count, count, guards, form.lasting)


def sliding_motion(kind: Kind, guarded: bool, held: bool = False) -> Motion:
    """Return the equations of motion of a sliding top of a kind, whose rolling may be held.

    If `guarded`, the first guard is of lift-off. Where slip can end, another tells whether it may
    be soon.
    """
    no_top: Any = None
    return motion_of(ContactMode(no_top, prevents_rolling=held, pulls=not guarded), (kind,))


def mode_on_two(
    tops: Tops,
    rolls: float,
    sticks: tuple[bool, bool] = (False, False),
    *,
    sense: float = 1.0,
    slowest_rolling: float = -1.0,
) -> ContactMode:
    """Return the mode of two contacts; the arguments are the attributes of `ContactMode`."""
    top, *beside = tops
    held = top.resists_rolling and not rolls
    return ContactMode(
        top,
        sticks,
        held,
        beside=tuple(beside),
        rolls=rolls,
        sense=sense,
        slowest_rolling=slowest_rolling,
    )


def sliding_on_two(state: State, tops: Tops, rolls: float) -> ContactMode:
    """Return the mode of a body that slides on two surfaces, each on its branch of the law."""
    first, second = tops
    if is_branched(second.friction):
        first, second = (on_numbered_branch(top, slip_of(*along_table(state), top)) for top in tops)
    return mode_on_two((first, second), rolls)
