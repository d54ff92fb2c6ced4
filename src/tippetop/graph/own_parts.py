"""Checks of friction laws and surfaces that users define: whether they are in plain operators."""

from functools import lru_cache
from typing import Any

from tippetop.graph.graph import LESS, SELECT, SIZE, NotRecordable
from tippetop.graph.recording import record
from tippetop.mechanics.surfaces.hull import acting, each_surface
from tippetop.mechanics.surfaces.surface import MeridianSurface
from tippetop.mechanics.top import Kind, Top
from tippetop.mechanics.vectors import Scalar
from tippetop.support.errors import Described, InvalidInput

CANNOT_BE_RECORDED = "cannot be recorded as an expression"
HINT = (
    "write laws and surfaces with + - * / ** < and >, and with tippetop.extend.where, abs, min,"
    " max, sqrt, exp, log and tanh in place of Python's if, and, or, min and max and of functions"
    " of math and numpy"
)

PACKAGE = __name__.partition(".")[0]

CHOICES = (LESS, SELECT, SIZE)
"""Operations that are not analytic: the steps of many launches at once do not see past them."""


def require_recordable(top: Top) -> None:
    """Refuse, with `InvalidInput`, a user's law or surface that asks of its arguments what only
    numbers have.
    """
    has_choices(top)


def has_choices(top: Top) -> bool:
    """Return whether a surface of arcs, or a user's law or surface, chooses by the numbers, as
    `tippetop.extend.where` does.

    Raises `InvalidInput` if it asks of its arguments what only numbers have.
    """
    surfaces = each_surface(top.surface)
    parts: tuple[Any, ...] = (top.friction, *surfaces)
    chooses = any(isinstance(surface, MeridianSurface) for surface in map(acting, surfaces))
    user_parts = [part for part in parts if type(part).__module__.partition(".")[0] != PACKAGE]
    return chooses or (bool(user_parts) and _of_kind(top.kind))


@lru_cache
def _of_kind(kind: Kind) -> bool:
    """Record the law and the surface of tops of a kind, and look for choices."""
    law = kind.law.__name__

    def traction(y: Any, numbers: Any) -> list[Scalar]:
        wrench = kind.top(tuple(numbers)).friction.traction((y[0], y[1]), (y[2], y[3], y[4]))
        return [*wrench.force, *wrench.torque]

    def heights(y: Any, numbers: Any) -> list[Scalar]:
        surfaces = each_surface(kind.top(tuple(numbers)).surface)
        return [
            function(y[0])
            for surface in surfaces
            for function in (surface.height, surface.slope, surface.curvature)
        ]

    return any(
        node.name in CHOICES
        for name, function in ((f"{law}.traction", traction), ("surface", heights))
        for node in _recorded(name, function, kind.numbers)
    )


def _recorded(name: str, function: Any, numbers: int) -> tuple[Any, ...]:
    """Return the operations of a function of at most 5 numbers, named for errors."""
    try:
        return record(function, 5, numbers).nodes
    except NotRecordable as error:
        choice = Described("a choice by if, and, or, min or max")
        raise InvalidInput(name, choice, "", CANNOT_BE_RECORDED, HINT) from error
    except (TypeError, ValueError, ArithmeticError, AttributeError) as error:
        raise InvalidInput(name, error, "", CANNOT_BE_RECORDED, HINT) from error
