"""Dry friction in an impact: slip, sticking, drilling and rolling with the normal impulse as time.

While the normal impulse p grows, slip zeta (see `slip_variables`) changes by d zeta / dp = A(e),
which depends on its direction e alone, as the configuration is fixed. Slip that ends stays ended if
the limit surface admits the impulse that keeps it so; else it goes on along a direction with A = R
e, R > 0, which then is constant: as in contact (see `find_onset`), with unit normal impulses for
forces that weight calls for.

A direction along which A(e) = R e stays so: all impulses then grow in a straight line, until slip
has ended if R < 0. Slip comes to such a direction much faster than it ends where one component of
it responds much more to friction than another, as sliding does on a small patch, on which drilling
lasts: equations that are stiff.
"""

# translate module: numbers

import math
from dataclasses import dataclass
from typing import Self

from tippetop.mechanics.contacts.contact_point import Acceleration, ContactPoint
from tippetop.mechanics.contacts.forces import is_set_valued, slip_length, struck_wrench
from tippetop.mechanics.contacts.slip_end import SlipComponent
from tippetop.mechanics.contacts.slip_onset import resolve_onset
from tippetop.mechanics.contacts.slip_variables import (
    come_to_rest,
    inner,
    plus,
    scaled,
    size,
    slip_part,
)
from tippetop.mechanics.contacts.wrench import Slip, Wrench
from tippetop.mechanics.impacts.process import SAME_FRICTION, SteppedProcess
from tippetop.mechanics.impacts.struck_body import FUZZ, Goal, Impulse, first_reach
from tippetop.mechanics.motion import along_table
from tippetop.mechanics.runge_kutta import RungeKuttaStep
from tippetop.mechanics.state import State
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import solve

SLIDING = SlipComponent(slip=True)

NO_SLIP = 10.0 * FUZZ
"""Slip, in units of the body's speed, that is none."""

STEPS_PER_PROBE = 4
"""After so many steps each it is probed whether slip has come to a direction that it keeps."""


def is_dry(top: Top) -> bool:
    """Return whether slip or rolling can end under the law of a top."""
    return top.resists_rolling or is_set_valued(top.friction)


@dataclass(frozen=True)
class DryProcess(SteppedProcess):
    """An impact under dry friction, all floats."""

    ended: bool = False
    stopped: bool = False
    """Whether slip, and rolling, have ended."""
    direction: Slip | None = None
    rolling_direction: Slip | None = None
    """The direction in which they go on all the same; None if they are held."""

    @property
    def top(self) -> Top:
        """The body and its law of friction."""
        return self.body.contact.top

    @property
    def reach(self) -> float | None:
        """Slip length of the law; None if drilling is free."""
        return slip_length(self.top.friction)

    def parts(self, velocity: Slip) -> tuple[Slip, Slip]:
        """Slip zeta and horizontal angular velocity (times the arm's length) of six velocities,
        m/s.
        """
        return slip_part(velocity, self.reach), scaled(self.body.lever, velocity[3:5])

    def zeros(self, velocity: Slip) -> tuple[bool, bool]:
        """Return whether slip, and rolling, have ended at these velocities, if they can."""
        (slip, rolling), least = self.parts(velocity), NO_SLIP * self.body.speed
        ended = is_set_valued(self.top.friction) and size(slip) <= least
        return ended, self.top.resists_rolling and size(rolling) <= least

    def with_status(self, impulse: Impulse) -> Self:
        """Return the process with the components that have ended, and the directions in which some
        go on.
        """
        velocity = self.body.velocities(impulse)
        ended, stopped = self.zeros(velocity)
        if not (ended or stopped):
            return type(self)(self.body) if self.ended or self.stopped else self
        slip, rolling = self.parts(velocity)
        onset, _ = resolve_onset(
            self.body.contact,
            None if ended else slip,
            None if stopped else rolling,
            moved=struck_motion,
        )
        return type(self)(self.body, ended, stopped, onset.slip, onset.rolling)

    def friction(self, velocity: Slip) -> Slip:
        """Force and torque per unit normal impulse at these velocities, six numbers."""
        direction = self.direction if self.ended else slip_part(velocity, self.reach)
        wrench = struck_wrench(
            self.body.contact, direction, self.rolling_direction if self.stopped else velocity[3:5]
        )
        return (*wrench.force, *wrench.torque)

    def pace(self, velocity: Slip, unit: Slip) -> float:
        """Rate of a clock in which slip, and rolling, that end decay exponentially: traction over
        both.
        """
        reach, rate = self.reach, 0.0
        slip, rolling = size(slip_part(velocity, reach)), size(velocity[3:5])
        if not self.ended and slip > 0.0:
            rate += math.hypot(unit[0], unit[1], 0.0 if reach is None else unit[5] / reach) / slip
        if self.top.resists_rolling and not self.stopped and rolling > 0.0:
            rate += math.hypot(unit[3], unit[4]) / (self.body.lever**2 * rolling)
        return rate

    def after(self, impulse: Impulse) -> State:
        """Return the state after an impulse, in which slip and rolling that have ended are exactly
        zero.
        """
        state = self.body.after(impulse)
        still = come_to_rest(
            along_table(state), self.top, *self.zeros(self.body.velocities(impulse))
        )
        return state._replace(
            momentum=still.momentum, velocity=(*still.velocity, state.velocity[2])
        )

    def error_norm(self, made: RungeKuttaStep, off: Slip) -> float:
        """Return the norm of an error in slip and rolling, relative to them or to a millionth of
        the speed.
        """
        first, last = self.body.velocities(made.start), self.body.velocities(made.end)
        parts = zip(self.parts(first), self.parts(last), self.parts(off), strict=True)
        least = 1e-6 * self.body.speed
        ratios = [
            size(wrong) / max(size(before), size(after), least) for before, after, wrong in parts
        ]
        return float(max(*ratios, abs(off[2]) / self.speed))

    def along_line(
        self, impulse: Impulse, goal: Goal, guess: float, steps: int
    ) -> tuple[Impulse, bool] | None:
        """Return the impulse at the end of a straight line, and whether it is the goal: slip may
        end before.

        It is None if slip changes its direction, or begins, or rolling is resisted; or is not
        looked for.
        """
        if (
            steps % STEPS_PER_PROBE
            or self.top.resists_rolling
            or (self.ended and self.direction is not None)
        ):
            return None
        line = None if goal(impulse) >= 0.0 else self.line(impulse)
        if line is None:
            return None
        unit, longest = line
        along = self.body.line_from(impulse, unit)
        if longest < math.inf:
            end = along(longest)
            if goal(end) < 0.0:
                return end, False
            guess = longest
        return first_reach(along, goal, guess), True

    def line(self, impulse: Impulse) -> tuple[Slip, float] | None:
        """Force and torque per unit normal impulse on a straight line, and its length until slip
        ends.
        """
        velocity = self.body.velocities(impulse)
        slip, unit = self.parts(velocity)[0], self.friction(velocity)
        if self.ended:
            return unit, math.inf
        grip = SLIDING.resisting(
            Wrench((unit[0], unit[1], 1.0), (unit[3], unit[4], unit[5])), self.top
        )
        speed, holds = size(slip), size(grip)
        direction, change = scaled(1.0 / speed, slip), slip_part(self.body.change(unit), self.reach)
        # What changes slip so, and what changes it along itself; their ratio in the metric of
        # kinetic energy.
        doing, along = self.impulse_for(change), self.impulse_for(direction)
        inertia = inner(direction, along)
        rate = inner(direction, doing) / inertia
        # Slip has a direction, and a rate, but for rounding.
        fuzz = FUZZ * self.body.speed / speed
        if abs(rate) * inertia <= fuzz * holds:
            rate = 0.0
        wrong = plus(doing, scaled(-rate, along))
        # What grows along a wrong direction would go ever farther.
        if size(wrong) > (SAME_FRICTION if rate > 0.0 else SAME_FRICTION + fuzz) * holds:
            return None
        drilling = 0.0 if self.reach is None else self.reach * wrong[2]
        exact = plus(unit, (-wrong[0], -wrong[1], 0.0, 0.0, 0.0, -drilling))
        return exact, speed / -rate if rate < 0.0 else math.inf

    def impulse_for(self, change: Slip) -> Slip:
        """Return the impulses of force, and of drilling torque over the law's length, that change
        slip so.
        """
        held, lengths = (
            ((0, 1), (1.0, 1.0)) if self.reach is None else ((0, 1, 5), (1.0, 1.0, self.reach))
        )
        pairs, response = list(zip(held, lengths, strict=True)), self.body.response
        return tuple(
            solve([[a * response[i][j] * b for j, b in pairs] for i, a in pairs], list(change))
        )


def struck_motion(
    point: ContactPoint, slip: Slip | None, rolling: Slip | None
) -> tuple[Wrench, Acceleration]:
    """Return the impulses per unit normal impulse, and the changes of the velocities."""
    wrench = struck_wrench(point, slip, rolling)
    return wrench, point.response(wrench)
