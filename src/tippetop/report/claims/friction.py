"""Claims about friction: Fig. 7, Fig. 8, and what is said of other values of mu."""

from typing import NamedTuple

import numpy as np
import xarray as xr

from tippetop.report.claim import Chapter, Finding, Source, both, listed
from tippetop.report.experiments.friction import power_law
from tippetop.report.quoted import EXPONENT, NORMAL_FRICTION
from tippetop.report.tolerance import ARRIVED, PLOTTED, TRANSCRIBED, WHOLE, half_last_digit

CHAPTER = Chapter()

_LOST = 0.1
"""Relative departure from the law that counts as losing it: more than its scatter over a decade below."""


@CHAPTER.claim(
    "sec3-friction",
    Source("3.3"),
    "Without friction the top hardly turns over, and too much friction makes it difficult too.",
    needs=("friction-extremes",),
    figure="fig07",
)
def _(data: xr.Dataset) -> Finding:
    mu, times = data["mu"].values, data["turning_time"].values
    turns = np.isfinite(times)
    fastest = int(np.nanargmin(times))
    some = listed("{:.2f} s at {:g} s/m", times[turns], mu[turns])
    none = " and ".join(f"{m:g} s/m" for m in mu[~turns])
    return Finding.unlisted(
        not turns[0] and bool((np.diff(times[fastest:][turns[fastest:]]) > 0).all()) and not turns[-1],
        f"The axis of the main launch first passes the horizontal after {some}; within "
        f"{data.attrs['window_s']:g} s it does not at {none}. Much friction hinders: the slip that turns the "
        "top over is soon gone, and a rolling top turns slowly.",
    )


@CHAPTER.claim(
    "fig07-exponent",
    Source("3.3", "Fig. 7, and summary, point 5"),
    f"For mu from {NORMAL_FRICTION[0]:g} to {NORMAL_FRICTION[1]:g} the flip time goes as mu^{EXPONENT}.",
    EXPONENT,
    needs=("flip-times", "flip-times-spins"),
    figure="fig07",
    right="no one power: the time jumps with the last swings",
)
def _(times: xr.Dataset, others: xr.Dataset) -> Finding:
    nearest = min(_fits(times, others), key=lambda fit: abs(fit.exponent - float(EXPONENT)))
    fits = [fit.exponent for fit in _fits(times, others)]
    given = sum(abs(fit - float(EXPONENT)) <= half_last_digit(EXPONENT).value for fit in fits)
    return Finding(
        *both(times, "exponent"),
        "Judged as a law, at Fig. 4's spin, "
        f"{times.attrs['spin_rad_per_s']:g} rad/s, in steps of {_step(times['mu']):.2g} s/m; the report "
        f"gives neither. Of {len(fits)} fits by its method, at this and other spins and steps, "
        f"{given or 'none'} give{'s' if given == 1 else ''} {EXPONENT}: they have {min(fits):.2f} to "
        f"{max(fits):.2f}, and the nearest is {nearest.exponent:.4f} ({nearest.converged:.4f} converged). A "
        "law it is not: the time jumps as the last swings about pi miss or meet the 0.01 rad (why-exponent).",
        nearest.exponent,
        f"fitted at {nearest.spin:g} rad/s in steps of {nearest.step:g} s/m",
    )


@CHAPTER.claim(
    "fig07-inverse",
    Source("3.3", "Fig. 7"),
    f"For mu from {NORMAL_FRICTION[0]:g} to {NORMAL_FRICTION[1]:g} the time to turn over is nearly inversely "
    f"proportional to mu (mu t within {100 * _LOST:.0f} % of its mean, at spins that stay on the table).",
    needs=("flip-times", "flip-times-spins", "onset-mu"),
    figure="fig07",
)
def _(times: xr.Dataset, others: xr.Dataset, onsets: xr.Dataset) -> Finding:
    onset = _least_onset(onsets["onset"].isel(window=-1), times["mu"].values)
    runs = {float(one["spin"]): one for one in (others.isel(spin=k) for k in range(others.sizes["spin"]))}
    runs[times.attrs["spin_rad_per_s"]] = times
    theirs, ours = (
        {each: _scatter(run[f"turning_time{suffix}"]) for each, run in runs.items()}
        for suffix in ("_listing", "")
    )
    off = listed("{:.0f} % at {:g} rad/s", [100 * ours[each] for each in sorted(ours)], sorted(ours))
    staying = [each for each in ours if each < onset]
    return Finding(
        bool(staying) and max(theirs[each] for each in staying) < _LOST,
        bool(staying) and max(ours[each] for each in staying) < _LOST,
        "Taken for the time at which the axis first passes the horizontal, which does not jump. Converged, "
        f"mu t departs from its mean over this range by up to: {off}. From {onset:.0f} rad/s on a launch "
        "leaves the table with some friction of the range and no longer counts (a table that pulls).",
    )


def _least_onset(onset: xr.DataArray, mu: np.ndarray) -> float:
    """The least spin that leaves the table with any of some frictions, between those scanned, rad/s."""
    return float(np.interp(np.log(mu), np.log(onset["mu"].values), onset.values).min())


def _scatter(times: xr.DataArray) -> float:
    """By how much mu t departs from its mean, as a part of it."""
    product = times["mu"] * times
    return float(abs(product / product.mean() - 1.0).max())


class _Fit(NamedTuple):
    """A fit of a power of mu: spin, rad/s, step of mu, s/m, and exponents by both methods."""

    spin: float
    step: float
    exponent: float
    converged: float


_FITTED = 5
"""The fewest values of mu that a fit is made of."""


def _fits(times: xr.Dataset, others: xr.Dataset) -> list[_Fit]:
    """All fits: that of the main spin, and those of others with every value of mu, and with every second."""
    suffixes = ("_listing", "")
    main = (float(times[f"exponent{suffix}"]) for suffix in suffixes)
    fits = [_Fit(float(times.attrs["spin_rad_per_s"]), _step(times["mu"]), *main)]
    for k, spin in enumerate(others["spin"].values):
        for every in (1, 2) if others.sizes["mu"] > 2 * _FITTED - 2 else (1,):
            some = others.isel(spin=k, mu=slice(None, None, every))
            rows = (some[f"flip_time{suffix}"].values for suffix in suffixes)
            fits.append(
                _Fit(float(spin), _step(some["mu"]), *(power_law(some["mu"].values, row)[1] for row in rows))
            )
    return [fit for fit in fits if np.isfinite(fit.exponent)]


def _step(mu: xr.DataArray) -> float:
    return float(mu[1] - mu[0])


@CHAPTER.claim(
    "summary-large-mu",
    Source("3.3", "summary, point 6"),
    "For mu beyond 1 s/m the relation t ~ 1/mu no longer holds.",
    needs=("flip-times-wide",),
    figure="fig07",
)
def _(wide: xr.Dataset) -> Finding:
    product = wide["mu_wide"] * wide["flip_time_wide"]
    law = product.sel(mu_wide=wide["mu_wide"] <= 0.1001).mean("mu_wide")
    off = abs(product / law - 1.0).transpose("spin_wide", "mu_wide")
    beyond = off.sel(mu_wide=wide["mu_wide"] > 1.0)
    first = [float(wide["mu_wide"][int(np.argmax(row > _LOST))]) for row in off.values]
    named = listed("{:.2f} s/m at {:g} rad/s", first, wide["spin_wide"].values, between=" and ")
    return Finding.unlisted(
        bool(float(beyond.max()) > _LOST),
        f"Beyond 1 s/m mu t departs by up to a factor {1 + float(beyond.max()):.1f}. By the report's "
        f"definition it does so earlier, too: it is first off by more than {100 * _LOST:.0f} % at {named}.",
    )


@CHAPTER.claim(
    "fig08-around-pi",
    Source("3.3", "Fig. 8"),
    "At mu = 100 s/m the top nutates around theta = pi (the axis goes round that pole in most nutations).",
    needs=("run-mu-100",),
    figure="fig08",
)
def _(run: xr.Dataset) -> Finding:
    (theirs, _), (ours, last) = (_round_the_pole(run, suffix) for suffix in ("_listing", ""))
    late = run["theta"].sel(time=slice(last, None))
    return Finding(
        theirs > 0.5,
        ours > 0.5,
        "theta is a polar angle and cannot exceed pi; that the top nutates around it means that its axis "
        "goes round the pole, with the precession in the same sense where it is nearest to pi as where it "
        f"is farthest. At 155 rad/s (the spin of Fig. 8 is not given) it does so in {100 * ours:.0f} % of "
        f"the nutations of 20 s after turning over, until {last:.1f} s; from then on the tilt swings below "
        f"pi, between {late.min():.3f} and {late.max():.3f} rad, beside the pole.",
    )


def _nearest_to_pi(run: xr.Dataset, suffix: str) -> tuple[np.ndarray, np.ndarray]:
    """When the tilt is largest in the nutations beyond the horizontal, s, and the precession there, rad/s."""
    times, theta = run[f"time{suffix}"].values, run[f"theta{suffix}"].values
    rising = np.diff(theta) > 0
    peaks = np.flatnonzero(rising[:-1] & ~rising[1:]) + 1
    peaks = peaks[theta[peaks] > np.pi / 2]
    return times[peaks], run[f"phi_dot{suffix}"].values[peaks]


def _round_the_pole(run: xr.Dataset, suffix: str) -> tuple[float, float]:
    """The part of the nutations in which the axis goes round the pole, and when it does so last, s."""
    times, precession = _nearest_to_pi(run, suffix)
    round_it = precession > 0
    return float(round_it.mean()), float(times[round_it][-1])


@CHAPTER.claim(
    "fig08-rapid",
    Source("3.3", "Fig. 8"),
    "At mu = 100 s/m the nutation around pi is rapid (a nutation takes less than a plot of 20 s can show).",
    needs=("run-mu-100",),
    figure="fig08",
)
def _(run: xr.Dataset) -> Finding:
    theirs, ours = (float(np.median(np.diff(_nearest_to_pi(run, suffix)[0]))) for suffix in ("_listing", ""))
    shown = PLOTTED.value * float(run["time"][-1])
    return Finding(
        theirs < shown,
        ours < shown,
        f"A nutation takes {ours:.3f} s, {1 / ours:.0f} a second; a plot of 20 s shows {shown:.2g} s.",
    )


@CHAPTER.claim(
    "fig08-settles",
    Source("3.3", "Fig. 8"),
    "At mu = 100 s/m the top finally stops nutating (swing of the tilt in the last second).",
    "0 rad",
    tolerance=ARRIVED,
    needs=("settling-mu-100",),
    figure="fig08",
)
def _(later: xr.Dataset) -> Finding:
    swing = later["swing"]
    return Finding.unlisted(
        float(swing[-1]),
        f"20 s are too short for it: there the tilt still swings by {swing[0]:.3f} rad. Converged swings in "
        f"the second before: {listed('{:.4f} rad at {:g} s', swing.values, swing['end'].values)}.",
    )


@CHAPTER.claim(
    "fig08-block",
    Source("3.3", "Fig. 8"),
    "At mu = 100 s/m a block started with 1 m/s travels only 0.001 m.",
    "0.001 m",
    needs=("block",),
    figure="fig08",
)
def _(block: xr.Dataset) -> Finding:
    distance = float(block["distance"])
    return Finding.unlisted(distance, f"It comes to rest after {1e3 * distance:.3f} mm.")


def _unit(
    name: str, source: Source, text: str, power: str, quantity: str, units: tuple[str, str], right: str = ""
) -> None:
    """A power of a quantity in a unit; `units` are the right one, as it is told, and the other."""

    @CHAPTER.claim(
        name,
        source,
        f"{text} (the value is the power of {quantity} in it).",
        power,
        tolerance=WHOLE,
        needs=("units",),
        right=right,
    )
    def _(check: xr.Dataset) -> Finding:
        others = {"length": "centimetres", "time": "tenths"}[quantity]
        misses = abs(check[f"theta_in_{others}"] - check["theta"])
        k = int(np.argmin(misses.values))
        found = float(misses[f"power_of_{quantity}"][k])
        return Finding(
            found,
            found,
            f"A launch computed in other units of {quantity} must give the same tilt. Converted as "
            f"{units[0]} it differs by {misses[k]:.1e} rad after 2 s, as {units[1]} by "
            f"{misses[1 - k]:.1e} rad." + (f" {TRANSCRIBED}" if quantity == "time" else ""),
        )


_TABLE_1 = Source("3", "Table 1")
_unit(
    "eq-2.7-mu-unit", Source("2.2", equation="(2.7)"), "mu has the dimension of s/m", "-1", "length",
    ("s/m", "m/s"),
)  # fmt: skip
_unit(
    "table-1-mu-unit", _TABLE_1, "Table 1: the unit of mu is m/s", "1", "length",
    ("s/m, which section 2.2 has right,", "m/s"), "s/m, as in section 2.2",
)  # fmt: skip
_unit(
    "table-1-g-unit", _TABLE_1, "Table 1: the unit of g is m s^2", "2", "time", ("m s^-2", "m s^2"), "m s^-2"
)
