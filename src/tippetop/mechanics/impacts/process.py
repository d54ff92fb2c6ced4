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
    advanced,
    short_step,
    step_from,
    step_to,
)
from tippetop.mechanics.state import State
from tippetop.mechanics.unsolved import Unsolved

LONGEST = 5.0
"""Longest step, in the impulse over which slip falls by a factor of e; longer ones are unstable."""

TOLERANCE = 1e-9
"""Error of the slip in a step of the integration, relative to the slip."""

SAME_FRICTION = 1e-8
"""Difference, relatively, up to which friction counts as what holds slip, or its direction: ten
times what steps leave out, so that they come this near. Much less is never met; more ends steps
while slip still changes.
"""

NO_VELOCITY = 1e-9
"""Velocity, in units of that with which a contact strikes, that is none: a contact opens with more,
and slip that is less has ended. It is what steps leave out of slip, `TOLERANCE`.
"""

ZERO_SLIP = 1e-12
"""Slip, per initial speed of the contact point, at which a law's friction per unit slip stands for
that at zero slip: far below slip at which a law bends, far above where its square underflows.
"""

SHORTEST = 1e-12
"""Step, relative to the longest, that is taken whatever its error: at a jump of the law."""

NEWTON_STEPS = 4
"""Improvements of the end of an impact."""

SHORT = 2e-3
"""How near to the end, in parts of the last step, a method of order 4 is exact enough."""

STRAIGHT = 1e-8
"""How near to the end, in the same unit, the impulse goes on in a straight line."""

MOST_STEPS = 20_000
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
        return self.body.approach(self.with_status(self.begin).friction(before)) < 0.0

    def normal(self, impulse: Impulse) -> float:
        """Normal impulse of what strikes, N s."""
        return impulse[NORMAL]

    def after(self, impulse: Impulse) -> State:
        """Return the state after an impulse."""
        return self.body.after(impulse)

    def with_status(self, impulse: Impulse) -> Self:
        """Return the process from an impulse on, with the status that holds from there."""
        return self

    def friction(self, velocity: Slip) -> Slip:
        """Force and torque per unit normal impulse at these velocities, six numbers."""
        return self.body.friction(velocity)

    @abstractmethod
    def until(self, impulse: Impulse, goal: Goal, guess: float) -> tuple[Impulse, int]:
        """Return the first impulse at which the goal is not negative, and the number of steps to
        it.

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
        """Longest step of the clock, kg; the first step is a tenth of it."""
        return 2.0 * LONGEST / float(self.body.response[0][0] + self.body.response[1][1])

    def ends(self, goal: Goal) -> list[Goal]:
        """Return the functions whose zeros end a step, the goal first; at others the process goes
        on.
        """
        return [goal]

    def pace(self, velocity: Slip, unit: Slip) -> float:
        """Rate of the clock with the normal impulse, of what slips, for force and torque that go
        with it.
        """
        slip, grip = math.hypot(velocity[0], velocity[1]), math.hypot(unit[0], unit[1])
        if slip == 0.0:
            slip = ZERO_SLIP * self.speed
            grip = math.hypot(*self.friction((slip, 0.0, *velocity[2:]))[:2])
        return grip / slip

    def slope(self, impulse: Impulse) -> Impulse:
        """Rate of the impulse, and of its normal work, with the clock."""
        velocity = self.body.velocities(impulse)
        unit = self.friction(velocity)
        return scaled(1.0 / (self.pace(velocity, unit) + 1.0 / self.speed), (*unit, velocity[2]))

    def error_norm(self, made: RungeKuttaStep, off: Slip) -> float:
        """Return the norm of a step's error in the six velocities."""
        velocities = [self.body.velocities(end) for end in (made.start, made.end)]
        return slip_error(velocities, off, self.speed)

    def along_line(
        self, impulse: Impulse, goal: Goal, guess: float, steps: int
    ) -> tuple[Impulse, bool] | None:
        """Return the impulse at the end of a straight line, and whether it is the goal; None if
        there is no line.

        There is where friction holds the slip constant, if it does so all along.
        """
        body, velocity = self.body, self.body.velocities(impulse)
        unit = self.friction(velocity)
        (a, b, *_), (_, d, *_), *_ = body.response
        x, y, *_ = body.change((0.0, 0.0, *unit[2:]))
        holding = ((b * y - d * x) / (a * d - b * b), (b * x - a * y) / (a * d - b * b))
        fuzz = FUZZ * body.striking * math.hypot(*unit[:2]) / (math.hypot(*velocity[:2]) or 1.0)
        if math.dist(unit[:2], holding) > SAME_FRICTION + fuzz:
            return None
        if not any(unit[:2]):
            # What is held without friction needs none, but for rounding.
            holding = (0.0, 0.0)
        end = first_reach(body.line_from(impulse, (*holding, *unit[2:])), goal, guess)
        later = self.friction(body.velocities(end))
        return (end, True) if math.dist(later, unit) <= 2.0 * (SAME_FRICTION + fuzz) else None

    def until(self, impulse: Impulse, goal: Goal, guess: float) -> tuple[Impulse, int]:
        """Step by step."""
        longest, waiting = self.longest, goal(impulse) >= 0.0
        step, now = 0.1 * longest, self.with_status(impulse)
        slope = now.slope(impulse)
        for steps in range(MOST_STEPS):
            line = now.along_line(impulse, goal, guess, steps)
            if line is not None:
                impulse, ends_there = line
                if ends_there:
                    return impulse, steps
                now, waiting = now.with_status(impulse), False
                slope = now.slope(impulse)
                continue
            taking, ends = step_from(impulse, slope, step, now.slope), now.ends(goal)
            error, reached = error_ratio(now, taking), max(end(taking.end) for end in ends) >= 0.0
            if (error > 1.0 and step > SHORTEST * longest) or (reached and waiting):
                if step <= SHORTEST * longest:
                    raise Unsolved("an impact without approach does not begin")
                step *= min(0.5, step_factor(error))
                continue
            impulse = reach(now, taking, ends) if reached else taking.end
            if reached and goal(impulse) >= max(end(impulse) for end in ends):
                return impulse, steps + 1
            later, waiting = now.with_status(impulse), False
            slope = later.slope(impulse) if reached or later is not now else taking.new_slope
            now, step = later, min(longest, step * min(5.0, step_factor(error)))
        raise Unsolved("an impact does not come to its end")


def slip_error(ends: Sequence[Slip], off: Slip, speed: float) -> float:
    """Return the norm of an error in velocities: of slip relative to slip, of the normal one to a
    speed.
    """
    slip = max(NO_VELOCITY * speed, *[math.hypot(*end[:2]) for end in ends])
    return float(max(math.hypot(*off[:2]) / slip, abs(off[2]) / speed))


def step_factor(error: float) -> float:
    """Return the ratio of the next step to one with this error over the tolerance."""
    return float(max(0.1, 0.9 * max(error, 1e-10) ** POWER))


def error_ratio(now: SteppedProcess, made: RungeKuttaStep) -> float:
    """Return the error of a step over the tolerance."""
    return (
        made.error_estimate(lambda error: now.error_norm(made, now.body.change(error))) / TOLERANCE
    )


def reach(now: SteppedProcess, taking: RungeKuttaStep, ends: list[Goal]) -> Impulse:
    """Return the impulse within a step at which one of some goals is reached.

    The cubic through its ends tells about where. From there on it is Newton's method, as a goal is
    linear in the impulse, or the least or largest of some that are.
    """

    def nearest(point: Impulse) -> float:
        """Return the largest of the goals: negative until one is reached."""
        return max(end(point) for end in ends)

    def along(size: float) -> Impulse:
        return step_to(taking.start, taking.slopes[0], size, now.slope)

    last = taking.size
    impulse = along(last * crossing(lambda part: nearest(taking.between(part)), 0.0, 1.0))
    for _ in range(NEWTON_STEPS):
        slope, value, nudge = now.slope(impulse), nearest(impulse), 1e-3 * taking.size
        rate = (nearest(advanced(impulse, nudge, slope)) - value) / nudge
        move = -value / rate if rate > 0.0 else taking.size
        if abs(move) < STRAIGHT * taking.size:
            return advanced(impulse, move, slope)
        if abs(move) > 0.1 * last:
            break
        short = abs(move) < SHORT * taking.size
        last, impulse = (
            abs(move),
            (short_step if short else step_to)(impulse, slope, move, now.slope),
        )
    return along(crossing(lambda size: nearest(along(size)), 0.0, taking.size))
