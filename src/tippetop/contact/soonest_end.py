"""Which velocity of a contact mode ends first at present rates, and how soon."""

import math

from tippetop.contact.closed_contacts import has_second
from tippetop.contact.contact_mode import ContactMode
from tippetop.contact.slip_end_mode import SlipEnd
from tippetop.mechanics.contacts.branches import is_branched, on_branch, on_limit_branch
from tippetop.mechanics.contacts.contact_point import ContactPoint
from tippetop.mechanics.contacts.forces import forces_and_accelerations, is_set_valued
from tippetop.mechanics.contacts.slip_clock import SlipComponent
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
    point = ContactPoint.of(state.axis, state.momentum, top, state.velocity[:2])
    rolling = point.turning[:2] if rolls_freely(top, state) else None
    return on_limit_branch(top, forces_and_accelerations(point, None, rolling)[0])


def soonest_end(mode: ContactMode, state: State) -> tuple[SlipEnd | None, float]:
    """Return the end of the velocity that ends first at present rates, and the time left.

    None, and infinity, where all grow or none can end. Of two contacts that slip, that of which
    slip ends comes first in the mode that is returned.
    """
    soonest: SlipEnd | None = None
    least = math.inf
    for ending in possible_ends(mode):
        contacts = ending.contact_mode.contacts(ending.contact_mode.numbers(state))
        component = ending.component
        time_left = time_to_end(contacts.velocity_of(component), contacts.rate_of(component))
        if time_left < least:
            soonest, least = ending, time_left
    return soonest, least


def possible_ends(mode: ContactMode) -> list[SlipEnd]:
    """Return the ends of all velocities of a mode that friction can end."""
    slips = not any(mode.sticks) and is_set_valued(mode.top.friction)
    ends = [SlipEnd.of(mode, SlipComponent(slip=True))] if slips else []
    rolls = mode.is_single and mode.top.resists_rolling and not mode.prevents_rolling
    if rolls:
        ends.append(SlipEnd.of(mode, SlipComponent(slip=False)))
    elif slips and has_second(mode, SlipComponent(slip=True)):
        ends.append(ends[0].of_second())
    return ends
