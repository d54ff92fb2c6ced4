"""What a contact mode must keep: normal forces that press, and friction within its bounds.

The guards of a mode end it where one of these falls to zero; here they are for the monitor of runs,
which looks at every step whether the guards were seen.
"""

from collections.abc import Sequence
from typing import Any

from tippetop.mechanics.contacts.contact_forces import ContactForces
from tippetop.mechanics.contacts.forces import (
    Slips,
    rolling_reserve,
    slip_length,
    slip_reserve,
)
from tippetop.mechanics.vectors import Scalar


def least(values: Sequence[Scalar]) -> Scalar:
    """Return the least of some numbers, in plain operators; 0 of none."""
    if not values:
        return 0.0
    smallest = values[0]
    for value in values[1:]:
        smallest = 0.5 * (smallest + value - abs(smallest - value))
    return smallest


def held_reserve(mode: Any, forces: ContactForces, slips: Slips) -> Scalar | None:
    """Return the least reserve of what friction holds in a contact mode, N^2; None where it holds
    nothing.

    The couple that holds rolling is compared with its arm.
    """
    reserves = list[Scalar]()
    if mode.prevents_rolling:
        arm = mode.top.rolling_resistance.length
        rolling = (
            rolling_reserve(forces.points[0], forces.wrenches[0], slips[0])
            if mode.is_single
            else forces.rolling_reserve
        )
        reserves.append(rolling / (arm * arm))
    if mode.is_single and mode.sticks[0]:
        reserves.append(slip_reserve(mode.top, forces.wrenches[0]))
    elif mode.is_mixed:
        reserves.append(forces.reserve(0))
    elif mode.sticks[0] and slip_length(mode.top.friction) is None:
        reserves += [forces.sticking_reserve(0), forces.sticking_reserve(1), forces.both_reserve]
    return least(reserves) if reserves else None
