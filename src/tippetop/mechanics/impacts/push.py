"""A push of the body by a hand: an impulse at a point of its axis."""

from tippetop.mechanics.state import State
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Scalar, Vector, add, cross, scale


def pushed_state(state: State, impulse: Vector, distance: Scalar, top: Top) -> State:
    """Return a state after an impulse, N s, on a point of the axis.

    The point is at a distance, m, from the centre of mass, in the direction of the axis. The
    impulse of the table, if it answers, is not included: the contact begins with the velocities
    that this state has.
    """
    gained = scale(1.0 / top.mass, impulse)
    return state._replace(
        momentum=add(state.momentum, cross(scale(distance, state.axis), impulse)),
        velocity=add(state.velocity, gained),
    )
