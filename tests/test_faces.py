"""Bodies that lie on a flat face: how they slide, spin and stop there."""

import math

import numpy as np
import pytest
import xarray as xr
from scipy.integrate import solve_ivp

import tippetop as tt
from planar_rim import time_to_tilt

MASS, RADIUS, THICKNESS, GRAVITY = 0.05, 0.02, 0.005, 9.8
MU = 0.2
KNOWN_RATIOS = {0.0: 0.6530, 0.5: 0.7745, 0.9: 0.9508}
"""Ratios v / (a1 w) at which faces stop, by inner radius over outer (Farkas et al. 2003)."""


def puck(inner: float = 0.0, axial: float | None = None) -> tt.Body:
    """Return a flat body whose I3 is (a0^2 + a1^2)/2, or so many m a1^2."""
    axial = (1 + inner**2) / 2 if axial is None else axial
    edges = [
        tt.Ring(radius=RADIUS, center=side * THICKNESS / 2, inner_radius=inner * RADIUS)
        for side in (-1, 1)
    ]
    inertia = axial * MASS * RADIUS**2
    return tt.Body(mass=MASS, shape=edges, I1=inertia / 2 + MASS * THICKNESS**2 / 12, I3=inertia)


def launched(slip: float, spin: float, body: tt.Body | None = None, **others) -> tt.Problem:
    """Return a flat launch."""
    fields = {"friction": tt.CoulombFriction(mu=MU), "gravity": GRAVITY} | others
    launch = tt.Launch(tilt=0.0, azimuth=0.4, spin=spin, slip=(slip, 0.0))
    return tt.Problem(body=body or puck(), launch=launch, **fields)


@pytest.mark.parametrize("slip", [1e-3, 0.3, 20.0])
def test_without_spin_a_face_stops_as_a_point_does(slip: float) -> None:
    run = tt.simulate(launched(slip, 0.0), 20.0, samples=501)
    assert run.attrs["status"] == "at_rest"
    assert run["event_kind"].values.tolist() == ["rests"]
    assert float(run["end_time"]) == pytest.approx(slip / (MU * GRAVITY), rel=1e-12)
    way = math.hypot(float(run["x"][-1]), float(run["y"][-1]))
    assert way == pytest.approx(slip**2 / (2 * MU * GRAVITY), rel=1e-12)
    assert float(run["energy_lost_drilling"]) == 0.0


@pytest.mark.parametrize("spin", [1e-2, -40.0, 3000.0])
def test_without_slip_a_disk_stops_after_the_known_time(spin: float) -> None:
    run = tt.simulate(launched(0.0, spin), 50.0, samples=501)
    assert run.attrs["status"] == "at_rest"
    expected = 3 * RADIUS * abs(spin) / (4 * MU * GRAVITY)
    assert float(run["end_time"]) == pytest.approx(expected, rel=1e-12)
    lost = 0.25 * MASS * RADIUS**2 * spin**2
    assert float(run["energy_lost_drilling"]) == pytest.approx(lost, rel=1e-12)
    assert float(run["energy"][-1]) == pytest.approx(MASS * GRAVITY * THICKNESS / 2, rel=1e-14)


@pytest.mark.parametrize("inner", KNOWN_RATIOS)
def test_slip_and_spin_end_together_at_the_known_ratio(inner: float) -> None:
    random = np.random.default_rng(11)
    for _ in range(6):
        ratio, slip = 10.0 ** random.uniform(-0.5, 0.6), 10.0 ** random.uniform(-1.5, 0.5)
        problem = launched(slip, slip / (ratio * RADIUS), puck(inner))
        run, solution = tt.simulate(problem, 50.0, samples=2, dense=True)
        assert run.attrs["status"] == "at_rest"
        assert float(run["energy_error"]) < 1e-14
        late = solution(float(run["end_time"]) * (1.0 - 1e-9))
        speed, drilled = np.hypot(*late.velocity[:2]), RADIUS * late.spin
        assert float(np.hypot(speed, drilled)) < 1e-8 * slip
        assert float(speed / drilled) == pytest.approx(KNOWN_RATIOS[inner], abs=1e-4)


@pytest.mark.parametrize("inner", [0.0, 0.5])
def test_a_face_slides_on_from_where_rounding_decides_what_prevails(inner: float) -> None:
    """Where a point of an edge rests, v = a w, its law goes over from one form to another; steps
    become short there, and one may end on the very number.
    """
    pressure, radius = ("uniform", inner * RADIUS) if inner else ("rim", RADIUS)
    for place in range(40, 80):
        spin = 0.3 / radius * (1.0 + place * 2.0**-53)
        problem = launched(0.3, spin, puck(inner), contact=tt.Contact(face_pressure=pressure))
        assert tt.simulate(problem, 0.01, samples=2).attrs["status"] == "completed", place


def test_a_rim_stops_where_its_rear_point_rests() -> None:
    """Of a ring whose mass is its rim v = a w: the instantaneous centre is on it."""
    problem = launched(0.5, 30.0, puck(0.9, 0.95), contact=tt.Contact(face_pressure="rim"))
    heavy = problem.replace({"body.I3": MASS * RADIUS**2, "body.I1": 0.6 * MASS * RADIUS**2})
    run, solution = tt.simulate(heavy, 50.0, samples=2, dense=True)
    assert run.attrs["status"] == "at_rest"
    late = solution(float(run["end_time"]) * (1.0 - 1e-8))
    speed = np.hypot(*late.velocity[:2])
    assert float(speed / (RADIUS * late.spin)) == pytest.approx(1.0, abs=1e-12)


def test_friction_is_least_where_slip_and_drilling_share_it() -> None:
    """A puck that spins slides farther: 1 m/s with 100 rad/s goes beyond v^2 / (2 mu g)."""
    ways = []
    for spin in (0.0, 50.0, 100.0):
        run = tt.simulate(launched(0.6, spin), 20.0, samples=2)
        ways.append(math.hypot(float(run["x"][-1]), float(run["y"][-1])))
    assert ways[0] < ways[1] < ways[2]


@pytest.mark.parametrize("inner", [0.0, 0.6])
def test_on_viscous_friction_slip_and_spin_decay_each_by_itself(inner: float) -> None:
    mu, time = 0.5, 0.3
    problem = launched(0.4, 30.0, puck(inner, 0.4), friction=tt.ViscousFriction(mu=mu))
    run = tt.simulate(problem, time, samples=11)
    assert run.attrs["status"] == "completed"
    assert set(run["mode"].values.tolist()) == {"sliding_flat_on_0"}
    times = run["time"].values
    slip = np.hypot(run["velocity"].sel(space="x"), run["velocity"].sel(space="y"))
    assert slip.values == pytest.approx(0.4 * np.exp(-mu * GRAVITY * times), rel=1e-12)
    arm = 0.5 * (1 + inner**2) / 0.4
    spin = 30.0 * np.exp(-mu * GRAVITY * arm * times)
    assert run["spin"].values == pytest.approx(spin, rel=1e-12)
    assert float(run["energy_error"]) < 1e-15


def test_a_regularized_face_comes_near_the_dry_one() -> None:
    dry = tt.simulate(launched(0.3, 5.0), 0.1, samples=3)
    smooth = launched(0.3, 5.0, friction=tt.RegularizedCoulombFriction(mu=MU, eps=1e-6))
    run = tt.simulate(smooth, 0.1, samples=3)
    assert float(run["energy_error"]) < 1e-14
    assert float(run["final_spin"]) == pytest.approx(float(dry["final_spin"]), rel=1e-4)
    assert float(run["energy"][-1]) == pytest.approx(float(dry["energy"][-1]), rel=1e-4)


def test_a_patch_on_a_face_is_the_face() -> None:
    patch = tt.ContensouFriction(mu=MU, patch_radius=1e-4)
    ends = [
        float(tt.simulate(launched(0.3, 20.0, friction=law), 5.0, samples=2)["end_time"])
        for law in (tt.CoulombFriction(mu=MU), patch)
    ]
    assert ends[0] == ends[1]


def test_a_body_launched_at_rest_on_its_face_rests() -> None:
    run = tt.simulate(launched(0.0, 0.0), 5.0, samples=3)
    assert run.attrs["status"] == "at_rest"
    assert float(run["end_time"]) < 1e-12
    assert str(tt.describe(run)) == (
        "The top starts flat on its face. It comes to rest on its face at 0 ms."
    )


def test_a_wobbling_disk_goes_on_spinning_on_its_face() -> None:
    """It comes down with the spin that it has then, which only drilling takes from it."""
    disk = tt.Body(mass=0.1, shape=tt.Ring(radius=0.02, center=-0.005), I1=1.2e-5, I3=2e-5)
    sine = 1e-6
    launch = tt.Launch(
        tilt=sine,
        precession=2 * math.sqrt(GRAVITY / (0.02 * sine)),
        spin=-20.0,
        velocity=(0.0, 0.0, 0.0),
    )
    problem = tt.Problem(
        body=disk, friction=tt.CoulombFriction(mu=0.2), launch=launch, rolling_resistance=1e-4
    )
    run = tt.simulate(problem, 20.0, samples=4001)
    kinds = run["event_kind"].values.tolist()
    assert run.attrs["status"] == "at_rest"
    assert kinds[-2:] == ["lies down", "rests"]
    assert float(run["energy_error"]) < 1e-9
    down = float(run["event_time"][-2])
    after = run.sel(time=slice(down, None))
    assert set(after["mode"].values.tolist()) == {"sliding_flat", "resting_flat"}
    spin = abs(float(after["spin"][0]))
    assert spin > 5.0


HEIGHT = 0.05
TALL = tt.Body(mass=0.1, shape=tt.Ring(radius=RADIUS, center=-HEIGHT), I1=1e-4, I3=2e-5)


STEEP = math.atan(RADIUS / HEIGHT) + 0.05
"""A slope on which no force in the face of `TALL` holds it."""


@pytest.mark.parametrize(
    ("mu", "slope", "sticks"), [(1.5, STEEP, True), (0.42, STEEP, True), (0.42, 0.53, False)]
)
def test_a_body_at_rest_tips_down_a_steep_slope(mu: float, slope: float, sticks: bool) -> None:
    """It turns about its rim where friction holds that, if not the face, else slides and tips."""
    table = tt.Table(slope=slope, azimuth=2.0)
    problem = launched(0.0, 0.0, TALL, table=table, friction=tt.CoulombFriction(mu=mu))
    run = tilted(problem, 0.1)
    assert run["event_kind"].values[0] == "tips over its rim"
    assert ("stick" in run["event_kind"].values) == sticks
    expected = time_to_tilt(TALL, 0.1, mu=math.inf if sticks else mu, gravity=GRAVITY, slope=slope)
    assert float(run["end_time"]) == pytest.approx(expected, rel=1e-9)
    assert float(run["energy_error"]) < 1e-13


def test_a_body_slides_down_a_steep_slope_with_little_friction() -> None:
    mu = 0.2
    table = tt.Table(slope=STEEP)
    run = tt.simulate(
        launched(0.0, 0.0, TALL, table=table, friction=tt.CoulombFriction(mu=mu)), 0.5, samples=3
    )
    assert run.attrs["status"] == "completed"
    assert run["event_kind"].values.tolist() == ["slip"]
    acceleration = GRAVITY * (math.sin(STEEP) - mu * math.cos(STEEP))
    assert float(run["x"][-1]) == pytest.approx(acceleration / 8, rel=1e-9)


@pytest.mark.parametrize(
    ("rate", "azimuth"), [pytest.param(2.0, 0.4, marks=pytest.mark.slow), (-3.5, 0.4)]
)
def test_a_body_launched_flat_with_a_rate_of_tilt_rocks(rate: float, azimuth: float) -> None:
    """Its rim stays on the table: it rises, turns round and lands, or falls over."""
    problem = launched(0.0, 0.0, TALL, friction=tt.CoulombFriction(mu=2.0)).replace(
        {"launch.tilt_rate": rate, "launch.azimuth": azimuth}
    )
    start = problem.start()
    assert start.velocity[2] == pytest.approx(abs(rate) * RADIUS, rel=1e-15)
    reach = 0.03
    run, solution = tt.simulate(
        problem, 3.0, samples=21, dense=True, until=lambda state: state.tilt - reach
    )
    assert run["event_kind"].values[0] == "tips over its rim"
    expected = time_to_tilt(TALL, reach, rate=abs(rate), gravity=GRAVITY)
    assert float(run["end_time"]) == pytest.approx(expected, rel=1e-10)
    lean = float(solution(0.5 * expected).azimuth) - azimuth
    assert math.cos(lean) == pytest.approx(math.copysign(1.0, rate), abs=1e-12)
    assert float(run["energy_error"]) < 1e-12


def test_a_body_tips_where_its_friction_grows_to_that() -> None:
    """Down a slope under viscous friction: the tilt grows with the cube of the time."""
    mu, slope = 0.5, 0.5
    east, down = GRAVITY * math.sin(slope), GRAVITY * math.cos(slope)
    limit = RADIUS / (mu * HEIGHT)
    final = east / (mu * down)
    assert limit < final
    crossing = -math.log(1.0 - limit / final) / (mu * down)

    def rates(_: float, y: list[float]) -> list[float]:
        theta, speed, velocity = y
        across = RADIUS * math.cos(theta) - HEIGHT * math.sin(theta)
        height = RADIUS * math.sin(theta) + HEIGHT * math.cos(theta)
        friction = mu * (velocity - height * speed)
        arm = friction * height - across
        normal = TALL.mass * (down - height * speed**2)
        normal /= 1.0 - TALL.mass * across * arm / TALL.I1
        return [speed, normal * arm / TALL.I1, east - friction * normal / TALL.mass]

    def reached(_: float, y: list[float]) -> float:
        return y[0] - 0.5

    reached.terminal = True
    options = {"method": "DOP853", "rtol": 1e-13, "atol": 1e-16, "events": reached}
    tips = solve_ivp(rates, (0.0, 5.0), [0.0, 0.0, limit], **options).t_events[0][0]
    friction, table = tt.ViscousFriction(mu=mu), tt.Table(slope=slope, azimuth=0.3)
    run = tilted(launched(0.0, 0.0, TALL, friction=friction, table=table), 0.5)
    assert run["event_kind"].values.tolist() == ["tips over its rim", "until"]
    assert float(run["event_time"][0]) == pytest.approx(crossing, rel=1e-12)
    assert float(run["end_time"]) == pytest.approx(crossing + tips, rel=1e-9)
    assert float(run["energy_error"]) < 1e-12


def tilted(problem: tt.Problem, tilt: float) -> xr.Dataset:
    """Return the run to the instant at which the tilt is reached."""
    return tt.simulate(problem, 3.0, samples=21, until=lambda state: state.tilt - tilt)


@pytest.mark.parametrize("mu", [0.42, 0.6, 0.9])
def test_a_tall_body_tips_over_the_front_of_its_rim(mu: float) -> None:
    run = tilted(launched(3.0, 0.0, TALL, friction=tt.CoulombFriction(mu=mu)), 0.5)
    assert run.attrs["status"] == "stopped"
    assert run["event_kind"].values[0] == "tips over its rim"
    assert float(run["end_time"]) == pytest.approx(
        time_to_tilt(TALL, 0.5, mu=mu, gravity=GRAVITY), rel=1e-11
    )
    assert float(run["energy_error"]) < 1e-14
    lean = math.remainder(float(run["azimuth"][-1]) - 0.4, 2 * math.pi)
    assert abs(lean) < 1e-9


def test_a_body_tips_where_its_pressure_would_leave_the_face() -> None:
    """At mu h > a1, whichever face it lies on."""
    for mu, tips in ((0.39, False), (0.41, True)):
        run = tt.simulate(launched(0.5, 0.0, TALL, friction=tt.CoulombFriction(mu=mu)), 2.0)
        assert ("tips over its rim" in run["event_kind"].values) == tips
        if not tips:
            assert run.attrs["status"] == "at_rest"
    turned = TALL.model_copy(update={"shape": tt.Ring(radius=RADIUS, center=HEIGHT)})
    upright, inverted = (
        tilted(launched(3.0, 0.0, body, friction=tt.CoulombFriction(mu=0.6)), at)
        if at < 1.0
        else tilted(
            launched(3.0, 0.0, body, friction=tt.CoulombFriction(mu=0.6)).replace(
                {"launch.tilt": math.pi}
            ),
            at,
        )
        for body, at in ((TALL, 0.5), (turned, math.pi - 0.5))
    )
    assert float(inverted["end_time"]) == pytest.approx(float(upright["end_time"]), rel=1e-12)


@pytest.mark.parametrize("spin", [10.0, 60.0, -100.0])
def test_a_spinning_body_tips_over_the_point_of_its_rim_that_slips_outwards(spin: float) -> None:
    """There v.e_t = -w a1: no friction turns the axis sideways at first."""
    problem = launched(3.0, spin, TALL, friction=tt.CoulombFriction(mu=0.6))
    run, solution = tt.simulate(problem, 0.02, samples=3, dense=True)
    assert run["event_kind"].values.tolist() == ["tips over its rim"]
    assert float(run["energy_error"]) < 1e-14
    soon = solution(1e-5)
    lean = math.remainder(float(soon.azimuth) - 0.4, 2 * math.pi)
    assert math.sin(lean) == pytest.approx(spin * RADIUS / 3.0, abs=1e-4)


def test_an_annulus_has_a_width() -> None:
    with pytest.raises(tt.InvalidInput, match="inner_radius"):
        tt.Ring(radius=0.02, inner_radius=0.02)


@pytest.mark.parametrize("azimuth", [0.0, 2.0])
def test_on_a_slope_a_face_slides_down_or_is_held(azimuth: float) -> None:
    """It accelerates by g (sin beta - mu cos beta), and is held where tan beta < mu."""
    for slope, slides in ((math.atan(MU) - 1e-3, False), (0.3, True)):
        table = tt.Table(slope=slope, azimuth=azimuth)
        run = tt.simulate(launched(0.0, 0.0, table=table), 1.0, samples=3)
        assert run.attrs["status"] == ("completed" if slides else "at_rest")
        if not slides:
            continue
        acceleration = GRAVITY * (math.sin(slope) - MU * math.cos(slope))
        way = math.hypot(float(run["x"][-1]), float(run["y"][-1]))
        assert way == pytest.approx(acceleration / 2, rel=1e-9)
        assert float(run["energy_error"]) < 1e-12


def test_a_puck_stops_on_a_slope_where_friction_holds_it() -> None:
    table = tt.Table(slope=0.1, azimuth=1.0)
    run = tt.simulate(launched(0.4, 40.0, table=table), 20.0, samples=3)
    assert run.attrs["status"] == "at_rest"
    assert float(run["energy_error"]) < 1e-13


@pytest.mark.parametrize("friction", [tt.CoulombFriction(mu=0.9), tt.ViscousFriction(mu=0.9)])
def test_a_face_that_drills_fast_is_not_tipped(friction: tt.Friction) -> None:
    """No point of its rim slips outwards, though friction on the whole face would move the
    pressure there: mu h F > a1 with v < a1 w.
    """
    speed, spin = 0.9, 50.0
    run = tt.simulate(launched(speed, spin, TALL, friction=friction), 2.0, samples=3)
    is_dry = friction.kind == "coulomb"
    assert run.attrs["status"] == ("at_rest" if is_dry else "completed")
    assert run["event_kind"].values.tolist() == ["pressure at the rim"] + ["rests"] * is_dry
    assert float(run["energy_error"]) < 1e-13
    if not is_dry:
        time = 2.0
        slip = math.hypot(*run["velocity"].values[-1, :2])
        assert slip == pytest.approx(speed * math.exp(-0.9 * GRAVITY * time), rel=1e-11)


def peg(half: float, axial: float = 1.0) -> tt.Body:
    """Return a slender body between two rims, whose I3 is m R^2 / 2 times a factor."""
    mass, radius = 0.02, 0.01
    rims = [tt.Ring(radius=radius, center=side * half) for side in (1, -1)]
    inertia = mass * radius**2 / 2
    transverse = inertia / 2 + mass * half**2 / 3
    return tt.Body(mass=mass, shape=rims, I1=transverse, I3=axial * inertia)


@pytest.mark.parametrize(
    ("friction", "launch"),
    [
        (tt.CoulombFriction(mu=0.5), {}),
        (tt.CoulombFriction(mu=0.5), {"spin": 20.0}),
        (tt.CoulombFriction(mu=0.5), {"slip": (0.0, 0.1)}),
        (tt.ViscousFriction(mu=0.3), {}),
        (tt.RegularizedCoulombFriction(mu=0.3, eps=1e-3), {"spin": 20.0}),
    ],
)
def test_a_rim_that_the_table_would_have_to_pull_leaves_it(friction: tt.Friction, launch) -> None:
    """It flies, as its middle rises at a1 times the rate of tilt and its centre of mass falls
    freely: h w^2 > g.
    """
    rate, time = 40.0, 0.01
    start = tt.Launch(**{"tilt": 0.0, "spin": 0.0, "tilt_rate": rate} | launch)
    problem = tt.Problem(body=peg(0.03), friction=friction, launch=start, gravity=GRAVITY)
    run = tt.simulate(problem, time, samples=3)
    assert run["event_kind"].values.tolist() == ["tips over its rim", "liftoff"]
    assert run["event_time"].values.tolist() == [0.0, 0.0]
    rises = 0.01 * rate * time - GRAVITY * time**2 / 2
    assert float(run["height"][-1]) == pytest.approx(0.03 + rises, rel=1e-12)


@pytest.mark.parametrize("mu", [1.31, 1.5, 3.0])
def test_a_body_whose_rim_friction_jams_is_struck_and_turns_about_it(mu: float) -> None:
    """Above mu = (I1/(m a1) + a1)/h an impulse ends slip at once, without moment about that point
    of the rim.
    """
    speed, half, radius = 0.5, 0.02, 0.01
    body, start = peg(half), tt.Launch(tilt=0.0, spin=0.0, slip=(speed, 0.0))
    problem = tt.Problem(body=body, friction=tt.CoulombFriction(mu=mu), launch=start)
    run = tt.simulate(problem, 0.002, samples=2)
    assert run["event_kind"].values.tolist() == ["tips over its rim", "impact", "stick"]
    about_rim = body.I1 + body.mass * (half**2 + radius**2)
    rate = body.mass * half * speed / about_rim
    impulse = body.mass * radius * rate
    lost = body.mass * speed**2 / 2 - about_rim * rate**2 / 2
    assert float(run["event_impulse"][1]) == pytest.approx(impulse, rel=1e-12)
    assert float(run["event_energy_lost"][1]) == pytest.approx(lost, rel=1e-12)
    assert float(run["energy_error"]) < 1e-12


@pytest.mark.parametrize("below", [pytest.param(1e-4, marks=pytest.mark.slow), 1e-6])
def test_a_rim_that_friction_nearly_jams_turns_as_one_that_is_struck(below: float) -> None:
    """Below mu = (I1/(m a1) + a1)/h the normal force is as large as 1 / below: slip ends in so
    short a time that the weight does nothing meanwhile.
    """
    speed, half, radius = 0.5, 0.02, 0.01
    body, start = peg(half), tt.Launch(tilt=0.0, spin=0.0, slip=(speed, 0.0))
    jams = (body.I1 / (body.mass * radius) + radius) / half
    friction = tt.CoulombFriction(mu=jams * (1.0 - below))
    problem = tt.Problem(body=body, friction=friction, launch=start)
    run, solution = tt.simulate(problem, 1e-4, samples=2, dense=True)
    assert run["event_kind"].values.tolist() == ["tips over its rim", "stick"]
    rate = body.mass * half * speed / (body.I1 + body.mass * (half**2 + radius**2))
    sticks = float(run["event_time"][1])
    assert sticks < 3.0 * below * speed / GRAVITY
    assert float(solution(sticks).tilt_rate) == pytest.approx(rate, rel=10 * below)


@pytest.mark.parametrize(
    "friction", [tt.ViscousFriction(mu=3.0), tt.RegularizedCoulombFriction(mu=1.5, eps=1e-3)]
)
def test_smooth_friction_jams_a_rim_as_dry_friction_does(friction: tt.Friction) -> None:
    start = tt.Launch(tilt=0.0, spin=0.0, slip=(0.5, 0.0))
    problem = tt.Problem(body=peg(0.02), friction=friction, launch=start)
    run = tt.simulate(problem, 0.002, samples=2)
    assert run.attrs["status"] == "completed"
    assert run["event_kind"].values[:2].tolist() == ["tips over its rim", "impact"]
    assert float(run["energy_error"]) < 1e-12
