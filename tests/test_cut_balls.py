"""Balls of which a part is cut off: they stand on the edge of the cut beyond it."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from typer.testing import CliRunner

import tippetop as tt
from campaigns import among
from tippetop.cli.commands import app

RADIUS, CENTER, CUT = 0.02, 0.004, 1.7
BALL = tt.Meridian(tubes=[RADIUS, 0.0], tilts=[CUT], center=CENTER)
EDGE = tt.Ring(radius=RADIUS * math.sin(CUT), center=CENTER - RADIUS * math.cos(CUT))
STEM = tt.Sphere(radius=0.003, center=0.03)
MOMENTS = {"mass": 0.02, "I1": 4e-6, "I3": 3.5e-6}


def of(*shapes, friction=None, **launch):
    body = tt.Body(shape=list(shapes) if len(shapes) > 1 else shapes[0], **MOMENTS)
    law = friction or tt.ViscousFriction(mu=0.3)
    return tt.Problem(body=body, friction=law, launch=tt.Launch(**launch))


def test_the_support_function_is_that_of_the_ball_and_of_the_edge():
    ball = tt.Sphere(radius=RADIUS, center=CENTER)
    for tilt in (0.3, 1.2, 1.69, 1.71, 2.2, 3.0):
        c = math.cos(tilt)
        meant = (ball if tilt < CUT else EDGE).surface
        for name in ("height", "slope", "curvature"):
            value = getattr(BALL.surface, name)(c)
            assert value == pytest.approx(getattr(meant, name)(c), rel=1e-12, abs=1e-15)
    c = math.cos(CUT)
    for name in ("height", "slope"):
        ball_value, edge = (getattr(one.surface, name)(c) for one in (ball, EDGE))
        assert ball_value == pytest.approx(edge, rel=1e-13)


@pytest.mark.parametrize(
    ("fields", "sentence"),
    [
        ({"tubes": [0.02, 0.0], "tilts": [1.0, 2.0]}, "1 tilts between 2 arcs"),
        ({"tubes": [0.02, 0.0, 0.01], "tilts": [2.0, 1.0]}, "an angle above the one before"),
        ({"tubes": [0.0, 0.0], "tilts": [2.0]}, "of which one is more than 0"),
        ({"tubes": [0.01, 0.02], "tilts": [2.0]}, "an arc beside the axis"),
    ],
)
def test_arcs_that_are_no_body_are_refused(fields, sentence):
    with pytest.raises(tt.InvalidInput, match=sentence):
        tt.Meridian(center=0.0, **fields)


@pytest.mark.parametrize("shape", [tt.Sphere(radius=RADIUS, center=CENTER), EDGE])
def test_a_run_on_one_arc_is_that_of_its_surface(shape):
    tilt = 0.3 if shape.kind == "sphere" else 2.3
    launch = {"tilt": tilt, "spin": 60.0, "precession": 3.0}
    one, other = (tt.simulate(of(body, **launch), 0.08, samples=9) for body in (BALL, shape))
    for name in ("tilt", "angular_momentum", "velocity"):
        np.testing.assert_allclose(one[name], other[name], rtol=1e-11, atol=1e-14)


def rates(t, y, problem):
    """Newton's and Euler's equations on viscous friction, of a body that touches at one point.

    State: axis n, angular momentum L, horizontal velocity; in the frame of the table.
    """
    n, moment, v = y[:3], y[3:6], y[6:8]
    m, I1, I3 = MOMENTS["mass"], MOMENTS["I1"], MOMENTS["I3"]
    c = n[2]
    s = math.hypot(n[0], n[1])
    if c > math.cos(CUT):
        h, h1, h2 = RADIUS - CENTER * c, -CENTER, 0.0
    else:
        h = EDGE.radius * s - EDGE.center * c
        h1, h2 = -EDGE.radius * c / s - EDGE.center, -EDGE.radius / s**3
    arm = -h1 * (n - [0, 0, c]) - [0, 0, h]
    omega = moment / I1 + (1 / I3 - 1 / I1) * (moment @ n) * n
    turn = np.cross(omega, n)
    velocity = np.array([*v, h1 * turn[2]])
    slip = (velocity + np.cross(omega, arm))[:2]
    pull = np.array([*(-problem.friction.mu * slip), 1.0])

    def accelerations(normal):
        """The rates, and what the gap's second derivative lacks."""
        rate = np.cross(arm, normal * pull)
        acceleration = normal * pull / m - [0, 0, problem.gravity]
        omega1 = rate / I1 + (1 / I3 - 1 / I1) * (
            (rate @ n + moment @ turn) * n + (moment @ n) * turn
        )
        turn1 = np.cross(omega1, n) + np.cross(omega, turn)
        return rate, acceleration, acceleration[2] - h2 * turn[2] ** 2 - h1 * turn1[2]

    at0, at1 = accelerations(0.0)[2], accelerations(1.0)[2]
    rate, acceleration, _ = accelerations(-at0 / (at1 - at0))
    return np.concatenate([turn, rate, acceleration[:2]])


def test_the_contact_passes_onto_the_edge_as_an_independent_integration_says():
    """The ball falls over its edge and comes back; the equations are integrated part by part."""
    problem = of(BALL, tilt=1.6, spin=30.0, tilt_rate=14.0)
    duration = 0.06
    run, solution = tt.simulate(problem, duration, dense=True, samples=3)
    assert run.attrs["status"] == "completed"
    assert int(run["flights"]) == 0
    assert run.sizes["event"] == 0
    first = solution(0.0)
    y = np.concatenate([first.axis, first.angular_momentum, first.velocity[:2]])
    time, passes = 0.0, 0
    while time < duration:

        def passing(t, y, problem):
            return y[2] - math.cos(CUT)

        passing.terminal = True
        nudge = 1e-9 if passes else 0.0
        part = solve_ivp(rates, (time, time + nudge), y, args=(problem,), rtol=1e-13, atol=1e-16)
        y, time = part.y[:, -1], part.t[-1]
        part = solve_ivp(
            rates, (time, duration), y, "DOP853", args=(problem,), events=passing,
            rtol=1e-13, atol=1e-16,
        )  # fmt: skip
        y, time = part.y[:, -1], part.t[-1]
        passes += part.status == 1
    assert passes >= 1
    last = solution(duration)
    assert last.axis == pytest.approx(y[:3], abs=1e-9)
    assert last.angular_momentum == pytest.approx(y[3:6], abs=1e-9 * np.abs(y[3:6]).max())
    assert last.velocity[:2] == pytest.approx(y[6:8], abs=1e-9)


@pytest.mark.parametrize(
    "friction",
    among(
        [
            tt.CoulombFriction(mu=0.3),
            tt.ViscousFriction(mu=0.3),
            tt.ContensouFriction(mu=0.3, patch_radius=5e-4, pressure="ellipsoidal"),
        ],
        check=1,
    ),
)
def test_what_is_conserved_on_ball_edge_and_stem(friction):
    problem = of(BALL, STEM, friction=friction, tilt=1.65, spin=40.0, tilt_rate=12.0)
    run = tt.simulate(problem, 0.5)
    assert run.attrs["status"] == "completed"
    assert float(run["energy_error"]) < 1e-12
    assert float(run["gap"].min()) > -1e-14
    assert float(run["max_tilt"]) > CUT
    swept = tt.sweep(problem, {"launch.spin": [40.0]}, duration=0.5)
    assert float(swept["final_tilt"][0]) == pytest.approx(float(run["final_tilt"]), abs=1e-8)


# A ball of 20 mm cut 8 mm above its middle, with a stem of 3 mm: half of its outline, mm.
RIM = math.sqrt(20.0**2 - 8.0**2)
DRAWN = [(0, -20), (20, 0, 20), (RIM, 8, 20), (3, 8), (3, 23), (0, 26, 3)]


def test_the_commonest_drawing_is_simulated_without_being_asked(tmp_path):
    body = tt.Body.turned(DRAWN, 700.0, unit="mm")
    ball, stem = body.shapes
    assert ball.tubes == pytest.approx((0.02, 0.0), abs=1e-15)
    assert ball.tilts == pytest.approx((math.pi - math.acos(8.0 / 20.0),))
    assert (stem.kind, stem.radius) == ("sphere", pytest.approx(0.003))
    rows = [",".join(map(str, point)) for point in DRAWN]
    (tmp_path / "a.csv").write_text("\n".join(["r (mm),z (mm),radius", *rows]))
    done = CliRunner().invoke(app, ["body", str(tmp_path / "a.csv"), "--density", "beech"])
    assert done.exit_code == 0
    assert "Cannot be simulated" not in done.stdout
    assert "edge of the cut ball" in done.stdout.replace("\n", " ")
    run = tt.simulate(of(*body.shapes, tilt=0.1, spin=200.0), 1.0)
    assert run.attrs["status"] == "completed"


def test_arcs_of_drawings_have_the_support_function_of_the_profile():
    """Cut balls, cones and lenses, against the largest support of many points of the outline."""
    lens = [(0, -10), (math.sqrt(300.0), 0, 20), (0, 10, 20)]
    cone = [(0, -20), (12, -16, 20), (16, 4), (3, 8), (3, 23), (0, 26, 3)]
    fillet = [(0, -20), (20, 0, 20), (RIM, 8, 20), (RIM - 3, 10, 3), (3, 10), (3, 25), (0, 28, 3)]
    for profile in (DRAWN, lens, cone, fillet):
        piece = tt.Workpiece(profile=profile, density=700.0, unit="mm", tolerance=0.0)
        body = tt.Body.turned(piece)
        points = piece.outline.points(4000)
        center = piece.mass_properties.center
        for tilt in np.linspace(0.01, math.pi - 0.01, 57).tolist():
            s, c = math.sin(tilt), math.cos(tilt)
            deepest = float((points.real * s - (points.imag - center) * c).max())
            height = max(shape.surface.height(c) for shape in body.shapes)
            assert height == pytest.approx(deepest, abs=2e-9), (profile, tilt)


@pytest.mark.parametrize("friction", [tt.CoulombFriction(mu=0.3), tt.ViscousFriction(mu=0.3)])
def test_a_run_ends_where_a_cut_ball_would_lie_on_its_cut(friction):
    problem = of(BALL, friction=friction, tilt=3.0, spin=0.0, tilt_rate=2.0)
    run = tt.simulate(problem, 1.0)
    assert run.attrs["status"] == "failed"
    assert "flat end of a surface of arcs" in run.attrs["message"]
    assert float(run["final_tilt"]) == pytest.approx(math.pi - 1e-4, abs=1e-7)


def test_a_cut_ball_is_not_launched_lying_on_its_cut():
    with pytest.raises(tt.InvalidInput, match="flat end of a surface of arcs") as refusal:
        of(BALL, tilt=math.pi, spin=10.0)
    assert refusal.value.field == "launch.tilt"
    of(BALL, tilt=0.0, spin=10.0)
    of(BALL, STEM, tilt=math.pi, spin=10.0)


def test_the_end_of_a_cut_ball_is_that_of_the_ball_if_it_stays_on_it():
    launch = {"tilt": 0.1, "spin": 20.0}
    ball = tt.Sphere(radius=RADIUS, center=CENTER)
    assert tt.predict(of(BALL, **launch)) == tt.predict(of(ball, **launch))
    with pytest.raises(tt.InvalidInput, match=r"leaves its sphere at a tilt of 1\.7 rad"):
        tt.predict(of(BALL, tilt=0.1, spin=300.0))
    with pytest.raises(tt.InvalidInput, match="an eccentric sphere"):
        tt.predict(of(BALL, tilt=2.0, spin=20.0))


@pytest.mark.parametrize("friction", [tt.ViscousFriction(mu=0.3), tt.CoulombFriction(mu=0.3)])
@pytest.mark.parametrize("tilt", [math.pi, math.pi - 1e-9])
def test_a_run_ends_where_a_cut_ball_falls_on_its_cut(friction, tilt):
    falling = of(BALL, friction=friction, tilt=tilt, spin=0.0, gap=0.002)
    run = tt.simulate(falling, 0.5, samples=3)
    assert run.attrs["status"] == "failed"
    assert "flat end of a surface of arcs" in run.attrs["message"]
    assert run["event_kind"].values.tolist() == ["touchdown"]
    assert float(run["end_time"]) == pytest.approx(math.sqrt(2 * 0.002 / falling.gravity), rel=1e-9)


def test_a_cut_ball_has_no_inverted_spin():
    """It would lie on its cut, which is no spin on a point as that of its edge or of a ball."""
    ball = of(BALL, tilt=0.1, spin=150.0)
    (upright,) = tt.steady_states(ball)
    assert upright.kind == "upright"
    edge = of(EDGE, tilt=0.1, spin=150.0)
    assert tt.steady_states(edge) == []
    whole = of(tt.Sphere(radius=RADIUS, center=CENTER), tilt=0.1, spin=150.0)
    *_, inverted = tt.steady_states(whole)
    assert inverted.kind == "inverted"
    with pytest.raises(tt.InvalidInput, match="touches in one point"):
        tt.spectrum(ball, inverted)
    spins = tt.critical_spins(ball)
    assert spins.inverted == math.inf
    # The upright spin does not know of the cut.
    values, complete = (
        np.sort_complex(tt.spectrum(one, upright).eigenvalues) for one in (ball, whole)
    )
    np.testing.assert_allclose(values, complete, rtol=1e-9)
