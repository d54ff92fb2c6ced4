"""An impact under any friction law, integrated."""

import math
from typing import NamedTuple, Self

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
from tippetop.mechanics.straight_impact import straight
from tippetop.mechanics.vectors import add, length, scale

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

    def until(self, impulse: Impulse, goal: Goal, guess: float) -> Impulse:
        """The first impulse from a given one on at which the goal is not negative.

        Raises
        ------
        ArithmeticError
            If it takes too many steps.
        """
        now, waiting = self.settled(impulse), goal(impulse) >= 0.0
        here, slope = pack(impulse), now.slope(pack(impulse))
        longest = 2.0 * LONGEST / (self.body.inverse_mass[0][0] + self.body.inverse_mass[1][1])
        step = 0.1 * longest
        for taken in range(MOST):
            held = now.held(unpack(here), goal, guess)
            if held is not None:
                return held._replace(steps=taken)
            if now.dry is not None and taken % LOOK == 0:
                ended = straight(now.dry, unpack(here), goal, guess)
                if ended is not None:
                    if goal(ended) >= 0.0:
                        return ended._replace(steps=taken)
                    here, waiting = pack(ended), False
                    now = now.settled(ended)
                    slope = now.slope(here)
                    continue
            taking = step_from(here, slope, step, now.slope)
            doubt = now.doubt(taking)
            reached = goal(unpack(taking.there)) >= 0.0
            if (doubt > 1.0 and step > SHORTEST * longest) or (reached and waiting):
                step *= min(0.5, max(0.1, 0.9 * doubt**POWER))
                continue
            if reached:
                return unpack(now.landing(taking, goal))._replace(steps=taken + 1)
            here, slope, waiting = taking.there, taking.new_slope, False
            if now.dry is not None:
                now = now.settled(unpack(here))
                slope = now.slope(here)
            step = min(longest, step * min(5.0, 0.9 * max(doubt, 1e-10) ** POWER))
        raise ArithmeticError("an impact does not come to its end")

    def settled(self, impulse: Impulse) -> Self:
        """The process from an impulse on, where a dry contact does what it does there."""
        return self if self.dry is None else self._replace(dry=self.dry.settled(impulse))

    def landing(self, taking: RungeKuttaStep, goal: Goal) -> Point:
        """The numbers within a step at which the goal is reached.

        The cubic through its ends tells about where. From there on it is Newton's method, as a goal is linear
        in the numbers, or the least or largest of some that are.
        """

        def missing(point: Point) -> float:
            return goal(unpack(point))

        def along(size: float) -> Point:
            return step_to(taking.here, taking.slopes[0], size, self.slope)

        last = taking.size
        here = along(last * crossing(lambda part: missing(taking.between(part)), 0.0, 1.0))
        for _ in range(NEWTON):
            slope, left, nudge = self.slope(here), missing(here), 1e-3 * taking.size
            rate = (missing(moved(here, nudge, slope)) - left) / nudge
            more = -left / rate if rate > 0.0 else taking.size
            if abs(more) < STRAIGHT * taking.size:
                return moved(here, more, slope)
            if abs(more) > 0.1 * last:
                break
            short = abs(more) < SHORT * taking.size
            last, here = abs(more), (short_step if short else step_to)(here, slope, more, self.slope)
        return along(crossing(lambda size: missing(along(size)), 0.0, taking.size))

    def slope(self, here: Point) -> Point:
        """Rate of the impulse's numbers with the clock s."""
        if self.dry is not None:
            return self.dry.rates(unpack(here))
        point, omega, (force, torque) = self.body.friction(unpack(here))
        slip, grip = math.hypot(point[0], point[1]), math.hypot(*force)
        if slip == 0.0:
            slip = 1e-12 * length(self.body.point)
            grip = math.hypot(*self.body.top.friction.traction((slip, 0.0), omega).force)
        pace = 1.0 / (grip / slip + 1.0 / length(self.body.point))
        return (pace, pace * force[0], pace * force[1], *scale(pace, torque), pace * point[2])

    def doubt(self, taken: RungeKuttaStep) -> float:
        """The error of a step over the one allowed."""
        here, there, speed = unpack(taken.here), unpack(taken.there), length(self.body.point)
        slip = max(self.slip(taken.here), self.slip(taken.there), 1e-9 * speed)

        def measure(error: Point) -> float:
            off = unpack(error)
            wrong = self.body.response(off)
            if self.dry is not None:
                return float(max(self.dry.doubt(here, there, off), abs(wrong[2]) / speed))
            return float(max(math.hypot(wrong[0], wrong[1]) / slip, abs(wrong[2]) / speed))

        return taken.doubt(measure) / TOLERANCE

    def slip(self, here: Point) -> float:
        """Slip speed, m/s."""
        change = self.body.response(unpack(here))
        return math.hypot(self.body.point[0] + change[0], self.body.point[1] + change[1])

    def held(self, impulse: Impulse, goal: Goal, guess: float) -> Impulse | None:
        """The rest if friction holds the slip constant, if it does so all along."""
        if self.dry is not None:
            return None
        (a, b, _), (_, d, _), _ = self.body.inverse_mass
        point, _, traction = self.body.friction(impulse)
        x, y, _ = self.body.response(Impulse(1.0, (0.0, 0.0), traction.torque, 0.0))
        holding = ((b * y - d * x) / (a * d - b * b), (b * x - a * y) / (a * d - b * b))
        fuzz = FUZZ * length(self.body.point) * math.hypot(*traction.force) / (math.hypot(*point[:2]) or 1.0)
        if math.dist(traction.force, holding) > STUCK + fuzz:
            return None
        if not any(traction.force):
            # What is held without friction needs none, but for rounding.
            holding = (0.0, 0.0)
        rise = self.body.approach(Impulse(1.0, holding, traction.torque, 0.0)) - self.body.point[2]

        def along(q: float) -> Impulse:
            return Impulse(
                impulse.normal + q,
                (impulse.tangential[0] + q * holding[0], impulse.tangential[1] + q * holding[1]),
                add(impulse.angular, scale(q, traction.torque)),
                impulse.normal_work + q * (point[2] + 0.5 * q * rise),
            )

        end = first_reach(along, goal, guess)
        later = self.body.friction(end)[2]
        drift = math.dist((*later.force, *later.torque), (*traction.force, *traction.torque))
        return end if drift <= 2.0 * (STUCK + fuzz) else None


def pack(impulse: Impulse) -> Point:
    """The numbers of an impulse in a row."""
    return (impulse.normal, *impulse.tangential, *impulse.angular, impulse.normal_work)


def unpack(y: Point) -> Impulse:
    """The impulse that has these numbers."""
    return Impulse(y[0], (y[1], y[2]), (y[3], y[4], y[5]), y[6])
