"""Free flight of a body of revolution in closed form.

In flight the angular momentum L is constant, the axis n turns about it at the constant rate w = L /
I1, and the centre of mass falls (Landau and Lifshitz, Mechanics, sections 33 and 35). A number y of
the axis so obeys y''' = -w^2 y', and every other one of the state y''' = 0.
"""

# translate module: numbers

from tippetop.mechanics.motion import along_table, axis_rate, on_table
from tippetop.mechanics.state import State
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Functions, Scalar, add, length, scale

SMALL = 1e-100
"""Added to a rate or an angle that is about to divide: changes nothing but 0 / 0."""


def fly(state: State, elapsed: Scalar, top: Top, functions: Functions) -> State:
    """Return the state after a time of free flight.

    Parameters
    ----------
    state
        The state at the start.
    elapsed
        Time since then, s: a number, or an array of them, whose shape every number of the result
        then has.
    top
        The body and gravity.
    functions
        Where sin and cos come from: `math`, `numpy`, ...
    """
    rate, second = flight_rates(state, top)
    sine, versine = swing(precession(state, top), elapsed, functions)
    return State(
        axis=add(state.axis, add(scale(sine, rate.axis), scale(versine, second.axis))),
        momentum=add(state.momentum, scale(elapsed, rate.momentum)),
        velocity=add(state.velocity, scale(elapsed, rate.velocity)),
        height=state.height + elapsed * (rate.height + 0.5 * elapsed * second.height),
    )


def precession(state: State, top: Top) -> Scalar:
    """Rate at which the axis turns about the angular momentum in flight, rad/s."""
    return length(state.momentum) / top.transverse_inertia


def flight_rates(state: State, top: Top) -> tuple[State, State]:
    """Rates of change of the state in free flight, its numbers' units per s, and theirs, per
    s^2.
    """
    turning = axis_rate(state.axis, state.momentum, top)
    still, falling = (0.0, 0.0, 0.0), (0.0, 0.0, -top.gravity)
    rate = State(turning, still, falling, state.velocity[2])
    return rate, State(axis_rate(turning, state.momentum, top), still, still, -top.gravity)


def swing(frequency: Scalar, elapsed: Scalar, functions: Functions) -> tuple[Scalar, Scalar]:
    """sin(w t) / w, s, and (1 - cos(w t)) / w^2, s^2, for a frequency w, rad/s, that may be zero.

    A number that obeys y''' = -w^2 y' gains the first of them times y', and the second times y'',
    in a time.
    """
    half = 0.5 * elapsed * frequency + SMALL
    chord = elapsed * functions.sin(half) / half
    return chord * functions.cos(half), 0.5 * chord * chord


def gap(state: State, top: Top) -> Scalar:
    """Height of the lowest point of the body above the table, z - h(n_z), m."""
    return state.height - on_table(along_table(state), top).height


def gap_rate(state: State, top: Top) -> Scalar:
    """Rate of change of the gap, m/s: the vertical velocity of the body's lowest point."""
    return state.velocity[2] - on_table(along_table(state), top).velocity[2]
