"""Free motion of a body of revolution, and the gap between it and the table."""

# translate module: numbers

from tippetop.mechanics.motion import along_table, axis_rate, on_table
from tippetop.mechanics.state import State
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Scalar


def free_rates(state: State, top: Top) -> State:
    """Return the rates of change of a state that no table touches, its numbers' units per s.

    The angular momentum is constant, the axis turns about it, and the centre of mass falls.
    """
    turning = axis_rate(state.axis, state.momentum, top)
    return State(turning, (0.0, 0.0, 0.0), (0.0, 0.0, -top.gravity), state.velocity[2])


def gap(state: State, top: Top) -> Scalar:
    """Height of the lowest point of the body above the table, z - h(n_z), m."""
    return state.height - on_table(along_table(state), top).height


def gap_rate(state: State, top: Top) -> Scalar:
    """Rate of change of the gap, m/s: the vertical velocity of the body's lowest point."""
    return state.velocity[2] - on_table(along_table(state), top).velocity[2]
