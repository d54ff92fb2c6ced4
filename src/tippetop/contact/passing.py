"""The moments in which slip, or rolling, ends or begins, under friction that is set-valued."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import ClassVar

from tippetop.contact.arriving import Arrival, arriving
from tippetop.contact.closed import ClosedMode, split
from tippetop.contact.closing import FEW, LANDED, OWN, closing_motion, closing_of, followed
from tippetop.contact.mode import EventKind, IntegratedMode, Mode, Outcome, Reaction, Segment, Transition
from tippetop.contact.sliding import Sliding, SlidingWithoutRolling
from tippetop.contact.sticking import Sticking
from tippetop.contact.surfaces import follow_surface, passes_flat, stays_open
from tippetop.integrators.base import Arc, Array, Integrator, Motion
from tippetop.integrators.dense import DenseSolution, as_array
from tippetop.mechanics.branches import on_other_branch
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
from tippetop.mechanics.rolling import slip_length, velocity_without_slip, without_rolling
from tippetop.mechanics.state import SlidingState, State
from tippetop.mechanics.stick_slip import (
    scaled,
    size,
    velocity_of,
)
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Row, Scalar, Vector, dot
from tippetop.mechanics.wrench import Slip

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
        """Whether no other surface touches, nor a face, and the table does not pull that may not.

        Whether it pulls is told at some of the looks.
        """
        looks = range(1, LOOKS + 1)
        if isinstance(self.top.surface, Hull) and not all(stays_open(self.top, at(look)) for look in looks):
            return False
        if passes_flat(self.top, [at(look) for look in range(LOOKS + 1)]):
            return False
        return self.rules.pulls or all(self.reaction(at(look)).force[2] > 0.0 for look in pressed)

    @property
    def free(self) -> int:
        """How many numbers come before what ends or begins."""
        return 8 if self.ending.moves else 6

    def _parts(self, y: Row) -> tuple[Vector, Vector, Slip, Slip]:
        return *split(y), tuple(y[6 : self.free]), tuple(y[self.free :])


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

    @property
    def motion(self) -> Motion:
        """Its equations in the clock."""
        return closing_motion(self.top.kind, self.ending, not self.rules.pulls)

    def segments(self, time: float, state: State, end: float, integrator: Integrator) -> Iterator[Segment]:
        """Follow it to its end, or to where it is no longer about to end."""
        begin = self.begin or self._clock(state)
        arcs, rest, arrival = self._followed(begin, end - time, integrator)
        here = closing_of(arcs[-1].end_state.tolist() if arcs else begin, self.ending)
        arc, until = arcs[-1] if arcs and arrival is None else None, float(here.time)
        if arc is not None and arc.failure is not None and here.speed < SLOWEST:
            # It passes zero by so little that no step is short enough to see it turn round.
            rest, arc = here._replace(speed=0.0), None
        if arrival is None:
            last, onwards = self.state(shown(rest)), straight(shown(here), shown(rest), until, rest.time)
        else:
            last, onwards = self.state(arrival.at(0.0)), in_one_step(arrival.onwards, until, arrival.left)
        solution = self._in_time(arcs, until, onwards).moved(time, time + onwards.end)
        then, steps = self._next(arc, solution.end, last), sum(one.steps for one in arcs)
        steps += arrival is not None
        method = next((one.method for one in arcs[::-1] if one.method is not None), None)
        yield Segment(self, solution, last, then, steps, steps, method=method)

    def _followed(
        self, begin: Row, longest: float, integrator: Integrator
    ) -> tuple[list[Arc], Closing, Arrival | None]:
        """It in its clock; and where it ends after that, in one step, if not by power series."""
        here, start, arcs = closing_of(begin, self.ending), (0.0, as_array(begin)), list[Arc]()
        arrival, rest = self._arrival(here, longest, integrator), here
        for horizon in LANDING:
            if arrival is not None or landing_guard(here, self.ending, self.top, horizon) <= 0.0:
                continue
            for arc in followed(integrator, self.motion, (*self.top.numbers, longest, horizon), start):
                arcs.append(arc)
                start = arc.solution.end, arc.end_state
                here = closing_of(arc.end_state.tolist(), self.ending)
                if arc.guard is None and arc.failure is None and arc.steps >= FEW:
                    arrival = self._arrival(here, longest, integrator)
                if arrival is not None:
                    return arcs, here, arrival
            if arcs[-1].guard != LANDED:
                return arcs, here, None
            rest, doubt = landed(here, self.ending, self.top)
            if doubt < SETTLED:
                break
        return arcs, rest if arcs or arrival is not None else landed(here, self.ending, self.top)[0], arrival

    def _arrival(self, here: Closing, longest: float, integrator: Integrator) -> Arrival | None:
        """The end of slip by power series, if its direction has come to rest and nothing else happens."""
        if not self.ending.slip or slip_length(self.top.friction) is None:
            return None
        found = arriving(here, self.ending, self.top, integrator)
        if found is None or here.time + found.left > longest:
            return None
        numbers = (*self.top.numbers, longest, 0.0)
        for look in range(1, LOOKS + 1):
            then = found.at(look / LOOKS)
            xi = tuple(then[6:])
            clock = (*then[:6], *scaled(1.0 / size(xi), xi), size(xi), here.time)
            if not all(one.value(clock, numbers) > 0.0 for one in self.motion.guards if one.name not in OWN):
                return None
        way = [found.at(look / LOOKS) for look in range(LOOKS + 1)]
        return None if passes_flat(self.top, way) else found

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
        if arc.guard == "jammed":
            return self.rules.jammed(time, state)
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

    def _in_time(self, arcs: Sequence[Arc], until: float, rest: DenseSolution) -> DenseSolution:
        """The numbers of the mode as polynomials in time: up to some time from the clock's, and the rest."""
        parts = [arc.solution for arc in arcs if len(arc.solution.terms)]
        if not parts:
            return rest
        clock, elapsed = DenseSolution.joined(parts), parts[0].size - 1

        def numbers(times: Array) -> tuple[Scalar, ...]:
            return shown(closing_of(clock.rows(clock.when(elapsed, times)), self.ending))

        knots = clock.knots_of(elapsed, until)
        solution = DenseSolution.fitted(numbers, thinned(knots), DEGREE)
        if solution.unresolved > RESOLVED:
            solution = DenseSolution.fitted(numbers, knots, DEGREE)
        return DenseSolution.joined([solution, rest]) if rest.end > until else solution


def straight(begin: Sequence[float], last: Sequence[float], start: float, end: float) -> DenseSolution:
    """Numbers that go from some to others in a straight line."""
    rows = [[a, b - a] for a, b in zip(begin, last, strict=True)]
    return in_one_step(rows, 0.0, 1.0).moved(start, end)


def in_one_step(rows: Sequence[list[Scalar]], start: float, lasts: float) -> DenseSolution:
    """Numbers by coefficients in powers of the time since some time, for as long as that."""
    terms = [[*row, *[0.0] * (DEGREE + 1 - len(row))] for row in rows]
    return DenseSolution.in_time([0.0, lasts], [terms]).moved(start, start + lasts)


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
