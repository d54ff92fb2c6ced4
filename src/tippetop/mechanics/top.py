"""The numbers of a top on its table, and the units in which they are few."""

from typing import Any, NamedTuple

from tippetop.mechanics.laws.coulomb import RollingResistance
from tippetop.mechanics.laws.friction import FrictionLaw, Traction
from tippetop.mechanics.state import State
from tippetop.mechanics.surfaces.hull import Hull, each_surface, lowest_surface
from tippetop.mechanics.surfaces.surface import Surface
from tippetop.mechanics.units import Units
from tippetop.mechanics.vectors import Horizontal, Scalar, Vector, add, scale


class Top(NamedTuple):
    """A body of revolution with one contact: all that the equations of motion need.

    A body of several surfaces (`Hull`) can touch the table with each of them, and one is active. Of
    a law with branches it has the one that holds at this contact. `each` and `lowest_at` return the
    same body with another contact, and `tippetop.mechanics.contacts.branches` another branch.
    """

    mass: Scalar
    transverse_inertia: Scalar
    axial_inertia: Scalar
    surface: Surface
    friction: FrictionLaw
    gravity: Scalar
    rolling_resistance: RollingResistance | None = None
    """What resists rolling beside friction, if anything does."""

    @property
    def conserves_jellett(self) -> bool:
        """Whether Jellett's integral -L.a is constant on one contact, whatever the motion.

        The contact force has no part in it on a sphere, because both its moment a x F and the
        change of a are perpendicular to the other; a torque of the table has.
        """
        return self.surface.spherical and self.torque_free

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
        coefficients = len(self.friction.coefficients(Units(1.0, 1.0, 1.0)))
        surface = getattr(self.surface, "make", type(self.surface))
        proportions = len(self.surface.proportions)
        return Kind(surface, type(self.friction), proportions, coefficients, self.resists_rolling)

    @property
    def active(self) -> int:
        """Number of the active surface; 0 if the body has no other."""
        return self.surface.active if isinstance(self.surface, Hull) else 0

    def lowest_at(self, c: float) -> "Top":
        """Return the top with the surface active that reaches lowest at this cosine of the tilt; of
        floats.
        """
        if not isinstance(self.surface, Hull):
            return self
        return self._replace(surface=lowest_surface(self.surface, c))

    @property
    def each(self) -> tuple["Top", ...]:
        """The top with every one of its surfaces active in turn."""
        every = each_surface(self.surface)
        return (
            tuple(self._replace(surface=surface) for surface in every)
            if len(every) > 1
            else (self,)
        )

    @property
    def numbers(self) -> tuple[Scalar, ...]:
        """The numbers that remain in natural units: inertias, proportions of the surface, friction
        law.

        And the arm of rolling resistance, if there is any.
        """
        units, resistance = natural_units(self), self.rolling_resistance
        return (
            self.transverse_inertia / units.inertia,
            self.axial_inertia / units.inertia,
            *self.surface.proportions,
            *self.friction.coefficients(units),
            *(() if resistance is None else (resistance.length / units.length,)),
        )


class Kind(NamedTuple):
    """What remains of a top when its numbers are taken away: how it is shaped and how it rubs."""

    surface: Any
    law: type[Any]
    proportions: int
    coefficients: int
    resists_rolling: bool

    @property
    def numbers(self) -> int:
        """How many dimensionless numbers a top of this kind has."""
        return 2 + self.proportions + self.coefficients + self.resists_rolling

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
        return Top(1.0, numbers[0], numbers[1], surface, friction, 1.0, resistance)


def natural_units(top: Top) -> Units:
    """Units in which the top's mass, its size and gravity are all 1."""
    size = top.surface.size
    return Units(top.mass, size, (size / top.gravity) ** 0.5)


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
