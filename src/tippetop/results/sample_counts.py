"""Numbers of samples of a run: the default, and how many let it be played at any speed."""

import math

from tippetop.mechanics.vectors import length
from tippetop.problem.problem import Problem, top_of

DEFAULT_SAMPLES = 2001
"""Number of samples of a run where nobody says how many: enough for curves in figures."""

TURN_PER_SAMPLE = 0.6
"""Largest turn of the body between samples, rad: above half a turn the sense of rotation is lost,
and above 1 rad the interpolation is visible.
"""
LEAST_RATE = 100.0
"""Least number of samples per second, more than a screen shows."""
MOST_SAMPLES = 40_000
"""Largest number of samples of a run, about 4 MB."""


def sample_count(problem: Problem, duration: float) -> int:
    """Return how many samples a run of a duration, s, needs to be played at any speed.

    The body turns no faster than its angular momentum at launch over its least moment of inertia.
    """
    top, start = top_of(problem), problem.start()
    least = min(float(top.transverse_inertia), float(top.axial_inertia))
    fastest = float(length(start.momentum)) / least
    rate = max(LEAST_RATE, fastest / TURN_PER_SAMPLE)
    return math.ceil(min(duration * rate, MOST_SAMPLES - 2.0)) + 2
