"""Steady rolling with the centre of mass at rest: disks, hurricane balls and all other bodies."""

import math
from typing import NamedTuple

from tippetop.mechanics.surfaces.surface import contact_vector
from tippetop.mechanics.top import Top


class RestingCenter(NamedTuple):
    """Rolling motion whose centre of mass is at rest."""

    precession: float
    """Rate of the axis and of the contact point about the vertical, rad/s."""
    spin: float
    """Angular velocity about the axis, omega3, rad/s."""


def resting_center(tilt: float, top: Top) -> RestingCenter | None:
    """Return how a body of revolution rolls at a tilt, rad, with its centre of mass at rest.

    Returns
    -------
    RestingCenter or None
        None if no rate of precession keeps the tilt constant.

    Notes
    -----
    The table bears the weight alone, and the angular velocity lies along the contact vector, whose
    components along the axis n and across it, towards the vertical, are a_n and a_e. With L going
    round at the rate Omega, Omega z x L = a x m g z gives

        Omega^2 s (I3 s a_n / a_e - I1 c) = m g (a_e c - a_n s),        omega3 = Omega s a_n / a_e.

    For a thin disk of radius R this is Omega^2 = 4 g / (R s), and for two balls that touch,
    cos(theta) = 2/5 - g / (Omega^2 R).
    """
    return resting_center_on(tilt, top.body.lowest_at(math.cos(tilt)))


def resting_center_on(tilt: float, top: Top) -> RestingCenter | None:
    """Return how a body rolls on its active surface, or None; see `resting_center`."""
    s, c = math.sin(tilt), math.cos(tilt)
    x, _, z = contact_vector((s, 0.0, c), top.surface)
    along, across = x * s + z * c, -x * c + z * s
    gyroscopic = s * (top.axial_inertia * s * along / across - top.transverse_inertia * c)
    weight = top.mass * top.gravity * (across * c - along * s)
    if gyroscopic * weight <= 0.0:
        return None
    precession = math.sqrt(weight / gyroscopic)
    return RestingCenter(precession, precession * s * along / across)
