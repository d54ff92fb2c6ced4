"""What the toy and its table look like: read by figures, films, models and, as data, by the player.

Lengths are in sizes of the toy: radii of a tippe top's sphere, or the longer semi-axis of an egg. The model's
sphere is whole; the toy is that sphere cut by a flat face, with a stem that reaches just as far as the sphere
would. What is cut away is drawn as glass: so one sees what touches the table when the toy lies on its face.
"""

import json
from collections.abc import Mapping
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tippetop.bodies import Body, EccentricSphere, Spheroid
from tippetop.figures.style import ACCENT, CONVERGED, REPORT
from tippetop.lowest import lowest_number
from tippetop.mechanics.hull import each_surface
from tippetop.mechanics.surface import Surface

Array = NDArray[np.float64]

FACE = 0.42
"""Distance from the sphere's centre to the flat face, along the axis."""
STEM, KNOB = 0.12, 0.165
"""Radii of the stem where it leaves the face, and of the ball at its end."""
STEM_TOP = 1.0 - KNOB
"""Distance from the sphere's centre to that ball's."""

OUTLINE = 97
"""Tilts at which the outline of a body that is no tippe top is found."""

POLE = 1e-4
"""The least of them, where the body does not lie flat yet."""

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
    if isinstance(body.shape, EccentricSphere):
        return body.shape.radius
    points = np.concatenate(outline(body.surface))
    return float(max(points[:, 0].max(), np.ptp(points[:, 1]) / 2))


def outline(surface: Surface) -> list[Array]:
    """The outline of a body from below, in smooth arcs and the straight lines between them.

    Points (distance from the axis, height along it from the centre of mass), m, shape (k, 2): where the body
    touches the table at evenly spaced tilts, and, on its faces, between.
    """
    tilts = np.linspace(0.0, np.pi, OUTLINE)
    tilts[[0, -1]] = POLE, np.pi - POLE
    sine, c = np.sin(tilts), np.cos(tilts)
    number, corner = lowest_number(surface, c), 10.0 * POLE * surface.size
    surfaces, pieces = each_surface(surface), []
    for some in np.split(np.arange(OUTLINE), np.flatnonzero(np.diff(number)) + 1):
        here = surfaces[number[some[0]]]
        slope = here.slope(c[some])
        across = here.height(c[some]) - c[some] * slope
        points = np.stack([sine[some] * across, -slope - c[some] * across], axis=1)
        points[np.abs(points[:, 0]) < corner, 0] = 0.0
        apart = np.hypot(*np.diff(points, axis=0).T) > corner
        pieces.append(points[np.append(True, apart)])
    first, last = pieces[0][0], pieces[-1][-1]
    ends = [[(0.0, first[1])] if first[0] else [], [(0.0, last[1])] if last[0] else []]
    corners = [np.array(end).reshape(-1, 2) for end in ends]
    pieces = [piece for piece in (corners[0], *pieces, corners[1]) if len(piece)]
    joined = [pieces[0]]
    for piece in pieces[1:]:
        joined += [np.stack([joined[-1][-1], piece[0]]), piece]
    return [piece for piece in joined if len(piece) > 1]


def toy_parts(body: Body) -> tuple[ToyPart, ...]:
    """The parts of the toy for this body: of a tippe top, or the belts of an egg or of any other."""
    shape = body.shape
    if isinstance(shape, EccentricSphere):
        return _tippe_top(shape.eccentricity)
    if isinstance(shape, Spheroid):
        semi_axes, middle = np.array([shape.across, shape.along]) / size(body), shape.center / size(body)
        latitudes = pairwise((-np.pi / 2, -0.12, 0.12, np.pi / 2))
        arcs = [_arc(*ends) * semi_axes + (0.0, middle) for ends in latitudes]
        belts = list(zip(arcs, (_BOWL, _BAND, _BOWL), strict=True))
    else:
        pieces = [piece / size(body) for piece in outline(body.surface)]
        if len(pieces) == 1:
            middle_one = len(pieces[0]) // 2
            ends = (0, middle_one - 2, middle_one + 2, len(pieces[0]) - 1)
            pieces = [pieces[0][low : high + 1] for low, high in pairwise(ends)]
        belts = [(piece, _BAND if number % 2 else _BOWL) for number, piece in enumerate(pieces)]
    return tuple(ToyPart(f"egg {number}", arc, colours) for number, (arc, colours) in enumerate(belts))


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


def as_json() -> str:
    """What the page draws toys from, its `looks.json`: scenes, a tippe top, the colours of belts."""
    parts = [part._replace(profile=part.profile.round(9).tolist())._asdict() for part in _tippe_top(0.0)]
    return json.dumps({"scenes": SCENES, "tippe_top": parts, "bowl": _BOWL, "band": _BAND}) + "\n"


def _arc(low: float, high: float, points: int = 16) -> Array:
    """Points of the unit circle between two latitudes; exactly on the axis at the poles."""
    latitude = np.linspace(low, high, points)
    away = np.where(np.isclose(np.abs(latitude), np.pi / 2), 0.0, np.cos(latitude))
    return np.stack([away, np.sin(latitude)], axis=1)
