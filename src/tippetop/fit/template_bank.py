"""Templates: points so close in phase that a local search from the nearest one finds the truth.

The misfit of an oscillation over a number of the problem is a comb: it has a minimum for each turn
of the oscillation's phase over the data. The distance of two points is therefore measured by the
phase that the run shifts between them, as searches for gravitational waves do:

    B. J. Owen, Search templates for gravitational waves from inspiraling binaries: choice of
    template spacing. Phys. Rev. D 53 (1996), 6749.
"""

import numpy as np

from tippetop.integrators.base import Array

SPACING = 0.9
"""Phase, root of its mean square over time, between neighbouring templates, rad: a quarter of a
turn at the end of a phase that grows evenly. At twice as much the linear model leads elsewhere."""


def phase_metric(bends: Array) -> Array:
    """Return the matrix G: the mean square of the phases that a change d of fields shifts is d.G d.

    The fast part of an oscillation a cos(phase) dominates its second derivative over time,
    -a rate^2 cos(phase); the derivative of that with respect to a field is the same times the
    derivative of the phase, a quarter of a turn later.

    Parameters
    ----------
    bends
        Second differences over time of what a run shows, in the first column, and of its
        derivatives with respect to fields, shape (instants, 1 + fields).
    """
    shown = bends[np.isfinite(bends).all(axis=1)]
    size = float(shown[:, 0] @ shown[:, 0])
    metric: Array = shown[:, 1:].T @ shown[:, 1:]
    return metric / size if size > 0.0 else np.zeros_like(metric)


def lattice(reach: Array, metric: Array, spacing: float = SPACING) -> Array:
    """Return points of a box that lie no farther apart in phase than `spacing`.

    Parameters
    ----------
    reach
        Matrix whose columns span the box from its centre, shape (fields, fields).
    metric
        The matrix of `phase_metric`, shape (fields, fields).

    Returns
    -------
    numpy.ndarray
        Differences from the centre, shape (points, fields), the nearest in phase first.
    """
    phases, directions = np.linalg.eigh(reach.T @ metric @ reach)
    extents = np.abs(directions).sum(axis=0)
    counts = np.ceil(2.0 * extents * np.sqrt(np.maximum(phases, 0.0)) / spacing).astype(int)
    counts += 1 - counts % 2
    axes = [
        extent * np.linspace(-1.0, 1.0, count) * (1.0 - 1.0 / count)
        for extent, count in zip(extents, counts, strict=True)
    ]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, len(axes))
    order = np.argsort(np.abs(grid * np.sqrt(np.maximum(phases, 0.0))).max(axis=1), kind="stable")
    inside = grid[order] @ directions.T
    # A point beyond a face stands for a part of the box only if it is at most half a cell away.
    cells = np.abs(directions) @ (extents / counts)
    points: Array = inside[(np.abs(inside) <= 1.0 + 0.5 * cells).all(axis=1)] @ reach.T
    return points


def template_count(reach: Array, metric: Array, spacing: float = SPACING) -> float:
    """Return about how many points `lattice` has."""
    phases, directions = np.linalg.eigh(reach.T @ metric @ reach)
    extents = np.abs(directions).sum(axis=0)
    sides = 2.0 * np.sqrt(np.maximum(phases, 0.0)) / spacing
    return float(np.prod(np.maximum(np.minimum(extents, 1.0) * sides, 1.0)))
