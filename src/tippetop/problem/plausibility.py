"""Checks of a problem for implausible numbers, such as those of a wrong unit.

A mass element at the distance r from the axis and the height z above the centre of mass adds r^2 to
I3 and r^2 / 2 + z^2 to I1, per mass. So three moments are m times the mean of a function over the
mass, whose mean height is 0:

    I3: r^2        I1 - I3 / 2: z^2        I1 + I3 / 2: r^2 + z^2, the distance squared.

All mass is inside the convex hull of the body's surfaces. The mean of a function f is at most the
least concave function of z above f there, at z = 0. As the three functions are convex, a line in z
that is above f at the corners (r_i, z_i) of a polygon is above f in all of it. Hence

    mean of f  <=  min over slopes s of max over i of (f(r_i, z_i) - s z_i),

with equality if all mass is at two corners, one above the centre of mass and one below it. For z^2
the bound is the product of the body's extents above and below the centre of mass. For a sphere of
radius R whose centre is c from the centre of mass, all three bounds are m (R^2 - c^2).
"""

import math
from typing import NamedTuple, TypeAlias

from tippetop.mechanics.surfaces.hull import Hull, acting, each_surface, lowest_surface
from tippetop.mechanics.surfaces.surface import Surface
from tippetop.mechanics.vectors import Scalar
from tippetop.problem.problem import Problem

CORNERS = 25
"""Corners of the polygon inscribed in half a meridian; its r^2 and z^2 are at most 0.5 % less."""

POLE = 1e-4
"""Tilt of the first corner, rad: at a pole a ring has no single point of contact."""

SLACK = 0.01
"""Share of the largest r^2 and z^2 by which a moment may exceed its bound: real sharp edges are a
little round, numbers are rounded, and the polygon is inscribed.
"""

FAR = 1e-3
"""Share of a bound below which a moment is implausible: all mass in a core of a thirtieth of the
size.
"""

MASSES, SIZES = (1e-4, 5.0), (1e-3, 0.5)
"""Masses, kg, and largest diameters, m, of tops that people spin on a table."""

WIDEST_PATCH = 0.5
"""Largest plausible radius of a contact patch, in radii of the body: the laws of friction are those
of small patches.
"""

HALF_TURN = 0.5 * math.pi + 1e-3
"""Tilt at launch, rad, above which the axis points down; more than any rounding of pi / 2."""

FASTEST = 1e4
"""Largest plausible spin, rad/s: no toy is faster, but spins in rpm read as rad/s are."""

AIR = 1.2
"""Density of air, kg/m^3."""

ROUNDING = 1e-12
"""Relative difference below which two numbers are equal but for rounding."""


class Doubt(NamedTuple):
    """Implausible property of a problem."""

    kind: str
    """Name of its sentence in `implausible.SENTENCES`."""
    gaps: tuple[tuple[str, str], ...]
    """Names and texts of the numbers in that sentence."""


class Outside(NamedTuple):
    """Extents of a body from its centre of mass.

    The means are the largest ones over any distribution of mass inside; infinite if all of the body
    is above its centre of mass, or below it.
    """

    across: Scalar
    """Largest distance from the axis, m."""
    below: Scalar
    """Extent below the centre of mass along the axis, m; negative if the body is all above."""
    above: Scalar
    """Extent above the centre of mass along the axis, m."""
    mean_width: Scalar
    """Largest mean of the squared distance from the axis, m^2."""
    mean_square: Scalar
    """Largest mean of the squared distance from the centre of mass, m^2."""
    mean_length: Scalar
    """Largest mean of the squared height, m^2."""
    furthest: Scalar
    """Largest squared distance from the centre of mass, m^2."""
    top_heaviness: Scalar
    """Height of the centre of mass above the centre of the ball that the body stands upright on, m;
    0 if it is not above, or not in such a ball.
    """


Check: TypeAlias = tuple[str, Scalar, tuple[tuple[str, Scalar, str], ...]]
"""Kind of doubt, whether it holds, and name, value and unit of its numbers."""


def doubts(problem: Problem) -> list[Doubt]:
    """Return what is implausible about a problem, at most one doubt of each kind."""
    distinct: list[Doubt] = []
    for kind, holds, numbers in checks(problem, outside_of(problem.body.surface)):
        if holds and kind not in [doubt.kind for doubt in distinct]:
            texts = [(name, _text(number, unit)) for name, number, unit in numbers]
            distinct.append(Doubt(kind, tuple(texts)))
    return distinct


def checks(problem: Problem, outside: Outside) -> list[Check]:
    """Return kinds of doubts, whether each holds, and names, values and units of its numbers.

    The numbers of the problem and of its outside may be arrays; the checks then hold arrays too.
    """
    body, launch = problem.body, problem.launch
    mass, spin, tilt = body.mass, launch.spin, launch.tilt
    across, height = outside.across, outside.above + outside.below
    patch = getattr(problem.friction, "patch_radius", 0.0)
    width, slack = SLACK * across * across, SLACK * outside.furthest
    rows: list[Check] = [
        *_moment_checks("I3", body.I3, mass, outside.mean_width, width),
        *_moment_checks("I1 + I3/2", body.I1 + 0.5 * body.I3, mass, outside.mean_square, slack),
        _bound_check("I1 - I3/2", body.I1 - 0.5 * body.I3, mass, outside.mean_length, slack),
    ]
    for gap in (-1.0 * outside.below, -1.0 * outside.above):
        away = gap > SLACK * (across + abs(height))
        rows.append(("centre", away, (("distance", gap, "m"),)))
    least, most = MASSES
    rows.append(("mass", (mass < least) | (mass > most), (("value", mass, "kg"),)))
    least, most = SIZES
    small = (2.0 * across < least) & (height < least)
    large = (2.0 * across > most) | (height > most)
    rows.append(("size", small | large, (("across", 2.0 * across, "m"), ("height", height, "m"))))
    wide = (("patch", patch, "m"), ("radius", across, "m"))
    rows.append(("patch", patch > WIDEST_PATCH * across, wide))
    rows.append(("tilt", tilt > HALF_TURN, (("value", tilt, "rad"),)))
    rows.append(("spin", abs(spin) > FASTEST, (("value", spin, "rad/s"),)))
    along_axis = (launch.precession != 0.0) & ((tilt == 0.0) | (tilt == math.pi))
    rows.append(("precession", along_axis, (("value", launch.precession, "rad/s"),)))
    heavy = (outside.top_heaviness > 0.0) & (tilt <= HALF_TURN)
    rows.append(("heavy", heavy, (("height", outside.top_heaviness, "m"),)))
    # The volume of a spheroid; a cylinder has 1.5 times as much.
    volume = 2.0 / 3.0 * math.pi * across * across * height
    rows.append(("light", mass < AIR * volume, (("value", mass, "kg"), ("volume", volume, "m^3"))))
    return rows


def _moment_checks(
    name: str, moment: Scalar, mass: Scalar, mean: Scalar, slack: Scalar
) -> list[Check]:
    """Return the checks that a moment is neither above m times its largest mean nor far below."""
    above = _bound_check(name, moment, mass, mean, slack)
    return [above, ("core", (moment < FAR * mass * mean) & (mean < math.inf), above[2])]


def _bound_check(name: str, moment: Scalar, mass: Scalar, mean: Scalar, slack: Scalar) -> Check:
    """Return the check that a moment is not above m times its largest mean by more than the
    slack.
    """
    numbers = (
        ("name", name, ""),
        ("value", moment, "kg m^2"),
        ("bound", mass * mean, "kg m^2"),
        ("radius", mean**0.5, "m"),
    )
    return ("moment", moment > mass * (mean + slack), numbers)


def outside_of(surface: Surface) -> Outside:
    """Return the extents of a body with this surface, or hull of surfaces.

    If arithmetic overflows all are nan, for which no check holds.
    """
    try:
        return _measured(surface)
    except ArithmeticError:
        nan = math.nan
        return Outside(nan, nan, nan, nan, nan, nan, nan, nan)


def _measured(surface: Surface) -> Outside:
    """Return the extents of a body: exact for a sphere, else from a polygon in its meridian."""
    if surface.spherical and not isinstance(surface, Hull):
        return _measured_sphere(surface)
    corners = [
        _corner(one, min(max(math.pi * k / (CORNERS - 1), POLE), math.pi - POLE))
        for one in each_surface(surface)
        for k in range(CORNERS)
    ]
    widths = [(z, r * r) for r, z in corners]
    squares = [(z, r * r + z * z) for r, z in corners]
    across, heights = max([r for r, _ in corners]), [z for _, z in corners]
    below, above = -min(heights), max(heights)
    return Outside(
        across,
        below,
        above,
        _largest_mean(widths),
        _largest_mean(squares),
        below * above if below >= 0.0 and above >= 0.0 else math.inf,
        max([square for _, square in squares]),
        _top_heaviness(surface),
    )


def _measured_sphere(surface: Surface) -> Outside:
    """Return the extents of a sphere."""
    center = -surface.slope(1.0)
    radius = surface.height(1.0) + center
    if radius == 0.0:
        # A tip alone says nothing of the extents of the body above it.
        return Outside(*[math.nan] * 8)
    mean = radius**2 - center**2
    mean = mean if mean >= 0.0 else math.inf
    return Outside(
        radius,
        radius - center,
        radius + center,
        mean,
        mean,
        mean,
        (radius + abs(center)) ** 2,
        _top_heaviness(surface),
    )


def _corner(surface: Surface, tilt: float) -> tuple[float, float]:
    """Return the contact point at a tilt: distance from the axis, and height along it, m."""
    c, s = math.cos(tilt), math.sin(tilt)
    slope = surface.slope(c)
    across = surface.height(c) - c * slope
    return s * across, -slope - c * across


def _largest_mean(points: list[tuple[float, float]]) -> float:
    """Return the largest mean of a quantity over points (height, quantity) whose mean height is 0.

    It is the value at 0 of the line through two points, one on either side, with no point above it;
    infinite if all points are on one side.
    """
    below = [point for point in points if point[0] <= 0.0]
    above = [point for point in points if point[0] >= 0.0]
    if not below or not above:
        return math.inf
    low, high = _highest(below, 0.0), _highest(above, 0.0)
    for _ in range(len(points)):
        width = high[0] - low[0]
        slope = (high[1] - low[1]) / width if width > 0.0 else 0.0
        level = low[1] - slope * low[0]
        point = _highest(points, slope)
        if point[0] == 0.0 or point[1] - slope * point[0] <= level + ROUNDING * abs(level):
            break
        if point[0] < 0.0:
            low = point
        else:
            high = point
    return max(level, point[1] - slope * point[0])


def _highest(points: list[tuple[float, float]], slope: float) -> tuple[float, float]:
    """Return the point (height, quantity) that is highest above a line of this slope."""
    best, most = points[0], -math.inf
    for point in points:
        level = point[1] - slope * point[0]
        if level > most:
            best, most = point, level
    return best


def _top_heaviness(surface: Surface) -> float:
    """Return `Outside.top_heaviness` of a surface."""
    lowest = lowest_surface(surface, 1.0)
    if not acting(lowest).spherical:
        return 0.0
    height = lowest.slope(1.0)
    radius = lowest.height(1.0) - height
    return height if ROUNDING * radius < height < (1.0 - SLACK) * radius else 0.0


def _text(number: Scalar, unit: str) -> str:
    """Return a number with its unit for people: lengths below 10 m in mm, masses below 1 kg in
    g.
    """
    if unit == "":
        return str(number)
    if unit == "m" and number < 10.0:
        return f"{1000.0 * number:.4g} mm"
    if unit == "kg" and number < 1.0:
        return f"{1000.0 * number:.4g} g"
    return f"{number:.5g} {unit}" if unit == "rad/s" else f"{number:.4g} {unit}"
