"""Fitting of profiles: arcs and lines through stated points, without the rounding of their numbers.

Runs of straight edges become lines and arcs of circles where the points are on them, tangent arcs
along other smooth curves, and edges as drawn between corners.
"""

# translate module: numpy

import cmath
import math
from collections.abc import Callable, Sequence
from functools import partial
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from tippetop.lathe.arcs import (
    Array,
    arcs_around,
    biarc,
    circle_on_axis,
    circle_through,
    circles_meet,
    ellipse_on_axis,
    tangents_along,
)
from tippetop.lathe.edges import Edge
from tippetop.lathe.profile import LARGEST
from tippetop.lathe.rounding import unrounded, usual_rounding

TOLERANCE = 1e-4
"""Default distance of the fitted profile from the points, in sizes of the profile."""

COARSEST = math.radians(29.0)
"""Largest angle between edges that stand for an arc, rad: a polygon of 12 edges or fewer stays
one.
"""

SMOOTH = math.radians(12.0)
"""Largest angle between edges that stand for a smooth curve other than an arc, rad."""

UNEVEN = 4.0
"""Largest ratio of the lengths of neighbouring edges on one smooth curve."""

FEWEST_ON_ARC = 4
"""Smallest number of edges on an arc: four points of any symmetric chamfer are on a circle."""

FEWEST_ON_CURVE = 6
"""Smallest number of edges on a smooth curve."""

WIDE = math.radians(60.0)
"""Turn from which points within the tolerance of a circle are an arc, rad: no other smooth curve
stays so close to its circle of curvature for so long.
"""

NARROW = math.radians(20.0)
"""Turn from which points within `CLOSE` of a circle are an arc in a smooth line, rad."""

CLOSE = 0.1
"""Share of the tolerance within which points of a short arc lie on its circle, unless they are
rounded to fewer digits.
"""

ABRUPT = 0.75
"""Share of the edges within the tolerance of a circle that must be as close as `CLOSE`: a smooth
curve leaves its circle of curvature with the third power of the length, and has less than half.
"""

COARSEST_ROUNDING = 1e-3
"""Largest rounding of points on smooth curves, in sizes of the profile."""

FLAT = 1e-9
"""Sagitta below which an edge is straight, in sizes of the profile."""

Points = tuple[tuple[float, ...], ...]
Circle = tuple[complex, float]


class Fit(NamedTuple):
    """A profile fitted to points."""

    points: Points
    """Points that state the fitted profile."""
    stated: int
    """Number of edges that were stated."""
    edges: int
    """Number of edges of the fitted profile."""
    deviation: float
    """Largest distance of a stated point from the fitted profile, in the unit of the points."""


def fit(points: Sequence[Sequence[float]], tolerance: float = TOLERANCE) -> Fit:
    """Return the profile fitted to points, to within a tolerance in sizes of the profile.

    With the tolerance 0 every edge is as stated.

    Examples
    --------
    >>> from math import cos, pi, sin
    >>> ball = [(sin(k * pi / 60), -cos(k * pi / 60)) for k in range(61)]
    >>> ball[-1] = (0.0, 1.0)
    >>> found = fit(ball)
    >>> found.stated, found.edges, found.deviation < 1e-12
    (60, 2, True)
    """
    stated = tuple(tuple(float(number) for number in point) for point in points)
    count = len(stated) - 1
    size = _size(stated) if count > 0 and all(len(point) in (2, 3) for point in stated) else 0.0
    if not (0.0 < size <= LARGEST and tolerance > 0.0):
        return Fit(stated, count, count, 0.0)
    written = unrounded(stated)
    found, deviation, k = [written[0]], 0.0, 1
    while k < len(written):
        end = k
        while end < len(written) and not any(written[end][2:]):
            end += 1
        if end == k:
            found.append(written[k])
            k += 1
            continue
        run = np.array([complex(*point[:2]) for point in written[k - 1 : end]])
        rounding = min(usual_rounding(stated), COARSEST_ROUNDING * size)
        edges, apart = _fit_run(run, max(tolerance * size, 1.5 * rounding), rounding)
        start = edges[0].start
        found[-1] = (start.real, start.imag, *found[-1][2:])
        found += [_point(edge, FLAT * size) for edge in edges]
        deviation, k = max(deviation, apart), end
    return Fit(tuple(found), count, len(found) - 1, deviation)


def _size(points: Points) -> float:
    heights = [point[1] for point in points]
    return max(*(abs(point[0]) for point in points), max(heights) - min(heights))


def _point(edge: Edge, flat: float) -> tuple[float, ...]:
    """Return the point that states an edge."""
    end = (edge.end.real, edge.end.imag)
    return end if edge.sagitta <= flat else (*end, edge.radius)


def _fit_run(points: Array, within: float, rounding: float) -> tuple[list[Edge], float]:
    """Return the edges fitted to a run of straight edges, and the largest distance of a point from
    them.
    """
    polyline = Polyline(points, within, rounding)
    pieces = polyline.pieces()
    parts = polyline.edges(pieces)
    deviation = 0.0
    for piece, edges in zip(pieces, parts, strict=True):
        # Points are compared with the edges of their own part: another may pass by.
        for point in points[piece.begin + 1 : piece.end]:
            apart = min(edge.distance(complex(point)) for edge in edges)
            deviation = max(deviation, apart)
    return [edge for part in parts for edge in part], deviation


class CurvePiece(NamedTuple):
    """A part of a polyline, with the curve that it stands for."""

    kind: str
    """"line", "arc", "curve" or "near arc": an arc unless the line continues smoothly beyond it."""
    begin: int
    end: int
    """Indices of its first and its last point."""
    circle: Circle = (0j, 0.0)
    """Centre and radius of an arc."""


class Polyline:
    """A run of straight edges that may stand for arcs and curves."""

    def __init__(self, points: Array, within: float, rounding: float) -> None:
        self.points = _with_poles(points)
        self.within = within
        self.close = max(CLOSE * within, min(1.2 * rounding, 4.0 * CLOSE * within))
        self.count = len(points) - 1
        chords = np.diff(self.points)
        lengths = np.abs(chords)
        turns = np.angle(chords[1:] * chords[:-1].conjugate())
        ratios = lengths[1:] / lengths[:-1]
        is_even = (ratios <= UNEVEN) & (ratios >= 1.0 / UNEVEN)
        self.is_soft = np.full(len(points), False)
        self.is_soft[1:-1] = (np.abs(turns) <= SMOOTH) & is_even
        self.curvature = np.zeros(len(points))
        self.curvature[1:-1] = np.abs(turns) / np.minimum(lengths[1:], lengths[:-1])
        # The directions of short edges scatter with their ends.
        is_long = np.minimum(lengths[1:], lengths[:-1]) > 10.0 * within
        self.is_sharp = np.full(len(points), False)
        self.is_sharp[1:-1] = (np.abs(turns) > COARSEST) & is_long

    def pieces(self) -> list[CurvePiece]:
        """Return the parts in their order."""
        if self._is_ellipse():
            return [CurvePiece("curve", 0, self.count)]
        first, last = self._arc_at_start(), self._arc_at_end()
        begin = first.end if first else 0
        if last and last.begin < begin:
            last = last._replace(begin=begin) if begin < self.count else None
        end = last.begin if last else self.count
        pieces = [first] if first else []
        k = begin
        while k < end:
            piece = self._arc_from(k, end) or self._line_from(k, end)
            if piece is None:
                is_soft = self.is_soft[k] or self.is_soft[k + 1]
                piece = CurvePiece("curve" if is_soft else "line", k, k + 1)
            pieces.append(piece)
            k = piece.end
        return self._with_curves([*pieces, *([last] if last else [])])

    def _with_curves(self, pieces: list[CurvePiece]) -> list[CurvePiece]:
        """Return the parts, with neighbouring edges of one smooth curve merged."""
        found: list[CurvePiece] = []
        for k, stated in enumerate(pieces):
            piece = stated
            if piece.kind == "near arc":
                joints = ((k - 1, piece.begin), (k + 1, piece.end))
                goes_on = any(
                    self.is_soft[place] and pieces[neighbour].kind != "line"
                    for neighbour, place in joints
                    if 0 <= neighbour < len(pieces)
                )
                piece = piece._replace(kind="curve" if goes_on else "arc")
            is_smooth = piece.kind == "curve" and self.is_soft[piece.begin]
            if found and is_smooth and found[-1].kind == "curve":
                found[-1] = found[-1]._replace(end=piece.end)
            else:
                found.append(piece)
        return [single for piece in found for single in _as_drawn_if_short(piece)]

    def _is_ellipse(self) -> bool:
        """Return whether the run is half an ellipse from the axis to the axis, but no half
        circle.
        """
        ends = self.points[[0, -1]]
        if ends.real.any() or self.count < 2 * FEWEST_ON_CURVE or not self.is_soft[1:-1].all():
            return False
        ellipse = ellipse_on_axis(self.points)
        if ellipse is None or ellipse[3] > self.within:
            return False
        circle = circle_on_axis(self.points)
        return circle is None or not self._are_on(self.points, circle, self.within)

    def _arc_at_start(self) -> CurvePiece | None:
        """Return the arc, centred on the axis, at the start of the run, or None."""
        return self._arc_at_axis(self.points, self.is_sharp)

    def _arc_at_end(self) -> CurvePiece | None:
        """Return the arc, centred on the axis, at the end of the run, or None."""
        piece = self._arc_at_axis(self.points[::-1], self.is_sharp[::-1])
        return piece and piece._replace(begin=self.count - piece.end, end=self.count)

    def _arc_at_axis(self, points: Array, is_sharp: np.ndarray) -> CurvePiece | None:
        # On the axis the line continues as its mirror image.
        if points[0].real or 2.0 * abs(_slope(points[1] - points[0])) > COARSEST:
            return None

        def circle(end: int, within: float) -> Circle | None:
            found = circle_on_axis(points[: end + 1])
            return found if found and self._are_on(points[: end + 1], found, within) else None

        limit = _first(is_sharp, 1, len(points) - 1)
        is_soft = self.is_soft if points is self.points else self.is_soft[::-1]
        return self._longest_arc(circle, 0, FEWEST_ON_ARC // 2, limit, points, is_soft, 0.5)

    def _arc_from(self, begin: int, end: int) -> CurvePiece | None:
        """Return the longest arc from a point, or None."""

        def circle(last: int, within: float) -> Circle | None:
            points = self.points[begin : last + 1]
            found = circle_through(points)
            if found is None or not self._are_on(points, found, within):
                return None
            center, radius = found
            if abs(center.real) <= 20.0 * within:
                on_axis = complex(0.0, center.imag)
                mean = float(np.abs(points - on_axis).mean())
                if self._are_on(points, (on_axis, mean), within):
                    return on_axis, mean
            return center, radius

        limit = min(_first(self.is_sharp, begin + 1, self.count), end)
        fewest = begin + FEWEST_ON_ARC
        return self._longest_arc(circle, begin, fewest, limit, self.points, self.is_soft, 1.0)

    def _longest_arc(
        self,
        circle: Callable[[int, float], Circle | None],
        begin: int,
        fewest: int,
        limit: int,
        points: Array,
        is_soft: np.ndarray,
        share: float,
    ) -> CurvePiece | None:
        """Return the longest arc up to the point `limit`; None if it may be part of another curve.

        The points are a `share` of the arc: half of it, if it continues beyond the axis.
        """
        if limit < fewest:
            return None
        last = _last_true(lambda end: circle(end, self.within) is not None, fewest, limit)
        end = _last_true(lambda end: circle(end, self.close) is not None, fewest, last)
        found = circle(end, self.close)
        if found is not None and end - begin >= ABRUPT * (last - begin):
            turn = abs(_turn(points[begin : end + 1], found[0])) / share
            if turn >= NARROW or not (is_soft[begin] or is_soft[end]):
                return CurvePiece("arc", begin, end, found)
        found = circle(last, self.within)
        if found is not None and abs(_turn(points[begin : last + 1], found[0])) / share >= WIDE:
            return CurvePiece("near arc", begin, last, found)
        return None

    def _are_on(self, points: Array, circle: Circle, within: float) -> bool:
        """Return whether points follow each other along a circle to within a distance."""
        center, radius = circle
        arms = points - center
        if np.abs(np.abs(arms) - radius).max() > within:
            return False
        steps = np.angle(arms[1:] * arms[:-1].conjugate())
        forward = steps if steps.sum() > 0.0 else -steps
        return bool(forward.min() > -2.0 * within / radius and forward.max() <= COARSEST)

    def _line_from(self, begin: int, end: int) -> CurvePiece | None:
        """Return the longest straight line of several edges from a point, or None."""
        last = self._straight_to(begin, end, self.close)
        if last - begin < 2:
            return None
        length = abs(self.points[last] - self.points[begin])
        for place in (begin, last):
            # A smooth curve with the neighbouring curvature would leave the line.
            if self.is_soft[place] and self.curvature[place] * length**2 < 8.0 * self.within:
                return None
        nearly = self._straight_to(begin, end, self.within)
        is_abrupt = last - begin >= ABRUPT * (nearly - begin)
        return CurvePiece("line", begin, last) if is_abrupt else None

    def _straight_to(self, begin: int, end: int, within: float) -> int:
        """Return the last point up to which the polyline is straight to within a distance."""

        def is_straight(last: int) -> bool:
            chord = self.points[last] - self.points[begin]
            if not chord:
                return False
            arms = (self.points[begin : last + 1] - self.points[begin]) / chord
            is_close = np.abs(arms.imag).max() * abs(chord) <= within
            return bool(is_close and (np.diff(arms.real) > 0.0).all())

        return _last_true(is_straight, begin + 1, end)

    def edges(self, pieces: list[CurvePiece]) -> list[list[Edge]]:
        """Return the edges of each part."""
        joints = [complex(self.points[piece.begin]) for piece in pieces]
        joints.append(complex(self.points[-1]))
        for k, joint in enumerate(joints):
            circles = [p.circle for p in pieces[max(0, k - 1) : k + 1] if p.kind == "arc"]
            if circles:
                joints[k] = _joint(joint, circles, 10.0 * self.within)
        lines = []
        for piece, (start, end) in zip(pieces, pairwise(joints), strict=True):
            points = self.points[piece.begin : piece.end + 1].copy()
            points[0] = start
            points[-1] = end
            lines.append(points)
        tangents = [
            _tangents(piece, points, self.within)
            for piece, points in zip(pieces, lines, strict=True)
        ]
        for k, piece in enumerate(pieces):
            if piece.kind == "curve":
                before = tangents[k - 1][-1] if k else _across_axis(joints[0])
                after = tangents[k + 1][0] if k + 1 < len(pieces) else _across_axis(joints[-1])
                for place, other in ((0, before), (-1, after)):
                    tangents[k][place] = _common(complex(tangents[k][place]), complex(other))
        found = []
        for piece, points, along in zip(pieces, lines, tangents, strict=True):
            start, end = complex(points[0]), complex(points[-1])
            if piece.kind == "arc":
                found.append(arcs_around(*piece.circle, start, end, _turn(points, piece.circle[0])))
            elif piece.kind == "line":
                found.append([Edge(start, end)])
            else:
                found.append(self._tangent_arcs(points, along))
        return found

    def _tangent_arcs(self, points: Array, tangents: Array) -> list[Edge]:
        """Return arcs along a curve, each tangent to the one before, as few as the tolerance
        allows.
        """
        found: list[Edge] = []
        begin, last = 0, len(points) - 1

        def arcs(start: int, end: int) -> list[Edge] | None:
            ends = ((complex(points[k]), complex(tangents[k])) for k in (start, end))
            (one, along), (other, towards) = ends
            return biarc(one, along, other, towards)

        def are_close(start: int, end: int) -> bool:
            edges = arcs(start, end)
            return edges is not None and all(
                min(edge.distance(complex(point)) for edge in edges) <= self.within
                for point in points[start + 1 : end]
            )

        while begin < last:
            end = _last_true(partial(are_close, begin), begin + 1, last)
            straight = [Edge(complex(points[begin]), complex(points[end]))]
            edges = arcs(begin, end) or straight
            found += [_beside_axis(edge) for edge in edges]
            begin = end
        return found


def _beside_axis(edge: Edge) -> Edge:
    """Return an edge, or its chord if the arc crosses the axis."""
    if not edge.turn:
        return edge
    innermost = edge.center - abs(edge.radius)
    share = edge.share(innermost)
    is_across = innermost.real < 0.0 < share < 1.0
    return Edge(edge.start, edge.end) if is_across else edge


def _with_poles(points: Array) -> Array:
    """Return the points, with a pole on the axis if the run begins or ends with an edge across it.

    A polygon around a ball may have the middle of an edge on the axis rather than a corner.
    """
    found = points.copy()
    for line in (found, found[::-1]):
        if len(line) < 5 or line[0].real or abs(_slope(line[1] - line[0])) > 1e-6:
            continue
        chords = np.diff(line[:4])
        turns = np.abs(np.angle(chords[1:] * chords[:-1].conjugate()))
        width = 2.0 * abs(chords[0])
        is_even = 0.5 * width <= abs(chords[1]) <= 2.0 * width
        largest = turns.max()
        if is_even and 1e-3 < largest <= min(COARSEST, 2.0 * turns.min()):
            circle = circle_on_axis(line[1:3])
            if circle is not None:
                center, radius = circle
                line[0] = center + 1j * math.copysign(radius, line[0].imag - center.imag)
    return found


def _slope(chord: complex) -> float:
    """Return the angle of a chord with the horizontal, between -pi/2 and pi/2, rad."""
    return math.atan2(chord.imag, abs(chord.real)) if chord else 0.0


def _as_drawn_if_short(piece: CurvePiece) -> list[CurvePiece]:
    """Return a curve of few edges as these edges; other parts unchanged."""
    if piece.kind != "curve" or piece.end - piece.begin >= FEWEST_ON_CURVE:
        return [piece]
    return [CurvePiece("line", k, k + 1) for k in range(piece.begin, piece.end)]


def _joint(point: complex, circles: list[Circle], within: float) -> complex:
    """Return the place near a point where two arcs meet, or the nearest place on one arc."""
    if len(circles) == 2:
        meeting = circles_meet(circles[0], circles[1], point)
        if meeting is not None and abs(meeting - point) <= within:
            return meeting
    # Of two arcs that are tangent, the one around the axis goes first.
    center, radius = min(circles, key=lambda circle: abs(circle[0].real))
    arm = point - center
    if not point.real:
        half = math.sqrt(max(0.0, radius**2 - center.real**2))
        return complex(0.0, center.imag + math.copysign(half, arm.imag))
    return center + arm / abs(arm) * radius


def _tangents(piece: CurvePiece, points: Array, within: float) -> Array:
    """Return the unit tangents of a part: at all its points for a curve, otherwise at its ends."""
    if piece.kind == "curve":
        return tangents_along(points, within)
    chord = points[-1] - points[0]
    if piece.kind == "line":
        return np.full(2, chord / abs(chord))
    arms = (points - piece.circle[0])[[0, -1]]
    turn = 1j if _turn(points, piece.circle[0]) > 0.0 else -1j
    return np.asarray(turn * arms / np.abs(arms))


def _turn(points: Array, center: complex) -> float:
    """Return the angle by which the direction of points from a centre turns, rad."""
    arms = points - center
    return float(np.angle(arms[1:] * arms[:-1].conjugate()).sum())


def _across_axis(point: complex) -> complex:
    """Return the direction of a smooth line at a point of the axis; 0 at another point."""
    return 0j if point.real else 1.0 + 0j


def _common(tangent: complex, neighbour: complex) -> complex:
    """Return the unit tangent where two parts meet; the neighbour's, if the line is smooth
    there.
    """
    if not neighbour.real and not neighbour.imag:
        return tangent
    along = neighbour if (neighbour * tangent.conjugate()).real > 0.0 else -neighbour
    return along if abs(cmath.phase(along / tangent)) <= SMOOTH else tangent


def _first(holds: np.ndarray, begin: int, otherwise: int) -> int:
    """Return the first index from `begin` on at which an array is true."""
    numbers = np.flatnonzero(holds[begin:])
    return begin + int(numbers[0]) if len(numbers) else otherwise


def _last_true(holds: Callable[[int], bool], low: int, high: int) -> int:
    """Return the last number between two up to which a condition holds, or the first number.

    The condition may fail at some numbers between, as with few and scattered points.
    """
    tried, step = [low], 1
    while tried[-1] < high:
        tried.append(min(low + step, high))
        step *= 2
    last = max((number for number in tried[1:] if holds(number)), default=low)
    beyond = next((number for number in tried if number > last), high + 1)
    while beyond - last > 1:
        middle = (last + beyond) // 2
        if holds(middle):
            last = middle
        else:
            beyond = middle
    return last
