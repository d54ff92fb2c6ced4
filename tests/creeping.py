"""What the equations of slip say at an instant: how a body creeps, and which way slip begins."""

from typing import NamedTuple

from tippetop.mechanics.contacts.contact_point import ContactPoint, flat
from tippetop.mechanics.contacts.forces import forces_and_accelerations, slip_length
from tippetop.mechanics.contacts.onset_forces import find_onset
from tippetop.mechanics.contacts.slip_variables import slip_part
from tippetop.mechanics.motion import axis_rate


class CreepRates(NamedTuple):
    """Rates Y of axis and angular momentum, and the rate A of the slip."""

    axis: tuple
    momentum: tuple
    slip: tuple


def creep_rates(axis, momentum, slip, top):
    """Rates of a slipping body; `slip` may be its direction only."""
    point = ContactPoint.of(axis, momentum, top)
    wrench, acceleration = forces_and_accelerations(point, slip, point.turning[:2])
    rate = slip_part(flat(acceleration), slip_length(top.friction))
    return CreepRates(axis_rate(axis, momentum, top), point.moment(wrench), rate)


def direction_of_slip(axis, momentum, top):
    """Direction in which a rolling body that cannot stick slips, and the rate of its speed."""
    point = ContactPoint.of(axis, momentum, top)
    found = find_onset(point, None, point.turning[:2], (True, False))
    return found.slip, found.rates[0]
