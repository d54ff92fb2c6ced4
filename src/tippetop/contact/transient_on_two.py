"""The moments in which slip begins or ends on two closed contacts, both of which slip."""

from dataclasses import dataclass

from tippetop.contact.contact_mode import ContactMode
from tippetop.contact.mode import split
from tippetop.mechanics.contacts.contact_forces import ContactForces, forces_on_two
from tippetop.mechanics.contacts.contact_point import contact_points
from tippetop.mechanics.contacts.forces import Slips
from tippetop.mechanics.contacts.pair import slips_of
from tippetop.mechanics.contacts.slip_variables import velocity_of
from tippetop.mechanics.motion import on_table
from tippetop.mechanics.state import SlidingState, State
from tippetop.mechanics.vectors import Row


@dataclass(frozen=True)
class TransientOnTwo(ContactMode):
    """A moment in which slip begins or ends on two contacts.

    Its numbers are axis, angular momentum and xi (see `tippetop.mechanics.contacts.pair`).
    """

    def state(self, y: Row) -> State:
        """Return the state, with its height."""
        axis, momentum = split(y)
        momentum = self.stilled(axis, momentum)
        velocity = velocity_of(axis, momentum, (y[6], y[7]), self.top)
        return on_table(SlidingState(axis, momentum, velocity), self.top)

    def contact_forces(self, y: Row) -> tuple[ContactForces, Slips]:
        """Return the forces and accelerations, and the slips of both contacts."""
        pair = contact_points(*split(y), self.tops)
        slips = slips_of(pair, (y[6], y[7], y[8]))
        return forces_on_two(pair, slips, self.rolls), slips
