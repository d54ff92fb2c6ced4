"""Least spin of launches from which runs of a top turn over and stand."""

import math
from collections.abc import Callable

from tippetop.mechanics.top import natural_units
from tippetop.problem.bodies import Body
from tippetop.problem.frictions import ContensouFriction
from tippetop.problem.launch import Launch
from tippetop.problem.problem import Problem, top_of
from tippetop.results.catalogue import NEAR_POLE
from tippetop.results.motion_state import MotionState
from tippetop.run import simulate
from tippetop.theory.advice import standing_spin

DRILLING = ContensouFriction(mu=0.3, patch_radius=5e-4)
"""Friction of runs that show whether a body stands, where nobody states another: wood on wood, with
a patch as large as a ball's of a few grams."""

LONGEST_RISE = 20.0
"""Seconds of a run within which a top must have turned over and come upright on its other end."""

FALLEN = 0.35
"""Angle from upside down, rad, beyond which a top does not stand any more: 20 degrees, more than
the nutation of a top on its stem."""

RISING = 1.15
"""Ratio of the spins that are tried one after the other until a run stands. Windows of spin in
which a top does not stand that are narrower than this may be passed over."""

FASTEST = 25.0
"""Largest spin that is tried, in natural units: 640 rad/s for a ball of 15 mm, several times what
fingers reach."""

CLOSE = 4e-3
"""Relative width of the interval to which the least spin is bisected: well below the scatter of
what fingers reach."""

LEAST = 0.01
"""Part of the first number down to which numbers are tried."""

BEYOND = (1.001, 1.003, 1.01, 1.02, 1.05, 1.1, 1.2, 1.35, 1.5)
"""Ratios to the least spin at which runs must stand as well: standing is no monotonic function of
spin, for impacts decide how a top comes onto its stem."""

USUAL = 6.0
"""Spin of the first run where theory has none, in natural units: about that of fingers."""


def drilling_launch(body: Body, spin: float = 1.0) -> Problem:
    """Return a launch of a body as the runs have it that show whether it stands."""
    return Problem(body=body, friction=DRILLING, launch=Launch(tilt=0.1, spin=spin))


def above_upside_down(state: MotionState) -> float:
    """Return a number that falls below zero where the axis comes within `NEAR_POLE` of upside down:
    an event function.
    """
    return float(state.axis[2]) + math.cos(NEAR_POLE)


def stands(problem: Problem) -> bool:
    """Return whether a run turns over and comes within `NEAR_POLE` of upside down."""
    run = simulate(problem, LONGEST_RISE, until=above_upside_down, samples=2)
    return bool(run.attrs["status"] == "stopped")


def least_standing_spin(problem: Problem) -> float:
    """Return the least spin of launches, rad/s, from which runs turn over and stand.

    Runs with more spin, up to half as much again, stand as well. The launches have the tilt and
    the friction of the problem. The result is inf if there is no such spin up to `FASTEST`.
    """
    inverse_time = 1.0 / float(natural_units(top_of(problem)).time)
    guess = standing_spin(problem.body, problem.gravity, problem.launch.tilt)
    if not math.isfinite(guess):
        guess = USUAL * inverse_time
    return least_passing(
        lambda spin: stands(problem.replace({"launch.spin": spin})), guess, FASTEST * inverse_time
    )


def least_passing(passes: Callable[[float], bool], guess: float, largest: float) -> float:
    """Return the least number from which on a test is passed, up to half as much again.

    Parameters
    ----------
    passes
        The test. It need not be monotonic: where it fails within the interval above a number that
        passes, the search goes on from there.
    guess
        Number with which to begin.
    largest
        Number beyond which no test is made; the result is inf if none up to it passes. It is 0 if
        all down to a small part of the guess pass.
    """
    low, high = 0.0, min(guess, largest)
    if passes(high):
        while passes(high / RISING):
            high /= RISING
            if high < LEAST * guess:
                return 0.0
        low = high / RISING
    else:
        low, high = high, math.inf
    while True:
        if math.isinf(high):
            high = _next_passing(passes, low, largest)
            if math.isinf(high):
                return high
            low = max(low, high / RISING)
        while high > low * (1.0 + CLOSE):
            middle = math.sqrt(low * high)
            if passes(middle):
                high = middle
            else:
                low = middle
        failing = [high * ratio for ratio in BEYOND if not passes(high * ratio)]
        if not failing:
            return high
        low, high = failing[-1], math.inf


def _next_passing(passes: Callable[[float], bool], low: float, largest: float) -> float:
    """Return the first of a geometric sequence above a number that passes; inf if none does."""
    spin = low * RISING
    while spin <= largest:
        if passes(spin):
            return spin
        spin *= RISING
    return math.inf
