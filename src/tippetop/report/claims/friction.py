"""Claims about friction: Fig. 7, Fig. 8, and statements on other values of mu."""

from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from tippetop.report.claim import Finding, both, examines, listed
from tippetop.report.experiments.friction import power_law
from tippetop.report.printed_numbers import EXPONENT
from tippetop.report.tolerance import ARRIVED, PLOTTED, TRANSCRIBED, half_last_digit

_LOST = 0.1
"""Relative departure from the law above which it does not hold, as in the claim fig07-inverse."""


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
        f" {data.attrs['window_s']:g} s it does not at {none}. Much friction hinders turning over:"
        " the slip that turns the top over soon ends, and a rolling top turns slowly.",
    )


@examines("fig07-exponent", "flip-times", "flip-times-spins")
def _(times: xr.Dataset, others: xr.Dataset) -> Finding:
    nearest = _nearest_fit(times, others)
    fits = [fit.exponent for fit in _fits(times, others)]
    agreeing = sum(abs(fit - float(EXPONENT)) <= half_last_digit(EXPONENT).value for fit in fits)
    return Finding(
        *both(times, "exponent"),
        f"Judged as a law, at Fig. 4's spin, {times.attrs['spin_rad_per_s']:g} rad/s, in steps of"
        f" {_step(times['mu']):.2g} s/m; the report states neither. Of {len(fits)} fits by its"
        f" method, at this and other spins and steps, {agreeing or 'none'}"
        f" give{'s' if agreeing == 1 else ''} {EXPONENT}: their exponents are {min(fits):.2f} to"
        f" {max(fits):.2f}, and the nearest is {nearest.exponent:.4f} ({nearest.converged:.4f}"
        " converged). It is not a law: the time jumps when one swing more about pi exceeds"
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
        f"Judged like the exponent of Fig. 7: by the report's definition of the flip time, at"
        f" {times.attrs['spin_rad_per_s']:g} rad/s. Then mu t departs from its mean over this"
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
    """Fit of a power of mu: spin (rad/s), step of mu (s/m), scatter and exponents.

    `scatter` is the largest relative departure of mu t from its mean, and `exponent` the exponent
    of the fit, both by the report's method; `converged` is the converged exponent.
    """

    spin: float
    step: float
    scatter: float
    exponent: float
    converged: float


_FITTED = 5
"""Smallest number of values of mu in a fit."""


def _fits(times: xr.Dataset, others: xr.Dataset) -> list[_Fit]:
    """Return all fits: of the main spin, and of other spins with every and with every second value
    of mu.
    """
    suffixes = ("_listing", "")
    main = (float(times[f"exponent{suffix}"]) for suffix in suffixes)
    scatter = _scatter(times["flip_time_listing"])
    fits = [_Fit(float(times.attrs["spin_rad_per_s"]), _step(times["mu"]), scatter, *main)]
    for k, spin in enumerate(others["spin"].values):
        for every in (1, 2) if others.sizes["mu"] > 2 * _FITTED - 2 else (1,):
            times_at = others.isel(spin=k, mu=slice(None, None, every))
            rows = (times_at[f"flip_time{suffix}"].values for suffix in suffixes)
            fits.append(
                _Fit(
                    float(spin),
                    _step(times_at["mu"]),
                    _scatter(times_at["flip_time_listing"]),
                    *(power_law(times_at["mu"].values, row)[1] for row in rows),
                )
            )
    return [fit for fit in fits if np.isfinite(fit.exponent)]


def _nearest_fit(times: xr.Dataset, others: xr.Dataset) -> _Fit:
    """Return the fit by the report's method with the exponent nearest to the printed one."""
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
    late = run["tilt"].sel(time=slice(last, None))
    return Finding(
        theirs > 0.5,
        ours > 0.5,
        "theta is a polar angle and cannot exceed pi; a top nutates around pi if its axis goes"
        " round the pole, so that the precession has the same sense where theta is nearest to pi"
        " as where it is farthest. At 155 rad/s (the report does not state the spin of Fig. 8) it"
        f" does so in {100 * ours:.0f} % of the nutations of 20 s after turning over, until"
        f" {last:.1f} s; after that the tilt swings below pi, between {late.min():.3f} and"
        f" {late.max():.3f} rad, beside the pole.",
    )


def _nearest_to_pi(run: xr.Dataset, suffix: str) -> tuple[np.ndarray, np.ndarray]:
    """Return the times (s) of the largest tilts of nutations beyond pi/2, and the precession
    (rad/s) then.
    """
    times, theta = run[f"time{suffix}"].values, run[f"tilt{suffix}"].values
    rising = np.diff(theta) > 0
    peaks = np.flatnonzero(rising[:-1] & ~rising[1:]) + 1
    peaks = peaks[theta[peaks] > np.pi / 2]
    return times[peaks], run[f"precession{suffix}"].values[peaks]


def _round_the_pole(run: xr.Dataset, suffix: str) -> tuple[float, float]:
    """Return the share of nutations in which the axis goes round the pole, and the last time of
    one, s.
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
        f"After 20 s the tilt still swings by {swing[0]:.3f} rad. Converged swings in the second"
        " before:"
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
    misses = abs(check[f"tilt_in_{others}"] - check["tilt"])
    k = int(np.argmin(misses.values))
    power = float(misses[f"power_of_{quantity}"][k])
    return Finding(
        power,
        power,
        f"A launch computed in other units of {quantity} must give the same tilt. Converted as "
        f"{correct} it differs by {misses[k]:.1e} rad after 2 s, as {wrong} by "
        f"{misses[1 - k]:.1e} rad." + (f" {TRANSCRIBED}" if quantity == "time" else ""),
    )
