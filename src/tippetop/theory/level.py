"""Level spins: bodies with a horizontal axis, as an egg on its side or hurricane balls on both.

An egg that lies on its waist and turns about the vertical at the rate Omega is in a steady state at
any Omega. Slip that creeps makes it rise where the branch of steady precessions reaches the
horizontal, which with the support function h(c) is at

    Omega^2 = m g h'' / (I3 (1 + h'' / h) - I1),      at c = 0.

For a spheroid h'' = (along^2 - across^2) / across (Moffatt and Shimomura, Nature 416 (2002) 385,
have this rate in the limit of small friction).

A body that lies on two of its surfaces rolls on both up to the rate at which one of them carries
the weight with the centre of mass at rest: beyond that rate the second surface lifts off (for
hurricane balls of radius R, Omega^2 = 5 g / (2 R)).
"""

import math
from typing import NamedTuple

from tippetop.mechanics.surfaces.hull import Hull, outer_height
from tippetop.mechanics.top import Top
from tippetop.theory.prediction import touching_tilts
from tippetop.theory.resting_center import resting_center_on
from tippetop.theory.steady import has_level_spin

LIFT = 1e-4
"""Tilt, rad, by which a surface is lifted to find whether the body then rolls faster: far above
rounding, and far below the tilts over which the rate turns back.
"""


class Lying(NamedTuple):
    """How a body lies, and the least rate about the vertical at which it rises from that."""

    tilt: float
    """theta, rad."""
    surfaces: tuple[int, ...]
    """Numbers of the surfaces that it lies on: its waist on one, or two."""
    rate: float
    """Least rate at which it rises, or lifts one of the two surfaces, rad/s; inf if there is
    none.
    """


def lying(top: Top, tilt: float) -> Lying | None:
    """Return how a body lies at the tilt nearest to `tilt`, rad; None if it does not lie.

    A body of several surfaces lies on the active one and another, at the nearest tilt where both
    touch, if the centre of mass is between the contact points.
    """
    if not isinstance(top.surface, Hull):
        return Lying(math.pi / 2, (0,), rising_rate(top)) if has_level_spin(top) else None
    ends = touching_tilts(top.surface, tilt)
    for at in sorted(ends, key=lambda at: abs(at - tilt)):
        second = top.body.contacts[ends[at]]
        if top.surface.slope(math.cos(at)) * second.surface.slope(math.cos(at)) < 0.0:
            surfaces = tuple(sorted((top.number, second.number)))
            return Lying(at, surfaces, lifting_rate(at, top))
    return None


def rising_rate(top: Top) -> float:
    """Return the least rate, rad/s, at which a body on its waist rises while slip creeps.

    The result is inf where a level spin is stable at any rate, or unstable at any.
    """
    height, bend = float(top.surface.height(0.0)), float(top.surface.curvature(0.0))
    support = top.mass * top.gravity * bend
    reaction = top.axial_inertia * (1.0 + bend / height) - top.transverse_inertia
    return math.sqrt(support / reaction) if support > 0.0 and reaction > 0.0 else math.inf


def lifting_rate(tilt: float, top: Top) -> float:
    """Return the least rate, rad/s, at which one of two surfaces carries a rolling body alone.

    `tilt`, rad, is that at which both touch, and `top` has the surface active that stays. The
    result is inf if the body rolls more slowly the farther the second surface is lifted.
    """
    rolling = resting_center_on(tilt, top)

    def reach(at: float) -> float:
        return float(top.surface.height(math.cos(at)) - outer_height(top.surface, math.cos(at)))

    lifted = max((tilt - LIFT, tilt + LIFT), key=reach)
    farther = resting_center_on(lifted, top)
    if rolling is None or farther is None or farther.precession < rolling.precession:
        return math.inf
    return rolling.precession
