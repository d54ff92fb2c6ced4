"""What the step-by-step integrators share: steps as polynomials, and where a guard falls through zero."""

from collections.abc import Callable, Sequence
from itertools import pairwise

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from tippetop.integrators.base import Arc, Array, Guard
from tippetop.integrators.dense import DenseSolution, chebyshev
from tippetop.integrators.rates import RightHandSide

Dense = Callable[[float], Array]
"""The solution within a step as a function of time."""

PROBES = tuple(np.linspace(0.0, 1.0, 9).tolist())
"""Where within a step a guard is looked at, as fractions of the step."""

INEXACT = 0.05
"""How near zero a dip must come, as a part of its depth, for the interpolation not to be trusted about it."""

EARLY = tuple(0.5**k for k in range(40, 2, -1))
"""Where else a guard is looked at that starts at zero, or by rounding below: one is within any rebound."""

RISEN = 1e-15
"""What such a guard must reach to have risen: less is rounding."""


class Steps:
    """Collects the steps of an arc, each by the values of its solution at Chebyshev's points.

    Parameters
    ----------
    rates
        The rates of the motion.
    start
        Time at which the arc begins.
    degree
        Of the polynomials that are to stand for the solution.
    """

    def __init__(self, rates: RightHandSide, start: float, degree: int) -> None:
        self.rates, self.degree = rates, degree
        self.knots, self.values, self._counted = [start], list[Array](), rates.calls

    def __len__(self) -> int:
        return len(self.values)

    def take(self, end: float, dense: Dense, advance: Dense) -> Arc | None:
        """Take in a step up to a time, or the last arc if a guard falls through zero in it.

        Parameters
        ----------
        end
            Where the step ends.
        dense, advance
            The solution within it; see `first_fall`.
        """
        motion, parameters, step = self.rates.motion, self.rates.parameters, (self.knots[-1], end)
        fall = first_fall(motion.guards, parameters, dense, advance, step)
        if fall is None:
            self._keep(end, dense)
            return None
        guard = motion.guards[fall[0]]
        at, last = polish(guard, parameters, advance, step, fall[1])
        self._keep(at, dense)
        return self.arc(last, guard.name)

    def _keep(self, end: float, dense: Dense) -> None:
        start = self.knots[-1]
        places = chebyshev(self.degree)[0]
        self.values.append(np.array([dense(start + place * (end - start)) for place in places.tolist()]))
        self.knots.append(end)

    def arc(self, state: Array, guard: str | None = None, failure: str | None = None) -> Arc:
        """The steps as an arc that ends in a state; the next begins there."""
        values = np.array(self.values).reshape(-1, self.rates.motion.size)
        solution = DenseSolution.fitted(lambda _: values.T, np.array(self.knots), self.degree)
        arc = Arc(solution, state, guard, failure, len(self), self.rates.calls - self._counted)
        self.knots, self.values, self._counted = [self.knots[-1]], [], self.rates.calls
        return arc


def first_fall(
    guards: Sequence[Guard],
    parameters: Sequence[float],
    dense: Dense,
    advance: Dense,
    step: tuple[float, float],
) -> tuple[int, float] | None:
    """The guard that first falls through zero within a step, and when.

    A guard that dips below zero and returns within the step is found by minimising it between the probes
    where its probed values bend that way; one that starts at zero, rises, and is back before the first probe,
    by looking earlier.

    Parameters
    ----------
    guards, parameters
        The guards, and the numbers in them.
    dense
        The solution within the step, as interpolated.
    advance
        The same by a step of its own: dearer, and exact where the interpolation of a long step is not.
    step
        Where it begins and ends.
    """
    if not guards:
        return None
    first: tuple[int, float] | None = None
    start, end = step
    probes = [start + fraction * (end - start) for fraction in PROBES]
    states = [dense(time) for time in probes]
    for index, guard in enumerate(guards):

        def value(time: float, solution: Dense = dense, guard: Guard = guard) -> float:
            return float(guard.value(solution(time).tolist(), parameters))

        def exact(time: float, value: Callable[[float, Dense], float] = value) -> float:
            return value(time, advance)

        values = [float(guard.value(state.tolist(), parameters)) for state in states]
        found = _early_bracket(step, value) if max(values[:2]) <= 0 else None
        found = found or _bracket(probes, values, value, exact)
        if found is None:
            continue
        low, high, function = found
        time = float(brentq(function, low, high, xtol=1e-15 * max(1.0, abs(end)), rtol=1e-15))
        if first is None or time < first[1]:
            first = index, time
    return first


Value = Callable[[float], float]


def _early_bracket(step: tuple[float, float], value: Value) -> tuple[float, float, Value] | None:
    """The interval before the first probe over which a guard falls that starts at zero and rises."""
    start, end = step
    probes = [start + fraction * (end - start) for fraction in EARLY]
    for low, high in pairwise(probes):
        if value(low) > RISEN and value(high) <= 0:
            return low, high, value
    return None


def _bracket(
    probes: Sequence[float], values: Sequence[float], value: Value, exact: Value
) -> tuple[float, float, Value] | None:
    """The first interval over which the guard falls from positive to not positive, and in which solution."""
    last = len(probes) - 1
    for i in range(last + 1):
        before, after = max(i - 1, 0), min(i + 1, last)
        if values[i] > 0 and values[i] <= min(values[before], values[after]):
            # Between the probes it may be lower, though by little: by less than it falls within two of them.
            drop = max(values[max(i - 2, 0) : i + 3]) - values[i]
            if values[i] < drop:
                low = minimize_scalar(value, bounds=(probes[before], probes[after]), method="bounded")
                if low.fun <= 0:
                    return probes[before], float(low.x), value
                if low.fun < INEXACT * drop and exact(float(low.x)) <= 0 < exact(probes[before]):
                    return probes[before], float(low.x), exact
        if values[i] > 0 >= values[after]:
            return probes[i], probes[after], value
    return None


def polish(
    guard: Guard,
    parameters: Sequence[float],
    advance: Callable[[float], Array],
    step: tuple[float, float],
    guess: float,
) -> tuple[float, Array]:
    """Improve the time of a guard's zero with solutions that really end there.

    The solution inside a step is less accurate than at its ends, so the step is taken again with other ends,
    `advance(time)`, until the secant no longer moves.
    """
    start, end = step
    shift = min(1e-4 * (end - start), 0.1 * (guess - start))
    times = [guess, guess - shift if guess - shift > start else guess + shift]
    states = [advance(time) for time in times]
    values = [float(guard.value(state.tolist(), parameters)) for state in states]
    for _ in range(8):
        if values[0] == values[1]:
            break
        new = times[0] - values[0] * (times[1] - times[0]) / (values[1] - values[0])
        new = min(max(new, start + 1e-3 * shift), end + shift)
        if abs(new - times[0]) <= 4e-16 * max(1.0, abs(new)):
            break
        times = [new, times[0]]
        states = [advance(new), states[0]]
        values = [float(guard.value(states[0].tolist(), parameters)), values[0]]
    best = int(np.argmin(np.abs(values)))
    return times[best], states[best]
