"""Slip ends, the contact sticks, and slip begins again: the modes of friction that is set-valued."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import ClassVar

import numpy as np

from tippetop.contact.mode import (
    Event,
    EventKind,
    IntegratedMode,
    Mode,
    Outcome,
    Reaction,
    Segment,
    Transition,
)
from tippetop.contact.sliding import LIFT_OFF, Sliding
from tippetop.contact.surfaces import follow_surface, number_of, stays_open, surface_guards
from tippetop.integrators import make_integrator
from tippetop.integrators.base import Arc, Array, Guard, Integrator, Motion
from tippetop.integrators.dense import DenseSolution, evaluated
from tippetop.mechanics.motion import axis_rate, on_table
from tippetop.mechanics.rolling import (
    ContactPoint,
    contact_wrench,
    on_branch,
    slip_dimension,
    velocity_without_slip,
)
from tippetop.mechanics.slip_onset import onset
from tippetop.mechanics.state import SlidingState, State
from tippetop.mechanics.stick_slip import (
    HORIZON,
    LANDING,
    Closing,
    closing_rates,
    creep_rates,
    direction_of_slip,
    landed,
    landing_guard,
    reopening_guard,
    scaled,
    size,
    slip_guard,
    slip_of,
    velocity_of,
)
from tippetop.mechanics.top import Kind, Top
from tippetop.mechanics.vectors import Row, Scalar, Vector, dot

SLIP, REOPENING, LANDED, TIME = "slip", "reopening", "landed", "time"

LONGEST = 100.0
"""More of the clock -ln s than lies between any two speeds."""

STIFF_TOLERANCE = 1e-12
"""Relative error per step of the implicit method that takes over where slip ends in many steps."""

SETTLED = 1e-14
"""Error of the instant at which slip ends, in natural units, that counts as none."""

ORDER, ACCURACY = 12, 1e-13
"""Degree of the series with which slip begins, and the size of its last terms relative to the first."""

LOOKS = 17
"""Looks along that series at whether another surface touches: then a mode with a guard takes over sooner."""

NEWTON = 6
"""Improvements of a time of the clock."""

SHORTEST, DEGREE = 1e-8, 14
"""The last of the steps that stand for the end of slip in a solution, relatively, and their degree."""


@dataclass(frozen=True)
class Sticking(IntegratedMode):
    """Rolling without slipping, and without drilling where the law resists that."""

    name: ClassVar[str] = "sticking"

    @property
    def motion(self) -> Motion:
        """Equations of motion of axis and angular momentum, and the guard of the limit surface."""
        return sticking_motion(self.top.kind)

    def numbers(self, state: State) -> tuple[Scalar, ...]:
        """Axis and angular momentum."""
        return (*state.axis, *state.momentum)

    def state(self, y: Row) -> State:
        """The state, whose velocity is that of rolling."""
        axis, momentum = split(y)
        velocity = velocity_without_slip(axis, momentum, self.top)
        return on_table(SlidingState(axis, momentum, velocity), self.top)

    def reaction(self, y: Row) -> Reaction:
        """The contact force and torque that hold the contact point."""
        point = ContactPoint.of(*split(y), self.top)
        wrench = contact_wrench(point, None, point.turning[:2])
        return Reaction(wrench.force, wrench.torque, dot(wrench.torque, point.turning))

    def follow(self, guard: str, time: float, state: State) -> Transition:
        """Slip begins, if it is not a surface that touches."""
        found = follow_surface(self, guard, time, state)
        if found is not None:
            return found
        events = (Event(EventKind.SLIP, time, surface=number_of(self.top)),)
        if self.reaction(self.numbers(state)).force[2] <= 0.0 and not self.rules.pulls:
            return self.rules.lift_off(time, state)
        return Transition(events, SlipOnset(self.top, self.rules, 2), state)


@dataclass(frozen=True)
class SlipOnset(Mode):
    """The first moments of slip, as a power series in time.

    Attributes
    ----------
    power
        How slip grows with time: 2 from the limit of sticking, 1 from beyond it.
    """

    power: int = 1

    name: ClassVar[str] = "sliding"

    def state(self, y: Row) -> State:
        """As in sliding."""
        return Sliding(self.top, self.rules).state(y)

    def segments(self, time: float, state: State, end: float, integrator: Integrator) -> Iterator[Segment]:
        """Evaluate the series, which need no integrator."""
        try:
            direction, _ = direction_of_slip(state.axis, state.momentum, self.top)
            top = on_branch(self.top, direction)
            begin = onset((state.axis, state.momentum, direction), self.power, top, ORDER)
        except ArithmeticError as error:
            nothing = DenseSolution(np.array([time]), np.empty((0, 8, 1)))
            yield Segment(
                Sliding(self.top, self.rules),
                nothing,
                state,
                Transition((), Outcome.FAILED, state, str(error)),
            )
            return
        duration = min(begin.valid_until(ACCURACY), end - time)

        def numbers(elapsed: Array) -> Array:
            axis, momentum, slip = begin.at(elapsed)
            rows = (*axis, *momentum, *velocity_of(axis, momentum, slip, self.top))
            return np.stack(np.broadcast_arrays(*rows), axis=-1)

        while duration > SETTLED and not stays_open(
            self.top, numbers(np.linspace(0.0, duration, LOOKS)[1:]).T
        ):
            duration *= 0.5
        solution = DenseSolution.fitted(numbers, np.array([0.0, duration]), DEGREE)
        knots = np.array([time, min(time + duration, end)])
        last = self.state(numbers(np.array([duration]))[0].tolist())
        sliding = Sliding(top, self.rules)
        then = Outcome.COMPLETED if knots[-1] >= end else sliding
        yield Segment(
            sliding, DenseSolution(knots, solution.terms), last, Transition((), then, last), steps=1
        )


@dataclass(frozen=True)
class SlipEnd(Mode):
    """The last moments of slip, followed in the clock -ln s (see `tippetop.mechanics.stick_slip`)."""

    name: ClassVar[str] = "sliding"

    def state(self, y: Row) -> State:
        """As in sliding."""
        return self._sliding.state(y)

    @property
    def _sliding(self) -> Sliding:
        return Sliding(self.top, self.rules)

    def segments(self, time: float, state: State, end: float, integrator: Integrator) -> Iterator[Segment]:
        """Follow the slip to its end, or to where it is no longer about to end."""
        slip = slip_of(state.axis, state.momentum, state.velocity[:2], self.top)
        speed = size(slip)
        begin = np.array([*state.axis, *state.momentum, *scaled(1.0 / speed, slip), speed, 0.0])
        motion, steps = closing_motion(self.top.kind, not self.rules.pulls), 0
        for horizon in LANDING:
            parameters = (*self.top.numbers, end - time, horizon)
            arcs = _followed(integrator, motion, parameters, begin)
            steps += sum(arc.steps for arc in arcs)
            here = closing_of(arcs[-1].end_state.tolist())
            rest, doubt = landed(here, self.top)
            if arcs[-1].guard != LANDED or doubt < SETTLED:
                break
        if arcs[-1].guard == LANDED:
            here = rest
        velocity = velocity_of(here.axis, here.momentum, scaled(here.speed, here.direction), self.top)
        last = on_table(SlidingState(here.axis, here.momentum, velocity), self.top)
        clock = DenseSolution.joined([arc.solution for arc in arcs])
        solution = self._in_time(clock, time, float(here.time))
        yield Segment(self._sliding, solution, last, self._next(arcs[-1], solution.end, last), steps, steps)

    def _next(self, arc: Arc, time: float, state: State) -> Transition:
        if arc.failure is not None or arc.guard is None:
            return Transition((), Outcome.FAILED, state, arc.failure or "the slip neither ends nor goes on")
        if arc.guard == TIME:
            return Transition((), Outcome.COMPLETED, state)
        if arc.guard == LIFT_OFF:
            return self.rules.lift_off(time, state)
        if arc.guard == REOPENING:
            return Transition((), self.rules.sliding(state), state)
        found = follow_surface(self, arc.guard, time, state)
        if found is not None:
            return found
        return self.rules.without_slip(time, state)

    def _in_time(self, clock: DenseSolution, time: float, duration: float) -> DenseSolution:
        """The numbers of sliding as polynomials in time, from their solution in the clock."""
        elapsed, sizes = clock.terms.shape[1] - 1, clock.terms.shape[1] - 8
        shown = clock.terms[:, elapsed, 0]
        knots = np.append(shown[shown < duration * (1.0 - SHORTEST)], duration)

        def numbers(times: Array) -> Array:
            y = clock(clock_at(clock, elapsed, times))
            n, L = tuple(y[:, :3].T), tuple(y[:, 3:6].T)
            slip = tuple((y[:, 6 : 6 + sizes] * y[:, [6 + sizes]]).T)
            return np.stack((*n, *L, *velocity_of(n, L, slip, self.top)), axis=-1)

        return DenseSolution(time + knots, DenseSolution.fitted(numbers, knots, DEGREE).terms)


def _followed(integrator: Integrator, motion: Motion, parameters: Sequence[float], begin: Array) -> list[Arc]:
    """The end of slip in its clock.

    On a small patch the direction of slip follows the friction much faster than slip ends: where that takes
    more steps than there are in an arc, an implicit method takes them instead.
    """
    first = next(iter(integrator.integrate(motion, parameters, (0.0, begin), LONGEST)))
    if first.guard is not None or first.failure is not None or first.solution.end >= LONGEST:
        return [first]
    implicit = make_integrator("radau", STIFF_TOLERANCE)
    return list(implicit.integrate(motion, parameters, (0.0, begin), LONGEST))


@lru_cache
def sticking_motion(kind: Kind) -> Motion:
    """Equations of motion of a sticking top of this kind."""

    def rates(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> tuple[Scalar, ...]:
        axis, momentum = split(y)
        point = ContactPoint.of(axis, momentum, kind.top(tuple(numbers)))
        moment = point.moment(contact_wrench(point, None, point.turning[:2]))
        return (*axis_rate(axis, momentum, point.top), *moment)

    def reserve(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> Scalar:
        return slip_guard(*split(y), kind.top(tuple(numbers)))

    guards = (Guard(SLIP, reserve), *surface_guards(kind))
    return Motion(rates, size=6, parameters=kind.numbers, guards=guards, lasting=False)


@lru_cache
def closing_motion(kind: Kind, guarded: bool) -> Motion:
    """Equations of motion in the clock -ln s of a top whose slip is about to end; time is the last number.

    The last parameters are when the run ends, and how long before its end slip is left to `landed`.
    """

    def top_of(numbers: Sequence[Scalar]) -> Top:
        return kind.top(tuple(numbers[: kind.numbers]))

    def rates(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> tuple[Scalar, ...]:
        rate = closing_rates(closing_of(y), top_of(numbers))
        return (*rate.axis, *rate.momentum, *rate.direction, rate.speed, rate.time)

    def normal(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> Scalar:
        state = closing_of(y)
        return creep_rates(state.axis, state.momentum, state.direction, top_of(numbers)).wrench.force[2]

    guards = [
        Guard(REOPENING, lambda y, numbers: reopening_guard(closing_of(y), top_of(numbers), HORIZON)),
        Guard(LANDED, lambda y, numbers: landing_guard(closing_of(y), top_of(numbers), numbers[-1])),
        Guard(TIME, lambda y, numbers: numbers[-2] - y[len(y) - 1]),
    ]
    if guarded:
        guards.append(Guard(LIFT_OFF, normal))
    guards += surface_guards(kind)
    return Motion(
        rates, 8 + slip_dimension(kind.example.friction), kind.numbers + 2, tuple(guards), lasting=False
    )


def closing_of(y: Row) -> Closing:
    """The state of slip that is about to end, from its numbers."""
    count = len(y)
    return Closing(*split(y), tuple(y[6 : count - 2]), y[count - 2], y[count - 1])


def split(y: Row) -> tuple[Vector, Vector]:
    """Axis and angular momentum, the first numbers of every mode in contact."""
    return (y[0], y[1], y[2]), (y[3], y[4], y[5])


def clock_at(clock: DenseSolution, elapsed: int, times: Array) -> Array:
    """When the clock shows some times, its component of number `elapsed`, by Newton's method, shape (m,)."""
    shown = np.append(clock.terms[:, elapsed, 0], clock(clock.knots[-1:])[0, elapsed])
    guess = np.interp(times, shown, clock.knots)
    slopes = clock.terms[:, [elapsed], 1:] * np.arange(1, clock.terms.shape[2])
    for _ in range(NEWTON):
        step = np.minimum(np.searchsorted(clock.knots[1:], guess, side="left"), len(clock.terms) - 1)
        span = clock.knots[step + 1] - clock.knots[step]
        here = (guess - clock.knots[step]) / span
        error = times - evaluated(clock.terms[:, [elapsed]], step, here)[:, 0]
        pace = evaluated(slopes, step, here)[:, 0] / span
        guess = np.clip(guess + error / pace, clock.knots[0], clock.knots[-1])
    return guess
