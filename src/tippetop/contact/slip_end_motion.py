"""The motion in which slip, or rolling, ends, in its clock."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import lru_cache
from typing import Any

from tippetop.contact.guards import BRANCH, LIFT_OFF, LIMIT_BRANCH, ROLLING, SLIP
from tippetop.contact.mode import split
from tippetop.contact.surfaces import WOBBLE, SurfaceGuard, surface_guards
from tippetop.integrators.base import Arc, Array, Guard, Integrator, Motion
from tippetop.mechanics.contacts.branches import has_limit_branches, limit_guard
from tippetop.mechanics.contacts.contact_point import ContactPoint
from tippetop.mechanics.contacts.forces import is_set_valued, rolling_reserve, slip_reserve
from tippetop.mechanics.contacts.slip_end import (
    SlipComponent,
    SlipEndRates,
    SlipEndState,
    jamming_guard,
    overtaking_guard,
    rates_in_time,
    reopening_guard,
    slip_beside,
    slip_end_rates,
    zero_guard,
)
from tippetop.mechanics.contacts.slip_variables import branch_guard
from tippetop.mechanics.contacts.wrench import Wrench
from tippetop.mechanics.lying_down import wobble_guard
from tippetop.mechanics.surfaces.hull import is_edge
from tippetop.mechanics.top import Kind, Top
from tippetop.mechanics.vectors import Row, Scalar

REOPENING, REACHED_ZERO, TIME = "reopening", "zero", "time"
OVERTAKEN, JAMMED = "overtaken", "jammed"

CLOCK_GUARDS = (REOPENING, REACHED_ZERO, TIME)
"""Guards of the clock itself; the others are of what else may happen."""

CLOCK_LIMIT = 1e4
"""More of the clock than any velocity takes to end, but one that turns for ever."""

SOON = (0.3, 2.0)
"""Parts of the clock after which friction that takes thousands of steps to slip's end may have
turned it as far as it does: slip is then followed by collocation (see `collocated_end`).
"""

FEW = 16
"""Steps in such a part from which that may be."""

MOST = 16
"""Arcs after which such an end is given up, within seconds; most take two."""

ENDLESS = "slip, or rolling, does not come to its end"
"""Why such an end is given up."""

STALLED = 1e-9
"""Part of the clock that an arc of thousands of steps goes, if it goes no farther, from which none
ends.
"""


def goes_on(arc: Arc) -> bool:
    """Return whether nothing has ended an arc."""
    return arc.guard is None and arc.failure is None


def slip_end_arcs(
    integrator: Integrator, motion: Motion, parameters: Sequence[float], start: tuple[float, Array]
) -> Iterator[Arc]:
    """Return the end of slip, or of rolling, in its clock, arc by arc; a guard or a failure ends
    the last.
    """
    arcs = 0
    for end in (*[start[0] + part for part in SOON if start[0] + part < CLOCK_LIMIT], CLOCK_LIMIT):
        for arc in integrator.integrate(motion, parameters, start, end):
            arcs += 1
            stalled = arc.solution.end - start[0] < STALLED * start[0]
            endless = arcs == MOST or stalled or arc.solution.end >= CLOCK_LIMIT
            given_up = goes_on(arc) and endless
            yield replace(arc, failure=ENDLESS) if given_up else arc
            if given_up or not goes_on(arc):
                return
            start = arc.solution.end, arc.end_state


@lru_cache
def slip_end_motion(kind: Kind, ending: SlipComponent, guarded: bool) -> Motion:
    """Equations of motion in the clock of `slip_end` where a velocity is about to end; time is the
    last number.

    The last parameters are when the run ends, and how long before its end the velocity is left to
    `landed`.
    """

    def top_of(numbers: Sequence[Scalar]) -> Top:
        return kind.top(tuple(numbers[: kind.numbers]))

    def rates(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> tuple[Scalar, ...]:
        state = slip_end_state(y, ending)
        return pack_clock(slip_end_rates(state, rates_in_time(state, ending, top_of(numbers))))

    def guard(name: str, value: Callable[[SlipEndState, Top, Sequence[Scalar]], Scalar]) -> Guard:
        return Guard(
            name, lambda y, numbers: value(slip_end_state(y, ending), top_of(numbers), numbers)
        )

    def rates_of(state: SlipEndState, top: Top) -> SlipEndRates:
        return rates_in_time(state, ending, top)

    def held_by(state: SlipEndState, top: Top) -> Wrench:
        return rates_of(state, top).wrench

    def on_branch_still(state: SlipEndState, top: Top, _: Sequence[Scalar]) -> Scalar:
        """Return the guard of the law's branch, by the slip that goes on, or else that ends."""
        return branch_guard(slip_beside(state, ending, top) or state.direction, top)

    guards = [
        guard(REOPENING, lambda state, top, _: reopening_guard(state, rates_of(state, top), top)),
        guard(
            REACHED_ZERO,
            lambda state, top, numbers: zero_guard(state, rates_of(state, top), top, numbers[-1]),
        ),
        guard(TIME, lambda state, _, numbers: numbers[-2] - state.time),
    ]
    top = kind.example
    law, stuck = top.friction, not ending.slip and ending.held
    if guarded:
        guards.append(guard(LIFT_OFF, lambda state, top, _: held_by(state, top).force[2]))
    if not ending.held:
        guards.append(guard(JAMMED, lambda state, top, _: jamming_guard(state, ending, top)))
    if not ending.held and top.resists_rolling and is_set_valued(law):
        guards.append(guard(OVERTAKEN, lambda state, top, _: overtaking_guard(state, ending, top)))
    if ending.held:
        held = ROLLING if ending.slip else SLIP
        guards.append(guard(held, lambda state, top, _: held_reserve(state, ending, top)))
    if (ending.slip or ending.moves) and hasattr(law, "branch_guard"):
        guards.append(guard(BRANCH, on_branch_still))
    if stuck and has_limit_branches(law):
        guards.append(
            guard(LIMIT_BRANCH, lambda state, top, _: limit_guard(top, held_by(state, top)))
        )
    if is_edge(top.surface):
        guards.append(guard(WOBBLE, lambda state, top, _: wobble_reserve(state, ending, top)))
    guards += [guard(name, _of_axis(value)) for name, value in surface_guards(top)]
    size = (10 if ending.moves else 8) + len(ending.wrenches(top))
    return Motion(rates, size, kind.numbers + 2, tuple(guards), lasting=False)


def _of_axis(value: SurfaceGuard) -> Callable[[SlipEndState, Top, Any], Scalar]:
    return lambda state, top, _: value(top, state.axis, state.momentum)


def wobble_reserve(state: SlipEndState, ending: SlipComponent, top: Top) -> Scalar:
    """Positive until the time left to the wobble of a body on an edge is known."""
    sticks = not ending.slip and ending.held
    normal = rates_in_time(state, ending, top).wrench.force[2] if sticks else None
    return wobble_guard(state.axis, state.momentum, normal, top)


def held_reserve(state: SlipEndState, ending: SlipComponent, top: Top) -> Scalar:
    """Positive while the table can hold what is held beside a velocity that ends."""
    wrench = rates_in_time(state, ending, top).wrench
    if ending.slip:
        point = ContactPoint.of(state.axis, state.momentum, top)
        return rolling_reserve(point, wrench, state.direction)
    return slip_reserve(top, wrench)


def slip_end_state(y: Row, ending: SlipComponent) -> SlipEndState:
    """Return the state of a velocity that is about to end, from its numbers."""
    count, free = len(y), 8 if ending.moves else 6
    return SlipEndState(
        *split(y), tuple(y[6:free]), tuple(y[free : count - 2]), y[count - 2], y[count - 1]
    )


def pack_clock(state: SlipEndState) -> tuple[Scalar, ...]:
    """Return the numbers of a state, or of rates, in the clock."""
    return (
        *state.axis,
        *state.momentum,
        *state.velocity,
        *state.direction,
        state.speed,
        state.time,
    )
