"""Time to the end of a launch under weak viscous friction, in plain numbers.

`tippetop.theory.averaging` computes the same slow flow as a function of time. This module
integrates it by steps of Dormand and Prince's method up to the first instant near its end.
"""

import math
from typing import NamedTuple

from tippetop.mechanics.laws.friction import ViscousLaw
from tippetop.mechanics.roots import crossing
from tippetop.mechanics.runge_kutta import POWER, Point, RungeKuttaStep, step_from, step_to
from tippetop.mechanics.surfaces.hull import Hull
from tippetop.mechanics.top import natural_units
from tippetop.mechanics.view import Angles
from tippetop.problem.problem import Problem, top_of
from tippetop.theory.dissipation import least_reaction
from tippetop.theory.nutation import Numbers, numbers_of, orbit_of_amplitudes
from tippetop.theory.nutation_decay import (
    FAR_FROM_POLE,
    LEAST_AMPLITUDE,
    Nutation,
    amplitudes_of,
    nutation_of_angles,
    rates_at,
)
from tippetop.theory.steady import jellett_of_launch

LOG_TOLERANCE = 1e-6
"""Error of the logarithms of the amplitudes per step: the time is shown with two digits."""

MOST_STEPS = 200
MOST_STAGES = 20
PARTS = 16
"""Instants of a step at which it is checked whether the end is near."""


class SlowPath(NamedTuple):
    """Part of the slow flow about one pole, and the tilt that it leads to."""

    jellett: float
    """Jellett's integral, in natural units."""
    numbers: Numbers
    """Numbers of the top, with alpha for that pole."""
    turned: bool
    """Whether the pole is theta = pi."""
    goal: float
    """Tilt of the end, rad."""
    distance: float
    """Distance from the end within which the time is counted, rad."""

    def rates(self, point: Point) -> Point:
        """Return the rates of a `Nutation.point` over mu t."""
        return rates_at(point, self.jellett, self.numbers)

    def beyond(self, point: Point) -> float:
        """Return how far, beyond `distance`, the end is outside the tilts of a nutation, rad."""
        fast, slow = math.exp(0.5 * point[0]), math.exp(0.5 * point[1])
        low = 2.0 * math.asin(min(abs(fast - slow), 1.0))
        high = 2.0 * math.asin(min(fast + slow, 1.0))
        goal = math.pi - self.goal if self.turned else self.goal
        return max(low - goal, goal - high) - self.distance


def time_to_end(problem: Problem, goal: float, distance: float) -> float:
    """Return the approximate time, s, at which the tilt of a launch first comes near its end.

    It is the limit for weak friction, and a few per cent off if friction turns the top over within
    a few precessions. `goal` is the tilt of the end and `distance` the distance from it that counts
    as near, both in rad. The time is nan for bodies that are no eccentric spheres, friction that is
    not viscous, launches exactly upright or inverted, launches above the table, and flows for which
    the table would have to pull.
    """
    launch, top = problem.launch, top_of(problem)
    law, surface = top.friction, top.surface
    if not isinstance(law, ViscousLaw) or isinstance(surface, Hull) or not surface.spherical:
        return math.nan
    numbers = numbers_of(top)
    vertical = launch.tilt in (0.0, math.pi) and launch.tilt_rate == 0.0
    if vertical or launch.gap > 0.0 or numbers.alpha == 0.0 or not top.torque_free:
        return math.nan
    units = natural_units(top)
    time = float(units.time)
    angles = Angles(
        launch.tilt,
        launch.tilt_rate * time,
        0.0,
        launch.precession * time,
        launch.spin * time,
        (0.0, 0.0),
    )
    jellett = jellett_of_launch(problem) / float(units.jellett)
    nutation, passed = nutation_of_angles(angles, numbers), 0.0
    for _ in range(MOST_STAGES):
        seen_numbers = numbers.turned if nutation.turned else numbers
        path = SlowPath(jellett, seen_numbers, nutation.turned, goal, distance)
        elapsed, end = _follow(path, nutation, problem.contact.liftoff != "ignore")
        passed += elapsed
        if end is None:
            return passed / (float(top.gravity) * float(law.mu))
        nutation = end.turn(numbers)
    return math.nan


def _follow(path: SlowPath, begin: Nutation, unilateral: bool) -> tuple[float, Nutation | None]:
    """Return mu t, in natural units, and None if the end is near then, or the nutation at that time
    if the other pole is nearer.

    mu t is nan, with None, if the flow cannot be followed.
    """
    point, passed = begin.point, 0.0
    if path.beyond(point) <= 0.0:
        return 0.0, None
    slope = path.rates(point)
    fastest = max(abs(slope[0]), abs(slope[1]), abs(slope[2]))
    size = 1.0 / fastest if fastest > 0.0 else 1.0
    for _ in range(MOST_STEPS):
        step = step_from(point, slope, size, path.rates)
        error = step.error_estimate(largest) / LOG_TOLERANCE
        if not (all(math.isfinite(value) for value in step.end) and error <= 1.0):
            size *= 0.5 if not error > 1.0 else max(0.2, 0.9 * error**POWER)
            continue
        near = _first_near(path, step)
        if math.isfinite(near):
            return passed + near * size, None
        point, slope, passed = step.end, step.new_slope, passed + size
        size *= min(5.0, 0.9 * error**POWER) if error > 0.0 else 5.0
        seen = orbit_of_amplitudes(amplitudes_of(point), point[2], path.jellett, path.numbers)
        if unilateral and least_reaction(seen, path.numbers) < 0.0:
            return math.nan, None
        if seen.middle > FAR_FROM_POLE:
            share = min(0.0, -abs(point[0] - point[1]) - math.log(LEAST_AMPLITUDE))
            return passed, Nutation(seen, path.turned, log_share=share)
    return math.nan, None


def largest(point: Point) -> float:
    """Return the largest absolute value."""
    return max(abs(point[0]), abs(point[1]), abs(point[2]))


def _first_near(path: SlowPath, step: RungeKuttaStep) -> float:
    """Return the first fraction of a step at which the end is near; nan if there is none.

    Where both amplitudes are equal the nutation passes the pole for an instant.
    """

    def at(part: float) -> Point:
        return step_to(step.start, step.slopes[0], part * step.size, path.rates)

    def beyond(part: float) -> float:
        return path.beyond(at(part))

    def amplitude_difference(part: float) -> float:
        point = at(part)
        return point[0] - point[1]

    before, difference = 0.0, step.start[0] - step.start[1]
    for count in range(1, PARTS + 1):
        after = count / PARTS
        point = step.between(after)
        instants = [after]
        passes = (point[0] - point[1]) * difference < 0.0
        if passes and amplitude_difference(before) * amplitude_difference(after) < 0.0:
            instants = [crossing(amplitude_difference, before, after), after]
        for instant in instants:
            if path.beyond(step.between(instant)) <= 0.0 and beyond(instant) <= 0.0:
                # The cubic was not near between the instant before and this one.
                return crossing(beyond, 0.0 if beyond(before) <= 0.0 else before, instant)
        before, difference = after, point[0] - point[1]
    return math.nan
