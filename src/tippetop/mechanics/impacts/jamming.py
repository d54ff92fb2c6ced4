"""Friction that turns and comes to press the contact, which it jams, and what an impulse does
then.
"""

import math

from tippetop.mechanics.contacts.contact_point import ContactPoint
from tippetop.mechanics.contacts.forces import sticking_constraints, sum_at
from tippetop.mechanics.contacts.slip_variables import plus, scaled, size, slip_of
from tippetop.mechanics.contacts.system import (
    Component,
    Constraint,
    ContactRates,
    solve_constraints,
)
from tippetop.mechanics.impacts.struck_body import struck_state
from tippetop.mechanics.invariants import energy
from tippetop.mechanics.motion import (
    along_table,
    moment_per_normal_force,
    on_table,
    sliding_contact,
)
from tippetop.mechanics.state import SlidingState, State
from tippetop.mechanics.top import Top
from tippetop.mechanics.unsolved import Unsolved
from tippetop.mechanics.vectors import VERTICAL, add, scale

PROBED = 1e-6
"""Part of the slip that an impulse takes or turns that tells how the Delassus number changes with
it.
"""

NEARLY_JAMMED = 1e-3
"""Delassus number times mass of a slipping contact, below which its normal force leaves no step to
take.
"""

PAST = 1e-7
"""How far the Delassus number times mass is below zero at least where the contact is past the jam,
which rounding does not decide.
"""


def past_jamming(state: State, top: Top) -> tuple[State, float, float] | None:
    """Return the state past the normal impulse during which friction jams the contact.

    There the Delassus number A of the slipping contact falls through zero, linearly with the
    impulse: from A0 > 0 the impulse 2 A0 / |dA/dp| leads to -A0, and the normal velocity of its two
    halves cancels. Where A0 is nearly zero, a step to -`PAST` leaves a normal velocity of the order
    of `PAST` squared.

    Parameters
    ----------
    state
        The state before, floats, in which a contact that slips is about to jam.
    top
        The body and the friction law.

    Returns
    -------
    tuple or None
        The state after, the normal impulse, N s, and the energy that went with it, J. None if that
        number is not next to zero, or does not fall as the impulse grows and the force does.

    Raises
    ------
    Unsolved
        If the motion alone has led to where it is zero, and the acceleration without a contact
        force with it, so that the force is finite: the singular point of Genot and Brogliato
        (1999), past which motions as near as one likes lift off, or are struck (Nordmark, Varkonyi
        and Champneys 2018).
    ArithmeticError
        If a number on the way to it is too large.
    """
    sliding = along_table(state)
    touch = sliding_contact(*sliding, top)
    if not abs(touch.delassus) < NEARLY_JAMMED / top.mass:
        return None
    force, moment = touch.traction.force, moment_per_normal_force(touch.arm, touch.traction)

    def after(impulse: float) -> SlidingState:
        x, y = plus(sliding.velocity, scaled(impulse / top.mass, force))
        return SlidingState(sliding.axis, add(sliding.momentum, scale(impulse, moment)), (x, y))

    before = slip_of(*sliding, top)
    stopping_impulse = size(before) / math.dist(slip_of(*after(1.0), top), before)
    fall = touch.delassus - sliding_contact(*after(PROBED * stopping_impulse), top).delassus
    if not fall > 0.0:
        if not abs(touch.free_acceleration) < NEARLY_JAMMED * top.gravity:
            return None
        raise Unsolved(
            "it would open there too, and whether it does or is struck rigid bodies do not tell"
        )
    further = touch.delassus + max(touch.delassus, PAST / top.mass)
    impulse = max(further, 0.0) / fall * PROBED * stopping_impulse
    beyond = on_table(after(impulse), top)
    return beyond, float(impulse), float(energy(state, top) - energy(beyond, top))


def stuck_at_once(state: State, top: Top) -> State:
    """Return the state after the impulse that ends slip, and drilling if the law resists it,
    without opening.
    """
    point, (x, y, *_) = (
        ContactPoint.of(state.axis, state.momentum, top),
        slip_of(*along_table(state), top),
    )
    points, velocities = (point,), ContactRates(((x, y, 0.0),), point.turning)
    closed = Constraint.of(Component(0, VERTICAL))
    held = [*sticking_constraints(points, [True]), closed]
    impulse = sum_at(0, solve_constraints(points, held, velocities).wrenches)
    return struck_state(state, point, impulse)
