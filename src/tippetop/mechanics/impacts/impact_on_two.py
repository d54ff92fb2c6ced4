"""An impact of one surface while another touches the table, and is pressed onto it.

With the normal impulse p of the striking contact as time (see `impact`), the other contact j has

    0 <= dp_j,    0 <= dv_nj,    dp_j dv_nj = 0    while its normal velocity v_nj is zero,

and none of its own while it is open. At both, friction follows the law along the way. What the
table does at the other contact is a force and a torque at the first, too: that of its moment about
it.
"""

# translate module: numbers

from dataclasses import dataclass, replace
from typing import Self

from tippetop.mechanics.contacts.forces import is_set_valued
from tippetop.mechanics.contacts.slip_variables import plus
from tippetop.mechanics.contacts.wrench import Slip
from tippetop.mechanics.impacts.process import (
    NO_VELOCITY,
    SAME_FRICTION,
    SteppedProcess,
    slip_error,
)
from tippetop.mechanics.impacts.struck_body import (
    NO_IMPULSE,
    NORMAL,
    Goal,
    Impulse,
    StruckBody,
    first_reach,
)
from tippetop.mechanics.motion import point_velocity
from tippetop.mechanics.runge_kutta import RungeKuttaStep
from tippetop.mechanics.vectors import Vector, add, cross, length, scale

SUNK = 1e-7
"""Normal velocity below zero at which a contact sinks, in units of that with which the other one
strikes: beyond all errors of steps.
"""

OTHER = 7
"""Place of the other contact's normal impulse."""


class SlipEndsInImpact(ArithmeticError):
    """Slip, or rolling, ends under a law that then leaves what resists it open."""


@dataclass(frozen=True)
class ProcessOnTwo(SteppedProcess):
    """Such an impact, floats: impulses are those of both contacts at what strikes, and work is its
    own.

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

    @classmethod
    def of(cls, body: StruckBody, beside: StruckBody) -> Self:
        """Return the process for the striking contact and the touching one."""
        return cls(body, add(beside.contact.arm, scale(-1.0, body.contact.arm)), beside.before)

    @property
    def begin(self) -> Impulse:
        """No impulse."""
        return (*NO_IMPULSE, 0.0)

    @property
    def speed(self) -> float:
        """Speed at which what strikes sinks, m/s; in an impact without approach that at which its
        contact point moves.
        """
        return -float(self.body.before[2]) or self.body.striking

    @property
    def is_struck(self) -> bool:
        """Whether the contact point sinks into the table, or would, with the impulse that keeps the
        other one closed.

        With the Delassus matrix A of both, friction included, contact 1 sinks without approach
        where A_11 < 0 and A_21 >= 0, which opens contact 2; where A_21 < 0, A_22 > 0 and A_11 A_22
        < A_12 A_21, which holds it; or where A_21 < 0, A_22 <= 0 and A_12 < 0: both sink.
        """
        before = float(self.body.before[2])
        if before != 0.0:
            return before < 0.0
        begin = self.begin
        return self.body.approach(self.with_status(begin).slope(begin)) < 0.0

    def normal(self, impulse: Impulse) -> float:
        """Normal impulse of what strikes, N s."""
        return impulse[NORMAL] - impulse[OTHER]

    def beside(self, change: Slip) -> Slip:
        """Change of the six velocities of the other contact, by that of what strikes: it keeps
        digits.
        """
        x, y, z, *turning = change
        turned = (turning[0], turning[1], turning[2])
        return (*point_velocity((x, y, z), turned, self.apart), *turned)

    def velocities_beside(self, impulse: Impulse) -> Slip:
        """Return the six velocities of the other contact after an impulse."""
        return plus(self.before, self.beside(self.body.change(impulse)))

    def with_status(self, impulse: Impulse) -> Self:
        """Return the process after an impulse, with the status of the other contact."""
        rise = self.velocities_beside(impulse)[2] / self.speed
        pressed, sunk = (
            bool(rise <= NO_VELOCITY),
            bool(rise < -(NO_VELOCITY if self.sunk else SUNK)),
        )
        same = pressed == self.pressed and sunk == self.sunk
        return self if same else replace(self, pressed=pressed, sunk=sunk)

    def ends(self, goal: Goal) -> list[Goal]:
        """Return the functions whose zeros end a step: the goal, and the closing of the other
        contact.
        """
        if self.pressed and not self.sunk:
            return [goal]
        sign = 1.0 if self.sunk else -1.0
        return [goal, lambda impulse: sign * self.velocities_beside(impulse)[2]]

    def slope(self, impulse: Impulse) -> Impulse:
        """Rate of the numbers in a clock in which slip that ends decays exponentially."""
        velocity, resistance = (
            self.body.velocities(impulse),
            self.body.contact.top.rolling_resistance,
        )
        rate = 1.0 / self.speed
        if resistance is not None:
            rolling = length((velocity[3], velocity[4], 0.0))
            if self.body.lever * rolling < NO_VELOCITY * self.speed:
                raise SlipEndsInImpact("rolling ends in an impact on two surfaces")
            rate += 2.0 * resistance.length / (self.body.lever**2 * rolling)
        unit, share = self.sliding(velocity), 0.0
        pace = self.pace(velocity, unit)
        if self.pressed:
            velocity_beside = self.velocities_beside(impulse)
            x, y, z, *torque = friction_beside = self.sliding(velocity_beside)
            moment = add((torque[0], torque[1], torque[2]), cross(self.apart, (x, y, z)))
            at_first = (x, y, z, *moment)
            share = self.share(unit, at_first)
            unit = tuple((1.0 - share) * a + share * b for a, b in zip(unit, at_first, strict=True))
            pace = (1.0 - share) * pace + share * self.pace(velocity_beside, friction_beside)
        work = (1.0 - share) * velocity[2]
        return tuple(number / (rate + pace) for number in (*unit, work, share))

    def share(self, unit: Slip, unit_beside: Slip) -> float:
        """Part of the normal impulses that acts at the other contact, which they keep closed.

        Where friction presses it as much as its impulse opens it (Painleve's paradox) it sinks, and
        has all of them until its slip has changed and it is back, as in an impact of its own.
        `unit` and `unit_beside` are unit impulses, with their friction, at what strikes and at the
        other one.
        """
        coupling, direct = (
            self.beside(self.body.change(wrench))[2] for wrench in (unit, unit_beside)
        )
        if self.sunk or (coupling < 0.0 and direct <= 0.0):
            return 1.0
        return -coupling / (direct - coupling) if coupling < 0.0 else 0.0

    def sliding(self, velocity: Slip) -> Slip:
        """Return the friction at a contact with these velocities; see `friction`."""
        slip = length((velocity[0], velocity[1], 0.0))
        if is_set_valued(self.body.contact.top.friction) and slip < NO_VELOCITY * self.speed:
            raise SlipEndsInImpact("slip ends in an impact on two surfaces")
        return self.friction(velocity)

    def error_norm(self, made: RungeKuttaStep, off: Slip) -> float:
        """Return the error norm, the larger of both contacts.

        A steep law may hold slip so slow that its force has no digits but those beside it.
        """
        velocities = [self.velocities_beside(end) for end in (made.start, made.end)]
        return max(
            super().error_norm(made, off), slip_error(velocities, self.beside(off), self.speed)
        )

    def along_line(
        self, impulse: Impulse, goal: Goal, guess: float, steps: int
    ) -> tuple[Impulse, bool] | None:
        """Return the end of the process if friction holds both slips constant.

        Where they change less along it than a step may err, a steep law would take many steps, and
        no other way.
        """
        if not self.pressed:
            return None
        rates = self.slope(impulse)
        if not self.normal(rates) > 0.0:
            return None
        unit = tuple(rate / self.normal(rates) for rate in rates)
        change = self.body.change(unit)
        x, y, rise, *_ = change
        moved = self.beside(change)
        if not length((x, y, 0.0)) + length((moved[0], moved[1], 0.0)) < SAME_FRICTION * rise:
            return None
        return first_reach(self.body.line_from(impulse, unit), goal, self.speed / rise), True
