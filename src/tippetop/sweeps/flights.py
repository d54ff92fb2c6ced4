"""Flights of many tops at once, and whether tops in contact slide on.

A flight is closed: the axis turns about the constant angular momentum and the centre of mass falls,
so that the gap is a known function of time. Its first zero is found piece by piece, on Taylor
polynomials that are exact to rounding there. What vanishes at the start of a flight
(`tippetop.mechanics.flight.touchdown.Start`) is divided out.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from tippetop.contact.contact_mode import ContactMode
from tippetop.integrators.base import Array
from tippetop.integrators.polynomials import Polynomials
from tippetop.mechanics.contacts.forces import is_set_valued
from tippetop.mechanics.contacts.slip_variables import (
    is_near,
    is_rolling,
    is_slipping,
    rolling_stopping_guard,
)
from tippetop.mechanics.flight.free_motion import fly
from tippetop.mechanics.flight.separation import NARROWEST, Separation, Tip
from tippetop.mechanics.flight.touchdown import highest_gap
from tippetop.mechanics.motion import (
    along_table,
    sliding_contact,
    sliding_rates,
)
from tippetop.mechanics.state import State
from tippetop.mechanics.surfaces.hull import is_edge
from tippetop.mechanics.top import Kind, Top
from tippetop.mechanics.view import axis_sine
from tippetop.sweeps.flight_steps import (
    LEFT,
    STATE,
    TIME,
    VANISHING,
    WANTED,
    Piece,
    divided,
    flight_terms,
    pieces,
)
from tippetop.sweeps.launch_arrays import Flags, Indices, single
from tippetop.sweeps.taylor_stepper import NumPyArithmetic
from tippetop.sweeps.tip_extremes import TipMotion

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
    """Whether it could not be followed, and is as it began: its polynomials are no numbers, or no
    pieces.
    """
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
    """Fly until the table is touched, for the `horizon` at most: all of shape (n,).

    The tops are told by their dimensionless numbers, shape (kind.numbers, n); of gap, gap rate and
    gap acceleration so many are `vanishing` at the start. `seen` is what follows the tip of the
    axis, the numbers of the launches there, and the times at the start.
    """
    tip, launches, begins = seen
    time, highest = np.zeros_like(horizon), np.zeros_like(horizon)
    landed, lost = np.zeros((2, *horizon.shape), dtype=bool)
    top = kind.top(tuple(numbers))
    turns = Turns.of(state, top, horizon)

    def separation(i: int) -> Separation:
        return Separation.of(single(state, i), kind.top(tuple(numbers[:, i].tolist())))

    starts = np.array([*state.pack(), time, horizon, vanishing, *tip.pauses(launches)])
    for _ in range(PIECES):
        active = np.flatnonzero(~landed & ~lost & (time < horizon))
        if not len(active):
            break
        parts = pieces(kind, starts[:, active], numbers[:, active])
        doubtful = np.flatnonzero(parts.doubt)
        if len(doubtful):
            which = active[doubtful]
            moments = begins[which] + time[which]
            seen_there = tip, launches[which], moments
            looked = closer_extremes(kind, starts[:, which], numbers[:, which], seen_there)
            for numbers_of_part, better in zip(parts, looked, strict=True):
                numbers_of_part[doubtful] = better
            starts[WANTED] = tip.pauses(launches)
        none = np.full(len(active), np.nan)
        tip.put_of(launches[active], np.array([none, parts.floor, -parts.ceiling]))
        highest[active] = np.fmax(highest[active], parts.highest_gap)
        over, before = parts.span == starts[LEFT, active], time[active]
        time[active] = np.where(over, horizon[active], before + parts.span)
        landed[active] = parts.touches != 0.0
        lost[active] = ~landed[active] & ~(time[active] > before)
        flying = ~landed & ~lost & (time < horizon)
        time = np.minimum(turns.leap(time, flying, separation), horizon)
        starts[TIME], starts[LEFT], starts[VANISHING] = time, horizon - time, 0.0
    time[lost] = 0.0
    last = fly(state, time, top, np)
    ground = top.surface.height(np.clip(last.axis[2], -1.0, 1.0))
    summit = np.clip(state.velocity[2] / top.gravity, 0.0, time)
    return Flown(
        time,
        landed,
        lost,
        last._replace(height=np.where(landed, ground, last.height)),
        highest,
        fly(state, summit, top, np).height,
    )


class Turns(NamedTuple):
    """What of flights of many turns need not be looked at: all of shape (n,).

    After a turn all has been seen of the tip's motion, and a turn nearer the summit the gap is
    larger.
    """

    period: Array
    """How long the axis takes for a turn."""
    summit: Array
    """When the centre of mass is highest while it may fly."""
    clear: Array
    """Until when it is too high for any touch; 0 where that is not known yet."""

    @classmethod
    def of(cls, state: State, top: Top, horizon: Array) -> "Turns":
        """Return the flights from some states on, for so long at most."""
        period: Array = np.asarray(2.0 * np.pi / Tip.of(state, top).frequency)
        return cls(
            period, np.clip(state.velocity[2] / top.gravity, 0.0, horizon), np.zeros_like(period)
        )

    def leap(self, time: Array, flying: Flags, separation: Callable[[int], Separation]) -> Array:
        """Times at which flights go on, of those that still fly, given the gap of each."""
        turned = flying & (time >= self.period)
        if not turned.any():
            return time
        for i in np.flatnonzero(turned & (self.clear == 0.0)).tolist():
            gap = separation(i)
            self.clear[i] = gap.clear_until(float(time[i]), gap.level)
        goal = np.where(
            time < self.summit, np.minimum(self.clear, self.summit - self.period), self.clear
        )
        leaps = turned & (np.abs(time - self.summit) > self.period)
        return np.where(leaps, np.maximum(goal, time), time)


def closer_extremes(
    kind: Kind, starts: Array, numbers: Array, seen: tuple[TipMotion, Indices, Array]
) -> Piece:
    """Return parts of flights by a search of their polynomials, and take in their extremes."""
    tip, launches, times = seen
    top = kind.top(tuple(numbers))
    motion = fly(State.unpack(list(starts[STATE])), starts[TIME], top, np)
    height, gap, reach = flight_terms(motion, starts[LEFT], top, PLAIN)
    rise, ahead = (np.array(np.broadcast_arrays(*terms)) for terms in (height, gap))
    zero = Polynomials(np.array(divided(list(ahead), starts[VANISHING], PLAIN)), reach).first_fall()
    touches = ~np.isnan(zero)
    span = np.where(touches, zero, reach)
    highest = -Polynomials(-ahead, span).refined_least()[1]
    flat = axis_sine(motion.axis) <= NARROWEST if is_edge(top.surface) else np.zeros(span.shape)
    for i in np.flatnonzero(flat).tolist():
        one, its = single(motion, i), kind.top(tuple(numbers[:, i].tolist()))
        end, root = Separation.of(one, its).across_flat(0.0, float(starts[LEFT, i]))
        touches[i], span[i] = root is not None, end if root is None else root
        highest[i] = highest_gap(one, its, float(span[i]))
    tip.see(launches, times, Polynomials(rise, span))
    missing = np.full(span.shape, np.nan)
    return Piece(span, touches, missing, highest, missing, missing)


def slides(state: State, top: Top) -> Flags:
    """Return whether tops in contact, whose contact point is at rest vertically, go on sliding."""
    sliding = along_table(state)
    touch = sliding_contact(sliding.axis, sliding.momentum, sliding.velocity, top)
    flags: Flags = (touch.delassus > 0.0) & (touch.free_acceleration < 0.0)
    return flags


def rolls(state: State, top: Top) -> Flags:
    """Return whether tops in contact roll on for a while, or nothing resists that."""
    count = np.ones(len(np.atleast_1d(state.height)), dtype=bool)
    if not top.resists_rolling:
        return count
    y = along_table(state)
    lasting = rolling_stopping_guard(y, sliding_rates(y, top), top) > 0.0
    flags: Flags = count & is_rolling(y.axis, y.momentum, top) & lasting
    return flags


def slips(state: State, top: Top, *, far: bool = False) -> Flags:
    """Return whether tops in contact slip on for a while, by their law's end of slip.

    If `far`, so fast that its end need not be guarded.
    """
    count = np.ones(len(np.atleast_1d(state.height)), dtype=bool)
    if not is_set_valued(top.friction):
        return count
    y = along_table(state)
    lasting = ContactMode(top).contacts(y.pack()).slip_left() > 0.0
    flags: Flags = count & is_slipping(*y, top) & lasting
    return flags & ~is_near(y, top) if far else flags
