"""The mode of closed contacts, one or two, by the status of each, and its equations of motion."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, ClassVar, Self

from tippetop.contact.closed_contacts import NONE_DIRECTED, ClosedContacts, Directed
from tippetop.contact.guards import GuardValue, guards_on_one, guards_on_two
from tippetop.contact.mode import IntegratedMode, Reaction, split
from tippetop.integrators.base import Guard, Motion
from tippetop.mechanics.contacts.branches import is_branched, on_numbered_branch
from tippetop.mechanics.contacts.forces import (
    velocity_without_slip,
    without_drilling,
    without_rolling,
)
from tippetop.mechanics.contacts.pair import Tops
from tippetop.mechanics.contacts.slip_variables import slip_of
from tippetop.mechanics.motion import along_table, on_table, sliding_rates
from tippetop.mechanics.state import SlidingState, State
from tippetop.mechanics.top import Kind, Top, contact_numbers, contacts_with, number_count
from tippetop.mechanics.vectors import Row, Scalar, Vector

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
        """Name of the equations of motion, with the signs that they need on two contacts."""
        return f"{self.status} {self.rolls:g} {self.sense:g}"

    @property
    def label(self) -> str:
        """Its status, and the numbers of the surfaces if the body has several."""
        if not self.is_mixed:
            return self.status + self._place
        rolling = "_without_rolling" if self.prevents_rolling else ""
        first, second = (top.number for top in self.tops)
        return f"{STICKS}{rolling}_on_{first}_{SLIPS}_on_{second}"

    @property
    def stuck(self) -> tuple[int, ...]:
        """Numbers of the surfaces that stick."""
        pairs = zip(self.tops, self.sticks, strict=True)
        return tuple([top.number for top, sticks in pairs if sticks])

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
    def swapped(self) -> Self:
        """The mode with its two contacts in the other order, of which both slip or both stick."""
        (second,) = self.beside
        return replace(self, top=second, beside=(self.top,))

    @property
    def further(self) -> tuple[Scalar, ...]:
        """What the status needs beside the numbers of the tops."""
        if self.is_single or not any(self.sticks):
            return ()
        return (self.sense,) if self.is_mixed else (self.slowest_rolling,)

    @property
    def parameters(self) -> tuple[Scalar, ...]:
        """The numbers of the tops, and what the status needs beside them."""
        return (*contact_numbers(self.tops), *self.further)

    def without_tops(self) -> Self:
        """Return the mode without its tops and parameters."""
        no_top: Any = None
        return replace(self, top=no_top, beside=(), sense=1.0, slowest_rolling=0.0)

    def on_tops(self, tops: Sequence[Top]) -> Self:
        """Return the mode of tops of the same kinds with other numbers."""
        return self.with_tops(tops, self.further)

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

    def contacts(self, y: Row, directed: Directed = NONE_DIRECTED) -> ClosedContacts:
        """Return the closed contacts at its numbers, of which velocities begin or end."""
        return ClosedContacts(self, y, directed)

    def rates(self, y: Row) -> tuple[Scalar, ...]:
        """Rates of axis and angular momentum, and of the velocity if nothing sticks."""
        if self.slides_freely:
            return sliding_rates(SlidingState.unpack(y), self.top).pack()
        return self.contacts(y).rates()

    def reaction(self, y: Row) -> Reaction:
        """Force of all contacts, and their torque about the first contact point."""
        return self.contacts(y).reaction()

    def guard_values(self) -> list[GuardValue]:
        """Return the guards."""
        return guards_on_one(self) if self.is_single else guards_on_two(self)


@lru_cache
def motion_of(form: Any, kinds: tuple[Kind, ...]) -> Motion:
    """Equations of motion of a mode without tops, for tops of these kinds."""

    def mode(numbers: Sequence[Scalar]) -> Any:
        return mode_with(form, kinds, numbers)

    def guard(name: str, value: Callable[[ClosedContacts], Scalar]) -> Guard:
        return Guard(name, lambda y, numbers: value(mode(numbers).contacts(y)))

    def rates(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> tuple[Scalar, ...]:
        values: tuple[Scalar, ...] = mode(numbers).rates(y)
        return values

    guards = tuple(guard(name, value) for name, value in example_of(form, kinds).guard_values())
    return Motion(rates, form.count, parameter_count(form, kinds), guards, form.lasting)


def mode_with(form: Any, kinds: Sequence[Kind], numbers: Sequence[Scalar]) -> Any:
    """Return a mode from one without tops, kinds of tops, and numbers that begin with its
    parameters.
    """
    first = number_count(kinds)
    return form.with_tops(contacts_with(kinds, numbers), numbers[first : first + len(form.further)])


def example_of(form: Any, kinds: Sequence[Kind]) -> Any:
    """Return some mode of these kinds of tops, to ask what is common to all."""
    return form.with_tops(contacts_with(kinds, (1.0,) * number_count(kinds)), form.further)


def parameter_count(form: Any, kinds: Sequence[Kind]) -> int:
    """Return how many parameters such modes have."""
    return number_count(kinds) + len(form.further)


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
