"""The toy as it is drawn: solids of revolution about the body's axis, with a pattern that shows the spin.

All is in metres, in the frame of the body: origin at the centre of mass, z along the axis. The model's sphere
is whole; the toy is that sphere cut by a flat face, with a stem that reaches just as far as the sphere would.
What is cut away is drawn as glass, so that one sees what touches the table when the toy lies on its face.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from matplotlib.colors import to_rgb
from numpy.typing import NDArray

from tippetop.figures.style import CONVERGED, REPORT
from tippetop.figures.toy import FACE
from tippetop.problem import Body, EccentricSphere

Array = NDArray[np.float64]

SEGMENTS = 48
"""Facets around the axis; every pattern divides it."""

_STEM, _KNOB = 0.12, 0.165
_ROUNDING = 0.04
_WOOD, _CREAM, _PALE = "#D9AE78", "#F4E7CF", "#66C5F0"
_BOWL = (CONVERGED, CONVERGED, _PALE) * 2
_BAND = (_CREAM, _CREAM, _CREAM, _CREAM, REPORT, REPORT)
_FACE = (_CREAM, _CREAM, "#E4D2AE")
_CRYSTAL = ("#BFD8EA",)


@dataclass(frozen=True)
class Part:
    """A surface of revolution.

    Attributes
    ----------
    name
        What it is of the toy.
    profile
        Points (distance from the axis, height along it), m, in order from below, shape (k, 2).
    colours
        Colours of equal sectors around the axis, as #rrggbb.
    opacity
        1 for solid, less for glass.
    """

    name: str
    profile: Array
    colours: tuple[str, ...]
    opacity: float = 1.0


@dataclass(frozen=True)
class Mesh:
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


def toy_parts(body: Body) -> tuple[Part, ...]:
    """The parts of the toy for this body: of a tippe top, or the one part of an egg."""
    shape = body.shape
    if isinstance(shape, EccentricSphere):
        return _tippe_top(shape.radius, shape.eccentricity)
    across, along = shape.across, shape.along
    belts = (-np.pi / 2, -0.12, 0.12, np.pi / 2)
    colours = (_BOWL, _BAND, _BOWL)
    return tuple(
        Part(f"egg {number}", _arc(low, high) * (across, along), colours[number])
        for number, (low, high) in enumerate(pairwise(belts))
    )


def reach(body: Body) -> float:
    """The largest distance of the toy's surface from the centre of mass, m."""
    return float(max(np.hypot(*part.profile.T).max() for part in toy_parts(body)))


def size(body: Body) -> float:
    """The length by which the toy is measured when it is drawn, m."""
    shape = body.shape
    return shape.radius if isinstance(shape, EccentricSphere) else max(shape.across, shape.along)


def _tippe_top(radius: float, eccentricity: float) -> tuple[Part, ...]:
    edge = float(np.arcsin(FACE))
    low, high = edge - 0.30, edge - 0.18
    face_radius = float(np.cos(edge))
    rim = [(face_radius, FACE), (face_radius - _ROUNDING, FACE + _ROUNDING / 3)]
    face = [rim[-1], (_STEM * 1.6, FACE + _ROUNDING / 3), (_STEM, FACE + 0.05)]
    knob = 1.0 - _KNOB
    swell = [
        (_STEM + (_KNOB - _STEM) * u**2, FACE + 0.05 + (knob - FACE - 0.05) * u) for u in np.linspace(0, 1, 9)
    ]
    cap = _arc(0.0, np.pi / 2, 9) * _KNOB + (0.0, knob)
    stem = np.concatenate([swell, cap[1:]])
    parts = (
        Part("bowl", _arc(-np.pi / 2, low, 22), _BOWL),
        Part("band", _arc(low, high, 4), _BAND),
        Part("collar", _arc(high, edge, 4), _BOWL),
        Part("rim", np.array(rim), (_CREAM,)),
        Part("face", np.array(face), _FACE),
        Part("stem", stem, (_WOOD, "#C79A62")),
        Part("glass", _arc(edge, np.pi / 2, 16), _CRYSTAL, opacity=0.16),
    )
    shift = (0.0, eccentricity)
    return tuple(
        Part(part.name, (part.profile + shift) * radius, part.colours, part.opacity) for part in parts
    )


def _arc(low: float, high: float, points: int = 16) -> Array:
    """Points of the unit circle between two latitudes; exactly on the axis at the poles."""
    latitude = np.linspace(low, high, points)
    away = np.where(np.isclose(np.abs(latitude), np.pi / 2), 0.0, np.cos(latitude))
    return np.stack([away, np.sin(latitude)], axis=1)


def lathe(part: Part, segments: int = SEGMENTS) -> Mesh:
    """The triangles of a part, with edges where its colours meet."""
    tangent = np.gradient(part.profile, axis=0)
    normal = np.stack([tangent[:, 1], -tangent[:, 0]], axis=1)
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    steps = segments // len(part.colours)
    meshes = []
    for number, colour in enumerate(part.colours):
        turn = 2 * np.pi * (number + np.linspace(0, 1, steps + 1)) / len(part.colours)
        meshes.append(_strip(part.profile, normal, turn, _linear(colour)))
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


def _linear(colour: str) -> Array:
    """Linear RGB of an sRGB colour."""
    value = np.array(to_rgb(colour))
    return np.where(value <= 0.04045, value / 12.92, ((value + 0.055) / 1.055) ** 2.4)
