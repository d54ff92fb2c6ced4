"""Dry friction: a sliding body feels all of it, and one that sticks no more than it takes."""

from typing import NamedTuple

from tippetop.mechanics.laws.friction import NO_TORQUE, Traction
from tippetop.mechanics.natural_units import Units
from tippetop.mechanics.vectors import Horizontal, Scalar, Vector

TINY = 1e-300
"""Square of an angular velocity that is none, so that no direction of it is asked for."""


class CoulombLaw(NamedTuple):
    """Coulomb's friction: f = -mu v / |v| in sliding, and at v = 0 any force up to mu N. No
    torque.
    """

    mu: Scalar

    @property
    def torque_free(self) -> bool:
        """It has no torque."""
        return True

    def traction(self, slip: Horizontal, angular_velocity: Vector) -> Traction:
        """Force and torque per unit normal force; the slip must not be zero."""
        factor = -self.mu * (slip[0] * slip[0] + slip[1] * slip[1]) ** -0.5
        return Traction((factor * slip[0], factor * slip[1]), NO_TORQUE)

    def reserve(self, normal: Scalar, force: Horizontal, drilling: Scalar) -> Scalar:
        """(mu N)^2 - T^2, N^2."""
        limit = self.mu * normal
        return limit * limit - force[0] * force[0] - force[1] * force[1]

    def coefficients(self, units: Units) -> tuple[Scalar, ...]:
        """Friction coefficient mu."""
        return (self.mu,)


class StaticCoulombLaw(NamedTuple):
    """Coulomb's friction with a static coefficient: f = -mu v / |v| in sliding, and at v = 0 any
    force up to static_mu N. No torque.

    Slip begins at a finite rate, because friction falls to mu N as it does. Under a force between
    mu N and static_mu N both sticking and sliding on are consistent, and what sticks goes on
    sticking.
    """

    mu: Scalar
    static_mu: Scalar

    @property
    def torque_free(self) -> bool:
        """It has no torque."""
        return True

    def traction(self, slip: Horizontal, angular_velocity: Vector) -> Traction:
        """Force and torque per unit normal force; the slip must not be zero."""
        return CoulombLaw(self.mu).traction(slip, angular_velocity)

    def reserve(self, normal: Scalar, force: Horizontal, drilling: Scalar) -> Scalar:
        """(static_mu N)^2 - T^2, N^2."""
        return CoulombLaw(self.static_mu).reserve(normal, force, drilling)

    def coefficients(self, units: Units) -> tuple[Scalar, ...]:
        """Friction coefficients mu and static_mu."""
        return (self.mu, self.static_mu)


class RollingResistance(NamedTuple):
    """A torque -length w_t / |w_t| against rolling, w_t the horizontal angular velocity."""

    length: Scalar
    """Arm of the normal force's couple, m. At w_t = 0 it is any horizontal torque up to length N.
    """

    def couple(self, angular_velocity: Vector) -> Vector:
        """Torque against rolling per unit normal force, m; nothing where there is none at all."""
        x, y, _ = angular_velocity
        factor = -self.length * (x * x + y * y + TINY) ** -0.5
        return (factor * x, factor * y, 0.0)

    def reserve(self, normal: Scalar, couple: Horizontal) -> Scalar:
        """Positive while the contact can exert this horizontal couple at rest, (N m)^2."""
        limit = self.length * normal
        return limit * limit - couple[0] * couple[0] - couple[1] * couple[1]
