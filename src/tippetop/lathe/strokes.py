"""Strokes of drawings: lines, arcs of circles and other smooth curves in the plane, y up.

A point is a complex number. Strokes are joined to paths, cut at an axis, and converted to points of
a profile.
"""

# translate module: numpy

import math
from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

SAMPLE_TURN = math.radians(2.0)
"""Turn of a curve between two of its sampled points, rad: half of that below which an arc is
recognised.
"""

FEWEST_SAMPLES, MOST_SAMPLES = 6, 180
"""Smallest and largest number of parts in which a curve is sampled."""

PROBES = 64
"""Number of parts of a stroke that are searched for crossings of an axis."""

ROUND = 1e-9
"""Relative difference of conjugate semi-axes within which an ellipse is a circle."""


class Stroke(NamedTuple):
    """Smooth curve from one point to another."""

    at: Callable[[float], complex]
    """Point at a parameter; of an arc of a circle, the parameter is the angle."""
    begin: float
    end: float
    """Parameters of its start and end."""
    radius: float = 0.0
    """Radius of an arc of a circle, infinite of a straight line, 0 of another curve."""

    @property
    def first(self) -> complex:
        """Start point."""
        return self.at(self.begin)

    @property
    def last(self) -> complex:
        """End point."""
        return self.at(self.end)

    @property
    def reverse(self) -> "Stroke":
        """The stroke from its end to its start."""
        return self._replace(begin=self.end, end=self.begin)

    def part(self, low: float, high: float) -> "Stroke":
        """Return the part between two shares of the stroke."""
        span = self.end - self.begin
        return self._replace(begin=self.begin + low * span, end=self.begin + high * span)

    def sample(self, count: int) -> list[complex]:
        """Return points at equal steps of the parameter with both ends; only the ends of a line."""
        steps = 1 if self.radius == math.inf else count
        span = self.end - self.begin
        return [self.at(self.begin + span * k / steps) for k in range(steps + 1)]

    def moved(self, place: Callable[[complex], complex], scale: float = 1.0) -> "Stroke":
        """Return the stroke under a similarity that scales lengths by a factor."""
        at = self.at
        return Stroke(lambda t: place(at(t)), self.begin, self.end, scale * self.radius)


Path = list[Stroke]
"""Strokes each of which begins where the one before ends."""


def line(start: complex, end: complex) -> Stroke:
    """Return a straight stroke."""
    return Stroke(lambda t: start + t * (end - start), 0.0, 1.0, math.inf)


def bezier(points: Sequence[complex]) -> Stroke:
    """Return the Bezier curve of control points; a straight stroke if all are on its chord."""
    start, end = points[0], points[-1]
    chord = end - start
    size = max(abs(point - start) for point in points)
    if chord and all(
        abs(((point - start) * chord.conjugate()).imag) <= ROUND * size * abs(chord)
        and 0.0 <= ((point - start) / chord).real <= 1.0
        for point in points
    ):
        return line(start, end)

    def at(t: float) -> complex:
        level = list(points)
        while len(level) > 1:
            level = [first + t * (second - first) for first, second in pairwise(level)]
        return level[0]

    return Stroke(at, 0.0, 1.0)


def ellipse(center: complex, first: complex, second: complex, begin: float, end: float) -> Stroke:
    """Return an arc of the ellipse with these conjugate semi-axes, between two eccentric angles."""
    size = max(abs(first), abs(second))
    skew = abs((first * second.conjugate()).real)
    is_circle = abs(abs(first) - abs(second)) <= ROUND * size and skew <= ROUND * size**2
    return Stroke(
        lambda t: center + first * math.cos(t) + second * math.sin(t),
        begin,
        end,
        size if is_circle else 0.0,
    )


def joined(paths: Sequence[Path], gap: float) -> list[Path]:
    """Return the paths, joined where their ends are closer than a gap."""
    closed = [path for path in paths if is_closed(path, gap)]
    waiting = [path for path in paths if not is_closed(path, gap)]
    while waiting:
        path = waiting.pop(0)
        while not is_closed(path, gap):
            following = [
                (abs(candidate[0].first - path[-1].last), number, candidate)
                for number, separate in enumerate(waiting)
                for candidate in (separate, reverse(separate))
            ]
            leading = [
                (abs(candidate[-1].last - path[0].first), number, candidate)
                for number, separate in enumerate(waiting)
                for candidate in (separate, reverse(separate))
            ]
            after = min(following, default=(math.inf, 0, path), key=lambda one: one[0])
            before = min(leading, default=(math.inf, 0, path), key=lambda one: one[0])
            if min(after[0], before[0]) > gap:
                break
            path = path + after[2] if after[0] <= before[0] else before[2] + path
            waiting.pop(after[1] if after[0] <= before[0] else before[1])
        closed.append(path)
    return closed


def is_closed(path: Path, gap: float) -> bool:
    """Return whether a path ends where it begins, to within a gap."""
    is_line = len(path) == 1 and path[0].radius == math.inf
    return not is_line and abs(path[-1].last - path[0].first) <= gap


def reverse(path: Path) -> Path:
    """Return the path from its end to its begin."""
    return [stroke.reverse for stroke in path[::-1]]


def right_parts(path: Path, within: float) -> list[Path]:
    """Return the parts of a path to the right of the imaginary axis, without strokes along it.

    A closed part is one path; other parts begin and end on the axis, or where the path does.
    """
    cut = [part for stroke in path for part in _cut(stroke, within)]
    sides = [_side(stroke, within) for stroke in cut]
    if all(side > 0 for side in sides):
        return [cut]
    if is_closed(path, within):
        turn = next(k for k, side in enumerate(sides) if side <= 0)
        cut, sides = cut[turn:] + cut[:turn], sides[turn:] + sides[:turn]
    parts: list[Path] = [[]]
    for stroke, side in zip(cut, sides, strict=True):
        if side > 0:
            parts[-1].append(stroke)
        elif parts[-1]:
            parts.append([])
    return [part for part in parts if part]


def _side(stroke: Stroke, within: float) -> int:
    """Return 1 for a stroke to the right of the axis, -1 to the left, 0 along it."""
    across = [point.real for point in stroke.sample(8)]
    if max(map(abs, across)) <= within:
        return 0
    return 1 if max(across) > -min(across) else -1


def _cut(stroke: Stroke, within: float) -> list[Stroke]:
    """Return a stroke cut where it crosses the axis."""
    across = [
        stroke.at(stroke.begin + (stroke.end - stroke.begin) * k / PROBES).real
        for k in range(PROBES + 1)
    ]
    shares = [0.0]
    for k in range(PROBES):
        if across[k] * across[k + 1] < 0.0:
            low, high = k / PROBES, (k + 1) / PROBES
            for _ in range(60):
                middle = 0.5 * (low + high)
                is_before = stroke.part(0.0, middle).last.real * across[k] > 0.0
                low, high = (middle, high) if is_before else (low, middle)
            shares.append(low)
        elif across[k + 1] == 0.0 and k + 1 < PROBES:
            shares.append((k + 1) / PROBES)
    shares.append(1.0)
    parts = [stroke.part(low, high) for low, high in pairwise(shares)]
    long = [part for part in parts if _extent(part) > within]
    return long or parts[:1]


def _extent(stroke: Stroke) -> float:
    start = stroke.first
    return max(abs(point - start) for point in stroke.sample(4))


def points_of(path: Path) -> list[tuple[float, ...]]:
    """Return the points of a path as those of a profile; curves that are no circles are sampled."""
    start = path[0].first
    points: list[tuple[float, ...]] = [(start.real, start.imag)]
    for stroke in path:
        if stroke.radius == math.inf:
            parts = [(stroke.last, 0.0)]
        elif stroke.radius:
            halves = math.ceil(abs(stroke.end - stroke.begin) / (0.9 * math.pi))
            ends = stroke.sample(2 * halves)
            middle = ends[1::2]
            parts = [
                (end, math.copysign(stroke.radius, ((via - begin).conjugate() * (end - via)).imag))
                for begin, via, end in zip(ends[:-2:2], middle, ends[2::2], strict=True)
            ]
        else:
            parts = [(point, 0.0) for point in stroke.sample(_samples(stroke))[1:]]
        points += [
            (point.real, point.imag, radius) if radius else (point.real, point.imag)
            for point, radius in parts
        ]
    return points


def _samples(stroke: Stroke) -> int:
    """Return the number of parts in which a curve is sampled."""
    chords = np.diff(np.array(stroke.sample(PROBES)))
    chords = chords[np.abs(chords) > 0.0]
    turning = float(np.abs(np.angle(chords[1:] / chords[:-1])).sum())
    return min(MOST_SAMPLES, max(FEWEST_SAMPLES, math.ceil(turning / SAMPLE_TURN)))
