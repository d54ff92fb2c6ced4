"""Bodies as a lathe makes them: the surfaces that a workpiece touches the table with."""

# translate module: numpy

from typing import NamedTuple

from tippetop.lathe.hull import Zone
from tippetop.lathe.support import polynomial_support
from tippetop.lathe.workpiece import Workpiece
from tippetop.problem.shapes import DEGREE, EccentricSphere, Oval, Ring, Shape, Sphere, Spheroid
from tippetop.support.errors import Described, InvalidInput

CUT_OFF = "would reach out of the body where it goes on"
AS_WHOLE = "take surfaces as whole with whole=True, at the command line --whole"

MOST = 12
"""Most surfaces of a turned body."""

PROTRUDING = 1e-6
"""How far a surface taken as whole may reach out of the body, in sizes of this."""

OFF_OVAL = 1e-3
"""How far an oval may be from the curve that it stands for, in sizes of the body."""


class TurnedFields(NamedTuple):
    """The fields of the body that a workpiece is."""

    mass: float
    shapes: list[Shape]
    I1: float
    I3: float
    profile: list[tuple[float, ...]]


def turned_fields(piece: Workpiece, whole: bool = False) -> TurnedFields:
    """Return the fields of the body that a workpiece is; see `touching` for what is refused."""
    mass, center, I1, I3 = piece.mass_properties
    profile = piece.outline.points_above(center)
    return TurnedFields(mass, touching(piece, whole), I1, I3, profile)


def touching(piece: Workpiece, whole: bool = False) -> list[Shape]:
    """The surfaces that a turned body touches the table with, as seen from its centre of mass.

    Smooth curves that are no circles become ovals. Raises `InvalidInput` if there are others than
    spheres, rings, ovals and one spheroid; or, unless they may be taken as whole, if one of these,
    were it whole, would be outside of the body.
    """
    center, hull = piece.mass_properties.center, piece.hull
    reach = allowance(piece)
    spheroid = hull.spheroid(reach) if len(hull.zones) > 2 else None
    if spheroid is not None:
        across, along, height = spheroid
        return [Spheroid(across=across, along=along, center=height - center)]
    smooth = hull.smooth_parts(reach)
    ovals = [_oval(piece, *part, whole) for part in smooth]

    def is_left(zone: Zone) -> bool:
        return not any(low <= zone.low and zone.high <= high for low, high in smooth)

    zones = [zone for zone in hull.zones if is_left(zone)]
    if len(zones) > MOST:
        raise InvalidInput(
            "profile",
            Described(f"a body that stands on {len(zones)} surfaces"),
            f"at most {MOST}",
            "has too many",
            "draw arcs rather than many short edges",
        )
    shapes = [_shape(zone, zone.height - center) for zone in zones]
    for zone in zones:
        if hull.protrusion(zone)[0] > reach and not whole:
            part = Described(
                f"a {zone.name} cut off, left from tilt {zone.low:.6g} to {zone.high:.6g}"
            )
            raise InvalidInput("profile", part, "", CUT_OFF, AS_WHOLE)
    if ovals:
        own = [shape for k, shape in enumerate(shapes) if shape not in shapes[:k]]
        return [*ovals, *own]
    outer = [_shape(zone, zone.height - center) for zone in hull.whole(reach)]
    first = outer[0]
    if len(outer) == 1 and isinstance(first, Sphere) and 0.0 < first.center < first.radius:
        return [EccentricSphere(radius=first.radius, eccentricity=first.center / first.radius)]
    return outer


def allowance(piece: Workpiece) -> float:
    """How far surfaces that a turned body touches the table with may reach out of it, m."""
    return PROTRUDING * piece.outline.size + 2.0 * piece.deviation


def _oval(piece: Workpiece, low: float, high: float, whole: bool) -> Shape:
    """The smooth surface that a turned body stands on between two tilts."""
    center = piece.mass_properties.center
    support, apart = polynomial_support(piece.hull, low, high, center, DEGREE, whole)
    if apart > OFF_OVAL * piece.outline.size:
        part = Described(f"a curve cut off, from tilt {low:.4g} to {high:.4g}")
        raise InvalidInput("profile", part, "", CUT_OFF, AS_WHOLE)
    return Oval(support=tuple(support))


def _shape(zone: Zone, center: float) -> Shape:
    if zone.radius == 0.0 and zone.tube:
        return Sphere(radius=zone.tube, center=center)
    if zone.radius > 0.0:
        return Ring(radius=zone.radius, center=center, tube=zone.tube)
    part = "a sharp tip" if zone.name == "tip" else "an arc around a point beyond the axis"
    wanted = "part of a body that stands on spheres, rings and smooth curves"
    raise InvalidInput("profile", Described(part), wanted, hint="round it, by 1 mm or so")
