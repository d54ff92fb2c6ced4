"""Figures of many launches: final tilts and flip times (the report's Figs. 6, 7), and window
effects.
"""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

import tippetop.figures.annotation as mark
from tippetop.figures.style import ACCENT, CONVERGED, DASHED, FAINT, INK, MUTED, REPORT, UNILATERAL


@mark.drawn(4.3)
def final_tilt_figure(axes: Axes, sweep: xr.Dataset, reported: tuple[float, float, float]) -> None:
    """Draw the final tilt against the spin at launch, with the critical spins.

    `reported` are the report's two critical spins and the spin of its abnormal point, rad/s.
    """
    longest = sweep.isel(window=-1)
    ours = (float(longest["upright_by_window"]), float(longest["inverted_by_window"]))
    onset = float(sweep["lift_off_onset"])
    right = 1.01 * float(sweep["spin"][-1])
    axes.axvspan(onset, right, color=ACCENT, alpha=0.07, lw=0)
    below = sweep.sel(spin=sweep["spin"] <= onset)
    above = sweep.sel(spin=sweep["spin"] > onset)
    axes.plot(below["spin"], below["final_tilt"], color=CONVERGED, lw=1.8, label="converged")
    axes.plot(
        above["spin"], above["final_tilt"], ".", color=MUTED, ms=3, label="converged, table pulls"
    )
    flying = sweep.sel(spin_flight=sweep["spin_flight"] > onset)
    axes.plot(
        flying["spin_flight"],
        flying["final_tilt_flight"],
        "-D",
        color=UNILATERAL,
        ms=3.5,
        lw=1.4,
        zorder=5,
        label="table only pushes",
    )
    axes.plot(
        sweep["spin_listing"],
        sweep["final_tilt_listing"],
        "o",
        color=REPORT,
        label="report's method",
        ms=5,
        mec="white",
        mew=0.5,
        zorder=4,
    )
    _critical(axes, (*reported[:2], *ours), 1.1)
    for name, theirs, spin in zip(mark.CRITICAL, reported, ours, strict=False):
        mark.note(axes, f"{name} = {spin:.1f}", (spin, np.pi + 0.56), (5, 0), CONVERGED, va="top")
        mark.note(axes, f"report: {theirs:g}", (spin, np.pi + 0.36), (5, 0), REPORT, va="top")
    _abnormal(axes, reported[2], onset)
    axes.set(xlabel=mark.SPIN, xlim=(0, right))
    mark.tilt_axis(axes, -0.08, np.pi + 0.62, r"tilt after 20 s, $\theta_{\mathrm{end}}$ (rad)")
    mark.legend_above(axes, 4)
    for box, around, tilts in (
        ((0.455, 0.11, 0.13, 0.4), (23.5, 30.5), (-0.006, 0.06)),
        ((0.635, 0.11, 0.125, 0.4), (76.0, 80.5), (np.pi - 0.06, np.pi + 0.006)),
    ):
        panel = mark.inset(axes, box)
        _critical(panel, (*reported[:2], *ours), 1.0)
        panel.plot(sweep["spin"], sweep["final_tilt"], ".-", color=CONVERGED, lw=1.2, ms=3)
        dots: dict[str, Any] = {"color": REPORT, "ms": 4, "mec": "white", "mew": 0.4}
        panel.plot(sweep["spin_listing"], sweep["final_tilt_listing"], "o", **dots)
        panel.set(xlim=around, ylim=tilts)
        panel.locator_params(nbins=4)
        mark.source(axes, panel)


def _critical(axes: Axes, spins: tuple[float, ...], width: float) -> None:
    """Draw the critical spins: the report's two, then the converged ones."""
    for spin, color in zip(spins, (REPORT, REPORT, CONVERGED, CONVERGED), strict=True):
        axes.axvline(spin, color=color, lw=width, ls=DASHED)


def _abnormal(axes: Axes, theirs: float, onset: float) -> None:
    axes.axvline(onset, color=ACCENT, lw=1.0)
    axes.axvline(theirs, color=REPORT, lw=1.1, ls=DASHED)
    for text, color, height in (
        (f"lift-off from {onset:.1f}", ACCENT, 0.56),
        (rf"report: $\omega_a$ = {theirs:g}", REPORT, 0.36),
    ):
        mark.note(axes, text, (onset, np.pi + height), (-4, 0), color, va="top")


@mark.drawn(3.9, 1, 2)
def flip_time_figure(left: Axes, right: Axes, times: xr.Dataset, reported: float) -> None:
    """Draw flip times against friction: the report's range with fits, and three decades.

    `reported` is the power of mu that the report prints; its line goes through the middle of the
    points of the report's method.
    """
    mu = times["mu"].values
    fine = np.linspace(mu[0], mu[-1], 200)
    series = (("_listing", REPORT, "o", "report's method"), ("", CONVERGED, ".", "converged"))
    for suffix, color, marker, name in series:
        a, b = float(times[f"factor{suffix}"]), float(times[f"exponent{suffix}"])
        r = float(times[f"correlation{suffix}"])
        left.plot(fine, a * fine**b, color=color, lw=1.2)
        label = f"{name}\n$t = {a:.2f}\\,\\mu^{{{b:.3f}}}$,  $r = {r:.4f}$"
        size = 6 if marker == "o" else 7
        left.plot(mu, times[f"flip_time{suffix}"], marker, color=color, ms=size, label=label)
    middle = np.exp(np.nanmean(np.log(times["flip_time_listing"] * mu**-reported)))
    label = rf"the report: $\mu^{{{reported:g}}}$"
    left.plot(fine, float(middle) * fine**reported, color=INK, lw=1.0, ls=DASHED, label=label)
    left.legend(loc="upper right", labelspacing=0.9)
    high = 1.15 * float(times["flip_time_listing"].max())
    left.set(xlabel=mark.FRICTION, ylabel="flip time (s)", ylim=(0, high))
    left.set_title(f"{times.attrs['spin_rad_per_s']:g} rad/s", size=10)
    _products(right, times)


def _products(axes: Axes, wide: xr.Dataset) -> None:
    """Draw mu times the flip time, which is constant where the law t ~ 1/mu holds."""
    axes.axvspan(0.2, 1.0, color=REPORT, alpha=0.10, lw=0)
    mark.note(
        axes, "the report's\nrange", (0.447, 1.0), (0, -4), REPORT, size=8.5, xycoords=mark.ALONG_X
    )
    colors = (CONVERGED, UNILATERAL)
    for spin, color in zip(wide["spin_wide"].values, colors, strict=False):
        product = wide["mu_wide"] * wide["flip_time_wide"].sel(spin_wide=spin)
        axes.plot(
            wide["mu_wide"], product, "-o", color=color, ms=3, lw=1.2, label=f"{spin:g} rad/s"
        )
    axes.set(
        xscale="log", yscale="log", xlabel=mark.FRICTION, ylabel=r"$\mu\,\times$ flip time (s²/m)"
    )
    mark.plain_ticks(axes.xaxis, [0.01, 0.1, 1, 10])
    mark.plain_ticks(axes.yaxis, [1, 2, 5, 10, 20, 50, 100])
    axes.legend(loc="upper left", bbox_to_anchor=(0.0, 0.88))
    axes.set_title("converged", size=10)


@mark.drawn(3.3, 1, 2, lettered=False)
def windows_figure(
    left: Axes, right: Axes, sweep: xr.Dataset, reported: tuple[float, float]
) -> None:
    """Draw the two critical spins against the length of the runs that they are read from.

    `reported` are the report's two critical spins, rad/s.
    """
    names = ("upright", "inverted")
    for axes, name, symbol, theirs in zip(
        (left, right), names, mark.CRITICAL, reported, strict=True
    ):
        window = sweep["window"].values
        span = sweep[f"{name}_by_margin"]
        axes.axhline(theirs, color=REPORT, lw=1.2, ls=DASHED)
        axes.plot(
            [window[0]] * 2, [float(span.min()), float(span.max())], color=FAINT, lw=7, zorder=1
        )
        axes.plot(window, sweep[f"{name}_by_window"], "-o", color=CONVERGED)
        place: dict[str, Any] = {"xycoords": mark.ALONG_Y, "ha": "right"}
        mark.note(axes, f"report: {theirs:g}", (1.0, theirs), (0, 3), REPORT, **place)
        last = float(sweep[f"{name}_by_window"][-1])
        mark.note(
            axes, f"{last:.2f}", (window[-1], last), (0, -8 if name == "inverted" else 7), CONVERGED
        )
        axes.set_xscale("log")
        axes.set_xlim(0.8 * window[0], 1.5 * window[-1])
        mark.plain_ticks(axes.xaxis, list(window))
        axes.set_xlabel("length of the runs (s)")
        axes.set_title(f"{symbol} (rad/s)", weight="normal", color=INK)
        low, high = axes.get_ylim()
        axes.set_ylim(low - 0.06 * (high - low), high + 0.06 * (high - low))
