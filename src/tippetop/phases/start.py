"""The phase in which a launch begins."""

from tippetop.integrators.base import Array
from tippetop.mechanics.flight import gap, gap_rate
from tippetop.mechanics.motion import along_table, contact
from tippetop.mechanics.state import State
from tippetop.mechanics.top import Kind
from tippetop.mechanics.touchdown import Start
from tippetop.phases.base import Transition
from tippetop.phases.contact import FreeToFly, StopAtLiftOff
from tippetop.phases.flight import Flight
from tippetop.phases.sliding import Sliding

TOUCHING = 1e-12
"""Gap, and gap rate, in natural units, up to which a launch is one from rest on the table."""


def first_phase(
    kind: Kind, numbers: tuple[float, ...], state: Array, liftoff: str, restitution: float
) -> Transition:
    """How a run begins.

    Parameters
    ----------
    kind, numbers
        What kind of top it is, and its dimensionless numbers.
    state
        The whole state at launch, shape (16,).
    liftoff
        "ignore", "stop" or "fly".
    restitution
        Ratio of the normal impulses of restitution and compression.
    """
    if liftoff == "ignore":
        return Transition((), Sliding(kind, numbers, None), state)
    top = kind.top(numbers)
    launched = State.unpack(state.tolist())
    if liftoff == "stop":
        rule = StopAtLiftOff()
        sliding = along_table(launched)
        if contact(sliding.axis, sliding.momentum, sliding.velocity, top).push <= 0:
            return rule.lift_off(0.0, state)
        return Transition((), Sliding(kind, numbers, rule), state)
    free = FreeToFly(kind, numbers, restitution)
    if gap(launched, top) > TOUCHING:
        return Transition((), Flight(kind, numbers, free, Start.AIRBORNE), state)
    rate = gap_rate(launched, top)
    if rate > TOUCHING:
        return Transition((), Flight(kind, numbers, free, Start.REBOUND), state)
    if rate < -TOUCHING:
        return free.touchdown(0.0, state)
    return free.resting(0.0, state)
