"""Flights of many tops at once: steps of free motion, until a surface touches the table."""

from collections.abc import Callable, Sequence
from functools import lru_cache
from itertools import chain
from typing import Any, NamedTuple

import numpy as np

from tippetop.contact.flight import SIZE, Start
from tippetop.graph.taylor_coefficients import SharedSeries
from tippetop.integrators.base import Array, Motion
from tippetop.integrators.polynomial_minima import least_value, looked_at
from tippetop.integrators.polynomial_zeros import single_fall
from tippetop.mechanics.series import Arithmetic, horner, solved, unknown
from tippetop.mechanics.surfaces.hull import is_edge
from tippetop.mechanics.top import Kind
from tippetop.mechanics.vectors import Scalar
from tippetop.sweeps.lane_sums import NO_SUMS, LaneSums, flying_motion
from tippetop.sweeps.taylor_step import PROBES, extremes, met, order_for, step_size
from tippetop.sweeps.taylor_stepper import NODES, compiled, padded

FLIGHT_TOLERANCE = 1e-14
"""What the polynomials of a step leave out, relative to the axis and the gap: a short flight has a
gap that is as small a part of the size.
"""

ORDER = order_for(FLIGHT_TOLERANCE)

LEFT, VANISHING, WANTED, GIVEN = SIZE, SIZE + 1, slice(SIZE + 2, SIZE + 5), SIZE + 5
"""Rows of what is given after the state, and how many: the time that is left, how many of gap, gap
rate and gap acceleration vanish, and what is waited for (see `met`). The numbers of sums follow.
"""


class FlightSteps(NamedTuple):
    """Steps of n flights, of which so many sums are carried."""

    after: Array
    """States and sums at the end, shape (10 + sums, n)."""
    full: Array
    span: Array
    """How long the polynomials serve, and how long the step is, shape (n,)."""
    touches: Array
    """1 where the table is touched at its end, else 0."""
    doubt: Array
    """Not 0 where that is not sure, or happens what is waited for."""
    highest_gap: Array
    highest: Array
    """Largest gap, and height of the centre of mass."""
    floor: Array
    ceiling: Array
    """Least and largest n_z."""
    state: Array
    guards: Array
    """Coefficients in powers of time, shapes (10 + sums, ORDER + 1, n) and (guards, ORDER + 1, n).
    """


def flight_steps(
    kind: Kind, starts: Array, numbers: Array, sums: LaneSums = NO_SUMS
) -> FlightSteps:
    """Return the steps of flights that begin with these numbers, shape (GIVEN + sums, n), of tops
    with these numbers, shape (kind.numbers, n).
    """
    count, size = starts.shape[1], SIZE + sums.count
    start, parameters = padded(starts), padded(numbers)
    guards = len(flying_motion(kind, sums).guards)
    made = np.empty((size + 8, start.shape[1]))
    terms = np.empty(((size + guards) * (ORDER + 1), start.shape[1]))
    _code(kind, sums)(start, parameters, made, terms)
    state, falls = np.split(terms.reshape(-1, ORDER + 1, start.shape[1])[..., :count], [size])
    return FlightSteps._make([made[:size, :count], *made[size:, :count], state, falls])


@lru_cache(maxsize=16)
def _code(kind: Kind, sums: LaneSums) -> Callable[..., None]:
    motion, on_edge = flying_motion(kind, sums), is_edge(kind.example.surface)

    def rows(start: Sequence[Scalar], numbers: Sequence[Scalar]) -> list[Scalar]:
        step = flight_step(motion, start, numbers, NODES, on_edge=on_edge)
        return [*step.after, *step[1:9], *chain(*step.state), *chain(*step.guards)]

    count = (motion.size + len(motion.guards)) * (ORDER + 1)
    return compiled(rows, GIVEN + sums.count, kind.numbers, count, effort=0)


def flight_step(
    motion: Motion,
    start: Sequence[Any],
    numbers: Sequence[Scalar],
    plain: Arithmetic,
    *,
    on_edge: bool,
) -> FlightSteps:
    """Return the step of one flight that begins with these numbers, of a top with these numbers.

    An edge's guard is no gap (`on_edge`), and says nothing of its height.
    """
    y = solved(
        [SharedSeries(unknown, plain) for _ in range(motion.size)],
        [*start[:SIZE], *start[GIVEN:]],
        lambda y: motion.rates(y, numbers),
    )
    guards = [guard.value(y, numbers).up_to(ORDER)[: ORDER + 1] for guard in motion.guards]
    state = [series.up_to(ORDER)[: ORDER + 1] for series in y]
    # Beside a large gap what is left out of the axis is compared with less.
    sums = state[SIZE:]
    full = step_size([*state[:3], *guards], start[LEFT], plain, axis=3, sums=sums)
    gap, *faces = guards
    span, doubt = single_fall(divided(gap, start[VANISHING], plain), full, plain)
    span = plain.least(span, full)
    for face in faces:
        fall, unsure = single_fall(face, full, plain)
        span, doubt = plain.least(fall, span), doubt + unsure
    touches = plain.below(span, full)
    floor, ceiling = extremes(state[2], span, plain)
    if on_edge:
        doubt += 1.0
    doubt += met(floor, ceiling, start[WANTED], plain)
    highest = [highest_value(terms, span, plain) for terms in (gap, state[9])]
    after = [horner(terms, span) for terms in state]
    numbers_of_step = [after, full, span, touches, doubt, *highest, floor, ceiling, state, guards]
    return FlightSteps._make(numbers_of_step)


def highest_value(terms: Sequence[Scalar], span: Scalar, plain: Arithmetic) -> Scalar:
    """Return the largest value of a polynomial in a step."""
    depth = [-term for term in terms]
    return -least_value(depth, looked_at(depth, span, PROBES), span, plain)


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
