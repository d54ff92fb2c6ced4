"""Surfaces of revolution, each given by its support function.

The support function h(c) is the height of the centre of mass above the table while the surface
touches it, as a function of c = cos(tilt). It determines the contact point: see `contact_vector`.
"""

from typing import Any, NamedTuple, Protocol, Self, TypeAlias

from tippetop.mechanics.vectors import Scalar, Vector, either, exceeds, power

NEARLY_FLAT = 1e-4
"""Sine of the tilt up to which a body that comes down from a flight lands on its face. In flights
that would follow a landing on its edge, rounding of the height of the edge grows as 1 / s: below,
they do not keep the energy to 1e-12; far above, rebounds that can be followed are left out.
"""

POLE = 1e-200
"""Added to the squared sine of the tilt where it divides: changes no tilt above 1e-92 rad, and
keeps the derivatives of a ring finite where the axis is vertical.
"""


Support: TypeAlias = tuple[Scalar, Scalar, Scalar]
"""Support function h of a surface and its derivatives h' and h'', m."""


class Surface(Protocol):
    """What the mechanics asks of a body's outer surface, seen from its centre of mass."""

    def height(self, c: Scalar) -> Scalar:
        """Support function h(c), m."""

    def slope(self, c: Scalar) -> Scalar:
        """First derivative h'(c), m."""

    def curvature(self, c: Scalar) -> Scalar:
        """Second derivative h''(c), m."""

    @property
    def spherical(self) -> bool:
        """Whether it is a sphere, wherever its centre."""

    @property
    def size(self) -> Scalar:
        """The length that serves as unit, m."""

    @property
    def proportions(self) -> tuple[Scalar, ...]:
        """The dimensionless numbers that remain when lengths are measured in `size`."""

    @classmethod
    def from_proportions(cls, proportions: tuple[Scalar, ...]) -> Self:
        """Make the surface of unit size with these proportions."""


class SphereSurface(NamedTuple):
    """A sphere whose centre is `center` above the centre of mass along the axis: the tippe top.

    Then h = radius - center c, and the contact vector is center n - radius z.
    """

    radius: Scalar
    center: Scalar

    def height(self, c: Scalar) -> Scalar:
        """Support function h(c), m."""
        return self.radius - self.center * c

    def slope(self, c: Scalar) -> Scalar:
        """First derivative h'(c), m."""
        return -self.center

    def curvature(self, c: Scalar) -> Scalar:
        """Second derivative h''(c), m: none."""
        return 0.0

    @property
    def spherical(self) -> bool:
        """It is a sphere."""
        return True

    @property
    def size(self) -> Scalar:
        """The radius, m."""
        return self.radius

    @property
    def proportions(self) -> tuple[Scalar, ...]:
        """The height of the centre, in radii: the eccentricity of a tippe top."""
        return (self.center / self.radius,)

    @classmethod
    def from_proportions(cls, proportions: tuple[Scalar, ...]) -> Self:
        """Make the sphere of radius 1 with its centre at this height."""
        return cls(1.0, *proportions)


class PointSurface(NamedTuple):
    """A sharp tip on the axis, `center` above the centre of mass: the point of a peg top.

    It is a sphere of radius 0, h = -center c, of which the distance of the centre of mass is the
    only length.
    """

    center: Scalar

    def height(self, c: Scalar) -> Scalar:
        """Support function h(c), m."""
        return -self.center * c

    def slope(self, c: Scalar) -> Scalar:
        """First derivative h'(c), m."""
        return -self.center

    def curvature(self, c: Scalar) -> Scalar:
        """Second derivative h''(c), m: none."""
        return 0.0

    @property
    def spherical(self) -> bool:
        """It is a sphere, of radius 0."""
        return True

    @property
    def size(self) -> Scalar:
        """The distance of the tip from the centre of mass, m."""
        return abs(self.center)

    @property
    def proportions(self) -> tuple[Scalar, ...]:
        """1 if the tip is above the centre of mass, -1 if it is below."""
        return (self.center / abs(self.center),)

    @classmethod
    def from_proportions(cls, proportions: tuple[Scalar, ...]) -> Self:
        """Make the tip at unit distance on this side."""
        return cls(*proportions)


class SpheroidSurface(NamedTuple):
    """A spheroid whose centre is `center` above the centre of mass along the axis: the spinning
    egg.

    With semi-axes `across` and `along` the axis, h = sqrt(across^2 (1 - c^2) + along^2 c^2) -
    center c.
    """

    across: Scalar
    along: Scalar
    center: Scalar = 0.0

    def height(self, c: Scalar) -> Scalar:
        """Support function h(c), m."""
        return self._central_height(c) - self.center * c

    def slope(self, c: Scalar) -> Scalar:
        """First derivative h'(c), m."""
        return (self.along**2 - self.across**2) * c / self._central_height(c) - self.center

    def curvature(self, c: Scalar) -> Scalar:
        """Second derivative h''(c), m."""
        return (self.along**2 - self.across**2) * self.across**2 / self._central_height(c) ** 3

    @property
    def spherical(self) -> bool:
        """It is none, though its semi-axes be equal."""
        return False

    @property
    def size(self) -> Scalar:
        """The semi-axis across, m."""
        return self.across

    @property
    def proportions(self) -> tuple[Scalar, ...]:
        """The semi-axis along the axis and the height of the centre, in units of the semi-axis
        across.
        """
        return (self.along / self.across, self.center / self.across)

    @classmethod
    def from_proportions(cls, proportions: tuple[Scalar, ...]) -> Self:
        """Make the spheroid with unit semi-axis across and these proportions."""
        return cls(1.0, *proportions)

    def _central_height(self, c: Scalar) -> Scalar:
        """Height of the spheroid's centre above the table, m."""
        return power(self.across**2 * (1.0 - c * c) + self.along**2 * c * c, 0.5)


class OvalSurface(NamedTuple):
    """A smooth convex surface whose support function is a polynomial, h = sum of a_k c^k: an egg.

    The coefficients are lengths; the first is the height of the centre of mass when the axis is
    level.
    """

    coefficients: tuple[Scalar, ...]

    def height(self, c: Scalar) -> Scalar:
        """Support function h(c), m."""
        height = 0.0 * c
        for coefficient in reversed(self.coefficients):
            height = height * c + coefficient
        return height

    def slope(self, c: Scalar) -> Scalar:
        """First derivative h'(c), m."""
        height, slope = 0.0 * c, 0.0 * c
        for coefficient in reversed(self.coefficients):
            slope = slope * c + height
            height = height * c + coefficient
        return slope

    def curvature(self, c: Scalar) -> Scalar:
        """Second derivative h''(c), m."""
        height, slope, curvature = 0.0 * c, 0.0 * c, 0.0 * c
        for coefficient in reversed(self.coefficients):
            curvature = curvature * c + slope
            slope = slope * c + height
            height = height * c + coefficient
        return 2.0 * curvature

    @property
    def spherical(self) -> bool:
        """It is none."""
        return False

    @property
    def size(self) -> Scalar:
        """The height of the centre of mass when the axis is level, m."""
        return self.coefficients[0]

    @property
    def proportions(self) -> tuple[Scalar, ...]:
        """The other coefficients, in units of the first."""
        return tuple([value / self.coefficients[0] for value in self.coefficients[1:]])

    @classmethod
    def from_proportions(cls, proportions: tuple[Scalar, ...]) -> Self:
        """Make the surface whose first coefficient is 1 with these others."""
        return cls((1.0, *proportions))


class RingSurface(NamedTuple):
    """A torus about the axis, whose middle is `center` above the centre of mass: the edge of a
    disk.

    With a circle of this radius in a tube, h = tube + radius sqrt(1 - c^2) - center c. Its
    derivatives are infinite where c^2 = 1: there the ring is parallel to the table. `support_at`
    and `gap_guard` take the axis, whose horizontal part has the digits that 1 - c^2 loses there.
    """

    radius: Scalar
    center: Scalar = 0.0
    tube: Scalar = 0.0
    inner_radius: Scalar = 0.0
    """Inner radius of the face that the ring bounds, m: 0 of a disk, else it is an annulus."""

    def height(self, c: Scalar) -> Scalar:
        """Support function h(c), m."""
        return self.tube + self.radius * power(1.0 - c * c, 0.5) - self.center * c

    def slope(self, c: Scalar) -> Scalar:
        """First derivative h'(c), m."""
        return -self.radius * c * power(1.0 - c * c, -0.5) - self.center

    def curvature(self, c: Scalar) -> Scalar:
        """Second derivative h''(c), m."""
        return -self.radius * power(1.0 - c * c, -1.5)

    def support_at(self, axis: Vector) -> Support:
        """Return the support function and its derivatives for an axis.

        Where the axis is vertical the contact point is undefined: the middle of the ring stands for
        it.
        """
        c, square = axis[2], _sine_squared(axis)
        inverse = power(square + POLE, -0.5)
        return (
            self.tube + self.radius * (square * inverse) - self.center * c,
            -self.radius * c * inverse - self.center,
            -self.radius * (inverse * inverse * inverse),
        )

    def gap_guard(self, axis: Vector, height: Scalar, margin: Scalar) -> Scalar:
        """Return what falls through zero as the gap of this ring and a margin do, m^2, smooth at
        every tilt.

        The gap is d - radius s, where d = height - tube + center c is how high the ring's middle is
        above a table that its tube touches. This is its product with d + radius s, which is
        positive wherever the gap is not negative. The margin, added to d, adds 2 d margin.
        """
        middle = self.face_gap(axis, height)
        product = middle * middle - self.radius * self.radius * _sine_squared(axis)
        return product + 2.0 * middle * margin

    def face_gap(self, axis: Vector, height: Scalar) -> Scalar:
        """Return the height of the ring's middle above a table that its tube touches, m: zero where
        a body falls flat, and there the product of `gap_guard` has a double zero.
        """
        return height - self.tube + self.center * axis[2]

    def lies_flat(self, axis: Vector, sine: Scalar = POLE**0.5) -> Scalar:
        """Return whether the ring is parallel to the table, up to a sine of the tilt: by default
        one that is rounding of a vertical axis.
        """
        return _sine_squared(axis) <= sine * sine

    @property
    def spherical(self) -> bool:
        """It is none."""
        return False

    @property
    def size(self) -> Scalar:
        """The radius of the circle, m."""
        return self.radius

    @property
    def proportions(self) -> tuple[Scalar, ...]:
        """The height of the middle, the tube's radius and the face's inner one, in radii of the
        circle.
        """
        return (
            self.center / self.radius,
            self.tube / self.radius,
            self.inner_radius / self.radius,
        )

    @classmethod
    def from_proportions(cls, proportions: tuple[Scalar, ...]) -> Self:
        """Make the ring with a circle of radius 1 and these proportions."""
        return cls(1.0, *proportions)


class MeridianArc(NamedTuple):
    """Arc of a meridian: a circle of radius `tube` about a point beside the axis."""

    radius: Scalar
    """Distance of the point from the axis, m: 0 for a sphere."""
    center: Scalar
    """Height of the point above the centre of mass, m."""
    tube: Scalar
    """Radius of the circle, m: 0 for a sharp edge."""
    is_sphere: bool


class MeridianSurface(NamedTuple):
    """A surface whose meridian is arcs that continue each other: a ball that is cut off.

    From tilt 0 on, each arc passes the contact on to the next one at a tilt. The circles touch
    there, so that h and h' are continuous and only h'' jumps: the contact goes on without an
    impact. Arc k has its centre at (rho_k, zeta_k), rho_{k+1} = rho_k + (r_k - r_{k+1}) sin(theta),
    zeta_{k+1} = zeta_k - (r_k - r_{k+1}) cos(theta), and h = r_k + rho_k sin(theta) - zeta_k
    cos(theta). Where an arc ends at a cut, the next one is the edge of the cut, r = 0.
    """

    radius: Scalar
    """Distance of the first arc's centre from the axis, m."""
    center: Scalar
    """Height of the first arc's centre above the centre of mass, m."""
    tubes: tuple[Scalar, ...]
    """Radii of the arcs, m."""
    cosines: tuple[Scalar, ...]
    """Cosines of the tilts at which one arc follows another, falling."""
    spheres: tuple[bool, ...]
    """Whether each arc has its centre on the axis."""

    @property
    def arcs(self) -> list[MeridianArc]:
        """The arcs with their centres."""
        radius, center = self.radius, self.center
        arcs = [MeridianArc(radius, center, self.tubes[0], self.spheres[0])]
        for k, cosine in enumerate(self.cosines):
            shorter = self.tubes[k] - self.tubes[k + 1]
            radius = radius + shorter * power(1.0 - cosine * cosine, 0.5)
            center = center - shorter * cosine
            arcs.append(MeridianArc(radius, center, self.tubes[k + 1], self.spheres[k + 1]))
        return arcs

    def support_at(self, axis: Vector) -> Support:
        """Return the support function and its derivatives for an axis."""
        return self._support(axis[2], _sine_squared(axis))

    def height(self, c: Scalar) -> Scalar:
        """Support function h(c), m."""
        return self._support(c, 1.0 - c * c)[0]

    def slope(self, c: Scalar) -> Scalar:
        """First derivative h'(c), m."""
        return self._support(c, 1.0 - c * c)[1]

    def curvature(self, c: Scalar) -> Scalar:
        """Second derivative h''(c), m."""
        return self._support(c, 1.0 - c * c)[2]

    def _support(self, c: Scalar, square: Scalar) -> Support:
        """Return the support function and its derivatives at cos(tilt) and sin(tilt)^2."""
        inverse = power(square + POLE, -0.5)
        height, slope, curvature = 0.0 * c, 0.0 * c, 0.0 * c
        arcs = self.arcs
        for k in range(len(arcs)):
            # From the last arc to the first: each holds above its cosine.
            arc = arcs[len(arcs) - 1 - k]
            h, h1, h2 = arc.tube - arc.center * c, 0.0 * c - arc.center, 0.0 * c
            if not arc.is_sphere:
                h = h + arc.radius * (square * inverse)
                h1 = h1 - arc.radius * c * inverse
                h2 = h2 - arc.radius * (inverse * inverse * inverse)
            if k == 0:
                height, slope, curvature = h, h1, h2
            else:
                holds = exceeds(c, self.cosines[len(arcs) - 1 - k])
                height = either(holds, h, height)
                slope = either(holds, h1, slope)
                curvature = either(holds, h2, curvature)
        return height, slope, curvature

    @property
    def flat_ends(self) -> tuple[float, ...]:
        """Cosines of the tilts, 1 and -1, at which the body would lie flat on an edge."""
        ends = [1.0] if not self.spheres[0] else list[float]()
        return (*ends, -1.0) if not self.spheres[len(self.spheres) - 1] else (*ends,)

    def end_guard(self, axis: Vector) -> Scalar:
        """Return what falls through zero as the body comes to lie on one of its flat ends."""
        distance = 1.0
        for end in self.flat_ends:
            distance = distance * (1.0 - end * axis[2] - 0.5 * NEARLY_FLAT * NEARLY_FLAT)
        return distance

    def gap_guard(self, axis: Vector, height: Scalar, margin: Scalar) -> Scalar:
        """Return what falls through zero as the gap and a margin do, m."""
        return height - self.support_at(axis)[0] + margin

    @property
    def spherical(self) -> bool:
        """It is none, though one of its arcs may be of a sphere."""
        return False

    @property
    def size(self) -> Scalar:
        """The sum of the radii of the arcs, m: that of a ball that is cut off."""
        return sum(self.tubes)

    @property
    def proportions(self) -> tuple[Scalar, ...]:
        """The other lengths in sizes, and the cosines."""
        size = self.size
        lengths = [self.radius / size, self.center / size, *[tube / size for tube in self.tubes]]
        return (*lengths, *self.cosines)

    @classmethod
    def from_proportions(cls, proportions: tuple[Scalar, ...]) -> Self:
        """Never used: the surface is made by its `make`, which knows of what arcs."""
        raise NotImplementedError

    @property
    def make(self) -> "MeridianKind":
        """What remains of it without its numbers."""
        return MeridianKind(self.spheres)


class MeridianKind(NamedTuple):
    """What remains of a surface of arcs when its numbers are taken away."""

    spheres: tuple[bool, ...]

    def from_proportions(self, proportions: tuple[Scalar, ...]) -> MeridianSurface:
        """Make the surface of unit size with these proportions."""
        count = len(self.spheres)
        tubes, cosines = proportions[2 : 2 + count], proportions[2 + count :]
        return MeridianSurface(
            proportions[0], proportions[1], tuple(tubes), tuple(cosines), self.spheres
        )


def kind_of(surface: Surface) -> Any:
    """Return what makes such surfaces of their proportions."""
    return getattr(surface, "make", type(surface))


def support_at(axis: Vector, surface: Surface) -> Support:
    """Return the support function of a surface and its derivatives for an axis, m."""
    if hasattr(surface, "support_at"):
        support: Support = surface.support_at(axis)
        return support
    c = axis[2]
    return surface.height(c), surface.slope(c), surface.curvature(c)


def gap_guard(axis: Vector, height: Scalar, margin: Scalar, surface: Surface) -> Scalar:
    """Return what falls through zero as the gap of a surface and a margin do, for the height of the
    centre of mass, m.

    It is their sum, or for a surface whose gap is not smooth at every tilt its own `gap_guard`. The
    margin is added last: added to the height it would be rounded to digits of the height.
    """
    if hasattr(surface, "gap_guard"):
        return surface.gap_guard(axis, height, margin)
    return height - surface.height(axis[2]) + margin


def contact_vector(axis: Vector, surface: Surface) -> Vector:
    """Vector from the centre of mass to the lowest point of the body, m: -h'(c) (n - c z) - h(c)
    z.
    """
    height, slope, _ = support_at(axis, surface)
    return (-slope * axis[0], -slope * axis[1], -height)


def _sine_squared(axis: Vector) -> Scalar:
    return axis[0] * axis[0] + axis[1] * axis[1]
