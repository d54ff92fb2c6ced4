"""Guards of what a body's shape makes happen: another surface touches the table, or its face lies
on it.
"""

from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

from tippetop.contact.mode import numbered
from tippetop.mechanics.lying_down import slap_guard
from tippetop.mechanics.surfaces.hull import acting, each_surface, has_flat_end, is_edge
from tippetop.mechanics.surfaces.surface import NEARLY_FLAT, gap_guard, support_at
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Row, Scalar, Vector

FACE, WOBBLE, TOUCH, FLAT_END = "face", "wobble", "touch", "flat end"

MARGIN = 1e-15
"""Gap, in sizes, below zero at which a surface touches: one that just let go is there by rounding.
"""


SurfaceGuard: TypeAlias = Callable[[Top, Vector, Vector], Scalar]
"""A guard as a function of the top, its axis and its angular momentum."""


def surface_guards(top: Top) -> list[tuple[str, SurfaceGuard]]:
    """Return the guards of the open surfaces of a body, by name, and of the face that the active
    one is the edge of.
    """
    guards: list[tuple[str, SurfaceGuard]] = []
    if is_edge(top.surface):
        guards.append((FACE, lambda top, axis, momentum: slap_guard(axis, momentum, top)))
    if has_flat_end(top.surface):
        guards.append((FLAT_END, _end_guard))
    open_ones = [number for number in range(len(each_surface(top.surface))) if number != top.number]
    return guards + [(numbered(TOUCH, number), _gap_of(number)) for number in open_ones]


def _end_guard(top: Top, axis: Vector, _: Vector) -> Scalar:
    """Return what falls through zero as the body comes to lie on a flat end of arcs."""
    arcs: Any = acting(top.surface)
    return arcs.end_guard(axis)


def lies_flat(top: Top, axis: Vector) -> Scalar:
    """Return whether a body whose active surface touches the table lies on the face that this is
    the edge of.
    """
    edge: Any = acting(top.surface)
    return is_edge(top.surface) and edge.lies_flat(axis)


def lands_flat(top: Top, axis: Vector) -> Scalar:
    """Return whether a body whose active surface comes to the table lands on the face that this is
    the edge of.
    """
    edge: Any = acting(top.surface)
    return is_edge(top.surface) and edge.lies_flat(axis, NEARLY_FLAT)


def lies_on_flat_end(top: Top, axis: Vector) -> Scalar:
    """Return whether a body whose active surface touches the table lies on a flat end of arcs, or
    so nearly that it counts as lying there.
    """
    return has_flat_end(top.surface) and _end_guard(top, axis, axis) <= 0.0


def passes_flat(top: Top, rows: Sequence[Row]) -> bool:
    """Return whether a body may come to lie flat between samples of its state, floats, which each
    begin with the horizontal components of the axis; not if it has no edge to lie on.

    In one plane its tip passes the pole within so little that no look tells: the straight line
    between two does, by its place nearest the pole, from which the tip strays by less than a
    quarter of the line.
    """
    if not is_edge(top.surface):
        return False
    for number in range(1, len(rows)):
        a, b = rows[number - 1], rows[number]
        x, y = b[0] - a[0], b[1] - a[1]
        square = x * x + y * y
        part = min(max(-(a[0] * x + a[1] * y) / square, 0.0), 1.0) if square > 0.0 else 0.0
        if (a[0] + part * x) ** 2 + (a[1] + part * y) ** 2 <= square / 16.0:
            return True
    return False


def _gap_of(number: int) -> SurfaceGuard:
    """Return the guard that falls through zero as the gap of a surface plus `MARGIN` does."""

    def gap(top: Top, axis: Vector, _: Vector) -> Scalar:
        height = support_at(axis, top.surface)[0]
        return gap_guard(axis, height, MARGIN, each_surface(top.surface)[number])

    return gap


def stays_open(top: Top, y: Row) -> bool:
    """Return whether no surface but the active one touches at the numbers of a mode, floats."""
    return clearance(top, y[2]) > -MARGIN


def clearance(top: Top, c: float) -> float:
    """Return the least gap of the other surfaces while the active one touches, at a cosine of the
    tilt, floats.
    """
    c = min(max(c, -1.0), 1.0)
    height = top.surface.height(c)
    gaps = [
        height - surface.height(c)
        for number, surface in enumerate(each_surface(top.surface))
        if number != top.number
    ]
    return float(min(gaps))
