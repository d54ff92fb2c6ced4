"""How slip ends on two closed contacts, both of which slip, in the clock of `slip_end`.

Under Coulomb's friction the slip of one contact ends, xi = v_1, while that of the other goes on:
v_2 = v_1 + zeta t (see `pair`). The accelerations depend on the direction of v_1 and on v_2. Where
both end at the same instant, v_2 / |v_1| has a limit: zeta goes along as a number of its own beside
xi, so that nothing cancels. Where the law resists drilling, xi = (v_1, zeta) ends as one.
"""

from tippetop.mechanics.contacts.contact_forces import ContactForces, forces_on_two
from tippetop.mechanics.contacts.contact_point import contact_points
from tippetop.mechanics.contacts.pair import ContactPair, Tops, slips_of
from tippetop.mechanics.contacts.slip_end import SlipEndRates, SlipEndState
from tippetop.mechanics.contacts.slip_variables import inner, scaled
from tippetop.mechanics.contacts.wrench import Slip
from tippetop.mechanics.motion import axis_rate
from tippetop.mechanics.vectors import Scalar


def slips_in_clock(pair: ContactPair, state: SlipEndState) -> tuple[Slip, Slip]:
    """Return slips of both contacts that have their directions: what ends is a unit vector."""
    if len(state.direction) == 3:
        return slips_of(pair, state.direction)
    return state.direction, slips_beside(pair, state)[1]


def slips_beside(pair: ContactPair, state: SlipEndState) -> tuple[Slip, Slip]:
    """Return the slips of both contacts where that of the first ends."""
    first = scaled(state.speed, state.direction)
    return slips_of(pair, (*first, *state.velocity))


def forces_in_clock(state: SlipEndState, tops: Tops, rolls: float) -> ContactForces:
    """Return the forces and accelerations where the body rolls as signed, or not (0)."""
    pair = contact_points(state.axis, state.momentum, tops)
    return forces_on_two(pair, slips_in_clock(pair, state), rolls)


def rates_on_two(state: SlipEndState, forces: ContactForces) -> SlipEndRates:
    """Rates in time under the forces of both contacts; the wrench is that of the first."""
    xi = forces.rate[: len(state.direction)]
    tilting = axis_rate(state.axis, state.momentum, forces.points[0].top)
    wrench, acceleration = forces.wrenches[0], forces.acceleration(0)
    beside = forces.rate[len(state.direction) :]
    return SlipEndRates(tilting, forces.moment, beside, xi, wrench, acceleration)


def overtaking_on_two(state: SlipEndState, forces: ContactForces) -> Scalar:
    """Falls through zero where the slip of the second contact, at present rates, ends in half the
    time left to that of the first.
    """
    second = slips_beside(forces.points, state)[1]
    along = inner(forces.rate[:2], state.direction)
    closing = inner(second, forces.rates.points[1][:2])
    return state.speed * closing - 2.0 * inner(second, second) * along
