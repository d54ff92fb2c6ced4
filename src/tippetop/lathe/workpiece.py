"""Bodies turned on a lathe, as users state them: a profile, a density, and inserts."""

# translate module: numpy

from collections.abc import Sequence
from functools import cached_property
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from tippetop.lathe.fitting import TOLERANCE, Fit, fit
from tippetop.lathe.hull import ConvexHull, hull_of
from tippetop.lathe.mass import MassProperties, mass_properties
from tippetop.lathe.materials import MATERIAL
from tippetop.lathe.profile import Profile, area_of, profile_of, require_points
from tippetop.lathe.rounding import COARSEST, usual_rounding
from tippetop.support.errors import Described, InvalidInput
from tippetop.support.validation import NO_WORD, NotNegative, Part, Points, Quantity

UNITS = {"m": 1.0, "cm": 0.01, "mm": 0.001, "in": 0.0254}
"""Units of profiles, m."""

DENSEST = 1e6
"""Largest density, kg/m^3: far above that of any metal."""

LIGHTEST = 1e-6
"""Smallest density, kg/m^3: far below that of any gas."""


class Insert(Part):
    """Part inside a body, which replaces the material in its place.

    Attributes
    ----------
    profile
        Points of its profile, as those of the body.
    density
        Density, kg/m^3, or the name of a material: 0 for a cavity.

    Examples
    --------
    >>> import tippetop as tt
    >>> steel = tt.Insert(profile=[(0, -15), (0, -5, 5)], density=7800)
    >>> profile = [(0, -20), (0, 20, 20)]
    >>> ball = tt.Workpiece(profile=profile, density=700, unit="mm", inserts=[steel])
    >>> round(1e3 * ball.mass_properties.center, 3)  # mm
    -1.368
    """

    profile: Points
    density: Annotated[
        NotNegative, Field(le=DENSEST), Quantity("kg m-3", "density of the insert"), MATERIAL
    ]


class Workpiece(Part):
    """Body turned on a lathe: the volume that a profile sweeps about the axis.

    Attributes
    ----------
    profile
        Points (distance from the axis, height along it), from the axis to the axis, or from one
        point to itself. The edge to a point is straight or, with a third number, an arc of this
        radius: positive if it turns to the left, as the outside of a ball does upwards. No arc is
        more than half a circle.
    density
        Density, kg/m^3, or the name of a material, such as "beech"; of a printed part with its
        infill, "PLA 20 %".
    inserts
        Cavities and weights in it; one may be inside another.
    unit
        Unit of the numbers of profiles: "m", "cm", "mm" or "in".
    tolerance
        Largest distance of the body from the points of its profile, in sizes of the profile. Rows
        of points along an arc or another smooth curve are replaced by it (see
        `tippetop.lathe.fitting.fit`); with 0, every edge is as stated.

    Examples
    --------
    >>> import tippetop as tt
    >>> ball = tt.Workpiece(profile=[(0, -20), (0, 20, 20)], density=700, unit="mm")
    >>> round(1e3 * ball.mass_properties.mass, 3)  # g
    23.457
    """

    profile: Points
    density: Annotated[
        float,
        Field(ge=LIGHTEST, le=DENSEST),
        NO_WORD,
        Quantity("kg m-3", "density of the body"),
        MATERIAL,
    ]
    inserts: tuple[Insert, ...] = ()
    unit: Literal["m", "cm", "mm", "in"] = "m"
    tolerance: Annotated[NotNegative, Field(le=0.05), Quantity("1", "tolerance of the fit")] = (
        TOLERANCE
    )

    @model_validator(mode="after")
    def _is_a_body(self) -> Self:
        outline = self.outline
        for number, inner in enumerate(self.insides):
            field = f"inserts.{number}.profile"
            sides = inner.sides(outline, self._flush_within(number))
            if "out" in sides:
                raise InvalidInput(
                    field,
                    Described("a line that leaves the body"),
                    "one inside the body's profile; tolerance = 0 takes every edge of both as"
                    " stated, without a fit of arcs",
                )
            if "on" in sides and not self.inserts[number].density:
                raise InvalidInput(
                    field,
                    Described("an open cavity"),
                    "one inside",
                    "is part of the body's own profile",
                    "draw it there",
                )
            for earlier in self.insides[:number]:
                if not (
                    _apart(inner, earlier) or _within(inner, earlier) or _within(earlier, inner)
                ):
                    raise InvalidInput(
                        field,
                        Described("a line across another insert's"),
                        "one beside or inside it; a bore that goes on into another insert as two"
                        " inserts, which meet where that begins",
                    )
        return self

    @cached_property
    def fit(self) -> Fit:
        """Profile fitted to the stated points, in their unit."""
        return _fit(self.profile, self.tolerance, "profile")

    @property
    def deviation(self) -> float:
        """Largest distance of a point of the profile from the body, m."""
        return UNITS[self.unit] * self.fit.deviation

    def _flush_within(self, number: int) -> float:
        """Return the distance within which an insert's edges lie on those of the body, m.

        Two files of one surface differ by the digits of their numbers and by the fits to them.
        """
        stated = self.inserts[number].profile
        fits = self.fit.deviation + self.insert_fits[number].deviation
        digits = usual_rounding(self.profile) + usual_rounding(stated)
        unit = UNITS[self.unit]
        return unit * fits + min(unit * digits, COARSEST * self.outline.size)

    @cached_property
    def insert_fits(self) -> tuple[Fit, ...]:
        """Profiles of the inserts fitted to the stated points, in their unit."""
        return tuple(
            [
                _fit(insert.profile, self.tolerance, f"inserts.{number}.profile")
                for number, insert in enumerate(self.inserts)
            ]
        )

    # translate: skip
    def turned_over(self) -> "Workpiece":
        """Return the workpiece upside down.

        Examples
        --------
        >>> import tippetop as tt
        >>> cone = tt.Workpiece(profile=[(0, 0), (20, 30), (0, 30)], density=700, unit="mm")
        >>> round(1e3 * cone.mass_properties.center, 2)
        22.5
        >>> round(1e3 * cone.turned_over().mass_properties.center, 2)
        -22.5
        """
        inserts = tuple(
            insert.model_copy(update={"profile": _mirrored(insert.profile)})
            for insert in self.inserts
        )
        return self.model_copy(update={"profile": _mirrored(self.profile), "inserts": inserts})

    @cached_property
    def outline(self) -> Profile:
        """Profile of the body, m."""
        return profile_of(self.fit.points, UNITS[self.unit])

    @cached_property
    def insides(self) -> tuple[Profile, ...]:
        """Profiles of the inserts, m."""
        return tuple(
            profile_of(fitted.points, UNITS[self.unit], f"inserts.{number}.profile")
            for number, fitted in enumerate(self.insert_fits)
        )

    @cached_property
    def around(self) -> tuple[int | None, ...]:
        """Index of the innermost insert around each insert; None in the body itself."""
        innermost = []
        for inner in self.insides:
            outer = [
                k
                for k, insert in enumerate(self.insides)
                if insert is not inner and _within(inner, insert)
            ]
            innermost.append(min(outer, key=lambda k: area_of(self.insides[k].edges), default=None))
        return tuple(innermost)

    @cached_property
    def mass_properties(self) -> MassProperties:
        """Mass, centre of mass and moments of inertia, exact up to rounding."""
        fillings = [(self.outline, self.density)]
        for inner, insert, outer in zip(self.insides, self.inserts, self.around, strict=True):
            replaced = self.density if outer is None else self.inserts[outer].density
            fillings.append((inner, insert.density - replaced))
        return mass_properties(fillings)

    @cached_property
    def hull(self) -> ConvexHull:
        """Surfaces with which the body touches the table."""
        return hull_of(self.outline)


def _fit(points: Sequence[Sequence[float]], tolerance: float, field: str) -> Fit:
    require_points(points, field)
    return fit(points, tolerance)


# translate: skip
def _mirrored(points: Sequence[tuple[float, ...]]) -> tuple[tuple[float, ...], ...]:
    """Return the points of a profile upside down: arcs turn the other way."""
    return tuple((point[0], *(-number for number in point[1:])) for point in points)


def _within(inner: Profile, outer: Profile) -> bool:
    """Return whether a profile lies inside another; they may touch."""
    sides = inner.sides(outer)
    return "in" in sides and "out" not in sides


def _apart(first: Profile, second: Profile) -> bool:
    """Return whether neither of two profiles has a part inside the other; they may touch."""
    sides = first.sides(second)
    return "out" in sides and "in" not in sides and "in" not in second.sides(first)
