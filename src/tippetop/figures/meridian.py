"""Meridian of a body as drawings show it: its stated profile, or else the hull of its surfaces."""

import math

import numpy as np

from tippetop.lathe.edges import Edge
from tippetop.lathe.profile import profile_of
from tippetop.mechanics.surfaces.outline import Line, is_outline, outline, smoothly_joined
from tippetop.problem.bodies import Body

ARC_STEP = np.pi / 48
"""Largest angle between neighbouring points on arcs of profiles, rad."""


def meridian(body: Body) -> list[Line]:
    """Return the meridian of a body, from its lowest point up, as smooth polylines (m)."""
    profile = stated_profile(body)
    return outline(body.surface) if profile is None else profile


def stated_profile(body: Body) -> list[Line] | None:
    """Return the meridian of a body's stated profile as smooth polylines (m), from its lowest point
    up.

    None is returned if the body states no profile, or if its surfaces are no longer those of the
    profile: both are fields of a body, and one can be changed without the other.
    """
    if body.profile is None:
        return None
    lines = smoothly_joined([_points(edge) for edge in profile_of(body.profile).edges])
    return lines if is_outline(lines, body.surface) else None


def _points(edge: Edge) -> Line:
    """Return the points of an edge, at most `ARC_STEP` apart along arcs."""
    steps = max(1, math.ceil(abs(edge.turn) / ARC_STEP - 1e-9))
    points = edge.points(np.linspace(0.0, 1.0, steps + 1))
    return [(point.real, point.imag) for point in points.tolist()]
