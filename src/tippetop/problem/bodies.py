"""Bodies of revolution as users state them, validated, and as a lathe makes them."""

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self

from pydantic import AfterValidator, model_validator

from tippetop.mechanics.surfaces.hull import Hull
from tippetop.mechanics.surfaces.surface import Surface
from tippetop.problem.shapes import Shape
from tippetop.support.errors import Described, InvalidInput
from tippetop.support.validation import ONE_OR_SEVERAL, Part, Points, Positive, Quantity

if TYPE_CHECKING:
    from tippetop.lathe.workpiece import Insert, Workpiece


# translate: skip
def _a_profile(
    points: tuple[tuple[float, ...], ...] | None,
) -> tuple[tuple[float, ...], ...] | None:
    """Refuse points of which no body could be turned."""
    if points is not None:
        from tippetop.lathe.profile import profile_of  # noqa: PLC0415 - slow to import

        profile_of(points)
    return points


class Body(Part):
    """A rigid body of revolution.

    Attributes
    ----------
    mass
        Mass, kg.
    shape
        Outer surface, and where the centre of mass is in it; or several, whose convex hull the body
        is.
    I1
        Moment of inertia about the centre of mass, transverse to the axis of symmetry, kg m^2.
    I3
        Moment of inertia about the axis of symmetry, kg m^2; at most 2 I1.
    profile
        What the body looks like, as pictures of it show it where it fits its surfaces: points
        (distance from the axis, height above the centre of mass) or, at the end of an arc,
        (distance, height, radius), m, as those of `tippetop.lathe.workpiece.Workpiece`. Without it,
        pictures show the hull of its surfaces.

    Examples
    --------
    >>> import tippetop as tt
    >>> sphere = tt.EccentricSphere(radius=0.02, eccentricity=0.3)
    >>> top = tt.Body(mass=0.02, shape=sphere, I1=3.0e-6, I3=3.2e-6)
    >>> tt.Body(mass=0.02, shape=sphere, I1=3.0e-6, I3=7e-6)
    Traceback (most recent call last):
        ...
    tippetop.support.errors.InvalidInput: I3: 7e-06 is more than any body with this I1 has
    (write at most 2 I1 = 6e-06)
    """

    mass: Annotated[Positive, Quantity("kg", "mass of the body")]
    shape: Annotated[Shape | tuple[Shape, ...], ONE_OR_SEVERAL]
    I1: Annotated[
        Positive, Quantity("kg m2", "moment of inertia transverse to the axis of symmetry")
    ]
    I3: Annotated[Positive, Quantity("kg m2", "moment of inertia along the axis of symmetry")]
    profile: Annotated[
        Points | None, AfterValidator(_a_profile), Quantity("m", "profile that pictures show")
    ] = None

    @model_validator(mode="after")
    def _can_exist(self) -> Self:
        if self.I3 > 2 * self.I1:
            raise InvalidInput(
                "I3",
                self.I3,
                f"at most 2 I1 = {2 * self.I1:g}",
                "is more than any body with this I1 has",
            )
        for number, shape in enumerate(self.shapes):
            if len(self.shapes) > 1 and not _reaches_out(number, self.shapes):
                numbers = ", ".join(f"{name} = {value}" for name, value in shape)
                raise InvalidInput(
                    f"shape.{number}",
                    Described(numbers),
                    "",
                    "is enclosed by the others",
                    "leave it out",
                )
        return self

    @property
    def shapes(self) -> tuple[Shape, ...]:
        """Its surfaces."""
        return self.shape if isinstance(self.shape, tuple) else (self.shape,)

    @property
    def surface(self) -> Surface:
        """Its surface, from the centre of mass, as the mechanics takes it: a `Hull` of several."""
        if isinstance(self.shape, tuple):
            return Hull.of(tuple(shape.surface for shape in self.shape))
        return self.shape.surface

    # translate: skip
    @classmethod
    def turned(
        cls,
        profile: "Sequence[Sequence[float]] | Path | str | Workpiece",
        density: float | None = None,
        *,
        inserts: "Sequence[Insert | Mapping[str, Any]] | None" = None,
        unit: Literal["m", "cm", "mm", "in"] | None = None,
        tolerance: float | None = None,
        axis: str | None = None,
        whole: bool = False,
    ) -> Self:
        """The body that a lathe makes: mass, moments of inertia and the surfaces it touches the
        table with.

        They are exact for the profile, whose edges are straight or arcs of circles, and which
        pictures show. Points in a row along a smooth curve stand for arcs, within the tolerance.

        Parameters
        ----------
        profile
            Points (distance from the axis, height) or, at the end of an arc, (distance, height,
            radius), as in `tippetop.lathe.workpiece.Workpiece`; or such a workpiece; or a .toml,
            .csv, .svg, .dxf or .stl file, as in `tippetop.lathe.files.read_workpiece`.
        density
            Density, kg/m^3.
        inserts
            Cavities and weights: `tippetop.lathe.workpiece.Insert` or their fields, profile and
            density.
        unit
            What the numbers of the profile are in: "m" if left out; of a drawing, its physical
            size, and of a mesh mm.
        tolerance
            How far the body may be from the points of the profile, in sizes of it: 1e-4 if left
            out; with 0, every edge is as it is stated.
        axis
            Where the axis of a drawing is, as "x=10", or its direction in a mesh, as "z"; it is
            found if left out.
        whole
            Take spheres and rings that the body has only a part of as whole. Otherwise it is
            refused if it does not stay within them.

        Raises
        ------
        InvalidInput
            If the profile is no body's, or if no surfaces that are known make up what it touches
            with.
        FileTrouble
            If a file cannot be read.
        """
        from tippetop.lathe.files import read_workpiece  # noqa: PLC0415 - slow to import
        from tippetop.lathe.workpiece import Workpiece  # noqa: PLC0415
        from tippetop.problem.turned import turned_fields  # noqa: PLC0415

        given = {"density": density, "inserts": inserts, "unit": unit, "tolerance": tolerance}
        fields = {name: value for name, value in given.items() if value is not None}
        if axis is not None and not isinstance(profile, str | Path):
            raise InvalidInput("axis", axis, "none: the profile is stated from the axis")
        match profile:
            case Workpiece():
                piece = profile.model_copy(update=fields)
            case str() | Path():
                piece = read_workpiece(profile, axis=axis, **fields)
            case _:
                piece = Workpiece(**{"profile": profile, **fields})
        mass, shapes, I1, I3, shown = turned_fields(piece, whole)
        shape = shapes[0] if len(shapes) == 1 else shapes
        return cls(mass=mass, shape=shape, I1=I1, I3=I3, profile=shown)


LOOKS, SEARCHES = 64, 5
"""Looks at the tilts where a surface may be outermost, repeated so often around the best of them.
"""

REACH = 1e-9
"""How far a surface must reach beyond the others, in its sizes, to be one of the body's."""


def _reaches_out(number: int, shapes: tuple[Shape, ...]) -> bool:
    """Whether a surface touches the table at some tilt; also where no computer can tell."""
    own = shapes[number].surface
    others = [shape.surface for place, shape in enumerate(shapes) if place != number]
    low, high = 0.0, math.pi
    for _ in range(SEARCHES):
        looks = [low + (high - low) * k / LOOKS for k in range(LOOKS + 1)]
        try:
            ahead = [
                own.height(c) - max(other.height(c) for other in others)
                for c in map(math.cos, looks)
            ]
        except ArithmeticError:
            return True
        if max(ahead) > REACH * own.size:
            return True
        best = ahead.index(max(ahead))
        low, high = looks[max(best - 1, 0)], looks[min(best + 1, LOOKS)]
    return False
