"""Shapes of bodies of revolution, each given by its support function.

The support function h(c) is the height of the centre of mass above the table while the body touches it,
as a function of c = cos(tilt). It determines the contact point: see `contact_vector`.
"""

from typing import NamedTuple, Protocol, Self

from tippetop.mechanics.vectors import Scalar, Vector


class Shape(Protocol):
    """What the mechanics asks of a shape."""

    def height(self, c: Scalar) -> Scalar:
        """Support function h(c), m."""

    def slope(self, c: Scalar) -> Scalar:
        """First derivative h'(c), m."""

    def curvature(self, c: Scalar) -> Scalar:
        """Second derivative h''(c), m."""

    @property
    def size(self) -> Scalar:
        """The length that serves as unit, m."""

    @property
    def proportions(self) -> tuple[Scalar, ...]:
        """The dimensionless numbers that remain when lengths are measured in `size`."""

    @classmethod
    def from_proportions(cls, proportions: tuple[Scalar, ...]) -> Self:
        """Make the shape of unit size with these proportions."""


class EccentricSphere(NamedTuple):
    """A sphere whose centre of mass lies on the axis, off its centre: the tippe top.

    The centre of mass is at -eccentricity * radius along the axis from the geometric centre, so that
    h = radius (1 - eccentricity c) and the contact vector is eccentricity radius n - radius z.
    """

    radius: Scalar
    eccentricity: Scalar

    def height(self, c: Scalar) -> Scalar:
        """Support function h(c), m."""
        return self.radius * (1.0 - self.eccentricity * c)

    def slope(self, c: Scalar) -> Scalar:
        """First derivative h'(c), m."""
        return -self.radius * self.eccentricity

    def curvature(self, c: Scalar) -> Scalar:
        """Second derivative h''(c), m: none."""
        return 0.0

    @property
    def size(self) -> Scalar:
        """The radius, m."""
        return self.radius

    @property
    def proportions(self) -> tuple[Scalar, ...]:
        """The eccentricity."""
        return (self.eccentricity,)

    @classmethod
    def from_proportions(cls, proportions: tuple[Scalar, ...]) -> Self:
        """Make the sphere of radius 1 with this eccentricity."""
        return cls(1.0, *proportions)


class Spheroid(NamedTuple):
    """A spheroid with its centre of mass at its centre: the spinning egg.

    With semi-axes `across` and `along` the axis, h = sqrt(across^2 (1 - c^2) + along^2 c^2).
    """

    across: Scalar
    along: Scalar

    def height(self, c: Scalar) -> Scalar:
        """Support function h(c), m."""
        return (self.across**2 * (1.0 - c * c) + self.along**2 * c * c) ** 0.5

    def slope(self, c: Scalar) -> Scalar:
        """First derivative h'(c), m."""
        return (self.along**2 - self.across**2) * c / self.height(c)

    def curvature(self, c: Scalar) -> Scalar:
        """Second derivative h''(c), m."""
        return (self.along**2 - self.across**2) * self.across**2 / self.height(c) ** 3

    @property
    def size(self) -> Scalar:
        """The semi-axis across, m."""
        return self.across

    @property
    def proportions(self) -> tuple[Scalar, ...]:
        """The semi-axis along the axis in units of the one across."""
        return (self.along / self.across,)

    @classmethod
    def from_proportions(cls, proportions: tuple[Scalar, ...]) -> Self:
        """Make the spheroid with unit semi-axis across and this ratio of the other to it."""
        return cls(1.0, *proportions)


def contact_vector(axis: Vector, shape: Shape) -> Vector:
    """Vector from the centre of mass to the lowest point of the body, m: -h'(c) (n - c z) - h(c) z."""
    c = axis[2]
    slope = shape.slope(c)
    return (-slope * axis[0], -slope * axis[1], -slope * (axis[2] - c) - shape.height(c))
