"""The forces of one contact that sticks and rolls freely, in the fewest operations.

Where the contact point stays at rest and nothing holds rolling, the equations are those of omega'
alone, since F = -m (gamma + omega' x a), gamma = -g z + f0 / m + omega x a':

    (1/J + m a^2 - m a a) omega' = (1/J) k omega3 n' + m0 - m a x gamma + t,

Let e = (n_x, n_y), no unit vector here: the horizontal part of a is -h' e. The matrix maps a
horizontal rate w and omega_z' to alpha w + (beta (e.w) + kappa omega_z') e and kappa (e.w) + delta
omega_z', where

    alpha = I1 + m h^2 + m h'^2 e^2,          beta = I3 - I1 - m h'^2,
    delta = I1 + (I3 - I1) c^2 + m h'^2 e^2,  kappa = (I3 - I1) c - m h h'.

The forces are those of `tippetop.mechanics.contacts.system`.
"""

from tippetop.mechanics.contacts.contact_point import Acceleration, ContactPoint
from tippetop.mechanics.contacts.wrench import Wrench
from tippetop.mechanics.laws.friction import NO_TORQUE
from tippetop.mechanics.surfaces.surface import support_at
from tippetop.mechanics.vectors import add, cross, scale


def sticking_forces(point: ContactPoint, drills: bool) -> tuple[Wrench, Acceleration]:
    """Return the wrench that keeps the contact point at rest, and the acceleration under it.

    Drilling stays constant too unless the contact drills freely.
    """
    top, n, c = point.top, point.axis, point.axis[2]
    height, slope, _ = support_at(n, top.surface)
    leaning, excess = n[0] * n[0] + n[1] * n[1], top.axial_inertia - top.transverse_inertia
    high, steep = top.mass * (height * height), top.mass * (slope * slope)
    lever = top.mass * (height * slope)
    wide, leant = steep * leaning, top.transverse_inertia + excess * leaning
    alpha, beta, kappa = (
        top.transverse_inertia + high + wide,
        excess - steep,
        excess * c - lever,
    )
    along = leant + high  # alpha + beta e^2
    carried = scale(-top.mass, cross(point.arm, point.carried))
    right = add(point.spun, carried)
    driven = n[0] * right[0] + n[1] * right[1]
    if drills:
        upright, across = (
            top.transverse_inertia + excess * (c * c),
            2.0 * excess * c * lever * leaning,
        )
        # (alpha + beta e^2) delta - kappa^2 e^2, without what cancels in it.
        determinant = (
            top.transverse_inertia * top.axial_inertia + leant * wide + upright * high + across
        )
        delta = upright + wide
        leans = (delta * driven - kappa * leaning * right[2]) / determinant
        spins, torque = (along * right[2] - kappa * driven) / determinant, NO_TORQUE
    else:
        leans, spins = driven / along, 0.0
        torque = (0.0, 0.0, kappa * leans - right[2])
    aside = beta * leans + kappa * spins if drills else beta * leans
    x, y = [(right[i] - aside * n[i]) / alpha for i in (0, 1)]
    turning = (x, y, spins)
    force = scale(-top.mass, add(point.carried, cross(turning, point.arm)))
    return Wrench(force, torque), Acceleration(NO_TORQUE, turning)
