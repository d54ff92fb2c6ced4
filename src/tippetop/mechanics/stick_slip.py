"""How slip ends, and whether and where it goes on, under a law that leaves the force at rest open.

What slips is a velocity zeta: the slip v, or, where the law resists drilling too, (v, l w) with the law's
length l and w = omega_z. Away from zeta = 0 the law depends on the direction e = zeta / s alone, s = |zeta|,
and so do all accelerations: with y = (n, L),

    y' = Y(y, e),        zeta' = A(y, e) = R e + V,        s' = R,        s e' = V,        V.e = 0.

With zeta itself as a variable beside y nothing cancels as it goes to zero. Where R < 0, s reaches zero in
finite time while e turns ever faster. In the clock -ln s it does not: de = -V/R, dy = -s Y/R, dt = -s/R, ds =
-s. At zeta = 0 the wrench that keeps it zero decides: the body sticks if the limit surface admits it.
Otherwise slip goes on in a direction in which it can, A = R e with R > 0 (see `slip_onset`).
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

from tippetop.mechanics.motion import angular_velocity, axial_spin, axis_rate, point_velocity
from tippetop.mechanics.rolling import (
    DRILLING,
    FORCES,
    ContactPoint,
    Slip,
    Wrench,
    arm_rate,
    contact_motion,
    contact_wrench,
    flat,
    set_valued,
    velocity_without_slip,
)
from tippetop.mechanics.state import SlidingState
from tippetop.mechanics.surface import contact_vector
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Horizontal, Scalar, Vector, add, cross, dot, scale

HORIZON = 0.05
"""How long before its end slip is followed in the clock -ln s, in natural units of time."""

LANDING = (3e-9, 1e-16)
"""How long before its end the rest of slip may be taken in one step, in natural units of time: if the
direction of slip has come to rest by then, and in any case."""

ROUNDING = 1e-14
"""Slip, relative to the momenta and velocities it is made of in natural units, that is rounding."""

ITERATIONS = 5000
"""Most iterations in search of a direction in which slip can go on; a hundred are usual."""


class CreepRates(NamedTuple):
    """What follows from axis, angular momentum and direction of slip.

    Attributes
    ----------
    axis, momentum
        Rates of axis and angular momentum, Y.
    slip
        Rate of the slip, A.
    wrench
        What the table does.
    """

    axis: Vector
    momentum: Vector
    slip: Slip
    wrench: Wrench


def slip_of(axis: Vector, momentum: Vector, velocity: Horizontal, top: Top) -> Slip:
    """The velocity zeta of a body in contact whose centre of mass has this horizontal velocity."""
    turning = angular_velocity(axis, momentum, top)
    point = point_velocity((*velocity, 0.0), turning, contact_vector(axis, top.surface))
    reach = set_valued(top.friction).slip_length
    return point[:2] if reach is None else (point[0], point[1], reach * turning[2])


def velocity_of(axis: Vector, momentum: Vector, slip: Slip, top: Top) -> Horizontal:
    """Horizontal velocity of the centre of mass with this slip, m/s."""
    rolling = velocity_without_slip(axis, momentum, top)
    return (rolling[0] + slip[0], rolling[1] + slip[1])


def is_slipping(axis: Vector, momentum: Vector, velocity: Horizontal, top: Top) -> Scalar:
    """Whether the contact slips, or drills where its law resists that, by more than rounding.

    A truth value of floats, or an array of them.
    """
    scale = sum(abs(number) for number in (*momentum, *velocity))
    found = False
    for number in slip_of(axis, momentum, velocity, top):
        found = found | (abs(number) > ROUNDING * scale)
    return found


def slip_part(accelerations: Sequence[Scalar], reach: Scalar | None) -> Slip:
    """Rate of zeta among the six accelerations of the contact."""
    if reach is None:
        return (accelerations[0], accelerations[1])
    return (accelerations[0], accelerations[1], reach * accelerations[5])


def creep_rates(
    axis: Vector, momentum: Vector, slip: Slip, top: Top, *, rolling_held: bool = False
) -> CreepRates:
    """Rates of a slipping body; `slip` may be its direction only."""
    point = ContactPoint.of(axis, momentum, top)
    wrench, acceleration = contact_motion(point, slip, None if rolling_held else point.turning[:2])
    rate = slip_part(flat(acceleration), set_valued(top.friction).slip_length)
    return CreepRates(axis_rate(axis, momentum, top), point.moment(wrench), rate, wrench)


# The end of slip -----------------------------------------------------------------------------------------


class Closing(NamedTuple):
    """A body whose slip is about to end: the state in the clock -ln s.

    Attributes
    ----------
    axis, momentum
        Axis n, and angular momentum L, kg m^2/s.
    direction
        Direction e of slip, a unit vector.
    speed
        Its size s, m/s.
    time
        Time, s.
    """

    axis: Vector
    momentum: Vector
    direction: Slip
    speed: Scalar
    time: Scalar


def closing_rates(state: Closing, top: Top) -> Closing:
    """Rates in the clock -ln s; the slip must be slowing down."""
    rates = creep_rates(state.axis, state.momentum, state.direction, top)
    pace = -1.0 / inner(rates.slip, state.direction)
    step = pace * state.speed
    # 1 where e is a unit vector, and such that it stays one: 1 itself would let it grow like exp(2 clock).
    unit = 3.0 - 2.0 * inner(state.direction, state.direction)
    turn = tuple(pace * a + unit * e for a, e in zip(rates.slip, state.direction, strict=True))
    return Closing(scale(step, rates.axis), scale(step, rates.momentum), turn, -state.speed, step)


def stopping_guard(state: SlidingState, rate: SlidingState, top: Top, horizon: Scalar) -> Scalar:
    """Falls through zero where slip, at its present rate, ends within the horizon (s): s (s + horizon R).

    Parameters
    ----------
    state, rate
        A sliding state and its time derivative.
    top
        The body.
    horizon
        How far ahead the end may be, s.
    """
    turning, tilting = angular_velocity(state.axis, state.momentum, top), rate.axis
    excess = (top.transverse_inertia - top.axial_inertia) / top.transverse_inertia
    spin = axial_spin(state.axis, state.momentum, top)
    spinning = (dot(rate.momentum, state.axis) + dot(state.momentum, tilting)) / top.axial_inertia
    turned = scale(1.0 / top.transverse_inertia, rate.momentum)
    turned = add(turned, scale(excess, add(scale(spinning, state.axis), scale(spin, tilting))))
    arm = contact_vector(state.axis, top.surface)
    carried = add(cross(turned, arm), cross(turning, arm_rate(state.axis, tilting, top)))
    slip = slip_of(state.axis, state.momentum, state.velocity, top)
    reach = set_valued(top.friction).slip_length
    change: Slip = (rate.velocity[0] + carried[0], rate.velocity[1] + carried[1])
    change = change if reach is None else (*change, reach * turned[2])
    return inner(slip, slip) + horizon * inner(change, slip)


def reopening_guard(state: Closing, top: Top, horizon: Scalar) -> Scalar:
    """-(s + 2 horizon R): falls through zero where the end of slip is twice as far as the horizon again."""
    rates = creep_rates(state.axis, state.momentum, state.direction, top)
    return -2.0 * horizon * inner(rates.slip, state.direction) - state.speed


def landing_guard(state: Closing, top: Top, horizon: Scalar) -> Scalar:
    """Falls through zero where slip, at its present rate, ends within the horizon (s): s + horizon R."""
    rates = creep_rates(state.axis, state.momentum, state.direction, top)
    return state.speed + horizon * inner(rates.slip, state.direction)


def landed(state: Closing, top: Top) -> tuple[Closing, float]:
    """The state at the end of slip, in one step at the present rates, and an estimate of its error, s."""
    rates = creep_rates(state.axis, state.momentum, state.direction, top)
    slowing = inner(rates.slip, state.direction)
    left = -state.speed / slowing
    across = plus(rates.slip, scaled(-slowing, state.direction))
    rest = Closing(
        add(state.axis, scale(left, rates.axis)),
        add(state.momentum, scale(left, rates.momentum)),
        state.direction,
        0.0,
        state.time + left,
    )
    return rest, left * size(across) / -slowing


def slip_guard(axis: Vector, momentum: Vector, top: Top, *, rolling_held: bool = False) -> Scalar:
    """Positive while the limit surface admits the wrench that keeps a sticking body so, N^2."""
    point = ContactPoint.of(axis, momentum, top)
    force, torque = contact_wrench(point, None, None if rolling_held else point.turning[:2])
    return set_valued(top.friction).reserve(force[2], (force[0], force[1]), torque[2])


def direction_of_slip(axis: Vector, momentum: Vector, top: Top) -> tuple[Slip, float]:
    """Direction e in which a body that cannot stick slips, floats, and the rate R >= 0 of its speed, m/s^2.

    The direction is a fixed point of e -> c e + A(e), normalized, for c large enough.

    Raises
    ------
    ArithmeticError
        If no such direction is found: more than one contact force may be consistent, or none.
    """
    point = ContactPoint.of(axis, momentum, top)
    reach = set_valued(top.friction).slip_length
    rolling = point.turning[:2]
    force, torque = contact_wrench(point, None, rolling)
    pushed = (-force[0], -force[1]) if reach is None else (-force[0], -force[1], -torque[2] / reach)
    direction = scaled(1.0 / size(pushed), pushed)
    share = sum(
        abs(slip_part(flat(point.response(wrench)), reach)[i])
        for i, wrench in enumerate((*FORCES[:2], DRILLING)[: len(direction)])
    )
    for _ in range(ITERATIONS):
        wrench, acceleration = contact_motion(point, direction, rolling)
        rate = slip_part(flat(acceleration), reach)
        hold = share * size(wrench.force[:2]) + size(rate)
        ahead = tuple(hold * e + a for e, a in zip(direction, rate, strict=True))
        new = scaled(1.0 / size(ahead), ahead)
        moved = size(tuple(a - b for a, b in zip(new, direction, strict=True)))
        direction = new
        if moved < 4e-16:
            break
    along = inner(rate, direction)
    if moved > 1e-9 or along < -1e-9 * size(point.free.point):
        raise ArithmeticError("no direction in which the contact can slip, though it cannot stick")
    return direction, max(along, 0.0)


def inner(a: Slip, b: Slip) -> Scalar:
    """Scalar product."""
    return sum((x * y for x, y in zip(a[1:], b[1:], strict=True)), a[0] * b[0])


def size(a: Slip) -> float:
    """Euclidean length, of floats."""
    return math.sqrt(inner(a, a))


def scaled(factor: Scalar, a: Slip) -> Slip:
    """A number times a vector."""
    return tuple(factor * x for x in a)


def plus(a: Slip, b: Slip) -> Slip:
    """Sum of two vectors."""
    return tuple(x + y for x, y in zip(a, b, strict=True))
