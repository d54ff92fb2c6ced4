"""A body that is struck at one or two contacts, and what impulses of the table do to it."""

# translate module: numbers

from collections.abc import Sequence
from operator import mul
from typing import NamedTuple, TypeAlias

from tippetop.mechanics.contacts.contact_point import ContactPoint, contact_points, flat
from tippetop.mechanics.contacts.slip_variables import inner, plus
from tippetop.mechanics.contacts.wrench import COUPLES, DRILLING, FORCES, Slip, Wrench
from tippetop.mechanics.impacts.unit_impulse import StruckContacts, normal_velocities
from tippetop.mechanics.laws.coulomb import RollingResistance
from tippetop.mechanics.laws.friction import FrictionLaw
from tippetop.mechanics.motion import angular_velocity, point_velocity
from tippetop.mechanics.natural_units import Units
from tippetop.mechanics.state import State
from tippetop.mechanics.surfaces.surface import contact_vector, kind_of
from tippetop.mechanics.top import RigidBody, Top
from tippetop.mechanics.vectors import Horizontal, add, length, scale

FUZZ = 1e-14
"""Round-off in the velocity of a point that strikes, relative to what it is made of."""

Impulse: TypeAlias = tuple[float, ...]
"""Impulse of the table's force so far and that of its torque about the first contact point, the
normal impulse of the first contact, and the work of the normal impulses.
"""

UPWARDS, FIRST, WORK = 2, 6, 7
"""Places in it of the normal impulse of all contacts, of that of the first, and of the work."""

NO_IMPULSE: Impulse = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


class StruckBody(NamedTuple):
    """A body at the start of an impact, and what an impulse does to it there.

    Its numbers are in units of the impact: the body's mass, its size, and the speed of approach of
    the first contact, or that of its contact point where it does not approach.
    """

    state: State
    """The state before, SI or in natural units."""
    top: Top
    """The body and its first contact, in the same."""
    units: Units
    """The units of the impact in those."""
    points: tuple[ContactPoint, ...]
    """The contact point that strikes, and one that strikes with it or is closed."""
    rounding: float
    """Round-off in velocities."""
    before: Slip
    """Velocity of the first contact point and angular velocity; a normal velocity that is no more
    than round-off is zero.
    """
    normal_beside: float
    """Normal velocity of the second contact point; zero without one."""
    contacts: StruckContacts
    """The contacts, with what an impulse adds to each of these six velocities."""

    @classmethod
    def of(cls, state: State, tops: Sequence[Top]) -> "StruckBody":
        """Return the body in this state; it strikes with the surface of the first of some tops."""
        top = tops[0]
        arms = [contact_vector(state.axis, one.surface) for one in tops]
        turning = angular_velocity(state.axis, state.momentum, top)
        x, y, z = point_velocity(state.velocity, turning, arms[0])
        fuzz = FUZZ * (length(state.velocity) + length(turning) * length(arms[0]))
        normal = without_fuzz(z, fuzz)
        speed = -normal if normal < 0.0 else length((x, y, normal)) or fuzz or 1.0
        units = Units(top.mass, top.surface.size, top.surface.size / speed)
        beside, apart = 0.0, (0.0, 0.0)
        if len(tops) > 1:
            sinking = point_velocity(state.velocity, turning, arms[1])[2]
            beside = without_fuzz(sinking, fuzz) / speed
            between = scale(1.0 / units.length, add(arms[1], scale(-1.0, arms[0])))
            apart = (between[0], between[1])
        scaled_body = in_units(top.body, units)
        scaled_tops = [
            one._replace(
                body=scaled_body,
                branch_law=None if one.branch_law is None else law_in_units(one.branch_law, units),
            )
            for one in tops
        ]
        momentum = scale(1.0 / units.angular_momentum, state.momentum)
        points = contact_points(state.axis, momentum, scaled_tops)
        contacts = StruckContacts(
            response_of(points[0]),
            apart,
            tuple([one.friction for one in scaled_tops]),
            scaled_tops[0].rolling_resistance,
        )
        before = (x / speed, y / speed, normal / speed, *points[0].turning)
        return cls(state, top, units, points, fuzz / speed, before, beside, contacts)

    def after(self, impulse: Impulse) -> State:
        """Return the state after an impulse."""
        x, y, z, along, across, upright = impulse[:6]
        moment = self.points[0].moment(Wrench((x, y, z), (along, across, upright)))
        gained = scale(self.units.speed, (x, y, z))
        turned = scale(self.units.angular_momentum, moment)
        return self.state._replace(
            momentum=add(self.state.momentum, turned), velocity=add(self.state.velocity, gained)
        )

    def change(self, impulse: Impulse) -> Slip:
        """Return what an impulse adds to the six velocities of the first contact."""
        return tuple([sum(map(mul, row, impulse)) for row in self.contacts.response])

    def velocities(self, impulse: Impulse) -> Slip:
        """Return the six velocities of the first contact after an impulse."""
        return plus(self.before, self.change(impulse))

    def normals(self, impulse: Impulse) -> Horizontal:
        """Return the normal velocities of both contacts after an impulse."""
        change = self.change(impulse)
        return normal_velocities(self.before, self.normal_beside, change, self.contacts)

    def energy_lost(self, impulse: Impulse) -> float:
        """Energy that goes with an impulse: minus its work, which is it times the mean velocity, as
        that is linear in it (Thomson and Tait).
        """
        twice = inner(impulse[:6], plus(self.before, self.velocities(impulse)))
        return max(0.0, float(-0.5 * twice * self.units.energy))


def without_fuzz(number: float, fuzz: float) -> float:
    """Return a number, or zero where it is no more than round-off."""
    return 0.0 if abs(number) <= fuzz else number


def law_in_units(law: FrictionLaw, units: Units) -> FrictionLaw:
    """Return a law with its numbers in these units."""
    return type(law)(*law.coefficients(units))


def in_units(body: RigidBody, units: Units) -> RigidBody:
    """Return a body with its numbers in these units of mass, length and time, and gravity 1."""
    resistance = body.rolling_resistance
    return RigidBody(
        body.mass / units.mass,
        body.transverse_inertia / units.inertia,
        body.axial_inertia / units.inertia,
        kind_of(body.surface).from_proportions(body.surface.proportions),
        law_in_units(body.friction, units),
        1.0,
        None if resistance is None else RollingResistance(resistance.length / units.length),
    )


def response_of(point: ContactPoint) -> tuple[Slip, ...]:
    """Return what unit wrenches at a contact point add to its velocity and the angular velocity."""
    columns = [flat(point.response(unit)) for unit in (*FORCES, *COUPLES, DRILLING)]
    return tuple(zip(*columns, strict=True))


def struck_state(state: State, point: ContactPoint, impulse: Wrench) -> State:
    """Return a state after the impulse of a force, N s, and a torque, N m s, at a contact point."""
    gained = scale(1.0 / point.top.mass, impulse.force)
    return state._replace(
        momentum=add(state.momentum, point.moment(impulse)), velocity=add(state.velocity, gained)
    )
