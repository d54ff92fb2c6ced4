"""Guards of what a body's shape makes happen: another surface touches the table, or its face lies on it."""

from collections.abc import Callable
from typing import Any

from tippetop.contact.mode import Mode, Outcome, Transition
from tippetop.integrators.base import Guard
from tippetop.mechanics.hull import Hull, acting, each_surface
from tippetop.mechanics.state import State
from tippetop.mechanics.top import Kind, Top
from tippetop.mechanics.vectors import Row, Scalar

FACE, TOUCH = "face", "touch "

MARGIN = 1e-15
"""Gap, in sizes, below zero at which a surface touches: one that just let go is there by rounding."""


def number_of(top: Top) -> int:
    """Number of the surface that is active."""
    return top.surface.active if isinstance(top.surface, Hull) else 0


def surface_guards(kind: Kind) -> list[Guard]:
    """Guards of the open surfaces of bodies of this kind, and of the face that one is the edge of."""
    surface, active, guards = kind.example.surface, number_of(kind.example), list[Guard]()

    def add_guard(name: str, value: Callable[[Any, Row], Scalar]) -> None:
        guards.append(
            Guard(name, lambda y, numbers: value(kind.top(tuple(numbers[: kind.numbers])).surface, y))
        )

    if hasattr(acting(surface), "face_guard"):
        add_guard(FACE, _face)
    for number in range(len(each_surface(surface))):
        if number != active:
            add_guard(f"{TOUCH}{number}", _gap_of(number))
    return guards


def _face(surface: Any, y: Row) -> Scalar:
    edge: Any = acting(surface)
    return edge.face_guard((y[0], y[1], y[2]))


def _gap_of(number: int) -> Callable[[Any, Row], Scalar]:
    """Gap of a surface while the active one touches, from the surfaces and the numbers of a mode."""
    return lambda surface, y: surface.height(y[2]) - surface.each[number].height(y[2]) + MARGIN


def stays_open(top: Top, y: Row) -> bool:
    """Whether no other surface touches at these numbers of a mode on the active one, floats."""
    return clearance(top, y[2]) > -MARGIN


def clearance(top: Top, c: float) -> float:
    """The least gap of the other surfaces while the active one touches, at a cosine of the tilt, floats."""
    height = top.surface.height(c)
    gaps = [
        height - other.height(c)
        for number, other in enumerate(each_surface(top.surface))
        if number != number_of(top)
    ]
    return float(min(gaps))


def follow_surface(mode: Mode, guard: str, time: float, state: State) -> Transition | None:
    """What follows one of these guards; None for any other."""
    if guard == FACE:
        return Transition((), Outcome.LYING_FLAT, state)
    if guard.startswith(TOUCH):
        return mode.rules.touch(int(guard.removeprefix(TOUCH)), time, state)
    return None
