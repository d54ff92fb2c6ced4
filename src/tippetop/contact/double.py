"""Two surfaces touch the table at once."""

from abc import abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Self

from tippetop.contact.closed import ROLLING, ROLLING_STOPPING, GuardValue, StatedMode, split
from tippetop.contact.mode import Reaction, numbered
from tippetop.contact.surfaces import number_of
from tippetop.mechanics.branches import is_branched, on_numbered_branch
from tippetop.mechanics.contact_pair import ContactPair, Tops
from tippetop.mechanics.motion import along_table, axis_rate, on_table
from tippetop.mechanics.pair_motion import PairMotion, pair_motion
from tippetop.mechanics.pair_resolver import rolling_way
from tippetop.mechanics.rolling import is_set_valued, slip_length, without_rolling
from tippetop.mechanics.state import SlidingState, State
from tippetop.mechanics.stick_slip import branch_guard, inner, scaled, slip_of
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Row, Scalar, Vector, dot
from tippetop.mechanics.wrench import Slip

OPENING, ENDING, BRANCHING = "opening", "ending", "branching"

SLOWEST_SLIP = 1e-9
"""Slip in natural units at which it ends on one of two contacts, or on both where drilling is
resisted too, and is not followed further.
"""


@dataclass(frozen=True)
class OnTwo(StatedMode):
    """Two surfaces touch."""

    other: Top
    """The top with the second surface active."""
    rolls: float = 0.0
    """Sign of omega_e (see `tippetop.mechanics.contact_pair`); 0 where rolling is held, or not
    resisted.
    """

    size: ClassVar[int] = 6

    @property
    def form(self) -> str:
        """How it rolls decides what its numbers say of the couple."""
        return f"{self.name} {self.rolls:g}"

    @property
    def label(self) -> str:
        """Its name, and the numbers of the surfaces."""
        first, second = sorted((number_of(self.top), number_of(self.other)))
        return f"{self.name}{self.held}_on_{first}_and_{second}"

    @property
    def held(self) -> str:
        """What its name says where rolling is held."""
        return "_without_rolling" if self.stopped else ""

    @property
    def stopped(self) -> bool:
        """Whether rolling is held."""
        return self.top.resists_rolling and not self.rolls

    @property
    def stuck(self) -> tuple[int, ...]:
        """Numbers of the surfaces that stick: none, where a mode does not say otherwise."""
        return ()

    def without_tops(self) -> Self:
        """Without the other top, too."""
        nothing: Any = None
        return replace(super().without_tops(), other=nothing)

    def with_tops(self, tops: Sequence[Top], more: Sequence[Scalar]) -> Self:
        """The same with both tops, and with its further parameters."""
        return replace(self, top=tops[0], other=tops[1])

    def rates(self, y: Row) -> tuple[Scalar, ...]:
        """Time derivatives of the numbers."""
        now = self.found(y)[0]
        return (*axis_rate(*split(y), self.top), *now.moment, *self.slipping(now))

    def slipping(self, now: PairMotion) -> Slip:
        """Those of the numbers after axis and angular momentum: none, where a mode does not say
        otherwise.
        """
        return ()

    def guard_values(self) -> list[GuardValue]:
        """The guards of normal forces, and of rolling.

        While both contacts stay closed the tilt does not change, and no further surface comes to
        the table.
        """
        found = [(numbered(OPENING, number), _normal(number)) for number in (0, 1)]
        if self.stopped:
            found.append((ROLLING, lambda mode, y: mode.found(y)[0].rolling_reserve))
        elif self.top.resists_rolling:
            found.append((ROLLING_STOPPING, lambda mode, y: mode.rolls * mode.found(y)[0].rolling))
        return found

    @abstractmethod
    def found(self, y: Row) -> tuple[PairMotion, tuple[Slip, Slip]]:
        """What the table does, and how both contacts slip, from the numbers of the mode."""

    def reaction(self, y: Row) -> Reaction:
        """Force of both contacts, and their torque about the first contact point."""
        found, slips = self.found(y)
        power: Any = dot(found.couple, found.pair.first.turning)
        for slip, wrench in zip(slips, found.wrenches, strict=True):
            power = power + (wrench.force[0] * slip[0] + wrench.force[1] * slip[1])
        return Reaction(found.force, found.torque, power, found.couple)

    def stilled(self, axis: Vector, momentum: Vector) -> Vector:
        """The angular momentum, without rolling where that is held."""
        return without_rolling(axis, momentum, self.top) if self.stopped else momentum

    @abstractmethod
    def slips_on(self, contact: int) -> bool:
        """Return whether a contact slips."""

    def rolling_direction(self, state: State) -> float:
        """Return the sign of omega_e with which rolling begins that can be held no longer."""
        return rolling_way(self.found(self.numbers(state))[0])

    @property
    def tops(self) -> Tops:
        """The top with either surface active: the branches of their laws may differ."""
        return self.top, self.other


@dataclass(frozen=True)
class SlidingOnTwo(OnTwo):
    """Sliding on two surfaces, as long as both normal forces are positive."""

    name: ClassVar[str] = "sliding"
    size: ClassVar[int] = 8

    def numbers(self, state: State) -> tuple[Scalar, ...]:
        """The 8 numbers of a sliding state."""
        return along_table(state).pack()

    def state(self, y: Row) -> State:
        """The state, with its height."""
        return on_table(SlidingState.unpack(y), self.top)

    def found(self, y: Row) -> tuple[PairMotion, tuple[Slip, Slip]]:
        """What the table does, and how both contacts slip."""
        state = SlidingState.unpack(y)
        one, other = (slip_of(*state, top) for top in self.tops)
        pair = ContactPair.of(state.axis, state.momentum, self.tops)
        return pair_motion(pair, (one, other), self.rolls), (one, other)

    def slipping(self, now: PairMotion) -> Slip:
        """Acceleration of the centre of mass."""
        return scaled(1.0 / self.top.mass, now.force[:2])

    def guard_values(self) -> list[GuardValue]:
        """The guards of slip's end, and of the branches of the law, too."""
        found = [*super().guard_values(), *self.endings()]
        if is_branched(self.top.friction):
            found += [(numbered(BRANCHING, number), _branch(number)) for number in (0, 1)]
        return found

    def endings(self) -> list[GuardValue]:
        """The guards of slip's end: on both contacts at once where drilling is resisted too."""
        law = self.top.friction
        if slip_length(law) is not None:
            return [(ENDING, lambda mode, y: _left(*mode.found(y)[1]))]
        return (
            [(numbered(ENDING, number), _slip(number)) for number in (0, 1)]
            if is_set_valued(law)
            else []
        )

    def slips_on(self, contact: int) -> bool:
        """Return that both do."""
        return True


def on_two(state: State, tops: Tops, rolls: float) -> SlidingOnTwo:
    """Return the mode of a body that slides on two surfaces."""
    one, other = tops
    if is_branched(other.friction):
        one, other = (on_numbered_branch(top, slip_of(*along_table(state), top)) for top in tops)
    return SlidingOnTwo(one, other, rolls)


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
