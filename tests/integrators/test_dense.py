"""Solutions as polynomials, one a step: where they come from, and what they give at any time."""

import itertools
import math
import os
import platform
import subprocess
import sys

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from tippetop.integrators.dense import DenseSolution, at_fractions, chebyshev, evaluated

KNOTS = st.lists(st.floats(0.01, 2.0), min_size=1, max_size=6).map(lambda s: np.cumsum([-1.0, *s]))


def polynomial(coefficients):
    """Of the time, several at once, coefficients of shape (size, degree + 1)."""
    return lambda times: np.polynomial.polynomial.polyval(times, coefficients.T).T


def size_of(coefficients, knots):
    """The largest that its terms can be anywhere between the knots."""
    return (
        np.abs(coefficients) @ np.abs(knots).max() ** np.arange(coefficients.shape[1])
    ).max() + 1e-300


@given(
    arrays(float, (3, 6), elements=st.floats(-1.0, 1.0, allow_subnormal=False)),
    KNOTS,
    st.integers(5, 15),
)
def test_polynomials_are_fitted_exactly(coefficients, knots, degree):
    exact = polynomial(coefficients)
    solution = DenseSolution.fitted(lambda t: exact(t).T, knots, degree)
    times = np.union1d(np.linspace(knots[0], knots[-1], 101), knots)
    fuzz = 1e-13 * size_of(coefficients, knots)
    np.testing.assert_allclose(solution(times), exact(times), rtol=0, atol=fuzz)
    assert solution.terms.shape == (len(knots) - 1, 3, degree + 1)
    # Their terms are values and derivatives at the start of each step.
    slopes = np.polynomial.polynomial.polyval(
        knots[:-1], np.polynomial.polynomial.polyder(coefficients.T)
    ).T
    np.testing.assert_allclose(solution.terms[:, :, 0], exact(knots[:-1]), rtol=0, atol=fuzz)
    np.testing.assert_allclose(
        solution.terms[:, :, 1],
        slopes * np.diff(knots)[:, None],
        rtol=0,
        atol=10 * degree**2 * fuzz,
    )


@pytest.mark.parametrize("degree", range(2, 12))
@pytest.mark.parametrize("span", [0.5, 2.0])
def test_what_is_no_polynomial_is_fitted_as_well_as_chebyshevs_points_allow(degree, span):
    """The error of exp is at most 2 (span / 4)^(d + 1) / (d + 1)! times its largest derivative."""
    knots = span * np.arange(3.0)
    solution = DenseSolution.fitted(lambda t: [np.exp(t)], knots, degree)
    for start, end in itertools.pairwise(knots):
        times = np.linspace(start, end, 201)
        error = np.abs(solution(times)[:, 0] - np.exp(times)).max()
        bound = 2.0 * (span / 4.0) ** (degree + 1) / math.factorial(degree + 1) * math.exp(end)
        assert error <= bound + 1e-15 * math.exp(end)
        assert error >= 0.1 * math.exp(-span) * bound - 1e-15 * math.exp(end)


def pieces():
    """A solution that jumps, so that the step which a time belongs to shows: it is the number of
    the step.
    """
    return DenseSolution(np.array([1.0, 2.0, 4.0, 5.0]), np.arange(3.0).reshape(3, 1, 1))


def test_a_time_where_two_steps_meet_belongs_to_the_earlier():
    times = np.array([1.0, 1.5, 2.0, np.nextafter(2.0, 3.0), 4.0, 4.5, 5.0])
    assert pieces()(times)[:, 0].tolist() == [0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0]
    assert pieces().end == 5.0


def test_at_its_knots_a_solution_has_the_values_at_the_ends_of_its_steps():
    knots = np.array([0.0, 0.3, 1.1])
    solution = DenseSolution.fitted(lambda t: (np.sin(t), np.cos(t)), knots, 14)
    np.testing.assert_array_equal(solution(knots[:1])[0], solution.terms[0, :, 0])
    np.testing.assert_allclose(
        solution(knots), np.stack([np.sin(knots), np.cos(knots)], axis=1), atol=1e-15
    )
    np.testing.assert_allclose(solution.terms[1, :, 0], solution(knots[1:2])[0], rtol=0, atol=1e-15)


@given(st.integers(1, 4))
def test_solutions_that_follow_one_another_are_joined(cut):
    knots = np.array([0.0, 0.5, 0.7, 1.5, 1.6, 2.5])
    whole = DenseSolution.fitted(lambda t: [np.exp(-t)], knots, 8)
    parts = [
        DenseSolution(knots[: cut + 1], whole.terms[:cut]),
        DenseSolution(knots[cut : cut + 1], whole.terms[:0]),  # an arc in which no step was taken
        DenseSolution(knots[cut:], whole.terms[cut:]),
    ]
    joined = DenseSolution.joined(parts)
    np.testing.assert_array_equal(joined.knots, whole.knots)
    np.testing.assert_array_equal(joined.terms, whole.terms)
    assert DenseSolution.joined([whole]) is whole


@given(arrays(float, (2, 3, 6), elements=st.floats(-1.0, 1.0, allow_subnormal=False)))
def test_terms_in_time_are_terms_in_parts_of_the_steps(terms):
    knots = np.array([0.5, 1.0, 3.0])
    solution = DenseSolution.in_time(knots, terms.copy())
    for step, time in ((0, 0.7), (1, 1.9)):
        exact = np.polynomial.polynomial.polyval(time - knots[step], terms[step].T)
        np.testing.assert_allclose(solution(np.array([time]))[0], exact, rtol=1e-13, atol=1e-13)


@pytest.mark.parametrize("span", [0.0, 1e-300, 1e-100, 1e-30, 1e-12])
def test_steps_of_next_to_no_length_are_fitted_with_numbers(span):
    """Guards may fall at once, and flights end where they began."""
    knots = np.array([0.0, span])
    solution = DenseSolution.fitted(lambda t: (1.0 + t, np.cos(t)), knots, 14)
    assert np.all(np.isfinite(solution.terms))
    np.testing.assert_allclose(solution(knots), [[1.0, 1.0], [1.0 + span, 1.0]], rtol=0, atol=1e-15)
    inside = at_fractions(solution.terms, np.array([0.0, 0.5, 1.0]))
    np.testing.assert_allclose(
        inside[0, :, 0], 1.0 + span * np.array([0.0, 0.5, 1.0]), rtol=0, atol=1e-15
    )


def test_a_solution_is_asked_when_a_component_that_grows_has_a_value():
    """Of t + t^3 and of -2 t: the first one's inverse is Cardano's."""
    knots = np.array([0.0, 0.4, 0.5, 2.0])
    solution = DenseSolution.fitted(lambda t: (-2.0 * t, t + t**3), knots, 5)
    values = np.linspace(0.0, 10.0, 41)
    root = np.sqrt(values**2 / 4.0 + 1.0 / 27.0)
    exact = np.cbrt(values / 2.0 + root) + np.cbrt(values / 2.0 - root)
    np.testing.assert_allclose(solution.when(1, values), exact, rtol=0, atol=1e-14)
    np.testing.assert_allclose(
        solution.rows(solution.when(1, values))[0], -2.0 * exact, rtol=0, atol=1e-13
    )
    # Every other step begins a polynomial, as two are short beside the radius of convergence.
    np.testing.assert_allclose(
        solution.knots_of(1, 5.0), [0.0, 0.5 + 0.5**3, 5.0], rtol=1e-14, atol=1e-15
    )
    np.testing.assert_allclose(solution.knots_of(1, 0.6), [0.0, 0.6], rtol=1e-14, atol=1e-15)


def test_a_solution_is_moved_in_time_to_end_exactly():
    knots = np.array([0.0, 0.1, 0.3])
    whole = DenseSolution.fitted(lambda t: (np.exp(t), 1.0), knots, 9)
    moved = whole.moved(1e3, 1000.3)
    assert moved.end == 1000.3
    np.testing.assert_allclose(
        moved(np.array([1000.2])), whole(np.array([0.2])), rtol=0, atol=1e-12
    )
    assert moved.size == 2


def test_what_does_not_exist_is_a_solution_too():
    assert DenseSolution.empty(2.0, 8).end == 2.0
    assert len(DenseSolution.empty(2.0, 8).terms) == 0


@given(arrays(float, (4, 2, 9), elements=st.floats(-1.0, 1.0, allow_subnormal=False)))
def test_fractions_of_steps_are_places_in_them(terms):
    fractions = np.array([0.0, 0.25, 1.0])
    found = at_fractions(terms, fractions)
    assert found.shape == (2, 3, 4)
    for m, fraction in enumerate(fractions):
        exact = evaluated(terms, np.arange(4), np.full(4, fraction))
        np.testing.assert_allclose(found[:, m].T, exact, rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("degree", [0, 1, 5, 20])
def test_chebyshevs_points_lie_within_and_his_coefficients_give_back_the_values(degree):
    places, transform, to_powers = chebyshev(degree)
    assert len(places) == degree + 1
    assert np.all((places > 0.0) & (places < 1.0))
    assert places + places[::-1] == pytest.approx(1.0, abs=1e-15)
    there = np.vander(places, degree + 1, increasing=True) @ to_powers @ transform
    # Powers of numbers up to 1 lose digits as the coefficients grow, (3 + 8^1/2)^degree / 2 at
    # most.
    lost = 1e-15 * (3.0 + math.sqrt(8.0)) ** degree
    assert there == pytest.approx(np.eye(degree + 1), abs=lost + 1e-14)


def test_what_polynomials_leave_unresolved_is_the_last_of_chebyshevs():
    knots = np.array([0.0, 2.0, 3.0])
    last = np.polynomial.Chebyshev.basis(14, domain=[0.0, 2.0])

    def numbers(t):
        return np.exp(-0.1 * t), 0.3 * np.where(t < 2.0, last(t), 1.0)

    solution = DenseSolution.fitted(numbers, knots, 14)
    assert solution.unresolved == pytest.approx(0.3, rel=1e-12)
    # Values near 1 are known to a rounding, and so is what is left of their last polynomial.
    assert (
        DenseSolution.fitted(lambda t: [np.exp(-0.1 * t)], knots, 14).unresolved
        < np.finfo(float).eps
    )


@pytest.mark.skipif(platform.libc_ver()[0] != "glibc", reason="other allocators have other rules")
def test_memory_that_arrays_leave_is_not_fetched_again():
    code = """if True:
        import resource
        import numpy as np
        import tippetop.integrators.dense

        def faults_of_some_arrays():
            before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
            held = [np.ones(2**16) for _ in range(16)]
            return resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before

        print(*(faults_of_some_arrays() for _ in range(3)))
    """

    # Dask's workers leave what they make of the allocator in the environment of their parent.
    environment = {
        name: value for name, value in os.environ.items() if not name.startswith("MALLOC_")
    }
    made = subprocess.run(
        [sys.executable, "-c", code], check=True, capture_output=True, text=True, env=environment
    )
    first, *others = map(int, made.stdout.split())
    assert max(others) < 0.1 * first
