"""How the contact point responds to forces, and the forces that hold it: rolling without slipping.

The body's point of contact, with velocity v = r' + omega x a, and its angular velocity change at
the rates

    v' = F / m + (J (a x F + t)) x a + beta,        omega' = J (a x F + t) + k omega3 n',

for a contact force F and torque t, where J is the inverse inertia, k = (I1 - I3) / I1, and beta =
-g z + (k omega3 n') x a + omega x a' is what it does without them. Slip does not enter: axis and
angular momentum are enough. The response to F and t is symmetric and positive definite (Delassus),
and every mode of contact is a linear equation: slip needs v_z' = 0 with the law's F = N (f, 1), and
rolling v' = 0. A contact that sticks under Contensou's friction does not drill either, omega_z' =
0, and rolling that is held has omega_x' = omega_y' = 0.

Where v' = 0, and nothing holds rolling, the equations are those of omega' alone, since F = -m
(gamma + omega' x a), gamma = -g z + omega x a':

    (1/J + m a^2 - m a a) omega' = (1/J) k omega3 n' - m a x gamma + t,

and with e the horizontal part of n, which that of a is -h' times, the matrix takes a horizontal
rate w and omega_z' to alpha w + (beta (e.w) + kappa omega_z') e and kappa (e.w) + delta omega_z',
where

    alpha = I1 + m h^2 + m h'^2 e^2,          beta = I3 - I1 - m h'^2,
    delta = I1 + (I3 - I1) c^2 + m h'^2 e^2,  kappa = (I3 - I1) c - m h h'.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple, TypeAlias

from tippetop.mechanics.branches import on_branch
from tippetop.mechanics.friction import NO_TORQUE, FrictionLaw
from tippetop.mechanics.motion import (
    angular_velocity,
    axial_spin,
    axis_rate,
    contact_swing,
    driven_acceleration,
    free_acceleration,
)
from tippetop.mechanics.surface import contact_vector, support_at
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Horizontal, Scalar, Vector, add, cross, dot, scale, solve
from tippetop.mechanics.wrench import COUPLES, DRILLING, FORCES, Slip, Wrench

Held: TypeAlias = tuple[int, Wrench]
"""A component that is held, as `ContactPoint.holding` has it, and what holds it."""


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
    """Acceleration of the point if the body went on turning as it does, gamma above, m/s^2."""
    top: Top
    """The body."""

    @classmethod
    def of(cls, axis: Vector, momentum: Vector, top: Top) -> "ContactPoint":
        """The contact point for this axis and angular momentum (kg m^2/s)."""
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

    def holding(self, held: Sequence[Held]) -> tuple[Wrench, Acceleration]:
        """The combination of wrenches that keeps as many velocities constant, and the acceleration
        then.

        Parameters
        ----------
        held
            Components, 0 to 2 of the contact point's velocity, 3 to 5 of the angular velocity, with
            a wrench each; that to component 2 may be a normal force with what goes with it.
        """
        responses = [self.response(wrench) for _, wrench in held]
        columns, free = [flat(response) for response in responses], flat(self.free)
        sizes = solve(
            [[column[i] for column in columns] for i, _ in held], [-free[i] for i, _ in held]
        )
        force = torque = NO_TORQUE
        point, turning = self.free
        for size, (_, wrench), response in zip(sizes, held, responses, strict=True):
            force, torque = (
                add(force, scale(size, wrench.force)),
                add(torque, scale(size, wrench.torque)),
            )
            point, turning = (
                add(point, scale(size, response.point)),
                add(turning, scale(size, response.turning)),
            )
        return Wrench(force, torque), Acceleration(point, turning)

    def pivoting(self, drills: bool) -> tuple[Wrench, Acceleration]:
        """What keeps the contact point's velocity constant, drilling too unless it drills, and what
        follows.

        In the fewest operations: the motion of what sticks is made of little else.
        """
        top, n, c = self.top, self.axis, self.axis[2]
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
        carried = scale(-top.mass, cross(self.arm, self.carried))
        right = add(scale(top.transverse_inertia, self.free.turning), carried)
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
        force = scale(-top.mass, add(self.carried, cross(turning, self.arm)))
        return Wrench(force, torque), Acceleration(NO_TORQUE, turning)


def arm_rate(axis: Vector, tilting: Vector, top: Top) -> Vector:
    """Rate of the contact vector for this rate of the axis (1/s): -h' n' - h'' c' (n - c z),
    m/s.
    """
    _, slope, curvature = support_at(axis, top.surface)
    bend = -curvature * tilting[2]
    return add(scale(-slope, tilting), (bend * axis[0], bend * axis[1], 0.0))


def contact_motion(
    point: ContactPoint, slip: Slip | None, rolling: Horizontal | None = None
) -> tuple[Wrench, Acceleration]:
    """What the table does to a body in contact, and how that accelerates.

    Parameters
    ----------
    point
        The contact point.
    slip
        The slip, of which a law that is set-valued takes the direction only: two components, or
        three with the drilling rate times the law's slip length; or None where it is held at zero
        (both, if the law resists drilling).
    rolling
        The horizontal angular velocity, of which only the direction counts, or None where it is
        held at zero; without rolling resistance it does not matter.
    """
    if slip is None and not point.top.resists_rolling:
        return point.pivoting(drills=slip_length(point.top.friction) is None)
    normal, slipping, turning = going_on(point, slip, rolling)
    return point.holding([*slipping, (2, normal), *turning])


def struck_wrench(point: ContactPoint, slip: Slip | None, rolling: Horizontal | None) -> Wrench:
    """What goes with a unit normal impulse, and that; of floats, as for `contact_motion`.

    Velocities that are held stay what they are: the configuration is fixed, and nothing falls
    meanwhile.
    """
    if slip is not None:
        point = point._replace(top=on_branch(point.top, slip))
    normal, slipping, turning = going_on(point, slip, rolling)
    held = [*slipping, *turning]
    if not held:
        return normal
    driven = point._replace(free=point.response(normal))
    more, _ = driven.holding(held)
    return Wrench(add(normal.force, more.force), add(normal.torque, more.torque))


def going_on(
    point: ContactPoint, slip: Slip | None, rolling: Horizontal | None
) -> tuple[Wrench, list[Held], list[Held]]:
    """A unit normal force with what goes with it, and what holds slip, and rolling, where these are
    None.
    """
    top = point.top
    slipping = [] if slip is not None else holding_slip(top.friction)
    if top.rolling_resistance is None:
        return normal_wrench(point, slip), slipping, []
    if rolling is None:
        return normal_wrench(point, slip), slipping, [(3, COUPLES[0]), (4, COUPLES[1])]
    couple = top.rolling_resistance.couple((rolling[0], rolling[1], 0.0))
    return normal_wrench(point, slip, couple), slipping, []


def normal_wrench(point: ContactPoint, slip: Slip | None, couple: Vector | None = None) -> Wrench:
    """A unit normal force with the friction that goes with it where the contact slips, and a
    couple.
    """
    force, torque = (0.0, 0.0), NO_TORQUE
    if slip is not None:
        force, torque = point.top.friction.traction((slip[0], slip[1]), turning_with(point, slip))
    return Wrench((*force, 1.0), torque if couple is None else add(torque, couple))


def holding_slip(law: FrictionLaw) -> list[Held]:
    """The velocities that slip is, and drilling if the law resists it, each with the wrench that
    holds it.
    """
    return list(zip((0, 1, 5), slip_wrenches(law), strict=False))


def slip_wrenches(law: FrictionLaw) -> tuple[Wrench, ...]:
    """The wrenches that resist slip: two forces, and the drilling torque if the law resists
    that.
    """
    return FORCES[:2] if slip_length(law) is None else (*FORCES[:2], DRILLING)


def slip_length(law: FrictionLaw) -> Scalar | None:
    """Length by which drilling compares with slip under a law, m; None where it does not resist
    drilling.
    """
    return getattr(law, "slip_length", None)


def slip_reserve(top: Top, wrench: Wrench) -> Scalar:
    """Positive while the table can exert the force and drilling torque in a wrench that holds slip,
    N^2.
    """
    law: Any = top.friction
    return law.reserve(wrench.force[2], wrench.force[:2], wrench.torque[2])


def rolling_reserve(point: "ContactPoint", wrench: Wrench, slip: Slip | None) -> Scalar:
    """Positive while the table can exert the couple in a wrench that holds rolling, (N m)^2."""
    resistance: Any = point.top.rolling_resistance
    couple, normal = (wrench.torque[0], wrench.torque[1]), wrench.force[2]
    if slip is not None:
        torque = point.top.friction.traction((slip[0], slip[1]), turning_with(point, slip)).torque
        couple = (couple[0] - normal * torque[0], couple[1] - normal * torque[1])
    return resistance.reserve(normal, couple)


def turning_with(point: "ContactPoint", slip: Slip) -> Vector:
    """The angular velocity as a law takes it, drilling as the slip has it, rad/s."""
    w = point.turning[2] if len(slip) == 2 else slip[2] / slip_length(point.top.friction)
    return (point.turning[0], point.turning[1], w)


def velocity_without_slip(axis: Vector, momentum: Vector, top: Top) -> Horizontal:
    """Horizontal velocity of the centre of mass of a body whose contact point is at rest, m/s."""
    x, y = contact_swing(axis, momentum, top)
    return (-x, -y)


def without_drilling(axis: Vector, momentum: Vector, top: Top) -> Vector:
    """The angular momentum for which the body does not turn about the vertical, kg m^2/s.

    What changes is the angular velocity's vertical component, which becomes zero.
    """
    turning = angular_velocity(axis, momentum, top)
    return spun_up(axis, momentum, (0.0, 0.0, -turning[2]), top)


def without_rolling(axis: Vector, momentum: Vector, top: Top) -> Vector:
    """The angular momentum for which the body turns about the vertical alone, kg m^2/s."""
    turning = angular_velocity(axis, momentum, top)
    return spun_up(axis, momentum, (-turning[0], -turning[1], 0.0), top)


def spun_up(axis: Vector, momentum: Vector, change: Vector, top: Top) -> Vector:
    """The angular momentum after a change of the angular velocity (rad/s), kg m^2/s."""
    along = (top.axial_inertia - top.transverse_inertia) * dot(axis, change)
    return add(momentum, add(scale(top.transverse_inertia, change), scale(along, axis)))


def is_set_valued(law: FrictionLaw) -> bool:
    """Whether a law lets slip end: it has a `reserve`, and elsewhere depends on slip's direction
    alone.
    """
    return hasattr(law, "reserve")


def flat(motion: Acceleration) -> tuple[Scalar, ...]:
    """Six numbers in a row."""
    return (*motion.point, *motion.turning)
