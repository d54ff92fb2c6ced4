"""Equations of motion of a body of revolution that slides on the table.

The centre of mass moves by m u' = F, the angular momentum about it by L' = a x F + N t, and the axis by
n' = L x n / I1, where F = N (z + f) is the contact force, N t its drilling torque and a the contact vector.
The normal force N follows from differentiating the constraint z = h(n_z) twice. The variables have no
singularity, and the right-hand side is algebraic.
"""

from typing import NamedTuple

from tippetop.mechanics.friction import Traction
from tippetop.mechanics.state import SlidingState, State
from tippetop.mechanics.surface import contact_vector
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import VERTICAL, Horizontal, Scalar, Vector, add, cross, dot, scale


class Contact(NamedTuple):
    """The geometry, kinematics and forces of the contact at an instant.

    Attributes
    ----------
    arm
        Contact vector a, from the centre of mass to the contact point, m.
    slip
        Slip velocity: horizontal velocity of the body's point of contact, m/s.
    traction
        Friction force and torque per unit normal force.
    push
        Normal force there would be if friction and gyroscopic reaction could not change it, N: the numerator
        of the normal force, which has its sign.
    resistance
        How much of a unit normal force reaches the acceleration of the gap, dimensionless: the denominator
        of the normal force. Where it is not positive, no contact force is consistent (Painleve's paradox).
    """

    arm: Vector
    slip: Horizontal
    traction: Traction
    push: Scalar
    resistance: Scalar

    @property
    def normal_force(self) -> Scalar:
        """Normal force N of the table, N."""
        return self.push / self.resistance


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


def contact(axis: Vector, momentum: Vector, velocity: Horizontal, top: Top) -> Contact:
    """Geometry, slip and contact force of the body on the table.

    Parameters
    ----------
    axis, momentum, velocity
        Axis n, angular momentum L (kg m^2/s) and horizontal velocity u of the centre of mass (m/s).
    top
        The body, the friction law and gravity.

    Notes
    -----
    N = m (g + h'' c'^2 + h' [L x n']_z / I1) / (1 - (m h'/I1) [(a x (z + f) + t) x n]_z), from the second
    derivative of the constraint z = h(c), c = n_z.
    """
    c = axis[2]
    slope = top.surface.slope(c)
    arm = contact_vector(axis, top.surface)
    omega = angular_velocity(axis, momentum, top)
    point = point_velocity((velocity[0], velocity[1], 0.0), omega, arm)
    slip = (point[0], point[1])
    traction = top.friction.traction(slip, omega)

    turning = axis_rate(axis, momentum, top)
    lever = slope / top.transverse_inertia
    free_acceleration = top.gravity + (
        top.surface.curvature(c) * turning[2] * turning[2] + lever * cross(momentum, turning)[2]
    )
    reaction = cross(moment_per_normal_force(arm, traction), axis)[2]
    return Contact(arm, slip, traction, top.mass * free_acceleration, 1.0 - top.mass * lever * reaction)


def moment_per_normal_force(arm: Vector, traction: Traction) -> Vector:
    """Moment of the contact force about the centre of mass per unit normal force, a x (z + f) + t, m."""
    force = (traction.force[0], traction.force[1], VERTICAL[2])
    return add(cross(arm, force), traction.torque)


def sliding_rates(state: SlidingState, top: Top) -> SlidingState:
    """Time derivative of the state of a sliding body."""
    touch = contact(state.axis, state.momentum, state.velocity, top)
    normal = touch.normal_force
    friction = (normal * touch.traction.force[0], normal * touch.traction.force[1])
    omega = angular_velocity(state.axis, state.momentum, top)
    return SlidingState(
        axis=axis_rate(state.axis, state.momentum, top),
        momentum=scale(normal, moment_per_normal_force(touch.arm, touch.traction)),
        velocity=(friction[0] / top.mass, friction[1] / top.mass),
        position=state.velocity,
        marker=cross(omega, state.marker),
        work=normal * power_per_normal_force(touch.slip, omega, touch.traction),
    )


def power_per_normal_force(slip: Horizontal, omega: Vector, traction: Traction) -> Scalar:
    """Power of friction per unit normal force, f.v + t.omega, m/s: never positive."""
    return traction.force[0] * slip[0] + traction.force[1] * slip[1] + dot(traction.torque, omega)


def on_table(state: SlidingState, top: Top) -> State:
    """The whole state of a body that touches the table: height h(c) and vertical velocity h'(c) c' added."""
    c = state.axis[2]
    sinking = top.surface.slope(c) * axis_rate(state.axis, state.momentum, top)[2]
    return State(
        state.axis,
        state.momentum,
        (*state.velocity, sinking),
        (*state.position, top.surface.height(c)),
        state.marker,
        state.work,
    )


def along_table(state: State) -> SlidingState:
    """The part of the state that is free while the body touches the table."""
    return SlidingState(
        state.axis, state.momentum, state.velocity[:2], state.position[:2], state.marker, state.work
    )
