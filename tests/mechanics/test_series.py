"""Series whose sums are known, and the solutions they make."""

import math

import numpy as np
import pytest

from tippetop.mechanics.series import Series, horner, solved, unknown
from tippetop.sweeps.taylor_stepper import NumPyArithmetic

PLAIN = NumPyArithmetic()
DEGREE = 12


def series(terms):
    return Series(lambda k: terms[k] if k < len(terms) else 0.0 * terms[0], PLAIN)


def terms_of(one, count=DEGREE):
    return [one[k] for k in range(count)]


@pytest.mark.parametrize(
    ("make", "value"),
    [
        (lambda t: 1.0 / (1.0 - t), lambda t: 1.0 / (1.0 - t)),
        (lambda t: (1.0 + t) ** 0.5, lambda t: math.sqrt(1.0 + t)),
        (lambda t: (2.0 + t) ** -0.5, lambda t: 1.0 / math.sqrt(2.0 + t)),
        (lambda t: (1.0 + t) ** 2 - t * t - 2.0 * t, lambda t: 1.0),
        (lambda t: (3.0 - t) / (1.0 + t * t), lambda t: (3.0 - t) / (1.0 + t * t)),
        (lambda t: -t + t * (1.0 + t) * (2.0 - t), lambda t: -t + t * (1.0 + t) * (2.0 - t)),
    ],
)
def test_arithmetic_of_series_is_that_of_functions(make, value):
    made = make(series([np.zeros(1), np.ones(1)]))
    time = 0.01
    assert horner(terms_of(made), time) == pytest.approx(value(time), rel=1e-14)


def test_powers_of_series_are_those_of_their_values():
    terms, time = [1.3, 0.2, -0.4, 0.7, *([0.01] * 13)], 0.1
    for power in (0.5, -0.5, 0.25, 2, -1.0, 3.7):
        found = terms_of(series([np.array([term]) for term in terms]) ** power, len(terms))
        assert horner(found, time) == pytest.approx(horner(terms, time) ** power, rel=1e-14)


@pytest.mark.parametrize("exponent", [1, 2, 3.0, 5, 20])
def test_a_whole_power_of_a_series_that_starts_at_zero_is_a_product(exponent):
    """(t + t^2)^n = t^n (1 + t)^n: the recurrence that divides by the base has no coefficients."""
    power = series([np.zeros(1), np.ones(1), np.ones(1)]) ** exponent
    expected = [
        math.comb(int(exponent), k - int(exponent)) if k >= exponent else 0 for k in range(26)
    ]
    assert np.ravel(terms_of(power, 26)).tolist() == expected


def test_solution_of_a_harmonic_oscillator_is_a_circle():
    y = solved(
        [Series(unknown, PLAIN) for _ in range(2)],
        [np.ones(1), np.zeros(1)],
        lambda y: (-y[1], y[0]),
    )
    for k in range(DEGREE):
        assert y[0][k] == pytest.approx((1, 0, -1, 0)[k % 4] / math.factorial(k), abs=1e-17)
        assert y[1][k] == pytest.approx((0, 1, 0, -1)[k % 4] / math.factorial(k), abs=1e-17)


def test_solution_with_a_constant_rate_is_a_line():
    (y,) = solved([Series(unknown, PLAIN)], [np.array([2.0])], lambda _: (3.0,))
    assert np.ravel(terms_of(y)).tolist() == [2.0, 3.0, *([0.0] * (DEGREE - 2))]
