"""The last moments of slip, or of rolling, of any contact mode, in a clock of their own (see
`tippetop.mechanics.contacts.slip_clock`), and polynomials in time made of that.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple, Self

from tippetop.contact.collocated_end import CollocatedEnd, collocated_end
from tippetop.contact.contact_mode import ContactMode
from tippetop.contact.mode import COMPLETED, FAILURE, ModeEnd, Segment
from tippetop.contact.slip_end_motion import (
    CLOCK_GUARDS,
    FEW,
    JAMMED,
    REACHED_ZERO,
    TIME,
    goes_on,
    numbers_in_clock,
    rates_in_time,
    slip_end_arcs,
    slip_end_motion,
    unpack_clock,
)
from tippetop.contact.slip_onset import onset_motion
from tippetop.contact.surfaces import passes_flat
from tippetop.contact.transient import DEGREE, TransientMode, straight
from tippetop.integrators.base import Arc, Array, Integrator, Motion
from tippetop.integrators.dense import DenseSolution, as_array
from tippetop.integrators.guard_functions import guard_values
from tippetop.mechanics.contacts.forces import slip_length
from tippetop.mechanics.contacts.slip_clock import (
    SlipComponent,
    SlipEndRates,
    SlipEndState,
    landed,
    zero_guard,
)
from tippetop.mechanics.contacts.slip_variables import scaled, size
from tippetop.mechanics.state import State
from tippetop.mechanics.vectors import Row, Scalar

ALMOST = 1e-6
"""Part of the time to the end that is left at the last probe of what else may happen: slip has a
direction.
"""

PROBES_OF_SLIP_END = 16
"""Intervals of the end of slip at whose ends it is asked whether another guard falls: then a mode
with that guard takes over sooner.
"""

SETTLED = 1e-14
"""Error of the instant at which slip ends, in natural units, that counts as none."""

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


class Approach(NamedTuple):
    """A velocity as far as its clock was followed."""

    arcs: list[Arc]
    """Its motion in the clock."""
    last: SlipEndState
    """The state where it has landed; else where the clock was left."""
    arrival: CollocatedEnd | None
    """Its end by collocation, if it is followed so from there on."""


@dataclass(frozen=True)
class SlipEnd(TransientMode):
    """The last moments of slip, or of rolling, in the clock."""

    begin: tuple[float, ...] = ()
    """The numbers of the clock where another branch of the law has left off; else they are the
    state's.
    """

    @classmethod
    def of(cls, mode: ContactMode, component: SlipComponent, begin: tuple[float, ...] = ()) -> Self:
        """Return the end of a velocity of a mode."""
        # The guards of a velocity that goes on are not asked, so that one form serves both.
        mode = replace(mode, near=False)
        both = component._replace(turns=not mode.is_single)
        return cls(mode.top, mode, (both,), begin)

    @property
    def component(self) -> SlipComponent:
        """The velocity that ends: of two contacts the slip of the first, or of both where the law
        resists drilling.
        """
        return SlipComponent(self.components[0].slip)

    def of_second(self) -> "SlipEnd":
        """Return the end of the other velocity: of slip or rolling, or of the slip of the other of
        two contacts.
        """
        mode, slip = self.contact_mode, self.component.slip
        if mode.is_single:
            return SlipEnd.of(mode, SlipComponent(not slip))
        return SlipEnd.of(mode.swapped, self.component)

    @property
    def motion(self) -> Motion:
        """Its equations in the clock."""
        mode = self.contact_mode
        kinds = tuple([top.kind for top in mode.tops])
        return slip_end_motion(mode.without_tops(), kinds, self.component)

    def state_in_clock(self, y: Row) -> SlipEndState:
        """Return the state from the numbers of the clock."""
        return unpack_clock(y, numbers_in_clock(self.contact_mode))

    def segments(
        self, time: float, state: State, end: float, integrator: Integrator
    ) -> Iterator[Segment]:
        """Follow it to its end, or to where it is no longer about to end."""
        begin = self.begin or self._clock(state)
        approach = self._follow_clock(begin, end - time, integrator)
        arcs, moment, arrival = approach
        now = self.state_in_clock(arcs[-1].end_state.tolist() if arcs else begin)
        until = float(now.time)
        if arrival is None:
            last = self.state(moment.numbers)
            onwards = straight(self._moment(now), self._moment(moment), until, moment.time)
        else:
            last, onwards = self.state(arrival.at(0.0)), arrival.solution(until)
        arc = arcs[-1] if arcs and arrival is None else None
        solution = self._in_time(arcs, onwards).moved(time, time + onwards.end)
        steps = sum(one.steps for one in arcs) + (arrival is not None)
        method = next((one.method for one in arcs[::-1] if one.method is not None), None)
        yield Segment(self, solution, last, _end(arc, last), steps, steps, method=method)

    def _clock(self, state: State) -> tuple[float, ...]:
        """Return the numbers of the clock at a state."""
        numbers, (component,) = self.contact_mode.numbers(state), self.components
        velocity = self.contact_mode.contacts(numbers).velocity_of(component)
        count = self.component.count(self.top)
        xi, beside = velocity[:count], velocity[count:]
        return (*numbers, *beside, *scaled(1.0 / size(xi), xi), size(xi), 0.0)

    def _moment(self, now: SlipEndState) -> tuple[Scalar, ...]:
        """Return the numbers of the mode at a state in the clock."""
        count = self.contact_mode.count
        return (*now.numbers[:count], *now.xi, *now.numbers[count:])

    def _rates(self, now: SlipEndState) -> SlipEndRates:
        """Return the rates in time."""
        return rates_in_time(now, self.contact_mode, self.component)

    def _follow_clock(self, begin: Row, longest: float, integrator: Integrator) -> Approach:
        """Follow the velocity until it lands, or to where it is no longer about to end."""
        tolerance = getattr(integrator, "tolerance", 0.0)
        motion, parameters = self.motion, self.contact_mode.parameters
        now, start, arcs = self.state_in_clock(begin), (0.0, as_array(begin)), list[Arc]()
        drills = slip_length(self.top.friction) is not None
        arrival = self._arrival(now, longest, tolerance) if drills else None
        last = now
        for horizon in LAST_STEPS:
            if arrival is not None or zero_guard(now, self._rates(now), horizon) <= 0.0:
                continue
            for arc in slip_end_arcs(integrator, motion, (*parameters, longest, horizon), start):
                arcs.append(arc)
                start = arc.solution.end, arc.end_state
                now = self.state_in_clock(arc.end_state.tolist())
                if goes_on(arc) and arc.steps >= FEW:
                    arrival = self._arrival(now, longest, tolerance)
                if arrival is not None:
                    return Approach(arcs, now, arrival)
            if arcs[-1].guard != REACHED_ZERO:
                return Approach(arcs, now, None)
            last, error = landed(now, self._rates(now))
            if error < SETTLED:
                break
        if not arcs and arrival is None:
            last = landed(now, self._rates(now))[0]
        return Approach(arcs, last, arrival)

    def _arrival(self, now: SlipEndState, longest: float, tolerance: float) -> CollocatedEnd | None:
        """Return the end of slip by collocation, if its direction has come to rest and nothing else
        happens.
        """
        mode = self.contact_mode
        if not (self.component.slip and mode.is_single):
            return None
        onset = onset_motion(mode.without_tops(), (mode.top.kind,), self.components)
        arrival = collocated_end(now, self._rates(now), onset, mode.parameters, tolerance)
        if arrival is None or now.time + arrival.time_left > longest:
            return None
        probes = [probe / PROBES_OF_SLIP_END for probe in range(PROBES_OF_SLIP_END + 1)]
        rows = arrival.rows([*probes, ALMOST])
        if passes_flat(self.top, rows[:-1]):
            return None
        clocks = list[Row]()
        for later in rows[1:]:
            xi = tuple(later[mode.count :])
            unit = scaled(1.0 / size(xi), xi)
            clocks.append((*later[: mode.count], *unit, size(xi), now.time))
        motion = self.motion
        values = guard_values(motion, (*mode.parameters, longest, 0.0), clocks)
        for guard, along in zip(motion.guards, values, strict=True):
            holds = all(value > 0.0 and math.isfinite(value) for value in along)
            if guard.name not in CLOCK_GUARDS and not holds:
                return None
        return arrival

    def _in_time(self, arcs: Sequence[Arc], onwards: DenseSolution) -> DenseSolution:
        """Return the numbers of the mode as polynomials in time: from the clock's, and onwards."""
        until = onwards.knots[0]
        parts = [arc.solution for arc in arcs if len(arc.solution.terms)]
        if not parts:
            return onwards
        clocked, elapsed = DenseSolution.joined(parts), parts[0].size - 1

        def numbers(times: Array) -> tuple[Scalar, ...]:
            return self._moment(self.state_in_clock(clocked.rows(clocked.when(elapsed, times))))

        knots = clocked.knots_of(elapsed, until)
        jams = arcs[-1].guard == JAMMED
        solution = DenseSolution.fitted(numbers, graded(knots) if jams else thinned(knots), DEGREE)
        if solution.unresolved > RESOLVED and not jams:
            solution = DenseSolution.fitted(numbers, knots, DEGREE)
        return DenseSolution.joined([solution, onwards]) if onwards.end > until else solution


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


def clock_at(end: ModeEnd) -> tuple[float, ...]:
    """Return the numbers with which a clock begins anew where it has ended: its time is zero."""
    return (*end.numbers[:-1], 0.0)


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
