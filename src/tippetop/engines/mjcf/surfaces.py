"""Body, friction and rolling resistance from the geoms of a free body."""

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import tippetop as tt
from tippetop.engines.mjcf.geoms import Geom, Mass
from tippetop.engines.mjcf.model import Pair
from tippetop.engines.mjcf.poses import Quaternion, inverse, matrix, onto
from tippetop.mechanics.laws.contensou import ELLIPSOIDAL_RADIUS
from tippetop.problem.bodies import reaches_out
from tippetop.support.errors import Described, InvalidInput

Array = NDArray[np.float64]

OFF_AXIS = 1e-6
"""Part of its size by which a body may differ from one of revolution: files state orientations with
7 digits, and what differs by more is not symmetric.
"""

SURFACES = ("sphere", "ellipsoid", "cylinder", "capsule")
"""Kinds of geoms that may touch the table."""


class Turned(NamedTuple):
    """A body of revolution in the frame of its file."""

    body: tt.Body
    center: Array
    """Centre of mass, m."""
    axis: Quaternion
    """Orientation whose z axis is the axis of symmetry."""
    pair: Pair
    """Friction of its surfaces."""


def _stated(pair: Pair) -> str:
    """Return the friction of a pair of geoms as a file states it."""
    numbers = " ".join(f"{number:g}" for number in pair.friction)
    return f"{numbers} with condim {pair.condim} (as stated, or MuJoCo's defaults)"


def turned_body(touching: Sequence[tuple[Geom, Pair]], mass: Mass) -> Turned:
    """Return the body whose surfaces are geoms, with the friction that all of them have.

    Raises `InvalidInput` where they, or the inertia, are not of revolution about one axis.
    """
    size = 0.0
    for geom, _ in touching:
        if geom.kind not in SURFACES:
            raise InvalidInput(
                f"{geom.field}.type",
                geom.kind,
                "",
                "touches the table, and is not read as a surface of revolution",
                f'write one of {", ".join(SURFACES)}, or contype="0" conaffinity="0"',
            )
        size = max(size, *geom.sizes)
    axis = _axis([geom for geom, _ in touching], mass, size)
    surfaces: list[tuple[tt.Shape, Geom, Pair]] = []
    for geom, pair in touching:
        surfaces += [(shape, geom, pair) for shape in _shapes(geom, mass.center, axis, size)]
    for one in list(surfaces):
        shapes = tuple(shape for shape, *_ in surfaces)
        if len(surfaces) > 1 and not reaches_out(surfaces.index(one), shapes):
            surfaces.remove(one)
    _, first, pair = surfaces[0]
    for _, geom, unlike in surfaces:
        if unlike != pair:
            raise InvalidInput(
                f"{geom.field}.friction",
                Described(_stated(unlike)),
                "",
                f"is not that of {first.field}",
                "write equal friction and condim for all that touches the table",
            )
    inside = matrix(axis).T @ mass.inertia @ matrix(axis)
    I1, I3 = _moments(inside)
    shapes = tuple(shape for shape, *_ in surfaces)
    shape = _eccentric(shapes[0]) if len(shapes) == 1 else shapes
    return Turned(tt.Body(mass=mass.mass, shape=shape, I1=I1, I3=I3), mass.center, axis, pair)


def _eccentric(shape: tt.Shape) -> tt.Shape:
    """Return a sphere as an eccentric one if its centre is above the centre of mass in it."""
    match shape:
        case tt.Sphere(radius=radius, center=center) if 0.0 < center < radius:
            return tt.EccentricSphere(radius=radius, eccentricity=center / radius)
    return shape


def _moments(inertia: Array) -> tuple[float, float]:
    """Return I1 and I3 of a matrix of inertia; raise `InvalidInput` if it is not of revolution."""
    across, second, along = map(float, np.diag(inertia))
    mixed = float(np.abs(inertia - np.diag(np.diag(inertia))).max())
    if max(abs(across - second), mixed) > OFF_AXIS * max(across, along):
        raise InvalidInput(
            "inertia",
            Described(", ".join(f"{moment:.4g}" for moment in np.linalg.eigvalsh(inertia))),
            "",
            "are the moments of inertia (kg m^2), and no two across the axis are equal",
            "arrange the parts symmetrically about the axis, or state <inertial>",
        )
    return (across if across == second else (across + second) / 2), along


def _axis(touching: Sequence[Geom], mass: Mass, size: float) -> Quaternion:
    """Return the orientation whose z axis is the axis of symmetry, as far as shapes tell it."""
    direction = next(_directions(touching, mass, size), np.array([0.0, 0.0, 1.0]))
    largest = float(direction[np.argmax(np.abs(direction))])
    return onto(direction * math.copysign(1.0, largest))


def _directions(touching: Sequence[Geom], mass: Mass, size: float) -> Iterator[Array]:
    """Yield directions of the axis: of shapes, from the centre of mass, and of the inertia."""
    for geom in touching:
        rotation = matrix(geom.pose.orientation)
        odd = _odd(geom.sizes) if geom.kind == "ellipsoid" else 2
        if geom.kind != "sphere" and odd is not None:
            yield rotation[:, odd]
    for geom in touching:
        away = geom.pose.position - mass.center
        if float(np.linalg.norm(away)) > OFF_AXIS * size:
            yield away
    moments, axes = np.linalg.eigh(mass.inertia)
    odd = _odd(tuple(moments))
    if odd is not None:
        yield axes[:, odd]


def _odd(values: Sequence[float]) -> int | None:
    """Return which of three numbers differs from two equal ones; None if all are equal."""
    gaps = [abs(values[(k + 1) % 3] - values[(k + 2) % 3]) for k in range(3)]
    return gaps.index(min(gaps)) if max(gaps) > OFF_AXIS * max(values) else None


def _shapes(geom: Geom, center: Array, axis: Quaternion, size: float) -> list[tt.Shape]:
    """Return the surfaces of a geom about the centre of mass; they are on the axis."""
    x, y, height = map(float, matrix(inverse(axis)) @ (geom.pose.position - center))
    if math.hypot(x, y) > OFF_AXIS * size:
        raise InvalidInput(
            f"{geom.field}.pos",
            Described(f"{math.hypot(x, y):.3g} m"),
            "",
            "is its distance from the axis of symmetry through the centre of mass",
            "put all that touches the table onto one axis",
        )
    if geom.kind == "sphere":
        return [tt.Sphere(radius=geom.sizes[0], center=height)]
    odd = _odd(geom.sizes) if geom.kind == "ellipsoid" else 2
    if odd is None:
        return [tt.Sphere(radius=geom.sizes[0], center=height)]
    along = (matrix(inverse(axis)) @ matrix(geom.pose.orientation))[:, odd]
    if math.hypot(along[0], along[1]) > OFF_AXIS:
        raise InvalidInput(
            f"{geom.field}",
            Described(f"{math.degrees(math.asin(min(1.0, math.hypot(*along[:2])))):.3g} degrees"),
            "",
            "is the angle between its axis and that of the body",
            "put all that touches the table onto one axis",
        )
    if geom.kind == "ellipsoid":
        across = [geom.sizes[k] for k in range(3) if k != odd]
        if abs(across[0] - across[1]) > OFF_AXIS * size:
            raise InvalidInput(
                f"{geom.field}.size", Described(str(geom.sizes)), "two equal semi-axes"
            )
        return [tt.Spheroid(across=across[0], along=geom.sizes[odd], center=height)]
    radius, half = geom.sizes
    ends = (height - half, height + half)
    if geom.kind == "cylinder":
        return [tt.Ring(radius=radius, center=end) for end in ends]
    return [tt.Sphere(radius=radius, center=end) for end in ends]


def friction_of(pair: Pair) -> tuple[tt.Friction, float]:
    """Return the friction law of a contact, and its rolling resistance, m."""
    sliding, torsional, rolling = pair.friction
    if pair.condim == 1 or not sliding:
        return tt.ViscousFriction(mu=0.0), 0.0
    if pair.condim == 3 or not torsional:
        law: tt.Friction = tt.CoulombFriction(mu=sliding)
    else:
        law = tt.ContensouFriction(
            mu=sliding,
            patch_radius=torsional / (sliding * ELLIPSOIDAL_RADIUS),
            pressure="ellipsoidal",
        )
    return law, rolling if pair.condim == 6 else 0.0
