"""The last moments of slip, or of rolling, under friction that is set-valued."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from tippetop.contact.collocated_end import CollocatedEnd, collocated_end
from tippetop.contact.mode import COMPLETED, FAILURE, ModeEnd, Segment
from tippetop.contact.slip_end_motion import (
    FEW,
    JAMMED,
    LANDED,
    OWN,
    TIME,
    slip_end_arcs,
    slip_end_motion,
    slip_end_state,
)
from tippetop.contact.surfaces import passes_flat
from tippetop.contact.transient import DEGREE, LOOKS, SETTLED, TransientMode, pack_moment, straight
from tippetop.integrators.base import Arc, Array, Integrator, Motion
from tippetop.integrators.dense import DenseSolution, as_array
from tippetop.mechanics.contacts.forces import slip_length
from tippetop.mechanics.contacts.slip_end import SlipEndState, landed, landing_guard
from tippetop.mechanics.contacts.slip_variables import scaled, size
from tippetop.mechanics.state import State
from tippetop.mechanics.vectors import Row, Scalar

LANDING = (3e-8, 1e-16)
"""How long before its end the rest of a velocity may be taken in one step, in natural units of
time: if its direction has come to rest by then, and in any case.
"""

ALMOST = 1e-6
"""Part of the time to the end that is left at the last look at what else may happen: slip has a
direction.
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


@dataclass(frozen=True)
class SlipEnd(TransientMode):
    """The last moments of slip, or of rolling, in a clock of their own (see
    `tippetop.mechanics.contacts.slip_end`).
    """

    begin: tuple[float, ...] = ()
    """The numbers of the clock where another branch of the law has left off; else they are the
    state's.
    """

    @property
    def motion(self) -> Motion:
        """Its equations in the clock."""
        return slip_end_motion(self.top.kind, self.ending, not self.pulls)

    def segments(
        self, time: float, state: State, end: float, integrator: Integrator
    ) -> Iterator[Segment]:
        """Follow it to its end, or to where it is no longer about to end."""
        begin = self.begin or self._clock(state)
        arcs, last_state, arrival = self._followed(begin, end - time, integrator)
        now = slip_end_state(arcs[-1].end_state.tolist() if arcs else begin, self.ending)
        arc, until = arcs[-1] if arcs and arrival is None else None, float(now.time)
        if arrival is None:
            last, onwards = (
                self.state(pack_moment(last_state)),
                straight(pack_moment(now), pack_moment(last_state), until, last_state.time),
            )
        else:
            last, onwards = (
                self.state(arrival.at(0.0)),
                arrival.solution(until),
            )
        solution = self._in_time(arcs, until, onwards).moved(time, time + onwards.end)
        how, steps = self._end(arc, last), sum(one.steps for one in arcs)
        steps += arrival is not None
        method = next((one.method for one in arcs[::-1] if one.method is not None), None)
        yield Segment(self, solution, last, how, steps, steps, method=method)

    def _followed(
        self, begin: Row, longest: float, integrator: Integrator
    ) -> tuple[list[Arc], SlipEndState, CollocatedEnd | None]:
        """Follow the velocity in its clock; return the arcs, the end state, and a collocated end if
        any.
        """
        now, start, arcs = slip_end_state(begin, self.ending), (0.0, as_array(begin)), list[Arc]()
        patch = slip_length(self.top.friction) is not None
        arrival, last_state = self._arrival(now, longest, integrator) if patch else None, now
        for horizon in LANDING:
            if arrival is not None or landing_guard(now, self.ending, self.top, horizon) <= 0.0:
                continue
            for arc in slip_end_arcs(
                integrator, self.motion, (*self.top.numbers, longest, horizon), start
            ):
                arcs.append(arc)
                start = arc.solution.end, arc.end_state
                now = slip_end_state(arc.end_state.tolist(), self.ending)
                if arc.guard is None and arc.failure is None and arc.steps >= FEW:
                    arrival = self._arrival(now, longest, integrator)
                if arrival is not None:
                    return arcs, now, arrival
            if arcs[-1].guard != LANDED:
                return arcs, now, None
            last_state, doubt = landed(now, self.ending, self.top)
            if doubt < SETTLED:
                break
        return (
            arcs,
            last_state if arcs or arrival is not None else landed(now, self.ending, self.top)[0],
            arrival,
        )

    def _arrival(
        self, now: SlipEndState, longest: float, integrator: Integrator
    ) -> CollocatedEnd | None:
        """Return the end of slip by collocation, if its direction has come to rest and nothing else
        happens.
        """
        if not self.ending.slip:
            return None
        arrival = collocated_end(now, self.ending, self.top, getattr(integrator, "tolerance", 0.0))
        if arrival is None or now.time + arrival.time_left > longest:
            return None
        numbers = (*self.top.numbers, longest, 0.0)
        for probe in range(LOOKS + 1):
            later = arrival.at(probe / LOOKS or ALMOST)
            xi = tuple(later[6:])
            clock = (*later[:6], *scaled(1.0 / size(xi), xi), size(xi), now.time)
            if not all(
                one.value(clock, numbers) > 0.0 for one in self.motion.guards if one.name not in OWN
            ):
                return None
        rows = [arrival.at(probe / LOOKS) for probe in range(LOOKS + 1)]
        return None if passes_flat(self.top, rows) else arrival

    def _clock(self, state: State) -> tuple[float, ...]:
        """Return the numbers of the clock at a state."""
        velocity = state.velocity[:2]
        xi = self.ending.of(state.axis, state.momentum, velocity, self.top)
        free = velocity if self.ending.moves else ()
        return (*state.axis, *state.momentum, *free, *scaled(1.0 / size(xi), xi), size(xi), 0.0)

    def _end(self, arc: Arc | None, state: State) -> ModeEnd:
        """Return what ended the mode."""
        if arc is None:
            return ModeEnd(LANDED, state)
        if arc.failure is not None or arc.guard is None:
            detail = arc.failure or "the slip neither ends nor goes on"
            return ModeEnd(FAILURE, state, detail=detail)
        if arc.guard == TIME:
            return ModeEnd(COMPLETED, state)
        return ModeEnd.by_guard(arc.guard, state, tuple(arc.end_state.tolist()))

    def _in_time(
        self, arcs: Sequence[Arc], until: float, last_state: DenseSolution
    ) -> DenseSolution:
        """Return the numbers of the mode as polynomials in time: up to some time from the clock's,
        and the rest.
        """
        parts = [arc.solution for arc in arcs if len(arc.solution.terms)]
        if not parts:
            return last_state
        clock, elapsed = DenseSolution.joined(parts), parts[0].size - 1

        def numbers(times: Array) -> tuple[Scalar, ...]:
            return pack_moment(slip_end_state(clock.rows(clock.when(elapsed, times)), self.ending))

        knots = clock.knots_of(elapsed, until)
        jams = arcs[-1].guard == JAMMED
        solution = DenseSolution.fitted(numbers, graded(knots) if jams else thinned(knots), DEGREE)
        if solution.unresolved > RESOLVED and not jams:
            solution = DenseSolution.fitted(numbers, knots, DEGREE)
        return DenseSolution.joined([solution, last_state]) if last_state.end > until else solution


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
