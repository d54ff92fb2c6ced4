"""Figures of steady states: stability against spin, growth rates, and which tops turn over."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MultipleLocator

import tippetop.figures.annotation as mark
from tippetop.figures.style import (
    ACCENT,
    CONVERGED,
    DASHED,
    INK,
    MUTED,
    REPORT,
    UNILATERAL,
    WIDTH,
    house_style,
)

_UNSTABLE = "#C0622B"
_ROUNDING = 1e-9
"""Growth rate up to which a state counts as stable, 1/s: rounding of the zero eigenvalues."""


@mark.drawn(3.9, 1, 2, sharey=True)
def bifurcation_figure(first: Axes, second: Axes, states: xr.Dataset) -> None:
    """Draw stable and unstable steady tilts against spin for two tops, with the ends of long
    runs.
    """
    titles = ("the report's top", f"$I_1/I_3$ = {states.attrs['inertia_ratio_jump']:g}: a fold")
    for axes, suffix, title in zip((first, second), ("", "_jump"), titles, strict=True):
        right = 1.04 * float(states[f"run_spin{suffix}"].max())
        _branches(axes, states, suffix, right)
        _ends_of_runs(axes, states, suffix)
        axes.set_title(title, weight="normal", color=INK, size=10)
        axes.set(xlabel=mark.SPIN, xlim=(0, right))
        axes.xaxis.set_major_locator(MultipleLocator(20))
    mark.tilt_axis(first, -0.12, np.pi + 0.12, r"final tilt $\theta$ (rad)")
    handles, labels = second.get_legend_handles_labels()
    first.figure.legend(handles, labels, loc="outside lower center", ncols=4, columnspacing=1.4)


def _branches(axes: Axes, states: xr.Dataset, suffix: str, right: float) -> None:
    """Draw stable states solid and unstable ones dashed, and mark the critical spins."""
    upright, inverted = (float(limit) for limit in states[f"limits{suffix}"])
    solid: dict[str, Any] = {"color": CONVERGED, "lw": 2.2}
    dashed: dict[str, Any] = {"color": _UNSTABLE, "lw": 1.5, "ls": DASHED}
    axes.plot([0, upright], [0, 0], **solid, label="stable")
    axes.plot([upright, right], [0, 0], **dashed, label="unstable")
    axes.plot([inverted, right], [np.pi, np.pi], **solid)
    axes.plot([0, inverted], [np.pi, np.pi], **dashed)
    spin, tilt = states[f"branch_spin{suffix}"].values, states[f"branch_tilt{suffix}"].values
    growing = states[f"branch_growth{suffix}"].values > _ROUNDING
    for which, line in ((~growing, solid), (growing, dashed)):
        axes.plot(np.where(which, spin, np.nan), tilt, **line)
    turning = int(np.nanargmin(spin))
    if 0 < turning < len(spin) - 1 and spin[turning] < min(upright, inverted) - 1.0:
        mark.note(
            axes, f"fold, {spin[turning]:.1f}", (spin[turning], tilt[turning]), (-8, 0), ACCENT
        )
        axes.plot(spin[turning], tilt[turning], "s", color=ACCENT, ms=5, zorder=5)
    for symbol, limit, height, offset in (
        (mark.CRITICAL[0], upright, 0.0, (5, 8)),
        (mark.CRITICAL[1], inverted, np.pi, (5, -9)),
    ):
        axes.plot(limit, height, "s", color=ACCENT, ms=5, zorder=5, clip_on=False)
        mark.note(
            axes, f"{symbol} = {limit:.2f}", (limit, height), offset, ACCENT, zorder=6, halo=True
        )


def _ends_of_runs(axes: Axes, states: xr.Dataset, suffix: str) -> None:
    """Mark where runs launched near the two verticals end."""
    spin, tilt, end = (states[f"run_{name}{suffix}"].values for name in ("spin", "tilt", "end"))
    low = tilt < np.pi / 2
    for which, marker, size, face, name in (
        (~low, "D", 8.5, "none", "run from near $\\pi$"),
        (low, "o", 5, "white", "run from 0.1 rad"),
    ):
        if which.any():
            axes.plot(
                spin[which],
                end[which],
                marker,
                ms=size,
                mfc=face,
                mec=INK,
                mew=1.1,
                ls="none",
                label=name,
                zorder=4,
                clip_on=False,
            )


@house_style()
def growth_figure(critical: xr.Dataset, reported: tuple[float, float]) -> Figure:
    """Draw the growth rates of both vertical spins, and the thresholds seen in runs of finite
    length.

    `reported` are the report's two critical spins, rad/s.
    """
    figure = Figure(figsize=(WIDTH, 5.4))
    panels = figure.subplot_mosaic(
        [["rate", "rate"], ["upright", "inverted"]], height_ratios=[1.25, 1]
    )
    _growth(panels["rate"], critical, reported)
    names = ("upright", "inverted")
    for name, symbol, theirs in zip(names, mark.CRITICAL, reported, strict=True):
        _apparent(panels[name], critical, name, symbol, theirs)
    mark.letters(panels[name] for name in ("rate", *names))
    return figure


def _growth(axes: Axes, critical: xr.Dataset, reported: tuple[float, float]) -> None:
    spins = critical["growth_spin"].values
    upright, inverted = (
        critical["growth_rate"].sel(vertical=name) for name in ("upright", "inverted")
    )
    limits = critical["critical_launch"].values
    slow = 1.0 / critical.attrs["apparent_window_s"]
    axes.axhspan(-slow, slow, color=MUTED, alpha=0.3, lw=0)
    axes.axhline(0, color=MUTED, lw=0.9)
    axes.plot(spins, upright, color=CONVERGED, lw=2, label="upright spin")
    axes.plot(spins, inverted, color=UNILATERAL, lw=2, label="inverted spin")
    low = min(float(upright.min()), float(inverted.min()))
    axes.set_ylim(1.6 * low, 2.2 * float(upright.max()))
    for symbol, limit, theirs, side in zip(mark.CRITICAL, limits, reported, (1, -1), strict=True):
        axes.plot(limit, 0, "s", color=ACCENT, ms=6, zorder=5)
        axes.axvline(theirs, color=REPORT, lw=1.1, ls=DASHED)
        mark.note(axes, f"{symbol} = {limit:.2f}", (limit, 0), (9 * side, -11), ACCENT, halo=True)
        aside = (3 if theirs > limit else -3, 4)
        mark.note(axes, f"report: {theirs:g}", (theirs, 0.0), aside, REPORT, xycoords=mark.ALONG_X)
    axes.set(xlabel=mark.SPIN, ylabel="growth rate (1/s)", xlim=(spins[0], spins[-1]))
    axes.legend(loc="upper left", bbox_to_anchor=(0.24, 1.0))


def _apparent(axes: Axes, critical: xr.Dataset, name: str, symbol: str, theirs: float) -> None:
    """Draw an apparent threshold against the least visible tilt, with runs and the report's
    value.
    """
    limit = float(critical["critical_launch"].sel(vertical=name))
    visible, seen = critical["visible"].values, critical[f"apparent_{name}"].values
    axes.axhline(limit, color=ACCENT, lw=1.2)
    axes.axhline(theirs, color=REPORT, lw=1.2, ls=DASHED)
    axes.plot(visible, seen, color=CONVERGED, lw=2, label="growth rates")
    inside = (critical["margin"] >= visible[0] * 0.99) & (critical["margin"] <= visible[-1] * 1.01)
    runs = critical[f"{name}_by_margin"].where(inside)
    axes.plot(critical["margin"], runs, "o", ms=6, mfc="white", mec=INK, label="runs of 20 s")
    axes.set_xscale("log")
    axes.set_xlim(visible[0] / 1.25, visible[-1] * 1.25)
    mark.plain_ticks(axes.xaxis, list(visible))
    axes.set_xlabel("least visible tilt (rad)")
    axes.set_title(
        f"{symbol} (rad/s) seen in {critical.attrs['apparent_window_s']:g} s", weight="normal"
    )
    values = [limit, theirs, *seen, *runs.values[np.isfinite(runs.values)]]
    room = 0.16 * (max(values) - min(values))
    axes.set_ylim(min(values) - room, max(values) + room)
    edge = 0.0 if name == "upright" else 1.0
    for text, value, color in (
        (f"true {limit:.2f}", limit, ACCENT),
        (f"report: {theirs:g}", theirs, REPORT),
    ):
        mark.note(axes, text, (edge, value), (4 - 8 * edge, 3), color, xycoords=mark.ALONG_Y)
    if name == "upright":
        axes.legend(loc="lower right")


_REGIONS = {"I": "#E8ECF0", "IIa": "#D5E8F8", "IIb": "#F9E3C4", "III": "#F3DCE6"}


@mark.drawn(4.9)
def groups_figure(axes: Axes, chart: xr.Dataset) -> None:
    """Draw the groups of eccentric spheres by inertia ratio and eccentricity, with some tops."""
    alpha = chart["alpha"].values
    left, right = chart.attrs["gamma_least"], chart.attrs["gamma_greatest"]
    first, jump, last = (
        np.clip(chart[name].values, left, right)
        for name in ("upright_boundary", "jump_boundary", "inverted_boundary")
    )
    for low, high, region in (
        (np.full_like(alpha, left), first, "I"),
        (first, jump, "IIb"),
        (jump, last, "IIa"),
        (last, np.full_like(alpha, right), "III"),
    ):
        axes.fill_betweenx(alpha, low, high, color=_REGIONS[region], lw=0)
    for line in (first, jump, last):
        inside = (line > left) & (line < right)
        axes.plot(line[inside], alpha[inside], color=INK, lw=1.1)
    _no_precession(axes, chart)
    axes.plot(chart["equal_thresholds"], alpha, color=MUTED, lw=1.2, ls=DASHED)
    _name_regions(axes)
    _tops(axes, chart)
    axes.set(xlabel=r"inertia ratio $\gamma = I_1/I_3$", ylabel=r"eccentricity $\alpha$")
    axes.set(xlim=(left, right), ylim=(0, float(alpha[-1])))
    axes.grid(visible=False)


def _no_precession(axes: Axes, chart: xr.Dataset) -> None:
    """Hatch and label the region in which no tilted precession is stable."""
    low, high = chart["no_precession_from"], chart["no_precession_to"]
    exists = np.isfinite(low)
    axes.fill_betweenx(
        chart["alpha"][exists],
        low[exists],
        high[exists],
        facecolor="none",
        edgecolor=MUTED,
        hatch="////",
        lw=0.6,
    )
    middle = 0.5 * float(low[0] + high[0])
    axes.annotate(
        "no tilted\nprecession is stable",
        (middle, 0.03),
        (0.63, 0.085),
        color=INK,
        size=9,
        ha="center",
        arrowprops={**mark.LEADER, "color": INK},
    )


def _name_regions(axes: Axes) -> None:
    for text, at, turn, size in (
        ("never inverts:\nupright stays stable", (0.63, 0.195), 0, 10),
        ("inverts completely,\ngradually", (1.0, 0.47), 0, 10),
        ("inverts with a jump:\ntwo states coexist", (0.712, 0.385), -49.5, 8.5),
        ("stops part-way:\ninverted never stable", (1.42, 0.16), 0, 10),
        (r"$\gamma = 1 - \alpha$", (0.66, 0.308), -51.5, 9),
        (r"$\gamma = 1 + \alpha$", (1.222, 0.255), 51.5, 9),
    ):
        turned: dict[str, Any] = {"rotation": turn, "rotation_mode": "anchor", "linespacing": 1.3}
        mark.note(axes, text, at, (0, 0), INK, size=size, **turned)


def _tops(axes: Axes, chart: xr.Dataset) -> None:
    """Mark the tops; the report's top is marked in its two versions."""
    places = (((-10, 13), "center"), ((10, 13), "center"), ((-9, 0), "right"))
    colors = (CONVERGED, REPORT, ACCENT)
    for k, (offset, side) in enumerate(places):
        at = (float(chart["top_gamma"][k]), float(chart["top_alpha"][k]))
        axes.plot(*at, "o", color=colors[k], ms=8, mec="white", mew=1.0, zorder=5)
        label = str(chart["top"].values[k]).replace(" and ", " and\n")
        mark.note(axes, label, at, offset, colors[k], ha=side, va="center", halo=True)
