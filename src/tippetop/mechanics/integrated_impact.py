"""An impact under any friction law, integrated."""

import math
from typing import NamedTuple, Protocol, Self

from tippetop.mechanics.dry_impact import DryContact
from tippetop.mechanics.impulse import FUZZ, Goal, Impulse, Striking, first_reach
from tippetop.mechanics.roots import crossing
from tippetop.mechanics.runge_kutta import (
    POWER,
    Point,
    RungeKuttaStep,
    moved,
    short_step,
    step_from,
    step_to,
)
from tippetop.mechanics.stick_slip import scaled
from tippetop.mechanics.straight_impact import straight
from tippetop.mechanics.unsolved import Unsolved

LONGEST = 5.0
"""Step at most, in the time in which slip falls by a factor of e: so many times it are still stable."""

TOLERANCE = 1e-9
"""Error of the slip in a step of the integration, relative to the slip."""

STUCK = 1e-8
"""How near the traction must be to the one that holds the slip constant to count as equal to it."""

SHORTEST = 1e-12
"""Step, relative to the longest, that is taken whatever its error: at a jump of the law."""

NEWTON, SHORT, STRAIGHT = 4, 2e-3, 1e-8
"""Improvements of the end of an impact, and how near to it, in parts of its last step, the way is short, and
straight."""

MOST = 20_000
"""Steps after which an impact is given up, within seconds; most take some ten, on small patches thousands."""

LOOK = 4
"""After how many steps each it is looked whether slip has come to a direction that it keeps."""


class Clocked(Protocol):
    """An impact in a clock of its own: the numbers that it changes, impulses and work, and their rates."""

    @property
    def longest(self) -> float:
        """Longest step of the clock, and a tenth of it is the first."""

    def settled(self, here: Point) -> Self:
        """The impact from some numbers on: as it is, or with what changes there."""

    def ends(self, goal: Goal) -> list[Goal]:
        """What a step may reach, the goal first; the impact goes on, as it is settled then, from others."""

    def slope(self, here: Point) -> Point:
        """Rate of the numbers with the clock."""

    def doubt(self, taken: RungeKuttaStep) -> float:
        """The error of a step over the one allowed."""

    def straight(self, here: Point, goal: Goal, guess: float, taken: int) -> tuple[Point, bool] | None:
        """Where a straight line leads, and whether to the goal; None if it is none from here on."""


def integrated(now: Clocked, here: Point, goal: Goal, guess: float) -> tuple[Point, int]:
    """The first numbers of an impact, from given ones on, at which a goal is reached, and the steps to there.

    The guess, positive, is how much the normal impulse may have to grow.

    Raises
    ------
    ArithmeticError
        If it takes too many steps.
    """
    longest, waiting = now.longest, goal(here) >= 0.0
    step, now = 0.1 * longest, now.settled(here)
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
        doubt, reached = now.doubt(taking), max(end(taking.there) for end in ends) >= 0.0
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


def landing(now: Clocked, taking: RungeKuttaStep, ends: list[Goal]) -> Point:
    """The numbers within a step at which one of some goals is reached.

    The cubic through its ends tells about where. From there on it is Newton's method, as a goal is linear in
    the numbers, or the least or largest of some that are.
    """

    def missing(point: Point) -> float:
        return max(end(point) for end in ends)

    def along(size: float) -> Point:
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


class IntegratedProcess(NamedTuple):
    """An impact under any friction law, integrated with slip as the clock.

    A law that is steep at small slip makes the equations stiff in p, as slip then changes fast. They are
    integrated over s instead, dp = ds / (|f|/|v| + 1/v_0) with v_0 the initial speed of the contact point:
    slip then decays at the rate of M however steep the law, and needs no more than some tens of units of s
    to fall by twenty orders of magnitude. Once friction has come to hold the slip constant, f = -M_tt^-1
    M_tn (less what a torque does), it stays so, and the rest is a straight line; it is checked
    that the law agrees. Dry friction has its own clock and its own rest: see `dry_impact`.
    """

    body: Striking
    dry: DryContact | None = None

    def until(self, impulse: Impulse, goal: Goal, guess: float) -> tuple[Impulse, int]:
        """The first impulse from a given one on at which the goal is not negative, and the steps to there."""
        return integrated(self, impulse, goal, guess)

    @property
    def longest(self) -> float:
        """Longest step of the clock."""
        return 2.0 * LONGEST / float(self.body.response[0][0] + self.body.response[1][1])

    def settled(self, here: Impulse) -> Self:
        """The process from an impulse on, where a dry contact does what it does there."""
        dry = None if self.dry is None else self.dry.settled(here)
        return self if dry is self.dry else self._replace(dry=dry)

    def ends(self, goal: Goal) -> list[Goal]:
        """The goal alone."""
        return [goal]

    def straight(self, here: Impulse, goal: Goal, guess: float, taken: int) -> tuple[Impulse, bool] | None:
        """The rest where friction holds slip, or its direction."""
        if self.dry is None:
            return self.held(here, goal, guess)
        return straight(self.dry, here, goal, guess) if taken % LOOK == 0 else None

    def slope(self, here: Impulse) -> Impulse:
        """Rate of the impulse with the clock s."""
        if self.dry is not None:
            return self.dry.rates(here)
        velocity, speed = self.body.velocities(here), self.body.striking
        unit = self.body.friction(velocity)
        slip, grip = math.hypot(velocity[0], velocity[1]), math.hypot(unit[0], unit[1])
        if slip == 0.0:
            slip = 1e-12 * speed
            grip = math.hypot(*self.body.friction((slip, 0.0, *velocity[2:]))[:2])
        return scaled(1.0 / (grip / slip + 1.0 / speed), (*unit, velocity[2]))

    def doubt(self, taken: RungeKuttaStep) -> float:
        """The error of a step over the one allowed."""
        here, there = self.body.velocities(taken.here), self.body.velocities(taken.there)
        speed = self.body.striking
        slip = max(math.hypot(*here[:2]), math.hypot(*there[:2]), 1e-9 * speed)

        def measure(error: Impulse) -> float:
            off = self.body.change(error)
            wrong = math.hypot(*off[:2]) / slip if self.dry is None else self.dry.doubt(here, there, off)
            return float(max(wrong, abs(off[2]) / speed))

        return taken.doubt(measure) / TOLERANCE

    def held(self, impulse: Impulse, goal: Goal, guess: float) -> tuple[Impulse, bool] | None:
        """The rest if friction holds the slip constant, if it does so all along."""
        body, velocity = self.body, self.body.velocities(impulse)
        unit = body.friction(velocity)
        (a, b, *_), (_, d, *_), *_ = body.response
        x, y, *_ = body.change((0.0, 0.0, *unit[2:]))
        holding = ((b * y - d * x) / (a * d - b * b), (b * x - a * y) / (a * d - b * b))
        fuzz = FUZZ * body.striking * math.hypot(*unit[:2]) / (math.hypot(*velocity[:2]) or 1.0)
        if math.dist(unit[:2], holding) > STUCK + fuzz:
            return None
        if not any(unit[:2]):
            # What is held without friction needs none, but for rounding.
            holding = (0.0, 0.0)
        end = first_reach(body.straight(impulse, (*holding, *unit[2:])), goal, guess)
        later = body.friction(body.velocities(end))
        return (end, True) if math.dist(later, unit) <= 2.0 * (STUCK + fuzz) else None
