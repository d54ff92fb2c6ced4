"""How long the top takes to turn over, as a function of friction: Fig. 7 and what is said around it."""

import math

import numpy as np
import xarray as xr
from scipy.optimize import curve_fit

from tippetop.integrators.base import Array
from tippetop.presets import report_problem
from tippetop.report.experiment import Experiment, variable
from tippetop.report.experiments.runs import WINDOW, on_table
from tippetop.report.listing import listing_run
from tippetop.report.readings import SETTLED, flip_time
from tippetop.simulate import simulate

SPIN = 155.0
"""The report does not say at which spin its Fig. 7 was made; this is that of its main run, rad/s."""

OTHER_SPINS = (100.0, 110.0, 120.0, 130.0, 140.0, 150.0, 160.0)
"""Other spins it may have used, rad/s: all of them turn the top over without lifting it at mu = 0.3 s/m."""


def converged_flip_time(spin: float, mu: float, window: float = WINDOW) -> float:
    """Flip time on a table that pulls, s; nan if the run became singular or did not turn the top over."""
    run = simulate(on_table(report_problem(spin, mu=mu)), window, samples=8001)
    theta = run["theta"].values
    if run.attrs["outcome"] != "completed" or theta[-1] < math.pi / 2:
        return math.nan
    return flip_time(run["time"].values, theta)


def listing_flip_time(spin: float, mu: float, window: float = WINDOW) -> float:
    """Flip time by the report's method and definition, s; nan if the method gave up."""
    run = listing_run(report_problem(spin, mu=mu), window)
    return math.nan if run.attrs["failure"] else flip_time(run["time"].values, run["theta"].values)


def power_law(mu: Array, times: Array) -> tuple[float, float, float, float]:
    """Fit t = a mu^b; return a, b, the b of a straight line through the logarithms, and a correlation.

    The fit is that of the curve itself, by least squares; the correlation is Pearson's, of log t with log mu.
    """
    sound = np.isfinite(times)
    if sound.sum() < 3:
        return (math.nan,) * 4
    x, y = mu[sound], times[sound]
    straight = np.polyfit(np.log(x), np.log(y), 1)
    (a, b), _ = curve_fit(lambda m, a, b: a * m**b, x, y, p0=(math.exp(straight[1]), straight[0]))
    return float(a), float(b), float(straight[0]), float(np.corrcoef(np.log(x), np.log(y))[0, 1])


def _flip_times(quick: bool) -> xr.Dataset:
    mu = np.linspace(0.2, 1.0, 9 if quick else 17)
    columns = {
        "": np.array([converged_flip_time(SPIN, float(m)) for m in mu]),
        "_listing": np.array([listing_flip_time(SPIN, float(m)) for m in mu]),
    }
    data = xr.Dataset(
        coords={"mu": variable(mu, "s m-1", "friction coefficient", ("mu",))},
        attrs={"spin_rad_per_s": SPIN, "within_rad": SETTLED, "window_s": WINDOW},
    )
    for suffix, times in columns.items():
        a, b, straight, correlation = power_law(mu, times)
        data[f"flip_time{suffix}"] = variable(times, "s", "flip time", ("mu",))
        data[f"factor{suffix}"] = variable(a, "s", "a of the fit a mu^b (mu in s/m)")
        data[f"exponent{suffix}"] = variable(b, "1", "b of the fit a mu^b")
        data[f"exponent_of_logarithms{suffix}"] = variable(straight, "1", "slope of log t over log mu")
        data[f"correlation{suffix}"] = variable(correlation, "1", "Pearson correlation of log t with log mu")
    return data


def _other_spins(quick: bool) -> xr.Dataset:
    spins = np.array(OTHER_SPINS[::3] if quick else OTHER_SPINS)
    mu = np.linspace(0.2, 1.0, 5 if quick else 9)
    data = xr.Dataset(
        coords={
            "spin": variable(spins, "rad s-1", "spin at launch", ("spin",)),
            "mu": variable(mu, "s m-1", "friction coefficient", ("mu",)),
        }
    )
    for suffix, measure in (("", converged_flip_time), ("_listing", listing_flip_time)):
        times = np.array([[measure(float(spin), float(m)) for m in mu] for spin in spins])
        exponents = [power_law(mu, row)[1] for row in times]
        data[f"flip_time{suffix}"] = variable(times, "s", "flip time", ("spin", "mu"))
        data[f"exponent{suffix}"] = variable(exponents, "1", "b of the fit a mu^b", ("spin",))
    return data


def _wide(quick: bool) -> xr.Dataset:
    mu = np.geomspace(0.01, 10.0, 13 if quick else 37)
    spins = np.array([100.0, 155.0])
    times = np.array(
        [
            [converged_flip_time(float(spin), float(m), max(WINDOW, 4.0 / m + 4.0)) for m in mu]
            for spin in spins
        ]
    )
    small = mu <= 0.1001
    slopes = [float(np.polyfit(np.log(mu[small]), np.log(row[small]), 1)[0]) for row in times]
    return xr.Dataset(
        {
            "flip_time_wide": variable(times, "s", "flip time", ("spin_wide", "mu_wide")),
            "small_exponent": variable(slopes, "1", "exponent of mu over 0.01 to 0.1 s/m", ("spin_wide",)),
        },
        {
            "spin_wide": variable(spins, "rad s-1", "spin at launch", ("spin_wide",)),
            "mu_wide": variable(mu, "s m-1", "friction coefficient", ("mu_wide",)),
        },
        {"window_wide": "the longer of 20 s and 4 / mu + 4 s"},
    )


EXPERIMENTS = [
    Experiment("flip-times", "flip time against friction, at 155 rad/s", 7.0, _flip_times),
    Experiment("flip-times-spins", "the same at other spins", 14.0, _other_spins),
    Experiment("flip-times-wide", "flip time over three decades of friction", 3.0, _wide),
]
"""What Fig. 7 is made from."""
