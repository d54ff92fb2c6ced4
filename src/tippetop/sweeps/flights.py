"""Flights of many tops at once, followed by steps of Taylor's method, and whether tops in contact
slide on.

What vanishes at the start of a flight (`tippetop.contact.flight.Start`) is divided out in the first
step.
"""

from typing import NamedTuple

import numpy as np

from tippetop.contact.contact_mode import ContactMode
from tippetop.contact.flight import SIZE, Flight
from tippetop.contact.trajectory import STEP_LIMIT
from tippetop.integrators.base import Array
from tippetop.integrators.polynomials import Polynomials
from tippetop.mechanics.contacts.forces import is_set_valued
from tippetop.mechanics.contacts.slip_variables import (
    is_near,
    is_rolling,
    is_slipping,
    rolling_stopping_guard,
)
from tippetop.mechanics.motion import (
    along_table,
    sliding_contact,
    sliding_rates,
)
from tippetop.mechanics.series import horner
from tippetop.mechanics.state import State
from tippetop.mechanics.surfaces.hull import is_edge
from tippetop.mechanics.surfaces.surface import support_at
from tippetop.mechanics.top import Kind, Top
from tippetop.results.highest_gaps import highest_gaps_of
from tippetop.sweeps.axis_extremes import TipMotion
from tippetop.sweeps.flight_steps import (
    GIVEN,
    LEFT,
    VANISHING,
    WANTED,
    FlightSteps,
    divided,
    flight_steps,
)
from tippetop.sweeps.lane_sums import NO_SUMS, LaneSums
from tippetop.sweeps.launch_arrays import Flags, Indices, branched
from tippetop.sweeps.taylor_step import is_singular
from tippetop.sweeps.taylor_stepper import NumPyArithmetic
from tippetop.sweeps.trajectory_samples import TrajectorySamples

PLAIN = NumPyArithmetic()


class Flown(NamedTuple):
    """What became of flights: all of shape (n,)."""

    duration: Array
    """How long each lasted."""
    landed: Flags
    """Whether it ended on the table rather than at the horizon."""
    lost: Flags
    """Whether it could not be followed to its end, as its polynomials are no numbers."""
    state: State
    """The states at the end."""
    sums: Array
    """The numbers of sums at the end, shape (sums, n)."""
    highest_gap: Array
    highest: Array
    """Largest gap of each, and largest height of its centre of mass."""
    steps: Array
    """How many steps each took."""


def fly_all(
    state: State,
    kind: Kind,
    numbers: Array,
    horizon: Array,
    vanishing: Indices,
    seen: tuple[TipMotion, Indices, Array],
    sampled: tuple[TrajectorySamples, Indices] | None = None,
    carried: tuple[LaneSums, Array] | None = None,
) -> Flown:
    """Fly until the table is touched, for the `horizon` at most: all of shape (n,).

    The tops are told by their dimensionless numbers, shape (kind.numbers, n); of gap, gap rate and
    gap acceleration so many are `vanishing` at the start. `seen` is what follows the tip of the
    axis, the numbers of the launches there, and the times at the start. `sampled` has the samples
    to take, and the numbers of the launches in them; `carried` the sums, and their numbers at the
    start, shape (sums, n).
    """
    tip, launches, begins = seen
    count = len(horizon)
    sums, summed = carried or (NO_SUMS, np.empty((0, count)))
    time, steps, lost = np.zeros(count), np.zeros(count), np.zeros(count, dtype=bool)
    landed, highest = lost.copy(), np.zeros((2, count))
    starts = np.empty((GIVEN + sums.count, count))
    starts[GIVEN:] = summed
    starts[:SIZE] = np.broadcast_arrays(*state.pack())
    starts[LEFT], starts[VANISHING], starts[WANTED] = horizon, vanishing, tip.pauses(launches)
    highest[1] = starts[SIZE - 1]
    active = np.flatnonzero(horizon > 0.0)
    while len(active):
        every = len(active) == count
        begin, tops = (starts, numbers) if every else (starts[:, active], numbers[:, active])
        sums.to_nearer_pole(begin, begin[GIVEN:])
        made = flight_steps(kind, begin, tops, sums)
        doubtful = np.flatnonzero(made.doubt)
        if len(doubtful):
            which = active[doubtful]
            moments = begins[which] + time[which]
            look_closer(made, doubtful, kind, (begin, tops), (tip, launches[which], moments))
            starts[WANTED] = tip.pauses(launches)
        none = np.full(len(active), np.nan)
        tip.put_of(launches[active], np.array([none, made.floor, -made.ceiling]))
        highest[:, active] = np.fmax(highest[:, active], (made.highest_gap, made.highest))
        over, touches = made.span == starts[LEFT, active], made.touches != 0.0
        moves = touches | (
            (made.span > 0.0) & (over | ~is_singular(made.span, starts[LEFT, active]))
        )
        lost[active] = ~moves
        if sampled is not None:
            samples, cells = sampled[0], sampled[1][active]
            start = begins[active] + time[active]
            samples.take(cells, start, made.state, np.where(moves, start + made.span, -np.inf))
        active, over, touches = active[moves], over[moves], touches[moves]
        starts[:SIZE, active], starts[VANISHING, active] = made.after[:SIZE, moves], 0.0
        starts[GIVEN:, active] = made.after[SIZE:, moves]
        passed = time[active] + made.span[moves]
        time[active] = np.where(over & ~touches, horizon[active], passed)
        starts[LEFT, active] = horizon[active] - time[active]
        steps[active] += 1.0
        landed[active] = touches
        active = active[~touches & ~over & (steps[active] < STEP_LIMIT)]
    last = State.unpack(list(starts[:SIZE]))
    ground = support_at(last.axis, kind.top(tuple(numbers)).surface)[0]
    last = last._replace(height=np.where(landed, ground, last.height))
    return Flown(time, landed, lost, last, starts[GIVEN:], highest[0], highest[1], steps)


def look_closer(
    made: FlightSteps,
    which: Indices,
    kind: Kind,
    inputs: tuple[Array, Array],
    seen: tuple[TipMotion, Indices, Array],
) -> None:
    """Search the polynomials of some steps for the first touch, and put what is found into them."""
    (starts, numbers), (tip, launches, times) = inputs, seen
    state, full = made.state[..., which], made.full[which]
    gap, *faces = made.guards[..., which]
    opened = np.array(divided(list(gap), starts[VANISHING, which], PLAIN))
    for _ in range(len(gap)):  # What vanishes beyond is divided out, too; a gap that stays zero is.
        zero = opened[0] == 0.0
        if not zero.any():
            break
        opened[:-1, zero], opened[-1, zero] = opened[1:, zero], 0.0
    falls = [Polynomials(terms, full).first_fall() for terms in (opened, *faces)]
    fall = np.where(opened[0] > 0.0, np.fmin.reduce(falls), 0.0)
    touches = ~np.isnan(fall)
    span = np.where(touches, fall, full)
    made.touches[which], made.span[which] = touches, span
    made.after[:, which] = [horner(terms, span) for terms in state]
    made.highest[which] = -Polynomials(-state[9], span).refined_least()[1]
    if is_edge(kind.example.surface):
        flight = Flight(kind.top(tuple(numbers[:, which])))
        terms = np.moveaxis(state, -1, 0) * span[:, None, None] ** np.arange(state.shape[1])
        made.highest_gap[which] = highest_gaps_of(flight, terms, span)
    else:
        made.highest_gap[which] = -Polynomials(-gap, span).refined_least()[1]
    tip.see(launches, times, Polynomials(state[2], span))
    made.floor[which] = made.ceiling[which] = np.nan


def slides(state: State, top: Top) -> Flags:
    """Return whether tops in contact, whose contact point is at rest vertically, go on sliding."""
    touch = sliding_contact(*along_table(state), branched(top, state))
    flags: Flags = (touch.delassus > 0.0) & (touch.free_acceleration < 0.0)
    return flags


def rolls(state: State, top: Top) -> Flags:
    """Return whether tops in contact roll on for a while, or nothing resists that."""
    count = np.ones(len(np.atleast_1d(state.height)), dtype=bool)
    if not top.resists_rolling:
        return count
    y, top = along_table(state), branched(top, state)
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
    y, top = along_table(state), branched(top, state)
    lasting = ContactMode(top).contacts(y.pack()).slip_left() > 0.0
    flags: Flags = count & is_slipping(*y, top) & lasting
    return flags & ~is_near(y, top) if far else flags
