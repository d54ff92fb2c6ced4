"""An impact under any friction law, integrated."""

import math
from collections.abc import Sequence
from operator import mul
from typing import NamedTuple, TypeAlias

from tippetop.mechanics.dry_impact import DryContact
from tippetop.mechanics.impulse import FUZZ, Goal, Impulse, Striking, first_reach
from tippetop.mechanics.roots import crossing
from tippetop.mechanics.vectors import add, length, scale

TOLERANCE = 1e-9
"""Error of the slip in a step of the integration, relative to the slip."""

STUCK = 1e-8
"""How near the traction must be to the one that holds the slip constant to count as equal to it."""

SHORTEST = 1e-12
"""Step, relative to the longest, that is taken whatever its error: at a jump of the law."""

MOST = 100_000
"""Steps after which an impact is given up; most take some hundred, the longest that came to an end 57,000."""

Point: TypeAlias = tuple[float, ...]
"""The numbers of an impulse in a row: p, impulse of friction, impulse of torque, normal work."""

NODES: tuple[tuple[float, ...], ...] = (
    (1 / 5,),
    (3 / 40, 9 / 40),
    (44 / 45, -56 / 15, 32 / 9),
    (19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729),
    (9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656),
    (35 / 384, 0.0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84),
)
"""Weights of the stages of Dormand and Prince's method of order 5 (1980)."""

DOUBT = (71 / 57600, 0.0, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40)
"""Weights of the stages in the error of a step of that method."""


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
        if self.dry is not None:
            self = self._replace(dry=self.dry.settled(impulse))  # noqa: PLW0642
        waiting = goal(impulse) >= 0.0
        here, slope = pack(impulse), self.slope(pack(impulse))
        longest = 2.0 / (self.body.inverse_mass[0][0] + self.body.inverse_mass[1][1])
        step = 0.05 * longest
        for taken in range(MOST):
            held = self.held(unpack(here), goal, guess)
            if held is not None:
                return held._replace(steps=taken)
            there, new_slope, doubt = self.step(here, slope, step)
            reached = goal(unpack(there)) >= 0.0
            if (doubt > 1.0 and step > SHORTEST * longest) or (reached and waiting):
                step *= min(0.5, max(0.1, 0.9 * doubt**-0.2))
                continue
            if reached:
                return self.landing(here, slope, step, goal)._replace(steps=taken + 1)
            here, slope, waiting = there, new_slope, False
            if self.dry is not None:
                self = self._replace(dry=self.dry.settled(unpack(here)))  # noqa: PLW0642
                slope = self.slope(here)
            step = min(longest, step * min(5.0, 0.9 * max(doubt, 1e-10) ** -0.2))
        raise ArithmeticError("an impact does not come to its end")

    def landing(self, here: Point, slope: Point, step: float, goal: Goal) -> Impulse:
        """The impulse within a step at which the goal is reached."""

        def along(part: float) -> Impulse:
            return unpack(self.step(here, slope, part)[0])

        return along(crossing(lambda part: goal(along(part)), 0.0, step))

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

    def step(self, here: Point, slope: Point, step: float) -> tuple[Point, Point, float]:
        """The numbers and rates after a step, and the error of the step over the one allowed."""
        slopes = [slope]
        there = here
        for weights in NODES:
            there = combined(here, step, weights, slopes)
            slopes.append(self.slope(there))
        off = unpack(combined((0.0,) * len(here), step, DOUBT, slopes))
        error, speed = self.body.response(off), length(self.body.point)
        if self.dry is not None:
            doubt = self.dry.doubt(unpack(here), unpack(there), off)
        else:
            slip = max(self.slip(here), self.slip(there), 1e-9 * speed)
            doubt = math.hypot(error[0], error[1]) / slip
        return there, slopes[-1], max(doubt, abs(error[2]) / speed) / TOLERANCE

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


def combined(here: Point, step: float, weights: Sequence[float], slopes: Sequence[Point]) -> Point:
    """A point plus a step along a mean of slopes."""
    return tuple(
        x + step * sum(map(mul, weights, column))
        for x, column in zip(here, zip(*slopes, strict=True), strict=True)
    )


def pack(impulse: Impulse) -> Point:
    """The numbers of an impulse in a row."""
    return (impulse.normal, *impulse.tangential, *impulse.angular, impulse.normal_work)


def unpack(y: Point) -> Impulse:
    """The impulse that has these numbers."""
    return Impulse(y[0], (y[1], y[2]), (y[3], y[4], y[5]), y[6])
