"""Rolling resistance and rest: motions known exactly, what must hold, and where it is refused."""

import math

import numpy as np
import pytest

import tippetop as tt
from tippetop.problem.problem import top_of

G = 9.8
R, M, ARM = 0.02, 0.015, 1e-4
BALL = tt.Body(
    mass=M,
    shape={"kind": "spheroid", "across": R, "along": R},
    I1=0.4 * M * R * R,
    I3=0.4 * M * R * R,
)
COULOMB = tt.CoulombFriction(mu=0.3)
PATCHES = [
    tt.ContensouFriction(mu=0.3, patch_radius=1e-3, pressure=word)
    for word in ("hertz", "ellipsoidal")
]
REPORT = tt.presets.report_problem(spin=100.0, tilt=0.1)


def modes(run):
    return run["mode"].values


def events(run, kind):
    return run["event_time"].values[run["event_kind"].values == kind]


@pytest.mark.parametrize(
    ("friction", "integrator"),
    [(COULOMB, "taylor"), (PATCHES[0], "taylor"), (PATCHES[1], "dop853")],
    ids=["coulomb-taylor", "hertz-taylor", "ellipsoidal-dop853"],
)
def test_a_rolling_ball_slows_down_evenly_and_stays_where_it_stops(friction, integrator):
    """About the contact point, (I + m R^2) w' = -N arm: w falls evenly to zero."""
    spin = 10.0
    launch = tt.Launch(tilt=1.0, spin=0.0, tilt_rate=spin)
    problem = tt.Problem(body=BALL, friction=friction, launch=launch, rolling_resistance=ARM)
    slowing = G * ARM / (1.4 * R * R)
    run = tt.simulate(problem, 20.0, samples=201, integrator=integrator)
    assert run.attrs["status"] == "at_rest"
    assert float(run["end_time"]) == pytest.approx(spin / slowing, abs=1e-9)
    assert events(run, "rolling stops") == pytest.approx([spin / slowing], abs=1e-9)
    # The tilt is turned back at each pole that the axis passes.
    rate = np.abs(run["tilt_rate"].values[:30])
    np.testing.assert_allclose(rate, spin - slowing * run["time"].values[:30], atol=1e-9 * spin)
    assert float(run["x"][-1]) == pytest.approx(R * spin**2 / (2 * slowing), rel=1e-9)
    kinetic = 0.5 * 1.4 * M * R * R * spin**2
    assert float(run["energy_lost_rolling"]) == pytest.approx(kinetic, rel=1e-10)
    assert abs(float(run["energy_lost_sliding"])) < 1e-12 * kinetic
    assert np.abs(run["angular_momentum"].values[-1]).max() < 1e-20


@pytest.mark.parametrize(
    ("pressure", "arm", "tilt"),
    [
        ("hertz", 0.0, 0.0),
        ("hertz", 1e-5, math.pi),
        ("ellipsoidal", 0.0, math.pi),
        ("ellipsoidal", 1e-5, 0.0),
    ],
)
def test_a_standing_top_loses_its_spin_by_drilling_and_comes_to_rest(pressure, arm, tilt):
    """I3 w' = -(3 pi / 16) mu N patch, whether it stands stably or not."""
    mu, patch, spin = 0.3, 2e-3, 100.0
    problem = REPORT.model_copy(
        update={
            "friction": tt.ContensouFriction(mu=mu, patch_radius=patch, pressure=pressure),
            "launch": tt.Launch(tilt=tilt, spin=spin),
            "rolling_resistance": arm,
        }
    )
    body = problem.body
    slowing = 3 * math.pi / 16 * mu * body.mass * problem.gravity * patch / body.I3
    run = tt.simulate(problem, 60.0, samples=61)
    assert run.attrs["status"] == "at_rest"
    assert float(run["end_time"]) == pytest.approx(spin / slowing, rel=1e-11)
    early = run["time"].values < spin / slowing
    spins = run["spin"].values[early]
    np.testing.assert_allclose(spins, spin - slowing * run["time"].values[early], atol=1e-9 * spin)
    assert float(run["energy_lost_drilling"]) == pytest.approx(0.5 * body.I3 * spin**2, rel=1e-11)
    assert float(run["final_tilt"]) == pytest.approx(tilt, abs=1e-15)


def test_a_rocking_top_comes_to_rest_where_the_table_holds_it():
    """At rest m g a sin(theta) <= N arm, and its energy is what it lost by rolling alone."""
    problem = REPORT.replace({"launch.spin": 0.0, "launch.tilt": 1.0}).model_copy(
        update={"friction": COULOMB, "rolling_resistance": ARM}
    )
    run = tt.simulate(problem, 60.0, samples=601)
    assert run.attrs["status"] == "at_rest"
    shape = problem.body.shape
    offset = shape.radius * shape.eccentricity
    assert offset * math.sin(float(run["final_tilt"])) <= ARM
    assert float(run["energy_error"]) < 1e-12
    lost = float(run["energy_lost_rolling"])
    assert lost == pytest.approx(float(run["energy_lost"]), rel=1e-11)
    couple = np.hypot(*run["contact_torque"].values[:, :2].T)
    assert np.all(couple <= ARM * run["normal_force"].values * (1 + 1e-12))


@pytest.mark.parametrize(("tilt", "rests"), [(0.99, True), (1.01, False)])
def test_a_tilted_top_set_down_rests_up_to_the_tilt_that_the_resistance_holds(tilt, rests):
    shape = REPORT.body.shape
    limit = math.asin(ARM / (shape.radius * shape.eccentricity))
    problem = REPORT.replace({"launch.spin": 0.0, "launch.tilt": tilt * limit}).model_copy(
        update={"friction": COULOMB, "rolling_resistance": ARM}
    )
    run = tt.simulate(problem, 0.05, samples=11)
    assert run.attrs["status"] == ("at_rest" if rests else "completed")
    assert (float(run["end_time"]) < 1e-9) is rests


@pytest.mark.parametrize(
    "friction",
    [
        pytest.param(tt.ViscousFriction(mu=0.3), id="viscous", marks=pytest.mark.slow),
        pytest.param(
            tt.RegularizedCoulombFriction(mu=0.3), id="smoothed", marks=pytest.mark.campaign
        ),  # stiff: a minute
    ],
)
def test_an_inverted_top_under_a_smooth_law_stops_rolling_and_stands(friction):
    problem = REPORT.replace({"launch.spin": 155.0}).model_copy(
        update={"friction": friction, "rolling_resistance": 1e-5}
    )
    runs = [
        tt.simulate(problem, 8.0, samples=161, integrator=name, tolerance=tolerance)
        for name, tolerance in (("taylor", None), ("dop853", 1e-13))
    ]
    for run in runs:
        assert run.attrs["status"] == "completed"
        assert float(run["energy_error"]) < 1e-10
        couple = np.hypot(*run["contact_torque"].values[:, :2].T)
        assert np.all(couple <= 1e-5 * run["normal_force"].values * (1 + 1e-12))
    one, other = runs
    np.testing.assert_allclose(one["tilt"], other["tilt"], atol=1e-7)
    np.testing.assert_allclose(
        events(one, "rolling stops"), events(other, "rolling stops"), rtol=1e-6
    )


def test_losses_add_up_to_the_energy_lost():
    problem = REPORT.replace(
        {"launch.spin": 60.0, "launch.tilt": 0.8, "launch.gap": 0.005}
    ).model_copy(update={"friction": PATCHES[1], "rolling_resistance": ARM})
    run = tt.simulate(problem, 2.0, samples=201)
    parts = [run[f"energy_lost_{name}"].item() for name in ("sliding", "drilling", "rolling")]
    assert min(parts) > 0.0
    struck = float(run["energy_lost_impacts"])
    assert struck > 0.0
    assert sum(parts) + struck == pytest.approx(float(run["energy_lost"]), rel=1e-12)
    sampled = sum(run[f"{name}_loss"].values for name in ("sliding", "drilling", "rolling"))
    impacts = sum(
        np.where(run["time"].values > at, lost, 0.0)
        for at, lost in zip(run["event_time"].values, run["event_energy_lost"].values, strict=True)
    )
    np.testing.assert_allclose(sampled + impacts, -run["work"].values, atol=1e-12 * struck)
    for name, value in zip(("sliding", "drilling", "rolling"), parts, strict=True):
        assert float(run[f"{name}_loss"][-1]) == pytest.approx(value, rel=1e-9)
        assert np.all(np.diff(run[f"{name}_loss"].values) > -1e-12 * sum(parts))


def test_jelletts_integral_and_the_theory_know_of_it():
    problem = REPORT.model_copy(update={"rolling_resistance": 1e-5})
    assert top_of(REPORT).conserves_jellett
    assert not top_of(problem).conserves_jellett
    run = tt.simulate(problem, 0.5, samples=11)
    assert float(run["jellett_drift"]) > 1e-6
    for ask in (tt.predict, tt.critical_spins):
        with pytest.raises(tt.InvalidInput, match="rolling_resistance: 1e-05"):
            ask(problem)


def test_wrong_arms_are_refused_and_right_ones_are_written():
    with pytest.raises(tt.InvalidInput, match=r"rolling_resistance: -0.1 .* at least 0"):
        REPORT.replace({"rolling_resistance": -0.1})
    problem = REPORT.replace({"rolling_resistance": 1e-5})
    assert tt.Problem.from_toml(problem.to_toml()) == problem
    assert tt.Problem.from_json(problem.to_json()) == problem
    assert "rolling_resistance = 1e-05" in problem.to_toml()


SMOOTH = [tt.ViscousFriction(mu=0.3), tt.RegularizedCoulombFriction(mu=0.3, eps=0.05)]
SLIPPERY = [law.model_copy(update={"mu": 0.02}) for law in (COULOMB, *PATCHES)]


@pytest.mark.parametrize(
    ("friction", "arm"),
    [
        *[(law, arm) for law in (*SMOOTH, COULOMB) for arm in (0.0, 1e-5)],
        *[(law, 0.0) for law in SLIPPERY],
        (PATCHES[0], 1e-5),
    ],
    ids=lambda it: (
        str(it) if isinstance(it, float) else f"{it.kind}-{it.mu}-{getattr(it, 'pressure', '')}"
    ),
)
def test_a_top_released_at_rest_falls_under_every_law(friction, arm):
    """What begins to slip, or to roll, lasts no shorter for a velocity beside it that is zero and
    goes on.
    """
    problem = REPORT.model_copy(
        update={
            "friction": friction,
            "launch": tt.Launch(tilt=0.8, spin=0.0),
            "rolling_resistance": arm,
        }
    )
    run, other = (
        tt.simulate(problem, 0.1, samples=11, integrator=name) for name in ("taylor", "dop853")
    )
    assert run.attrs["status"] == other.attrs["status"] == "completed"
    assert abs(float(run["energy_error"])) < 1e-14
    assert np.ptp(run["tilt"].values) > 0.01
    for name in ("tilt", "x", "tilt_rate"):
        exact = 1e-10 * np.abs(run[name].values).max()
        np.testing.assert_allclose(other[name], run[name], rtol=0.0, atol=exact, err_msg=name)
    assert (float(run["energy_lost_rolling"]) > 0.0) == (arm > 0.0)
    assert float(run["energy_lost_sliding"]) >= -1e-14 * float(run["initial_energy"])


def test_rolling_that_is_held_begins_once_friction_of_slip_has_turned_towards_it() -> None:
    """A top slides and turns about the vertical: the couple that keeps it from rolling grows to all
    that the table exerts, which the monitor of the run sees.
    """
    problem = tt.presets.report_problem(tilt=0.3, spin=20.0 * np.cos(0.3)).replace(
        {
            "friction": tt.CoulombFriction(mu=0.05),
            "rolling_resistance": 1e-3,
            "launch.precession": 20.0,
            "launch.slip": (0.3, 0.0),
        }
    )
    run = tt.simulate(problem, 0.27, times=np.linspace(0.0, 0.27, 109))
    assert run.attrs["status"] == "completed"
    assert run["event_kind"].values.tolist() == ["rolling stops", "rolling starts"]
    stops, starts = run["event_time"].values
    rolling = np.hypot(*run["angular_velocity"].values[:, :2].T)
    held = (run["time"].values > stops) & (run["time"].values < starts)
    assert np.count_nonzero(held) > 10
    assert rolling[held].max() < 1e-12
    assert rolling[-1] > 1e-3
