"""The first moments of slip at one of two closed contacts, or at both."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, Self

from tippetop.contact.mode import Segment, split
from tippetop.contact.slip_onset import FIRST_SPEED, UNSEEN, failed_segment, onset_segment
from tippetop.contact.slip_phase import follow_slip
from tippetop.contact.transient_on_two import TransientOnTwo
from tippetop.integrators.base import Integrator
from tippetop.mechanics.contacts.branches import is_branched
from tippetop.mechanics.contacts.contact_forces import forces_on_two
from tippetop.mechanics.contacts.contact_point import contact_points
from tippetop.mechanics.contacts.pair import slips_of
from tippetop.mechanics.contacts.slip_collocation import SlipMotion
from tippetop.mechanics.contacts.slip_variables import branch_guard, scaled
from tippetop.mechanics.contacts.wrench import Slip
from tippetop.mechanics.motion import axis_rate
from tippetop.mechanics.state import State
from tippetop.mechanics.top import Kind
from tippetop.mechanics.vectors import Row, Scalar

NUMBERS = 9
"""How many numbers such a motion has."""


@dataclass(frozen=True)
class SlipOnsetOnTwo(TransientOnTwo):
    """The first moments of slip at one of two contacts, or at both."""

    begin: tuple[float, ...] = ()
    """The numbers at the start."""
    direction: Slip = ()
    """Direction of what begins: of the slip of the first contact, or of xi."""

    def without_tops(self) -> Self:
        """Without the numbers of one state, too."""
        none = tuple([0.0 for _ in self.direction])
        return replace(super().without_tops(), begin=(), direction=none)

    def onset_rates(self, y: Row, direction: Slip) -> tuple[Row, Row]:
        """Return the rates of the numbers, and margins, where what begins has a direction."""
        axis, momentum = split(y)
        pair = contact_points(axis, momentum, self.tops)
        slips = slips_of(pair, direction if len(direction) == 3 else (y[6], y[7], y[8]))
        if len(direction) == 2:
            slips = direction, slips[1]
        now = forces_on_two(pair, slips, self.rolls)
        margins = [*now.normal]
        if self.prevents_rolling:
            margins.append(now.rolling_reserve)
        elif self.top.resists_rolling:
            margins.append(self.rolls * now.rolling)
        if is_branched(self.top.friction):
            margins += [branch_guard(slip, top) for slip, top in zip(slips, self.tops, strict=True)]
        return (*axis_rate(axis, momentum, self.top), *now.moment, *now.rate), margins

    def segments(
        self, time: float, state: State, end: float, integrator: Integrator
    ) -> Iterator[Segment]:
        """Follow what begins for a step."""
        kinds = tuple([top.kind for top in self.tops])
        phase = follow_slip(
            onset_motion_on_two(self.without_tops(), kinds),
            self.top,
            (self.begin, [self.direction]),
            end - time,
            numbers=self.parameters,
        )
        if not phase.rows:
            yield failed_segment(self, time, state, UNSEEN)
            return
        first = scaled(FIRST_SPEED, self.direction)
        start = [*self.begin[:6], *first, *self.begin[6 + len(first) :]]
        yield onset_segment(self, phase, start, phase.last, (time, end))


@lru_cache
def onset_motion_on_two(form: Any, kinds: tuple[Kind, ...]) -> SlipMotion:
    """Return the equations of motion of a mode without tops, for tops of these kinds."""
    first_kind, second_kind = kinds

    def rates(
        numbers: Sequence[Scalar], ways: Sequence[Any], parameters: Sequence[Scalar]
    ) -> tuple[Sequence[Any], Sequence[Any]]:
        first, second = parameters[: first_kind.numbers], parameters[first_kind.numbers :]
        mode = form.with_tops((first_kind.top(tuple(first)), second_kind.top(tuple(second))), ())
        changes: tuple[Sequence[Any], Sequence[Any]] = mode.onset_rates(numbers, ways[0])
        return changes

    margins = (
        2 + int(first_kind.resists_rolling) + 2 * int(is_branched(first_kind.example.friction))
    )
    velocities = ((6, len(form.direction)),)
    return SlipMotion(rates, NUMBERS, velocities, first_kind.numbers + second_kind.numbers, margins)
