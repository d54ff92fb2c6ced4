"""Final tilt as a function of the spin: Fig. 6 and its two critical spins."""

import math

import numpy as np
import xarray as xr
from scipy.optimize import brentq

from tippetop.problem.presets import report_problem
from tippetop.report.experiment import dataset, experiment
from tippetop.report.experiments.flights import leaves_at, onset_between
from tippetop.report.experiments.runs import WINDOW, on_table, swept, unilateral
from tippetop.report.listing import listing_run
from tippetop.report.readings import SETTLED
from tippetop.run import simulate

MARGINS = (0.001, SETTLED, 0.1)
"""Tilts that may count as upright, and distances from pi that may count as inverted, rad."""

LISTED_MARGINS = np.linspace(0.001, 0.01, 91)
"""Fine values of the same margins, up to 0.01 rad, for the report's method."""

TURNED = 0.1
"""Distance of a final tilt from pi within which a launch counts as turned over, rad."""

LONG_WINDOWS = (20.0, 60.0, 200.0, 600.0)

FLYING = (165.0, 210.0)
"""Range of spins with final tilts on a table that only pushes, in Fig. 6, rad/s."""

_TILT = ("rad", "tilt at the end of the run")


def final_tilt(spin: float, window: float = WINDOW) -> float:
    """Return the final tilt of a converged run on a table that pulls, rad; nan if it became
    singular.
    """
    run = simulate(on_table(report_problem(spin)), window, samples=2)
    return float(run["tilt"].values[-1]) if run.attrs["status"] == "completed" else math.nan


def _listing_spins(quick: bool) -> np.ndarray:
    low = np.arange(24.0, 29.0)
    high = np.arange(77.5, 80.1, 1.0 if quick else 0.5)
    top = np.arange(166.0, 174.0, 2.0 if quick else 1.0)
    between = np.concatenate([np.arange(5, 24, 6), np.arange(35, 76, 8), np.arange(85, 164, 10)])
    coarse = between[1::5] if quick else between
    return np.unique(
        np.concatenate([coarse, low, high, top, [180.0] if quick else [180, 190, 200, 210]])
    )


@experiment("final-tilt-listing", "final tilt against spin, by the report's method", 14.0)
def _by_listing(quick: bool) -> xr.Dataset:
    spins = _listing_spins(quick)
    runs = (listing_run(report_problem(float(spin)), WINDOW) for spin in spins)
    tilts = np.array([float(run["tilt"].values[-1]) for run in runs])
    low, high = (spins >= 24) & (spins < 32), (spins > 76) & (spins < 81)
    upright = [
        _where(spins[low], np.log(tilts[low]), math.log(margin)) for margin in LISTED_MARGINS
    ]
    inverted = [
        _where(spins[high], -np.log(math.pi - tilts[high]), -math.log(margin))
        for margin in LISTED_MARGINS
    ]
    name = "spin above which the final tilt is no longer 0, by the report's method"
    name_inverted = "spin above which the final tilt is pi, by the report's method"
    return dataset(
        {"spin_listing": spins, "margin_listing": LISTED_MARGINS},
        final_tilt_listing=(tilts, *_TILT, "spin_listing"),
        critical_upright_listing=(upright, "rad s-1", name, "margin_listing"),
        critical_inverted_listing=(inverted, "rad s-1", name_inverted, "margin_listing"),
        lost_listing=_least_lost(
            spins, np.abs(tilts - math.pi) > TURNED, ", by the report's method"
        ),
    )


def _least_lost(spins: np.ndarray, lost: np.ndarray, words: str) -> tuple[float, str, str]:
    """Return the least spin above 100 rad/s that does not end at pi, with its unit and meaning."""
    lost_spins = spins[(spins > 100) & lost]
    name = f"least spin above 100 rad/s that does not end at pi{words}"
    return lost_spins.min() if len(lost_spins) else np.nan, "rad s-1", name


def _where(x: np.ndarray, y: np.ndarray, level: float) -> float:
    """Return the place at which rising values reach a level, by linear interpolation."""
    return float(np.interp(level, np.maximum.accumulate(y), x))


@experiment("final-tilt", "final tilt against spin, converged", 2.5)
def _converged(quick: bool) -> xr.Dataset:
    spins = np.arange(5.0, 210.1, 2.5 if quick else 0.5)
    tilts = swept(on_table(report_problem()), {"launch.spin": spins})["final_tilt"].values

    def leaves(spin: float) -> float:
        return leaves_at(report_problem(spin), WINDOW)

    onset = onset_between(leaves, 120.0, 200.0, WINDOW, accuracy=0.005)
    pulling = "least spin at which the table would have to pull within the window"
    only = "tilt at the end of the run on a table that only pushes"
    flying = np.arange(FLYING[0], FLYING[1] + 0.1, 7.5 if quick else 2.5)
    true_tilts = swept(unilateral(report_problem()), {"launch.spin": flying})["final_tilt"].values
    return dataset(
        {"spin": spins, "spin_flight": flying},
        {"window_s": WINDOW},
        final_tilt=(tilts, *_TILT, "spin"),
        final_tilt_flight=(true_tilts, "rad", only, "spin_flight"),
        lift_off_onset=(onset, "rad s-1", pulling),
        lost=_least_lost(spins, ~(np.abs(tilts - math.pi) < TURNED), " on a table that pulls"),
    )


def critical_spins(
    window: float,
    margin: float,
    between: tuple[tuple[float, float], tuple[float, float]] = ((22.0, 34.0), (72.0, 84.0)),
) -> tuple[float, float]:
    """Return the two spins (rad/s) between which a launch ends neither upright nor inverted.

    `window` is the length of the runs, s. `margin` is the final tilt that counts as upright, and
    the distance from pi that counts as inverted, rad. `between` are the intervals in which the
    spins are searched, rad/s.
    """

    def upright(spin: float) -> float:
        return math.log(max(final_tilt(spin, window), 1e-12) / margin)

    def inverted(spin: float) -> float:
        return -math.log(max(math.pi - final_tilt(spin, window), 1e-12) / margin)

    first, second = (
        brentq(of, *ends, xtol=2e-3) for of, ends in zip((upright, inverted), between, strict=True)
    )
    return float(first), float(second)


@experiment("critical-spins", "critical spins against the length of the runs", 9.0)
def _thresholds(quick: bool) -> xr.Dataset:
    windows = LONG_WINDOWS[:2] if quick else LONG_WINDOWS
    critical = [critical_spins(windows[0], SETTLED)]
    for window in windows[1:]:
        # Longer runs show critical spins that lie between those of shorter runs, near to them.
        upright, inverted = critical[-1]
        critical.append(
            critical_spins(window, SETTLED, ((upright, upright + 1.0), (inverted - 1.2, inverted)))
        )
    by_window = np.array(critical)
    by_margin = np.array([critical_spins(WINDOW, margin) for margin in MARGINS])
    names = (
        "spin above which the final tilt is no longer 0",
        "spin above which the final tilt is pi",
    )
    return dataset(
        {"window": list(windows), "margin": list(MARGINS)},
        {"margin_of_windows_rad": SETTLED},
        upright_by_window=(by_window[:, 0], "rad s-1", names[0], "window"),
        inverted_by_window=(by_window[:, 1], "rad s-1", names[1], "window"),
        upright_by_margin=(by_margin[:, 0], "rad s-1", names[0], "margin"),
        inverted_by_margin=(by_margin[:, 1], "rad s-1", names[1], "margin"),
    )
