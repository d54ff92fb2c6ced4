"""Implicit steps: their order, and that stiff rates do not bound them."""

import math

import pytest

from tippetop.mechanics.implicit_step import COUNTS, implicit_step


def followed(rates, jacobian, here, span, steps):
    """Where it is in the end, and the largest doubt of a step."""
    doubt = 0.0
    for _ in range(steps):
        taken = implicit_step(here, rates(here), span / steps, rates, jacobian(here))
        here, doubt = taken.there, max(doubt, taken.doubt(lambda error: math.hypot(*error)))
    return here, doubt


@pytest.mark.parametrize("known", [1.0, 0.0], ids=["with derivatives", "without"])
def test_its_order_is_the_number_of_divisions_and_that_of_its_doubt_is_one_less(known):
    def rates(y):
        return (y[1], -math.sin(y[0]))

    def jacobian(y):
        return ((0.0, known), (-known * math.cos(y[0]), 0.0))

    exact = followed(rates, jacobian, (1.0, 0.3), 6.0, 800)[0]
    (coarse, rough), (fine, smooth) = (
        followed(rates, jacobian, (1.0, 0.3), 6.0, steps) for steps in (30, 60)
    )
    assert math.log2(math.dist(coarse, exact) / math.dist(fine, exact)) == pytest.approx(len(COUNTS), abs=0.7)
    assert math.log2(rough / smooth) == pytest.approx(len(COUNTS), abs=0.7)


@pytest.mark.parametrize("stiffness", [1e4, 1e8, 1e12])
def test_a_component_that_decays_at_once_does_not_bound_its_steps(stiffness):
    """y follows cos t (Prothero and Robinson 1974), the last number is t."""

    def rates(y):
        return (-stiffness * (y[0] - math.cos(y[1])) - math.sin(y[1]), 1.0)

    def jacobian(y):
        return ((-stiffness, -stiffness * math.sin(y[1]) - math.cos(y[1])), (0.0, 0.0))

    there, doubt = followed(rates, jacobian, (1.0, 0.0), 2.0, 20)
    assert there == pytest.approx((math.cos(2.0), 2.0), abs=1e-6)
    assert doubt < 1e-6
    away = followed(rates, jacobian, (1.5, 0.0), 2.0, 20)[0]
    assert away == pytest.approx(there, abs=1e-6)
