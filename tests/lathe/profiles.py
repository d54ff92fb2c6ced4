"""Random profiles, and their properties the slow way."""

import math
from itertools import pairwise

import numpy as np
from hypothesis import reject
from hypothesis import strategies as st

from strategies import numbers
from tippetop.lathe.profile import profile_of
from tippetop.support.errors import InvalidInput

BALL = ((0.0, -0.02), (0.0, 0.02, 0.02))


@st.composite
def lines(draw):
    """Points from the axis below the origin to the axis above, one of them level with it."""
    below = draw(st.lists(numbers(0.1, 1.4), max_size=3, unique_by=lambda angle: round(angle, 1)))
    above = draw(st.lists(numbers(0.1, 1.4), max_size=3, unique_by=lambda angle: round(angle, 1)))
    angles = [-math.pi / 2, *sorted(-angle for angle in below), 0.0, *sorted(above), math.pi / 2]
    away = [draw(numbers(0.01, 0.03)) for _ in angles]
    points = [(r * math.cos(a), r * math.sin(a)) for r, a in zip(away, angles, strict=True)]
    points[0], points[-1] = (0.0, points[0][1]), (0.0, points[-1][1])
    found = [points[0]]
    for start, end in pairwise(points):
        bend = draw(st.one_of(st.just(0.0), numbers(0.2, 1.0), numbers(-1.0, -0.2)))
        found.append((*end, math.dist(start, end) / 2.0 / bend) if bend else end)
    return found


@st.composite
def profiles(draw):
    """Profiles of bodies through the origin."""
    return made(draw(lines()))


def made(points):
    """The profile through points; other examples are looked for where it is none."""
    try:
        return profile_of(points)
    except InvalidInput:
        reject()


def brute_support(profile, tilts, steps=1000):
    """Height of the origin over the table, from many points of the profile: never too much."""
    shares = np.linspace(0.0, 1.0, steps + 1)
    points = np.concatenate([edge.points(shares) for edge in profile.edges])
    return np.max(
        np.outer(points.real, np.sin(tilts)) - np.outer(points.imag, np.cos(tilts)), axis=0
    )
