"""Claims that theory explains: the report's statements against steady states and the averaged
flow.
"""

import numpy as np
import xarray as xr

from tippetop.report.claim import Finding, examines, listed
from tippetop.report.experiments.theory import QUOTED_SPINS
from tippetop.report.printed_numbers import ABNORMAL_SPIN, CRITICAL_SPINS
from tippetop.report.readings import SETTLED
from tippetop.report.tolerance import Tolerance, rounded

_NEAR_LIMIT = 1e-3
"""Relative difference within which a value agrees with its limit: the report's own tolerance."""


@examines(
    "why-final-tilt",
    tolerance=Tolerance(1e-6, "ten thousand times less than what the report's figures can show"),
)
def _(states: xr.Dataset) -> Finding:
    quoted = states.isel(
        run=[int(np.argmin(abs(states["run_spin"].values - s))) for s in QUOTED_SPINS]
    )
    spins, tilts, ends = (quoted[f"run_{name}"].values for name in ("spin", "predicted", "end"))
    each = listed(
        "{:g} rad/s: {:.6f} rad ({} off)", spins, tilts, map(rounded, ends - tilts), between="; "
    )
    return Finding.unlisted(
        _tilt_miss(states),
        "Friction does not change Jellett's integral lambda, and only one stable steady state has"
        " the lambda of the launch. Predicted from lambda, against runs of"
        f" {states.attrs['long_run_s']:g} s: {each}.",
    )


@examines("why-regimes", "why-bifurcation", "why-groups", "final-tilt-listing")
def _(states: xr.Dataset, chart: xr.Dataset, listing: xr.Dataset) -> Finding:
    upright, inverted = (float(limit) for limit in states["limits"])
    spin, end = states["run_spin"].values, states["run_end"].values
    expected_upright, expected_inverted = spin < upright, spin > inverted
    as_claimed = (
        np.array_equal(end < SETTLED, expected_upright)
        and np.array_equal(np.pi - end < SETTLED, expected_inverted)
        and bool((states["run_stable"] == 1).all())
    )
    both = int((states["run_stable_jump"] == 2).sum())
    first, second = (float(printed) for printed in CRITICAL_SPINS)
    spins, tilts = listing["spin_listing"].values, listing["final_tilt_listing"].values
    tilted = (spins > first + 1.0) & (spins < second - 1.0)
    by_method = (
        bool((tilts[spins < first] < SETTLED).all())
        and bool(((tilts[tilted] > SETTLED) & (np.pi - tilts[tilted] > SETTLED)).all())
        and bool((np.pi - tilts[(spins > second) & (spins < float(ABNORMAL_SPIN))] < SETTLED).all())
    )
    group = str(chart["top_group"].values[0])
    return Finding(
        by_method,
        as_claimed,
        f"The critical spins are {upright:.2f} and {inverted:.2f} rad/s. The statement holds"
        f" because this top is in group {group}: at every spin one steady state is stable. A top"
        f" with I1 / I3 ="
        f" {states.attrs['inertia_ratio_jump']:g} has two at {both} of {states.sizes['run_jump']}"
        " launches, and its launch decides between them.",
    )


@examines("why-flip-law", "why-exponent")
def _(times: xr.Dataset) -> Finding:
    misses = _law_misses(times)
    return Finding.unlisted(
        max(misses) < _NEAR_LIMIT,
        "Weak friction hardly disturbs the nutation: averaged over one period of it, the torque and"
        " the power of friction are proportional to mu, so that the motion depends on mu t only."
        " The averaged"
        f" flow has mu t_flip = {times['limit_arrival']:.4f} s²/m at"
        f" {times.attrs['spin_rad_per_s']:g} rad/s without one full run; runs at mu ="
        f" {times['mu_flip'][0]:g} s/m differ from it by {misses[0]:.1e} of its value, and by"
        f" {misses[1]:.1e} in the time to pi/2. The rule is for small mu; it does not apply near"
        " 1 s/m.",
    )


@examines(
    "section-5-small-mu",
    "why-exponent",
    "flip-times-wide",
    tolerance=Tolerance(0.005, "the precision of the exponent quoted for Fig. 7, half a per cent"),
)
def _(times: xr.Dataset, wide: xr.Dataset) -> Finding:
    some = times.sel(mu_flip=[0.1, 0.3, 1.0, 3.0], method="nearest")
    local = listed(
        "{:.3f} at {:.2g}", some["exponent_crossing_time"].values, some["mu_flip"].values
    )
    exponents, spins = wide["small_exponent"].values, wide["spin_wide"].values
    fitted = listed("{:.4f} at {:g} rad/s", exponents, spins, between=" and ")
    nearest = times.sel(mu_flip=0.01, method="nearest")
    return Finding.unlisted(
        float(nearest["exponent_arrival_time_end"]),
        f"Fitted up to 0.1 s/m it is {fitted}. The exponent of the time to the "
        f"first tilt above pi/2 leaves -1 as mu grows (s/m): {local}.",
    )


@examines("why-only-simulation", "why-critical", "why-bifurcation", "why-exponent")
def _(theory: xr.Dataset, states: xr.Dataset, times: xr.Dataset) -> Finding:
    tilt, law = _tilt_miss(states), max(_law_misses(times))
    spectral = float(abs(theory["critical_spectrum"] / theory["critical_formula"] - 1.0).max())
    theory_agrees = spectral < _NEAR_LIMIT and tilt < SETTLED and law < _NEAR_LIMIT
    return Finding.unlisted(
        not theory_agrees,
        "Theory gives the critical spins, the final tilt (runs differ from it by at most"
        f" {tilt:.0e} rad) and, for small mu, the time to turn over (to {law:.0e} of its value)."
        " Only the single swings of a launch need a simulation.",
    )


def _tilt_miss(states: xr.Dataset) -> float:
    """Return the largest error of the predicted final tilts of the report's top, rad."""
    return float(abs(states["run_end"] - states["run_predicted"]).max())


def _law_misses(times: xr.Dataset) -> tuple[float, float]:
    """Return the relative errors of the limit of mu t at the least mu, for arrival and for pi/2."""
    least = times.isel(mu_flip=0)
    mu = float(least["mu_flip"])
    arrival = mu * float(least["arrival_time_end"]) / float(times["limit_arrival"])
    crossing = mu * float(least["crossing_time"]) / float(times["limit_crossing"])
    return abs(arrival - 1.0), abs(crossing - 1.0)
