"""Equations of motion of one contact while slip, rolling, or both, begin or end."""

from collections.abc import Sequence
from functools import lru_cache
from typing import Any

from tippetop.contact.mode import split
from tippetop.contact.surfaces import surface_guards
from tippetop.mechanics.contacts.branches import has_limit_branches, limit_guard
from tippetop.mechanics.contacts.contact_point import ContactPoint
from tippetop.mechanics.contacts.forces import (
    forces_and_accelerations,
    rolling_reserve,
    slip_reserve,
)
from tippetop.mechanics.contacts.slip_collocation import SlipMotion
from tippetop.mechanics.contacts.slip_end import SlipComponent
from tippetop.mechanics.contacts.slip_variables import branch_guard, scaled, slip_of
from tippetop.mechanics.lying_down import wobble_guard
from tippetop.mechanics.motion import axis_rate
from tippetop.mechanics.surfaces.hull import is_edge
from tippetop.mechanics.top import Kind
from tippetop.mechanics.vectors import Scalar

SLIP_AND_ROLLING = (SlipComponent(slip=True), SlipComponent(slip=False))
"""Slip and rolling, which begin together."""


@lru_cache
def onset_motion(kind: Kind, begins: tuple[SlipComponent, ...], guarded: bool) -> SlipMotion:
    """Return the equations of motion for tops of a kind.

    Their numbers are axis, angular momentum, the horizontal velocity of the centre of mass where
    that is free, and the velocities that begin. Their margins are what would end the mode in which
    that happens: if `guarded`, the normal force; a reserve of what is held; the branch of the law;
    the wobble of a body on an edge; and the gaps of other surfaces.

    Parameters
    ----------
    kind
        The kind of top.
    begins
        One component, or `SLIP_AND_ROLLING`.
    guarded
        Whether the table cannot pull.
    """
    first, top = begins[0], kind.example
    free = 8 if first.moves else 6
    counts = [len(component.wrenches(top)) for component in begins]
    velocities = tuple([(free + sum(counts[:i]), count) for i, count in enumerate(counts)])
    prevents_rolling = first.slip and first.held and top.resists_rolling
    holds_slip = not first.slip and first.held
    branches = not holds_slip and hasattr(top.friction, "branch_guard")
    limits = holds_slip and has_limit_branches(top.friction)
    wobbles, surfaces = is_edge(top.surface), surface_guards(top)

    def rates(
        numbers: Sequence[Scalar], ways: Sequence[Any], parameters: Sequence[Scalar]
    ) -> tuple[Sequence[Any], Sequence[Any]]:
        body = kind.top(tuple(parameters))
        axis, momentum = split(numbers)
        point = ContactPoint.of(axis, momentum, body)
        slip: Any = None
        rolling: Any = None
        if first.slip:
            slip = ways[0]
            rolling = None if first.held else point.turning[:2]
        elif first.moves:
            slip = slip_of(axis, momentum, (numbers[6], numbers[7]), body)
        if not begins[-1].slip:
            rolling = ways[-1]
        wrench, acceleration = forces_and_accelerations(point, slip, rolling)
        changes = [*axis_rate(axis, momentum, body), *point.moment(wrench)]
        if first.moves:
            changes += [*scaled(1.0 / body.mass, wrench.force[:2])]
        for component in begins:
            changes += [*component.rate(acceleration, body)]
        margins = [wrench.force[2]] if guarded else []
        if prevents_rolling:
            margins.append(rolling_reserve(point, wrench, slip))
        if holds_slip:
            margins.append(slip_reserve(body, wrench))
        if branches:
            margins.append(branch_guard(slip, body))
        if limits:
            margins.append(limit_guard(body, wrench))
        if wobbles:
            normal = wrench.force[2] if holds_slip else None
            margins.append(wobble_guard(axis, momentum, normal, body))
        margins += [value(body, axis, momentum) for _, value in surfaces]
        return changes, margins

    margins = [guarded, prevents_rolling, holds_slip, branches, limits, wobbles]
    count = sum(margins) + len(surfaces)
    return SlipMotion(rates, free + sum(counts), velocities, kind.numbers, count)
