"""What every program's derivatives share: the exact ones, and differences of whole runs."""

import math
from collections.abc import Callable, Iterator
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

import tippetop as tt
from tippetop.engines.adapters import adapter
from tippetop.engines.adapters.base import Setting
from tippetop.engines.cases import Case
from tippetop.engines.reference import judged_state

Array = NDArray[np.float64]

Gradients: TypeAlias = Iterator[tuple[str, str, Callable[[str], Array]]]
"""Method, setting, and the derivative of the judged state as a function of a parameter."""

PART = 1e-5
"""Change of a number of the launch in differences of whole runs, relative."""


def exact_gradient(case: Case, parameter: str) -> Array:
    """Return the exact derivative of the judged state of a case by a number of its launch."""
    until = float(case.times[case.judged - 1])
    slopes = tt.sensitivities(case.problem, until, [parameter], times=[0.0, until])
    last = slopes.isel(parameter=0, time=-1)
    # A judged state is linear in axis and angular velocity.
    return judged_state(case, last["axis"].values, last["angular_velocity"].values)


def steps_of(case: Case, step: float) -> tuple[int, float]:
    """Return how many steps of about a length lead to the judged state, and their length, s."""
    until = float(case.times[case.judged - 1])
    count = math.ceil(until / step * (1.0 - 1e-9))
    return count, until / count


def by_runs(
    name: str, case: Case, step: float, setting: Setting, part: float, parameter: str
) -> Array:
    """Return the derivative of the judged state in a program by differences of whole runs."""
    count, length = steps_of(case, step)
    value, ends = case.problem.get(parameter), []
    for sign in (1.0, -1.0):
        problem = case.problem.replace({parameter: value * (1.0 + sign * part)})
        run = adapter(name).start(case._replace(problem=problem), length, setting)
        run.advance(count)
        state = run.read()
        ends.append(judged_state(case, state.axis, state.omega))
    slope: Array = (ends[0] - ends[1]) / (2.0 * part * value)
    return slope
