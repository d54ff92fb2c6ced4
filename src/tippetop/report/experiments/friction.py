"""Time of turning over against friction: Fig. 7 and the statements around it."""

import math
from typing import NamedTuple

import numpy as np
import xarray as xr
from scipy.optimize import curve_fit
from scipy.stats import linregress

from tippetop.integrators.base import Array
from tippetop.problem.presets import report_problem
from tippetop.report.experiment import dataset, experiment, variable
from tippetop.report.experiments.runs import WINDOW, on_table, swept
from tippetop.report.listing import listing_run
from tippetop.report.printed_numbers import NORMAL_FRICTION, SPIN
from tippetop.report.readings import SETTLED, crossings, flip_time

FIG_7_SPINS = (100.0, 115.0, 130.0, 145.0, 160.0)
"""Spins besides that of its main run that the report may have used for its Fig. 7, rad/s.

The report does not state it. At mu = 0.3 s/m all of them turn the top over without lifting it.
"""


class Times(NamedTuple):
    """Times of turning over, s, of every spin with every friction coefficient, shape (spins,
    mu).
    """

    flip: Array
    """By the report's definition; nan if a run became singular or did not turn the top over."""
    turning: Array
    """Time at which the axis first passes the horizontal; nan if it does not."""


def converged_times(spins: Array, mu: Array, window: float = WINDOW) -> Times:
    """Return the converged times, on a table that pulls."""
    runs = swept(on_table(report_problem()), {"launch.spin": spins, "friction.mu": mu}, window)
    over = runs["final_tilt"] > math.pi / 2
    return Times(runs["arrival_time"].where(over).values, runs["turnover_time"].values)


def listing_times(spins: Array, mu: Array) -> Times:
    """Return the times by the report's method; nan where it gave up."""
    times = [[_listing_times(float(spin), float(m)) for m in mu] for spin in spins]
    return Times(*np.moveaxis(np.array(times), 2, 0))


def _listing_times(spin: float, mu: float) -> tuple[float, float]:
    run = listing_run(report_problem(spin, mu=mu), WINDOW)
    if run.attrs["failure"]:
        return math.nan, math.nan
    times, theta = run["time"].values, run["tilt"].values
    passed = crossings(times, theta - 0.5 * math.pi)
    return flip_time(times, theta), float(passed[0]) if len(passed) else math.nan


_TURNING = ("s", "first tilt of more than pi/2")


def power_law(mu: Array, times: Array) -> tuple[float, float, float]:
    """Return a and b of the fit t = a mu^b, and a correlation.

    The fit is by least squares of t; the correlation is Pearson's, of log t with log mu. All are
    nan unless there are three positive times for friction coefficients that differ.
    """
    sound = np.isfinite(times)
    x, y = mu[sound], times[sound]
    if len(x) < 3 or not np.ptp(x) > 0.0 or not np.all(y > 0.0):
        return (math.nan,) * 3
    line = linregress(np.log(x), np.log(y))
    (a, b), _ = curve_fit(lambda m, a, b: a * m**b, x, y, p0=(math.exp(line.intercept), line.slope))
    return float(a), float(b), float(line.rvalue)


def _fitted(spins: Array, count: int) -> xr.Dataset:
    """Return times by both methods over the report's range of friction, with fits a mu^b for every
    spin.
    """
    mu = np.linspace(*NORMAL_FRICTION, count)
    data = dataset({"spin": spins, "mu": mu})
    for suffix, measure in (("", converged_times), ("_listing", listing_times)):
        times = measure(spins, mu)
        factor, exponent, correlation = np.array([power_law(mu, row) for row in times.flip]).T
        data[f"flip_time{suffix}"] = variable(times.flip, "s", "flip time", "spin", "mu")
        data[f"turning_time{suffix}"] = variable(times.turning, *_TURNING, "spin", "mu")
        data[f"factor{suffix}"] = variable(factor, "s", "a of the fit a mu^b (mu in s/m)", "spin")
        data[f"exponent{suffix}"] = variable(exponent, "1", "b of the fit a mu^b", "spin")
        data[f"correlation{suffix}"] = variable(
            correlation, "1", "Pearson correlation of log t with log mu", "spin"
        )
    return data


@experiment("flip-times", f"flip time against friction, at {SPIN:g} rad/s", 2.0)
def _flip_times(quick: bool) -> xr.Dataset:
    attrs = {"spin_rad_per_s": SPIN, "within_rad": SETTLED, "window_s": WINDOW}
    times = _fitted(np.array([SPIN]), 7 if quick else 17)
    return times.isel(spin=0, drop=True).assign_attrs(attrs)


@experiment("flip-times-spins", "the same at other spins", 7.0)
def _flip_times_of_spins(quick: bool) -> xr.Dataset:
    return _fitted(np.array(FIG_7_SPINS[:3:2] if quick else FIG_7_SPINS), 5 if quick else 9)


@experiment("flip-times-wide", "flip time over three decades of friction", 2.5)
def _wide(quick: bool) -> xr.Dataset:
    mu = np.geomspace(0.03, 10.0, 9) if quick else np.geomspace(0.01, 10.0, 28)
    spins = np.array([100.0, SPIN])
    # Strong friction delays settling. Powers of two let neighbours run as one sweep.
    needed = np.maximum(3.0 / mu + 4.0, 30.0 * mu)
    windows = WINDOW * 2.0 ** np.ceil(np.log2(np.maximum(1.0, needed / WINDOW)))
    times = np.empty((len(spins), len(mu)))
    for window in np.unique(windows):
        times[:, windows == window] = converged_times(
            spins, mu[windows == window], float(window)
        ).flip
    small = mu <= 0.1001
    slopes = [linregress(np.log(mu[small]), np.log(row[small])).slope for row in times]
    return dataset(
        {"spin_wide": spins, "mu_wide": mu},
        {"window_wide": "20 s, doubled until it is no less than 3 / mu + 4 and 30 mu s"},
        flip_time_wide=(times, "s", "flip time", "spin_wide", "mu_wide"),
        small_exponent=(slopes, "1", "exponent of mu up to 0.1 s/m", "spin_wide"),
    )


@experiment("friction-extremes", "turning over from no friction to far too much", 5.0)
def _extremes(quick: bool) -> xr.Dataset:
    mu = np.array([0.0, 0.3, 1.0, 100.0, *([] if quick else [300.0]), 1000.0])
    window = 0.5 * WINDOW if quick else WINDOW
    runs = swept(on_table(report_problem(SPIN)), {"friction.mu": mu}, window)
    return dataset(
        {"mu": mu},
        {"spin_rad_per_s": SPIN, "window_s": window},
        turning_time=(runs["turnover_time"].values, *_TURNING, "mu"),
    )
