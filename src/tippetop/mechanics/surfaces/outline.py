"""Outlines of bodies as lines of points: of their profile, or of the hull of their surfaces."""

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import TypeAlias

from tippetop.mechanics.surfaces.hull import lowest_surface, outer_height
from tippetop.mechanics.surfaces.surface import Surface

Line: TypeAlias = list[tuple[float, float]]
"""Points (distance from the axis, height along it from the centre of mass), m."""

SMOOTH = 0.15
"""Angle at a corner, rad, from which on it is drawn as one: more than between the chords of an arc.
"""

FITS = 0.03
"""How far a profile may be from where the body touches the table, in sizes of it, to be the body's.
"""

TILTS = 61
"""Tilts at which this is looked at."""

OUTLINE = 97
"""Tilts at which the hull of surfaces is lines."""

POLE_TILT = 1e-4
"""The least of them, where the body does not lie flat yet."""


def extent(lines: Sequence[Line]) -> float:
    """Return the size of an outline: its largest distance from the axis, or half its height, m."""
    points = [point for line in lines for point in line]
    across, heights = max([r for r, _ in points]), [z for _, z in points]
    return max(across, (max(heights) - min(heights)) / 2.0)


def is_outline(lines: Sequence[Line], surface: Surface) -> bool:
    """Return whether a body with these surfaces has this outline: it reaches as far down, whatever
    the tilt.
    """
    points, within = [point for line in lines for point in line], FITS * extent(lines)
    for number in range(TILTS):
        tilt = math.pi * number / (TILTS - 1)
        sine, c = math.sin(tilt), math.cos(tilt)
        if abs(max([r * sine - z * c for r, z in points]) - outer_height(surface, c)) > within:
            return False
    return True


def smoothly_joined(edges: Sequence[Line]) -> list[Line]:
    """Return edges that follow one another, joined to lines where they turn by less than SMOOTH."""
    lines = list[Line]()
    for edge in edges:
        if lines and _turn(lines[-1], edge) < SMOOTH:
            lines[-1] = [*lines[-1], *edge[1:]]
        else:
            lines.append(edge)
    return lines


def _turn(before: Line, after: Line) -> float:
    """Return the angle between the end of a line and the beginning of the next."""
    (a, b), (c, d) = before[-2], before[-1]
    (e, f), (g, h) = after[0], after[1]
    x, y, u, v = c - a, d - b, g - e, h - f
    return abs(math.atan2(x * v - y * u, x * u + y * v))


def outline(surface: Surface) -> list[Line]:
    """Return the hull of a body's surfaces from below, in smooth arcs and the straight lines
    between them.

    Where the body touches the table at evenly spaced tilts, and, on its faces, between.
    """
    arcs, last, corner = list[Line](), surface, 10.0 * POLE_TILT * surface.size
    for number in range(OUTLINE):
        tilt = min(max(math.pi * number / (OUTLINE - 1), POLE_TILT), math.pi - POLE_TILT)
        c = math.cos(tilt)
        lowest = lowest_surface(surface, c)
        if not arcs or lowest != last:
            arcs.append([])
        last, slope = lowest, lowest.slope(c)
        across = lowest.height(c) - c * slope
        r, z = math.sin(tilt) * across, -slope - c * across
        point = (0.0 if abs(r) < corner else r, z)
        if not arcs[-1] or math.dist(point, arcs[-1][-1]) > corner:
            arcs[-1].append(point)
    begin, end = arcs[0][0], arcs[-1][-1]
    if begin[0] != 0.0:
        arcs = [[(0.0, begin[1])], *arcs]
    if end[0] != 0.0:
        arcs.append([(0.0, end[1])])
    lines = arcs[:1]
    for before, arc in pairwise(arcs):
        lines += [[before[-1], arc[0]], arc]
    lines = [line for line in lines if len(line) > 1]
    # A tip alone says nothing of the body above it: a cone stands for that.
    return lines if lines else _cone(surface)


def _cone(surface: Surface) -> list[Line]:
    """Return the outline of a cone from a sharp tip to the centre of mass."""
    tip, rim = -surface.height(1.0), 0.5 * surface.size
    points = [(0.0, tip), (rim, 0.0), (0.0, 0.0)]
    ordered = points if tip < 0.0 else points[::-1]
    return [[ordered[0], ordered[1]], [ordered[1], ordered[2]]]
