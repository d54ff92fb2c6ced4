"""Fast oscillations on a long axis: drawn as the band between their turning points, not as a solid
blob.
"""

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

_ACROSS = 150
"""How many oscillations an axis can show side by side."""
_POINTS = 600


def envelope(
    times: ArrayLike, values: ArrayLike, across: int = _ACROSS
) -> tuple[Array, Array, Array]:
    """The band that an oscillation fills.

    Where turning points follow each other too closely to be seen apart, the band lies between the
    curves through the upper and through the lower ones; elsewhere it is the curve itself.

    Times and values of the oscillation are of shape (n,), increasing in time; values that are not
    finite are left out. So many oscillations can be seen side by side `across` the axis. Returned
    are times at equal distances, and the lower and upper edge of the band there, shape (m,).
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
        own = turns[slope[turns - 1] == sense]
        knots = np.union1d(np.flatnonzero(apart), own if len(own) else ends)
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
    """Draw an oscillation as a line where one sees it, and as a pale band between two lines where
    not.
    """
    grid, low, high = envelope(times, values, across)
    inside = high - low > 1e-3 * (high.max() - low.min())
    axes.fill_between(grid, low, high, where=inside, color=color, alpha=0.22, lw=0)
    axes.plot(grid, high, color=color, lw=width, label=label or None)
    axes.plot(grid, low, color=color, lw=width)
