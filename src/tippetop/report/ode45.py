"""MATLAB's ode45 as the report used it: Dormand-Prince 5(4) with ode45's step control.

SciPy's RK45 has the same formulas and another step control: it measures the error by its root mean
square, ode45 by its largest component, and the two change the step by different rules. At the
default tolerance this difference moves the instants of a sensitive motion by tenths of a second.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.integrate import RK45

from tippetop.integrators.base import Array

Rates = Callable[[Array], Array]

RELATIVE, ABSOLUTE = 1e-3, 1e-6
"""Default tolerances of ode45."""

REFINE = 4
"""Number of points of output per step."""

_A, _B, _E, _P = RK45.A, RK45.B, RK45.E, RK45.P
_PARTS = np.arange(1, REFINE) / REFINE
_POWERS = _PARTS[:, None] ** np.arange(1, 5)
_STAGES = 7


@dataclass(frozen=True)
class Solution:
    """Solution by ode45."""

    times: Array
    states: Array
    """Ends of the steps with the points of output between them, shapes (k,) and (k, size)."""
    steps: int
    evaluations: int
    """Number of accepted steps, and of evaluations of the right-hand side."""
    failure: str | None = None
    """Why the integration stopped early, or None."""


def dormand_prince_step(
    rates: Rates, state: Array, slope: Array, step: float
) -> tuple[Array, Array]:
    """Return the state after one step of the fifth-order formula, and the rates at its stages.

    `state` and its rates `slope` have shape (size,), the rates at the stages (7, size).
    """
    stages = np.empty((_STAGES, len(state)))
    stages[0] = slope
    for i in range(1, _STAGES - 1):
        stages[i] = rates(state + step * (_A[i, :i] @ stages[:i]))
    end = state + step * (_B @ stages[:-1])
    stages[-1] = rates(end)
    return end, stages


def ode45(
    rates: Rates,
    duration: float,
    start: Array,
    relative: float = RELATIVE,
    absolute: float = ABSOLUTE,
) -> Solution:
    """Return the solution of y' = rates(y) by the algorithm of MATLAB's ode45.

    The tolerances are per step; `start` is the state at time 0, shape (size,). Source: Shampine and
    Reichelt (1997).
    """
    threshold, longest = absolute / relative, 0.1 * duration
    time, state = 0.0, np.array(start, dtype=float)
    slope = rates(state)
    evaluations, steps = 1, 0
    pace = float(np.max(np.abs(slope) / np.maximum(np.abs(state), threshold))) / (
        0.8 * relative**0.2
    )
    step = min(longest, 1.0 / pace) if pace > 0 else longest
    times, states = [time], [state]

    def result(failure: str | None = None) -> Solution:
        return Solution(np.array(times), np.array(states), steps, evaluations, failure)

    while time < duration:
        shortest = 16.0 * float(np.spacing(time))
        step = min(longest, max(shortest, step))
        if 1.1 * step >= duration - time:
            step = duration - time
        failed = False
        while True:
            try:
                end, stages = dormand_prince_step(rates, state, slope, step)
            except (ArithmeticError, ValueError) as error:
                return result(f"the solution is no longer finite ({error})")
            evaluations += _STAGES - 1
            weight = np.maximum(np.maximum(np.abs(state), np.abs(end)), threshold)
            error_size = step * float(np.max(np.abs(_E @ stages) / weight))
            if error_size <= relative:
                break
            if step <= shortest or not np.isfinite(error_size):
                return result("no step is short enough for the tolerance")
            shrink = 0.5 if failed else max(0.1, 0.8 * (relative / error_size) ** 0.2)
            step, failed = max(shortest, step * shrink), True
        steps += 1
        times.extend(time + step * _PARTS)
        states.extend(state + step * (_POWERS @ (stages.T @ _P).T))
        time = duration if step == duration - time else time + step
        state, slope = end, stages[-1]
        times.append(time)
        states.append(state)
        if not failed:
            growth = 1.25 * (error_size / relative) ** 0.2
            step = step / growth if growth > 0.2 else 5.0 * step
    return result()
