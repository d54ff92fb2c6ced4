"""The mode of two closed contacts, by the status of each."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Self

from tippetop.contact.contact_mode import (
    ROLLING,
    ROLLING_STOPPING,
    SLIP,
    SLIPS,
    STICKS,
    GuardValue,
    StatedMode,
    split,
)
from tippetop.contact.mode import Reaction, numbered
from tippetop.contact.surfaces import number_of
from tippetop.mechanics.contacts.branches import is_branched, on_numbered_branch
from tippetop.mechanics.contacts.forces import (
    directions_of,
    is_set_valued,
    slip_length,
    velocity_without_slip,
    without_drilling,
    without_rolling,
)
from tippetop.mechanics.contacts.pair import ContactPair, Tops, slip_apart, slips_of
from tippetop.mechanics.contacts.pair_motion import PairMotion, pair_motion
from tippetop.mechanics.contacts.pair_resolver import rolling_direction
from tippetop.mechanics.contacts.slip_variables import branch_guard, inner, scaled, slip_of
from tippetop.mechanics.contacts.wrench import Slip
from tippetop.mechanics.motion import along_table, axis_rate, on_table
from tippetop.mechanics.state import SlidingState, State
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Row, Scalar, Vector, dot

OPENING, ENDING, BRANCHING = "opening", "ending", "branching"

SLOWEST_SLIP = 1e-9
"""Slip in natural units at which it ends on one of two contacts, or on both where drilling is
resisted too, and is not followed further.
"""


@dataclass(frozen=True)
class TwoContactMode(StatedMode):
    """Two contacts are closed: each slips or sticks, and rolling goes on one way, or is held.

    Of one that sticks and one that slips, the first sticks, and the second slips across the axis,
    along t of `tippetop.mechanics.contacts.pair`.
    """

    second_top: Top
    """The top with the second surface active."""
    sticks: tuple[bool, bool] = (False, False)
    """Whether each of the contacts sticks; else it slips."""
    rolls: float = 0.0
    """Sign of omega_e (see `tippetop.mechanics.contacts.pair`); 0 where rolling is held, or not
    resisted.
    """
    sense: float = 1.0
    """Where the first contact sticks alone: the sign of the slip of the second along t."""
    slowest_rolling: float = -1.0
    """Where both stick: the |omega_e| at which patches slip that stick while the body rolls."""

    name: ClassVar[str] = "two_contacts"

    @property
    def count(self) -> int:
        """How many numbers the mode has: axis, angular momentum, and velocity if both slip."""
        return 6 if any(self.sticks) else 8

    @property
    def further_count(self) -> int:
        """How many parameters there are beside the numbers of the tops."""
        return 1 if any(self.sticks) else 0

    @property
    def status(self) -> str:
        """Name of the motion in a result, without the surfaces that touch."""
        if self.is_mixed:
            return f"{STICKS}_and_{SLIPS}"
        return STICKS if self.sticks[0] else SLIPS

    @property
    def form(self) -> str:
        """Modes of the same form and tops read the same from their numbers."""
        return f"two: {self.sticks[0]} {self.sticks[1]}, {self.rolls:g} {self.sense:g}"

    @property
    def label(self) -> str:
        """Its status, and the numbers of the surfaces."""
        rolling = "_without_rolling" if self.stopped else ""
        first, second = number_of(self.top), number_of(self.second_top)
        if self.is_mixed:
            return f"{STICKS}{rolling}_on_{first}_{SLIPS}_on_{second}"
        return f"{self.status}{rolling}_on_{min(first, second)}_and_{max(first, second)}"

    @property
    def is_mixed(self) -> bool:
        """Whether the first contact sticks, and the second slips."""
        return self.sticks[0] and not self.sticks[1]

    @property
    def stopped(self) -> bool:
        """Whether rolling is held."""
        return self.top.resists_rolling and not self.rolls

    @property
    def stuck(self) -> tuple[int, ...]:
        """Numbers of the surfaces that stick."""
        return tuple(
            [number_of(top) for top, held in zip(self.tops, self.sticks, strict=True) if held]
        )

    @property
    def tops(self) -> Tops:
        """The top with either surface active: the branches of their laws may differ."""
        return self.top, self.second_top

    @property
    def parameters(self) -> tuple[Scalar, ...]:
        """The numbers of the top on either surface, and what the status needs beside them."""
        numbers = (*self.top.numbers, *self.second_top.numbers)
        if not any(self.sticks):
            return numbers
        return (*numbers, self.sense if self.is_mixed else self.slowest_rolling)

    def without_tops(self) -> Self:
        """Return the mode without its tops and parameters."""
        no_top: Any = None
        return replace(super().without_tops(), second_top=no_top, sense=1.0, slowest_rolling=0.0)

    def with_tops(self, tops: Sequence[Top], further: Sequence[Scalar]) -> Self:
        """Return the mode with both tops, and with further parameters."""
        mode = replace(self, top=tops[0], second_top=tops[1])
        if not any(self.sticks):
            return mode
        return (
            replace(mode, sense=further[0])
            if self.is_mixed
            else replace(mode, slowest_rolling=further[0])
        )

    def numbers(self, state: State) -> tuple[Scalar, ...]:
        """Axis, angular momentum, and velocity if both slip."""
        return along_table(state).pack()[: self.count]

    def state(self, y: Row) -> State:
        """Return the state, with its height; what is held is zero."""
        if not any(self.sticks):
            return on_table(SlidingState.unpack(y), self.top)
        axis, momentum = split(y)
        if all(self.sticks):
            momentum = without_drilling(axis, momentum, self.top)
        momentum = self.stilled(axis, momentum)
        velocity = velocity_without_slip(axis, momentum, self.top)
        return on_table(SlidingState(axis, momentum, velocity), self.top)

    def contact_forces(self, y: Row) -> tuple[PairMotion, tuple[Slip, Slip]]:
        """Return the forces and accelerations, and the slips of both contacts, from the numbers."""
        pair = ContactPair.of(*split(y), self.tops)
        if all(self.sticks):
            return pair_motion(pair, (None, None), self.rolls), ((0.0, 0.0), (0.0, 0.0))
        if self.is_mixed:
            zeta = slip_apart(pair)
            direction = scaled(self.sense, directions_of(pair.first.axis)[1][:2])
            slips = slips_of(pair, (0.0 * zeta, 0.0 * zeta, zeta))
            return pair_motion(pair, (None, direction), self.rolls), slips
        first, second = (slip_of(*SlidingState.unpack(y), top) for top in self.tops)
        return pair_motion(pair, (first, second), self.rolls), (first, second)

    def rates(self, y: Row) -> tuple[Scalar, ...]:
        """Time derivatives of the numbers."""
        now = self.contact_forces(y)[0]
        drawn = () if any(self.sticks) else scaled(1.0 / self.top.mass, now.force[:2])
        return (*axis_rate(*split(y), self.top), *now.moment, *drawn)

    def reaction(self, y: Row) -> Reaction:
        """Force of both contacts, and their torque about the first contact point."""
        motion, slips = self.contact_forces(y)
        power: Any = dot(motion.couple, motion.pair.first.turning)
        for slip, wrench in zip(slips, motion.wrenches, strict=True):
            power = power + (wrench.force[0] * slip[0] + wrench.force[1] * slip[1])
        return Reaction(motion.force, motion.torque, power, motion.couple)

    def guard_values(self) -> list[GuardValue]:
        """Return the guards of normal forces, of rolling, and of slip that ends or begins.

        While both contacts stay closed the tilt does not change, and no further surface comes to
        the table.
        """
        guards = [(numbered(OPENING, number), _normal(number)) for number in (0, 1)]
        if self.stopped:
            guards.append((ROLLING, lambda mode, y: mode.contact_forces(y)[0].rolling_reserve))
        elif self.top.resists_rolling:
            guards.append(
                (ROLLING_STOPPING, lambda mode, y: mode.rolls * mode.contact_forces(y)[0].rolling)
            )
        if self.is_mixed:
            return [*self._mixed_guards(), *guards]
        return guards + (self._sticking_guards() if all(self.sticks) else self._slip_guards())

    def _mixed_guards(self) -> list[GuardValue]:
        """Return the guards of what holds the first contact, and of slip on the second."""
        return [
            (numbered(SLIP, 0), lambda mode, y: mode.contact_forces(y)[0].reserve(0)),
            (ENDING, lambda mode, y: mode.sense * slip_apart(ContactPair.of(*split(y), mode.tops))),
        ]

    def _sticking_guards(self) -> list[GuardValue]:
        """Return the guards of what holds both contacts."""
        if slip_length(self.top.friction) is None:
            return [
                (numbered(SLIP, 0), lambda mode, y: mode.contact_forces(y)[0].sticking_reserve(0)),
                (numbered(SLIP, 1), lambda mode, y: mode.contact_forces(y)[0].sticking_reserve(1)),
                (SLIP, lambda mode, y: mode.contact_forces(y)[0].both_reserve),
            ]
        if not self.rolls:
            return []
        return [
            (
                SLIP,
                lambda mode, y: (
                    mode.rolls * mode.contact_forces(y)[0].rolling - mode.slowest_rolling
                ),
            )
        ]

    def _slip_guards(self) -> list[GuardValue]:
        """Return the guards of slip's end, and of the branches of the law."""
        guards = self.endings()
        if is_branched(self.top.friction):
            guards += [(numbered(BRANCHING, number), _branch(number)) for number in (0, 1)]
        return guards

    def endings(self) -> list[GuardValue]:
        """Return the guards of slip's end: of both contacts at once if drilling is resisted."""
        law = self.top.friction
        if slip_length(law) is not None:
            return [(ENDING, lambda mode, y: _slip_beyond_least(*mode.contact_forces(y)[1]))]
        if not is_set_valued(law):
            return []
        return [(numbered(ENDING, number), _slip(number)) for number in (0, 1)]

    def stilled(self, axis: Vector, momentum: Vector) -> Vector:
        """Return the angular momentum, without rolling where that is held."""
        return without_rolling(axis, momentum, self.top) if self.stopped else momentum

    def rolling_direction(self, state: State) -> float:
        """Return the sign of omega_e with which rolling begins that can be held no longer."""
        return rolling_direction(self.contact_forces(self.numbers(state))[0])


def on_two(state: State, tops: Tops, rolls: float) -> TwoContactMode:
    """Return the mode of a body that slides on two surfaces."""
    first, second = tops
    if is_branched(second.friction):
        first, second = (on_numbered_branch(top, slip_of(*along_table(state), top)) for top in tops)
    return TwoContactMode(first, second, rolls=rolls)


def _normal(number: int) -> Callable[[Any, Row], Scalar]:
    return lambda mode, y: mode.contact_forces(y)[0].normal[number]


def _slip(number: int) -> Callable[[Any, Row], Scalar]:
    return lambda mode, y: _slip_beyond_least(mode.contact_forces(y)[1][number])


def _branch(number: int) -> Callable[[Any, Row], Scalar]:
    return lambda mode, y: branch_guard(mode.contact_forces(y)[1][number], mode.tops[number])


def _slip_beyond_least(*slips: Slip) -> Scalar:
    """Falls through zero where so little is left of all these that they are followed no further.

    A length: it falls straight through, where its square would only touch zero. In straight motion
    steps may lead beyond the end of slip, and rounding hides so slight a touch.
    """
    return sum(inner(slip, slip) for slip in slips) ** 0.5 - SLOWEST_SLIP
