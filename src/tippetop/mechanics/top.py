"""The numbers of a top on its table, and the units in which they are few."""

from typing import NamedTuple

from tippetop.mechanics.friction import FrictionLaw
from tippetop.mechanics.shape import Shape
from tippetop.mechanics.state import State
from tippetop.mechanics.vectors import Scalar, scale


class Top(NamedTuple):
    """A body of revolution, the table's friction law and gravity: all that the equations of motion need."""

    mass: Scalar
    transverse_inertia: Scalar
    axial_inertia: Scalar
    shape: Shape
    friction: FrictionLaw
    gravity: Scalar

    @property
    def kind(self) -> "Kind":
        """What remains when the numbers are taken away."""
        return kind_of(self)

    @property
    def numbers(self) -> tuple[Scalar, ...]:
        """The dimensionless numbers."""
        return dimensionless_numbers(self)


class Units(NamedTuple):
    """Units of mass (kg), length (m) and time (s) in which a top is simulated."""

    mass: Scalar
    length: Scalar
    time: Scalar

    @property
    def speed(self) -> Scalar:
        """Unit of velocity, m/s."""
        return self.length / self.time

    @property
    def energy(self) -> Scalar:
        """Unit of energy, J."""
        return self.mass * self.speed**2

    @property
    def angular_momentum(self) -> Scalar:
        """Unit of angular momentum, kg m^2/s."""
        return self.mass * self.length * self.speed


def natural_units(top: Top) -> Units:
    """Units in which the top's mass, its size and gravity are all 1."""
    size = top.shape.size
    return Units(top.mass, size, (size / top.gravity) ** 0.5)


def dimensionless_numbers(top: Top) -> tuple[Scalar, ...]:
    """The numbers that remain in natural units: inertias, proportions of the shape, friction law."""
    units = natural_units(top)
    inertia = units.mass * units.length**2
    return (
        top.transverse_inertia / inertia,
        top.axial_inertia / inertia,
        *top.shape.proportions,
        *top.friction.coefficients(units.speed),
    )


def natural(top: Top) -> Top:
    """The top in its natural units."""
    return top.kind.top(top.numbers)


def natural_state(state: State, units: Units) -> State:
    """A state in natural units from one in SI."""
    return State(
        state.axis,
        scale(1.0 / units.angular_momentum, state.momentum),
        scale(1.0 / units.speed, state.velocity),
        state.height / units.length,
    )


class Kind(NamedTuple):
    """What remains of a top when its numbers are taken away: how it is shaped and how it rubs."""

    shape: type[Shape]
    friction: type[FrictionLaw]
    proportions: int
    coefficients: int

    @property
    def numbers(self) -> int:
        """How many dimensionless numbers a top of this kind has."""
        return 2 + self.proportions + self.coefficients

    def top(self, numbers: tuple[Scalar, ...]) -> Top:
        """Make the top of this kind, in natural units, with these dimensionless numbers."""
        cut = 2 + self.proportions
        shape = self.shape.from_proportions(tuple(numbers[2:cut]))
        friction = self.friction.from_coefficients(tuple(numbers[cut:]))
        return Top(1.0, numbers[0], numbers[1], shape, friction, 1.0)


def kind_of(top: Top) -> Kind:
    """The kind of a top."""
    coefficients = top.friction.coefficients(1.0)
    return Kind(type(top.shape), type(top.friction), len(top.shape.proportions), len(coefficients))
