"""A piece of a flight of many tops at once: how far it goes, whether the table is touched, how high
it leads.

Within a piece the gap is a Taylor polynomial that is exact to rounding. LLVM compiles all that is
usual of it. Where something is doubtful, or happens that is asked for, the polynomials are to be
looked at.
"""

from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from tippetop.graph.graph import COSINE, SINE, Node
from tippetop.integrators.base import Array
from tippetop.integrators.polynomial_minima import first_fall, least_value, looked_at
from tippetop.mechanics.flight.free_motion import fly
from tippetop.mechanics.flight.separation import NARROWEST, Tip, support_terms
from tippetop.mechanics.flight.touchdown import Start
from tippetop.mechanics.series import Arithmetic
from tippetop.mechanics.state import State
from tippetop.mechanics.surfaces.hull import is_edge
from tippetop.mechanics.top import Kind, Top
from tippetop.mechanics.vectors import Scalar
from tippetop.mechanics.view import axis_sine
from tippetop.sweeps.taylor_step import FINE_PROBES, PROBES, extremes, met, step_size
from tippetop.sweeps.taylor_stepper import NODES, compiled, padded

STATE, TIME, LEFT, VANISHING, WANTED, GIVEN = slice(10), 10, 11, 12, slice(13, 16), 16
"""Rows of what is given, and how many: the state at the start of the flight, the time since then
and what is left, how many of gap, gap rate and gap acceleration vanish now, and what is wanted (see
`met`).
"""


BESIDE = 0.5
"""Part of the angle to flat that an edge turns in a piece at most: in one plane, series see no kink
there.
"""


class Piece(NamedTuple):
    """What became of pieces: all of shape (n,)."""

    span: Array
    """How long each lasts."""
    touches: Array
    """1 where the table is touched at its end, else 0."""
    doubt: Array
    """Not 0 where the polynomials are to be looked at, and nothing here is to be used."""
    highest_gap: Array
    floor: Array
    ceiling: Array
    """Largest gap, and least and largest n_z."""


class NodeFunctions:
    """Elementary functions of nodes."""

    def sin(self, angle: Node) -> Node:
        """Sine."""
        return angle.graph.node(SINE, (angle,))

    def cos(self, angle: Node) -> Node:
        """Cosine."""
        return angle.graph.node(COSINE, (angle,))


def pieces(kind: Kind, starts: Array, numbers: Array) -> Piece:
    """Return the parts of flights that begin with these numbers, of shape (GIVEN, n), of tops with
    these numbers, (kind.numbers, n).
    """
    count = starts.shape[1]
    start, parameters = padded(starts), padded(numbers)
    parts = np.empty((len(Piece._fields), start.shape[1]))
    _code(kind)(start, parameters, parts)
    return Piece(*parts[:, :count])


@lru_cache(maxsize=16)
def _code(kind: Kind) -> Callable[[Array, Array, Array], None]:
    def rows(start: Sequence[Scalar], numbers: Sequence[Scalar]) -> Sequence[Scalar]:
        return flight_part(kind.top(tuple(numbers)), start, NODES)

    return compiled(rows, GIVEN, kind.numbers, effort=0)


def flight_part(top: Top, start: Sequence[Any], plain: Arithmetic) -> Piece:
    """Return the part of a flight that begins with these numbers."""
    motion = fly(State.unpack(start[STATE]), start[TIME], top, NodeFunctions())
    tip, gap, reach = flight_terms(motion, start[LEFT], top, plain)
    zero, doubt = first_fall(divided(gap, start[VANISHING], plain), reach, FINE_PROBES, plain)
    touches = plain.below(zero, reach)
    span = plain.least(zero, reach)
    floor, ceiling = extremes(tip, span, plain)
    depth = [-term for term in gap]
    highest = -least_value(depth, looked_at(depth, span, PROBES), span, plain)
    if is_edge(top.surface):
        doubt += 1.0 - plain.below(0.0, reach)
    return Piece(
        span, touches, doubt + met(floor, ceiling, start[WANTED], plain), highest, floor, ceiling
    )


def flight_terms(
    state: State, remaining: Scalar, top: Top, plain: Arithmetic
) -> tuple[list[Scalar], list[Scalar], Scalar]:
    """Polynomials of n_z and of the gap in flight, and how far they serve, all that is left at
    most.

    That is 0 where an edge lies flat, or almost.
    """
    moving = Tip.of(state, top)
    tip = moving.terms
    support = support_terms(top.surface, tip, plain)
    fall = (state.height, state.velocity[2], -0.5 * top.gravity)
    gap = [b - s for b, s in zip(fall, support[:3], strict=True)] + [-term for term in support[3:]]
    reach = step_size([tip, support], remaining, plain)
    if is_edge(top.surface):
        sine = axis_sine(state.axis)
        beside = plain.least(reach, BESIDE * sine / moving.frequency)
        reach = plain.choose(plain.below(NARROWEST, sine), beside, 0.0 * remaining)
    return tip, gap, reach


def divided(terms: Sequence[Scalar], vanishing: Scalar, plain: Arithmetic) -> list[Scalar]:
    """Return a polynomial whose first coefficients vanish, divided by the power of time that it
    has.
    """
    terms_left = list(terms)
    for most in range(int(max(Start))):
        is_zero = plain.below(most + 0.5, vanishing)
        shifted = [*terms_left[1:], 0.0 * terms_left[0]]
        terms_left = [
            plain.choose(is_zero, after, term)
            for term, after in zip(terms_left, shifted, strict=True)
        ]
    return terms_left
