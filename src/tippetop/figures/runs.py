"""Figures of one launch, by the report's method and converged (the report's Figs. 4, 5, 8 to
16).
"""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.ticker import MultipleLocator

import tippetop.figures.annotation as mark
from tippetop.figures.envelope import band
from tippetop.figures.flights import continue_unilateral
from tippetop.figures.overview import shade_flights
from tippetop.figures.style import ACCENT, CONVERGED, DASHED, INK, MUTED, REPORT

_NAME, _NAME_REPORT = "converged", "report's method"
_LINES = (("_listing", "time_listing", REPORT, 2.6, 1.8), ("", "time", CONVERGED, 1.0, 0.8))
"""Both methods' suffix of variables, time, colour, width of lines, and width of the edges of
bands.
"""


@mark.drawn(5.0, 2, 2, sharex=True)
def motion_figure(
    panels: Any,
    run: xr.Dataset,
    zoom: tuple[float, float],
    reported_turn: float,
    reported_reversals: tuple[float, ...],
    precession_limit: float = 200.0,
    inset: mark.Box = (0.5, 0.13, 0.48, 0.56),
    reported_end: tuple[float, dict[str, float]] | None = None,
) -> None:
    """Draw tilt, axial spin, precession and slip of a launch, by both methods.

    The axis of precession ends at `precession_limit` rad/s, since precession peaks wherever the
    axis comes near the vertical. The span of time `zoom` (s) of the tilt is enlarged in the inset
    `inset` (left, bottom, width, height in shares of the panel).

    Dots mark reversals of the precession: `quiet_start` and `quiet_end` if a calm begins later than
    1 s, else `last_reversal`. Squares mark values that the report prints: the time `reported_turn`
    at which the top has turned over, the times `reported_reversals`, and `reported_end`, the time
    of its final values with theta, omega3 and phi_dot.
    """
    tilt, spin, turning, slip = panels.flat
    _pair(tilt, run, "tilt", legend=True)
    mark.tilt_axis(tilt)
    _zoom(tilt, run, zoom, inset)
    _pair(spin, run, "spin")
    spin.set_ylabel(r"axial spin $\omega_3$ (rad/s)")
    _precession(turning, run, precession_limit)
    square = {"color": REPORT, "ms": 5, "mec": INK, "mew": 0.6, "zorder": 6}
    turning.plot(reported_reversals, np.zeros(len(reported_reversals)), "s", **square)
    for time, below in zip(reversed(reported_reversals), (-6, -20), strict=False):
        mark.note(turning, f"report:\n{time:g} s", (time, 0), (7, below), REPORT, halo=True)
    turned = (
        reported_turn,
        float(np.interp(reported_turn, run["time_listing"], run["tilt_listing"])),
    )
    tilt.plot(*turned, "s", **square)
    mark.note(tilt, f"report: {reported_turn:g} s", turned, (6, -8), REPORT, halo=True)
    speeds = {
        f"speed{end}": np.hypot(run[f"slip_x{end}"], run[f"slip_y{end}"])
        for end in ("_listing", "")
    }
    _pair(slip, run.assign(speeds), "speed")
    slip.set(ylabel="slip speed $|v_A|$ (m/s)", ylim=(0, None))
    for axes, name in ((tilt, "tilt"), (spin, "spin"), (turning, "precession")):
        if reported_end:
            end = reported_end[0], reported_end[1][name]
            axes.plot(*end, "s", **square)
            mark.note(axes, f"report: {end[1]:g}", end, (4, 8), REPORT, halo=True)
    for axes in panels[1]:
        axes.set_xlabel("time (s)")
    for axes in panels.flat:
        axes.set_xlim(0, float(run["time"][-1]))


@mark.drawn(3.0)
def tilt_figure(
    axes: Axes,
    run: xr.Dataset,
    zoom: tuple[float, float],
    inset: mark.Box = (0.56, 0.14, 0.42, 0.56),
) -> None:
    """Draw the tilt of a launch against time by both methods, and mark its lift-off.

    `lift_off_time` is the time of lift-off. If the top flies, the motion on a table that only
    pushes is drawn as well. The span of time `zoom` (s) is enlarged in the inset `inset` (left,
    bottom, width, height in shares of the panel).
    """
    _over_time(axes, run)
    _trio(axes, run, "tilt")
    mark.tilt_axis(axes)
    _zoom(axes, run, zoom, inset)
    _mark_lift_off(axes, float(run["lift_off_time"]))


@mark.drawn(3.0)
def upright_figure(axes: Axes, run: xr.Dataset, until: float = 3.0) -> None:
    """Draw the tilt, up to a time (s), of a launch that stays near the vertical, on its own
    scale.
    """
    _over_time(axes, run)
    start = run.sel(time=slice(None, until), time_listing=slice(None, until))
    _pair(axes, start, "tilt", legend=True)
    axes.set_xlim(0, until)
    axes.xaxis.set_major_locator(MultipleLocator(0.5))
    axes.set_ylim(0, 1.12 * float(run["tilt"].max()))
    axes.set_ylabel(mark.TILT)


@mark.drawn(3.0)
def energy_figure(axes: Axes, run: xr.Dataset, reported: tuple[float, float]) -> None:
    """Draw energy against time: the report's (4.1) by its method, and the full energy converged.

    `reported` is the time, s, and the gain, J, that the report states.
    """
    _over_time(axes, run)
    start = 1e3 * float(run["launch_energy"])
    axes.axhline(start, color=MUTED, lw=0.9, ls=DASHED)
    mark.note(axes, "energy at launch", (0, start), (2, -3), MUTED)
    names = ("(4.1), report's method", "full energy, table pulls")
    _trio(axes, run, "energy", scale=1e3, names=names)
    axes.set(ylabel="energy (mJ)", ylim=(0, None))
    low = 1e3 * float(np.interp(reported[0], run["time_listing"], run["energy_listing"]))
    high = low + 1e3 * reported[1]
    ends = {
        "arrowstyle": "|-|",
        "color": INK,
        "lw": 1.2,
        "mutation_scale": 3,
        "shrinkA": 0,
        "shrinkB": 0,
    }
    axes.annotate("", (reported[0], low), (reported[0], high), arrowprops=ends, zorder=6)
    text = f"the report's gain\nof {reported[1]:g} J at {reported[0]:g} s"
    mark.note(axes, text, (reported[0], high), (-22, -14), INK, halo=True)
    _mark_lift_off(axes, float(run["lift_off_time"]))


@mark.drawn(3.0)
def force_figure(axes: Axes, run: xr.Dataset) -> None:
    """Draw the normal force against time; where it is negative, the table would have to pull."""
    _over_time(axes, run)
    low = 1.12 * min(float(run["normal_force"].min()), float(run["normal_force_listing"].min()))
    axes.axhspan(low, 0, color=ACCENT, alpha=0.07, lw=0)
    axes.axhline(0, color=ACCENT, lw=1.0)
    _trio(axes, run, "normal_force")
    mark.note(axes, "the table pulls", (0, low), (6, 5), ACCENT)
    axes.set(ylabel="normal force $g_n$ (N)", ylim=(low, None))
    _mark_lift_off(axes, float(run["lift_off_time"]))


@mark.drawn(4.6, 2, 1, height_ratios=[1.3, 1])
def stopped_figure(tilt: Axes, force: Axes, run: xr.Dataset, reported_stop: float) -> None:
    """Draw tilt and force up to the report's stop (s), up to lift-off, and in the flight after
    it.
    """
    stop = float(run["lift_off_time"])
    before = run.sel(time=run["time"] <= stop)
    listing = run.sel(time_listing=run["time_listing"] <= reported_stop)
    for axes, name in ((tilt, "tilt"), (force, "normal_force")):
        for part, suffix, color, width, edge, label in (
            (listing, "_listing", REPORT, 2.6, 1.8, _NAME_REPORT),
            (before, "", CONVERGED, 1.3, 1.3, _NAME),
        ):
            times, values = part[f"time{suffix}"], part[f"{name}{suffix}"]
            if axes is tilt:
                band(axes, times, values, color, edge, label, across=60)  # before it stops
            else:
                axes.plot(times, values, color=color, lw=width)
        continue_unilateral(axes, run, name)
        shade_flights(axes, run)
    mark.tilt_axis(tilt)
    force.axhline(0, color=ACCENT, lw=1.0)
    force.set(
        xlabel="time (s)", ylabel="normal force $g_n$ (N)", xlim=(stop - 0.55, reported_stop + 1.25)
    )
    tilt.set_xlim(0, 8)
    for time, color in ((stop, ACCENT), (reported_stop, REPORT)):
        force.axvline(time, color=color, lw=1.0, ls=DASHED)
    end = float(np.interp(stop, run["time"], run["tilt"]))
    last = float(listing["tilt_listing"][-1])
    tilt.plot([stop], [end], "o", color=ACCENT, ms=6, zorder=5)
    tilt.plot([reported_stop], [last], "s", color=REPORT, ms=6, zorder=5, mec=INK, mew=0.6)
    for text, at, offset, color in (
        (f"the top leaves the table\nat {stop:.3f} s", (stop, end), (-44, 22), ACCENT),
        (f"the report stops\nat {reported_stop:g} s", (reported_stop, last), (52, -12), INK),
    ):
        mark.note(
            tilt, text, at, offset, color, va="center", arrowprops={**mark.LEADER, "color": color}
        )
    tilt.legend(loc="upper left")


def _over_time(axes: Axes, run: xr.Dataset) -> None:
    axes.set(xlabel="time (s)", xlim=(0, float(run["time"][-1])))
    axes.xaxis.set_major_locator(MultipleLocator(2))


def _pair(
    axes: Axes,
    run: xr.Dataset,
    name: str,
    *,
    scale: float = 1.0,
    legend: bool = False,
    names: tuple[str, str] = (_NAME_REPORT, _NAME),
) -> None:
    """Draw a variable by both methods: the report's as a wide line below the converged one."""
    for (suffix, time, color, _, edge), label in zip(_LINES, names, strict=True):
        band(axes, run[time], scale * run[f"{name}{suffix}"], color, edge, label)
    if legend:
        mark.legend_above(axes, 2)


def _trio(
    axes: Axes,
    run: xr.Dataset,
    name: str,
    *,
    scale: float = 1.0,
    names: tuple[str, str] | None = None,
) -> None:
    """Draw a variable by both methods and, if the top flies, on a table that only pushes."""
    flies = f"{name}_flight" in run
    _pair(
        axes,
        run,
        name,
        scale=scale,
        names=names or (_NAME_REPORT, "converged, table pulls" if flies else _NAME),
    )
    if flies:
        shade_flights(axes, run)
        continue_unilateral(axes, run, name, scale=scale, as_band=True)
    mark.legend_above(axes, 3)


def _precession(axes: Axes, run: xr.Dataset, limit: float) -> None:
    axes.axhline(0, color=MUTED, lw=0.8)
    _pair(axes, run, "precession")
    axes.set_ylim(-limit, limit)
    last = float(run["last_reversal"])
    quiet = [float(run[name]) for name in ("quiet_start", "quiet_end")]
    marks = [time for time in (quiet if quiet[0] > 1.0 else [last]) if np.isfinite(time)]
    axes.plot(marks, np.zeros(len(marks)), "o", color=ACCENT, ms=5, zorder=5)
    for time in marks:
        mark.note(axes, f"{time:.2f} s", (time, 0), (7, 5), ACCENT, halo=True)
    axes.set_ylabel(r"precession $\dot\varphi$ (rad/s)")


def _mark_lift_off(axes: Axes, time: float) -> None:
    """Mark the time of lift-off, unless it is nan."""
    if not np.isfinite(time):
        return
    axes.axvline(time, color=ACCENT, lw=1.0, ls=DASHED)
    mark.note(axes, f"lift-off, {time:.2f} s", (time, 1.0), (-4, -2), ACCENT, xycoords=mark.ALONG_X)


def _zoom(axes: Axes, run: xr.Dataset, span: tuple[float, float], box: mark.Box) -> None:
    """Draw a span of time of the tilt in an inset, and frame that span in the panel."""
    inset = mark.inset(axes, box)
    drawn = []
    for suffix, time, color, width, _ in _LINES:
        part = run.sel({time: slice(*span)})
        inset.plot(part[time], part[f"tilt{suffix}"], color=color, lw=width)
        drawn.append(part[f"tilt{suffix}"].values)
    if "tilt_flight" in run:
        shade_flights(inset, run)
        continue_unilateral(inset, run, "tilt")
    low, high = min(part.min() for part in drawn), max(part.max() for part in drawn)
    inset.set_xlim(*span)
    inset.set_ylim(low - 0.08 * (high - low), high + 0.08 * (high - low))
    inset.locator_params(nbins=4)
    mark.source(axes, inset)
