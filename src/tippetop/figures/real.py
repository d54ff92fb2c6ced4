"""Figures of real tops: a stem that strikes, stems stood upon, an egg, a disk and two balls."""

import numpy as np
import xarray as xr
from matplotlib import colormaps
from matplotlib.axes import Axes

import tippetop.figures.annotation as mark
from tippetop.figures.style import ACCENT, CONVERGED, CYCLE, DASHED, INK, MUTED


@mark.drawn(4.2)
def leine_figure(axes: Axes, data: xr.Dataset) -> None:
    """Draw the tilt of Leine and Glocker's top, with the times at which its stem touches and
    leaves.
    """
    for tilt, color in zip(data["tilt"], (CONVERGED, MUTED), strict=False):
        axes.plot(data["time"], tilt, color=color, label=str(tilt["pressure"].values))
    main = data.isel(pressure=0)
    axes.axvspan(float(main["both"]), float(main["apart"]), color=ACCENT, alpha=0.15, lw=0)
    for name, text, side in (("stem", "stem touches", 4), ("back", "back on its sphere", -4)):
        time = float(main[name])
        axes.axvline(time, color=ACCENT, ls=DASHED, lw=1.0)
        mark.note(axes, text, (time, 0.06), (side, 0), ACCENT, xycoords=mark.ALONG_X)
    mark.note(axes, "on both", (float(main["apart"]), 0.06), (4, 0), ACCENT, xycoords=mark.ALONG_X)
    axes.set(xlabel="time (s)", xlim=(0, float(data["time"][-1])))
    mark.tilt_axis(axes, 0)
    mark.legend_above(axes, 2)


@mark.drawn(5.4, 2, 1)
def stepping_figure(above: Axes, below: Axes, data: xr.Dataset) -> None:
    """Draw the tilt in the rocking by time-stepping, and the errors of event times against the
    step.
    """
    for step, tilt, color in zip(data["step"], data["tilt"], CYCLE, strict=False):
        above.plot(data["time"], tilt, color=color, lw=1.2, label=f"{1e3 * float(step):g} ms")
    above.plot(data["time"], data["exact_tilt"], color=INK, ls=DASHED, lw=1.4, label="exact")
    span = (float(data["time"][0]), float(data["time"][-1]))
    above.set(xlim=span, xlabel="time (s)", ylabel=mark.TILT)
    mark.legend_above(above, 6)
    words = {
        "stem": "stem touches",
        "back": "back on its sphere",
        "both": "on both",
        "apart": "apart",
    }
    steps = 1e3 * data["step"].values
    for (name, text), color in zip(words.items(), CYCLE, strict=False):
        off = np.abs(data[name].values - float(data[f"exact_{name}"]))
        below.loglog(steps, off, "o-", color=color, label=text)
    mark.plain_ticks(below.xaxis, steps)
    below.set(xlabel="step (ms)", ylabel="off by (s)")
    mark.legend_above(below, 4)


@mark.drawn(4.8, 2, 1, sharex=True)
def stems_figure(above: Axes, below: Axes, data: xr.Dataset) -> None:
    """Draw final tilt and Jellett's integral, over the value needed to stand, against the tip's
    radius.
    """
    radius = 1e3 * data["radius"].values
    above.plot(radius, data["final_tilt"], "o-", color=CONVERGED)
    above.set_ylabel(r"tilt at the end (rad)")
    below.plot(radius, data["jellett"] / data["jellett_needed"], "o-", color=CONVERGED)
    below.axhline(1.0, color=ACCENT, ls=DASHED, lw=1.2)
    mark.note(below, "stands above", (radius[0], 1.0), (4, 6), ACCENT)
    below.set(xlabel="radius of the stem's tip (mm)", ylabel="Jellett's integral / needed")


@mark.drawn(4.0)
def egg_figure(axes: Axes, data: xr.Dataset) -> None:
    """Draw the tilt of eggs spun on their sides, with their first lift-offs."""
    colors = colormaps["viridis"](np.linspace(0.0, 0.9, data.sizes["rate"]))
    for rate, tilt, lift, color in zip(
        data["rate"], data["tilt"], data["liftoff"], colors, strict=True
    ):
        axes.plot(data["time"], tilt, color=color, lw=1.2, label=f"{float(rate):g} rad/s")
        if np.isfinite(lift):
            at = (float(lift), float(np.interp(lift, data["time"], tilt)))
            axes.plot(*at, "o", mfc="white", mec=INK, zorder=5)
    axes.set(xlabel="time (s)", xlim=(0, float(data["time"][-1])))
    mark.tilt_axis(axes, np.pi / 2 - 0.2)
    mark.legend_above(axes, 4)


@mark.drawn(3.8, 1, 2)
def rolling_figure(left: Axes, right: Axes, data: xr.Dataset) -> None:
    """Draw precession against tilt of a disk and two balls that roll with their centres at rest."""
    for axes, name in ((left, "disk"), (right, "balls")):
        tilt = data[f"{name}_tilt"]
        axes.plot(tilt, data[f"{name}_precession"], color=CONVERGED, label="closed formula")
        axes.plot(tilt, data[f"{name}_measured"], "o", color=ACCENT, label="runs")
        axes.set(xlabel=mark.TILT, title=name)
    left.plot(data["disk_tilt"], data["disk_thin"], color=INK, ls=DASHED, lw=1.0, label="thin disk")
    left.set_ylabel("precession (rad/s)")
    for axes in (left, right):
        axes.legend()
