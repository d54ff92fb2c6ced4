"""Bodies that land flat: the impact of a face, the rim it may tip over, and rocking."""

import math

import numpy as np
import pytest

import tippetop as tt
from planar_rim import time_to_tilt
from tippetop.contact.face_impact import face_impact
from tippetop.mechanics.face_motion import law_of_face
from tippetop.mechanics.invariants import energy
from tippetop.mechanics.laws.coulomb import CoulombLaw
from tippetop.mechanics.state import State
from tippetop.mechanics.surfaces.surface import RingSurface
from tippetop.mechanics.top import Top
from tippetop.mechanics.unsolved import Unsolved

GRAVITY = 9.81
RADIUS, THICKNESS, MASS = 0.015, 0.01, 0.05


def cylinder(radius: float, height: float, mass: float = MASS) -> tt.Body:
    """Return a solid cylinder."""
    return tt.Body(
        mass=mass,
        shape=[tt.Ring(radius=radius, center=side * height / 2) for side in (-1, 1)],
        I1=mass * (3 * radius**2 + height**2) / 12,
        I3=mass * radius**2 / 2,
    )


DISK = cylinder(RADIUS, THICKNESS)


def dropped(body: tt.Body, mu: float, restitution: float = 0.0, **launch) -> tt.Problem:
    """Return a body that falls with its face level."""
    return tt.Problem(
        body=body,
        friction=tt.CoulombFriction(mu=mu),
        gravity=GRAVITY,
        launch=tt.Launch(**{"tilt": 0.0, "spin": 0.0} | launch),
        contact=tt.Contact(restitution=restitution),
    )


@pytest.mark.parametrize("gap", [0.05, 1e-4, 1e-9])
def test_a_face_lands_when_it_has_fallen_so_far(gap: float) -> None:
    """It spins, and its edge's gap is the square of its face's."""
    run = tt.simulate(dropped(DISK, 0.3, gap=gap, spin=20.0), 0.2, samples=2)
    assert run["event_kind"].values[:3].tolist() == ["touchdown", "impact", "lies down"]
    assert float(run["event_time"][0]) == pytest.approx(math.sqrt(2 * gap / GRAVITY), rel=1e-12)


@pytest.mark.parametrize("speed", [0.1, 0.5])
def test_a_landing_takes_slip_by_the_friction_of_its_impulse(speed: float) -> None:
    """It takes mu v_n, all of 0.1 m/s at a fall of 50 mm; what is left slides on."""
    mu, gap = 0.3, 0.05
    run = tt.simulate(dropped(DISK, mu, gap=gap, velocity=(speed, 0.0, 0.0)), 1.0, samples=2)
    fall = math.sqrt(2 * gap / GRAVITY)
    left = max(0.0, speed - mu * GRAVITY * fall)
    assert run.attrs["status"] == "at_rest"
    assert float(run["end_time"]) == pytest.approx(fall + left / (mu * GRAVITY), rel=1e-12)
    way = speed * fall + left**2 / (2 * mu * GRAVITY)
    assert float(run["x"][-1]) == pytest.approx(way, rel=1e-12)
    assert float(run["event_impulse"][1]) == pytest.approx(MASS * GRAVITY * fall, rel=1e-12)
    lost = 0.5 * MASS * ((GRAVITY * fall) ** 2 + speed**2 - left**2)
    assert float(run["energy_lost_impacts"]) == pytest.approx(lost, rel=1e-12)
    assert float(run["energy_error"]) < 1e-14


def test_a_landing_takes_spin_by_the_friction_of_its_impulse() -> None:
    """A disk loses 4 mu v_n / (3 a) of it."""
    mu, gap, spin = 0.3, 0.02, 60.0
    run, solution = tt.simulate(dropped(DISK, mu, gap=gap, spin=spin), 1.0, samples=2, dense=True)
    fall = math.sqrt(2 * gap / GRAVITY)
    after = solution(fall, side="right")
    left = spin - 4 * mu * GRAVITY * fall / (3 * RADIUS)
    assert after.spin == pytest.approx(left, rel=1e-11)
    rest = fall + 3 * RADIUS * left / (4 * mu * GRAVITY)
    assert float(run["end_time"]) == pytest.approx(rest, rel=1e-11)


@pytest.mark.parametrize("friction", [tt.CoulombFriction(mu=0.3), tt.ViscousFriction(mu=0.4)])
def test_an_impulse_acts_as_the_weight_does_in_so_long_a_time(friction: tt.Friction) -> None:
    gap, spin, slip = 0.01, 40.0, 0.5
    fall = math.sqrt(2 * gap / GRAVITY)
    drop = dropped(DISK, 0.3, gap=gap, spin=spin, velocity=(slip, 0.0, 0.0))
    flat = dropped(DISK, 0.3, spin=spin, slip=(slip, 0.0))
    _, landed = tt.simulate(drop.replace({"friction": friction}), 0.2, samples=2, dense=True)
    _, slides = tt.simulate(flat.replace({"friction": friction}), 0.2, samples=2, dense=True)
    after, same = landed(fall, side="right"), slides(fall)
    assert after.spin == pytest.approx(float(same.spin), rel=1e-11)
    assert after.velocity[0] == pytest.approx(float(same.velocity[0]), rel=1e-11)


def test_a_face_rebounds_as_it_is_elastic_and_flies_on_with_its_spin() -> None:
    """Each impact takes mu (1 + e) v_n of the slip, or of the spin 4/3 of that over a."""
    mu, gap, part = 0.1, 0.05, 0.6
    slides = dropped(DISK, mu, part, gap=gap, velocity=(2.0, 0.0, 0.0))
    spins = dropped(DISK, mu, part, gap=gap, spin=300.0)
    fall = math.sqrt(2 * gap / GRAVITY)
    sinking = GRAVITY * fall
    _, slid = tt.simulate(slides, 0.5, samples=2, dense=True)
    run, spun = tt.simulate(spins, 0.5, samples=2, dense=True)
    landings = run["event_time"].values[run["event_kind"].values == "touchdown"]
    expected, speed, spin = fall, 2.0, 300.0
    for landing in landings[:4]:
        assert landing == pytest.approx(expected, rel=1e-12)
        taken = mu * (1 + part) * sinking
        speed, spin = speed - taken, spin - 4 * taken / (3 * RADIUS)
        assert slid(landing, side="right").velocity[0] == pytest.approx(speed, rel=1e-11)
        assert spun(landing, side="right").spin == pytest.approx(spin, rel=1e-11)
        sinking *= part
        expected += 2 * sinking / GRAVITY
    assert run["event_kind"].values[-1] == "lies down"
    assert float(run["energy_error"]) < 1e-13


HEIGHT = 0.05
TALL = tt.Body(mass=0.1, shape=tt.Ring(radius=0.02, center=-HEIGHT), I1=1e-4, I3=2e-5)


@pytest.mark.parametrize(("mu", "tips"), [(0.39, False), (0.41, True), (0.6, True)])
def test_a_tall_body_that_lands_with_slip_tips_over_its_rim(mu: float, tips: bool) -> None:
    """At mu h > a1: the impulse P acts at the front of the rim, and v_n = a1 omega after it."""
    gap, radius = 0.01, 0.02
    problem = dropped(TALL, mu, gap=gap, azimuth=0.7, velocity=(3.0, 0.0, 0.0))
    run = tt.simulate(problem, 3.0, samples=3, until=lambda state: state.tilt - 0.5)
    assert float(run["energy_error"]) < 1e-12
    if not tips:
        assert run.attrs["status"] == "at_rest"
        return
    fall = math.sqrt(2 * gap / GRAVITY)
    arm = mu * HEIGHT - radius
    impulse = GRAVITY * fall / (1 / TALL.mass - radius * arm / TALL.I1)
    assert float(run["event_impulse"][1]) == pytest.approx(impulse, rel=1e-12)
    expected = fall + time_to_tilt(TALL, 0.5, mu=mu, rate=arm * impulse / TALL.I1, gravity=GRAVITY)
    assert run.attrs["status"] == "stopped"
    assert float(run["end_time"]) == pytest.approx(expected, rel=1e-10)
    assert math.remainder(float(run["azimuth"][-1]), 2 * math.pi) == pytest.approx(0.0, abs=1e-9)


def left_of_rate(radius: float, height: float) -> float:
    """Return the part of its rate that a solid cylinder keeps where it rocks from one side of its
    rim to the other without slip: angular momentum about the new edge (Housner 1963).
    """
    inertia, half = (3 * radius**2 + height**2) / 12, height / 2
    return (inertia + half**2 - radius**2) / (inertia + half**2 + radius**2)


@pytest.mark.parametrize(("radius", "height", "azimuth"), [(0.01, 0.06, 0.0), (0.02, 0.06, 2.0)])
def test_a_tall_cylinder_rocks_on(radius: float, height: float, azimuth: float) -> None:
    """And keeps so much of its rate at every landing: 0.849 of 20 x 60 mm, 0.529 of 40 x 60 mm."""
    body, tilt = cylinder(radius, height), 0.05
    problem = dropped(body, 1.0, tilt=tilt, azimuth=azimuth)
    run, solution = tt.simulate(problem, 2.0, samples=201, dense=True)
    assert run.attrs["status"] == "at_rest"
    assert run["event_kind"].values[-2:].tolist() == ["lies down", "rests"]
    assert float(run["energy_error"]) < 1e-12
    times = run["event_time"].values[run["event_kind"].values == "impact"]
    kept = left_of_rate(radius, height)
    for time in times[:3]:
        before, after = solution(time - 1e-9), solution(time + 1e-9)
        assert after.tilt_rate == pytest.approx(-kept * float(before.tilt_rate), rel=1e-6)
    losses = run["event_energy_lost"].values[run["event_kind"].values == "impact"][:4]
    assert losses[1:] / losses[:-1] == pytest.approx([kept**2] * 3, rel=1e-9)


def test_a_flat_disk_that_comes_down_on_its_other_side_lies_down() -> None:
    """The impulse would have to act beyond its rim to rock it on: I1/m + h^2 < a^2."""
    run = tt.simulate(dropped(DISK, 1.0, tilt=0.3), 2.0, samples=3)
    assert run["event_kind"].values[-3:].tolist() == ["impact", "lies down", "rests"]
    assert list(run["event_kind"].values).count("impact") == 1
    assert float(run["energy_error"]) < 1e-11  # the law of a slap is used for the last 1e-6


@pytest.mark.parametrize("seed", range(16))
def test_what_an_impact_of_a_face_leaves_is_possible(seed: int) -> None:
    """The face has stopped sinking, v_n >= a1 |omega_h|, the impulse is one that the table can
    exert, of friction within mu P and of the couple within a1 P, and energy is lost.

    Where no point of the rim slips outwards the law of the whole face may ask more of the couple.
    """
    random = np.random.default_rng(seed)
    radius, half = 1.0, random.uniform(0.1, 4.0)
    inertia, axial, mu = random.uniform(0.2, 2.0), 0.5, random.uniform(0.05, 1.5)
    top = Top.of(1.0, inertia, axial, RingSurface(radius, -half), CoulombLaw(mu), 1.0)
    moves = random.choice([0.0, 1.0], 3)
    spin, slip = random.normal() * moves[0], random.normal(size=2) * moves[1]
    if seed % 2 == 0:  # it slips or drills, so that friction is not held by rounding
        slip = random.normal(size=2)
    turning = random.normal(size=2) * 0.5 * moves[2]
    state = State(
        (0.0, 0.0, 1.0),
        (*(inertia * turning).tolist(), axial * float(spin)),
        (*slip.tolist(), -float(random.uniform(0.01, 1.0))),
        half,
    )
    restitution = float(random.choice([0.0, 0.6]))
    try:
        struck = face_impact(state, restitution, top, law_of_face(top, "uniform"))
    except Unsolved as error:
        assert "nothing tips the body" in str(error)  # noqa: PT017
        return
    after = struck.state
    gained = np.subtract(after.velocity, state.velocity)
    turned = np.subtract(after.momentum, state.momentum)
    couple = turned - np.cross([0.0, 0.0, -half], gained)
    assert gained[2] == pytest.approx(struck.impulse, rel=1e-11)
    assert np.hypot(*gained[:2]) <= mu * struck.impulse * (1.0 + 1e-9)
    drills_fast = np.hypot(*slip) < radius * abs(spin) and not turning.any()
    if not drills_fast:
        assert np.hypot(*couple[:2]) <= radius * struck.impulse * (1.0 + 1e-9)
    omega = np.divide(after.momentum[:2], inertia)
    assert after.velocity[2] >= radius * float(np.hypot(*omega)) - 1e-12
    energies = [float(energy(each, top)) for each in (state, after)]
    assert struck.energy_lost == pytest.approx(energies[0] - energies[1], abs=1e-13)
    assert energies[1] <= energies[0]
