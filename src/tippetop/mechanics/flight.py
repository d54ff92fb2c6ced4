"""Free flight of a body of revolution in closed form.

In flight the angular momentum L is constant, the axis n turns about it at the constant rate L / I1, and the
centre of mass falls (Landau and Lifshitz, Mechanics, sections 33 and 35).
"""

from tippetop.mechanics.motion import along_table, on_table
from tippetop.mechanics.state import State
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Functions, Scalar, Vector, add, cross, length, scale

SMALL = 1e-100
"""Added to a rate or an angle that is about to divide: changes nothing but 0 / 0."""


def fly(state: State, elapsed: Scalar, top: Top, functions: Functions) -> State:
    """The state after a time of free flight.

    Parameters
    ----------
    state
        The state at the start.
    elapsed
        Time since then, s: a number, or an array of them, whose shape every number of the result then has.
    top
        The body and gravity.
    functions
        Where sin and cos come from: `math`, `numpy`, ...
    """
    precession = scale(1.0 / top.transverse_inertia, state.momentum)
    still = (0.0 * elapsed, 0.0 * elapsed, 0.0 * elapsed)
    falling = (0.0 * elapsed, 0.0 * elapsed, -top.gravity * elapsed)
    return State(
        axis=turned(state.axis, precession, elapsed, functions),
        momentum=add(state.momentum, still),
        velocity=add(state.velocity, falling),
        height=state.height + elapsed * (state.velocity[2] + 0.5 * falling[2]),
    )


def turned(vector: Vector, rate: Vector, elapsed: Scalar, functions: Functions) -> Vector:
    """A vector after turning for a time with a constant angular velocity (rad/s), which may be zero."""
    half = 0.5 * elapsed * length(rate) + SMALL
    pivot = scale(0.5 * elapsed * functions.sin(half) / half, rate)
    swung = cross(pivot, vector)
    return add(vector, scale(2.0, add(scale(functions.cos(half), swung), cross(pivot, swung))))


def gap(state: State, top: Top) -> Scalar:
    """Height of the lowest point of the body above the table, z - h(n_z), m."""
    return state.height - on_table(along_table(state), top).height


def gap_rate(state: State, top: Top) -> Scalar:
    """Rate of change of the gap, m/s: the vertical velocity of the body's lowest point."""
    return state.velocity[2] - on_table(along_table(state), top).velocity[2]
