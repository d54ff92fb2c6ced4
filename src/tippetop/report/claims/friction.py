"""Claims about friction: Fig. 7, Fig. 8, and what is said of other values of mu."""

from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from tippetop.report.claim import Finding, both, examines, listed
from tippetop.report.experiments.friction import power_law
from tippetop.report.quoted import EXPONENT
from tippetop.report.tolerance import ARRIVED, PLOTTED, TRANSCRIBED, half_last_digit

_LOST = 0.1
"""Relative departure from the law that counts as losing it: more than its scatter over a decade
below; the claim fig07-inverse tells it.
"""


@examines("sec3-friction", "friction-extremes")
def _(data: xr.Dataset) -> Finding:
    mu, times = data["mu"].values, data["turning_time"].values
    turns = np.isfinite(times)
    fastest = int(np.nanargmin(times))
    some = listed("{:.2f} s at {:g} s/m", times[turns], mu[turns])
    none = " and ".join(f"{m:g} s/m" for m in mu[~turns])
    return Finding.unlisted(
        not turns[0]
        and bool((np.diff(times[fastest:][turns[fastest:]]) > 0).all())
        and not turns[-1],
        f"The axis of the main launch first passes the horizontal after {some}; within"
        f" {data.attrs['window_s']:g} s it does not at {none}. Much friction hinders: the slip that"
        " turns the top over is soon gone, and a rolling top turns slowly.",
    )


@examines("fig07-exponent", "flip-times", "flip-times-spins")
def _(times: xr.Dataset, others: xr.Dataset) -> Finding:
    nearest = _nearest_fit(times, others)
    fits = [fit.exponent for fit in _fits(times, others)]
    given = sum(abs(fit - float(EXPONENT)) <= half_last_digit(EXPONENT).value for fit in fits)
    return Finding(
        *both(times, "exponent"),
        f"Judged as a law, at Fig. 4's spin, {times.attrs['spin_rad_per_s']:g} rad/s, in steps of"
        f" {_step(times['mu']):.2g} s/m; the report gives neither. Of {len(fits)} fits by its"
        f" method, at this and other spins and steps, {given or 'none'}"
        f" give{'s' if given == 1 else ''} {EXPONENT}: they have {min(fits):.2f} to"
        f" {max(fits):.2f}, and the nearest is {nearest.exponent:.4f} ({nearest.converged:.4f}"
        " converged). A law it is not: the time jumps as the last swings about pi miss or meet the"
        " 0.01 rad (why-exponent).",
        nearest.exponent,
        f"fitted at {nearest.spin:g} rad/s in steps of {nearest.step:g} s/m",
    )


@examines("fig07-inverse", "flip-times", "flip-times-spins")
def _(times: xr.Dataset, others: xr.Dataset) -> Finding:
    nearest = _nearest_fit(times, others)
    theirs, ours = (_scatter(times[f"flip_time{suffix}"]) for suffix in ("_listing", ""))
    smooth = _scatter(times["turning_time"])
    return Finding(
        theirs < _LOST,
        ours < _LOST,
        f"Judged as the exponent of Fig. 7 is: by the report's definition of the flip time, at"
        f" {times.attrs['spin_rad_per_s']:g} rad/s. There mu t departs from its mean over this"
        f" range by up to {100 * theirs:.0f} % by its method and {100 * ours:.0f} % converged, and"
        f" by up to {100 * nearest.scatter:.0f} % at {nearest.spin:g} rad/s, where the fit is"
        f" nearest to {EXPONENT}. The time at which the axis first passes the horizontal, which"
        f" does not jump, departs by up to {100 * smooth:.0f} %. For weak friction the law holds"
        f" (why-flip-law).",
        nearest.scatter < _LOST,
        f"launched at {nearest.spin:g} rad/s, in steps of {nearest.step:g} s/m",
        right=f"mu t departs from its mean by up to {100 * ours:.0f} %",
    )


def _scatter(times: xr.DataArray) -> float:
    """Return the largest departure of mu t from its mean, relative to the mean."""
    product = times["mu"] * times
    return float(abs(product / product.mean() - 1.0).max())


class _Fit(NamedTuple):
    """A fit of a power of mu: spin, rad/s, step of mu, s/m, the largest relative departure of mu t
    from its mean and the exponent by the report's method, and the converged exponent.
    """

    spin: float
    step: float
    scatter: float
    exponent: float
    converged: float


_FITTED = 5
"""The fewest values of mu that a fit is made of."""


def _fits(times: xr.Dataset, others: xr.Dataset) -> list[_Fit]:
    """All fits: that of the main spin, and those of others with every value of mu, and with every
    second.
    """
    suffixes = ("_listing", "")
    main = (float(times[f"exponent{suffix}"]) for suffix in suffixes)
    scatter = _scatter(times["flip_time_listing"])
    fits = [_Fit(float(times.attrs["spin_rad_per_s"]), _step(times["mu"]), scatter, *main)]
    for k, spin in enumerate(others["spin"].values):
        for every in (1, 2) if others.sizes["mu"] > 2 * _FITTED - 2 else (1,):
            some = others.isel(spin=k, mu=slice(None, None, every))
            rows = (some[f"flip_time{suffix}"].values for suffix in suffixes)
            fits.append(
                _Fit(
                    float(spin),
                    _step(some["mu"]),
                    _scatter(some["flip_time_listing"]),
                    *(power_law(some["mu"].values, row)[1] for row in rows),
                )
            )
    return [fit for fit in fits if np.isfinite(fit.exponent)]


def _nearest_fit(times: xr.Dataset, others: xr.Dataset) -> _Fit:
    """Return the fit by the report's method that comes nearest to the exponent that it prints."""
    return min(_fits(times, others), key=lambda fit: abs(fit.exponent - float(EXPONENT)))


def _step(mu: xr.DataArray) -> float:
    return float(mu[1] - mu[0])


@examines("summary-large-mu", "flip-times-wide")
def _(wide: xr.Dataset) -> Finding:
    product = wide["mu_wide"] * wide["flip_time_wide"]
    law = product.sel(mu_wide=wide["mu_wide"] <= 0.1001).mean("mu_wide")
    off = abs(product / law - 1.0).transpose("spin_wide", "mu_wide")
    beyond = off.sel(mu_wide=wide["mu_wide"] > 1.0)
    first = [float(wide["mu_wide"][int(np.argmax(row > _LOST))]) for row in off.values]
    named = listed("{:.2f} s/m at {:g} rad/s", first, wide["spin_wide"].values, between=" and ")
    return Finding.unlisted(
        bool(float(beyond.max()) > _LOST),
        f"Beyond 1 s/m mu t departs by up to a factor {1 + float(beyond.max()):.1f}. By the"
        " report's definition it does so earlier, too: it is first off by more than"
        f" {100 * _LOST:.0f} % at {named}.",
    )


@examines("fig08-around-pi", "run-mu-100")
def _(run: xr.Dataset) -> Finding:
    (theirs, _), (ours, last) = (_round_the_pole(run, suffix) for suffix in ("_listing", ""))
    late = run["theta"].sel(time=slice(last, None))
    return Finding(
        theirs > 0.5,
        ours > 0.5,
        "theta is a polar angle and cannot exceed pi; that the top nutates around it means that"
        " its axis goes round the pole, with the precession in the same sense where it is nearest"
        " to pi as where it is farthest. At 155 rad/s (the spin of Fig. 8 is not given) it does so"
        f" in {100 * ours:.0f} % of the nutations of 20 s after turning over, until {last:.1f} s;"
        f" from then on the tilt swings below pi, between {late.min():.3f} and {late.max():.3f}"
        " rad, beside the pole.",
    )


def _nearest_to_pi(run: xr.Dataset, suffix: str) -> tuple[np.ndarray, np.ndarray]:
    """When the tilt is largest in the nutations beyond the horizontal, s, and the precession there,
    rad/s.
    """
    times, theta = run[f"time{suffix}"].values, run[f"theta{suffix}"].values
    rising = np.diff(theta) > 0
    peaks = np.flatnonzero(rising[:-1] & ~rising[1:]) + 1
    peaks = peaks[theta[peaks] > np.pi / 2]
    return times[peaks], run[f"phi_dot{suffix}"].values[peaks]


def _round_the_pole(run: xr.Dataset, suffix: str) -> tuple[float, float]:
    """Return the part of the nutations in which the axis goes round the pole, and when it does so
    last, s.
    """
    times, precession = _nearest_to_pi(run, suffix)
    round_it = precession > 0
    return float(round_it.mean()), float(times[round_it][-1])


@examines("fig08-rapid", "run-mu-100")
def _(run: xr.Dataset) -> Finding:
    theirs, ours = (
        float(np.median(np.diff(_nearest_to_pi(run, suffix)[0]))) for suffix in ("_listing", "")
    )
    shown = PLOTTED.value * float(run["time"][-1])
    return Finding(
        theirs < shown,
        ours < shown,
        f"A nutation takes {ours:.3f} s, {1 / ours:.0f} a second; a plot of 20 s shows"
        f" {shown:.2g} s.",
    )


@examines("fig08-settles", "settling-mu-100", tolerance=ARRIVED)
def _(later: xr.Dataset) -> Finding:
    swing = later["swing"]
    return Finding.unlisted(
        float(swing[-1]),
        f"20 s are too short for it: there the tilt still swings by {swing[0]:.3f} rad. Converged"
        " swings in the second before:"
        f" {listed('{:.4f} rad at {:g} s', swing.values, swing['end'].values)}.",
    )


@examines("fig08-block", "block")
def _(block: xr.Dataset) -> Finding:
    distance = float(block["distance"])
    return Finding.unlisted(distance, f"It comes to rest after {1e3 * distance:.3f} mm.")


_LENGTH: dict[str, Any] = {
    "quantity": "length",
    "others": "centimetres",
    "wrong": "m/s",
}
_TIME: dict[str, Any] = {
    "quantity": "time",
    "others": "tenths",
    "wrong": "m s^2",
}


@examines("eq-2.7-mu-unit", "units", **_LENGTH, correct="s/m")
@examines("table-1-mu-unit", "units", **_LENGTH, correct="s/m, which section 2.2 has right,")
@examines("table-1-g-unit", "units", **_TIME, correct="m s^-2")
def _(check: xr.Dataset, *, quantity: str, others: str, wrong: str, correct: str) -> Finding:
    misses = abs(check[f"theta_in_{others}"] - check["theta"])
    k = int(np.argmin(misses.values))
    found = float(misses[f"power_of_{quantity}"][k])
    return Finding(
        found,
        found,
        f"A launch computed in other units of {quantity} must give the same tilt. Converted as "
        f"{correct} it differs by {misses[k]:.1e} rad after 2 s, as {wrong} by "
        f"{misses[1 - k]:.1e} rad." + (f" {TRANSCRIBED}" if quantity == "time" else ""),
    )
