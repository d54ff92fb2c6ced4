"""Bodies of revolution as users state them, validated: their shapes, masses and moments of inertia."""

from abc import abstractmethod
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from tippetop.errors import InvalidInput
from tippetop.mechanics.surface import SphereSurface, SpheroidSurface, Surface
from tippetop.validation import NO_WORD, OF_ITS_KIND, Part, Positive, Quantity, Variant


class Shape(Variant):
    """The outer surface of a body, and where the centre of mass is in it; a kind of it is a subclass.

    Attributes
    ----------
    kind
        The word for the kind, in a subclass with a default: ``kind: Literal["cone"] = "cone"``.

    Examples
    --------
    >>> import tippetop as tt
    >>> isinstance(tt.Spheroid(across=0.02, along=0.03), tt.Shape)
    True
    >>> sorted(tt.Shape.kinds)[:1]
    ['eccentric_sphere']
    """

    kind: str

    @property
    @abstractmethod
    def surface(self) -> Surface:
        """The outer surface, from the centre of mass, as the mechanics takes it."""


class EccentricSphere(Shape):
    """A sphere whose centre of mass is off its centre: the tippe top.

    Attributes
    ----------
    radius
        Radius of the sphere, m.
    eccentricity
        Distance of the centre of mass from the centre, in radii, between 0 and 1.

    Examples
    --------
    >>> import tippetop as tt
    >>> tt.EccentricSphere(radius=0.02, eccentricity=0.3)
    EccentricSphere(kind='eccentric_sphere', radius=0.02, eccentricity=0.3)
    """

    kind: Literal["eccentric_sphere"] = "eccentric_sphere"
    radius: Annotated[Positive, Quantity("m", "radius of the sphere")]
    eccentricity: Annotated[
        float,
        Field(gt=0, lt=1),
        NO_WORD,
        Quantity("1", "distance of the centre of mass from the centre, in radii"),
    ]

    @property
    def surface(self) -> Surface:
        """The outer surface, from the centre of mass, as the mechanics takes it."""
        return SphereSurface(self.radius, self.eccentricity * self.radius)


class Spheroid(Shape):
    """A spheroid with its centre of mass at its centre: the spinning egg.

    Attributes
    ----------
    across, along
        Semi-axes across and along the axis of symmetry, m.

    Examples
    --------
    >>> import tippetop as tt
    >>> egg = tt.Spheroid(across=0.02, along=0.03)
    >>> egg.surface.height(1.0), egg.surface.height(0.0)  # of the centre, standing and lying
    (0.03, 0.02)
    """

    kind: Literal["spheroid"] = "spheroid"
    across: Annotated[Positive, Quantity("m", "semi-axis across the axis of symmetry")]
    along: Annotated[Positive, Quantity("m", "semi-axis along the axis of symmetry")]

    @property
    def surface(self) -> Surface:
        """The outer surface, from the centre of mass, as the mechanics takes it."""
        return SpheroidSurface(self.across, self.along)


class Body(Part):
    """A rigid body of revolution.

    Attributes
    ----------
    mass
        Mass, kg.
    shape
        Outer surface, and where the centre of mass is in it.
    I1, I3
        Principal moments of inertia about the centre of mass, kg m^2: transverse to and along the axis of
        symmetry. No body has I3 > 2 I1.

    Examples
    --------
    >>> import tippetop as tt
    >>> sphere = tt.EccentricSphere(radius=0.02, eccentricity=0.3)
    >>> top = tt.Body(mass=0.02, shape=sphere, I1=3.0e-6, I3=3.2e-6)
    >>> tt.Body(mass=0.02, shape=sphere, I1=3.0e-6, I3=7e-6)
    Traceback (most recent call last):
    tippetop.errors.InvalidInput: I3 = 7e-06 is not possible; accepted: at most 2 I1 = 6e-06, as for any body
    """

    mass: Annotated[Positive, Quantity("kg", "mass of the body")]
    shape: Annotated[Shape, OF_ITS_KIND]
    I1: Annotated[Positive, Quantity("kg m2", "moment of inertia transverse to the axis of symmetry")]
    I3: Annotated[Positive, Quantity("kg m2", "moment of inertia along the axis of symmetry")]

    @model_validator(mode="after")
    def _can_exist(self) -> Self:
        if self.I3 > 2 * self.I1:
            raise InvalidInput("I3", self.I3, f"at most 2 I1 = {2 * self.I1:g}, as for any body")
        return self
