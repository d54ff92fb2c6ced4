"""Tall bodies on a face that drills fast, whose friction moves the pressure to the rim."""

import math

import numpy as np
import pytest

import tippetop as tt

GRAVITY, RADIUS, HALF = 9.81, 0.01, 0.03


def peg(axial: float = 0.6, half: float = HALF) -> tt.Body:
    """Return a slender body between two rims, whose I3 is m R^2 / 2 times a factor."""
    mass = 0.02
    inertia = mass * RADIUS**2 / 2
    rims = [tt.Ring(radius=RADIUS, center=side * half) for side in (1, -1)]
    transverse = inertia / 2 + mass * half**2 / 3
    return tt.Body(mass=mass, shape=rims, I1=transverse, I3=axial * inertia)


def launched(friction: tt.Friction, slip: float, spin: float, **others) -> tt.Problem:
    """Return a launch on the face."""
    launch = tt.Launch(tilt=0.0, spin=spin, slip=(slip, 0.0))
    fields = {"body": peg(), "friction": friction, "gravity": GRAVITY, "launch": launch}
    return tt.Problem(**fields | others)


def speeds(solution, time: float) -> tuple[float, float]:
    """Return v and a1 |w| at a time."""
    state = solution(time)
    return math.hypot(*state.velocity[:2]), RADIUS * abs(float(state.spin))


@pytest.mark.parametrize(("slip", "spin"), [(0.3, 60.0), (0.5, -51.0), (0.5, 50.0)])
def test_a_body_whose_slip_rises_through_that_of_its_rim_rolls_on_it(
    slip: float, spin: float
) -> None:
    """The point of the rim that rests bears it with a force a1 N / h at right angles to v."""
    problem = launched(tt.CoulombFriction(mu=0.6), slip, spin)
    run, solution = tt.simulate(problem, 0.3, samples=301, dense=True)
    assert run.attrs["status"] == "completed"
    assert run["event_kind"].values[-1] == "rolls on its rim"
    begins = float(run["event_time"][-1])
    for time in (begins + 1e-9, 0.2, 0.3):
        speed, drilled = speeds(solution, time)
        assert speed == pytest.approx(drilled, rel=1e-13)
    later = run.sel(time=slice(begins + 1e-3, None))
    assert set(later["mode"].values.tolist()) == {"rolling_flat_on_1"}
    u, v = later["velocity"].values[:, :2].T
    turned = np.unwrap(np.arctan2(v, u))
    rate = (turned[-1] - turned[0]) / float(later["time"][-1] - later["time"][0])
    assert rate == pytest.approx(-GRAVITY / (HALF * float(run["final_spin"])), rel=1e-11)
    assert np.ptp(later["energy"].values) < 1e-15 * float(later["energy"][0]) * len(u)
    assert float(run["energy_error"]) < 1e-14


def test_many_samples_of_rolling_on_the_rim_show_the_force_that_few_do() -> None:
    """Many are read by a compiled function. With a spin of its own the body rolls at another slip,
    and the force at right angles to its velocity v is m g v / (h w).
    """
    ring = tt.Ring(radius=RADIUS, center=-HALF)
    for spin in (60.0, 45.0):
        problem = launched(tt.CoulombFriction(mu=0.6), 0.3, spin).replace({"body.shape": ring})
        run = tt.simulate(problem, 0.3, samples=3001).isel(time=slice(2900, None))
        assert set(run["mode"].values.tolist()) == {"rolling_flat"}
        force, velocity = run["contact_force"].values, run["velocity"].values
        speed = np.linalg.norm(velocity, axis=1)
        expected = RADIUS / HALF * problem.body.mass * GRAVITY
        assert np.linalg.norm(force[:, :2], axis=1) == pytest.approx(expected, rel=1e-9)
        assert np.sum(force * velocity, axis=1) == pytest.approx(0.0, abs=1e-9 * speed.max())


def test_rolling_upright_is_the_limit_of_rolling_on_the_rim() -> None:
    """Of a rim that sticks at a small tilt, in steady precession at -g / (h w)."""
    spin, dry = 45.0, tt.CoulombFriction(mu=0.6)
    precession = -GRAVITY / (HALF * spin)
    flat = tt.simulate(launched(dry, RADIUS * spin, spin), 0.3, samples=31)
    assert flat["event_kind"].values.tolist() == ["rolls on its rim"]
    errors = []
    for tilt in (1e-3, 1e-4):
        launch = tt.Launch(
            tilt=tilt, azimuth=math.pi / 2, spin=spin, precession=precession, slip=(0.0, 0.0)
        )
        leans = tt.simulate(launched(dry, 0.0, 0.0, launch=launch), 0.3, samples=31)
        assert leans["event_kind"].values.tolist() == ["stick"]
        errors.append(float(np.abs(leans["velocity"] - flat["velocity"]).max()))
    assert errors[0] < 1e-2 * RADIUS * spin
    assert errors[1] == pytest.approx(0.1 * errors[0], rel=0.1)


@pytest.mark.parametrize(
    ("friction", "slip_at_rim"),
    [
        (tt.RegularizedCoulombFriction(mu=0.6, eps=1e-2), 1e-2 / math.sqrt((0.6 * 3.0) ** 2 - 1)),
        (tt.ViscousFriction(mu=2.0), 1 / (2.0 * 3.0)),
    ],
)
def test_smooth_friction_is_asked_for_its_force_at_the_rim(
    friction: tt.Friction, slip_at_rim: float
) -> None:
    """The outward slip sqrt(v^2 - (a1 w)^2) grows to that at which h f = a1, and stays there."""
    run, solution = tt.simulate(launched(friction, 0.5, 51.0), 0.04, samples=2, dense=True)
    assert run["event_kind"].values.tolist() == ["pressure at the rim", "rolls on its rim"]
    for time in (float(run["event_time"][1]), 0.04):
        speed, drilled = speeds(solution, time)
        assert math.sqrt(speed**2 - drilled**2) == pytest.approx(slip_at_rim, rel=1e-9)
    assert float(run["energy_error"]) < 1e-14


@tt.extend.friction_law(mu="1", eps="m s-1", speed="m s-1")
def weakening(slip, angular_velocity, mu, eps, speed):
    """Friction that grows to a peak and falls again."""
    square = slip[0] * slip[0] + slip[1] * slip[1]
    factor = -mu / (tt.extend.sqrt(square + eps * eps) * (1.0 + square / (speed * speed)))
    return factor * slip[0], factor * slip[1]


def test_a_law_that_falls_again_is_asked_at_small_slip() -> None:
    """The body rolls on its rim at the least outward slip at which h f = a1, though the law tips it
    at its own speed, too, and no longer at slips beyond.
    """
    law = weakening(mu=0.6, eps=1e-2, speed=1.0)
    run, solution = tt.simulate(launched(law, 0.5, 51.0), 0.1, samples=2, dense=True)
    (time,) = run["event_time"].values[run["event_kind"].values == "rolls on its rim"]
    speed, drilled = speeds(solution, float(time))

    def moved(slip: float) -> float:
        return HALF / RADIUS * 0.6 * slip / (math.hypot(slip, 1e-2) * (1.0 + slip**2))

    least, largest = 0.0, 0.1
    for _ in range(50):
        middle = 0.5 * (least + largest)
        least, largest = (middle, largest) if moved(middle) < 1.0 else (least, middle)
    assert moved(speed) > 1.0 > moved(1.0)
    assert math.sqrt(speed**2 - drilled**2) == pytest.approx(least, rel=1e-9)


@pytest.mark.parametrize("mu", [0.6, 1.0])
def test_an_impact_of_a_face_that_drills_rolls_on_its_rim(mu: float) -> None:
    """Friction of the impulse raises v to a1 w, and no further."""
    launch = tt.Launch(tilt=0.0, spin=60.0, velocity=(0.5, 0.0, 0.0), gap=0.02)
    problem = launched(tt.CoulombFriction(mu=mu), 0.0, 0.0, launch=launch)
    run, solution = tt.simulate(problem, 0.2, samples=2, dense=True)
    assert run.attrs["status"] == "completed"
    assert float(run["energy_error"]) < 1e-13
    speed, drilled = speeds(solution, 0.2)
    assert speed == pytest.approx(drilled, rel=1e-13)


@pytest.mark.parametrize("spin", [50.0, 50.0 * (1.0 - 1e-13)])
def test_a_face_that_lands_where_its_rim_begins_to_slip_slides_on(spin: float) -> None:
    """A fall takes the time v_n / g, and its impact as much slip as sliding takes in that time."""
    dry, body = tt.CoulombFriction(mu=0.6), peg(2.0)
    launch = tt.Launch(tilt=0.0, spin=spin, velocity=(0.5, 0.0, 0.0), gap=0.02)
    slides = tt.simulate(launched(dry, 0.5, spin, body=body), 0.2, samples=2)
    lands = tt.simulate(launched(dry, 0.0, 0.0, body=body, launch=launch), 0.2, samples=2)
    assert slides.attrs["status"] == lands.attrs["status"] == "at_rest"
    assert float(lands["end_time"]) == pytest.approx(float(slides["end_time"]), rel=1e-9)


def test_dry_friction_on_a_face_only_rescales_time() -> None:
    """Velocities 1e-6 times as fast change at times 1e-6 times as late."""
    dry, scale = tt.CoulombFriction(mu=0.6), 1e-6
    fast = tt.simulate(launched(dry, 0.3, 60.0), 0.3, samples=2)
    slow = tt.simulate(launched(dry, 0.3 * scale, 60.0 * scale), 0.3 * scale, samples=2)
    assert slow["event_kind"].values.tolist() == ["pressure at the rim", "rolls on its rim"]
    assert fast["event_kind"].values.tolist() == slow["event_kind"].values.tolist()
    np.testing.assert_allclose(slow["event_time"], scale * fast["event_time"], rtol=1e-9)


@pytest.mark.parametrize(
    "cause", [{"table": tt.Table(slope=0.1)}, {"air": tt.Air(axial_linear=1e-9)}]
)
def test_where_a_slope_or_air_makes_the_slip_of_the_rim_faster_the_run_says_so(cause) -> None:
    problem = launched(tt.CoulombFriction(mu=0.6), 0.5, 51.0, **cause)
    run = tt.simulate(problem, 0.3, samples=2)
    assert run.attrs["status"] == "failed"
    assert "the slope of the table, or a torque of the air about the axis" in run.attrs["message"]
    assert "with table.slope = 0" in run.attrs["message"]


@pytest.mark.parametrize("pressure", ["uniform", "rim", "ellipsoidal"])
def test_a_face_whose_slip_starts_as_fast_as_its_rim_takes_few_steps(pressure: str) -> None:
    """There the law is hardly analytic: v = a1 w to rounding."""
    ends = []
    for spin in (50.0, 50.0 * (1.0 + 1e-9)):
        problem = launched(
            tt.CoulombFriction(mu=0.3),
            0.5,
            spin,
            body=peg(1.25, 0.005),
            contact=tt.Contact(face_pressure=pressure),
        )
        run = tt.simulate(problem, 1.0, samples=2)
        assert run.attrs["status"] == "at_rest"
        assert int(run["steps"]) < 300
        ends.append(float(run["end_time"]))
    assert ends[0] == pytest.approx(ends[1], rel=1e-8)
