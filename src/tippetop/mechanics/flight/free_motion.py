"""Free motion of a body of revolution, and the gap between it and the table."""

# translate module: numbers

from tippetop.mechanics.motion import along_table, axis_rate, on_table, outer_forces_in
from tippetop.mechanics.state import State
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Scalar, add, scale


def free_rates(state: State, top: Top) -> State:
    """Return the rates of change of a state that no table touches, its numbers' units per s.

    The angular momentum is constant without air, the axis turns about it, and the centre of mass
    falls.
    """
    turning = axis_rate(state.axis, state.momentum, top)
    couple, falling = (0.0, 0.0, 0.0), (0.0, 0.0, -top.gravity)
    outer = outer_forces_in(state.axis, state.momentum, state.velocity, top)
    if outer is not None:
        couple, falling = outer.couple, add(falling, scale(1.0 / top.mass, outer.force))
    return State(turning, couple, falling, state.velocity[2])


def gap(state: State, top: Top) -> Scalar:
    """Height of the lowest point of the body above the table, z - h(n_z), m."""
    return state.height - on_table(along_table(state), top).height


def gap_rate(state: State, top: Top) -> Scalar:
    """Rate of change of the gap, m/s: the vertical velocity of the body's lowest point."""
    return state.velocity[2] - on_table(along_table(state), top).velocity[2]
