"""Two closed contacts of one body, which slip or stick: what the table does, and what it can hold.

The gaps change at gap_i'' = A_ij N_j + b_i with the normal forces N_i and the friction that goes
with them. Both stay closed where A N + b = 0 has N > 0: there c' = 0, and c'' with it. Both contact
points lie in the plane of the axis and the vertical, a_2 - a_1 = D e, with e the horizontal
direction of the axis and D constant, as the tilt is. While both stay closed the body turns about e
and the vertical only, so that with t = z x e

    v_2 = v_1 + zeta t,        zeta = D omega_z:

xi = (v_1, zeta) says how both slip. Where both stick, three of its components are held: along e the
points move as one, and what holds them may act at either; across e each is held by itself. With N_i
and the needed forces T_i across e and S along it, Coulomb's friction can where |T_i| <= mu N_i and

    |S| <= sqrt(mu^2 N_1^2 - T_1^2) + sqrt(mu^2 N_2^2 - T_2^2).

Patches that resist drilling both stick or neither does, as xi = 0. There nothing works, and the
body turns about the line that joins both contact points as fast as it did: in the frame that goes
with it nothing changes, both T_i are zero, and S is all that friction has to exert. Where rolling
is resisted the T_i are none any more but constant, and moments of drilling may take a share in what
holds the points across e.

What rolls turns about e, one way or the other: rolling resistance is a couple -+ length (N_1 + N_2)
e. Where omega_e = 0 it is any up to that, along e: across e the normal forces hold the body
already.
"""

from typing import TypeAlias

from tippetop.mechanics.contacts.contact_point import ContactPoint
from tippetop.mechanics.contacts.forces import (
    directions_of,
    rolling_constraints,
    slip_length,
    sticking_constraints,
)
from tippetop.mechanics.contacts.system import (
    Component,
    Constraint,
    ContactRates,
    moment_of,
    solve_constraints,
)
from tippetop.mechanics.contacts.wrench import Slip
from tippetop.mechanics.motion import axis_rate
from tippetop.mechanics.state import State
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import VERTICAL, Scalar, Vector, add, cross, dot, scale

Tops: TypeAlias = tuple[Top, ...]
"""A top with one, and with the other, of two of its surfaces active."""


ContactPair: TypeAlias = tuple[ContactPoint, ...]
"""Both contact points, the first one first."""


def apart(pair: ContactPair) -> Scalar:
    """D, how far the second contact is from the first along e, m."""
    e = directions_of(pair[0].axis)[0]
    return dot(pair[1].arm, e) - dot(pair[0].arm, e)


def slip_apart(pair: ContactPair) -> Scalar:
    """D omega_z, m/s."""
    return apart(pair) * pair[0].turning[2]


def turning_along(pair: ContactPair) -> Scalar:
    """omega_e, rad/s."""
    return dot(pair[0].turning, directions_of(pair[0].axis)[0])


def without_tilting(state: State, top: Top) -> State:
    """Return the state with c' = 0 and no sinking; the momentum changes across the axis alone."""
    n = state.axis
    rate = axis_rate(n, state.momentum, top)[2]
    part = top.transverse_inertia * rate / (n[0] * n[0] + n[1] * n[1])
    momentum = (state.momentum[0] - part * n[1], state.momentum[1] + part * n[0], state.momentum[2])
    return state._replace(momentum=momentum, velocity=(*state.velocity[:2], 0.0))


def slips_of(pair: ContactPair, xi: Slip) -> tuple[Slip, Slip]:
    """Return the slips of both contacts, with drilling if the law resists it."""
    across = directions_of(pair[0].axis)[1]
    first, second = (xi[0], xi[1]), (xi[0] + xi[2] * across[0], xi[1] + xi[2] * across[1])
    reach = slip_length(pair[0].top.friction)
    if reach is None:
        return first, second
    drilling = reach * xi[2] / apart(pair)
    return (*first, drilling), (*second, drilling)


def at_rest(
    pair: ContactPair, velocity: Vector, ended: tuple[bool, bool], *, stopped: bool
) -> tuple[Vector, Vector]:
    """Angular momentum and velocity after the impulses that end what is left of slip, and of
    rolling.

    They act at the contacts, and keep the normal velocities: what little slip is left goes as
    friction takes it.
    """
    omega = pair[0].turning
    velocities = ContactRates(
        tuple([add(velocity, cross(omega, point.arm)) for point in pair]), omega
    )
    held = [
        *sticking_constraints(pair, ended),
        *[Constraint.of(Component(number, VERTICAL)) for number in (0, 1)],
        *(rolling_constraints(pair, None) if stopped else []),
    ]
    impulses = solve_constraints(pair, held, velocities).wrenches
    momentum = add(pair[0].momentum, moment_of(pair, impulses))
    for _, impulse in impulses:
        velocity = add(velocity, scale(1.0 / pair[0].top.mass, impulse.force))
    return momentum, velocity
