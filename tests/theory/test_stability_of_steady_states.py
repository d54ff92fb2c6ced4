"""Spectra of the steady states against the published equations, the energy, and full runs."""

import math

import numpy as np
import pytest
from full_runs import all_spheres, full_run, jellett_unit, sphere, tilts_of
from hypothesis import assume, given

from strategies import numbers, spheroids, tops
from tippetop import presets
from tippetop.mechanics.euler import published_rates
from tippetop.mechanics.laws.friction import ViscousLaw
from tippetop.mechanics.motion import along_table
from tippetop.problem.problem import top_of
from tippetop.theory.derivatives import jacobian
from tippetop.theory.prediction import stable_by_energy
from tippetop.theory.stability import (
    eigenvalues,
    linear_tilts,
    spectrum,
    vertical_growth_rates,
)
from tippetop.theory.steady import (
    SteadyKind,
    level_spin,
    precession_branch,
    steady_states,
    vertical_spin,
)


def assert_same_numbers(one, other, tolerance):
    """Equal as sets, up to rounding: each number has a partner in the other set."""
    assert len(one) == len(other)
    left = list(other)
    for number in one:
        nearest = min(left, key=lambda candidate: abs(candidate - number))
        assert abs(nearest - number) < tolerance
        left.remove(nearest)


def test_the_upright_spin_at_100_rad_per_s():
    """Known to six digits, in a frame at rest."""
    top = top_of(presets.report_problem(mu=0.3))
    found = spectrum(vertical_spin(SteadyKind.UPRIGHT, top, 100.0), top)
    assert found.frame_rate == 0.0
    assert found.unstable
    assert found.growth_rate == pytest.approx(1.089027, abs=5e-7)
    fast = found.eigenvalues[np.argmax(found.eigenvalues.imag)]
    assert fast == pytest.approx(1.089027 + 110.50298j, abs=5e-6)


@given(all_spheres, numbers(0.1, 3.0))
def test_the_spectrum_of_a_precession_is_that_of_the_published_equations(top, tilt):
    """In Euler angles the azimuth drops out by itself, and a precession is an equilibrium of the
    rest.
    """
    branch = precession_branch(top, np.array([tilt]))
    assume(np.isfinite(branch.precession[0]) and branch.precession[0] < 300.0)
    ours = eigenvalues(branch, top)[0]
    y = [tilt, 0.0, 0.0, branch.precession[0], branch.spin[0], 0.0, 0.0]
    matrix = jacobian(lambda t: published_rates(t, top, np), y)
    without_azimuth = np.delete(np.delete(matrix, 2, axis=0), 2, axis=1)
    published = np.linalg.eigvals(without_azimuth)
    scale = np.abs(published).max()
    neutral = np.argmin(np.abs(published))
    assert abs(published[neutral]) < 1e-9 * scale
    # Eigenvalues close to another, or to the neutral one, are ill-conditioned.
    rest = np.delete(published, neutral)
    spread = np.abs(published[:, None] - published[None, :]) + np.eye(len(published)) * scale
    assume(spread.min() > 1e-3 * scale)
    assert_same_numbers(ours, rest, 1e-9 * scale)


@given(all_spheres, numbers(0.2, 8.0))
def test_stable_is_what_has_least_energy(top, size):
    """Friction takes energy and leaves lambda: minima are stable, whatever mu, and nothing else
    is.
    """
    states = steady_states(top, size * jellett_unit(top))
    minima = stable_by_energy(states)
    for steady in states:
        found = spectrum(steady, top)
        assume(abs(found.growth_rate) > 1e-9 * np.abs(found.eigenvalues).max())
        assert found.stable == (steady in minima)
        assert found.unstable != found.stable


def test_without_friction_nothing_decays():
    top = top_of(presets.report_problem()).altered(friction=ViscousLaw(0.0))
    for steady in steady_states(top, 1.8 * jellett_unit(top)):
        assert not spectrum(steady, top).stable


@given(tops(friction_laws=(ViscousLaw,)), numbers(-5.0, 5.0), numbers(-5.0, 5.0))
def test_a_turning_frame_shifts_the_frequencies_of_a_vertical_spin(top, spin, frame):
    unit = math.sqrt(top.gravity / top.surface.size)
    steady = vertical_spin(SteadyKind.INVERTED, top, spin * unit)
    still = spectrum(steady, top).eigenvalues
    turning = spectrum(steady, top, frame_rate=frame * unit)
    shift = 1j * frame * unit
    scale = np.abs(still).max() + abs(shift)
    for number in turning.eigenvalues:
        assert (
            min(np.abs(still - shift - number).min(), np.abs(still + shift - number).min())
            < 1e-4 * scale
        )
    assert turning.frame_rate == frame * unit


def test_mirrored_precessions_have_the_same_spectrum():
    top = top_of(presets.report_problem())
    kept = 1.8 * jellett_unit(top)
    _, one, _ = steady_states(top, kept)
    _, other, _ = steady_states(top, -kept)
    assert other.precession == pytest.approx(-one.precession, rel=1e-13)
    first, second = spectrum(one, top).eigenvalues, spectrum(other, top).eigenvalues
    assert_same_numbers(first, second, 1e-9 * np.abs(first).max())


@given(tops(shapes=spheroids(), friction_laws=(ViscousLaw,)), numbers(0.5, 20.0))
def test_a_level_spin_has_two_neutral_directions(top, rate):
    steady = level_spin(top, rate * math.sqrt(top.gravity / top.surface.size))
    found = spectrum(steady, top)
    assert len(found.eigenvalues) + len(found.neutral) == 7


@pytest.mark.parametrize("kind", [SteadyKind.UPRIGHT, SteadyKind.INVERTED])
def test_many_spins_give_the_spectra_of_each(kind):
    top = sphere(0.9, 0.3)
    spins = np.array([-20.0, 5.0, 60.0])
    together = eigenvalues(vertical_spin(kind, top, spins), top)
    for row, spin in zip(together, spins, strict=True):
        alone = spectrum(vertical_spin(kind, top, spin), top).eigenvalues
        assert_same_numbers(row, alone, 1e-10 * np.abs(alone).max())
    assert vertical_growth_rates(kind, top, spins) == pytest.approx(together.real.max(axis=1))


def test_the_spin_of_a_real_run_grows_as_the_linear_motion_says():
    """A launch at 1e-6 rad from the upright spin, followed for 6 s."""
    problem = presets.report_problem(spin=100.0, tilt=1e-6)
    top = top_of(problem)
    times = np.array([0.0, 0.5, 2.0, 4.0, 6.0])
    axis, _, _ = full_run(problem, times)
    linear = linear_tilts(
        vertical_spin(SteadyKind.UPRIGHT, top, 100.0), top, along_table(problem.start()), times
    )
    assert linear == pytest.approx(tilts_of(axis), rel=1e-6)
