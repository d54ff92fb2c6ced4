"""Bodies of revolution as users state them, validated, and as they are turned on a lathe."""

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
def _validated_profile(
    points: tuple[tuple[float, ...], ...] | None,
) -> tuple[tuple[float, ...], ...] | None:
    """Return the points of a profile; raise `InvalidInput` if no body has them."""
    if points is not None:
        from tippetop.lathe.profile import profile_of  # noqa: PLC0415 - slow to import

        profile_of(points)
    return points


class Body(Part):
    """Rigid body of revolution.

    Attributes
    ----------
    mass
        Mass, kg.
    shape
        Outer surface, with the position of the centre of mass in it; or several surfaces, whose
        convex hull the body is.
    I1
        Moment of inertia about the centre of mass, transverse to the axis of symmetry, kg m^2.
    I3
        Moment of inertia about the axis of symmetry, kg m^2; at most 2 I1.
    profile
        Profile that pictures show if it fits the surfaces: points (distance from the axis, height
        above the centre of mass) or, at the end of an arc, (distance, height, radius), m, as those
        of `tippetop.lathe.workpiece.Workpiece`. Without it, pictures show the hull of the surfaces.

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
        Points | None,
        AfterValidator(_validated_profile),
        Quantity("m", "profile that pictures show"),
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
            if len(self.shapes) > 1 and not reaches_out(number, self.shapes):
                numbers = ", ".join(f"{name} = {value}" for name, value in shape)
                raise InvalidInput(
                    f"shape.{number}",
                    Described(numbers),
                    "",
                    "is enclosed by the others",
                    "omit it",
                )
        return self

    @property
    def shapes(self) -> tuple[Shape, ...]:
        """Surfaces of the body."""
        return self.shape if isinstance(self.shape, tuple) else (self.shape,)

    @property
    def surface(self) -> Surface:
        """Surface in the form that the mechanics uses: a `Hull` if there are several."""
        if isinstance(self.shape, tuple):
            return Hull.of(tuple(shape.surface for shape in self.shape))
        return self.shape.surface

    # translate: skip
    @classmethod
    def turned(
        cls,
        profile: "Sequence[Sequence[float]] | Path | str | Workpiece",
        density: float | str | None = None,
        *,
        inserts: "Sequence[Insert | Mapping[str, Any]] | None" = None,
        unit: Literal["m", "cm", "mm", "in"] | None = None,
        tolerance: float | None = None,
        axis: str | None = None,
        frame: bool | None = None,
        upside_down: bool = False,
        whole: bool = False,
    ) -> Self:
        """Return the body that a lathe turns: mass, moments of inertia and touching surfaces.

        They are exact for the profile, whose edges are straight or arcs of circles, and which
        pictures show. Rows of points along a smooth curve are replaced by arcs, within the
        tolerance.

        Parameters
        ----------
        profile
            Points (distance from the axis, height) or, at the end of an arc, (distance, height,
            radius), as in `tippetop.lathe.workpiece.Workpiece`; or such a workpiece; or a .toml,
            .csv, .svg, .dxf, .stl, .obj, .ply or .off file, as in
            `tippetop.lathe.files.read_workpiece`.
        density
            Density, kg/m^3, or the name of a material, as in `tippetop.lathe.workpiece.Workpiece`.
        inserts
            Cavities and weights: `tippetop.lathe.workpiece.Insert` or their fields, profile and
            density.
        unit
            Unit of the profile's numbers: by default "m", for a drawing its physical size, and for
            a mesh "mm".
        tolerance
            Largest distance of the body from the points of the profile, in sizes of it: 1e-4 by
            default; with 0, every edge is as stated.
        axis
            Place of the axis in a drawing, as "x=10", or its direction in a mesh, as "z"; sought by
            default.
        frame
            Whether a rectangle around all else in a drawing is a frame, which is left out, or the
            body; by default it is a frame, and an error if it may be either.
        upside_down
            Turn the body over: what is below in its profile comes up.
        whole
            Accept surfaces of which the body has only a part, such as a cut sphere, as if they were
            complete. Otherwise the body is refused if such a surface reaches out of it.

        Raises
        ------
        InvalidInput
            If the profile is not that of a body, or if the touching surfaces are not of the
            supported kinds.
        FileTrouble
            If a file cannot be read.
        """
        from tippetop.lathe.files import read_workpiece  # noqa: PLC0415 - slow to import
        from tippetop.lathe.workpiece import Workpiece  # noqa: PLC0415
        from tippetop.problem.turned import turned_fields  # noqa: PLC0415

        settings = {"density": density, "inserts": inserts, "unit": unit, "tolerance": tolerance}
        fields = {name: value for name, value in settings.items() if value is not None}
        for name, value in (("axis", axis), ("frame", frame)):
            if value is not None and not isinstance(profile, str | Path):
                raise InvalidInput(name, value, "none: the profile is stated from the axis")
        match profile:
            case Workpiece():
                workpiece = profile.model_copy(update=fields)
            case str() | Path():
                workpiece = read_workpiece(profile, axis=axis, frame=frame, **fields)
            case _:
                workpiece = Workpiece(**{"profile": profile, **fields})
        if upside_down:
            workpiece = workpiece.turned_over()
        mass, shapes, I1, I3, shown = turned_fields(workpiece, whole)
        shape = shapes[0] if len(shapes) == 1 else shapes
        return cls(mass=mass, shape=shape, I1=I1, I3=I3, profile=shown)


TILTS, SEARCHES = 64, 5
"""Tilts at which it is checked whether a surface is outermost, and repetitions around the best."""

REACH = 1e-9
"""Length by which a surface must reach beyond the others, in its sizes: above rounding."""


def reaches_out(number: int, shapes: tuple[Shape, ...]) -> bool:
    """Return whether a surface touches the table at some tilt; True if arithmetic overflows."""
    surface = shapes[number].surface
    others = [shape.surface for place, shape in enumerate(shapes) if place != number]
    low, high = 0.0, math.pi
    for _ in range(SEARCHES):
        tilts = [low + (high - low) * k / TILTS for k in range(TILTS + 1)]
        try:
            ahead = [
                surface.height(c) - max(second.height(c) for second in others)
                for c in map(math.cos, tilts)
            ]
        except ArithmeticError:
            return True
        if max(ahead) > REACH * surface.size:
            return True
        best = ahead.index(max(ahead))
        low, high = tilts[max(best - 1, 0)], tilts[min(best + 1, TILTS)]
    return False
