"""The outline of a body as it is drawn: its own profile where it has one, else the hull of its
surfaces.
"""

import math

import numpy as np

from tippetop.lathe.edges import Edge
from tippetop.lathe.profile import profile_of
from tippetop.mechanics.outline import Line, is_outline, outline, smoothly_joined
from tippetop.problem.bodies import Body

ARC_STEP = np.pi / 48
"""Angle between points on arcs of profiles, rad, at most."""


def meridian(body: Body) -> list[Line]:
    """The outline of a body from below, in smooth lines."""
    shown = own_profile(body)
    return outline(body.surface) if shown is None else shown


def own_profile(body: Body) -> list[Line] | None:
    """The profile that a body has, in smooth lines from below; None if it has none, or not this
    shape.

    It may have another one by now: the profile is stated beside the surfaces.
    """
    if body.profile is None:
        return None
    lines = smoothly_joined([_points(edge) for edge in profile_of(body.profile).edges])
    return lines if is_outline(lines, body.surface) else None


def _points(edge: Edge) -> Line:
    steps = max(1, math.ceil(abs(edge.turn) / ARC_STEP - 1e-9))
    points = edge.points(np.linspace(0.0, 1.0, steps + 1))
    return [(point.real, point.imag) for point in points.tolist()]
