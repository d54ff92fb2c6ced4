"""Circles, ellipses and tangent arcs through points of the half-plane beside the axis."""

# translate module: numpy

import cmath
import math
from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from tippetop.lathe.edges import Edge

Array = NDArray[np.complex128]

LARGEST_TURN = 0.9 * math.pi
"""Largest turn of one arc, rad: the centre of half a circle is on its chord, and inexact."""

STRAIGHT = 1e-14
"""Square of the relative width below which points count as collinear: that of rounding."""


def circle_through(points: Array) -> tuple[complex, float] | None:
    """Return centre and radius of the circle closest to points; None if they are on a line.

    The circle minimises the sum of squares of its equation.
    """
    base = complex(points.mean())
    arms = points - base
    x, y = arms.real, arms.imag
    square = x * x + y * y
    xx, xy, yy = float(x @ x), float(x @ y), float(y @ y)
    # The mean of the points is the origin: the constant term separates.
    size = xx + yy
    area = xx * yy - xy * xy
    if not area > STRAIGHT * size * size:
        return None
    p, q = 0.5 * float(x @ square), 0.5 * float(y @ square)
    center = complex(p * yy - q * xy, q * xx - p * xy) / area
    return base + center, math.sqrt(abs(center) ** 2 + size / len(points))


def circle_on_axis(points: Array) -> tuple[complex, float] | None:
    """Return centre and radius of the circle closest to points, with its centre on the axis."""
    base = 1j * points.imag.mean()
    arms = points - base
    columns = [2.0 * arms.imag, np.ones(len(arms))]
    height, remainder = least_squares(columns, np.abs(arms) ** 2)
    square = remainder + height**2
    if not square > 0.0:
        return None
    return base + 1j * height, math.sqrt(square)


def ellipse_on_axis(points: Array) -> tuple[float, float, float, float] | None:
    """Return semi-axes across and along the axis, height of the centre, and largest distance from
    points.

    None is returned if no ellipse is close to the points.
    """
    base = points.imag.mean()
    size = float(np.abs(points - 1j * base).max())
    r, z = points.real / size, (points.imag - base) / size
    p, q, s = least_squares([r**2, z**2, z], np.ones(len(points)))
    if not (p > 0.0 and q > 0.0):
        return None
    level = 1.0 + s * s / (4.0 * q)
    across, along, center = math.sqrt(level / p), math.sqrt(level / q), -s / (2.0 * q)
    value = (r / across) ** 2 + ((z - center) / along) ** 2 - 1.0
    gradient = 2.0 * np.hypot(r / across**2, (z - center) / along**2)
    apart = float(np.abs(value / gradient).max())
    return size * across, size * along, base + size * center, size * apart


# translate: runtime
def least_squares(
    columns: Sequence[NDArray[np.float64]], values: NDArray[np.float64]
) -> tuple[float, ...]:
    """Return the factors of columns whose sum is closest to some values."""
    factors, *_ = np.linalg.lstsq(np.stack(columns, axis=1), values, rcond=None)
    return tuple(factors.tolist())


def biarc(start: complex, along: complex, end: complex, towards: complex) -> list[Edge] | None:
    """Return two arcs, tangent to each other, from a point with a unit tangent to another one.

    Of all such pairs it is the one whose control polygon has equal legs. The result is None if the
    arcs would turn back.
    """
    chord = end - start
    both = along + towards
    slope = (chord * both.conjugate()).real
    spread = 2.0 * (1.0 - (along * towards.conjugate()).real)
    square = abs(chord) ** 2
    if spread > 1e-12:
        leg = (math.sqrt(slope**2 + spread * square) - slope) / spread
    elif slope > 0.0:
        leg = square / (2.0 * slope)
    else:
        return None
    middle = 0.5 * (start + end + leg * (along - towards))
    if middle in (start, end):
        return None
    first = 2.0 * cmath.phase((middle - start) / along)
    second = 2.0 * cmath.phase(towards / (end - middle))
    if max(abs(first), abs(second)) > 0.5 * math.pi:
        return None
    return [Edge(start, middle, first), Edge(middle, end, second)]


def tangents_along(points: Array, within: float) -> Array:
    """Return the unit tangents at points of a smooth curve.

    Each is the tangent of a circle through neighbouring points, as many as lie within a distance of
    one circle.
    """
    tangents = np.full(len(points), 0j)
    last = len(points) - 1
    for k in range(len(points)):
        low, high = max(0, k - 1), min(last, k + 1)
        if high - low < 2:
            low, high = max(0, high - 2), min(last, low + 2)
        best = _tangent(points, low, high, k)
        width = 2
        while width <= last:
            low, high = max(0, k - width), min(last, k + width)
            some = points[low : high + 1]
            circle = circle_through(some)
            if circle is None or np.abs(np.abs(some - circle[0]) - circle[1]).max() > 0.1 * within:
                break
            best = _tangent(points, low, high, k)
            width *= 2
        tangents[k] = best
    return tangents


def _tangent(points: Array, low: int, high: int, k: int) -> complex:
    some = points[low : high + 1]
    chord = complex(some[-1] - some[0])
    circle = circle_through(some)
    along = chord if circle is None else 1j * (complex(points[k]) - circle[0])
    along /= abs(along)
    return along if (along * chord.conjugate()).real > 0.0 else -along


def arcs_around(
    center: complex, radius: float, start: complex, end: complex, about: float
) -> list[Edge]:
    """Return the arcs around a centre between two points that turn by about the angle `about`."""
    first, second = (cmath.phase(point - center) for point in (start, end))
    turn = about + (second - first - about + math.pi) % math.tau - math.pi
    parts = max(1, math.ceil(abs(turn) / LARGEST_TURN))
    inner = [center + cmath.rect(radius, first + turn * k / parts) for k in range(1, parts)]
    points = [start, *inner, end]
    return [Edge(*ends, turn / parts) for ends in pairwise(points)]


def circles_meet(
    first: tuple[complex, float], second: tuple[complex, float], near: complex
) -> complex | None:
    """Return the intersection of two circles that is closest to a point; None if there is none."""
    (center, radius), (other_center, other_radius) = first, second
    between = other_center - center
    apart = abs(between)
    if not apart:
        return None
    along = (apart + (radius**2 - other_radius**2) / apart) / 2.0
    square = radius**2 - along**2
    if square < 0.0:
        return None
    points = [
        center + between / apart * complex(along, side * math.sqrt(square)) for side in (-1.0, 1.0)
    ]
    return min(points, key=lambda point: abs(point - near))
