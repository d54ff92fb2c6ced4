"""Impacts of many tops at once.

An impact without restitution ends where the contact point stops sinking. Its equations, in which
the normal impulse plays the part of time (see `tippetop.mechanics.impacts.impact`), are solved
piece by piece by polynomials, as those of sliding are; where another branch of the law takes over,
a piece ends.
"""

import numpy as np

from tippetop.contact.striking import MOST_PIECES, impact_motion
from tippetop.integrators.base import Array
from tippetop.mechanics.contacts.branches import on_other_branch
from tippetop.mechanics.impacts.struck_body import contact_velocity
from tippetop.mechanics.state import State
from tippetop.mechanics.surfaces.surface import contact_vector
from tippetop.mechanics.top import Kind, Top
from tippetop.mechanics.vectors import length
from tippetop.sweeps.launch_arrays import Flags
from tippetop.sweeps.polynomial_arcs import arcs
from tippetop.sweeps.taylor_stepper import polynomials

TOLERANCE = 1e-10
"""What is left out of the polynomials, relative to the momenta and velocities."""

TINY = 1e-150
"""Added to a step that may be zero."""


def collide(state: State, top: Top) -> tuple[State, Flags]:
    """States after impacts without restitution, and which of them are to be had; the others are
    unchanged.

    Left out are tops whose contact point does not sink, and impacts too stiff for this method.
    """
    kind = top.kind
    motion = impact_motion(kind)
    point = contact_velocity(state, contact_vector(state.axis, top.surface), top)
    longest = top.mass * length(point) + TINY
    moving = np.array(np.broadcast_arrays(*state.momentum, *state.velocity))
    numbers = np.array(np.broadcast_arrays(*top.numbers, *state.axis))
    pauses = np.repeat(
        [[1.0] for _ in motion.guards] + [[0.0], [np.inf], [-np.inf]], moving.shape[1], axis=1
    )
    struck = np.zeros(moving.shape[1], dtype=bool)
    after, work = moving.copy(), np.flatnonzero(point[2] < 0.0)
    for _ in range(MOST_PIECES):
        if not len(work):
            break
        jet = polynomials(motion, TOLERANCE)(after[:, work], numbers[:, work])
        course = arcs(jet, np.zeros(len(work)), longest[work], pauses[:, work])
        course.look_closer(jet, pauses[:, work])
        after[:, work], ended, branched = (
            course.after,
            course.fallen == 0.0,
            course.fallen == 1.0,
        )
        if branched.any():
            numbers[: kind.numbers, work[branched]] = others(
                kind, numbers[: kind.numbers, work[branched]]
            )
        struck[work[ended]] = True
        work = work[~ended & (branched | (course.span > 0.0))]
    after[:, ~struck] = moving[:, ~struck]
    return state._replace(momentum=tuple(after[:3]), velocity=tuple(after[3:])), struck


def others(kind: Kind, numbers: Array) -> Array:
    """Return the numbers of tops with the branch of their law that takes over."""
    return np.array(np.broadcast_arrays(*on_other_branch(kind.top(tuple(numbers))).numbers))
