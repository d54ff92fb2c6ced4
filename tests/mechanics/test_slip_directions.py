"""Directions in which velocities begin, where one component responds much less than another."""

import pytest

from tippetop.mechanics.contacts.slip_direction import Resisted, directions
from tippetop.mechanics.contacts.slip_variables import inner, plus, scaled, size

DRIVEN = (2.0, 0.3, 0.05)
"""What drives the three components."""

RESPONSES = (1.0, 1.0, 0.02)
"""How much each responds to what resists it: drilling of a small patch hardly does."""


def test_a_component_that_hardly_responds_does_not_make_the_search_long():
    asked = []

    def response(ways):
        asked.append(ways)
        (e,) = ways
        resisted = tuple([-a * b for a, b in zip(RESPONSES, e, strict=True)])
        return [Resisted(plus(DRIVEN, resisted), 1.0)]

    (e,) = directions(response, [(0.0, 0.6, 0.8)])
    (resisted,) = response([e])
    along = inner(resisted.rate, e)
    assert along > 0.0
    assert size(plus(resisted.rate, scaled(-along, e))) == pytest.approx(0.0, abs=1e-14)
    assert len(asked) < 40
