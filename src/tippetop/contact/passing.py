"""The moments in which slip, or rolling, ends or begins, under friction that is set-valued."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import ClassVar

from tippetop.contact.arriving import Arrival, arriving
from tippetop.contact.closed import ClosedMode, split
from tippetop.contact.closing import LANDED, closing_motion, closing_of, followed
from tippetop.contact.mode import EventKind, IntegratedMode, Mode, Outcome, Reaction, Segment, Transition
from tippetop.contact.sliding import Sliding, SlidingWithoutRolling
from tippetop.contact.sticking import Sticking
from tippetop.contact.surfaces import follow_surface, stays_open
from tippetop.integrators.base import Arc, Array, Integrator
from tippetop.integrators.dense import DenseSolution, as_array
from tippetop.mechanics.ending import (
    Closing,
    Vanishing,
    landed,
    landing_guard,
    rates_in_time,
    slip_beside,
)
from tippetop.mechanics.hull import Hull
from tippetop.mechanics.motion import angular_velocity, on_table
from tippetop.mechanics.rolling import (
    Slip,
    on_other_branch,
    slip_length,
    velocity_without_slip,
    without_rolling,
)
from tippetop.mechanics.state import SlidingState, State
from tippetop.mechanics.stick_slip import (
    branch_guard,
    scaled,
    size,
    velocity_of,
)
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Row, Scalar, Vector, dot

LANDING = (3e-8, 1e-16)
"""How long before its end the rest of a velocity may be taken in one step, in natural units of time: if its
direction has come to rest by then, and in any case."""

SETTLED = 1e-14
"""Error of the instant at which slip ends, in natural units, that counts as none."""

SLOWEST = 1e-12
"""A velocity, in natural units, that has ended where it cannot be followed further."""

LOOKS = 16
"""Looks along a moment at whether another surface touches, or the table would have to pull: else a mode with
a guard takes over sooner."""

SHORT = 1e-14
"""How long a top at rest is followed, in natural units of time or relative to the time."""

DEGREE = 14
"""Degree of the polynomials that stand for the last moments in a solution."""

SHARE = 0.01
"""Part of the time to the end that such a polynomial leaves: what follows its friction ends smoothly."""

RESOLVED = 1e-15
"""Last term of these polynomials, in natural units, that is small: else they are made for shorter times."""


@dataclass(frozen=True)
class Passing(Mode):
    """A moment between two modes, which is told as the one of them in which something moves."""

    ending: Vanishing
    """Which velocity ends or begins, and whether the other is held."""

    name: ClassVar[str] = "passing"

    @property
    def told(self) -> ClosedMode:
        """The mode as which it is told."""
        if self.ending.slip:
            return (SlidingWithoutRolling if self.ending.held else Sliding)(self.top, self.rules)
        return (Sticking if self.ending.held else Sliding)(self.top, self.rules)

    @property
    def label(self) -> str:
        """The name of the mode as which it is told."""
        return self.told.label

    @property
    def form(self) -> str:
        """What ends or begins decides how its numbers are read."""
        return f"{self.name}: slip {self.ending.slip}, held {self.ending.held}"

    def state(self, y: Row) -> State:
        """The state from axis, momentum, velocity where it is free, and what ends or begins."""
        axis, momentum, velocity, xi = self._parts(y)
        if self.ending.slip:
            velocity = velocity_of(axis, momentum, xi, self.top)
            momentum = without_rolling(axis, momentum, self.top) if self.ending.held else momentum
        elif self.ending.held:
            velocity = velocity_without_slip(axis, momentum, self.top)
        return on_table(SlidingState(axis, momentum, (velocity[0], velocity[1])), self.top)

    def reaction(self, y: Row) -> Reaction:
        """The contact force and torque, from what ends or begins itself: a state has but few digits of it."""
        axis, momentum, velocity, xi = self._parts(y)
        here = Closing(axis, momentum, velocity, xi, 0.0, 0.0)
        force, torque = rates_in_time(here, self.ending, self.top).wrench
        power = dot(torque, angular_velocity(axis, momentum, self.top))
        slip = xi if self.ending.slip else slip_beside(here, self.ending, self.top)
        if slip is not None:
            power = power + (force[0] * slip[0] + force[1] * slip[1])
        return Reaction(force, torque, power)

    def goes_on(self, at: Callable[[int], Row], pressed: Sequence[int]) -> bool:
        """Whether no other surface touches at any look, and at some the table does not pull that may not."""
        looks = range(1, LOOKS + 1)
        if isinstance(self.top.surface, Hull) and not all(stays_open(self.top, at(look)) for look in looks):
            return False
        return self.rules.pulls or all(self.reaction(at(look)).force[2] > 0.0 for look in pressed)

    def _parts(self, y: Row) -> tuple[Vector, Vector, Slip, Slip]:
        free = 8 if self.ending.moves else 6
        return *split(y), tuple(y[6:free]), tuple(y[free:])


@dataclass(frozen=True)
class Resting(Mode):
    """Every velocity has ended: an instant, so that a result has it, and then the run is over."""

    told: IntegratedMode
    """The mode as which it is told."""

    name: ClassVar[str] = "resting"

    def state(self, y: Row) -> State:
        """As in the mode as which it is told."""
        return self.told.state(y)

    def segments(self, time: float, state: State, end: float, integrator: Integrator) -> Iterator[Segment]:
        """Stay as it is."""
        numbers = self.told.numbers(state)
        still = straight(numbers, numbers, time, time + SHORT * max(1.0, time))
        yield Segment(self.told, still, state, Transition((), Outcome.AT_REST, state))


@dataclass(frozen=True)
class Stopping(Passing):
    """The last moments of slip, or of rolling, in a clock of their own (see `tippetop.mechanics.ending`)."""

    begin: tuple[float, ...] = ()
    """The numbers of the clock where another branch of the law has left off; else they are the state's."""

    def segments(self, time: float, state: State, end: float, integrator: Integrator) -> Iterator[Segment]:
        """Follow it to its end, or to where it is no longer about to end."""
        ending, begin = self.ending, self.begin or self._clock(state)
        arrival = self._arrival(closing_of(begin, ending), end - time, integrator)
        if arrival is not None:
            solution = DenseSolution.in_time([0.0, arrival.left], [arrival.onwards])
            last = self.state(arrival.at(0.0))
            then = self._next(None, time + arrival.left, last)
            yield Segment(self, solution.moved(time, time + arrival.left), last, then, steps=1)
            return
        here, steps, arc, parts = closing_of(begin, ending), 0, None, list[DenseSolution]()
        rest, method = here, None
        start = 0.0, as_array(begin)
        motion = closing_motion(self.top.kind, ending, not self.rules.pulls)
        for horizon in LANDING:
            if landing_guard(here, ending, self.top, horizon) <= 0.0:
                continue
            arcs = followed(integrator, motion, (*self.top.numbers, end - time, horizon), start)
            steps += sum(arc.steps for arc in arcs)
            method = arcs[-1].method or method
            arc, parts = arcs[-1], [*parts, *(arc.solution for arc in arcs if len(arc.solution.terms))]
            start = arc.solution.end, arc.end_state
            here = closing_of(arc.end_state.tolist(), ending)
            if arc.guard != LANDED:
                break
            rest, doubt = landed(here, ending, self.top)
            if doubt < SETTLED:
                break
        before = here
        if arc is not None and arc.failure is not None and here.speed < SLOWEST:
            # It passes zero by so little that no step is short enough to see it turn round.
            here, arc = here._replace(speed=0.0), None
        elif arc is None:
            here = landed(here, ending, self.top)[0]
        elif arc.guard == LANDED:
            here = rest
        last = self.state(shown(here))
        solution = self._in_time(parts, begin, time, before, here)
        then = self._next(arc, solution.end, last)
        yield Segment(self, solution, last, then, steps, steps, method=method)

    def _arrival(self, here: Closing, longest: float, integrator: Integrator) -> Arrival | None:
        """The end of slip by power series, if its direction has come to rest and nothing else happens."""
        law = self.top.friction
        if not self.ending.slip or self.top.resists_rolling or slip_length(law) is None:
            return None
        found = arriving(here, self.ending, self.top, integrator)
        if found is None or found.left > longest:
            return None
        arrival, looks = found, range(1, LOOKS + 1)
        if not self.goes_on(lambda look: arrival.at(look / LOOKS), looks):
            return None
        if hasattr(law, "branch_guard"):
            ways = [tuple(found.at(look / LOOKS)[6:]) for look in looks]
            if not all(branch_guard(way, self.top) > 0.0 for way in ways):
                return None
        return found

    def _clock(self, state: State) -> tuple[float, ...]:
        """The numbers of the clock at a state."""
        velocity = state.velocity[:2]
        xi = self.ending.of(state.axis, state.momentum, velocity, self.top)
        free = velocity if self.ending.moves else ()
        return (*state.axis, *state.momentum, *free, *scaled(1.0 / size(xi), xi), size(xi), 0.0)

    def _next(self, arc: Arc | None, time: float, state: State) -> Transition:
        ending, stuck = self.ending, not self.ending.slip and self.ending.held
        if arc is None or arc.guard == LANDED:
            return self.rules.settled(time, state, new=(ending.slip, not ending.slip), held=ending.held)
        if arc.failure is not None or arc.guard is None:
            return Transition((), Outcome.FAILED, state, arc.failure or "the slip neither ends nor goes on")
        found = follow_surface(self, arc.guard, time, state)
        if found is not None:
            return found
        if arc.guard == "time":
            return Transition((), Outcome.COMPLETED, state)
        if arc.guard == "lift-off":
            return self.rules.lift_off(time, state)
        if arc.guard == "reopening":
            return Transition((), self.rules.going_on(state, slips=not stuck), state)
        if arc.guard == "overtaken":
            return Transition((), replace(self, ending=Vanishing(not ending.slip), begin=()), state)
        if arc.guard in ("branch", "limit branch"):
            return Transition((), self._onwards(arc, on_other_branch(self.top)), state)
        if arc.guard in ("slip", "rolling"):
            slip = arc.guard == "slip"
            event = self.rules.event(EventKind.SLIP if slip else EventKind.ROLL, time)
            return self.rules.giving_way(state, (event,), Vanishing(slip=slip))
        raise AssertionError(f"nothing is said of what follows {arc.guard}")

    def _onwards(self, arc: Arc, top: Top) -> "Stopping":
        """The mode that takes the clock up where an arc leaves it, on another branch of the law."""
        return replace(self, top=top, begin=(*arc.end_state.tolist()[:-1], 0.0))

    def _in_time(
        self, parts: Sequence[DenseSolution], begin: Row, time: float, before: Closing, after: Closing
    ) -> DenseSolution:
        """The numbers of the mode as polynomials in time, from their solution in the clock.

        It goes on in a straight line from the end of the clock (before) to where the velocity ends (after).
        """
        if not parts:
            still = shown(closing_of(begin, self.ending))
            return straight(still, still, time, time + float(after.time))
        clock, elapsed = DenseSolution.joined(parts), len(begin) - 1

        def numbers(times: Array) -> tuple[Scalar, ...]:
            return shown(closing_of(clock.rows(clock.when(elapsed, times)), self.ending))

        knots = clock.knots_of(elapsed, float(before.time))
        solution = DenseSolution.fitted(numbers, thinned(knots), DEGREE)
        if solution.unresolved > RESOLVED:
            solution = DenseSolution.fitted(numbers, knots, DEGREE)
        reach = float(after.time)
        if reach > knots[-1]:
            rest = straight(shown(before), shown(after), knots[-1], reach)
            solution = DenseSolution.joined([solution, rest])
        return solution.moved(time, time + reach)


def straight(begin: Sequence[float], last: Sequence[float], start: float, end: float) -> DenseSolution:
    """Numbers that go from some to others in a straight line."""
    terms = [(a, b - a, *[0.0] * (DEGREE - 1)) for a, b in zip(begin, last, strict=True)]
    return DenseSolution.in_time([0.0, 1.0], [terms]).moved(start, end)


def thinned(knots: Sequence[float]) -> list[float]:
    """Ends of steps, so few of them that each leaves but a share of the time to the last."""
    end, found = knots[-1], [knots[0]]
    for knot in knots[1:-1]:
        if end - knot <= SHARE * (end - found[-1]):
            found.append(knot)
    return [*found, end]


def shown(here: Closing) -> tuple[Scalar, ...]:
    """The numbers of a moment that passes: axis, momentum, velocity where it is free, and xi."""
    return (*here.axis, *here.momentum, *here.velocity, *scaled(here.speed, here.direction))
