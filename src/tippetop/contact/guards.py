"""Guards of contact modes, by the status of each contact: their names and values.

A guard is a function of a mode and its numbers, which falls through zero where the mode ends.
"""

from collections.abc import Callable
from typing import Any, TypeAlias

from tippetop.contact.mode import BOTH, numbered, split
from tippetop.contact.surfaces import WOBBLE, SurfaceGuard, surface_guards
from tippetop.mechanics.contacts.branches import has_limit_branches, is_branched, limit_guard
from tippetop.mechanics.contacts.contact_forces import ContactForces
from tippetop.mechanics.contacts.contact_point import contact_points
from tippetop.mechanics.contacts.forces import (
    is_set_valued,
    rolling_reserve,
    slip_length,
    slip_reserve,
)
from tippetop.mechanics.contacts.pair import slip_apart
from tippetop.mechanics.contacts.slip_variables import (
    branch_guard,
    nearing_guard,
    parting_guard,
    remaining,
    rolling_stopping_guard,
    slip_of,
)
from tippetop.mechanics.lying_down import wobble_guard
from tippetop.mechanics.state import SlidingState
from tippetop.mechanics.surfaces.hull import is_edge
from tippetop.mechanics.vectors import Row, Scalar

LIFT_OFF, OPENING = "lift-off", "opening"
"""The normal force of the only contact, or of one of two, falls to zero."""

SLIP, ROLLING = "slip", "rolling"
"""Friction can no longer prevent slip, or the couple of rolling resistance rolling, which is a
horizontal angular velocity everywhere here.
"""

STOPPING, ROLLING_STOPPING, ENDING = "stopping", "rolling stopping", "ending"
"""Slip, or rolling, is about to end; or the body has stopped turning about one of two contacts."""

SLIP_SMALL, SLIP_LARGE = "slip small", "slip large"
"""Slip falls below `slip_variables.NEAR`, where its end begins to be guarded, or grows beyond
`APART`, where it no longer is.
"""

BRANCH, LIMIT_BRANCH = "branch", "limit branch"
"""Another branch of the law, or of its limit surface, takes over."""

GuardValue: TypeAlias = tuple[str, Callable[[Any, Row], Scalar]]
"""Name of a guard, and its value from a mode and the numbers of that."""


def guards_on_one(mode: Any) -> list[GuardValue]:
    """Return the guards of one contact: of what holds it, or of slip; of rolling; and of the body's
    shape.
    """
    guards = _sticking_on_one(mode) if mode.sticks[0] else _slipping_on_one(mode)
    if mode.prevents_rolling:
        guards.append((ROLLING, _rolling_reserve))
    elif mode.top.resists_rolling:
        guards.append((ROLLING_STOPPING, _rolling_left))
    if is_edge(mode.top.surface):
        guards.append((WOBBLE, _wobble_on_one))
    return guards + [(name, _of_top(value)) for name, value in surface_guards(mode.top)]


def _sticking_on_one(mode: Any) -> list[GuardValue]:
    guards: list[GuardValue] = [
        (SLIP, lambda mode, y: slip_reserve(mode.top, _forces(mode, y).wrenches[0]))
    ]
    if has_limit_branches(mode.top.friction):
        guards.append(
            (LIMIT_BRANCH, lambda mode, y: limit_guard(mode.top, _forces(mode, y).wrenches[0]))
        )
    return guards


def _slipping_on_one(mode: Any) -> list[GuardValue]:
    law, guards = mode.top.friction, list[GuardValue]()
    if not mode.pulls:
        guards.append((LIFT_OFF, _normal(0)))
    if is_set_valued(law) and mode.near:
        guards.append((STOPPING, lambda mode, y: mode.slip_left(y)))
        guards.append((SLIP_LARGE, lambda mode, y: parting_guard(SlidingState.unpack(y), mode.top)))
    elif is_set_valued(law):
        guards.append((SLIP_SMALL, lambda mode, y: nearing_guard(SlidingState.unpack(y), mode.top)))
    if hasattr(law, "branch_guard"):
        guards.append((BRANCH, _branch_on_one))
    return guards


def _branch_on_one(mode: Any, y: Row) -> Scalar:
    """Positive as long as the branch of the law holds."""
    return branch_guard(slip_of(*SlidingState.unpack(y), mode.top), mode.top)


def _rolling_reserve(mode: Any, y: Row) -> Scalar:
    """Positive while the table can exert the couple that holds rolling."""
    forces, slips = mode.contact_forces(y)
    return rolling_reserve(forces.points[0], forces.wrenches[0], slips[0])


def _rolling_left(mode: Any, y: Row) -> Scalar:
    """Positive while rolling goes on for a while."""
    if mode.slides_freely:
        rates = SlidingState.unpack(mode.rates(y))
        return rolling_stopping_guard(SlidingState.unpack(y), rates, mode.top)
    forces = _forces(mode, y)
    return remaining(forces.points[0].turning[:2], forces.rates.turning[:2])


def _wobble_on_one(mode: Any, y: Row) -> Scalar:
    """Positive until the time left to the wobble of a body on an edge is known."""
    return wobble_guard(*split(y), mode.normal_if_stuck(y), mode.top)


def _of_top(value: SurfaceGuard) -> Callable[[Any, Row], Scalar]:
    return lambda mode, y: value(mode.top, *split(y))


def guards_on_two(mode: Any) -> list[GuardValue]:
    """Return the guards of two contacts: of normal forces, of rolling, and of slip that ends or
    begins.

    While both contacts stay closed the tilt does not change, and no further surface comes to the
    table.
    """
    guards: list[GuardValue] = [(numbered(OPENING, number), _normal(number)) for number in (0, 1)]
    if mode.prevents_rolling:
        guards.append((ROLLING, lambda mode, y: _forces(mode, y).rolling_reserve))
    elif mode.top.resists_rolling:
        guards.append((ROLLING_STOPPING, lambda mode, y: mode.rolls * _forces(mode, y).rolling))
    if mode.is_mixed:
        return [*_turning_on_two(), *guards]
    return guards + (_sticking_on_two(mode) if mode.sticks[0] else _slipping_on_two(mode))


def _turning_on_two() -> list[GuardValue]:
    """Return the guards of what holds the first contact, and of slip on the second."""
    return [
        (numbered(SLIP, 0), lambda mode, y: _forces(mode, y).reserve(0)),
        (
            ENDING,
            lambda mode, y: mode.sense * slip_apart(contact_points(*split(y), mode.tops)),
        ),
    ]


def _sticking_on_two(mode: Any) -> list[GuardValue]:
    """Return the guards of what holds both contacts."""
    if slip_length(mode.top.friction) is None:
        return [
            (numbered(SLIP, 0), lambda mode, y: _forces(mode, y).sticking_reserve(0)),
            (numbered(SLIP, 1), lambda mode, y: _forces(mode, y).sticking_reserve(1)),
            (SLIP, lambda mode, y: _forces(mode, y).both_reserve),
        ]
    if not mode.rolls:
        return []
    return [
        (SLIP, lambda mode, y: mode.rolls * _forces(mode, y).rolling - mode.slowest_rolling),
    ]


def _slipping_on_two(mode: Any) -> list[GuardValue]:
    """Return the guards of slip that is about to end, of both contacts at once if drilling is
    resisted, and of the branches of the law.
    """
    law, guards = mode.top.friction, list[GuardValue]()
    if slip_length(law) is not None:
        guards.append((STOPPING, lambda mode, y: remaining(*mode.slip_and_rate(y, BOTH))))
    elif is_set_valued(law):
        guards += [(numbered(STOPPING, number), _slip_left(number)) for number in (0, 1)]
    if is_branched(law):
        guards += [(numbered(BRANCH, number), _branch(number)) for number in (0, 1)]
    return guards


def _forces(mode: Any, y: Row) -> ContactForces:
    forces: ContactForces = mode.contact_forces(y)[0]
    return forces


def _normal(number: int) -> Callable[[Any, Row], Scalar]:
    return lambda mode, y: _forces(mode, y).wrenches[number].force[2]


def _slip_left(number: int) -> Callable[[Any, Row], Scalar]:
    return lambda mode, y: remaining(*mode.slip_and_rate(y, number))


def _branch(number: int) -> Callable[[Any, Row], Scalar]:
    return lambda mode, y: branch_guard(mode.contact_forces(y)[1][number], mode.tops[number])
