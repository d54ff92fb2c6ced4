"""Free flight of a body of revolution in closed form.

In flight the angular momentum L is constant, the axis n turns about it at the constant rate L / I1, and the
centre of mass falls (Landau and Lifshitz, Mechanics, sections 33 and 35). The body turns with omega = L / I1
+ s n, where s is constant and n turns with L / I1: its rotation is the one about the initial axis by s t,
followed by the one about L by |L| t / I1.
"""

from tippetop.mechanics.motion import along_table, angular_velocity, on_table
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
    spinning = add(angular_velocity(state.axis, state.momentum, top), scale(-1.0, precession))
    marker = turned(state.marker, spinning, elapsed, functions)
    still = (0.0 * elapsed, 0.0 * elapsed, 0.0 * elapsed)
    falling = (0.0 * elapsed, 0.0 * elapsed, -top.gravity * elapsed)
    return State(
        axis=turned(state.axis, precession, elapsed, functions),
        momentum=add(state.momentum, still),
        velocity=add(state.velocity, falling),
        position=add(state.position, scale(elapsed, add(state.velocity, scale(0.5, falling)))),
        marker=turned(marker, precession, elapsed, functions),
        work=state.work + 0.0 * elapsed,
    )


def turned(vector: Vector, rate: Vector, elapsed: Scalar, functions: Functions) -> Vector:
    """A vector after turning for a time with a constant angular velocity (rad/s), which may be zero."""
    half = 0.5 * elapsed * length(rate) + SMALL
    pivot = scale(0.5 * elapsed * functions.sin(half) / half, rate)
    swung = cross(pivot, vector)
    return add(vector, scale(2.0, add(scale(functions.cos(half), swung), cross(pivot, swung))))


def gap(state: State, top: Top) -> Scalar:
    """Height of the lowest point of the body above the table, z - h(n_z), m."""
    return state.position[2] - on_table(along_table(state), top).position[2]


def gap_rate(state: State, top: Top) -> Scalar:
    """Rate of change of the gap, m/s: the vertical velocity of the body's lowest point."""
    return state.velocity[2] - on_table(along_table(state), top).velocity[2]
