"""A body that is struck at its contact point: the impulses of the table, and its inverse effective mass."""

from collections.abc import Callable
from typing import NamedTuple, Protocol, TypeAlias

from tippetop.mechanics.friction import NO_TORQUE, Traction
from tippetop.mechanics.motion import angular_velocity, point_velocity
from tippetop.mechanics.roots import crossing
from tippetop.mechanics.state import State
from tippetop.mechanics.surface import contact_vector
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Horizontal, Vector, add, cross, length, scale

FUZZ = 1e-14
"""Round-off in the velocity of the contact point, relative to what it is made of."""


class Impulse(NamedTuple):
    """Impulses of the table on the body so far."""

    normal: float
    """Normal impulse p, N s."""
    tangential: Horizontal
    """Impulse of friction, N s."""
    angular: Vector
    """Impulse of the torque, N m s."""
    normal_work: float
    """Work of the normal impulse, J."""
    steps: int = 0
    """How many steps it took to find them, where they are integrated."""


NO_IMPULSE = Impulse(0.0, (0.0, 0.0), NO_TORQUE, 0.0)

Goal: TypeAlias = Callable[[Impulse], float]
"""Negative as long as a phase of the impact lasts."""


class Striking(NamedTuple):
    """A body at the start of an impact, and what an impulse does to its contact point."""

    state: State
    top: Top
    """The body."""
    arm: Vector
    """Contact vector a, m."""
    point: Vector
    """Velocity of the contact point, m/s; a normal part that is but round-off is zero."""
    inverse_mass: tuple[Vector, Vector, Vector]
    """Columns of M, the inverse effective mass (Delassus matrix): velocity of the contact point per unit
    impulse along x, y and z, 1/kg."""

    @classmethod
    def of(cls, state: State, top: Top) -> "Striking":
        """The body in this state."""
        arm = contact_vector(state.axis, top.surface)
        at_rest = state._replace(momentum=NO_TORQUE, velocity=NO_TORQUE)
        point = contact_velocity(state, arm, top)
        omega = angular_velocity(state.axis, state.momentum, top)
        if abs(point[2]) <= FUZZ * (length(state.velocity) + length(omega) * length(arm)):
            point = (point[0], point[1], 0.0)
        here = cls(state, top, arm, point, (NO_TORQUE, NO_TORQUE, NO_TORQUE))
        nudged = [
            contact_velocity(struck(at_rest, arm, unit, NO_TORQUE, top), arm, top)
            for unit in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
        ]
        return here._replace(inverse_mass=(nudged[0], nudged[1], nudged[2]))

    def after(self, impulse: Impulse) -> State:
        """The state after an impulse."""
        return struck(self.state, self.arm, (*impulse.tangential, impulse.normal), impulse.angular, self.top)

    def response(self, impulse: Impulse) -> Vector:
        """Change of the velocity of the contact point by an impulse, m/s."""
        (x, y), p, (east, north, up) = impulse.tangential, impulse.normal, self.inverse_mass
        change = (
            x * east[0] + y * north[0] + p * up[0],
            x * east[1] + y * north[1] + p * up[1],
            x * east[2] + y * north[2] + p * up[2],
        )
        if impulse.angular == NO_TORQUE:
            return change
        return add(change, cross(angular_velocity(self.state.axis, impulse.angular, self.top), self.arm))

    def approach(self, impulse: Impulse) -> float:
        """Normal velocity of the contact point after an impulse, m/s."""
        return float(self.point[2] + self.response(impulse)[2])

    def friction(self, impulse: Impulse) -> tuple[Vector, Vector, Traction]:
        """Velocity of the contact point, angular velocity and traction after an impulse."""
        omega = angular_velocity(self.state.axis, self.after(impulse).momentum, self.top)
        point = add(self.point, self.response(impulse))
        return point, omega, self.top.friction.traction((point[0], point[1]), omega)


class Process(Protocol):
    """How an impact goes on under some friction law."""

    def until(self, impulse: Impulse, goal: Goal, guess: float) -> Impulse:
        """The first impulse from a given one on at which the goal is not negative.

        The guess, positive, is how much the normal impulse may have to grow.
        """


def struck(state: State, arm: Vector, linear: Vector, angular: Vector, top: Top) -> State:
    """The state after an impulse at the contact and an impulse of torque."""
    return state._replace(
        momentum=add(state.momentum, add(cross(arm, linear), angular)),
        velocity=add(state.velocity, scale(1.0 / top.mass, linear)),
    )


def contact_velocity(state: State, arm: Vector, top: Top) -> Vector:
    """Velocity of the body's contact point, m/s."""
    return point_velocity(state.velocity, angular_velocity(state.axis, state.momentum, top), arm)


def first_reach(along: Callable[[float], Impulse], goal: Goal, guess: float) -> Impulse:
    """The impulse at which the goal stops being negative, on a way where it does so once.

    Where the goal is zero at the start, it is about to become negative: that start is passed over.
    """
    high = guess
    there = goal(along(high))
    while there < 0.0:
        high *= 2.0
        there = goal(along(high))
    if there == 0.0:
        return along(high)
    low = 0.0 if goal(along(0.0)) < 0.0 else 0.5 * high
    while goal(along(low)) >= 0.0:
        low, high = 0.5 * low, low
    return along(crossing(lambda q: goal(along(q)), low, high))
