"""The moments in which slip, or rolling, ends or begins, under friction that is set-valued."""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import ClassVar

from tippetop.contact.growth import growth
from tippetop.contact.mode import EventKind, IntegratedMode, Mode, Outcome, Reaction, Segment, Transition
from tippetop.contact.sliding import BRANCH, LIFT_OFF, ROLLING, Sliding, SlidingWithoutRolling
from tippetop.contact.sticking import LIMIT_BRANCH, SLIP, Sticking, split
from tippetop.contact.surfaces import follow_surface, stays_open, surface_guards
from tippetop.integrators import make_integrator
from tippetop.integrators.base import Arc, Array, Guard, Integrator, Motion
from tippetop.integrators.dense import DenseSolution, as_array
from tippetop.mechanics.beginning import beginning
from tippetop.mechanics.coulomb import RollingResistance
from tippetop.mechanics.ending import (
    Closing,
    Vanishing,
    closing_rates,
    landed,
    landing_guard,
    overtaking_guard,
    rates_in_time,
    reopening_guard,
    slip_beside,
)
from tippetop.mechanics.hull import Hull
from tippetop.mechanics.motion import angular_velocity, on_table
from tippetop.mechanics.rolling import (
    ContactPoint,
    Slip,
    has_limit_branches,
    is_set_valued,
    limit_guard,
    on_branch,
    on_other_branch,
    on_other_limit_branch,
    rolling_reserve,
    set_valued,
    sliding_law,
    slip_dimension,
    velocity_without_slip,
    without_rolling,
)
from tippetop.mechanics.series import horner
from tippetop.mechanics.slip_onset import onset
from tippetop.mechanics.state import SlidingState, State
from tippetop.mechanics.stick_slip import (
    HORIZON,
    scaled,
    size,
    slip_branch_guard,
    slip_of,
    velocity_of,
)
from tippetop.mechanics.top import Kind, Top
from tippetop.mechanics.vectors import Row, Scalar, Vector, dot

REOPENING, LANDED, TIME, OVERTAKEN = "reopening", "landed", "time", "overtaken"

LANDING = (3e-9, 1e-16)
"""How long before its end the rest of a velocity may be taken in one step, in natural units of time: if its
direction has come to rest by then, and in any case."""

LONGEST = 100.0
"""More of the clock -ln s than lies between any two speeds."""

STIFF_TOLERANCE = 1e-12
"""Relative error per step of the implicit method that takes over where slip ends in many steps."""

SETTLED = 1e-14
"""Error of the instant at which slip ends, in natural units, that counts as none."""

LOOKS = 16
"""Looks along a beginning at whether another surface touches: then a mode with a guard takes over sooner."""

ORDER, ACCURACY = 20, 1e-13
"""Degree of the series with which slip begins, and the size of its last terms relative to the first."""

INSTANT = 1e-9
"""How long slip and rolling that begin at once go on at their first rates, in natural units of time."""

PART = 0.25
"""Part of the time in which another velocity could end at its first rate that such a beginning lasts."""

SHORT = 1e-14
"""How long a top at rest is followed, in natural units of time or relative to the time."""

DEGREE = 14
"""Degree of the polynomials that stand for the last moments in a solution."""

TINY = 1e-100
"""What begins at zero, and has no direction there, in natural units: nothing, but for that."""


MOST_STEPS = 2048
"""Steps of the implicit method after which such an end is given up, within seconds; most take hundreds."""


@dataclass(frozen=True)
class Passing(Mode):
    """A moment between two modes, which is told as the one of them in which something moves.

    Attributes
    ----------
    ending
        Which velocity ends or begins, and whether the other is held.
    """

    ending: Vanishing

    name: ClassVar[str] = "passing"

    @property
    def told(self) -> Sliding | Sticking:
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

    def _parts(self, y: Row) -> tuple[Vector, Vector, Slip, Slip]:
        free = 8 if self.ending.moves else 6
        return *split(y), tuple(y[6:free]), tuple(y[free:])


@dataclass(frozen=True)
class Loosening(Passing):
    """The first moments of slip, or of rolling, as a power series in time.

    Attributes
    ----------
    power
        How it grows with time: 2 from the limit of what can be held, 1 from beyond it.
    """

    power: int = 1

    def segments(self, time: float, state: State, end: float, integrator: Integrator) -> Iterator[Segment]:
        """Evaluate the series."""
        try:
            passing, direction, longest = self._directed(state)
            velocity = state.velocity[:2] if self.ending.moves else ()
            start, degree = (state.axis, state.momentum, direction), ORDER + self.power - 1
            known = growth(start, passing.top, self.ending, velocity, degree, integrator)
            begin = onset(known, self.power, ORDER)
        except ArithmeticError as error:
            yield _nothing(self.told, time, state, str(error))
            return
        duration = min(begin.valid_until(ACCURACY), longest, end - time)
        yield passing.piece(begin.rows, direction, time, duration, end)

    def _directed(self, state: State) -> "tuple[Loosening, tuple[float, ...], float]":
        """The mode on its law's branch, the direction of what begins, and how long it lasts at most.

        In planar motion what ends meanwhile passes through zero, which series do not see.
        """
        ending, other = self.ending, Vanishing(not self.ending.slip)
        point = ContactPoint.of(state.axis, state.momentum, self.top)
        slip, rolling = None, None
        if ending.moves:
            slip = slip_of(state.axis, state.momentum, state.velocity[:2], self.top)
        if ending.slip and not ending.held:
            rolling = point.turning[:2]
        found = beginning(point, slip, rolling, (ending.slip, not ending.slip))
        top = on_branch(self.top, found.slip) if found.slip is not None else self.top
        way = found.slip if ending.slip else found.rolling
        assert way is not None
        beside = slip if ending.moves else rolling
        longest = PART * size(beside) / size(other.rate(found.acceleration, top)) if beside else math.inf
        return replace(self, top=top), way, longest

    def piece(
        self, rows: Sequence[list[Scalar]], direction: Slip, time: float, duration: float, end: float
    ) -> Segment:
        """The segment in which the numbers are polynomials in the time since its start."""
        while isinstance(self.top.surface, Hull) and duration > SETTLED:
            if self._stays_open(rows, duration):
                break
            duration *= 0.5
        # What is zero has no direction, and friction none to be against.
        first = len(rows) - len(direction)
        apart = [[TINY * e, *row[1:]] for e, row in zip(direction, rows[first:], strict=True)]
        reach = min(time + duration, end)
        solution = DenseSolution.in_time([0.0, duration], [[*rows[:first], *apart]]).moved(time, reach)
        last = self.state([horner(row, duration) for row in rows])
        then = Outcome.COMPLETED if reach >= end else self.rules.going_on(last, slips=not self.stuck)
        return Segment(self, solution, last, Transition((), then, last), steps=1)

    def _stays_open(self, rows: Sequence[list[Scalar]], duration: float) -> bool:
        looks = [duration * look / LOOKS for look in range(1, LOOKS + 1)]
        return all(stays_open(self.top, [horner(row, look) for row in rows]) for look in looks)

    @property
    def stuck(self) -> bool:
        """Whether the contact sticks meanwhile."""
        return not self.ending.slip and self.ending.held


@dataclass(frozen=True)
class BothLoosening(Loosening):
    """Slip and rolling begin at once: an instant at their first rates, to which what follows settles."""

    ending: Vanishing = Vanishing(slip=True)  # noqa: RUF009

    def segments(self, time: float, state: State, end: float, integrator: Integrator) -> Iterator[Segment]:
        """Go on at the first rates."""
        point = ContactPoint.of(state.axis, state.momentum, self.top)
        try:
            found = beginning(point, None, None, (True, True))
        except ArithmeticError as error:
            yield _nothing(self.told, time, state, str(error))
            return
        assert found.slip is not None
        passing, pace = replace(self, top=on_branch(self.top, found.slip)), scaled(found.rates[0], found.slip)
        still, growing = (*state.axis, *state.momentum), (0.0, 0.0, 0.0, *point.moment(found.wrench))
        rows = [[number, rate] for number, rate in zip(still, growing, strict=True)]
        rows += [[0.0, rate] for rate in pace]
        yield passing.piece(rows, found.slip, time, min(INSTANT, end - time), end)


@dataclass(frozen=True)
class Resting(Mode):
    """Every velocity has ended: an instant, so that a result has it, and then the run is over.

    Attributes
    ----------
    told
        The mode as which it is told.
    """

    told: IntegratedMode

    name: ClassVar[str] = "resting"

    def state(self, y: Row) -> State:
        """As in the mode as which it is told."""
        return self.told.state(y)

    def segments(self, time: float, state: State, end: float, integrator: Integrator) -> Iterator[Segment]:
        """Stay as it is."""
        still = DenseSolution.standing(self.told.numbers(state), time, time + SHORT * max(1.0, time))
        yield Segment(self.told, still, state, Transition((), Outcome.AT_REST, state))


@dataclass(frozen=True)
class Stopping(Passing):
    """The last moments of slip, or of rolling, in the clock -ln s (see `tippetop.mechanics.ending`).

    Attributes
    ----------
    begin
        The numbers of the clock where another branch of the law has left off; else they are the state's.
    """

    begin: tuple[float, ...] = ()

    def segments(self, time: float, state: State, end: float, integrator: Integrator) -> Iterator[Segment]:
        """Follow it to its end, or to where it is no longer about to end."""
        ending, begin = self.ending, self.begin or self._clock(state)
        here, steps, arc, parts = closing_of(begin, ending), 0, None, list[DenseSolution]()
        start = 0.0, as_array(begin)
        motion = closing_motion(self.top.kind, ending, not self.rules.pulls)
        for horizon in LANDING:
            if landing_guard(here, ending, self.top, horizon) <= 0.0:
                continue
            arcs = _followed(integrator, motion, (*self.top.numbers, end - time, horizon), start)
            steps += sum(arc.steps for arc in arcs)
            arc, parts = arcs[-1], [*parts, *(arc.solution for arc in arcs)]
            start = arc.solution.end, arc.end_state
            here = closing_of(arc.end_state.tolist(), ending)
            if arc.guard != LANDED or landed(here, ending, self.top)[1] < SETTLED:
                break
        if arc is None or arc.guard == LANDED:
            here = landed(here, ending, self.top)[0]
        last = self.state(shown(here))
        solution = self._in_time(parts, begin, time, float(here.time))
        then = self._next(arc, solution.end, last)
        yield Segment(self, solution, last, then, steps, steps)

    def _clock(self, state: State) -> tuple[float, ...]:
        """The numbers of the clock at a state."""
        velocity = state.velocity[:2]
        xi = self.ending.of(state.axis, state.momentum, velocity, self.top)
        free = velocity if self.ending.moves else ()
        return (*state.axis, *state.momentum, *free, *scaled(1.0 / size(xi), xi), size(xi), 0.0)

    def _next(self, arc: Arc | None, time: float, state: State) -> Transition:
        ending, stuck = self.ending, not self.ending.slip and self.ending.held
        if arc is None:
            return self.rules.settled(time, state, new=(ending.slip, not ending.slip), held=ending.held)
        if arc.failure is not None or arc.guard is None:
            return Transition((), Outcome.FAILED, state, arc.failure or "the slip neither ends nor goes on")
        found = follow_surface(self, arc.guard, time, state)
        if found is not None:
            return found
        match arc.guard:
            case "time":
                return Transition((), Outcome.COMPLETED, state)
            case "lift-off":
                return self.rules.lift_off(time, state)
            case "reopening":
                return Transition((), self.rules.going_on(state, slips=not stuck), state)
            case "overtaken":
                return Transition((), replace(self, ending=Vanishing(not ending.slip), begin=()), state)
            case "branch":
                return Transition((), self._onwards(arc, on_other_branch(self.top)), state)
            case "limit branch":
                return Transition((), self._onwards(arc, on_other_limit_branch(self.top)), state)
            case "slip":
                return self.rules.giving_way(
                    state, (self.rules.event(EventKind.SLIP, time),), Vanishing(slip=True)
                )
            case "rolling":
                return self.rules.giving_way(
                    state, (self.rules.event(EventKind.ROLL, time),), Vanishing(slip=False)
                )
        return self.rules.settled(time, state, new=(ending.slip, not ending.slip), held=ending.held)

    def _onwards(self, arc: Arc, top: Top) -> "Stopping":
        """The mode that takes the clock up where an arc leaves it, on another branch of the law."""
        return replace(self, top=top, begin=(*arc.end_state.tolist()[:-1], 0.0))

    def _in_time(
        self, parts: Sequence[DenseSolution], begin: Row, time: float, duration: float
    ) -> DenseSolution:
        """The numbers of the mode as polynomials in time, from their solution in the clock."""
        if not parts:
            return DenseSolution.standing(shown(closing_of(begin, self.ending)), time, time + duration)
        clock, elapsed = DenseSolution.joined(parts), len(begin) - 1

        def numbers(times: Array) -> tuple[Scalar, ...]:
            return shown(closing_of(clock.rows(clock.when(elapsed, times)), self.ending))

        solution = DenseSolution.fitted(numbers, clock.knots_of(elapsed, duration), DEGREE)
        return solution.moved(time, time + duration)


def shown(here: Closing) -> tuple[Scalar, ...]:
    """The numbers of a moment that passes: axis, momentum, velocity where it is free, and xi."""
    return (*here.axis, *here.momentum, *here.velocity, *scaled(here.speed, here.direction))


def _nothing(mode: Mode, time: float, state: State, why: str) -> Segment:
    """No motion at all, and why."""
    return Segment(mode, DenseSolution.nothing(time, 8), state, Transition((), Outcome.FAILED, state, why))


def _followed(
    integrator: Integrator, motion: Motion, parameters: Sequence[float], start: tuple[float, Array]
) -> list[Arc]:
    """The end of slip, or of rolling, in its clock.

    On a small patch the direction of slip follows the friction much faster than slip ends: where that takes
    more steps than there are in an arc, an implicit method takes them instead.
    """
    first = next(iter(integrator.integrate(motion, parameters, start, LONGEST)))
    if first.guard is not None or first.failure is not None or first.solution.end >= LONGEST:
        return [first]
    arcs: list[Arc] = []
    for arc in make_integrator("radau", STIFF_TOLERANCE).integrate(motion, parameters, start, LONGEST):
        arcs.append(arc)
        if arc.guard is None and sum(one.steps for one in arcs) >= MOST_STEPS:
            arcs[-1] = replace(arc, failure="slip, or rolling, takes too many steps to end")
            break
    return arcs


@lru_cache
def closing_motion(kind: Kind, ending: Vanishing, guarded: bool) -> Motion:
    """Equations of motion in the clock -ln s where a velocity is about to end; time is the last number.

    The last parameters are when the run ends, and how long before its end the velocity is left to `landed`.
    """

    def top_of(numbers: Sequence[Scalar]) -> Top:
        return kind.top(tuple(numbers[: kind.numbers]))

    def rates(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> tuple[Scalar, ...]:
        rate = closing_rates(closing_of(y, ending), ending, top_of(numbers))
        return (*rate.axis, *rate.momentum, *rate.velocity, *rate.direction, rate.speed, rate.time)

    def guard(name: str, value: Callable[[Closing, Top, Sequence[Scalar]], Scalar]) -> Guard:
        return Guard(name, lambda y, numbers: value(closing_of(y, ending), top_of(numbers), numbers))

    def on_branch_still(state: Closing, top: Top, _: Sequence[Scalar]) -> Scalar:
        return slip_branch_guard(slip_beside(state, ending, top) or state.direction, top)

    guards = [
        guard(REOPENING, lambda state, top, _: reopening_guard(state, ending, top, HORIZON)),
        guard(LANDED, lambda state, top, numbers: landing_guard(state, ending, top, numbers[-1])),
        guard(TIME, lambda state, _, numbers: numbers[-2] - state.time),
    ]
    law = kind.example.friction
    resisted, stuck = isinstance(law, RollingResistance), not ending.slip and ending.held
    if guarded:
        guards.append(
            guard(LIFT_OFF, lambda state, top, _: rates_in_time(state, ending, top).wrench.force[2])
        )
    if not ending.held and resisted and is_set_valued(law):
        guards.append(guard(OVERTAKEN, lambda state, top, _: overtaking_guard(state, ending, top)))
    if ending.held:
        guards.append(
            guard(ROLLING if ending.slip else SLIP, lambda state, top, _: spared(state, ending, top))
        )
    if (ending.slip or ending.moves) and hasattr(sliding_law(law), "branch_guard"):
        guards.append(guard(BRANCH, on_branch_still))
    if stuck and has_limit_branches(law):
        guards.append(
            guard(
                LIMIT_BRANCH, lambda state, top, _: limit_guard(top, rates_in_time(state, ending, top).wrench)
            )
        )
    guards += surface_guards(kind)
    free = 2 if ending.moves else 0
    components = slip_dimension(law) if ending.slip else 2
    return Motion(rates, 8 + free + components, kind.numbers + 2, tuple(guards), lasting=False)


def spared(state: Closing, ending: Vanishing, top: Top) -> Scalar:
    """Positive while the table can hold what is held beside a velocity that ends."""
    wrench = rates_in_time(state, ending, top).wrench
    if ending.slip:
        point = ContactPoint.of(state.axis, state.momentum, top)
        return rolling_reserve(point, wrench, state.direction)
    return set_valued(top.friction).reserve(wrench.force[2], wrench.force[:2], wrench.torque[2])


def closing_of(y: Row, ending: Vanishing) -> Closing:
    """The state of a velocity that is about to end, from its numbers."""
    count, free = len(y), 8 if ending.moves else 6
    return Closing(*split(y), tuple(y[6:free]), tuple(y[free : count - 2]), y[count - 2], y[count - 1])
