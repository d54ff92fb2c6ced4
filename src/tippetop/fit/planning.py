"""Plans of measurements: what to film, how long, and at how many frames a second.

The errors of a fit follow from the derivatives of what will be observed, before anything is
observed (Fisher information). They fall with the square root of the number of frames. A plan is
confirmed by fits of made data before it is told.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from tippetop.fit.least_squares import fit
from tippetop.fit.measurement import Measurement
from tippetop.fit.model import Model, nutation_period
from tippetop.fit.observations import Camera, EventTimes, Observation, SpinRate, Variables
from tippetop.integrators.base import Array
from tippetop.problem.problem import Problem, require_problem
from tippetop.run import simulate
from tippetop.support.errors import InvalidInput, NotConverged, is_number
from tippetop.support.suggestions import not_one_of
from tippetop.support.units import number_in
from tippetop.support.validation import require_names

FRAME_RATE = 60.0
"""Frames a second of the film whose derivatives are computed."""

PHONE_RATES = (30.0, 60.0, 120.0, 240.0)
"""Frames a second that phones have."""

FRAMES_PER_PERIOD = 2.2
"""Frames on each period of the nutation, at least: with fewer than two it looks like a slower one,
and other spins fit equally well."""

FRAMES_PER_NUMBER = 2
"""Frames for each fitted number, at least."""

CONFIRMED = 1.5
"""Ratio of the error of a fit of made data to the plan's up to which the plan holds."""

MADE_FITS = 3
"""Fits of made data that confirm a plan: of a number that data hardly determine, one may have a
small error by chance.
"""

MOST_OFF = 4.0
"""Standard errors from the truth up to which a fit of made data confirms a plan."""

PARTS = (0.25, 0.5, 1.0)
"""Parts of the longest duration that are compared."""

MOST_FRAMES = 1200
"""Frames that are predicted at most; of longer films, fewer a second."""

CAMERA = {"camera.angle": 0.5, "camera.x": 0.0, "camera.y": 0.0}
"""Direction, rad, and origin of the planned pictures."""

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
    """A plan to measure, and what it will tell.

    Examples
    --------
    >>> import tippetop as tt
    >>> tt.PlannedMeasurement("tilt", duration=2.0, frame_rate=60.0, error=0.01).frame_rate
    60.0
    """

    quantity: str
    duration: float
    """s."""
    frame_rate: float
    """Frames a second, one of 30, 60, 120 and 240; 0 if it is one reading of a clock."""
    error: float
    """Relative standard error of the target: the largest of fits of made data."""


def plan_measurement(
    problem: Problem,
    duration: Any,
    vary: str | Sequence[str],
    *,
    accuracy: float = 0.05,
    noise: Mapping[str, float] | None = None,
) -> list[PlannedMeasurement]:
    """Return ways to measure the first of some numbers to an accuracy, the easiest first.

    There is one for each quantity that can be measured so well: the one with the fewest pictures
    that resolve the nutation, at a rate that a phone has. Each is confirmed by fits of made data.

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
        If there is no such field or quantity, or none of the quantities is enough.

    Examples
    --------
    >>> import tippetop as tt
    >>> ways = tt.plan_measurement(tt.presets.report_problem(), 1.0, ["friction.mu"])
    >>> bool(ways[0].error < 0.05 and ways[0].frame_rate <= 240.0)
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
    measurements = planned_measurements(problem, seconds, deviations)
    model = Model(problem, list(measurements.values()), fields)
    numbers = model.start
    jacobian = model.jacobian(numbers) * model.scales(numbers)
    target = abs(numbers[0]) / model.scales(numbers)[0]
    ends = np.cumsum([one.values.size for one in measurements.values()])[:-1]
    fastest = nutation_period(problem)
    slowest = FRAMES_PER_PERIOD / fastest if fastest else 0.0
    plans, reached = list[PlannedMeasurement](), dict[str, float]()
    for place, (quantity, one) in enumerate(measurements.items()):
        names = [*model.fields, *model.instruments[place].values()]
        columns = [model.names.index(name) for name in names]
        steps = np.split(model.steps, ends)[place][:, None]
        spreads = np.hypot(deviations[quantity], steps)
        block = np.split(jacobian, ends)[place][:, columns] / spreads
        ways = list[PlannedMeasurement]()
        if not len(one.times):
            ways.append(PlannedMeasurement(quantity, float(one.values[0, 0]), 0.0, _error(block)))
        rows = np.repeat(one.times, one.values.shape[1])
        sparse = len(one.times) / (FRAME_RATE * seconds)
        for part in PARTS if len(one.times) else ():
            # Errors of a film with fewer frames than 60 a second, scaled to that.
            error = _error(block[rows <= part * seconds]) * min(sparse, 1.0) ** 0.5
            ways += [
                PlannedMeasurement(
                    quantity, part * seconds, rate, error * (FRAME_RATE / rate) ** 0.5
                )
                for rate in PHONE_RATES
                if rate >= slowest and rate * part * seconds >= FRAMES_PER_NUMBER * len(names)
            ]
        ways = sorted((plan._replace(error=plan.error / target) for plan in ways), key=_pictures)
        reached[quantity] = min((plan.error for plan in ways), default=np.inf)
        for plan in ways:
            if plan.error <= accuracy:
                confirmed = _confirmed(problem, fields, one, plan, deviations[quantity])
                if confirmed is not None and confirmed.error <= accuracy:
                    plans.append(confirmed)
                    break
    if not plans:
        best = min(reached, key=lambda quantity: reached[quantity])
        shown = f"{reached[best]:.2g} by {best}" if np.isfinite(reached[best]) else "nothing"
        fault = f"is not reached by any of these quantities in {seconds:.3g} s: {shown} at best"
        if reached[best] <= accuracy:
            fault += ", which fits of made data do not confirm"
        hint = "film longer, fit fewer numbers, or read them more accurately"
        raise InvalidInput("accuracy", accuracy, "", fault, hint)
    return sorted(plans, key=_pictures)


def _pictures(plan: PlannedMeasurement) -> tuple[float, float]:
    return (plan.frame_rate * plan.duration, plan.duration)


def _confirmed(
    problem: Problem,
    fields: Sequence[str],
    planned: Measurement,
    plan: PlannedMeasurement,
    deviation: float,
) -> PlannedMeasurement | None:
    """Return a plan with the error of fits of made data; None if one does not confirm it."""
    random = np.random.default_rng(0)
    made = planned
    if plan.frame_rate:
        times = np.arange(0.0, plan.duration, 1.0 / plan.frame_rate)
        run = simulate(problem, float(times[-1]), times=times)
        made = replace(planned, times=times, values=planned.observation(run, CAMERA))
    truth, errors = float(problem.get(fields[0])), list[float]()
    for _ in range(MADE_FITS):
        noise = random.normal(0.0, deviation, made.values.shape)
        try:
            fitted = fit(problem, replace(made, values=made.values + noise), fields, starts=1)
        except (InvalidInput, NotConverged):
            return None
        error = fitted.errors[fields[0]]
        is_near = abs(fitted.values[fields[0]] - truth) <= MOST_OFF * error
        ratio = error / (plan.error * abs(truth))
        if not (is_near and 1.0 / CONFIRMED <= ratio <= CONFIRMED):
            return None
        errors.append(error)
    return plan._replace(error=max(errors) / abs(truth))


def planned_measurements(
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
    planned = dict[str, Measurement]()
    for quantity, observation in instruments.items():
        values = observation(run, CAMERA)
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
