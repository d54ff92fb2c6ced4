"""Bodies that are no tippe tops: a disk on its edge, hurricane balls, eggs off their centre."""

import math

import numpy as np
import pytest

import tippetop as tt
from campaigns import among
from tippetop.mechanics.contacts.slip_variables import is_slipping
from tippetop.mechanics.motion import along_table
from tippetop.problem.problem import top_of

DISK_MASS, DISK_RADIUS, THICKNESS = 0.4, 0.0375, 0.0125
DISK = tt.Body(
    mass=DISK_MASS,
    shape=tt.Ring(radius=DISK_RADIUS, center=-THICKNESS / 2),
    I1=DISK_MASS * (3 * DISK_RADIUS**2 + THICKNESS**2) / 12,
    I3=DISK_MASS * DISK_RADIUS**2 / 2,
)
BALL_MASS, BALL_RADIUS = 0.032, 0.01
BALLS = tt.Body(
    mass=2 * BALL_MASS,
    shape=tt.Sphere(radius=BALL_RADIUS, center=-BALL_RADIUS),
    I1=2 * (2 / 5 + 1) * BALL_MASS * BALL_RADIUS**2,
    I3=2 * 2 / 5 * BALL_MASS * BALL_RADIUS**2,
)
ROUGH = tt.CoulombFriction(mu=1.0)


def steadily_rolling(body: tt.Body, tilt: float, precession: float, spin: float) -> None:
    """See that a body whose centre is at rest goes on so."""
    launch = tt.Launch(tilt=tilt, precession=precession, spin=spin)
    run = tt.simulate(
        tt.Problem(body=body, friction=ROUGH, launch=launch, gravity=9.81), 0.2, samples=41
    )
    assert run.attrs["status"] == "completed"
    np.testing.assert_allclose(run["tilt"], tilt, rtol=0, atol=2e-9)
    np.testing.assert_allclose(run["precession"], precession, rtol=2e-9)
    assert np.abs(run["velocity"]).max() < 2e-9 * precession * float(body.surface.size)
    assert float(run["energy_error"]) < 1e-12


def test_a_disk_rolls_on_its_edge_with_its_centre_at_rest() -> None:
    """With the precession and the spin that an independent solver finds for this disk."""
    steadily_rolling(DISK, 0.3, 59.96600573975, 2.95352773481)


def test_a_disk_launched_without_slip_near_flat_has_none() -> None:
    """There h' is large, and what slip is made of must not cancel."""
    rng = np.random.default_rng(1)
    for _ in range(400):
        tilt, azimuth = rng.uniform(1.2e-3, 4e-3), rng.uniform(0.0, 6.0)
        spin, precession, tilt_rate = rng.uniform(-100.0, 100.0, 3)
        launch = tt.Launch(
            tilt=tilt, spin=spin, precession=precession, tilt_rate=tilt_rate, azimuth=azimuth
        )
        problem = tt.Problem(body=DISK, friction=ROUGH, launch=launch)
        assert not is_slipping(*along_table(problem.start()), top_of(problem)), launch


@pytest.mark.parametrize("precession", [55.0, 80.0, 200.0])
def test_hurricane_balls_roll_on_one_ball(precession: float) -> None:
    """cos(theta) = 2/5 - g / (Omega^2 R), while omega lies along the contact vector."""
    c = 2 / 5 - 9.81 / (precession**2 * BALL_RADIUS)
    steadily_rolling(BALLS, math.acos(c), precession, precession * (1 + c))


def test_a_disk_that_does_not_spin_falls_flat() -> None:
    """Without friction its centre falls straight down: energy gives its tilt as a quadrature."""
    thin = DISK.model_copy(update={"shape": tt.Ring(radius=DISK_RADIUS)})
    launch = tt.Launch(tilt=1.2, spin=0.0)
    problem = tt.Problem(
        body=thin, friction=tt.ViscousFriction(mu=0.0), launch=launch, gravity=9.81
    )
    run = tt.simulate(problem, 1.0)
    assert run["event_kind"].values.tolist() == ["impact", "lies down"]  # the face slaps down
    assert abs(run["tilt"].values[-1]) < 1e-9
    # (I1 + m R^2 cos^2) theta'^2 / 2 = m g R (sin 1.2 - sin theta); theta = 1.2 - u^2 takes the
    # root away.
    nodes, weights = np.polynomial.legendre.leggauss(60)
    u = np.sqrt(1.2) * (nodes + 1) / 2
    tilt, inertia = 1.2 - u * u, thin.I1
    fall = DISK_MASS * 9.81 * DISK_RADIUS * (np.sin(1.2) - np.sin(tilt))
    moving = (inertia + DISK_MASS * (DISK_RADIUS * np.cos(tilt)) ** 2) / 2
    expected = np.sqrt(1.2) / 2 * weights @ (2 * u * np.sqrt(moving / fall))
    assert float(run["event_time"][0]) == pytest.approx(expected, rel=1e-9)
    assert float(run["energy_error"]) < 1e-9


LAWS = {
    "viscous": tt.ViscousFriction(mu=0.3),
    "coulomb": tt.CoulombFriction(mu=0.1),
    "ellipsoidal": tt.ContensouFriction(mu=0.3, patch_radius=1e-3, pressure="ellipsoidal"),
    "hertz": tt.ContensouFriction(mu=0.1, patch_radius=1e-3, pressure="hertz"),
}


@pytest.mark.parametrize(
    ("tilt", "rate", "law"),
    among(
        [
            (*launch, law)
            for law in LAWS
            for launch in ((0.16, -20.0), (0.14, -10.0), (math.pi - 0.2, 40.0))
        ],
        check=3,
    ),
)
def test_a_coin_thrown_onto_its_face_slips_until_it_lies_flat(
    tilt: float, rate: float, law: str
) -> None:
    """In one plane, where its tip passes the pole within a step, its edge lies flat on the way
    there.
    """
    problem = tt.Problem(
        body=tt.presets.COIN,
        friction=LAWS[law],
        launch=tt.Launch(tilt=tilt, spin=0.0, tilt_rate=rate),
    )
    run, solution = tt.simulate(problem, 0.5, samples=1001, dense=True)
    down = run["event_time"].values[run["event_kind"].values == "lies down"]
    assert len(down) == 1
    assert run.attrs["status"] == ("completed" if law == "viscous" else "at_rest")
    assert float(run["energy_error"]) < 1e-9
    tilts = solution(np.linspace(0.0, float(down[0]), 1001)).tilt
    theta = tilts if rate < 0.0 else math.pi - tilts
    assert theta[-1] == pytest.approx(0.0, abs=1e-9)
    assert (np.diff(theta) < 0.0).all()


@pytest.mark.parametrize("body", [DISK, BALLS])
def test_their_shapes_go_into_text_and_come_back(body: tt.Body) -> None:
    problem = tt.Problem(body=body, friction=ROUGH, launch=tt.Launch(tilt=0.3, spin=1.0))
    assert tt.Problem.from_toml(problem.to_toml()) == problem
    assert tt.Problem.from_json(problem.to_json()) == problem


def test_an_egg_may_be_heavier_at_one_end() -> None:
    egg = tt.Body(
        mass=0.05, shape=tt.Spheroid(across=0.02, along=0.03, center=0.004), I1=9e-6, I3=5e-6
    )
    assert egg.surface.height(1.0) == pytest.approx(0.03 - 0.004)
    assert egg.surface.height(-1.0) == pytest.approx(0.03 + 0.004)


def test_an_oval_that_is_a_sphere_moves_as_one():
    center = -0.004
    sphere = tt.Body(mass=0.02, shape=tt.Sphere(radius=0.02, center=-center), I1=3e-6, I3=3.2e-6)
    oval = sphere.model_copy(update={"shape": tt.Oval(support=(0.02, center, *(15 * [0.0])))})
    ends = []
    for body in (sphere, oval):
        problem = tt.Problem(
            body=body,
            friction=tt.ViscousFriction(mu=0.3),
            launch=tt.Launch(tilt=0.3, spin=120.0),
        )
        ends.append(tt.simulate(problem, 1.0)["tilt"].values[-1])
    assert ends[1] == pytest.approx(ends[0], abs=1e-9)


def test_an_oval_is_convex():
    with pytest.raises(tt.InvalidInput, match=r"support: .* a convex surface"):
        tt.Oval(support=(0.02, 0.0, 0.0, 0.0, -0.03, *(12 * [0.0])))
    with pytest.raises(tt.InvalidInput, match="support"):
        tt.Oval(support=(0.02, 0.0))
