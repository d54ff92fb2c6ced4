"""Friction laws: the force and torque of the table per unit normal force, given the slip."""

from typing import NamedTuple, Protocol

from tippetop.mechanics.natural_units import Units
from tippetop.mechanics.vectors import Horizontal, Scalar, Vector


class Traction(NamedTuple):
    """What the table does to the body at the contact, per unit normal force."""

    force: Horizontal
    torque: Vector


NO_TORQUE: Vector = (0.0, 0.0, 0.0)


class FrictionLaw(Protocol):
    """What the mechanics asks of a friction law."""

    @property
    def torque_free(self) -> bool:
        """Whether its torque is zero at any slip."""

    def traction(self, slip: Horizontal, angular_velocity: Vector) -> Traction:
        """Force and torque per unit normal force at this slip velocity (m/s) and angular velocity
        (rad/s).
        """

    def coefficients(self, units: Units) -> tuple[Scalar, ...]:
        """Return the numbers of the law in these units, as its class takes them."""


class ViscousLaw(NamedTuple):
    """Friction proportional to slip and normal force, f = -mu v (mu in s/m), with no torque."""

    mu: Scalar

    @property
    def torque_free(self) -> bool:
        """It is a force alone."""
        return True

    def traction(self, slip: Horizontal, angular_velocity: Vector) -> Traction:
        """Force and torque per unit normal force."""
        return Traction((-self.mu * slip[0], -self.mu * slip[1]), NO_TORQUE)

    def coefficients(self, units: Units) -> tuple[Scalar, ...]:
        """Friction coefficient mu in units of 1 / speed."""
        return (self.mu * units.speed,)


class RegularizedCoulombLaw(NamedTuple):
    """Coulomb friction smoothed below the slip speed eps (m/s): f = -mu v / sqrt(v^2 + eps^2), no
    torque.
    """

    mu: Scalar
    eps: Scalar

    @property
    def torque_free(self) -> bool:
        """It is a force alone."""
        return True

    def traction(self, slip: Horizontal, angular_velocity: Vector) -> Traction:
        """Force and torque per unit normal force."""
        factor = -self.mu * (slip[0] ** 2 + slip[1] ** 2 + self.eps**2) ** -0.5
        return Traction((factor * slip[0], factor * slip[1]), NO_TORQUE)

    def coefficients(self, units: Units) -> tuple[Scalar, ...]:
        """Friction coefficient mu, and eps in units of speed."""
        return (self.mu, self.eps / units.speed)
