"""How well the times of an account are known: how far a minute change of the launch moves them."""

import math
import warnings

import xarray as xr

from tippetop.problem.implausible import Implausible
from tippetop.problem.problem import Problem
from tippetop.results.dataset import require_run
from tippetop.results.description import describe
from tippetop.run import simulate
from tippetop.support.errors import InvalidInput, is_number

CHANGE = 1e-6
"""Relative change of the numbers of the launch and of friction: nobody knows them better."""

MOVED = (
    ("launch.spin", "launch.tilt", "launch.precession", "launch.tilt_rate", "launch.gap"),
    ("friction.mu",),
)
"""Fields that are changed together."""

LONGER = 1.05
"""How much longer than a run that ended early the runs beside it are followed."""


def time_uncertainties(run: xr.Dataset, change: float = CHANGE) -> dict[str, float]:
    """Return how far a relative change of launch and friction moves each time of an account.

    A run that impacts or slips decide may depend on its launch so much that its times mean nothing:
    134 jumps multiply a change of the spin of 1e-10 to 0.1 s. Two runs beside the run are followed:
    one with another launch, one with other friction.

    Parameters
    ----------
    run
        The run of `tippetop.simulate`.
    change
        Relative change of the numbers.

    Returns
    -------
    dict
        Seconds, by the names of the clauses of `tippetop.describe` that tell a time, and of the
        run's variables `turnover_time`, `arrival_time`, `settling_time` and `liftoff_time`.
        Infinite where a run beside it does not tell the same, or goes through other events before.
        Pass it to `Account.rounded`, whose sentences have no more digits than that leaves.

    Raises
    ------
    InvalidInput
        If the argument is no run.

    Examples
    --------
    >>> import tippetop as tt
    >>> run = tt.simulate(tt.presets.report_problem(spin=155.0), duration=20.0)
    >>> tt.time_uncertainties(run)["turnover_time"] < 1e-3
    True
    """
    require_run(run)
    problem = Problem.from_json(run.attrs["problem"])
    times = _times(run)
    moved = dict.fromkeys(times, 0.0)
    end = float(run["end_time"])
    duration = end if run.attrs["status"] == "completed" else LONGER * end
    for fields in MOVED:
        beside = _beside(problem, fields, change)
        if not times or beside is None or not duration > 0.0:
            continue
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", Implausible)
            other_run = simulate(beside, duration, samples=2)
        other_times = _times(other_run)
        for name, time in times.items():
            same = _events(run, time) == _events(other_run, other_times.get(name, -1.0))
            distance = abs(other_times[name] - time) if same and name in other_times else math.inf
            moved[name] = max(moved[name], distance)
    return moved


TOLD_TIMES = ("turnover_time", "arrival_time", "settling_time", "liftoff_time")
"""Variables of a run that are times."""


def _times(run: xr.Dataset) -> dict[str, float]:
    """Return the times that a run and its account tell, by name.

    When a run ends as long as it was asked for is no result.
    """
    times = {name: float(run[name]) for name in TOLD_TIMES}
    for clause in describe(run).clauses:
        if "time" in clause.numbers:
            times.setdefault(clause.name, clause.numbers["time"])
    is_complete, end = run.attrs["status"] == "completed", float(run["end_time"])
    return {
        name: time
        for name, time in times.items()
        if math.isfinite(time) and time > 0.0 and not (is_complete and time == end)
    }


def _events(run: xr.Dataset, time: float) -> list[str]:
    """Return the kinds of the events up to a time, in order.

    The event at the time itself is left out: it may be a little before or after.
    """
    is_before = run["event_time"].values < time * (1.0 - EDGE)
    return [str(kind) for kind in run["event_kind"].values[is_before]]


EDGE = 1e-3
"""Part of a time before it in which an event counts as one at that time."""


def _beside(problem: Problem, fields: tuple[str, ...], change: float) -> Problem | None:
    """Return a problem with changed fields; None if it has none of them, or they are zero."""
    changed = dict[str, float]()
    for field in fields:
        try:
            number = problem.get(field)
        except InvalidInput:
            continue
        if is_number(number) and number != 0.0:
            changed[field] = float(number) * (1.0 + change)
    try:
        return problem.replace(changed) if changed else None
    except InvalidInput:  # The field is at its bound.
        return None
