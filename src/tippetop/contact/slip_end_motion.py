"""The motion in which slip, or rolling, ends, in its clock."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import lru_cache
from typing import Any

from tippetop.contact.closed_contacts import ClosedContacts, Directed, has_second
from tippetop.contact.contact_mode import example_of, mode_with, parameter_count
from tippetop.contact.guards import lasting_guards
from tippetop.integrators.base import Arc, Array, Guard, Integrator, Motion
from tippetop.mechanics.contacts.forces import slip_length
from tippetop.mechanics.contacts.slip_clock import (
    SlipComponent,
    SlipEndRates,
    SlipEndState,
    overtaking_guard,
    reopening_guard,
    slip_end_rates,
    zero_guard,
)
from tippetop.mechanics.top import Kind
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
def slip_end_motion(form: Any, kinds: tuple[Kind, ...], ending: SlipComponent) -> Motion:
    """Return the equations of motion in the clock of `slip_clock` where a velocity of a mode
    without tops is about to end, for tops of these kinds; time is the last number.

    The last parameters are when the run ends, and how long before its end the velocity is left to
    `landed`.
    """
    example = example_of(form, kinds)
    numbers_first = numbers_in_clock(example)

    def mode_of(numbers: Sequence[Scalar]) -> Any:
        return mode_with(form, kinds, numbers)

    def rates(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> tuple[Scalar, ...]:
        state = unpack_clock(y, numbers_first)
        return pack_clock(slip_end_rates(state, rates_in_time(state, mode_of(numbers), ending)))

    def clock_guard(
        name: str, value: Callable[[SlipEndState, SlipEndRates, Sequence[Scalar]], Scalar]
    ) -> Guard:
        def guard_value(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> Scalar:
            state = unpack_clock(y, numbers_first)
            return value(state, rates_in_time(state, mode_of(numbers), ending), numbers)

        return Guard(name, guard_value)

    def guard(name: str, value: Callable[[ClosedContacts], Scalar]) -> Guard:
        return Guard(
            name,
            lambda y, numbers: value(
                contacts_in_clock(unpack_clock(y, numbers_first), mode_of(numbers), ending)
            ),
        )

    def overtaking(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> Scalar:
        state = unpack_clock(y, numbers_first)
        now = contacts_in_clock(state, mode_of(numbers), ending)
        second: Any = now.beside(ending)
        return overtaking_guard(state, now.rate_of(ending), *second)

    guards = [
        clock_guard(REOPENING, lambda state, rates, _: reopening_guard(state, rates)),
        clock_guard(
            REACHED_ZERO, lambda state, rates, numbers: zero_guard(state, rates, numbers[-1])
        ),
        Guard(TIME, lambda y, numbers: numbers[-2] - y[len(y) - 1]),
    ]
    if not any(example.sticks) and not example.prevents_rolling:
        guards.append(guard(JAMMED, lambda now: now.jamming_margin()))
    if has_second(example, ending):
        guards.append(Guard(OVERTAKEN, overtaking))
    guards += [guard(name, value) for name, value in lasting_guards(example)]
    size = numbers_first + ending.count(example.top) + 2
    return Motion(rates, size, parameter_count(form, kinds) + 2, tuple(guards), lasting=False)


def contacts_in_clock(state: SlipEndState, mode: Any, ending: SlipComponent) -> ClosedContacts:
    """Return the closed contacts where a velocity is about to end."""
    numbers, beside = state.numbers[: mode.count], state.numbers[mode.count :]
    directed = Directed(rolling=state.direction)
    if ending.slip:
        zeta = beside[0] if len(beside) > 0 else None
        directed = Directed(state.direction, state.xi, zeta=zeta)
    return ClosedContacts(mode, numbers, directed)


def numbers_in_clock(mode: Any) -> int:
    """Return how many numbers come before the direction of what ends: those of the mode, and zeta
    where the slip of the first of two contacts ends and that of the second with it or later.
    """
    ends_alone = not mode.is_single and slip_length(mode.top.friction) is None
    return int(mode.count) + int(ends_alone)


def rates_in_time(state: SlipEndState, mode: Any, ending: SlipComponent) -> SlipEndRates:
    """Return the rates in time of what the clock follows."""
    now = contacts_in_clock(state, mode, ending)
    turning = now.forces.points[0].turning
    beside = now.forces.rate[2:] if len(state.numbers) > mode.count else ()
    return SlipEndRates((*now.rates(), *beside), now.rate_of(ending), turning)


def unpack_clock(y: Row, count: int) -> SlipEndState:
    """Return the state in the clock from its numbers, so many of which come before the
    direction.
    """
    last = len(y) - 2
    return SlipEndState(tuple(y[:count]), tuple(y[count:last]), y[last], y[last + 1])


def pack_clock(state: SlipEndState) -> tuple[Scalar, ...]:
    """Return the numbers of a state, or of rates, in the clock."""
    return (*state.numbers, *state.direction, state.speed, state.time)
