"""The slow flow against full runs, against itself, and what it is the limit of."""

import math

import numpy as np
import pytest
from full_runs import full_run, sphere_problem, tilts_of
from scipy.integrate import solve_ivp

from campaigns import among
from tippetop import presets
from tippetop.mechanics.surfaces.surface import SphereSurface
from tippetop.mechanics.top import natural_units
from tippetop.problem.problem import top_of
from tippetop.support.errors import InvalidInput
from tippetop.theory.averaging import (
    arrival_time_limit,
    averaged_flow,
    local_exponent,
    nutation_of_launch,
)
from tippetop.theory.dissipation import amplitude_rates, mean_dissipation
from tippetop.theory.nutation import (
    Amplitudes,
    Constants,
    amplitudes,
    numbers_of,
    orbit,
    orbit_of_amplitudes,
    turned_orbit,
    turning_tilts,
)
from tippetop.theory.prediction import predict
from tippetop.theory.slow_time import time_to_end
from tippetop.theory.steady import jellett_of_launch

REPORT = presets.report_problem(spin=100.0)
LAUNCHES = [
    REPORT,
    presets.report_problem(spin=50.0),
    presets.report_problem(spin=20.0, tilt=0.5),
    presets.report_problem(spin=150.0, tilt=0.785),
    presets.report_problem(spin=-100.0, tilt=1.5),
    presets.report_problem(spin=100.0, tilt=2.5),
    presets.report_problem(spin=60.0, tilt=3.0).replace({"launch.precession": 4.0}),
    sphere_problem(1.5, 0.3, 0.2, 90.0),
    sphere_problem(0.6, 0.3, 0.3, 60.0),
    sphere_problem(0.97, 0.04, 2.7, -15.0),
]

SUBTLE = [
    sphere_problem(1.551, 0.277, 1.84, 48.7),
    sphere_problem(1.477, 0.372, 1.98, -48.7),
    sphere_problem(1.474, 0.06, 2.23, -8.5).replace(
        {"launch.tilt_rate": -3.7, "launch.precession": 15.4}
    ),
]
"""Launches whose nutation is still there at the end, and whose third root meets the other choice of
it.
"""


def arrival_time(problem, window, count):
    """First time a full run is within 0.01 rad of theta = pi, s, looked for in a window of time."""
    axis, _, _ = full_run(problem, np.concatenate([[0.0], np.linspace(*window, count)]))
    away = math.pi - tilts_of(axis)[1:] - 0.01
    times = np.linspace(*window, count)
    first = int(np.argmax(away < 0.0))
    assert first > 0
    share = away[first - 1] / (away[first - 1] - away[first])
    return times[first - 1] + share * (times[first] - times[first - 1])


def test_the_limit_of_the_flip_time_of_the_report():
    """mu t for mu -> 0, known to five digits from full runs."""
    assert arrival_time_limit(REPORT) == pytest.approx(2.3437, abs=6e-5)


@pytest.mark.parametrize("problem", [*LAUNCHES, *SUBTLE])
def test_the_time_in_plain_numbers_is_that_of_the_slow_flow(problem):
    """The same rates by another integrator, without a dense solution."""
    ends = predict(problem)
    if ends.is_certain:
        time = time_to_end(problem, ends.final.tilt, 0.01)
        assert time * problem.friction.mu == pytest.approx(arrival_time_limit(problem), rel=3e-4)


def test_no_time_is_told_where_the_slow_flow_does_not_hold():
    changes = [
        {"launch.tilt": 0.0},
        {"launch.gap": 0.01},
        {"friction.kind": "coulomb"},
        {"rolling_resistance": 1e-5},
        {"launch.spin": 1000.0},
    ]
    for change in changes:
        assert math.isnan(time_to_end(REPORT.replace(change), math.pi, 0.01)), change


def test_full_runs_approach_the_limit_quadratically():
    limit = arrival_time_limit(REPORT)
    excess = [
        mu * arrival_time(REPORT.replace({"friction.mu": mu}), (2.33 / mu, 2.37 / mu), 4001) / limit
        - 1.0
        for mu in (0.04, 0.02, 0.005)
    ]
    assert excess[2] == pytest.approx(0.0, abs=1e-5)
    assert excess[0] / excess[1] == pytest.approx(4.0, rel=0.1)


@pytest.mark.parametrize("problem", among(LAUNCHES[::2], check=3))
def test_the_tilt_of_a_full_run_with_little_friction_is_in_the_envelope_of_the_flow(problem):
    mu = 0.001
    flow = averaged_flow(problem)
    mu_times = np.linspace(0.0, min(flow.mu_time[-1], 3.0), 300)
    low, high = flow.tilts(mu_times)
    axis, _, _ = full_run(problem.replace({"friction.mu": mu}), mu_times / mu)
    tilts = tilts_of(axis)
    margin = 0.02
    assert np.all(tilts > low - margin)
    assert np.all(tilts < high + margin)


@pytest.mark.parametrize("mu", [0.3, 0.03, 0.003])
def test_the_tilt_as_a_function_of_mu_t_comes_closer_as_mu_falls(mu):
    flow = averaged_flow(REPORT)
    mu_times = np.linspace(0.6, 2.4, 50)
    axis, _, _ = full_run(
        REPORT.replace({"friction.mu": mu}), np.concatenate([[0.0], mu_times / mu])
    )
    error = np.abs(tilts_of(axis)[1:] - flow.tilts(mu_times)[0]).max()
    assert error < {0.3: 0.3, 0.03: 4e-3, 0.003: 1e-3}[mu]


@pytest.mark.parametrize("problem", LAUNCHES)
def test_the_flow_ends_in_the_predicted_state(problem):
    flow = averaged_flow(problem)
    assert flow.final_tilt in [state.tilt for state in predict(problem).reachable]
    assert np.all(np.diff(flow.mu_time) > 0.0)
    assert np.all(flow.tilt_low <= flow.tilt_high)
    last = np.array([flow.tilt_low[-1], flow.tilt_high[-1]])
    assert last == pytest.approx(flow.final_tilt, abs=2e-6)
    low, high = flow.tilts(np.array([0.0]))
    assert low[0] - 1e-9 <= problem.launch.tilt <= high[0] + 1e-9


@pytest.mark.parametrize("problem", [*LAUNCHES[1:3], *SUBTLE])
def test_the_flow_is_that_of_the_constants_of_the_smooth_table(problem):
    """L3 and the energy at constant lambda, without amplitudes, poles or a third root."""
    numbers, unit = numbers_of(top_of(problem)), float(natural_units(top_of(problem)).jellett)
    alpha, kept = numbers.alpha, jellett_of_launch(problem) / unit
    seen = nutation_of_launch(problem)
    begin = turned_orbit(seen.orbit, numbers.turned) if seen.turned else seen.orbit

    def path(y):
        return orbit(Constants(kept + alpha * y[0], y[0], y[1]), numbers)

    def rates(_, y):
        taken = mean_dissipation(path(y), numbers)
        return [taken.axial, taken.energy]

    mu_times = np.linspace(0.0, 0.999, 12) * arrival_time_limit(problem)
    energy = begin.swing + begin.axial**2 / (2.0 * numbers.axial) + 1.0 - alpha
    span = mu_times * problem.gravity
    start, settings = [begin.axial, energy], {"method": "DOP853", "rtol": 1e-11, "atol": 1e-11}
    found = solve_ivp(rates, (0.0, span[-1]), start, t_eval=span, **settings)
    exact = np.array([turning_tilts(amplitudes(path(y))) for y in found.y.T]).T
    flow = averaged_flow(problem, samples=4000)
    low, high = flow.tilts(mu_times)
    assert low + high == pytest.approx(exact[0] + exact[1], abs=1e-5)
    assert high - low == pytest.approx(
        exact[1] - exact[0], abs=1e-4
    )  # a small one is lost in rounding here
    final = predict(problem).final.tilt
    assert min(abs(exact[:, -1] - final)) == pytest.approx(0.01, abs=2e-4)


def test_a_launch_that_a_table_cannot_hold_is_refused():
    """Where it pulls it gives energy, and the nutation grows beyond all bounds."""
    problem = sphere_problem(0.6266, 0.558, 1.9427, 106.7)
    problem = problem.replace({"launch.tilt_rate": 5.0, "launch.precession": 11.2})
    for liftoff, reason in {
        "ignore": "does not decay in the time followed",
        "fly": "the table would have to pull",
    }.items():
        with pytest.raises(InvalidInput, match=f"{reason}.*only pushes"):
            arrival_time_limit(problem.replace({"contact.liftoff": liftoff}))


def test_a_launch_so_near_an_unstable_vertical_that_rounding_decides_is_refused_with_the_reason():
    """The third turning point is at the pole itself, and which side of it is told by the last
    digit.
    """
    launches = [
        REPORT.replace({"launch.tilt": math.pi - off, "launch.spin": 1.0}) for off in (1e-6, 1e-7)
    ]
    for launch in launches:
        with pytest.raises(
            InvalidInput, match=r"launch\.tilt.*unstable vertical.*rounding decides"
        ):
            arrival_time_limit(launch)


def test_the_size_of_the_friction_and_the_sense_of_the_spin_do_not_matter():
    limit = arrival_time_limit(REPORT)
    assert arrival_time_limit(REPORT.replace({"friction.mu": 7.0})) == limit
    assert arrival_time_limit(REPORT.replace({"launch.spin": -100.0})) == pytest.approx(
        limit, rel=1e-12
    )


@pytest.mark.parametrize("problem", among([*LAUNCHES, *SUBTLE], check=7))
def test_with_its_axis_drawn_the_other_way_a_top_does_the_same(problem):
    """The sphere's middle is below the centre of mass then, and what was upright is inverted."""
    shape, launch = problem.body.shape, problem.launch
    middle = shape.radius * shape.eccentricity
    flip = {"tilt": math.pi - launch.tilt, "tilt_rate": -launch.tilt_rate, "spin": -launch.spin}
    drawn = {"body.shape": {"kind": "sphere", "radius": shape.radius, "center": -middle}}
    other = problem.replace({**drawn, **{f"launch.{name}": value for name, value in flip.items()}})
    assert arrival_time_limit(other) == pytest.approx(arrival_time_limit(problem), rel=1e-6)
    flow, same = (averaged_flow(each, samples=2000) for each in (problem, other))
    assert same.final_tilt == pytest.approx(math.pi - flow.final_tilt, abs=1e-9)
    # Where it passes a vertical its least tilt has a corner, between samples.
    both = (
        (flow.mu_time < same.mu_time[-1])
        & (flow.tilt_low > 0.01)
        & (flow.tilt_high < math.pi - 0.01)
    )
    low, high = same.tilts(flow.mu_time[both])
    assert math.pi - high == pytest.approx(flow.tilt_low[both], abs=1e-4)
    assert math.pi - low == pytest.approx(flow.tilt_high[both], abs=1e-4)


def test_a_wide_nutation_that_reaches_the_end_counts():
    """Launched within 0.01 rad of its end, the top is there at once."""
    problem = presets.report_problem(spin=60.0, tilt=math.pi - 0.005)
    assert arrival_time_limit(problem) == 0.0
    swinging = problem.replace({"launch.tilt_rate": 6.0})
    assert averaged_flow(swinging).tilt_low[0] < math.pi - 0.02
    assert arrival_time_limit(swinging) == 0.0


@pytest.mark.parametrize(("spin", "tilt"), [(25.0, 0.1), (50.0, 1.0), (100.0, 1.0)])
def test_a_nutation_that_passes_the_end_on_its_way_counts(spin, tilt):
    problem, mu = presets.report_problem(spin=spin, tilt=tilt), 0.0005
    limit, end = arrival_time_limit(problem), predict(problem).final.tilt
    mu_times = np.linspace(0.0, 1.1 * limit, 40001)
    axis, _, _ = full_run(problem.replace({"friction.mu": mu}), mu_times / mu)
    near = np.abs(tilts_of(axis) - end) < 0.01
    assert near.any()
    assert mu_times[np.argmax(near)] == pytest.approx(limit, rel=0.01)


def launched(spin, tilt, tilt_rate=0.0):
    changes = {"launch.tilt_rate": tilt_rate, "contact.liftoff": "ignore"}
    return presets.report_problem(spin=spin, tilt=tilt).replace(changes)


@pytest.mark.parametrize(
    ("problem", "distance"),
    [
        (launched(50.0, 1.0), 1e-4),
        (launched(192.767, 1.8668, 8.508), 1e-3),
        *(
            (launched(spin, tilt, 15.0), 1e-3)
            for spin in (15.0, 60.0, 180.0)
            for tilt in (0.2, 1.5, 2.9)
        ),
    ],
)
def test_the_limit_is_the_first_time_near_the_end_however_short(problem, distance):
    flow = averaged_flow(problem, distance=distance, samples=50000)
    away = np.maximum(flow.tilt_low - flow.final_tilt, flow.final_tilt - flow.tilt_high)
    first = int(np.argmax(away <= distance * (1.0 + 1e-9)))
    limit = arrival_time_limit(problem, distance)
    assert flow.mu_time[max(first - 1, 0)] - 1e-12 <= limit <= flow.mu_time[first] + 1e-12


def test_a_nutation_that_dies_on_the_way_to_an_unstable_state_grows_again():
    """This launch drifts to theta = 0 first, which is unstable, and inverts only then."""
    problem = sphere_problem(0.58, 0.46, 0.7, 190.0)
    flow = averaged_flow(problem)
    assert flow.tilt_high.min() < 0.02
    assert flow.final_tilt == predict(problem).final.tilt == math.pi


@pytest.mark.parametrize("tilt", [0.3, 1.0, 1.7, 2.6])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_nutation_of_no_width_drifts_along_the_precessions_of_a_smooth_table(tilt, sign):
    """The amplitudes' rates against d L3 / d(mu t) of a precession that slips, fast or slow, at
    this tilt.
    """
    top = top_of(REPORT)
    numbers = numbers_of(top)
    across, along, alpha = numbers
    units = natural_units(top)
    kept = jellett_of_launch(REPORT) / (units.angular_momentum * units.length)

    def precession(c):
        square, weight = across * (1.0 - alpha * c), alpha * (c - alpha)
        rate = (kept + sign * math.sqrt(kept**2 + 4.0 * square * weight)) / (2.0 * square)
        return rate, across * c * rate - alpha / rate

    c, step = math.cos(tilt), 1e-6
    rate, momentum = precession(c)
    slope = (precession(c + step)[1] - precession(c - step)[1]) / (2.0 * step)
    speed = math.sin(tilt) * (momentum / along - rate * (c - alpha)) / slope

    amplitude = math.sin(tilt / 2.0) ** 2
    excess = (
        kept + (alpha - 1.0) * momentum
    )  # the fast one has L_z > L3, the slow one not necessarily
    tiny = 1e-9 * amplitude
    pair = Amplitudes(amplitude, tiny) if excess > 0.0 else Amplitudes(tiny, amplitude)
    root = abs(excess) / (2.0 * math.sqrt(2.0 * across * alpha) * amplitude)
    path = orbit_of_amplitudes(pair, root, kept, numbers)
    assert path.axial == pytest.approx(momentum, rel=1e-6)
    assert turning_tilts(pair)[0] == pytest.approx(tilt, abs=1e-3)
    rates = amplitude_rates(pair, root, kept, numbers)
    growth = rates.fast if excess > 0.0 else rates.slow
    assert math.tan(tilt / 2.0) * growth == pytest.approx(speed, rel=1e-5)


def test_the_local_exponent_of_a_power_law():
    mu = np.geomspace(0.01, 1.0, 20)
    assert local_exponent(mu, 2.0 / mu) == pytest.approx(-1.0, abs=1e-12)
    assert local_exponent(mu, 2.0 * mu**-0.985) == pytest.approx(-0.985, abs=1e-12)


@pytest.mark.parametrize(
    "changes",
    [
        {"body.shape": {"kind": "spheroid", "across": 0.02, "along": 0.03}},
        {"body.shape": {"kind": "sphere", "radius": 0.02, "center": 0.0}},
        {"friction": {"kind": "regularized_coulomb", "mu": 0.3, "eps": 0.01}},
        {"launch.tilt": 0.0},
        {"launch.tilt": math.pi},
    ],
)
def test_launches_without_a_slow_flow_are_refused(changes):
    with pytest.raises(InvalidInput):
        averaged_flow(REPORT.replace(changes))


@pytest.mark.parametrize(
    ("field", "value"),
    [
        *(("samples", samples) for samples in (0, -3, 1, 3.5, True, "many")),
        *(
            (field, value)
            for field in ("distance", "tolerance")
            for value in (0.0, -1e-3, math.nan)
        ),
    ],
)
def test_settings_that_cannot_be_are_refused(field, value):
    with pytest.raises(InvalidInput, match=f"{field}: .* is not a (whole|finite) number"):
        averaged_flow(REPORT, **{field: value})


def test_the_flow_needs_no_units():
    """Twice the radius, mass times 3: time goes as sqrt(R/g), mu as 1/sqrt(g R), so that mu t goes
    as 1/g.
    """
    body = REPORT.body
    larger = REPORT.replace(
        {
            "body.mass": 3.0 * body.mass,
            "body.shape.radius": 2.0 * body.shape.radius,
            "body.I1": 12.0 * body.I1,
            "body.I3": 12.0 * body.I3,
            "launch.spin": 100.0 * math.sqrt(1.5 / 2.0),
            "gravity": 1.5 * REPORT.gravity,
        }
    )
    assert isinstance(top_of(larger).surface, SphereSurface)
    assert arrival_time_limit(larger) == pytest.approx(arrival_time_limit(REPORT) / 1.5, rel=1e-9)
