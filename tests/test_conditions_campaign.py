"""Random bodies of up to three surfaces, whose support functions have up to four maxima: no gap is
negative, no contact pulls, friction stays within its bounds, and energy balances.

All is asked at Gauss's points and at the ends of every step of a run, of its equations alone: what
guards have seen and integrals have summed is compared with it.
"""

import math
from typing import Any

import numpy as np
import pytest
from numpy.polynomial import chebyshev

import tippetop as tt
from campaigns import seeds
from launches import any_of, laws_of
from tippetop.contact.block import NODES, Block, ModeSteps
from tippetop.contact.contact_mode import ContactMode
from tippetop.contact.mode import Mode
from tippetop.contact.readings import conditions
from tippetop.contact.transient import TransientMode
from tippetop.integrators.dense import at_fractions
from tippetop.mechanics.contacts.forces import is_set_valued
from tippetop.results.observables import Recorder

LEAST = -1e-12
"""Least gap over the size, and least normal force and friction left over the weight."""

IMBALANCE = 1e-11
"""Largest imbalance of energy and work over the energy at launch, which is the largest of a run."""

TERMS = 17
"""Coefficients of an oval's support function."""


def oval_of(random: np.random.Generator, size: float) -> dict[str, Any]:
    """A convex surface by h = size (1 + sum of e_k cos(k tilt)), k up to 8: up to four maxima.

    Its radius of curvature h + h'' is positive as long as the sum of |e_k| (k^2 - 1) is below 1.
    """
    weights = random.uniform(-1.0, 1.0, 7) * (random.random(7) < 0.4)
    curvatures = weights / max(np.abs(weights).sum(), 1.0) * random.uniform(0.3, 0.8)
    cosines = np.zeros(9)
    cosines[0], cosines[1] = 1.0, random.uniform(-0.3, 0.3)
    cosines[2:] = curvatures / (np.arange(2, 9) ** 2 - 1.0)
    powers = chebyshev.cheb2poly(cosines)
    support = np.concatenate([size * powers, np.zeros(TERMS - len(powers))])
    return {"kind": "oval", "support": support.tolist()}


def surface_of(random: np.random.Generator, size: float) -> dict[str, Any]:
    """A surface of any kind."""
    part, center = size * random.uniform(0.3, 1.0, 2), size * random.uniform(-0.8, 0.8)
    kinds = [
        oval_of(random, size * random.uniform(0.5, 1.0)),
        {"kind": "sphere", "radius": part[0], "center": center},
        {"kind": "spheroid", "across": part[0], "along": part[1], "center": 0.5 * center},
        {"kind": "ring", "radius": part[0], "center": center, "tube": 0.3 * part[1]},
    ]
    return kinds[random.choice(4, p=[0.55, 0.15, 0.15, 0.15])]


def problem_of(seed: int) -> tuple[tt.Problem, float]:
    """A random problem and how long it is followed."""
    random = np.random.default_rng(seed)
    while True:  # bodies of which a surface never touches are refused
        try:
            problem = tt.Problem.model_validate(fields_of(random))
        except (ValueError, tt.InvalidInput):
            continue
        return problem, float(random.uniform(0.05, 0.3))


def fields_of(random: np.random.Generator) -> dict[str, Any]:
    """Fields of a random problem."""
    size, mass = random.uniform(0.005, 0.05), random.uniform(0.002, 0.1)
    transverse = random.uniform(0.2, 0.6) * mass * size**2
    shapes = [surface_of(random, size) for _ in range(random.integers(1, 4))]
    launch: dict[str, Any] = {
        "tilt": random.uniform(0.02, 3.1),
        "spin": random.choice([-1.0, 1.0]) * 10.0 ** random.uniform(0.0, 2.2),
        "precession": random.choice([0.0, random.uniform(-50.0, 50.0)]),
        "tilt_rate": random.choice([0.0, random.uniform(-10.0, 10.0)]),
    }
    if random.random() < 0.4:
        launch["gap"] = size * random.uniform(0.01, 0.5)
    elif random.random() < 0.5:
        launch["slip"] = random.uniform(-0.3, 0.3, 2).tolist()
    fields: dict[str, Any] = {
        "body": {
            "mass": mass,
            "shape": shapes[0] if len(shapes) == 1 else shapes,
            "I1": transverse,
            "I3": random.uniform(0.4, 1.7) * transverse,
        },
        "friction": any_of(random, laws_of(random, size)),
        "launch": launch,
        "contact": {"liftoff": "fly", "restitution": float(random.choice([0.0, 0.0, 0.5]))},
    }
    if random.random() < 0.2:
        fields["rolling_resistance"] = size * 10.0 ** random.uniform(-3.5, -1.5)
    return fields


def friction_left(mode: Mode, y: np.ndarray) -> np.ndarray:
    """Return mu N - |T| of one contact that sticks, in weights; of drilling, too."""
    force, torque = mode.reaction(y)[:2]
    length = getattr(mode.top.friction, "slip_length", None)
    pull = force[0] ** 2 + force[1] ** 2
    if length is not None and not isinstance(mode.top.friction, tuple):
        return np.zeros_like(pull)
    if length is not None:
        pull = pull + (torque[2] / length) ** 2
    return mode.top.friction.mu * force[2] - np.sqrt(pull)


class Least:
    """The least of what is to be positive in a run, by name."""

    def __init__(self) -> None:
        self.gap = self.force = self.friction = math.inf

    def take(self, block: Block) -> None:
        for group in block.groups:
            self._take(group)

    def _take(self, group: ModeSteps) -> None:
        mode, y = group.mode, at_fractions(group.terms, np.array([0.0, *NODES, 1.0]))
        gap, pressing, _ = conditions(mode, y)
        self.gap = min(self.gap, float(np.min(gap)))
        if not isinstance(mode, (ContactMode, TransientMode)):
            return
        force = mode.reaction(y).force[2]
        self.force = min(self.force, float(np.min(force)), float(np.min(pressing)))
        single = isinstance(mode, ContactMode) and mode.is_single and mode.sticks[0]
        if single and is_set_valued(mode.top.friction):
            self.friction = min(self.friction, float(np.min(friction_left(mode, y))))


@pytest.mark.parametrize("seed", seeds(check=5, sample=60, claim=2000))
@pytest.mark.filterwarnings("ignore::tippetop.Implausible")
def test_random_bodies_keep_what_contact_keeps(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    (problem, duration), least, take = problem_of(seed), Least(), Recorder.take

    def take_all(recorder: Recorder, block: Block) -> None:
        take(recorder, block)
        least.take(block)

    monkeypatch.setattr(Recorder, "take", take_all)
    run = tt.simulate(problem, duration, samples=3)
    assert run.attrs["status"] != "inaccurate", run.attrs["message"]
    if run.attrs["status"] != "completed":
        return
    assert least.gap >= LEAST
    assert least.force >= LEAST
    assert least.friction >= LEAST
    assert float(run["energy_error"]) <= IMBALANCE


@pytest.mark.parametrize("seed", [488, pytest.param(851, marks=pytest.mark.slow), 1195])
@pytest.mark.filterwarnings("ignore::tippetop.Implausible")
def test_what_is_left_of_slip_that_has_ended_in_an_impact_does_not_slip_on(seed: int) -> None:
    """What is left is rounding of velocities a hundred times the one of approach, or lies across
    the way in which slip falls.
    """
    problem, duration = problem_of(seed)
    run = tt.simulate(problem, duration, samples=3)
    assert run.attrs["status"] == "completed"
    assert float(run["energy_error"]) <= IMBALANCE
