"""Impacts of many tops at once.

Compression ends where the contact point stops sinking. Restitution ends with a part of the impulse
of compression, or earlier, once the normal impulse has given back the work that it took. The
equations of an impact, in which the normal impulse plays the part of time (see
`tippetop.contact.impact`), are solved piece by piece by polynomials, as those of sliding are; where
another branch of the law takes over, a piece ends.
"""

from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from tippetop.contact.collision import SLOWEST_REBOUND
from tippetop.contact.impact_motion import UNITS, ImpactForm, StruckNumbers, impact_motion
from tippetop.integrators.base import Array, Motion
from tippetop.mechanics.contacts.contact_point import ContactPoint
from tippetop.mechanics.contacts.wrench import Wrench
from tippetop.mechanics.flight.free_motion import gap_rate
from tippetop.mechanics.impacts.struck_body import FIRST, response_of, struck_state
from tippetop.mechanics.impacts.struck_status import HELD, SLIDES
from tippetop.mechanics.impacts.unit_impulse import ALONE, StruckContacts
from tippetop.mechanics.motion import point_velocity
from tippetop.mechanics.state import State
from tippetop.mechanics.top import Kind, Top
from tippetop.mechanics.vectors import Scalar, length
from tippetop.sweeps.launch_arrays import Flags, Indices
from tippetop.sweeps.polynomial_arcs import arcs
from tippetop.sweeps.taylor_stepper import polynomials

IMPACT_TOLERANCE = 1e-15
"""What is left out of the polynomials, relative to the impulses: rebounds, of which a top may make
hundreds, let errors grow.
"""

MOST_PIECES = 50
"""Pieces that an impact may have here: one that has more is followed as a single one."""

LONGEST = 10.0
"""Longest piece, in units of the momentum of the contact point's velocity."""

PAST_FULL = 1.25
"""Longest piece of restitution over the normal impulse that is left to its end, so that the end
lies within. In a piece much longer the end is so near its start that it takes the slower search.
"""

TINY = 1e-150
"""Added to a step that may be zero."""

FULL = StruckNumbers._fields.index("full") - len(StruckNumbers._fields)
"""Place among the parameters, from their end, of the normal impulse where restitution ends."""


class Collisions(NamedTuple):
    """What impacts did, all of shape (n,)."""

    state: State
    """The states after; as before where an impact is left out."""
    struck: Flags
    """Which impacts were computed."""
    rebounds: Flags
    """Which tops leave the table."""
    impulse: Array
    """Normal impulses."""


class ImpactsUnderWay:
    """Impacts that are followed together, one a column.

    Attributes
    ----------
    sinks
        Whether the contact point sinks at the start, shape (n,).
    impulse
        The numbers of a `tippetop.mechanics.impacts.struck_body.Impulse`, and one that is constant,
        with which what is left out of the impulses is compared: these begin at zero; shape (9, n).
    numbers
        The parameters of the equations, with the numbers of the present branches of the laws.
    """

    def __init__(self, state: State, top: Top) -> None:
        self.kind, self.start = top.kind, state
        self.point = ContactPoint.of(state.axis, state.momentum, top)
        velocity = point_velocity(state.velocity, self.point.turning, self.point.arm)
        contacts = StruckContacts(
            response_of(self.point), (0.0, 0.0), (top.friction,), top.rolling_resistance
        )
        before = (*velocity, *self.point.turning)
        struck_numbers = StruckNumbers(contacts, before, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
        self.numbers = np.array(np.broadcast_arrays(*struck_numbers.parameters, velocity[2])[:-1])
        count = self.numbers.shape[1]
        self.sinks = np.broadcast_to(velocity[2] < 0.0, (count,))
        self.impulse = np.zeros((len(before) + 3, count))
        self.impulse[-1] = top.mass * (length(velocity) + TINY)

    def press(self, some: Flags, *, restores: bool) -> Flags:
        """Follow compression, or restitution, of some impacts; return which came to its end."""
        motion = measured_motion(form_of_kind(self.kind, restores=restores))
        goals = 2 if restores else 1
        count = self.impulse.shape[1]
        pauses = np.repeat(
            [[1.0] for _ in motion.guards] + [[0.0], [np.inf], [-np.inf]], count, axis=1
        )
        ended, work = np.zeros(count, dtype=bool), np.flatnonzero(some)
        for _ in range(MOST_PIECES):
            if not len(work):
                break
            jet = polynomials(motion, IMPACT_TOLERANCE)(
                self.impulse[:, work], self.numbers[:, work]
            )
            longest = LONGEST * self.impulse[-1, work]
            if restores:
                impulse_left = self.numbers[FULL, work] - self.impulse[FIRST, work]
                longest = np.minimum(longest, PAST_FULL * impulse_left)
            course = arcs(jet, np.zeros(len(work)), longest, pauses[:, work])
            course.look_closer(jet, pauses[:, work])
            self.impulse[:, work] = course.after
            over = (course.fallen >= 0.0) & (course.fallen < goals)
            changed = course.fallen >= goals
            if changed.any():
                self._change_branches(work[changed])
            ended[work[over]] = True
            work = work[~over & (changed | (course.span > 0.0))]
        return ended

    def restore(self, some: Flags, restitution: Array) -> Flags:
        """Follow restitution of some impacts that are compressed; return which came to its end."""
        self.numbers[FULL] = (1.0 + restitution) * self.impulse[FIRST]
        return self.press(some, restores=True)

    def after(self) -> State:
        """Return the states with the present impulses."""
        x, y, z, *torque = self.impulse[:6].copy()
        wrench = Wrench((x, y, z), (torque[0], torque[1], torque[2]))
        return struck_state(self.start, self.point, wrench)

    def _change_branches(self, which: Indices) -> None:
        """Let the branch of the law that takes over hold in some impacts."""
        last = self.kind.coefficients + self.kind.branch_count
        law: Any = self.kind.branch_law(*self.numbers[:last, which])
        coefficients = law.other_branch().coefficients(UNITS)
        self.numbers[:last, which] = np.array(np.broadcast_arrays(*coefficients))


def collide(state: State, top: Top, restitution: Array) -> Collisions:
    """Return what impacts with coefficients of restitution, shape (n,), do to tops.

    Left out are tops whose contact point does not sink, and impacts too stiff for this method. As
    of a single top, an impact that would hardly let it rebound has no restitution (see
    `tippetop.contact.collision`).
    """
    impacts = ImpactsUnderWay(state, top)
    struck = impacts.press(impacts.sinks, restores=False)
    after, rebounds = impacts.after(), np.zeros_like(struck)
    impulse = impacts.impulse[FIRST].copy()
    bounces = struck & (restitution > 0.0)
    if bounces.any():
        finished = impacts.restore(bounces, restitution)
        later = impacts.after()
        rising = gap_rate(later, top)
        # Friction that turns may press what was compressed together again.
        struck &= ~bounces | (finished & (rising >= 0.0))
        rebounds = struck & bounces & (rising > SLOWEST_REBOUND)
        after = chosen(rebounds, later, after)
        impulse = np.where(rebounds, impacts.impulse[FIRST], impulse)
    return Collisions(chosen(struck, after, state), struck, rebounds, impulse)


def chosen(which: Flags, some: State, others: State) -> State:
    """Return some states where flags say so, and others elsewhere."""
    pairs = zip(some.pack(), others.pack(), strict=True)
    return State.unpack([np.where(which, first, second) for first, second in pairs])


def form_of_kind(kind: Kind, *, restores: bool) -> ImpactForm:
    """Return the form of the equations of tops that slide on one contact."""
    return ImpactForm(
        (kind.branch_law,),
        (kind.coefficients + kind.branch_count,),
        kind.resists_rolling,
        ALONE,
        (SLIDES,),
        SLIDES if kind.resists_rolling else HELD,
        restores=restores,
        ending=False,
    )


@lru_cache(maxsize=64)
def measured_motion(form: ImpactForm) -> Motion:
    """Return the equations of an impact, with one more number that is constant: what is left out of
    the impulses, which begin at zero, is compared with it.
    """
    motion = impact_motion(form)

    def rates(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> tuple[Scalar, ...]:
        return (*motion.rates(y, numbers), 0.0 * y[-1])

    return replace(motion, rates=rates, size=motion.size + 1)
