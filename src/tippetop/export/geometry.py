"""Triangles of the toy, with its coloured pattern: in metres, z along the axis."""

from typing import NamedTuple

import numpy as np
from matplotlib.colors import to_rgb
from numpy.typing import NDArray

from tippetop.figures.appearance import ToyPart

Array = NDArray[np.float64]

SEGMENTS = 48
"""Number of facets around the axis: a multiple of the number of sectors of every pattern."""


class Mesh(NamedTuple):
    """Triangles with a normal and a colour at every corner."""

    points: Array
    normals: Array
    colours: Array
    """Corners (m), unit normals and linear RGB, each of shape (n, 3)."""
    triangles: NDArray[np.uint32]
    """Indices of corners, anticlockwise seen from outside, shape (m, 3)."""


def lathe(part: ToyPart, unit: float, segments: int = SEGMENTS) -> Mesh:
    """Return the triangles of a part of a toy whose size is `unit` (m).

    Corners are doubled where the colours of two sectors meet.
    """
    sectors, columns = len(part.colours), len(part.profile)
    steps = segments // sectors
    sector = np.repeat(np.arange(sectors), steps + 1)
    turn = 2 * np.pi / sectors * (sector + np.tile(np.linspace(0, 1, steps + 1), sectors))
    around = np.stack([np.cos(turn), np.sin(turn)], axis=1)

    def turned(curve: Array) -> Array:
        heights = np.broadcast_to(curve[:, 1:], (len(turn), columns, 1))
        return np.concatenate([around[:, None] * curve[:, :1], heights], axis=2).reshape(-1, 3)

    along, up = np.gradient(part.profile, axis=0).T
    normal = np.stack([up, -along], axis=1) / np.hypot(along, up)[:, None]
    points = turned(unit * part.profile)
    corner = np.arange(len(points)).reshape(len(turn), columns)
    begins = np.flatnonzero(np.arange(len(turn)) % (steps + 1) < steps)
    near, far = corner[begins], corner[begins + 1]
    a, b, c, d = (side.ravel() for side in (near[:, :-1], far[:, :-1], far[:, 1:], near[:, 1:]))
    triangles = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    sides = points[triangles[:, 1:]] - points[triangles[:, :1]]
    # Quadrilaterals that end on the axis have one triangle without area.
    areas = np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1)
    has_area = areas > 1e-9 * np.ptp(points) ** 2
    colours = np.repeat(_linear(part.colours)[sector], columns, axis=0)
    return Mesh(points, turned(normal), colours, triangles[has_area].astype(np.uint32))


def _linear(colours: tuple[str, ...]) -> Array:
    """Return linear RGB of sRGB colours, shape (k, 3)."""
    values = np.array([to_rgb(colour) for colour in colours])
    return np.where(values <= 0.04045, values / 12.92, ((values + 0.055) / 1.055) ** 2.4)
