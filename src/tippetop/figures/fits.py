"""Data, the fitted run and the residuals."""

from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tippetop.figures.style import CONVERGED, INK, MUTED, WIDTH, ShownFigure, house_style
from tippetop.fit.fit_result import FitResult
from tippetop.integrators.base import Array
from tippetop.results.catalogue import written_unit
from tippetop.support.suggestions import not_one_of


class FittedColumn(NamedTuple):
    """Column of the data beside the fitted run."""

    times: Array
    """Times, s; numbers of the rows where the data are times of events."""
    label: str
    unit: str
    values: Array
    predicted: Array
    residuals: Array
    """Residuals over the standard deviation of the data."""

    def draw(self, axes: Axes) -> None:
        """Draw the data and the fitted run into a panel."""
        axes.plot(self.times, self.values, ".", color=MUTED, label="data")
        axes.plot(self.times, self.predicted, color=CONVERGED, linewidth=1.1, label="fit")
        unit = "" if self.unit in ("", "1") else f" ({written_unit(self.unit)})"
        axes.set_title(f"{self.label}{unit}")


def columns_of(fit: FitResult, name: str | None = None) -> list[FittedColumn]:
    """Return the columns of the data of a fit, or those of one name.

    Raises
    ------
    InvalidInput
        If the data have no column of this name.
    """
    columns = [
        FittedColumn(one.times if len(one.times) else np.arange(1.0), label, unit, *table)
        for one, residuals, predicted in zip(
            fit.measurements, fit.residuals, fit.predict(), strict=True
        )
        for label, unit, *table in zip(
            one.observation.labels,
            one.observation.units,
            one.values.T,
            predicted.T,
            residuals.T,
            strict=True,
        )
    ]
    chosen = [column for column in columns if name in (None, column.label)]
    if not chosen:
        raise not_one_of("variable", name, [column.label for column in columns])
    return chosen


def draw_fit(axes: Axes, fit: FitResult, name: str | None = None) -> None:
    """Draw a column of the data, by default the first, and the fitted run into a panel."""
    columns_of(fit, name)[0].draw(axes)
    axes.set_xlabel("Time (s)")
    axes.legend()


@house_style()
def plot_fit(fit: FitResult, name: str | None = None) -> Figure:
    """Draw each column of the data with the fitted run, and its standardised residuals below."""
    columns = columns_of(fit, name)
    figure = ShownFigure(figsize=(WIDTH, 3.2 * len(columns)))
    heights = [3, 1] * len(columns)
    grid = figure.subplots(2 * len(columns), 1, sharex=True, height_ratios=heights, squeeze=False)
    for place, column in enumerate(columns):
        column.draw(grid[2 * place, 0])
        below = grid[2 * place + 1, 0]
        below.plot(column.times, column.residuals, ".", color=INK)
        below.axhline(0.0, color=MUTED, linewidth=0.8)
        below.set_ylabel("residual / σ")
    grid[0, 0].legend()
    grid[-1, 0].set_xlabel("Time (s)")
    return figure
