"""Geoms of MJCF: their shapes, masses, and what touches what."""

import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tippetop.engines.mjcf.document import is_true, number, numbers
from tippetop.engines.mjcf.poses import AngleUnits, Pose, matrix, onto, pose_of
from tippetop.support.errors import InvalidInput

Array = NDArray[np.float64]

SIZES = {"sphere": 1, "capsule": 2, "cylinder": 2, "ellipsoid": 3, "box": 3, "plane": 3}
"""Kinds of geoms that are read, and how many sizes they have."""

WITHOUT_VOLUME = ("mesh", "hfield", "sdf")
"""Kinds of geoms whose mass is not computed."""

DENSITY = 1000.0
"""Density of a geom that states none, kg/m^3."""

ATTRIBUTES = {
    *("name", "class", "type", "contype", "conaffinity", "condim", "group", "priority", "size"),
    *("friction", "mass", "density", "shellinertia", "margin", "gap", "fromto", "pos", "quat"),
    *("axisangle", "xyaxes", "zaxis", "euler", "mesh", "hfield", "fitscale"),
    # How it is drawn, how stiff its contacts are, and what fluids do: the option has the fluid.
    *("material", "rgba", "user", "solmix", "solref", "solimp", "fluidshape", "fluidcoef"),
}
"""Attributes of geoms."""


class GeomContact(NamedTuple):
    """How a geom touches others."""

    contype: int
    conaffinity: int
    priority: int
    condim: int
    friction: tuple[float, ...]
    """Sliding, drilling (m) and rolling (m)."""


class Geom(NamedTuple):
    """A geom with its pose in the frame of the body, or of the world."""

    field: str
    """How refusals call it."""
    name: str
    kind: str
    sizes: tuple[float, ...]
    pose: Pose
    touch: GeomContact
    attributes: Mapping[str, str]


def geom_of(attributes: Mapping[str, str], field: str, frame: Pose, angles: AngleUnits) -> Geom:
    """Return the geom of an element's attributes, in a frame with a pose."""
    for name in attributes:
        if name not in ATTRIBUTES:
            raise InvalidInput(f"{field}.{name}", attributes[name], "", "is no attribute of geoms")
    kind = attributes.get("type", "mesh" if "mesh" in attributes else "sphere")
    if kind not in SIZES and kind not in WITHOUT_VOLUME:
        accepted = f"a type of geoms: {', '.join([*SIZES, *WITHOUT_VOLUME])}"
        raise InvalidInput(f"{field}.type", kind, accepted)
    sizes = _checked_sizes(attributes, field, kind)
    if "fromto" in attributes and kind in ("capsule", "cylinder", "ellipsoid", "box"):
        pose, sizes = _between(attributes, field, kind, sizes)
    else:
        pose = pose_of(attributes, field, angles)
        if kind in SIZES and len(sizes) < SIZES[kind]:
            raise InvalidInput(
                f"{field}.size", attributes.get("size", "nothing"), f"{SIZES[kind]} numbers"
            )
    return Geom(
        field,
        attributes.get("name", ""),
        kind,
        sizes,
        frame.of(pose),
        _touch(attributes, field),
        attributes,
    )


def _checked_sizes(attributes: Mapping[str, str], field: str, kind: str) -> tuple[float, ...]:
    """Return the sizes that a geom states, which are positive unless it is a plane."""
    sizes = numbers(attributes, "size", field, (1, 2, 3)) or ()
    sizes = sizes[: SIZES.get(kind, 3)]
    if kind != "plane" and not all(size > 0.0 for size in sizes) and kind in SIZES:
        raise InvalidInput(f"{field}.size", attributes["size"], "positive numbers")
    return sizes


def _between(
    attributes: Mapping[str, str], field: str, kind: str, sizes: tuple[float, ...]
) -> tuple[Pose, tuple[float, ...]]:
    """Return pose and sizes of a geom that reaches from one point to another."""
    ends = np.array(numbers(attributes, "fromto", field, (6,)))
    along = ends[3:] - ends[:3]
    length = float(np.linalg.norm(along))
    if not length or not sizes:
        raise InvalidInput(f"{field}.fromto", attributes["fromto"], "two points, beside a size")
    across = (sizes[0],) if kind in ("capsule", "cylinder") else (sizes[0], sizes[0])
    return Pose((ends[:3] + ends[3:]) / 2, onto(along)), (*across, length / 2)


def _touch(attributes: Mapping[str, str], field: str) -> GeomContact:
    friction = numbers(attributes, "friction", field, (1, 2, 3)) or ()
    if any(part < 0.0 for part in friction):
        raise InvalidInput(f"{field}.friction", attributes["friction"], "numbers at least 0")
    masks = [int(number(attributes, name, field, 1.0)) for name in ("contype", "conaffinity")]
    return GeomContact(
        masks[0],
        masks[1],
        int(number(attributes, "priority", field, 0.0)),
        condim_of(attributes, field),
        (*friction, *FRICTION[len(friction) :]),
    )


FRICTION = (1.0, 0.005, 0.0001)
"""Friction of a geom that states none: sliding, drilling (m) and rolling (m)."""


def condim_of(attributes: Mapping[str, str], field: str) -> int:
    """Return the dimension of the contacts of a geom or pair."""
    condim = number(attributes, "condim", field, 3.0)
    if condim not in (1.0, 3.0, 4.0, 6.0):
        raise InvalidInput(f"{field}.condim", attributes["condim"], "1, 3, 4 or 6")
    return int(condim)


class Mass(NamedTuple):
    """Mass, centre of mass, and matrix of the moments of inertia about it."""

    mass: float
    center: Array
    inertia: Array

    def scaled(self, factor: float) -> "Mass":
        """Return it with a density that is a factor larger."""
        return Mass(self.mass * factor, self.center, self.inertia * factor)


def total(masses: list[Mass]) -> Mass:
    """Return the mass of several together; their sum is positive."""
    if len(masses) == 1:
        return masses[0]
    mass = sum(one.mass for one in masses)
    center = sum((one.mass * one.center for one in masses), np.zeros(3)) / mass
    inertia = np.zeros((3, 3))
    for one in masses:
        away = one.center - center
        inertia += one.inertia + one.mass * (away @ away * np.eye(3) - np.outer(away, away))
    return Mass(mass, center, inertia)


def mass_of(geom: Geom) -> Mass | None:
    """Return the mass of a geom; None if it has none.

    Raises `InvalidInput` for a shell and for shapes whose mass is not computed.
    """
    attributes, field = geom.attributes, geom.field
    if geom.kind == "plane":
        return None
    density = number(attributes, "density", field, DENSITY)
    mass = number(attributes, "mass", field, math.nan)
    if mass < 0.0 or density < 0.0:
        name = "mass" if mass < 0.0 else "density"
        raise InvalidInput(f"{field}.{name}", attributes[name], "a number at least 0")
    if mass == 0.0 or (math.isnan(mass) and density == 0.0):
        return None
    if geom.kind in WITHOUT_VOLUME:
        raise InvalidInput(
            f"{field}.type",
            geom.kind,
            "",
            "has a mass that is not computed here",
            'state the body\'s <inertial>, or write mass="0" if it is only drawn',
        )
    if is_true(attributes, "shellinertia"):
        raise InvalidInput(f"{field}.shellinertia", "true", "false", hint="state <inertial>")
    parts = _solids(geom.kind, geom.sizes)
    volume = sum(part for part, _ in parts)
    if math.isnan(mass):
        mass = density * volume
    moments = sum((part / volume * mass * np.array(arms) for part, arms in parts), np.zeros(3))
    rotation = matrix(geom.pose.orientation)
    return Mass(mass, geom.pose.position, rotation @ np.diag(moments) @ rotation.T)


def _solids(kind: str, sizes: tuple[float, ...]) -> list[tuple[float, tuple[float, float, float]]]:
    """Return the solids that a shape is made of: volumes, and squared radii of gyration about its
    three axes.
    """
    match kind, sizes:
        case "box", (a, b, c):
            return [(8.0 * a * b * c, _squared_radii(a, b, c, 3.0))]
        case "cylinder", (r, half):
            across = (3.0 * r * r + 4.0 * half * half) / 12.0
            return [(2.0 * math.pi * r * r * half, (across, across, r * r / 2.0))]
        case "capsule", (r, half):
            # Two half balls, whose centres of mass are 3/8 r beyond the ends of the cylinder.
            across = 0.4 * r * r + half * half + 0.75 * r * half
            ends = (4.0 / 3.0 * math.pi * r**3, (across, across, 0.4 * r * r))
            return [*_solids("cylinder", sizes), ends]
    a, b, c = sizes if kind == "ellipsoid" else 3 * sizes
    return [(4.0 / 3.0 * math.pi * a * b * c, _squared_radii(a, b, c, 5.0))]


def _squared_radii(a: float, b: float, c: float, divisor: float) -> tuple[float, float, float]:
    """Return the squared radii of gyration of a box or ellipsoid of these half lengths."""
    return ((b * b + c * c) / divisor, (a * a + c * c) / divisor, (a * a + b * b) / divisor)
