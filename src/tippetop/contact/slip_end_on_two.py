"""The last moments of slip on two closed contacts, under friction that is set-valued."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, Self

from tippetop.contact.contact_mode import ContactMode
from tippetop.contact.guards import BRANCH, OPENING, ROLLING, ROLLING_STOPPING
from tippetop.contact.mode import Segment, numbered, split
from tippetop.contact.slip_clock import EndClock, follow_clock, segment_of
from tippetop.contact.slip_end_motion import OVERTAKEN, REACHED_ZERO, REOPENING, TIME, pack_clock
from tippetop.contact.transient import straight
from tippetop.contact.transient_on_two import TransientOnTwo
from tippetop.integrators.base import Guard, Integrator, Motion
from tippetop.mechanics.contacts.branches import is_branched
from tippetop.mechanics.contacts.contact_forces import ContactForces
from tippetop.mechanics.contacts.contact_point import contact_points
from tippetop.mechanics.contacts.forces import slip_length
from tippetop.mechanics.contacts.pair import slip_apart
from tippetop.mechanics.contacts.slip_end import (
    SlipEndRates,
    SlipEndState,
    reopening_guard,
    slip_end_rates,
    zero_guard,
)
from tippetop.mechanics.contacts.slip_end_on_two import (
    forces_in_clock,
    overtaking_on_two,
    rates_on_two,
    slips_in_clock,
)
from tippetop.mechanics.contacts.slip_variables import branch_guard, scaled, size, slip_of
from tippetop.mechanics.motion import along_table
from tippetop.mechanics.state import State
from tippetop.mechanics.top import Kind
from tippetop.mechanics.vectors import Row, Scalar


@dataclass(frozen=True)
class SlipEndOnTwo(TransientOnTwo):
    """The last moments of the slip of the first of two contacts, or of both where the law resists
    drilling, in a clock of their own (see `tippetop.mechanics.contacts.slip_end_on_two`).
    """

    begin: tuple[float, ...] = ()
    """The numbers of the clock where another branch of the law has left off; else they are the
    state's.
    """

    def without_tops(self) -> Self:
        """Without the numbers of one state, too."""
        return replace(super().without_tops(), begin=())

    @property
    def clock_motion(self) -> Motion:
        """Its equations in the clock."""
        kinds = tuple([top.kind for top in self.tops])
        return slip_end_motion_on_two(self.without_tops(), kinds)

    def segments(
        self, time: float, state: State, end: float, integrator: Integrator
    ) -> Iterator[Segment]:
        """Follow it to its end, or to where it is no longer about to end."""
        begin = self.begin or self._clock(state)
        clock = EndClock(
            self.clock_motion,
            self.parameters,
            self.top,
            lambda y: unpack_clock(y, self.drills),
            self.rates_in_time,
            self.pack,
            lambda _: None,
            False,
        )
        approach = follow_clock(clock, begin, end - time, integrator)
        now = clock.unpack(approach.arcs[-1].end_state.tolist() if approach.arcs else begin)
        numbers = self.pack(now), self.pack(approach.last)
        onwards = straight(*numbers, float(now.time), approach.last.time)
        yield segment_of(self, clock, approach, self.state(numbers[1]), onwards, time)

    def forces(self, now: SlipEndState) -> ContactForces:
        """Return the forces and accelerations in the clock."""
        first, second = self.tops
        return forces_in_clock(now, (first, second), self.rolls)

    def rates_in_time(self, now: SlipEndState) -> SlipEndRates:
        """Return the rates in time in the clock."""
        return rates_on_two(now, self.forces(now))

    def pack(self, now: SlipEndState) -> tuple[Scalar, ...]:
        """Return axis, angular momentum and xi."""
        return (*now.axis, *now.momentum, *scaled(now.speed, now.direction), *now.velocity)

    def _clock(self, state: State) -> tuple[float, ...]:
        """Return the numbers of the clock at a state."""
        slip = slip_of(*along_table(state), self.top)[:2]
        zeta = slip_apart(contact_points(state.axis, state.momentum, self.tops))
        xi, beside = ((*slip, zeta), ()) if self.drills else (slip, (zeta,))
        direction = scaled(1.0 / size(xi), xi)
        return (*state.axis, *state.momentum, *beside, *direction, size(xi), 0.0)

    @property
    def drills(self) -> bool:
        """Whether the law resists drilling, so that xi ends as one."""
        return slip_length(self.top.friction) is not None


def end_on_two(mode: ContactMode, number: int) -> SlipEndOnTwo:
    """Return the mode in which the slip of a contact of two ends, or that of both (-1)."""
    first, second = mode.tops[::-1] if number == 1 else mode.tops
    return SlipEndOnTwo(
        first, (False, False), mode.prevents_rolling, beside=(second,), rolls=mode.rolls
    )


def unpack_clock(y: Row, drills: bool) -> SlipEndState:
    """Return the state of slip that is about to end, from its numbers in the clock: zeta ends with
    it, or goes on beside it.
    """
    first = 6 if drills else 7
    return SlipEndState(*split(y), tuple(y[6:first]), tuple(y[first:9]), y[9], y[10])


@lru_cache
def slip_end_motion_on_two(form: Any, kinds: tuple[Kind, ...]) -> Motion:
    """Return the equations of motion in the clock of a mode without tops, for tops of these kinds;
    time is the last number.

    The last parameters are when the run ends, and how long before its end slip is left to `landed`.
    """
    first_kind, second_kind = kinds
    count, top = first_kind.numbers + second_kind.numbers, first_kind.example
    drills = slip_length(top.friction) is not None

    def mode_of(numbers: Sequence[Scalar]) -> Any:
        first, second = numbers[: first_kind.numbers], numbers[first_kind.numbers : count]
        return form.with_tops((first_kind.top(tuple(first)), second_kind.top(tuple(second))), ())

    def rates(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> tuple[Scalar, ...]:
        state = unpack_clock(y, drills)
        return pack_clock(slip_end_rates(state, mode_of(numbers).rates_in_time(state)))

    def guard(name: str, value: Callable[[SlipEndState, Any, Sequence[Scalar]], Scalar]) -> Guard:
        return Guard(
            name, lambda y, numbers: value(unpack_clock(y, drills), mode_of(numbers), numbers)
        )

    def on_branch_still(number: int) -> Callable[..., Scalar]:
        def branch_guard_value(state: SlipEndState, mode: Any, _: Sequence[Scalar]) -> Scalar:
            pair = contact_points(state.axis, state.momentum, mode.tops)
            return branch_guard(slips_in_clock(pair, state)[number], mode.tops[number])

        return branch_guard_value

    guards = [
        guard(
            REOPENING,
            lambda state, mode, _: reopening_guard(state, mode.rates_in_time(state), mode.top),
        ),
        guard(
            REACHED_ZERO,
            lambda state, mode, numbers: zero_guard(
                state, mode.rates_in_time(state), mode.top, numbers[-1]
            ),
        ),
        guard(TIME, lambda state, _, numbers: numbers[-2] - state.time),
        guard(numbered(OPENING, 0), lambda state, mode, _: mode.forces(state).normal[0]),
        guard(numbered(OPENING, 1), lambda state, mode, _: mode.forces(state).normal[1]),
    ]
    if form.prevents_rolling:
        guards.append(guard(ROLLING, lambda state, mode, _: mode.forces(state).rolling_reserve))
    elif top.resists_rolling:
        guards.append(
            guard(
                ROLLING_STOPPING,
                lambda state, mode, _: mode.rolls * mode.forces(state).rolling,
            )
        )
    if not drills:
        guards.append(
            guard(
                OVERTAKEN,
                lambda state, mode, _: overtaking_on_two(state, mode.forces(state)),
            )
        )
    if is_branched(top.friction):
        guards += [guard(numbered(BRANCH, number), on_branch_still(number)) for number in (0, 1)]
    return Motion(rates, 11, count + 2, tuple(guards), lasting=False)
