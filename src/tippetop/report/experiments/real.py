"""Real tops and other toys: stems that strike the table, an egg, a disk and two balls."""

import math

import numpy as np
import xarray as xr

from tippetop.problem.bodies import Body
from tippetop.problem.frictions import ContensouFriction, CoulombFriction, ViscousFriction
from tippetop.problem.launch import Launch
from tippetop.problem.presets import (
    EGG,
    EULER_DISK,
    HURRICANE_BALLS,
    LEINE_GLOCKER_STEM,
    REPORT_STEM,
    report_problem,
)
from tippetop.problem.problem import Problem, top_of
from tippetop.problem.shapes import Shape, Sphere
from tippetop.report.experiment import dataset, experiment
from tippetop.report.experiments.runs import event_times
from tippetop.run import simulate
from tippetop.theory.resting_center import RestingCenter, resting_center
from tippetop.theory.stem import jellett_about, least_jellett_to_stand

GRAVITY = 9.81
"""Gravity in published experiments and computations, m/s^2."""

LEINE = Problem(
    body=LEINE_GLOCKER_STEM,
    friction=ContensouFriction(mu=0.3, patch_radius=5e-4, pressure="ellipsoidal"),
    launch=Launch(tilt=0.1, spin=180.0, velocity=(0.0, 0.0, 0.0)),
    gravity=GRAVITY,
)
"""The launch of Leine and Glocker (2003), with their stem."""

LEINE_WINDOW = 8.0
"""Length of Leine and Glocker's run, s."""

REACH = 0.03
"""Height of the stem's end above the centre of mass, the same for all stems, m."""

STEM_WINDOW = 20.0
"""Length of the runs of tops with stems, s."""

UPRIGHT_ON_STEM = 0.1
"""Distance of the final tilt from pi within which a top stands on its stem, rad."""

EGG_MU = 1.0
"""Viscous friction under the egg, s/m."""

EGG_WINDOW = 8.0
"""Length of the runs of eggs, s."""

ROUGH = CoulombFriction(mu=1.0)
"""Friction on which the disk and the balls never slip."""

BALL_TILTS = (1.2, 1.55)
"""Range of tilts of the hurricane balls, rad: at a right angle the other ball touches too."""

ROLLING_WINDOW = 0.2
"""Length of the runs of steady rolling, s: some turns."""


def first_of(times: np.ndarray, after: float = 0.0) -> float:
    """Return the first of some times after `after`, s; nan if there is none."""
    later = times[times > after]
    return float(later[0]) if len(later) else math.nan


EVENTS = {
    "stem": "first touch of the stem",
    "back": "first touch of the sphere again",
    "both": "beginning of double contact",
    "apart": "end of double contact",
}
"""Events of Leine and Glocker's top."""


def contact_events(run: xr.Dataset) -> dict[str, float]:
    """Return the times of `EVENTS` in a run, s."""
    both = first_of(event_times(run, "double contact"))
    stem, back = (first_of(event_times(run, "touchdown", surface)) for surface in (1, 0))
    return {
        "stem": stem,
        "back": back,
        "both": both,
        "apart": first_of(event_times(run, "opening"), both),
    }


@experiment("real-leine", "Leine and Glocker's top, stem and all", 8.0)
def _leine(quick: bool) -> xr.Dataset:
    """Return Leine and Glocker's top: first touch of the stem, fall back, and contact of both
    surfaces.
    """
    pressures = ["ellipsoidal"] if quick else ["ellipsoidal", "hertz"]
    problems = [LEINE.replace({"friction.pressure": name}) for name in pressures]
    runs = [simulate(problem, LEINE_WINDOW, samples=801) for problem in problems]
    times = [contact_events(run) for run in runs]
    errors = [float(run["energy_error"]) for run in runs]
    return dataset(
        {"pressure": pressures, "time": runs[0]["time"].values},
        tilt=([run["tilt"].values for run in runs], "rad", "tilt", "pressure", "time"),
        energy_error=(errors, "1", "energy", "pressure"),
        **{
            name: ([each[name] for each in times], "s", long, "pressure")
            for name, long in EVENTS.items()
        },
    )


def with_stem(radius: float) -> Body:
    """Return the report's top with a stem that ends in a sphere of this radius, m, at a fixed
    height.
    """
    bowl, _ = REPORT_STEM.shapes
    shapes: list[Shape] = [bowl, Sphere(radius=radius, center=REACH - radius)]
    return REPORT_STEM.model_copy(update={"shape": tuple(shapes)})


@experiment("real-stems", "which stems let the report's top stand", 2.0)
def _stems(quick: bool) -> xr.Dataset:
    """Return final tilts of the report's top on stems, and Jellett's integral when they first
    touch.
    """
    radii = np.array([0.003, 0.006, 0.009, 0.012]) if quick else np.arange(0.002, 0.0141, 0.001)
    final, needed, brought, struck = [], [], [], []
    for radius in radii.tolist():
        problem = report_problem().replace({"body": with_stem(radius)})
        run = simulate(problem, STEM_WINDOW, samples=2001)
        touch = first_of(event_times(run, "touchdown", 1))
        before = run.isel(time=int(np.searchsorted(run["time"].values, touch)) - 1)
        axis, momentum = (
            tuple(before[name].values.tolist()) for name in ("axis", "angular_momentum")
        )
        brought.append(abs(jellett_about(1, axis, momentum, top_of(problem))))
        needed.append(least_jellett_to_stand(problem.body))
        struck.append(touch)
        final.append(float(run["tilt"][-1]))
    over = "radius"
    return dataset(
        {"radius": (radii, "m", "radius of the stem's tip")},
        {"window_s": STEM_WINDOW, "upright_rad": UPRIGHT_ON_STEM, "reach_m": REACH},
        final_tilt=(final, "rad", "tilt at the end", over),
        jellett=(brought, "kg m3 s-1", "Jellett's integral about the tip at its touch", over),
        jellett_needed=(needed, "kg m3 s-1", "least Jellett's integral to stand on the tip", over),
        touch=(struck, "s", "first touch of the stem", over),
    )


@experiment("real-egg", "a hard-boiled egg that rises", 4.0)
def _egg(quick: bool) -> xr.Dataset:
    """Return tilts and lift-offs of a hard-boiled egg that is spun on its side at several rates."""
    rates = [60.0, 200.0] if quick else [40.0, 60.0, 80.0, 100.0, 120.0, 150.0, 200.0]
    friction = ViscousFriction(mu=EGG_MU)
    launches = [Launch(tilt=1.5, spin=0.0, precession=rate) for rate in rates]
    problems = [Problem(body=EGG, friction=friction, launch=launch) for launch in launches]
    runs = [simulate(problem, EGG_WINDOW, samples=401) for problem in problems]
    lifts = [first_of(event_times(run, "liftoff")) for run in runs]
    return dataset(
        {
            "rate": (rates, "rad s-1", "rate of turning about the vertical at launch"),
            "time": runs[0]["time"].values,
        },
        {"mu_s_per_m": EGG_MU},
        tilt=([run["tilt"].values for run in runs], "rad", "tilt", "rate", "time"),
        liftoff=(lifts, "s", "lift-off", "rate"),
    )


def rolling(body: Body, tilt: float) -> tuple[RestingCenter, xr.Dataset] | None:
    """Return the rolling of a body with its centre at rest, and a run of it; None if it cannot."""
    launch = Launch(tilt=tilt, spin=0.0)
    problem = Problem(body=body, friction=ROUGH, launch=launch, gravity=GRAVITY)
    motion = resting_center(tilt, top_of(problem))
    if motion is None:
        return None
    rolls = problem.replace({"launch.spin": motion.spin, "launch.precession": motion.precession})
    return motion, simulate(rolls, ROLLING_WINDOW, samples=41)


@experiment("real-rolling", "Euler's disk and hurricane balls", 2.0)
def _rolling(quick: bool) -> xr.Dataset:
    tilts = {"disk": [0.1, 0.3, 0.5] if quick else np.linspace(0.05, 0.6, 12).tolist()}
    tilts["balls"] = np.linspace(*BALL_TILTS, 4 if quick else 12).tolist()
    bodies = {"disk": EULER_DISK, "balls": HURRICANE_BALLS}
    measured: dict[str, list[tuple[float, float, float, float]]] = {name: [] for name in bodies}
    for name, body in bodies.items():
        for tilt in tilts[name]:
            rolls = rolling(body, tilt)
            if rolls is not None:
                motion, run = rolls
                precession = float(run["precession"].mean())
                drift = float(np.abs(run["tilt"] - tilt).max())
                measured[name].append((tilt, motion.precession, precession, drift))
    columns = {
        f"{name}_{label}": (list(values), *meaning, name)
        for name, rows in measured.items()
        for (label, *meaning), values in zip(_COLUMNS, zip(*rows, strict=True), strict=True)
    }
    radius = float(EULER_DISK.shapes[0].surface.size)
    thin = np.sqrt(4.0 * GRAVITY / (radius * np.sin([row[0] for row in measured["disk"]])))
    return dataset(
        {},
        {"ball_radius_m": float(HURRICANE_BALLS.shapes[0].surface.size), "gravity": GRAVITY},
        disk_thin=(thin, "rad s-1", "precession of a thin disk", "disk"),
        **columns,
    )


_COLUMNS = (
    ("tilt", "rad", "tilt"),
    ("precession", "rad s-1", "precession by the closed formula"),
    ("measured", "rad s-1", "mean precession of a run"),
    ("drift", "rad", "how far the tilt of the run goes from that at launch"),
)
