"""Whole runs: against converged numbers, exact laws, symmetries, and what they promise their
users.
"""

import functools
import math
from dataclasses import replace
from importlib import import_module

import numpy as np
import pytest
import xarray as xr
from hypothesis import HealthCheck, assume, given, reject, settings
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.spatial.transform import Rotation

import tippetop as tt
from campaigns import among, examples
from strategies import numbers
from tippetop.integrators import make_integrator
from tippetop.integrators.base import NOT_FINITE
from tippetop.problem.presets import REPORT, report_problem
from tippetop.results.catalogue import SAMPLED

few_and_slow = settings(
    max_examples=10,
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.filter_too_much],
)
EXACT_INTEGRATORS = ["taylor", "dop853"]


def report(spin=155.0, liftoff="ignore", mu=0.3, **launch):
    """The report's top, by default with a table that may pull."""
    changes = {
        "contact.liftoff": liftoff,
        **{f"launch.{name}": value for name, value in launch.items()},
    }
    return report_problem(spin, mu=mu).replace(changes)


def egg(spin=60.0, tilt=1.2, mu=1.0, **launch):
    """A spheroid of the report's mass, on its side."""
    across, along, mass = 0.015, 0.022, 0.02
    return tt.Problem(
        body=tt.Body(
            mass=mass,
            shape=tt.Spheroid(across=across, along=along),
            I1=mass * (across**2 + along**2) / 5,
            I3=mass * 2 * across**2 / 5,
        ),
        friction=tt.ViscousFriction(mu=mu),
        launch=tt.Launch(tilt=tilt, spin=spin, **launch),
        contact=tt.Contact(liftoff="ignore"),
    )


@st.composite
def tippe_tops(draw, liftoffs=("stop", "ignore")):
    """Tippe tops of all sizes with either friction, launched at any tilt, spinning either way."""
    radius, mass, gravity = (
        draw(numbers(0.005, 0.1)),
        draw(numbers(0.001, 1.0)),
        draw(numbers(1.6, 25.0)),
    )
    speed = math.sqrt(gravity * radius)
    rate = speed / radius
    mu = draw(numbers(0.0, 1.0))
    friction = draw(
        st.one_of(
            st.just(tt.ViscousFriction(mu=mu / speed)),
            st.builds(
                lambda eps: tt.RegularizedCoulombFriction(mu=mu, eps=eps * speed),
                numbers(0.01, 1.0),
            ),
        )
    )
    transverse = draw(numbers(0.2, 1.0)) * mass * radius**2
    small = numbers(-0.3, 0.3)
    try:
        return tt.Problem(
            body=tt.Body(
                mass=mass,
                shape=tt.EccentricSphere(radius=radius, eccentricity=draw(numbers(0.05, 0.6))),
                I1=transverse,
                I3=draw(numbers(0.2, 2.0)) * transverse,
            ),
            friction=friction,
            launch=tt.Launch(
                tilt=draw(numbers(0.0, math.pi)),
                spin=rate * draw(numbers(-10.0, 10.0)),
                azimuth=draw(numbers(-math.pi, math.pi)),
                tilt_rate=rate * draw(small),
                precession=rate * draw(small),
                slip=(speed * draw(small), speed * draw(small)),
            ),
            contact=tt.Contact(liftoff=draw(st.sampled_from(liftoffs))),
            gravity=gravity,
        )
    except tt.InvalidInput:
        reject()


def largest(values):
    return float(np.abs(values).max())


# --- converged numbers
# --------------------------------------------------------------------------------------

THETA_AT = {
    50.0: {
        1.0: 0.044079719929,
        2.0: 0.038000728951,
        4.0: 0.128112074376,
        6.0: 0.457767096583,
        8.0: 1.243168192814,
        20.0: 1.503557333885,
    },
    155.0: {
        1.0: 0.090203172662,
        2.0: 0.069549411907,
        4.0: 0.203285686736,
        6.0: 1.804652321102,
        8.0: 3.134116250457,
        20.0: 3.141443639505,
    },
}
"""Tilt at some times, s, for the report's launch at these spins, rad/s, converged by independent
programs.
"""
AFTER_20_S = {50.0: (35.254677, -8.207585), 155.0: (0.999451, -82.8658819364)}
"""Precession and axial spin, rad/s."""


@pytest.mark.parametrize(
    ("spin", "integrator"),
    among([(155.0, "taylor"), (50.0, "taylor"), (50.0, "dop853")], check=2),
)
def test_tilt_follows_the_converged_run(spin, integrator):
    tolerance = 3e-12 if integrator == "dop853" else None
    run = tt.simulate(
        report(spin), 20.0, times=list(THETA_AT[spin]), integrator=integrator, tolerance=tolerance
    )
    np.testing.assert_allclose(run.tilt, list(THETA_AT[spin].values()), rtol=0, atol=1e-7)
    precession, axial_spin = AFTER_20_S[spin]
    assert float(run.precession[-1]) == pytest.approx(precession, abs=1e-6)
    assert float(run.spin[-1]) == pytest.approx(axial_spin, abs=1e-6)


def test_spin_of_50_ends_in_the_steady_state_of_constant_tilt():
    """omega3 = phi' (c - alpha) and phi'^2 = m g R alpha / (I1 c + I3 (alpha - c))."""
    body, gravity = REPORT, 9.8
    alpha = body.shape.eccentricity
    end = tt.simulate(report(50.0), 300.0, times=[300.0], integrator=EXACT_INTEGRATORS[0]).isel(
        time=0
    )
    c, precession = math.cos(end.tilt), float(end.precession)
    torque = body.mass * gravity * body.shape.radius * alpha
    assert float(end.spin) == pytest.approx(precession * (c - alpha), rel=1e-8)
    assert precession**2 == pytest.approx(torque / (body.I1 * c + body.I3 * (alpha - c)), rel=1e-8)


# --- what must hold in every run
# ----------------------------------------------------------------------------


@settings(few_and_slow, max_examples=examples(check=40, claim=2000))
@given(tippe_tops())
def test_jellett_and_energy_hold_for_every_tippe_top(problem):
    """The invariants over 20 s, to the rounding of the numbers they are made of.

    Jellett's integral -L.a may be as near to 0 as it likes: with a vertical L and a contact vector
    across it, or with two terms that cancel. Rounding L and n by a part in 1e16 changes it by |L|
    |a| / 1e16 all the same, so that |L| |a| is what its drift must be small against: at launch, or,
    where friction turns sliding into spin, later.
    """
    run = tt.simulate(problem, 20.0, samples=101)
    shape = problem.body.shape
    longest_arm = shape.radius * (1 + shape.eccentricity)
    size = largest(np.linalg.norm(run.angular_momentum, axis=1)) * longest_arm
    assert largest(run.jellett - run.jellett[0]) <= 1e-12 * size
    # The energy is largest at launch, unless the table pulls: friction then drives the top.
    before, most = float(run.energy[0]), largest(run.energy)
    if run.attrs["status"] != "failed":
        assert largest(run.energy - before - run.work) <= 1e-11 * most
    lengths = np.linalg.norm(run.axis, axis=1)
    np.testing.assert_allclose(lengths, 1.0, rtol=0, atol=1e-12)
    if problem.contact.liftoff == "stop" and run.sizes["time"] > 1:
        # A table that does not pull takes energy and never gives any. (A launch that it would have
        # to hold down ends where it begins.)
        assert most == pytest.approx(before, rel=1e-11)
        assert np.all(np.diff(run.work) <= 1e-13 * before)
        assert float(run.normal_force.min()) >= -1e-12 * problem.body.mass * problem.gravity


@pytest.mark.parametrize("tolerance", [1e-9, 1e-12, None])
def test_huge_slip_leads_no_axis_astray(tolerance):
    """Coulomb's friction is the same however fast the top slips, and so is what it does to the
    axis.
    """
    rules = {"friction": tt.CoulombFriction(mu=0.3), "contact.liftoff": "ignore"}
    fast, faster = (
        tt.simulate(
            report(155.0).replace({**rules, "launch.slip": (slip, 0.0)}),
            0.5,
            samples=51,
            tolerance=tolerance,
        )
        for slip in (1e6, 1e8)
    )
    allowed = 10.0 * int(faster.steps) * (tolerance or np.finfo(float).eps)
    np.testing.assert_allclose(np.linalg.norm(faster.axis, axis=1), 1.0, rtol=0, atol=allowed)
    # The slip changes by less than 10 m/s, and its direction by less than a part in a hundred
    # thousand.
    np.testing.assert_allclose(faster.axis, fast.axis, rtol=0, atol=1e-5 + allowed)


@pytest.mark.parametrize("problem", [report(155.0), egg()], ids=["tippe top", "egg"])
def test_newtons_laws_hold_for_what_a_result_says(problem):
    """m r'' and L', differentiated from the samples, against the force and the arm that go with
    them.
    """
    dt = 1e-4
    run = tt.simulate(problem, 3.0, times=1.0 + dt * np.arange(2001))
    body, inner = problem.body, slice(2, -2)

    def rate(values):
        return (values[:-4] - 8 * values[1:-3] + 8 * values[3:-1] - values[4:]) / (12 * dt)

    azimuth, normal = run.azimuth.values[inner], run.normal_force.values[inner]
    along, across = run.slip_x.values[inner], run.slip_y.values[inner]
    slip = np.stack(
        (
            along * np.cos(azimuth) - across * np.sin(azimuth),
            along * np.sin(azimuth) + across * np.cos(azimuth),
        ),
        axis=1,
    )
    force = np.concatenate((-problem.friction.mu * normal[:, None] * slip, normal[:, None]), axis=1)
    weight = np.array([0.0, 0.0, -body.mass * problem.gravity])
    scale = largest(force)
    np.testing.assert_allclose(
        body.mass * rate(run.velocity.values), force + weight, rtol=0, atol=1e-6 * scale
    )

    position = np.stack((run.x, run.y, run.height), axis=1)
    fastest = largest(run.velocity)
    np.testing.assert_allclose(
        rate(position), run.velocity.values[inner], rtol=0, atol=1e-6 * fastest
    )

    moment = np.cross(lowest_points(body.shape, run.axis.values[inner]), force)
    np.testing.assert_allclose(
        rate(run.angular_momentum.values), moment, rtol=0, atol=1e-6 * largest(moment)
    )


def lowest_points(shape, axes):
    """From the centre of mass to where the body touches the table.

    Of a sphere, the centre and then a radius down; of an ellipsoid r.(1/Q) r = 1 with Q = b^2 (1 -
    n n) + d^2 n n, the point -Q z / sqrt(z.Q z) with a horizontal tangent plane.
    """
    down = np.array([0.0, 0.0, -1.0])
    if isinstance(shape, tt.EccentricSphere):
        return shape.radius * (shape.eccentricity * axes + down)
    stretched = (
        shape.across**2 * down + (shape.along**2 - shape.across**2) * (axes @ down)[:, None] * axes
    )
    return stretched / np.sqrt(stretched @ down)[:, None]


def vertical_momentum(run):
    return run.angular_momentum.sel(space="z")


@pytest.mark.parametrize(
    "problem", [report(60.0, mu=0.0, tilt=0.7, precession=3.0), egg(mu=0.0, tilt_rate=2.0)]
)
def test_without_friction_energy_momentum_and_both_spins_are_conserved(problem):
    run = tt.simulate(problem, 5.0)
    for conserved in (run.energy, vertical_momentum(run), run.spin):
        np.testing.assert_allclose(conserved, conserved[0], rtol=1e-12)
    across = run.velocity.sel(space=["x", "y"])
    assert largest(across - across[0]) < 1e-13 * largest(run.velocity)
    assert np.ptp(run.tilt.values) > 0.1


def test_friction_of_either_kind_takes_energy_and_spares_jellett():
    for friction in (tt.ViscousFriction(mu=0.3), tt.RegularizedCoulombFriction(mu=0.2, eps=0.01)):
        run = tt.simulate(report(100.0).replace({"friction": friction.model_dump()}), 3.0)
        assert run.attrs["status"] == "completed"
        assert float(run.energy[-1]) < 0.99 * float(run.energy[0])
        np.testing.assert_allclose(run.energy, run.energy[0] + run.work, rtol=1e-12)
        np.testing.assert_allclose(run.jellett, run.jellett[0], rtol=1e-12)


def test_regularized_coulomb_friction_is_viscous_where_the_slip_is_far_below_eps():
    """mu v / sqrt(v^2 + eps^2) = (mu / eps) v, but for v^2 / (2 eps^2)."""
    viscous = tt.simulate(report(100.0, mu=0.3), 1.0)
    eps = 1e3 * largest(np.hypot(viscous.slip_x, viscous.slip_y))
    law = {"kind": "regularized_coulomb", "mu": 0.3 * eps, "eps": eps}
    coulomb = tt.simulate(report(100.0).replace({"friction": law}), 1.0)
    np.testing.assert_allclose(coulomb.tilt, viscous.tilt, rtol=0, atol=1e-4)
    assert largest(coulomb.tilt - viscous.tilt) > 0


def test_egg_rises_on_its_end_and_does_not_keep_jelletts_integral():
    run = tt.simulate(egg(spin=2.0, tilt=1.5, precession=180.0), 5.0)
    assert run.attrs["status"] == "completed"
    assert float(run.tilt[0]) > 1.4
    assert float(run.tilt.min()) < 0.5
    np.testing.assert_allclose(run.energy, run.energy[0] + run.work, rtol=1e-12)
    assert np.ptp(run.jellett.values) > 1e-3 * largest(run.jellett)
    np.testing.assert_allclose(run.gap, 0.0, atol=1e-15)


# --- lift-off
# -----------------------------------------------------------------------------------------------

FIRST_LIFT_OFF = {175.0: (5.361332, 5e-7), 170.0: (5.85182, 5e-6)}
"""When the normal force first falls to zero, s, and to what that is rounded, for the report's
launch.
"""
SHORTLY_BEFORE = 5.2

OWN_TOLERANCE = {
    "taylor": 2.3e-16,
    "dop853": 1e-12,
    "rk45": 1e-10,
    "radau": 1e-9,
    "bdf": 1e-9,
    "lsoda": 1e-11,
}
STEP = 2e-4


@pytest.mark.parametrize("spin", FIRST_LIFT_OFF)
def test_lift_off_is_where_the_normal_force_first_falls_to_zero(spin):
    when, rounding = FIRST_LIFT_OFF[spin]
    run = tt.simulate(report(spin, liftoff="stop"), 20.0)
    assert run.attrs["status"] == "lifted_off"
    assert run.event_kind.values.tolist() == ["liftoff"]
    assert float(run.event_time[0]) == pytest.approx(when, abs=rounding)
    # The run ends there and then.
    assert float(run.time[-1]) == float(run.event_time[0])
    np.testing.assert_array_equal(
        run.time[:-1], np.linspace(0.0, 20.0, 2001)[: run.sizes["time"] - 1]
    )
    weight = REPORT.mass * 9.8
    assert float(run.normal_force[-1]) == pytest.approx(0.0, abs=1e-12 * weight)
    assert float(run.normal_force[:-1].min()) > 0


@functools.cache
def launch_shortly_before_lift_off():
    """The report's run at 175 rad/s, from its motion at 5.2 s on."""
    run = tt.simulate(report(175.0), 6.0, times=[SHORTLY_BEFORE], integrator=EXACT_INTEGRATORS[0])
    now = {
        name: float(run[name][0])
        for name in run.data_vars
        if run[name].dims == ("time",) and name != "mode"
    }
    return report(
        now["spin"],
        liftoff="stop",
        tilt=now["tilt"],
        tilt_rate=now["tilt_rate"],
        azimuth=now["azimuth"],
        precession=now["precession"],
        slip=(now["slip_x"], now["slip_y"]),
    )


@pytest.mark.parametrize(
    "integrator", [*OWN_TOLERANCE, pytest.param("rk4", marks=pytest.mark.slow)]
)
def test_every_integrator_locates_lift_off_to_its_own_tolerance(integrator):
    step = STEP if integrator == "rk4" else None
    run = tt.simulate(
        launch_shortly_before_lift_off(), 0.2, samples=2, integrator=integrator, step=step
    )
    when, rounding = FIRST_LIFT_OFF[175.0]
    # In the top's unit of time, sqrt(R / g), the normal force falls by about its usual size in a
    # unit: errors of the motion and of the time are alike.
    unit = math.sqrt(REPORT.shape.radius / 9.8)
    per_step = (175.0 * STEP) ** 5 / 120 if step else OWN_TOLERANCE[integrator]
    allowed = rounding + 10 * run.steps.item() * per_step * unit
    assert run.attrs["status"] == "lifted_off"
    assert float(run.event_time[0]) + SHORTLY_BEFORE == pytest.approx(when, abs=allowed)


def test_a_table_that_may_pull_changes_nothing_before_it_does():
    stopped = tt.simulate(report(175.0, liftoff="stop"), 8.0)
    pulled = tt.simulate(report(175.0, liftoff="ignore"), 8.0)
    assert pulled.attrs["status"] == "completed"
    assert float(pulled.time[-1]) == 8.0
    assert float(pulled.normal_force.min()) < -1e-3
    before = pulled.isel(time=slice(stopped.sizes["time"] - 1))
    assert float(before.normal_force.min()) > 0
    for name in ("tilt", "spin", "normal_force", "energy", "x", "axis", "orientation"):
        np.testing.assert_allclose(
            stopped[name][:-1],
            before[name],
            rtol=0,
            atol=1e-9 * largest(before[name]),
            err_msg=name,
        )


def test_run_that_never_lifts_off_has_no_events():
    run = tt.simulate(report(155.0, liftoff="stop"), 20.0)
    assert run.attrs["status"] == "completed"
    assert run.sizes["event"] == 0
    assert float(run.normal_force.min()) > 0


@pytest.mark.parametrize("spin", [60.0, 155.0])
def test_watching_for_lift_off_costs_no_steps(spin):
    alone, watched = (
        tt.simulate(report(spin, liftoff=rule), 20.0, integrator=EXACT_INTEGRATORS[0])
        for rule in ("ignore", "fly")
    )
    assert int(watched["flights"]) == 0
    assert int(watched["steps"]) <= 1.001 * int(alone["steps"])


def test_launch_that_the_table_would_have_to_hold_ends_as_it_begins():
    """With its centre of mass above the middle, a top that swings fast pulls at the table."""
    run = tt.simulate(report(0.0, liftoff="stop", tilt=2.5, tilt_rate=200.0), 1.0)
    assert run.attrs["status"] == "lifted_off"
    assert run.time.values.tolist() == [0.0]
    assert run.event_time.values.tolist() == [0.0]
    assert float(run.tilt[0]) == pytest.approx(2.5)


# --- the poles
# ----------------------------------------------------------------------------------------------

NOT_AT_THE_POLES = {"precession"}
"""What is documented not to be a number where the axis is vertical."""


@pytest.mark.parametrize(("tilt", "up"), [(0.0, 1.0), (math.pi, -1.0)])
@settings(few_and_slow)
@given(
    spin=st.one_of(st.sampled_from([155.0, -155.0, 0.0]), numbers(-300.0, 300.0)),
    azimuth=numbers(-4, 4),
)
def test_vertical_launch_stays_exactly_vertical(tilt, up, spin, azimuth):
    run = tt.simulate(report(spin, tilt=tilt, azimuth=azimuth, liftoff="stop"), 5.0, samples=11)
    assert run.attrs["status"] == "completed"
    assert run.axis.values.tolist() == [[0.0, 0.0, up]] * 11
    for name in ("x", "y", "slip_x", "slip_y", "work", "tilt_rate"):
        assert largest(run[name]) == 0.0, name
    assert set(run.tilt.values) == {tilt}
    np.testing.assert_allclose(run.spin, spin, rtol=1e-14)
    np.testing.assert_allclose(run.normal_force, REPORT.mass * 9.8, rtol=1e-14)
    assert np.all(np.isnan(run.precession))
    for name in set(SAMPLED) - NOT_AT_THE_POLES:
        assert np.all(np.isfinite(run[name])), name
    # The body turns about the vertical all the same.
    turned = Rotation.from_quat(run.orientation.values, scalar_first=True)
    expected = Rotation.from_rotvec(np.outer(spin * up * run.time.values, [0, 0, 1])) * turned[0]
    assert largest((turned * expected.inv()).magnitude()) < 1e-9


def thrown_through_the_pole(up, spin, tilt):
    """A frictionless top that passes exactly through a pole, and what it then must do.

    With p = I3 omega3, a vertical angular momentum of +-p lets the axis reach the pole. Measured
    from there, by the angle t of cosine c, the energy is I1 t'^2/2 + m (R alpha s t')^2/2 + p^2 (1
    - c)/(2 I1 (1 + c)) +- m g R (1 - alpha c); a top that starts at rest in tilt at t0 passes the
    pole after a quarter of its period. Returns the problem, that time, and the rate at which the
    pole is passed.
    """
    body, gravity = REPORT, 9.8
    m, R, alpha, p = body.mass, body.shape.radius, body.shape.eccentricity, body.I3 * spin
    c0 = math.cos(tilt)

    def cosine_gained(t, short):
        return 2 * math.sin(tilt - short / 2) * math.sin(short / 2)

    def rate(t, short):
        """Rate of the tilt at t = tilt - short."""
        c, s = math.cos(t), math.sin(t)
        potential = p**2 / (body.I1 * (1 + c) * (1 + c0)) + up * m * gravity * R * alpha
        return math.sqrt(
            2 * cosine_gained(t, short) * potential / (body.I1 + m * (R * alpha * s) ** 2)
        )

    def time_per_phase(phase):
        short = 2 * tilt * math.sin((math.pi / 2 - phase) / 2) ** 2
        return tilt * math.cos(phase) / rate(tilt - short, short)

    quarter, _ = quad(time_per_phase, 0.0, math.pi / 2, epsabs=0.0, epsrel=1e-13)
    launched = tilt if up > 0 else math.pi - tilt
    precession = up * p / (body.I1 * (1 + c0))
    problem = report(spin, mu=0.0, tilt=launched, precession=precession)
    return problem, quarter, rate(0.0, tilt)


@pytest.mark.parametrize(
    ("up", "spin", "tilt"),
    [(1, 155.0, 0.3), (1, -20.0, 1.0), (1, 0.0, 0.5), (-1, 155.0, 0.3), (-1, -90.0, 0.7)],
)
def test_run_through_a_pole_is_an_ordinary_run(up, spin, tilt):
    problem, quarter, rate = thrown_through_the_pole(up, spin, tilt)
    passages = quarter * np.array([1.0, 3.0, 5.0])
    away = np.array([-1e-4, -1e-7, 0.0, 1e-7, 1e-4])
    times = (passages[:, None] + away * quarter).ravel()
    run = tt.simulate(problem, 6 * quarter, times=[0.0, *times], integrator=EXACT_INTEGRATORS[0])
    from_pole = np.hypot(*run.axis.values[1:, :2].T).reshape(-1, len(away))
    assert run.attrs["status"] == "completed"
    assert largest(from_pole[:, 2]) < 1e-9
    # Near the pole the axis moves as in a straight line through it.
    np.testing.assert_allclose(
        from_pole, rate * quarter * np.abs(away) * np.ones((3, 1)), rtol=1e-5, atol=1e-9
    )
    np.testing.assert_allclose(
        np.abs(run.tilt_rate[1:]).values.reshape(-1, len(away))[:, [0, 4]], rate, rtol=1e-5
    )
    for conserved in (run.energy, vertical_momentum(run), run.spin):
        np.testing.assert_allclose(conserved, conserved[0], rtol=1e-11, atol=1e-18)
    for name in set(SAMPLED) - NOT_AT_THE_POLES:
        assert np.all(np.isfinite(run[name])), name


def test_tilt_of_a_billionth_grows_as_the_linear_equations_say_and_turns_over():
    """While both tilts are small, a thousand times the smaller is the larger."""
    smaller, larger = (
        tt.simulate(report(155.0, tilt=tilt), 20.0, samples=201, integrator=EXACT_INTEGRATORS[0])
        for tilt in (1e-9, 1e-6)
    )
    linear = larger.time.values < 1.0
    np.testing.assert_allclose(1e3 * smaller.tilt[linear], larger.tilt[linear], rtol=1e-6)
    assert float(larger.tilt[-1]) > 3.0
    for run in (smaller, larger):
        np.testing.assert_allclose(run.jellett, run.jellett[0], rtol=1e-12)
        np.testing.assert_allclose(run.energy, run.energy[0] + run.work, rtol=1e-12)


# --- symmetries
# ---------------------------------------------------------------------------------------------

BRIEFLY = {"duration": 0.5, "samples": 51}


@few_and_slow
@given(problem=tippe_tops(["ignore"]), turn=numbers(-3.0, 3.0))
def test_direction_of_the_launch_turns_everything_with_it(problem, turn):
    turned = problem.replace({"launch.azimuth": problem.launch.azimuth + turn})
    run, other = tt.simulate(problem, **BRIEFLY), tt.simulate(turned, **BRIEFLY)
    assume(is_regular(run))
    near, matrix = comparison(problem), Rotation.from_rotvec([0, 0, turn]).as_matrix()
    for name in ("axis", "velocity", "angular_momentum"):
        near(name, other[name], run[name].values @ matrix.T)
    near("x", other.x, math.cos(turn) * run.x - math.sin(turn) * run.y)
    near("y", other.y, math.sin(turn) * run.x + math.cos(turn) * run.y)
    for name in ("tilt", "spin", "normal_force", "energy", "work", "jellett", "height"):
        near(name, other[name], run[name])


@few_and_slow
@given(problem=tippe_tops(["ignore"]))
def test_mirrored_launch_gives_the_mirrored_run(problem):
    launch = problem.launch
    mirrored = problem.replace(
        {
            "launch.spin": -launch.spin,
            "launch.precession": -launch.precession,
            "launch.azimuth": -launch.azimuth,
            "launch.slip": (launch.slip[0], -launch.slip[1]),
        }
    )
    run, other = tt.simulate(problem, **BRIEFLY), tt.simulate(mirrored, **BRIEFLY)
    assume(is_regular(run))
    near = comparison(problem)
    for name in ("tilt", "normal_force", "energy", "work", "x", "height"):
        near(name, other[name], run[name])
    for name in ("spin", "jellett", "y"):
        near(name, other[name], -run[name])
    near("axis", other.axis, run.axis.values * [1, -1, 1])
    near("velocity", other.velocity, run.velocity.values * [1, -1, 1])
    near("angular_momentum", other.angular_momentum, run.angular_momentum.values * [-1, 1, -1])


def is_regular(run):
    """Whether a run has no singular end, into which nothing but a table that pulls lets a top go.

    There its last numbers grow without bound, and those of no two runs agree.
    """
    is_singular = run.attrs["status"] == "failed"
    assert not is_singular or run.normal_force.min() < 0.0
    return not is_singular


def comparison(problem):
    """How far apart numbers of runs may be that rounding at launch alone sets apart.

    Tops are sensitive to where they start: in half a second rounding grows by several powers of
    ten. What is small is measured in the top's own units of mass, length and time.
    """
    mass, length = problem.body.mass, problem.body.shape.radius
    speed = math.sqrt(problem.gravity * length)
    units = {
        "tilt": 1.0,
        "axis": 1.0,
        "spin": speed / length,
        "normal_force": mass * problem.gravity,
        "energy": mass * speed**2,
        "work": mass * speed**2,
        "velocity": speed,
        "angular_momentum": mass * speed * length,
        "jellett": mass * speed * length**2,
        "height": length,
        "x": length,
        "y": length,
    }

    def near(name, values, expected):
        expected = np.asarray(expected)
        allowed = 1e-7 * max(largest(expected), units[name])
        np.testing.assert_allclose(np.asarray(values), expected, rtol=0, atol=allowed, err_msg=name)

    return near


# --- what a result holds
# ------------------------------------------------------------------------------------

UNITS = {
    "tilt": "rad",
    "tilt_rate": "rad s-1",
    "azimuth": "rad",
    "precession": "rad s-1",
    "spin": "rad s-1",
    "slip_x": "m s-1",
    "slip_y": "m s-1",
    "normal_force": "N",
    "energy": "J",
    "work": "J",
    "jellett": "kg m3 s-1",
    "height": "m",
    "gap": "m",
    "x": "m",
    "y": "m",
    "axis": "1",
    "velocity": "m s-1",
    "angular_momentum": "kg m2 s-1",
    "orientation": "1",
}


@pytest.fixture(scope="module")
def usual():
    """Two seconds of the report's run."""
    return tt.simulate(
        report(155.0, liftoff="stop", azimuth=0.4, tilt=0.3, slip=(0.1, -0.2)), 2.0, samples=401
    )


def test_every_variable_is_there_with_its_unit_and_its_name(usual):
    for name, unit in UNITS.items():
        assert usual[name].attrs["units"] == unit, name
        assert usual[name].dims[0] == "time"
        assert usual[name].dtype == np.float64
    assert usual.time.attrs["units"] == "s"
    for name, variable in usual.data_vars.items():
        assert len(variable.attrs["long_name"]) > 3, name
    assert usual.axis.dims == ("time", "space")
    assert usual.orientation.dims == ("time", "quaternion")
    assert usual.space.values.tolist() == ["x", "y", "z"]
    assert usual["quaternion"].values.tolist() == ["w", "x", "y", "z"]
    assert usual.event_time.dims == usual.event_kind.dims == ("event",)
    assert usual.event_time.attrs["units"] == "s"


def test_origin_of_a_result_can_be_read_off_it(usual):
    problem = report(155.0, liftoff="stop", azimuth=0.4, tilt=0.3, slip=(0.1, -0.2))
    assert tt.Problem.from_json(usual.attrs["problem"]) == problem
    assert usual.attrs["status"] == "completed"
    assert usual.attrs["message"] == tt.Status.COMPLETED.value
    assert usual.attrs["integrator"] == EXACT_INTEGRATORS[0]
    assert usual.attrs["tippetop_version"] == tt.__version__
    assert usual.attrs["Conventions"].startswith("CF-")
    assert usual.steps.item() > 0


def test_numbers_of_numpy_are_numbers_of_floats_and_none_may_be_infinite():
    duration, tolerance = np.float32(0.25), np.float32(1e-8)
    found = tt.simulate(report(), duration, samples=3, tolerance=tolerance)
    xr.testing.assert_identical(
        found, tt.simulate(report(), float(duration), samples=3, tolerance=float(tolerance))
    )
    for infinite in (np.float32("inf"), np.float16("inf"), 10**400, np.float32("nan")):
        with pytest.raises(tt.InvalidInput, match=r"^duration: "):
            tt.simulate(report(), infinite)


def test_tolerance_and_step_are_written_down_as_they_were_given():
    assert (
        tt.simulate(report(), 0.01, integrator="dop853", tolerance=1e-7).attrs["tolerance"] == 1e-7
    )
    classical = tt.simulate(report(), 0.01, integrator="rk4", step=1e-4).attrs
    assert classical["step"] == pytest.approx(1e-4, rel=1e-15)
    assert "tolerance" not in classical


def test_launch_is_the_first_sample(usual):
    first = usual.isel(time=0)
    expected = {"tilt": 0.3, "azimuth": 0.4, "tilt_rate": 0.0, "precession": 0.0, "spin": 155.0}
    expected |= {"slip_x": 0.1, "slip_y": -0.2, "x": 0.0, "y": 0.0, "work": 0.0}
    for name, value in expected.items():
        assert float(first[name]) == pytest.approx(value, rel=1e-12, abs=1e-11), name
    s, c = math.sin(0.3), math.cos(0.3)
    np.testing.assert_allclose(first.axis, [s * math.cos(0.4), s * math.sin(0.4), c], atol=1e-15)
    assert float(first.height) == pytest.approx(0.02 * (1 - 0.3 * c), rel=1e-14)
    assert float(first.jellett) == pytest.approx(REPORT.I3 * 155.0 * 0.02 * (c - 0.3), rel=1e-12)


def test_angles_and_axis_agree(usual):
    s = np.sin(usual.tilt)
    expected = np.stack(
        (s * np.cos(usual.azimuth), s * np.sin(usual.azimuth), np.cos(usual.tilt)), axis=1
    )
    np.testing.assert_allclose(usual.axis, expected, rtol=0, atol=1e-14)
    np.testing.assert_allclose(usual.gap, 0.0, atol=1e-16)


def test_rates_are_the_derivatives_of_the_angles():
    dt = 1e-5
    run = tt.simulate(report(155.0, tilt=0.5), 1.0, times=0.5 + dt * np.arange(1001))
    for angle, rate in ((run.tilt, run.tilt_rate), (np.unwrap(run.azimuth), run.precession)):
        differences = (np.asarray(angle)[2:] - np.asarray(angle)[:-2]) / (2 * dt)
        np.testing.assert_allclose(differences, rate[1:-1], rtol=0, atol=1e-5 * largest(rate))


def test_orientation_is_a_unit_quaternion_that_carries_the_axis(usual):
    quaternions = usual.orientation.values
    np.testing.assert_allclose(np.linalg.norm(quaternions, axis=1), 1.0, rtol=1e-14)
    turned = Rotation.from_quat(quaternions, scalar_first=True)
    np.testing.assert_allclose(turned.apply([0, 0, 1]), usual.axis, rtol=0, atol=1e-14)
    assert np.einsum("ij,ij->i", quaternions[1:], quaternions[:-1]).min() > 0


def test_orientation_turns_with_the_angular_velocity():
    """omega = L / I1 + (I1 - I3) / I1 omega3 n, against the turn from one sample to the next."""
    dt = 1e-5
    run = tt.simulate(report(155.0, tilt=0.5), 1.0, times=0.5 + dt * np.arange(1001))
    turned = Rotation.from_quat(run.orientation.values, scalar_first=True)
    between = (turned[2:] * turned[:-2].inv()).as_rotvec() / (2 * dt)
    excess = (REPORT.I1 - REPORT.I3) / REPORT.I1 * run.spin.values[:, None] * run.axis.values
    omega = run.angular_momentum.values / REPORT.I1 + excess
    np.testing.assert_allclose(between, omega[1:-1], rtol=0, atol=1e-5 * largest(omega))


def test_contact_mode_is_a_word_of_those_that_its_attribute_lists(usual):
    meanings = usual.mode.attrs["flag_meanings"].split()
    assert len(meanings) == len(set(meanings))
    assert set(usual.mode.values.tolist()) <= set(meanings)
    assert usual.mode[0] == "sliding"


# --- sample times
# -------------------------------------------------------------------------------------------


def test_samples_are_equally_spaced_from_launch_to_end():
    assert tt.simulate(report(), 0.5).sizes["time"] == 2001
    run = tt.simulate(report(), 0.3, samples=7)
    np.testing.assert_array_equal(run.time, np.linspace(0.0, 0.3, 7))


@pytest.mark.parametrize(
    "kind", [list, tuple, np.array, xr.DataArray], ids=lambda kind: kind.__name__
)
def test_times_can_be_given_instead(kind):
    times = [0.0, 0.1, 0.1 + 1e-9, 0.25]
    run = tt.simulate(report(), 0.3, times=kind(times))
    assert run.time.values.tolist() == times
    reference = tt.simulate(report(), 0.3, samples=4)
    assert float(run.tilt[1]) == pytest.approx(float(reference.tilt[1]), abs=1e-12)


def test_times_may_leave_out_the_launch_and_the_end():
    run = tt.simulate(report(175.0, liftoff="stop"), 20.0, times=[1.0, 2.0])
    # It ends before its time, which is a sample too.
    assert run.time.values[:2].tolist() == [1.0, 2.0]
    assert float(run.time[-1]) == float(run.event_time[0])
    assert tt.simulate(report(), 1.0, times=[0.5]).time.values.tolist() == [0.5]


@pytest.mark.parametrize("duration", [0.2, 0.3, 0.7, 1])
def test_a_run_to_its_end_ends_when_it_was_to(duration):
    """To the last bit, though it is followed in natural units."""
    run = tt.simulate(report(), duration, times=[0.1])
    assert float(run["end_time"]) == tt.summarize(run)["end_time"] == duration


def test_more_samples_do_not_change_the_run():
    sparse, dense = tt.simulate(report(), 2.0, samples=11), tt.simulate(report(), 2.0, samples=1001)
    np.testing.assert_allclose(sparse.tilt, dense.tilt[::100], rtol=0, atol=1e-12)


def test_samples_that_do_not_fit_into_memory_are_refused(monkeypatch):
    class Memory:
        available = 10_000_000

    memory = import_module("tippetop.results.checked_times").psutil
    monkeypatch.setattr(memory, "virtual_memory", Memory)
    assert tt.simulate(report(), 0.01, samples=100).sizes["time"] == 100
    for arguments in (
        {"samples": 1_000_000},
        {"samples": 10**15},
        {"times": np.linspace(0, 0.01, 1_000_000)},
    ):
        with pytest.raises(tt.InvalidInput, match="memory") as refusal:
            tt.simulate(report(), 0.01, **arguments)
        # What it offers instead does fit.
        offered = int(refusal.value.accepted.split()[2].rstrip(","))
        assert 100 < offered < 1_000_000


def test_bytes_per_sample_are_enough():
    """A result and what it is made of take less memory per sample than is reckoned with."""
    import tracemalloc  # noqa: PLC0415

    from tippetop.results.checked_times import BYTES_PER_SAMPLE  # noqa: PLC0415

    tt.simulate(report(), 0.1)
    samples = 100_000
    tracemalloc.start()
    try:
        tt.simulate(report(), 0.1, samples=samples, integrator=EXACT_INTEGRATORS[0])
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert peak < BYTES_PER_SAMPLE * samples


# --- what cannot be
# -----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("field", "arguments"),
    [
        *(("duration", {"duration": bad}) for bad in (0, -1.0, math.nan, math.inf, "20", None)),
        *(("samples", {"samples": bad}) for bad in (1, 0, -5, 2.0, "100", None, True, math.nan)),
        *(
            ("times", {"times": bad})
            for bad in ([], [[0.0, 1.0]], 0.5, [0.0, 0.0], [0.5, 0.1], [0.0, math.nan])
        ),
        *(
            ("times", {"times": bad})
            for bad in ([-0.1, 0.5], [0.0, 1.1], [[0.0], [0.1, 0.2]], "0 1")
        ),
        ("times.0", {"times": ["a", "b"]}),
        *(("integrator", {"integrator": bad}) for bad in ("euler", "", "Taylor", 4, ["taylor"])),
        *(
            ("tolerance", {"tolerance": bad})
            for bad in (0.0, -1e-9, 1.0, math.nan, math.inf, 1e-20, "small")
        ),
        *(
            ("step", {"integrator": "rk4", "step": bad})
            for bad in (None, 0, -1e-3, math.nan, math.inf, "long")
        ),
        ("step", {"step": 1e-3}),
        ("tolerance", {"integrator": "rk4", "step": 1e-3, "tolerance": 1e-9}),
        ("tolerance", {"integrator": make_integrator("dop853"), "tolerance": 1e-9}),
        ("step", {"integrator": make_integrator("rk4", step=0.1), "step": 1e-3}),
    ],
    ids=lambda value: value if isinstance(value, str) else str(next(reversed(value.values()))),
)
def test_what_cannot_be_is_refused_in_one_line_that_names_it(field, arguments):
    with pytest.raises(tt.InvalidInput) as refusal:
        tt.simulate(report(), **{"duration": 1.0, **arguments})
    told = str(refusal.value)
    assert refusal.value.field == field
    assert told.startswith(f"{field}: ") or told.startswith(f"{field} is missing")
    assert "\n" not in told


# --- the seam
# -----------------------------------------------------------------------------------------------


class Quitter:
    """Follows a motion well for a while, and then gives up."""

    name, caution = "quitter", ""

    def __init__(self, patience, words="it was tired"):
        self.patience, self.words = patience, words
        self.spans = []

    def integrate(self, motion, parameters, start, end):
        self.spans.append((start[0], end))
        last = min(self.patience, end)
        for arc in make_integrator("dop853", 1e-10).integrate(motion, parameters, start, last):
            tired = arc.solution.end >= last < end
            yield replace(arc, failure=self.words if tired else None, evaluations=7)


class Nameless:
    integrate, caution = Quitter.integrate, ""


class Careless:
    integrate, name = Quitter.integrate, "careless"


class Silent(Careless):
    caution = None


class Idle:
    name, caution, integrate = "idle", "", None


@pytest.mark.parametrize(
    "incomplete", [Nameless(), Careless(), Silent(), Idle(), Quitter, object(), 3]
)
def test_integrators_that_lack_something_are_refused_before_the_run(incomplete):
    needed = "a method integrate and the texts name and caution"
    with pytest.raises(tt.InvalidInput, match=needed) as refusal:
        tt.simulate(report(), 0.5, integrator=incomplete)
    assert refusal.value.field == "integrator"


UNIT = math.sqrt(REPORT.shape.radius / 9.8)


def test_any_integrator_can_be_passed_in():
    patient = Quitter(math.inf)
    run = tt.simulate(report(), 0.5, samples=11, integrator=patient)
    expected = tt.simulate(report(), 0.5, samples=11, integrator="dop853", tolerance=1e-10)
    np.testing.assert_array_equal(run.tilt, expected.tilt)
    assert run.attrs["integrator"] == "quitter"
    assert "tolerance" not in run.attrs
    assert run.evaluations.item() == 7
    # It works in the top's own unit of time.
    assert patient.spans == [(0.0, pytest.approx(0.5 / UNIT))]


@pytest.mark.parametrize("words", ["it was tired", NOT_FINITE])
def test_failed_run_has_all_that_was_computed_before_it_failed(words):
    """Whatever the integrator's words are: a last state that is finite is a sample."""
    run = tt.simulate(report(), 1.0, samples=11, integrator=Quitter(0.57 / UNIT, words))
    whole = tt.simulate(report(), 1.0, samples=11, integrator="dop853", tolerance=1e-10)
    assert run.attrs["status"] == "failed"
    assert words in run.attrs["message"]
    assert "\n" not in run.attrs["message"]
    np.testing.assert_allclose(run.time, [0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.57], rtol=1e-14)
    np.testing.assert_allclose(run.tilt[:-1], whole.tilt[:6], rtol=0, atol=1e-9)
    for name in UNITS:
        assert np.all(np.isfinite(run[name])), name


def runaway():
    """A top pushed so fast over so rough a table that, held to it, it is wrenched apart."""
    return report(0.0, mu=2.0, tilt=0.1, slip=(2.0, 0.0))


@pytest.mark.parametrize("integrator", EXACT_INTEGRATORS)
def test_motion_that_becomes_singular_is_a_failed_run_and_no_exception(integrator):
    """Where the table may pull and rub however hard, friction can grow beyond all bounds."""
    run = tt.simulate(runaway(), 5.0, integrator=integrator)
    assert run.attrs["status"] == "failed"
    assert 0 < float(run.time[-1]) < 5.0
    assert np.all(np.diff(run.time) > 0)
    for name in set(UNITS) - NOT_AT_THE_POLES:
        assert np.all(np.isfinite(run[name])), name
    start = run.isel(time=slice(0, run.sizes["time"] // 2))
    assert start.sizes["time"] > 3
    np.testing.assert_allclose(start.energy, start.energy[0] + start.work, rtol=1e-9)


def test_steps_that_rounding_of_time_swallows_are_no_more_than_a_few_thousand():
    run = tt.simulate(runaway(), 5.0, samples=11, integrator="taylor", tolerance=1e-9)
    assert run.attrs["status"] == "failed"
    assert "the step size fell to nothing" in run.attrs["message"]
    assert int(run["steps"]) < 10_000
    assert np.all(np.diff(run.time) > 0)
    exact = tt.simulate(runaway(), 5.0, samples=11, integrator="taylor")
    assert float(run["end_time"]) == pytest.approx(float(exact["end_time"]), rel=1e-6)
