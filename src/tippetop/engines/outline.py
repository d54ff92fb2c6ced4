"""The outside of a body as points and triangles, for programs that take meshes."""

import math
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import tippetop as tt

Array = NDArray[np.float64]

FACETS = 180
"""Facets around the axis: of a ball of 20 mm they leave out 3 micrometres."""


POLE = 1e-6
"""Tilt next to the vertical, rad: nearer, support functions of rings have no slope."""


class ConvexMesh(NamedTuple):
    """A convex body of revolution as triangles, axis along z, from the centre of mass."""

    points: Array
    """Corners, m, (n, 3)."""
    triangles: NDArray[np.int64]
    """Numbers of the corners of each triangle, counter-clockwise from outside, (k, 3)."""
    error: float
    """Largest distance of the body's surface from the mesh's, m."""


def meridian(shape: tt.Shape, facets: int = FACETS) -> Array:
    """Return points (distance from the axis, height) of a surface, from its lowest to its highest.

    The point that touches a table at the tilt with cosine c is ((h - c h') s, -h' s^2 - h c).
    """
    if isinstance(shape, tt.Ring) and shape.tube == 0.0:
        return np.array([[shape.radius, shape.center]])
    surface = shape.surface
    points = []
    for tilt in np.linspace(POLE, math.pi - POLE, facets // 2 + 1):
        c, s = math.cos(tilt), math.sin(tilt)
        h, slope = float(surface.height(c)), float(surface.slope(c))
        points.append(((h - c * slope) * s, -slope * s * s - h * c))
    return np.array(points)


def revolved(body: tt.Body, facets: int = FACETS) -> ConvexMesh:
    """Return the convex hull of a body's surfaces as a mesh inside it, with its largest error."""
    from scipy.spatial import ConvexHull  # noqa: PLC0415 - slow to import

    outline = np.concatenate([meridian(shape, facets) for shape in body.shapes])
    outline[:, 0] = np.where(
        outline[:, 0] < 10.0 * POLE * np.abs(outline).max(), 0.0, outline[:, 0]
    )
    mirrored = np.concatenate([outline, outline * (-1.0, 1.0)])
    corners = mirrored[ConvexHull(mirrored).vertices]
    outline = corners[corners[:, 0] >= 0.0]
    outline = outline[np.argsort(np.arctan2(outline[:, 0], -outline[:, 1] + outline[:, 1].mean()))]
    points = list[tuple[float, float, float]]()
    rows = list[list[int]]()
    for radius, height in outline:
        if radius == 0.0:
            rows.append([len(points)] * facets)
            points.append((0.0, 0.0, height))
            continue
        rows.append(list(range(len(points), len(points) + facets)))
        for k in range(facets):
            angle = 2.0 * math.pi * k / facets
            points.append((radius * math.cos(angle), radius * math.sin(angle), height))
    triangles = [
        corner
        for low, high in pairwise(rows)
        for k in range(facets)
        for corner in _pair(low, high, k, (k + 1) % facets)
    ]
    for row, order in ((rows[0], (0, 2, 1)), (rows[-1], (0, 1, 2))):
        if row[0] != row[1]:
            fans = ((row[0], row[k], row[k + 1]) for k in range(1, facets - 1))
            triangles += [(fan[order[0]], fan[order[1]], fan[order[2]]) for fan in fans]
    corners = np.array(points)
    return ConvexMesh(corners, np.array(triangles), _error(body, corners, facets))


def _pair(low: list[int], high: list[int], k: int, after: int) -> list[tuple[int, int, int]]:
    """Return the triangles of a facet between two rows; one where a row is a point."""
    triangles = []
    if low[k] != low[after]:
        triangles.append((low[k], low[after], high[k]))
    if high[k] != high[after]:
        triangles.append((low[after], high[after], high[k]))
    return triangles


def _error(body: tt.Body, points: Array, facets: int) -> float:
    """Return the largest difference of the support functions of a body and its mesh, m.

    Between two corners around the axis, and at many tilts, they differ most.
    """
    surfaces = [shape.surface for shape in body.shapes]
    angle = math.pi / facets
    worst = 0.0
    for tilt in np.linspace(0.01, math.pi - 0.01, 733):
        c, s = math.cos(tilt), math.sin(tilt)
        down = np.array([s * math.cos(angle), s * math.sin(angle), -c])
        exact = max(float(surface.height(c)) for surface in surfaces)
        worst = max(worst, exact - float((points @ down).max()))
    return worst
