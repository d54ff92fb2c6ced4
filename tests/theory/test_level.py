"""Bodies that lie: when an egg rises, and when one of two surfaces is lifted."""

import math

import pytest
from hypothesis import assume, given

import tippetop as tt
from strategies import numbers
from tippetop import presets
from tippetop.problem.problem import top_of
from tippetop.theory.level import lying, rising_rate
from tippetop.theory.prediction import hull_of
from tippetop.theory.stability import spectrum
from tippetop.theory.steady import level_spin


def spheroid(along, I1, I3):
    body = tt.Body(mass=0.05, shape=tt.Spheroid(across=0.02, along=along), I1=I1, I3=I3)
    launch = tt.Launch(tilt=1.5, spin=0.0, precession=30.0)
    return tt.Problem(body=body, friction=tt.ViscousFriction(mu=0.3), launch=launch)


@given(numbers(0.021, 0.04), numbers(5e-6, 1.5e-5), numbers(0.5, 0.95))
def test_an_egg_rises_where_its_level_spin_becomes_unstable(along, I1, ratio):
    top = top_of(spheroid(along, I1, ratio * I1))
    rate = rising_rate(top)
    assume(math.isfinite(rate))
    assume(rate < 1e3)
    growths = [spectrum(level_spin(top, share * rate), top).growth_rate for share in (0.999, 1.001)]
    assert growths[0] < 0.0 < growths[1]


def test_a_spheroid_rises_at_the_rate_in_closed_form():
    problem = spheroid(0.03, 1e-5, 6e-6)
    m, g, a, b, I1, I3 = 0.05, problem.gravity, 0.02, 0.03, 1e-5, 6e-6
    expected = math.sqrt(m * g * (b**2 - a**2) / a / (I3 * b**2 / a**2 - I1))
    assert lying(top_of(problem), 1.5).rate == pytest.approx(expected, rel=1e-12)


def test_a_lens_on_its_rim_never_rises_from_there():
    assert math.isinf(rising_rate(top_of(spheroid(0.01, 4e-6, 6e-6))))


def test_hurricane_balls_lift_at_the_rate_in_closed_form():
    """Omega^2 = 5 g / (2 R), whatever the mass."""
    problem = tt.Problem(
        body=presets.HURRICANE_BALLS,
        friction=tt.ViscousFriction(mu=0.3),
        launch=tt.Launch(tilt=1.5, spin=0.0, precession=60.0),
    )
    top = top_of(problem).altered(surface=hull_of(problem))
    found = lying(top, 1.5)
    assert found.tilt == pytest.approx(math.pi / 2, abs=1e-12)
    assert found.surfaces == (0, 1)
    radius = presets.HURRICANE_BALLS.shapes[0].radius
    assert found.rate == pytest.approx(math.sqrt(2.5 * problem.gravity / radius), rel=1e-9)


def test_tops_that_stand_by_themselves_lie_nowhere():
    for name in ("report", "report-stem", "leine-glocker"):
        problem = presets.report_problem().replace({"body": presets.body(name)})
        several = len(problem.body.shapes) > 1
        top = top_of(problem).altered(surface=hull_of(problem)) if several else top_of(problem)
        assert lying(top, 0.1) is None
