"""Where in a step another branch of the law takes over."""

import numpy as np

from tippetop.integrators.polynomial_minima import first_fall
from tippetop.integrators.polynomials import Polynomials
from tippetop.sweeps.taylor_step import LOOKS
from tippetop.sweeps.taylor_stepper import NumPyArithmetic


def told(terms, span):
    with np.errstate(all="ignore"):
        time, doubt = first_fall(list(terms), span, LOOKS, NumPyArithmetic())
    return time, doubt > 0.0


def test_a_change_of_branch_is_told_where_a_guard_first_falls_or_there_is_doubt():
    random = np.random.default_rng(5)
    count, degree = 4000, 12
    terms = (
        random.normal(size=(degree + 1, count))
        * random.uniform(0.2, 0.9, count) ** np.arange(degree + 1)[:, None]
    )
    terms[0] = np.abs(terms[0]) * 10.0 ** random.uniform(-8, 0, count)
    span = random.uniform(0.3, 1.0, count)
    time, doubt = told(terms, span)
    first = Polynomials(terms, span).first_fall()
    falls, sure = np.isfinite(first), ~doubt
    assert np.all(np.isfinite(time[sure]) == falls[sure])
    assert np.count_nonzero(sure & falls) > 0.1 * count
    assert np.abs(time - first)[sure & falls].max() < 1e-12


def test_a_guard_that_begins_at_zero_or_dips_between_looks_is_left_to_a_closer_look():
    terms = np.array([[0.0, 0.3**2 - 1e-9, 1.0], [-1.0, -0.6, -1.0], [2.0, 1.0, 0.0]])
    time, doubt = told(terms, np.ones(3))
    assert doubt.tolist() == [True, True, False]
    assert time[2] == 1.0 or np.isinf(time[2])
