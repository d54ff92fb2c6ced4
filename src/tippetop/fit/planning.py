"""Plans of measurements: what to film, how long, and at how many frames a second.

The errors of a fit follow from the derivatives of what will be observed, before anything is
observed (Fisher information). They fall with the square root of the number of frames.
"""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from tippetop.fit.measurement import Measurement
from tippetop.fit.model import Model
from tippetop.fit.observations import Camera, EventTimes, Observation, SpinRate, Variables
from tippetop.integrators.base import Array
from tippetop.problem.problem import Problem, require_problem
from tippetop.run import simulate
from tippetop.support.errors import InvalidInput, is_number
from tippetop.support.suggestions import not_one_of
from tippetop.support.units import number_in
from tippetop.support.validation import require_names

FRAME_RATE = 60.0
"""Frames a second of the planned film: an ordinary phone's."""

PARTS = (0.25, 0.5, 1.0)
"""Parts of the longest duration that are compared."""

MOST_FRAMES = 1200
"""Frames that are predicted at most; of longer films, fewer a second."""

SINGULAR = 1e-7
"""Singular value, relative to the largest, below which numbers are not told apart."""

NOISES = {
    "tilt": 0.02,
    "tip from the side": 5e-4,
    "tip from above": 5e-4,
    "turns a minute": 10.0,
    "time of turning over": 0.1,
}
"""Usual standard deviations: rad, m, m, rpm, s."""


class PlannedMeasurement(NamedTuple):
    """A way to measure, and what it will tell."""

    quantity: str
    duration: float
    """s."""
    frame_rate: float
    """Frames a second that the accuracy needs; infinite if no number of them is enough, 0 if it is
    one reading of a clock."""
    error: float
    """Relative standard error of the target at 60 frames a second."""


def plan_measurement(
    problem: Problem,
    duration: Any,
    vary: str | Sequence[str],
    *,
    accuracy: float = 0.05,
    noise: Mapping[str, float] | None = None,
) -> list[PlannedMeasurement]:
    """Return ways to measure the first of some numbers to an accuracy, the easiest first.

    Parameters
    ----------
    problem
        The top as it is believed to be: plans are for numbers near these.
    duration
        Longest time to film, s.
    vary
        Fields of numbers that are not known and will be fitted together; the first is the target.
    accuracy
        Relative standard error of the target.
    noise
        Standard deviations of the quantities that can be measured, in rad, m, rpm and s; None for
        the usual ones of all: "tilt" 0.02, "tip from the side" and "tip from above" 5e-4, "turns a
        minute" 10, "time of turning over" 0.1.

    Raises
    ------
    InvalidInput
        If there is no such field or quantity.

    Examples
    --------
    >>> import tippetop as tt
    >>> ways = tt.plan_measurement(tt.presets.report_problem(), 1.0, ["friction.mu"])
    >>> bool(ways[0].error < 0.05 and ways[0].frame_rate < 60.0)
    True
    """
    require_problem(problem)
    if not (is_number(accuracy) and accuracy > 0.0):
        raise InvalidInput("accuracy", accuracy, "a number greater than 0, such as 0.05")
    deviations = NOISES if noise is None else noise
    for quantity, deviation in deviations.items():
        if quantity not in NOISES:
            raise not_one_of("noise", quantity, NOISES)
        if not (is_number(deviation) and deviation > 0.0):
            raise InvalidInput(f"noise.{quantity}", deviation, "a number greater than 0")
    fields = require_names("vary", vary)
    seconds = float(number_in("duration", duration, "s"))
    measurements = _planned(problem, seconds, deviations)
    model = Model(problem, list(measurements.values()), fields)
    numbers = model.start
    jacobian = model.jacobian(numbers, exact=True) * model.scales(numbers)
    target = abs(numbers[0]) / model.scales(numbers)[0]
    ends = np.cumsum([one.values.size for one in measurements.values()])[:-1]
    plans = list[PlannedMeasurement]()
    for place, (quantity, one) in enumerate(measurements.items()):
        names = [*model.fields, *model.instruments[place].values()]
        columns = [model.names.index(name) for name in names]
        block = np.split(jacobian, ends)[place][:, columns] / deviations[quantity]
        if not len(one.times):
            error = _error(block) / target
            rate = 0.0 if error <= accuracy else np.inf
            plans.append(PlannedMeasurement(quantity, float(one.values[0, 0]), rate, error))
            continue
        rows = np.repeat(one.times, one.values.shape[1])
        sparse = len(one.times) / (FRAME_RATE * seconds)
        for part in PARTS:
            # Errors of a film with fewer frames than 60 a second, scaled to that.
            error = _error(block[rows <= part * seconds]) * min(sparse, 1.0) ** 0.5 / target
            rate = FRAME_RATE * (error / accuracy) ** 2
            plans.append(PlannedMeasurement(quantity, part * seconds, rate, error))
    return sorted(plans, key=lambda plan: (plan.frame_rate * plan.duration, plan.duration))


def _planned(
    problem: Problem, duration: float, deviations: Mapping[str, float]
) -> dict[str, Measurement]:
    """Return measurements that show the run of the problem itself."""
    frames = int(min(FRAME_RATE * duration, MOST_FRAMES)) + 1
    times = np.linspace(0.0, duration, frames)
    run = simulate(problem, duration, times=times)
    instruments: dict[str, Observation] = {
        "tilt": Variables(("tilt",)),
        "tip from the side": Camera("side", "tip", 1.0, "m"),
        "tip from above": Camera("above", "tip", 1.0, "m"),
        "turns a minute": SpinRate(),
        "time of turning over": EventTimes(("turnover_time",)),
    }
    camera = {"camera.angle": 0.5, "camera.x": 0.0, "camera.y": 0.0}
    planned = dict[str, Measurement]()
    for quantity, observation in instruments.items():
        values = observation(run, camera)
        if quantity not in deviations or not np.isfinite(values).all():
            continue  # A top that does not turn over shows no time of it.
        at = times[: len(values)] if len(values) > 1 else np.empty(0)
        noise = np.full(values.shape[1], deviations[quantity])
        planned[quantity] = Measurement(at, values, observation, noise, quantity)
    if not planned:
        accepted = "quantities that the run shows"
        raise InvalidInput("noise", ", ".join(deviations), accepted, "are not to be seen in it")
    return planned


def _error(jacobian: Array) -> float:
    """Return the standard error of the first number; infinite if the rows do not determine it."""
    _, strengths, directions = np.linalg.svd(jacobian)
    strengths = np.append(strengths, np.zeros(len(directions) - len(strengths)))
    singular = strengths <= SINGULAR * strengths[0]
    if np.any(np.abs(directions[singular, 0]) > SINGULAR**0.5) or not np.isfinite(strengths).all():
        return np.inf
    return float(np.linalg.norm(directions[~singular, 0] / strengths[~singular]))
