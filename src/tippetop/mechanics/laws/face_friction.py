r"""Friction of a flat face, disk or annulus, that slips and drills at once.

The face lies on the table between an inner and an outer radius, a0 and a1. Its middle slips at v,
and it turns about the vertical at w. Coulomb's law acts on every element of it under a pressure
that is assumed: a rigid face does not determine it. **Uniform** pressure and a **rim** that carries
all of it bracket what real faces do. Force and torque derive from one dissipation potential: per
mu N, it is the mean speed of the face's elements, |w| times their mean distance from the
instantaneous centre, which lies v / |w| from the middle.

With k = min(v, a |w|) / max(v, a |w|) and the complete elliptic integrals K, E, B, D and C of this
modulus (Jahnke and Emde 1933), a disk of radius a under uniform pressure has

    F = 4/(3 pi) (B + E) v / max(v, a |w|),
    T = 4/(9 pi) a^2 w / max(v, a |w|) * ((4 - 2 k^2) E - (1 - k^2) K)    where v < a |w|,
    T = 4/(9 pi) a^2 w / max(v, a |w|) * (3 B - D + C)                    where v > a |w|.

No term cancels another. Both are analytic but for v = a |w|, where third derivatives of the
potential are infinite. A disk whose I3 is m a^2 / 2 comes to rest at v / (a w) = 0.653 (Farkas,
Bartels, Unger and Wolf, Phys. Rev. Lett. 90, 248302, 2003).
"""

from typing import Any, NamedTuple, Protocol

from tippetop.mechanics.laws.contensou import PI, EllipsoidalLaw
from tippetop.mechanics.laws.contensou_hertz import HertzLaw
from tippetop.mechanics.laws.coulomb import CoulombLaw, StaticCoulombLaw
from tippetop.mechanics.laws.friction import FrictionLaw, ViscousLaw
from tippetop.mechanics.vectors import Horizontal, Scalar, either, exceeds

MEANS = 7
"""Arithmetic-geometric means after the first: as many as 1 - k^2 >= `LEAST_COMPLEMENT` needs."""

LEAST_COMPLEMENT = 1e-13
"""Least 1 - k^2, whose root and logarithm then have derivatives: the squared modulus is less by as
much, relatively. Much less is lost in rounding where a rim comes to rest at v = a |w|; more can be
seen in the force.
"""

PREVALENCE = 1e-14
"""How far drilling must prevail over slip, relatively, for its form of the law. A rim comes to rest
at v = a |w|, where rounding would choose anew in every step; 1 - k^2 must stay positive.
"""

LEAST_WIDTH = 1e-3
"""Least width of an annulus in outer radii under uniform pressure: force and torque are differences
of those of two disks, and lose as many digits.
"""

POINTS = 12
"""Points of every circle of a face on which a law acts that has no closed form for a face."""

CIRCLES, SHARES = (
    (0.0694318442029737, 0.3300094782075719, 0.6699905217924281, 0.9305681557970263),
    (0.1739274225687269, 0.3260725774312731, 0.3260725774312731, 0.1739274225687269),
)
"""Gauss's points and weights in [0, 1], of the squared radius: where those circles are."""

COSINES = (
    1.0,
    0.8660254037844386,
    0.5,
    0.0,
    -0.5,
    -0.8660254037844386,
    -1.0,
    -0.8660254037844386,
    -0.5,
    0.0,
    0.5,
    0.8660254037844386,
)
"""Cosines of the angles of those points."""


class Integrals(NamedTuple):
    """What the complete elliptic integrals of a modulus are made of."""

    first: Scalar
    """K."""
    sigma: Scalar
    """(D - B) / (2 k^2 K)."""


class FaceTraction(NamedTuple):
    """What the table does to a face, per unit normal force."""

    force: Horizontal
    torque: Scalar
    """About the vertical through the middle, m."""


class FaceLaw(Protocol):
    """What the mechanics asks of the friction law of a face."""

    def traction(self, slip: Horizontal, drilling: Scalar) -> FaceTraction:
        """Return force and torque per unit normal force at a slip velocity of the middle, m/s, and
        an angular velocity about the vertical, rad/s.
        """


def elliptic_integrals(square: Scalar) -> Integrals:
    """Return the integrals for a squared modulus, by the arithmetic-geometric mean (Abramowitz and
    Stegun 17.6), without differences of nearly equal numbers.

    Its differences c_n, all divided by k^2, are q_1 = 1 / (2 (1 + k')) and q_(n+1) = k^2 q_n^2 / (4
    a_(n+1)), and sigma is the sum of 2^(n-1) q_n^2.
    """
    complement = (1.0 - (1.0 - LEAST_COMPLEMENT) * square) ** 0.5
    mean, geometric = 0.5 * (1.0 + complement), complement**0.5
    part = 0.5 / (1.0 + complement)
    sigma, factor = part * part, 1.0
    for _ in range(MEANS):
        mean, geometric = 0.5 * (mean + geometric), (mean * geometric) ** 0.5
        part = 0.25 * square * (part * part) / mean
        factor = 2.0 * factor
        sigma = sigma + factor * (part * part)
    return Integrals(0.5 * PI / mean, sigma)


class DiskShares(NamedTuple):
    """Force over slip, and torque over drilling, of a round patch, per mu N: s/m, and m s."""

    force: Scalar
    torque: Scalar


def uniform_shares(square: Scalar, drilling: Scalar, radius: Scalar) -> DiskShares:
    """Return the shares of a disk under uniform pressure, at slip of this square, m^2/s^2, and
    drilling w.
    """
    larger, k2, drills = _prevailing(square, drilling, radius)
    first, sigma = elliptic_integrals(k2)
    both = 1.5 - 0.5 * k2 - k2 * sigma * (1.0 + k2)  # (B + E) / K
    second = 1.0 - 0.5 * k2 - k2 * k2 * sigma  # E / K
    inside = (4.0 - 2.0 * k2) * second - (1.0 - k2)
    beyond = 1.0 + 2.0 * sigma * (1.0 - 2.0 * k2)
    factor = first * larger**-0.5
    torque = either(drills, inside, beyond)
    return DiskShares(
        4.0 / (3.0 * PI) * (factor * both),
        4.0 / (9.0 * PI) * (radius * radius) * (factor * torque),
    )


def rim_shares(square: Scalar, drilling: Scalar, radius: Scalar) -> DiskShares:
    """Return the shares of a rim: 2/pi times E or B, the limit of those of ever thinner annuli."""
    larger, k2, drills = _prevailing(square, drilling, radius)
    first, sigma = elliptic_integrals(k2)
    second = 1.0 - 0.5 * k2 - k2 * k2 * sigma  # E / K
    below = 0.5 - k2 * sigma  # B / K
    factor = 2.0 / PI * (first * larger**-0.5)
    return DiskShares(
        factor * either(drills, below, second),
        (radius * radius) * factor * either(drills, second, below),
    )


def _prevailing(square: Scalar, drilling: Scalar, radius: Scalar) -> tuple[Scalar, Scalar, Scalar]:
    """Return the larger of v^2 and (a w)^2, the smaller over it, and whether drilling prevails.

    Steps become ever shorter towards v = a |w|, so that one may end where rounding tells no
    difference: a quotient in place of the choice would have no derivatives there.
    """
    drilled = (radius * drilling) * (radius * drilling)
    drills = exceeds(drilled, (1.0 + PREVALENCE) * square)
    larger = either(drills, drilled, square)
    return larger, either(drills, square, drilled) / larger, drills


def _against(shares: DiskShares, mu: Scalar, slip: Horizontal, drilling: Scalar) -> FaceTraction:
    force = -mu * shares.force
    return FaceTraction((force * slip[0], force * slip[1]), -mu * shares.torque * drilling)


def _square(slip: Horizontal) -> Scalar:
    return slip[0] * slip[0] + slip[1] * slip[1]


class UniformDiskLaw(NamedTuple):
    """Dry friction of a disk under uniform pressure; slip and drilling must not both be zero."""

    mu: Scalar
    outer: Scalar
    """Radius a1, m."""

    @classmethod
    def of(cls, law: Any, inner: Scalar, outer: Scalar) -> "UniformDiskLaw":
        """Return the law of a face with the friction coefficient of a law."""
        return cls(law.mu, outer)

    def traction(self, slip: Horizontal, drilling: Scalar) -> FaceTraction:
        """Return force and torque per unit normal force."""
        shares = uniform_shares(_square(slip), drilling, self.outer)
        return _against(shares, self.mu, slip, drilling)


class UniformAnnulusLaw(NamedTuple):
    """Dry friction of an annulus under uniform pressure, by the disks of its two radii; slip and
    drilling must not both be zero.
    """

    mu: Scalar
    inner: Scalar
    outer: Scalar
    """Radii a0 and a1, m."""

    @classmethod
    def of(cls, law: Any, inner: Scalar, outer: Scalar) -> "UniformAnnulusLaw":
        """Return the law of a face with the friction coefficient of a law."""
        return cls(law.mu, inner, outer)

    def traction(self, slip: Horizontal, drilling: Scalar) -> FaceTraction:
        """Return force and torque per unit normal force."""
        square, inner, outer = _square(slip), self.inner, self.outer
        hole_square, disk_square = inner * inner, outer * outer
        hole = uniform_shares(square, drilling, inner)
        disk = uniform_shares(square, drilling, outer)
        area = (outer - inner) * (outer + inner)
        shares = DiskShares(
            (disk_square * disk.force - hole_square * hole.force) / area,
            (disk_square * disk.torque - hole_square * hole.torque) / area,
        )
        return _against(shares, self.mu, slip, drilling)


class RimLaw(NamedTuple):
    """Dry friction of a face that presses with its rim alone; slip and drilling must not both be
    zero.
    """

    mu: Scalar
    outer: Scalar
    """Radius a1, m."""

    @classmethod
    def of(cls, law: Any, inner: Scalar, outer: Scalar) -> "RimLaw":
        """Return the law of a face with the friction coefficient of a law."""
        return cls(law.mu, outer)

    def traction(self, slip: Horizontal, drilling: Scalar) -> FaceTraction:
        """Return force and torque per unit normal force."""
        shares = rim_shares(_square(slip), drilling, self.outer)
        return _against(shares, self.mu, slip, drilling)


class EllipsoidalFaceLaw(NamedTuple):
    """Dry friction of a face with an ellipsoidal limit surface, which without slip drills as hard
    as uniform pressure does; slip and drilling must not both be zero.

    S = sqrt(v^2 + (rho w)^2), F = v / S, T = rho^2 w / S, with rho = 2/3 (a1^3 - a0^3) / (a1^2 -
    a0^2).
    """

    mu: Scalar
    inner: Scalar
    outer: Scalar
    """Radii a0 and a1, m."""

    @classmethod
    def of(cls, law: Any, inner: Scalar, outer: Scalar) -> "EllipsoidalFaceLaw":
        """Return the law of a face with the friction coefficient of a law."""
        return cls(law.mu, inner, outer)

    def traction(self, slip: Horizontal, drilling: Scalar) -> FaceTraction:
        """Return force and torque per unit normal force."""
        inner, outer = self.inner, self.outer
        arm = (2.0 / 3.0) * (outer * outer + outer * inner + inner * inner) / (outer + inner)
        drilled = arm * drilling
        factor = (_square(slip) + drilled * drilled) ** -0.5
        return _against(DiskShares(factor, arm * arm * factor), self.mu, slip, drilling)


class ViscousFaceLaw(NamedTuple):
    """Viscous friction of a face under any pressure that is the same all around: exact.

    F = -mu v, T = -mu (a0^2 + a1^2)/2 w, with uniform pressure.
    """

    mu: Scalar
    """Friction coefficient, s/m."""
    inner: Scalar
    outer: Scalar
    """Radii a0 and a1, m."""

    @classmethod
    def of(cls, law: Any, inner: Scalar, outer: Scalar) -> "ViscousFaceLaw":
        """Return the law of a face with the friction coefficient of a law."""
        return cls(law.mu, inner, outer)

    def traction(self, slip: Horizontal, drilling: Scalar) -> FaceTraction:
        """Return force and torque per unit normal force."""
        arm = 0.5 * (self.inner * self.inner + self.outer * self.outer)
        return _against(DiskShares(1.0, arm), self.mu, slip, drilling)


class PointwiseFaceLaw(NamedTuple):
    """Friction of a face on each of whose points a law acts, by quadrature over a few circles.

    It is the face of a body with as many feet, which share the weight: the sum is no worse a law
    than the integral, and takes as much energy as it says.
    """

    law: FrictionLaw
    """The law of a point."""
    inner: Scalar
    outer: Scalar
    """Radii a0 and a1, m."""

    @classmethod
    def of(cls, law: Any, inner: Scalar, outer: Scalar) -> "PointwiseFaceLaw":
        """Return the law of a face on whose points a law acts."""
        return cls(law, inner, outer)

    def traction(self, slip: Horizontal, drilling: Scalar) -> FaceTraction:
        """Return force and torque per unit normal force."""
        turning = (0.0, 0.0, drilling)
        least, most = self.inner * self.inner, self.outer * self.outer
        along: Scalar = 0.0
        across: Scalar = 0.0
        torque: Scalar = 0.0
        for place, share in zip(CIRCLES, SHARES, strict=True):
            radius = (least + place * (most - least)) ** 0.5
            for number in range(POINTS):
                x = radius * COSINES[number]
                y = radius * COSINES[(number + 9) % POINTS]
                at = (slip[0] - drilling * y, slip[1] + drilling * x)
                (p, q), couple = self.law.traction(at, turning)
                weight = share / POINTS
                along = along + weight * p
                across = across + weight * q
                torque = torque + weight * (x * q - y * p + couple[2])
        return FaceTraction((along, across), torque)


def face_law_type(law: FrictionLaw, inner: Scalar, pressure: str) -> Any:
    """Return the class of the law of a face on which a law acts; None of a set-valued law of users.

    Parameters
    ----------
    law
        The law of a point or a patch. A patch on a face is the face itself.
    inner
        Inner radius of the face, m, a float.
    pressure
        "uniform", "rim" or "ellipsoidal": what stands for the pressure under dry friction.
    """
    if isinstance(law, ViscousLaw):
        return ViscousFaceLaw
    if isinstance(law, (CoulombLaw, StaticCoulombLaw, EllipsoidalLaw, HertzLaw)):
        if pressure == "rim":
            return RimLaw
        if pressure == "ellipsoidal":
            return EllipsoidalFaceLaw
        return UniformAnnulusLaw if inner > 0.0 else UniformDiskLaw
    return None if hasattr(law, "reserve") else PointwiseFaceLaw
