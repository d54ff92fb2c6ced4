"""Which surfaces of a body touch the table beside the active one, and whether they stay closed."""

import math
from collections.abc import Sequence

from tippetop.contact.flight import TOUCHING
from tippetop.mechanics.contacts.contact_point import ContactPoint, contact_points
from tippetop.mechanics.contacts.forces import forces_and_accelerations, is_set_valued
from tippetop.mechanics.contacts.pair import Tops
from tippetop.mechanics.contacts.slip_variables import has_ended, slip_of
from tippetop.mechanics.contacts.system import free_rates, rates_under
from tippetop.mechanics.contacts.wrench import Wrench
from tippetop.mechanics.flight.free_motion import gap, gap_rate
from tippetop.mechanics.motion import along_table
from tippetop.mechanics.state import State
from tippetop.mechanics.surfaces.surface import support_at
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Vector

SLOWEST_ROCKING = 1e-7
"""Velocity, in units of sqrt(g R), below which rocking between two surfaces has come to its end.

Infinitely many impacts, now of one and now of the other, bring both to touch at once in a finite
time. Where a gap falls back with more than g, this is faster as the square root: rebounds stay out
of reach of rounding.
"""


SAME_POINT = 1e-6
"""Distance between the points of two surfaces, in sizes, up to which they touch as one contact. Two
that touch at the pole are as far apart where their gaps differ by the square, the gap up to which a
surface touches.
"""


def other_touching(top: Top, state: State) -> list[Top]:
    """Return the top with each other surface active that touches, the fastest sinking first.

    One that touches at the point of the active surface is no contact of its own.
    """
    place, nearest = _place(top, state), SAME_POINT * top.surface.size
    others = [
        each
        for each in top.body.contacts
        if each.number != top.number
        and gap(state, each) <= TOUCHING
        and abs(_place(each, state) - place) > nearest
    ]
    return sorted(others, key=lambda each: float(gap_rate(state, each)))


def _place(top: Top, state: State) -> float:
    """Return how far the active surface touches from under the centre of mass, along the axis."""
    return float(support_at(state.axis, top.surface)[1]) * math.hypot(*state.axis[:2])


def farthest_touching(top: Top, state: State) -> Top | None:
    """Return the top with that other surface active which touches farthest from the active one.

    None if no other touches. What lies between two that touch has no force (see `outermost`).
    """
    place = _place(top, state)
    others = other_touching(top, state)
    return max(others, key=lambda each: abs(_place(each, state) - place)) if others else None


def stays_closed(top: Top, beside: Top, state: State) -> bool:
    """Return whether another touching surface stays closed.

    It does if its gap rate is below that of rocking that has come to its end, `SLOWEST_ROCKING`, or
    too small to lift it out of the table, into which it reaches by at most the tolerance of
    touching.
    """
    back, depth = 1.0, max(0.0, float(gap(state, top) - gap(state, beside)))
    if _both_slip(top, beside, state):
        point = ContactPoint.of(state.axis, state.momentum, top, state.velocity[:2])
        slip = slip_of(*along_table(state), top)
        wrench = forces_and_accelerations(point, slip, point.turning[:2])[0]
        back = float(abs(gap_acceleration(top, beside, state, wrench)))
    slowest = max(SLOWEST_ROCKING * max(1.0, back) ** 0.5, (2.0 * back * depth) ** 0.5)
    return bool(gap_rate(state, beside) <= slowest)


def gap_acceleration(top: Top, beside: Top, state: State, wrench: Wrench) -> float:
    """Return the acceleration of another surface's gap under a wrench at the active one."""
    pair = contact_points(state.axis, state.momentum, (top, beside), state.velocity[:2])
    return float(rates_under(pair, [(0, wrench)], free_rates(pair)).points[1][2])


def _both_slip(top: Top, beside: Top, state: State) -> bool:
    """Return whether both contacts slip, by more than rounding, if slip can end."""
    if not is_set_valued(top.friction):
        return True
    return not any(has_ended(*along_table(state), one) for one in (top, beside))


def outermost(touching: Sequence[Top], axis: Vector) -> Tops:
    """Return the two of some tops that touch farthest apart, in their order.

    A surface touches at -h' s along e. What lies between them touches without force: all contact
    points are in a line, on which a rigid body rests on two. How three would share its weight is
    not determined by the equations of a rigid body, but where it slides and turns at once.
    """
    places = [float(support_at(axis, top.surface)[1]) for top in touching]
    first, second = sorted((places.index(min(places)), places.index(max(places))))
    return touching[first], touching[second]
