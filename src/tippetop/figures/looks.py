"""What the toy and its table look like: read by figures, films, models and, as data, by the player.

Lengths are in sizes of the toy: radii of a tippe top's sphere, or half the height or the width of
any other body, which is drawn by its outline. Of a tippe top that is known as a sphere only, this
sphere is whole; the toy is that sphere cut by a flat face, with a stem that reaches just as far as
the sphere would. What is cut away is drawn as glass: so one sees what touches the table when the
toy lies on its face.
"""

import json
from collections.abc import Mapping
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tippetop.figures.meridian import ARC_STEP, meridian, own_profile
from tippetop.figures.style import ACCENT, CONVERGED, REPORT
from tippetop.mechanics.outline import extent
from tippetop.problem.bodies import Body
from tippetop.problem.shapes import EccentricSphere

Array = NDArray[np.float64]

FACE = 0.42
"""Distance from the sphere's centre to the flat face, along the axis."""
STEM, KNOB = 0.12, 0.165
"""Radii of the stem where it leaves the face, and of the ball at its end."""
STEM_TOP = 1.0 - KNOB
"""Distance from the sphere's centre to that ball's."""

SCENES: Mapping[str, Mapping[str, Any]] = {
    "light": {
        "background": "#eef1f4",
        "table": "#e3d9c8",
        "line": "#b7a98f",
        "ruler": "#f3d27a",
        "trace": ACCENT,
        "sky": "#ffffff",
        "ground": "#e5d9c4",
        "sun": 2.4,
        "ambient": 1.7,
    },
    "dark": {
        "background": "#14181d",
        "table": "#3b3832",
        "line": "#5f594e",
        "ruler": "#c9a84f",
        "trace": "#ff6fa5",
        "sky": "#c4d3e6",
        "ground": "#5a4d3d",
        "sun": 2.3,
        "ambient": 1.4,
    },
}
"""The colours around the toy, and how bright it is there, by the theme."""

_PALE, _CREAM, _SAND, _WOOD = "#66C5F0", "#F4E7CF", "#E4D2AE", ("#D9AE78", "#C79A62")
_BOWL = (CONVERGED, CONVERGED, _PALE) * 2
_BAND = (_CREAM, _CREAM, _CREAM, _CREAM, REPORT, REPORT)


class ToyPart(NamedTuple):
    """A surface of revolution."""

    name: str
    """What it is of the toy."""
    profile: Array
    """Points (distance from the axis, height along it from the centre of mass), from below, shape
    (k, 2).
    """
    colours: tuple[str, ...]
    """Colours of equal sectors around the axis, as #rrggbb."""
    opacity: float = 1.0
    """1 for solid, less for glass."""

    def plain(self) -> dict[str, Any]:
        """It as plain numbers and words."""
        return self._replace(profile=self.profile.round(9).tolist())._asdict()


BAND = 4
"""Half the width of the band around an outline without corners, in points of it."""


def size(body: Body) -> float:
    """The length by which the toy is measured when it is drawn, m."""
    ball = _plain_ball(body)
    return ball.radius if ball else extent(meridian(body))


def toy_parts(body: Body) -> tuple[ToyPart, ...]:
    """The parts of the toy for this body: of a tippe top, or the belts of any other body's
    outline.
    """
    ball = _plain_ball(body)
    if ball:
        return _tippe_top(ball.eccentricity)
    lines = meridian(body)
    pieces = [np.array(line) / extent(lines) for line in lines]
    if len(pieces) == 1:
        middle, last = len(pieces[0]) // 2, len(pieces[0]) - 1
        pieces = [
            pieces[0][i : j + 1] for i, j in pairwise((0, middle - BAND, middle + BAND, last))
        ]
    return tuple(
        ToyPart(f"belt {number}", piece, _BAND if number % 2 else _BOWL)
        for number, piece in enumerate(pieces)
    )


def _plain_ball(body: Body) -> EccentricSphere | None:
    """The sphere of a body of which nothing else is known."""
    return (
        body.shape
        if isinstance(body.shape, EccentricSphere) and own_profile(body) is None
        else None
    )


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
    """What the page draws toys from, its `looks.json`: scenes, a tippe top, the colours of belts,
    rules.
    """
    parts = [part.plain() for part in _tippe_top(0.0)]
    rules = {"arc_step": ARC_STEP, "band": BAND}
    told = {"scenes": SCENES, "tippe_top": parts, "bowl": _BOWL, "band": _BAND, "meridian": rules}
    return json.dumps(told) + "\n"


def _arc(low: float, high: float, points: int = 16) -> Array:
    """Points of the unit circle between two latitudes; exactly on the axis at the poles."""
    latitude = np.linspace(low, high, points)
    away = np.where(np.isclose(np.abs(latitude), np.pi / 2), 0.0, np.cos(latitude))
    return np.stack([away, np.sin(latitude)], axis=1)
