"""Summary of a run: its main numbers."""

from typing import Any

import numpy as np
import xarray as xr

from tippetop.results.catalogue import METRICS, MONITORS
from tippetop.results.dataset import require_run
from tippetop.results.description import describe


def summarize(run: xr.Dataset) -> dict[str, Any]:
    """Return the main numbers of a run, as plain numbers and strings.

    Returns
    -------
    dict
        Keys: account (clauses with name and numbers, as `tippetop.describe` gives them),
        description (the account in English), outcome, advice, duration (s), final (theta,
        theta_dot, omega3, phi_dot: rad and rad/s), is_settled (whether the tilt stays near
        a steady state for ever), turns_over (s: the tilt first passes pi/2; None if not
        within the run), arrives (s: first within 0.01 rad of the tilt at which it settles;
        None until then), settled_since (s: from then on it stays within 0.01 rad of it;
        None until then), highest_tilt (rad; None while a larger one may follow),
        first_lift_off (s), highest (m), least_normal_force (N), energy_start, energy_lost,
        energy_lost_sliding, energy_lost_drilling, energy_lost_rolling (J), jellett_drift
        and energy_error (relative), flights (how many), airborne_time (s), highest_gap (m),
        impact_energy_lost (J), events (kind and time, s), integrator, steps, evaluations.
        Numbers that do not exist are None.

    Examples
    --------
    >>> import tippetop as tt
    >>> summary = tt.summarize(tt.simulate(tt.presets.report_problem(spin=155.0), duration=20.0))
    >>> summary["outcome"], round(summary["turns_over"], 2), summary["flights"]
    ('completed', 5.88, 0)
    """
    require_run(run)
    last = run.isel(time=-1)
    names = ("theta", "theta_dot", "omega3", "phi_dot")
    account = describe(run)
    return {
        "account": account.plain(),
        "description": str(account),
        "outcome": run.attrs["outcome"],
        "advice": run.attrs["outcome_advice"],
        "duration": float(run["end_time"]),
        "final": {name: _number(last[name]) for name in names},
        "is_settled": bool(run["is_settled"] == 1),
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
    "final_theta",
    "final_omega3",
    "final_phi_dot",
    "end_time",
    "steps",
    "evaluations",
    "jellett_error",
    "is_settled",
    "peak_tilt",
    "peak_time",
}
NUMBERS = [name for name in (*METRICS, *MONITORS) if name not in _NOT_LISTED]
"""Single numbers of a run that the summary has under their own names."""


def _number(value: xr.DataArray) -> int | float | None:
    number = value.item()
    return number if np.isfinite(number) else None
