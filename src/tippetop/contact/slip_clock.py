"""What follows a velocity in the clock of its end, and what makes polynomials in time of that."""

from collections.abc import Callable, Sequence
from typing import NamedTuple

from tippetop.contact.collocated_end import CollocatedEnd
from tippetop.contact.mode import COMPLETED, FAILURE, Mode, ModeEnd, Segment
from tippetop.contact.slip_end_motion import FEW, JAMMED, REACHED_ZERO, TIME, goes_on, slip_end_arcs
from tippetop.contact.transient import DEGREE, SETTLED
from tippetop.integrators.base import Arc, Array, Integrator, Motion
from tippetop.integrators.dense import DenseSolution, as_array
from tippetop.mechanics.contacts.slip_end import (
    SlipEndRates,
    SlipEndState,
    landed,
    zero_guard,
)
from tippetop.mechanics.state import State
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Row, Scalar

LAST_STEPS = (3e-8, 1e-16)
"""How long before its end the rest of a velocity may be taken in one step, in natural units of
time: if its direction has come to rest by then, and in any case.
"""

SHARE = 0.01
"""Part of the time to the end that a polynomial of `DEGREE` leaves: friction after it ends
smoothly.
"""

NEARER, NEAREST = 0.6, 1e-13
"""Part of the time to a jam that a polynomial leaves to the next one, and part of all that is the
last's.
"""

RESOLVED = 1e-15
"""Last term of such polynomials, in natural units, that is small: else they are made for shorter
times.
"""


class EndClock(NamedTuple):
    """The clock of `tippetop.mechanics.contacts.slip_end` for a velocity of one or two contacts."""

    motion: Motion
    """Equations of motion and guards."""
    parameters: tuple[Scalar, ...]
    """Their parameters but the last two: when the run ends, and how long before its end the
    velocity is left to `landed`.
    """
    top: Top
    """The body."""
    unpack: Callable[[Row], SlipEndState]
    """From the numbers of the clock to a state."""
    rates: Callable[[SlipEndState], SlipEndRates]
    """Rates in time."""
    pack: Callable[[SlipEndState], tuple[Scalar, ...]]
    """From a state to the numbers of the mode."""
    collocated: Callable[[SlipEndState], CollocatedEnd | None]
    """The end by collocation, where there is one."""
    tries_at_once: bool
    """Whether that is looked for from the first instant on."""


class Approach(NamedTuple):
    """A velocity as far as its clock was followed."""

    arcs: list[Arc]
    """Its motion in the clock."""
    last: SlipEndState
    """The state where it has landed; else where the clock was left."""
    arrival: CollocatedEnd | None
    """Its end by collocation, if it is followed so from there on."""


def follow_clock(clock: EndClock, begin: Row, longest: float, integrator: Integrator) -> Approach:
    """Follow a velocity in its clock until it lands, or to where it is no longer about to end."""
    now, start, arcs = clock.unpack(begin), (0.0, as_array(begin)), list[Arc]()
    arrival, last = clock.collocated(now) if clock.tries_at_once else None, now
    for horizon in LAST_STEPS:
        if arrival is not None or (zero_guard(now, clock.rates(now), clock.top, horizon) <= 0.0):
            continue
        for arc in slip_end_arcs(
            integrator, clock.motion, (*clock.parameters, longest, horizon), start
        ):
            arcs.append(arc)
            start = arc.solution.end, arc.end_state
            now = clock.unpack(arc.end_state.tolist())
            if goes_on(arc) and arc.steps >= FEW:
                arrival = clock.collocated(now)
            if arrival is not None:
                return Approach(arcs, now, arrival)
        if arcs[-1].guard != REACHED_ZERO:
            return Approach(arcs, now, None)
        last, doubt = landed(now, clock.rates(now))
        if doubt < SETTLED:
            break
    if not arcs and arrival is None:
        last = landed(now, clock.rates(now))[0]
    return Approach(arcs, last, arrival)


def segment_of(
    mode: Mode,
    clock: EndClock,
    approach: Approach,
    last: State,
    onwards: DenseSolution,
    time: float,
) -> Segment:
    """Return the segment of a mode that began at a time and was followed in its clock.

    Parameters
    ----------
    mode
        The mode.
    clock, approach
        Its clock, and how far that was followed.
    last
        The state at the end.
    onwards
        The numbers of the mode from where the clock was left, in time since the start.
    time
        When it began.
    """
    arcs = approach.arcs
    arc = arcs[-1] if arcs and approach.arrival is None else None
    solution = _in_time(clock, arcs, onwards).moved(time, time + onwards.end)
    steps = sum(one.steps for one in arcs) + (approach.arrival is not None)
    method = next((one.method for one in arcs[::-1] if one.method is not None), None)
    return Segment(mode, solution, last, _end(arc, last), steps, steps, method=method)


def _end(arc: Arc | None, state: State) -> ModeEnd:
    """Return what ended the mode."""
    if arc is None:
        return ModeEnd(REACHED_ZERO, state)
    if arc.failure is not None:
        return ModeEnd(FAILURE, state, detail=arc.failure)
    assert arc.guard is not None, "an end of slip whose clock still goes on"
    if arc.guard == TIME:
        return ModeEnd(COMPLETED, state)
    return ModeEnd.by_guard(arc.guard, state, tuple(arc.end_state.tolist()))


def _in_time(clock: EndClock, arcs: Sequence[Arc], onwards: DenseSolution) -> DenseSolution:
    """Return the numbers of the mode as polynomials in time: from the clock's, and onwards."""
    until = onwards.knots[0]
    parts = [arc.solution for arc in arcs if len(arc.solution.terms)]
    if not parts:
        return onwards
    clocked, elapsed = DenseSolution.joined(parts), parts[0].size - 1

    def numbers(times: Array) -> tuple[Scalar, ...]:
        return clock.pack(clock.unpack(clocked.rows(clocked.when(elapsed, times))))

    knots = clocked.knots_of(elapsed, until)
    jams = arcs[-1].guard == JAMMED
    solution = DenseSolution.fitted(numbers, graded(knots) if jams else thinned(knots), DEGREE)
    if solution.unresolved > RESOLVED and not jams:
        solution = DenseSolution.fitted(numbers, knots, DEGREE)
    return DenseSolution.joined([solution, onwards]) if onwards.end > until else solution


def thinned(knots: Sequence[float]) -> list[float]:
    """Ends of steps, so few of them that each leaves but a share of the time to the last."""
    end, chosen = knots[-1], [knots[0]]
    for knot in knots[1:-1]:
        if end - knot <= SHARE * (end - chosen[-1]):
            chosen.append(knot)
    return [*chosen, end]


def graded(knots: Sequence[float]) -> list[float]:
    """Ends of steps that grow as short as what is left to the last, where the normal force has no
    bound.
    """
    end, chosen = knots[-1], [knots[0]]
    for knot in knots[1:]:
        while NEARER * (end - chosen[-1]) > max(end - knot, NEAREST * (end - knots[0])):
            chosen.append(end - NEARER * (end - chosen[-1]))
        chosen.append(knot)
    return chosen
