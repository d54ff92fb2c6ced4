"""Turned bodies as triangles, closed and seen from outside anticlockwise."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tippetop.errors import InvalidInput
from tippetop.lathe.profile import Profile
from tippetop.lathe.workpiece import Workpiece


class Solid(NamedTuple):
    """A body, or one of the weights in it, without what is let into it."""

    name: str
    """What it is called."""
    points: NDArray[np.float64]
    """Corners, m, shape (n, 3)."""
    triangles: NDArray[np.int64]
    """Numbers of corners, shape (m, 3): the surface outside, and those of the hollows."""


def solids(piece: Workpiece, facets: int) -> list[Solid]:
    """The body, and then the weights in it, each with the hollows that the others leave.

    There are so many facets around the axis, and around a circle of the profile. Raises `InvalidInput` if an
    insert touches the surface of the body or another insert.
    """
    for number, inner in enumerate(piece.insides):
        if any("on" in inner.sides(other) for other in (piece.outline, *piece.insides[:number])):
            field = f"inserts.{number}.profile"
            raise InvalidInput(
                field, "an insert that touches a surface", "for a solid, one inside another part"
            )
    shells = [_shell(profile, facets) for profile in (piece.outline, *piece.insides)]
    around = [0 if outer is None else outer + 1 for outer in piece.around]
    found = []
    for number, shell in enumerate(shells):
        if number == 0 or piece.inserts[number - 1].density:
            hollows = [shells[k + 1] for k, outer in enumerate(around) if outer == number]
            name = f"insert {number}" if number else "body"
            found.append(Solid(name, *_joined([shell, *((p, t[:, ::-1]) for p, t in hollows)])))
    return found


Shell = tuple[NDArray[np.float64], NDArray[np.int64]]


def _shell(profile: Profile, facets: int) -> Shell:
    """The surface that a profile sweeps out; points on the axis are one corner each."""
    shares = [
        np.arange(steps) / steps
        for edge in profile.edges
        for steps in [math.ceil(abs(edge.turn) / math.tau * facets) or 1]
    ]
    line = np.concatenate([edge.points(share) for edge, share in zip(profile.edges, shares, strict=True)])
    closed = profile.edges[0].start == profile.edges[-1].end
    line = line if closed else np.append(line, profile.edges[-1].end)
    turn = np.exp(2j * np.pi * np.arange(facets) / facets)
    corners, points, count = [], [], 0
    for point in line:
        around = point.real * (turn if point.real else turn[:1])
        points.append(np.stack([around.real, around.imag, np.full(len(around), point.imag)], axis=1))
        corners.append(count + np.arange(facets) % len(around))
        count += len(around)
    rows = corners + corners[:1] * closed
    below, above = np.concatenate(rows[:-1]), np.concatenate(rows[1:])
    nexts = np.concatenate([np.roll(row, -1) for row in rows]).reshape(len(rows), facets)
    right_below, right_above = nexts[:-1].ravel(), nexts[1:].ravel()
    triangles = np.concatenate(
        [np.stack([below, right_below, right_above], axis=1), np.stack([below, right_above, above], axis=1)]
    )
    a, b, c = triangles.T
    return np.concatenate(points), triangles[(a != b) & (b != c) & (c != a)]


def _joined(shells: list[Shell]) -> Shell:
    starts = np.cumsum([0, *(len(points) for points, _ in shells)])
    triangles = [start + corners for start, (_, corners) in zip(starts, shells, strict=False)]
    return np.concatenate([points for points, _ in shells]), np.concatenate(triangles)
