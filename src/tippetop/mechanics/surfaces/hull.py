"""Bodies of several surfaces: the convex hull of all, of which one at a time is asked."""

from typing import Any, NamedTuple

from tippetop.mechanics.surfaces.surface import (
    Support,
    Surface,
    gap_guard,
    kind_of,
    support_at,
)
from tippetop.mechanics.vectors import Scalar, Vector

SAME_HEIGHT = 1e-12
"""Difference of the heights of two surfaces, in sizes, up to which both are lowest: the gap up to
which a surface touches.
"""

UPRIGHT = 1e-12
"""Difference of |c| from 1 up to which the axis is vertical: there the gaps of surfaces that touch
the table at one point, a few of it, do not tell which is lowest beside.
"""


class Hull(NamedTuple):
    """The surfaces of a body: a `Surface` that stands for the active one."""

    units: tuple[Surface, ...]
    sizes: tuple[Scalar, ...]
    """The surfaces, each of unit size, and their sizes, m."""
    active: int = 0
    """Number of the active surface."""

    @classmethod
    def of(cls, surfaces: tuple[Surface, ...]) -> "Hull":
        """Return the hull of some surfaces; the first is active."""
        units = tuple(
            kind_of(surface).from_proportions(surface.proportions) for surface in surfaces
        )
        return cls(units, tuple(surface.size for surface in surfaces))

    @property
    def each(self) -> tuple["Hull", ...]:
        """The hull with every surface active in turn."""
        return tuple([self.on(number) for number in range(len(self.units))])

    def on(self, number: int) -> "Hull":
        """Return the hull with a surface active."""
        return Hull(self.units, self.sizes, number)

    def height(self, c: Scalar) -> Scalar:
        """Support function h(c), m."""
        return self.sizes[self.active] * self.units[self.active].height(c)

    def slope(self, c: Scalar) -> Scalar:
        """First derivative h'(c), m."""
        return self.sizes[self.active] * self.units[self.active].slope(c)

    def curvature(self, c: Scalar) -> Scalar:
        """Second derivative h''(c), m."""
        return self.sizes[self.active] * self.units[self.active].curvature(c)

    def support_at(self, axis: Vector) -> Support:
        """Return the support function of the active surface and its derivatives for an axis, m."""
        size = self.sizes[self.active]
        height, slope, curvature = support_at(axis, self.units[self.active])
        return size * height, size * slope, size * curvature

    def gap_guard(self, axis: Vector, height: Scalar, margin: Scalar) -> Scalar:
        """Return what falls through zero as the gap of the active surface and a margin do."""
        size, unit = self.sizes[self.active], self.units[self.active]
        return gap_guard(axis, height / size, margin / size, unit)

    def face_gap(self, axis: Vector, height: Scalar) -> Scalar:
        """Return the height of the middle of the active ring above a table that its tube touches,
        m.
        """
        size = self.sizes[self.active]
        ring: Any = self.units[self.active]
        return size * ring.face_gap(axis, height / size)

    @property
    def spherical(self) -> bool:
        """It is none, though all of its surfaces be spheres."""
        return False

    @property
    def size(self) -> Scalar:
        """The size of the first surface, m, whichever is active."""
        return self.sizes[0]

    @property
    def proportions(self) -> tuple[Scalar, ...]:
        """Those of every surface, and before them, for all but the first, its size in sizes of the
        first.
        """
        numbers: tuple[Scalar, ...] = self.units[0].proportions
        for unit, size in zip(self.units[1:], self.sizes[1:], strict=True):
            numbers = (*numbers, size / self.sizes[0], *unit.proportions)
        return numbers

    @classmethod
    def from_proportions(cls, proportions: tuple[Scalar, ...]) -> "Hull":
        """Never used: a hull is made by its `make`, which knows of what surfaces."""
        raise NotImplementedError

    @property
    def make(self) -> "HullKind":
        """What remains of it without its numbers."""
        return HullKind(
            tuple([kind_of(unit) for unit in self.units]),
            tuple(len(unit.proportions) for unit in self.units),
            self.active,
        )


class HullKind(NamedTuple):
    """What remains of a hull when its numbers are taken away."""

    units: tuple[Any, ...]
    counts: tuple[int, ...]
    active: int

    def from_proportions(self, proportions: tuple[Scalar, ...]) -> Hull:
        """Make the hull, whose first surface has unit size, with these proportions."""
        units: list[Surface] = []
        sizes: list[Any] = []
        place = 0
        for number, (unit, count) in enumerate(zip(self.units, self.counts, strict=True)):
            sizes.append(proportions[place] if number else 1.0)
            place += number > 0
            units.append(unit.from_proportions(tuple(proportions[place : place + count])))
            place += count
        return Hull(tuple(units), tuple(sizes), self.active)


def each_surface(surface: Surface) -> tuple[Surface, ...]:
    """Return a surface alone, or a hull with every surface active in turn."""
    return surface.each if isinstance(surface, Hull) else (surface,)


def sizes(surface: Surface) -> tuple[Scalar, ...]:
    """Return the sizes of all surfaces, m."""
    return surface.sizes if isinstance(surface, Hull) else (surface.size,)


def acting(surface: Surface) -> Surface:
    """Return a surface, or the active surface of a hull, at its size."""
    return surface.units[surface.active] if isinstance(surface, Hull) else surface


def is_edge(surface: Surface) -> bool:
    """Return whether a surface, or the one that is active, is an edge, on whose face the body may
    lie flat.
    """
    return hasattr(acting(surface), "lies_flat")


def has_flat_end(surface: Surface) -> bool:
    """Return whether a surface, or the one that is active, ends in an edge that bounds no face."""
    return len(getattr(acting(surface), "flat_ends", ())) > 0


def lies_flat_at(surface: Surface, end: float) -> bool:
    """Return whether a body whose axis is vertical lies flat on a surface, or on the one that is
    active: on the face of an edge, or on a flat end of arcs.

    `end` is the cosine of the tilt, 1 or -1.
    """
    return is_edge(surface) or end in getattr(acting(surface), "flat_ends", ())


def outer_height(surface: Surface, c: Scalar) -> Scalar:
    """Height of the centre of mass above the table while the lowest of all surfaces touches it,
    m.
    """
    first, *others = each_surface(surface)
    height = first.height(c)
    for surface_beside in others:
        height_beside = surface_beside.height(c)
        height = 0.5 * (height + height_beside + abs(height - height_beside))
    return height


def lowest_gap(axis: Vector, height: Scalar, surface: Surface) -> Scalar:
    """Height of the lowest of all surfaces above the table, for that of the centre of mass, m."""
    first, *others = each_surface(surface)
    gap = height - support_at(axis, first)[0]
    for surface_beside in others:
        gap_beside = height - support_at(axis, surface_beside)[0]
        gap = 0.5 * (gap + gap_beside - abs(gap - gap_beside))
    return gap


def lowest_surface(surface: Surface, c: float) -> Surface:
    """Return the surface that reaches lowest at this c, active; of floats."""
    return each_surface(surface)[lowest_number(surface, c)]


def lowest_number(surface: Surface, c: float) -> int:
    """Return the number of the surface that reaches lowest at this c; the first of several; of
    floats.

    Where the axis is vertical several surfaces may reach lowest at one point. At any other tilt the
    bluntest is the lowest of them, of which the height grows fastest.
    """
    every = each_surface(surface)
    if len(every) == 1:
        return 0
    lowest = max(range(len(every)), key=lambda number: float(every[number].height(c)))
    if abs(c) < 1.0 - UPRIGHT:
        return lowest
    level = every[lowest].height(c) - SAME_HEIGHT * surface.size
    sense = 1.0 if c > 0.0 else -1.0
    at = sense * (1.0 - UPRIGHT)
    return max(
        [number for number, one in enumerate(every) if one.height(c) >= level],
        key=lambda number: -sense * float(every[number].slope(at)),
    )
