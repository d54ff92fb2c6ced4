"""Figures of launches that leave the table: the onset of lift-off, and the flights after it."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.ticker import LogLocator, MaxNLocator

import tippetop.figures.annotation as mark
from tippetop.figures.envelope import band
from tippetop.figures.style import ACCENT, CYCLE, DASHED, FAINT, INK, MUTED, REPORT, UNILATERAL


def continue_unilateral(
    axes: Axes, run: xr.Dataset, name: str, scale: float = 1.0, *, as_band: bool = False
) -> None:
    """Draw a variable after lift-off on a table that only pushes.

    `run` has the variable with the suffix `_flight` over time, and `lift_off_time`. With `as_band`,
    oscillations are drawn as a band, for an axis on which they are too fast to be seen.
    """
    after = scale * run[f"{name}_flight"].sel(time=slice(float(run["lift_off_time"]), None))
    if as_band:
        band(axes, after["time"], after, UNILATERAL, 1.1, "table only pushes")
    else:
        axes.plot(
            after["time"], after, color=UNILATERAL, lw=1.1, zorder=4, label="table only pushes"
        )


@mark.drawn(3.9)
def onset_figure(axes: Axes, sweep: xr.Dataset, over: str, reported: float) -> None:
    """Draw the least spin that leaves the table against "mu" or "tilt", with the launches scanned.

    `reported` is the spin of the report's abnormal point, rad/s.
    """
    values, spins = np.meshgrid(sweep[over].values, sweep["spin"].values, indexing="ij")
    times = sweep["liftoff_time"].values
    stays = ~np.isfinite(times)
    axes.plot(values[stays], spins[stays], "o", color=FAINT, ms=3.5, mec=MUTED, mew=0.5, zorder=2)
    dots = axes.scatter(
        values[~stays],
        spins[~stays],
        c=times[~stays],
        s=22,
        norm=LogNorm(),
        zorder=2,
        edgecolors="none",
    )
    bar = axes.figure.colorbar(dots, ax=axes, label="first lift-off (s)", pad=0.02)
    first, last = np.nanmin(times), np.nanmax(times)
    locator = (
        LogLocator(subs=(1, 2, 5)) if last > 5 * first else MaxNLocator(4, steps=[1, 2, 5, 10])
    )
    ticks = locator.tick_values(first, last)
    mark.plain_ticks(bar.ax.yaxis, ticks[(first <= ticks) & (ticks <= last)])
    for k, (window, style) in enumerate(
        zip(sweep["window"].values, ("-", (0, (4, 2))), strict=False)
    ):
        axes.plot(
            sweep[over],
            sweep["onset"].sel(window=window),
            color=ACCENT,
            ls=style,
            lw=1.8,
            zorder=4 - k,
            label=f"onset within {window:g} s",
        )
    name = rf"report: $\omega_a$ = {reported:g}"
    axes.axhline(reported, color=REPORT, lw=1.1, ls=DASHED, label=name)
    reported_at = 0.3 if over == "mu" else 0.1
    axes.plot(reported_at, reported, "s", color=REPORT, ms=6, mec=INK, mew=0.6, zorder=5)
    axes.set(ylabel=mark.SPIN, ylim=(40, 1.03 * float(sweep["spin"][-1])))
    if over == "mu":
        axes.set(xscale="log", xlabel=mark.FRICTION)
        mark.plain_ticks(axes.xaxis, [0.03, 0.1, 0.3, 1, 3, 10])
    else:
        axes.set_xlabel(r"tilt at launch $\theta_0$ (rad)")
    mark.legend_above(axes, 3)


@mark.drawn(5.2, 2, 2, sharex=True)
def flights_figure(panels: Any, sweep: xr.Dataset) -> None:
    """Draw airborne time, turning over, number of flights and final tilt against the spin."""
    share, turning, count, tilt = panels.flat
    for restitution, color, marker in zip(
        sweep["restitution"].values, (UNILATERAL, CYCLE[5]), ("o", "s"), strict=False
    ):
        runs = sweep.sel(restitution=restitution).dropna("spin", subset=["airborne_time"])
        spins, air = runs["spin"], runs["airborne_time"]
        hollow = {"color": color, "marker": marker, "ms": 4}
        between = runs["last_touchdown"] - runs["liftoff_time"]
        share.plot(spins, 100 * air / between, ls=(0, (4, 2)), mfc="white", **hollow)
        share.plot(spins, 100 * air / runs["last_touchdown"].where(runs["flights"] > 0), **hollow)
        turning.plot(spins, runs["turning_time"], label=f"restitution {restitution:g}", **hollow)
        flying = runs.sel(spin=runs["flights"] > 0)
        count.plot(flying["spin"], flying["flights"], **hollow)
        tilt.plot(spins, runs["final_tilt_flight"], **hollow)
    _label_shares(share, sweep)
    share.set(ylabel="airborne share (%)", ylim=(0, 100))
    turning.set(ylabel=r"$\theta$ first passes π/2 (s)", ylim=(0, None))
    turning.legend(loc="upper left")
    count.set(ylabel="number of flights", yscale="log")
    mark.tilt_axis(tilt, -0.1, np.pi + 0.25, "tilt after 60 s (rad)")
    for axes in panels[1]:
        axes.set_xlabel(mark.SPIN)


def _label_shares(axes: Axes, sweep: xr.Dataset) -> None:
    """Label each curve of the airborne share at its last point."""
    last = sweep.isel(restitution=0).dropna("spin", subset=["airborne_time"]).isel(spin=-1)
    air, end = float(last["airborne_time"]), float(last["last_touchdown"])
    for text, share, offset in (
        ("from first lift-off\nto last touchdown", air / (end - float(last["liftoff_time"])), 14),
        ("from launch\nto last touchdown", air / end, -32),
    ):
        at = (float(last["spin"]), 100 * share)
        mark.note(axes, text, at, (0, offset), UNILATERAL, ha="right", va="center", size=8.5)
