"""Design of bodies: a cavity, weight, or bowl and stem for a given eccentricity and I1 / I3."""

import math
from collections.abc import Callable
from itertools import groupby, pairwise
from typing import Any

import numpy as np
from scipy.optimize import brentq

from tippetop.lathe.profile import ROUNDING
from tippetop.lathe.workpiece import DENSEST, UNITS, Insert, Workpiece
from tippetop.support.errors import Described, InvalidInput, is_number, require
from tippetop.support.units import number_in

SIZES_TRIED = 96
"""Number of sizes that are tried to bracket the solution."""

LONGEST = 3.0
"""Largest distance of the stem's end from the centre of the sphere, in radii."""


def design_insert(
    piece: Workpiece,
    eccentricity: float,
    inertia_ratio: float,
    *,
    density: float = 0.0,
    wall: float | None = None,
) -> Workpiece:
    """Return a turned body with a further spherical cavity or weight that gives it these
    properties.

    Parameters
    ----------
    piece
        The body: a ball, one with a stem, or any other that stands on a sphere.
    eccentricity
        alpha: distance of the centre of mass below the centre of that sphere, in its radii.
    inertia_ratio
        gamma = I1 / I3.
    density
        Density of the insert, kg/m^3: 0 for a cavity.
    wall
        Least thickness of the body around it, m; by default a twentieth of the sphere's radius.

    Raises
    ------
    InvalidInput
        If there is no such body; the message says what is possible.

    Examples
    --------
    >>> import tippetop as tt
    >>> ball = tt.Workpiece(profile=[(0, -20), (0, 20, 20)], density=700, unit="mm")
    >>> hollow = tt.design_insert(ball, eccentricity=0.1, inertia_ratio=0.95)
    >>> mass = hollow.mass_properties
    >>> round(-mass.center / 0.02, 9), round(mass.I1 / mass.I3, 9)
    (0.1, 0.95)
    """
    require("piece", piece, Workpiece, "a Workpiece")
    eccentricity = _number("eccentricity", eccentricity)
    inertia_ratio = _positive("inertia_ratio", inertia_ratio)
    density = _number("density", density, "kg m-3")
    sphere = piece.hull.zones[0]
    if sphere.name != "sphere":
        raise InvalidInput(
            "piece",
            Described(f"a body that stands on a {sphere.name}"),
            "one that stands on a sphere",
        )
    if not 0.0 <= density <= DENSEST:
        raise InvalidInput("density", density, f"a number at least 0 and at most {DENSEST:g}")
    if density == piece.density:
        raise InvalidInput("density", density, "another density", "is the body's own density")
    radius, base = sphere.tube, piece.mass_properties
    least = _wall(radius, wall)
    points = piece.outline.points(2)
    heights = np.linspace(points.imag.min(), points.imag.max(), 16 * SIZES_TRIED + 1)
    clearance = np.array([_clearance(piece, height) for height in heights]) - least

    def made(size: float, height: float) -> Workpiece:
        ball = ((0.0, height - size), (0.0, height + size, size))
        unit = UNITS[piece.unit]
        profile = tuple(tuple(number / unit for number in point) for point in ball)
        inserts = (*piece.inserts, Insert(profile=profile, density=density))
        return piece.model_copy(update={"inserts": inserts})

    def mass(size: float) -> float:
        return (density - piece.density) * 4.0 / 3.0 * math.pi * size**3

    def height(size: float) -> float | None:
        center = sphere.height - eccentricity * radius
        place = center + (center - base.center) * base.mass / mass(size)
        return place if _clearance(piece, place) - least >= size else None

    def extremes(size: float) -> list[float]:
        within = heights[clearance >= size]
        centers = (base.mass * base.center + mass(size) * within) / (base.mass + mass(size))
        return [float(sphere.height - center) / radius for center in centers]

    sizes = np.linspace(0.0, clearance.max(), SIZES_TRIED + 2)[1:-1].tolist()
    return _solve(sizes, height, extremes, made, eccentricity, inertia_ratio)


def _clearance(workpiece: Workpiece, height: float) -> float:
    """Return the distance of a point of the axis from all surfaces, m; 0 outside the material."""
    point, profiles = 1j * height, (workpiece.outline, *workpiece.insides)
    away = min(profile.distance(point) for profile in profiles)
    if away <= ROUNDING * workpiece.outline.size:
        return 0.0
    # From a point on the axis inside a profile, its half line subtends the angle pi.
    around = [
        abs(sum(edge.angle_seen(point) for edge in profile.edges)) > 1.0 for profile in profiles
    ]
    return away if around == [True] + [False] * len(workpiece.insides) else 0.0


def design_bowl(
    radius: float,
    density: float,
    eccentricity: float,
    inertia_ratio: float,
    *,
    stem: float | None = None,
    wall: float | None = None,
) -> Workpiece:
    """Return a bowl with a stem inside, of one material, with these properties on its sphere.

    The sphere ends just where the stem touches instead. The thickness of the bowl and the length of
    the stem, which is round at its end, are computed.

    Parameters
    ----------
    radius
        Radius of the sphere, m.
    density
        Density, kg/m^3.
    eccentricity
        alpha: distance of the centre of mass below the centre of the sphere, in radii.
    inertia_ratio
        gamma = I1 / I3.
    stem
        Radius of the stem, m; by default a tenth of the sphere's.
    wall
        Least thickness of the bowl, m; by default a twentieth of the radius.

    Raises
    ------
    InvalidInput
        If there is no such body; the message says what is possible.

    Examples
    --------
    >>> import tippetop as tt
    >>> top = tt.design_bowl(radius=0.02, density=700.0, eccentricity=0.15, inertia_ratio=1.2)
    >>> round(top.mass_properties.I1 / top.mass_properties.I3, 9)
    1.2
    """
    radius = _positive("radius", radius, "m")
    density = _positive("density", density, "kg m-3")
    eccentricity = _number("eccentricity", eccentricity)
    inertia_ratio = _positive("inertia_ratio", inertia_ratio)
    least = _wall(radius, wall)
    thick = radius / 10.0 if stem is None else _number("stem", stem, "m")
    if not 0.0 < thick < radius / 2.0:
        raise InvalidInput("stem", thick, "a radius greater than 0 and less than half the sphere's")

    def ends(tip: float) -> tuple[float, float]:
        return math.hypot(rim_height(radius, thick, tip), thick + least), radius - least

    def bowl(tip: float, hollow: float) -> Workpiece:
        return bowl_with_stem(radius, density, stem=thick, tip=tip, hollow=hollow)

    def extremes(tip: float) -> list[float]:
        return [_alpha(bowl(tip, hollow), radius) for hollow in ends(tip)]

    def hollow(tip: float) -> float | None:
        low, high = extremes(tip)
        if not min(low, high) <= eccentricity <= max(low, high):
            return None
        return _root(lambda size: _alpha(bowl(tip, size), radius) - eccentricity, *ends(tip))

    tips = np.linspace(radius, LONGEST * radius, SIZES_TRIED // 2 + 1)[1:].tolist()
    possible = [tip for tip in tips if ends(tip)[0] < ends(tip)[1]]
    return _solve(possible, hollow, extremes, bowl, eccentricity, inertia_ratio)


def rim_height(radius: float, stem: float, tip: float) -> float:
    """Return the height over the sphere's centre at which the sphere is cut off, m.

    The end of the stem takes over there.
    """
    return radius * (radius - stem) / (tip - stem)


def bowl_with_stem(
    radius: float, density: float, *, stem: float, tip: float, hollow: float
) -> Workpiece:
    """Return a bowl with a stem inside, of one material.

    Parameters
    ----------
    radius, density
        Radius of the sphere, m, and density, kg/m^3.
    stem
        Radius of the stem and of its round end, m.
    tip
        Height of the stem's end over the sphere's centre, m.
    hollow
        Radius of the inside of the bowl, m.
    """
    face = rim_height(radius, stem, tip)
    outer, inner = math.sqrt(radius**2 - face**2), math.sqrt(hollow**2 - face**2)
    floor = -math.sqrt(hollow**2 - stem**2)
    outside = ((0.0, -radius), (radius, 0.0, radius), (outer, face, radius), (inner, face))
    inside = ((stem, floor, -hollow), (stem, tip - stem), (0.0, tip, stem))
    return Workpiece(profile=(*outside, *inside), density=density)


def _wall(radius: float, wall: float | None) -> float:
    least = radius / 20.0 if wall is None else _number("wall", wall, "m")
    if not 0.0 < least < radius / 2.0:
        raise InvalidInput(
            "wall", least, "a thickness greater than 0 and less than half the radius"
        )
    return least


def _positive(field: str, value: Any, units: str = "1") -> float:
    """Return a positive number in an SI unit."""
    number = _number(field, value, units)
    if number <= 0.0:
        raise InvalidInput(field, value, "a number greater than 0")
    return number


def _number(field: str, value: Any, units: str = "1") -> float:
    """Return a finite number in an SI unit, from a number, a text with a unit or a pint
    quantity.
    """
    number = number_in(field, value, units)
    if not is_number(number):
        raise InvalidInput(field, value, "a finite number")
    return float(number)


def _alpha(workpiece: Workpiece, radius: float) -> float:
    """Return the depth of the centre of mass below the origin, in radii."""
    return -workpiece.mass_properties.center / radius


def _solve(
    sizes: list[float],
    partner: Callable[[float], float | None],
    extremes: Callable[[float], list[float]],
    body_of: Callable[[float, float], Workpiece],
    eccentricity: float,
    inertia_ratio: float,
) -> Workpiece:
    """Return the body with this ratio I1 / I3 and this eccentricity.

    `body_of` makes a body of two lengths. `partner` returns, for the first length, the second one
    that gives this eccentricity, or None.
    """

    def ratio(size: float) -> float:
        second = partner(size)
        if second is None:
            return math.nan
        properties = body_of(size, second).mass_properties
        return properties.I1 / properties.I3

    ratios = [ratio(size) for size in sizes]
    if not np.isfinite(ratios).any():
        alphas = [alpha for size in sizes for alpha in extremes(size)]
        between = f"one from {min(alphas):.3f} to {max(alphas):.3f}" if alphas else "none"
        raise InvalidInput(
            "eccentricity", eccentricity, between, "is out of reach of bodies of this kind"
        )
    for (low, below), (high, above) in pairwise(zip(sizes, ratios, strict=True)):
        if min(below, above) <= inertia_ratio <= max(below, above):
            size = _root(lambda size: ratio(size) - inertia_ratio, low, high)
            second = partner(size)
            if second is not None:
                return body_of(size, second)
    runs = [list(run) for finite, run in groupby(ratios, math.isfinite) if finite]
    longer = [run for run in runs if len(run) > 1] or runs
    between = " or ".join(f"{min(run):.5g} to {max(run):.5g}" for run in longer)
    raise InvalidInput(
        "inertia_ratio",
        inertia_ratio,
        f"one from {between}",
        "is out of reach with this eccentricity",
    )


def _root(function: Callable[[float], float], low: float, high: float) -> float:
    return float(brentq(function, low, high, xtol=1e-15, rtol=1e-15))
