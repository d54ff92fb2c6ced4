"""Overview of one run (`tt.plot`): four variables of the report, the normal force, the energy."""

from io import BytesIO
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tippetop.figures.style import ACCENT, CONVERGED, DASHED, MUTED, WIDTH, house_style, pi_ticks
from tippetop.results.dataset import require_run

TALLEST_PRECESSION = 400.0
"""Precession beyond which a curve is cut off, rad/s: it has no bound where the axis is vertical."""


class ShownFigure(Figure):
    """Figure that notebooks show although pyplot does not know it."""

    @house_style()
    def _repr_png_(self) -> bytes:
        picture = BytesIO()
        self.savefig(picture, format="png")
        return picture.getvalue()


@house_style()
def plot(run: xr.Dataset) -> Figure:
    """Draw tilt, axial spin, precession, slip, normal force and energy of a run against time.

    Examples
    --------
    >>> import tippetop as tt
    >>> figure = tt.plot(tt.simulate(tt.presets.report_problem(), duration=10.0))
    >>> figure.savefig("run.svg")
    """
    require_run(run)
    panels = {
        "Tilt θ (rad)": run["theta"].values,
        "Axial spin ω₃ (rad/s)": run["omega3"].values,
        "Precession φ′ (rad/s)": run["phi_dot"].values,
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
    _cut(grid[1, 0], run["phi_dot"].values)
    grid[2, 0].axhline(0.0, color=MUTED, linewidth=0.8)
    for axes in grid[2]:
        axes.set_xlabel("Time (s)")
    return figure


def shade_flights(axes: Axes, run: xr.Dataset) -> None:
    """Shade the flights of a run; mark the end of a run that stopped at lift-off by a line."""
    for begin, end in zip(run["flight_start"].values, run["flight_end"].values, strict=True):
        axes.axvspan(begin, end, color=ACCENT, alpha=0.15, linewidth=0.4)
    if run.attrs["outcome"] == "lifted_off":
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
