"""Where a guard falls through zero within a step of an integrator whose guards are no polynomials.

A guard is a function of the state, of which a step has polynomials; the guard along them is none.
So it is looked at in places that divide the step evenly. Between two of them it falls from positive
to not positive, or it dips and returns (`brackets`), and then its zero is bracketed.
`dormand_prince.suspect` tells in a loop over arrays which steps need no search. Taylor's method has
the polynomials of its guards, and `tippetop.integrators.polynomial_zeros` searches them by bounds.
"""

# translate module: numbers

import math
from collections.abc import Callable, Iterator, Sequence

from tippetop.integrators.base import Array
from tippetop.integrators.dormand_prince import EARLIEST, GUARD_INTERVALS, RISEN
from tippetop.mechanics.roots import crossing, dip

Dense = Callable[[float], Array]
"""The solution within a step as a function of time."""

StateFunction = Callable[[Array], float]
"""A guard as a function of the state."""

TimeFunction = Callable[[float], float]
"""A guard as a function of time."""

AT_ONCE = 1e-3
"""Part of a step. A fall within it does not count if the guard is positive at the end of the step:
there the guard is zero but for errors, and a motion that stopped there would stop again and again.
"""

INEXACT = 0.05
"""How near zero a dip must come, as a part of its depth, for the interpolation not to be trusted
about it.
"""

BESIDE = 1e-6
"""Distance, as a part of that between two probes, at which a guard is compared with its value at a
probe to tell whether it rises there; much nearer, the difference is rounding.
"""


def first_fall(
    guards: Sequence[StateFunction],
    dense: Dense,
    advance: Dense,
    step: tuple[float, float],
) -> tuple[int, float, Array] | None:
    """Return the guard that first falls through zero within a step, when, and the state then.

    A guard that dips below zero and returns within the step is found by minimising it between the
    probes where its probed values bend that way; one that starts at zero, rises, and is back before
    the first probe, by looking earlier.

    Parameters
    ----------
    guards
        The guards.
    dense
        The solution within the step, as interpolated.
    advance
        The same by a step of its own: dearer, and exact where the interpolation of a long step is
        not.
    step
        Where it begins and ends.
    """
    fall = _fall_along(guards, dense, advance, step, 0.0)
    if fall is None:
        return None
    number, guess = fall
    polished = _polished(guards[number], advance, step, guess)
    if polished is not None:
        return number, *polished

    def landed(time: float) -> Array:
        return advance(time) if step[0] < time < step[1] else dense(time)

    # The interpolation is wrong by more than the guard is: only ends of steps tell.
    fall = _fall_along(guards, landed, landed, step, AT_ONCE)
    return None if fall is None else (*fall, landed(fall[1]))


def _fall_along(
    guards: Sequence[StateFunction],
    dense: Dense,
    advance: Dense,
    step: tuple[float, float],
    least: float,
) -> tuple[int, float] | None:
    """Return the guard that first falls along a solution, and when; see `first_fall`.

    One that falls before this least part of the step and is positive at its end is passed over.
    """
    if not guards:
        return None
    first: tuple[int, float] | None = None
    start, end = step
    probes = [
        start + probe / GUARD_INTERVALS * (end - start) for probe in range(GUARD_INTERVALS)
    ] + [end]
    states = [dense(time) for time in probes]
    for index, guard in enumerate(guards):
        values = [value_of(guard, state) for state in states]
        value, exact = _along(guard, dense), _along(guard, advance)
        for low, high, function in brackets(probes, values, value, exact):
            time = crossing(function, low, high)
            if values[GUARD_INTERVALS] > 0.0 and time - start < least * (end - start):
                continue
            if first is None or time < first[1]:
                first = index, time
            break
    return first


def _along(guard: StateFunction, solution: Dense) -> TimeFunction:
    """Return a guard along a solution, as a function of time; infinite at a pole of the guard."""
    return lambda time: value_of(guard, solution(time))


def value_of(guard: StateFunction, state: Array) -> float:
    """Return the value of a guard; infinite at a pole, before which another guard may fall."""
    try:
        return guard(state)
    except ArithmeticError:
        return math.inf


def brackets(
    probes: Sequence[float], values: Sequence[float], value: TimeFunction, exact: TimeFunction
) -> Iterator[tuple[float, float, TimeFunction]]:
    """Yield the intervals over which the guard falls from positive to not positive, and the
    solution in which it does, in turn.
    """
    last, least = len(probes) - 1, min(values)
    if least > 0.0 and 2.0 * least >= max(values):
        return  # The values vary too little for a dip to reach zero.
    if max(values[:2]) <= 0.0:
        early = _early_bracket(probes[0], probes[last], last, value)
        if early is not None:
            yield early
    for i in range(last + 1):
        before, after = max(i - 1, 0), min(i + 1, last)
        if values[i] > 0.0 and values[i] <= min(values[before], values[after]):
            # Between the probes it may be lower, though by little: by less than it falls within two
            # of them.
            drop = max(values[max(i - 2, 0) : i + 3]) - values[i]
            if values[i] < drop:
                place, lowest = dip(value, probes[before], probes[after])
                if lowest <= 0.0:
                    yield probes[before], place, value
                elif (
                    lowest < INEXACT * drop and exact(place) <= 0.0 and exact(probes[before]) > 0.0
                ):
                    yield probes[before], place, exact
        if values[i] > 0.0 and values[after] <= 0.0:
            if values[i] < values[before]:
                # Where it rises at the probe before its fall, it may have dipped before that, too.
                near = probes[i] - BESIDE * (probes[i] - probes[before])
                if value(near) < values[i]:
                    place, lowest = dip(value, probes[before], probes[i])
                    if lowest <= 0.0:
                        yield probes[before], place, value
            yield probes[i], probes[after], value


def _early_bracket(
    start: float, end: float, intervals: int, value: TimeFunction
) -> tuple[float, float, TimeFunction] | None:
    """Return the interval before the first probe over which a guard falls that starts at zero and
    rises.
    """
    part = EARLIEST
    while part < 1.0 / intervals:
        low, high = start + part * (end - start), start + 2.0 * part * (end - start)
        if value(low) > RISEN and value(high) <= 0.0:
            return low, high, value
        part *= 2.0
    return None


def _polished(
    guard: StateFunction, advance: Dense, step: tuple[float, float], guess: float
) -> tuple[float, Array] | None:
    """Improve the time of a guard's zero with solutions that really end there.

    The solution inside a step is less accurate than at its ends, so the step is taken again with
    other ends, `advance(time)`, until the secant no longer moves. None if it leads far away, as to
    where a guard began at zero, or comes to no place: the solution inside the step is wrong by more
    than the guard is, and that need not fall.
    """
    start, end = step
    shift = min(1e-4 * (end - start), 0.1 * (guess - start))
    time, previous = guess, guess - shift if guess - shift > start else guess + shift
    state, beside = advance(time), advance(previous)
    value, theirs = (value_of(guard, one) for one in (state, beside))
    moved, finest = shift, 1e-3 * shift
    for _ in range(8):
        if not 0.0 < abs(value - theirs) < math.inf:
            break
        new = time - value * (time - previous) / (value - theirs)
        moved = abs(new - time)
        new = min(max(new, start + finest), end + shift)
        if abs(new - time) <= 4e-16 * max(1.0, abs(new)):
            break
        time, previous, beside, theirs = new, time, state, value
        state = advance(new)
        value = value_of(guard, state)
    if moved > max(finest, 4e-16 * max(1.0, abs(time))) or abs(time - guess) > 0.5 * (
        guess - start
    ):
        return None
    return (time, state) if abs(value) <= abs(theirs) else (previous, beside)
