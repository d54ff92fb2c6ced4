"""Outer surfaces of bodies as users state them, with the position of the centre of mass."""

import math
from abc import abstractmethod
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from tippetop.mechanics.laws.face_friction import LEAST_WIDTH
from tippetop.mechanics.surfaces.surface import (
    MeridianSurface,
    OvalSurface,
    PointSurface,
    RingSurface,
    SphereSurface,
    SpheroidSurface,
    Surface,
)
from tippetop.support.errors import InvalidInput
from tippetop.support.validation import NO_WORD, NotNegative, Number, Positive, Quantity, Variant

Center = Annotated[Number, Quantity("m", "height of the surface's middle above the centre of mass")]


class Shape(Variant):
    """Base class of the outer surfaces of bodies, with the position of the centre of mass in them.

    Attributes
    ----------
    kind
        Name of the shape; a subclass declares it: ``kind: Literal["cone"] = "cone"``.

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
        """Surface about the centre of mass, in the form that the mechanics uses."""


class EccentricSphere(Shape):
    """Sphere whose centre of mass is below its centre: the tippe top.

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
        """Surface about the centre of mass, in the form that the mechanics uses."""
        return SphereSurface(self.radius, self.eccentricity * self.radius)


class Sphere(Shape):
    """Sphere with its centre anywhere on the axis: the tip of a stem, or one of two hurricane
    balls; with radius 0 a sharp tip.

    Attributes
    ----------
    radius
        Radius of the sphere, m; 0 for a sharp tip, such as the point of a peg top.
    center
        Height of its centre above the centre of mass, along the axis, m; not 0 for a sharp tip.

    Examples
    --------
    >>> import tippetop as tt
    >>> bowl, tip = tt.Sphere(radius=0.02, center=0.006), tt.Sphere(radius=0.003, center=0.025)
    >>> top = tt.Body(mass=0.02, shape=[bowl, tip], I1=3.0e-6, I3=3.2e-6)
    >>> [shape.kind for shape in top.shapes]
    ['sphere', 'sphere']
    """

    kind: Literal["sphere"] = "sphere"
    radius: Annotated[NotNegative, Quantity("m", "radius of the sphere")]
    center: Center

    @model_validator(mode="after")
    def _has_a_size(self) -> Self:
        if self.radius == 0.0 and self.center == 0.0:
            accepted = "a height other than 0: a sharp tip is not at the centre of mass"
            raise InvalidInput("center", self.center, accepted)
        return self

    @property
    def surface(self) -> Surface:
        """Surface about the centre of mass, in the form that the mechanics uses."""
        if self.radius == 0.0:
            return PointSurface(self.center)
        return SphereSurface(self.radius, self.center)


class Ring(Shape):
    """Ring about the axis, sharp or round: the edge of a disk or a coin.

    Attributes
    ----------
    radius
        Radius of the circle in the middle of the ring, m.
    center
        Height of its plane above the centre of mass, along the axis, m.
    tube
        Radius of the ring's cross-section, m; 0 for a sharp edge.
    inner_radius
        Inner radius of the flat face that the ring bounds, m, less than `radius`; 0 for a disk.

    Examples
    --------
    >>> import tippetop as tt
    >>> tt.Ring(radius=0.0125, center=0.0).surface.height(0.0)  # standing on its edge
    0.0125
    """

    kind: Literal["ring"] = "ring"
    radius: Annotated[Positive, Quantity("m", "radius of the ring's circle")]
    center: Center = 0.0
    tube: Annotated[NotNegative, Quantity("m", "radius of the ring's tube")] = 0.0
    inner_radius: Annotated[NotNegative, Quantity("m", "inner radius of the ring's face")] = 0.0

    @model_validator(mode="after")
    def _has_a_face(self) -> Self:
        widest = (1.0 - LEAST_WIDTH) * self.radius
        if not self.inner_radius <= widest:
            accepted = f"from 0 to {widest:.4g} m, less than the ring's radius"
            raise InvalidInput("inner_radius", self.inner_radius, accepted)
        return self

    @property
    def surface(self) -> Surface:
        """Surface about the centre of mass, in the form that the mechanics uses."""
        return RingSurface(self.radius, self.center, self.tube, self.inner_radius)


LengthsOfArcs = Annotated[
    tuple[NotNegative, ...], Field(min_length=2, max_length=14), Quantity("m", "radii of the arcs")
]
TiltsOfArcs = Annotated[
    tuple[Number, ...],
    Field(min_length=1, max_length=13),
    Quantity("rad", "tilts at which one arc follows another"),
]

ON_AXIS = 1e-12
"""Distance of an arc's centre from the axis up to which it is on it, in sizes: rounding."""


class Meridian(Shape):
    """Convex surface whose meridian is arcs that continue each other: a ball that is cut off.

    From tilt 0 on the body stands on each arc up to a tilt, from which on it stands on the next
    one. An arc of radius 0 is a sharp edge, such as that of a cut. An end that is no sphere is
    flat, but no face as that of a `Ring`: a run in which the body comes to lie on it ends as
    "failed".

    Attributes
    ----------
    tubes
        Radii of the arcs, m.
    tilts
        Tilts at which each arc ends and the next begins, rad, increasing; one less than arcs.
    center
        Height of the first arc's centre above the centre of mass, along the axis, m.
    radius
        Distance of the first arc's centre from the axis, m; 0 for a sphere.

    Examples
    --------
    >>> import tippetop as tt
    >>> from math import acos
    >>> cut = tt.Meridian(tubes=[0.02, 0.0], tilts=[acos(-0.4)], center=0.004)  # 8 mm up
    >>> ball = tt.Sphere(radius=0.02, center=0.004)
    >>> cut.surface.height(-0.3) == ball.surface.height(-0.3)
    True
    >>> cut.surface.height(-0.9) < ball.surface.height(-0.9)
    True
    """

    kind: Literal["meridian"] = "meridian"
    tubes: LengthsOfArcs
    tilts: TiltsOfArcs
    center: Center
    radius: Annotated[Number, Quantity("m", "distance of the first arc's centre from the axis")] = (
        0.0
    )

    @model_validator(mode="after")
    def _is_convex(self) -> Self:
        if len(self.tilts) != len(self.tubes) - 1:
            raise InvalidInput(
                "tilts", self.tilts, f"{len(self.tubes) - 1} tilts between {len(self.tubes)} arcs"
            )
        ends = (0.0, *self.tilts, math.pi)
        for number, tilt in enumerate(self.tilts):
            if not ends[number] < tilt < math.pi:
                raise InvalidInput(
                    f"tilts.{number}", tilt, "an angle above the one before, and below pi"
                )
        size = sum(self.tubes)
        if not size > 0.0:
            raise InvalidInput("tubes", self.tubes, "radii of which one is more than 0")
        for number, arc in enumerate(self.surface.arcs):
            for tilt in ends[number : number + 2]:
                if arc.radius + arc.tube * math.sin(tilt) < -ON_AXIS * size:
                    raise InvalidInput(
                        f"tubes.{number}", arc.tube, "the radius of an arc beside the axis"
                    )
        return self

    @property
    def surface(self) -> MeridianSurface:
        """Surface about the centre of mass, in the form that the mechanics uses."""
        cosines = tuple([math.cos(tilt) for tilt in self.tilts])
        none = tuple([False for _ in self.tubes])
        about = MeridianSurface(self.radius, self.center, self.tubes, cosines, none)
        within = ON_AXIS * sum(self.tubes)
        spheres = tuple([abs(arc.radius) <= within for arc in about.arcs])
        return about._replace(spheres=spheres)


DEGREE = 16
"""Degree of the support functions of ovals: enough for eggs as slender as 2 to 1 within 1e-5."""

Support = Annotated[
    tuple[Number, ...],
    Field(min_length=DEGREE + 1, max_length=DEGREE + 1),
    Quantity("m", "coefficients of the support function"),
]


class Oval(Shape):
    """Smooth convex surface whose support function is a polynomial: an egg, or a drawn body.

    Attributes
    ----------
    support
        Coefficients of h(c) = a_0 + a_1 c + a_2 c^2 + ..., the height of the centre of mass above
        the table with c the cosine of the tilt, m: 17 of them, the first positive.

    Examples
    --------
    >>> import tippetop as tt
    >>> oval = tt.Oval(support=[0.02, -0.003, 0.002] + 14 * [0.0])
    >>> round(oval.surface.height(1.0), 6), oval.surface.height(0.0)
    (0.019, 0.02)
    """

    kind: Literal["oval"] = "oval"
    support: Support

    @model_validator(mode="after")
    def _is_convex(self) -> Self:
        surface = self.surface
        for step in range(TILT_STEPS + 1):
            c = math.cos(math.pi * step / TILT_STEPS)
            slope = surface.slope(c)
            across = surface.height(c) - c * slope
            if not (across > 0.0 and across + surface.curvature(c) * (1.0 - c * c) > 0.0):
                accepted = f"those of a convex surface, also at a tilt of {math.acos(c):.4g} rad"
                raise InvalidInput("support", self.support, accepted)
        return self

    @property
    def surface(self) -> Surface:
        """Surface about the centre of mass, in the form that the mechanics uses."""
        return OvalSurface(self.support)


TILT_STEPS = 180
"""Steps of the tilt at which the convexity of an oval is checked."""

MOST_ASPECT = 1e6
"""Largest ratio of a spheroid's semi-axes: its curvature needs the square, which is then still
above rounding.
"""


class Spheroid(Shape):
    """Spheroid, such as a spinning egg.

    Attributes
    ----------
    across
        Semi-axis across the axis of symmetry, m.
    along
        Semi-axis along the axis of symmetry, m.
    center
        Height of its centre above the centre of mass, along the axis, m.

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
    center: Center = 0.0

    @model_validator(mode="after")
    def _has_a_thickness(self) -> Self:
        if not 1.0 / MOST_ASPECT <= self.along / self.across <= MOST_ASPECT:
            accepted = f"within a factor of {MOST_ASPECT:.1g} of across = {self.across:g}"
            raise InvalidInput("along", self.along, accepted)
        return self

    @property
    def surface(self) -> Surface:
        """Surface about the centre of mass, in the form that the mechanics uses."""
        return SpheroidSurface(self.across, self.along, self.center)
