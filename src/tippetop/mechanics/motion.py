"""Equations of motion of a body of revolution that slides on the table.

The centre of mass moves by m u' = F + f0, the angular momentum about it by L' = a x F + N t + m0,
and the axis by n' = L x n / I1. Here F = N (z + f) is the contact force, N t its drilling torque, a
the contact vector, and f0 and m0 are the force and the couple of the outer field. The normal force
N follows from differentiating the constraint z = h(n_z) twice. The variables have no singularity,
and the right-hand side is algebraic.
"""

from typing import NamedTuple

from tippetop.mechanics.field import OuterForces
from tippetop.mechanics.laws.friction import Traction
from tippetop.mechanics.state import SlidingState, State
from tippetop.mechanics.surfaces.surface import contact_vector, support_at
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import VERTICAL, Horizontal, Scalar, Vector, add, cross, dot, scale

ROUNDING = 1e-13
"""Rounding of the gap's acceleration and of the axis after a run, relative to the largest part of
the former and to 1. Less calls rounding a force; more hides as weak a force.
"""


class SlidingContact(NamedTuple):
    """The geometry, kinematics and forces of the contact at an instant."""

    arm: Vector
    """Contact vector a, from the centre of mass to the contact point, m."""
    slip: Horizontal
    """Slip velocity: horizontal velocity of the body's point of contact, m/s."""
    spin: Vector
    """Angular velocity omega, rad/s."""
    traction: Traction
    """Friction force and torque per unit normal force."""
    outer: OuterForces | None
    """What the outer field does, if there is one."""
    free_acceleration: Scalar
    """Acceleration b of the gap there would be without a contact force, m/s^2."""
    delassus: Scalar
    """Acceleration A of the gap per unit normal force with the friction that goes with it, 1/kg.
    Where it is negative no contact force is consistent if b < 0, and two are, zero and -b / A, if
    b > 0 (Painleve's paradox).
    """

    @property
    def normal_force(self) -> Scalar:
        """Normal force of the table that keeps the gap closed, -b / A, N."""
        return -self.free_acceleration / self.delassus

    @property
    def force(self) -> Vector:
        """Force of the table, N."""
        normal, (x, y) = self.normal_force, self.traction.force
        return (normal * x, normal * y, normal)

    @property
    def torque(self) -> Vector:
        """Torque of the table about the contact point, N m."""
        return scale(self.normal_force, self.traction.torque)

    @property
    def power(self) -> Scalar:
        """Power of friction, N (f.v + t.omega), W: never positive while the table pushes."""
        (x, y), torque = self.traction.force, self.traction.torque
        return self.normal_force * (x * self.slip[0] + y * self.slip[1] + dot(torque, self.spin))


def axial_spin(axis: Vector, momentum: Vector, top: Top) -> Scalar:
    """Angular velocity about the axis of symmetry, omega3 = L.n / I3, rad/s."""
    return dot(momentum, axis) / top.axial_inertia


def angular_velocity(axis: Vector, momentum: Vector, top: Top) -> Vector:
    """Angular velocity of the body, L/I1 + (I1 - I3)/I1 omega3 n, rad/s."""
    excess = (top.transverse_inertia - top.axial_inertia) / top.transverse_inertia
    along = excess * axial_spin(axis, momentum, top)
    return add(scale(1.0 / top.transverse_inertia, momentum), scale(along, axis))


def axis_rate(axis: Vector, momentum: Vector, top: Top) -> Vector:
    """Rate of change of the axis, L x n / I1, 1/s."""
    return scale(1.0 / top.transverse_inertia, cross(momentum, axis))


def point_velocity(velocity: Vector, omega: Vector, arm: Vector) -> Vector:
    """Velocity of the body's point at `arm` from the centre of mass, m/s."""
    return add(velocity, cross(omega, arm))


def contact_swing(axis: Vector, momentum: Vector, top: Top) -> Horizontal:
    """Horizontal velocity of the contact point relative to the centre of mass, omega x a, m/s.

    On a sphere of radius r that is -h' n' - r omega x z, in fewer products, as a = -h' n - r z and
    n' = omega x n. Near the edge of a disk, both parts are large and would cancel.
    """
    omega, surface = angular_velocity(axis, momentum, top), top.surface
    if not surface.spherical:
        x, y, _ = cross(omega, contact_vector(axis, surface))
        return (x, y)
    tilting, slope, radius = (
        axis_rate(axis, momentum, top),
        surface.slope(axis[2]),
        surface.height(0.0),
    )
    return (-(slope * tilting[0] + radius * omega[1]), radius * omega[0] - slope * tilting[1])


def sliding_contact(
    axis: Vector, momentum: Vector, velocity: Horizontal, top: Top
) -> SlidingContact:
    """Geometry, slip and contact force of the body on the table.

    Parameters
    ----------
    axis, momentum, velocity
        Axis n, angular momentum L (kg m^2/s) and horizontal velocity u of the centre of mass (m/s).
    top
        The body, the friction law and gravity.

    Notes
    -----
    The second derivative of the gap z - h(c), c = n_z, is A N + b with b of `free_acceleration` and
    A of `driven_acceleration`, by z + f and a x (z + f) + t.
    """
    arm = contact_vector(axis, top.surface)
    omega = angular_velocity(axis, momentum, top)
    swing = contact_swing(axis, momentum, top)
    slip = (velocity[0] + swing[0], velocity[1] + swing[1])
    traction = top.traction(slip, omega)

    outer = outer_forces(axis, momentum, velocity, top)
    free = free_acceleration(axis, momentum, top, outer)
    delassus = driven_acceleration(axis, 1.0, moment_per_normal_force(arm, traction), top)
    return SlidingContact(arm, slip, omega, traction, outer, free, delassus)


def outer_forces(
    axis: Vector, momentum: Vector, velocity: Horizontal | None, top: Top
) -> OuterForces | None:
    """Return what the outer field does to a body that touches the table; None without a field.

    Parameters
    ----------
    axis, momentum
        Axis n, and angular momentum L, kg m^2/s.
    velocity
        Horizontal velocity of the centre of mass, m/s; None where the contact point is at rest.
    top
        The body.
    """
    if top.field is None:
        return None
    if top.field.drag is None:
        return outer_forces_in(axis, momentum, (0.0, 0.0, 0.0), top)
    if velocity is None:
        x, y = contact_swing(axis, momentum, top)
        velocity = (-x, -y)
    sinking = support_at(axis, top.surface)[1] * axis_rate(axis, momentum, top)[2]
    return outer_forces_in(axis, momentum, (velocity[0], velocity[1], sinking), top)


def outer_forces_in(
    axis: Vector, momentum: Vector, velocity: Vector, top: Top
) -> OuterForces | None:
    """Return what the outer field does to a body whose centre of mass has this velocity, m/s."""
    field = top.field
    if field is None:
        return None
    force = field.air_force(velocity)
    if field.slope is not None:
        east, north = field.slope
        force = (force[0] + top.mass * east, force[1] + top.mass * north, force[2])
    if not field.resists_turning:
        return OuterForces(force, (0.0, 0.0, 0.0))
    spin = axial_spin(axis, momentum, top)
    return OuterForces(force, field.couple(axis, spin, angular_velocity(axis, momentum, top)))


def air_power(axis: Vector, momentum: Vector, velocity: Vector, top: Top) -> Scalar:
    """Return the power of air, W, which is not positive."""
    field = top.field
    if field is None or not field.has_air:
        return 0.0
    power = dot(field.air_force(velocity), velocity)
    if not field.resists_turning:
        return power
    turning = angular_velocity(axis, momentum, top)
    return power + dot(field.couple(axis, axial_spin(axis, momentum, top), turning), turning)


def free_acceleration(
    axis: Vector, momentum: Vector, top: Top, outer: OuterForces | None
) -> Scalar:
    """Acceleration of the gap without a contact force, m/s^2.

    It is -(g + h'' c'^2 + h' [L x n']_z / I1) and that of the outer forces, if there are any.
    """
    bending, swinging = turning_parts(axis, momentum, top)
    falling = -(top.gravity + (bending + swinging))
    if outer is None:
        return falling
    return falling + driven_acceleration(axis, outer.force[2], outer.couple, top)


def turning_parts(axis: Vector, momentum: Vector, top: Top) -> Horizontal:
    """Return the parts h'' c'^2 and h' [L x n']_z / I1 of the free acceleration, m/s^2."""
    turning = axis_rate(axis, momentum, top)
    _, slope, curvature = support_at(axis, top.surface)
    lever = slope / top.transverse_inertia
    bending = curvature * turning[2] * turning[2]
    return bending, lever * cross(momentum, turning)[2]


def driven_acceleration(axis: Vector, upwards: Scalar, moment: Vector, top: Top) -> Scalar:
    """Return the gap acceleration F/m - (h'/I1) [M x n]_z of an upward force F, N, and a moment M,
    N m.
    """
    lever = support_at(axis, top.surface)[1] / top.transverse_inertia
    return upwards / top.mass - lever * cross(moment, axis)[2]


def presses(axis: Vector, momentum: Vector, top: Top, outer: OuterForces | None) -> Scalar:
    """Return whether the gap would close without a contact force, by more than rounding.

    A truth value of floats, or an array of them.
    """
    bending, swinging = turning_parts(axis, momentum, top)
    sinking = -free_acceleration(axis, momentum, top, outer)
    lever = abs(support_at(axis, top.surface)[1]) / top.transverse_inertia
    error = ROUNDING * lever * dot(momentum, momentum) / top.transverse_inertia
    return sinking > ROUNDING * (top.gravity + abs(bending) + abs(swinging)) + error


def falls_by_zero(normal: Scalar, axis: Vector, momentum: Vector, top: Top) -> Scalar:
    """Return whether a normal force -b / A changes its sign because b does, not A.

    Where b is zero the force is, too; where A is, it is beyond all bounds. So what tells is whether
    it is less than the mass times the parts of b: neither case comes anywhere near that. A truth
    value of floats, or an array of them.
    """
    bending, swinging = turning_parts(axis, momentum, top)
    return abs(normal) < top.mass * (top.gravity + abs(bending) + abs(swinging))


def moment_per_normal_force(arm: Vector, traction: Traction) -> Vector:
    """Moment of the contact force about the centre of mass per unit normal force, a x (z + f) + t,
    m.
    """
    force = (traction.force[0], traction.force[1], VERTICAL[2])
    return add(cross(arm, force), traction.torque)


def sliding_rates(state: SlidingState, top: Top) -> SlidingState:
    """Time derivative of the state of a sliding body."""
    touch = sliding_contact(state.axis, state.momentum, state.velocity, top)
    normal, force = touch.normal_force, touch.force
    x, y, _ = moment_per_normal_force(touch.arm, touch.traction)
    # About the vertical only friction has a moment: as that of the force, it is a product less.
    twisting = cross(touch.arm, force)[2] + touch.torque[2]
    moment = (normal * x, normal * y, twisting)
    if touch.outer is not None:
        moment, force = add(moment, touch.outer.couple), add(force, touch.outer.force)
    return SlidingState(
        axis=axis_rate(state.axis, state.momentum, top),
        momentum=moment,
        velocity=(force[0] / top.mass, force[1] / top.mass),
    )


def on_table(state: SlidingState, top: Top) -> State:
    """Return the whole state of a body that touches the table: height h(c) and vertical velocity
    h'(c) c' added.
    """
    height, slope, _ = support_at(state.axis, top.surface)
    sinking = slope * axis_rate(state.axis, state.momentum, top)[2]
    return State(state.axis, state.momentum, (*state.velocity, sinking), height)


def along_table(state: State) -> SlidingState:
    """Return the part of the state that is free while the body touches the table."""
    return SlidingState(state.axis, state.momentum, state.velocity[:2])
