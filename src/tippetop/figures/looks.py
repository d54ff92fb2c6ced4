"""What the toy and its table look like: read by figures, films, models and, as data, by the player.

Lengths are in sizes of the toy: radii of a tippe top's sphere, or the longer semi-axis of an egg. The model's
sphere is whole; the toy is that sphere cut by a flat face, with a stem that reaches just as far as the sphere
would. What is cut away is drawn as glass: so one sees what touches the table when the toy lies on its face.
"""

from collections.abc import Mapping
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tippetop.bodies import Body, EccentricSphere, Shape, Spheroid
from tippetop.figures.style import ACCENT, CONVERGED, REPORT

Array = NDArray[np.float64]

FACE = 0.42
"""Distance from the sphere's centre to the flat face, along the axis."""
STEM, KNOB = 0.12, 0.165
"""Radii of the stem where it leaves the face, and of the ball at its end."""
STEM_TOP = 1.0 - KNOB
"""Distance from the sphere's centre to that ball's."""

OUTLINE = 49
"""Points on the outline of a body that is no tippe top."""

SCENES: Mapping[str, Mapping[str, Any]] = {
    "light": {
        "background": "#eef1f4", "table": "#e3d9c8", "line": "#b7a98f", "ruler": "#f3d27a",
        "trace": ACCENT, "sky": "#ffffff", "ground": "#e5d9c4", "sun": 2.4, "ambient": 1.7,
    },
    "dark": {
        "background": "#14181d", "table": "#3b3832", "line": "#5f594e", "ruler": "#c9a84f",
        "trace": "#ff6fa5", "sky": "#c4d3e6", "ground": "#5a4d3d", "sun": 2.3, "ambient": 1.4,
    },
}  # fmt: skip
"""The colours around the toy, and how bright it is there, by the theme."""

_PALE, _CREAM, _SAND, _WOOD = "#66C5F0", "#F4E7CF", "#E4D2AE", ("#D9AE78", "#C79A62")
_BOWL = (CONVERGED, CONVERGED, _PALE) * 2
_BAND = (_CREAM, _CREAM, _CREAM, _CREAM, REPORT, REPORT)


class ToyPart(NamedTuple):
    """A surface of revolution.

    Attributes
    ----------
    name
        What it is of the toy.
    profile
        Points (distance from the axis, height along it from the centre of mass), from below, shape (k, 2).
    colours
        Colours of equal sectors around the axis, as #rrggbb.
    opacity
        1 for solid, less for glass.
    """

    name: str
    profile: Array
    colours: tuple[str, ...]
    opacity: float = 1.0


def size(body: Body) -> float:
    """The length by which the toy is measured when it is drawn, m."""
    shape = body.shape
    if isinstance(shape, EccentricSphere):
        return shape.radius
    points = outline(shape)
    return float(max(points[:, 0].max(), np.ptp(points[:, 1]) / 2))


def outline(shape: Shape) -> Array:
    """Points (distance from the axis, height along it from the centre of mass), m, from below, shape (k, 2).

    They are where the body touches the table at evenly spaced tilts.
    """
    tilts = np.linspace(0.0, np.pi, OUTLINE)
    sine, c = np.sin(tilts), np.cos(tilts)
    sine[-1] = 0.0
    slope = shape.surface.slope(c)
    across = shape.surface.height(c) - c * slope
    return np.stack([sine * across, -slope - c * across], axis=1)


def toy_parts(body: Body) -> tuple[ToyPart, ...]:
    """The parts of the toy for this body: of a tippe top, or the belts of an egg or of any other."""
    shape = body.shape
    if isinstance(shape, EccentricSphere):
        return _tippe_top(shape.eccentricity)
    if isinstance(shape, Spheroid):
        semi_axes = np.array([shape.across, shape.along]) / size(body)
        arcs = [_arc(*ends) * semi_axes for ends in pairwise((-np.pi / 2, -0.12, 0.12, np.pi / 2))]
    else:
        points = outline(shape) / size(body)
        middle = OUTLINE // 2
        arcs = [points[: middle - 1], points[middle - 2 : middle + 3], points[middle + 2 :]]
    belts = enumerate(zip(arcs, (_BOWL, _BAND, _BOWL), strict=True))
    return tuple(ToyPart(f"egg {number}", arc, colours) for number, (arc, colours) in belts)


def _tippe_top(eccentricity: float) -> tuple[ToyPart, ...]:
    edge = float(np.arcsin(FACE))
    rim = float(np.cos(edge)) - 0.04
    knob = _arc(0.0, np.pi / 2, 9) * KNOB + (0.0, STEM_TOP)
    parts = (
        ToyPart("stem", np.array([(STEM, FACE), *knob]), _WOOD),
        ToyPart("bowl", _arc(-np.pi / 2, edge - 0.30, 22), _BOWL),
        ToyPart("band", _arc(edge - 0.30, edge - 0.18, 4), _BAND),
        ToyPart("collar", _arc(edge - 0.18, edge, 4), _BOWL),
        ToyPart("rim", np.array([(np.cos(edge), FACE), (rim, FACE)]), (_CREAM,)),
        ToyPart("face", np.array([(rim, FACE), (STEM, FACE)]), (_CREAM, _CREAM, _SAND)),
        ToyPart("glass", _arc(edge, np.pi / 2), ("#BFD8EA",), opacity=0.16),
    )
    shift = np.array([0.0, eccentricity])
    return tuple(part._replace(profile=part.profile + shift) for part in parts)


def _arc(low: float, high: float, points: int = 16) -> Array:
    """Points of the unit circle between two latitudes; exactly on the axis at the poles."""
    latitude = np.linspace(low, high, points)
    away = np.where(np.isclose(np.abs(latitude), np.pi / 2), 0.0, np.cos(latitude))
    return np.stack([away, np.sin(latitude)], axis=1)
