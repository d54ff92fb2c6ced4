"""Diagnostics of runs: gyroscopic balance, effective potential, envelope of the nutation."""

import math

import numpy as np
import pytest
from full_runs import full_run, tilts_of

from tippetop import presets
from tippetop.mechanics.laws.friction import ViscousLaw
from tippetop.mechanics.surfaces.surface import SpheroidSurface
from tippetop.mechanics.view import Angles, state_from_angles
from tippetop.problem.problem import top_of
from tippetop.support.errors import InvalidInput
from tippetop.theory.diagnostics import (
    gyroscopic_balance,
    nutation_envelope,
    potential_at,
    smooth_constants,
)
from tippetop.theory.steady import precession_branch

PROBLEM = presets.report_problem(spin=100.0)


def test_gyroscopic_balance_is_that_of_the_angles():
    top = top_of(PROBLEM)
    tilts, spins = np.array([0.3, 1.0, 2.5]), np.array([50.0, 3.0, -80.0])
    rates = np.array([5.0, -20.0, 40.0])
    state = state_from_angles(Angles(tilts, 7.0, 0.4, rates, spins, (0.0, 0.0)), top, np)
    axis, momentum = np.stack(state.axis, axis=1), np.stack(state.momentum, axis=1)
    expected = top.transverse_inertia * rates * np.cos(tilts) - top.axial_inertia * spins
    assert gyroscopic_balance(axis, momentum, top) == pytest.approx(expected, rel=1e-12)


def test_a_vertical_axis_has_no_gyroscopic_balance():
    top = top_of(PROBLEM)
    axis, momentum = np.array([[0.0, 0.0, 1.0]]), np.array([[0.0, 0.0, 1e-4]])
    assert np.isnan(gyroscopic_balance(axis, momentum, top)[0])


def test_a_spinning_top_that_turns_over_is_in_gyroscopic_balance_on_the_way():
    """xi over I3 times the initial spin is small while the tilt is between 0.5 and 2.5 rad."""
    axis, momentum, _ = full_run(PROBLEM, np.linspace(0.0, 8.0, 801))
    tilts = tilts_of(axis)
    balance = gyroscopic_balance(axis, momentum, top_of(PROBLEM)) / (
        top_of(PROBLEM).axial_inertia * 100.0
    )
    turning = (tilts > 0.5) & (tilts < 2.5)
    assert turning.sum() > 20
    assert np.abs(balance[turning]).max() < 0.25


def test_the_envelope_encloses_every_run_and_is_constant_on_a_smooth_table():
    times = np.linspace(0.0, 6.0, 601)
    axis, momentum, _ = full_run(PROBLEM, times)
    tilts, (low, high) = tilts_of(axis), nutation_envelope(axis, momentum, top_of(PROBLEM))
    assert np.all(tilts > low - 1e-6)
    assert np.all(tilts < high + 1e-6)

    axis, momentum, _ = full_run(PROBLEM, times, smooth=True)
    low, high = nutation_envelope(axis, momentum, top_of(PROBLEM).altered(friction=ViscousLaw(0.0)))
    assert np.ptp(low) < 1e-9
    assert np.ptp(high) < 1e-9


def test_a_steady_precession_has_no_nutation_and_is_the_bottom_of_its_potential():
    top = top_of(PROBLEM)
    branch = precession_branch(top, np.array([1.2]))
    angles = Angles(1.2, 0.0, 0.0, float(branch.precession[0]), float(branch.spin[0]), (0.0, 0.0))
    state = state_from_angles(angles, top, math)
    axis, momentum = np.array([state.axis]), np.array([state.momentum])
    low, high = nutation_envelope(axis, momentum, top)
    assert (low[0], high[0]) == pytest.approx((1.2, 1.2), abs=1e-6)
    tilts = np.linspace(0.2, 3.0, 2801)
    potential = potential_at(0, axis, momentum, top, tilts)
    assert tilts[np.argmin(potential)] == pytest.approx(1.2, abs=1e-3)
    assert potential.min() == pytest.approx(
        smooth_constants(axis, momentum, top).energy[0], rel=1e-6
    )


def test_other_shapes_have_no_envelope():
    top = top_of(PROBLEM).altered(surface=SpheroidSurface(0.02, 0.03))
    with pytest.raises(InvalidInput):
        nutation_envelope(np.array([[0.1, 0.0, 0.99]]), np.array([[0.0, 0.0, 1e-4]]), top)
