"""The method that impacts are integrated by: order 8, and an estimate of its error."""

import math

import numpy as np
import pytest
from scipy.integrate import DOP853

from tippetop.mechanics.runge_kutta import FINE, POWER, ROUGH, STAGES, step_from


def pendulum(y):
    return (y[1], -math.sin(y[0]))


def test_its_weights_are_scipys():
    for ours, theirs in zip(
        (*STAGES, FINE, ROUGH), (*DOP853.A[1:], DOP853.B, DOP853.E5, DOP853.E3), strict=True
    ):
        assert ours == tuple(theirs[: len(ours)])
        assert not np.any(theirs[len(ours) :])


def followed(span, steps):
    """Where the pendulum is in the end, and the largest doubt of a step."""
    here, doubt = (1.0, 0.3), 0.0
    for _ in range(steps):
        taken = step_from(here, pendulum(here), span / steps, pendulum)
        here, doubt = taken.end, max(doubt, taken.error_estimate(lambda error: math.hypot(*error)))
    return here, doubt


def test_it_is_of_order_8_and_so_is_its_estimate_of_a_steps_error():
    exact = followed(12.0, 400)[0]
    (coarse, rough), (fine, smooth) = (followed(12.0, steps) for steps in (15, 30))
    assert math.log2(math.dist(coarse, exact) / math.dist(fine, exact)) == pytest.approx(
        8.0, abs=1.0
    )
    assert math.log2(rough / smooth) == pytest.approx(-1.0 / POWER, abs=1.0)


def test_the_cubic_through_a_steps_ends_has_their_slopes():
    taken = step_from((1.0, 0.3), pendulum((1.0, 0.3)), 0.4, pendulum)
    assert taken.between(0.0) == taken.start
    assert taken.between(1.0) == pytest.approx(taken.end, abs=1e-16)
    for part, slope in ((0.0, taken.slopes[0]), (1.0, taken.new_slope)):
        ahead, behind = taken.between(part + 1e-6), taken.between(part - 1e-6)
        rate = [(a - b) / 2e-6 / taken.size for a, b in zip(ahead, behind, strict=True)]
        assert rate == pytest.approx(slope, rel=1e-6)
