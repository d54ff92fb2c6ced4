"""Zeros and extremes of polynomials that were made from them."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tippetop.contact.block import NODES
from tippetop.integrators.polynomials import INTERVALS, Polynomials, least_of_each


def with_roots(roots, factor=1.0):
    return factor * np.poly(roots)[::-1].reshape(-1, 1)


def ones(value=1.0):
    return np.array([value])


@given(st.lists(st.floats(0.01, 3.0), min_size=1, max_size=5, unique=True), st.floats(0.5, 2.0))
def test_first_fall_is_the_smallest_root_at_which_the_polynomial_falls(roots, span):
    roots = sorted(roots)
    gaps, triples = np.diff([0.0, *roots]), np.array(roots[2:]) - np.array(roots[:-2])
    if np.any(gaps < 1e-2) or abs(roots[0] - span) < 1e-9:
        # Roots that merge, or a root at the very end, are decided by rounding.
        return
    if np.any(triples < 2.0 * span / INTERVALS):
        # More than one extreme between two looks is not seen.
        return
    terms = with_roots(roots)
    terms *= np.sign(terms[0])  # positive at 0, so that the first root is a fall
    found = Polynomials(terms, ones(span)).first_fall()[0]
    if roots[0] < span:
        assert found == pytest.approx(roots[0], rel=1e-9)
    else:
        assert np.isnan(found)


@given(st.lists(st.floats(-1.0, 1.0), min_size=1, max_size=9), st.floats(0.5, 2.0))
def test_backward_a_polynomial_is_read_from_the_end_of_its_interval(terms, span):
    forward = Polynomials(np.array(terms).reshape(-1, 1), ones(span))
    backward = forward.backward()
    assert np.allclose(backward.values, forward.values[::-1], rtol=0.0, atol=1e-10)
    assert backward.span == forward.span


@pytest.mark.parametrize("width", [1e-1, 1e-3, 1e-5])
def test_a_dip_between_two_looks_is_found(width):
    middle = 0.5 / INTERVALS + 10 / INTERVALS
    found = Polynomials(
        with_roots([middle - width / INTERVALS, middle + width / INTERVALS]), ones()
    ).first_fall()[0]
    assert found == pytest.approx(middle - width / INTERVALS, rel=1e-9)


@pytest.mark.parametrize("middle", [0.4 / INTERVALS, 1.0 - 0.4 / INTERVALS])
def test_a_dip_in_the_first_or_the_last_interval_is_found(middle):
    width = 0.3 / INTERVALS
    found = Polynomials(with_roots([middle - width, middle + width]), ones()).first_fall()[0]
    assert found == pytest.approx(middle - width, rel=1e-9)


def test_a_dip_right_before_a_fall_is_found():
    roots = [1.3125, 1.34375, 1.375]
    assert Polynomials(-with_roots(roots), ones(1.65625)).first_fall()[0] == pytest.approx(
        1.3125, rel=1e-9
    )


def test_a_graze_that_does_not_touch_is_none():
    middle = 0.5 / INTERVALS + 10 / INTERVALS
    terms = with_roots([middle, middle])
    terms[0] += 1e-8
    assert np.isnan(Polynomials(terms, ones()).first_fall()[0])


def test_polynomials_do_not_meddle_with_each_other():
    terms = np.hstack(
        [
            with_roots([0.3, 0.9, 2.0]) * -1.0,
            with_roots([0.6, 5.0, 7.0]) * -1.0,
            0 * with_roots([1, 1, 1]) + 1,
        ]
    )
    found = Polynomials(terms, np.ones(3)).first_fall()
    assert found[:2] == pytest.approx([0.3, 0.6], rel=1e-14)
    assert np.isnan(found[2])


@pytest.mark.parametrize("count", [1, 7, 60])
def test_zeros_are_to_the_last_bit_those_that_fewer_polynomials_have(count):
    random = np.random.default_rng(1)
    terms = random.normal(size=(21, 2000)) * 0.5 ** np.arange(21.0)[:, None]
    every = Polynomials(terms, np.ones(2000))
    lots = [
        every.some(np.arange(first, min(first + count, 2000))) for first in range(0, 2000, count)
    ]
    found = every.first_fall()
    assert np.isfinite(found).sum() > 300
    np.testing.assert_array_equal(found, np.concatenate([lot.first_fall() for lot in lots]))


def test_starting_at_zero_and_sinking_falls_at_once_and_rising_does_not():
    assert Polynomials(np.array([[0.0], [-1.0]]), ones()).first_fall()[0] == 0.0
    assert np.isnan(Polynomials(np.array([[0.0], [1.0]]), ones()).first_fall()[0])


@given(st.floats(0.1, 0.9))
def test_extremes_of_a_parabola_are_exact(vertex):
    terms = np.array([[vertex**2], [-2.0 * vertex], [1.0]])
    place, value = Polynomials(terms, ones()).refined_least()
    assert place[0] == pytest.approx(vertex, abs=1e-12)
    assert value[0] == pytest.approx(0.0, abs=1e-15)
    place, value = Polynomials(-terms, ones()).negative().refined_least()
    assert place[0] == pytest.approx(vertex, abs=1e-12)
    assert value[0] == pytest.approx(0.0, abs=1e-15)


def test_an_extreme_at_an_end_is_the_end():
    rising = Polynomials(np.array([[1.0], [2.0]]), ones(3.0))
    for polynomial, where, what in ((rising, 0.0, 1.0), (rising.negative(), 3.0, -7.0)):
        place, value = polynomial.refined_least()
        assert place[0] == where
        assert value[0] == what


def test_a_dip_between_an_end_and_the_next_look_is_found():
    terms = np.array([[0.0], [-0.02], [1.0]])
    for coefficients in (terms, np.array([[0.98], [-1.98], [1.0]])):
        assert Polynomials(coefficients, ones()).refined_least()[1][0] == pytest.approx(
            -1e-4, rel=1e-12
        )


def test_the_least_values_of_lots_are_found_whatever_their_degrees():
    dip = Polynomials(np.array([[0.3], [-1.0], [1.0]]), ones())
    lines = Polynomials(np.array([[1.0, 2.0], [-0.5, 1.0]]), np.ones(2))
    first, none, last = least_of_each([lines, dip], [], [lines])
    assert first == pytest.approx((0.05, 2, 0.5), rel=1e-12)
    assert none.value == np.inf
    assert last == (0.5, 0, 1.0)


# --- sag
# ------------------------------------------------------------------------------------------

ANY_TERMS = st.lists(st.floats(-1.0, 1.0, allow_subnormal=False), min_size=1, max_size=22)
PLACES = np.linspace(0.0, 1.0, 1001)


def values_of(terms, span):
    """Values all over the interval, and rounding in them."""
    values = np.polynomial.polynomial.polyval(PLACES * span, terms)
    return values, 1e-14 * np.abs(np.array(terms) * span ** np.arange(len(terms))).sum()


def assert_within_sag(terms, span=1.0):
    one = Polynomials(np.array(terms, dtype=float)[:, None], ones(span))
    seen = np.polynomial.polynomial.polyval(NODES * span, terms)
    values, fuzz = values_of(terms, span)
    assert values.min() >= seen.min() - one.sag[0] - fuzz
    assert values.max() <= seen.max() + one.sag[0] + fuzz


@given(ANY_TERMS, st.floats(0.1, 1.5))
def test_no_polynomial_goes_further_beyond_gausss_points_than_its_sag(terms, span):
    assert_within_sag(terms, span)


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("degree", range(22))
def test_powers_stay_within_their_sag(degree, sign):
    """They rise most beyond the last of the points."""
    assert_within_sag([0.0] * degree + [sign])


@pytest.mark.parametrize("degree", range(2, 12))
@pytest.mark.parametrize("side", [0.0, 0.5])
def test_waves_between_gausss_points_stay_within_their_sag(degree, side):
    """Chebyshev's polynomials on the interval, and their squares, turn near its ends and all over
    it.
    """
    wave = np.polynomial.Chebyshev.basis(degree, domain=[0.0, 1.0]).convert(
        kind=np.polynomial.Polynomial
    )
    terms = wave.convert(domain=[-1.0, 1.0], window=[-1.0, 1.0]).coef
    assert_within_sag(terms)
    assert_within_sag(-terms)
    assert_within_sag(np.polynomial.polynomial.polymul(terms, terms) - side * 1.0)


def test_sag_of_a_line_is_what_lies_beyond_the_points():
    sag = Polynomials(np.array([[0.0], [1.0]]), ones()).sag[0]
    assert NODES[0] <= sag <= 1.02 * NODES[0]


def test_some_polynomials_are_told_of_themselves():
    terms = np.array([[1.0, 2.0, 3.0], [0.5, -0.5, 0.25]])
    every = Polynomials(terms, np.array([1.0, 2.0, 4.0]))
    assert every.sag.shape == every.lowest.shape == (3,)
    some = every.some(np.array([2, 0]), sign=-1.0, shift=5.0)
    assert some.lowest.tolist() == [1.0, 3.5]
    assert some.sag.tolist() == every.sag[[2, 0]].tolist()


def test_so_many_that_they_are_taken_in_parts_are_as_one_by_one():
    random = np.random.default_rng(3)
    terms, span = random.normal(size=(8, 600)), random.uniform(0.5, 2.0, 600)
    many, middle = Polynomials(terms, span), np.array([0, 255, 256, 511, 512, 599])
    few = Polynomials(terms[:, middle], span[middle])
    for name in ("values", "bending", "sag"):
        assert getattr(many, name)[..., middle] == pytest.approx(
            getattr(few, name), rel=1e-14, abs=1e-14
        )
    assert many.values.shape == (INTERVALS + 1, 600)
    assert few.values[INTERVALS] == pytest.approx(np.sum(few.unit, axis=0), rel=1e-13, abs=1e-13)
