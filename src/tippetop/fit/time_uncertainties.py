"""How well the times of an account are known: how far a minute change of the launch moves them."""

import warnings

import xarray as xr

from tippetop.problem.implausible import Implausible
from tippetop.problem.problem import Problem
from tippetop.results.account_text import facts_of
from tippetop.results.dataset import require_run
from tippetop.results.time_digits import CHANGE, LONGER, MOVED, account_times, time_changes
from tippetop.run import simulate
from tippetop.support.errors import InvalidInput, is_number


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
    facts = facts_of(run)
    moved = dict.fromkeys(account_times(facts), 0.0)
    end = float(run["end_time"])
    duration = end if run.attrs["status"] == "completed" else LONGER * end
    for fields in MOVED:
        beside = _beside(problem, fields, change)
        if not moved or beside is None or not duration > 0.0:
            continue
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", Implausible)
            facts_beside = facts_of(simulate(beside, duration, samples=2))
        for name, distance in time_changes(facts, facts_beside).items():
            moved[name] = max(moved[name], distance)
    return moved


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
