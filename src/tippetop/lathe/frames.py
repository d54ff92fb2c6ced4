"""Pages and frames of drawings: rectangles around all else, which are no outlines of bodies."""

# translate module: numpy

import math
from collections.abc import Sequence
from typing import NamedTuple

from tippetop.lathe.strokes import Path, is_closed, joined

STRAIGHT_SHARE = 0.8
"""Least share of the sides of a rectangle that its straight strokes cover: corners may be round."""

PAGE_SHARE = 0.01
"""Largest distance of a background from the page, in sizes of the page."""

NamedPath = tuple[str, Path]


class Box(NamedTuple):
    """Upright rectangle on the sheet."""

    leftmost: float
    low: float
    rightmost: float
    high: float

    def contains(self, inner: "Box", gap: float) -> bool:
        """Return whether another box is inside, up to a gap."""
        return (
            self.leftmost - gap <= inner.leftmost
            and self.low - gap <= inner.low
            and inner.rightmost <= self.rightmost + gap
            and inner.high <= self.high + gap
        )

    @property
    def size(self) -> float:
        """The longer side."""
        return max(self.rightmost - self.leftmost, self.high - self.low)


class Framed(NamedTuple):
    """Drawing with a rectangle around all else."""

    box: Box
    """The rectangle."""
    name: str
    """Its name in messages."""
    inner: list[NamedPath]
    """What it encloses."""


def framed(paths: Sequence[NamedPath], gap: float) -> Framed | None:
    """Return the drawing in an outermost rectangle; None if no rectangle encloses all else.

    Lines that end on the rectangle, such as those of a title block, belong to it.
    """
    outlines = joined([path for _, path in paths], gap)
    if len(outlines) < 2:
        return None
    boxes = [box_of(path) for path in outlines]
    largest = max(range(len(boxes)), key=lambda number: boxes[number].size)
    outer = boxes[largest]
    encloses_all = all(outer.contains(box, gap) for box in boxes)
    if not (encloses_all and _is_rectangle(outlines[largest], outer, gap)):
        return None
    of_frame = [
        path
        for number, path in enumerate(outlines)
        if number == largest or _hangs_on(path, outer, gap)
    ]
    strokes = [stroke.at for path in of_frame for stroke in path]
    inner = [(name, path) for name, path in paths if not any(path[0].at == at for at in strokes)]
    name = next(name for name, path in paths if path[0].at in strokes)
    return Framed(outer, name, inner) if inner else None


def box_of(path: Path) -> Box:
    """Return the box around a path."""
    points = [point for stroke in path for point in stroke.sample(24)]
    across, along = [point.real for point in points], [point.imag for point in points]
    return Box(min(across), min(along), max(across), max(along))


def is_page(box: Box, page: Box) -> bool:
    """Return whether a rectangle covers the page."""
    within = PAGE_SHARE * page.size
    return box.contains(page, within)


def _is_rectangle(path: Path, box: Box, gap: float) -> bool:
    """Return whether a closed path runs along its box, but for its corners."""
    if not is_closed(path, gap):
        return False
    length = 0.0
    for stroke in path:
        if stroke.radius != math.inf:
            continue
        begin, end = stroke.first, stroke.last
        for place, ends in (
            ((box.leftmost, box.rightmost), (begin.real, end.real)),
            ((box.low, box.high), (begin.imag, end.imag)),
        ):
            for side in place:
                if max(abs(ends[0] - side), abs(ends[1] - side)) <= gap:
                    length += abs(end - begin)
    sides = 2.0 * (box.rightmost - box.leftmost + box.high - box.low)
    return length >= STRAIGHT_SHARE * sides


def _hangs_on(path: Path, box: Box, gap: float) -> bool:
    """Return whether an open path of straight lines has both ends on the sides of a box."""
    if is_closed(path, gap) or any(stroke.radius != math.inf for stroke in path):
        return False
    return all(
        min(
            abs(end.real - box.leftmost),
            abs(end.real - box.rightmost),
            abs(end.imag - box.low),
            abs(end.imag - box.high),
        )
        <= gap
        for end in (path[0].first, path[-1].last)
    )
