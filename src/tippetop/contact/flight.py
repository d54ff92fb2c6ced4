"""Free flight: the mode without closed contacts, its equations of motion and its guards."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from enum import IntEnum
from functools import lru_cache
from typing import Any, ClassVar

from tippetop.contact.mode import IntegratedMode, ModeEnd, Segment, numbered
from tippetop.integrators.base import Arc, Guard, Integrator, Motion
from tippetop.integrators.dense import DenseSolution, as_array
from tippetop.integrators.opening import opening
from tippetop.mechanics.flight.free_motion import free_rates, gap, gap_rate
from tippetop.mechanics.state import State
from tippetop.mechanics.surfaces.hull import acting, each_surface, is_edge
from tippetop.mechanics.surfaces.surface import Surface, gap_guard, support_at
from tippetop.mechanics.top import Kind, Top
from tippetop.mechanics.vectors import Row, Scalar, length

LANDING = "landing"
"""Cause of the end of a flight on the table."""

TOUCHING = 1e-12
"""Gap, and gap rate, in natural units, up to which a surface touches, and neither opens nor closes.
"""

TURN = 0.5
"""Angle through which the axis turns in a step of a solution at most, rad: with Gauss's eight
points the quadrature of the marker's angle is exact to rounding then.
"""

MOST_PARTS = 63.0
"""Parts more than one of a step at most: a step of more turns does not follow the axis at all."""

SIZE = 10
"""How many numbers the state of a flight has."""


class Start(IntEnum):
    """How a flight starts: how many of gap, gap rate and gap acceleration are then zero."""

    AIRBORNE = 0
    REBOUND = 1
    RELEASE = 2
    LIFT_OFF = 3


@dataclass(frozen=True)
class Flight(IntegratedMode):
    """Free flight, until a surface touches the table."""

    start: Start = Start.AIRBORNE
    """How the flight starts for the active surface: thrown, rebounding, released or lifting off."""

    name: ClassVar[str] = "flight"
    touching: ClassVar[bool] = False

    @property
    def lasting(self) -> bool:
        """Whether what is read off its numbers is worth compiling: it is quick without."""
        return False

    @property
    def motion(self) -> Motion:
        """Equations of motion and guards, which are the same whichever surface is active."""
        return flight_motion(self.top.body.contacts[0].kind)

    @property
    def parameters(self) -> tuple[Scalar, ...]:
        """The numbers of the body: no branch of the law matters."""
        return self.top.body.numbers

    def numbers(self, state: State) -> tuple[Scalar, ...]:
        """Return the numbers of the state."""
        return state.pack()

    def state(self, y: Row) -> State:
        """Return the state, whose numbers are those of a flight."""
        return State.unpack(y)

    def vanishing(self, state: State) -> tuple[int, ...] | None:
        """Return how many Taylor coefficients of each guard vanish at the start of the flight.

        None where every surface is above the table.
        """
        if all(gap(state, top) > TOUCHING for top in self.top.body.contacts):
            return None
        level, counts = is_level(state), list[int]()
        for top in self.top.body.contacts:
            start = self.start if top.number == self.top.number else start_of(state, top)
            if not is_edge(top.surface) or level:
                counts.append(int(start))
            elif gap(state, top) <= TOUCHING and lies_on_face(state, top):
                # The other factor of the product vanishes, too, as the gap of the face, with t.
                counts += [int(start) + 1, 1]
            else:
                # The product that is an edge's gap guard vanishes as the gap does, its face's gap
                # does not.
                counts += [int(start), 0]
        return tuple(counts)

    def segments(
        self, time: float, state: State, end: float, integrator: Integrator
    ) -> Iterator[Segment]:
        """Integrate the equations of motion, the first step with guards that vanish at the start.

        See `tippetop.integrators.opening`.
        """
        vanishing = self.vanishing(state)
        motion = flight_motion(self.top.body.contacts[0].kind, level=is_level(state))
        if vanishing is not None:
            begin = time, as_array(self.numbers(state))
            arc = opening(motion, self.parameters, begin, end, vanishing)
            segment = self.segment(arc, end)
            yield segment
            if segment.mode_end is not None:
                return
            time, state = segment.end_time, segment.end_state
        begin = time, as_array(self.numbers(state))
        for arc in integrator.integrate(motion, self.parameters, begin, end):
            yield self.segment(arc, end)

    def solution_of(self, arc: Arc) -> DenseSolution:
        """Return the solution of an arc, in steps in which the axis turns by at most `TURN`.

        The marker's angle is a quadrature over each, whose rate is singular at the farther pole:
        longer ones would come near that.
        """
        knots, y = arc.solution.knots, arc.end_state
        longest = max([knots[i + 1] - knots[i] for i in range(len(knots) - 1)], default=0.0)
        rate = length((y[3], y[4], y[5])) / self.top.transverse_inertia
        return arc.solution.subdivided(1 + int(min(longest * rate / TURN, MOST_PARTS)))

    def end_by_guard(self, name: str, last: State) -> ModeEnd:
        """Return the end of the flight on a surface, which touches the table exactly."""
        ended = ModeEnd.by_guard(name, last)
        landed = self.top.body.contacts[ended.contact]
        height = support_at(last.axis, landed.surface)[0]
        return replace(ended, state=last._replace(height=height))


def is_level(state: State) -> bool:
    """Return whether the axis is vertical and stays so: the body turns about it alone."""
    x, y, _ = state.axis
    p, q, _ = state.momentum
    return not any((x, y, p, q))


def lies_on_face(state: State, top: Top) -> bool:
    """Return whether the axis is vertical above the face of the active edge, floats."""
    edge: Any = acting(top.surface)
    return bool(edge.lies_flat(state.axis))


@lru_cache
def flight_motion(kind: Kind, *, level: bool = False) -> Motion:
    """Return the equations of free motion of tops of a kind: of axis, angular momentum, velocity
    and height. Every surface has a guard, its gap.

    Where the axis stays `level`, the gap of an edge is that of its face, of which its own guard is
    the square: that falls to rounding long before it is zero.
    """

    def rates(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> tuple[Scalar, ...]:
        return free_rates(State.unpack(y), kind.top(tuple(numbers))).pack()

    def guard(number: int, value: Callable[[Surface, State], Scalar]) -> Guard:
        def of_surface(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> Scalar:
            surface = each_surface(kind.top(tuple(numbers)).surface)[number]
            return value(surface, State.unpack(y))

        return Guard(numbered(LANDING, number), of_surface)

    guards = list[Guard]()
    for number, surface in enumerate(each_surface(kind.example.surface)):
        if not (is_edge(surface) and level):
            guards.append(guard(number, surface_gap))
        if is_edge(surface):
            guards.append(guard(number, face_gap))
    return Motion(rates, SIZE, kind.numbers, tuple(guards))


def surface_gap(surface: Surface, state: State) -> Scalar:
    """Return what falls through zero as the gap of a surface does."""
    return gap_guard(state.axis, state.height, 0.0, surface)


def face_gap(surface: Any, state: State) -> Scalar:
    """Return what falls through zero where a body falls flat on the face of an edge."""
    return surface.face_gap(state.axis, state.height)


def start_of(state: State, top: Top) -> Start:
    """Return how a flight starts for a surface: open, or just opened."""
    rate = gap_rate(state, top)
    if gap(state, top) > TOUCHING or rate < -TOUCHING:
        return Start.AIRBORNE
    return Start.REBOUND if rate > TOUCHING else Start.RELEASE
