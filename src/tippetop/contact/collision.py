"""What an impact does to a body, by the quickest method that applies, and whether it rebounds."""

from typing import NamedTuple

from tippetop.contact.striking import impact_of_patch
from tippetop.contact.touching import SLOWEST_ROCKING, other_touching
from tippetop.integrators.base import Integrator
from tippetop.mechanics.flight.free_motion import gap_rate
from tippetop.mechanics.impacts.impact import Impact, begins_without_approach, impact
from tippetop.mechanics.impacts.impact_on_two import SlipEndsInImpact
from tippetop.mechanics.state import State
from tippetop.mechanics.top import Top
from tippetop.mechanics.unsolved import Unsolved

SLOWEST_REBOUND = 1e-6
"""Rebound velocity, in units of sqrt(g R), below which a rebound is none and the top stays on the
table.

A rebound of this speed rises by half its square, 5e-13 radii. Without such an end, the bounces of a
top with restitution between 0 and 1 would be infinitely many in a finite time.
"""


UNKNOWN_HOLD = "slip ends on one of two surfaces that jam together, and what then holds it is open"
"""Why the impulse of two contacts that jam together cannot be found."""


class Collision(NamedTuple):
    """An impact, and whether the body leaves the table after it."""

    impact: Impact
    rebounds: bool


def collision(
    state: State, restitution: float, top: Top, integrator: Integrator | None
) -> Collision:
    """Return what an impact does; one that would hardly rebound has no restitution.

    Raises
    ------
    ArithmeticError
        If the impulse cannot be computed.
    """
    struck = _impact(state, restitution, top, integrator)
    rebounds = bool(gap_rate(struck.state, top) > SLOWEST_REBOUND)
    if restitution and not rebounds:
        steps = struck.steps
        struck = _impact(state, 0.0, top, integrator)
        struck = struck._replace(steps=steps + struck.steps)
    return Collision(struck, rebounds)


def _impact(state: State, restitution: float, top: Top, integrator: Integrator | None) -> Impact:
    """Return the impact of the active surface alone, unless it presses another one that touches.

    Where slip ends meanwhile, under a law that leaves the force open then, the surfaces strike in
    turns.
    """
    single = None if restitution else impact_of_patch(state, top, integrator)
    if single is None:
        single = impact(state, restitution, top)
    for neighbour in other_touching(top, single.state):
        # Two contacts may jam of which neither does alone.
        jams = not single.impulse and begins_without_approach(state, top, neighbour)
        pressed = jams or gap_rate(single.state, neighbour) < -SLOWEST_ROCKING
        if pressed and abs(gap_rate(state, neighbour)) <= SLOWEST_ROCKING:
            try:
                both = impact(state, restitution, top, neighbour)
            except SlipEndsInImpact:
                if jams:
                    raise Unsolved(UNKNOWN_HOLD) from None
                return single
            return both._replace(steps=single.steps + both.steps)
    return single
