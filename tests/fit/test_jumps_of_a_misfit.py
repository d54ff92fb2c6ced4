"""Searches in a misfit that jumps, of a model of which all is known by hand."""

from types import SimpleNamespace

import numpy as np
import pytest

from tippetop.fit.search import Search

BOUND = 0.5
"""Where the model jumps."""


class Branches:
    """A model of one number: two lines with other offsets, one on each side of a bound.

    The data are zero. On a side the residuals are the number, from the side's own least, and an
    offset that no number removes.
    """

    names = fields = ("a",)
    is_event = np.array([False])
    data = np.zeros(2)
    runs = 0

    def __init__(self, left, right):
        self.sides = left, right

    def predict(self, numbers):
        least, offset = self.sides[bool(numbers[0] >= BOUND)]
        return SimpleNamespace(values=np.array([numbers[0] - least, offset]))

    def differences(self, numbers, steps=None):
        return self.predict(numbers).values, np.array([[1.0], [0.0]])

    def scales(self, numbers):
        return np.ones(1)


def search_in(left, right, low=-np.inf, high=np.inf):
    return Search(Branches(left, right), np.ones(2), np.array([low]), np.array([high]))


def test_a_minimum_at_a_jump_is_one_and_says_so():
    found = search_in((1.0, 2.0), (1.0, 3.0)).refine(np.zeros(1))
    assert found.converged
    assert found.jumps
    assert found.numbers[0] == pytest.approx(BOUND, abs=1e-3)
    assert found.cost == pytest.approx(BOUND**2 + 2.0**2, abs=1e-3)


def test_a_lower_minimum_beyond_a_jump_is_found():
    search = search_in((0.0, 2.0), (2.0, 1.0))
    near = search.refine(np.zeros(1))
    assert near.converged
    assert near.cost == pytest.approx(4.0)
    found = search.lowest_around(near)
    assert found.numbers[0] == pytest.approx(2.0)
    assert found.cost == pytest.approx(1.0)
    assert not found.jumps


def test_a_minimum_at_a_bound_is_no_jump():
    found = search_in((1.0, 2.0), (1.0, 2.0), high=0.25).refine(np.zeros(1))
    assert found.numbers[0] == pytest.approx(0.25)
    assert not found.jumps
