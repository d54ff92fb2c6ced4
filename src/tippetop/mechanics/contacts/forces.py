"""Forces of the closed contacts of a body, by the status of each: it slips, or it sticks.

A contact that slips has the friction of its law. A contact that sticks keeps its slip constant, and
its drilling under a law that resists drilling. Rolling that is resisted goes on, against a couple
of the table, or it is held: its angular velocity stays constant.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple, TypeAlias

from tippetop.mechanics.contacts.contact_point import Acceleration, ContactPoint
from tippetop.mechanics.contacts.sticking import sticking_forces
from tippetop.mechanics.contacts.system import (
    At,
    Component,
    Constraint,
    ConstraintSolution,
    ContactRates,
    delassus_matrix,
    free_rates,
    rates_under,
    responses_to,
    solve_constraints,
)
from tippetop.mechanics.contacts.wrench import DRILLING, EAST, FORCES, NORTH, Slip, Wrench
from tippetop.mechanics.laws.friction import NO_TORQUE, FrictionLaw
from tippetop.mechanics.motion import angular_velocity, contact_swing
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import (
    VERTICAL,
    Horizontal,
    Scalar,
    Vector,
    add,
    determinant,
    dot,
    scale,
)

JAMMING = 1e-8
"""Determinant of the Delassus matrix of contacts that slip, over that without friction, at which
they jam: the time that is left falls as its square, and is rounding then. The slip that friction
still takes before the jam is as small a fraction of what the impact takes.
"""

Slips: TypeAlias = Sequence[Slip | None]
"""Slip of every contact, or its direction; None where the contact sticks."""


def forces_and_accelerations(
    point: ContactPoint, slip: Slip | None, rolling: Horizontal | None = None
) -> tuple[Wrench, Acceleration]:
    """Return the wrench of the table at the contact, and the acceleration of the contact point.

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
        return sticking_forces(point, drills=slip_length(point.top.friction) is None)
    solution = solve_contacts((point,), (slip,), rolling)
    (acceleration,), turning = solution.rates
    return sum_at(0, solution.wrenches), Acceleration(acceleration, turning)


def solve_contacts(
    points: Sequence[ContactPoint], slips: Slips, rolling: Slip | None
) -> ConstraintSolution:
    """Return the wrenches of the table at all closed contacts, and the accelerations.

    Parameters
    ----------
    points
        The contact points.
    slips
        Slip of every contact, or its direction; None where it sticks.
    rolling
        The horizontal angular velocity, or its direction; None where it is held. On several
        contacts, where it is along the axis, a unit vector, or zero without rolling resistance.
    """
    return solve_constraints(points, constraints_of(points, slips, rolling), free_rates(points))


class Load(NamedTuple):
    """Normal forces that are given, N, and the share of the body's rates without contact forces."""

    normal: tuple[float, ...]
    share: float


def solve_loaded(
    points: Sequence[ContactPoint], slips: Slips, rolling: Slip | None, load: Load
) -> ConstraintSolution:
    """Return the wrenches of the table under given normal forces, and the accelerations.

    The gaps are free to open or to close. The other arguments are those of `solve_contacts`.
    """
    driving = list[At]()
    for number, constraint in enumerate(normal_constraints(points, slips, rolling)):
        force, torque = constraint.wrench
        size = load.normal[number]
        driving.append((number, Wrench(scale(size, force), scale(size, torque))))
    free = free_rates(points)
    rates = ContactRates(
        tuple([scale(load.share, rate) for rate in free.points]), scale(load.share, free.turning)
    )
    rates = rates_under(points, driving, rates)
    held = [
        *sticking_constraints(points, [slip is None for slip in slips]),
        *rolling_constraints(points, rolling),
    ]
    if not held:
        return ConstraintSolution(driving, rates)
    solution = solve_constraints(points, held, rates)
    return ConstraintSolution([*driving, *solution.wrenches], solution.rates)


def constraints_of(
    points: Sequence[ContactPoint], slips: Slips, rolling: Slip | None
) -> list[Constraint]:
    """Return the components that are held: slip of what sticks, normal velocities, rolling."""
    return [
        *sticking_constraints(points, [slip is None for slip in slips]),
        *normal_constraints(points, slips, rolling),
        *rolling_constraints(points, rolling),
    ]


def sticking_constraints(
    points: Sequence[ContactPoint], sticks: Sequence[bool]
) -> list[Constraint]:
    """Return the constraints of the contacts that stick.

    Two contacts of a body of revolution move as one along the horizontal part of the axis, in whose
    plane they are, and two that stick do not drill.
    """
    numbers = [number for number, held in enumerate(sticks) if held]
    if len(numbers) > 1:
        first, second = numbers
        along, across = directions_of(points[0].axis)
        held = [Component(first, along), Component(first, across), Component(second, across)]
        return [Constraint.of(component) for component in held]
    held = [Component(number, direction) for number in numbers for direction in (EAST, NORTH)]
    if numbers and len(points) == 1 and slip_length(points[0].top.friction) is not None:
        held.append(Component(numbers[0], VERTICAL, turns=True))
    return [Constraint.of(component) for component in held]


def normal_constraints(
    points: Sequence[ContactPoint], slips: Slips, rolling: Slip | None
) -> list[Constraint]:
    """Return the constraints that keep the gaps closed: unit normal forces with their friction."""
    couple = rolling_couple(points, rolling)
    return [
        Constraint(Component(number, VERTICAL), normal_wrench(point, slip, couple))
        for number, (point, slip) in enumerate(zip(points, slips, strict=True))
    ]


def rolling_couple(points: Sequence[ContactPoint], rolling: Slip | None) -> Vector | None:
    """Return the couple that resists rolling per unit normal force; None without one."""
    resistance = points[0].top.rolling_resistance
    if resistance is None or rolling is None:
        return None
    turning = (rolling[0], rolling[1], 0.0)
    return resistance.couple(turning) if len(points) == 1 else scale(-resistance.length, turning)


def rolling_constraints(points: Sequence[ContactPoint], rolling: Slip | None) -> list[Constraint]:
    """Return the constraints of rolling that is held.

    Two closed contacts hold the angular velocity across the axis already.
    """
    if rolling is not None or not points[0].top.resists_rolling:
        return []
    axes = [EAST, NORTH] if len(points) == 1 else [directions_of(points[0].axis)[0]]
    return [Constraint.of(Component(0, axis, turns=True)) for axis in axes]


def directions_of(axis: Vector) -> tuple[Vector, Vector]:
    """Return the horizontal unit vectors e along the axis and t across it."""
    inverse = (axis[0] * axis[0] + axis[1] * axis[1]) ** -0.5
    x, y = axis[0] * inverse, axis[1] * inverse
    return (x, y, 0.0 * x), (-y, x, 0.0 * x)


def sum_at(contact: int, wrenches: Sequence[At]) -> Wrench:
    """Return the sum of the wrenches at a contact."""
    force = torque = NO_TORQUE
    for number, wrench in wrenches:
        if number == contact:
            force, torque = add(force, wrench.force), add(torque, wrench.torque)
    return Wrench(force, torque)


def jamming_margin(points: Sequence[ContactPoint], slips: Slips, rolling: Slip | None) -> Scalar:
    """Fall through zero where normal forces grow beyond all bounds: Painleve's paradox begins.

    Friction that turns is about to press the contacts as much as their normal forces open them.
    There slip changes as fast, and would seem to end, however much of it is left.

    The arguments are those of `solve_contacts`; every contact slips.
    """
    held = rolling_constraints(points, rolling)

    def determinant_with(normal: Sequence[Constraint]) -> Scalar:
        constraints = [*held, *normal]
        return determinant(delassus_matrix(constraints, responses_to(points, constraints)))

    frictionless = normal_constraints(points, [None for _ in points], None)
    pressed = determinant_with(normal_constraints(points, slips, rolling))
    return pressed - JAMMING * determinant_with(frictionless)


def normal_wrench(point: ContactPoint, slip: Slip | None, couple: Vector | None = None) -> Wrench:
    """Return a unit normal force with the friction that goes with it where the contact slips, and a
    couple.
    """
    force, torque = (0.0, 0.0), NO_TORQUE
    if slip is not None:
        force, torque = point.top.friction.traction((slip[0], slip[1]), turning_with(point, slip))
    return Wrench((*force, 1.0), torque if couple is None else add(torque, couple))


def slip_wrenches(law: FrictionLaw) -> tuple[Wrench, ...]:
    """Return the wrenches that resist slip: two forces, and the drilling torque if the law resists
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
    """Return the angular velocity as a law takes it, drilling as the slip has it, rad/s."""
    w = point.turning[2] if len(slip) == 2 else slip[2] / slip_length(point.top.friction)
    return (point.turning[0], point.turning[1], w)


def velocity_without_slip(axis: Vector, momentum: Vector, top: Top) -> Horizontal:
    """Horizontal velocity of the centre of mass of a body whose contact point is at rest, m/s."""
    x, y = contact_swing(axis, momentum, top)
    return (-x, -y)


def without_drilling(axis: Vector, momentum: Vector, top: Top) -> Vector:
    """Return the angular momentum for which the body does not turn about the vertical, kg m^2/s.

    What changes is the angular velocity's vertical component, which becomes zero.
    """
    turning = angular_velocity(axis, momentum, top)
    return spun_up(axis, momentum, (0.0, 0.0, -turning[2]), top)


def without_rolling(axis: Vector, momentum: Vector, top: Top) -> Vector:
    """Return the angular momentum for which the body turns about the vertical alone, kg m^2/s."""
    turning = angular_velocity(axis, momentum, top)
    return spun_up(axis, momentum, (-turning[0], -turning[1], 0.0), top)


def spun_up(axis: Vector, momentum: Vector, change: Vector, top: Top) -> Vector:
    """Return the angular momentum after a change of the angular velocity (rad/s), kg m^2/s."""
    along = (top.axial_inertia - top.transverse_inertia) * dot(axis, change)
    return add(momentum, add(scale(top.transverse_inertia, change), scale(along, axis)))


def is_set_valued(law: FrictionLaw) -> bool:
    """Return whether a law lets slip end: it has a `reserve`, and elsewhere depends on slip's
    direction alone.
    """
    return hasattr(law, "reserve")
