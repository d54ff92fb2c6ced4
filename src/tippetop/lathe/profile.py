"""Profiles of bodies of revolution: closed lines of edges beside the axis around a volume."""

# translate module: numpy

import math
from collections.abc import Sequence
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from tippetop.lathe.edges import Edge, Points, meetings
from tippetop.support.errors import Described, InvalidInput

ROUNDING = 1e-9
"""Distance within which two places are equal, in sizes of the profile."""

HALF_CIRCLE = 1e-12
"""Relative difference of an arc's radius from half its chord within which it is half a circle,
whose centre is then exact.
"""

SHORT = 1e-6
"""Relative amount by which the radius of half a circle may be too short because of rounded ends."""

MOST = 2000
"""Largest number of points of a profile."""

MOST_STATED = 100_000
"""Largest number of points of a profile that is fitted to them."""

LARGEST = 1e6
"""Largest number in a profile, and inverse of its smallest size."""


class Profile:
    """Closed line in which a half-plane from the axis cuts the surface of a body.

    Attributes
    ----------
    edges
        Its edges, with the body on their left, without the part on the axis.
    """

    def __init__(self, edges: Sequence[Edge]) -> None:
        leftwards = area_of(edges) > 0.0
        self.edges = tuple(edges if leftwards else [edge.backwards for edge in reversed(edges)])

    @cached_property
    def loop(self) -> tuple[Edge, ...]:
        """Edges, with the part of the axis that closes them."""
        first, last = self.edges[0].start, self.edges[-1].end
        return self.edges if first == last else (*self.edges, Edge(last, first))

    @cached_property
    def size(self) -> float:
        """Largest extent, m."""
        points = self.points(8)
        return float(max(np.ptp(points.real), np.ptp(points.imag), points.real.max()))

    @cached_property
    def nodes(self) -> tuple[Points, NDArray[np.float64]]:
        """Quadrature points along the profile and their weights in integrals over dz; see
        `Edge.nodes`.
        """
        points, weights = zip(*(edge.nodes() for edge in self.edges), strict=True)
        return np.concatenate(points), np.concatenate(weights)

    @property
    def reaches_axis(self) -> bool:
        """Whether the body contains its axis, rather than lying around it."""
        return len(self.loop) > len(self.edges) or self.edges[0].start.real == 0.0

    def points(self, steps: int) -> Points:
        """Return points along the profile, `steps` on every arc; a closed line repeats its
        first.
        """
        shares = [np.arange(steps) / steps if edge.turn else np.zeros(1) for edge in self.edges]
        points = [edge.points(share) for edge, share in zip(self.edges, shares, strict=True)]
        return np.concatenate([*points, [self.edges[-1].end]])

    def points_above(self, height: float) -> list[tuple[float, ...]]:
        """Return the points of the profile, with heights above another origin, m."""
        start = self.edges[0].start
        ends = [(edge.end, (edge.radius,) if edge.turn else ()) for edge in self.edges]
        return [
            (point.real, point.imag - height, *radius) for point, radius in [(start, ()), *ends]
        ]

    def surrounds(self, point: complex) -> bool:
        """Return whether a point that is not on the profile is inside."""
        return abs(sum(edge.angle_seen(point) for edge in self.loop)) > math.pi

    def distance(self, point: complex) -> float:
        """Return the distance of a point from its edges, m."""
        return min(edge.distance(point) for edge in self.edges)

    def sides(self, outer: "Profile", flush: float = 0.0) -> set[str]:
        """Return where the edges lie relative to another profile: "in" it, "on" its edges or
        "out".

        Edges lie on others within the distance `flush`, m, and always within rounding.
        """
        within = max(ROUNDING * outer.size, 0.5 * flush)
        sides = set()
        for edge in self.edges:
            met = (point for border in outer.edges for point in meetings(edge, border, within))
            shares = sorted({0.0, 1.0, *(min(1.0, max(0.0, edge.share(point))) for point in met)})
            for low, high in pairwise(shares):
                if (high - low) * abs(edge.chord) > 10.0 * within:
                    middle = complex(edge.points((low + high) / 2.0))
                    on = outer.distance(middle) <= 2.0 * within
                    sides.add("on" if on else "in" if outer.surrounds(middle) else "out")
        return sides


def profile_of(
    points: Sequence[Sequence[float]], unit: float = 1.0, field: str = "profile"
) -> Profile:
    """Return the profile through points, in metres.

    The points are distance from the axis, height along it and, where an arc ends, its radius, which
    is positive if the arc turns to the left. They go in either direction, from the axis to the axis
    or from a point to itself. Their numbers are in a `unit` (m), and messages call them `field`.

    Raises `InvalidInput` if they are not the edge of a body: an open line, one that meets itself or
    crosses the axis, an arc too tight for its ends, or no volume inside.
    """
    require_points(points, field, MOST)
    size = max(max(abs(point[0]), abs(point[1] - points[0][1])) for point in points)
    if not 1.0 / LARGEST <= size <= LARGEST:
        raise InvalidInput(
            field,
            Described(f"a body of size {size:g}"),
            f"one between {1 / LARGEST:g} and {LARGEST:g}",
        )
    edges = [_edge(points, number, size, field) for number in range(1, len(points))]
    edges = _closed(edges, ROUNDING * size, field)
    _refuse_meetings(edges, ROUNDING * size, field)
    if not abs(area_of(edges)) > ROUNDING * size**2:
        raise InvalidInput(field, [list(point) for point in points], "a line around some volume")
    return Profile([Edge(unit * edge.start, unit * edge.end, edge.turn) for edge in edges])


def area_of(edges: Sequence[Edge]) -> float:
    """Return the area between edges and the axis, m^2, positive on their left."""
    return sum(float(points.real @ weights) for points, weights in (edge.nodes() for edge in edges))


def require_points(points: Sequence[Sequence[float]], field: str, most: int = MOST_STATED) -> None:
    """Raise `InvalidInput` unless there are 2 to `most` points, none beyond the axis."""
    if not 2 <= len(points) <= most:
        raise InvalidInput(field, Described(f"{len(points)} points"), f"2 to {most} points")
    for number, point in enumerate(points):
        if len(point) not in (2, 3):
            accepted = "a point: distance from the axis, height and, where an arc ends, its radius"
            raise InvalidInput(f"{field}.{number}", list(point), accepted)
        if max(map(abs, point)) > LARGEST:
            raise InvalidInput(
                f"{field}.{number}", list(point), f"made of numbers of at most {LARGEST:g}"
            )
        if point[0] < 0.0:
            raise InvalidInput(
                f"{field}.{number}.0", point[0], "a distance from the axis, at least 0"
            )
    if len(points[0]) == 3 and points[0][2]:
        raise InvalidInput(
            f"{field}.0.2",
            points[0][2],
            "0",
            "is the radius of no arc: none ends at the first point",
        )


def _edge(points: Sequence[Sequence[float]], number: int, size: float, field: str) -> Edge:
    """Return the edge that ends at a point.

    Raises `InvalidInput` for an edge of no length, for an arc with too small a radius, and for an
    arc across the axis.
    """
    start, end = (complex(*point[:2]) for point in points[number - 1 : number + 1])
    if abs(end - start) <= ROUNDING * size:
        raise InvalidInput(
            f"{field}.{number}", list(points[number][:2]), "a point away from the one before"
        )
    radius = points[number][2] if len(points[number]) == 3 else 0.0
    if not radius:
        return Edge(start, end)
    share = abs(end - start) / (2.0 * abs(radius))
    if share > 1.0 + SHORT:
        least = (
            "0 for a straight edge, or a size of at least half the distance,"
            f" {abs(end - start) / 2:g}"
        )
        raise InvalidInput(f"{field}.{number}.2", radius, least)
    half = math.pi / 2.0 if share > 1.0 - HALF_CIRCLE else math.asin(share)
    edge = Edge(start, end, math.copysign(2.0 * half, radius))
    innermost = edge.center - abs(edge.radius)
    share = edge.share(innermost)
    if innermost.real < -ROUNDING * size and 0.0 < share < 1.0:
        raise InvalidInput(
            f"{field}.{number}", list(points[number]), "an arc that stays beside the axis"
        )
    return edge


def _closed(edges: list[Edge], within: float, field: str) -> list[Edge]:
    """Return edges that end exactly on the axis or where they began; raise `InvalidInput` if
    not.
    """
    first, last = edges[0].start, edges[-1].end
    closes = abs(last - first) <= within
    if closes:
        edges[-1] = edges[-1]._replace(end=first)
    elif first.real > within or last.real > within:
        ends = (
            f"an open line from ({first.real:g}, {first.imag:g}) to ({last.real:g}, {last.imag:g})"
        )
        raise InvalidInput(
            field,
            Described(ends),
            "a line that ends where it began, or one from the axis to the axis",
        )
    edges = [
        edge._replace(start=_on_axis(edge.start, within), end=_on_axis(edge.end, within))
        for edge in edges
    ]
    on_axis = [
        k
        for k, edge in enumerate(edges)
        if not edge.turn and edge.start.real == edge.end.real == 0.0
    ]
    if closes and len(on_axis) == 1:
        edges = edges[on_axis[0] + 1 :] + edges[: on_axis[0]]
    for point in [edge.end for edge in edges[:-1]] + [_innermost(edge) for edge in edges]:
        if point.real <= within:
            place = f"a line through the axis at a height of {point.imag:g}"
            raise InvalidInput(
                field, Described(place), "a line that is on the axis at its ends only"
            )
    return edges


def _on_axis(point: complex, within: float) -> complex:
    return complex(0.0, point.imag) if point.real <= within else point


def _innermost(edge: Edge) -> complex:
    """Return the point of an arc closest to the axis between its ends, or its middle."""
    if edge.turn:
        point = edge.center - abs(edge.radius)
        share = edge.share(point)
        if 1e-6 < share < 1.0 - 1e-6:
            return point
    return complex(edge.points(0.5))


def _refuse_meetings(edges: list[Edge], within: float, field: str) -> None:
    """Raise `InvalidInput` if a line meets itself other than at common ends of its edges."""
    reach = np.array([edge.sagitta + within for edge in edges])
    starts = np.array([edge.start for edge in edges])
    ends = np.array([edge.end for edge in edges])
    leftmost = (np.minimum(starts.real, ends.real) - reach).tolist()
    rightmost = (np.maximum(starts.real, ends.real) + reach).tolist()
    low = (np.minimum(starts.imag, ends.imag) - reach).tolist()
    high = (np.maximum(starts.imag, ends.imag) + reach).tolist()
    near = []
    upwards = sorted(range(len(edges)), key=lambda place: low[place])
    for rank, place in enumerate(upwards):
        above = rank + 1
        while above < len(upwards) and low[upwards[above]] <= high[place]:
            second = upwards[above]
            if leftmost[second] <= rightmost[place] and rightmost[second] >= leftmost[place]:
                near.append((min(place, second), max(place, second)))
            above += 1
    for first, second in sorted(near):
        _refuse_meeting(edges, first, second, within, field)


def _refuse_meeting(edges: list[Edge], first: int, second: int, within: float, field: str) -> None:
    """Raise `InvalidInput` if two edges meet other than at common ends."""
    shared = _shared_ends(edges, first, second)
    for point in meetings(edges[first], edges[second], within):
        if all(abs(point - end) > 10.0 * within for end in shared):
            place = (
                f"a line whose edges {first + 1} and {second + 1} meet at ({point.real:g},"
                f" {point.imag:g})"
            )
            raise InvalidInput(field, Described(place), "a line that does not meet itself")


def _shared_ends(edges: list[Edge], first: int, second: int) -> list[complex]:
    """Return the common ends of two edges, of which the second comes later in the line."""
    ends = [edges[first].end] if second == first + 1 else []
    if first == 0 and second == len(edges) - 1 and edges[0].start == edges[-1].end:
        ends.append(edges[0].start)
    return ends
