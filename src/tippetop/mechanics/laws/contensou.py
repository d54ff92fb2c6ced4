"""Dry friction of a round contact patch that slips and drills at once (Contensou 1963).

Every part of the patch rubs by Coulomb's law against its own velocity, so that drilling makes
sliding easier and sliding makes drilling easier. With slip speed v, drilling rate w and patch
radius R, force and torque depend on kappa = v / (R |w|) alone, and derive from one convex
dissipation potential. Sticking needs v = 0 and w = 0.
"""

from typing import NamedTuple

from tippetop.mechanics.laws.friction import Traction
from tippetop.mechanics.natural_units import Units
from tippetop.mechanics.vectors import Horizontal, Scalar, Vector

PI = 3.141592653589793

ELLIPSOIDAL_RADIUS = 3.0 * PI / 16.0
"""Semi-axis rho of the ellipsoidal limit surface over the patch radius: it drills as hard as
Hertz's.
"""


class PatchLaw(NamedTuple):
    """What the laws of a patch are made of."""

    mu: Scalar
    """Friction coefficient."""
    patch_radius: Scalar
    """Radius R of the contact patch, m."""

    @property
    def slip_length(self) -> Scalar:
        """The patch radius, m."""
        return self.patch_radius

    @property
    def torque_free(self) -> bool:
        """It resists drilling."""
        return False

    def coefficients(self, units: Units) -> tuple[Scalar, ...]:
        """Friction coefficient, and patch radius in units of length."""
        return (self.mu, self.patch_radius / units.length)


class EllipsoidalLaw(PatchLaw):
    """Contensou friction with an ellipsoidal limit surface (Leine and Glocker 2003).

    S = sqrt(v^2 + rho^2 w^2), f = -mu v / S, t = -mu rho^2 w / S along the vertical, and rho = (3
    pi/16) patch_radius: analytic but for v = w = 0, where any (T / mu N)^2 + (M / (mu N rho))^2 <=
    1 is possible.
    """

    @property
    def slip_length(self) -> Scalar:
        """The semi-axis rho, m."""
        return ELLIPSOIDAL_RADIUS * self.patch_radius

    def traction(self, slip: Horizontal, angular_velocity: Vector) -> Traction:
        """Force and torque per unit normal force; slip and drilling must not both be zero."""
        drilling = self.slip_length * angular_velocity[2]
        speed = (slip[0] * slip[0] + slip[1] * slip[1] + drilling * drilling) ** 0.5
        force = -self.mu * slip[0] / speed, -self.mu * slip[1] / speed
        return Traction(force, (0.0, 0.0, -self.mu * self.slip_length * drilling / speed))

    def reserve(self, normal: Scalar, force: Horizontal, drilling: Scalar) -> Scalar:
        """(mu N)^2 - T^2 - (M / rho)^2, N^2."""
        limit, torque = self.mu * normal, drilling / self.slip_length
        return limit * limit - force[0] * force[0] - force[1] * force[1] - torque * torque
