"""Critical spins: closed forms, the spectrum, and what a finite run shows of them."""

import math

import numpy as np
import pytest
from full_runs import full_run, jellett_unit, sphere, tilts_of
from hypothesis import assume, given

import tippetop as tt
from strategies import numbers, spheroids, tops
from tippetop import presets
from tippetop.mechanics.laws.friction import ViscousLaw
from tippetop.problem.problem import top_of
from tippetop.support.errors import InvalidInput
from tippetop.theory.apparent import (
    apparent_critical_spins,
    critical_spin_from_spectrum,
    growth_rates_of_launches,
)
from tippetop.theory.steady import SteadyKind, jellett_of_launch, vertical_spin
from tippetop.theory.thresholds import critical_jellett, critical_spin, critical_spins, jellett_line

VERTICAL = [SteadyKind.UPRIGHT, SteadyKind.INVERTED]


def test_the_critical_spins_of_the_report():
    """Converged values for the launch at 0.1 rad and for a vertical one."""
    tilted = critical_spins(presets.report_problem())
    assert tilted.upright == pytest.approx(27.83840778639015, rel=1e-12)
    assert tilted.inverted == pytest.approx(77.2337102841416, rel=1e-12)
    vertical = critical_spins(presets.report_problem(tilt=0.0))
    assert vertical.upright == pytest.approx(27.63972766607055, rel=1e-12)
    assert vertical.inverted == pytest.approx(76.68250049622102, rel=1e-12)


@given(numbers(0.5, 2.0), numbers(0.02, 0.9))
def test_the_thresholds_are_the_closed_forms(gamma, alpha):
    top = sphere(gamma, alpha)
    unit, room_up, room_down = jellett_unit(top), alpha + gamma - 1.0, 1.0 + alpha - gamma
    assume(min(abs(room_up), abs(room_down)) > 1e-6)
    up = (1.0 - alpha) ** 2 / math.sqrt(room_up) if room_up > 0.0 else math.inf
    down = (1.0 + alpha) ** 2 / math.sqrt(room_down) if room_down > 0.0 else math.inf
    assert critical_jellett(SteadyKind.UPRIGHT, top) == pytest.approx(unit * up, rel=1e-9)
    assert critical_jellett(SteadyKind.INVERTED, top) == pytest.approx(unit * down, rel=1e-9)


@pytest.mark.parametrize("kind", VERTICAL)
@given(numbers(0.5, 2.0), numbers(0.05, 0.9), numbers(-3.0, 1.0))
def test_the_spectrum_of_a_sphere_changes_sign_at_the_threshold_whatever_the_friction(
    kind, gamma, alpha, logarithm
):
    top = sphere(gamma, alpha, mu=10.0**logarithm)
    assume(min(abs(alpha + gamma - 1.0), abs(1.0 + alpha - gamma)) > 1e-3)
    assert critical_spin_from_spectrum(kind, top) == pytest.approx(
        critical_spin(kind, top), rel=1e-9
    )


@given(tops(shapes=spheroids(), friction_laws=(ViscousLaw,)))
def test_the_spectrum_of_a_spheroid_changes_sign_at_the_threshold(top):
    unit = math.sqrt(top.gravity / top.surface.size)
    assume(abs(top.surface.along / top.surface.across - 1.0) > 0.05)
    assume(top.friction.mu * unit * top.surface.size > 1e-3)
    by_formula = critical_spin(SteadyKind.UPRIGHT, top)
    assume(by_formula == math.inf or by_formula < 1e3 * unit)
    assert critical_spin_from_spectrum(SteadyKind.UPRIGHT, top) == pytest.approx(
        by_formula, rel=1e-7
    )


def test_a_launch_with_a_precession_has_its_own_critical_spins():
    problem = presets.report_problem(tilt=0.4).replace(
        {"launch.precession": 12.0, "launch.tilt_rate": 3.0}
    )
    spins = critical_spins(problem)
    for spin, kind in ((spins.upright, SteadyKind.UPRIGHT), (spins.inverted, SteadyKind.INVERTED)):
        launched = jellett_of_launch(problem.replace({"launch.spin": spin}))
        assert launched == pytest.approx(critical_jellett(kind, top_of(problem)), rel=1e-12)


def test_a_launch_whose_spin_has_no_part_in_lambda_has_no_critical_spin():
    """Where cos(tilt) = alpha, the axial spin has no moment about the contact vector."""
    problem = presets.report_problem(tilt=1.2).replace({"body.shape.eccentricity": math.cos(1.2)})
    spins = critical_spins(problem)
    assert min(spins.upright, spins.inverted) > 1e12


def test_growth_rates_of_launches_vanish_at_their_critical_spins():
    problem = presets.report_problem()
    spins = critical_spins(problem)
    for kind, spin in zip(VERTICAL, (spins.upright, spins.inverted), strict=True):
        below, at, above = growth_rates_of_launches(
            kind, problem, spin * np.array([0.99, 1.0, 1.01])
        )
        assert abs(at) < 1e-10
        assert below * above < 0.0
        assert (below < 0.0) == (kind is SteadyKind.UPRIGHT)
    unit = vertical_spin(SteadyKind.UPRIGHT, top_of(problem), 1.0)
    vertical = jellett_line(problem).at(spins.upright) / unit.jellett
    assert vertical == pytest.approx(critical_spin(SteadyKind.UPRIGHT, top_of(problem)), rel=1e-13)


def test_a_finite_window_shows_the_upright_threshold_too_low_and_by_how_much():
    """At the apparent threshold a run of that length ends just visibly away from the vertical."""
    problem, window, visible = presets.report_problem(), 20.0, 0.005
    apparent = apparent_critical_spins(problem, window, visible)
    assert apparent.upright < critical_spins(problem).upright
    axis, _, _ = full_run(problem.replace({"launch.spin": apparent.upright}), [0.0, window])
    assert tilts_of(axis)[-1] == pytest.approx(visible, rel=0.03)
    assert apparent.upright == pytest.approx(26.3, abs=0.1)


def test_a_finite_window_shows_the_inverted_threshold_too_high_and_by_how_much_at_least():
    problem, window, visible = presets.report_problem(), 20.0, 0.005
    apparent = apparent_critical_spins(problem, window, visible)
    assert critical_spins(problem).inverted < apparent.inverted < 78.6
    axis, _, _ = full_run(problem.replace({"launch.spin": apparent.inverted}), [0.0, window])
    assert visible < math.pi - tilts_of(axis)[-1] < 2.5 * visible


@pytest.mark.parametrize(("window", "visible"), [(20.0, 0.0), (20.0, 0.2), (-1.0, 0.01)])
def test_impossible_windows_are_refused(window, visible):
    with pytest.raises(InvalidInput):
        apparent_critical_spins(presets.report_problem(), window, visible)


@pytest.mark.parametrize(
    "friction", [tt.ViscousFriction(mu=0.3), tt.ContensouFriction(mu=0.3, patch_radius=1e-4)]
)
def test_one_of_two_balls_on_top_of_the_other_never_stands_on_the_table(
    friction: tt.Friction,
) -> None:
    """Where they touch one another is the centre of mass: for the upper one, in the table."""
    balls = tt.presets.HURRICANE_BALLS
    for center in (balls.shapes[0].center, -balls.shapes[0].radius):
        ball = tt.Sphere(radius=balls.shapes[0].radius, center=center)
        problem = tt.Problem(
            body=balls.model_copy(update={"shape": ball}),
            friction=friction,
            launch=tt.Launch(tilt=0.1, spin=155.0),
        )
        assert tt.critical_spins(problem).inverted == math.inf
