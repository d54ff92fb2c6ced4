"""Taylor's method of high order: steps taken, and looked through for guards, in compiled code."""

import ctypes
import math
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import Any, ClassVar, NamedTuple

import numpy as np

from tippetop.graph.llvm import llvm_source
from tippetop.graph.llvm_series import room_size, series_source, with_choices
from tippetop.graph.recording import Recorded, record, recordable
from tippetop.graph.taylor_coefficients import NodeArithmetic
from tippetop.integrators.base import NO_STEP, NOT_FINITE, TOLERANCES, Arc, Array, Guard, Motion
from tippetop.integrators.dense import DenseSolution
from tippetop.integrators.machine_code import loaded
from tippetop.integrators.polynomial_minima import looked_at, may_fall
from tippetop.integrators.polynomial_zeros import single_fall
from tippetop.integrators.polynomials import Polynomials
from tippetop.mechanics.series import horner
from tippetop.mechanics.vectors import Scalar

STEPS_PER_ARC = 4096
"""Steps in an arc at most: after each it is looked whether the motion is stiff."""

PROBES_PER_STEP = 12
"""Intervals of a step at whose ends compiled code looks at the guards."""

RESOLVED = 1e6
"""Step, in roundings of time, below which only a solution that blows up is followed: these matter
in it.
"""

LEFT_OUT = 100.0
"""What the last terms of a step may add to a number, in tolerances of that number or of 1, the
larger; beside huge slip or friction, to which they are compared too, the axis would go astray.
"""

SLOW_CLOCK = 2.0**-30
"""Unit, in natural units of time, of the clock by which a motion is followed once its
coefficients, or products of them, are too large for floats. In a motion that changes within 1e-10,
those of order 20 are 1e200 times its numbers; by this clock they are far smaller. A power of two
does not round times.
"""

GUARDED = 2.0**-5
"""Weight of the last terms of guards beside those of the state. A guard's zero needs fewer digits,
since the state there is the state's own polynomial: by itself a guard would cost steps.
"""

BEYOND = 8.0
"""How far beyond a change of branch of a law a step goes, in roundings of time: then the next step
is on the other branch. It is followed that far on the wrong one.
"""

POLISHES, NEAR, EXACT = 2, 1e-3, 1e-9
"""Newton's improvements of the time at which a guard falls, and how far they may go, as a part of
the step: further they do where a guard hardly falls. Newton's method doubles the digits that are
right: an improvement below the last, as a part of the step, is the last one.
"""

TURNED, UNSURE = 1e-2, 1e-10
"""Value at the zero of its polynomial, as a part of that at the step's begin and in natural units,
beyond which a guard does not fall there. What polynomials leave out is less, or the tolerance.
"""

FALL = 2
"""Results of the search in a guard: when it falls, and whether that is undecided."""

CACHE_LINE = 64
"""Bytes that are loaded together."""

NODES = NodeArithmetic()

_PLACE = ctypes.c_void_p

ROWS_LOOP = """\
define void @{name}(ptr %rows, i64 %count, ptr %numbers, ptr %out) {{
entry:
  br label %next
next:
  %i = phi i64 [ 0, %entry ], [ %later, %row ]
  %left = icmp ult i64 %i, %count
  br i1 %left, label %row, label %end
row:
  %first = mul i64 %i, {length}
  %begin = getelementptr double, ptr %rows, i64 %first
  %place = mul i64 %i, {results}
  %to = getelementptr double, ptr %out, i64 %place
  call void @{function}(ptr %begin, ptr %numbers, ptr %to, i64 1)
  %later = add i64 %i, 1
  br label %next
end:
  ret void
}}
"""
"""The loop that calls a function for the coefficients of every number of the state, or of every
guard. Each call has so many results of its own, or, if none, brings up to date those of all.
"""

STEPS_LOOP = """\
declare void @llvm.memcpy.p0.p0.i64(ptr, ptr, i64, i1)
declare void @llvm.memset.p0.i64(ptr, i8, i64, i1)
define void @scale_all(ptr %raw, i64 %size, ptr %powers, ptr %row) {{
entry:
  %terms = mul i64 %size, {count}
  %after = getelementptr double, ptr %row, i64 %terms
  br label %number
number:
  %i = phi i64 [ 0, %entry ], [ %next, %number ]
  %offset = mul i64 %i, {count}
  %from = getelementptr double, ptr %raw, i64 %offset
  %to = getelementptr double, ptr %row, i64 %offset
  %sum = getelementptr double, ptr %after, i64 %i
  call void @scale(ptr %from, ptr %powers, ptr %to, i64 1, ptr %sum)
  %next = add i64 %i, 1
  %more = icmp ult i64 %next, %size
  br i1 %more, label %number, label %end
end:
  ret void
}}
define i64 @follow(ptr %jet, ptr %y, ptr %p, ptr %room, ptr %raw, ptr %rows, i64 %most, i64 %size,
i64 %guards) alignstack(64) {{
entry:
  %measures = alloca [{measures} x double]
  %looked = alloca [2 x double]
  %powers = alloca [{order} x double]
  %terms = mul i64 %size, {count}
  %guard_rows = getelementptr double, ptr %raw, i64 %terms
  %guard_numbers = mul i64 %guards, {order}
  %clock = getelementptr double, ptr %guard_rows, i64 %guard_numbers
  %watch = getelementptr double, ptr %clock, i64 3
  %largest_place = getelementptr double, ptr %measures, i64 {largest}
  %clock_copy = getelementptr double, ptr %measures, i64 {clock}
  %doubt_place = getelementptr double, ptr %looked, i64 1
  %time_at = add i64 %terms, %size
  %width = add i64 %time_at, 4
  %state_bytes = mul i64 %size, 8
  br label %step
step:
  %steps = phi i64 [ 0, %entry ], [ %next, %advance ]
  %begin = mul i64 %steps, %width
  %row = getelementptr double, ptr %rows, i64 %begin
  call void %jet(ptr %y, ptr %p, ptr %room, ptr %raw)
  call void @llvm.memset.p0.i64(ptr %measures, i8 0, i64 24, i1 false)
  store double 1.0, ptr %largest_place
  call void @all_largest(ptr %raw, i64 %size, ptr %measures, ptr %largest_place)
  call void @all_ratios(ptr %raw, i64 %size, ptr %measures, ptr %measures)
  call void @all_guard_ratios(ptr %guard_rows, i64 %guards, ptr %measures, ptr %measures)
  call void @llvm.memcpy.p0.p0.i64(ptr %clock_copy, ptr %clock, i64 24, i1 false)
  %time = getelementptr double, ptr %row, i64 %time_at
  call void @timing(ptr %measures, ptr %measures, ptr %time, i64 1)
  %span_place = getelementptr double, ptr %time, i64 3
  call void @powers(ptr %span_place, ptr %span_place, ptr %powers, i64 1)
  call void @scale_all(ptr %raw, i64 %size, ptr %powers, ptr %row)
  %span = load double, ptr %span_place
  %moves = fcmp ogt double %span, 0.0
  br i1 %moves, label %look, label %stop
look:
  %watches = load double, ptr %watch
  %watched = fcmp ogt double %watches, 0.0
  %guards_watched = select i1 %watched, i64 %guards, i64 0
  store double %span, ptr %looked
  store double 0.0, ptr %doubt_place
  call void @all_looks(ptr %guard_rows, i64 %guards_watched, ptr %looked, ptr %doubt_place)
  %doubt = load double, ptr %doubt_place
  %may_fall = fcmp ogt double %doubt, 0.0
  br i1 %may_fall, label %stop, label %advance
advance:
  %state = getelementptr double, ptr %row, i64 %terms
  call void @llvm.memcpy.p0.p0.i64(ptr %y, ptr %state, i64 %state_bytes, i1 false)
  call void @llvm.memcpy.p0.p0.i64(ptr %clock, ptr %time, i64 16, i1 false)
  store double 1.0, ptr %watch
  %next = add i64 %steps, 1
  %place = getelementptr double, ptr %time, i64 2
  %goes_on = load double, ptr %place
  %left = fcmp ogt double %goes_on, 0.0
  %room_left = icmp ult i64 %next, %most
  %again = and i1 %left, %room_left
  br i1 %again, label %step, label %end
end:
  ret i64 %next
stop:
  ret i64 %steps
}}
"""
"""The loop over steps. A step that is not taken leaves its row after those of the others."""


@dataclass(frozen=True)
class Taylor:
    """Adaptive Taylor series, accurate to rounding at its default tolerance.

    A motion that cannot be recorded (see `tippetop.graph.recording`) is left to SciPy's Dormand and
    Prince of order 8: its arcs say so.
    """

    tolerance: float = TOLERANCES["taylor"]
    """Relative and absolute error per step, at least 2.2e-16."""
    name: str = field(default="taylor", init=False)
    caution: ClassVar[str] = ""

    def integrate(
        self, motion: Motion, parameters: Sequence[float], start: tuple[float, Array], end: float
    ) -> Iterator[Arc]:
        """Follow the motion; see `tippetop.integrators.base.Integrator`."""
        if _recorded(motion) is None:
            from tippetop.integrators.scipy_methods import SciPy  # noqa: PLC0415 - slow to import

            method = SciPy("dop853", max(self.tolerance, TOLERANCES["dop853"]))
            for arc in method.integrate(motion, parameters, start, end):
                yield replace(arc, method=method)
            return
        for arc in self._arcs(motion, parameters, start, end):
            if arc.failure != NOT_FINITE:
                yield arc
                continue
            if arc.steps and len(arc.solution.terms):
                yield replace(arc, failure=None)
            yield from self._slowed_arcs(motion, parameters, arc, end)

    def _slowed_arcs(
        self, motion: Motion, parameters: Sequence[float], before: Arc, end: float
    ) -> Iterator[Arc]:
        """Follow a motion by the slower clock, from the end of an arc on."""
        start = before.solution.end / SLOW_CLOCK, before.end_state
        numbers = (*parameters, SLOW_CLOCK)
        for arc in self._arcs(_slowed(motion), numbers, start, end / SLOW_CLOCK):
            solution = DenseSolution(SLOW_CLOCK * arc.solution.knots, arc.solution.terms)
            yield replace(arc, solution=solution)

    def _arcs(
        self, motion: Motion, parameters: Sequence[float], start: tuple[float, Array], end: float
    ) -> Iterator[Arc]:
        """Follow a motion that can be recorded."""
        stepper = _stepper(motion, order_for(self.tolerance), self.tolerance)
        run = Run(stepper, parameters, start, end)
        while run.time < end:
            begin = run.time
            steps, guard, failure = run.advance(STEPS_PER_ARC)
            rounding = steps * np.spacing(abs(run.time))
            if failure is None and guard is None and run.time - begin < min(rounding, end - begin):
                failure = NO_STEP  # steps shorter than rounding of time lead nowhere
            solution = run.solution(begin, steps)
            if failure is not None:
                solution = _before_blow_up(solution)
                state = solution(solution.knots[-1:])[0] if len(solution.terms) else run.start_state
                yield Arc(solution, state, None, failure, steps, run.expansions)
                return
            name = None if guard is None else motion.guards[guard].name
            yield Arc(solution, run.state, name, None, steps, run.expansions)
            if guard is not None:
                return


def order_for(tolerance: float) -> int:
    """Return the degree of the polynomials for a tolerance (Jorba and Zou 2005)."""
    return max(2, math.ceil(1.0 - 0.5 * math.log(tolerance)))


class SeriesExpansion:
    """The compiled function that expands a motion's solution and guards to some order.

    `expand` takes the addresses of the state, the parameters, the room, and of what it fills with
    the coefficients of state and guards.
    """

    def __init__(self, recorded: Recorded, order: int) -> None:
        self._engine = loaded(series_source(recorded, order))
        self.address = self._engine.get_function_address("jet")
        self.expand: Callable[..., None] = ctypes.CFUNCTYPE(None, *[_PLACE] * 4)(self.address)
        self._room = room_size(recorded, order)
        guards = len(recorded.outputs) - recorded.size
        self.coefficients = recorded.size * (order + 1) + guards * order

    def room(self) -> Array:
        """Return the room the function needs, which no other call uses meanwhile."""
        return aligned_zeros(self._room)


class StepLayout(NamedTuple):
    """Where numbers lie in what a step takes, `raw`, and makes, a row."""

    size: int
    guards: int
    order: int

    @property
    def terms(self) -> int:
        """How many coefficients the state has: these are the first of both."""
        return self.size * (self.order + 1)

    @property
    def clock(self) -> int:
        """Place in `raw`, after the guards' coefficients, of the time and of what rounding has
        taken from it, of the end, and of whether guards are looked at.
        """
        return self.terms + self.guards * self.order

    @property
    def raw(self) -> int:
        """How many numbers a step takes."""
        return self.clock + 4

    @property
    def time(self) -> int:
        """Place in a row, after the next state, of the next time and of what rounding took; then
        come whether there is another step, and the length of this one.
        """
        return self.terms + self.size

    @property
    def row(self) -> int:
        """How many numbers a step makes."""
        return self.time + 4


class CompiledSteps:
    """Compiled steps of one motion at one tolerance."""

    def __init__(self, motion: Motion, recorded: Recorded, order: int, tolerance: float) -> None:
        self.jet = SeriesExpansion(recorded, order)
        self.guards, self.order, self.unsure = len(motion.guards), order, max(UNSURE, tolerance)
        self.layout = StepLayout(recorded.size, len(recorded.outputs) - recorded.size, order)
        self._engine = _step_code(order, min(LEFT_OUT, 1.0 / tolerance))
        kind = ctypes.CFUNCTYPE(ctypes.c_int64, *[_PLACE] * 6, *[ctypes.c_int64] * 3)
        self.follow: Callable[..., int] = kind(self._engine.get_function_address("follow"))
        falls = ctypes.CFUNCTYPE(None, _PLACE, ctypes.c_int64, *[_PLACE] * 2)
        self.falls: Callable[..., None] = falls(self._engine.get_function_address("all_falls"))
        # Rooms that nobody uses at present: threads take one each.
        self.rooms = list[Array]()

    def room(self) -> Array:
        """Return room for an arc's rows."""
        return self.rooms.pop() if self.rooms else np.empty((STEPS_PER_ARC + 1) * self.layout.row)


class Run:
    """A motion under way: its state, and the steps of the arc that is being made."""

    def __init__(
        self,
        stepper: CompiledSteps,
        parameters: Sequence[float],
        start: tuple[float, Array],
        end: float,
    ) -> None:
        self.stepper, self.layout = stepper, stepper.layout
        self.parameters = np.array([*parameters, 0.0], dtype=float)
        self._state = np.array(start[1], dtype=float)
        self._raw, self._room = np.zeros(self.layout.raw), stepper.jet.room()
        self._places = [
            part.ctypes.data for part in (self._state, self.parameters, self._room, self._raw)
        ]
        self._clock = self._raw[self.layout.clock :]
        self._clock[:] = start[0], 0.0, end, 1.0
        self._knots, self._terms = np.empty(0), np.empty(0)
        terms, order = self.layout.terms, self.layout.order
        self._guard_values = self._raw[terms : terms + stepper.guards * order : order]
        self._were_positive = np.zeros(stepper.guards, dtype=bool)
        self.start_state, self.expansions = self.state, 0

    @property
    def time(self) -> float:
        """Where it is."""
        return float(self._clock[0])

    @property
    def state(self) -> Array:
        """The state there."""
        return self._state.copy()

    def advance(self, most: int) -> tuple[int, int | None, str | None]:
        """Take so many steps at most; return how many, the guard that ends the last, and why there
        are no more.
        """
        stepper, layout = self.stepper, self.layout
        room = stepper.room()
        rows, steps = room.reshape(-1, layout.row), 0
        self.start_state, self.expansions = self.state, 0
        guard = failure = None
        while steps < most and self.time < self._clock[2]:
            place, counts = rows[steps:].ctypes.data, (most - steps, layout.size, layout.guards)
            unsearched = int(self._clock[3] == 0.0)
            count = stepper.follow(stepper.jet.address, *self._places, place, *counts)
            steps, self.expansions = steps + count, self.expansions + count
            if count > unsearched:  # The search has found all guards positive.
                self._were_positive[:] = True
            if steps == most or self.time >= self._clock[2]:
                break
            self.expansions += 1
            guard = self._fallen_at_start()
            if guard is not None:
                break
            span = float(rows[steps, -1])
            if not span > 0.0:
                failure = NOT_FINITE
                break
            fall = self._first_fall(span, rows[steps, layout.row - 1 :].ctypes.data)
            if fall is None:
                self._clock[3] = 0.0  # The step is taken again, whatever the guards.
                continue
            number, fall_time = fall
            guard = number if number < stepper.guards else None
            if guard is None:
                fall_time += BEYOND * float(np.spacing(abs(self.time) + fall_time))
                fall_time = self._until_moved(rows[steps], span, fall_time)
            else:
                polished = self._polished(rows[steps], span, guard, fall_time)
                guard = None if polished is None else guard
                fall_time = 0.5 * fall_time if polished is None else polished
            self._end_at(rows[steps], span, fall_time)
            steps += 1
            if guard is not None:
                break
        if guard is None and failure is None and stepper.guards:
            stepper.jet.expand(*self._places)
            self.expansions += 1
            guard = self._fallen_at_start()
        self._knots, self._terms = (
            rows[:steps, layout.time].copy(),
            rows[:steps, : layout.terms].copy(),
        )
        stepper.rooms.append(room)
        return steps, guard, failure

    def solution(self, begin: float, steps: int) -> DenseSolution:
        """Return the steps that were taken last, from the time at which they began."""
        shape = steps, self.layout.size, self.layout.order + 1
        return DenseSolution(np.append(begin, self._knots), self._terms.reshape(shape))

    def _fallen_at_start(self) -> int | None:
        """Return the guard that is not positive where a step starts and was so a step before.

        Its own polynomial may not show that it falls: it leaves out as much as is left of the
        guard, by rounding or at a loose tolerance. Of several, nothing tells which fell first: all
        were positive throughout the step before and fall at its end, the same instant. The first by
        number is returned.
        """
        fallen = self._were_positive & (self._guard_values <= 0.0)
        self._were_positive = self._guard_values > 0.0
        return int(fallen.argmax()) if fallen.any() else None

    def _first_fall(self, span: float, span_place: int) -> tuple[int, float] | None:
        """Return which guard, or margin of a choice, falls first in a step, and when.

        Compiled code searches. It leaves undecided guards that begin at zero or come near it.
        """
        layout = self.layout
        rows, results = self._raw[layout.terms : layout.clock], np.empty((layout.guards, FALL))
        self.stepper.falls(rows.ctypes.data, layout.guards, span_place, results.ctypes.data)
        times, undecided = results.T.tolist()
        if any(undecided):
            terms = rows.reshape(layout.guards, layout.order).T
            # A margin may be zero at first, and then falls at once.
            is_guard = np.arange(layout.guards) < self.stepper.guards
            spans = np.full(layout.guards, span)
            times = Polynomials(terms, spans).first_fall(after_rise=is_guard).tolist()
        fallen = [(time, number) for number, time in enumerate(times) if time <= span]
        if not fallen:
            return None
        fall_time, first = min(fallen)
        return first, fall_time

    def _polished(self, row: Array, span: float, guard: int, fall: float) -> float | None:
        """Return when a guard falls along the polynomials of the state, by Newton's method.

        The guard's own polynomial differs from it by what both leave out. None if it does not fall
        there: a guard like sqrt(x^2 + tiny^2) turns where its polynomial goes on.
        """
        place = self.layout.terms + guard * self.layout.order
        positive = max(TURNED * float(self._raw[place]), self.stepper.unsure)
        for _ in range(POLISHES):
            self._state[:] = np.cumsum(self._at(row, fall / span), axis=1)[:, -1]
            self.stepper.jet.expand(*self._places)
            value, slope = self._raw[place : place + 2].tolist()
            if value > positive:
                return None
            move = -value / slope if slope < 0.0 else math.nan
            if not (abs(move) <= NEAR * span and 0.0 < fall + move <= span):
                break
            fall += move
            if abs(move) <= EXACT * span:
                break
        return fall

    def _until_moved(self, row: Array, span: float, fall: float) -> float:
        """Return the time from a branch's change on at which rounding shows that the state has
        moved; else the next step would end at the same change. It is within the step.
        """
        while fall < span and not np.any(
            np.cumsum(self._at(row, fall / span), axis=1)[:, -1] - self._state
        ):
            fall = min(2.0 * fall, span)
        return fall

    def _at(self, row: Array, part: float) -> Array:
        """Return the terms of a step up to a part of it, the last of them first."""
        layout = self.layout
        terms = row[: layout.terms].reshape(layout.size, layout.order + 1)
        return (terms * part ** np.arange(layout.order + 1))[:, ::-1]

    def _end_at(self, row: Array, span: float, fall: float) -> None:
        """End a step sooner."""
        layout, (time, lost, end) = self.layout, self._clock[:3]
        terms = self._at(row, fall / span)
        self._state[:] = np.cumsum(terms, axis=1)[:, -1]
        row[: layout.terms] = terms[:, ::-1].ravel()
        row[layout.time] = min(time + (lost + fall), end)
        self._clock[:2] = row[layout.time], 0.0
        self._clock[3] = 1.0


@lru_cache(maxsize=64)
def _stepper(motion: Motion, order: int, tolerance: float) -> CompiledSteps:
    """Return the compiled steps of a motion that can be recorded."""
    recorded = _recorded(motion)
    assert recorded is not None
    return CompiledSteps(motion, recorded, order, tolerance)


def coefficients_at(
    motion: Motion, parameters: Sequence[float], state: Array
) -> tuple[list[list[float]], list[list[float]], list[list[float]]]:
    """Return what `tippetop.integrators.expansion.expanded` does, by compiled code."""
    tolerance = TOLERANCES["taylor"]
    stepper = _stepper(motion, order_for(tolerance), tolerance)
    layout, jet = stepper.layout, stepper.jet
    raw, room = np.zeros(layout.raw), jet.room()
    numbers, y = np.array([*parameters, 0.0], dtype=float), np.array(state, dtype=float)
    jet.expand(*[part.ctypes.data for part in (y, numbers, room, raw)])
    terms = raw[: layout.terms].reshape(layout.size, layout.order + 1).tolist()
    falls = raw[layout.terms : layout.clock].reshape(layout.guards, layout.order).tolist()
    return terms, falls[: stepper.guards], falls[stepper.guards :]


@lru_cache(maxsize=64)
def _slowed(motion: Motion) -> Motion:
    """Return a motion by another clock, whose unit of time is the last parameter."""

    def rates(y: Sequence[Scalar], p: Sequence[Scalar]) -> list[Scalar]:
        return [p[motion.parameters] * rate for rate in motion.rates(y, p[: motion.parameters])]

    def slowed(guard: Guard) -> Guard:
        return replace(guard, value=lambda y, p: guard.value(y, p[: motion.parameters]))

    guards = tuple([slowed(guard) for guard in motion.guards])
    return replace(motion, rates=rates, parameters=motion.parameters + 1, guards=guards)


@lru_cache(maxsize=64)
def _recorded(motion: Motion) -> Recorded | None:
    """Return rates, guards and margins of choices of a motion; None where it cannot be recorded."""

    def values(y: Sequence[Scalar], p: Sequence[Scalar]) -> list[Scalar]:
        return [*motion.rates(y, p), *[guard.value(y, p) for guard in motion.guards]]

    recorded = recordable(values, motion.size, motion.parameters)
    return None if recorded is None else with_choices(recorded)


class Measures(NamedTuple):
    """What a step's length and its end follow from: numbers beside one another in compiled code."""

    before_last: Scalar
    """The largest last coefficient but one of a number or a guard, over what may be left out."""
    last: Scalar
    """The largest last coefficient."""
    total: Scalar
    """Sum of the last two coefficients of the state's numbers, which is finite if they are."""
    largest: Scalar
    """The largest number of the state, at least 1."""
    time: Scalar
    lost: Scalar
    """What rounding has taken from the time."""
    end: Scalar


@lru_cache(maxsize=64)
def _step_code(order: int, left_out: float) -> Any:
    """Compile the functions that make a step of coefficients and look at a guard, and the loops
    over numbers, guards and steps.

    They know nothing of what moves, so that they serve all motions.
    """
    measures, count = len(Measures._fields), order + 1

    def largest(terms: Sequence[Scalar], p: Sequence[Scalar]) -> list[Scalar]:
        return [larger(NODES.size(terms[0]), Measures(*p).largest)]

    def ratios(terms: Sequence[Scalar], p: Sequence[Scalar]) -> list[Scalar]:
        return with_number(Measures(*p), terms, left_out)

    def guard_ratio(terms: Sequence[Scalar], p: Sequence[Scalar]) -> list[Scalar]:
        return with_guard(Measures(*p), terms)

    def timing(p: Sequence[Scalar], _: Sequence[Scalar]) -> list[Scalar]:
        return timing_of(Measures(*p), order)

    functions = {
        "largest": record(largest, count, measures),
        "ratios": record(ratios, count, measures),
        "guard_ratio": record(guard_ratio, order, measures),
        "timing": record(timing, measures, 0),
        "powers": record(lambda span, _: span_powers(span[0], order), 1, 0),
        "scale": record(scaled, count, order, 1),
        "look": record(doubt_about, order, 2),
        "fall": record(fall_of, order, 1),
    }
    loops = {
        "all_largest": ("largest", count, 0),
        "all_ratios": ("ratios", count, 0),
        "all_guard_ratios": ("guard_ratio", order, 0),
        "all_looks": ("look", order, 0),
        "all_falls": ("fall", order, FALL),
    }
    lines = [
        ROWS_LOOP.format(name=name, function=function, length=length, results=results)
        for name, (function, length, results) in loops.items()
    ]
    driver = STEPS_LOOP.format(
        order=order,
        count=count,
        measures=measures,
        largest=Measures._fields.index("largest"),
        clock=Measures._fields.index("time"),
    )
    return loaded(llvm_source(functions, 1) + "".join(lines) + driver)


def doubt_about(terms: Sequence[Scalar], looked: Sequence[Scalar]) -> list[Scalar]:
    """Return how many guards may fall in a step of some length, from how many of those before."""
    span, doubt = looked
    return [doubt + may_fall(terms, looked_at(terms, span, PROBES_PER_STEP), span, NODES)]


def fall_of(terms: Sequence[Scalar], spans: Sequence[Scalar]) -> list[Scalar]:
    """Return when a guard first falls in a step, inf if never, and whether that is undecided."""
    return [*single_fall(terms, spans[0], NODES)]


def with_number(measures: Measures, terms: Sequence[Scalar], left_out: float) -> list[Scalar]:
    """Return the first three measures with those of a number of the state.

    Its last coefficients are compared with the largest number, but with no more than `left_out`
    times the number itself, or 1 if that is larger.
    """
    bound = left_out * larger(NODES.size(terms[0]), 1.0)
    weight = 1.0 / NODES.least(bound, measures.largest)
    before_last, last = NODES.size(terms[-2]), NODES.size(terms[-1])
    return [
        larger(before_last * weight, measures.before_last),
        larger(last * weight, measures.last),
        measures.total + (before_last + last),
    ]


def with_guard(measures: Measures, terms: Sequence[Scalar]) -> list[Scalar]:
    """Return the first measure with that of a guard, which has one coefficient less."""
    weight = GUARDED / larger(NODES.size(terms[0]), 1.0)
    return [larger(NODES.size(terms[-1]) * weight, measures.before_last)]


def timing_of(measures: Measures, order: int) -> list[Scalar]:
    """Return the time after a step, what rounding took from it, whether there is another step, and
    the length of this one.

    No polynomial's last two terms are more than may be left out in a step (Jorba and Zou 2005). Its
    length is 0 where coefficients are no numbers.
    """
    plain, (time, lost, end) = NODES, measures[4:]
    before_last = (1.0 / measures.before_last) ** (1.0 / (order - 1))
    radius = plain.least(before_last, (1.0 / measures.last) ** (1.0 / order))
    length = math.exp(-2.0 - 0.7 / (order - 1)) * radius
    length = plain.choose(plain.below(measures.total, math.inf), length, 0.0)
    remaining = (end - time) - lost
    span = plain.least(length, remaining)
    # What rounding takes from the time is given back (Knuth's sum of two numbers).
    reached = time + span
    moved = reached - time
    lost = lost + ((time - (reached - moved)) + (span - moved))
    goes_on = plain.below(span, remaining)
    later = reached + lost
    return [plain.choose(goes_on, later, end), lost - (later - reached), goes_on, span]


def span_powers(span: Scalar, order: int) -> list[Scalar]:
    """Return the powers of a step's length from the first on."""
    powers = [span]
    for _ in range(1, order):
        # A long step of what hardly moves has powers beyond all floats; 0 times inf is none.
        powers.append(NODES.least(powers[-1] * span, sys.float_info.max))
    return powers


def scaled(terms: Sequence[Scalar], powers: Sequence[Scalar]) -> list[Scalar]:
    """Return a number's coefficients in powers of the part of a step, and the number after it."""
    parts = [term * power for term, power in zip(terms[1:], powers, strict=True)]
    return [terms[0], *parts, horner(terms, powers[0])]


def larger(a: Any, b: Any) -> Any:
    """Return the larger of two; the second where the first is not a number."""
    return NODES.choose(NODES.below(b, a), a, b)


def aligned_zeros(count: int) -> Array:
    """Return so many zeros that begin where a line of the processor's cache does."""
    every = CACHE_LINE // 8
    room = np.zeros(count + every)
    first = (-room.ctypes.data // 8) % every
    return room[first : first + count]


def _before_blow_up(solution: DenseSolution) -> DenseSolution:
    """Return a solution that ends in numbers that are none without the steps in which rounding of
    time matters.
    """
    spans, ends = np.diff(solution.knots), np.abs(solution.knots)
    resolved = RESOLVED * np.spacing(np.maximum(ends[:-1], ends[1:]))
    fine = np.flatnonzero(spans > resolved)
    steps = fine[-1] + 1 if len(fine) else 0
    return DenseSolution(solution.knots[: steps + 1], solution.terms[:steps])
