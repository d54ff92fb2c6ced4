"""Union of overlapping profiles: parts of a body that were drawn or modelled one by one."""

# translate module: numpy

from collections.abc import Sequence

from tippetop.lathe.edges import Edge, meetings
from tippetop.lathe.profile import Profile

COINCIDENT = 1e-6
"""Distance within which edges of two parts lie on each other, in sizes of the parts: single
precision, in which meshes are written, rounds by a tenth of it.
"""

Point = tuple[float, ...]


def overlap(first: Profile, second: Profile) -> bool:
    """Return whether two profiles cross, or lie beside each other with a common border."""
    sides, opposite = first.sides(second), second.sides(first)
    crosses = "out" in sides and "out" in opposite and ("in" in sides or "in" in opposite)
    return crosses or ("out" in sides and "out" in opposite and _has_common_border(first, second))


def united(first: Profile, second: Profile) -> list[list[Point]]:
    """Return the lines around the union of two overlapping profiles, the outermost first."""
    within = COINCIDENT * max(first.size, second.size)
    remaining = [
        *_outside(first, second, within, keeps_common=True),
        *_outside(second, first, within, keeps_common=False),
    ]
    lines = sorted(_joined(remaining, 20.0 * within), key=lambda line: -abs(_area(line)))
    return [_points(line) for line in lines]


def _has_common_border(first: Profile, second: Profile) -> bool:
    """Return whether parts of two profiles' edges lie on each other."""
    within = COINCIDENT * max(first.size, second.size)
    return any(
        _side(part, second, within)[0] == "on"
        for edge in first.edges
        for part in _cut(edge, second, within)
    )


def _outside(profile: Profile, beside: Profile, within: float, keeps_common: bool) -> list[Edge]:
    """Return the parts of edges outside another profile; of common ones those in one direction."""
    remaining = []
    for edge in profile.edges:
        for part in _cut(edge, beside, within):
            side, is_along = _side(part, beside, within)
            if side == "out" or (side == "on" and keeps_common and is_along):
                remaining.append(part)
    return remaining


def _side(part: Edge, profile: Profile, within: float) -> tuple[str, bool]:
    """Return where the middle of an edge lies, and whether a border there has its direction."""
    middle = part.point(0.5)
    border = min(profile.edges, key=lambda edge: edge.distance(middle))
    if border.distance(middle) <= 4.0 * within:
        along = border.direction(min(1.0, max(0.0, border.share(middle))))
        return "on", (along * part.direction(0.5).conjugate()).real > 0.0
    return ("in" if profile.surrounds(middle) else "out"), False


def _cut(edge: Edge, beside: Profile, within: float) -> list[Edge]:
    """Return an edge cut where it meets those of another profile."""
    met = [point for border in beside.edges for point in meetings(edge, border, within)]
    shares = sorted([min(1.0, max(0.0, edge.share(point))) for point in met])
    shortest = 10.0 * within / max(abs(edge.chord), within)
    apart = [0.0]
    for share in shares:
        if apart[-1] + shortest < share < 1.0 - shortest:
            apart.append(share)
    apart.append(1.0)
    ends = [edge.start, *[edge.point(share) for share in apart[1:-1]], edge.end]
    return [
        Edge(ends[k], ends[k + 1], (apart[k + 1] - apart[k]) * edge.turn)
        for k in range(len(apart) - 1)
    ]


def _joined(edges: Sequence[Edge], gap: float) -> list[list[Edge]]:
    """Return edges joined to lines where one begins at the end of another."""
    waiting = list(edges)
    lines = []
    while waiting:
        # An open line begins where no other edge ends.
        ends = [edge.end for edge in waiting]
        begins = [
            number
            for number, edge in enumerate(waiting)
            if all(abs(edge.start - end) > gap for end in ends)
        ]
        line = [waiting.pop(begins[0] if begins else 0)]
        while waiting:
            last = line[-1].end
            distances = [abs(edge.start - last) for edge in waiting]
            nearest = min(distances)
            if nearest > gap:
                break
            following = waiting.pop(distances.index(nearest))
            line.append(following._replace(start=last))
        lines.append(line)
    return lines


def _area(line: Sequence[Edge]) -> float:
    return sum(float(points.real @ weights) for points, weights in (edge.nodes() for edge in line))


def _points(line: Sequence[Edge]) -> list[Point]:
    """Return the points of a line as those of a profile."""
    first, last = line[0].start, line[-1].end
    points: list[Point] = [(first.real, first.imag)]
    for edge in line:
        radius = (edge.radius,) if edge.turn else ()
        points.append((edge.end.real, edge.end.imag, *radius))
    if abs(first - last) <= 20.0 * COINCIDENT * max(abs(first), abs(last)):
        points[-1] = (*points[0], *points[-1][2:])
    return points
