"""Which velocity ends first at present rates, and how soon: slip or rolling of one contact, or the
slip of one of two.
"""

from tippetop.contact.contact_mode import ContactMode
from tippetop.contact.mode import BOTH
from tippetop.mechanics.contacts.branches import is_branched, on_branch, on_limit_branch
from tippetop.mechanics.contacts.contact_point import ContactPoint
from tippetop.mechanics.contacts.forces import forces_and_accelerations, is_set_valued, slip_length
from tippetop.mechanics.contacts.slip_end import SlipComponent
from tippetop.mechanics.contacts.slip_variables import is_rolling, slip_of, time_to_end
from tippetop.mechanics.motion import along_table
from tippetop.mechanics.state import State
from tippetop.mechanics.top import Top


def rolls_freely(top: Top, state: State) -> bool:
    """Return whether rolling is not held: it is not resisted, or the body rolls already."""
    return not top.resists_rolling or bool(is_rolling(state.axis, state.momentum, top))


def on_present_branch(top: Top, state: State, slips: bool) -> Top:
    """Return the top with the branch of its law that holds at present."""
    if not is_branched(top.friction):
        return top
    if slips:
        return on_branch(top, slip_of(*along_table(state), top))
    point = ContactPoint.of(state.axis, state.momentum, top)
    rolling = point.turning[:2] if rolls_freely(top, state) else None
    return on_limit_branch(top, forces_and_accelerations(point, None, rolling)[0])


def soonest_end(top: Top, state: State, slips: bool) -> tuple[SlipComponent | None, float]:
    """Return which velocity ends first at present rates, and the time left.

    None, and infinity, where all grow or none can end.
    """
    rolls, ends = rolls_freely(top, state), slips and is_set_valued(top.friction)
    possible = [SlipComponent(slip=True, held=not rolls)] if ends else []
    possible += [SlipComponent(slip=False, held=not slips)] if rolls and top.resists_rolling else []
    if not possible:
        return None, float("inf")
    sliding, branched = along_table(state), on_present_branch(top, state, slips)
    point = ContactPoint.of(state.axis, state.momentum, branched)
    slip = slip_of(*sliding, branched) if slips else None
    acceleration = forces_and_accelerations(point, slip, point.turning[:2] if rolls else None)[1]
    soonest, least = None, float("inf")
    for ending in possible:
        xi = ending.of(*sliding, branched)
        time_left = time_to_end(xi, ending.rate(acceleration, branched))
        if time_left < least:
            soonest, least = ending, time_left
    return soonest, least


def soonest_end_on_two(mode: ContactMode, state: State) -> tuple[int, float]:
    """Return on which of two contacts that slip it ends first at present rates, and the time left.

    On both (-1) where the law resists drilling. The time is infinite where none can end.
    """
    law = mode.top.friction
    if not is_set_valued(law):
        return BOTH, float("inf")
    numbers = mode.numbers(state)
    contacts = [BOTH] if slip_length(law) is not None else [0, 1]
    times = [time_to_end(*mode.slip_and_rate(numbers, number)) for number in contacts]
    soonest = times.index(min(times))
    return contacts[soonest], times[soonest]
