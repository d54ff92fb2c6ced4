"""Natural units of a top: its mass, its size and sqrt(size / g)."""

from typing import NamedTuple

from tippetop.mechanics.vectors import Scalar


class Units(NamedTuple):
    """Units of mass (kg), length (m) and time (s) in which a top is simulated."""

    mass: Scalar
    length: Scalar
    time: Scalar

    @property
    def speed(self) -> Scalar:
        """Unit of velocity, m/s."""
        return self.length / self.time

    @property
    def inertia(self) -> Scalar:
        """Unit of moment of inertia, kg m^2."""
        return self.mass * self.length**2

    @property
    def energy(self) -> Scalar:
        """Unit of energy, J."""
        return self.mass * self.speed**2

    @property
    def force(self) -> Scalar:
        """Unit of force, N."""
        return self.mass * self.length / self.time**2

    @property
    def angular_momentum(self) -> Scalar:
        """Unit of angular momentum, kg m^2/s."""
        return self.mass * self.length * self.speed

    @property
    def jellett(self) -> Scalar:
        """Unit of Jellett's integral, kg m^3/s."""
        return self.angular_momentum * self.length
