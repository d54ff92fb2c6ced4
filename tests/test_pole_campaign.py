"""Random bodies of several surfaces, rings among them, launched at the poles and near them."""

from collections import Counter
from typing import Any

import numpy as np
import pytest

import tippetop as tt
from campaigns import seed_ranges

SIZE, MASS = 0.02, 0.02
STEPS, MODES = 2_000, 200
TILTS = [0.0, 1e-12, 1e-9, 1e-8, 1e-6, 1e-3, 0.05, np.pi - 1e-3, np.pi - 1e-9, np.pi]

NAMED = {"completed", "at_rest", "too_many_steps", "too_many_modes"}
"""Outcomes that need no reason."""


def shape_of(random: np.random.Generator) -> list[tt.Shape]:
    """One surface that carries the body at one pole, and one to three others anywhere."""
    shapes: list[tt.Shape] = [
        tt.Sphere(radius=SIZE * random.uniform(0.2, 1.0), center=SIZE * random.uniform(-0.8, 0.8))
    ]
    for _ in range(random.integers(1, 4)):
        part, center = SIZE * random.uniform(0.1, 1.0, 2), SIZE * random.uniform(-1.2, 1.2)
        match random.integers(5):
            case 0:
                shapes.append(tt.Sphere(radius=part[0], center=center))
            case 1:
                shapes.append(tt.Spheroid(across=part[0], along=part[1], center=0.6 * center))
            case 2:
                shapes.append(tt.Ring(radius=part[0], center=center, tube=0.3 * part[1]))
            case _:
                shapes.append(tt.Ring(radius=part[0], center=center))
    return [shapes[place] for place in random.permutation(len(shapes))]


def problem_of(random: np.random.Generator) -> tt.Problem:
    """A problem of such a body; another one where that cannot be."""
    transverse = random.uniform(0.2, 0.6) * MASS * SIZE**2
    laws: list[dict[str, Any]] = [
        {"kind": "viscous", "mu": 10.0 ** random.uniform(-2.0, 0.5)},
        {"kind": "regularized_coulomb", "mu": random.uniform(0.05, 0.6), "eps": 0.01},
        {"kind": "coulomb", "mu": random.uniform(0.05, 1.0)},
        {
            "kind": "contensou",
            "mu": random.uniform(0.05, 0.6),
            "patch_radius": 5e-4,
            "pressure": str(random.choice(["hertz", "ellipsoidal"])),
        },
    ]

    def some(number: float) -> float:
        return float(random.choice([0.0, number]))

    try:
        return tt.Problem(
            body=tt.Body(
                mass=MASS,
                shape=shape_of(random),
                I1=transverse,
                I3=random.uniform(0.3, 1.6) * transverse,
            ),
            friction=laws[random.integers(len(laws))],
            launch=tt.Launch(
                tilt=float(random.choice(TILTS)),
                azimuth=some(random.uniform(-3.0, 3.0)),
                spin=some(random.uniform(-300.0, 300.0)),
                tilt_rate=some(random.uniform(-10.0, 10.0)),
                precession=some(random.uniform(-20.0, 20.0)),
                slip=(some(0.1), some(random.uniform(-0.5, 0.5))),
                gap=some(0.005),
            ),
            contact=tt.Contact(restitution=float(random.choice([0.0, 0.0, 0.5]))),
            rolling_resistance=some(1e-5),
        )
    except tt.InvalidInput:
        return problem_of(random)


def ending_of(seed: int, integrator: str = "dop853") -> str:
    """The outcome of a random problem, and the reason of one that failed.

    Bodies of a kind of their own are compiled for longer than they are followed without.
    """
    problem = problem_of(np.random.default_rng(seed))
    run = tt.simulate(
        problem,
        0.2,
        samples=51,
        integrator=integrator,
        tolerance=1e-10,
        step_limit=STEPS,
        mode_limit=MODES,
    )
    outcome: str = run.attrs["status"]
    if outcome in NAMED:
        if outcome == "completed":
            assert float(run["energy_error"]) < 1e-8, (seed, problem.to_json())
            assert float(run["gap"].min()) > -1e-9 * SIZE, (seed, problem.to_json())
        return outcome
    advice: str = run.attrs["message"]
    return f"{outcome}: {advice.removeprefix(tt.Status[outcome.upper()].value).strip()}"


@pytest.mark.parametrize("seeds", seed_ranges(check=2, sample=18, claim=500, size=8))
def test_no_random_problem_raises_and_what_fails_says_why(seeds: range) -> None:
    endings = Counter(ending_of(seed) for seed in seeds)
    assert not [ending for ending in endings if ending.endswith(": ")], endings
