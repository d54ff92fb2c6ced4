"""Derivatives by complex steps against computer algebra and against what is known of them."""

import math

import numpy as np
import pytest
import sympy
from hypothesis import given, settings
from hypothesis import strategies as st

from campaigns import examples
from strategies import numbers, slides
from tippetop.mechanics.motion import sliding_rates
from tippetop.mechanics.state import SlidingState
from tippetop.theory.derivatives import derivative, jacobian


def rates_of_eight(y, top):
    return sliding_rates(SlidingState.unpack(y), top).pack()


@given(numbers(0.1, 3.0))
def test_every_operation_differentiates_as_the_rules_say(x):
    cases = [
        (lambda t: 3.0 - t, -1.0),
        (lambda t: t - 3.0, 1.0),
        (lambda t: 2.0 * t + 1.0, 2.0),
        (lambda t: -t * t, -2.0 * x),
        (lambda t: t / (1.0 + t), 1.0 / (1.0 + x) ** 2),
        (lambda t: 2.0 / t, -2.0 / x**2),
        (lambda t: t / 4.0, 0.25),
        (lambda t: t**3, 3.0 * x**2),
        (lambda t: t**-0.5, -0.5 * x**-1.5),
        (lambda t: np.sin(t) * np.cos(t), math.cos(2.0 * x)),
    ]
    for function, slope in cases:
        assert derivative(function, x) == pytest.approx(slope, rel=1e-14, abs=1e-15)
        assert derivative(function, np.array([x, 1.0]))[0] == pytest.approx(
            slope, rel=1e-14, abs=1e-15
        )


@pytest.mark.parametrize("at", [-2.0, np.array([-2.0, 3.0])], ids=["number", "array"])
def test_what_is_not_analytic_is_refused(at):
    for function in (abs, np.sign, lambda t: t * abs(1.0 - t)):
        with pytest.raises(TypeError, match="analytic"):
            derivative(function, at)
        with pytest.raises(TypeError, match="analytic"):
            jacobian(lambda y, taken=function: [y[0], taken(y[1])], [at, at])


@pytest.mark.parametrize("root", [lambda t: t**0.5, np.sqrt, lambda t: (t**0.75) ** 4, np.log])
def test_a_root_of_a_negative_number_has_no_derivative(root):
    assert math.isnan(derivative(root, -2.0))
    assert np.isnan(derivative(root, np.array([-2.0, 3.0]))).tolist() == [True, False]
    assert np.isnan(jacobian(lambda y: [root(y[0]), y[0]], [-2.0])).tolist() == [[True], [False]]
    assert derivative(lambda t: (t * t) ** 0.5, -2.0) == -1.0


def test_plain_results_have_zero_derivatives():
    assert jacobian(lambda y: [y[0] * y[1], 5.0], [2.0, 3.0]).tolist() == [[3.0, 2.0], [0.0, 0.0]]


def test_many_points_give_the_matrices_of_each():
    first, second = np.array([1.0, 2.0, 3.0]), np.array([4.0, 5.0, 6.0])
    together = jacobian(lambda y: [y[0] / y[1], y[0] * y[0], y[1]], [first, second])
    assert together.shape == (3, 3, 2)
    for i, matrix in enumerate(together):
        alone = jacobian(lambda y: [y[0] / y[1], y[0] * y[0], y[1]], [first[i], second[i]])
        assert np.array_equal(matrix, alone)


@settings(max_examples=examples(check=4, claim=50))
@given(slides(), st.lists(numbers(-1.0, 1.0), min_size=8, max_size=8))
def test_the_jacobian_of_the_mechanics_is_that_of_computer_algebra(case, direction):
    """Along a direction, sliding_rates(y + s v) is a function of s alone, which SymPy
    differentiates.
    """
    top, state = case
    y = state.pack()
    along = [number * max(abs(entry), 1e-6) for number, entry in zip(direction, y, strict=True)]
    s = sympy.Symbol("s")
    moved = [entry + s * step for entry, step in zip(y, along, strict=True)]
    slopes = [
        float(sympy.diff(sympy.sympify(rate), s).subs(s, 0)) for rate in rates_of_eight(moved, top)
    ]
    matrix = jacobian(lambda t: rates_of_eight(t, top), y)
    scale = np.abs(matrix) @ np.abs(along) + 1e-300
    assert np.abs(matrix @ along - slopes) / scale == pytest.approx(0.0, abs=1e-11)
