"""Impacts of many tops at once.

An impact without restitution ends where the contact point stops sinking. Its equations, in which the normal
impulse plays the part of time (see `tippetop.mechanics.impact`), are solved piece by piece by polynomials, as
those of sliding are; where another branch of the law takes over, a piece ends.
"""

from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from tippetop.contact.sliding import BRANCH
from tippetop.integrators.base import Array, Guard, Motion
from tippetop.integrators.polynomials import Polynomials
from tippetop.mechanics.impulse import contact_velocity
from tippetop.mechanics.motion import angular_velocity, moment_per_normal_force
from tippetop.mechanics.rolling import is_branched, on_other_branch
from tippetop.mechanics.state import State
from tippetop.mechanics.stick_slip import branch_guard, slip_of
from tippetop.mechanics.surface import contact_vector
from tippetop.mechanics.top import Kind, Top
from tippetop.mechanics.vectors import Scalar, length, scale
from tippetop.sweeps.launches import Flags
from tippetop.sweeps.stepper import NumPyArithmetic, stepper
from tippetop.sweeps.stride import Jet, step_size

PLAIN = NumPyArithmetic()

TOLERANCE = 1e-10
"""What is left out of the polynomials, relative to the momenta and velocities."""

MOST_PIECES = 50
"""Pieces that an impact may have before it is left to the method that takes stiff friction."""

TINY = 1e-150
"""Added to a step that may be zero."""

SINKING = "sinking"


def collide(state: State, top: Top) -> tuple[State, Flags]:
    """States after impacts without restitution, and which of them are to be had; the others are unchanged.

    Left out are tops whose contact point does not sink, and impacts too stiff for this method.
    """
    kind = top.kind
    motion = impact_motion(kind)
    point = contact_velocity(state, contact_vector(state.axis, top.surface), top)
    longest = top.mass * length(point) + TINY
    moving = np.array(np.broadcast_arrays(*state.momentum, *state.velocity))
    numbers = np.array(np.broadcast_arrays(*top.numbers, *state.axis))
    struck = np.zeros(moving.shape[1], dtype=bool)
    after, work = moving.copy(), np.flatnonzero(point[2] < 0.0)
    for _ in range(MOST_PIECES):
        if not len(work):
            break
        with np.errstate(all="ignore"):
            jet = stepper(motion, TOLERANCE).jet(after[:, work], numbers[:, work])
            span, ended, branched = pieces(jet, longest[work])
            after[:, work] = jet.at(span)
        if branched.any():
            numbers[: kind.numbers, work[branched]] = others(kind, numbers[: kind.numbers, work[branched]])
        struck[work[ended]] = True
        work = work[~ended & np.isfinite(span)]
    after[:, ~struck] = moving[:, ~struck]
    return state._replace(momentum=tuple(after[:3]), velocity=tuple(after[3:])), struck


def pieces(jet: Jet, longest: Array) -> tuple[Array, Flags, Flags]:
    """How far pieces of impacts go, which of them end with the impact, and which with the law's branch."""
    size = step_size([list(series) for series in jet.state], longest, PLAIN)
    end, *changes = (Polynomials(terms, size).first_fall() for terms in jet.guards)
    change = changes[0] if changes else np.full(size.shape, np.nan)
    ended = ~np.isnan(end) & ~(change < end)
    branched = ~np.isnan(change) & ~ended
    return np.where(ended, end, np.where(branched, change, size)), ended, branched


def others(kind: Kind, numbers: Array) -> Array:
    """The numbers of tops with the branch of their law that takes over."""
    return np.array(np.broadcast_arrays(*on_other_branch(kind.top(tuple(numbers))).numbers))


@lru_cache
def impact_motion(kind: Kind) -> Motion:
    """How angular momentum and velocity of struck tops change with the normal impulse.

    The parameters are a top's numbers and its axis, which does not move.
    """

    def read(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> tuple[State, Top]:
        x, y_, z = numbers[kind.numbers :]
        state = State((x, y_, z), (y[0], y[1], y[2]), (y[3], y[4], y[5]), 0.0)
        return state, kind.top(tuple(numbers[: kind.numbers]))

    def rates(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> tuple[Scalar, ...]:
        state, top = read(y, numbers)
        arm = contact_vector(state.axis, top.surface)
        point = contact_velocity(state, arm, top)
        traction = top.friction.traction(
            (point[0], point[1]), angular_velocity(state.axis, state.momentum, top)
        )
        return (*moment_per_normal_force(arm, traction), *scale(1.0 / top.mass, (*traction.force, 1.0)))

    def sinking(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> Scalar:
        state, top = read(y, numbers)
        return -contact_velocity(state, contact_vector(state.axis, top.surface), top)[2]

    def branch(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> Scalar:
        state, top = read(y, numbers)
        return branch_guard(slip_of(state.axis, state.momentum, state.velocity[:2], top), top)

    guards = [Guard(SINKING, sinking)]
    if is_branched(kind.example.friction):
        guards.append(Guard(BRANCH, branch))
    return Motion(rates, size=6, parameters=kind.numbers + 3, guards=tuple(guards))
