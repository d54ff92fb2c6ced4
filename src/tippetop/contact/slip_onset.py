"""The first moments of slip, or of rolling, of any contact mode, in which slip may end again."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Self

from tippetop.contact.contact_mode import ContactMode, example_of, mode_with, parameter_count
from tippetop.contact.guards import lasting_guards
from tippetop.contact.mode import COMPLETED, FAILURE, ModeEnd, Segment
from tippetop.contact.slip_phase import follow_slip
from tippetop.contact.transient import TransientMode, directed_contacts
from tippetop.integrators.base import Integrator
from tippetop.integrators.dense import DenseSolution
from tippetop.mechanics.contacts.slip_clock import SlipComponent
from tippetop.mechanics.contacts.slip_collocation import SlipMotion
from tippetop.mechanics.contacts.slip_variables import inner, size
from tippetop.mechanics.contacts.wrench import Slip
from tippetop.mechanics.state import State
from tippetop.mechanics.top import Kind
from tippetop.mechanics.vectors import Row, Scalar

PART = 0.25
"""Part of the time in which another velocity could end, at its first rate, that a step takes: in
planar motion that velocity passes through zero, where friction jumps.
"""

FIRST_SPEED = 1e-100
"""Speed of the first instant, in natural units, which gives a velocity of zero its direction."""

ONSET_OVER, ENDED = "onset over", "slip ended"
"""Causes of the end of such a mode: its onset is over, and an ordinary mode follows the motion; or
slip has ended.
"""

UNSEEN = "slip, or rolling, cannot be told from its beginning"
"""Detail of the status where rounding hides the velocities that begin."""


@dataclass(frozen=True)
class SlipOnset(TransientMode):
    """The mode from the instant at which slip, or rolling, or both, begin."""

    directions: tuple[Slip, ...] = ()
    """The direction of each."""

    @classmethod
    def of(
        cls, mode: ContactMode, components: Sequence[SlipComponent], directions: Sequence[Slip]
    ) -> Self:
        """Return the onset of velocities of a mode in some directions."""
        return cls(mode.top, mode, tuple(components), tuple(directions))

    def segments(
        self, time: float, state: State, end: float, integrator: Integrator
    ) -> Iterator[Segment]:
        """Follow what begins: to its end where it may end and begin many times a second."""
        mode, recurs = self.contact_mode, len(self.components) == 1
        numbers = [*mode.numbers(state)]
        zeros = [0.0 for direction in self.directions for _ in direction]
        kinds = tuple([top.kind for top in mode.tops])
        phase = follow_slip(
            onset_motion(mode.without_tops(), kinds, self.components),
            self.top,
            ([*numbers, *zeros], self.directions),
            end - time,
            to_end=recurs and mode.is_single and self.components[0].recurs(self.top),
            longest_step=self._longest_step if recurs else None,
            numbers=mode.parameters,
        )
        if not phase.rows:
            empty = DenseSolution.empty(time, len(numbers) + len(zeros))
            yield Segment(self, empty, state, ModeEnd(FAILURE, state, detail=UNSEEN))
            return
        last = [*phase.last[: len(numbers)], *zeros] if phase.ended else phase.last
        first = [FIRST_SPEED * number for direction in self.directions for number in direction]
        lasts = phase.knots[-1]
        reach = end if lasts >= end - time else min(time + lasts, end)
        rows = DenseSolution.of_rows(phase.knots, [*numbers, *first], phase.rows)
        solution, last_state = rows.moved(time, reach), self.state(last)
        cause = ENDED if phase.ended else (COMPLETED if reach >= end else ONSET_OVER)
        how = ModeEnd(cause, last_state)
        yield Segment(self, solution, last_state, how, len(phase.knots) - 1, phase.sweeps)

    def _longest_step(self, numbers: Row, direction: Slip) -> float:
        """Return how long a step may be: a part of the time in which the other velocity could end,
        at its present rate; infinity where none can.
        """
        count, component = self.contact_mode.count, self.components[0]
        now = self.contacts(numbers[:count], (direction,), (tuple(numbers[count:]),))
        second = now.beside(component)
        if second is None or size(second[0]) == 0.0:
            return math.inf
        velocity, rate = second
        closing = inner(velocity, rate)
        return PART * inner(velocity, velocity) / -closing if closing < 0.0 else math.inf


@lru_cache
def onset_motion(
    form: Any, kinds: tuple[Kind, ...], components: tuple[SlipComponent, ...]
) -> SlipMotion:
    """Return the equations of motion while velocities of a mode without tops begin, or end, for
    tops of these kinds.

    Their numbers are those of the mode and then these velocities. Their margins are the guards of
    the mode, but of what begins.

    Parameters
    ----------
    form
        The mode without tops.
    kinds
        The kinds of tops.
    components
        One component, or `SLIP_AND_ROLLING`.
    """
    example = example_of(form, kinds)
    guards = lasting_guards(example)
    counts = [component.count(example.top) for component in components]
    free = form.count
    velocities = tuple([(free + sum(counts[:i]), count) for i, count in enumerate(counts)])

    def rates(
        numbers: Sequence[Scalar], ways: Sequence[Any], parameters: Sequence[Scalar]
    ) -> tuple[Sequence[Any], Sequence[Any]]:
        mode = mode_with(form, kinds, parameters)
        each = [tuple(numbers[first : first + count]) for first, count in velocities]
        now = directed_contacts(mode, components, numbers[:free], ways, each)
        changes = [*now.rates()]
        for component in components:
            changes += [*now.rate_of(component)]
        return changes, [value(now) for _, value in guards]

    count = parameter_count(form, kinds)
    return SlipMotion(rates, free + sum(counts), velocities, count, len(guards))
