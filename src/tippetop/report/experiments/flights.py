"""Launches that leave the table: the least spin that does, and the flights after it."""

import math
from collections.abc import Callable

import numpy as np
import xarray as xr

from tippetop.problem.presets import report_problem
from tippetop.problem.problem import Problem
from tippetop.report.experiment import dataset, experiment
from tippetop.report.experiments.runs import WINDOW, flight_readings, stopping, swept, unilateral
from tippetop.report.printed_numbers import MU, TILT
from tippetop.run import simulate

LONG_WINDOW = 100.0
"""Length of the longer runs that are searched for a lift-off, s."""

FLIGHTS_WINDOW = 60.0
"""Length of the runs through all flights, s."""

SAMPLES_PER_SECOND = 100
"""Number of samples per second of the runs through all flights."""


def leaves_at(problem: Problem, window: float) -> float:
    """Return when a launch first leaves the table, s; nan if it does not within the window."""
    return float(simulate(stopping(problem), window, samples=2)["liftoff_time"])


def first_onset(
    times: Callable[[float], float],
    spins: np.ndarray,
    scanned: np.ndarray,
    window: float,
    accuracy: float,
) -> float:
    """Return the least spin that leaves the table, rad/s, from a scan refined by halving.

    `times` gives the time of the first lift-off at a spin, s, nan if there is none; `scanned` are
    these times at the increasing `spins`, rad/s. A lift-off counts up to the time `window`, s;
    `accuracy` is the largest error, rad/s. nan is returned if no spin of the scan lifts off, or
    already the first does.
    """
    lifting = np.flatnonzero(scanned <= window)
    if not len(lifting) or lifting[0] == 0:
        return math.nan
    return onset_between(
        times, float(spins[lifting[0] - 1]), float(spins[lifting[0]]), window, accuracy
    )


def onset_between(
    times: Callable[[float], float], low: float, high: float, window: float, accuracy: float
) -> float:
    """Return the onset of lift-off (rad/s) between a spin that stays and one that leaves, by
    halving.
    """
    while high - low > 2.0 * accuracy:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if times(middle) <= window else (middle, high)
    return 0.5 * (low + high)


def _onsets(field: str, values: np.ndarray, windows: tuple[float, ...], quick: bool) -> xr.Dataset:
    """Return times of the first lift-off against spin and another field, and the onset for its
    values.
    """
    name = field.partition(".")[2]
    spins = np.arange(60.0, 600.1, 120.0 if quick else 30.0)
    base = stopping(report_problem(tilt=TILT, mu=MU))
    times = swept(base, {field: values, "launch.spin": spins}, windows[-1])["liftoff_time"].values

    def onset(window: float, value: float, row: np.ndarray) -> float:
        def leaves(spin: float) -> float:
            return leaves_at(base.replace({field: value, "launch.spin": spin}), window)

        return first_onset(leaves, spins, row, window, 2.0 if quick else 0.25)

    scans = list(zip(values, times, strict=True))
    onsets = [[onset(window, value, row) for value, row in scans] for window in windows]
    onset_name = "least spin of the scan that leaves the table, refined by halving"
    return dataset(
        {"spin": spins, "window": list(windows), name: values},
        liftoff_time=(times, "s", "when the top first leaves the table", name, "spin"),
        onset=(onsets, "rad s-1", onset_name, "window", name),
    )


@experiment("onset-mu", "the least spin that leaves the table, against friction", 7.0)
def _over_mu(quick: bool) -> xr.Dataset:
    values = np.geomspace(0.05, 10.0, 3 if quick else 8)
    return _onsets("friction.mu", values, (WINDOW, LONG_WINDOW), quick).assign_attrs(tilt_rad=TILT)


@experiment("onset-tilt", "the least spin that leaves the table, against tilt", 5.0)
def _over_tilt(quick: bool) -> xr.Dataset:
    values = np.sort([TILT, *np.linspace(0.05, 1.4, 4 if quick else 12)])
    return _onsets("launch.tilt", values, (WINDOW,), quick).assign_attrs(mu_s_per_m=MU)


def followed(spins: tuple[float, ...], restitution: float) -> xr.Dataset:
    """Return launches with these spins (rad/s) on a table that only pushes, with all their flights.

    Variables over restitution and spin: those of `flight_readings`, and liftoff_time, s.
    """
    samples = int(SAMPLES_PER_SECOND * FLIGHTS_WINDOW) + 1
    problems = [unilateral(report_problem(spin), restitution) for spin in spins]
    runs = [simulate(problem, FLIGHTS_WINDOW, samples=samples) for problem in problems]
    read = [flight_readings(run).assign(liftoff_time=run["liftoff_time"]) for run in runs]
    data = dataset(
        {"spin": list(spins), "restitution": [restitution]}, {"window_s": FLIGHTS_WINDOW}
    )
    return data.assign(xr.concat(read, "spin").expand_dims("restitution"))


@experiment("flights", "launches followed through their flights", 11.0)
def _plastic(quick: bool) -> xr.Dataset:
    spins = (160.0, 168.0, 175.0, 200.0, 250.0, 300.0, 400.0, 500.0, 700.0, 1000.0)
    return followed((160.0, 175.0, 300.0, 600.0) if quick else spins, restitution=0.0)


@experiment("flights-bouncing", "the same with impacts that rebound", 5.0)
def _bouncing(quick: bool) -> xr.Dataset:
    return followed((175.0, 200.0) if quick else (175.0, 200.0, 250.0, 300.0), restitution=0.5)
