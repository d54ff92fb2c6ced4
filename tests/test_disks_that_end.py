"""Random disks, coins and cups with rolling resistance come to their end under every friction law.

What is left at the end is stated by the energy of a body that lies flat, and when it comes by the
law that a wobble's tilt falls as the square of the time left.
"""

import math

import numpy as np
import pytest
import xarray as xr

import tippetop as tt
from campaigns import seeds

G = 9.81
LAWS = ("viscous", "regularized", "coulomb", "hertz", "ellipsoidal")
ROCKING = (23, 36)
"""Seeds of bodies that rock from side to side under Coulomb friction, and slap in the end."""

SLAPPING = 1e-7
"""Tilt rate, rad/s, above which a face slaps onto the table; a wobble ends far below it."""


def body_of(kind: str, random: np.random.Generator) -> tuple[tt.Body, float]:
    """A steel disk, a coin or a cup, and the tilt at which its edges touch at once."""
    radius = 10 ** random.uniform(-2.0, -1.2)
    if kind == "cup":
        height, mouth = radius * random.uniform(0.5, 1.5), radius * random.uniform(1.0, 1.3)
        mass, depth = 900 * np.pi * radius**2 * height, height * random.uniform(0.35, 0.5)
        tube = radius * random.choice([0.0, 0.02])
        shape = (
            tt.Ring(radius=radius - tube, center=tube - depth, tube=tube),
            tt.Ring(radius=mouth, center=height - depth),
        )
        axial, transverse = (
            0.7 * mass * radius**2,
            mass * (0.4 * radius**2 + height**2 / 12),
        )
    else:
        disk = kind == "disk"
        thickness = radius * (random.uniform(0.2, 0.6) if disk else random.uniform(0.1, 0.2))
        off = 0.0 if disk else thickness * random.uniform(-0.05, 0.05)
        mass, depth = 7850 * np.pi * radius**2 * thickness, thickness / 2 + off
        shape = (
            tt.Ring(radius=radius, center=-depth),
            tt.Ring(radius=radius, center=thickness - depth),
        )
        axial, transverse = mass * radius**2 / 2, mass * (3 * radius**2 + thickness**2) / 12
    return tt.Body(mass=mass, shape=shape, I1=transverse, I3=axial), math.atan2(radius, depth)


def friction_of(law: str, mu: float, radius: float) -> tt.Friction:
    """A friction law; the patch of Contensou's laws is a fiftieth of the radius."""
    match law:
        case "viscous":
            return tt.ViscousFriction(mu=3 * mu)
        case "regularized":
            return tt.RegularizedCoulombFriction(mu=mu)
        case "coulomb":
            return tt.CoulombFriction(mu=mu)
        case "hertz":
            return tt.ContensouFriction(mu=mu, patch_radius=0.02 * radius, pressure="hertz")
    return tt.ContensouFriction(mu=mu, patch_radius=0.02 * radius, pressure="ellipsoidal")


def outer_radius(body: tt.Body) -> float:
    """Radius of the edge that touches first, m."""
    edge = body.shape[0]
    assert isinstance(edge, tt.Ring)
    return edge.radius + edge.tube


def problem_of(seed: int) -> tt.Problem:
    """A body that is launched on its edge, every third of one kind, with one law after another."""
    random = np.random.default_rng(seed)
    body, topples = body_of(("disk", "coin", "cup")[seed % 3], random)
    radius = outer_radius(body)
    friction = friction_of(LAWS[seed // 3 % 5], random.uniform(0.2, 1.0), radius)
    launch = tt.Launch(
        tilt=min(random.uniform(0.05, 0.5), 0.6 * topples),
        precession=random.choice([-1, 1]) * random.uniform(1.0, 1.2 * math.sqrt(G / radius)),
        spin=random.choice([0.0, random.uniform(-30.0, 30.0)]),
    )
    return tt.Problem(
        body=body,
        friction=friction,
        launch=launch,
        gravity=G,
        rolling_resistance=radius * 10 ** random.uniform(-2.5, -1.5),
    )


EULER = tt.Problem(
    body=tt.presets.EULER_DISK,
    friction=tt.CoulombFriction(mu=1.0),
    launch=tt.Launch(tilt=0.3, spin=0.0, precession=5.0),
    rolling_resistance=5e-4,
)
"""The toy, launched so slowly that it leans over and rocks from side to side."""

COIN = tt.Problem(
    body=tt.presets.COIN,
    friction=tt.CoulombFriction(mu=0.3),
    launch=tt.Launch(tilt=1.0, spin=5.0, precession=8.0),
    rolling_resistance=1e-4,
)
"""A coin whose rolling is resisted so little that it rocks, sticks and slips to its end."""


def check_end(problem: tt.Problem, imbalance: float = 1e-8) -> xr.Dataset:
    """Check that a body comes to lie flat with the energy, and at the time, that it should, and
    return the run.

    The imbalance is that of the energy at most. A body that rocks turns round at tilts down to
    1e-14 rad, of which steps whose error is relative to the length of the axis leave two digits.
    """
    run, solution = tt.simulate(problem, 60.0, samples=2, dense=True)
    down = run["event_time"].values[run["event_kind"].values == "lies down"]
    assert len(down) == 1
    assert float(run["energy_error"]) < imbalance
    end, unit = float(down[0]), math.sqrt(outer_radius(problem.body) / G)
    last = solution(end, side="left")
    assert last.tilt < 1e-10
    if abs(last.tilt_rate) > SLAPPING:
        lasts = 4e-6 * unit
        before = solution(end - lasts)
        mean = 0.5 * (before.tilt_rate + last.tilt_rate)
        assert before.tilt == pytest.approx(-mean * lasts, rel=1e-4)
        return run
    tau = 0.02 * unit
    highest = [
        float(solution(np.linspace(end - 2 * part, end - part, 2001)).tilt.max())
        for part in (tau, tau / 2)
    ]
    assert 2.5 < highest[0] / highest[1] < 6.5
    return run


@pytest.mark.parametrize("seed", seeds(0, 1, 100, always=(15,), sampled=(7, 14, 19, *ROCKING)))
def test_a_body_on_its_edge_comes_to_its_end(seed: int) -> None:
    check_end(problem_of(seed))


@pytest.mark.slow
def test_a_slow_disk_rocks_to_its_end_and_a_sweep_says_the_same() -> None:
    run = check_end(EULER, 1e-7)  # 25,000 steps
    swept = tt.sweep(EULER, {"launch.precession": [5.0]}, duration=60.0)
    assert swept["outcome"].values.tolist() == [run["outcome"].item()] == ["at_rest"]
    assert float(swept["end_time"][0]) == pytest.approx(float(run["end_time"]), rel=1e-12)


def test_a_coin_that_rocks_within_rounding_of_flat_comes_to_its_end() -> None:
    """Slip that begins again and again lasts no longer than rounding hides; the end comes before.

    The coin turns round at a tilt of 1e-24, and of its wobble 1e-9 s are left.
    """
    tilt = 1e-20
    slowly = 0.1 * math.sqrt(G / (outer_radius(COIN.body) * tilt))
    run = tt.simulate(
        COIN.replace({"launch.tilt": tilt, "launch.spin": 0.0, "launch.precession": slowly}), 1.0
    )
    assert run["outcome"].item() == "at_rest"
    assert run["event_kind"].values.tolist()[-2:] == ["lies down", "rests"]
    assert float(run["end_time"]) < 1e-9


@pytest.mark.campaign
def test_a_coin_that_hardly_rolls_rocks_to_its_end() -> None:
    check_end(COIN, 1e-7)
