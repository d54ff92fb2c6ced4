"""Free flight in closed form, and the landing of a body that is followed by the mode of flights.

In flight the angular momentum L is constant, the axis n turns about it at the constant rate w = L /
I1, and the centre of mass falls (Landau and Lifshitz, Mechanics, sections 33 and 35).
"""

import math

import numpy as np

from tippetop.contact.flight import Flight, Start
from tippetop.integrators import make_integrator
from tippetop.mechanics.motion import axis_rate
from tippetop.mechanics.state import State
from tippetop.mechanics.top import natural, natural_state, natural_units
from tippetop.mechanics.vectors import add, length, scale
from tippetop.results.highest_gaps import highest_gaps_of

SMALL = 1e-100
"""Added to an angle that is about to divide: changes nothing but 0 / 0."""


def fly(state, elapsed, top, functions):
    """Return the state after a time of free flight: a number, or an array of them.

    A number y of the axis obeys y''' = -w^2 y', and in a time t gains sin(w t) / w times y' and
    (1 - cos(w t)) / w^2 times y''; `functions` is where sin and cos come from.
    """
    turning = axis_rate(state.axis, state.momentum, top)
    bending = axis_rate(turning, state.momentum, top)
    half = 0.5 * elapsed * length(state.momentum) / top.transverse_inertia + SMALL
    chord = elapsed * functions.sin(half) / half
    sine, versine = chord * functions.cos(half), 0.5 * chord * chord
    x, y, z = state.velocity
    return State(
        axis=add(state.axis, add(scale(sine, turning), scale(versine, bending))),
        momentum=add(state.momentum, scale(elapsed, (0.0, 0.0, 0.0))),
        velocity=(x + 0.0 * elapsed, y + 0.0 * elapsed, z - elapsed * top.gravity),
        height=state.height + elapsed * (z - 0.5 * elapsed * top.gravity),
    )


def segments_of(state, top, horizon, start=Start.AIRBORNE):
    """Return the segments of a flight that lasts for a horizon, s, at most, and its units."""
    units = natural_units(top)
    flight = Flight(natural(top), start)
    method = make_integrator(None)
    begin = natural_state(state, units)
    return list(flight.segments(0.0, begin, horizon / units.time, method)), units


def landing(state, top, horizon=math.inf, start=Start.AIRBORNE):
    """Return when a body in flight first touches the table, s; None if not within a horizon."""
    segments, units = segments_of(state, top, min(horizon, fall_time(state, top)), start)
    last = segments[-1]
    assert last.mode_end is not None
    return last.end_time * units.time if last.mode_end.cause == "landing" else None


def highest_gap(state, top, duration, start=Start.AIRBORNE):
    """Return the highest gap of a flight within a time, m."""
    segments, units = segments_of(state, top, duration, start)
    gaps = [
        highest_gaps_of(one.mode, one.solution.terms, np.diff(one.solution.knots))
        for one in segments
    ]
    return float(np.concatenate(gaps).max(initial=0.0)) * units.length


def fall_time(state, top):
    """Return the time after which the centre of mass is too low for any body not to touch, s."""
    depth = 3.0 * top.surface.size + abs(state.height)
    rise = state.velocity[2]
    return (rise + (rise * rise + 2.0 * top.gravity * (state.height + depth)) ** 0.5) / top.gravity
