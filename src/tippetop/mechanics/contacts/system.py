"""The multiplier system of any number of closed contacts: forces, reactions and accelerations.

A velocity component is the power of a unit wrench at a contact: of a unit force, the velocity of
the contact point along it; of a unit couple, the angular velocity along it. A component that is
held has a multiplier, the size of the wrench that holds it. The wrench is that unit wrench itself,
or, for the normal velocity of a contact that slips or rolls, a unit normal force with the friction
that the law adds to it. With the multipliers p the rate of component r is

    sum_c D_rc p_c + b_r = 0,

where D_rc is the rate of component r per unit of wrench c (Delassus matrix), and b_r its rate
without contact forces. The same system with velocities in place of rates gives the impulses that
end the components.
"""

from collections.abc import Sequence
from typing import NamedTuple, Self, TypeAlias

from tippetop.mechanics.contacts.contact_point import ContactPoint
from tippetop.mechanics.contacts.wrench import Wrench
from tippetop.mechanics.laws.friction import NO_TORQUE
from tippetop.mechanics.vectors import Scalar, Vector, add, cross, dot, scale, solve

At: TypeAlias = tuple[int, Wrench]
"""Number of a contact, and a wrench at it."""


class ContactRates(NamedTuple):
    """Accelerations of all contact points, m/s^2, and the angular acceleration, rad/s^2; or the
    velocities.
    """

    points: tuple[Vector, ...]
    turning: Vector

    def plus(self, factor: Scalar, rates: Self) -> "ContactRates":
        """Return the sum of these rates and others times a factor."""
        points = tuple(
            [add(a, scale(factor, b)) for a, b in zip(self.points, rates.points, strict=True)]
        )
        return ContactRates(points, add(self.turning, scale(factor, rates.turning)))


class Component(NamedTuple):
    """A velocity component of a contact: of its point along a direction, or of the angular
    velocity.
    """

    contact: int
    """Number of the contact."""
    direction: Vector
    """Unit vector."""
    turns: bool = False
    """Whether it is the angular velocity along the direction."""

    @property
    def wrench(self) -> Wrench:
        """The unit wrench whose power it is: a force, or a couple."""
        force_or_couple = self.direction
        return (
            Wrench(NO_TORQUE, force_or_couple) if self.turns else Wrench(force_or_couple, NO_TORQUE)
        )

    def rate(self, rates: ContactRates) -> Scalar:
        """Return the rate of the component."""
        return dot(self.direction, rates.turning if self.turns else rates.points[self.contact])


class Constraint(NamedTuple):
    """A component that is held, and the wrench per unit of its multiplier.

    The wrench of the normal velocity of a contact that slips has friction in it: the matrix of the
    system is not symmetric then.
    """

    component: Component
    wrench: Wrench

    @classmethod
    def of(cls, component: Component) -> "Constraint":
        """Return the constraint whose wrench is the unit wrench of the component."""
        return cls(component, component.wrench)


class ConstraintSolution(NamedTuple):
    """Wrenches of the table that hold all constraints, in their order, and the rates under them."""

    wrenches: list[At]
    rates: ContactRates


def free_rates(points: Sequence[ContactPoint]) -> ContactRates:
    """Return the rates without contact forces."""
    return ContactRates(tuple([point.free.point for point in points]), points[0].free.turning)


def rates_added(points: Sequence[ContactPoint], contact: int, wrench: Wrench) -> ContactRates:
    """Return the rates that a wrench at a contact adds."""
    struck = points[contact]
    acceleration, turning = struck.response(wrench)
    moved = [
        acceleration
        if number == contact
        else add(acceleration, cross(turning, add(point.arm, scale(-1.0, struck.arm))))
        for number, point in enumerate(points)
    ]
    return ContactRates(tuple(moved), turning)


def moment_of(points: Sequence[ContactPoint], wrenches: Sequence[At]) -> Vector:
    """Moment of some wrenches at contacts about the centre of mass, N m."""
    total = NO_TORQUE
    for number, wrench in wrenches:
        total = add(total, points[number].moment(wrench))
    return total


def responses_to(
    points: Sequence[ContactPoint], constraints: Sequence[Constraint]
) -> list[ContactRates]:
    """Return the rates that the wrench of each constraint adds."""
    return [
        rates_added(points, constraint.component.contact, constraint.wrench)
        for constraint in constraints
    ]


def delassus_matrix(
    constraints: Sequence[Constraint], responses: Sequence[ContactRates]
) -> list[list[Scalar]]:
    """Return the matrix D_rc of the system, from the responses to the constraints' wrenches."""
    return [
        [constraint.component.rate(column) for column in responses] for constraint in constraints
    ]


def solve_constraints(
    points: Sequence[ContactPoint], constraints: Sequence[Constraint], rates: ContactRates
) -> ConstraintSolution:
    """Return the wrenches that hold all constraints, and the rates under them.

    Parameters
    ----------
    points
        The contact points.
    constraints
        Independent constraints, those of slip before the normal ones (the elimination takes no
        pivots).
    rates
        ContactRates without the wrenches; or velocities, for impulses that end the components.
    """
    responses = responses_to(points, constraints)
    matrix = delassus_matrix(constraints, responses)
    right = [-constraint.component.rate(rates) for constraint in constraints]
    wrenches = list[At]()
    for size, constraint, column in zip(solve(matrix, right), constraints, responses, strict=True):
        unit = constraint.wrench
        wrench = Wrench(scale(size, unit.force), scale(size, unit.torque))
        wrenches.append((constraint.component.contact, wrench))
        rates = rates.plus(size, column)
    return ConstraintSolution(wrenches, rates)


def rates_under(
    points: Sequence[ContactPoint], wrenches: Sequence[At], rates: ContactRates
) -> ContactRates:
    """Return the rates under some wrenches, from those without them."""
    for contact, wrench in wrenches:
        rates = rates.plus(1.0, rates_added(points, contact, wrench))
    return rates
