"""Runs with stick and slip against time-stepping, which shares no equation with them: first
order.
"""

import math

import pytest

import moreau
from dry_runs import DryRun, launched
from tippetop.integrators.scipy_methods import SciPy
from tippetop.mechanics.laws.contensou import ELLIPSOIDAL_RADIUS, EllipsoidalLaw
from tippetop.mechanics.laws.coulomb import CoulombLaw
from tippetop.mechanics.surfaces.surface import SphereSurface
from tippetop.mechanics.top import Top

MASS, RADIUS, GRAVITY = 0.02, 0.02, 9.8
BODY = (MASS, 131 / 350 * MASS * RADIUS**2, 0.4 * MASS * RADIUS**2, RADIUS, 0.3 * RADIUS, GRAVITY)
SECOND = math.sqrt(GRAVITY / RADIUS)

CASES = {
    "slips, and sticks for good": (CoulombLaw(0.3), 0.0, 155.0, True, 0.1),
    "sticks, slips and sticks": (CoulombLaw(0.028), 0.0, 155.0, False, 0.04),
    "slips and drills": (
        EllipsoidalLaw(0.3, 0.05 / ELLIPSOIDAL_RADIUS),
        0.05 * RADIUS,
        100.0,
        False,
        0.05,
    ),
}


@pytest.mark.parametrize("case", CASES)
def test_time_stepping_converges_to_our_runs_at_first_order(case):
    law, rho, spin, rests, end = CASES[case]
    top = Top.of(1.0, 131 / 350, 0.4, SphereSurface(1.0, 0.3), law, 1.0)
    run = DryRun(*launched(top, 0.1, spin / SECOND, rests=rests), SciPy("dop853", 1e-12)).follow(
        end * SECOND
    )
    tilt = math.acos(run.axis[2])
    errors = []
    for step in (2e-4, 1e-4):
        other = moreau.launched(BODY, law.mu, rho, 0.1, spin, rests=rests)
        for _ in range(round(end / step)):
            other.step(step)
        errors.append(other.tilt - tilt)
    assert abs(errors[0]) < 3e-4
    assert errors[0] / errors[1] == pytest.approx(2.0, rel=0.1)
