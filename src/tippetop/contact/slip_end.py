"""The last moments of slip, or of rolling, under friction that is set-valued."""

from collections.abc import Iterator
from dataclasses import dataclass

from tippetop.contact.collocated_end import CollocatedEnd, collocated_end
from tippetop.contact.mode import Segment
from tippetop.contact.slip_clock import EndClock, follow_clock, segment_of
from tippetop.contact.slip_end_motion import CLOCK_GUARDS, slip_end_motion, slip_end_state
from tippetop.contact.surfaces import passes_flat
from tippetop.contact.transient import PROBES_OF_SLIP_END, TransientMode, pack_moment, straight
from tippetop.integrators.base import Integrator, Motion
from tippetop.mechanics.contacts.forces import slip_length
from tippetop.mechanics.contacts.slip_end import SlipEndState, rates_in_time
from tippetop.mechanics.contacts.slip_variables import scaled, size
from tippetop.mechanics.state import State

ALMOST = 1e-6
"""Part of the time to the end that is left at the last look at what else may happen: slip has a
direction.
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
        return slip_end_motion(self.top.kind, self.component, not self.pulls)

    def segments(
        self, time: float, state: State, end: float, integrator: Integrator
    ) -> Iterator[Segment]:
        """Follow it to its end, or to where it is no longer about to end."""
        begin, longest = self.begin or self._clock(state), end - time
        tolerance = getattr(integrator, "tolerance", 0.0)
        clock = EndClock(
            self.motion,
            self.top.numbers,
            self.top,
            lambda y: slip_end_state(y, self.component),
            lambda now: rates_in_time(now, self.component, self.top),
            pack_moment,
            lambda now: self._arrival(now, longest, tolerance),
            slip_length(self.top.friction) is not None,
        )
        approach = follow_clock(clock, begin, longest, integrator)
        arcs, moment, arrival = approach
        now = clock.unpack(arcs[-1].end_state.tolist() if arcs else begin)
        until = float(now.time)
        if arrival is None:
            last, onwards = (
                self.state(pack_moment(moment)),
                straight(pack_moment(now), pack_moment(moment), until, moment.time),
            )
        else:
            last, onwards = self.state(arrival.at(0.0)), arrival.solution(until)
        yield segment_of(self, clock, approach, last, onwards, time)

    def _arrival(self, now: SlipEndState, longest: float, tolerance: float) -> CollocatedEnd | None:
        """Return the end of slip by collocation, if its direction has come to rest and nothing else
        happens.
        """
        if not self.component.slip:
            return None
        arrival = collocated_end(now, self.component, self.top, tolerance)
        if arrival is None or now.time + arrival.time_left > longest:
            return None
        numbers = (*self.top.numbers, longest, 0.0)
        for probe in range(PROBES_OF_SLIP_END + 1):
            later = arrival.at(probe / PROBES_OF_SLIP_END or ALMOST)
            xi = tuple(later[6:])
            clock = (*later[:6], *scaled(1.0 / size(xi), xi), size(xi), now.time)
            if not all(
                one.value(clock, numbers) > 0.0
                for one in self.motion.guards
                if one.name not in CLOCK_GUARDS
            ):
                return None
        rows = [arrival.at(probe / PROBES_OF_SLIP_END) for probe in range(PROBES_OF_SLIP_END + 1)]
        return None if passes_flat(self.top, rows) else arrival

    def _clock(self, state: State) -> tuple[float, ...]:
        """Return the numbers of the clock at a state."""
        velocity = state.velocity[:2]
        xi = self.component.of(state.axis, state.momentum, velocity, self.top)
        free = velocity if self.component.moves else ()
        return (*state.axis, *state.momentum, *free, *scaled(1.0 / size(xi), xi), size(xi), 0.0)
