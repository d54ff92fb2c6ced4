"""The outline of a body as it is drawn: its own profile where it has one, else the hull of its surfaces.

The page in the browser finds the same (`web/src/run/looks.js`).
"""

import math

import numpy as np
from numpy.typing import NDArray

from tippetop.bodies import Body
from tippetop.lathe.profile import Profile, profile_of
from tippetop.lowest import lowest_number
from tippetop.mechanics.hull import each_surface, outer_height
from tippetop.mechanics.surface import Surface

Array = NDArray[np.float64]

ARC_STEP = np.pi / 48
"""Angle between points on arcs of profiles, rad, at most."""

SMOOTH = 0.15
"""Angle at a corner, rad, from which on it is drawn as one: more than between the chords of an arc."""

FITS = 0.03
"""How far a profile may be from where the body touches the table, in sizes of it, to be the body's."""

TILTS = 61
"""Tilts at which this is looked at."""

OUTLINE = 97
"""Tilts at which the hull of surfaces is found."""

POLE = 1e-4
"""The least of them, where the body does not lie flat yet."""


def meridian(body: Body) -> list[Array]:
    """The outline of a body from below, in smooth pieces.

    Points (distance from the axis, height along it from the centre of mass), m, shape (k, 2).
    """
    shown = own_profile(body)
    return outline(body.surface) if shown is None else shown


def own_profile(body: Body) -> list[Array] | None:
    """The profile that a body has, in smooth pieces from below; None if it has none, or not this shape.

    It may have another one by now: the profile is stated beside the surfaces.
    """
    if body.profile is None:
        return None
    pieces = _smooth_pieces(profile_of(body.profile))
    points = np.concatenate(pieces)
    for tilt in np.linspace(0.0, math.pi, TILTS).tolist():
        reach = (points @ (math.sin(tilt), -math.cos(tilt))).max()
        if abs(reach - outer_height(body.surface, math.cos(tilt))) > FITS * extent(pieces):
            return None
    return pieces


def extent(pieces: list[Array]) -> float:
    """The size of an outline: its largest distance from the axis, or half its height, m."""
    points = np.concatenate(pieces)
    return float(max(points[:, 0].max(), np.ptp(points[:, 1]) / 2))


def _smooth_pieces(profile: Profile) -> list[Array]:
    pieces: list[Array] = []
    for edge in profile.edges:
        steps = max(1, math.ceil(abs(edge.turn) / ARC_STEP - 1e-9))
        points = edge.points(np.linspace(0.0, 1.0, steps + 1))
        piece = np.stack([points.real, points.imag], axis=1)
        if pieces and _turn(pieces[-1], piece) < SMOOTH:
            pieces[-1] = np.concatenate([pieces[-1], piece[1:]])
        else:
            pieces.append(piece)
    return pieces


def _turn(before: Array, after: Array) -> float:
    """The angle between the end of a piece and the beginning of the next, rad."""
    (x, y), (u, v) = before[-1] - before[-2], after[1] - after[0]
    return abs(math.atan2(x * v - y * u, x * u + y * v))


def outline(surface: Surface) -> list[Array]:
    """The hull of a body's surfaces from below, in smooth arcs and the straight lines between them.

    Points as of a `meridian`: where the body touches the table at evenly spaced tilts, and, on its faces,
    between.
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
