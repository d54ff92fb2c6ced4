"""The toy as triangles, with a pattern that shows the spin: in metres, z along the axis."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.colors import to_rgb
from numpy.typing import NDArray

from tippetop.figures.looks import Part

Array = NDArray[np.float64]

SEGMENTS = 48
"""Facets around the axis; every pattern divides it."""


class Mesh(NamedTuple):
    """Triangles with a colour at every corner.

    Attributes
    ----------
    points, normals, colours
        Corners (m), unit normals and linear RGB, each of shape (n, 3).
    triangles
        Numbers of corners, anticlockwise seen from outside, shape (m, 3).
    """

    points: Array
    normals: Array
    colours: Array
    triangles: NDArray[np.uint32]


def lathe(part: Part, unit: float, segments: int = SEGMENTS) -> Mesh:
    """The triangles of a part of a toy whose size is `unit` (m), with edges where its colours meet."""
    tangent = np.gradient(part.profile, axis=0)
    normal = np.stack([tangent[:, 1], -tangent[:, 0]], axis=1)
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    steps = segments // len(part.colours)
    meshes = []
    for number, colour in enumerate(part.colours):
        turn = 2 * np.pi * (number + np.linspace(0, 1, steps + 1)) / len(part.colours)
        meshes.append(_strip(unit * part.profile, normal, turn, linear(colour)))
    return joined(meshes)


def _strip(profile: Array, normal: Array, turn: Array, colour: Array) -> Mesh:
    around = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    rows, columns = len(turn), len(profile)
    points = np.empty((rows, columns, 3))
    points[..., :2] = around[:, None, :] * profile[None, :, :1]
    points[..., 2] = profile[:, 1]
    normals = np.empty_like(points)
    normals[..., :2] = around[:, None, :] * normal[None, :, :1]
    normals[..., 2] = normal[:, 1]
    corner = np.arange(rows * columns).reshape(rows, columns)
    a, b, c, d = (
        corner[i : rows - 1 + i, j : columns - 1 + j].ravel() for i, j in ((0, 0), (1, 0), (1, 1), (0, 1))
    )
    triangles = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    flat = points.reshape(-1, 3)
    sides = flat[triangles[:, 1:]] - flat[triangles[:, :1]]
    whole = np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1) > 1e-9 * np.ptp(flat) ** 2
    colours = np.broadcast_to(colour, flat.shape)
    return Mesh(flat, normals.reshape(-1, 3), np.array(colours), triangles[whole].astype(np.uint32))


def joined(meshes: Sequence[Mesh]) -> Mesh:
    """Several meshes as one."""
    starts = np.cumsum([0, *(len(mesh.points) for mesh in meshes)])
    return Mesh(
        np.concatenate([mesh.points for mesh in meshes]),
        np.concatenate([mesh.normals for mesh in meshes]),
        np.concatenate([mesh.colours for mesh in meshes]),
        np.concatenate(
            [mesh.triangles + np.uint32(start) for mesh, start in zip(meshes, starts, strict=False)]
        ),
    )


def linear(colour: str) -> Array:
    """Linear RGB of an sRGB colour."""
    value = np.array(to_rgb(colour))
    return np.where(value <= 0.04045, value / 12.92, ((value + 0.055) / 1.055) ** 2.4)
