"""Friction laws of the table as users state them, validated."""

from abc import abstractmethod
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from tippetop.mechanics.laws.contensou import EllipsoidalLaw
from tippetop.mechanics.laws.contensou_hertz import HertzLaw
from tippetop.mechanics.laws.coulomb import CoulombLaw, StaticCoulombLaw
from tippetop.mechanics.laws.friction import FrictionLaw, RegularizedCoulombLaw, ViscousLaw
from tippetop.mechanics.vectors import Scalar
from tippetop.support.errors import InvalidInput
from tippetop.support.validation import NO_WORD, NotNegative, Positive, Quantity, Variant

LEAST_PATCH = 1e-9
"""Least radius of a contact patch in units of the body's size: the drilling torque of a smaller one
is lost in rounding.
"""

LEAST_EPS = 1e-100
"""Least slip speed below which a law may be smoothed, m/s: the square of a much smaller one
underflows to 0.
"""


class Friction(Variant):
    """Base class of the friction laws of the table.

    Attributes
    ----------
    kind
        Name of the law; a subclass declares it: ``kind: Literal["wet"] = "wet"``.

    Examples
    --------
    >>> import tippetop as tt
    >>> isinstance(tt.CoulombFriction(mu=0.3), tt.Friction)
    True
    """

    kind: str

    @property
    @abstractmethod
    def law(self) -> FrictionLaw:
        """Law in the form that the mechanics uses."""

    def fits(self, size: Scalar) -> bool:
        """Return whether a body of this size, m, can have such a contact; arrays give an array."""
        return True

    @property
    def vanishes(self) -> bool:
        """Whether the table is smooth: there is a coefficient mu, and it is 0."""
        return getattr(self, "mu", None) == 0.0


class ViscousFriction(Friction):
    """Friction force -mu N v for slip velocity v and normal force N.

    Attributes
    ----------
    mu
        Friction coefficient, s/m.

    Examples
    --------
    >>> import tippetop as tt
    >>> tt.ViscousFriction(mu=0.3).law.traction((0.1, 0.0), (0.0, 0.0, 0.0)).force  # at 0.1 m/s
    (-0.03, -0.0)
    """

    kind: Literal["viscous"] = "viscous"
    mu: Annotated[NotNegative, Quantity("s m-1", "friction coefficient")]

    @property
    def law(self) -> FrictionLaw:
        """Law in the form that the mechanics uses."""
        return ViscousLaw(self.mu)


class RegularizedCoulombFriction(Friction):
    """Friction force -mu N v / sqrt(v^2 + eps^2) for slip velocity v and normal force N.

    Attributes
    ----------
    mu
        Friction coefficient, dimensionless.
    eps
        Slip speed below which the force falls to zero, m/s.

    Examples
    --------
    >>> import tippetop as tt
    >>> law = tt.RegularizedCoulombFriction(mu=0.3, eps=1e-3).law
    >>> [round(law.traction((slip, 0.0), (0.0, 0.0, 0.0)).force[0], 3) for slip in (1e-3, 0.1)]
    [-0.212, -0.3]
    """

    kind: Literal["regularized_coulomb"] = "regularized_coulomb"
    mu: Annotated[NotNegative, Quantity("1", "friction coefficient")]
    eps: Annotated[
        float,
        Field(ge=LEAST_EPS),
        NO_WORD,
        Quantity("m s-1", "slip speed below which friction falls to zero"),
    ] = 1e-3

    @property
    def law(self) -> FrictionLaw:
        """Law in the form that the mechanics uses."""
        return RegularizedCoulombLaw(self.mu, self.eps)


class CoulombFriction(Friction):
    """Dry friction by Coulomb's law: ``-mu N v / |v|`` for slip velocity v and normal force N.

    At v = 0 the force is any one up to mu N, as needed to keep v = 0: the contact sticks, and the
    top rolls. Drilling, which is turning about the vertical on the spot, is not resisted.

    Attributes
    ----------
    mu
        Friction coefficient.

    Examples
    --------
    >>> import tippetop as tt
    >>> problem = tt.presets.report_problem().replace({"friction.kind": "coulomb"})
    >>> run = tt.simulate(problem, duration=1.0)
    >>> str(run["event_kind"].values[0]), bool(run["turnover_time"].isnull())  # it sticks and rolls
    ('stick', True)
    """

    kind: Literal["coulomb"] = "coulomb"
    mu: Annotated[Positive, Quantity("1", "Coulomb friction coefficient")]

    @property
    def law(self) -> FrictionLaw:
        """Law in the form that the mechanics uses."""
        return CoulombLaw(self.mu)


class StaticCoulombFriction(Friction):
    """Dry friction that holds more than it resists sliding: ``-mu N v / |v|``, and at v = 0 any
    force up to ``static_mu N``.

    A contact that sticks goes on sticking until more than static_mu N is needed; friction then
    falls to mu N at once. One that slides sticks again where its slip ends and static_mu N holds
    it. Under the same force one body may stick, and another, launched with some slip, slide on.

    Attributes
    ----------
    mu
        Coefficient of sliding friction.
    static_mu
        Coefficient of static friction, not less than `mu`.

    Examples
    --------
    >>> import tippetop as tt
    >>> law = tt.StaticCoulombFriction(mu=0.1, static_mu=0.3).law
    >>> law.traction((0.5, 0.0), (0.0, 0.0, 0.0)).force  # slipping at 0.5 m/s
    (-0.1, -0.0)
    >>> [law.reserve(1.0, (needed, 0.0), 0.0) > 0.0 for needed in (0.2, 0.4)]  # sticking
    [True, False]
    """

    kind: Literal["static_coulomb"] = "static_coulomb"
    mu: Annotated[Positive, Quantity("1", "coefficient of sliding friction")]
    static_mu: Annotated[Positive, Quantity("1", "coefficient of static friction")]

    @model_validator(mode="after")
    def _holds_more(self) -> Self:
        if self.static_mu < self.mu:
            raise InvalidInput("static_mu", self.static_mu, f"at least mu, {self.mu:.4g}")
        return self

    @property
    def law(self) -> FrictionLaw:
        """Law in the form that the mechanics uses."""
        return StaticCoulombLaw(self.mu, self.static_mu)


class ContensouFriction(Friction):
    """Dry friction of a round contact patch that slides and drills (Contensou 1963).

    Coulomb's law acts on every element of the patch, against its own velocity: drilling reduces the
    resistance to sliding, and sliding reduces that to drilling. The contact sticks while force and
    torque are within the limit surface.

    Attributes
    ----------
    mu
        Friction coefficient.
    patch_radius
        Radius R of the patch, m; see `hertz_patch_radius`.
    pressure
        "hertz": the exact law for the pressure of Hertz's contact; "ellipsoidal": its limit surface
        approximated by an ellipsoid with the same drilling torque, semi-axis (3 pi/16) R (Leine
        and Glocker 2003).

    Examples
    --------
    >>> import tippetop as tt
    >>> law = tt.ContensouFriction(mu=0.3, patch_radius=1e-3).law
    >>> slip, still, spinning = (0.001, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 100.0)
    >>> slow, fast = (law.traction(slip, spin).force[0] for spin in (still, spinning))
    >>> round(slow, 4), round(fast, 4)  # drilling reduces the resistance to sliding
    (-0.3, -0.0035)
    """

    kind: Literal["contensou"] = "contensou"
    mu: Annotated[Positive, Quantity("1", "Coulomb friction coefficient")]
    patch_radius: Annotated[Positive, Quantity("m", "radius of the contact patch")]
    pressure: Literal["hertz", "ellipsoidal"] = "hertz"

    @property
    def law(self) -> FrictionLaw:
        """Law in the form that the mechanics uses."""
        return (HertzLaw if self.pressure == "hertz" else EllipsoidalLaw)(
            self.mu, self.patch_radius
        )

    def fits(self, size: Scalar) -> bool:
        """Return whether the patch is no larger than the body, and not too small to drill."""
        fits: bool = (self.patch_radius >= LEAST_PATCH * size) & (self.patch_radius <= size)
        return fits
