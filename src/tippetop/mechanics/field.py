"""The outer field: gravity along a table that slopes, and air.

What acts on a body beside the table, and beside its weight along the table's normal, is a function
of its state, field(n, L, u) -> (f0, m0): a force at the centre of mass and a couple. The normal of
the table is z; gravity along it is `Top.gravity`. Impulses know nothing of the field.
"""

from typing import NamedTuple

from tippetop.mechanics.natural_units import Units
from tippetop.mechanics.vectors import Horizontal, Scalar, Vector, add, dot, scale

STILL = 1e-4
"""Speed, and angular velocity, in natural units, below which quadratic resistance is linear: |u| is
sqrt(u^2 + STILL^2), which has power series at u = 0. With more, a brake of slow motion shows the
difference; with much less, the coefficients of a step do not show the bend of |u| that is ahead,
and the step passes it.
"""


class Resistance(NamedTuple):
    """What resists a velocity: (linear + quadratic |v|) v."""

    linear: Scalar
    quadratic: Scalar | None = None
    """None where resistance is linear, which has power series at any velocity."""

    def factor(self, square: Scalar) -> Scalar:
        """Return the resistance per velocity, where the velocity has this square."""
        if self.quadratic is None:
            return self.linear
        return self.linear + self.quadratic * (square + STILL * STILL) ** 0.5

    @property
    def numbers(self) -> tuple[Scalar, ...]:
        """Its coefficients."""
        return (self.linear,) if self.quadratic is None else (self.linear, self.quadratic)


class OuterForces(NamedTuple):
    """What acts on a body beside the table, and beside its weight along the table's normal."""

    force: Vector
    """Force at the centre of mass, N."""
    couple: Vector
    """Couple, N m."""


class FieldKind(NamedTuple):
    """What remains of an outer field without its numbers: how many coefficients each part has."""

    slope: int
    axial: int
    transverse: int
    drag: int

    @property
    def numbers(self) -> int:
        """How many numbers such a field has."""
        return self.slope + self.axial + self.transverse + self.drag

    def field(self, numbers: tuple[Scalar, ...]) -> "OuterField":
        """Return the field of this kind with these numbers."""
        first = self.slope
        second = first + self.axial
        third = second + self.transverse
        return OuterField(
            (numbers[0], numbers[1]) if self.slope else None,
            resistance_of(tuple(numbers[first:second])),
            resistance_of(tuple(numbers[second:third])),
            resistance_of(tuple(numbers[third:])),
        )


class OuterField(NamedTuple):
    """Gravity along the table, and what air resists; each None where it is absent."""

    slope: Horizontal | None = None
    """Acceleration of gravity along the table, m/s^2."""
    axial: Resistance | None = None
    """Resistance of air to the angular velocity about the axis, N m s and N m s^2."""
    transverse: Resistance | None = None
    """Resistance of air to the angular velocity across the axis, N m s and N m s^2."""
    drag: Resistance | None = None
    """Resistance of air to the velocity of the centre of mass, N s/m and N s^2/m^2."""

    @property
    def resists_turning(self) -> bool:
        """Whether air has a couple, which changes Jellett's integral."""
        return self.axial is not None or self.transverse is not None

    @property
    def has_air(self) -> bool:
        """Whether there is air, which takes energy."""
        return self.resists_turning or self.drag is not None

    # translate: skip
    def without_zeros(self) -> "OuterField | None":
        """Return the field of the parts that are not zero; None if all are. Of floats."""
        slope = self.slope if self.slope is not None and any(self.slope) else None
        axial, transverse, drag = (
            part if part is not None and any(part.numbers) else None
            for part in (self.axial, self.transverse, self.drag)
        )
        acting = OuterField(slope, axial, transverse, drag)
        return None if acting == OuterField() else acting

    def couple(self, axis: Vector, spin: Scalar, turning: Vector) -> Vector:
        """Return the couple of air, N m.

        Parameters
        ----------
        axis, spin, turning
            Axis n, angular velocity about it and angular velocity, rad/s.
        """
        across = add(turning, scale(-spin, axis))
        couple: Vector = (0.0, 0.0, 0.0)
        if self.axial is not None:
            couple = scale(-(self.axial.factor(spin * spin) * spin), axis)
        if self.transverse is not None:
            couple = add(couple, scale(-self.transverse.factor(dot(across, across)), across))
        return couple

    def air_force(self, velocity: Vector) -> Vector:
        """Return the force of air, N, at a velocity of the centre of mass, m/s."""
        if self.drag is None:
            return (0.0, 0.0, 0.0)
        return scale(-self.drag.factor(dot(velocity, velocity)), velocity)

    @property
    def kind(self) -> FieldKind:
        """What remains of it without its numbers."""
        counts = [
            0 if resistance is None else len(resistance.numbers)
            for resistance in (self.axial, self.transverse, self.drag)
        ]
        return FieldKind(0 if self.slope is None else 2, counts[0], counts[1], counts[2])

    def numbers(self, units: Units) -> tuple[Scalar, ...]:
        """Return its numbers in units of mass, length and time."""
        acceleration = units.speed / units.time
        numbers: tuple[Scalar, ...] = ()
        if self.slope is not None:
            numbers = (self.slope[0] / acceleration, self.slope[1] / acceleration)
        for resistance in (self.axial, self.transverse):
            if resistance is not None:
                numbers = (
                    *numbers,
                    *in_units(resistance, units.inertia / units.time, units.inertia),
                )
        if self.drag is not None:
            numbers = (
                *numbers,
                *in_units(self.drag, units.mass / units.time, units.mass / units.length),
            )
        return numbers


def in_units(resistance: Resistance, linear: Scalar, quadratic: Scalar) -> tuple[Scalar, ...]:
    """Return the coefficients of a resistance in units of these."""
    if resistance.quadratic is None:
        return (resistance.linear / linear,)
    return (resistance.linear / linear, resistance.quadratic / quadratic)


def resistance_of(numbers: tuple[Scalar, ...]) -> Resistance | None:
    """Return the resistance with these coefficients, none, one or two."""
    if len(numbers) == 0:
        return None
    return Resistance(numbers[0]) if len(numbers) == 1 else Resistance(numbers[0], numbers[1])
