"""One run and its derivatives: every leg of it followed with what moves it.

A run is a chain of legs. An integrated leg, in contact or in flight, is followed with its
variational equations (see `variational`). A junction lies between two of them: the guard that ends
one, what the automaton decides there - a reset, an impact - and the modes that are no equations of
motion, such as the first and last moments of slip. The derivative of the guard's time gives the
state at the junction; its own code, called beside the run, gives the derivatives of what comes out
of it.

All derivatives at the ends of legs are total ones: they move with the time of the end.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from itertools import zip_longest
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from tippetop.contact.automaton import Automaton
from tippetop.contact.block import Block
from tippetop.contact.contact_mode import ContactMode
from tippetop.contact.flight import LANDING, TOUCHING, Flight, is_level
from tippetop.contact.guards import (
    BRANCH,
    ENDING,
    LIMIT_BRANCH,
    ROLLING_STOPPING,
    SLIP_LARGE,
    SLIP_SMALL,
    STOPPING,
)
from tippetop.contact.mode import (
    COMPLETED,
    FAILURE,
    NUMBER_SIGN,
    EventKind,
    IntegratedMode,
    Mode,
    ModeEnd,
    Segment,
    Status,
    Transition,
)
from tippetop.contact.natural_launch import NaturalLaunch, automaton_of
from tippetop.contact.slip_end_motion import OVERTAKEN, REOPENING
from tippetop.contact.slip_onset import ONSET_OVER
from tippetop.contact.surfaces import TOUCH
from tippetop.contact.trajectory import Trajectory
from tippetop.fit.dual import duals, parts_of
from tippetop.fit.problem_numbers import Direction, StartNumbers
from tippetop.fit.variational import TOGETHER, followed
from tippetop.integrators import make_integrator
from tippetop.integrators.base import Array, Guard
from tippetop.integrators.dense import DenseSolution
from tippetop.mechanics.natural_units import Units
from tippetop.mechanics.state import State
from tippetop.mechanics.top import Kind, Top, contact_numbers, contacts_with
from tippetop.problem.problem import Problem, top_of
from tippetop.results.catalogue import SAMPLED
from tippetop.results.observables import Recorder
from tippetop.results.run_metrics import RunMetrics
from tippetop.run import read_off
from tippetop.support.errors import InvalidInput

BESIDE = 2e-5
"""How far beside the run a junction is followed, in natural units.

The error of the rule over four such runs is the fourth power of that over the scale of the motion,
and rounding over it: slip that is about to end, at 1e-3, is the smallest scale.
"""

CHECKED = 0.6
"""How much nearer to the run its junctions are followed in the check of the derivatives: the error
of the rule is an eighth then, and rounding another, so that both differ by what the first are off.
"""

READ_BESIDE = 5e-6
"""How far beside the run its variables are read off by two runs, in natural units: the error is the
square of that over the scale of the motion, as small as 1e-2 for normal forces, and rounding over
it.
"""

TRIES, SHORTER = 3, 0.1
"""How often a junction is followed nearer to the run, and how much nearer each time, until the runs
beside it go through the same events.
"""

GRAZING = 1e-8
"""Rate of a guard where it falls, over the sum of the sizes of its parts, one of each number of the
motion, below which its time has no derivative: the parts cancel, and rounding leaves few digits of
what is divided by that rate.
"""

SHORT_FLIGHT = 1e-2
"""Duration of a flight, in natural units, up to which it belongs to the junction between others:
to first order runs beside bounces that die away would soon go through other events.
"""

SLIP_LEFT = 1e-5
"""Time before the end of slip on two contacts, in natural units, at which the derivative of that
end is found first: slip, 1e-5 then, has 11 digits, and what follows changes the time by 1e-5 of
what the slip's direction changes.
"""

FOLLOWED_ON = (SLIP_SMALL, SLIP_LARGE, STOPPING, ONSET_OVER, REOPENING, OVERTAKEN)
"""Causes of the end of a mode after which the same motion goes on, and is only followed in another
way.
"""

OTHER_FORMULA = (BRANCH, LIMIT_BRANCH)
"""Causes of the end of a mode after which the same motion goes on by another formula of the law.
"""

FOUR = ((-2, 1.0 / 12.0), (-1, -8.0 / 12.0), (1, 8.0 / 12.0), (2, -1.0 / 12.0))
"""Rule of fourth order for a first derivative: places and weights."""

RULE_ROUNDING = 1.5 * np.finfo(float).eps
"""Rounding of a number of size 1 in the rule, times the distance: the sum of its weights."""

OTHER_EVENTS = (
    "runs nearby go through other events: a choice of the contact is at its edge, or at the limit"
    " of sticking"
)
GRAZES = "the motion grazes: the guard that ends it hardly falls"
UNSOLVED = "the variational equations cannot be followed"
AT_BOUND = (
    "contact.restitution is at the end of its range, from 0 to 1: there is no run on the other side"
)
ELASTIC = (
    "an impact without friction and without loss: restitution and the energy stored end it at once,"
    " and friction.mu has no run on the other side"
)
UNKNOWN = "what follows cannot be found beside the run"


EVENT_STATES = {
    f"event_{name}": SAMPLED[name]._replace(long_name=f"{SAMPLED[name].long_name}, after an event")
    for name in ("axis", "angular_momentum", "velocity", "height")
}
"""Variables over the events, by name, of the state just after each."""


class Differs(Exception):
    """A run beside another goes through other events from some time on, or cannot go on."""

    def __init__(self, reason: str, time: float = 0.0) -> None:
        super().__init__(reason)
        self.time = time


@dataclass
class Visit:
    """A mode that the run went through."""

    mode: Mode
    """The mode as it was entered."""
    time: float
    state: State
    """When and where it was entered."""
    segments: list[Segment] = field(default_factory=list)
    end: ModeEnd | None = None
    """What ended it, if anything did."""
    transition: Transition | None = None
    """What followed."""

    @property
    def end_time(self) -> float:
        """When it ended."""
        return self.segments[-1].end_time

    @property
    def goes_on(self) -> bool:
        """Whether the same motion goes on after it."""
        return goes_on(self.segments[-1].mode, self.end)

    def joined(self, onwards: "Visit") -> "Visit":
        """Return the visit with that of another mode in which the same motion goes on."""
        return Visit(
            self.mode,
            self.time,
            self.state,
            self.segments + onwards.segments,
            onwards.end,
            onwards.transition,
        )


@dataclass
class IntegratedLeg:
    """A visit of a mode with equations of motion, and its derivatives."""

    visit: Visit
    solutions: list[DenseSolution]
    """StartNumbers and derivatives, of at most `TOGETHER` directions each."""
    times: tuple[Array, Array]
    """Derivatives of the times at which it begins and ends, shape (directions,)."""
    last: Array
    """StartNumbers at its end."""
    changes: Array
    """Total derivatives of them, shape (directions, size)."""
    guard: tuple[Guard, Array] | None = None
    """The guard that ends it, and its gradient there, over the square of that."""
    along: dict[int, tuple[Array, Array]] = field(default_factory=dict)
    """Derivatives along it, once they are asked for, by direction."""

    def displaced(self, mode: Mode, direction: int, change: float, end: float) -> Segment:
        """Return it as a segment of a run beside the run, to first order.

        `end` is the time of its end.
        """
        solution = self.solutions[direction // TOGETHER]
        moved, rates = self._rates_along(direction)
        terms = change * rates
        degree = solution.terms.shape[2]
        terms[:, :, :degree] += solution.terms[:, : len(self.last)]
        ends = solution.knots + change * moved
        ends[-1] = end
        last = mode.state((self.last + change * self.changes[direction]).tolist())
        mode_end = self.visit.end
        steps = sum(segment.steps for segment in self.visit.segments)
        return Segment(mode, DenseSolution(ends, terms), last, mode_end, steps)

    def _rates_along(self, direction: int) -> tuple[Array, Array]:
        """Return the derivatives of the ends of the steps and, along them, of the polynomials."""
        if direction in self.along:
            return self.along[direction]
        solution = self.solutions[direction // TOGETHER]
        size, place, knots = len(self.last), 1 + direction % TOGETHER, solution.knots
        start, stop = (float(times[direction]) for times in self.times)
        span = knots[-1] - knots[0]
        moved = start + (stop - start) * (knots - knots[0]) / (span if span > 0.0 else 1.0)
        degree = solution.terms.shape[2]
        terms = solution.terms[:, place * size : (place + 1) * size]
        stretched = moved - start
        if np.any(stretched):
            # The ends of a step move: its polynomial is one of a part of the step, to first order.
            terms = np.concatenate([terms, np.zeros((*terms.shape[:2], 1))], axis=2)
            spans = np.diff(knots)[:, None, None]
            slopes = solution.terms[:, :size, 1:] * np.arange(1, degree) / spans
            terms[:, :, : degree - 1] += slopes * stretched[:-1, None, None]
            terms[:, :, 1:degree] += slopes * np.diff(stretched)[:, None, None]
        self.along[direction] = moved, terms
        return moved, terms


@dataclass
class Junction:
    """What lies between two integrated legs: transitions, and visits of other modes."""

    before: IntegratedLeg | None
    """The leg that it ends; None at launch."""
    transitions: list[Transition]
    """What follows the leg, or the launch, and each of the visits."""
    visits: list[Visit]
    """The visits, one after each transition but the last. Those in which the same motion goes on
    are one, in the mode in which it is entered: a run beside may follow it in other ways.
    """

    def add(self, visit: Visit) -> None:
        """Add the next visit, and what follows it."""
        if self.visits and self.visits[-1].goes_on:
            self.visits[-1] = self.visits[-1].joined(visit)
            self.transitions.pop()
        else:
            self.visits.append(visit)
        if visit.transition is not None:
            self.transitions.append(visit.transition)


@dataclass
class Beside:
    """A junction followed beside the run."""

    transitions: list[Transition]
    segments: list[list[Segment]]
    time: float
    state: State
    """When and where it ends."""


class LinearizedRun:
    """A run of a problem, and its derivatives in several directions.

    Parameters
    ----------
    problem, duration, grid
        The problem, how long it runs, and when it is sampled, s.
    directions
        What is varied.
    tolerance
        Tolerance of the integrator, if it is not its own.
    distance
        How far beside the run its junctions are followed, in natural units.
    rounding_of
        The same run and one of its directions, where derivatives are to be what rounding of the
        differences at its junctions makes of those: the one direction here moves no number.

    Attributes
    ----------
    failures
        Why derivatives do not exist and from which time on, natural units, by direction.
    is_differenced
        Whether the derivatives go through junctions of which differences are taken.
    """

    def __init__(
        self,
        problem: Problem,
        duration: float,
        grid: Array,
        directions: Sequence[Direction],
        *,
        tolerance: float | None = None,
        distance: float = BESIDE,
        rounding_of: "tuple[LinearizedRun, int] | None" = None,
    ) -> None:
        self.rounding_of, self.chance = rounding_of, np.random.default_rng(0)
        self.problem, self.duration, self.grid = problem, duration, grid
        self.distance, self.is_differenced = distance, False
        self.fields = tuple(directions)
        self.directions = tuple([one.rates for one in directions])
        self.numbers = StartNumbers.of(problem)
        self.integrator = make_integrator(None, tolerance)
        self.kind = top_of(problem).kind
        self.failures = dict[int, tuple[float, str]]()
        self.legs = list[IntegratedLeg | Junction]()
        self._problems = dict[tuple[int, float], Problem | None]()
        self._follow()
        self._differentiate()

    # The run itself.

    def _automaton(self, numbers: StartNumbers) -> Automaton:
        rules = automaton_of(self.problem.contact, numbers.top_of(self.kind), numbers.natural_units)
        if getattr(rules, "restitution", None) == self.numbers.restitution:
            rules = replace(rules, restitution=numbers.restitution)
        return rules

    def _end_of(self, numbers: StartNumbers) -> float:
        return float(self.duration / numbers.units[2])

    @np.errstate(all="ignore")
    def _follow(self) -> None:
        """Follow the run, and keep every visit."""
        numbers = self.numbers
        automaton = self._automaton(numbers)
        launch = automaton.launch(numbers.start)
        self.trajectory = Trajectory(automaton, launch, self._end_of(numbers), self.integrator)
        self.visits, self.launch, entered = list[Visit](), launch, launch
        visit: Visit | None = None
        for segment in self.trajectory.segments():
            if visit is None:
                assert isinstance(entered.next, Mode)
                begin = self.visits[-1].end_time if self.visits else 0.0
                visit = Visit(entered.next, begin, entered.state)
                self.visits.append(visit)
            visit.segments.append(segment)
            if segment.transition is not None:
                visit.end, visit.transition = segment.mode_end, segment.transition
                entered, visit = segment.transition, None
        assert self.trajectory.status is not None
        self.status: Status = self.trajectory.status

    # Its derivatives.

    @np.errstate(all="ignore")
    def _differentiate(self) -> None:
        """Go from leg to leg with the derivatives."""
        before: IntegratedLeg | None = None
        transition, visits = self.launch, list(self.visits)
        while True:
            junction = Junction(before, [transition], [])
            while visits and not is_integrated(visits[0]):
                junction.add(visits.pop(0))
                if junction.visits[-1].transition is None:
                    break
            self.legs.append(junction)
            if not visits:
                return
            visit = visits.pop(0)
            assert isinstance(visit.mode, IntegratedMode)
            times, changes = self._through(junction, visit)
            before = self._integrated(visit, times, changes)
            self.legs.append(before)
            if visit.transition is None:
                return
            transition = visit.transition
            if visit.end is not None and visit.end.cause in (COMPLETED, FAILURE):
                return

    def _through(self, junction: Junction, visit: Visit) -> tuple[Array, Array]:
        """Return the derivatives of the time and numbers with which a leg begins."""
        mode: Any = visit.mode
        size = len(mode.numbers(visit.state))
        changes, ahead = np.zeros((len(self.directions), size)), np.zeros(len(self.directions))
        straight = self._straight(junction, mode)
        if straight is not None:
            return ahead, straight
        self.is_differenced = True
        for direction in range(len(self.directions)):
            if direction in self.failures:
                continue
            change = self._change(junction, direction)
            for _ in range(TRIES):
                try:
                    for place, weight in FOUR:
                        beside = self.beside(junction, direction, place * change)
                        mode_beside = self._mode(mode, self.directions[direction], place * change)
                        row = np.array(mode_beside.numbers(beside.state))
                        changes[direction] += weight / change * row
                        ahead[direction] += weight / change * (beside.time - visit.time)
                    break
                except Differs as differs:
                    error = differs
                    changes[direction], ahead[direction] = 0.0, 0.0
                    change *= SHORTER
            else:
                self.fail(direction, error.time, str(error))
        if self.rounding_of is not None:
            rounding = self._rounding_at(visit, *self.rounding_of)
            changes[0] += rounding[:-1]
            ahead[0] += rounding[-1]
        leg = junction.before
        if leg is not None and not junction.visits:
            # The axis does not jump: where two surfaces strike in turns, ever sooner, rounding of
            # the rule in its derivative would grow as fast as the time between them shrinks.
            changes[:, :3], ahead = leg.changes[:, :3], leg.times[1]
        return ahead, self._touching(visit, changes)

    def _rounding_at(self, visit: Visit, run: "LinearizedRun", direction: int) -> Array:
        """Return what rounding makes of the differences of the numbers, and of the time, with which
        a leg of the same run begins; the signs are by chance.
        """
        mode: Any = visit.mode
        junction = run.legs[len(self.legs) - 1]
        assert isinstance(junction, Junction)
        sizes = np.maximum(1.0, np.abs([*mode.numbers(visit.state), visit.time]))
        signs = self.chance.choice([-1.0, 1.0], len(sizes))
        return np.asarray(signs * sizes * RULE_ROUNDING / run._change(junction, direction))

    def _touching(self, visit: Visit, changes: Array) -> Array:
        """Return the derivatives of the numbers with which a leg begins, where its gaps that are
        zero stay so.

        Rounding of the rule in them would be divided by the speed with which a surface leaves and
        returns, which is small where surfaces strike in turns.
        """
        mode: Any = visit.mode
        parameters = np.array(mode.parameters, dtype=float)
        y = np.array(mode.numbers(visit.state), dtype=float)
        rates = np.stack([self._parameter_rates(mode, one) for one in self.directions])
        for guard in mode.motion.guards:
            is_gap = guard.name.split(NUMBER_SIGN)[0] in (LANDING, TOUCH)
            if is_gap and abs(guard.value(y.tolist(), parameters.tolist())) <= TOUCHING:
                slopes, gradient = guard_slopes(guard, (y, changes), (parameters, rates))
                # The axis stays a unit vector.
                towards = gradient - np.append(y[:3] * (y[:3] @ gradient[:3]), np.zeros(len(y) - 3))
                if towards.any():
                    changes = changes - np.outer(slopes, towards / float(gradient @ towards))
        return changes

    def _straight(self, junction: Junction, mode: Any) -> Array | None:
        """Return the derivatives of the numbers with which the run begins, where nothing happens at
        launch.
        """
        unchanged = self.launch.state == self.numbers.start and not self.launch.events
        if junction.before is not None or junction.visits or not unchanged:
            return None
        rows = [mode.numbers(State.unpack(rates.state.tolist())) for rates in self.directions]
        return np.array(rows, dtype=float)

    def _change(self, junction: Junction, direction: int) -> float:
        """Return how far to go along a direction beside the run."""
        rates = self.directions[direction]
        sizes = [np.max(np.abs(rates.top)), abs(rates.restitution)]
        leg = junction.before
        if leg is None:
            sizes.append(np.max(np.abs(rates.state)))
        else:
            sizes += [np.max(np.abs(leg.changes[direction])), abs(leg.times[1][direction])]
        return self.distance / max(1.0, *map(float, sizes))

    def fail(self, direction: int, time: float, reason: str) -> None:
        """Say that derivatives do not exist from a time on, which may come before another."""
        if time < self.failures.get(direction, (np.inf, ""))[0]:
            self.failures[direction] = time, reason

    def _integrated(self, visit: Visit, times: Array, changes: Array) -> IntegratedLeg:
        """Follow the variational equations of a visit to its end, and its guard."""
        mode: Any = visit.mode
        motion, parameters = mode.motion, np.array(mode.parameters, dtype=float)
        start = np.array(mode.numbers(visit.state), dtype=float)
        # Derivatives at a fixed time since the beginning of the leg are followed, not at a fixed
        # time: so errors of rates multiply the derivative of what the leg lasts, and not the much
        # larger one of its times, where surfaces strike in turns ever sooner.
        rates = np.stack([self._parameter_rates(mode, one) for one in self.directions])
        carried = parameters, rates
        solutions, last, final = self._followed(visit, carried, (visit.time, start, changes))
        earlier = np.zeros(len(times))
        near = visit.end_time - SLIP_LEFT
        slip_ends = visit.end is not None and visit.end.cause == ENDING
        if slip_ends and near > visit.time and all(len(one.terms) for one in solutions):
            # Slip is known to a few digits where it ends on two contacts, and so is the direction
            # of friction. The derivative of the time at which there was more of it needs more, and
            # the rest depends little on what is varied.
            moments = [
                np.reshape(one.rows(np.array([near])), (-1, len(start))) for one in solutions
            ]
            moment, tangents = moments[0][0], np.vstack([rows[1:] for rows in moments])
            slopes = np.array(motion.rates(moment.tolist(), parameters.tolist()))
            _, earlier = self._durations(visit, (moment, tangents, slopes), carried, times)
            tangents = tangents + np.outer(earlier, slopes)
            _, last, final = self._followed(visit, carried, (near, moment, tangents))
        slopes = np.array(motion.rates(last.tolist(), parameters.tolist()))
        guard, lasts = self._durations(visit, (last, final, slopes), carried, times)
        total = final + np.outer(lasts, slopes)
        return IntegratedLeg(visit, solutions, (times, times + earlier + lasts), last, total, guard)

    def _followed(
        self, visit: Visit, carried: tuple[Array, Array], begin: tuple[float, Array, Array]
    ) -> tuple[list[DenseSolution], Array, Array]:
        """Return the solutions of the variational equations of a visit from a time, numbers and
        their derivatives on, and the last numbers and derivatives.
        """
        (parameters, rates), (time, start, tangents) = carried, begin
        mode: Any = visit.mode
        solutions, last, ended = list[DenseSolution](), start, list[Array]()
        for first in range(0, len(tangents), TOGETHER):
            some = slice(first, first + TOGETHER)
            solved = followed(
                mode.motion,
                np.vstack([parameters, rates[some]]),
                (time, np.vstack([start, tangents[some]])),
                visit.end_time,
                self.integrator,
                mode.solution_of,
            )
            if solved is None:
                size = (1 + len(tangents[some])) * len(start)
                solutions.append(DenseSolution.empty(time, size))
                for direction in range(first, first + len(tangents[some])):
                    self.fail(direction, time, UNSOLVED)
                ended.append(np.zeros_like(tangents[some]))
                continue
            solutions.append(solved[0])
            last = solved[1][0]
            ended.append(solved[1][1:])
        return solutions, last, np.vstack(ended)

    def _parameter_rates(self, mode: Mode, direction: StartNumbers) -> Array:
        """Return the derivatives of the parameters of a mode."""
        step = 1e-3
        ends = [self._mode(mode, direction, sign * step).parameters for sign in (-1.0, 1.0)]
        return np.asarray((np.array(ends[1]) - np.array(ends[0])) / (2.0 * step))

    def _mode(self, mode: Mode, direction: StartNumbers, change: float) -> Any:
        """Return a mode with the tops of a run beside."""
        numbers = np.array(contact_numbers(mode.tops))
        # A number of a branch does not change.
        numbers[: len(direction.top)] += change * direction.top
        tops = contacts_with([top.kind for top in mode.tops], tuple(numbers.tolist()))
        if isinstance(mode, ContactMode):
            return mode.with_tops(tops, mode.parameters[len(numbers) :])
        return replace(mode, top=tops[0])

    def _durations(
        self,
        visit: Visit,
        at: tuple[Array, Array, Array],
        carried: tuple[Array, Array],
        begins: Array,
    ) -> tuple[tuple[Guard, Array] | None, Array]:
        """Return the guard whose fall ends a visit, with its gradient over the square of that, and
        the derivatives of the time that the visit lasts.

        There is no guard where the run ends, and where the same motion goes on under one law.
        """
        last, tangents, slopes = at
        count = len(tangents)
        mode: Any = visit.mode
        guard = guard_of(mode.motion.guards, visit.end)
        if visit.goes_on and not (visit.end and visit.end.cause in OTHER_FORMULA):
            # Any time would do. That of the guard keeps what comes soon as near to it beside; where
            # the guard grazes, it is the one at which the run beside is nearest to the end.
            if guard is not None:
                changes, gradient = guard_slopes(guard, (last, tangents), carried)
                slope = float(gradient @ slopes)
                if abs(slope) > GRAZING * float(np.abs(gradient) @ np.abs(slopes)):
                    return None, -changes / slope
            return None, -(tangents @ slopes) / (1.0 + slopes @ slopes)
        if guard is None:
            ends = [self._end_rate(one) for one in self.directions]
            return None, np.array(ends) - begins
        changes, gradient = guard_slopes(guard, (last, tangents), carried)
        slope, steepest = float(gradient @ slopes), float(np.linalg.norm(gradient))
        times = np.zeros(count)
        # Bounces that die away land ever slower, and do not graze.
        lands = visit.end is not None and visit.end.cause == LANDING
        least = 0.0 if lands else GRAZING * float(np.abs(gradient) @ np.abs(slopes))
        if abs(slope) > least:
            times = -changes / slope
        else:
            for direction in range(count):
                self.fail(direction, visit.end_time, GRAZES)
        return (guard, gradient / steepest**2), times

    def _end_rate(self, direction: StartNumbers) -> float:
        """Return the derivative of the natural time at which the run ends."""
        return float(-self._end_of(self.numbers) / self.numbers.units[2] * direction.units[2])

    # Runs beside it.

    def beside(
        self,
        junction: Junction,
        direction: int,
        change: float,
        end: float | None = None,
        until: float = np.inf,
    ) -> Beside:
        """Follow a junction beside the run.

        Parameters
        ----------
        junction
            The junction.
        direction, change
            Which of the directions, and how far along it.
        end
            Time at which the run beside ends, if that is known better than to first order.
        until
            Time of the run after which visits are not followed further.

        Raises
        ------
        Differs
            If it goes through other events.
        """
        numbers = self._beside(direction, change, at_launch=junction.before is None)
        end = self._end_of(numbers) if end is None else end
        automaton, nominal = self._automaton(numbers), self._start_of(junction)
        segments = list[list[Segment]]()
        try:
            require_impact(numbers, self.kind, junction.transitions[0])
            if junction.before is None:
                time, transition = 0.0, automaton.launch(numbers.start)
            else:
                time, transition = self._after_leg(automaton, junction.before, direction, change)
            if junction.before is None or not junction.before.visit.goes_on:
                transition = same(transition, junction.transitions[0])
            done = [transition]
            for visit, following in zip_longest(junction.visits, junction.transitions[1:]):
                nominal = visit.end_time
                some, mode, how = self._visited(visit, automaton, (time, done[-1]), end)
                segments.append(some)
                time = some[-1].end_time
                if following is None or nominal >= until:
                    return Beside(done, segments, time, some[-1].end_state)
                if visit.goes_on:
                    transition = replace(following, state=some[-1].end_state)
                else:
                    require_impact(numbers, self.kind, following)
                    transition = same(automaton.follow(mode, how, time), following)
                done.append(transition)
                some[-1] = replace(some[-1], transition=transition)
        except (Differs, ArithmeticError, ValueError) as error:
            reason = str(error) if isinstance(error, Differs) else UNKNOWN
            raise Differs(reason, nominal) from error
        return Beside(done, segments, time, done[-1].state)

    def _visited(
        self, visit: Visit, automaton: Automaton, start: tuple[float, Transition], end: float
    ) -> tuple[list[Segment], Mode, ModeEnd]:
        """Return the segments of a visit beside the run, its last mode, and how that ended.

        Where the same motion goes on after the visit, it is followed for as long as in the run.
        """
        (time, transition), segments = start, list[Segment]()
        until = min(time + (visit.end_time - visit.time), end) if visit.goes_on else end
        while True:
            mode: Any = transition.next
            segments += mode.segments(time, transition.state, until, self.integrator)
            time, how = segments[-1].end_time, segments[-1].mode_end
            if how is None:
                raise Differs(OTHER_EVENTS)
            if not goes_on(mode, how) or time >= until:
                break
            transition = automaton.follow(mode, how, time)
        if visit.goes_on and how.cause != COMPLETED and not goes_on(mode, how):
            raise Differs(OTHER_EVENTS)
        return segments, mode, how

    def _beside(self, direction: int, change: float, *, at_launch: bool) -> StartNumbers:
        """Return the numbers of a run beside the run, which are linear in the change.

        Those at launch are the problem's own, where there is such a problem: so contact and the
        absence of slip hold to rounding, and not to first order.
        """
        problem = self._problem_beside(direction, change) if at_launch else None
        try:
            numbers = None if problem is None else StartNumbers.of(problem)
        except InvalidInput:
            numbers = None
        return (
            self.numbers.moved(self.directions[direction], change) if numbers is None else numbers
        )

    def _problem_beside(self, direction: int, change: float) -> Problem | None:
        """Return the problem beside, if there is one."""
        key = direction, change
        if key not in self._problems:
            self._problems[key] = self.fields[direction].beside(self.problem, change)
        return self._problems[key]

    def _after_leg(
        self, automaton: Automaton, leg: IntegratedLeg, direction: int, change: float
    ) -> tuple[float, Transition]:
        """Return when a leg ends beside the run, and what follows there."""
        assert leg.visit.end is not None
        rates = self.directions[direction]
        mode: Any = self._mode(leg.visit.mode, rates, change)
        y = leg.last + change * leg.changes[direction]
        time = leg.visit.end_time + change * float(leg.times[1][direction])
        if leg.guard is not None:
            # The guard is zero to first order, and the nearest place where it is zero is sought. A
            # step along the motion to there would be long where the guard falls slowly.
            guard, towards = leg.guard
            y = y - float(guard.value(y.tolist(), tuple(mode.parameters))) * towards
            how = mode.end_by_guard(guard.name, mode.state(y.tolist()))
        else:
            how = replace(leg.visit.end, state=mode.state(y.tolist()))
        return time, automaton.follow(mode, how, time)

    @np.errstate(all="ignore")
    def read_beside(self, direction: int, change: float) -> "RunReading":
        """Return what a run beside the run shows, to first order in a change.

        Raises
        ------
        Differs
            If it goes through other events.
        """
        rates = self.directions[direction]
        numbers = self._beside(direction, change, at_launch=True)
        units, end = numbers.natural_units, self._end_of(numbers)
        failing = self.failures.get(direction, (np.inf, ""))[0]
        segments, events, launch = list[Segment](), list[Any](), None
        states = list[State]()
        time, state = 0.0, numbers.start
        for leg in self.legs:
            if isinstance(leg, Junction):
                if self._start_of(leg) >= failing:
                    break
                passed = self.beside(leg, direction, change, end, failing)
                if launch is None:
                    launch = passed.transitions[0]
                elif segments:
                    segments[-1] = replace(segments[-1], transition=passed.transitions[0])
                for one in passed.transitions:
                    events += one.events
                    states += [one.state] * len(one.events)
                segments += [segment for some in passed.segments for segment in some]
                time, state = passed.time, passed.state
                continue
            if leg.visit.time >= failing:
                break
            completes = leg.visit.end is None or leg.visit.end.cause == COMPLETED
            until = leg.visit.end_time + change * float(leg.times[1][direction])
            mode = self._mode(leg.visit.mode, rates, change)
            segment = leg.displaced(mode, direction, change, end if completes else until)
            segments.append(segment)
            time, state = segment.end_time, segment.end_state
        if launch is None:
            return self.read()
        start = self._launch(numbers, launch)
        trajectory = Trajectory(start.automaton, launch, end, self.integrator)
        trajectory.end_at(time, state, self.status, self.trajectory.detail)
        trajectory.events = events
        problem = self._problem_beside(direction, change) or self.problem
        return RunReading(self._dataset(problem, start, segments, trajectory), states, units)

    @np.errstate(all="ignore")
    def read(self) -> "RunReading":
        """Return what the run itself shows."""
        start = self._launch(self.numbers, self.launch)
        segments = [segment for visit in self.visits for segment in visit.segments]
        run = self._dataset(self.problem, start, segments, self.trajectory)
        transitions = [self.launch, *(v.transition for v in self.visits if v.transition)]
        states = [one.state for one in transitions for _ in one.events]
        return RunReading(run, states, start.units)

    def end_beside(self, direction: int, change: float) -> tuple[State, Top, Units]:
        """Return the last state of a run beside the run, to first order in a change, with its top
        and units.

        Raises
        ------
        Differs
            If what follows the last integrated leg is another.
        """
        numbers, last = self._beside(direction, change, at_launch=True), self.legs[-1]
        top, units = numbers.top_of(self.kind), numbers.natural_units
        if isinstance(last, Junction):
            end = self._end_of(numbers)
            return self.beside(last, direction, change, end).state, top, units
        mode = self._mode(last.visit.mode, self.directions[direction], change)
        return mode.state((last.last + change * last.changes[direction]).tolist()), top, units

    def _launch(self, numbers: StartNumbers, first: Transition) -> NaturalLaunch:
        """Return the launch of the run, or of one beside it."""
        return NaturalLaunch(
            numbers.natural_units,
            numbers.top_of(self.kind),
            numbers.start,
            numbers.azimuth,
            self._automaton(numbers),
            first,
        )

    def _dataset(
        self,
        problem: Problem,
        start: NaturalLaunch,
        segments: Sequence[Segment],
        trajectory: Trajectory,
    ) -> xr.Dataset:
        """Return the dataset of segments, of the run or beside it."""
        recorder = Recorder.of(start, self.grid / start.units.time)
        run_metrics = RunMetrics(start.top, start.state)
        block = Block(segments)
        recorder.take(block)
        run_metrics.take(block)
        readers, status = (recorder, run_metrics), self.status
        attributes = {"problem": problem.to_json(), "status": status.name.lower()}
        grid, duration = self.grid, self.duration
        return read_off(start, readers, trajectory, status, grid, duration, attributes=attributes)

    def _start_of(self, junction: Junction) -> float:
        return 0.0 if junction.before is None else junction.before.visit.end_time

    def reach(self, direction: int, beside: float = READ_BESIDE) -> float:
        """Return a change that moves the run by a distance at most, at a fixed time too."""
        rates = self.directions[direction]
        sizes = [1.0, float(np.max(np.abs(rates.pack())[: len(rates.top) + 10]))]
        size = 0.0
        for leg in self.legs:
            if isinstance(leg, IntegratedLeg) and direction not in self.failures:
                solution = leg.solutions[direction // TOGETHER]
                terms = solution.terms
                size = len(leg.last)
                place = 1 + direction % TOGETHER
                tangent = terms[:, place * size : (place + 1) * size, 0]
                sizes += [float(np.max(np.abs(tangent), initial=0.0))]
                spans = np.diff(solution.knots)
                lasts = spans > 0.0  # Rounding may leave a step of no length.
                rates_of_change = terms[lasts, :size, 1] / spans[lasts, None]
                fastest = float(np.max(np.abs(rates_of_change), initial=1.0))
                sizes += [fastest * abs(float(times[direction])) for times in leg.times]
        return beside / max(sizes)


class RunReading(NamedTuple):
    """What a run shows."""

    run: xr.Dataset
    """Its dataset."""
    states: Sequence[State]
    """The states just after its events, natural units."""
    units: Units
    """The natural units."""

    @property
    def variables(self) -> dict[str, xr.Variable]:
        """All its variables by name, with those of `EVENT_STATES`."""
        rows = np.array([state.pack() for state in self.states], dtype=float).reshape(-1, 10)
        scales = 1.0, self.units.angular_momentum, self.units.speed
        values: list[Array] = [
            rows[:, 3 * place : 3 * place + 3] * scale for place, scale in enumerate(scales)
        ]
        values.append(rows[:, 9] * self.units.length)
        named = dict[str, xr.Variable]()
        for (name, described), one in zip(EVENT_STATES.items(), values, strict=True):
            dimensions = ("event", "space")[: one.ndim]
            named[name] = xr.Variable(dimensions, one, described.attributes)
        return {**{str(name): one for name, one in self.run.variables.items()}, **named}


def require_impact(numbers: StartNumbers, kind: Kind, transition: Transition) -> None:
    """Refuse, with `Differs`, an impact beside the run for which the coefficient of restitution is
    out of its range, or friction is where restitution is full: then another condition ends it.
    """
    if not any(event.kind is EventKind.IMPACT for event in transition.events):
        return
    if not 0.0 <= numbers.restitution <= 1.0:
        raise Differs(AT_BOUND)
    if numbers.restitution == 1.0 and getattr(numbers.top_of(kind).friction, "mu", 0.0) < 0.0:
        raise Differs(ELASTIC)


def is_integrated(visit: Visit) -> bool:
    """Return whether a mode is followed by its equations of motion alone.

    The guards of a flight with a vertical axis are others than those of flights beside it. Bounces
    that die away are followed whole.
    """
    if isinstance(visit.mode, Flight):
        return not is_level(visit.state) and visit.end_time - visit.time > SHORT_FLIGHT
    return is_plainly_integrated(visit.mode)


def is_plainly_integrated(mode: object) -> bool:
    """Return whether a mode goes from its first step on as the equations of motion say."""
    return isinstance(mode, IntegratedMode) and type(mode).segments is IntegratedMode.segments


def goes_on(mode: Mode, end: ModeEnd | None) -> bool:
    """Return whether the same motion goes on after the end of a mode, so that a run beside the run
    may go on in another mode there.

    Rolling on one contact is only about to end where its guard falls; on two it ends there.
    """
    if end is None:
        return False
    is_about_to_end = end.cause == ROLLING_STOPPING and len(mode.tops) == 1
    return is_about_to_end or end.cause in FOLLOWED_ON or end.cause in OTHER_FORMULA


def guard_slopes(
    guard: Guard, at: tuple[Array, Array], carried: tuple[Array, Array]
) -> tuple[Array, Array]:
    """Return the derivatives of a guard in every direction, and its gradient.

    `at` are the numbers and their derivatives, `carried` the parameters and theirs.
    """
    (y, tangents), (parameters, rates) = at, carried
    count, size = tangents.shape
    numbers = duals(y, np.vstack([tangents, np.eye(size)]))
    others = duals(parameters, np.vstack([rates, np.zeros((size, len(parameters)))]))
    changes, gradient = np.split(parts_of(guard.value(numbers, others), count + size), [count])
    return changes, gradient


def guard_of(guards: Sequence[Guard], end: ModeEnd | None) -> Guard | None:
    """Return the guard that ended a mode; None if the run did."""
    if end is None:
        return None
    for guard in guards:
        named = ModeEnd.by_guard(guard.name, end.state)
        if (named.cause, named.contact) == (end.cause, end.contact):
            return guard
    return None


def same(transition: Transition, nominal: Transition) -> Transition:
    """Return a transition if it is that of the run but for its numbers.

    Raises
    ------
    Differs
        If it is not.
    """
    kinds = [event.kind for event in transition.events]
    if kinds != [event.kind for event in nominal.events]:
        raise Differs(OTHER_EVENTS)
    mode, expected = transition.next, nominal.next
    if isinstance(mode, Mode) and isinstance(expected, Mode):
        names = (mode.label, mode.form), (expected.label, expected.form)
        alike = type(mode) is type(expected) and names[0] == names[1]
    else:
        alike = mode is expected
    if not alike:
        raise Differs(OTHER_EVENTS)
    return transition
