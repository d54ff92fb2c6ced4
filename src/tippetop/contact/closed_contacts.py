"""The closed contacts of a mode at an instant: how they slip, and what the table does.

All that a mode states - its rates, its guards, what a result reads off it - is a function of this.
A velocity that begins or ends is given beside the numbers of the mode, by its direction, of which
friction is a function: the numbers have few digits of it.
"""

from typing import Any, NamedTuple

from tippetop.contact.conditions import held_reserve, least
from tippetop.contact.mode import BOTH, Reaction, split
from tippetop.mechanics.contacts.contact_forces import ContactForces, forces_on_one, forces_on_two
from tippetop.mechanics.contacts.contact_point import ContactPoint, contact_points
from tippetop.mechanics.contacts.forces import (
    Slips,
    directions_of,
    is_set_valued,
    jamming_margin,
    rolling_reserve,
    slip_length,
    slip_reserve,
)
from tippetop.mechanics.contacts.pair import slip_apart, slips_of
from tippetop.mechanics.contacts.slip_clock import SlipComponent
from tippetop.mechanics.contacts.slip_variables import remaining, scaled, slip_of
from tippetop.mechanics.contacts.wrench import Slip
from tippetop.mechanics.motion import axis_rate
from tippetop.mechanics.state import SlidingState
from tippetop.mechanics.vectors import Row, Scalar, Vector, add, dot


class Directed(NamedTuple):
    """Velocities that begin or end, beside the numbers of a mode."""

    slip: Slip | None = None
    """Direction of the slip of the only contact, or of the first of two, or of xi on two contacts
    whose law resists drilling (see `tippetop.mechanics.contacts.pair`); None if neither begins nor
    ends.
    """
    velocity: Slip = ()
    """That slip itself."""
    rolling: Slip | None = None
    """Direction of the horizontal angular velocity, or this itself; None if it neither begins nor
    ends.
    """
    zeta: Scalar | None = None
    """Where the slip of the first of two contacts ends, by how much that of the second is another
    along t: both may end at one instant.
    """


NONE_DIRECTED = Directed()


class ClosedContacts:
    """The closed contacts of a mode at an instant.

    Attributes
    ----------
    mode
        The mode: a `tippetop.contact.contact_mode.ContactMode`.
    numbers
        Its numbers: axis, angular momentum, and velocity if nothing sticks.
    directed
        Velocities that begin or end.
    """

    def __init__(self, mode: Any, numbers: Row, directed: Directed = NONE_DIRECTED) -> None:
        self.mode, self.numbers, self.directed = mode, numbers, directed
        self._evaluated: tuple[ContactForces, Slips] | None = None

    @property
    def points(self) -> tuple[ContactPoint, ...]:
        """The contact points."""
        y, mode = self.numbers, self.mode
        velocity = None if any(mode.sticks) else (y[6], y[7])
        return contact_points(*split(y), mode.tops, velocity)

    @property
    def forces(self) -> ContactForces:
        """Forces and accelerations."""
        return self._with_slips()[0]

    @property
    def slips(self) -> Slips:
        """Slip of each contact, or its direction where it begins or ends.

        That of one contact that sticks is None, and that of two is zero.
        """
        return self._with_slips()[1]

    def _with_slips(self) -> tuple[ContactForces, Slips]:
        """Return the forces and the slips, computed once."""
        evaluated = self._evaluated
        if evaluated is None:
            evaluated = self._on_one() if self.mode.is_single else self._on_two()
            self._evaluated = evaluated
        return evaluated

    def _on_one(self) -> tuple[ContactForces, Slips]:
        mode, y, (slip, _, rolling, _) = self.mode, self.numbers, self.directed
        (point,) = self.points
        if mode.sticks[0]:
            slip = None
        elif slip is None:
            slip = slip_of(*split(y), (y[6], y[7]), mode.top)[:2]
        if mode.prevents_rolling:
            rolling = None
        elif rolling is None:
            rolling = point.turning[:2]
        turning: Any = rolling
        return forces_on_one(point, slip, turning), (slip,)

    def _on_two(self) -> tuple[ContactForces, Slips]:
        mode, points = self.mode, self.points
        if mode.is_mixed:
            zeta = slip_apart(points)
            direction = scaled(mode.sense, directions_of(points[0].axis)[1][:2])
            slips = slips_of(points, (0.0 * zeta, 0.0 * zeta, zeta))
            return forces_on_two(points, (None, direction), mode.rolls), slips
        if mode.sticks[0]:
            return forces_on_two(points, (None, None), mode.rolls), ((0.0, 0.0), (0.0, 0.0))
        first, second = self._slips_on_two(points)
        return forces_on_two(points, (first, second), mode.rolls), (first, second)

    def _slips_on_two(self, points: tuple[ContactPoint, ...]) -> tuple[Slip, Slip]:
        """Return the slips of two contacts that both slip."""
        direction, velocity, _, zeta = self.directed
        if direction is None:
            sliding = SlidingState.unpack(self.numbers)
            return slip_of(*sliding, self.mode.tops[0]), slip_of(*sliding, self.mode.tops[1])
        if len(direction) == 3:
            return slips_of(points, direction)
        apart = slip_apart(points) if zeta is None else zeta
        return direction, slips_of(points, (*velocity, apart))[1]

    # Rates.

    def rates(self) -> tuple[Scalar, ...]:
        """Return the rates of the numbers."""
        forces, mode = self.forces, self.mode
        moment, force, outer = forces.moment, forces.force, forces.points[0].outer
        if outer is not None:
            moment, force = add(moment, outer.couple), add(force, outer.force)
        drawn = () if any(mode.sticks) else scaled(1.0 / mode.top.mass, force[:2])
        return (*axis_rate(*split(self.numbers), mode.top), *moment, *drawn)

    def rate_of(self, component: SlipComponent) -> Slip:
        """Return the rate of a velocity: slip, of two contacts that of the first or xi, or
        rolling.
        """
        forces = self.forces
        if self.mode.is_single:
            return component.rate(forces.acceleration(0), self.mode.top)
        return forces.rate[: component.count(self.mode.top)]

    def velocity_of(self, component: SlipComponent) -> Slip:
        """Return that velocity as the numbers have it."""
        mode, y = self.mode, self.numbers
        if mode.is_single:
            return component.of(*split(y), tuple(y[6:8]), mode.top)
        slip = slip_of(*SlidingState.unpack(y), mode.top)
        xi = (slip[0], slip[1], slip_apart(self.forces.points))
        return xi[: component.count(mode.top)]

    def beside(self, component: SlipComponent) -> tuple[Slip, Slip] | None:
        """Return the other velocity that friction can end, and its rate; None where there is
        none.
        """
        if not has_second(self.mode, component):
            return None
        if not self.mode.is_single:
            second: Any = self.slips[1]
            return second, self.forces.rates.points[1][:2]
        second_component = SlipComponent(not component.slip)
        return self.velocity_of(second_component), self.rate_of(second_component)

    # What the table does.

    def normal(self, number: int) -> Scalar:
        """Return the normal force of a contact."""
        return self.forces.wrenches[number].force[2]

    def reaction(self) -> Reaction:
        """Return the force of all contacts, and their torque about the first contact point."""
        forces, rolling = self.forces, self.directed.rolling
        turning: Vector = forces.points[0].turning
        if rolling is not None:
            turning = (rolling[0], rolling[1], turning[2])
        power = dot(forces.couple, turning)
        for slip, wrench in zip(self.slips, forces.wrenches, strict=True):
            if slip is not None:
                power = power + (wrench.force[0] * slip[0] + wrench.force[1] * slip[1])
        pressing = None if self.mode.is_single else least(forces.normal)
        held = held_reserve(self.mode, forces, self.slips)
        return Reaction(forces.force, forces.torque, power, forces.couple, pressing, held)

    def slip_reserve(self) -> Scalar:
        """Return what is positive while the table can hold the only contact, which sticks."""
        return slip_reserve(self.mode.top, self.forces.wrenches[0])

    def rolling_reserve(self) -> Scalar:
        """Return what is positive while the table can exert the couple that holds rolling."""
        forces = self.forces
        if not self.mode.is_single:
            return forces.rolling_reserve
        return rolling_reserve(forces.points[0], forces.wrenches[0], self.slips[0])

    def jamming_margin(self) -> Scalar:
        """Return what falls through zero where the normal forces of contacts that slip grow beyond
        all bounds.
        """
        mode, points, rolling = self.mode, self.forces.points, self.directed.rolling
        if not mode.is_single:
            along = directions_of(points[0].axis)[0]
            rolling = None if mode.prevents_rolling else scaled(mode.rolls, along[:2])
        elif rolling is None and not mode.prevents_rolling:
            rolling = points[0].turning[:2]
        return jamming_margin(points, self.slips, rolling)

    def slip_left(self, number: int = BOTH) -> Scalar:
        """Return what is positive while the slip of a contact goes on for a while: of the only one,
        or of both where the law resists drilling, if no number is given.
        """
        if number == 1:
            second: Any = self.slips[1]
            return remaining(second, self.forces.rates.points[1][:2])
        slip = SlipComponent(slip=True)
        return remaining(self.velocity_of(slip), self.rate_of(slip))

    def normal_if_stuck(self) -> Scalar | None:
        """Return the normal force of the only contact if it sticks; None where it slips."""
        return self.normal(0) if self.mode.sticks[0] else None


def has_second(mode: Any, component: SlipComponent) -> bool:
    """Return whether a velocity other than this one may end in a mode: slip or rolling, or the slip
    of the second of two contacts.
    """
    law, resists_rolling = mode.top.friction, mode.top.resists_rolling
    if not mode.is_single:
        return is_set_valued(law) and slip_length(law) is None
    if mode.sticks[0] or mode.prevents_rolling:
        return False
    return bool(resists_rolling if component.slip else is_set_valued(law))
