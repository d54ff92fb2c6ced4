"""Fitting of arcs and lines to the stated points of a profile, with their rounding removed.

Runs of straight edges become lines and arcs of circles if the points are on them, tangent arcs
along other smooth curves, and otherwise stay as drawn.
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

SHARP_TURN = math.radians(29.0)
"""Largest angle between edges that stand for an arc, rad: a polygon of 12 edges or fewer stays
one.
"""

SMOOTH = math.radians(12.0)
"""Largest angle between edges that stand for a smooth curve other than an arc, rad."""

UNEVEN = 4.0
"""Largest ratio of the lengths of neighbouring edges on one smooth curve."""

FEWEST_ON_ARC = 4
"""Smallest number of edges on an arc: four points of any symmetric chamfer lie on a circle."""

FEWEST_CURVE_EDGES = 6
"""Smallest number of edges on a smooth curve."""

WIDE = math.radians(60.0)
"""Turn, rad, from which points within the tolerance of a circle are an arc: other smooth curves
leave their circle of curvature before.
"""

NARROW = math.radians(20.0)
"""Turn, rad, from which points within `CLOSE` of a circle are an arc in a smooth line."""

CLOSE = 0.1
"""Share of the tolerance within which points of a short arc lie on its circle, if their digits
allow.
"""

ABRUPT = 0.75
"""Share of the edges within the tolerance of a circle that must be as close as `CLOSE` for an arc:
a smooth curve leaves its circle of curvature with the third power of the length, and has less than
half.
"""

COARSEST_ROUNDING = 1e-3
"""Largest rounding of points on smooth curves, in sizes of the profile."""

SOME = 16
"""Number of points of a long line that are tried before all of them: with half of them a smooth
curve is taken for an arc more often, which all points then show.
"""

FLAT = 1e-9
"""Sagitta below which an edge is straight, in sizes of the profile."""

Points = tuple[tuple[float, ...], ...]
Circle = tuple[complex, float]


class Fit(NamedTuple):
    """Profile fitted to points."""

    points: Points
    """Points of the fitted profile."""
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
    >>> result = fit(ball)
    >>> result.stated, result.edges, result.deviation < 1e-12
    (60, 2, True)
    """
    stated = tuple(tuple(float(number) for number in point) for point in points)
    count = len(stated) - 1
    size = _size(stated) if count > 0 and all(len(point) in (2, 3) for point in stated) else 0.0
    if not (0.0 < size <= LARGEST and tolerance > 0.0):
        return Fit(stated, count, count, 0.0)
    written = unrounded(stated)
    is_closed = written[0][:2] == written[-1][:2]
    if is_closed and not any(any(point[2:]) for point in written):
        written = _from_a_corner(written)
    fitted, deviation, k = [written[0]], 0.0, 1
    while k < len(written):
        end = k
        while end < len(written) and not any(written[end][2:]):
            end += 1
        if end == k:
            fitted.append(written[k])
            k += 1
            continue
        run = np.array([complex(*point[:2]) for point in written[k - 1 : end]])
        rounding = min(usual_rounding(stated), COARSEST_ROUNDING * size)
        edges, apart = _fit_run(run, max(tolerance * size, 1.5 * rounding), rounding)
        start = edges[0].start
        fitted[-1] = (start.real, start.imag, *fitted[-1][2:])
        fitted += [_point(edge, FLAT * size) for edge in edges]
        deviation, k = max(deviation, apart), end
    if is_closed:
        fitted[-1] = (*fitted[0][:2], *fitted[-1][2:])
    return Fit(tuple(fitted), count, len(fitted) - 1, deviation)


def _from_a_corner(loop: Points) -> Points:
    """Return the points of a closed line from its sharpest corner on, if it begins on a smooth
    part.
    """
    places = np.array([complex(*point[:2]) for point in loop])
    chords = np.diff(places)
    following = np.concatenate([chords[1:], chords[:1]])
    turns = np.abs(np.angle(following * chords.conjugate())).tolist()
    if turns[-1] > SHARP_TURN:
        return loop
    corner = (turns.index(max(turns)) + 1) % len(chords)
    return (*loop[corner : len(chords)], *loop[: corner + 1])


def _size(points: Points) -> float:
    heights = [point[1] for point in points]
    return max(*(abs(point[0]) for point in points), max(heights) - min(heights))


def _point(edge: Edge, flat: float) -> tuple[float, ...]:
    """Return the point of a profile that describes an edge."""
    end = (edge.end.real, edge.end.imag)
    return end if edge.sagitta <= flat else (*end, edge.radius)


def _fit_run(points: Array, within: float, rounding: float) -> tuple[list[Edge], float]:
    """Return the edges fitted to a run of straight edges, and the largest distance of a point."""
    polyline = Polyline(points, within, rounding)
    parts = polyline.parts(polyline.sections())
    deviation = 0.0
    for part in parts:
        # Points are compared with the edges of their own part: another may be nearer by chance.
        for point in points[part.begin + 1 : part.end]:
            apart = min(edge.distance(complex(point)) for edge in part.edges)
            deviation = max(deviation, apart)
    return [edge for part in parts for edge in part.edges], deviation


class Section(NamedTuple):
    """Section of a polyline, with the curve that it approximates."""

    kind: str
    """"line", "arc", "curve" or "near arc": an arc unless the line continues smoothly beyond it."""
    begin: int
    end: int
    """Indices of its first and last points."""
    circle: Circle = (0j, 0.0)
    """Centre and radius of an arc."""


class FittedPart(NamedTuple):
    """Part of a polyline with the edges that replace it."""

    begin: int
    end: int
    """Indices of its first and last points."""
    edges: list[Edge]
    """The edges: an arc or two tangent ones along a curve, of other sections all."""


class Polyline:
    """Run of straight edges that may approximate arcs and curves."""

    def __init__(self, points: Array, within: float, rounding: float) -> None:
        self.points = _with_poles(points)
        self.within, self.rounding = within, rounding
        self.close = max(CLOSE * within, min(1.2 * rounding, 4.0 * CLOSE * within))
        self.count = len(points) - 1
        chords = np.diff(self.points)
        lengths = np.abs(chords)
        turns = np.angle(chords[1:] * chords[:-1].conjugate())
        ratios = lengths[1:] / lengths[:-1]
        is_even = (ratios <= UNEVEN) & (ratios >= 1.0 / UNEVEN)
        self.is_soft = np.full(len(points), False)
        self.is_soft[1:-1] = (np.abs(turns) <= SMOOTH) & is_even
        # By how much the line has turned before each point, whichever way.
        self.turned = [0.0, 0.0]
        for turn in np.abs(turns).tolist():
            self.turned.append(self.turned[-1] + turn)
        self.curvature = np.zeros(len(points))
        self.curvature[1:-1] = np.abs(turns) / np.minimum(lengths[1:], lengths[:-1])
        # The directions of short edges scatter with the errors of their ends.
        is_long = np.minimum(lengths[1:], lengths[:-1]) > 10.0 * within
        self.is_sharp = np.full(len(points), False)
        self.is_sharp[1:-1] = (np.abs(turns) > SHARP_TURN) & is_long

    def sections(self) -> list[Section]:
        """Return the sections in their order."""
        if self._is_ellipse():
            return [Section("curve", 0, self.count)]
        first, last = self._arc_at_start(), self._arc_at_end()
        begin = first.end if first else 0
        if last and last.begin < begin:
            last = last._replace(begin=begin) if begin < self.count else None
        end = last.begin if last else self.count
        sections = [first] if first else []
        k = begin
        while k < end:
            section = self._arc_from(k, end) or self._line_from(k, end)
            if section is None:
                is_soft = self.is_soft[k] or self.is_soft[k + 1]
                section = Section("curve" if is_soft else "line", k, k + 1)
            sections.append(section)
            k = section.end
        return self._with_curves([*sections, *([last] if last else [])])

    def _with_curves(self, sections: list[Section]) -> list[Section]:
        """Return the sections, with neighbouring edges of one smooth curve merged."""
        merged: list[Section] = []
        for k, stated in enumerate(sections):
            section = stated
            if section.kind == "near arc":
                joints = ((k - 1, section.begin), (k + 1, section.end))
                goes_on = any(
                    self.is_soft[place] and sections[neighbour].kind != "line"
                    for neighbour, place in joints
                    if 0 <= neighbour < len(sections)
                )
                section = section._replace(kind="curve" if goes_on else "arc")
            is_smooth = section.kind == "curve" and self.is_soft[section.begin]
            if merged and is_smooth and merged[-1].kind == "curve":
                merged[-1] = merged[-1]._replace(end=section.end)
            else:
                merged.append(section)
        return [single for section in merged for single in _as_drawn_if_short(section)]

    def _is_ellipse(self) -> bool:
        """Return whether the run is half an ellipse from the axis to the axis, but no half
        circle.
        """
        ends = self.points[[0, -1]]
        if ends.real.any() or self.count < 2 * FEWEST_CURVE_EDGES or not self.is_soft[1:-1].all():
            return False
        ellipse = ellipse_on_axis(self.points)
        if ellipse is None or ellipse[3] > self.within:
            return False
        circle = circle_on_axis(self.points)
        return circle is None or not self._are_on(self.points, circle, self.within)

    def _arc_at_start(self) -> Section | None:
        """Return the arc, centred on the axis, at the start of the run, or None."""
        return self._arc_at_axis(self.points, self.is_sharp)

    def _arc_at_end(self) -> Section | None:
        """Return the arc, centred on the axis, at the end of the run, or None."""
        section = self._arc_at_axis(self.points[::-1], self.is_sharp[::-1])
        return section and section._replace(begin=self.count - section.end, end=self.count)

    def _arc_at_axis(self, points: Array, is_sharp: np.ndarray) -> Section | None:
        # On the axis the line continues as its mirror image.
        if points[0].real or 2.0 * abs(_slope(points[1] - points[0])) > SHARP_TURN:
            return None

        def circle(end: int, within: float, some: bool) -> Circle | None:
            along = _some(points[: end + 1], some)
            candidate = circle_on_axis(along)
            return candidate if candidate and self._are_on(along, candidate, within) else None

        limit = _first(is_sharp, 1, len(points) - 1)
        is_soft = self.is_soft if points is self.points else self.is_soft[::-1]
        return self._longest_arc(circle, 0, FEWEST_ON_ARC // 2, limit, points, is_soft, 0.5)

    def _arc_from(self, begin: int, end: int) -> Section | None:
        """Return the longest arc from a point, or None."""

        def circle(last: int, within: float, some: bool) -> Circle | None:
            points = _some(self.points[begin : last + 1], some)
            candidate = circle_through(points)
            if candidate is None or not self._are_on(points, candidate, within):
                return None
            center, radius = candidate
            if abs(center.real) <= 20.0 * within:
                on_axis = complex(0.0, center.imag)
                mean = float(np.abs(points - on_axis).mean())
                if self._are_on(points, (on_axis, mean), within):
                    return on_axis, mean
            return center, radius

        limit = min(_first(self.is_sharp, begin + 1, self.count), end)
        fewest = begin + FEWEST_ON_ARC
        if self.is_soft[begin] and not self._may_begin_arc(circle, begin, fewest, limit):
            return None
        return self._longest_arc(circle, begin, fewest, limit, self.points, self.is_soft, 1.0)

    def _may_begin_arc(
        self,
        circle: Callable[[int, float, bool], Circle | None],
        begin: int,
        fewest: int,
        limit: int,
    ) -> bool:
        """Return whether an arc may begin at a point in a smooth line.

        Such an arc turns at least by `NARROW` or, if its points are not `CLOSE`, by `WIDE`. Its
        first points are then on a circle too, which fits them about as well.
        """
        for angle, within in ((NARROW, self.close), (WIDE, self.within)):
            end = max(self._turned_by(begin, angle), fewest)
            if end <= limit and circle(end, 2.0 * within, True) is not None:
                return True
        return False

    def _turned_by(self, begin: int, angle: float) -> int:
        """Return the last point before the line turns by an angle, rad, from a point on.

        If it does not turn by as much, the result is beyond the line.
        """
        low, high = begin, self.count + 1
        while high - low > 1:
            middle = (low + high) // 2
            if self.turned[middle] - self.turned[begin] < angle:
                low = middle
            else:
                high = middle
        return low if high <= self.count else high

    def _longest_arc(
        self,
        circle: Callable[[int, float, bool], Circle | None],
        begin: int,
        fewest: int,
        limit: int,
        points: Array,
        is_soft: np.ndarray,
        share: float,
    ) -> Section | None:
        """Return the longest arc up to the point `limit`; None if it may be part of another curve.

        The points are a `share` of the arc: half of it, if it continues beyond the axis.
        """
        if limit < fewest:
            return None
        last = _last_on(partial(_has_circle, circle, self.within), fewest, limit)
        end = _last_on(partial(_has_circle, circle, self.close), fewest, last)
        best = circle(end, self.close, False)
        if best is not None and end - begin >= ABRUPT * (last - begin):
            turn = abs(_turn(points[begin : end + 1], best[0])) / share
            if turn >= NARROW or not (is_soft[begin] or is_soft[end]):
                return Section("arc", begin, end, best)
        best = circle(last, self.within, False)
        if best is not None and abs(_turn(points[begin : last + 1], best[0])) / share >= WIDE:
            return Section("near arc", begin, last, best)
        return None

    def _are_on(self, points: Array, circle: Circle, within: float) -> bool:
        """Return whether points follow each other along a circle to within a distance."""
        center, radius = circle
        arms = points - center
        if np.abs(np.abs(arms) - radius).max() > within:
            return False
        steps = np.angle(arms[1:] * arms[:-1].conjugate())
        forward = steps if steps.sum() > 0.0 else -steps
        return bool(forward.min() > -2.0 * within / radius and forward.max() <= SHARP_TURN)

    def _line_from(self, begin: int, end: int) -> Section | None:
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
        return Section("line", begin, last) if is_abrupt else None

    def _straight_to(self, begin: int, end: int, within: float) -> int:
        """Return the last point up to which the polyline is straight to within a distance."""

        def is_straight(last: int, some: bool) -> bool:
            chord = self.points[last] - self.points[begin]
            if not chord:
                return False
            along = _some(self.points[begin : last + 1], some)
            arms = (along - self.points[begin]) / chord
            is_close = np.abs(arms.imag).max() * abs(chord) <= within
            return bool(is_close and (np.diff(arms.real) > 0.0).all())

        return _last_on(is_straight, begin + 1, end)

    def parts(self, sections: list[Section]) -> list[FittedPart]:
        """Return the parts of the sections, with their edges."""
        sections = list(sections)
        joints = [complex(self.points[section.begin]) for section in sections]
        joints.append(complex(self.points[-1]))
        on_faces = self._make_faces_tangent(sections, joints)
        for k, joint in enumerate(joints):
            circles = [p.circle for p in sections[max(0, k - 1) : k + 1] if p.kind == "arc"]
            if circles and k not in on_faces:
                joints[k] = _joint(joint, circles, 10.0 * self.within)
        lines = []
        for section, (start, end) in zip(sections, pairwise(joints), strict=True):
            points = self.points[section.begin : section.end + 1].copy()
            points[0] = start
            points[-1] = end
            lines.append(points)
        tangents = [
            _tangents(section, points, self.within)
            for section, points in zip(sections, lines, strict=True)
        ]
        for k, section in enumerate(sections):
            if section.kind == "curve":
                before = tangents[k - 1][-1] if k else _across_axis(joints[0])
                after = tangents[k + 1][0] if k + 1 < len(sections) else _across_axis(joints[-1])
                for place, direction in ((0, before), (-1, after)):
                    tangents[k][place] = _common(complex(tangents[k][place]), complex(direction))
        parts = list[FittedPart]()
        for section, points, along in zip(sections, lines, tangents, strict=True):
            start, end = complex(points[0]), complex(points[-1])
            if section.kind == "curve":
                parts += self._tangent_arcs(points, along, section.begin)
                continue
            edges = [Edge(start, end)]
            if section.kind == "arc":
                turn = _turn(points, section.circle[0])
                edges = arcs_around(*section.circle, start, end, turn)
            parts.append(FittedPart(section.begin, section.end, edges))
        return parts

    def _make_faces_tangent(self, sections: list[Section], joints: list[complex]) -> set[int]:
        """Make faces level and arcs that round their rims tangent to them; return the joints
        there.

        A face is a line whose ends are equally high to the digits of the points. If the arc beside
        it were fitted alone, the body would stand on the middle of its face by a fraction of the
        last digit.
        """
        on_faces = set[int]()
        for k, section in enumerate(sections):
            level = joints[k].imag
            if section.kind != "line" or abs(joints[k + 1].imag - level) > self.rounding:
                continue
            joints[k + 1] = complex(joints[k + 1].real, level)
            for beside, place in ((k - 1, k), (k + 1, k + 1)):
                if not (0 <= beside < len(sections) and sections[beside].kind == "arc"):
                    continue
                center, radius = sections[beside].circle
                tangent = complex(center.real, level + math.copysign(radius, center.imag - level))
                touch = complex(center.real, level)
                if (
                    center.real > 0.0
                    and abs(tangent - center) <= 2.0 * self.within
                    and abs(touch - joints[place]) ** 2 <= 8.0 * self.within * radius
                ):
                    sections[beside] = sections[beside]._replace(circle=(tangent, radius))
                    joints[place] = touch
                    on_faces.add(place)
        return on_faces

    def _tangent_arcs(self, points: Array, tangents: Array, first_point: int) -> list[FittedPart]:
        """Return the fewest arcs along a curve within the tolerance, each tangent to the next.

        The first of the points is the `first_point` of the polyline.
        """
        parts = list[FittedPart]()
        begin, last = 0, len(points) - 1

        def arcs(start: int, end: int) -> list[Edge] | None:
            ends = ((complex(points[k]), complex(tangents[k])) for k in (start, end))
            (first, along), (last, towards) = ends
            return biarc(first, along, last, towards)

        def are_close(start: int, end: int) -> bool:
            edges = arcs(start, end)
            # Most that are not close are not so in the middle.
            tried = [points[(start + end) // 2], *points[start + 1 : end]]
            return edges is not None and all(
                min(edge.distance(complex(point)) for edge in edges) <= self.within
                for point in tried
            )

        while begin < last:
            end = _last_true(partial(are_close, begin), begin + 1, last)
            straight = [Edge(complex(points[begin]), complex(points[end]))]
            edges = arcs(begin, end) or straight
            beside = [_beside_axis(edge) for edge in edges]
            parts.append(FittedPart(first_point + begin, first_point + end, beside))
            begin = end
        return parts


def _some(points: Array, some: bool) -> Array:
    """Return the points; if only `some` are asked for, about `SOME` of them and the last."""
    step = (len(points) - 1) // SOME
    if not some or step < 2:
        return points
    return np.concatenate([points[:-1:step], points[-1:]])


def _has_circle(
    circle: Callable[[int, float, bool], Circle | None], within: float, last: int, some: bool
) -> bool:
    """Return whether the points up to the `last`, or `some` of them, are within a distance of a
    circle.
    """
    return circle(last, within, some) is not None


def _last_on(holds: Callable[[int, bool], bool], low: int, high: int) -> int:
    """Return a last point between `low` and `high` up to which points are on one line or circle.

    It is searched for with some of the points, so that the time is proportional to the number of
    points where most are on none, and among all where all are not on the one that is found.
    """
    last = _last_true(lambda end: holds(end, True), low, high)
    if last == low or holds(last, False):
        return last
    return _last_true(lambda end: holds(end, False), low, last)


def _beside_axis(edge: Edge) -> Edge:
    """Return an edge, or its chord if the arc crosses the axis."""
    if not edge.turn:
        return edge
    innermost = edge.center - abs(edge.radius)
    share = edge.share(innermost)
    is_across = innermost.real < 0.0 < share < 1.0
    return Edge(edge.start, edge.end) if is_across else edge


def _with_poles(points: Array) -> Array:
    """Return the points, with a point on the axis if the run begins or ends with an edge across it.

    A polygon around a ball may have the middle of an edge on the axis rather than a corner.
    """
    result = points.copy()
    for line in (result, result[::-1]):
        if len(line) < 5 or line[0].real or abs(_slope(line[1] - line[0])) > 1e-6:
            continue
        chords = np.diff(line[:4])
        turns = np.abs(np.angle(chords[1:] * chords[:-1].conjugate()))
        width = 2.0 * abs(chords[0])
        is_even = 0.5 * width <= abs(chords[1]) <= 2.0 * width
        largest = turns.max()
        if is_even and 1e-3 < largest <= min(SHARP_TURN, 2.0 * turns.min()):
            circle = circle_on_axis(line[1:3])
            if circle is not None:
                center, radius = circle
                line[0] = center + 1j * math.copysign(radius, line[0].imag - center.imag)
    return result


def _slope(chord: complex) -> float:
    """Return the angle of a chord with the horizontal, between -pi/2 and pi/2, rad."""
    return math.atan2(chord.imag, abs(chord.real)) if chord else 0.0


def _as_drawn_if_short(section: Section) -> list[Section]:
    """Return a curve of few edges as lines along these edges; other sections unchanged."""
    if section.kind != "curve" or section.end - section.begin >= FEWEST_CURVE_EDGES:
        return [section]
    return [Section("line", k, k + 1) for k in range(section.begin, section.end)]


def _joint(point: complex, circles: list[Circle], within: float) -> complex:
    """Return the place near a point where two arcs meet, or the nearest place on one arc."""
    if len(circles) == 2:
        meeting = circles_meet(circles[0], circles[1], point)
        if meeting is not None and abs(meeting - point) <= within:
            return meeting
    # If two arcs are tangent, the one centred on the axis is preferred.
    center, radius = min(circles, key=lambda circle: abs(circle[0].real))
    arm = point - center
    if not point.real:
        half = math.sqrt(max(0.0, radius**2 - center.real**2))
        return complex(0.0, center.imag + math.copysign(half, arm.imag))
    return center + arm / abs(arm) * radius


def _tangents(section: Section, points: Array, within: float) -> Array:
    """Return the unit tangents of a section: at all points of a curve, otherwise at its ends."""
    if section.kind == "curve":
        return tangents_along(points, within)
    chord = points[-1] - points[0]
    if section.kind == "line":
        return np.full(2, chord / abs(chord))
    arms = (points - section.circle[0])[[0, -1]]
    turn = 1j if _turn(points, section.circle[0]) > 0.0 else -1j
    return np.asarray(turn * arms / np.abs(arms))


def _turn(points: Array, center: complex) -> float:
    """Return the angle by which the direction of points from a centre turns, rad."""
    arms = points - center
    return float(np.angle(arms[1:] * arms[:-1].conjugate()).sum())


def _across_axis(point: complex) -> complex:
    """Return the direction of a smooth line at a point of the axis; 0 at another point."""
    return 0j if point.real else 1.0 + 0j


def _common(tangent: complex, neighbour: complex) -> complex:
    """Return the unit tangent where two sections meet: the neighbour's if the line is smooth."""
    if not neighbour.real and not neighbour.imag:
        return tangent
    along = neighbour if (neighbour * tangent.conjugate()).real > 0.0 else -neighbour
    return along if abs(cmath.phase(along / tangent)) <= SMOOTH else tangent


def _first(holds: np.ndarray, begin: int, otherwise: int) -> int:
    """Return the first index from `begin` on at which an array is true, or `otherwise`."""
    numbers = np.flatnonzero(holds[begin:])
    return begin + int(numbers[0]) if len(numbers) else otherwise


def _last_true(holds: Callable[[int], bool], low: int, high: int) -> int:
    """Return a last number between `low` and `high` at which a condition holds, or `low`.

    The search doubles its steps and then bisects: the condition may fail at some numbers in
    between, as it does for few and scattered points.
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
