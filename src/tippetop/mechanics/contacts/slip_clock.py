"""How slip, or rolling, ends: the velocities that dry friction can bring to zero, and their last
moments.

What ends is a velocity xi: the slip zeta (see `slip_variables`), or rolling, which is the
horizontal angular velocity w_t under rolling resistance; of two contacts that slip, the slip of the
first, or (v_1, zeta) where the law resists drilling (see `pair`). Away from xi = 0 the table's
wrench depends on the direction e = xi / s alone, s = |xi|: with the state y = (n, L, u), or (n, L)
where a contact sticks,

    y' = Y(y, e),        xi' = A(y, e) = R e + V,        s' = R,        s e' = V,        V.e = 0.

The state goes on as it is, and e and s ride beside it: its own xi has few digits. Where R < 0, s
reaches zero in finite time, and e turns at the rate V/s, which may grow without bound. In a clock
whose unit is the time s / |A|, nearly -ln s, it does not: de = V/|A|, dy = s Y/|A|, dt = s/|A|, ds
= s R/|A|. Nor does it where s has a least value, R = 0.
"""

from typing import NamedTuple

from tippetop.mechanics.contacts.contact_point import Acceleration, flat
from tippetop.mechanics.contacts.forces import slip_length, slip_wrenches
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
from tippetop.mechanics.contacts.wrench import COUPLES, Slip, Wrench
from tippetop.mechanics.motion import angular_velocity
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Scalar, Vector, dot

DIGITS = 1e-11
"""Error of a velocity that is not followed by itself, relative to those of which it is made."""

QUICK = 1e5
"""How many times its own velocities change in a natural unit of time where they change fast."""


class SlipComponent(NamedTuple):
    """A velocity that ends or begins."""

    slip: bool
    """Whether it is the slip; else it is rolling."""
    turns: bool = False
    """Whether the slips of two contacts both do, and so xi = (v_1, zeta) (see `pair`) as one; under
    a law that resists drilling they always do.
    """

    def recurs(self, top: Top) -> bool:
        """Return whether it may end and begin many times a second: slip under a law that does not
        resist drilling.
        """
        return self.slip and slip_length(top.friction) is None

    def count(self, top: Top) -> int:
        """Return how many components it has."""
        drills = self.turns or slip_length(top.friction) is not None
        return 3 if self.slip and drills else 2

    def of(self, axis: Vector, momentum: Vector, velocity: Slip, top: Top) -> Slip:
        """Return the velocity xi of one contact, from axis, angular momentum and horizontal
        velocity of the centre of mass.
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


class SlipEndState(NamedTuple):
    """A body one of whose velocities is about to end: the state in the clock above."""

    numbers: Slip
    """Axis n, angular momentum L, kg m^2/s, and where nothing sticks the horizontal velocity of the
    centre of mass, m/s.
    """
    direction: Slip
    """Direction e of xi, a unit vector."""
    speed: Scalar
    """Its size s, m/s or rad/s."""
    time: Scalar
    """Time, s."""

    @property
    def xi(self) -> Slip:
        """The velocity that ends."""
        return scaled(self.speed, self.direction)


class SlipEndRates(NamedTuple):
    """What follows from a state: rates of its numbers and of xi in time, and the angular velocity,
    rad/s.
    """

    numbers: Slip
    xi: Slip
    turning: Vector


def slip_end_rates(state: SlipEndState, rates: SlipEndRates) -> SlipEndState:
    """Rates in the clock of the way that xi goes, in units of s."""
    pace = inner(rates.xi, rates.xi) ** -0.5
    along, step = pace * inner(rates.xi, state.direction), pace * state.speed
    # The last part is none where e is a unit vector, and keeps it one.
    unit = 2.0 * (1.0 - inner(state.direction, state.direction)) - along
    turn = tuple([pace * a + unit * e for a, e in zip(rates.xi, state.direction, strict=True)])
    return SlipEndState(scaled(step, rates.numbers), turn, along * state.speed, step)


def reopening_guard(state: SlipEndState, rates: SlipEndRates) -> Scalar:
    """Falls through zero where xi outlasts twice the `HORIZON` of `remaining`, by more than what
    rounding of its direction in a state makes of it.

    A state has xi to `DIGITS` of a velocity U that it is made of, and so the rate R to `DIGITS` U
    |A| / s: a velocity that is not more than rounding stays in the clock until it ends or grows.
    All is in natural units, where U^2 = g size + (omega size)^2 is 1 + omega^2; the value is a
    velocity squared, as that of `remaining` is, of rolling an angular velocity squared.
    """
    rate = rates.xi
    doubt = DIGITS * (_square(rates) * inner(rate, rate)) ** 0.5
    horizon = 2.0 * HORIZON
    return horizon * doubt - remaining(state.xi, rate, horizon)


def zero_guard(state: SlipEndState, rates: SlipEndRates, horizon: Scalar) -> Scalar:
    """Falls through zero where xi, at its present rate, ends within the horizon, and is small
    by itself.

    That is s + horizon R Q / (Q + |A|), in natural units, with an acceleration Q that takes the
    body's own velocities, (1 + omega^2)^(1/2), in the time 1 / `QUICK`: where xi changes faster
    than that, there may be much of it left for so short a time.
    """
    rate, quick = rates.xi, QUICK * _square(rates) ** 0.5
    share = quick / (quick + inner(rate, rate) ** 0.5)
    return state.speed + horizon * share * inner(rate, state.direction)


def _square(rates: SlipEndRates) -> Scalar:
    """Return the square of the body's own velocities, in natural units."""
    return 1.0 + dot(rates.turning, rates.turning)


def overtaking_guard(state: SlipEndState, rate: Slip, second: Slip, second_rate: Slip) -> Scalar:
    """Falls through zero where a second velocity, at present rates, ends in half the time left to
    xi.
    """
    ahead = -2.0 * inner(second, second) * inner(rate, state.direction)
    return ahead + state.speed * inner(second, second_rate)


def landed(state: SlipEndState, rates: SlipEndRates) -> tuple[SlipEndState, float]:
    """Return the state where xi has ended, by one step at the present rates, and an error estimate.

    In natural units, of the time and of the velocities.
    """
    along = inner(rates.xi, state.direction)
    time_left = -state.speed / along
    across = plus(rates.xi, scaled(-along, state.direction))
    numbers = plus(state.numbers, scaled(time_left, rates.numbers))
    end = SlipEndState(numbers, state.direction, 0.0, state.time + time_left)
    return end, time_left * size(across) * max(1.0, -1.0 / along)
