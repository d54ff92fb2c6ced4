"""Dry friction in an impact once slip has come to a direction that it keeps.

As slip zeta changes by d zeta / dp = A(e), which depends on its direction e alone (see `dry_impact`), a
direction along which A(e) = R e stays so: all impulses then grow in a straight line, until slip has ended if
R < 0. Slip comes to such a direction much faster than it ends where one component of it answers much more to
friction than another, as sliding does on a small patch, on which drilling lasts: equations that are stiff.
"""

import math

from tippetop.mechanics.dry_impact import DryContact
from tippetop.mechanics.ending import Vanishing
from tippetop.mechanics.impulse import FUZZ, Goal, Impulse, first_reach
from tippetop.mechanics.rolling import Slip, Wrench, solve
from tippetop.mechanics.stick_slip import inner, plus, scaled, size, slip_part

SLIP = Vanishing(slip=True)

KEPT = 1e-8
"""How near, relatively, friction must be to what keeps the direction of slip to count as equal to it."""


def straight(dry: DryContact, impulse: Impulse, goal: Goal, guess: float) -> tuple[Impulse, bool] | None:
    """The impulse at the end of a straight line, and whether that is the goal: slip may end before.

    It is None if slip changes its direction, or begins, or rolling is resisted.
    """
    if dry.top.resists_rolling or (dry.ended and dry.way is not None) or goal(impulse) >= 0.0:
        return None
    line = _line(dry, impulse)
    if line is None:
        return None
    unit, longest = line
    along = dry.body.straight(impulse, unit)
    if longest < math.inf:
        end = along(longest)
        if goal(end) < 0.0:
            return end, False
        guess = longest
    return first_reach(along, goal, guess), True


def _line(dry: DryContact, impulse: Impulse) -> tuple[Slip, float] | None:
    """Force and torque per unit normal impulse on a straight line, and its length until slip ends."""
    slip, rolling = dry.parts(dry.body.velocities(impulse))
    unit = dry.friction(slip, rolling)
    if dry.ended:
        return unit, math.inf
    grip = SLIP.resisting(Wrench((unit[0], unit[1], 1.0), (unit[3], unit[4], unit[5])), dry.top)
    speed, holds = size(slip), size(grip)
    way, change = scaled(1.0 / speed, slip), slip_part(dry.body.change(unit), dry.reach)
    # What changes slip so, and what changes it along itself; their ratio in the metric of kinetic energy.
    doing, along = _impulse_for(dry, change), _impulse_for(dry, way)
    inertia = inner(way, along)
    rate = inner(way, doing) / inertia
    # Slip has a direction, and a rate, but for rounding.
    fuzz = FUZZ * dry.body.speed / speed
    if abs(rate) * inertia <= fuzz * holds:
        rate = 0.0
    wrong = plus(doing, scaled(-rate, along))
    # What grows along a wrong direction would go ever farther.
    if size(wrong) > (KEPT if rate > 0.0 else KEPT + fuzz) * holds:
        return None
    drilling = 0.0 if dry.reach is None else dry.reach * wrong[2]
    exact = plus(unit, (-wrong[0], -wrong[1], 0.0, 0.0, 0.0, -drilling))
    return exact, speed / -rate if rate < 0.0 else math.inf


def _impulse_for(dry: DryContact, change: Slip) -> Slip:
    """What changes slip so: impulses of force, and that of a drilling torque over the law's length."""
    held, lengths = ((0, 1), (1.0, 1.0)) if dry.reach is None else ((0, 1, 5), (1.0, 1.0, dry.reach))
    pairs, response = list(zip(held, lengths, strict=True)), dry.body.response
    return tuple(solve([[a * response[i][j] * b for j, b in pairs] for i, a in pairs], list(change)))
