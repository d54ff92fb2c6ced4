"""Impacts under a friction law, and how one is integrated."""

# translate module: numbers

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

from tippetop.mechanics.contacts.slip_variables import scaled
from tippetop.mechanics.contacts.wrench import Slip
from tippetop.mechanics.impacts.struck_body import (
    FUZZ,
    NO_IMPULSE,
    NORMAL,
    Goal,
    Impulse,
    StruckBody,
    first_reach,
)
from tippetop.mechanics.roots import crossing
from tippetop.mechanics.runge_kutta import (
    POWER,
    RungeKuttaStep,
    moved,
    short_step,
    step_from,
    step_to,
)
from tippetop.mechanics.state import State
from tippetop.mechanics.unsolved import Unsolved

LONGEST = 5.0
"""Step at most, in the time in which slip falls by a factor of e: so many times it are still
stable.
"""

TOLERANCE = 1e-9
"""Error of the slip in a step of the integration, relative to the slip."""

STUCK = 1e-8
"""How near the traction must be to the one that holds the slip constant to count as equal to it."""

SHORTEST = 1e-12
"""Step, relative to the longest, that is taken whatever its error: at a jump of the law."""

NEWTON, SHORT, STRAIGHT = 4, 2e-3, 1e-8
"""Improvements of the end of an impact, and how near to it, in parts of its last step, the way is
short, and straight.
"""

MOST = 20_000
"""Steps after which an impact is given up, within seconds; most take some ten, on small patches
thousands.
"""


@dataclass(frozen=True)
class ImpactProcess(ABC):
    """An impact under some law of friction: what may be asked of any, however its impulses are
    found.
    """

    body: StruckBody
    """The body at the start of the impact."""

    @property
    def begin(self) -> Impulse:
        """The impulse at the start."""
        return NO_IMPULSE

    @property
    def is_struck(self) -> bool:
        """Whether the contact point sinks into the table, or would, if the impact did not begin."""
        before = self.body.before
        if before[2] != 0.0:
            return bool(before[2] < 0.0)
        return self.body.approach(self.settled(self.begin).friction(before)) < 0.0

    def normal(self, here: Impulse) -> float:
        """Normal impulse of what strikes, N s."""
        return here[NORMAL]

    def after(self, here: Impulse) -> State:
        """The state after an impulse."""
        return self.body.after(here)

    def settled(self, here: Impulse) -> Self:
        """The impact from an impulse on: as it is, or with what changes there."""
        return self

    def friction(self, velocity: Slip) -> Slip:
        """Force and torque per unit normal impulse at these velocities, six numbers."""
        return self.body.friction(velocity)

    @abstractmethod
    def until(self, here: Impulse, goal: Goal, guess: float) -> tuple[Impulse, int]:
        """The first impulse from a given one on at which the goal is not negative, and the steps to
        there.

        The guess, positive, is how much the normal impulse may have to grow.

        Raises
        ------
        ArithmeticError
            If it takes too many steps.
        """


@dataclass(frozen=True)
class SteppedProcess(ImpactProcess):
    """An impact of one contact under a law that says the friction at any slip, with slip as the
    clock.

    A law that is steep at small slip makes the equations stiff in p, as slip then changes fast.
    They are integrated over s instead, dp = ds / (|f|/|v| + 1/v_0) with v_0 the initial speed of
    the contact point: slip then decays at the rate of M however steep the law, and needs no more
    than some tens of units of s to fall by twenty orders of magnitude. Once friction has come to
    hold the slip constant, f = -M_tt^-1 M_tn (less what a torque does), it stays so, and the rest
    is a straight line; it is checked that the law agrees.
    """

    @property
    def speed(self) -> float:
        """What errors of velocities are measured by, m/s."""
        return self.body.striking

    @property
    def longest(self) -> float:
        """Longest step of the clock, and a tenth of it is the first."""
        return 2.0 * LONGEST / float(self.body.response[0][0] + self.body.response[1][1])

    def ends(self, goal: Goal) -> list[Goal]:
        """What a step may reach, the goal first; the impact goes on, as it is settled then, from
        others.
        """
        return [goal]

    def pace(self, velocity: Slip, unit: Slip) -> float:
        """Rate of the clock with the normal impulse, of what slips, for force and torque that go
        with it.
        """
        slip, grip = math.hypot(velocity[0], velocity[1]), math.hypot(unit[0], unit[1])
        if slip == 0.0:
            slip = 1e-12 * self.speed
            grip = math.hypot(*self.friction((slip, 0.0, *velocity[2:]))[:2])
        return grip / slip

    def slope(self, here: Impulse) -> Impulse:
        """Rate of the impulse, and of its normal work, with the clock."""
        velocity = self.body.velocities(here)
        unit = self.friction(velocity)
        return scaled(1.0 / (self.pace(velocity, unit) + 1.0 / self.speed), (*unit, velocity[2]))

    def wrong(self, taken: RungeKuttaStep, off: Slip) -> float:
        """What an error in the six velocities counts as, that is one of a step."""
        velocities = [self.body.velocities(end) for end in (taken.here, taken.there)]
        return slip_error(velocities, off, self.speed)

    def straight(
        self, here: Impulse, goal: Goal, guess: float, taken: int
    ) -> tuple[Impulse, bool] | None:
        """Where a straight line leads after some steps, and whether to the goal; None if there is
        none.

        There is where friction holds the slip constant, if it does so all along.
        """
        body, velocity = self.body, self.body.velocities(here)
        unit = self.friction(velocity)
        (a, b, *_), (_, d, *_), *_ = body.response
        x, y, *_ = body.change((0.0, 0.0, *unit[2:]))
        holding = ((b * y - d * x) / (a * d - b * b), (b * x - a * y) / (a * d - b * b))
        fuzz = FUZZ * body.striking * math.hypot(*unit[:2]) / (math.hypot(*velocity[:2]) or 1.0)
        if math.dist(unit[:2], holding) > STUCK + fuzz:
            return None
        if not any(unit[:2]):
            # What is held without friction needs none, but for rounding.
            holding = (0.0, 0.0)
        end = first_reach(body.straight(here, (*holding, *unit[2:])), goal, guess)
        later = self.friction(body.velocities(end))
        return (end, True) if math.dist(later, unit) <= 2.0 * (STUCK + fuzz) else None

    def until(self, here: Impulse, goal: Goal, guess: float) -> tuple[Impulse, int]:
        """Step by step."""
        longest, waiting = self.longest, goal(here) >= 0.0
        step, now = 0.1 * longest, self.settled(here)
        slope = now.slope(here)
        for taken in range(MOST):
            line = now.straight(here, goal, guess, taken)
            if line is not None:
                here, ends_there = line
                if ends_there:
                    return here, taken
                now, waiting = now.settled(here), False
                slope = now.slope(here)
                continue
            taking, ends = step_from(here, slope, step, now.slope), now.ends(goal)
            doubt, reached = doubt_of(now, taking), max(end(taking.there) for end in ends) >= 0.0
            if (doubt > 1.0 and step > SHORTEST * longest) or (reached and waiting):
                step *= min(0.5, max(0.1, 0.9 * doubt**POWER))
                continue
            here = landing(now, taking, ends) if reached else taking.there
            if reached and goal(here) >= max(end(here) for end in ends):
                return here, taken + 1
            then, waiting = now.settled(here), False
            slope = then.slope(here) if reached or then is not now else taking.new_slope
            now, step = then, min(longest, step * min(5.0, 0.9 * max(doubt, 1e-10) ** POWER))
        raise Unsolved("an impact does not come to its end")


def slip_error(ends: Sequence[Slip], off: Slip, speed: float) -> float:
    """An error in velocities, known at a step's ends: of slip beside it, and of the normal one by a
    speed.
    """
    slip = max(1e-9 * speed, *[math.hypot(*end[:2]) for end in ends])
    return float(max(math.hypot(*off[:2]) / slip, abs(off[2]) / speed))


def doubt_of(now: SteppedProcess, taken: RungeKuttaStep) -> float:
    """The error of a step over the one allowed."""
    return taken.doubt(lambda error: now.wrong(taken, now.body.change(error))) / TOLERANCE


def landing(now: SteppedProcess, taking: RungeKuttaStep, ends: list[Goal]) -> Impulse:
    """The impulse within a step at which one of some goals is reached.

    The cubic through its ends tells about where. From there on it is Newton's method, as a goal is
    linear in the impulse, or the least or largest of some that are.
    """

    def missing(point: Impulse) -> float:
        return max(end(point) for end in ends)

    def along(size: float) -> Impulse:
        return step_to(taking.here, taking.slopes[0], size, now.slope)

    last = taking.size
    here = along(last * crossing(lambda part: missing(taking.between(part)), 0.0, 1.0))
    for _ in range(NEWTON):
        slope, left, nudge = now.slope(here), missing(here), 1e-3 * taking.size
        rate = (missing(moved(here, nudge, slope)) - left) / nudge
        more = -left / rate if rate > 0.0 else taking.size
        if abs(more) < STRAIGHT * taking.size:
            return moved(here, more, slope)
        if abs(more) > 0.1 * last:
            break
        short = abs(more) < SHORT * taking.size
        last, here = abs(more), (short_step if short else step_to)(here, slope, more, now.slope)
    return along(crossing(lambda size: missing(along(size)), 0.0, taking.size))
