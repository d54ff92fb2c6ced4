"""`tt.plot`: one figure for each kind of result, or a drawing of it into a panel of your own."""

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tippetop.figures.fits import draw_fit, plot_fit
from tippetop.figures.maps import draw_map, phase_map
from tippetop.figures.overview import draw_variable, overview
from tippetop.figures.style import (
    CONVERGED,
    CYCLE,
    MUTED,
    WIDTH,
    ShownFigure,
    house_style,
    pi_ticks,
)
from tippetop.fit.fit_result import Comparison, FitResult
from tippetop.results.dataset import is_sweep, require_run
from tippetop.support.errors import InvalidInput
from tippetop.theory.prediction import Prediction
from tippetop.theory.steady import SteadyState

ACCEPTED = (
    "a run, a sweep, a fit, a comparison of fits, a prediction or a list of steady states, as"
    " simulate, sweep, fit, compare_fits, predict and steady_states return them"
)


@house_style()
def plot(result: object, variable: str | None = None, *, ax: Axes | None = None) -> Figure:
    """Draw a run, a sweep, a fit, a comparison, a prediction or steady states.

    Parameters
    ----------
    result
        What `simulate`, `sweep`, `fit`, `compare_fits`, `predict` or `steady_states` returned.
    variable
        Variable to draw. Of a run: one over time; None for six of them, or for the tilt in `ax`. Of
        a sweep: one over the launches; None for the outcome. Of a fit: a column of the data; None
        for all, or for the first in `ax`.
    ax
        Panel of matplotlib to draw into; None for a new figure.

    Returns
    -------
    matplotlib.figure.Figure
        The figure, which notebooks show.

    Raises
    ------
    InvalidInput
        If the result is none of these, or has no such variable, or has more dimensions than a panel
        can show.

    Examples
    --------
    >>> import tippetop as tt
    >>> figure = tt.plot(tt.simulate(tt.presets.report_problem(), duration=10.0))
    >>> figure.savefig("run.svg")
    >>> panel = figure.add_subplot()
    >>> tt.plot(tt.steady_states(tt.presets.report_problem(spin=50.0)), ax=panel) is figure
    True
    """
    if not (ax is None or isinstance(ax, Axes)):
        raise InvalidInput("ax", ax, "a panel of matplotlib, or None")
    if isinstance(result, FitResult):
        return plot_fit(result, variable) if ax is None else _within(ax, draw_fit, result, variable)
    if is_sweep(result):
        name = variable or "outcome"
        return phase_map(result, name) if ax is None else _within(ax, draw_map, result, name)
    if isinstance(result, xr.Dataset):
        require_run(result)
        if ax is None and variable is None:
            return overview(result)
        return _within(_panel(ax), draw_variable, result, variable or "tilt")
    if variable is not None:
        raise InvalidInput("variable", variable, "None for this result")
    if isinstance(result, Comparison):
        return _within(_panel(ax), _draw_comparison, result)
    states = result.stable if isinstance(result, Prediction) else result
    if (
        isinstance(states, Sequence)
        and states
        and all(isinstance(state, SteadyState) for state in states)
    ):
        return _within(_panel(ax), _draw_states, states)
    raise InvalidInput("result", result, ACCEPTED)


def _panel(ax: Axes | None) -> Axes:
    """Return a panel, that of a new figure if there is none."""
    return ShownFigure(figsize=(WIDTH, 4.2)).subplots() if ax is None else ax


def _within(ax: Axes, draw: object, *arguments: object) -> Figure:
    """Draw into a panel and return its figure."""
    assert callable(draw)
    draw(ax, *arguments)
    figure = ax.get_figure(root=True)
    assert figure is not None
    return figure


def _draw_comparison(ax: Axes, comparison: Comparison) -> None:
    """Draw the differences of Schwarz's criterion as bars, the preferred model first."""
    names = list(comparison.differences)
    colors = [CONVERGED if name == comparison.preferred else MUTED for name in names]
    ax.barh(names, list(comparison.differences.values()), color=colors, height=0.6)
    ax.invert_yaxis()
    ax.set_xlabel("BIC above the least")


def _draw_states(ax: Axes, states: Sequence[SteadyState[float]]) -> None:
    """Draw the energies of steady states over their tilts, a colour for each kind."""
    kinds = list(dict.fromkeys(state.kind for state in states))
    for kind, color in zip(kinds, CYCLE, strict=False):
        some = [state for state in states if state.kind is kind]
        tilts, energies = [one.tilt for one in some], [1e3 * one.energy for one in some]
        ax.plot(tilts, energies, "o", color=color, label=str(kind))
    ax.set(xlabel="Tilt (rad)", ylabel="Energy (mJ)", xlim=(-0.1, np.pi + 0.1))
    pi_ticks(ax.xaxis)
    ax.legend()
