"""Flights of many tops at once, and whether tops in contact slide on.

A flight is closed: the axis turns about the constant angular momentum and the centre of mass falls, so that
the gap is a known function of time. Its first zero is found piece by piece, on Taylor polynomials that are
exact to rounding there. What vanishes at the start of a flight (`tippetop.mechanics.touchdown.Start`) is
divided out.
"""

from typing import NamedTuple

import numpy as np

from tippetop.integrators.base import Array
from tippetop.integrators.polynomials import Polynomials
from tippetop.mechanics.flight import fly
from tippetop.mechanics.motion import (
    along_table,
    contact,
    on_table,
    sliding_rates,
)
from tippetop.mechanics.rolling import is_set_valued
from tippetop.mechanics.state import State
from tippetop.mechanics.stick_slip import (
    is_near,
    is_rolling,
    is_slipping,
    rolling_stopping_guard,
    stopping_guard,
)
from tippetop.mechanics.top import Kind, Top
from tippetop.sweeps.launches import Flags, Indices
from tippetop.sweeps.pieces import LEFT, STATE, TIME, VANISHING, WANTED, Piece, divided, flight_terms, pieces
from tippetop.sweeps.stepper import NumPyArithmetic
from tippetop.sweeps.tip import TipMotion

PLAIN = NumPyArithmetic()

PIECES = 100_000
"""Pieces that a flight may have: each is a fraction of a turn."""


class Flown(NamedTuple):
    """What became of flights: all of shape (n,)."""

    duration: Array
    """How long each lasted."""
    landed: Flags
    """Whether it ended on the table rather than at the horizon."""
    lost: Flags
    """Whether it could not be followed, as its polynomials are no numbers."""
    state: State
    """The states at the end."""
    highest_gap: Array
    highest: Array
    """Largest gap of each, and largest height of its centre of mass."""


def fly_all(
    state: State,
    kind: Kind,
    numbers: Array,
    horizon: Array,
    vanishing: Indices,
    seen: tuple[TipMotion, Indices, Array],
) -> Flown:
    """Fly until the table is touched.

    Parameters
    ----------
    state
        The states at the start, every number an array of shape (n,).
    kind, numbers
        The tops: their dimensionless numbers, shape (kind.numbers, n).
    horizon
        How long to fly at most, shape (n,).
    vanishing
        How many of gap, gap rate and gap acceleration vanish at the start, shape (n,).
    seen
        What follows the tip of the axis, under which numbers, and the times at the start.
    """
    tip, launches, begun = seen
    time, highest = np.zeros_like(horizon), np.zeros_like(horizon)
    landed, lost = np.zeros((2, *horizon.shape), dtype=bool)
    given = np.array([*state.pack(), time, horizon, vanishing, *tip.wanted(launches)])
    for _ in range(PIECES):
        active = np.flatnonzero(~landed & ~lost & (time < horizon))
        if not len(active):
            break
        found = pieces(kind, given[:, active], numbers[:, active])
        doubtful = np.flatnonzero(found.doubt)
        if len(doubtful):
            which = active[doubtful]
            moments = begun[which] + time[which]
            looked = look(kind, given[:, which], numbers[:, which], (tip, launches[which], moments))
            for kept, better in zip(found, looked, strict=True):
                kept[doubtful] = better
            given[WANTED] = tip.wanted(launches)
        none = np.full(len(active), np.nan)
        tip.put_of(launches[active], np.array([none, found.floor, -found.ceiling]))
        highest[active] = np.fmax(highest[active], found.highest_gap)
        over = found.span == given[LEFT, active]
        time[active] = np.where(over, horizon[active], time[active] + found.span)
        landed[active] = found.touches != 0.0
        lost[active] = ~landed[active] & ~(found.span > 0.0)
        given[TIME], given[LEFT], given[VANISHING] = time, horizon - time, 0.0
    top = kind.top(tuple(numbers))
    last = fly(state, time, top, np)
    ground = on_table(along_table(last), top).height
    summit = np.clip(state.velocity[2] / top.gravity, 0.0, time)
    return Flown(
        time,
        landed,
        lost,
        last._replace(height=np.where(landed, ground, last.height)),
        highest,
        fly(state, summit, top, np).height,
    )


def look(kind: Kind, given: Array, numbers: Array, seen: tuple[TipMotion, Indices, Array]) -> Piece:
    """Pieces of flights, by looking at their polynomials, and what happens in them taken in."""
    tip, launches, begun = seen
    top = kind.top(tuple(numbers))
    here = fly(State.unpack(list(given[STATE])), given[TIME], top, np)
    with np.errstate(all="ignore"):
        height, gap, reach = flight_terms(here, given[LEFT], top, PLAIN)
    rise, ahead = (np.array(np.broadcast_arrays(*terms)) for terms in (height, gap))
    zero = Polynomials(np.array(divided(list(ahead), given[VANISHING], PLAIN)), reach).first_fall()
    touches = ~np.isnan(zero)
    span = np.where(touches, zero, reach)
    tip.see(launches, begun, Polynomials(rise, span))
    highest = -Polynomials(-ahead, span).refined_least()[1]
    nothing = np.full(span.shape, np.nan)
    return Piece(span, touches, nothing, highest, nothing, nothing)


def slides(state: State, top: Top) -> Flags:
    """Whether tops in contact, whose contact point is at rest vertically, go on sliding."""
    sliding = along_table(state)
    with np.errstate(all="ignore"):
        touch = contact(sliding.axis, sliding.momentum, sliding.velocity, top)
    found: Flags = (touch.delassus > 0.0) & (touch.free_acceleration < 0.0)
    return found


def rolls(state: State, top: Top) -> Flags:
    """Whether tops in contact roll on for a while, or nothing resists that."""
    count = np.ones(len(np.atleast_1d(state.height)), dtype=bool)
    if not top.resists_rolling:
        return count
    y = along_table(state)
    with np.errstate(all="ignore"):
        lasting = rolling_stopping_guard(y, sliding_rates(y, top), top) > 0.0
    found: Flags = count & is_rolling(y.axis, y.momentum, top) & lasting
    return found


def slips(state: State, top: Top, *, far: bool = False) -> Flags:
    """Whether tops in contact slip on for a while, for all that their law says of the end of slip.

    If `far`, so fast that it need not be watched how long.
    """
    count = np.ones(len(np.atleast_1d(state.height)), dtype=bool)
    if not is_set_valued(top.friction):
        return count
    y = along_table(state)
    with np.errstate(all="ignore"):
        lasting = stopping_guard(y, sliding_rates(y, top), top) > 0.0
    found: Flags = count & is_slipping(*y, top) & lasting
    return found & ~is_near(y, top) if far else found
