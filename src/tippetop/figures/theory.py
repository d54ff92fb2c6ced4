"""Steady states: where launches end and why, how fast they get there, and which tops turn over."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke
from matplotlib.ticker import FixedLocator, MultipleLocator, NullFormatter, ScalarFormatter

from tippetop.figures.style import (
    ACCENT,
    CONVERGED,
    INK,
    MUTED,
    REPORT,
    WIDTH,
    house_style,
    panel_letter,
    pi_ticks,
)

_LOST = "#C0622B"
_DASHED = (0, (4, 3))
_SYMBOLS = (r"$\omega_{c1}$", r"$\omega_{c2}$")
_ROUNDING = 1e-9


def bifurcation_figure(states: xr.Dataset) -> Figure:
    """Return the steady tilts against the spin, stable and unstable, with the ends of long runs.

    `states` has branch_spin and branch_growth over branch_theta, run_spin, run_tilt and run_end over run, and
    limits, the two critical spins; and the same with suffix _jump for a top that jumps.
    """
    with house_style():
        figure = Figure(figsize=(WIDTH, 3.9))
        panels = figure.subplots(1, 2, sharey=True)
        titles = ("the report's top", f"$I_1/I_3$ = {states.attrs['inertia_ratio_jump']:g}: a fold")
        for axes, suffix, title, letter in zip(panels, ("", "_jump"), titles, "ab", strict=True):
            right = 1.04 * float(states[f"run_spin{suffix}"].max())
            _branches(axes, states, suffix, right)
            _ends_of_runs(axes, states, suffix)
            axes.set_title(title, weight="normal", color=INK, size=10)
            axes.set_xlabel(r"spin at launch $\omega_0$ (rad/s)")
            axes.set_xlim(0, right)
            axes.xaxis.set_major_locator(MultipleLocator(20))
            panel_letter(axes, letter)
        panels[0].set_ylabel(r"final tilt $\theta$ (rad)")
        panels[0].set_ylim(-0.12, np.pi + 0.12)
        pi_ticks(panels[0].yaxis)
        handles, labels = panels[1].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=4, columnspacing=1.4)
    return figure


def _branches(axes: Axes, states: xr.Dataset, suffix: str, right: float) -> None:
    """Draw stable states solid and unstable ones dashed, and mark the critical spins."""
    upright, inverted = (float(limit) for limit in states[f"limits{suffix}"])
    solid: dict[str, Any] = {"color": CONVERGED, "lw": 2.2}
    dashed: dict[str, Any] = {"color": _LOST, "lw": 1.5, "ls": _DASHED}
    axes.plot([0, upright], [0, 0], **solid, label="stable")
    axes.plot([upright, right], [0, 0], **dashed, label="unstable")
    axes.plot([inverted, right], [np.pi, np.pi], **solid)
    axes.plot([0, inverted], [np.pi, np.pi], **dashed)
    spin, tilt = states[f"branch_spin{suffix}"].values, states[f"branch_theta{suffix}"].values
    growing = states[f"branch_growth{suffix}"].values > _ROUNDING
    for which, line in ((~growing, solid), (growing, dashed)):
        axes.plot(np.where(which, spin, np.nan), tilt, **line)
    turning = int(np.nanargmin(spin))
    if 0 < turning < len(spin) - 1 and spin[turning] < min(upright, inverted) - 1.0:
        axes.annotate(
            f"fold, {spin[turning]:.1f}", (spin[turning], tilt[turning]), (-8, 0), va="center", ha="right",
            textcoords="offset points", size=9, color=ACCENT,
        )  # fmt: skip
        axes.plot(spin[turning], tilt[turning], "s", color=ACCENT, ms=5, zorder=5)
    for symbol, limit, height, offset in (
        (_SYMBOLS[0], upright, 0.0, (5, 8)),
        (_SYMBOLS[1], inverted, np.pi, (5, -9)),
    ):
        axes.plot(limit, height, "s", color=ACCENT, ms=5, zorder=5, clip_on=False)
        axes.annotate(
            f"{symbol} = {limit:.2f}", (limit, height), offset, textcoords="offset points", color=ACCENT,
            size=9, va="bottom" if height == 0.0 else "top", zorder=6,
            path_effects=[withStroke(linewidth=2.5, foreground="white")],
        )  # fmt: skip


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
                spin[which], end[which], marker, ms=size, mfc=face, mec=INK, mew=1.1, ls="none", label=name,
                zorder=4, clip_on=False,
            )  # fmt: skip


def growth_figure(critical: xr.Dataset, reported: tuple[float, float]) -> Figure:
    """Return the growth rates of both vertical spins, and the thresholds that a window makes of them.

    `critical` has growth_rate over vertical and growth_spin, critical_launch over vertical, apparent_upright
    and apparent_inverted over visible, and upright_by_margin and inverted_by_margin, read from runs, over
    margin. `reported` are the report's two critical spins, rad/s.
    """
    with house_style():
        figure = Figure(figsize=(WIDTH, 5.4))
        panels = figure.subplot_mosaic([["rate", "rate"], ["upright", "inverted"]], height_ratios=[1.25, 1])
        _growth(panels["rate"], critical, reported)
        names = ("upright", "inverted")
        for name, symbol, theirs, letter in zip(names, _SYMBOLS, reported, "bc", strict=True):
            _apparent(panels[name], critical, name, symbol, theirs)
            panel_letter(panels[name], letter)
        panel_letter(panels["rate"], "a")
    return figure


def _growth(axes: Axes, critical: xr.Dataset, reported: tuple[float, float]) -> None:
    spins = critical["growth_spin"].values
    upright, inverted = (critical["growth_rate"].sel(vertical=name) for name in ("upright", "inverted"))
    limits = critical["critical_launch"].values
    slow = 1.0 / critical.attrs["apparent_window_s"]
    axes.axhspan(-slow, slow, color=MUTED, alpha=0.3, lw=0)
    axes.axhline(0, color=MUTED, lw=0.9)
    axes.plot(spins, upright, color=CONVERGED, lw=2, label="upright spin")
    axes.plot(spins, inverted, color="#109B60", lw=2, label="inverted spin")
    low = min(float(upright.min()), float(inverted.min()))
    axes.set_ylim(1.6 * low, 2.2 * float(upright.max()))
    for symbol, limit, theirs, side in zip(_SYMBOLS, limits, reported, (1, -1), strict=True):
        axes.plot(limit, 0, "s", color=ACCENT, ms=6, zorder=5)
        axes.axvline(theirs, color=REPORT, lw=1.1, ls=_DASHED)
        axes.annotate(
            f"{symbol} = {limit:.2f}", (limit, 0), (9 * side, -11), textcoords="offset points", color=ACCENT,
            size=9, ha="left" if side > 0 else "right", va="top",
            path_effects=[withStroke(linewidth=2.5, foreground="white")],
        )  # fmt: skip
        axes.annotate(
            f"report: {theirs:g}", (theirs, 0.0), (3 if theirs > limit else -3, 4), color=REPORT, size=9,
            xycoords=("data", "axes fraction"), textcoords="offset points",
            ha="left" if theirs > limit else "right",
        )  # fmt: skip
    axes.set(xlabel=r"spin at launch $\omega_0$ (rad/s)", ylabel="growth rate (1/s)")
    axes.set_xlim(spins[0], spins[-1])
    axes.legend(loc="upper left", bbox_to_anchor=(0.24, 1.0))


def _apparent(axes: Axes, critical: xr.Dataset, name: str, symbol: str, theirs: float) -> None:
    """Draw an apparent threshold against what can be seen, with runs and the report's value."""
    limit = float(critical["critical_launch"].sel(vertical=name))
    visible, seen = critical["visible"].values, critical[f"apparent_{name}"].values
    axes.axhline(limit, color=ACCENT, lw=1.2)
    axes.axhline(theirs, color=REPORT, lw=1.2, ls=_DASHED)
    axes.plot(visible, seen, color=CONVERGED, lw=2, label="growth rates")
    inside = (critical["margin"] >= visible[0] * 0.99) & (critical["margin"] <= visible[-1] * 1.01)
    runs = critical[f"{name}_by_margin"].where(inside)
    axes.plot(critical["margin"], runs, "o", ms=6, mfc="white", mec=INK, label="runs of 20 s")
    axes.set_xscale("log")
    axes.set_xlim(visible[0] / 1.25, visible[-1] * 1.25)
    axes.xaxis.set_major_locator(FixedLocator(list(visible)))
    axes.xaxis.set_major_formatter(ScalarFormatter())
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.set_xlabel("least tilt told from none (rad)")
    axes.set_title(f"{symbol} (rad/s) seen in {critical.attrs['apparent_window_s']:g} s", weight="normal")
    values = [limit, theirs, *seen, *runs.values[np.isfinite(runs.values)]]
    room = 0.16 * (max(values) - min(values))
    axes.set_ylim(min(values) - room, max(values) + room)
    for text, value, color in (("true", limit, ACCENT), (f"report: {theirs:g}", theirs, REPORT)):
        at_left = name == "upright"
        axes.annotate(
            f"{text} {limit:.2f}" if text == "true" else text, (0.0 if at_left else 1.0, value),
            (4 if at_left else -4, 3), xycoords=("axes fraction", "data"), textcoords="offset points",
            ha="left" if at_left else "right", va="bottom", color=color, size=9,
        )  # fmt: skip
    if name == "upright":
        axes.legend(loc="lower right")


_REGIONS = {"I": "#E8ECF0", "IIa": "#D5E8F8", "IIb": "#F9E3C4", "III": "#F3DCE6"}


def groups_figure(chart: xr.Dataset) -> Figure:
    """Return the map of the eccentric spheres by inertia ratio and eccentricity, with some tops on it.

    `chart` has upright_boundary, inverted_boundary, jump_boundary, equal_thresholds, no_precession_from and
    no_precession_to over alpha, and top_gamma and top_alpha over top.
    """
    with house_style():
        figure = Figure(figsize=(WIDTH, 4.9))
        axes = figure.subplots()
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
        axes.plot(chart["equal_thresholds"], alpha, color=MUTED, lw=1.2, ls=_DASHED)
        _name_regions(axes)
        _tops(axes, chart)
        axes.set(xlabel=r"inertia ratio $\gamma = I_1/I_3$", ylabel=r"eccentricity $\alpha$")
        axes.set_xlim(left, right)
        axes.set_ylim(0, float(alpha[-1]))
        axes.grid(visible=False)
    return figure


def _no_precession(axes: Axes, chart: xr.Dataset) -> None:
    """Hatch where no tilted precession is stable, and say so."""
    low, high = chart["no_precession_from"], chart["no_precession_to"]
    exists = np.isfinite(low)
    axes.fill_betweenx(
        chart["alpha"][exists], low[exists], high[exists], facecolor="none", edgecolor=MUTED, hatch="////",
        lw=0.6,
    )  # fmt: skip
    middle = 0.5 * float(low[0] + high[0])
    axes.annotate(
        "no tilted\nprecession is stable", (middle, 0.03), (0.63, 0.085), color=INK, size=9, ha="center",
        arrowprops={"arrowstyle": "-", "color": INK, "lw": 0.8},
    )  # fmt: skip


def _name_regions(axes: Axes) -> None:
    for text, at, turn in (
        ("never inverts:\nupright stays stable", (0.63, 0.195), 0),
        ("inverts completely,\ngradually", (1.0, 0.47), 0),
        ("inverts with a jump:\ntwo states coexist", (0.712, 0.385), -49.5),
        ("stops part-way:\ninverted never stable", (1.42, 0.16), 0),
    ):
        axes.annotate(
            text, at, ha="center", va="center", rotation=turn, size=10 if turn == 0 else 8.5, color=INK,
            linespacing=1.3, rotation_mode="anchor",
        )  # fmt: skip
    for text, at, turn in (
        (r"$\gamma = 1 - \alpha$", (0.66, 0.308), -51.5),
        (r"$\gamma = 1 + \alpha$", (1.222, 0.255), 51.5),
    ):
        axes.annotate(text, at, ha="center", va="center", rotation=turn, size=9, color=INK)


def _tops(axes: Axes, chart: xr.Dataset) -> None:
    """Mark the tops, the report's as its two versions."""
    places = ((-10, 13, "center"), (10, 13, "center"), (-9, 0, "right"))
    colors = (CONVERGED, REPORT, ACCENT)
    for k, (dx, dy, side) in enumerate(places):
        at = (float(chart["top_gamma"][k]), float(chart["top_alpha"][k]))
        axes.plot(*at, "o", color=colors[k], ms=8, mec="white", mew=1.0, zorder=5)
        axes.annotate(
            _label(str(chart["top"].values[k])), at, (dx, dy), textcoords="offset points", size=9, ha=side,
            va="center", color=colors[k], path_effects=[withStroke(linewidth=2.5, foreground="white")],
        )  # fmt: skip


def _label(name: str) -> str:
    """A long name on two lines."""
    first, _, rest = name.partition(" and ")
    return f"{first} and\n{rest}" if rest else name
