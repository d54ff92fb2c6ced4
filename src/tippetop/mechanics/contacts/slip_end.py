"""How slip, or rolling, ends: the velocities that dry friction can bring to zero, and their last
moments.

What ends is a velocity xi: the slip zeta (see `slip_variables`), or rolling, which is the
horizontal angular velocity w_t under rolling resistance. Away from xi = 0 the table's wrench
depends on the direction e = xi / s alone, s = |xi|, and on numbers that do not end with it: with y
= (n, L), and u where the contact slips,

    y' = Y(y, e),        xi' = A(y, e) = R e + V,        s' = R,        s e' = V,        V.e = 0.

With xi itself as a variable beside y nothing cancels as it goes to zero. Where R < 0, s reaches
zero in finite time, and e turns at the rate V/s, which may grow without bound. In a clock whose
unit is the time s / |A|, nearly -ln s, it does not: de = V/|A|, dy = s Y/|A|, dt = s/|A|, ds = s
R/|A|. Nor does it where s has a least value, R = 0.
"""

from typing import NamedTuple

from tippetop.mechanics.contacts.contact_point import Acceleration, ContactPoint, flat
from tippetop.mechanics.contacts.forces import (
    forces_and_accelerations,
    pressing_wrench,
    slip_length,
    slip_wrenches,
)
from tippetop.mechanics.contacts.slip_variables import (
    HORIZON,
    inner,
    plus,
    remaining,
    scaled,
    size,
    slip_of,
    slip_part,
)
from tippetop.mechanics.contacts.wrench import COUPLES, FORCES, Slip, Wrench
from tippetop.mechanics.motion import angular_velocity, axis_rate
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Horizontal, Scalar, Vector, add, dot, scale

DIGITS = 1e-11
"""Error of a velocity that is not followed by itself, relative to those of which it is made."""

QUICK = 1e5
"""How many times its own velocities change in a natural unit of time where they change fast."""

JAMMING = 1e-8
"""Delassus number of the slipping contact, over that without friction, at which the contact jams:
the time that is left falls as its square, and is rounding then. The slip that friction still takes
before the jam is as small a fraction of what the impact takes.
"""


class SlipComponent(NamedTuple):
    """A velocity that ends or begins, and what the other does meanwhile."""

    slip: bool
    """Whether it is the slip; else it is rolling."""
    held: bool = False
    """Whether the other is held at zero; else it goes on, or is not resisted."""

    @property
    def moves(self) -> bool:
        """Whether the velocity of the centre of mass is free beside it."""
        return not self.slip and not self.held

    def recurs(self, top: Top) -> bool:
        """Return whether it may end and begin many times a second: slip under a law that does not
        resist drilling.
        """
        return self.slip and slip_length(top.friction) is None

    def of(self, axis: Vector, momentum: Vector, velocity: Slip, top: Top) -> Slip:
        """Return the velocity xi, from axis, angular momentum and horizontal velocity of the centre
        of mass.
        """
        if self.slip:
            return slip_of(axis, momentum, (velocity[0], velocity[1]), top)
        return angular_velocity(axis, momentum, top)[:2]

    def rate(self, acceleration: Acceleration, top: Top) -> Slip:
        """Return the rate of xi as the contact accelerates."""
        if self.slip:
            return slip_part(flat(acceleration), slip_length(top.friction))
        return acceleration.turning[:2]

    def wrenches(self, top: Top) -> tuple[Wrench, ...]:
        """Return the wrenches that resist its components."""
        return slip_wrenches(top.friction) if self.slip else COUPLES

    def resisting(self, wrench: Wrench, top: Top) -> Slip:
        """Return the components of a wrench that resist xi; a drilling torque is over the law's
        length.
        """
        if not self.slip:
            return wrench.torque[:2]
        reach = slip_length(top.friction)
        return wrench.force[:2] if reach is None else (*wrench.force[:2], wrench.torque[2] / reach)

    def shares(self, direction: Slip, top: Top) -> tuple[Scalar, ...]:
        """Return the resisting components per unit normal force for a direction of xi."""
        if not self.slip:
            assert top.rolling_resistance is not None
            return top.rolling_resistance.couple((direction[0], direction[1], 0.0))[:2]
        reach = slip_length(top.friction)
        w = 0.0 * direction[0] if reach is None else direction[2] * (1.0 / reach)
        force, torque = top.friction.traction((direction[0], direction[1]), (0.0, 0.0, w))
        return force if reach is None else (*force, torque[2])

    def contact(
        self, point: ContactPoint, xi: Slip | None, slip: Slip | None
    ) -> tuple[Wrench, Acceleration]:
        """Return the wrench and the acceleration of the contact for a direction of xi, or xi held
        (None).

        The slip is asked for only where rolling ends or begins and the contact slips meanwhile.
        """
        return forces_and_accelerations(point, *self.beside(point, xi, slip))

    def beside(
        self, point: ContactPoint, xi: Slip | None, slip: Slip | None
    ) -> tuple[Slip | None, Horizontal | None]:
        """Slip and rolling, None where they are held, for the same."""
        if self.slip:
            return xi, None if self.held else point.turning[:2]
        return slip if self.moves else None, None if xi is None else (xi[0], xi[1])


class SlipEndState(NamedTuple):
    """A body one of whose velocities is about to end: the state in the clock above."""

    axis: Vector
    momentum: Vector
    """Axis n, and angular momentum L, kg m^2/s."""
    velocity: Slip
    """Horizontal velocity of the centre of mass, m/s, where that is free, or zeta of two contacts
    (see `slip_end_on_two`); else nothing.
    """
    direction: Slip
    """Direction e of xi, a unit vector."""
    speed: Scalar
    """Its size s, m/s or rad/s."""
    time: Scalar
    """Time, s."""


class SlipEndRates(NamedTuple):
    """What follows from a state: rates of axis, angular momentum, velocity and xi, and the table's
    wrench.
    """

    axis: Vector
    momentum: Vector
    velocity: Slip
    xi: Slip
    wrench: Wrench
    acceleration: Acceleration


def rates_in_time(state: SlipEndState, ending: SlipComponent, top: Top) -> SlipEndRates:
    """Rates in time."""
    point = ContactPoint.of(state.axis, state.momentum, top)
    wrench, acceleration = ending.contact(point, state.direction, slip_beside(state, ending, top))
    drawn = scaled(1.0 / top.mass, wrench.force[: len(state.velocity)])
    tilting = axis_rate(state.axis, state.momentum, top)
    xi = ending.rate(acceleration, top)
    return SlipEndRates(tilting, point.moment(wrench), drawn, xi, wrench, acceleration)


def slip_beside(state: SlipEndState, ending: SlipComponent, top: Top) -> Slip | None:
    """Return the slip that goes on while rolling ends; None where there is none."""
    if not ending.moves:
        return None
    return slip_of(state.axis, state.momentum, (state.velocity[0], state.velocity[1]), top)


def slip_end_rates(state: SlipEndState, rates: SlipEndRates) -> SlipEndState:
    """Rates in the clock of the way that xi goes, in units of s."""
    pace = inner(rates.xi, rates.xi) ** -0.5
    along, step = pace * inner(rates.xi, state.direction), pace * state.speed
    # The last part is none where e is a unit vector, and keeps it one.
    unit = 2.0 * (1.0 - inner(state.direction, state.direction)) - along
    turn = tuple(pace * a + unit * e for a, e in zip(rates.xi, state.direction, strict=True))
    moved, speeding = scaled(step, rates.velocity), along * state.speed
    return SlipEndState(
        scale(step, rates.axis), scale(step, rates.momentum), moved, turn, speeding, step
    )


def reopening_guard(state: SlipEndState, rates: SlipEndRates, top: Top) -> Scalar:
    """Falls through zero where xi outlasts twice the `HORIZON` of `remaining`, by more than what
    rounding of its direction in a state makes of it.

    A state has xi to `DIGITS` of a velocity U that it is made of, and so the rate R to `DIGITS` U
    |A| / s: a velocity that is not more than rounding stays in the clock until it ends or grows.
    All is in natural units, where U^2 = g size + (omega size)^2 is 1 + omega^2; the value is a
    velocity squared, as that of `remaining` is, of rolling an angular velocity squared.
    """
    rate, turning = rates.xi, angular_velocity(state.axis, state.momentum, top)
    doubt = DIGITS * ((1.0 + dot(turning, turning)) * inner(rate, rate)) ** 0.5
    horizon = 2.0 * HORIZON
    return horizon * doubt - remaining(scaled(state.speed, state.direction), rate, horizon)


def zero_guard(state: SlipEndState, rates: SlipEndRates, top: Top, horizon: Scalar) -> Scalar:
    """Falls through zero where xi, at its present rate, ends within the horizon, and is small
    by itself.

    That is s + horizon R Q / (Q + |A|), in natural units, with an acceleration Q that takes the
    body's own velocities, (1 + omega^2)^(1/2), in the time 1 / `QUICK`: where xi changes faster
    than that, there may be much of it left for so short a time.
    """
    rate, turning = rates.xi, angular_velocity(state.axis, state.momentum, top)
    quick = QUICK * (1.0 + dot(turning, turning)) ** 0.5
    share = quick / (quick + inner(rate, rate) ** 0.5)
    return state.speed + horizon * share * inner(rate, state.direction)


def overtaking_guard(state: SlipEndState, ending: SlipComponent, top: Top) -> Scalar:
    """Falls through zero where the other velocity, at present rates, ends in half the time left to
    this.
    """
    rates = rates_in_time(state, ending, top)
    second = SlipComponent(not ending.slip)
    xi = second.of(state.axis, state.momentum, state.velocity, top)
    ahead = -2.0 * inner(xi, xi) * inner(rates.xi, state.direction)
    return ahead + state.speed * inner(xi, second.rate(rates.acceleration, top))


def jamming_guard(state: SlipEndState, ending: SlipComponent, top: Top) -> Scalar:
    """Falls through zero where the normal force grows beyond all bounds: Painleve's paradox begins.

    Friction that turns is about to press the contact as much as the normal force opens it. There xi
    changes as fast, and would seem to end, however much of it is left.
    """
    point = ContactPoint.of(state.axis, state.momentum, top)
    pressed = pressing_wrench(
        point, *ending.beside(point, state.direction, slip_beside(state, ending, top))
    )
    return point.response(pressed).point[2] - JAMMING * point.response(FORCES[2]).point[2]


def landed(state: SlipEndState, rates: SlipEndRates) -> tuple[SlipEndState, float]:
    """Return the state where xi has ended, by one step at the present rates, and an error estimate.

    In natural units, of the time and of the velocities.
    """
    along = inner(rates.xi, state.direction)
    time_left = -state.speed / along
    across = plus(rates.xi, scaled(-along, state.direction))
    end = SlipEndState(
        add(state.axis, scale(time_left, rates.axis)),
        add(state.momentum, scale(time_left, rates.momentum)),
        plus(state.velocity, scaled(time_left, rates.velocity)),
        state.direction,
        0.0,
        state.time + time_left,
    )
    return end, time_left * size(across) * max(1.0, -1.0 / along)
