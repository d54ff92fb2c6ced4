"""Appearance of the toy and its table, shared by figures, films, models and the page's player.

Lengths are in sizes of the toy: the radius of a tippe top's sphere, or half the height or the width
of any other body, which is drawn by its meridian.

A tippe top that states nothing but its sphere is drawn as a sphere cut by a flat face, with a stem
that reaches as far as the sphere does. The part that is cut away is drawn as glass, so that one
sees what touches the table when the toy lies on its face.
"""

import json
from collections.abc import Mapping
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tippetop.figures.meridian import ARC_STEP, meridian, stated_profile
from tippetop.figures.style import ACCENT, CONVERGED, REPORT
from tippetop.mechanics.surfaces.outline import extent
from tippetop.problem.bodies import Body
from tippetop.problem.shapes import EccentricSphere

Array = NDArray[np.float64]

FACE = 0.42
"""Distance from the sphere's centre to the flat face, along the axis, in radii."""
STEM, KNOB = 0.12, 0.165
"""Radii of the stem at the face, and of the ball at the stem's end."""
STEM_TOP = 1.0 - KNOB
"""Distance from the sphere's centre to the centre of the ball at the stem's end."""

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
"""Colours and brightness of the surroundings of the toy, by theme."""

_PALE, _CREAM, _SAND, _WOOD = "#66C5F0", "#F4E7CF", "#E4D2AE", ("#D9AE78", "#C79A62")
_BOWL = (*(CONVERGED,) * 5, _PALE)
_BAND = (*(_CREAM,) * 5, REPORT)
# One mark a turn: with several, a top seems to turn backwards at a fraction of the speed.


class ToyPart(NamedTuple):
    """Surface of revolution of the toy, with its colours."""

    name: str
    """Name of the part."""
    profile: Array
    """Points (distance from the axis, height along it from the centre of mass), from below, shape
    (k, 2).
    """
    colours: tuple[str, ...]
    """Colours of equal sectors around the axis, as #rrggbb."""
    opacity: float = 1.0
    """1 for solid, less for glass."""

    def plain(self) -> dict[str, Any]:
        """Return the part as plain numbers and texts."""
        return self._replace(profile=self.profile.round(9).tolist())._asdict()


BAND = 4
"""Half the width of the coloured band around a smooth outline, in points of the outline."""


def size(body: Body) -> float:
    """Return the length (m) that is the unit of a body's toy."""
    ball = _plain_ball(body)
    return ball.radius if ball else extent(meridian(body))


def toy_parts(body: Body) -> tuple[ToyPart, ...]:
    """Return the parts of a body's toy: the parts of a tippe top, or belts of the body's
    meridian.
    """
    ball = _plain_ball(body)
    if ball:
        return _tippe_top(ball.eccentricity)
    lines = meridian(body)
    belts = [np.array(line) / extent(lines) for line in lines]
    if len(belts) == 1:
        middle, last = len(belts[0]) // 2, len(belts[0]) - 1
        belts = [belts[0][i : j + 1] for i, j in pairwise((0, middle - BAND, middle + BAND, last))]
    return tuple(
        ToyPart(f"belt {number}", belt, _BAND if number % 2 else _BOWL)
        for number, belt in enumerate(belts)
    )


def _plain_ball(body: Body) -> EccentricSphere | None:
    """Return the sphere of a body that states nothing but its sphere, else None."""
    return (
        body.shape
        if isinstance(body.shape, EccentricSphere) and stated_profile(body) is None
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
    """Return the JSON text from which the page draws toys: scenes, a tippe top, colours, rules."""
    parts = [part.plain() for part in _tippe_top(0.0)]
    rules = {"arc_step": ARC_STEP, "band": BAND}
    data = {"scenes": SCENES, "tippe_top": parts, "bowl": _BOWL, "band": _BAND, "meridian": rules}
    return json.dumps(data) + "\n"


def _arc(low: float, high: float, points: int = 16) -> Array:
    """Return points of the unit circle between two latitudes, exactly on the axis at the poles."""
    latitude = np.linspace(low, high, points)
    away = np.where(np.isclose(np.abs(latitude), np.pi / 2), 0.0, np.cos(latitude))
    return np.stack([away, np.sin(latitude)], axis=1)
