"""Fit numbers of a problem to measurements by least squares."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from tippetop.fit.fit_result import FitResult, result_of
from tippetop.fit.joint_model import JointModel
from tippetop.fit.measurement import Measurement, read_measurement
from tippetop.fit.model import Model
from tippetop.fit.problem_numbers import require_fields
from tippetop.fit.search import MOST_RUNS, FitProgress, Search, deviations_of
from tippetop.integrators.base import Array
from tippetop.problem.implausible import warn_if_implausible
from tippetop.problem.problem import Problem, require_problem
from tippetop.support.errors import (
    MISSING,
    OR_NONE,
    Described,
    InvalidInput,
    NotConverged,
    is_number,
    is_whole,
    renamed,
    short,
)
from tippetop.support.suggestions import not_one_of
from tippetop.sweeps.axes import in_si_of

Vary = Sequence[str] | Mapping[str, Any] | str


def fit(
    problem: Problem | Sequence[tuple[Problem, Any]],
    data: Any = None,
    vary: Vary | None = None,
    *,
    shared: Sequence[str] | None = None,
    noise: Any = None,
    starts: int | None = None,
    most_runs: int = MOST_RUNS,
    callback: Callable[[FitProgress], None] | None = None,
) -> FitResult:
    """Return the problem whose run is nearest to measurements, with errors.

    A run oscillates, and the misfit has a minimum for each turn by which its phases may be off. The
    region around the problem's numbers is therefore scanned in steps of a quarter of a turn over a
    first part of the data; what is near the data there is followed over all of them. Ctrl-C ends
    the search: the best fit so far is returned, with a caution.

    Parameters
    ----------
    problem
        The problem to start from: its numbers may be 20 % off, or, where nothing nearer describes
        the data, 50 %. Or several launches: a list of pairs of a problem and its data.
    data
        A measurement, or several of the same launch; or what `read_measurement` reads: a file, a
        DataFrame, or a mapping of headings to numbers. None for several launches.
    vary
        Fields of numbers that are fitted, such as ``["friction.mu", "launch.spin"]``; or a mapping
        of fields to ranges ``(low, high)`` that they stay in, whose ends may have units as in
        "150 rpm", or None for none. Missing initial conditions are fitted like anything else:
        "launch.tilt_rate", "launch.precession". None for those that are shared.
    shared
        Fields among them that are the same in all of several launches; None for all. The others are
        fitted for each launch, and named by its number: "2.launch.spin".
    noise
        Standard deviation of the data in their unit, a number for each column or one for all; for
        several measurements, a list. None for what the measurements say; if they say nothing, it
        is estimated from the residuals.
    starts
        How many points are followed from the first part of the data; None for 12, 1 for the
        problem's own numbers alone, without a scan.
    most_runs
        Number of runs after which the search ends; the best fit so far is returned, with a caution.
    callback
        Function that is called with the progress from time to time.

    Raises
    ------
    InvalidInput
        If there is no such field, fewer data than numbers to fit, or no run near the start shows
        what was measured.
    NotConverged
        If the search does not reach a minimum.

    Examples
    --------
    >>> import numpy as np
    >>> import tippetop as tt
    >>> true = tt.presets.report_problem(spin=155.0)
    >>> times = np.linspace(0.0, 0.5, 60)
    >>> tilt = tt.simulate(true, 0.5, times=times)["tilt"].values
    >>> film = tt.Measurement.of_variables(times, {"tilt": tilt}, noise=0.01)
    >>> fitted = tt.fit(true.replace({"friction.mu": 0.25}), film, ["friction.mu"])
    >>> round(fitted.problem.friction.mu, 6)
    0.3
    """
    launches = _launches(problem, data)
    for one, _ in launches:
        require_problem(one)
    fields, low, high = _ranges(launches[0][0], shared if vary is None else vary)
    common = fields if shared is None else tuple(shared)
    for field in common:
        if field not in fields:
            raise not_one_of("shared", field, fields)
    each = [_measurements(rows, noise) for _, rows in launches]
    measurements = [one for several in each for one in several]
    models = [Model(one, some, fields) for (one, _), some in zip(launches, each, strict=True)]
    model: Model | JointModel = models[0]
    if len(models) > 1:
        model = JointModel(models, common)
        places = [
            fields.index(name.partition(".")[2] if name not in common else name)
            for name in model.fields
        ]
        low, high = low[places], high[places]
    if not (starts is None or (is_whole(starts) and starts >= 1)):
        raise InvalidInput("starts", starts, f"a whole number, at least 1{OR_NONE}")
    if not (is_whole(most_runs) and most_runs >= 1):
        raise InvalidInput("most_runs", most_runs, "a whole number, at least 1")
    for one, _ in launches:
        warn_if_implausible(one)
    measured = np.isfinite(model.data)
    if measured.sum() < len(model.names):
        shown = f"{measured.sum()} numbers"
        fewest = f"at least {len(model.names)}, as many as are fitted: {', '.join(model.names)}"
        raise InvalidInput("data", shown, fewest)
    search = Search(model, deviations_of(measurements), low, high)
    search.most_runs, search.callback = most_runs, callback
    minima, stopped = search.minima(starts), search.stopped
    best = minima[0]
    if not (best.converged or stopped):
        pairs = zip(model.names, best.numbers, strict=True)
        nearest = ", ".join(f"{name} = {number:.4g}" for name, number in pairs)
        raise NotConverged(
            f"the fit did not reach a minimum in {search.runs} runs ({best.message}; nearest so"
            f" far: {nearest}); start nearer to the data, fit fewer numbers, or give ranges"
        )
    return result_of(search, best, [one for one in minima[1:] if one.converged])


def _launches(problem: Any, data: Any) -> list[tuple[Problem, Any]]:
    """Return pairs of a problem and its data."""
    if isinstance(problem, Problem) or data is not None:
        return [(problem, data)]
    pairs = list(problem) if isinstance(problem, list | tuple) else []
    if not (pairs and all(isinstance(pair, list | tuple) and len(pair) == 2 for pair in pairs)):
        accepted = "a problem with data, or a list of pairs (problem, data)"
        raise InvalidInput("problem", problem, accepted)
    return [(one, rows) for one, rows in pairs]


def _measurements(data: Any, noise: Any) -> list[Measurement]:
    """Return the measurements with their noise."""
    several = list(data) if isinstance(data, list | tuple) else [data]
    if not several:
        raise InvalidInput(
            "data", data, "a measurement, or a list of them: see tt.read_measurement"
        )
    noises = [noise] if len(several) == 1 else [None] * len(several) if noise is None else noise
    if not (isinstance(noises, list | tuple) and len(noises) == len(several)):
        raise InvalidInput("noise", noise, "a list with the noise of every measurement")
    measurements = list[Measurement]()
    for one, level in zip(several, noises, strict=True):
        if not isinstance(one, Measurement):
            measurements.append(read_measurement(one, noise=level))
        else:
            measurements.append(one if level is None else one.with_noise(level))
    return measurements


def _ranges(problem: Problem, vary: Any) -> tuple[tuple[str, ...], Array, Array]:
    """Return the fields to fit, with the lower and upper ends of their ranges."""
    if vary is None:
        raise InvalidInput("vary", MISSING, "names of fields, such as friction.mu and launch.spin")
    ranges: Mapping[str, Any] = (
        vary
        if isinstance(vary, Mapping)
        else dict.fromkeys([vary] if isinstance(vary, str) else vary)
    )
    if not ranges or not all(isinstance(field, str) for field in ranges):
        raise InvalidInput("vary", vary, "names of fields, such as friction.mu and launch.spin")
    require_fields(problem, tuple(ranges), "vary")
    low, high = list[float](), list[float]()
    for field, ends in ranges.items():
        pair = (-np.inf, np.inf) if ends is None else ends
        if not (isinstance(pair, list | tuple) and len(pair) == 2):
            raise InvalidInput(f"vary.{field}", ends, "a range (low, high)")
        try:
            lower, upper = (in_si_of(field, end) for end in pair)
        except InvalidInput as error:
            raise renamed(error, f"vary.{field}") from None
        if not (ends is None or (is_number(lower) and is_number(upper) and lower < upper)):
            stated = Described(f"{short(pair[0])} to {short(pair[1])}")
            raise InvalidInput(f"vary.{field}", stated, "a range from a number to a greater one")
        low.append(lower)
        high.append(upper)
    return tuple(ranges), np.array(low), np.array(high)
