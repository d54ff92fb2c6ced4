"""Derivatives of a run with respect to fields of its problem, through every event."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from tippetop.contact.trajectory import require_limits
from tippetop.fit.linearized_run import BESIDE, CHECKED, LinearizedRun, RunReading
from tippetop.fit.problem_numbers import Direction, natural_size, require_fields
from tippetop.fit.variable_slopes import DIGITS, DISTANCES, NIL, Slopes, size_of, slopes_of
from tippetop.integrators.base import Array
from tippetop.mechanics.top import natural_units
from tippetop.problem.problem import Problem, require_problem, top_of
from tippetop.results.checked_times import sample_times
from tippetop.results.sample_counts import DEFAULT_SAMPLES
from tippetop.support.units import number_in
from tippetop.support.validation import require_names

FEW_DIGITS = (
    "derivatives of which fewer than six digits are known are NaN: differences at two distances"
    " beside the run do not agree better"
)
"""Why single derivatives are missing."""

NO_NUMBER = "not a number in the run itself: {}"
"""Why a metric has no derivatives that is not a number in the run itself."""


def sensitivities(
    problem: Problem,
    duration: float,
    vary: str | Sequence[str],
    *,
    samples: int = DEFAULT_SAMPLES,
    times: ArrayLike | None = None,
) -> xr.Dataset:
    """Return the derivatives of a run with respect to fields of its problem.

    Nothing is smoothed, and whole runs are not compared. Motion in contact is followed with its
    variational equations, as are flights, and the derivative of the time at which a guard falls
    takes them through events (saltation). What an event does - an impact, a reset - with the first
    and last moments of slip, and how variables are read off the solution, are differentiated by
    differences at 1e-4 to 1e-7 beside the run, which leaves relative errors of 1e-9 to 1e-7. Where
    events are differentiated so, all of it is done twice, at two distances, which tells how many
    digits are known.

    Parameters
    ----------
    problem
        The physics.
    duration
        Length of the run, s; or a text such as "1 min", or a quantity of pint.
    vary
        Name or names of fields with a number, such as "friction.mu", "launch.spin" or "gravity".
    samples
        Number of equally spaced samples from launch to end.
    times
        Sample times instead, s: increasing, from 0 to `duration`.

    Returns
    -------
    xarray.Dataset
        The variables of a run (see `tippetop.simulate`) that are real numbers, each with the
        dimension `parameter` before its own: derivatives of the values at a time, of the metrics,
        of the time, impulse and energy of every event, and of the state just after it
        (`event_axis`, `event_angular_momentum`, `event_velocity`, `event_height`). The unit of each
        is that of the variable over that of the field, which the coordinate `parameter_units` has.
        Where a derivative does not exist it is NaN from there on. One that two distances do not
        give to six digits of the largest of its variable is NaN, too: of those by all fields that
        are asked for, each field changing by its own size. `reason`, by parameter, says why. One is
        zero where both distances show no more of it than rounding, as that grows through the run,
        and rounding is less than the sixth digit of the variable itself. A metric that the run
        itself does not have, such as the time of turning over where it does not turn over within
        the duration, has none either: its attribute `reason` says so.

    Raises
    ------
    InvalidInput
        If an argument cannot be.

    Examples
    --------
    >>> import tippetop as tt
    >>> problem = tt.presets.report_problem(spin=155.0)
    >>> slopes = tt.sensitivities(problem, 7.0, vary=["friction.mu", "launch.spin"])
    >>> slopes["turnover_time"].sel(parameter="friction.mu").item() < 0.0  # s per s/m
    True
    >>> slopes["tilt"].dims
    ('parameter', 'time')
    """
    require_problem(problem)
    duration = float(number_in("duration", duration, "s"))
    require_limits(duration, natural_units(top_of(problem)).time)
    fields = require_names("vary", vary)
    require_fields(problem, fields, "vary")
    grid = sample_times(duration, samples, times)
    directions = [Direction.of(problem, name) for name in fields]
    run, check = LinearizedRun(problem, duration, grid, directions), None
    if run.is_differenced:
        check = LinearizedRun(problem, duration, grid, directions, distance=CHECKED * BESIDE)
    nominal = run.read()
    slopes_by_field = [
        _slopes_before_failures(run, check, direction, nominal) for direction in range(len(fields))
    ]
    largest = {
        name: max(
            one[name].largest * field.scale
            for one, field in zip(slopes_by_field, run.fields, strict=True)
        )
        for name in slopes_by_field[0]
    }
    columns, reasons = list[dict[str, Array]](), list[str]()
    for direction, slopes in enumerate(slopes_by_field):
        column, reason = _known_slopes(run, check, direction, slopes, largest, nominal)
        columns.append(column)
        reasons.append(reason)
    units = [problem.quantity(name).units for name in fields]
    return _labelled(nominal, columns, [str(name) for name in fields], units, reasons)


def _slopes_before_failures(
    run: LinearizedRun, check: LinearizedRun | None, direction: int, nominal: RunReading
) -> dict[str, Slopes]:
    """Return the derivatives of the variables with respect to a field, NaN from where those of the
    run or of its check fail, and of metrics that the run itself does not have.
    """
    if check is not None and direction in check.failures:
        run.fail(direction, *check.failures[direction])
    slopes, variables = slopes_of(run, direction), nominal.variables
    missing = [name for name in slopes if not variables[name].dims and np.isnan(variables[name])]
    return slopes | {name: slopes[name].before(0.0) for name in missing}


def _known_slopes(
    run: LinearizedRun,
    check: LinearizedRun | None,
    direction: int,
    slopes: dict[str, Slopes],
    largest: dict[str, float],
    nominal: RunReading,
) -> tuple[dict[str, Array], str]:
    """Return the derivatives of the variables with respect to a field, and why some are missing.

    `check` is the same run, whose junctions were followed at another distance. `largest` has the
    largest change of each variable where one of the fields changes by its own size, to first order.
    """
    reason = run.failures.get(direction, (np.inf, ""))[1]
    if check is None:
        return {name: one.values for name, one in slopes.items()}, reason
    beside, columns, zeros = slopes_of(check, direction), dict[str, Array](), dict[str, float]()
    scale = run.fields[direction].scale
    for name, one in slopes.items():
        variable = nominal.variables[name]
        natural = natural_size(variable.attrs.get("units", "1"), nominal.units)
        size = max(size_of(variable.values), natural)
        least = max(DIGITS * largest[name], NIL * size)
        columns[name] = one.known_beside(beside[name], least / scale)
        is_unknown = np.isnan(columns[name]) & ~np.isnan(one.values)
        if np.any(np.abs(one.values[is_unknown]) <= DIGITS * size / scale):
            zeros[name] = DIGITS * size / scale
    if zeros:
        rounding = _rounding_of(run, direction)
        for name, bound in zeros.items():
            is_zero = slopes[name].zeros_beside(beside[name], rounding[name], bound)
            columns[name] = np.where(np.isnan(columns[name]) & is_zero, 0.0, columns[name])
    if any(np.any(np.isnan(columns[name]) > np.isnan(slopes[name].values)) for name in slopes):
        reason = f"{reason}; {FEW_DIGITS}" if reason else FEW_DIGITS
    return columns, reason


def _rounding_of(run: LinearizedRun, direction: int) -> dict[str, Slopes]:
    """Return what rounding of the differences at the junctions of a run has made of the derivatives
    of its variables with respect to a field.
    """
    still, source = [run.fields[direction].without_motion()], (run, direction)
    rounded = LinearizedRun(run.problem, run.duration, run.grid, still, rounding_of=source)
    # Few digits of it are asked for: one distance gives them.
    return slopes_of(rounded, 0, DISTANCES[1:2])


def _labelled(
    nominal: RunReading,
    columns: Sequence[dict[str, Array]],
    names: Sequence[str],
    units: Sequence[str],
    reasons: Sequence[str],
) -> xr.Dataset:
    """Return the slopes of all parameters as a dataset, as long as the run itself."""
    variables = dict[str, Any]()
    run = nominal.variables
    for name in columns[0]:
        one = run[name]
        values = np.full((len(columns), *one.shape), np.nan)
        for row, column in enumerate(columns):
            slope = column[name]
            within: Any = (row, *[slice(size) for size in slope.shape])
            values[within] = slope
        attributes = {
            "long_name": f"derivative of {one.attrs.get('long_name', name)}",
            "numerator_units": one.attrs.get("units", "1"),
        }
        if not one.dims and np.isnan(one.values):
            attributes["reason"] = NO_NUMBER.format(one.attrs.get("long_name", name))
        variables[name] = (("parameter", *one.dims), values, attributes)
    variables["reason"] = (("parameter",), np.array(reasons, dtype=object).astype(str))
    coordinates = {
        "parameter": list(names),
        "parameter_units": ("parameter", list(units)),
        "time": ("time", run["time"].values, {"units": "s", "long_name": "time since launch"}),
    }
    return xr.Dataset(variables, coordinates)
