"""Bodies turned on a lathe: the surfaces with which a workpiece touches the table."""

# translate module: numpy

from typing import NamedTuple

from tippetop.lathe.hull import Zone
from tippetop.lathe.support import polynomial_support
from tippetop.lathe.workpiece import Workpiece
from tippetop.problem.shapes import DEGREE, EccentricSphere, Oval, Ring, Shape, Sphere, Spheroid
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
    smooth = hull.smooth_parts(reach)
    ovals = [_oval(workpiece, *part, completed) for part in smooth]

    def is_separate(zone: Zone) -> bool:
        return not any(low <= zone.low and zone.high <= high for low, high in smooth)

    zones = [zone for zone in hull.zones if is_separate(zone)]
    if len(zones) > MOST_SURFACES:
        raise InvalidInput(
            "profile",
            Described(f"a body that stands on {len(zones)} surfaces"),
            f"at most {MOST_SURFACES}",
            "has too many",
            "draw arcs rather than many short edges",
        )
    shapes = [_shape(zone, _above(zone.height, workpiece)) for zone in zones]
    for zone in zones:
        if hull.protrusion(zone)[0] > reach and not completed:
            part = Described(
                f"a {zone.name} of which only tilts {zone.low:.6g} to {zone.high:.6g} exist"
            )
            raise InvalidInput("profile", part, "", PROTRUDES, ACCEPT_COMPLETED)
    if ovals:
        distinct = [shape for k, shape in enumerate(shapes) if shape not in shapes[:k]]
        return [*ovals, *distinct]
    outer = [_shape(zone, _above(zone.height, workpiece)) for zone in hull.complete_surfaces(reach)]
    first = outer[0]
    if len(outer) == 1 and isinstance(first, Sphere) and 0.0 < first.center < first.radius:
        return [EccentricSphere(radius=first.radius, eccentricity=first.center / first.radius)]
    return outer


def _above(height: float, workpiece: Workpiece) -> float:
    """Return how far above the centre of mass a height is, m; 0 where that is rounding."""
    above = height - workpiece.mass_properties.center
    return 0.0 if abs(above) <= CENTRED * workpiece.outline.size else above


def allowance(workpiece: Workpiece) -> float:
    """Return the length by which touching surfaces may reach out of a turned body, m."""
    return PROTRUSION * workpiece.outline.size + 2.0 * workpiece.deviation


def _oval(workpiece: Workpiece, low: float, high: float, completed: bool) -> Shape:
    """Return the smooth surface that touches the table between two tilts, as an oval."""
    center = workpiece.mass_properties.center
    support, deviation = polynomial_support(workpiece.hull, low, high, center, DEGREE, completed)
    if deviation > OVAL_DEVIATION * workpiece.outline.size:
        part = Described(f"a curve of which only tilts {low:.4g} to {high:.4g} exist")
        raise InvalidInput("profile", part, "", PROTRUDES, ACCEPT_COMPLETED)
    return Oval(support=tuple(support))


def _shape(zone: Zone, center: float) -> Shape:
    if zone.radius == 0.0:
        return Sphere(radius=zone.tube, center=center)
    if zone.radius > 0.0:
        return Ring(radius=zone.radius, center=center, tube=zone.tube)
    part = "an arc around a point beyond the axis"
    accepted = "part of a body that stands on spheres, rings and smooth curves"
    raise InvalidInput("profile", Described(part), accepted, hint="round it by about 1 mm")
