"""How finely a run is sampled so that it can be played at any speed."""

import math

from tippetop.mechanics.vectors import length
from tippetop.problem.problem import Problem

TURN_PER_SAMPLE = 0.6
"""Angle by which the body may turn between samples, rad: from half a turn on a player could not
tell in which sense it turned, and from 1 rad on interpolation shows.
"""
LEAST_RATE = 100.0
"""Samples per second of even the slowest run: as a screen shows it."""
MOST_SAMPLES = 40_000
"""Samples of a run at most: some 4 MB."""


def sample_count(problem: Problem, duration: float) -> int:
    """Return how many samples a run of a duration, s, needs so that it can be played at any speed.

    The body turns no faster than its angular momentum at launch over its least moment of inertia;
    spin, precession and tilt rate are all in that.
    """
    top, start = problem.top, problem.start()
    least = min(float(top.transverse_inertia), float(top.axial_inertia))
    fastest = float(length(start.momentum)) / least
    rate = max(LEAST_RATE, fastest / TURN_PER_SAMPLE)
    return math.ceil(min(duration * rate, MOST_SAMPLES - 2.0)) + 2
