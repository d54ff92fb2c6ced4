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
from tippetop.mechanics.contacts.pair_resolver import rolling_way
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

    other: Top
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
        one, other = number_of(self.top), number_of(self.other)
        if self.is_mixed:
            return f"{STICKS}{rolling}_on_{one}_{SLIPS}_on_{other}"
        return f"{self.status}{rolling}_on_{min(one, other)}_and_{max(one, other)}"

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
        return self.top, self.other

    @property
    def parameters(self) -> tuple[Scalar, ...]:
        """The numbers of the top on either surface, and what the status needs beside them."""
        numbers = (*self.top.numbers, *self.other.numbers)
        if not any(self.sticks):
            return numbers
        return (*numbers, self.sense if self.is_mixed else self.slowest_rolling)

    def without_tops(self) -> Self:
        """What remains of it when its tops, and its parameters, are taken away."""
        nothing: Any = None
        return replace(super().without_tops(), other=nothing, sense=1.0, slowest_rolling=0.0)

    def with_tops(self, tops: Sequence[Top], more: Sequence[Scalar]) -> Self:
        """The same with both tops, and with its further parameters."""
        mode = replace(self, top=tops[0], other=tops[1])
        if not any(self.sticks):
            return mode
        return (
            replace(mode, sense=more[0])
            if self.is_mixed
            else replace(mode, slowest_rolling=more[0])
        )

    def numbers(self, state: State) -> tuple[Scalar, ...]:
        """Axis, angular momentum, and velocity if both slip."""
        return along_table(state).pack()[: self.count]

    def state(self, y: Row) -> State:
        """The state, with its height; what is held is zero."""
        if not any(self.sticks):
            return on_table(SlidingState.unpack(y), self.top)
        axis, momentum = split(y)
        if all(self.sticks):
            momentum = without_drilling(axis, momentum, self.top)
        momentum = self.stilled(axis, momentum)
        velocity = velocity_without_slip(axis, momentum, self.top)
        return on_table(SlidingState(axis, momentum, velocity), self.top)

    def found(self, y: Row) -> tuple[PairMotion, tuple[Slip, Slip]]:
        """What the table does, and how both contacts slip, from the numbers of the mode."""
        pair = ContactPair.of(*split(y), self.tops)
        if all(self.sticks):
            return pair_motion(pair, (None, None), self.rolls), ((0.0, 0.0), (0.0, 0.0))
        if self.is_mixed:
            zeta = slip_apart(pair)
            way = scaled(self.sense, directions_of(pair.first.axis)[1][:2])
            slips = slips_of(pair, (0.0 * zeta, 0.0 * zeta, zeta))
            return pair_motion(pair, (None, way), self.rolls), slips
        one, other = (slip_of(*SlidingState.unpack(y), top) for top in self.tops)
        return pair_motion(pair, (one, other), self.rolls), (one, other)

    def rates(self, y: Row) -> tuple[Scalar, ...]:
        """Time derivatives of the numbers."""
        now = self.found(y)[0]
        drawn = () if any(self.sticks) else scaled(1.0 / self.top.mass, now.force[:2])
        return (*axis_rate(*split(y), self.top), *now.moment, *drawn)

    def reaction(self, y: Row) -> Reaction:
        """Force of both contacts, and their torque about the first contact point."""
        found, slips = self.found(y)
        power: Any = dot(found.couple, found.pair.first.turning)
        for slip, wrench in zip(slips, found.wrenches, strict=True):
            power = power + (wrench.force[0] * slip[0] + wrench.force[1] * slip[1])
        return Reaction(found.force, found.torque, power, found.couple)

    def guard_values(self) -> list[GuardValue]:
        """The guards of normal forces, of rolling, and of slip that ends or begins.

        While both contacts stay closed the tilt does not change, and no further surface comes to
        the table.
        """
        guards = [(numbered(OPENING, number), _normal(number)) for number in (0, 1)]
        if self.stopped:
            guards.append((ROLLING, lambda mode, y: mode.found(y)[0].rolling_reserve))
        elif self.top.resists_rolling:
            guards.append((ROLLING_STOPPING, lambda mode, y: mode.rolls * mode.found(y)[0].rolling))
        if self.is_mixed:
            return [*self._mixed_guards(), *guards]
        return guards + (self._sticking_guards() if all(self.sticks) else self._slip_guards())

    def _mixed_guards(self) -> list[GuardValue]:
        """The guards of what holds the first contact, and of slip on the second."""
        return [
            (numbered(SLIP, 0), lambda mode, y: mode.found(y)[0].reserve(0)),
            (ENDING, lambda mode, y: mode.sense * slip_apart(ContactPair.of(*split(y), mode.tops))),
        ]

    def _sticking_guards(self) -> list[GuardValue]:
        """The guards of what holds both contacts."""
        if slip_length(self.top.friction) is None:
            return [
                (numbered(SLIP, 0), lambda mode, y: mode.found(y)[0].left(0)),
                (numbered(SLIP, 1), lambda mode, y: mode.found(y)[0].left(1)),
                (SLIP, lambda mode, y: mode.found(y)[0].both_reserve),
            ]
        if not self.rolls:
            return []
        return [
            (SLIP, lambda mode, y: mode.rolls * mode.found(y)[0].rolling - mode.slowest_rolling)
        ]

    def _slip_guards(self) -> list[GuardValue]:
        """The guards of slip's end, and of the branches of the law."""
        guards = self.endings()
        if is_branched(self.top.friction):
            guards += [(numbered(BRANCHING, number), _branch(number)) for number in (0, 1)]
        return guards

    def endings(self) -> list[GuardValue]:
        """The guards of slip's end: on both contacts at once where drilling is resisted too."""
        law = self.top.friction
        if slip_length(law) is not None:
            return [(ENDING, lambda mode, y: _left(*mode.found(y)[1]))]
        if not is_set_valued(law):
            return []
        return [(numbered(ENDING, number), _slip(number)) for number in (0, 1)]

    def stilled(self, axis: Vector, momentum: Vector) -> Vector:
        """The angular momentum, without rolling where that is held."""
        return without_rolling(axis, momentum, self.top) if self.stopped else momentum

    def rolling_direction(self, state: State) -> float:
        """Return the sign of omega_e with which rolling begins that can be held no longer."""
        return rolling_way(self.found(self.numbers(state))[0])


def on_two(state: State, tops: Tops, rolls: float) -> TwoContactMode:
    """Return the mode of a body that slides on two surfaces."""
    one, other = tops
    if is_branched(other.friction):
        one, other = (on_numbered_branch(top, slip_of(*along_table(state), top)) for top in tops)
    return TwoContactMode(one, other, rolls=rolls)


def _normal(number: int) -> Callable[[Any, Row], Scalar]:
    return lambda mode, y: mode.found(y)[0].normal[number]


def _slip(number: int) -> Callable[[Any, Row], Scalar]:
    return lambda mode, y: _left(mode.found(y)[1][number])


def _branch(number: int) -> Callable[[Any, Row], Scalar]:
    return lambda mode, y: branch_guard(mode.found(y)[1][number], mode.tops[number])


def _left(*slips: Slip) -> Scalar:
    """Falls through zero where so little is left of all these that they are followed no further.

    A length: it falls straight through, where its square would only touch zero. In straight motion
    steps may lead beyond the end of slip, and rounding hides so slight a touch.
    """
    return sum(inner(slip, slip) for slip in slips) ** 0.5 - SLOWEST_SLIP
