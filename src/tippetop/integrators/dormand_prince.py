"""Steps of Dormand and Prince's method of order 8(5,3), in Python that the page translates.

Hairer, Norsett and Wanner 1993, Solving Ordinary Differential Equations I, section II.10: order,
error estimate, step sizes and dense output are as in SciPy's DOP853. Sums are compensated: what
rounding takes from the state in a step is given back in the next.
"""

# translate module: arrays

import math
from collections.abc import Callable
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

Array: TypeAlias = NDArray[np.float64]
Compiled: TypeAlias = Callable[[Array, Array, Array], None]
"""A function of state and parameters that puts what it makes of them into the last argument."""

stages: Any = None
more_stages: Any = None
combined: Any = None
polynomials: Any = None
"""What `tableau.written_out` writes, so that numbers are in it and no loops over them."""

REACHED, FULL, SUSPECT, STUCK, SINGULAR = range(5)
"""How `advance` ends: at the end, out of room, after a step in which a guard may fall, or unable to
go on.
"""

SAFETY, LEAST_FACTOR, MOST_FACTOR = 0.9, 0.2, 10.0
"""How much of the step that the error allows is taken, and how much steps may differ."""

NOTHING = 2e-15
"""A step shorter than this part of the time does not move it."""

EARLIEST, RISEN = 0.5**40, 1e-15
"""Where else a guard is looked at that starts at zero: one place is within any rebound; and what it
must reach there to have risen: less is rounding.
"""

ROWS = 21
"""Stages of a step, 16, two estimates of its error, and room for three states."""

POWERS = 8
"""Coefficients of each of a step's polynomials."""

GUARD_INTERVALS = 8
"""Parts of a step at whose ends guards are looked at."""

STEADY, TIGHT = 1.25, 1e-6
"""What the greatest of a guard's values at the ends and the middle of a step is below, in units of
the least, if it is looked at nowhere else; and the tolerance up to which that will do: such steps
are a small part of what swings, those of a loose one are not.
"""


def evaluate(function: Compiled, y: Array, p: Array, out: Array) -> None:
    """Call a motion's function."""
    function(y, p, out)


def fixed(array: Array) -> Array:
    """Return an array whose shape a compiler may rely on."""
    return array


def probe_guards(
    guards: Compiled,
    p: Array,
    terms: Array,
    first: int,
    end: Array,
    y: Array,
    values: Array,
    room: Array,
    tight: bool,
) -> bool:
    """Put the guards' values at the looks of a step into the rows of values after the first.

    The last are those of the state `end` itself, with which the next step starts: so a guard falls
    within a step, never between two. False where they vary so little at a tight tolerance that none
    falls: only those at its middle and its end are there then.
    """
    within(terms, first, 0.5, y)
    evaluate(guards, y, p, values[GUARD_INTERVALS // 2])
    evaluate(guards, end, p, values[GUARD_INTERVALS])
    if tight and are_steady(values):
        return False
    for number in range(1, GUARD_INTERVALS):
        if 2 * number != GUARD_INTERVALS:
            within(terms, first, number / GUARD_INTERVALS, y)
            evaluate(guards, y, p, values[number])
    return True


def are_steady(values: Array) -> bool:
    """Return whether all guards vary little from the start of a step to its middle and end."""
    for guard in range(len(values[0])):
        begin, end = values[0, guard], values[GUARD_INTERVALS, guard]
        middle = values[GUARD_INTERVALS // 2, guard]
        bound = STEADY * min(begin, middle, end)
        if not (begin < bound and middle < bound and end < bound):
            return False
    return True


def error_of(h: float, y: Array, new: Array, k: Array, tolerance: Array, size: int) -> float:
    """Error of a step: less than 1 is good enough."""
    combined(y, k)
    fifth, third = 0.0, 0.0
    for i in range(len(y)):
        scale = tolerance[1] + tolerance[0] * max(abs(y[i]), abs(new[i]))
        first, second = k[16, i] / scale, k[17, i] / scale
        fifth += first * first
        third += second * second
    return (
        0.0
        if fifth == 0.0 and third == 0.0
        else h * fifth / math.sqrt((fifth + 0.01 * third) * size)
    )


def eighth_root(number: float) -> float:
    """Return the eighth root, quicker than by a power."""
    return math.sqrt(math.sqrt(math.sqrt(number)))


def factor_for(error: float, tries: int) -> float:
    """By how much a step of this error may be longer."""
    if not error < 1.0:
        # What is no number, after a step too far, is less than the least factor too.
        factor = SAFETY / eighth_root(error)
        return factor if factor > LEAST_FACTOR else LEAST_FACTOR
    factor = MOST_FACTOR if error == 0.0 else min(MOST_FACTOR, SAFETY / eighth_root(error))
    return factor if tries == 1 else min(1.0, factor)


def measure(a: Array, b: Array, y: Array, tolerance: Array, size: int) -> float:
    """Return the root mean square of a difference, relative to the errors that are allowed."""
    total = 0.0
    for i in range(len(y)):
        part = (a[i] - b[i]) / (tolerance[1] + tolerance[0] * abs(y[i]))
        total += part * part
    return math.sqrt(total / size)


def first_step(
    rates: Compiled,
    p: Array,
    y: Array,
    k: Array,
    place: Array,
    span: float,
    tolerance: Array,
    size: int,
) -> float:
    """Return a step to begin with, whose error is about right, and put the rates into k[0]; -1
    where there are none.
    """
    evaluate(rates, y, p, k[0])
    for i in range(size):
        if not math.isfinite(k[0, i]):
            return -1.0
    for i in range(len(y)):
        place[i] = 0.0
    extent, slope = measure(y, place, y, tolerance, size), measure(k[0], place, y, tolerance, size)
    trial = min(span, 1e-6 if extent < 1e-5 or slope < 1e-5 else 0.01 * extent / slope)
    for i in range(len(y)):
        place[i] = y[i] + trial * k[0, i]
    evaluate(rates, place, p, k[1])
    steepest = max(slope, measure(k[1], k[0], y, tolerance, size) / trial)
    allowed = max(1e-6, trial * 1e-3) if steepest <= 1e-15 else eighth_root(0.01 / steepest)
    return min(100.0 * trial, allowed, span)


def within(terms: Array, first: int, part: float, y: Array) -> None:
    """Put the state at a part of a step, whose coefficients are from `first` on, in y."""
    at = first
    for i in range(len(y)):
        high = terms[at + 4] + part * (
            terms[at + 5] + part * (terms[at + 6] + part * terms[at + 7])
        )
        low = terms[at + 2] + part * (terms[at + 3] + part * high)
        y[i] = terms[at] + part * (terms[at + 1] + part * low)
        at += POWERS


def may_fall(values: Array, guard: int) -> bool:
    """Return whether a guard with these values at the looks falls through zero, or may dip below it
    in between.
    """
    least, most = values[0, guard], values[0, guard]
    for i in range(1, GUARD_INTERVALS + 1):
        least = min(least, values[i, guard])
        most = max(most, values[i, guard])
    if least > 0.0 and 2.0 * least >= most:
        return False
    for i in range(GUARD_INTERVALS + 1):
        before, value, after = max(i - 1, 0), values[i, guard], min(i + 1, GUARD_INTERVALS)
        if value > 0.0:
            if values[after, guard] <= 0.0:
                return True
            if value <= values[before, guard] and value <= values[after, guard]:
                for j in range(max(i - 2, 0), min(i + 2, GUARD_INTERVALS) + 1):
                    if 2.0 * value < values[j, guard]:
                        return True
    return False


def rises(
    guards: Compiled, p: Array, terms: Array, first: int, y: Array, values: Array, guard: int
) -> bool:
    """Return whether a guard that starts at zero, or by rounding below, rises before the first
    look.
    """
    part = 1.0 / GUARD_INTERVALS
    while part > EARLIEST:
        part *= 0.5
        within(terms, first, part, y)
        evaluate(guards, y, p, values[GUARD_INTERVALS + 1])
        if values[GUARD_INTERVALS + 1, guard] > RISEN:
            return True
    return False


def suspect(
    guards: Compiled,
    p: Array,
    terms: Array,
    first: int,
    end: Array,
    y: Array,
    values: Array,
    room: Array,
    tight: bool,
) -> bool:
    """Return whether a guard may fall in a step that ends in a state; values has those at its
    start, and room for the other looks.
    """
    if not probe_guards(guards, p, terms, first, end, y, values, room, tight):
        return False
    for guard in range(len(values[0])):
        if may_fall(values, guard):
            return True
        low = values[0, guard] <= 0.0 and values[1, guard] <= 0.0
        if low and rises(guards, p, terms, first, y, values, guard):
            return True
    return False


def take_step(
    rates: Compiled,
    p: Array,
    y: Array,
    lost: Array,
    k: Array,
    span: Array,
    tolerance: Array,
    terms: Array,
    first: int,
    size: int,
    moved: Array,
    new: Array,
    place: Array,
) -> int:
    """Take the longest step whose error is allowed; how many were tried, 0 if none is long enough.

    It brings the time in `span` up to date too, and puts the coefficients of its polynomials into
    `terms`, from `first` on; the last three are room.
    """
    time, reach, error, tries = span[0], span[0], 2.0, 0
    while not error < 1.0:
        if not span[2] > NOTHING * abs(time):
            return 0
        reach = min(time + span[2], span[1])
        stages(rates, reach - time, p, y, lost, k, new, moved)
        error = error_of(reach - time, y, new, k, tolerance, size)
        tries += 1
        span[2] = (reach - time) * factor_for(error, tries)
    more_stages(rates, reach - time, p, y, lost, k, place)
    polynomials(reach - time, y, new, k, terms, first)
    for i in range(len(y)):
        lost[i] = moved[i] - (new[i] - y[i])
        y[i] = new[i]
        k[0, i] = k[12, i]
    span[0] = reach
    return tries


def advance(
    rates: Compiled,
    guards: Compiled,
    count: int,
    p: Array,
    y: Array,
    lost: Array,
    k: Array,
    span: Array,
    tolerance: Array,
    knots: Array,
    terms: Array,
    steps: int,
    size: int,
) -> tuple[int, int, int]:
    """Take steps from a state, which is brought up to date.

    A motion is rates and guards, so many as `count`, of its state y and parameters p. What rounding
    has taken from the state so far is in `lost`. The rows of `k`, shape (`ROWS`, n), are room for
    the rates of the stages, of which the first have been found unless all begins here, and for what
    is made of them. `span` is the time, the end, and the next step's size, to begin with 0 or minus
    the least to be tried: time and size are brought up to date. `tolerance` is the relative and the
    absolute error per step. `knots`, shape (n + 1,), and `terms` are room for the ends of steps and
    the coefficients of their polynomials, those of each number in a row; `steps` of them are there.
    The state has `size` numbers; its rows, and those of what is made of it, may be longer, with
    zeros at the end.

    It returns how many steps are there then, how often the rates were asked for, and how it ended.
    """
    y, lost, k = fixed(y), fixed(lost), fixed(k)
    moved, new, place = k[ROWS - 3], k[ROWS - 2], k[ROWS - 1]
    values = np.empty((GUARD_INTERVALS + 2, count))
    room = np.empty(GUARD_INTERVALS * (len(y) + count))
    calls = 0
    if span[2] <= 0.0:
        trial = first_step(rates, p, y, k, place, span[1] - span[0], tolerance, size)
        if trial < 0.0:
            return steps, 1, SINGULAR
        span[2] = max(trial, -span[2])
        calls += 2
    if count > 0:
        evaluate(guards, y, p, values[0])
    while span[0] < span[1]:
        if steps == len(knots) - 1:
            return steps, calls, FULL
        first = steps * len(y) * POWERS
        tries = take_step(
            rates, p, y, lost, k, span, tolerance, terms, first, size, moved, new, place
        )
        if tries == 0:
            return steps, calls, STUCK
        calls += 12 * tries + 3
        steps += 1
        knots[steps] = span[0]
        if count > 0:
            if suspect(guards, p, terms, first, y, place, values, room, tolerance[0] <= TIGHT):
                return steps, calls, SUSPECT
            for guard in range(count):
                values[0, guard] = values[GUARD_INTERVALS, guard]
    return steps, calls, REACHED
