"""Slow inversion: the limit of weak friction, and the nutation within a run."""

import math

import numpy as np
import xarray as xr

from tippetop.integrators.base import Array
from tippetop.problem.presets import report_problem
from tippetop.problem.problem import top_of
from tippetop.report import printed_numbers
from tippetop.report.experiment import dataset, experiment, variable
from tippetop.report.experiments.runs import WINDOW, on_table
from tippetop.report.readings import SETTLED, crossings, flip_time
from tippetop.run import simulate
from tippetop.theory.apparent import growth_rates_of_launches
from tippetop.theory.averaging import arrival_time_limit, averaged_flow, local_exponent
from tippetop.theory.diagnostics import (
    gyroscopic_balance,
    nutation_envelope,
    potential_at,
    smooth_constants,
)
from tippetop.theory.prediction import predict
from tippetop.theory.steady import SteadyKind

SPIN = 100.0
"""Spin of the launches whose averaged flow is shown, rad/s."""

FRICTIONS = (0.3, 0.03, 0.003)
"""Friction coefficients of the runs that are compared in mu t, s/m."""

CROSSED = math.pi / 2
"""Tilt at which the top has turned half over, rad."""

_BINS = 400


@experiment("why-collapse", "runs at small friction against the averaged flow", 2.0)
def _collapse(quick: bool) -> xr.Dataset:
    """Return the tilt against mu t: the averaged flow, and runs at several frictions."""
    problem = report_problem(SPIN)
    flow = averaged_flow(problem, samples=400)
    end = 1.1 * arrival_time_limit(problem)
    edges = np.linspace(0.0, end, _BINS + 1)
    middle = 0.5 * (edges[1:] + edges[:-1])
    low, high = flow.tilts(middle)
    frictions = FRICTIONS[:2] if quick else FRICTIONS
    bounds = np.array([_band(mu, edges) for mu in frictions])
    swing = simulate(on_table(problem), end / FRICTIONS[0], samples=2501)
    tilts, swings = swing["tilt"].values, FRICTIONS[0] * swing["time"].values
    limit = arrival_time_limit(problem, SETTLED)
    of_run = ("friction", "mu_time")
    return dataset(
        {
            "mu_time": (middle, "s2 m-1", "mu t"),
            "friction": (list(frictions), "s m-1", "friction coefficient"),
            "mu_time_swing": (swings, "s2 m-1", "mu t"),
        },
        {"spin_rad_per_s": SPIN},
        flow_low=(low, "rad", "least tilt of the nutation, averaged flow", "mu_time"),
        flow_high=(high, "rad", "largest tilt of the nutation, averaged flow", "mu_time"),
        run_low=(bounds[:, 0], "rad", "least tilt of the run around this time", *of_run),
        run_high=(bounds[:, 1], "rad", "largest tilt of the run around this time", *of_run),
        tilt_swing=(tilts, "rad", "tilt of the run with most friction", "mu_time_swing"),
        flip_limit=(limit, "s2 m-1", "limit of mu times flip time"),
    )


def _band(mu: float, edges: Array) -> tuple[Array, Array]:
    """Return the least and the largest tilt of a run between successive values of mu t."""
    each = 60
    times = np.linspace(edges[0], edges[-1], each * (len(edges) - 1) + 1) / mu
    run = simulate(on_table(report_problem(SPIN, mu=mu)), float(times[-1]), times=times)
    theta = run["tilt"].values
    parts = np.concatenate([theta[:-1].reshape(-1, each), theta[each::each, None]], axis=1)
    return parts.min(axis=1), parts.max(axis=1)


@experiment("why-exponent", "turning over against friction, in several senses", 6.0)
def _exponent(quick: bool) -> xr.Dataset:
    """Return the time to turn over against friction, by several definitions, and its limit."""
    small = np.geomspace(0.01 if quick else 0.003, 0.3, 4 if quick else 10)
    mu = np.concatenate([small[:-1], np.geomspace(0.3, 3.0, 13 if quick else 25)])
    problem = report_problem(SPIN)
    final = predict(problem).final.tilt
    times = np.array([_times(float(one), final) for one in mu]).T
    flow = averaged_flow(problem, samples=4000)
    half = crossings(flow.mu_time, flow.tilt_high - CROSSED)[0]
    data = dataset({"mu_flip": mu}, {"spin_rad_per_s": SPIN, "within_rad": SETTLED})
    for (name, long_name), row in zip(_SENSES.items(), times, strict=True):
        data[name] = variable(row, "s", long_name, "mu_flip")
    for name in ("crossing_time", "arrival_time_end"):
        exponent = local_exponent(mu, data[name].values)
        data[f"exponent_{name}"] = variable(exponent, "1", f"d ln t / d ln mu, {name}", "mu_flip")
    data["limit_crossing"] = variable(half, "s2 m-1", "limit of mu t at the first tilt of pi/2")
    data["limit_arrival"] = variable(
        arrival_time_limit(problem, SETTLED), "s2 m-1", "limit of mu t, arrival"
    )
    return data


_SENSES = {
    "crossing_time": "first time with a tilt of more than pi/2",
    "arrival_time_end": "first time within 0.01 rad of the steady tilt",
    "settling_time": "time from which on the tilt stays within 0.01 rad of the steady tilt",
    "arrival_time_window": (
        "first time within 0.01 rad of the tilt after 20 s, the report's definition"
    ),
}


def _times(mu: float, final: float) -> tuple[float, float, float, float]:
    """Return the times (s) of the first tilt above pi/2, of arriving, of settling, and of the
    report's flip.
    """
    duration = max(WINDOW, 3.5 / mu + 8.0 / _decay_rate(mu))
    run = simulate(on_table(report_problem(SPIN, mu=mu)), duration, samples=40_001)
    times, theta = run["time"].values, run["tilt"].values
    far = np.abs(theta - final) >= SETTLED
    last = int(np.flatnonzero(far)[-1])
    first = int(np.argmin(far))
    early = times <= WINDOW
    by_report = flip_time(times[early], theta[early]) if theta[early][-1] > CROSSED else math.nan
    return (
        float(times[np.argmax(theta > CROSSED)]),
        float(times[first]),
        float(times[min(last + 1, len(times) - 1)]),
        by_report,
    )


def _decay_rate(mu: float) -> float:
    """Return decay rate of the inverted spin that the launch leads to, 1/s."""
    problem = report_problem(SPIN, mu=mu)
    return -float(growth_rates_of_launches(SteadyKind.INVERTED, problem, np.array([SPIN]))[0])


@experiment("why-diagnostics", "what the main run says of its nutation", 1.0)
def _diagnostics(quick: bool) -> xr.Dataset:
    """Return gyroscopic balance, envelope of the nutation and effective potential along the
    report's main run.
    """
    problem = on_table(report_problem(printed_numbers.SPIN))
    top = top_of(problem)
    run = simulate(problem, 10.0, samples=2001 if quick else 5001)
    axis, momentum = run["axis"].values, run["angular_momentum"].values
    xi = gyroscopic_balance(axis, momentum, top)
    low, high = nutation_envelope(axis, momentum, top)
    values = smooth_constants(axis, momentum, top)
    axial = top.axial_inertia * run["spin"].values
    instants = np.array([0.0, 3.0, 5.0, 5.5, 6.0, 8.0])
    index = np.searchsorted(run["time"].values, instants)
    tilts = np.linspace(1e-3, math.pi - 1e-3, 1201)
    wells = [potential_at(int(i), axis, momentum, top, tilts) for i in index]
    over = ("time_diagnosed",)
    return dataset(
        {
            "time_diagnosed": run["time"].values,
            "instant": (run["time"].values[index], "s", "instant of the run"),
            "well_tilt": (tilts, "rad", "tilt"),
        },
        {"spin_rad_per_s": printed_numbers.SPIN},
        tilt_diagnosed=(run["tilt"].values, "rad", "tilt", *over),
        balance=(xi, "kg m2 s-1", "xi = I1 phi' cos(theta) - I3 omega3", *over),
        balance_ratio=(xi / float(abs(axial[0])), "1", "xi over I3 omega3 at launch", *over),
        envelope_low=(low, "rad", "least tilt a smooth table would allow", *over),
        envelope_high=(high, "rad", "largest tilt a smooth table would allow", *over),
        potential=(wells, "J", "effective potential", "instant", "well_tilt"),
        level=(np.asarray(values.energy)[index], "J", "energy", "instant"),
        instant_tilt=(run["tilt"].values[index], "rad", "tilt", "instant"),
    )
