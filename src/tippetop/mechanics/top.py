"""The numbers of a top on its table: the body, said once, and the contacts that it may have."""

from collections.abc import Sequence
from typing import Any, NamedTuple

from tippetop.mechanics.field import FieldKind, OuterField
from tippetop.mechanics.laws.coulomb import RollingResistance
from tippetop.mechanics.laws.friction import FrictionLaw, Traction
from tippetop.mechanics.natural_units import Units
from tippetop.mechanics.state import State
from tippetop.mechanics.surfaces.hull import Hull, lowest_number
from tippetop.mechanics.surfaces.surface import Surface, kind_of
from tippetop.mechanics.vectors import Horizontal, Scalar, Vector, add, scale

NATURAL = Units(1.0, 1.0, 1.0)
"""The units of numbers that are in natural units already."""


class RigidBody(NamedTuple):
    """A body of revolution, and what acts on it: all numbers of the equations of motion."""

    mass: Scalar
    transverse_inertia: Scalar
    axial_inertia: Scalar
    surface: Surface
    """Its outside: one surface, or a `Hull` of several."""
    friction: FrictionLaw
    """The whole law, where a law has branches."""
    gravity: Scalar
    """Acceleration of gravity along the table's normal, m/s^2."""
    rolling_resistance: RollingResistance | None = None
    """What resists rolling beside friction, if anything does."""
    field: OuterField | None = None
    """Gravity along the table, and air; None where the table is level and there is no air."""

    @property
    def contacts(self) -> tuple["Top", ...]:
        """Its contacts, one a surface."""
        count = len(self.surface.units) if isinstance(self.surface, Hull) else 1
        return tuple([Top(self, number) for number in range(count)])

    def lowest_at(self, c: float) -> "Top":
        """Return the contact of the surface that reaches lowest at this cosine of the tilt; of
        floats.
        """
        return Top(self, lowest_number(self.surface, c))

    @property
    def numbers(self) -> tuple[Scalar, ...]:
        """The numbers that remain in natural units: inertias, proportions of the surface, friction
        law.

        And the arm of rolling resistance, if there is any, and the outer field.
        """
        units, resistance, field = natural_units(self), self.rolling_resistance, self.field
        return (
            self.transverse_inertia / units.inertia,
            self.axial_inertia / units.inertia,
            *self.surface.proportions,
            *self.friction.coefficients(units),
            *(() if resistance is None else (resistance.length / units.length,)),
            *(() if field is None else field.numbers(units)),
        )


class Top(NamedTuple):
    """One contact of a body: the body, which of its surfaces touches, and which branch of the law
    holds.

    It has what the equations of motion need: the numbers of the body, the surface and the law.
    `RigidBody.contacts` and `RigidBody.lowest_at` make contacts of the same body, and
    `tippetop.mechanics.contacts.branches` takes another branch.
    """

    body: RigidBody
    number: int = 0
    """Number of the surface; 0 if the body has no other."""
    branch_law: FrictionLaw | None = None
    """The branch of the law that holds; None where the whole law does."""

    @classmethod
    def of(
        cls,
        mass: Scalar,
        transverse_inertia: Scalar,
        axial_inertia: Scalar,
        surface: Surface,
        friction: FrictionLaw,
        gravity: Scalar,
        rolling_resistance: RollingResistance | None = None,
        field: OuterField | None = None,
    ) -> "Top":
        """Return the first contact of the body with these numbers."""
        return cls(
            RigidBody(
                mass,
                transverse_inertia,
                axial_inertia,
                surface,
                friction,
                gravity,
                rolling_resistance,
                field,
            )
        )

    # translate: skip
    def altered(self, **numbers: Any) -> "Top":
        """Return the same contact of a body with other numbers, by the names of `RigidBody`, and
        the whole law.
        """
        return Top(self.body._replace(**numbers), self.number)

    @property
    def mass(self) -> Scalar:
        """Mass of the body, kg."""
        return self.body.mass

    @property
    def transverse_inertia(self) -> Scalar:
        """Principal moment of inertia across the axis, kg m^2."""
        return self.body.transverse_inertia

    @property
    def axial_inertia(self) -> Scalar:
        """Principal moment of inertia about the axis, kg m^2."""
        return self.body.axial_inertia

    @property
    def surface(self) -> Surface:
        """The surface that touches."""
        surface = self.body.surface
        return surface.on(self.number) if isinstance(surface, Hull) else surface

    @property
    def friction(self) -> FrictionLaw:
        """The law of friction, or the branch of it that holds at this contact."""
        return self.body.friction if self.branch_law is None else self.branch_law

    @property
    def gravity(self) -> Scalar:
        """Acceleration of gravity along the table's normal, m/s^2."""
        return self.body.gravity

    @property
    def rolling_resistance(self) -> RollingResistance | None:
        """What resists rolling beside friction, if anything does."""
        return self.body.rolling_resistance

    @property
    def field(self) -> OuterField | None:
        """Gravity along the table, and air; None where the table is level and there is no air."""
        return self.body.field

    @property
    def conserves_jellett(self) -> bool:
        """Whether Jellett's integral -L.a is constant on one contact, whatever the motion.

        The contact force has no part in it on a sphere, because both its moment a x F and the
        change of a are perpendicular to the other; a torque of the table has, and one of air.
        """
        turned_by_air = self.field is not None and self.field.resists_turning
        return self.surface.spherical and self.torque_free and not turned_by_air

    @property
    def resists_rolling(self) -> bool:
        """Whether the table resists rolling, and holds it where that takes little enough."""
        return self.rolling_resistance is not None

    @property
    def torque_free(self) -> bool:
        """Whether the table's torque, about the vertical and of rolling, is zero at any slip."""
        return self.friction.torque_free and not self.resists_rolling

    def traction(self, slip: Horizontal, angular_velocity: Vector) -> Traction:
        """Force and torque per unit normal force at this slip velocity (m/s) and angular velocity
        (rad/s).
        """
        force, torque = self.friction.traction(slip, angular_velocity)
        if self.rolling_resistance is not None:
            torque = add(torque, self.rolling_resistance.couple(angular_velocity))
        return Traction(force, torque)

    @property
    def kind(self) -> "Kind":
        """What remains of it without its numbers."""
        law, surface = self.body.friction, self.body.surface
        coefficients = len(law.coefficients(NATURAL))
        return Kind(
            kind_of(surface),
            type(law),
            len(surface.proportions),
            coefficients,
            self.resists_rolling,
            self.number,
            type(self.friction),
            len(self.friction.coefficients(NATURAL)) - coefficients,
            None if self.field is None else self.field.kind,
        )

    @property
    def branch_numbers(self) -> tuple[Scalar, ...]:
        """The numbers of the branch that the whole law does not have."""
        if self.branch_law is None:
            return ()
        units = natural_units(self.body)
        return self.branch_law.coefficients(units)[len(self.body.friction.coefficients(units)) :]

    @property
    def numbers(self) -> tuple[Scalar, ...]:
        """The numbers that remain in natural units: those of the body, and then of the branch."""
        return (*self.body.numbers, *self.branch_numbers)


class Kind(NamedTuple):
    """What remains of a contact when its numbers are taken away: its shape and its law."""

    surface: Any
    """What makes the surfaces of the body."""
    law: type[Any]
    """The whole law."""
    proportions: int
    coefficients: int
    """How many numbers surfaces and law have."""
    resists_rolling: bool
    number: int
    """Number of the surface that touches."""
    branch_law: type[Any]
    """The branch of the law that holds; the whole law where this has none."""
    branch_count: int
    """How many numbers the branch has that the law does not have."""
    field: FieldKind | None = None
    """The parts of the outer field; None where there is none."""

    @property
    def body_count(self) -> int:
        """How many dimensionless numbers its body has."""
        outer = 0 if self.field is None else self.field.numbers
        return 2 + self.proportions + self.coefficients + self.resists_rolling + outer

    @property
    def numbers(self) -> int:
        """How many dimensionless numbers a top of this kind has."""
        return self.body_count + self.branch_count

    @property
    def example(self) -> "Top":
        """Some top of this kind, to ask what is common to all."""
        return self.top((1.0,) * self.numbers)

    def top(self, numbers: tuple[Scalar, ...]) -> Top:
        """Make the top of this kind, in natural units, with these dimensionless numbers."""
        first, last = 2 + self.proportions, 2 + self.proportions + self.coefficients
        surface: Surface = self.surface.from_proportions(tuple(numbers[2:first]))
        friction = self.law(*numbers[first:last])
        resistance = RollingResistance(numbers[last]) if self.resists_rolling else None
        outer = tuple(numbers[last + self.resists_rolling : self.body_count])
        field = None if self.field is None else self.field.field(outer)
        body = RigidBody(1.0, numbers[0], numbers[1], surface, friction, 1.0, resistance, field)
        return self.on(body, numbers[self.body_count : self.numbers])

    def on(self, body: RigidBody, branch_numbers: Sequence[Scalar]) -> Top:
        """Make the contact of this kind on a body in natural units, with the numbers of its
        branch.
        """
        if self.branch_law is self.law:
            return Top(body, self.number)
        # A law with branches is a row of its numbers, with which those of each branch begin.
        law: Any = body.friction
        return Top(body, self.number, self.branch_law(*law, *branch_numbers))


# Several contacts of one body: its numbers come once, and then those of each branch.


def contact_numbers(tops: Sequence[Top]) -> tuple[Scalar, ...]:
    """Return the dimensionless numbers of some contacts of one body."""
    numbers: tuple[Scalar, ...] = tops[0].body.numbers
    for top in tops:
        numbers = (*numbers, *top.branch_numbers)
    return numbers


def number_count(kinds: Sequence[Kind]) -> int:
    """Return how many numbers contacts of these kinds have, on one body."""
    return kinds[0].body_count + sum([kind.branch_count for kind in kinds])


def contacts_with(kinds: Sequence[Kind], numbers: Sequence[Scalar]) -> list[Top]:
    """Return contacts of these kinds on one body, from a row that begins with their numbers."""
    last = kinds[0].body_count
    body = kinds[0].top(tuple(numbers[: kinds[0].numbers])).body
    tops = list[Top]()
    for kind in kinds:
        first, last = last, last + kind.branch_count
        tops.append(kind.on(body, numbers[first:last]))
    return tops


def natural_units(body: RigidBody | Top) -> Units:
    """Units in which the body's mass, its size and gravity along the table's normal are all 1."""
    size = body.surface.size
    return Units(body.mass, size, (size / body.gravity) ** 0.5)


def natural(top: Top) -> Top:
    """Return the top in its natural units."""
    return top.kind.top(top.numbers)


def natural_state(state: State, units: Units) -> State:
    """Return a state in natural units from one in SI."""
    return State(
        state.axis,
        scale(1.0 / units.angular_momentum, state.momentum),
        scale(1.0 / units.speed, state.velocity),
        state.height / units.length,
    )
