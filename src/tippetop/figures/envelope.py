"""Envelope of a fast oscillation: the band between its turning points, drawn in place of the
curve.
"""

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

_ACROSS = 150
"""Number of oscillations that can be told apart side by side along an axis."""
_POINTS = 600


def envelope(
    times: ArrayLike, values: ArrayLike, across: int = _ACROSS
) -> tuple[Array, Array, Array]:
    """Return the lower and the upper edge of an oscillation at evenly spaced times.

    Where turning points follow each other too closely to be told apart, the edges are the curves
    through the lower and through the upper turning points. Elsewhere both edges are the curve
    itself.

    Times and values have shape (n,), times increase, and values that are not finite are left out.
    `across` is the number of oscillations that can be told apart along the axis. The times and both
    edges are returned, each of shape (m,).
    """
    t, y = np.asarray(times, dtype=float), np.asarray(values, dtype=float)
    t, y = t[np.isfinite(y)], y[np.isfinite(y)]
    grid = np.linspace(t[0], t[-1], _POINTS)
    slope = np.sign(np.diff(y))
    turns = np.flatnonzero(slope[1:] * slope[:-1] < 0) + 1
    ends = np.concatenate([[0], turns, [len(t) - 1]])
    seen = np.repeat(np.diff(t[ends]) > (t[-1] - t[0]) / across, np.diff(ends))
    apart = np.append(seen, seen[-1:]) | np.append(seen[:1], seen)
    edges = []
    for sense in (-1.0, 1.0):
        same_side = turns[slope[turns - 1] == sense]
        knots = np.union1d(np.flatnonzero(apart), same_side if len(same_side) else ends)
        edges.append(np.interp(grid, t[knots], y[knots]))
    return grid, np.minimum(*edges), np.maximum(*edges)


def band(
    axes: Axes,
    times: ArrayLike,
    values: ArrayLike,
    color: str,
    width: float,
    label: str = "",
    across: int = _ACROSS,
) -> None:
    """Draw an oscillation as a line, and as a pale band where it is too fast to be told apart."""
    grid, low, high = envelope(times, values, across)
    inside = high - low > 1e-3 * (high.max() - low.min())
    axes.fill_between(grid, low, high, where=inside, color=color, alpha=0.22, lw=0)
    axes.plot(grid, high, color=color, lw=width, label=label or None)
    axes.plot(grid, low, color=color, lw=width)
