"""Derivatives of a run with respect to fields of its problem, through every event."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from tippetop.contact.trajectory import require_limits
from tippetop.fit.linearized_run import EVENT_STATES, Differs, LinearizedRun
from tippetop.fit.problem_numbers import Direction, require_fields
from tippetop.integrators.base import Array
from tippetop.mechanics.top import natural_units
from tippetop.problem.problem import Problem, require_problem
from tippetop.results.catalogue import DERIVED, LISTED, METRICS, SAMPLED, Variable
from tippetop.results.sample_times import sample_times
from tippetop.support.errors import InvalidInput
from tippetop.support.units import number_in

NEARER, TRIES = 0.1, 3
"""How much nearer to the run its variables are read off, and how often at most, until the runs
beside it go through its events.
"""

TURN = 2.0 * np.pi


def sensitivities(
    problem: Problem,
    duration: float,
    wrt: Sequence[str],
    *,
    samples: int = 2001,
    times: ArrayLike | None = None,
) -> xr.Dataset:
    """Return the derivatives of a run with respect to fields of its problem.

    Nothing is smoothed, and whole runs are not compared. Motion in contact is followed with its
    variational equations, and the derivative of the time at which a guard falls takes them through
    events (saltation). What an event does - an impact, a reset - with flights and the first and
    last moments of slip, and how variables are read off the solution, are differentiated by
    differences at 1e-5 beside the run, which leaves relative errors of 1e-9 to 1e-7.

    Parameters
    ----------
    problem
        The physics.
    duration
        Length of the run, s; or a text such as "1 min", or a quantity of pint.
    wrt
        Names of fields with a number, such as "friction.mu", "launch.spin" or "gravity".
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
        Where a derivative does not exist it is NaN from there on, and `reason`, by parameter, says
        why.

    Raises
    ------
    InvalidInput
        If an argument cannot be.

    Examples
    --------
    >>> import tippetop as tt
    >>> problem = tt.presets.report_problem(spin=155.0)
    >>> slopes = tt.sensitivities(problem, 7.0, wrt=["friction.mu", "launch.spin"])
    >>> slopes["turns_over"].sel(parameter="friction.mu").item() < 0.0  # s per s/m
    True
    >>> slopes["theta"].dims
    ('parameter', 'time')
    """
    require_problem(problem)
    duration = float(number_in("duration", duration, "s"))
    require_limits(duration, natural_units(problem.top).time)
    if isinstance(wrt, str) or not len(wrt):
        raise InvalidInput("wrt", wrt, 'a list of names of fields, such as ["friction.mu"]')
    require_fields(problem, wrt, "wrt")
    grid = sample_times(duration, samples, times)
    run = LinearizedRun(problem, duration, grid, [Direction.of(problem, name) for name in wrt])
    columns, reasons = list[dict[str, Any]](), list[str]()
    for direction in range(len(wrt)):
        slopes, reason = slopes_of(run, direction)
        columns.append(slopes)
        reasons.append(reason)
    units = [problem.quantity(name).units for name in wrt]
    return _labelled(columns, [str(name) for name in wrt], units, reasons)


def slopes_of(run: LinearizedRun, direction: int) -> tuple[dict[str, xr.Variable], str]:
    """Return the derivatives of the variables of a run with respect to a field, and why some do not
    exist.
    """
    while True:
        change, scale = run.reach(direction), run.fields[direction].scale
        for _ in range(TRIES):
            try:
                ends = [run.read_beside(direction, sign * change) for sign in (1.0, -1.0)]
                break
            except Differs as differs:
                error = differs
                change *= NEARER
        else:
            run.fail(direction, error.time, str(error))
            continue
        time, reason = run.failures.get(direction, (np.inf, ""))
        slopes = _differences(ends, 2.0 * change * scale, time * float(run.numbers.units[2]))
        return slopes, reason


def _differences(ends: Sequence[xr.Dataset], apart: float, until: float) -> dict[str, xr.Variable]:
    """Return the slopes of the variables between two runs, NaN from a time on."""
    up, down = ends
    slopes = dict[str, xr.Variable]()
    for name, variable in described().items():
        high, low = up.variables[name], down.variables[name]
        if high.dtype.kind != "f":
            continue
        slope: Array = (high.values - low.values) / apart
        if variable.units == "rad":
            slope = (np.remainder(slope * apart + 0.5 * TURN, TURN) - 0.5 * TURN) / apart
        if "time" in high.dims:
            slope[up.variables["time"].values >= until] = np.nan
        elif "event" in high.dims:
            slope[up.variables["event_time"].values >= until] = np.nan
        elif np.isfinite(until):
            slope = np.full_like(slope, np.nan)
        slopes[name] = xr.Variable(high.dims, slope, high.attrs)
    slopes["time"] = up.variables["time"]
    return slopes


def described() -> dict[str, Variable]:
    """Return all variables of a run that may have derivatives, by name."""
    return {**SAMPLED, **DERIVED, **METRICS, **LISTED, **EVENT_STATES}


def _labelled(
    columns: Sequence[dict[str, xr.Variable]],
    names: Sequence[str],
    units: Sequence[str],
    reasons: Sequence[str],
) -> xr.Dataset:
    """Return the slopes of all parameters as a dataset."""
    variables = dict[str, Any]()
    longest = {
        dimension: max(column[name].sizes.get(dimension, 0) for column in columns)
        for name in columns[0]
        for dimension in columns[0][name].dims
    }
    for name, first in columns[0].items():
        if name == "time":
            continue
        shape = [longest[dimension] for dimension in first.dims]
        values = np.full((len(columns), *shape), np.nan)
        for row, column in enumerate(columns):
            slope = column[name].values
            within: Any = (row, *[slice(0, size) for size in slope.shape])
            values[within] = slope
        attributes = {
            "long_name": f"derivative of {first.attrs.get('long_name', name)}",
            "numerator_units": first.attrs.get("units", "1"),
        }
        variables[name] = (("parameter", *first.dims), values, attributes)
    variables["reason"] = (("parameter",), np.array(reasons, dtype=object).astype(str))
    longest_time = max((column["time"].values for column in columns), key=len)
    coordinates = {
        "parameter": list(names),
        "parameter_units": ("parameter", list(units)),
        "time": ("time", longest_time, {"units": "s", "long_name": "time since launch"}),
    }
    return xr.Dataset(variables, coordinates)
