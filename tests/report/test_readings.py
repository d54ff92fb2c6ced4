"""What is read off runs, on curves whose answer is known."""

import math

import numpy as np
import pytest

from tippetop.report.experiments.friction import power_law
from tippetop.report.readings import crossings, first_below_zero, flip_time, longest_quiet

TIMES = np.linspace(0.0, 10.0, 100_001)


@pytest.mark.parametrize("within", [0.1, 0.01])
def test_flip_time_of_an_exponential(within: float) -> None:
    theta = math.pi * (1.0 - np.exp(-3.0 * TIMES))
    assert flip_time(TIMES, theta, within) == pytest.approx(
        math.log(math.pi / within) / 3.0, abs=1e-3
    )


def test_flip_time_is_the_first_even_if_the_tilt_leaves_again() -> None:
    theta = np.cos(TIMES * 2.0 * math.pi)
    assert flip_time(TIMES, theta) == 0.0


def test_crossings_of_a_cosine() -> None:
    found = crossings(TIMES, np.cos(TIMES))
    assert found == pytest.approx([math.pi / 2, 3 * math.pi / 2, 5 * math.pi / 2], abs=1e-6)


def test_crossings_ignore_what_is_not_a_number() -> None:
    values = np.cos(TIMES)
    values[::7] = np.nan
    assert len(crossings(TIMES, values)) == 3


def test_longest_quiet_lies_between_two_reversals() -> None:
    values = np.sin(TIMES**2)
    start, end = longest_quiet(TIMES[1:], values[1:])
    assert (start, end) == pytest.approx((math.sqrt(math.pi), math.sqrt(2 * math.pi)), abs=1e-5)
    assert np.isnan(longest_quiet(TIMES, TIMES + 1.0)).all()


def test_first_below_zero() -> None:
    assert first_below_zero(TIMES, np.cos(TIMES)) == pytest.approx(math.pi / 2, abs=1e-6)
    assert math.isnan(first_below_zero(TIMES, TIMES + 1.0))
    assert first_below_zero(TIMES, TIMES - 1.0) == 0.0


def test_power_law_is_found_again() -> None:
    mu = np.linspace(0.2, 1.0, 9)
    times = 2.5 * mu**-0.9
    times[3] = np.nan
    assert power_law(mu, times) == pytest.approx((2.5, -0.9, -1.0))


@pytest.mark.parametrize(
    ("mu", "times"),
    [
        ([0.1, 0.2], [2.0, 1.0]),
        ([0.2, 0.2, 0.2], [1.0, 1.0, 1.1]),
        ([0.1, 0.2, 0.3], [1.0, 0.0, 0.5]),
    ],
)
def test_no_power_law_is_fitted_where_there_is_none(mu: list[float], times: list[float]) -> None:
    assert np.isnan(power_law(np.array(mu), np.array(times))).all()
