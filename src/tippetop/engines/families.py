"""Families of random problems for data sets: bodies, laws and launches within stated ranges."""

import math
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np

import tippetop as tt

Random = np.random.Generator


class Family(NamedTuple):
    """A kind of problem, and how its numbers are drawn."""

    name: str
    about: str
    """What happens in it, in a line."""
    base: tt.Problem
    """The problem whose fields are drawn."""
    draw: Callable[[Random], dict[str, float]]
    """Draws the values of fields, by their dotted names."""


def _logarithmic(random: Random, low: float, high: float) -> float:
    """Return a number between two, whose logarithm is uniform."""
    return float(math.exp(random.uniform(math.log(low), math.log(high))))


def _ball(random: Random) -> dict[str, float]:
    """Return an eccentric ball of 5 to 50 g and 1 to 3 cm, about as heavy all over."""
    mass, radius = _logarithmic(random, 0.005, 0.05), float(random.uniform(0.01, 0.03))
    across = float(random.uniform(0.3, 0.42)) * mass * radius**2
    return {
        "body.mass": mass,
        "body.shape.radius": radius,
        "body.shape.eccentricity": float(random.uniform(0.05, 0.35)),
        "body.I1": across,
        "body.I3": across * float(random.uniform(0.85, 1.15)),
    }


def _launch(random: Random) -> dict[str, float]:
    """Return a launch that leans by up to 1.5 rad and spins with 20 to 200 rad/s."""
    return {
        "launch.tilt": float(random.uniform(0.05, 1.5)),
        "launch.spin": float(random.uniform(20.0, 200.0)),
        "launch.tilt_rate": float(random.uniform(-5.0, 5.0)),
    }


def _film(random: Random) -> dict[str, float]:
    return {**_ball(random), **_launch(random), "friction.mu": _logarithmic(random, 0.05, 1.0)}


def _dry(random: Random) -> dict[str, float]:
    slip = {"launch.slip.0": float(random.uniform(-0.5, 0.5))}
    return {**_ball(random), **_launch(random), **slip, "friction.mu": random.uniform(0.05, 0.8)}


def _patch(random: Random) -> dict[str, float]:
    ball = _ball(random)
    return {
        **ball,
        **_launch(random),
        "friction.mu": float(random.uniform(0.1, 0.6)),
        "friction.patch_radius": ball["body.shape.radius"] * _logarithmic(random, 0.005, 0.05),
    }


def _dropped(random: Random) -> dict[str, float]:
    return {
        **_ball(random),
        **_launch(random),
        "launch.gap": float(random.uniform(0.002, 0.03)),
        "friction.mu": float(random.uniform(0.05, 0.8)),
    }


def _resisted(random: Random) -> dict[str, float]:
    ball = _ball(random)
    arm = ball["body.shape.radius"] * _logarithmic(random, 0.001, 0.03)
    return {
        **ball,
        **_launch(random),
        "friction.mu": float(random.uniform(0.2, 0.8)),
        "rolling_resistance": arm,
    }


def _egg(random: Random) -> dict[str, float]:
    across = float(random.uniform(0.012, 0.025))
    along = across * float(random.uniform(1.05, 1.6))
    mass = _logarithmic(random, 0.02, 0.1)
    return {
        "body.mass": mass,
        "body.shape.across": across,
        "body.shape.along": along,
        "body.I1": 0.2 * mass * (across**2 + along**2),
        "body.I3": 0.4 * mass * across**2,
        "friction.mu": float(random.uniform(0.1, 0.5)),
        "friction.patch_radius": across * _logarithmic(random, 0.01, 0.05),
        "launch.tilt": float(random.uniform(0.8, 1.5)),
        "launch.precession": float(random.uniform(20.0, 120.0)),
    }


def _on(friction: tt.Friction, body: tt.Body = tt.presets.REPORT) -> tt.Problem:
    return tt.Problem(body=body, friction=friction, launch=tt.Launch(tilt=0.5, spin=100.0))


_DRY = tt.CoulombFriction(mu=0.3)
_PATCH = tt.ContensouFriction(mu=0.3, patch_radius=3e-4, pressure="ellipsoidal")

FAMILIES = (
    Family("film", "a tippe top on a viscous film", _on(tt.ViscousFriction(mu=0.3)), _film),
    Family("dry", "a top on dry friction slips, sticks and rolls", _on(_DRY), _dry),
    Family("patch", "a tippe top on a contact patch that drills", _on(_PATCH), _patch),
    Family("dropped", "a spinning ball is dropped and does not rebound", _on(_DRY), _dropped),
    Family("resisted", "a top rolls down against rolling resistance", _on(_DRY), _resisted),
    Family("egg", "a spinning egg on a contact patch", _on(_PATCH, tt.presets.EGG), _egg),
)
"""The families: problem k of a data set is of the family k modulo their number."""

SHARES: Mapping[str, float] = {"train": 0.8, "validation": 0.1, "test": 0.1}
"""Parts of a data set."""


class DrawnProblem(NamedTuple):
    """A problem of a data set."""

    family: int
    fields: dict[str, float]
    split: int
    problem: tt.Problem


def drawn_problem(seed: int, number: int) -> DrawnProblem:
    """Return a problem by its number: it does not depend on how many there are."""
    random = np.random.default_rng([seed, number])
    share, split = float(random.random()), 0
    for split, part in enumerate(SHARES.values()):  # noqa: B007 - the last part has what is over
        share -= part
        if share < 0.0:
            break
    family = number % len(FAMILIES)
    fields = {name: float(value) for name, value in FAMILIES[family].draw(random).items()}
    changes: dict[str, Any] = dict(fields)
    slip = changes.pop("launch.slip.0", None)
    if slip is not None:
        changes["launch.slip"] = (slip, 0.0)
    return DrawnProblem(family, fields, split, FAMILIES[family].base.replace(changes))
