"""Guards of a motion compiled together, and the derivatives of its rates."""

import math

import numpy as np
import pytest

from tippetop.fit.variational import followed, variational_motion
from tippetop.integrators import make_integrator
from tippetop.integrators.base import Guard, Motion
from tippetop.integrators.collocation import Collocation
from tippetop.integrators.guard_functions import guard_functions, guard_values
from tippetop.integrators.rates import RightHandSide

GUARDS = (
    Guard("circle", lambda y, p: p[0] - y[0] * y[0] - y[1] * y[1]),
    Guard("pole", lambda y, p: (y[1] - p[0]) / y[0]),
)
MOTION = Motion(lambda y, p: (y[1], -p[0] * y[0]), 2, 1, GUARDS)
STATES = [(0.5, -1.0), (2.0, 3.0), (0.0, 1.0)]


def unrecorded(guard):
    """Return a guard that asks for numbers, so that nothing can be compiled."""
    return Guard(guard.name, lambda y, p: guard.value([math.fsum([one]) for one in y], p))


@pytest.mark.parametrize("guards", [GUARDS, tuple(map(unrecorded, GUARDS))])
def test_guards_have_their_values_and_are_infinite_at_a_pole(guards):
    motion = Motion(MOTION.rates, 2, 1, guards)
    circle, pole = guard_values(motion, (4.0,), STATES)
    assert circle == pytest.approx([2.75, -9.0, 3.0], rel=1e-15)
    assert pole[:2] == pytest.approx([-10.0, -0.5], rel=1e-15)
    assert not math.isfinite(pole[2])
    functions = guard_functions(motion, (4.0,))
    assert [functions[0](np.array(state)) for state in STATES] == circle
    assert [functions[1](np.array(state)) for state in STATES] == [*pole[:2], math.inf]


def test_guards_of_other_parameters_have_other_values():
    for bound in (1.0, 2.0):
        (circle, _) = guard_functions(MOTION, (bound,))
        assert circle(np.array([0.0, 0.5])) == bound - 0.25


def bent(y, p):
    """A number that follows a pendulum, the faster the larger the first parameter."""
    return (p[0] * (y[1] - y[0]) * (1.0 + y[0] * y[0]), y[2], -p[1] * y[1])


def test_derivatives_of_rates_are_those_by_hand():
    states = np.array([[0.3, -0.7, 2.0], [1.1, 0.2, -0.4]])
    values, slopes = RightHandSide(Motion(bent, 3, 2), (5.0, 2.0)).linearized(states)
    for (a, b, c), value, slope in zip(states, values, slopes, strict=True):
        assert value == pytest.approx([5.0 * (b - a) * (1.0 + a * a), c, -2.0 * b], rel=1e-14)
        along_a = 5.0 * (2.0 * a * (b - a) - (1.0 + a * a))
        rows = [[along_a, 5.0 * (1.0 + a * a), 0.0], [0.0, 0.0, 1.0], [0.0, -2.0, 0.0]]
        assert slope == pytest.approx(np.array(rows), rel=1e-14)


def test_the_implicit_method_follows_directions_as_the_explicit_one_does():
    motion, numbers = Motion(bent, 3, 2), np.array([[40.0, 2.0], [0.0, 0.0], [1.0, 0.0]])
    start = np.array([[0.3, -0.7, 2.0], [1.0, 0.5, 0.0], [0.0, 0.0, 0.0]])
    ends = []
    for method in (Collocation(1e-13), make_integrator("taylor")):
        solved = followed(motion, numbers, (0.0, start), 1.5, method)
        assert solved is not None
        ends.append(solved[1])
    assert ends[0] == pytest.approx(ends[1], abs=1e-11)
    assert abs(ends[1][2, 0]) > 1e-5, "the derivative by the first parameter is no rounding"
    assert variational_motion(motion, 2).varied is motion
