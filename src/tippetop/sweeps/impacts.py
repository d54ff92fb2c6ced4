"""Impacts of many tops at once.

Compression ends where the contact point stops sinking. Restitution ends with a part of the impulse
of compression, or earlier, once the normal impulse has given back the work that it took. The
equations of an impact, in which the normal impulse plays the part of time (see
`tippetop.mechanics.impacts.impact`), are solved piece by piece by polynomials, as those of sliding
are; where another branch of the law takes over, a piece ends.
"""

from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from tippetop.contact.collision import SLOWEST_REBOUND
from tippetop.contact.striking import MOST_PIECES, impact_motion
from tippetop.integrators.base import Array, Guard, Motion
from tippetop.mechanics.contacts.branches import on_other_branch
from tippetop.mechanics.flight.free_motion import gap_rate
from tippetop.mechanics.impacts.struck_body import contact_velocity
from tippetop.mechanics.state import State
from tippetop.mechanics.surfaces.surface import contact_vector
from tippetop.mechanics.top import Kind, Top
from tippetop.mechanics.vectors import Scalar, length
from tippetop.sweeps.launch_arrays import Flags
from tippetop.sweeps.polynomial_arcs import arcs
from tippetop.sweeps.taylor_stepper import polynomials

TOLERANCE = 1e-14
"""What is left out of the polynomials, relative to the momenta and velocities: rebounds, of which a
top may make hundreds, let errors grow.
"""

TINY = 1e-150
"""Added to a step that may be zero."""

WORK = 6
"""Row of the work of the normal impulse, after angular momentum and velocity."""

RETURNED = "returned"
"""The normal impulse has given back the work that it took in compression."""


class Collisions(NamedTuple):
    """What impacts did, all of shape (n,)."""

    state: State
    """The states after; as before where an impact is left out."""
    struck: Flags
    """Which impacts were computed."""
    rebounds: Flags
    """Which tops leave the table."""


class ImpactsUnderWay:
    """Impacts that are followed together, one a column.

    Attributes
    ----------
    moving
        Angular momentum, velocity, and the work of the normal impulse, shape (7, n).
    numbers
        The numbers of the tops on the present branches of their laws, and the axes.
    impulse
        The normal impulse so far, shape (n,).
    """

    def __init__(self, state: State, top: Top) -> None:
        self.kind = top.kind
        self.point = contact_velocity(state, contact_vector(state.axis, top.surface), top)
        self.longest = top.mass * length(self.point) + TINY
        self.impulse = np.zeros_like(self.longest)
        self.moving = np.array(
            np.broadcast_arrays(*state.momentum, *state.velocity, self.impulse), dtype=float
        )
        self.numbers = np.array(np.broadcast_arrays(*top.numbers, *state.axis))

    def press(self, some: Flags, motion: Motion, most: Array) -> Flags:
        """Follow some impacts until the first guard of a motion falls, or the normal impulse has
        grown by so much, shape (n,); return which came there.
        """
        remaining, ended = most.copy(), np.zeros_like(some)
        pauses = np.repeat(
            [[1.0] for _ in motion.guards] + [[0.0], [np.inf], [-np.inf]], len(remaining), axis=1
        )
        work = np.flatnonzero(some)
        for _ in range(MOST_PIECES):
            if not len(work):
                break
            jet = polynomials(motion, TOLERANCE)(self.moving[:, work], self.numbers[:, work])
            limit = np.minimum(self.longest, remaining)[work]
            course = arcs(jet, np.zeros(len(work)), limit, pauses[:, work])
            course.look_closer(jet, pauses[:, work])
            self.moving[:, work] = course.after
            self.impulse[work] += course.span
            remaining[work] -= course.span
            changed = course.fallen == 1.0
            if changed.any():
                self._change_branches(work[changed])
            over = (course.fallen == 0.0) | (remaining[work] <= 0.0)
            ended[work[over]] = True
            work = work[~over & (changed | (course.span > 0.0))]
        return ended

    def after(self, state: State) -> State:
        """Return the states with the present momenta and velocities."""
        rows = self.moving.copy()
        return state._replace(momentum=tuple(rows[:3]), velocity=tuple(rows[3:WORK]))

    def _change_branches(self, which: Array) -> None:
        """Let the branch of the law that takes over hold in some impacts."""
        last = self.kind.numbers
        top = on_other_branch(self.kind.top(tuple(self.numbers[:last, which])))
        self.numbers[:last, which] = np.array(np.broadcast_arrays(*top.numbers))


def collide(state: State, top: Top, restitution: Array) -> Collisions:
    """Return what impacts with coefficients of restitution, shape (n,), do to tops.

    Left out are tops whose contact point does not sink, and impacts too stiff for this method. As
    of a single top, an impact that would hardly let it rebound has no restitution (see
    `tippetop.contact.collision`).
    """
    impacts = ImpactsUnderWay(state, top)
    endless = np.full_like(impacts.longest, np.inf)
    struck = impacts.press(impacts.point[2] < 0.0, compression(impacts.kind), endless)
    after, rebounds = impacts.after(state), np.zeros_like(struck)
    bounces = struck & (restitution > 0.0)
    if bounces.any():
        returned = restitution * impacts.impulse
        finished = impacts.press(bounces, restitution_motion(impacts.kind), returned)
        later = impacts.after(state)
        rising = gap_rate(later, top)
        # Friction that turns may press what was compressed together again.
        struck &= ~bounces | (finished & (rising >= 0.0))
        rebounds = struck & bounces & (rising > SLOWEST_REBOUND)
        after = chosen(rebounds, later, after)
    return Collisions(chosen(struck, after, state), struck, rebounds)


def chosen(which: Flags, some: State, others: State) -> State:
    """Return some states where flags say so, and others elsewhere."""
    pairs = zip(some.pack(), others.pack(), strict=True)
    return State.unpack([np.where(which, first, second) for first, second in pairs])


@lru_cache
def compression(kind: Kind) -> Motion:
    """Return the equations of an impact, with the work of the normal impulse, until the contact
    point stops sinking.
    """
    impact = impact_motion(kind)

    def rates(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> tuple[Scalar, ...]:
        sinking = impact.guards[0].value(y[:WORK], numbers)
        return (*impact.rates(y[:WORK], numbers), -sinking)

    return replace(impact, rates=rates, size=WORK + 1)


@lru_cache
def restitution_motion(kind: Kind) -> Motion:
    """Return the same equations until the normal impulse has given back all work."""
    impact = compression(kind)
    returned = Guard(RETURNED, lambda y, _: -y[WORK])
    return replace(impact, guards=(returned, *impact.guards[1:]))
