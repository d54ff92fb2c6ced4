"""The contact point of a body: its kinematics, and how it accelerates under a wrench.

The body's point of contact, with velocity v = r' + omega x a, and its angular velocity change at
the rates

    v' = F / m + (J (a x F + t)) x a + beta,        omega' = J (a x F + t + m0) + k omega3 n',

for a contact force F and a contact torque t, where J is the inverse inertia, k = (I1 - I3) / I1,
and beta = -g z + f0 / m + (k omega3 n' + J m0) x a + omega x a' is the acceleration of the point
without them, under the force f0 and the couple m0 of the outer field. Slip
does not enter: axis and angular momentum determine all. The response to F and t is symmetric and
positive definite (Delassus).
"""

from collections.abc import Sequence
from typing import NamedTuple

from tippetop.mechanics.contacts.wrench import Wrench
from tippetop.mechanics.field import OuterForces
from tippetop.mechanics.motion import (
    angular_velocity,
    axial_spin,
    axis_rate,
    contact_swing,
    driven_acceleration,
    free_acceleration,
    outer_forces,
)
from tippetop.mechanics.surfaces.surface import contact_vector, support_at
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Horizontal, Scalar, Vector, add, cross, dot, scale


class Acceleration(NamedTuple):
    """Rate of change of the contact point's velocity, m/s^2, and of the angular velocity,
    rad/s^2.
    """

    point: Vector
    turning: Vector


class ContactPoint(NamedTuple):
    """The contact point of a body in some configuration, and how it accelerates."""

    axis: Vector
    momentum: Vector
    """Unit vector n, and angular momentum L, kg m^2/s."""
    arm: Vector
    """Contact vector a, m."""
    turning: Vector
    """Angular velocity omega, rad/s."""
    free: Acceleration
    """Acceleration without contact force."""
    carried: Vector
    """Acceleration of the point if the body went on turning as it does, gamma = -g z + f0 / m +
    omega x a', m/s^2.
    """
    spun: Vector
    """Angular acceleration without contact force in terms of a moment, J^-1 k omega3 n' + m0, N m.
    """
    outer: OuterForces | None
    """What the outer field does, if there is one."""
    top: Top
    """The body."""

    @classmethod
    def of(
        cls, axis: Vector, momentum: Vector, top: Top, velocity: Horizontal | None = None
    ) -> "ContactPoint":
        """Return the contact point for this axis and angular momentum (kg m^2/s).

        The horizontal velocity of the centre of mass, m/s, matters to air alone; None stands for
        that of a contact point at rest.
        """
        arm = contact_vector(axis, top.surface)
        turning = angular_velocity(axis, momentum, top)
        excess = (top.transverse_inertia - top.axial_inertia) / top.transverse_inertia
        tilting = axis_rate(axis, momentum, top)
        gyration = scale(excess * axial_spin(axis, momentum, top), tilting)
        carried = add((0.0, 0.0, -top.gravity), cross(turning, arm_rate(axis, tilting, top)))
        spun = scale(top.transverse_inertia, gyration)
        outer = outer_forces(axis, momentum, velocity, top)
        if outer is not None:
            spun = add(spun, outer.couple)
            gyration = add(gyration, angular_response(axis, outer.couple, top))
            carried = add(carried, scale(1.0 / top.mass, outer.force))
        x, y, _ = add(cross(gyration, arm), carried)
        free = Acceleration((x, y, free_acceleration(axis, momentum, top, outer)), gyration)
        return cls(axis, momentum, arm, turning, free, carried, spun, outer, top)

    def response(self, wrench: Wrench) -> Acceleration:
        """Acceleration that a wrench adds."""
        moment = self.moment(wrench)
        turning = angular_response(self.axis, moment, self.top)
        x, y, _ = add(scale(1.0 / self.top.mass, wrench.force), cross(turning, self.arm))
        upwards = driven_acceleration(self.axis, wrench.force[2], moment, self.top)
        return Acceleration((x, y, upwards), turning)

    def moment(self, wrench: Wrench) -> Vector:
        """Moment of a wrench about the centre of mass, N m."""
        return add(cross(self.arm, wrench.force), wrench.torque)


def angular_response(axis: Vector, moment: Vector, top: Top) -> Vector:
    """Return the angular acceleration J M that a moment M, N m, adds, rad/s^2."""
    transverse, axial = 1.0 / top.transverse_inertia, 1.0 / top.axial_inertia
    along = (axial - transverse) * dot(axis, moment)
    return add(scale(transverse, moment), scale(along, axis))


def contact_points(
    axis: Vector, momentum: Vector, tops: Sequence[Top], velocity: Horizontal | None = None
) -> tuple[ContactPoint, ...]:
    """Return the contact points for this axis and angular momentum (kg m^2/s), one for each of some
    tops with another active surface.

    The horizontal velocity of the centre of mass, m/s, matters to air alone; None stands for that
    at which the first contact point is at rest.
    """
    first = tops[0]
    if velocity is None and first.field is not None and first.field.drag is not None:
        x, y = contact_swing(axis, momentum, first)
        velocity = (-x, -y)
    return tuple([ContactPoint.of(axis, momentum, top, velocity) for top in tops])


def arm_rate(axis: Vector, tilting: Vector, top: Top) -> Vector:
    """Rate of the contact vector for this rate of the axis (1/s): -h' n' - h'' c' (n - c z),
    m/s.
    """
    _, slope, curvature = support_at(axis, top.surface)
    bend = -curvature * tilting[2]
    return add(scale(-slope, tilting), (bend * axis[0], bend * axis[1], 0.0))


def flat(motion: Acceleration) -> tuple[Scalar, ...]:
    """Six numbers in a row."""
    return (*motion.point, *motion.turning)
