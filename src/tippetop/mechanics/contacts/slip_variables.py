"""How slip ends, and whether and where it goes on, under a law that leaves the force at rest open.

What slips is a velocity zeta: the slip v, or, where the law resists drilling too, (v, l w) with the
law's length l and w = omega_z. Away from zeta = 0 the law depends on the direction e = zeta / s
alone, s = |zeta|, and so do all accelerations: with y = (n, L),

    y' = Y(y, e),        zeta' = A(y, e) = R e + V,        s' = R,        s e' = V,        V.e = 0.

How it comes to zero is said in `slip_clock`. At zeta = 0 the wrench that keeps it zero decides: the
body sticks if the limit surface admits it. Otherwise slip goes on in a direction in which it can, A
= R e with R > 0 (see `find_onset`).
"""

import math
from collections.abc import Sequence
from typing import Any

from tippetop.mechanics.contacts.forces import (
    slip_length,
    velocity_without_slip,
    without_drilling,
    without_rolling,
)
from tippetop.mechanics.contacts.wrench import Slip
from tippetop.mechanics.motion import angular_velocity, axial_spin, contact_swing
from tippetop.mechanics.state import SlidingState
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Horizontal, Scalar, Vector

HORIZON = 0.05
"""How long before its end slip is followed in a clock of its own, in natural units of time."""

NEAR = 1e-3
"""Slip, in natural units, below which its end is guarded.

To guard it costs as much again as to follow the motion, and most of a motion it does not end.
"""

APART = 0.1
"""Slip, in natural units, from which its end is guarded no longer."""

ROUNDING = 1e-14
"""Slip, relative to the velocities it is made of, that is rounding."""

LEFT_OVER = 30.0
"""How many times `ROUNDING`, in natural units and relative to the velocities, is left of the slip
of one contact where that of another ends with it: a hundred roundings of each motion leave less,
and friction takes as little slip away in no time.
"""

SMALLEST_DIVISOR = 1e-200
"""Added to what divides, where a velocity is zero."""

STILL = 0.1
"""Angular velocity, in natural units, below which rounding does not fall with it."""


def slip_of(axis: Vector, momentum: Vector, velocity: Horizontal, top: Top) -> Slip:
    """Return the velocity zeta of a body in contact whose centre of mass has this horizontal
    velocity.
    """
    swing, reach = contact_swing(axis, momentum, top), slip_length(top.friction)
    slip = (velocity[0] + swing[0], velocity[1] + swing[1])
    return slip if reach is None else (*slip, reach * angular_velocity(axis, momentum, top)[2])


def velocity_of(axis: Vector, momentum: Vector, slip: Slip, top: Top) -> Horizontal:
    """Horizontal velocity of the centre of mass with this slip, m/s."""
    rolling = velocity_without_slip(axis, momentum, top)
    return (rolling[0] + slip[0], rolling[1] + slip[1])


def come_to_rest(state: SlidingState, top: Top, slip: bool, rolling: bool) -> SlidingState:
    """Return the state in which slip, or rolling, that has ended is exactly zero."""
    axis, momentum, velocity = state
    if slip and slip_length(top.friction) is not None:
        momentum = without_drilling(axis, momentum, top)
    if rolling:
        momentum = without_rolling(axis, momentum, top)
    return SlidingState(
        axis, momentum, velocity_without_slip(axis, momentum, top) if slip else velocity
    )


def is_slipping(axis: Vector, momentum: Vector, velocity: Horizontal, top: Top) -> Scalar:
    """Return whether the contact slips, or drills where its law resists that, by more than
    rounding.

    A truth value of floats, or an array of them.
    """
    slips, least = False, least_slip(axis, momentum, velocity, top)
    for number in slip_of(axis, momentum, velocity, top):
        slips = slips | (abs(number) > least)
    return slips


def least_slip(axis: Vector, momentum: Vector, velocity: Horizontal, top: Top) -> Scalar:
    """Slip that is more than rounding."""
    turning = scaled(top.surface.size, angular_velocity(axis, momentum, top))
    return ROUNDING * sum(abs(number) for number in (*turning, *velocity))


def has_ended(axis: Vector, momentum: Vector, velocity: Horizontal, top: Top) -> bool:
    """Return whether what is left of slip is what rounding leaves where it has ended; of floats."""
    least = ROUNDING + float(least_slip(axis, momentum, velocity, top))
    return size(slip_of(axis, momentum, velocity, top)) <= LEFT_OVER * least


def is_rolling(axis: Vector, momentum: Vector, top: Top) -> Scalar:
    """Return whether the angular velocity is horizontal in part, by more than rounding."""
    measure = sum(abs(number) for number in momentum) / top.transverse_inertia + STILL
    x, y, _ = angular_velocity(axis, momentum, top)
    return (abs(x) > ROUNDING * measure) | (abs(y) > ROUNDING * measure)


def slip_part(accelerations: Sequence[Scalar], reach: Scalar | None) -> Slip:
    """Rate of zeta among the six accelerations of the contact."""
    if reach is None:
        return (accelerations[0], accelerations[1])
    return (accelerations[0], accelerations[1], reach * accelerations[5])


def nearing_guard(state: SlidingState, top: Top) -> Scalar:
    """Falls through zero where slip becomes so small that its end is to be guarded; slip squared,
    in natural units as `NEAR` is.
    """
    slip = slip_of(*state, top)
    return inner(slip, slip) - NEAR * NEAR


def parting_guard(state: SlidingState, top: Top) -> Scalar:
    """Falls through zero where slip is so large again that its end need not be guarded; slip
    squared, in natural units as `APART` is.
    """
    slip = slip_of(*state, top)
    return APART * APART - inner(slip, slip)


def is_near(state: SlidingState, top: Top) -> Scalar:
    """Return whether slip is near its end, so that its end is guarded; of floats or arrays, in
    natural units.
    """
    slip = slip_of(*state, top)
    return inner(slip, slip) < NEAR * APART


def rolling_stopping_guard(state: SlidingState, rate: SlidingState, top: Top) -> Scalar:
    """Falls through zero where rolling ends soon; for a sliding state and its time derivative.

    omega = L / I1 + k omega3 n changes by L' / I1 + k (omega3' n + omega3 n'), omega3' = L'.n / I3.
    """
    turning = angular_velocity(state.axis, state.momentum, top)
    spin, spinning = (
        axial_spin(state.axis, momentum, top) for momentum in (state.momentum, rate.momentum)
    )
    excess = (top.transverse_inertia - top.axial_inertia) / top.transverse_inertia
    change = [
        rate.momentum[i] / top.transverse_inertia
        + excess * (spinning * state.axis[i] + spin * rate.axis[i])
        for i in (0, 1)
    ]
    return remaining(turning[:2], (change[0], change[1]))


def remaining(velocity: Slip, change: Slip, horizon: float = HORIZON) -> Scalar:
    """Positive while a velocity outlasts a horizon: s (s + horizon R R^2 / (A^2 + s^2)), in natural
    units.

    At its present rate of change A = R e + V it ends after the time s / -R. Where its direction
    turns faster than it ends, as that of a disk that wobbles down, it counts as farther from its
    end: there the clock of `slip_clock`, whose unit is the time s / |A|, is no better than time.
    """
    return inner(velocity, velocity) + horizon * _closing(velocity, change)


def time_to_end(velocity: Slip, change: Slip) -> float:
    """Return the horizon at which `remaining` is zero; infinity where the velocity grows."""
    closing = _closing(velocity, change)
    return inner(velocity, velocity) / -closing if closing < 0.0 else math.inf


def _closing(velocity: Slip, change: Slip) -> Scalar:
    """Return s R R^2 / (A^2 + s^2): half the rate of s^2, times the part of a velocity's change
    that is along it.
    """
    square, closing = inner(velocity, velocity), inner(change, velocity)
    along = closing * closing / (square * (inner(change, change) + square) + SMALLEST_DIVISOR)
    return closing * along


def branch_guard(slip: Slip, top: Top) -> Scalar:
    """Positive as long as a branch of a law holds where it slips so, or in that direction,
    m^2/s^2.
    """
    law: Any = top.friction
    return law.branch_guard(slip)


def inner(a: Slip, b: Slip) -> Scalar:
    """Scalar product."""
    return sum((x * y for x, y in zip(a[1:], b[1:], strict=True)), a[0] * b[0])


def size(a: Slip) -> float:
    """Euclidean length, of floats."""
    return math.hypot(*a)


def scaled(factor: Scalar, a: Slip) -> Slip:
    """Return a number times a vector."""
    return tuple([factor * x for x in a])


def plus(a: Slip, b: Slip) -> Slip:
    """Sum of two vectors."""
    return tuple([x + y for x, y in zip(a, b, strict=True)])


def tangents(e: Slip) -> list[Slip]:
    """Unit vectors across a unit vector and across each other; in space, of floats."""
    if len(e) == 2:
        return [(-e[1], e[0])]
    x, y, z = e
    sign = 1.0 if z >= 0.0 else -1.0
    a = 1.0 / (1.0 + sign * z)
    return [(1.0 - x * x * a, -x * y * a, -sign * x), (-x * y * a, 1.0 - y * y * a, -sign * y)]
