"""An impact under any friction law, integrated."""

import math
from typing import NamedTuple, Self

from tippetop.mechanics.dry_impact import DryContact
from tippetop.mechanics.impulse import FUZZ, Goal, Impulse, Striking, first_reach
from tippetop.mechanics.roots import crossing
from tippetop.mechanics.runge_kutta import (
    POWER,
    RungeKuttaStep,
    moved,
    short_step,
    step_from,
    step_to,
)
from tippetop.mechanics.stick_slip import scaled
from tippetop.mechanics.straight_impact import straight

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
        """The first impulse from a given one on at which the goal is not negative, and the steps to there.

        Raises
        ------
        ArithmeticError
            If it takes too many steps.
        """
        now, here, waiting = self.settled(impulse), impulse, goal(impulse) >= 0.0
        slope = now.slope(here)
        longest = 2.0 * LONGEST / (self.body.response[0][0] + self.body.response[1][1])
        step = 0.1 * longest
        for taken in range(MOST):
            held = now.held(here, goal, guess)
            if held is not None:
                return held, taken
            if now.dry is not None and taken % LOOK == 0:
                ended = straight(now.dry, here, goal, guess)
                if ended is not None:
                    if goal(ended) >= 0.0:
                        return ended, taken
                    now, here, waiting = now.settled(ended), ended, False
                    slope = now.slope(here)
                    continue
            taking = step_from(here, slope, step, now.slope)
            doubt = now.doubt(taking)
            reached = goal(taking.there) >= 0.0
            if (doubt > 1.0 and step > SHORTEST * longest) or (reached and waiting):
                step *= min(0.5, max(0.1, 0.9 * doubt**POWER))
                continue
            if reached:
                return now.landing(taking, goal), taken + 1
            here, slope, waiting = taking.there, taking.new_slope, False
            if now.dry is not None:
                now = now.settled(here)
                slope = now.slope(here)
            step = min(longest, step * min(5.0, 0.9 * max(doubt, 1e-10) ** POWER))
        raise ArithmeticError("an impact does not come to its end")

    def settled(self, impulse: Impulse) -> Self:
        """The process from an impulse on, where a dry contact does what it does there."""
        return self if self.dry is None else self._replace(dry=self.dry.settled(impulse))

    def landing(self, taking: RungeKuttaStep, goal: Goal) -> Impulse:
        """The impulse within a step at which the goal is reached.

        The cubic through its ends tells about where. From there on it is Newton's method, as a goal is linear
        in the numbers, or the least or largest of some that are.
        """

        def along(size: float) -> Impulse:
            return step_to(taking.here, taking.slopes[0], size, self.slope)

        last = taking.size
        here = along(last * crossing(lambda part: goal(taking.between(part)), 0.0, 1.0))
        for _ in range(NEWTON):
            slope, left, nudge = self.slope(here), goal(here), 1e-3 * taking.size
            rate = (goal(moved(here, nudge, slope)) - left) / nudge
            more = -left / rate if rate > 0.0 else taking.size
            if abs(more) < STRAIGHT * taking.size:
                return moved(here, more, slope)
            if abs(more) > 0.1 * last:
                break
            short = abs(more) < SHORT * taking.size
            last, here = abs(more), (short_step if short else step_to)(here, slope, more, self.slope)
        return along(crossing(lambda size: goal(along(size)), 0.0, taking.size))

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

    def held(self, impulse: Impulse, goal: Goal, guess: float) -> Impulse | None:
        """The rest if friction holds the slip constant, if it does so all along."""
        if self.dry is not None:
            return None
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
        return end if math.dist(later, unit) <= 2.0 * (STUCK + fuzz) else None
