"""Removal of the rounding of a profile's numbers, which is estimated from their digits."""

# translate module: numpy

import cmath
import math
from collections.abc import Callable, Sequence
from decimal import Decimal
from itertools import pairwise

from tippetop.lathe.edges import Edge

COARSEST = 1e-4
"""Largest rounding that is undone, in sizes of the profile: numbers of two digits stay as
stated.
"""

FINEST = 1e-9
"""Smallest rounding, in sizes of the profile, as of computed numbers."""

EXACT = 1e-14
"""Relative distance of a place from its circle by floating-point rounding."""

Point = tuple[float, ...]
RoundingAt = Callable[[Point], float]


# translate: runtime
def rounding_of(number: float) -> float:
    """Return half a unit of the last decimal of a number, 0 of a whole number.

    Examples
    --------
    >>> round(rounding_of(14.142), 6), rounding_of(20.0)
    (0.0005, 0.0)
    """
    exponent = Decimal(repr(float(number))).normalize().as_tuple().exponent
    return 0.5 * 10.0**exponent if isinstance(exponent, int) and exponent < 0 else 0.0


def usual_rounding(points: Sequence[Point]) -> float:
    """Return the median rounding of the numbers of points, whole numbers left out."""
    roundings = sorted(
        rounding for point in points for rounding in map(rounding_of, point) if rounding
    )
    return roundings[len(roundings) // 2] if roundings else 0.0


def unrounded(points: Sequence[Point], rounding: float | None = None) -> tuple[Point, ...]:
    """Return the points of a profile, with arcs centred on the axis if their digits allow it.

    Straight edges shorter than the rounding are omitted. The rounding of every number follows from
    its digits unless it is passed.
    """
    heights = [point[1] for point in points]
    size = max(*(abs(point[0]) for point in points), max(heights) - min(heights))

    def rounding_at(point: Point) -> float:
        if rounding is not None:
            return rounding
        return min(COARSEST * size, max(FINEST * size, *map(rounding_of, point)))

    remaining = _without_short_edges(list(points), rounding_at)
    return _around_axis(remaining, rounding_at)


def _without_short_edges(points: list[Point], rounding_at: RoundingAt) -> list[Point]:
    """Return the points without straight edges that are shorter than the rounding of their ends."""
    remaining = [points[0]]
    for k, point in enumerate(points[1:], start=1):
        before = remaining[-1]
        short = math.dist(point[:2], before[:2]) <= rounding_at(point) + rounding_at(before)
        is_straight = len(point) == 2 or not point[2]
        if not (short and is_straight and len(points) > 3):
            remaining.append(point)
        elif k == len(points) - 1 and len(remaining) > 1:
            remaining[-1] = (*point[:2], *before[2:])
    return remaining


def _around_axis(points: list[Point], rounding_at: RoundingAt) -> tuple[Point, ...]:
    """Return the points, with arcs centred on the axis if they are so to within rounding."""
    places = [complex(*point[:2]) for point in points]
    roundings = [rounding_at(point) for point in points]
    circles: list[tuple[complex, float] | None] = [None] * len(points)
    for k in range(1, len(points)):
        radius = points[k][2] if len(points[k]) == 3 else 0.0
        if radius:
            within = 2.0 * max(roundings[k - 1], roundings[k])
            circles[k] = _circle(places[k - 1], places[k], radius, within, circles[k - 1])
    circles = _shared(circles, places, roundings)
    for k, place in enumerate(places):
        beside = [circle for circle in circles[k : k + 2] if circle]
        if beside:
            places[k] = _on_circles(place, beside, k in (0, len(points) - 1))
    # A closed line ends where it began, to its digits.
    if math.dist(points[0][:2], points[-1][:2]) <= roundings[0] + roundings[-1]:
        places[0] = places[0] if circles[1] else places[-1]
        places[-1] = places[0]
    moved = []
    for k, (point, place) in enumerate(zip(points, places, strict=True)):
        circle = circles[k]
        end = (math.copysign(circle[1], point[2]),) if circle else point[2:]
        moved.append((place.real, place.imag, *end))
    return tuple(moved)


def _shared(
    circles: list[tuple[complex, float] | None], places: list[complex], roundings: list[float]
) -> list[tuple[complex, float] | None]:
    """Return the circles of arcs; successive ones that are one to their digits are made one.

    That is the circle of an arc that ends on the axis, or else of the finest numbers: its centre is
    the most exact.
    """
    errors = [0.0] + [
        0.0 if min(start.real, end.real) == 0.0 else max(roundings[arc : arc + 2])
        for arc, (start, end) in enumerate(pairwise(places))
    ]
    shared = list(circles)
    k = 1
    while k < len(circles):
        end = k + 1
        while end < len(circles) and _are_one(circles, roundings, end):
            end += 1
        best = errors[k:end].index(min(errors[k:end]))
        for arc in range(k, end):
            shared[arc] = circles[k + best]
        k = end
    return shared


def _are_one(circles: list[tuple[complex, float] | None], roundings: list[float], k: int) -> bool:
    """Return whether an arc and the one before are on one circle, to their digits."""
    before, after = circles[k - 1], circles[k]
    within = 4.0 * max(roundings[k - 2 : k + 1])
    return before is not None and after is not None and _are_same(before, after, within)


def _circle(
    start: complex,
    end: complex,
    radius: float,
    within: float,
    before: tuple[complex, float] | None,
) -> tuple[complex, float] | None:
    """Return centre (on the axis) and radius of an arc; None if its centre is elsewhere.

    The circle of the arc before is returned if both arcs are on it.
    """
    size = abs(radius)
    share = abs(end - start) / (2.0 * size)
    if not 0.0 < share <= 1.0 + 1e-6:
        return None
    half = math.copysign(math.asin(min(1.0, share)), radius)
    stated = Edge(start, end, 2.0 * half)
    ends = [end for end in (start, end) if end.real <= within]
    if ends:
        center = ends[0].imag + math.copysign(size, stated.center.imag - ends[0].imag)
    else:
        below = [
            point.imag
            + math.copysign(
                math.sqrt(max(0.0, size**2 - point.real**2)), stated.center.imag - point.imag
            )
            for point in (start, end)
        ]
        # The end nearer to the axis gives the centre: the root has all digits there.
        center = below[0] if start.real < end.real else below[1]
    on_axis = complex(0.0, center)
    if before and _are_same(before, (on_axis, size), 2.0 * within):
        on_axis, size = before
    apart = max(abs(abs(point - on_axis) - size) for point in (start, end))
    is_same_side = abs(on_axis - stated.center) <= 0.1 * size
    return (on_axis, size) if apart <= within and is_same_side else None


def _are_same(first: tuple[complex, float], second: tuple[complex, float], within: float) -> bool:
    return max(abs(first[0] - second[0]), abs(first[1] - second[1])) <= within


def _on_circles(place: complex, circles: list[tuple[complex, float]], is_end: bool) -> complex:
    """Return a place moved onto its circle; onto the last, if two circles differ."""
    center, radius = circles[-1]
    arm = place - center
    if abs(abs(arm) - radius) <= EXACT * radius:
        return place
    if is_end and place.real <= FINEST * radius:
        return complex(0.0, center.imag + math.copysign(radius, arm.imag))
    return center + cmath.rect(radius, cmath.phase(arm))
