"""What an impact does to a body, and whether it rebounds."""

from typing import NamedTuple

from tippetop.contact.impact import Impact, impact
from tippetop.contact.touching import farthest_touching
from tippetop.mechanics.flight.free_motion import gap_rate
from tippetop.mechanics.state import State
from tippetop.mechanics.top import Top

SLOWEST_REBOUND = 1e-6
"""Rebound velocity, in units of sqrt(g R), below which a rebound is none and the top stays on the
table.

A rebound of this speed rises by half its square, 5e-13 radii. Without such an end, the bounces of a
top with restitution between 0 and 1 would be infinitely many in a finite time.
"""


class Collision(NamedTuple):
    """An impact, and whether the body leaves the table after it."""

    impact: Impact
    rebounds: bool


def collision(state: State, restitution: float, top: Top) -> Collision:
    """Return what an impact does; one that would hardly rebound has no restitution.

    Another surface that touches strikes too, or is pressed onto the table, or opens.

    It is followed to rounding whatever method the run has: what it leaves of slip that has ended
    must be rounding.

    Raises
    ------
    ArithmeticError
        If the impulse cannot be computed.
    """
    beside = farthest_touching(top, state)  # it strikes too, is closed, or may close meanwhile
    struck = impact(state, restitution, top, beside)
    rebounds = bool(gap_rate(struck.state, top) > SLOWEST_REBOUND)
    if restitution and not rebounds:
        steps = struck.steps
        struck = impact(state, 0.0, top, beside)
        struck = struck._replace(steps=steps + struck.steps)
    return Collision(struck, rebounds)
