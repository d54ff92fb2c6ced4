"""Guards of contact modes, by the status of each contact: their names and values.

A guard is a function of the closed contacts at an instant, which falls through zero where the mode
ends.
"""

from collections.abc import Callable
from typing import Any, TypeAlias

from tippetop.contact.closed_contacts import ClosedContacts
from tippetop.contact.mode import NUMBER_SIGN, numbered, split
from tippetop.contact.surfaces import WOBBLE, SurfaceGuard, surface_guards
from tippetop.mechanics.contacts.branches import has_limit_branches, is_branched, limit_guard
from tippetop.mechanics.contacts.forces import is_set_valued, slip_length
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
from tippetop.mechanics.vectors import Scalar

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

GuardValue: TypeAlias = tuple[str, Callable[[ClosedContacts], Scalar]]
"""Name of a guard, and its value at an instant."""


def guards_on_one(mode: Any) -> list[GuardValue]:
    """Return the guards of one contact: of what holds it, or of slip; of rolling; and of the body's
    shape.
    """
    guards = _sticking_on_one(mode) if mode.sticks[0] else _slipping_on_one(mode)
    if mode.prevents_rolling:
        guards.append((ROLLING, lambda now: now.rolling_reserve()))
    elif mode.top.resists_rolling:
        guards.append((ROLLING_STOPPING, _rolling_left))
    if is_edge(mode.top.surface):
        guards.append((WOBBLE, _wobble_on_one))
    return guards + [(name, _of_top(value)) for name, value in surface_guards(mode.top)]


def _sticking_on_one(mode: Any) -> list[GuardValue]:
    guards: list[GuardValue] = [(SLIP, lambda now: now.slip_reserve())]
    if has_limit_branches(mode.top.friction):
        guards.append((LIMIT_BRANCH, lambda now: limit_guard(now.mode.top, now.forces.wrenches[0])))
    return guards


def _slipping_on_one(mode: Any) -> list[GuardValue]:
    law, guards = mode.top.friction, list[GuardValue]()
    if not mode.pulls:
        guards.append((LIFT_OFF, lambda now: now.normal(0)))
    if is_set_valued(law) and mode.near:
        guards.append((STOPPING, lambda now: now.slip_left()))
        guards.append((SLIP_LARGE, lambda now: parting_guard(_sliding(now), now.mode.top)))
    elif is_set_valued(law):
        guards.append((SLIP_SMALL, lambda now: nearing_guard(_sliding(now), now.mode.top)))
    if hasattr(law, "branch_guard"):
        guards.append((BRANCH, _branch_on_one))
    return guards


def _sliding(now: ClosedContacts) -> SlidingState:
    return SlidingState.unpack(now.numbers)


def _branch_on_one(now: ClosedContacts) -> Scalar:
    """Return what is positive as long as the branch of the law holds."""
    direction, top = now.directed.slip, now.mode.top
    return branch_guard(slip_of(*_sliding(now), top) if direction is None else direction, top)


def _rolling_left(now: ClosedContacts) -> Scalar:
    """Return what is positive while rolling goes on for a while."""
    mode = now.mode
    if mode.slides_freely:
        rates = SlidingState.unpack(mode.rates(now.numbers))
        return rolling_stopping_guard(_sliding(now), rates, mode.top)
    return remaining(now.forces.points[0].turning[:2], now.forces.rates.turning[:2])


def _wobble_on_one(now: ClosedContacts) -> Scalar:
    """Return what is positive until the time left to the wobble of a body on an edge is known."""
    return wobble_guard(*split(now.numbers), now.normal_if_stuck(), now.mode.top)


def _of_top(value: SurfaceGuard) -> Callable[[ClosedContacts], Scalar]:
    return lambda now: value(now.mode.top, *split(now.numbers))


def guards_on_two(mode: Any) -> list[GuardValue]:
    """Return the guards of two contacts: of normal forces, of rolling, and of slip that ends or
    begins.

    While both contacts stay closed the tilt does not change, and no further surface comes to the
    table.
    """
    guards: list[GuardValue] = [(numbered(OPENING, number), _normal(number)) for number in (0, 1)]
    if mode.prevents_rolling:
        guards.append((ROLLING, lambda now: now.rolling_reserve()))
    elif mode.top.resists_rolling:
        guards.append((ROLLING_STOPPING, lambda now: now.mode.rolls * now.forces.rolling))
    if mode.is_mixed:
        return [*_turning_on_two(), *guards]
    return guards + (_sticking_on_two(mode) if mode.sticks[0] else _slipping_on_two(mode))


def _turning_on_two() -> list[GuardValue]:
    """Return the guards of what holds the first contact, and of slip on the second."""
    return [
        (numbered(SLIP, 0), lambda now: now.forces.reserve(0)),
        (ENDING, lambda now: now.mode.sense * slip_apart(now.points)),
    ]


def _sticking_on_two(mode: Any) -> list[GuardValue]:
    """Return the guards of what holds both contacts.

    An outer field changes what patches need: without one only rolling does.
    """
    if slip_length(mode.top.friction) is None or mode.top.field is not None:
        return [
            (numbered(SLIP, 0), lambda now: now.forces.sticking_reserve(0)),
            (numbered(SLIP, 1), lambda now: now.forces.sticking_reserve(1)),
            (SLIP, lambda now: now.forces.both_reserve),
        ]
    if not mode.rolls:
        return []
    return [
        (SLIP, lambda now: now.mode.rolls * now.forces.rolling - now.mode.slowest_rolling),
    ]


def _slipping_on_two(mode: Any) -> list[GuardValue]:
    """Return the guards of slip that is about to end, of both contacts at once if drilling is
    resisted, and of the branches of the law.
    """
    law, guards = mode.top.friction, list[GuardValue]()
    if slip_length(law) is not None:
        guards.append((STOPPING, lambda now: now.slip_left()))
    elif is_set_valued(law):
        guards += [(numbered(STOPPING, number), _slip_left(number)) for number in (0, 1)]
    if is_branched(law):
        guards += [(numbered(BRANCH, number), _branch(number)) for number in (0, 1)]
    return guards


def _normal(number: int) -> Callable[[ClosedContacts], Scalar]:
    return lambda now: now.normal(number)


def _slip_left(number: int) -> Callable[[ClosedContacts], Scalar]:
    return lambda now: now.slip_left(number)


def _branch(number: int) -> Callable[[ClosedContacts], Scalar]:
    def guard_value(now: ClosedContacts) -> Scalar:
        slip: Any = now.slips[number]
        return branch_guard(slip, now.mode.tops[number])

    return guard_value


def lasting_guards(mode: Any) -> list[GuardValue]:
    """Return the guards of a mode that hold, too, while one of its velocities begins or ends.

    Those of the ends of velocities do not: at its beginning or end a velocity has other ones.
    """
    ends = [SLIP_SMALL, SLIP_LARGE, STOPPING]
    if mode.is_single:
        ends.append(ROLLING_STOPPING)
    return [guard for guard in mode.guard_values() if guard[0].split(NUMBER_SIGN)[0] not in ends]
