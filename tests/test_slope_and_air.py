"""Runs on a slope and in air, against closed solutions, balances and another formulation."""

import math
from itertools import product

import numpy as np
import pytest
from scipy.interpolate import make_interp_spline

import tippetop as tt
from campaigns import among
from tippetop.export.raycast import view_of
from tippetop.mechanics.field import STILL

G, R, MASS, MU = 9.8, 0.02, 0.1, 0.3
BALL = tt.Body(
    mass=MASS,
    shape=tt.Sphere(radius=R, center=0.0),
    I1=0.4 * MASS * R**2,
    I3=0.4 * MASS * R**2,
)
STEEPEST_ROLLING = math.atan(3.5 * MU)
"""Slope, rad, beyond which a ball slips: it needs the friction 2/7 g sin(slope) to roll."""


def released(slope, azimuth=0.7, **others):
    return tt.Problem(
        body=BALL,
        friction=tt.CoulombFriction(mu=MU),
        launch=tt.Launch(tilt=0.3, spin=0.0),
        table=tt.Table(slope=slope, azimuth=azimuth),
        **others,
    )


@pytest.mark.parametrize("slope", [1e-3, 0.1, STEEPEST_ROLLING - 1e-6])
def test_ball_rolls_down_with_five_sevenths(slope):
    run = tt.simulate(released(slope), duration=1.0)
    x, y, up = run["velocity"].values[-1]
    assert set(run["mode"].values.tolist()) == {"sticking"}
    assert math.hypot(x, y) == pytest.approx(5.0 / 7.0 * G * math.sin(slope), rel=1e-12)
    assert math.atan2(y, x) == pytest.approx(0.7, abs=1e-12)
    assert math.hypot(run["x"][-1], run["y"][-1]) == pytest.approx(
        5.0 / 14.0 * G * math.sin(slope), rel=1e-12
    )
    assert up == 0.0
    assert float(run["energy_error"]) < 1e-12
    assert float(run["descent"]) == pytest.approx(5.0 / 14.0 * G * math.sin(slope), rel=1e-12)


def test_the_account_says_how_far_it_went_down_the_slope():
    """A ball that slips from rest is 0.5 a t^2 further down."""
    slope, time = 1.0, 2.0
    run = tt.simulate(released(slope), duration=time, samples=2)
    way = 0.5 * G * (math.sin(slope) - MU * math.cos(slope)) * time**2
    (clause,) = [one for one in tt.describe(run).clauses if one.name == "has_descended"]
    assert clause.numbers["distance"] == pytest.approx(way, rel=1e-12)
    assert f"has moved {way:.3g} m down the slope" in str(tt.describe(run))
    uphill = released(slope).replace({"launch.velocity": (-math.cos(0.7), -math.sin(0.7), 0.0)})
    climbed = tt.simulate(uphill, duration=0.05, samples=2)
    assert float(climbed["descent"]) < 0.0
    assert "mm up the slope" in str(tt.describe(climbed))


@pytest.mark.parametrize("slope", [STEEPEST_ROLLING + 1e-6, 1.0, 1.5])
def test_ball_on_a_steeper_slope_slips(slope):
    run = tt.simulate(released(slope), duration=0.5)
    acceleration = G * (math.sin(slope) - MU * math.cos(slope))
    assert math.hypot(*run["velocity"].values[-1]) == pytest.approx(0.5 * acceleration, rel=1e-12)
    turning = 2.5 * MU * G * math.cos(slope) / R
    assert math.hypot(*run["angular_velocity"].values[-1]) == pytest.approx(
        0.5 * turning, rel=1e-11
    )
    assert float(run["energy_error"]) < 1e-12


def test_rolling_ball_on_a_slope_moves_like_a_projectile():
    launch = tt.Launch(tilt=0.3, spin=80.0, velocity=(0.2, -0.3))
    run = tt.simulate(released(0.05, azimuth=0.0).replace({"launch": launch.model_dump()}), 2.0)
    rolls = run.isel(time=run["time"].values > float(run["event_time"][0]))
    first, last = rolls.isel(time=0), rolls.isel(time=-1)
    passed = float(last["time"] - first["time"])
    change = (last["velocity"] - first["velocity"]).values
    expected = (5.0 / 7.0 * G * math.sin(0.05) * passed, 0.0, 0.0)
    assert change == pytest.approx(expected, abs=1e-12)


def test_azimuth_turns_the_motion():
    problem = tt.presets.report_problem(spin=155.0).replace({"table.slope": "3 deg"})
    run = tt.simulate(problem, duration=1.0)
    turn = 0.9
    turned = problem.replace({"table.azimuth": turn, "launch.azimuth": turn})
    other = tt.simulate(turned, duration=1.0)
    x, y = run["x"].values[-1], run["y"].values[-1]
    cosine, sine = math.cos(turn), math.sin(turn)
    assert float(other["x"][-1]) == pytest.approx(cosine * x - sine * y, rel=1e-8)
    assert float(other["y"][-1]) == pytest.approx(sine * x + cosine * y, rel=1e-8)
    assert float(other["tilt"][-1]) == pytest.approx(float(run["tilt"][-1]), rel=1e-8)


AIR = {
    "air.axial_linear": 4e-7,
    "air.axial_quadratic": 2e-9,
    "air.transverse_linear": 3e-7,
    "air.transverse_quadratic": 1e-9,
    "air.drag_linear": 2e-3,
    "air.drag_quadratic": 1e-2,
}
SLOPE = {"table.slope": 0.04, "table.azimuth": 2.0}


def bodies():
    """Launches whose contact slips, sticks, rolls against resistance, flies and strikes."""
    report = tt.presets.report_problem(spin=155.0)
    dry = report.replace({"friction.kind": "coulomb", "friction.mu": 0.2})
    patch = report.replace(
        {"friction.kind": "contensou", "friction.mu": 0.3, "friction.patch_radius": 5e-4}
    )
    resisted = dry.replace({"rolling_resistance": 1e-5})
    dropped = dry.replace({"launch.gap": 0.01, "launch.tilt": 0.7, "contact.restitution": 0.5})
    return {
        "viscous": report,
        "dry": dry,
        "patch": patch,
        "rolling resistance": resisted,
        "dropped": dropped,
    }


@pytest.mark.parametrize(
    ("name", "field"), among(list(product(bodies(), (SLOPE, AIR, SLOPE | AIR))), check=8)
)
def test_energy_and_work_balance(name, field):
    problem = bodies()[name].replace(field)
    run = tt.simulate(problem, duration=1.5)
    assert run.attrs["status"] == "completed"
    assert float(run["energy_error"]) < 1e-12
    parts = ("sliding", "drilling", "rolling", "air", "impacts")
    lost = sum(float(run[f"energy_lost_{part}"]) for part in parts)
    assert float(run["energy_lost"]) == pytest.approx(lost, rel=1e-12)
    change = float(run["energy"][0] - run["energy"][-1])
    assert float(run["energy_lost"]) == pytest.approx(change, rel=1e-11)
    assert (float(run["energy_lost_air"]) > 0.0) == (field is not SLOPE)


def test_energy_counts_the_way_down():
    problem = released(0.1)
    run = tt.simulate(problem, duration=1.0)
    kinetic = run["energy_translation"] + run["energy_spin"] + run["energy_turning"]
    way = run["x"] * math.cos(0.7) + run["y"] * math.sin(0.7)
    expected = kinetic + MASS * G * (math.cos(0.1) * R - math.sin(0.1) * way)
    assert run["energy"].values == pytest.approx(expected.values, rel=1e-12)
    assert float(run["energy_lost"]) == pytest.approx(0.0, abs=1e-15)


def test_jellett_is_constant_on_a_slope():
    for name in ("viscous", "dry"):
        run = tt.simulate(bodies()[name].replace(SLOPE), duration=2.0)
        assert float(run["jellett_drift"]) < 1e-12


@pytest.mark.parametrize("name", ["viscous", "dry", "dropped"])
def test_jellett_loses_the_moment_of_air(name):
    problem = bodies()[name].replace(AIR).replace({"contact.restitution": 0.0})
    run = tt.simulate(problem, duration=1.0, samples=4001)
    arm = -(run["height"].values - run["gap"].values)
    axis, turning = run["axis"].values, run["angular_velocity"].values
    eccentric = problem.body.shape.eccentricity * R
    contact = eccentric * axis - R * np.array([0.0, 0.0, 1.0])
    assert contact[:, 2] == pytest.approx(arm, abs=1e-14)
    spin = run["spin"].values[:, None]
    across = turning - spin * axis
    speed = np.linalg.norm(across, axis=1)[:, None]
    couple = -(4e-7 + 2e-9 * abs(spin)) * spin * axis - (3e-7 + 1e-9 * speed) * across
    rate = -(couple * contact).sum(axis=1)
    events = run["event_time"].values
    last = float(events[-1]) if len(events) else 0.0
    late = run["time"].values >= last
    times, jellett = run["time"].values[late], run["jellett"].values[late]
    lost = make_interp_spline(times, rate[late], k=9).antiderivative()
    change = lost(times) - lost(times[0])
    assert jellett - jellett[0] == pytest.approx(change, abs=1e-11 * abs(jellett[0]))


def thrown(air, **launch):
    return tt.Problem(
        body=tt.presets.REPORT,
        friction=tt.CoulombFriction(mu=MU),
        launch=tt.Launch(gap=1000.0, **launch),
        air=air,
    )


@pytest.mark.parametrize("tilt", [0.0, 0.8])
@pytest.mark.parametrize(("linear", "quadratic"), [(4e-7, 0.0), (0.0, 5e-9), (4e-7, 5e-9)])
def test_spin_in_flight_decays_as_air_alone_has_it(tilt, linear, quadratic):
    # I3 w' = -(a + b sqrt(w^2 + e^2)) w, whatever the axis does. With w = e / sinh(x) that is
    # I3 x' = a tanh(x) + b e.
    air = tt.Air(axial_linear=linear, axial_quadratic=quadratic)
    run = tt.simulate(thrown(air, tilt=tilt, spin=300.0, tilt_rate=20.0), duration=4.0)
    time, I3 = run["time"].values, tt.presets.REPORT.I3
    a, b, start, e = linear, quadratic, 300.0, STILL / math.sqrt(R / G)
    spin = run["spin"].values
    if not b:
        assert spin == pytest.approx(start * np.exp(-a * time / I3), rel=1e-12)
    elif not a:
        x = np.arcsinh(e / start) + b * e * time / I3
        assert spin == pytest.approx(e / np.sinh(x), rel=1e-12)
    else:
        x = np.arcsinh(e / spin)
        integral = b * e * x - a * np.log(a * np.sinh(x) + b * e * np.cosh(x))
        passed = I3 * (integral - integral[0]) / ((b * e) ** 2 - a**2)
        assert passed == pytest.approx(time, rel=1e-12, abs=1e-12)
    assert spin[-1] < 0.7 * start


def test_turning_across_the_axis_decays_in_flight():
    air = tt.Air(transverse_linear=6e-7)
    run = tt.simulate(thrown(air, tilt=0.5 * math.pi, spin=0.0, tilt_rate=50.0), duration=4.0)
    expected = 50.0 * np.exp(-6e-7 / tt.presets.REPORT.I1 * run["time"].values)
    turning = np.linalg.norm(run["angular_velocity"].values, axis=1)
    assert turning == pytest.approx(expected, rel=1e-12)


def test_fall_in_linear_drag():
    rate = 0.008 / 0.02
    run = tt.simulate(thrown(tt.Air(drag_linear=0.008), tilt=0.3, spin=10.0), duration=3.0)
    time = run["time"].values
    expected = -G / rate * (1.0 - np.exp(-rate * time))
    assert run["velocity"].values[:, 2] == pytest.approx(expected, rel=1e-12, abs=1e-12)


def test_fall_in_quadratic_drag():
    # Below e = STILL sqrt(g R) drag is linear, and less by at most d e^2 / 2.
    fastest, slow = math.sqrt(0.02 * G / 0.003), STILL * math.sqrt(G * R)
    launch = {"velocity": (0.0, 0.0, 0.0), "tilt": 0.3, "spin": 10.0}
    run = tt.simulate(thrown(tt.Air(drag_quadratic=0.003), **launch), duration=3.0)
    expected = -fastest * np.tanh(G * run["time"].values / fastest)
    within = 0.5 * 0.003 / 0.02 * slow**2 * 3.0
    assert run["velocity"].values[:, 2] == pytest.approx(expected, abs=within)


@pytest.mark.parametrize("law", [tt.ViscousFriction(mu=0.3), tt.CoulombFriction(mu=MU)])
def test_stone_slides_as_on_an_incline(law):
    # A ball of next to no radius of gyration would not do: a body whose slip is its velocity is one
    # that spins about a vertical axis through its lowest point.
    slope = 0.5
    problem = tt.Problem(
        body=BALL,
        friction=law,
        launch=tt.Launch(tilt=0.0, spin=0.0),
        table=tt.Table(slope=slope),
        contact=tt.Contact(liftoff="stop"),
    )
    run = tt.simulate(problem, duration=0.4)
    # m u' = m g sin - F and 2/5 m R w' = F, so that 7/2 F = m (g sin - slip').
    velocity, turning = run["velocity"].values[:, 0], run["angular_velocity"].values[:, 1]
    slip = velocity - R * turning
    gained = velocity + 0.4 * R * turning
    assert gained == pytest.approx(G * math.sin(slope) * run["time"].values, rel=1e-12, abs=1e-13)
    if isinstance(law, tt.ViscousFriction):
        rate = 3.5 * 0.3 * G * math.cos(slope)
        ends = G * math.sin(slope) / rate * (1.0 - np.exp(-rate * run["time"].values))
        assert slip == pytest.approx(ends, rel=1e-12, abs=1e-13)


def test_spinning_top_drifts_across_the_slope():
    # A spin about the axis makes friction, which holds the top against the slope, turn its axis.
    for sign in (1.0, -1.0):
        problem = tt.presets.report_problem(spin=sign * 155.0).replace(
            {"table.slope": "2 deg", "launch.tilt": 0.0}
        )
        run = tt.simulate(problem, duration=0.5)
        assert sign * float(run["y"][-1]) < -1e-3


def test_without_slope_and_air_nothing_changes():
    problem = tt.presets.report_problem(spin=155.0)
    level = tt.simulate(problem, duration=0.5)
    explicit = tt.simulate(problem.replace({"table.azimuth": 1.0}), duration=0.5)
    for name in ("axis", "velocity", "x", "energy"):
        assert (level[name].values == explicit[name].values).all()


@pytest.mark.parametrize("name", ["table.slope", "air.axial_linear"])
def test_runs_that_end_where_they_are_held_for_good_have_neither_slope_nor_air(name):
    with pytest.raises(tt.InvalidInput, match=f"settled.*{name} is swept"):
        tt.sweep(tt.presets.report_problem(), {name: [0.0, 1e-8]}, duration=1.0, settled=1e-3)


def test_air_beside_a_sharp_tip_alone_is_not_estimated():
    tip = tt.Body(mass=0.02, shape=tt.Sphere(radius=0.0, center=-0.02), I1=1e-5, I3=1e-6)
    with pytest.raises(tt.InvalidInput, match="sharp tips alone"):
        tt.Air.estimated(tip, spin=100.0)


def test_a_slope_is_told_of_what_still_moves_on_it():
    moving = tt.presets.report_problem().replace({"table.slope": 0.05})
    assert "no spin on it is steady" in str(tt.describe(tt.simulate(moving, duration=0.2)))
    coin = tt.Problem(
        body=tt.presets.COIN,
        friction=tt.CoulombFriction(mu=0.5),
        launch=tt.Launch(tilt=0.0, spin=3.0),
        table=tt.Table(slope=0.05),
    )
    run = tt.simulate(coin, duration=2.0)
    assert run.attrs["status"] == "at_rest"
    assert "steady" not in str(tt.describe(run))


@pytest.mark.parametrize("theory", [tt.predict, tt.critical_spins, tt.steady_states])
def test_theory_of_level_tables_refuses(theory):
    problem = tt.presets.report_problem()
    with pytest.raises(tt.InvalidInput, match=r"table\.slope: .*on a slope a spinning top drifts"):
        theory(problem.replace({"table.slope": 0.01}))
    with pytest.raises(tt.InvalidInput, match=r"air: .*brakes every spin"):
        theory(problem.replace({"air.axial_linear": 1e-9}))


# What users state.


def test_air_from_decay_lets_the_spin_decay_so():
    air = tt.Air.from_decay(tt.presets.REPORT, time="3 s")
    run = tt.simulate(thrown(air, tilt=0.4, spin=100.0), duration=3.0)
    assert float(run["spin"][-1]) == pytest.approx(100.0 / math.e, rel=1e-12)


def test_disk_has_cochrans_torque():
    air = tt.Air.estimated(tt.presets.COIN, spin=100.0, density=1.2, viscosity=1.8e-5)
    radius = 0.023_25 / 2
    torque = 1.94 * radius**4 * math.sqrt(1.2 * 1.8e-5 * 100.0**3)
    assert 100.0 * (air.axial_linear + 100.0 * air.axial_quadratic) == pytest.approx(torque)
    # The slope is that of the power 3/2.
    slope = air.axial_linear + 200.0 * air.axial_quadratic
    assert slope == pytest.approx(1.5 * torque / 100.0)


def test_slow_sphere_has_stokes_torque():
    air = tt.Air.estimated(BALL, spin=0.01)
    assert air.axial_linear == pytest.approx(8.0 * math.pi * 1.8e-5 * R**3)
    assert air.axial_quadratic == 0.0
    assert air.drag_linear == pytest.approx(6.0 * math.pi * 1.8e-5 * R)
    assert air.drag_quadratic == pytest.approx(0.22 * math.pi * 1.2 * R**2)


def test_estimates_refuse_what_they_do_not_know():
    with pytest.raises(tt.InvalidInput, match="turbulent"):
        tt.Air.estimated(BALL, spin=3000.0)
    with pytest.raises(tt.InvalidInput, match="spin"):
        tt.Air.estimated(BALL, spin=0.0)
    with pytest.raises(tt.InvalidInput, match="time"):
        tt.Air.from_decay(BALL, time=-1.0)


@pytest.mark.parametrize(
    ("field", "value"),
    [("table.slope", -0.1), ("table.slope", "90 deg"), ("air.drag_linear", -1.0)],
)
def test_impossible_values_are_refused(field, value):
    with pytest.raises(tt.InvalidInput, match=field):
        tt.presets.report_problem().replace({field: value})


def test_units_of_air_and_slope():
    problem = tt.presets.report_problem().replace(
        {"table.slope": "2 deg", "air.axial_linear": "3 g cm2/s"}
    )
    assert problem.table.slope == pytest.approx(math.radians(2.0))
    assert problem.air.axial_linear == pytest.approx(3e-7)


FIELDS = ("table.slope", "table.azimuth", "air.axial_linear", "air.drag_quadratic")


@pytest.mark.parametrize("field", FIELDS)
def test_derivatives_are_differences_of_runs(field):
    problem = bodies()["viscous"].replace(SLOPE | AIR)
    slopes = tt.sensitivities(problem, 0.3, [field], samples=5)
    value = problem.get(field)
    step = 1e-4 * value
    ahead, behind = (
        tt.simulate(problem.replace({field: value + sign * step}), duration=0.3, samples=5)
        for sign in (1.0, -1.0)
    )
    for name in ("tilt", "x", "y"):
        difference = (ahead[name].values[-1] - behind[name].values[-1]) / (2.0 * step)
        derivative = float(np.ravel(slopes[name].values)[-1])
        assert derivative == pytest.approx(difference, rel=1e-5, abs=1e-12 / step)


@pytest.mark.parametrize(
    ("law", "down"),
    [
        (tt.ViscousFriction(mu=MU), math.tan(0.04) / MU),
        (tt.CoulombFriction(mu=MU), 0.0),
    ],
)
@pytest.mark.parametrize("spin", [155.0, -155.0])
def test_spinning_top_drifts_straight_across_the_slope(law, down, spin):
    # With its centre of mass above the contact point no force has a moment: the top keeps its axis,
    # at sin(tilt + slope) = sin(slope) / alpha downhill, and its velocity.
    slope, report = 0.04, tt.presets.REPORT
    tilt = math.asin(math.sin(slope) / report.shape.eccentricity) - slope
    across = -R * spin * math.sin(tilt)
    problem = tt.Problem(
        body=report,
        friction=law,
        launch=tt.Launch(tilt=tilt, spin=spin, velocity=(down, across)),
        table=tt.Table(slope=slope),
    )
    run = tt.simulate(problem, duration=0.1)
    expected = np.tile([down, across, 0.0], (len(run["time"]), 1))
    assert run["velocity"].values == pytest.approx(expected, abs=1e-11)
    assert run["tilt"].values == pytest.approx(np.full(len(run["time"]), tilt), abs=1e-10)
    assert run["spin"].values == pytest.approx(np.full(len(run["time"]), spin), rel=1e-11)
    modes = set(run["mode"].values[1:].tolist())
    assert modes == ({"sliding"} if down else {"sticking"})


def test_pictures_of_a_film_are_upright_by_gravity():
    problem = tt.presets.report_problem().replace({"table.slope": 0.2, "table.azimuth": 1.1})
    gravity = np.array(problem.gravity_vector)
    view = view_of(np.zeros(3), np.array([2.6, -6.0, 3.0]), (64, 48), problem.table)
    assert view.right @ gravity == pytest.approx(0.0, abs=1e-14)
    assert view.up @ gravity < 0.0
    level = view_of(np.zeros(3), np.array([2.6, -6.0, 3.0]), (64, 48))
    assert level.right[2] == 0.0
    # The eye is as high above the toy's place, by gravity, as beside a level table.
    assert view.eye @ gravity == pytest.approx(-9.8 * level.eye[2])


@pytest.mark.slow
def test_fit_finds_slope_and_air():
    problem = bodies()["viscous"].replace({"table.slope": 0.02, "air.axial_linear": 3e-7})
    run = tt.simulate(problem, duration=1.0, samples=61)
    random = np.random.default_rng(1)
    noise = {"tilt": 1e-3, "spin": 0.05}
    columns = {
        name: run[name].values + size * random.normal(size=61) for name, size in noise.items()
    }
    film = tt.Measurement.of_variables(run["time"].values, columns, noise=list(noise.values()))
    fields = ["table.slope", "air.axial_linear"]
    guess = problem.replace({"table.slope": 0.018, "air.axial_linear": 2.7e-7})
    fitted = tt.fit(guess, film, fields)
    for field in fields:
        off = abs(fitted.values[field] - problem.get(field))
        assert off < 4.0 * fitted.errors[field] < 0.3 * problem.get(field)
