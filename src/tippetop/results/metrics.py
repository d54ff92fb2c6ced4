"""Each number of a launch, defined once: for one launch and for arrays of them.

A number is an event or an extreme of the motion itself, never of its samples. `Ends` is what an
executor finds on its way, in natural units; `metrics` makes every number of
`tippetop.results.catalogue.METRICS` of it.
"""

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tippetop.contact.flights import Flights
from tippetop.contact.lowest_surface import highest_between, lowest_jellett
from tippetop.contact.mode import Event, EventKind, Outcome
from tippetop.integrators.base import Array
from tippetop.integrators.polynomials import Polynomials
from tippetop.mechanics.invariants import energy
from tippetop.mechanics.motion import axial_spin
from tippetop.mechanics.state import State
from tippetop.mechanics.surfaces.hull import outer_height
from tippetop.mechanics.top import Top
from tippetop.mechanics.units import Units
from tippetop.mechanics.vectors import Scalar, length
from tippetop.mechanics.view import axis_sine, precession_rate
from tippetop.results.catalogue import LEANS_AT_LAUNCH, NEAR_FINAL, NEAR_POLE, RISE, Ending
from tippetop.results.settling import is_barred, tilt

OUTCOMES = tuple(Outcome)
"""How a launch can end, by number."""

Flags = NDArray[np.bool_]


@dataclass
class Ends:
    """What was found of launches, in natural units: all of shape (n,), or numbers of one."""

    state: State
    """The states at the end."""
    time: Scalar
    """When that was."""
    outcome: Scalar
    """Numbers of `OUTCOMES`."""
    steps: Scalar
    flights: Scalar
    """Steps taken, and flights made."""
    least_force: Scalar
    """Least normal force; 0 where the top left the table."""
    lift_off: Scalar
    """First time the table let go; nan if it never did."""
    struck: Scalar
    drilled: Scalar
    rolled: Scalar
    """Energy lost in impacts, to drilling and to rolling."""
    airborne: Scalar
    highest_gap: Scalar
    highest: Scalar
    """Time spent in the air, and there the largest gap and the largest height of the centre of
    mass.
    """
    down: Scalar
    up: Scalar
    """Least and largest n_z."""
    turned: Scalar
    """First time n_z fell through 0; nan if it never did."""
    settled: Scalar
    """Tilt near which the motion stays for good; nan if it may move (see
    `tippetop.results.settling`).
    """
    arrived: Scalar
    """First time n_z was in the band of `settled_band`; nan if it never was."""
    rolls: Scalar
    """1 where it rolls without slip and without loss at the end, else 0."""

    # translate: skip
    @classmethod
    def unknown(cls, count: int) -> "Ends":
        """Ends that nothing is known of yet."""
        unknown: dict[str, Any] = {field.name: np.full(count, np.nan) for field in fields(cls)}
        none = {
            name: np.zeros(count)
            for name in (
                *("struck", "drilled", "rolled", "airborne", "highest_gap", "highest"),
                "rolls",
            )
        }
        counts = {name: np.zeros(count, dtype=np.int64) for name in ("steps", "flights")}
        outcome = np.full(count, OUTCOMES.index(Outcome.FAILED), dtype=np.int8)
        state = State.unpack([np.full(count, np.nan) for _ in range(10)])
        return cls(**{**unknown, **none, **counts, "outcome": outcome, "state": state})

    @classmethod
    def of_one(
        cls,
        state: State,
        time: float,
        outcome: int,
        events: Sequence[Event],
        flights: Flights,
        steps: int,
        resisted: tuple[float, float],
        least: Sequence[float],
        settling: tuple[float, float, float],
        rolls: float,
    ) -> "Ends":
        """The ends of one launch.

        `resisted` has the energy lost to drilling and to rolling; `least`, the least values of the
        normal force, n_z, -n_z and, in flights, the negative height; `settling`, the numbers
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
            outcome,
            steps,
            count,
            *pressed,
            struck,
            *resisted,
            *aloft,
            down,
            -up,
            *settling,
            rolls,
        )

    # translate: skip
    def put(self, where: NDArray[np.intp], found: "Ends") -> None:
        """Put what was found of some launches in its places."""
        for field in fields(self):
            mine, theirs = getattr(self, field.name), getattr(found, field.name)
            if field.name == "state":
                for kept, number in zip(mine.pack(), theirs.pack(), strict=True):
                    kept[where] = number
            else:
                mine[where] = theirs


# translate: skip
def turning_time(tip: Polynomials) -> Array:
    """First times at which n_z falls through 0 from above, nan where it does not, shape (n,).

    A top that starts beyond a right angle turns over when it passes it from below.
    """
    return tip.first_fall(from_above=True)


# translate: skip
def arrival_time(tip: Polynomials, low: Scalar, high: Scalar) -> Array:
    """First times at which n_z is between `low` and `high`, shape (n,); nan where it is not."""
    start = tip.unit[0]
    above, below = start > high, start < low
    # From above n_z falls to the upper end, from below its negative to that of the lower.
    sign, shift = np.where(above, 1.0, -1.0), np.where(above, -high, low)
    falls = tip.some(np.arange(len(tip.span)), sign, shift).first_fall()
    found: Array = np.where(above | below, falls, 0.0)
    return found


# translate: skip
def last_outside(tip: Polynomials, low: Scalar, high: Scalar) -> Array:
    """Last times at which n_z is not between `low` and `high`, shape (n,); nan where it always
    is.
    """
    last, back = tip.values[-1], tip.backward()
    every = np.arange(len(tip.span))
    exits = [back.some(every, sign, at).first_fall() for sign, at in ((-1.0, high), (1.0, -low))]
    within = tip.span - np.fmin(*exits)
    found: Array = np.where((last > high) | (last < low), tip.span, within)
    return found


def settled_band(settled: Scalar) -> tuple[Scalar, Scalar]:
    """Return the least and the largest n_z near tilts at which motions settle, each of shape (n,);
    nan where they do not.

    A band about a pole is open there: rounding takes n_z beyond 1.
    """
    low = np.where(settled + NEAR_FINAL < np.pi, np.cos(settled + NEAR_FINAL), -OPEN)
    high = np.where(settled - NEAR_FINAL > 0.0, np.cos(settled - NEAR_FINAL), OPEN)
    known = settled == settled
    return np.where(known, low, np.nan), np.where(known, high, np.nan)


OPEN = 2.0
"""A number that n_z never reaches."""


def metrics(ends: Ends, start: State, top: Top, units: Units) -> dict[str, NDArray[Any]]:
    """Every number of `tippetop.results.catalogue.METRICS` in SI, by name, each of shape (n,).

    `start` has the states at launch in natural units, every number of shape (n,); `top` and
    `units`, the tops in natural units and those units, have numbers, or arrays of shape (n,).
    """
    end = ends.state
    with np.errstate(all="ignore"):
        moment = length(start.momentum) * outer_height(top.surface, start.axis[2])
        change = np.abs(lowest_jellett(end, top) - lowest_jellett(start, top))
        drift = change / np.where(moment > 0, moment, np.nan)
        lost = energy(start, top) - energy(end, top)
        precession = np.where(
            axis_sine(end.axis) > 0, precession_rate(end.axis, end.momentum, top), np.nan
        )
        highest = np.fmax(highest_between(top.surface, ends.down, ends.up), ends.highest)
        risen = highest_seen(ends)
        over = is_barred(end, top, outer_height(top.surface, ends.down), risen)
        highest_tilt = np.where(over, risen, np.maximum(ends.settled, risen))
    return {
        "final_theta": tilt(end),
        "final_omega3": axial_spin(end.axis, end.momentum, top) / units.time,
        "final_phi_dot": precession / units.time,
        "is_settled": np.where(ends.settled == ends.settled, 1, 0),
        "turns_over": ends.turned * units.time,
        "arrives": ends.arrived * units.time,
        "highest_tilt": highest_tilt,
        "least_normal_force": ends.least_force * units.force,
        "first_lift_off": ends.lift_off * units.time,
        "flights": ends.flights,
        "airborne_time": ends.airborne * units.time,
        "energy_lost": lost * units.energy,
        "energy_lost_sliding": (lost - ends.struck - ends.drilled - ends.rolled) * units.energy,
        "energy_lost_drilling": ends.drilled * units.energy,
        "energy_lost_rolling": ends.rolled * units.energy,
        "highest": highest * units.length,
        "highest_gap": ends.highest_gap * units.length,
        "jellett_error": drift,
        "end_time": ends.time * units.time,
        "steps": ends.steps,
    }


def highest_seen(ends: Ends) -> Array:
    """Return the largest tilts that were met on the way, rad."""
    sine = np.sqrt(np.maximum(1.0 - ends.down**2, 0.0))
    found: Array = np.arctan2(sine, ends.down)
    return found


# translate: skip
def ending(ends: Ends, start: State) -> NDArray[np.int8]:
    """Return numbers of `tippetop.results.catalogue.Ending`, shape (n,), given the states at
    launch.
    """
    final, risen = tilt(ends.state), highest_seen(ends)
    near = [final <= NEAR_POLE, final >= np.pi - NEAR_POLE]
    settled = np.isfinite(ends.settled)
    found = np.where(
        settled,
        np.select(near, [Ending.UPRIGHT, Ending.INVERTED], Ending.TILTED),
        np.select(near, [Ending.MOVING_UPRIGHT, Ending.MOVING_INVERTED], Ending.MOVING_TILTED),
    )
    found[~settled & (np.asarray(ends.rolls) > 0.0)] = Ending.ROLLING
    for number, outcome in enumerate(OUTCOMES):
        if outcome is not Outcome.COMPLETED:
            found[ends.outcome == number] = getattr(Ending, outcome.name, Ending.FAILED)
    came_down = risen - np.maximum(final, tilt(start)) > RISE
    below = np.isfinite(ends.turned) & (tilt(start) < LEANS_AT_LAUNCH) & (final < 0.5 * np.pi)
    known = ~np.isin(found, [Ending.FAILED, Ending.INACCURATE, Ending.LIFTED_OFF])
    found[known & came_down & (below | settled)] = Ending.FELL_BACK
    return found.astype(np.int8)
