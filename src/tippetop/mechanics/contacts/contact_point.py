"""The contact point of a body: its kinematics, and how it accelerates under a wrench.

The body's point of contact, with velocity v = r' + omega x a, and its angular velocity change at
the rates

    v' = F / m + (J (a x F + t)) x a + beta,        omega' = J (a x F + t) + k omega3 n',

for a contact force F and a contact torque t, where J is the inverse inertia, k = (I1 - I3) / I1,
and beta = -g z + (k omega3 n') x a + omega x a' is the acceleration of the point without them. Slip
does not enter: axis and angular momentum determine all. The response to F and t is symmetric and
positive definite (Delassus).
"""

from collections.abc import Sequence
from typing import NamedTuple

from tippetop.mechanics.contacts.wrench import Wrench
from tippetop.mechanics.motion import (
    angular_velocity,
    axial_spin,
    axis_rate,
    driven_acceleration,
    free_acceleration,
)
from tippetop.mechanics.surfaces.surface import contact_vector, support_at
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Scalar, Vector, add, cross, dot, scale


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
    """Acceleration of the point if the body went on turning as it does, gamma = -g z + omega x a',
    m/s^2.
    """
    top: Top
    """The body."""

    @classmethod
    def of(cls, axis: Vector, momentum: Vector, top: Top) -> "ContactPoint":
        """Return the contact point for this axis and angular momentum (kg m^2/s)."""
        arm = contact_vector(axis, top.surface)
        turning = angular_velocity(axis, momentum, top)
        excess = (top.transverse_inertia - top.axial_inertia) / top.transverse_inertia
        tilting = axis_rate(axis, momentum, top)
        gyration = scale(excess * axial_spin(axis, momentum, top), tilting)
        carried = add((0.0, 0.0, -top.gravity), cross(turning, arm_rate(axis, tilting, top)))
        x, y, _ = add(cross(gyration, arm), carried)
        free = Acceleration((x, y, free_acceleration(axis, momentum, top)), gyration)
        return cls(axis, momentum, arm, turning, free, carried, top)

    def response(self, wrench: Wrench) -> Acceleration:
        """Acceleration that a wrench adds."""
        transverse, axial = 1.0 / self.top.transverse_inertia, 1.0 / self.top.axial_inertia
        moment = self.moment(wrench)
        along = (axial - transverse) * dot(self.axis, moment)
        turning = add(scale(transverse, moment), scale(along, self.axis))
        x, y, _ = add(scale(1.0 / self.top.mass, wrench.force), cross(turning, self.arm))
        upwards = driven_acceleration(self.axis, wrench.force[2], moment, self.top)
        return Acceleration((x, y, upwards), turning)

    def moment(self, wrench: Wrench) -> Vector:
        """Moment of a wrench about the centre of mass, N m."""
        return add(cross(self.arm, wrench.force), wrench.torque)


def contact_points(axis: Vector, momentum: Vector, tops: Sequence[Top]) -> tuple[ContactPoint, ...]:
    """Return the contact points for this axis and angular momentum (kg m^2/s), one for each of some
    tops with another active surface.
    """
    return tuple([ContactPoint.of(axis, momentum, top) for top in tops])


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
