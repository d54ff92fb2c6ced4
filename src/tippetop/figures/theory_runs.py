"""Figures of slow inversion: runs against the limit of weak friction, and the nutation of a run."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.ticker import MultipleLocator, NullLocator

import tippetop.figures.annotation as mark
from tippetop.figures.style import ACCENT, CONVERGED, DASHED, FAINT, INK, MUTED, REPORT, UNILATERAL

_SPAN = 3.0
"""Energies above the potential's minimum that each panel shows, mJ."""


@mark.drawn(5.6, 2, 1, sharex=True, height_ratios=[1.2, 1])
def collapse_figure(linear: Axes, logarithmic: Axes, flow: xr.Dataset) -> None:
    """Draw tilts of runs and of the averaged flow against mu t, on a linear and a logarithmic
    scale.
    """
    limit = float(flow["flip_limit"])
    for axes in (linear, logarithmic):
        _runs_and_flow(axes, flow)
        axes.axvline(limit, color=MUTED, lw=0.9, ls=DASHED)
        axes.set_ylabel(mark.TILT)
    mark.tilt_axis(linear, -0.08, np.pi + 0.12)
    linear.legend(loc="upper left")
    mark.note(linear, f"limit of $\\mu\\,t_{{flip}}$\n{limit:.4f} s²/m", (limit, 0.2), (-6, 0), INK)
    logarithmic.set(yscale="log", ylim=(1e-3, 5.0), xlabel=r"$\mu\,t$ (s²/m)")
    logarithmic.set_xlim(0, float(flow["mu_time"][-1]))


def _runs_and_flow(axes: Axes, flow: xr.Dataset) -> None:
    """Draw the run with most friction as a curve, the other runs and the flow by their ranges."""
    axes.plot(
        flow["mu_time_swing"],
        flow["tilt_swing"],
        color=REPORT,
        lw=0.8,
        label=rf"run, $\mu$ = {float(flow['friction'][0]):g} s/m",
    )
    for k, color in zip(range(1, flow.sizes["friction"]), (UNILATERAL, CONVERGED), strict=False):
        mu = float(flow["friction"][k])
        axes.fill_between(
            flow["mu_time"],
            flow["run_low"][k],
            flow["run_high"][k],
            color=color,
            alpha=0.4,
            lw=0.9,
            label=rf"run, $\mu$ = {mu:g} s/m: range of the nutation",
        )
    for bound, name in (("flow_low", "limit of small friction: range"), ("flow_high", None)):
        axes.plot(flow["mu_time"], flow[bound], color=INK, lw=1.1, ls=(0, (5, 3)), label=name)


@mark.drawn(5.6, 2, 1, sharex=True, height_ratios=[1.45, 1])
def exponent_figure(above: Axes, below: Axes, times: xr.Dataset) -> None:
    """Draw mu times several times of turning over against friction, and the local exponents."""
    mu = times["mu_flip"].values
    limits = (float(times["limit_arrival"]), float(times["limit_crossing"]))
    for limit, color in zip(limits, (CONVERGED, UNILATERAL), strict=True):
        above.axhline(limit, color=color, lw=0.9, ls=DASHED)
        aside = (0, -3 if limit == limits[1] else 3)
        mark.note(above, f"limit {limit:.4f}", (mu[0], limit), aside, color, ha="left")
    for name, color, line, size, label in (
        ("settling_time", "#B4BDC6", "-o", 6.5, "stays within 0.01 rad of the end"),
        (
            "arrival_time_window",
            REPORT,
            "s",
            5.5,
            "the report's: within 0.01 rad of the tilt at 20 s",
        ),
        ("arrival_time_end", CONVERGED, "-o", 3.5, "first within 0.01 rad of the end"),
        ("crossing_time", UNILATERAL, "-o", 3.5, r"first tilt of more than $\pi/2$"),
    ):
        above.plot(mu, mu * times[name], line, color=color, ms=size, lw=1.4, label=label)
    above.set_yscale("log")
    mark.plain_ticks(above.yaxis, [1, 2, 5, 10, 20, 50, 100])
    above.set_ylim(1.25, 1.3 * float((times["mu_flip"] * times["settling_time"]).max()))
    above.set_ylabel(r"$\mu\,\times$ time (s²/m)")
    above.legend(loc="upper left")
    _exponents(below, times)
    for axes in (above, below):
        axes.axvspan(0.2, 1.0, color=REPORT, alpha=0.09, lw=0)
    mark.note(
        below, "the report's\nrange", (0.447, 1.0), (0, -4), REPORT, size=8.5, xycoords=mark.ALONG_X
    )


def _exponents(axes: Axes, times: xr.Dataset) -> None:
    mu = times["mu_flip"].values
    axes.axhline(-1, color=MUTED, lw=0.9, ls=DASHED)
    for name, color, width in (
        ("arrival_time_end", CONVERGED, 0.7),
        ("crossing_time", UNILATERAL, 1.6),
    ):
        axes.plot(mu, times[f"exponent_{name}"], "-o", color=color, ms=3.5, lw=width)
    axes.set_xscale("log")
    axes.set_xlim(mu[0] / 1.12, mu[-1] * 1.12)
    mark.plain_ticks(axes.xaxis, [0.003, 0.01, 0.03, 0.1, 0.3, 1, 3])
    axes.xaxis.set_minor_locator(NullLocator())
    axes.set(xlabel=mark.FRICTION, ylabel=r"exponent $d\ln t\,/\,d\ln\mu$", ylim=(-2.1, 1.3))


@mark.drawn(5.0, 2, 1, sharex=True)
def balance_figure(tilt: Axes, ratio: Axes, run: xr.Dataset) -> None:
    """Draw the distance of a run from gyroscopic balance, and its tilt within its nutation's
    envelope.
    """
    time = run["time_diagnosed"].values
    _within_envelope(tilt, run, 0.9)
    inset = mark.inset(tilt, (0.71, 0.13, 0.28, 0.66))
    part = run.sel(time_diagnosed=slice(4.8, 5.3))
    _within_envelope(inset, part, 1.3)
    inset.set_xlim(4.8, 5.3)
    mark.source(tilt, inset)
    mark.tilt_axis(tilt)
    tilt.legend(loc="upper left")
    ratio.axhspan(-0.1, 0.1, color=FAINT, alpha=0.7, lw=0)
    ratio.axhline(0, color=MUTED, lw=0.9)
    ratio.plot(time, run["balance_ratio"], color=ACCENT, lw=0.8)
    ratio.set_ylim(-1.35, 1.35)
    mark.note(ratio, "within a tenth", (time[-1], -0.1), (-3, -3), MUTED)
    ratio.set(xlabel="time (s)", ylabel=r"$\xi\,/\,|I_3\omega_3|$ at launch", xlim=(0, time[-1]))


def _within_envelope(axes: Axes, run: xr.Dataset, width: float) -> None:
    time = run["time_diagnosed"].values
    axes.fill_between(
        time,
        run["envelope_low"],
        run["envelope_high"],
        color=REPORT,
        alpha=0.35,
        lw=0,
        label="between the turning points on a smooth table",
    )
    axes.plot(time, run["tilt_diagnosed"], color=CONVERGED, lw=width, label="run")


@mark.drawn(4.9, 2, 3, sharex=True, lettered=False)
def potential_figure(panels: Any, run: xr.Dataset) -> None:
    """Draw the effective potential of the tilt and the energy level at several instants of a
    run.
    """
    tilt = run["well_tilt"].values
    for k, axes in enumerate(panels.flat):
        well, level = 1e3 * run["potential"][k].values, 1e3 * float(run["level"][k])
        at = float(run["instant_tilt"][k])
        low = float(well.min())
        axes.fill_between(tilt, well, level, where=well <= level, color=REPORT, alpha=0.3, lw=0)
        axes.plot(tilt, well, color=CONVERGED, lw=1.6)
        axes.axhline(level, color=REPORT, lw=1.1)
        axes.plot(at, level, "o", color=ACCENT, ms=5, zorder=5)
        axes.set(ylim=(low - 0.1 * _SPAN, low + _SPAN), xlim=(-0.05, np.pi + 0.05))
        axes.xaxis.set_major_locator(MultipleLocator(np.pi / 2))
        axes.set_title(f"t = {float(run['instant'][k]):g} s", weight="normal", size=10)
    for axes in panels[1]:
        axes.set_xlabel(mark.TILT)
        axes.xaxis.set_ticks(
            [0, np.pi / 4, np.pi / 2, 3 * np.pi / 4, np.pi], ["0", "", "π/2", "", "π"]
        )
    for axes in panels[:, 0]:
        axes.set_ylabel("effective potential (mJ)")
