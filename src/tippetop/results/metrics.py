"""Metrics of launches, each defined once for one launch and for arrays of launches.

A metric is an event or an extreme of the motion itself, never of its samples. An executor collects
`Ends` in natural units; `metrics` computes all of `tippetop.results.catalogue.METRICS` from them.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tippetop.contact.flights import Flights
from tippetop.contact.lowest_surface import highest_between, lowest_jellett
from tippetop.contact.mode import Event, EventKind, Status
from tippetop.integrators.base import Array
from tippetop.integrators.polynomials import Polynomials
from tippetop.mechanics.invariants import energy
from tippetop.mechanics.motion import axial_spin
from tippetop.mechanics.natural_units import Units
from tippetop.mechanics.state import State
from tippetop.mechanics.surfaces.hull import outer_height
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Scalar, length
from tippetop.mechanics.view import axis_sine, precession_rate
from tippetop.results.catalogue import LEANS_AT_LAUNCH, NEAR_FINAL, NEAR_POLE, RISE, Outcome
from tippetop.results.settling import is_barred, tilt
from tippetop.results.sums import RunSums

STATUSES = tuple(Status)
"""Statuses by number."""

Flags = NDArray[np.bool_]


@dataclass
class Ends:
    """Ends of n launches and what led to them, in natural units: shape (n,), or numbers of one.

    `tippetop.results.accumulation` says how each follows from those of the parts of a run.
    """

    state: State
    """States at the end."""
    time: Scalar
    """Times of the end."""
    status: Scalar
    """Numbers of `STATUSES`."""
    steps: Scalar
    flights: Scalar
    """Steps taken, and flights made."""
    least_force: Scalar
    """Least normal force; 0 where the top left the table."""
    lift_off: Scalar
    """Time of the first lift-off; nan without one."""
    struck: Scalar
    drilled: Scalar
    rolled: Scalar
    braked: Scalar
    """Energy lost in impacts, to drilling, to rolling and to air."""
    descended: Scalar
    """Work of gravity along the table."""
    airborne: Scalar
    highest_gap: Scalar
    highest: Scalar
    """Time in the air, and the largest gap and height of the centre of mass in flights."""
    down: Scalar
    up: Scalar
    """Least and largest n_z."""
    turned: Scalar
    """First time at which n_z fell through 0; nan if it never did."""
    settled: Scalar
    """Tilt near which the motion stays for ever; nan if it may leave it (see
    `tippetop.results.settling`).
    """
    arrived: Scalar
    """First time at which n_z was in the band of `settled_band`; nan if it never was."""
    rolls: Scalar
    """1 if the top rolls without slip and without loss at the end, else 0."""

    @classmethod
    def of_one(
        cls,
        state: State,
        time: float,
        status: int,
        events: Sequence[Event],
        flights: Flights,
        steps: int,
        sums: RunSums,
        descended: Scalar,
        least: Sequence[float],
        settling: tuple[float, float, float],
        rolls: float,
    ) -> "Ends":
        """Return the ends of one launch.

        `descended` is the work of gravity along the table. `least` holds the least values of the
        normal force, n_z, -n_z and, in flights, the negative height, and `settling` the numbers
        `turned`, `settled` and `arrived`.
        """
        lift_offs = [event.time for event in events if event.kind is EventKind.LIFT_OFF]
        struck, count = sum([event.energy_lost for event in events]), len(flights.rows)
        force, down, up, depth = least
        pressed = 0.0 if lift_offs or count else force, min(lift_offs, default=np.nan)
        aloft = flights.duration, flights.highest_gap, max(-depth, 0.0)
        return cls(
            state,
            time,
            status,
            steps,
            count,
            *pressed,
            struck,
            *sums.losses,
            descended,
            *aloft,
            down,
            -up,
            *settling,
            rolls,
        )


# translate: skip
def turning_time(tip: Polynomials) -> Array:
    """Return the first times at which n_z falls through 0, shape (n,); nan where it does not.

    A top that starts beyond a right angle must first return below it.
    """
    return tip.first_fall(from_above=True)


# translate: skip
def arrival_time(tip: Polynomials, low: Scalar, high: Scalar) -> Array:
    """Return the first times at which n_z is between `low` and `high`, shape (n,), or nan."""
    start = tip.unit[0]
    above, below = start > high, start < low
    # From above, n_z falls to the upper bound; from below, -n_z falls to minus the lower bound.
    sign, shift = np.where(above, 1.0, -1.0), np.where(above, -high, low)
    falls = tip.some(np.arange(len(tip.span)), sign, shift).first_fall()
    times: Array = np.where(above | below, falls, 0.0)
    return times


# translate: skip
def last_outside(tip: Polynomials, low: Scalar, high: Scalar) -> Array:
    """Return the last times at which n_z is not between `low` and `high`, shape (n,), or nan."""
    last, back = tip.values[-1], tip.backward()
    every = np.arange(len(tip.span))
    exits = [back.some(every, sign, at).first_fall() for sign, at in ((-1.0, high), (1.0, -low))]
    within = tip.span - np.fmin(*exits)
    times: Array = np.where((last > high) | (last < low), tip.span, within)
    return times


def settled_band(settled: Scalar) -> tuple[Scalar, Scalar]:
    """Return the bounds of n_z near the tilts at which motions settle, shape (n,), or nan.

    A band about a pole has no bound there, because rounding can make n_z larger than 1.
    """
    low = np.where(settled + NEAR_FINAL < np.pi, np.cos(settled + NEAR_FINAL), -OPEN)
    high = np.where(settled - NEAR_FINAL > 0.0, np.cos(settled - NEAR_FINAL), OPEN)
    settles = settled == settled
    return np.where(settles, low, np.nan), np.where(settles, high, np.nan)


OPEN = 2.0
"""Bound of n_z that is never reached."""


def metrics(ends: Ends, start: State, top: Top, units: Units) -> dict[str, NDArray[Any]]:
    """Return all of `tippetop.results.catalogue.METRICS` in SI, by name, each of shape (n,).

    `start` has the states at launch in natural units, shape (n,). `top` has the tops in natural
    units and `units` these units; their numbers may have shape (n,) too.
    """
    end = ends.state
    with np.errstate(all="ignore"):
        moment = length(start.momentum) * outer_height(top.surface, start.axis[2])
        change = np.abs(lowest_jellett(end, top) - lowest_jellett(start, top))
        drift = change / np.where(moment > 0, moment, np.nan)
        lost = energy(start, top) - energy(end, top) + ends.descended
        sliding = lost - ends.struck - ends.drilled - ends.rolled - ends.braked
        precession = np.where(
            axis_sine(end.axis) > 0, precession_rate(end.axis, end.momentum, top), np.nan
        )
        highest = np.fmax(highest_between(top.surface, ends.down, ends.up), ends.highest)
        risen = highest_seen(ends)
        over = is_barred(end, top, outer_height(top.surface, ends.down), risen)
        max_tilt_ever = np.where(over, risen, np.maximum(ends.settled, risen))
    return {
        "final_tilt": tilt(end),
        "final_spin": axial_spin(end.axis, end.momentum, top) / units.time,
        "final_precession": precession / units.time,
        "is_settled": ends.settled == ends.settled,
        "turnover_time": _turned_over(ends) * units.time,
        "arrival_time": ends.arrived * units.time,
        "max_tilt_ever": max_tilt_ever,
        "min_normal_force": ends.least_force * units.force,
        "liftoff_time": ends.lift_off * units.time,
        "flights": ends.flights,
        "airborne_time": ends.airborne * units.time,
        "energy_lost": lost * units.energy,
        "energy_lost_sliding": sliding * units.energy,
        "energy_lost_drilling": ends.drilled * units.energy,
        "energy_lost_rolling": ends.rolled * units.energy,
        "energy_lost_air": ends.braked * units.energy,
        "descent": _descent(ends, top) * units.length,
        "max_height": highest * units.length,
        "max_gap": ends.highest_gap * units.length,
        "jellett_change": drift,
        "end_time": ends.time * units.time,
        "steps": ends.steps,
    }


def _descent(ends: Ends, top: Top) -> Array:
    """Return how far the centres of mass moved down the slope, in natural units; 0 on the level."""
    if top.field is None or top.field.slope is None:
        level: Array = 0.0 * ends.time
        return level
    along, across = top.field.slope
    pull = top.mass * np.sqrt(along * along + across * across)
    distances: Array = ends.descended / np.where(pull > 0.0, pull, np.inf)
    return distances


PAST_LEVEL = 1e-6
"""Tilt beyond a right angle, rad, from which a top has turned over. A body that strikes the table
with both ends when its axis is level, such as two equal balls, passes the level only by rounding
(1e-10 rad); what turns over goes on by far more.
"""


def _turned_over(ends: Ends) -> Array:
    """Return the times of turning over; nan if n_z only touched 0 and the run went on."""
    at_the_end = np.where(ends.turned >= ends.time, ends.turned, np.nan)
    times: Array = np.where(ends.down < -PAST_LEVEL, ends.turned, at_the_end)
    return times


def highest_seen(ends: Ends) -> Array:
    """Return the largest tilts of the launches, rad."""
    sine = np.sqrt(np.maximum(1.0 - ends.down**2, 0.0))
    tilts: Array = np.arctan2(sine, ends.down)
    return tilts


def came_down(
    final: Scalar, highest: Scalar, launched: Scalar, has_turned: Scalar, is_settled: Scalar
) -> Scalar:
    """Return whether launches rose and fell back, see `Outcome.FELL_BACK`; of numbers or arrays.

    Parameters
    ----------
    final, highest, launched
        Tilts at the end, at most and at launch, rad.
    has_turned, is_settled
        Whether the top turned over, and whether its tilt is settled at the end.
    """
    risen = (highest - final > RISE) & (highest - launched > RISE)
    below = has_turned & (launched < LEANS_AT_LAUNCH) & (final < 0.5 * np.pi)
    return risen & (below | is_settled)


# translate: skip
def outcomes_of(ends: Ends, start: State) -> NDArray[np.int8]:
    """Return what became of launches, as numbers of `tippetop.results.catalogue.Outcome`.

    `start` has the states at launch; the result has shape (n,).
    """
    final, risen = tilt(ends.state), highest_seen(ends)
    near = [final <= NEAR_POLE, final >= np.pi - NEAR_POLE]
    settled = np.isfinite(ends.settled)
    outcomes = np.where(
        settled,
        np.select(near, [Outcome.UPRIGHT, Outcome.INVERTED], Outcome.TILTED),
        np.select(near, [Outcome.MOVING_UPRIGHT, Outcome.MOVING_INVERTED], Outcome.MOVING_TILTED),
    )
    outcomes[~settled & (np.asarray(ends.rolls) > 0.0)] = Outcome.ROLLING
    for number, status in enumerate(STATUSES):
        if status not in (Status.COMPLETED, Status.STOPPED):
            outcomes[ends.status == number] = getattr(Outcome, status.name, Outcome.FAILED)
    has_turned = np.isfinite(_turned_over(ends))
    fell = came_down(final, risen, tilt(start), has_turned, settled)
    is_followed = ~np.isin(outcomes, [Outcome.FAILED, Outcome.INACCURATE, Outcome.LIFTED_OFF])
    outcomes[is_followed & fell] = Outcome.FELL_BACK
    return outcomes.astype(np.int8)
