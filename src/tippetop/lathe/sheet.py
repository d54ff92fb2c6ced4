"""Reading of profiles from drawings: the axis, the half of the outline to turn, the cavities."""

# translate module: numpy

import math
import re
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tippetop.lathe.fitting import fit
from tippetop.lathe.frames import Box, Framed, framed, is_page
from tippetop.lathe.profile import ROUNDING, Profile, area_of, profile_of
from tippetop.lathe.rounding import unrounded
from tippetop.lathe.strokes import Path, is_closed, joined, points_of, right_parts
from tippetop.lathe.union import overlap, united
from tippetop.support.errors import Described, InvalidInput

GAP = 1e-3
"""Distance of two ends that count as meeting, in sizes of the drawing: hand-drawn lines miss each
other by less.
"""

ALONG = 1e-4
"""Distance from the axis within which a line runs along it, in sizes of the drawing."""

ASYMMETRY = 0.01
"""Largest difference of the two sides of a drawing, in sizes of the drawing."""

LONG_SIDE = 0.5
"""Share of the extent of a drawing from which a straight side may be its axis."""

UNDECIDED = "may be"
"""Beginning of refusals that ask what a drawing means."""

WHOLE_SIDE = 0.95
"""Share of the extent of a drawing from which a straight side runs over its whole length."""

AXES = "x=NUMBER or y=NUMBER, a place on the sheet, or x or y alone"
"""Accepted axes, in messages."""

Point = tuple[float, ...]
Chords = tuple[NDArray[np.complex128], NDArray[np.complex128]]


class Sheet(NamedTuple):
    """Drawing, y up."""

    paths: list[tuple[str, Path]]
    """Paths of strokes, with their names in messages."""
    unit: str
    """Unit of the numbers."""
    is_y_down: bool = False
    """Whether y counts downwards in the drawing's own numbers."""
    page: Box | None = None
    """The page, if the drawing has one."""


class Reading(NamedTuple):
    """Profile and cavities read from a drawing or a mesh."""

    profile: list[Point]
    cavities: list[list[Point]]
    remarks: list[str]
    """Sentences on the place of the axis, and on the symmetry of the drawing."""


class _NoAxis(ValueError):
    """Error raised if there is no axis; the text describes the drawing."""


class _Frame(NamedTuple):
    """Names of places across an axis that was turned upright, for messages."""

    name: str
    sign: float
    unit: str

    def place_text(self, x: float) -> str:
        """Return a place in the drawing's own numbers, such as "x = 10 mm"."""
        return f"{self.name} = {self.sign * x + 0.0:.6g} {self.unit}"


class _Axis(NamedTuple):
    """Upright axis on the sheet."""

    place: float
    """x of the axis."""
    remark: str
    """Sentence on how it was determined."""


# translate: skip
def read_sheet(
    sheet: Sheet, axis: str | None, tolerance: float, field: str, frame: bool | None = None
) -> Reading:
    """Return the profile of a drawing, in its unit.

    The axis is upright or level: as stated, x = 10 or y = 10; or a centre line that touches no
    other line; or the straight edge of a half outline; or the middle of a full one. Outlines inside
    the outermost are cavities. Outlines that overlap are united. A rectangle around all else is a
    page or a frame, and left out; where it may be a body with cavities too, `frame` decides.

    Raises `InvalidInput` if there is no axis, if the two sides differ, or if the outlines are not
    those of one body with cavities in it.
    """
    directions, place = _stated(axis)
    return read_along(sheet, directions, place, tolerance, field, frame)


def read_along(
    sheet: Sheet,
    directions: str,
    place: float | None,
    tolerance: float,
    field: str,
    frame: bool | None = None,
) -> Reading:
    """Return the profile of a drawing around an axis in one of some directions; see
    `read_sheet`.
    """
    if not sheet.paths:
        raise InvalidInput(
            field, Described("a drawing without lines"), "one with an outline of the body"
        )
    around = None if frame is False else _framed(sheet)
    if around is None:
        return _read_outlines(sheet, directions, place, tolerance, field)
    is_background = sheet.page is not None and is_page(around.box, sheet.page)
    inner = sheet._replace(paths=around.inner)
    if not (frame or is_background) and not _is_readable(inner, directions, place, tolerance):
        return _read_outlines(sheet, directions, place, tolerance, field)
    reading = read_along(inner, directions, place, tolerance, field, frame)
    if frame is None and not is_background and _may_be_bored(sheet, around):
        raise InvalidInput(
            field,
            Described(f"{around.name}, a rectangle around all else"),
            "",
            "may be a frame of the drawing or a body with bores",
            "state frame=True or frame=False, at the command line --frame or --no-frame",
        )
    kind = "page" if is_background else "frame"
    remark = f"The rectangle around the drawing, {around.name}, is its {kind}, and left out."
    return reading._replace(remarks=[remark, *reading.remarks])


def _is_readable(sheet: Sheet, directions: str, place: float | None, tolerance: float) -> bool:
    """Return whether a drawing has a profile, or may have several."""
    try:
        read_along(sheet, directions, place, tolerance, "profile")
    except InvalidInput as error:
        return error.fault.startswith(UNDECIDED)
    return True


def _framed(sheet: Sheet) -> Framed | None:
    points, _ = _chords([path for _, path in sheet.paths])
    size = float(max(np.ptp(points.real), np.ptp(points.imag)))
    return framed(sheet.paths, GAP * size) if size > 0.0 else None


def _may_be_bored(sheet: Sheet, around: Framed) -> bool:
    """Return whether a rectangle and what it encloses may be the section of a bored cylinder.

    The section is a full one, symmetric about the middle of the rectangle; or half of one, beside
    an axis at 0.
    """
    box, within = around.box, GAP * around.box.size
    if min(abs(box.leftmost), abs(box.rightmost), abs(box.low), abs(box.high)) <= within:
        return True
    for turn, middle in ((1.0, box.leftmost + box.rightmost), (1j, -box.low - box.high)):
        paths = [_times(path, turn) for _, path in around.inner]
        if _difference(paths, 0.5 * middle) <= ASYMMETRY * box.size:
            return True
    return False


def _read_outlines(
    sheet: Sheet, directions: str, place: float | None, tolerance: float, field: str
) -> Reading:
    """Return the profile of a drawing without a frame."""
    reasons = []
    for name in _likely_directions(sheet, directions, place, field):
        # A level axis is turned upright: right on the sheet becomes up.
        turn = 1.0 if name == "x" else 1j
        sign = 1.0 if name == "x" else (1.0 if sheet.is_y_down else -1.0)
        paths = [(called, _times(path, turn)) for called, path in sheet.paths]
        frame = _Frame(name, sign, sheet.unit)
        try:
            return _read(paths, None if place is None else sign * place, frame, tolerance, field)
        except _NoAxis as reason:
            reasons.append(str(reason))
    raise InvalidInput(
        field,
        Described(reasons[0]),
        "half an outline that begins and ends on an upright axis, a full one that agrees on both"
        f" sides to {100.0 * ASYMMETRY:g} %, or the place of the axis: --axis x=NUMBER",
    )


def _likely_directions(sheet: Sheet, directions: str, place: float | None, field: str) -> str:
    """Return the directions that the axis of a drawing may have.

    A closed outline that is symmetric about a level line, and has a straight upright side, may be a
    full one that lies, or half of one beside that side. It lies if that side is short, as the end
    of a stem is. If it is long the outline may still be either, unless its other strokes are curves
    as of half a ball: then `InvalidInput` is raised.
    """
    if len(directions) == 1 or place is not None:
        return directions
    paths = [path for _, path in sheet.paths]
    points, _ = _chords(paths)
    size = float(max(np.ptp(points.real), np.ptp(points.imag)))
    outlines, center_lines = _outlines(sheet.paths, GAP * size)
    closed = [path for _, path in outlines if is_closed(path, GAP * size)]
    middle = 0.5 * (float(points.real.min()) + float(points.real.max()))
    turned = [_times(path, 1j) for path in closed]
    level = -0.5 * (float(points.imag.min()) + float(points.imag.max()))
    if (
        center_lines
        or not closed
        or len(closed) < len(outlines)
        or _difference(closed, middle) <= ASYMMETRY * size
    ):
        return directions
    if _difference(turned, level) > ASYMMETRY * size:
        return _direction_of_half(closed, turned, directions, size, field)
    straight = [
        (stroke.first, stroke.last)
        for path in closed
        for stroke in path
        if stroke.radius == math.inf
    ]
    sides = [float(points.real.min()), float(points.real.max())]
    if min([abs(side) for side in sides]) <= GAP * size:
        return directions
    along = [
        [pair for pair in straight if all(abs(end.real - side) <= GAP * size for end in pair)]
        for side in sides
    ]
    longest = max([sum([abs(end - begin) for begin, end in pairs]) for pairs in along])
    if longest < LONG_SIDE * float(np.ptp(points.imag)):
        return "y"
    if len(straight) > max([len(pairs) for pairs in along]):
        raise InvalidInput(
            field,
            Described("an outline with a straight side that is symmetric about a level line"),
            "",
            "may be half of one beside that side, or a full one that lies",
            "state the direction of its axis, axis='x' for upright or 'y' for level, at the"
            " command line --axis",
        )
    return directions


def _direction_of_half(
    upright: list[Path], turned: list[Path], directions: str, size: float, field: str
) -> str:
    """Return the directions of the axis beside half an outline that has no symmetry.

    The axis is the straight side over the full length of the drawing. A drawing with its axis on
    its left, or at 0, is taken at once. If another side is as long as the drawing, and the left one
    is straight in a part, the outline may be half of two bodies: then `InvalidInput` is raised.
    """
    straight, at_zero = [], False
    for paths in (upright, turned):
        points, _ = _chords(paths)
        extent = float(np.ptp(points.imag))
        for side in (float(points.real.min()), float(points.real.max())):
            at_zero = at_zero or abs(side) <= GAP * size
            straight.append(_straight_length(paths, side, size) / extent)
    full_length = [number for number in range(4) if straight[number] >= WHOLE_SIDE]
    if at_zero or 0 in full_length or not full_length:
        return directions
    if len(full_length) == 1 and len([share for share in straight if share > 0.0]) == 1:
        return "x" if full_length[0] == 1 else "y"
    raise InvalidInput(
        field,
        Described("an outline with straight sides that is not symmetric"),
        "",
        "may be half of a body beside one of them or another",
        "state the place of its axis, axis='x=NUMBER' for upright or 'y=NUMBER' for level, at the"
        " command line --axis",
    )


def _straight_length(paths: list[Path], side: float, size: float) -> float:
    """Return the length of the straight strokes on an upright line, of those that end there."""
    length = 0.0
    for path in paths:
        for stroke in path:
            apart = max(abs(stroke.first.real - side), abs(stroke.last.real - side))
            if stroke.radius == math.inf and apart <= ALONG * size:
                length += abs(stroke.last - stroke.first)
    return length


# translate: skip
def _stated(axis: str | None) -> tuple[str, float | None]:
    """Return the possible directions of the axis, and its place or None."""
    if axis is None:
        return "xy", None
    parts = re.fullmatch(r"\s*([xy])\s*(?:=\s*(\S+))?\s*", axis) if isinstance(axis, str) else None
    try:
        if parts is None:
            raise ValueError
        place = float(parts[2]) if parts[2] else None
    except ValueError:
        raise InvalidInput("axis", axis, AXES) from None
    if place is not None and not math.isfinite(place):
        raise InvalidInput("axis", axis, AXES)
    return parts[1], place


def _times(path: Path, factor: complex) -> Path:
    return [stroke.moved(lambda point: factor * point) for stroke in path]


def _read(
    paths: list[tuple[str, Path]],
    place: float | None,
    frame: _Frame,
    tolerance: float,
    field: str,
) -> Reading:
    """Return the profile around an upright axis."""
    points, _ = _chords([path for _, path in paths])
    size = float(max(np.ptp(points.real), np.ptp(points.imag)))
    if not size > 0.0:
        raise InvalidInput(
            field, Described("a drawing of one point"), "one with an outline of the body"
        )
    outlines, center_lines = _outlines(paths, GAP * size)
    if not outlines:
        raise _NoAxis("straight lines that do not meet")
    axis = _axis(outlines, center_lines, place, size, frame)
    points, _ = _chords([path for _, path in outlines])
    reach = points.real - axis.place
    side = -1.0 if reach.max() <= GAP * size else 1.0
    halves = [
        (name, part)
        for name, path in outlines
        for part in right_parts(_beside(path, axis.place, side), ALONG * size)
    ]
    stated = []
    for name, part in halves:
        ends = part[0].first, part[-1].last
        if not is_closed(part, GAP * size) and max(end.real for end in ends) > GAP * size:
            first, last = (f"({side * end.real + axis.place:.6g}, {end.imag:.6g})" for end in ends)
            raise InvalidInput(
                field,
                Described(f"an open line from {first} to {last}"),
                f"lines that end on the axis, {frame.place_text(axis.place)}, or where they begin",
            )
        stated.append((name, unrounded(_ended(points_of(part), GAP * size), ALONG * size)))
    outer, cavities = nested(stated, tolerance, field)
    remarks = [axis.remark]
    if frame.name == "y":
        remarks.append("The body lies on the sheet: what is right on it is taken as up.")
    if cavities:
        count = "One outline" if len(cavities) == 1 else f"{len(cavities)} outlines"
        remarks.append(f"{count} inside the outermost: a cavity each.")
    return Reading(outer, cavities, remarks)


def _beside(path: Path, place: float, side: float) -> Path:
    """Return a path seen from an axis at a place, mirrored if it is on its left."""

    def move(point: complex) -> complex:
        return complex(side * (point.real - place), point.imag)

    return [stroke.moved(move) for stroke in path]


def _ended(points: list[Point], gap: float) -> list[Point]:
    """Return the points of a line with ends moved onto the axis, or onto each other."""
    first, last = points[0], points[-1]
    if max(first[0], last[0]) > gap:
        points[-1] = (*first[:2], *last[2:])
    else:
        points[0] = (0.0, *first[1:])
        points[-1] = (0.0, *last[1:])
    return [(max(0.0, point[0]), *point[1:]) for point in points]


def _outlines(
    paths: list[tuple[str, Path]], gap: float
) -> tuple[list[tuple[str, Path]], list[Path]]:
    """Return the paths joined to outlines, and the centre lines: straight lines without contact."""
    ends = [end for _, path in paths for end in (path[0].first, path[-1].last)]

    def is_apart(path: Path) -> bool:
        return (
            len(path) == 1
            and path[0].radius == math.inf
            and all(
                sum(abs(end - neighbour) <= gap for neighbour in ends) == 1
                for end in (path[0].first, path[-1].last)
            )
        )

    center_lines = [path for _, path in paths if is_apart(path)]
    others = [(name, path) for name, path in paths if not is_apart(path)]
    if not others and len(center_lines) == len(paths):
        # A drawing of single lines has no centre lines.
        others, center_lines = paths, []
    outlines = []
    for path in joined([path for _, path in others], gap):
        names = [name for name, part in others if any(part[0].at == stroke.at for stroke in path)]
        outlines.append((names[0], path))
    return outlines, center_lines


def _axis(
    outlines: list[tuple[str, Path]],
    center_lines: list[Path],
    place: float | None,
    size: float,
    frame: _Frame,
) -> _Axis:
    """Return the upright axis of a drawing."""
    paths = [path for _, path in outlines]
    points, _ = _chords(paths)
    low, high = float(points.real.min()), float(points.real.max())
    if place is not None:
        return _placed(paths, place, size, frame, "The axis is where it is stated,")
    upright = [
        path[0].first.real
        for path in center_lines
        if abs(path[0].first.real - path[0].last.real) <= ALONG * size
    ]
    if upright and max(upright) - min(upright) <= ALONG * size:
        return _placed(paths, upright[0], size, frame, "The axis is the centre line")
    edges = [
        edge
        for edge in (0.0, low, high)
        if (low >= edge - GAP * size or high <= edge + GAP * size) and _is_half(paths, edge, size)
    ]
    is_open = any(not is_closed(path, GAP * size) for path in paths)
    middle = 0.5 * (low + high)
    difference = _difference(paths, middle)
    if edges and (not edges[0] or is_open or difference > ASYMMETRY * size):
        return _Axis(edges[0], f"The axis is the straight edge at {frame.place_text(edges[0])}.")
    if is_open:
        first, last = next(
            (path[0].first, path[-1].last) for path in paths if not is_closed(path, GAP * size)
        )
        raise _NoAxis(
            f"an open line from ({first.real:.6g}, {first.imag:.6g}) to ({last.real:.6g},"
            f" {last.imag:.6g})"
        )
    if difference > ASYMMETRY * size:
        raise _NoAxis(f"two sides that differ by {100.0 * difference / size:.3g} % of the size")
    return _placed(paths, middle, size, frame, "The axis is the middle of the outline,")


def _placed(paths: list[Path], place: float, size: float, frame: _Frame, how: str) -> _Axis:
    """Return an axis at a place; raise `InvalidInput` if the two sides differ too much."""
    points, _ = _chords(paths)
    reach = points.real - place
    if reach.min() >= -GAP * size or reach.max() <= GAP * size:
        return _Axis(place, f"{how} at {frame.place_text(place)}.")
    difference = _difference(paths, place) / size
    if difference > ASYMMETRY:
        raise InvalidInput(
            "axis",
            Described(
                f"{frame.place_text(place)}, with sides that differ by {100.0 * difference:.3g} %"
            ),
            f"an axis on whose sides the drawing differs by {100.0 * ASYMMETRY:g} % at most, or one"
            " side alone",
        )
    percent = 100.0 * difference if difference > ROUNDING else 0.0
    agreement = f"the two sides differ by {percent:.2g} % of the size at most"
    return _Axis(place, f"{how} at {frame.place_text(place)}; {agreement}.")


def _is_half(paths: list[Path], edge: float, size: float) -> bool:
    """Return whether a drawing has open ends or straight edges on the line x = `edge`."""
    ends = [
        abs(end.real - edge) <= GAP * size
        for path in paths
        if not is_closed(path, GAP * size)
        for end in (path[0].first, path[-1].last)
    ]
    straight = any(
        stroke.radius == math.inf
        and max(abs(end.real - edge) for end in (stroke.first, stroke.last)) <= ALONG * size
        and abs(stroke.last - stroke.first) > GAP * size
        for path in paths
        for stroke in path
    )
    return all(ends) and (bool(ends) or straight)


def _difference(paths: list[Path], place: float) -> float:
    """Return the largest distance between a drawing and its mirror image."""
    starts, ends = _chords(paths)
    mirrored = (2.0 * place - starts.conjugate(), 2.0 * place - ends.conjugate())
    return max(_apart(mirrored[0], (starts, ends)), _apart(starts, mirrored))


def _apart(points: NDArray[np.complex128], chords: Chords) -> float:
    """Return the largest distance of points from the closest of some chords."""
    starts, ends = chords
    along = np.where(starts == ends, 1e-300, ends - starts)
    lengths, closest = np.abs(along), []
    for point in points.tolist():
        share = (point - starts) / along
        distances = np.abs(share - np.clip(share.real, 0.0, 1.0)) * lengths
        closest.append(float(distances.min()))
    return max(closest)


def _chords(paths: Sequence[Path]) -> Chords:
    """Return starts and ends of chords along all paths."""
    lines = [np.array(stroke.sample(24)) for path in paths for stroke in path]
    return (
        np.concatenate([line[:-1] for line in lines]),
        np.concatenate([line[1:] for line in lines]),
    )


class Outline(NamedTuple):
    """Closed line of a drawing or a mesh."""

    name: str
    """Name in messages."""
    points: Sequence[Point]
    profile: Profile


def _united(outlines: list[Outline], tolerance: float, field: str) -> list[Outline]:
    """Return the outlines, with those that overlap or share a border replaced by their union."""
    result = list(outlines)
    pair = _overlapping(result)
    while pair is not None:
        first, second = (result[number] for number in pair)
        name = f"{first.name} with {second.name}"
        others = [one for number, one in enumerate(result) if number not in pair]
        lines = united(first.profile, second.profile)
        try:
            made = [
                Outline(name, points, profile_of(fit(points, tolerance).points, field=field))
                for points in lines
            ]
        except InvalidInput:
            # The parts are too close to each other to tell where they cross.
            return result
        result = [*others, *made]
        pair = _overlapping(result)
    return result


def _overlapping(outlines: Sequence[Outline]) -> tuple[int, int] | None:
    """Return the numbers of two outlines that overlap, or None."""
    for high, second in enumerate(outlines):
        for low, first in enumerate(outlines[:high]):
            if overlap(first.profile, second.profile):
                return low, high
    return None


def nested(
    outlines: Sequence[tuple[str, Sequence[Point]]], tolerance: float, field: str
) -> tuple[list[Point], list[list[Point]]]:
    """Return the outer outline and the cavities in it; raise `InvalidInput` for others."""
    profiles: list[Outline] = [
        Outline(name, points, profile_of(fit(points, tolerance).points, field=field))
        for name, points in outlines
    ]
    profiles = _united(profiles, tolerance, field)
    (outer_name, outer, body), *inner = sorted(
        profiles, key=lambda one: -area_of(one.profile.edges)
    )
    for name, _, profile in inner:
        sides = profile.sides(body)
        if "out" in sides:
            how = "crosses" if "in" in sides else "is beside"
            raise InvalidInput(
                field,
                Described(f"{name}, which {how} {outer_name}"),
                "one outline around the body, and bores inside it: join the parts of the body",
            )
    for number, (name, _, cavity) in enumerate(inner):
        for earlier_name, _, earlier in inner[:number]:
            if "out" not in cavity.sides(earlier) or "in" in earlier.sides(cavity):
                inside = Described(f"{name}, which is inside {earlier_name}")
                raise InvalidInput(field, inside, "bores beside each other")
    return list(outer), [list(points) for _, points, _ in inner]
