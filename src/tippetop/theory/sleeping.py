"""Gyroscopic thresholds: the spin from which a top-heavy top stands upright.

To first order in p = n_x + i n_y, a body that spins about the vertical with omega_z = w moves as

    A p'' - i G w p' + m g zeta p = 0,

where l is the height of the centre of mass, zeta = r - l its depth below the centre of curvature of
the surface at the contact point, and r the radius of curvature there. On a smooth table A = I1 and
G = I3, because the centre of mass stays at rest. Where the contact rolls without slip, A = I1 +
m l^2 and G = I3 + m l r. With p ~ exp(i nu t), nu is real if

    (G w)^2 + 4 A m g zeta >= 0.

A top-heavy body (zeta < 0) therefore stands, or "sleeps", from w = 2 sqrt(A m g |zeta|) / G on, and
falls at the rate sqrt(-(G w)^2 - 4 A m g zeta) / (2 A) below. For r = 0 this is the textbooks'
threshold of the sleeping top on a fixed point (Goldstein, Classical Mechanics, section 5.7).

Slip that creeps adds a slow instability to this fast one: see `thresholds` and `stability`.
"""

import math
from typing import NamedTuple

from tippetop.mechanics.top import Top
from tippetop.theory.steady import SteadyKind, end_of


class Sleeping(NamedTuple):
    """Gyroscopic threshold of a vertical spin, with the growth rates of a small tilt."""

    spin: float
    """Least axial spin at which the body stands, rad/s; 0 if it stands at any."""
    growth_rate: float
    """Rate at which a small tilt grows at the spin of the launch, 1/s; 0 if it does not grow."""
    growth_rate_at_rest: float
    """Rate at which a small tilt grows without spin, 1/s; 0 if the body stands at any spin."""


def sleeping(kind: SteadyKind, top: Top, spin: float, *, rolls: bool) -> Sleeping:
    """Return the gyroscopic threshold of a vertical spin, and the growth of a tilt at a spin.

    Parameters
    ----------
    kind
        The upright or the inverted spin.
    top
        The body, in SI units; its friction does not matter.
    spin
        Axial spin of the launch, rad/s.
    rolls
        Whether the contact rolls without slip; otherwise the table is smooth.
    """
    pole = end_of(kind)
    height, depth = float(top.surface.height(pole)), -pole * float(top.surface.slope(pole))
    inertia, gyration = float(top.transverse_inertia), float(top.axial_inertia)
    if rolls:
        inertia += top.mass * height**2
        gyration += top.mass * height * (height + depth)
    stiffness = 4.0 * inertia * top.mass * top.gravity * depth
    least = math.sqrt(max(0.0, -stiffness))
    rate = math.sqrt(max(0.0, -((gyration * spin) ** 2) - stiffness))
    return Sleeping(least / gyration, 0.5 * rate / inertia, 0.5 * least / inertia)
