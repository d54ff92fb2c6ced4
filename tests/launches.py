"""Random launches over every law, surface and ending; and what Python and JavaScript make of
them.
"""

import json
import math
import subprocess
import warnings
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

import tippetop as tt
from node import NODE
from tippetop.mechanics.motion import angular_velocity
from tippetop.page_engine import HERE
from tippetop.problem.problem import top_of
from tippetop.results.catalogue import LISTED, METRICS, SAMPLED
from tippetop.support.errors import TippetopError

SAMPLES = 41
TOLERANCE = 3e-14
"""Of both. Launches that stick and slip again and again multiply errors up to 1e5 times, in Python
as in the page: with 1e-12 a step either may be off by more than the 1e-7 by which they are judged.
"""

MOST_OFF = 1e-7
"""How much numbers may differ, beside the largest of their unit in the run."""

FORCES = {"contact_force", "normal_force"}
"""What changes with friction as much as that does."""

ROUNDINGS = 10.0
"""How much more, at most, than by what Python's own change where a launch changes by a rounding."""


def laws_of(random: np.random.Generator, size: float) -> list[dict[str, Any]]:
    """Laws of friction of every kind."""
    mu = random.uniform(0.05, 0.6)
    patch = size * 10.0 ** random.uniform(-2.5, -0.7)
    return [
        {"kind": "viscous", "mu": mu},
        {"kind": "regularized_coulomb", "mu": mu, "eps": 10.0 ** random.uniform(-2.5, -0.5)},
        {"kind": "coulomb", "mu": mu},
        {"kind": "contensou", "mu": mu, "patch_radius": patch, "pressure": "ellipsoidal"},
        {"kind": "contensou", "mu": mu, "patch_radius": patch, "pressure": "hertz"},
    ]


def surfaces_of(random: np.random.Generator, size: float) -> list[dict[str, Any]]:
    """Tame surfaces of every kind, each for a body that has it alone."""
    return [
        {"kind": "eccentric_sphere", "radius": size, "eccentricity": random.uniform(0.05, 0.6)},
        {"kind": "sphere", "radius": size, "center": random.uniform(-0.5, 0.5) * size},
        {"kind": "spheroid", "across": size, "along": size * random.uniform(0.6, 1.7)},
        {"kind": "ring", "radius": size, "center": 0.0, "tube": 0.2 * size},
    ]


def parts_of(random: np.random.Generator, size: float) -> list[dict[str, Any]]:
    """Surfaces of every kind for a body that has several."""
    part, center = size * random.uniform(0.2, 1.0, 2), size * random.uniform(-1.0, 1.0)
    return [
        {"kind": "sphere", "radius": part[0], "center": center},
        {"kind": "ring", "radius": part[0], "center": center, "tube": 0.3 * part[1]},
        {"kind": "spheroid", "across": part[0], "along": part[1], "center": 0.6 * center},
    ]


def any_of(random: np.random.Generator, kinds: list[dict[str, Any]]) -> dict[str, Any]:
    """One of some kinds."""
    return kinds[random.integers(len(kinds))]


def thrown(fields: dict[str, Any]) -> dict[str, Any]:
    """Give a launch across a gap the velocity with which its lowest point moves by the slip."""
    launch = dict(fields["launch"])
    if not launch.get("gap") or "slip" not in launch:
        return fields
    gap = launch.pop("gap")
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", category=tt.Implausible)
        try:
            velocity = tt.Problem(**fields | {"launch": launch}).start().velocity
        except TippetopError:
            return fields
    del launch["slip"]
    return fields | {"launch": launch | {"gap": gap, "velocity": list(map(float, velocity))}}


def launch_of(seed: int) -> dict[str, Any]:
    """The fields of a problem; some are refused."""
    random = np.random.default_rng(seed)
    size, mass = random.uniform(0.005, 0.05), random.uniform(0.002, 0.1)
    several = random.random() < 0.25
    transverse = random.uniform(0.2, 0.6) * mass * size**2
    single = any_of(random, surfaces_of(random, size))
    shape: Any = [any_of(random, parts_of(random, size)) for _ in range(2)] if several else single
    launch: dict[str, Any] = {
        "tilt": random.uniform(0.02, 3.1),
        "spin": random.choice([-1.0, 1.0]) * 10.0 ** random.uniform(0.0, 2.2),
        "azimuth": random.uniform(-3.0, 3.0),
        "precession": random.choice([0.0, random.uniform(-20.0, 20.0)]),
        "tilt_rate": random.choice([0.0, random.uniform(-5.0, 5.0)]),
    }
    if random.random() < 0.3:
        launch["slip"] = random.uniform(-0.3, 0.3, 2).tolist()
    liftoff = "fly" if several else str(random.choice(["fly", "fly", "stop", "ignore"]))
    if liftoff == "fly" and random.random() < 0.3:
        launch["gap"] = size * random.uniform(0.1, 1.0)
    fields: dict[str, Any] = {
        "body": {
            "mass": mass,
            "shape": shape,
            "I1": transverse,
            "I3": random.uniform(0.4, 1.7) * transverse,
        },
        "friction": any_of(random, laws_of(random, size)),
        "launch": launch,
        "contact": {"liftoff": liftoff, "restitution": float(random.choice([0.0, 0.0, 0.5]))},
    }
    if random.random() < 0.2:
        fields["rolling_resistance"] = size * 10.0 ** random.uniform(-3.5, -1.5)
    return thrown(fields)


def in_javascript(
    launches: list[dict[str, Any]], *options: str, engine: Path = HERE
) -> Iterator[dict[str, Any]]:
    """What the engine makes of launches, in Node with some options."""
    process = _following(options, engine)
    for launch in launches:
        process.stdin.write(json.dumps(launch) + "\n")
        process.stdin.flush()
        answer = process.stdout.readline()
        if not answer:
            _following.cache_clear()
        assert answer, "Node has ended"
        yield json.loads(answer)


@cache
def _following(options: tuple[str, ...], engine: Path) -> Any:
    """Return a process that follows one launch after another: to start takes longer than most."""
    follow = Path(__file__).with_name("follow.mjs")
    command = [NODE, *options, str(follow), str(engine / "index.js")]
    process = subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, encoding="utf-8"
    )
    processes.append(process)
    return process


processes = list[Any]()
"""The processes of Node that follow launches."""


def end_processes() -> None:
    """End the processes of Node that follow launches."""
    _following.cache_clear()
    while processes:
        processes.pop().communicate()


def compared(found: dict[str, Any], run: Any, beside: Any = None) -> list[str]:
    """How what JavaScript made of a launch differs from a run; nothing if it does not.

    A run of nearly the same launch, if one is given, tells how far a rounding may grow.
    """
    if "status" not in found:
        return [str(found)]
    wrong = []
    if found["status"]["name"] != run.attrs["status"]:
        wrong.append(f"status {found['status']} instead of {run.attrs['message']}")
    outcome = run["outcome"].item()
    if found["fellBack"] != (outcome == "fell_back"):
        wrong.append(f"fell back: {found['fellBack']} where the outcome is {outcome}")
    kinds = [str(kind) for kind in run["event_kind"].values]
    others = [event["kind"] for event in found["events"]]
    if others != kinds:
        first = next(
            (i for i, (a, b) in enumerate(zip(others, kinds, strict=False)) if a != b), None
        )
        return [*wrong, f"events {len(others)} instead of {len(kinds)}, from number {first} on"]
    modes = run["mode"].values.tolist()
    # Where the runs end before their time, one may end a rounding before the last of the samples.
    count = min(len(modes), len(found["track"]["time"]))
    if found["track"]["mode"][:count] != modes[:count]:
        wrong.append(f"modes {found['track']['mode']} instead of {modes}")
    sizes = sizes_of(run)
    for name, numbers in numbers_of(found).items():
        ours = run[name].values[:count] if name in SAMPLED else run[name].values
        theirs = np.array(numbers, dtype=float).ravel()
        if name in SAMPLED:
            theirs = theirs[: ours.size]
        if theirs.size != ours.size:
            wrong.append(f"{theirs.size} of {name} instead of {ours.size}")
            continue
        theirs = theirs.reshape(ours.shape)
        if not np.array_equal(np.isnan(theirs), np.isnan(ours)):
            wrong.append(f"{name} is missing elsewhere")
        most, size = apart(theirs, ours, name), sizes[run[name].attrs.get("units", "1")]
        known = beside is not None and beside[name].shape == run[name].shape
        grown = apart(beside[name].values, run[name].values, name) if known else 0.0
        allowed = max(MOST_OFF * size, ROUNDINGS * grown)
        if name in FORCES and most > allowed:
            allowed += friction_apart(found["track"], run, count)
        if most > allowed:
            wrong.append(f"{name} off by {most:.1e} of {size:.1e}")
    return wrong


def friction_apart(track: dict[str, Any], run: Any, count: int) -> float:
    """Return how far the friction law's force in the states of the page is from that in Python's.

    The law is Python's in both, N. Where a top creeps, at a slip of 1e-6 m/s, friction multiplies a
    difference of slip by 1e5 N s/m: slips that agree to 1e-12 m/s give forces that agree to 1e-7 N.
    """
    top = top_of(tt.Problem.from_json(run.attrs["problem"]))
    names = ("slip_x", "slip_y", "axis", "angular_momentum")
    forces = []
    for source in (track, run):
        x, y, axis, momentum = (
            np.array(source[name], dtype=float).ravel()[: count * run[name][0].size]
            for name in names
        )
        omega = angular_velocity(
            tuple(axis.reshape(-1, 3).T), tuple(momentum.reshape(-1, 3).T), top
        )
        with np.errstate(all="ignore"):
            forces.append(np.array(top.friction.traction((x, y), omega).force))
    return largest(run["normal_force"].values[:count] * np.hypot(*(forces[0] - forces[1])))


def sizes_of(run: Any) -> dict[str, float]:
    """The largest number of each unit in a run, beside which others are judged; and 1 rad, 1 s and
    1. Jellett's integral, zero but for rounding in planar motion, is judged beside its factors.
    """
    sizes = dict[str, float]()
    for name in SAMPLED | METRICS | LISTED:
        if run[name].dtype.kind == "f":
            units = run[name].attrs["units"]
            sizes[units] = max(sizes.get(units, 0.0), largest(np.abs(run[name].values)))
    units = run["jellett"].attrs["units"]
    factors = largest(np.abs(run["angular_momentum"].values)) * largest(run["height"].values)
    sizes[units] = max(sizes[units], factors)
    return sizes | dict.fromkeys(("rad", "s", "1"), 1.0)


def apart(a: Any, b: Any, name: str) -> float:
    """How far some numbers are from others, at most."""
    off = np.abs(a - b)
    return largest(np.minimum(off, 2.0 * np.pi - off) if name == "azimuth" else off)


def largest(numbers: Any) -> float:
    """The largest of some numbers but those that are missing; 0 if all are."""
    return float(np.max(numbers, initial=0.0, where=~np.isnan(numbers)))


def numbers_of(found: dict[str, Any]) -> dict[str, list[Any]]:
    """The numbers of what JavaScript made of a launch by their names in a run; steps are its own
    matter.
    """
    numbers = {name: found["track"][name] for name in SAMPLED}
    numbers |= {name: [found["metrics"][name]] for name in METRICS if name != "steps"}
    for name in LISTED:
        table, _, word = name.partition("_")
        if name != "event_kind":
            numbers[name] = [one[word] for one in found[f"{table}s"]]
    return numbers


def asked(seed: int, duration: float) -> dict[str, Any]:
    """What is asked of the engine."""
    times = np.linspace(0.0, duration, SAMPLES)
    return {
        "problem": launch_of(seed),
        "duration": duration,
        "tolerance": TOLERANCE,
        "times": times.tolist(),
    }


def in_python(fields: dict[str, Any], duration: float) -> Any:
    """The same launch in Python; None if it is refused."""
    try:
        return tt.simulate(
            tt.Problem(**fields),
            duration,
            samples=SAMPLES,
            integrator="taylor",
            tolerance=TOLERANCE,
        )
    except tt.InvalidInput as refusal:
        return str(refusal)


def nudged(fields: dict[str, Any]) -> dict[str, Any]:
    """The same launch but for a rounding of its tilt."""
    return fields | {
        "launch": fields["launch"] | {"tilt": math.nextafter(fields["launch"]["tilt"], 4.0)}
    }
