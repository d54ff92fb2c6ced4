"""One run over time: six variables in panels, or one of them."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tippetop.figures.style import (
    ACCENT,
    CONVERGED,
    DASHED,
    MUTED,
    WIDTH,
    ShownFigure,
    house_style,
    pi_ticks,
)
from tippetop.results.catalogue import written_unit
from tippetop.support.suggestions import not_one_of

TALLEST_PRECESSION = 400.0
"""Precession beyond which a curve is cut off, rad/s: it has no bound where the axis is vertical."""


@house_style()
def overview(run: xr.Dataset) -> Figure:
    """Draw tilt, axial spin, precession, slip, normal force and energy of a run against time."""
    panels = {
        "Tilt θ (rad)": run["tilt"].values,
        "Axial spin ω₃ (rad/s)": run["spin"].values,
        "Precession φ′ (rad/s)": run["precession"].values,
        "Slip speed (m/s)": np.hypot(run["slip_x"].values, run["slip_y"].values),
        "Normal force (N)": run["normal_force"].values,
        "Energy (J)": run["energy"].values,
    }
    figure = ShownFigure(figsize=(WIDTH, 6.2))
    grid = figure.subplots(3, 2, sharex=True)
    for axes, (title, values) in zip(grid.flat, panels.items(), strict=True):
        axes.plot(run["time"].values, values, color=CONVERGED, linewidth=1.1)
        axes.set_title(title)
        shade_flights(axes, run)
    pi_ticks(grid[0, 0].yaxis)
    grid[0, 0].set_ylim(-0.1, np.pi + 0.1)
    _cut(grid[1, 0], run["precession"].values)
    grid[2, 0].axhline(0.0, color=MUTED, linewidth=0.8)
    for axes in grid[2]:
        axes.set_xlabel("Time (s)")
    return figure


def draw_variable(axes: Axes, run: xr.Dataset, name: str) -> None:
    """Draw a variable of a run against time into a panel, with its flights shaded.

    Raises
    ------
    InvalidInput
        If the run has no such variable over time.
    """
    names = [str(one) for one in run.data_vars if run[one].dims[:1] == ("time",) and one != "mode"]
    if name not in names:
        raise not_one_of("variable", name, names)
    variable = run[name]
    for values in variable.values.reshape(len(variable), -1).T:
        axes.plot(run["time"].values, values, linewidth=1.1)
    units = variable.attrs.get("units", "1")
    axes.set_title(f"{name} ({written_unit(units)})" if units != "1" else name)
    axes.set_xlabel("Time (s)")
    shade_flights(axes, run)
    if name == "tilt":
        pi_ticks(axes.yaxis)
        axes.set_ylim(-0.1, np.pi + 0.1)
    elif name == "precession":
        _cut(axes, variable.values)


def shade_flights(axes: Axes, run: xr.Dataset) -> None:
    """Shade the flights of a run; mark the end of a run that stopped at lift-off by a line."""
    for begin, end in zip(run["flight_start"].values, run["flight_end"].values, strict=True):
        axes.axvspan(begin, end, color=ACCENT, alpha=0.15, linewidth=0.4)
    if run.attrs["status"] == "lifted_off":
        axes.axvline(float(run["time"][-1]), color=ACCENT, linewidth=0.8, linestyle=DASHED)


def _cut(axes: Axes, values: np.ndarray[Any, Any]) -> None:
    """Limit the axis of precession, so that peaks at the poles do not flatten the rest of the
    curve.
    """
    finite = values[np.isfinite(values)]
    if len(finite) and np.abs(finite).max() > TALLEST_PRECESSION:
        typical = 1.5 * float(np.quantile(np.abs(finite), 0.98))
        bound = min(TALLEST_PRECESSION, max(typical, 1.0))
        axes.set_ylim(max(-bound, 1.1 * finite.min()), min(bound, 1.1 * finite.max()))
