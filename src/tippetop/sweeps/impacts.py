"""Impacts of many tops at once.

An impact without restitution ends where the contact point stops sinking. Its equations, in which
the normal impulse plays the part of time (see `tippetop.contact.impact`), are solved piece by piece
by polynomials, as those of sliding are; where another branch of the law takes over, a piece ends.
"""

from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from typing import Any

import numpy as np

from tippetop.contact.impact_motion import UNITS, ImpactForm, StruckNumbers, impact_motion
from tippetop.integrators.base import Array, Motion
from tippetop.mechanics.contacts.contact_point import ContactPoint
from tippetop.mechanics.contacts.wrench import Wrench
from tippetop.mechanics.impacts.struck_body import response_of, struck_state
from tippetop.mechanics.impacts.struck_status import HELD, SLIDES
from tippetop.mechanics.impacts.unit_impulse import ALONE, StruckContacts
from tippetop.mechanics.motion import point_velocity
from tippetop.mechanics.state import State
from tippetop.mechanics.top import Kind, Top
from tippetop.mechanics.vectors import Scalar, length
from tippetop.sweeps.launch_arrays import Flags
from tippetop.sweeps.polynomial_arcs import arcs
from tippetop.sweeps.taylor_stepper import polynomials

TOLERANCE = 1e-15
"""What is left out of the polynomials, relative to the impulses."""

MOST_PIECES = 50
"""Pieces that an impact may have here: one that has more is followed as a single one."""

LONGEST = 10.0
"""Longest piece, in units of the momentum of the contact point's velocity."""

TINY = 1e-150
"""Added to a step that may be zero."""


def collide(state: State, top: Top) -> tuple[State, Flags]:
    """States after impacts without restitution, and which of them are to be had; the others are
    unchanged.

    Left out are tops whose contact point does not sink, and impacts too stiff for this method.
    """
    kind = top.kind
    point = ContactPoint.of(state.axis, state.momentum, top)
    velocity = point_velocity(state.velocity, point.turning, point.arm)
    form = ImpactForm(
        (kind.law,),
        (kind.coefficients,),
        kind.resists_rolling,
        ALONE,
        (SLIDES,),
        SLIDES if kind.resists_rolling else HELD,
        restores=False,
        ending=False,
    )
    motion = measured_motion(form)
    contacts = StruckContacts(
        response_of(point), (0.0, 0.0), (top.friction,), top.rolling_resistance
    )
    before = (*velocity, *point.turning)
    struck_numbers = StruckNumbers(contacts, before, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    numbers = np.array(np.broadcast_arrays(*struck_numbers.parameters, velocity[2])[:-1])
    count = numbers.shape[1]
    measure = top.mass * (length(velocity) + TINY) + np.zeros(count)
    pauses = np.repeat([[1.0] for _ in motion.guards] + [[0.0], [np.inf], [-np.inf]], count, axis=1)
    struck = np.zeros(count, dtype=bool)
    impulse, work = np.zeros((motion.size, count)), np.flatnonzero(velocity[2] < 0.0)
    impulse[-1] = measure
    for _ in range(MOST_PIECES):
        if not len(work):
            break
        jet = polynomials(motion, TOLERANCE)(impulse[:, work], numbers[:, work])
        course = arcs(jet, np.zeros(len(work)), LONGEST * measure[work], pauses[:, work])
        course.look_closer(jet, pauses[:, work])
        impulse[:, work], ended, branched = (
            course.after,
            course.fallen == 0.0,
            course.fallen == 1.0,
        )
        if branched.any():
            numbers[: kind.coefficients, work[branched]] = others(
                kind, numbers[: kind.coefficients, work[branched]]
            )
        struck[work[ended]] = True
        work = work[~ended & (branched | (course.span > 0.0))]
    impulse[:, ~struck] = 0.0
    x, y, z, *torque = impulse[:6]
    wrench = Wrench((x, y, z), (torque[0], torque[1], torque[2]))
    return struck_state(state, point, wrench), struck


@lru_cache(maxsize=64)
def measured_motion(form: ImpactForm) -> Motion:
    """Return the equations of an impact, with one more number that is constant: what is left out of
    the impulses, which begin at zero, is compared with it.
    """
    motion = impact_motion(form)

    def rates(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> tuple[Scalar, ...]:
        return (*motion.rates(y, numbers), 0.0 * y[-1])

    return replace(motion, rates=rates, size=motion.size + 1)


def others(kind: Kind, coefficients: Array) -> Array:
    """Return the numbers of laws on the branch that takes over."""
    law: Any = kind.law(*coefficients)
    return np.array(np.broadcast_arrays(*law.other_branch().coefficients(UNITS)))
