"""Contensou friction of a patch with Hertz's pressure, exact, in two analytic branches.

See `contensou`. The law has two derivatives where the branches meet, kappa = 1: there the point of
the patch that stands still is on its rim.
"""

from typing import Any, NamedTuple

from tippetop.mechanics.laws.contensou import PI, PatchLaw
from tippetop.mechanics.laws.friction import Traction
from tippetop.mechanics.laws.hertz_shares import drilling_shares, scaled_shares, sliding_shares
from tippetop.mechanics.natural_units import Units
from tippetop.mechanics.series import horner
from tippetop.mechanics.vectors import Horizontal, Scalar, Vector

# fmt: off
LIMIT: tuple[tuple[float, ...], ...] = (
    (0.8835729338221295, 3.889778559163314, 5.573221706650525, 3.0420944615186203,
     0.7966720357548377, 0.26696888590798373, 0.05714222546990528, 0.0010481676273393747,
     0.00039135703969367353),
    (1.0, 4.402328783813161, 6.1825966830889465, 2.8926555398109404, 0.12101121238237003,
     -0.09382811272248932, 0.006126226581420139),
)
# fmt: on
"""Coefficients of two polynomials whose ratio is F on the limit surface, in (1 - (T / T(kappa =
1))^2)^(1/2); relative error 4e-16.
"""

EDGE = 1e-5
"""How far beyond kappa^2 = 1 the law of drilling serves, off by kappa^2 - 1 to the power of 5/2
over 5.

Slip's law has a singularity there that power series feel: they come no nearer to it than half of
this, and no launch is on both branches, or on neither, by rounding.
"""

BEYOND = 1e-20
"""Share of slip in drilling, and of drilling in slip, that keeps a branch finite far from where it
holds.
"""

BRANCH_TORQUE = 9.0 * PI / 128.0
"""T at kappa = 1."""


class HertzPiece(PatchLaw):
    """A branch of Hertz's law, which has a number beyond where it holds, too."""

    def traction(self, slip: Horizontal, angular_velocity: Vector) -> Traction:
        """Force and torque per unit normal force; what prevails, drilling or slip, must not be
        zero.
        """
        return resisting(self, slip, angular_velocity)

    @property
    def whole_law(self) -> "HertzLaw":
        """The law of which it is a branch."""
        return HertzLaw(*self)


class HertzDrillingLaw(HertzPiece):
    """Contensou friction with Hertz's pressure where drilling prevails, kappa < 1.

    f = -mu (3 pi/32) (4 - kappa^2) v / (R |w|), |t| = mu R (3 pi/16) (1 - kappa^2 + 3/8 kappa^4).
    """

    def shares(self, square: Scalar, drilling: Scalar) -> tuple[Scalar, Scalar]:
        """Force over slip, and torque, per unit normal force, at slip of this square and drilling R
        w.
        """
        larger = drilling * drilling + BEYOND * square
        return scaled_shares(self, larger, drilling, drilling_shares(square / larger))

    def reserve(self, normal: Scalar, force: Horizontal, drilling: Scalar) -> Scalar:
        """(mu N F)^2 - T^2 where the limit surface has this drilling torque, N^2.

        It is that as long as `limit_guard` is positive, and some number elsewhere.
        """
        limit = self.mu * normal
        torque = (16.0 / (3.0 * PI)) * drilling / (self.patch_radius * limit)
        under = 1.5 * (torque * torque) ** 0.5 - 0.5
        kappa2 = (4.0 / 3.0) * (1.0 - (under * under) ** 0.25)
        size = (3.0 * PI / 32.0) * (4.0 - kappa2) * limit
        return size * size * kappa2 - force[0] * force[0] - force[1] * force[1]

    def limit_guard(self, normal: Scalar, drilling: Scalar) -> Scalar:
        """Positive as long as this piece of the limit surface is followed, (N m)^2."""
        return limit_branch_guard(self, normal, drilling, 4.0 / 3.0 * EDGE)

    def branch_guard(self, slip: Vector) -> Scalar:
        """Positive as long as this branch is followed, up to `EDGE`, m^2/s^2."""
        return law_branch_guard(slip, EDGE)

    def other_branch(self) -> "HertzSlidingLaw":
        """Return the other branch, whose part of the limit surface adjoins this one's."""
        return HertzSlidingLaw(*self)


class HertzSlidingLaw(HertzPiece):
    """Contensou friction with Hertz's pressure where slip prevails, kappa > 1, drilling or not.

    With sig = asin(1 / kappa) and q = sqrt(kappa^2 - 1),

        F = (3/16) [kappa (4 - kappa^2) sig + q (kappa^2 + 2) / kappa],
        T = (3/8) [(1 - kappa^2 + 3/8 kappa^4) sig + q (3/4 - 3/8 kappa^2)],

    f = -mu F along the slip and |t| = mu R T. The terms cancel for large kappa. They do not in x =
    cos(sig) = q / kappa and y = 1 - x^2 = 1 / kappa^2, with sig kappa = x + y C and C = 2/3 x + y
    D:

        F = (3/16) [6 x + (4 y - 1) C],        T kappa = (3/8) [x + (y - 1) C + 3/8 D].

    D is analytic in x on [0, 1] with the nearest singularity at -1, and a ratio of polynomials
    gives it to rounding, with plain operators only.

    Notes
    -----
    Beyond its branch, x is the root of |1 - 1 / kappa^2|: there is a number there for an integrator
    that looks ahead, but not the law. It is followed from kappa^2 = 1 + EDGE / 2 on; drilling's
    branch serves up to 1 + EDGE. So that it has derivatives at kappa = 1 too, x is 1e-6 there.
    """

    def shares(self, square: Scalar, drilling: Scalar) -> tuple[Scalar, Scalar]:
        """Force over slip, and torque, per unit normal force, at slip of this square and drilling R
        w.
        """
        drilled = drilling * drilling
        larger = square + BEYOND * drilled
        return scaled_shares(self, larger, drilling, sliding_shares(1.0 - drilled / larger))

    def reserve(self, normal: Scalar, force: Horizontal, drilling: Scalar) -> Scalar:
        """(mu N F)^2 - T^2 where the limit surface has this drilling torque, N^2.

        It is that as long as `limit_guard` is positive, and some number elsewhere.
        """
        limit = self.mu * normal
        share = drilling / (BRANCH_TORQUE * self.patch_radius * limit)
        under = 1.0 - share * share
        y = (under * under) ** 0.25
        size = limit * horner(LIMIT[0], y) / horner(LIMIT[1], y)
        return size * size - force[0] * force[0] - force[1] * force[1]

    def limit_guard(self, normal: Scalar, drilling: Scalar) -> Scalar:
        """Positive as long as this piece of the limit surface is followed, (N m)^2."""
        return -limit_branch_guard(self, normal, drilling, 2.0 / 3.0 * EDGE)

    def branch_guard(self, slip: Vector) -> Scalar:
        """Positive as long as this branch is followed, down to half of `EDGE`, m^2/s^2."""
        return -law_branch_guard(slip, 0.5 * EDGE)

    def other_branch(self) -> "HertzDrillingLaw":
        """Return the other branch, whose part of the limit surface adjoins this one's."""
        return HertzDrillingLaw(*self)


class HertzBranch(NamedTuple):
    """The branch of Hertz's law that a number tells: the other one has no part in it.

    Both have a number wherever the patch moves, so that the same equations follow many launches,
    each on its own: a single one costs half with those of its branch alone.
    """

    mu: Scalar
    """Friction coefficient."""
    patch_radius: Scalar
    """Radius R of the contact patch, m."""
    drills: Scalar
    """1 where drilling prevails, 0 where slip does."""

    @property
    def whole_law(self) -> "HertzLaw":
        """The law of which it is a branch."""
        return HertzLaw(self.mu, self.patch_radius)

    @property
    def slip_length(self) -> Scalar:
        """The patch radius, m."""
        return self.patch_radius

    @property
    def torque_free(self) -> bool:
        """It resists drilling."""
        return False

    def traction(self, slip: Horizontal, angular_velocity: Vector) -> Traction:
        """Force and torque per unit normal force; slip and drilling must not both be zero."""
        return resisting(self, slip, angular_velocity)

    def shares(self, square: Scalar, drilling: Scalar) -> tuple[Scalar, Scalar]:
        """Force over slip, and torque, per unit normal force, at slip of this square and drilling R
        w.
        """
        drilled = drilling * drilling
        larger = self._either(drilled + BEYOND * square, square + BEYOND * drilled)
        share = self._either(square, drilled) / larger
        drills, slides = drilling_shares(share), sliding_shares(self._either(1.0, 1.0 - share))
        law = self._either(drills[0], slides[0]), self._either(drills[1], slides[1])
        return scaled_shares(self, larger, drilling, law)

    def _either(self, drills: Scalar, slides: Scalar) -> Scalar:
        """Return the value of the branch that holds."""
        return self.drills * drills + (1.0 - self.drills) * slides

    def reserve(self, normal: Scalar, force: Horizontal, drilling: Scalar) -> Scalar:
        """Return the reserve of the whole law."""
        return self.whole_law.reserve(normal, force, drilling)

    def branch_guard(self, slip: Vector) -> Scalar:
        """Positive as long as this branch is followed, up to `EDGE` or down to half of it,
        m^2/s^2.
        """
        return (2.0 * self.drills - 1.0) * law_branch_guard(slip, 0.5 * EDGE * (1.0 + self.drills))

    def other_branch(self) -> "HertzBranch":
        """Return the other branch."""
        return self._replace(drills=1.0 - self.drills)

    def coefficients(self, units: Units) -> tuple[Scalar, ...]:
        """Friction coefficient, patch radius in units of length, and which branch it is."""
        return (self.mu, self.patch_radius / units.length, self.drills)


class HertzLaw(PatchLaw):
    """Contensou friction with Hertz's pressure, whichever branch holds: for numbers, or arrays of
    them.
    """

    def drills(self, slip: Vector) -> Scalar:
        """Return whether drilling prevails at a slip, of floats or arrays."""
        return law_branch_guard(slip, 0.75 * EDGE) > 0.0

    def branch(self, slip: Vector) -> HertzDrillingLaw | HertzSlidingLaw:
        """Return the branch of the law that holds at a slip; of floats."""
        return HertzDrillingLaw(*self) if self.drills(slip) else HertzSlidingLaw(*self)

    def numbered_branch(self, slip: Vector) -> HertzBranch:
        """Return the branch that holds at a slip, in plain operators."""
        return HertzBranch(*self, 1.0 * self.drills(slip))

    def limit_branch(self, normal: float, drilling: float) -> HertzDrillingLaw | HertzSlidingLaw:
        """Return the branch whose part of the limit surface has this drilling torque, N m; of
        floats.
        """
        # Without drilling no normal force decides: it may be a symbol.
        drills = drilling != 0.0 and limit_branch_guard(self, normal, drilling, EDGE) > 0.0
        return HertzDrillingLaw(*self) if drills else HertzSlidingLaw(*self)

    def traction(self, slip: Horizontal, angular_velocity: Vector) -> Traction:
        """Force and torque per unit normal force; slip and drilling must not both be zero."""
        drilling = self.patch_radius * angular_velocity[2]
        return self.numbered_branch((*slip, drilling)).traction(slip, angular_velocity)

    def reserve(self, normal: Scalar, force: Horizontal, drilling: Scalar) -> Scalar:
        """(mu N F)^2 - T^2 where the limit surface has this drilling torque, N^2; else less than
        zero.
        """
        if normal == 0.0:  # without a normal force there is no friction
            return -(force[0] ** 2) - force[1] ** 2 - (drilling / self.patch_radius) ** 2
        return self.limit_branch(normal, drilling).reserve(normal, force, drilling)


def law_branch_guard(slip: Vector, edge: Scalar) -> Scalar:
    """(1 + edge) (R w)^2 - v^2, of slip (v, R w): positive where drilling prevails, m^2/s^2."""
    x, y, drilling = slip
    return (1.0 + edge) * (drilling * drilling) - (x * x + y * y)


def limit_branch_guard(law: Any, normal: Scalar, drilling: Scalar, edge: Scalar) -> Scalar:
    """M^2 - (1 - edge) (mu N R T(1))^2, (N m)^2: positive where drilling torque M is on drilling's
    piece.

    T falls by 2/3 of what kappa^2 exceeds 1 by, relatively, and T^2 by 4/3 of it.
    """
    limit = BRANCH_TORQUE * law.mu * normal * law.patch_radius
    return drilling * drilling - (1.0 - edge) * limit * limit


def resisting(law: Any, slip: Horizontal, angular_velocity: Vector) -> Traction:
    """Force and torque per unit normal force of a branch of the law."""
    square = slip[0] * slip[0] + slip[1] * slip[1]
    force, torque = law.shares(square, law.patch_radius * angular_velocity[2])
    return Traction((force * slip[0], force * slip[1]), (0.0, 0.0, torque))
