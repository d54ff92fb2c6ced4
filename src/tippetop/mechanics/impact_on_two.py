"""An impact of one surface while another touches the table, and is pressed onto it.

With the normal impulse p of the striking contact as time (see `impact`), the other contact j has

    0 <= dp_j,    0 <= dv_nj,    dp_j dv_nj = 0    while its normal velocity v_nj is zero,

and none of its own while it is open. At both, friction follows the law along the way. What the table does at
the other contact is a force and a torque at the first, too: that of its moment about it.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Self

from tippetop.mechanics.impact_process import SteppedProcess, slip_error
from tippetop.mechanics.implicit_step import implicit_step
from tippetop.mechanics.impulse import NO_IMPULSE, NORMAL, Goal, Impulse, Striking
from tippetop.mechanics.motion import point_velocity
from tippetop.mechanics.rolling import is_set_valued
from tippetop.mechanics.runge_kutta import RungeKuttaStep
from tippetop.mechanics.stick_slip import inner, plus, scaled
from tippetop.mechanics.vectors import Vector, add, cross, length, scale
from tippetop.mechanics.wrench import Slip

OPEN = 1e-9
"""Normal velocity of a contact that is closed, and slip that has ended, in units of what strikes."""

SUNK = 1e-7
"""Normal velocity below zero at which it sinks, in the same units: beyond all errors of steps."""

HELD = 1e-3
"""Slip over friction at which a law may be steep, in the same units: its errors are measured by this."""

NUDGED = 1e-5
"""Part of that by which velocities are changed to tell derivatives."""

OTHER = 7
"""Place of the other contact's normal impulse."""


class SlipEnds(ArithmeticError):
    """Slip, or rolling, ends under a law that then leaves what resists it open."""


@dataclass(frozen=True)
class ProcessOnTwo(SteppedProcess):
    """Such an impact, floats: impulses are those of both contacts at what strikes, and work is its own.

    The other contact's normal impulse is one more of their numbers.
    """

    apart: Vector
    """From the contact point that strikes to the other one, m."""
    before: Slip
    """The six velocities of the other contact at the start."""
    pressed: bool = True
    """Whether the other contact is closed."""
    sunk: bool = False
    """Whether it sinks, as friction has jammed it."""
    held: bool = False
    """Whether friction answers steeply to slip at a closed contact."""

    @classmethod
    def of(cls, body: Striking, other: Striking) -> Self:
        """The impact of a body at what strikes, and at what touches."""
        return cls(body, add(other.contact.arm, scale(-1.0, body.contact.arm)), other.before)

    @property
    def is_smooth(self) -> bool:
        """Whether the law says the friction at any slip."""
        return not is_set_valued(self.body.contact.top.friction)

    @property
    def begin(self) -> Impulse:
        """No impulse."""
        return (*NO_IMPULSE, 0.0)

    @property
    def speed(self) -> float:
        """Speed at which what strikes sinks, m/s."""
        return -float(self.body.before[2])

    def normal(self, here: Impulse) -> float:
        """Normal impulse of what strikes, N s."""
        return here[NORMAL] - here[OTHER]

    def beside(self, change: Slip) -> Slip:
        """Change of the six velocities of the other contact, by that of what strikes: it keeps digits."""
        x, y, z, *turning = change
        turned = (turning[0], turning[1], turning[2])
        return (*point_velocity((x, y, z), turned, self.apart), *turned)

    def there(self, here: Impulse) -> Slip:
        """The six velocities of the other contact after an impulse."""
        return plus(self.before, self.beside(self.body.change(here)))

    def settled(self, here: Impulse) -> Self:
        """The impact from some impulses on, as the contacts then are."""
        there = self.there(here)
        rise = there[2] / self.speed
        pressed, sunk = bool(rise <= OPEN), bool(rise < -(OPEN if self.sunk else SUNK))
        closed = (self.body.velocities(here), there)[: 1 + pressed]
        held = self.is_smooth and bool(HELD * self.steepness(closed) * self.speed > 1.0)
        same = pressed == self.pressed and sunk == self.sunk and held == self.held
        return self if same else replace(self, pressed=pressed, sunk=sunk, held=held)

    def ends(self, goal: Goal) -> list[Goal]:
        """The goal, and that the other contact closes, or has come back."""
        if self.pressed and not self.sunk:
            return [goal]
        way = 1.0 if self.sunk else -1.0
        return [goal, lambda here: way * self.there(here)[2]]

    def slope(self, here: Impulse) -> Impulse:
        """Rate of the numbers in a clock in which slip that ends decays exponentially."""
        return self.rates(self.body.velocities(here), self.there(here))

    def rates(self, velocity: Slip, there: Slip) -> Impulse:
        """The same at these velocities; what is held slips on, and normal impulses are the clock."""
        resistance, rate = self.body.contact.top.rolling_resistance, 1.0 / self.speed
        if resistance is not None:
            rolling = length((velocity[3], velocity[4], 0.0))
            if self.body.lever * rolling < OPEN * self.speed:
                raise SlipEnds("rolling ends in an impact on two surfaces")
            rate += 2.0 * resistance.length / (self.body.lever**2 * rolling)
        unit, share = self.sliding(velocity), 0.0
        pace = self.pace(velocity, unit)
        if self.pressed:
            x, y, z, *torque = more = self.sliding(there)
            moment = add((torque[0], torque[1], torque[2]), cross(self.apart, (x, y, z)))
            at_first = (x, y, z, *moment)
            share = self.share(unit, at_first)
            unit = tuple((1.0 - share) * a + share * b for a, b in zip(unit, at_first, strict=True))
            pace = (1.0 - share) * pace + share * self.pace(there, more)
        work = (1.0 - share) * velocity[2]
        return tuple(number / (rate if self.held else rate + pace) for number in (*unit, work, share))

    def step(self, here: Impulse, slope: Impulse, size: float) -> RungeKuttaStep:
        """A step of the clock, implicit where a law may be steep: it holds one slip, and not the other."""
        if not self.held:
            return super().step(here, slope, size)
        return implicit_step(here, slope, size, self.slope, self.jacobian(here, slope))

    def jacobian(self, here: Impulse, slope: Impulse) -> list[list[float]]:
        """How the rates of the numbers change with them: a row each, by differences of velocities."""
        velocity, there, response = self.body.velocities(here), self.there(here), self.body.response
        nudge = NUDGED / self.steepness((velocity, there)[: 1 + self.pressed])
        columns = []
        for number in range(6):
            size = nudge if number < 3 else nudge / self.body.lever
            off = tuple(size if number == place else 0.0 for place in range(6))
            beside = self.beside(off)
            after = self.rates(plus(velocity, off), plus(there, beside))
            before = self.rates(plus(velocity, scaled(-1.0, off)), plus(there, scaled(-1.0, beside)))
            columns.append([(b - a) / (2.0 * size) for a, b in zip(before, after, strict=True)])
        rows, impulses = zip(*columns, strict=True), list(zip(*response, strict=True))
        return [[*[inner(row, column) for column in impulses], 0.0, 0.0] for row in rows]

    def steepness(self, closed: Sequence[Slip]) -> float:
        """Friction per unit normal impulse over slip where some velocities make that the most, s/m."""
        return max(self.pace(velocity, self.friction(velocity)) for velocity in closed)

    def share(self, unit: Slip, other: Slip) -> float:
        """Part of the normal impulses that acts at the other contact, which they keep closed.

        Where friction presses it as much as that pushes it apart (Painleve's paradox) it sinks, and has all
        of them until its slip has changed and it is back, as in an impact of its own.
        Those, with the friction that they cause, are given: `unit` at what strikes, `other` at the other one.
        """
        pushed, answer = (self.beside(self.body.change(wrench))[2] for wrench in (unit, other))
        if self.sunk or (pushed < 0.0 and answer <= 0.0):
            return 1.0
        return -pushed / (answer - pushed) if pushed < 0.0 else 0.0

    def sliding(self, velocity: Slip) -> Slip:
        """The friction at a contact with these velocities; see `friction`."""
        slip = length((velocity[0], velocity[1], 0.0))
        if not self.is_smooth and slip < OPEN * self.speed:
            raise SlipEnds("slip ends in an impact on two surfaces")
        return self.friction(velocity)

    def straight(self, here: Impulse, goal: Goal, guess: float, taken: int) -> None:
        """None: what friction holds takes few implicit steps."""
        return None  # noqa: RET501 - in JavaScript, too

    def wrong(self, taken: RungeKuttaStep, off: Slip) -> float:
        """What an error counts as: that of the contact where it is the larger."""
        least = (HELD if self.is_smooth else OPEN) * self.speed
        ends = taken.here, taken.there
        one = slip_error([self.body.velocities(end) for end in ends], off, self.speed, least)
        other = slip_error([self.there(end) for end in ends], self.beside(off), self.speed, least)
        return max(one, other)
