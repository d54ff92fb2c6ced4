"""Data, the fitted run and the residuals."""

import numpy as np
from matplotlib.figure import Figure

from tippetop.figures.overview import ShownFigure
from tippetop.figures.style import CONVERGED, INK, MUTED, WIDTH, house_style
from tippetop.fit.fitted import FitResult


@house_style()
def plot_fit(fit: FitResult) -> Figure:
    """Draw each column of the data with the fitted run, and its standardised residuals below.

    Times of events are drawn over their numbers.

    Examples
    --------
    >>> import numpy as np
    >>> import tippetop as tt
    >>> tilts = {"theta": [0.1, 0.102, 0.105, 0.107]}
    >>> film = tt.Measurement.of_variables(np.linspace(0.0, 0.03, 4), tilts)
    >>> figure = tt.plot_fit(tt.fit(tt.presets.report_problem(), film, "launch.tilt_rate"))
    """
    columns = [
        (one.times if len(one.times) else np.arange(1.0), label, unit, *table)
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
    figure = ShownFigure(figsize=(WIDTH, 3.2 * len(columns)))
    heights = [3, 1] * len(columns)
    grid = figure.subplots(2 * len(columns), 1, sharex=True, height_ratios=heights, squeeze=False)
    for place, (times, label, unit, values, predicted, residuals) in enumerate(columns):
        above, below = grid[2 * place, 0], grid[2 * place + 1, 0]
        above.plot(times, values, ".", color=MUTED, label="data")
        above.plot(times, predicted, color=CONVERGED, linewidth=1.1, label="fit")
        above.set_title(f"{label} ({unit})" if unit else label)
        below.plot(times, residuals, ".", color=INK)
        below.axhline(0.0, color=MUTED, linewidth=0.8)
        below.set_ylabel("residual / σ")
    grid[0, 0].legend()
    grid[-1, 0].set_xlabel("Time (s)")
    return figure
