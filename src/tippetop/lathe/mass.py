"""Mass properties of turned bodies."""

# translate module: numpy

import math
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple, TypeAlias

from tippetop.lathe.profile import Profile


class MassProperties(NamedTuple):
    """Mass (kg), centre of mass and moments of inertia."""

    mass: float
    center: float
    """Height of the centre of mass, in the profile's own coordinates, m."""
    I1: float
    I3: float
    """Moments of inertia about the centre of mass, transverse to and along the axis, kg m^2."""


Filling: TypeAlias = tuple[Profile, float]
"""A profile and its density less that of the material it replaces, kg/m^3."""


def mass_properties(fillings: Sequence[Filling]) -> MassProperties:
    """Return the mass properties of coaxial bodies of revolution, exact up to rounding.

    By Green's theorem the integrals over a profile are integrals along its edges. With r the
    distance from the axis and z the height along it, the integral of pi r^2 over dz is the volume,
    that of pi r^4 / 2 the moment of inertia about the axis, and those of pi r^2 z and pi r^2 z^2
    are moments of the height.
    """
    mass = _integral(fillings, lambda r, z: math.pi * r**2)
    center = _integral(fillings, lambda r, z: math.pi * r**2 * z) / mass
    axial = _integral(fillings, lambda r, z: math.pi / 2.0 * r**4)
    polar = _integral(fillings, lambda r, z: math.pi * (r * (z - center)) ** 2)
    return MassProperties(mass, center, axial / 2.0 + polar, axial)


def _integral(fillings: Sequence[Filling], integrand: Callable[[Any, Any], Any]) -> float:
    nodes = [(density, *profile.nodes) for profile, density in fillings]
    return sum(
        density * float(integrand(points.real, points.imag) @ weights)
        for density, points, weights in nodes
    )
