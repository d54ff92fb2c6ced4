"""A body that is struck at its contact point, and what impulses of the table do to it."""

# translate module: numbers

from collections.abc import Callable, Sequence
from operator import mul
from typing import NamedTuple, TypeAlias

from tippetop.mechanics.contacts.contact_point import ContactPoint, flat
from tippetop.mechanics.contacts.slip_variables import inner, plus
from tippetop.mechanics.contacts.wrench import COUPLES, DRILLING, FORCES, Slip, Wrench
from tippetop.mechanics.motion import angular_velocity, point_velocity
from tippetop.mechanics.roots import crossing
from tippetop.mechanics.state import State
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Vector, add, length, scale

FUZZ = 1e-14
"""Round-off in the velocity of the contact point, relative to what it is made of."""

Impulse: TypeAlias = tuple[float, ...]
"""Impulse of the table's force so far, N s, that of its torque, N m s, and the work of the normal
part, J; or that, and more.
"""

NORMAL, WORK = 2, 6
"""Places of the normal impulse in it, and of its work."""

NO_IMPULSE: Impulse = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)

Goal: TypeAlias = Callable[[Impulse], float]
"""Negative as long as a phase of the impact lasts."""


class StruckBody(NamedTuple):
    """A body at the start of an impact, and what an impulse does to it there."""

    state: State
    contact: ContactPoint
    lever: float
    """Length of the contact vector, m."""
    speed: float
    striking: float
    """Speeds of the body's material, what rounding is measured by, and of its contact point, m/s.
    """
    before: Slip
    """Velocity of the contact point, m/s, and angular velocity, rad/s; what is but round-off of a
    normal velocity is zero.
    """
    response: tuple[Slip, ...]
    """What an impulse adds to each of these six, per component of the force's and of the torque's:
    first of all the inverse effective mass M (Delassus matrix), 1/kg.
    """

    @classmethod
    def of(cls, state: State, top: Top) -> "StruckBody":
        """Return the body in this state."""
        contact = ContactPoint.of(state.axis, state.momentum, top)
        lever = length(contact.arm)
        speed = length(state.velocity) + length(contact.turning) * lever
        x, y, z = point_velocity(state.velocity, contact.turning, contact.arm)
        columns = [flat(contact.response(wrench)) for wrench in (*FORCES, *COUPLES, DRILLING)]
        point = (x, y, 0.0 if abs(z) <= FUZZ * speed else z)
        before, response = (*point, *contact.turning), tuple(zip(*columns, strict=True))
        return cls(state, contact, lever, speed, length(point), before, response)

    def after(self, impulse: Impulse) -> State:
        """Return the state after an impulse."""
        x, y, z, *torque = impulse[:6]
        moment = self.contact.moment(Wrench((x, y, z), (torque[0], torque[1], torque[2])))
        gained = scale(1.0 / self.contact.top.mass, (x, y, z))
        return self.state._replace(
            momentum=add(self.state.momentum, moment), velocity=add(self.state.velocity, gained)
        )

    def change(self, impulse: Sequence[float]) -> Slip:
        """Return the changes of the six velocities by an impulse."""
        return tuple([sum(map(mul, row, impulse)) for row in self.response])

    def velocities(self, impulse: Impulse) -> Slip:
        """Return the six velocities after an impulse."""
        return plus(self.before, self.change(impulse))

    def approach(self, impulse: Impulse) -> float:
        """Normal velocity of the contact point after an impulse, m/s."""
        return float(self.before[2] + sum(map(mul, self.response[2], impulse)))

    def friction(self, velocity: Slip) -> Slip:
        """Force and torque per unit normal impulse under a law that says them at any slip, six
        numbers.
        """
        x, y, _, *omega = velocity
        force, torque = self.contact.top.traction((x, y), (omega[0], omega[1], omega[2]))
        return (*force, 1.0, *torque)

    def work(self, impulse: Impulse) -> float:
        """Work of an impulse, J: times the mean velocity, as that is linear in it (Thomson and
        Tait).
        """
        return float(0.5 * inner(impulse[:6], plus(self.before, self.velocities(impulse))))

    def line_from(self, impulse: Impulse, unit: Slip) -> Callable[[float], Impulse]:
        """Return the impulse as a function of the normal one, from an impulse on, at a constant
        ratio.
        """
        approach, rise = self.approach(impulse), sum(map(mul, self.response[2], unit))

        def along(q: float) -> Impulse:
            moved = [a + q * b for a, b in zip(impulse, unit, strict=False)]
            work = impulse[WORK] + q * (approach + 0.5 * q * rise)
            return (*moved[:WORK], work, *moved[WORK + 1 :])

        return along


def contact_velocity(state: State, arm: Vector, top: Top) -> Vector:
    """Velocity of the body's contact point, m/s."""
    return point_velocity(state.velocity, angular_velocity(state.axis, state.momentum, top), arm)


def first_reach(along: Callable[[float], Impulse], goal: Goal, guess: float) -> Impulse:
    """Return the impulse on a curve at which the goal stops being negative, which it does once.

    Where the goal is zero at the start, it is about to become negative: that start is passed over.
    """
    high = guess
    ahead = goal(along(high))
    while ahead < 0.0:
        high *= 2.0
        ahead = goal(along(high))
    if ahead == 0.0:
        return along(high)
    low = 0.0 if goal(along(0.0)) < 0.0 else 0.5 * high
    while goal(along(low)) >= 0.0:
        low, high = 0.5 * low, low
    return along(crossing(lambda q: goal(along(q)), low, high))
