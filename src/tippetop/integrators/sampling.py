"""What the step-by-step integrators share: taking samples, and finding where a guard falls through zero."""

from collections.abc import Callable, Sequence

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from tippetop.integrators.base import Array, Guard

Dense = Callable[[float], Array]
"""The solution within a step as a function of time."""

PROBES = (0.0, 0.25, 0.5, 0.75, 1.0)
"""Where within a step a guard is looked at, as fractions of the step."""


class Samples:
    """Collects the solution at the sample times as the steps pass them."""

    def __init__(self, times: Array, start: tuple[float, Array]) -> None:
        self.times = times
        self.states: list[Array] = []
        self._record_until(start[0], lambda _: start[1])

    def _record_until(self, time: float, dense: Dense) -> None:
        while len(self.states) < len(self.times) and self.times[len(self.states)] <= time:
            self.states.append(dense(float(self.times[len(self.states)])))

    def wanted_before(self, time: float) -> bool:
        """Whether some sample not yet taken lies at or before this time."""
        return len(self.states) < len(self.times) and bool(self.times[len(self.states)] <= time)

    def take(self, time: float, dense: Dense) -> None:
        """Take the samples up to this time from a step's solution."""
        self._record_until(time, dense)

    def result(self, size: int) -> tuple[Array, Array]:
        """Sample times reached, shape (k,), and states there, shape (k, size)."""
        return self.times[: len(self.states)], np.array(self.states).reshape(-1, size)


def first_fall(
    guards: Sequence[Guard], parameters: Sequence[float], dense: Dense, step: tuple[float, float]
) -> tuple[int, float] | None:
    """The guard that first falls through zero within a step, and when.

    A guard that dips below zero and returns within the step is found by minimising it between the probes
    where its probed values bend that way.
    """
    first: tuple[int, float] | None = None
    start, end = step
    probes = [start + fraction * (end - start) for fraction in PROBES]
    states = [dense(time) for time in probes]
    for index, guard in enumerate(guards):

        def value(time: float, guard: Guard = guard) -> float:
            return float(guard.value(dense(time).tolist(), parameters))

        values = [float(guard.value(state.tolist(), parameters)) for state in states]
        bracket = _bracket(probes, values, value)
        if bracket is None:
            continue
        time = float(brentq(value, *bracket, xtol=1e-15 * max(1.0, abs(end)), rtol=1e-15))
        if first is None or time < first[1]:
            first = index, time
    return first


def _bracket(
    probes: Sequence[float], values: Sequence[float], value: Callable[[float], float]
) -> tuple[float, float] | None:
    """The first interval over which the guard falls from positive to not positive."""
    for i in range(len(probes) - 1):
        if values[i] > 0 >= values[i + 1]:
            return probes[i], probes[i + 1]
        if i and values[i] <= min(values[i - 1], values[i + 1]):
            # A dip between the probes: its depth is at most a few times the drop that the probes show.
            drop = max(values[i - 1], values[i + 1]) - values[i]
            if 0 < values[i] < 4.0 * drop:
                low = minimize_scalar(value, bounds=(probes[i - 1], probes[i + 1]), method="bounded")
                if low.fun <= 0:
                    return probes[i - 1], float(low.x)
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
    shift = 1e-4 * (end - start)
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
