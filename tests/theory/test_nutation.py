"""The nutation of a smooth table and what friction takes from it, against runs and the mechanics
itself.
"""

import math

import numpy as np
import pytest
from full_runs import full_run, sphere_problem, tilts_of
from hypothesis import assume, given

from strategies import numbers
from tippetop import presets
from tippetop.mechanics.laws.friction import ViscousLaw
from tippetop.mechanics.motion import sliding_contact, sliding_rates
from tippetop.mechanics.state import SlidingState
from tippetop.mechanics.surfaces.surface import SpheroidSurface
from tippetop.mechanics.top import natural_units
from tippetop.mechanics.vectors import dot
from tippetop.problem.problem import top_of
from tippetop.support.errors import InvalidInput
from tippetop.theory.derivatives import jacobian
from tippetop.theory.diagnostics import smooth_constants
from tippetop.theory.dissipation import amplitude_rates, mean_dissipation
from tippetop.theory.nutation import (
    Amplitudes,
    Constants,
    amplitudes,
    constants,
    effective_potential,
    natural_constants,
    numbers_of,
    orbit,
    orbit_of_amplitudes,
    turned_orbit,
    turning_tilts,
)

LAUNCHES = [
    presets.report_problem(spin=100.0, tilt=0.1),
    presets.report_problem(spin=60.0, tilt=1.0).replace({"launch.tilt_rate": 20.0}),
    presets.report_problem(spin=-80.0, tilt=2.0).replace({"launch.precession": 15.0}),
    sphere_problem(1.4, 0.15, 2.6, 90.0),
]


def natural(problem):
    top, start = top_of(problem), problem.start()
    return natural_constants(constants(start.axis, start.momentum, top), top), numbers_of(top)


def path_of(problem):
    values, numbers_ = natural(problem)
    return orbit(values, numbers_), numbers_


@pytest.mark.parametrize("problem", LAUNCHES)
def test_turning_tilts_are_the_extremes_of_a_run_on_a_smooth_table(problem):
    axis, momentum, _ = full_run(problem, np.linspace(0.0, 2.0, 40001), smooth=True)
    tilts = tilts_of(axis)
    low, high = turning_tilts(amplitudes(path_of(problem)[0]))
    assert tilts.min() == pytest.approx(low, abs=1e-4)
    assert tilts.max() == pytest.approx(high, abs=1e-4)
    assert tilts.min() > low - 1e-9
    assert tilts.max() < high + 1e-9
    kept = smooth_constants(axis, momentum, top_of(problem))
    for values in kept:
        assert np.ptp(values) < 1e-11 * np.abs(values).max()


@pytest.mark.parametrize("problem", LAUNCHES)
def test_at_the_turning_tilts_the_effective_potential_is_the_energy(problem):
    start = problem.start()
    values = constants(start.axis, start.momentum, top_of(problem))
    for tilt in turning_tilts(amplitudes(path_of(problem)[0])):
        assert effective_potential(tilt, values, top_of(problem), math) == pytest.approx(
            values.energy, rel=1e-9
        )


@pytest.mark.parametrize("problem", LAUNCHES)
def test_friction_takes_from_a_nutation_what_the_mechanics_says_on_average(problem):
    """Averaged over a run on a smooth table: the derivative of the mechanics' rates by mu, at mu =
    0.
    """
    top = top_of(problem)
    # A window that is smooth at its ends averages a periodic function fast, whatever its period.
    times = np.linspace(0.0, 12.0, 60001)
    phase = np.clip(times / times[-1], 1e-12, 1.0 - 1e-12)
    window = np.exp(-1.0 / (phase * (1.0 - phase)))
    axis, momentum, _ = full_run(problem, times, smooth=True)
    zero = np.zeros_like(times)
    state = SlidingState(tuple(axis.T), tuple(momentum.T), (zero, zero))

    def taken_by(point):
        rough = top.altered(friction=ViscousLaw(point[0]))
        return dot(sliding_rates(state, rough).momentum, state.axis), sliding_contact(
            *state, rough
        ).power

    torque, power = jacobian(taken_by, [zero])[..., 0].T
    units = natural_units(top)
    taken = mean_dissipation(*path_of(problem))
    expected = np.array([torque @ window, power @ window]) / window.sum()
    per_friction = 1.0 / (units.speed * units.time)
    found = (
        per_friction
        * np.array([taken.axial * units.angular_momentum, taken.energy * units.energy])
        * units.speed**2
    )
    assert found == pytest.approx(expected, rel=1e-6)


@given(
    numbers(0.5, 1.9),
    numbers(0.05, 0.6),
    numbers(0.02, 3.1),
    numbers(-8.0, 8.0),
    numbers(-5.0, 5.0),
    numbers(-5.0, 5.0),
)
def test_the_orbit_is_that_of_its_constants(gamma, alpha, tilt, spin, tilt_rate, precession):
    """The cubic has the three roots, and the amplitudes give the orbit back."""
    unit = math.sqrt(9.8 / 0.02)
    problem = sphere_problem(gamma, alpha, tilt, spin * unit).replace(
        {"launch.tilt_rate": tilt_rate * unit, "launch.precession": precession * unit}
    )
    values, numbers_ = natural(problem)
    path = orbit(values, numbers_)
    kept = values.vertical - alpha * values.axial
    assume(abs(kept) > 0.01 and path.half > 1e-4 and path.far - path.middle - path.half > 1e-2)
    size = path.far**3 * alpha + path.far * (abs(path.axial) + abs(path.excess)) ** 2
    for p in (path.middle - path.half, path.middle + path.half, path.far):
        room = p * (2.0 - p) * (path.swing - alpha * p)
        about = (path.excess + path.axial * p) ** 2 / (2.0 * numbers_.transverse)
        assert room - about == pytest.approx(0.0, abs=1e-11 * size)
    low, high = turning_tilts(amplitudes(path))
    assert low - 1e-6 <= tilt <= high + 1e-6

    for seen, view in ((path, numbers_), (turned_orbit(path, numbers_), numbers_.turned)):
        pair = Amplitudes(*map(float, amplitudes(seen)))
        again = orbit_of_amplitudes(pair, math.sqrt(abs(seen.far)), kept, view)
        assert tuple(again) == pytest.approx(tuple(seen), rel=1e-6, abs=1e-6)


@pytest.mark.parametrize("problem", LAUNCHES)
def test_upside_down_the_nutation_is_the_same(problem):
    path, numbers_ = path_of(problem)
    turned, view = turned_orbit(path, numbers_), numbers_.turned
    low, high = turning_tilts(amplitudes(path))
    low_seen, high_seen = turning_tilts(amplitudes(turned))
    assert (math.pi - high_seen, math.pi - low_seen) == pytest.approx((low, high), abs=1e-9)
    taken, seen = mean_dissipation(path, numbers_), mean_dissipation(turned, view)
    assert (-seen.axial, seen.energy) == pytest.approx(tuple(taken), rel=1e-9)
    back = turned_orbit(turned, view)
    assert tuple(back) == pytest.approx(tuple(path), rel=1e-12)


@pytest.mark.parametrize("problem", LAUNCHES)
@pytest.mark.parametrize("turned", [False, True])
def test_a_root_that_is_a_little_wrong_is_put_right(problem, turned):
    values, numbers_ = natural(problem)
    kept = values.vertical - numbers_.alpha * values.axial
    path = orbit(values, numbers_)
    seen, view = (turned_orbit(path, numbers_), numbers_.turned) if turned else (path, numbers_)
    pair, root = Amplitudes(*map(float, amplitudes(seen))), math.sqrt(abs(seen.far))
    again = orbit_of_amplitudes(pair, root * (1.0 + 1e-4), kept, view)
    assert tuple(again) == pytest.approx(tuple(seen), rel=1e-8)


@pytest.mark.parametrize("problem", LAUNCHES)
@pytest.mark.parametrize("turned", [False, True])
def test_the_amplitudes_change_as_the_constants_do(problem, turned):
    """The rates of the amplitudes against the amplitudes of constants after a little friction."""
    values, numbers_ = natural(problem)
    kept = values.vertical - numbers_.alpha * values.axial
    taken = mean_dissipation(orbit(values, numbers_), numbers_)
    step = 1e-5

    def amplitudes_after(time):
        axial = values.axial + time * taken.axial
        later = Constants(kept + numbers_.alpha * axial, axial, values.energy + time * taken.energy)
        path = orbit(later, numbers_)
        seen, view = (turned_orbit(path, numbers_), numbers_.turned) if turned else (path, numbers_)
        return [*map(float, amplitudes(seen)), math.sqrt(abs(seen.far))], view

    before, view = amplitudes_after(-step)
    now, _ = amplitudes_after(0.0)
    after, _ = amplitudes_after(step)
    rates = amplitude_rates(Amplitudes(*now[:2]), now[2], kept, view)
    slopes = [(b - a) / (2.0 * step) for a, b in zip(before, after, strict=True)]
    assert rates.fast * now[0] == pytest.approx(slopes[0], rel=1e-4, abs=1e-7)
    assert rates.slow * now[1] == pytest.approx(slopes[1], rel=1e-4, abs=1e-7)
    assert rates.root == pytest.approx(slopes[2], rel=1e-4, abs=1e-6)


def test_other_shapes_are_refused():
    with pytest.raises(InvalidInput, match="eccentric sphere"):
        numbers_of(top_of(LAUNCHES[0]).altered(surface=SpheroidSurface(0.02, 0.03)))
