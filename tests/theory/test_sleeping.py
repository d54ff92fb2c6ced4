"""Gyroscopic thresholds of vertical spins: against linear motions of the modes, and textbooks."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

import tippetop as tt
from tippetop.contact.contact_mode import ContactMode
from tippetop.mechanics.laws.coulomb import CoulombLaw
from tippetop.mechanics.surfaces.surface import SphereSurface, SpheroidSurface
from tippetop.mechanics.top import Top
from tippetop.problem.problem import top_of
from tippetop.theory.derivatives import jacobian
from tippetop.theory.sleeping import sleeping
from tippetop.theory.stability import vertical_growth_rates
from tippetop.theory.steady import SteadyKind

KINDS = [SteadyKind.UPRIGHT, SteadyKind.INVERTED]
SURFACES = st.one_of(
    st.builds(lambda r, zeta: SphereSurface(r, zeta * r), st.floats(0.3, 2.0), st.floats(-3, 0.9)),
    st.builds(
        lambda along, up: SpheroidSurface(1.0, along, up * along),
        st.floats(1.1, 3.0),
        st.floats(-0.6, 0.6),
    ),
)
INERTIAS = st.tuples(st.floats(0.2, 0.8), st.floats(0.1, 0.4))


def top_on(surface, inertias):
    return Top.of(1.0, *inertias, surface, CoulombLaw(0.3), 1.0)


def rolling_growth(kind, top, spin):
    """Largest growth rate of the mode that sticks, about its vertical spin, by its own rates."""
    pole = 1.0 if kind is SteadyKind.UPRIGHT else -1.0
    mode = ContactMode(top, sticks=(True,))
    start = (0.0, 0.0, pole, 0.0, 0.0, pole * top.axial_inertia * spin)
    matrix = jacobian(mode.rates, [np.array([number]) for number in start])[0]
    horizontal = [0, 1, 3, 4]
    return max(np.linalg.eigvals(matrix[np.ix_(horizontal, horizontal)]).real)


@pytest.mark.parametrize("kind", KINDS)
@given(SURFACES, INERTIAS, st.floats(0.0, 5.0))
def test_a_rolling_contact_grows_a_tilt_as_the_mode_that_sticks_does(kind, surface, inertias, spin):
    top = top_on(surface, inertias)
    assume(float(surface.height(1.0)) > 0.05)
    assume(float(surface.height(-1.0)) > 0.05)
    threshold = sleeping(kind, top, spin, rolls=True)
    # At the threshold two eigenvalues meet: rounding there is as the square root.
    assume(abs(spin - threshold.spin) > 1e-3)
    growth = rolling_growth(kind, top, spin)
    assert growth == pytest.approx(threshold.growth_rate, abs=1e-7 * (1.0 + abs(growth)))
    assert (threshold.growth_rate > 0.0) == (spin < threshold.spin)


@pytest.mark.parametrize("kind", KINDS)
@given(SURFACES, INERTIAS, st.floats(0.0, 5.0))
def test_a_smooth_table_grows_a_tilt_as_the_spectrum_without_friction_does(
    kind, surface, inertias, spin
):
    top = top_on(surface, inertias)
    assume(float(surface.height(1.0)) > 0.05)
    assume(float(surface.height(-1.0)) > 0.05)
    threshold = sleeping(kind, top, spin, rolls=False)
    assume(abs(spin - threshold.spin) > 1e-3)
    smooth = top.altered(friction=tt.ViscousFriction(mu=0.0).law)
    growth = float(vertical_growth_rates(kind, smooth, np.array([spin]))[0])
    assert growth == pytest.approx(threshold.growth_rate, abs=1e-6 * (1.0 + abs(growth)))


def test_a_top_on_a_point_sleeps_as_in_textbooks():
    """omega^2 I3^2 = 4 A m g l, A about the point."""
    mass, height, gravity, transverse, axial = 0.01, 0.03, 9.81, 5e-5, 1e-4
    surface = SphereSurface(0.0, -height)
    top = Top.of(mass, transverse, axial, surface, CoulombLaw(0.2), gravity)
    about_point = transverse + mass * height**2
    expected = 2.0 * math.sqrt(about_point * mass * gravity * height) / axial
    assert sleeping(SteadyKind.UPRIGHT, top, 50.0, rolls=True).spin == pytest.approx(expected)
    fall = math.sqrt(mass * gravity * height / about_point)
    assert sleeping(SteadyKind.UPRIGHT, top, 0.0, rolls=True).growth_rate == pytest.approx(fall)


def tilts_of_run(share):
    """Tilts over time, rad, of a slender top on dry friction, with a share of its threshold."""
    body = tt.Body(mass=0.01, shape=tt.Sphere(radius=0.0005, center=-0.0295), I1=5e-5, I3=1e-4)
    problem = tt.Problem(
        body=body, friction=tt.CoulombFriction(mu=0.9), launch=tt.Launch(tilt=1e-6, spin=1.0)
    )
    spin = share * sleeping(SteadyKind.UPRIGHT, top_of(problem), 1.0, rolls=True).spin
    run = tt.simulate(problem.replace({"launch.spin": spin}), 1.5, samples=4)
    growth = sleeping(SteadyKind.UPRIGHT, top_of(problem), spin, rolls=True).growth_rate
    return run["tilt"].values, growth


def test_a_run_on_dry_friction_falls_below_the_threshold_at_the_growth_rate():
    tilts, growth = tilts_of_run(0.5)
    assert math.log(tilts[3] / tilts[2]) / 0.5 == pytest.approx(growth, rel=1e-2)


def test_a_run_on_dry_friction_sleeps_above_the_threshold():
    tilts, growth = tilts_of_run(1.1)
    assert growth == 0.0
    assert max(tilts) < 1e-5
