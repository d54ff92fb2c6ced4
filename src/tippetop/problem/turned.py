"""Bodies turned on a lathe: the surfaces with which a workpiece touches the table."""

# translate module: numpy

import math
from typing import NamedTuple

from tippetop.lathe.hull import ConvexHull, Zone
from tippetop.lathe.support import polynomial_support
from tippetop.lathe.workpiece import Workpiece
from tippetop.mechanics.laws.face_friction import LEAST_WIDTH
from tippetop.problem.shapes import (
    DEGREE,
    EccentricSphere,
    Meridian,
    Oval,
    Ring,
    Shape,
    Sphere,
    Spheroid,
)
from tippetop.support.errors import Described, InvalidInput

PROTRUDES = "would reach out of the body if it were complete"
ACCEPT_COMPLETED = "accept incomplete surfaces with whole=True, at the command line --whole"

MOST_SURFACES = 12
"""Most surfaces of a turned body: each costs time at every step of a run."""

PROTRUSION = 1e-6
"""Length by which a completed surface may reach out of the body, in sizes of it: above rounding."""

OVAL_DEVIATION = 1e-3
"""Largest distance of an oval from the curve that it replaces, in sizes of the body."""


CENTRED = 1e-12
"""Distance of a surface's centre from the centre of mass, in sizes of the body, up to which they
are one: integrals over a profile round by 1e-16 and more, and no drawing has as many digits. A ball
whose eccentricity is rounding would belong to a group.
"""


class TurnedFields(NamedTuple):
    """Fields of the body that a workpiece makes."""

    mass: float
    shapes: list[Shape]
    I1: float
    I3: float
    profile: list[tuple[float, ...]]


def turned_fields(workpiece: Workpiece, completed: bool = False) -> TurnedFields:
    """Return the fields of the body that a workpiece makes.

    Raises `InvalidInput` as `touching_surfaces` does.
    """
    mass, center, I1, I3 = workpiece.mass_properties
    profile = workpiece.outline.points_above(center)
    return TurnedFields(mass, touching_surfaces(workpiece, completed), I1, I3, profile)


def touching_surfaces(workpiece: Workpiece, completed: bool = False) -> list[Shape]:
    """Return the surfaces with which a turned body touches the table, about its centre of mass.

    Smooth curves that are no circles become ovals. Raises `InvalidInput` if there are surfaces
    other than spheres, rings, ovals and one spheroid. Unless incomplete surfaces may be
    `completed`, it also raises if one of them, continued beyond its part of the body, would reach
    out of it.
    """
    hull = workpiece.hull
    reach = allowance(workpiece)
    spheroid = hull.spheroid(reach) if len(hull.zones) > 2 else None
    if spheroid is not None:
        across, along, height = spheroid
        return [Spheroid(across=across, along=along, center=_above(height, workpiece))]
    curves = hull.smooth_parts(reach)
    fits = [_fitted_oval(workpiece, *part, completed) for part in curves]
    smooth = [fit for fit in fits if completed or fit.is_close]
    ovals = [_oval(fit) for fit in smooth]

    def is_separate(zone: Zone) -> bool:
        return not any(fit.low <= zone.low and zone.high <= fit.high for fit in smooth)

    zones = [zone for zone in hull.zones if is_separate(zone)]
    if len(zones) > MOST_SURFACES:
        for fit in fits:
            _oval(fit)
        raise InvalidInput(
            "profile",
            Described(f"a body that stands on {len(zones)} surfaces"),
            f"at most {MOST_SURFACES}",
            "has too many",
            "draw arcs rather than many short edges",
        )
    cut = [] if completed else [row for row in hull.rows(zones) if _is_cut(row, hull, reach)]
    if cut:
        complete = [zone for zone in zones if not any(zone in row for row in cut)]
        shapes = [
            *((row[0].low, _arcs(row, workpiece)) for row in cut),
            *((zone.low, _shape(zone, workpiece)) for zone in complete),
        ]
        ordered = [shape for _, shape in sorted(shapes, key=lambda pair: pair[0])]
        distinct = [shape for k, shape in enumerate(ordered) if shape not in ordered[:k]]
        return [*ovals, *distinct]
    shapes_of_zones = [_shape(zone, workpiece) for zone in zones]
    if ovals:
        return [
            *ovals,
            *[one for k, one in enumerate(shapes_of_zones) if one not in shapes_of_zones[:k]],
        ]
    outer = [_shape(zone, workpiece) for zone in hull.complete_surfaces(reach)]
    first = outer[0]
    if len(outer) == 1 and isinstance(first, Sphere) and 0.0 < first.center < first.radius:
        return [EccentricSphere(radius=first.radius, eccentricity=first.center / first.radius)]
    return outer


def _is_cut(row: list[Zone], hull: ConvexHull, reach: float) -> bool:
    """Return whether a surface of a row, if complete, would reach out of the body."""
    return any(zone.radius < 0.0 or hull.protrusion(zone)[0] > reach for zone in row)


def _part(row: list[Zone], workpiece: Workpiece) -> Described:
    """Return which surface of a row would reach out of the body if it were complete."""
    reach = allowance(workpiece)
    cut = [zone for zone in row if zone.radius < 0.0 or workpiece.hull.protrusion(zone)[0] > reach]
    zone = cut[0]
    if zone.radius < 0.0:
        return Described("an arc around a point beyond the axis")
    return Described(f"a {zone.name} of which only tilts {zone.low:.6g} to {zone.high:.6g} exist")


def _arcs(row: list[Zone], workpiece: Workpiece) -> Shape:
    """Return the surface of zones that continue each other, with sharp edges at its ends.

    Raises `InvalidInput` if the body lies on a face that such a row bounds.
    """
    first, last = row[0], row[-1]
    if (first.low == 0.0 and first.radius) or (last.high == math.pi and last.radius):
        raise InvalidInput("profile", _part(row, workpiece), "", PROTRUDES, ACCEPT_COMPLETED)
    tubes, tilts = [zone.tube for zone in row], [zone.low for zone in row[1:]]
    if first.low > 0.0 and first.tube:
        tubes, tilts = [0.0, *tubes], [first.low, *tilts]
    if last.high < math.pi and last.tube:
        tubes, tilts = [*tubes, 0.0], [*tilts, last.high]
    # The centres follow from that of a sphere, which is exactly on the axis, or of any arc.
    start = len(tubes) - len(row) - (last.high < math.pi and last.tube > 0.0)
    anchor = next((k for k, zone in enumerate(row) if zone.name == "sphere"), 0)
    radius, height = row[anchor].radius, row[anchor].height
    for k in range(start + anchor - 1, -1, -1):
        longer = tubes[k + 1] - tubes[k]
        radius += longer * math.sin(tilts[k])
        height -= longer * math.cos(tilts[k])
    return Meridian(
        tubes=tuple(tubes), tilts=tuple(tilts), center=_above(height, workpiece), radius=radius
    )


def _above(height: float, workpiece: Workpiece) -> float:
    """Return how far above the centre of mass a height is, m; 0 where that is rounding."""
    above = height - workpiece.mass_properties.center
    return 0.0 if abs(above) <= CENTRED * workpiece.outline.size else above


def allowance(workpiece: Workpiece) -> float:
    """Return the length by which touching surfaces may reach out of a turned body, m."""
    return PROTRUSION * workpiece.outline.size + 2.0 * workpiece.deviation


class FittedOval(NamedTuple):
    """Oval that replaces the smooth surface which touches the table between two tilts."""

    low: float
    high: float
    support: list[float]
    """Coefficients of its support function; none if there is no such oval."""
    is_close: bool
    """Whether it is as close to the curve as `OVAL_DEVIATION` asks for."""


def _fitted_oval(workpiece: Workpiece, low: float, high: float, completed: bool) -> FittedOval:
    """Return the oval closest to the surface between two tilts, in the body unless `completed`."""
    center = workpiece.mass_properties.center
    support, deviation = polynomial_support(workpiece.hull, low, high, center, DEGREE, completed)
    return FittedOval(low, high, support, deviation <= OVAL_DEVIATION * workpiece.outline.size)


def _oval(fit: FittedOval) -> Shape:
    """Return a fitted oval; raise `InvalidInput` if it is not close to its curve."""
    if not fit.is_close:
        part = Described(f"a curve of which only tilts {fit.low:.4g} to {fit.high:.4g} exist")
        raise InvalidInput("profile", part, "", PROTRUDES, ACCEPT_COMPLETED)
    return Oval(support=tuple(fit.support))


def _shape(zone: Zone, workpiece: Workpiece) -> Shape:
    """Return the surface of a zone about the centre of mass, complete."""
    center = _above(zone.height, workpiece)
    if zone.radius == 0.0:
        return Sphere(radius=zone.tube, center=center)
    if zone.radius > 0.0:
        inner = inner_radius(zone, workpiece)
        return Ring(radius=zone.radius, center=center, tube=zone.tube, inner_radius=inner)
    part = "an arc around a point beyond the axis"
    accepted = "part of a body that stands on spheres, rings and smooth curves"
    raise InvalidInput("profile", Described(part), accepted, hint="round it by about 1 mm")


def inner_radius(zone: Zone, workpiece: Workpiece) -> float:
    """Return the inner radius of the flat face that a ring bounds, m; 0 of a disk.

    The face is what the profile has of the plane on which the body lies, from the ring inwards to
    where the profile leaves it: 0 if that is at the axis, and of a ring that touches the plane in a
    circle, such as a rounded rim, as near to the ring as a face may be.

    Of the two faces of a ring on which the body can lie either way, it is that at tilt 0, and a
    ring on which it never lies has none.
    """
    lowest, highest = zone.low == 0.0, zone.high == math.pi
    if not (lowest or highest):
        return 0.0
    plane = zone.height - zone.tube if lowest else zone.height + zone.tube
    within, radius = allowance(workpiece), zone.radius
    flat = [
        (min(edge.start.real, edge.end.real), max(edge.start.real, edge.end.real))
        for edge in workpiece.outline.edges
        if not edge.turn and max(abs(edge.start.imag - plane), abs(edge.end.imag - plane)) <= within
    ]
    for inner, outer in sorted(flat, key=lambda ends: -ends[0]):
        if inner < radius <= outer + within:
            radius = inner
    if radius <= within:
        return 0.0
    return min(radius, (1.0 - LEAST_WIDTH) * zone.radius)
