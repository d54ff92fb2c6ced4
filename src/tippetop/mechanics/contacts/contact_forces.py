"""What the table does to a body at its closed contacts, one or two, and how that accelerates."""

from collections.abc import Sequence
from typing import Any, NamedTuple

from tippetop.mechanics.contacts.contact_point import Acceleration, ContactPoint
from tippetop.mechanics.contacts.forces import (
    Load,
    Slips,
    directions_of,
    forces_and_accelerations,
    slip_reserve,
    solve_contacts,
    solve_loaded,
    sum_at,
    turning_with,
)
from tippetop.mechanics.contacts.pair import ContactPair, apart, slips_of, turning_along
from tippetop.mechanics.contacts.slip_variables import scaled
from tippetop.mechanics.contacts.system import ContactRates
from tippetop.mechanics.contacts.wrench import Slip, Wrench
from tippetop.mechanics.laws.coulomb import TINY
from tippetop.mechanics.laws.friction import NO_TORQUE
from tippetop.mechanics.vectors import Horizontal, Scalar, Vector, add, cross, dot, scale


class ContactForces(NamedTuple):
    """What the table does at all closed contacts, and how they accelerate.

    From `rate` on, the quantities are those of two contacts: see
    `tippetop.mechanics.contacts.pair`.
    """

    points: tuple[ContactPoint, ...]
    """The contact points."""
    wrenches: tuple[Wrench, ...]
    """What the table does at each; along e, where two stick, all at the first."""
    rates: ContactRates
    """Accelerations of the contact points, and angular acceleration."""
    holding: Scalar = 0.0
    """Couple along e that holds rolling on two contacts, N m; none where nothing does."""

    @property
    def force(self) -> Vector:
        """Force of the table, N."""
        return _total([wrench.force for wrench in self.wrenches])

    @property
    def couple(self) -> Vector:
        """Torque of the table at all contacts, each about its own point, N m."""
        return _total([wrench.torque for wrench in self.wrenches])

    @property
    def moment(self) -> Vector:
        """Moment of the table about the centre of mass, N m."""
        pairs = zip(self.points, self.wrenches, strict=True)
        return _total([point.moment(wrench) for point, wrench in pairs])

    @property
    def torque(self) -> Vector:
        """Torque of the table about the first contact point, N m."""
        torque, first = self.couple, self.points[0].arm
        for point, wrench in zip(self.points[1:], self.wrenches[1:], strict=True):
            torque = add(torque, cross(add(point.arm, scale(-1.0, first)), wrench.force))
        return torque

    @property
    def normal(self) -> tuple[Scalar, ...]:
        """Normal forces, N."""
        return tuple([wrench.force[2] for wrench in self.wrenches])

    def acceleration(self, number: int) -> Acceleration:
        """Return the acceleration of a contact point, and the angular acceleration."""
        return Acceleration(self.rates.points[number], self.rates.turning)

    @property
    def rate(self) -> Slip:
        """Rate of xi."""
        point = self.rates.points[0]
        return (point[0], point[1], apart(self.points) * self.rates.turning[2])

    def needed(self, number: int) -> Scalar:
        """Force across e at a contact, N."""
        return dot(self.wrenches[number].force, directions_of(self.points[0].axis)[1])

    def reserve(self, number: int) -> Scalar:
        """Positive while the table can exert the horizontal force on a contact that alone sticks,
        N^2.
        """
        return slip_reserve(self.points[number].top, Wrench(self.wrenches[number].force, NO_TORQUE))

    def sticking_reserve(self, number: int) -> Scalar:
        """mu^2 N_i^2 - T_i^2 where both stick, N^2."""
        force = (self.needed(number), 0.0, self.normal[number])
        return slip_reserve(self.points[number].top, Wrench(force, NO_TORQUE))

    @property
    def along(self) -> Scalar:
        """S, the force along e at both, N."""
        return dot(self.force, directions_of(self.points[0].axis)[0])

    @property
    def rolling(self) -> Scalar:
        """omega_e, rad/s."""
        return turning_along(self.points)

    @property
    def rolling_rate(self) -> Scalar:
        """Rate of omega_e, rad/s^2."""
        return dot(self.rates.turning, directions_of(self.points[0].axis)[0])

    @property
    def rolling_reserve(self) -> Scalar:
        """Positive while the table can exert the couple that holds rolling, (N m)^2."""
        resistance: Any = self.points[0].top.rolling_resistance
        return resistance.reserve(self.normal[0] + self.normal[1], (self.holding, 0.0))

    @property
    def both_reserve(self) -> Scalar:
        """Positive while the table can exert S, N^2: (sqrt(A_1) + sqrt(A_2))^2 - S^2 for positive
        A_i.
        """
        first, second, along = self.sticking_reserve(0), self.sticking_reserve(1), self.along
        product = first * second
        return first + second + 2.0 * (product * product + TINY) ** 0.25 - along * along

    @property
    def is_held(self) -> bool:
        """Whether the table can hold both contacts, without moments of drilling; of floats."""
        return bool(
            min(self.sticking_reserve(0), self.sticking_reserve(1), self.both_reserve) >= 0.0
        )

    def spare(self, direction: Slip) -> Scalar:
        """Return the most power of friction where xi = `direction`, less that of holding, W."""
        spare: Any = 0.0
        for point, slip, wrench in zip(
            self.points, slips_of(self.points, direction), self.wrenches, strict=True
        ):
            turning = turning_with(point, slip)
            force, torque = point.top.friction.traction((slip[0], slip[1]), turning)
            x, y, normal = wrench.force
            spare = spare - normal * torque[2] * turning[2]
            spare = spare + (x - normal * force[0]) * slip[0] + (y - normal * force[1]) * slip[1]
        return spare


def forces_on_one(
    point: ContactPoint, slip: Slip | None, rolling: Horizontal | None
) -> ContactForces:
    """Return the forces and accelerations of one closed contact; see `forces_and_accelerations`."""
    wrench, acceleration = forces_and_accelerations(point, slip, rolling)
    return ContactForces(
        (point,), (wrench,), ContactRates((acceleration.point,), acceleration.turning)
    )


def forces_on_two(
    pair: ContactPair, slips: Slips, rolls: float, load: Load | None = None
) -> ContactForces:
    """Return the forces and accelerations of a body whose two contacts stay closed.

    Parameters
    ----------
    pair
        The contact points.
    slips
        How they slip.
    rolls
        Sign of omega_e, 0 where it is held at zero; without rolling resistance it does not matter.
    load
        Normal forces, if these are given and the contacts need not stay closed.
    """
    along = directions_of(pair[0].axis)[0]
    stopped = pair[0].top.resists_rolling and not rolls
    rolling = None if stopped else scaled(rolls, along[:2])
    wrenches, rates = (
        solve_contacts(pair, slips, rolling)
        if load is None
        else solve_loaded(pair, slips, rolling, load)
    )
    holding = dot(wrenches[-1][1].torque, along) if stopped else 0.0
    return ContactForces(pair, (sum_at(0, wrenches), sum_at(1, wrenches)), rates, holding)


def _total(vectors: Sequence[Vector]) -> Vector:
    """Return the sum of vectors, of which there is at least one."""
    total = vectors[0]
    for vector in vectors[1:]:
        total = add(total, vector)
    return total
