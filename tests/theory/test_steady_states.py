"""Steady states: what the mechanics makes of them, closed forms, and the energy."""

import math
from functools import partial

import numpy as np
import pytest
from full_runs import all_spheres, jellett_unit
from hypothesis import assume, given

from strategies import numbers, spheroids, tops
from tippetop import presets
from tippetop.mechanics.invariants import energy, jellett
from tippetop.mechanics.motion import on_table, sliding_contact, sliding_rates
from tippetop.mechanics.vectors import cross, length
from tippetop.mechanics.view import Angles, state_from_angles
from tippetop.problem.problem import top_of
from tippetop.theory.derivatives import derivative
from tippetop.theory.steady import (
    SteadyKind,
    has_level_spin,
    jellett_of_launch,
    least_energy,
    level_spin,
    precession_branch,
    state_of,
    steady_states,
    vertical_spin,
)


def assert_steady(steady, top):
    """The state only turns about the vertical, without slip, and the table bears the weight."""
    state = state_of(steady, top)
    rates = sliding_rates(state, top)
    touch = sliding_contact(state.axis, state.momentum, state.velocity, top)
    weight = top.mass * top.gravity
    turning = (0.0, 0.0, steady.precession)
    unit = abs(steady.precession) + abs(steady.spin) + math.sqrt(top.gravity / top.surface.size)
    assert touch.slip == pytest.approx((0.0, 0.0), abs=1e-12 * unit * top.surface.size)
    assert touch.normal_force == pytest.approx(weight, rel=1e-9)
    assert rates.axis == pytest.approx(cross(turning, state.axis), abs=1e-11 * unit)
    moment = weight * top.surface.size + unit * length(state.momentum)
    assert rates.momentum == pytest.approx(cross(turning, state.momentum), abs=1e-9 * moment)
    assert rates.velocity == pytest.approx((0.0, 0.0), abs=1e-9 * top.gravity)


@given(all_spheres, numbers(-8.0, 8.0))
def test_all_steady_states_of_a_sphere_are_steady_and_have_the_integral_asked_for(top, size):
    kept = size * jellett_unit(top)
    for steady in steady_states(top, kept):
        assert_steady(steady, top)
        whole = on_table(state_of(steady, top), top)
        assert jellett(whole, top) == pytest.approx(kept, rel=1e-9, abs=1e-9 * jellett_unit(top))
        assert energy(whole, top) == pytest.approx(steady.energy, rel=1e-9)


@given(tops(shapes=spheroids()), numbers(0.2, 20.0))
def test_all_steady_states_of_a_spheroid_are_steady(top, size):
    assume(abs(top.surface.along / top.surface.across - 1.0) > 1e-3)
    unit = top.mass * math.sqrt(top.gravity * top.surface.size) * top.surface.size**2
    states = steady_states(top, size * unit)
    assert SteadyKind.LEVEL in {steady.kind for steady in states}
    for steady in states:
        assert_steady(steady, top)
        assert steady.jellett == pytest.approx(size * unit, rel=1e-9)


@given(all_spheres, numbers(0.05, 3.09))
def test_branch_of_a_sphere_is_the_closed_form(top, tilt):
    """phi'^2 = m g R alpha / (I1 c + I3 (alpha - c)), omega3 = phi' (c - alpha), lambda = ..."""
    radius, center = top.surface
    alpha = center / radius
    s, c = math.sin(tilt), math.cos(tilt)
    inertia = top.transverse_inertia * c + top.axial_inertia * (alpha - c)
    branch = precession_branch(top, np.array([tilt]))
    if inertia <= 0.0:
        assert np.isnan(branch.precession[0])
        return
    assume(inertia > 1e-3 * top.axial_inertia)
    rate = math.sqrt(top.mass * top.gravity * radius * alpha / inertia)
    around = top.transverse_inertia * s**2 + top.axial_inertia * (c - alpha) ** 2
    assert branch.precession[0] == pytest.approx(rate, rel=1e-11)
    assert branch.spin[0] == pytest.approx(rate * (c - alpha), rel=1e-11, abs=1e-12 * rate)
    assert branch.jellett[0] == pytest.approx(radius * rate * around, rel=1e-11)


@given(tops(), numbers(0.1, 3.0))
def test_every_precession_of_the_branch_is_found_from_its_integral(top, tilt):
    branch = precession_branch(top, np.array([tilt]))
    assume(np.isfinite(branch.jellett[0]) and abs(tilt - math.pi / 2) > 0.05)
    assume(not has_level_spin(top) or abs(top.surface.along / top.surface.across - 1.0) > 1e-3)
    unit = top.mass * math.sqrt(top.gravity * top.surface.size) * top.surface.size**2
    assume(1e-3 * unit < abs(branch.jellett[0]) < 1e3 * unit)
    found = [steady.tilt for steady in steady_states(top, float(branch.jellett[0]))]
    assert min(abs(other - tilt) for other in found) < 1e-5


def test_the_half_inverted_end_state_of_the_report():
    """Converged values of the final state of 50 rad/s, which the report quotes to four digits."""
    problem = presets.report_problem(spin=50.0)
    upright, half, inverted = steady_states(top_of(problem), jellett_of_launch(problem))
    assert (upright.kind, half.kind, inverted.kind) == (
        SteadyKind.UPRIGHT,
        SteadyKind.PRECESSION,
        SteadyKind.INVERTED,
    )
    assert half.tilt == pytest.approx(1.503553858228, abs=1e-11)
    assert half.precession == pytest.approx(35.254723275, abs=1e-8)
    assert half.spin == pytest.approx(-8.207588432, abs=1e-8)


def test_a_launch_at_rest_in_tilt_has_the_integral_of_its_spin():
    """lambda = R I3 omega0 (cos(theta0) - alpha)."""
    problem = presets.report_problem(spin=-70.0, tilt=0.6)
    body = problem.body
    kept = body.shape.radius * body.I3 * -70.0 * (math.cos(0.6) - 0.3)
    assert jellett_of_launch(problem) == pytest.approx(kept, rel=1e-13)


def test_without_jellett_integral_only_the_vertical_states_at_rest_are_left():
    top = top_of(presets.report_problem())
    assert [(steady.kind, steady.spin) for steady in steady_states(top, 0.0)] == [
        (SteadyKind.UPRIGHT, 0.0),
        (SteadyKind.INVERTED, 0.0),
    ]


@given(tops(), numbers(-3.0, 3.0))
def test_named_spins_are_steady(top, rate):
    spin = rate * math.sqrt(top.gravity / top.surface.size)
    assert_steady(vertical_spin(SteadyKind.UPRIGHT, top, spin), top)
    assert_steady(vertical_spin(SteadyKind.INVERTED, top, spin), top)
    if has_level_spin(top):
        assert_steady(level_spin(top, spin), top)


@given(all_spheres, numbers(0.3, 6.0))
def test_steady_states_are_where_the_least_energy_is_stationary(top, size):
    kept = size * jellett_unit(top)
    for steady in steady_states(top, kept):
        assert least_energy(steady.tilt, kept, top, math) == pytest.approx(steady.energy, rel=1e-11)
        slope = derivative(partial(least_energy, jellett=kept, top=top, functions=np), steady.tilt)
        assert slope == pytest.approx(0.0, abs=1e-8 * steady.energy)


@given(
    all_spheres, numbers(0.1, 3.0), numbers(-30.0, 30.0), numbers(-30.0, 30.0), numbers(-30.0, 30.0)
)
def test_no_motion_has_less_than_the_least_energy(top, tilt, tilt_rate, precession, spin):
    state = state_from_angles(Angles(tilt, tilt_rate, 0.0, precession, spin, (0.0, 0.0)), top, math)
    whole = on_table(state._replace(velocity=(0.0, 0.0)), top)
    least = least_energy(tilt, jellett(whole, top), top, math)
    assert energy(whole, top) >= least * (1.0 - 1e-13)
