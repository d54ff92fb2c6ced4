"""In which direction slip, or rolling, begins where the table cannot hold it."""

from collections.abc import Callable, Sequence
from typing import NamedTuple, TypeAlias

from tippetop.mechanics.contacts.contact_point import Acceleration, ContactPoint
from tippetop.mechanics.contacts.forces import (
    forces_and_accelerations,
    rolling_reserve,
    slip_length,
    slip_reserve,
)
from tippetop.mechanics.contacts.slip_clock import SlipComponent
from tippetop.mechanics.contacts.slip_direction import Resisted, directions, directions_near
from tippetop.mechanics.contacts.slip_variables import inner, scaled, size
from tippetop.mechanics.contacts.wrench import Slip, Wrench
from tippetop.mechanics.motion import presses
from tippetop.mechanics.unsolved import Unsolved

CHOICES = ((True, False), (False, True), (True, True))
"""What is tried in turn where not all of slip and rolling that have ended is held: whether they go
on all the same.
"""

TableResponse: TypeAlias = Callable[
    [ContactPoint, Slip | None, Slip | None], tuple[Wrench, Acceleration]
]
"""Function from slip and rolling, None where they are held, to the wrench of the table and the
acceleration of the contact point.
"""

Motion: TypeAlias = tuple[Slip | None, Slip | None, Wrench, Acceleration]
"""Slip and rolling, or their directions, None where they are held; and what comes of them."""


class Onset(NamedTuple):
    """How the velocities of a contact go on."""

    slip: Slip | None
    rolling: Slip | None
    """Slip and rolling, or the directions in which they begin; None where they are held."""
    rates: tuple[float, ...]
    """At which rates R >= 0 those that begin grow, slip first."""
    wrench: Wrench
    acceleration: Acceleration
    """What the table does, and how the contact accelerates."""


def find_onset(
    point: ContactPoint,
    slip: Slip | None,
    rolling: Slip | None,
    begins: tuple[bool, bool],
    *,
    held: Wrench | None = None,
    near: Sequence[Slip] = (),
    moved: TableResponse = forces_and_accelerations,
) -> Onset:
    """Return the directions in which slip, or rolling, or both, begin, and the forces.

    Parameters
    ----------
    point
        The contact point, floats.
    slip, rolling
        Slip and horizontal angular velocity, None where they are zero.
    begins
        Whether slip, and rolling, begin; what is zero and does not is held.
    held
        What would hold what begins, if that is known and not both begin.
    near
        Approximate directions of what begins, slip first, if they are known.
    moved
        What the table does: in contact, or in an impact.

    Raises
    ------
    ArithmeticError
        If no such direction is found: more than one contact force may be consistent, or none.
    """
    parts = [
        SlipComponent(which)
        for which, goes_on in zip((True, False), begins, strict=True)
        if goes_on
    ]
    stiffness = [_stiffness(part, point) for part in parts]

    tried = list[tuple[Sequence[Slip], Motion]]()

    def motion(ways: Sequence[Slip]) -> Motion:
        if tried and tried[-1][0] is ways:
            return tried[-1][1]
        each = dict(zip([part.slip for part in parts], ways, strict=True))
        both = each.get(True, slip), each.get(False, rolling)
        result = (*both, *moved(point, *both))
        tried.append((ways, result))
        return result

    def response(ways: Sequence[Slip]) -> list[Resisted]:
        _, _, wrench, acceleration = motion(ways)
        return [
            Resisted(
                part.rate(acceleration, point.top), stiff * size(part.resisting(wrench, point.top))
            )
            for part, stiff in zip(parts, stiffness, strict=True)
        ]

    ways: list[Slip] = []
    if near:
        ways = directions_near(response, near)
    elif parts:
        # Against what would have held it; slip, if both begin, against what holds it once rolling
        # goes on.
        beside = (
            find_onset(point, slip, rolling, (False, True), moved=moved).rolling
            if all(begins)
            else rolling
        )
        against = held or moved(point, slip, beside)[0]
        ways = directions(
            response, [scaled(-1.0, part.resisting(against, point.top)) for part in parts]
        )
    onset = motion(ways)
    along = [inner(part.rate(onset[3], point.top), e) for part, e in zip(parts, ways, strict=True)]
    return Onset(onset[0], onset[1], tuple(max(rate, 0.0) for rate in along), onset[2], onset[3])


def contact_after_end(
    point: ContactPoint,
    slip: Slip | None,
    rolling: Slip | None,
    *,
    moved: TableResponse = forces_and_accelerations,
) -> tuple[Onset, tuple[bool, bool]]:
    """Return how a contact goes on after slip or rolling has ended, and which of them begin again.

    What is held goes first: a contact that strong friction can hold stays closed even where b > 0,
    so that opening would be consistent, too (Painleve's paradox).

    The arguments are those of `find_onset`; slip and rolling that have ended are None.

    Raises
    ------
    ArithmeticError
        If nothing can hold the contact, and it can go on in no direction.
    """
    ended = slip is None, rolling is None
    held = find_onset(point, slip, rolling, (False, False), moved=moved)
    within = _within_limits(point, held)
    if _is_pressed(point, held) and all(within):
        return held, (False, False)
    # Where friction holds one beside the other, however much that takes, it does not begin alone.
    holds = [_is_pressed(point, held) and part for part in within]
    for begins in CHOICES:
        if begins[0] > ended[0] or begins[1] > ended[1]:
            continue
        if not all(begins) and (holds[0] if begins[0] else holds[1]):
            continue
        try:
            onset = find_onset(point, slip, rolling, begins, moved=moved)
        except ArithmeticError:
            continue
        if _is_pressed(point, onset) and all(_within_limits(point, onset)):
            return onset, begins
    raise Unsolved("nothing can hold the contact, and there is no direction in which it can go on")


def _is_pressed(point: ContactPoint, onset: Onset) -> bool:
    """Return whether the table presses, or the weight does not."""
    weight = presses(point.axis, point.momentum, point.top, point.outer)
    return bool(onset.wrench.force[2] > 0.0 or not weight)


def _within_limits(point: ContactPoint, onset: Onset) -> tuple[bool, bool]:
    """Return whether slip, and rolling, if they are held, are so within friction's limits."""
    slip = onset.slip is not None or bool(slip_reserve(point.top, onset.wrench) >= 0.0)
    rolling = onset.rolling is not None or bool(
        rolling_reserve(point, onset.wrench, onset.slip) >= 0.0
    )
    return slip, rolling


def _stiffness(part: SlipComponent, point: ContactPoint) -> float:
    """Return a bound of the response of xi to what resists it, 1/kg or 1/(kg m^2)."""
    responses = [part.rate(point.response(unit), point.top) for unit in part.wrenches(point.top)]
    sizes = [abs(response[i]) for i, response in enumerate(responses)]
    return float(sum(sizes[:2]) + sum(sizes[2:]) * (slip_length(point.top.friction) or 0.0))
