"""The few numbers a person wants to know of a run."""

from typing import Any

import numpy as np
import xarray as xr

NEAR_FINAL = 0.01
"""How close to its final value the tilt must be to count as arrived, rad (the report's definition)."""


def summarize(run: xr.Dataset) -> dict[str, Any]:
    """The main figures of a run, as plain numbers and strings.

    Returns
    -------
    dict
        Keys: outcome, advice, duration (s), final (theta, theta_dot, omega3, phi_dot: rad and rad/s),
        turns_over (s: the tilt first passes pi/2; None if never), arrives (s: first within 0.01 rad of
        its last value), least_normal_force (N), energy_start, energy_lost (J), jellett_drift and energy_error
        (relative), flights (how many), airborne_time (s), highest_gap (m), impact_energy_lost (J), events
        (kind and time, s), integrator, steps, evaluations. What is not a number is None.
    """
    theta = run["theta"].values
    energy = run["energy"].values
    jellett = run["jellett"].values
    time = run["time"].values
    moment = _length(run["angular_momentum"].values) * _length(
        run["axis"].values * run["height"].values[:, None]
    )
    balance = energy - energy[0] - (run["work"].values - run["work"].values[0])
    return {
        "outcome": run.attrs["outcome"],
        "advice": run.attrs["outcome_advice"],
        "duration": float(time[-1]),
        "final": {
            name: _number(run[name].values[-1]) for name in ("theta", "theta_dot", "omega3", "phi_dot")
        },
        "turns_over": _crossing(time, theta - np.pi / 2),
        "arrives": float(time[np.argmax(np.abs(theta - theta[-1]) < NEAR_FINAL)]),
        "least_normal_force": float(run["normal_force"].values.min()),
        "energy_start": float(energy[0]),
        "energy_lost": float(energy[0] - energy[-1]),
        "jellett_drift": _number(np.ptp(jellett) / moment[0]),
        "energy_error": float(np.abs(balance).max() / abs(energy[0])),
        "flights": run.sizes["flight"],
        "airborne_time": float((run["flight_end"] - run["flight_start"]).sum()),
        "highest_gap": float(run["flight_highest_gap"].values.max(initial=0.0)),
        "impact_energy_lost": float(run["event_energy_lost"].values.sum()),
        "events": [
            {"kind": str(kind), "time": float(at)}
            for kind, at in zip(run["event_kind"].values, run["event_time"].values, strict=True)
        ],
        "integrator": run.attrs["integrator"],
        "steps": int(run.attrs["steps"]),
        "evaluations": int(run.attrs["evaluations"]),
    }


def _crossing(time: np.ndarray[Any, Any], value: np.ndarray[Any, Any]) -> float | None:
    """When the value first rises through zero, by linear interpolation; None if it never does."""
    rises = np.flatnonzero((value[:-1] < 0) & (value[1:] >= 0))
    if not len(rises):
        return None
    i = int(rises[0])
    return float(time[i] - value[i] * (time[i + 1] - time[i]) / (value[i + 1] - value[i]))


def _length(vectors: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    return np.asarray(np.linalg.norm(vectors, axis=-1))


def _number(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None
