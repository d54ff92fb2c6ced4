"""Summary of a run: its main numbers."""

from typing import Any

import numpy as np
import xarray as xr

from tippetop.results.account_text import describe
from tippetop.results.catalogue import METRICS, MONITORS
from tippetop.results.dataset import require_run


def summarize(run: xr.Dataset) -> dict[str, Any]:
    """Return the main numbers of a run, as plain numbers and strings.

    Returns
    -------
    dict
        Keys: account (clauses with name and numbers, as `tippetop.describe` gives them),
        description (the account in English), outcome (what became of the top: a name of
        `tippetop.Outcome`), status (how the run ended: a name of `tippetop.Status`), message
        (what to do about it), end_time (s), final (tilt,
        tilt_rate, spin, precession: rad and rad/s), is_settled (whether the tilt stays near
        a steady state for ever), turnover_time (s: the tilt first passes pi/2; None if not
        within the run), arrives (s: first within 0.01 rad of the tilt at which it settles;
        None until then), settling_time (s: from then on it stays within 0.01 rad of it;
        None until then), max_tilt_ever (rad; None while a larger one may follow),
        liftoff_time (s), max_height (m), min_normal_force (N), initial_energy, energy_lost,
        energy_lost_sliding, energy_lost_drilling, energy_lost_rolling, energy_lost_air (J),
        jellett_drift and energy_error (relative), flights (how many), airborne_time (s),
        max_gap (m), energy_lost_impacts (J), events (kind and time, s), integrator, steps,
        evaluations.
        Numbers that do not exist are None.

    Examples
    --------
    >>> import tippetop as tt
    >>> summary = tt.summarize(tt.simulate(tt.presets.report_problem(spin=155.0), duration=20.0))
    >>> summary["outcome"], round(summary["turnover_time"], 2), summary["status"]
    ('inverted', 5.88, 'completed')
    """
    require_run(run)
    last = run.isel(time=-1)
    names = ("tilt", "tilt_rate", "spin", "precession")
    account = describe(run)
    return {
        "account": account.plain(),
        "description": str(account),
        "outcome": str(run["outcome"].item()),
        "status": run.attrs["status"],
        "message": run.attrs["message"],
        "end_time": float(run["end_time"]),
        "final": {name: _number(last[name]) for name in names},
        "is_settled": bool(run["is_settled"]),
        **{name: _number(run[name]) for name in NUMBERS},
        "events": [
            {"kind": str(kind), "time": float(at)}
            for kind, at in zip(run["event_kind"].values, run["event_time"].values, strict=True)
        ],
        "integrator": run.attrs["integrator"],
        "steps": int(run["steps"]),
        "evaluations": int(run["evaluations"]),
    }


_NOT_LISTED = {
    "final_tilt",
    "final_spin",
    "final_precession",
    "end_time",
    "steps",
    "evaluations",
    "jellett_change",
    "is_settled",
    "max_tilt",
    "max_tilt_time",
}
NUMBERS = [name for name in (*METRICS, *MONITORS) if name not in _NOT_LISTED]
"""Single numbers of a run that the summary has under their own names."""


def _number(value: xr.DataArray) -> int | float | None:
    number = value.item()
    return number if np.isfinite(number) else None
