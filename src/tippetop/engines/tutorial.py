"""The tippe top of MuJoCo's tutorial, in MuJoCo and exactly.

Run as ``python -m tippetop.engines.tutorial``, it measures every number anew and prints it; with
``--write`` it stores what MuJoCo gives, which the page about it shows.
"""

import math
import sys
from collections.abc import Iterable, Iterator, Mapping
from importlib.resources import files
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

import tippetop as tt
from tippetop.engines.adapters.base import axis_of
from tippetop.engines.measurements import Measurements
from tippetop.engines.mjcf.reading import problem_of_mjcf
from tippetop.engines.reference import numbers_of
from tippetop.mechanics.laws.contensou import ELLIPSOIDAL_RADIUS
from tippetop.support.errors import Unavailable

Array = NDArray[np.float64]

FILE, STORED = "tutorial_top.xml", "tutorial_top.json"
"""Files of this package: the top, and what MuJoCo makes of it."""

MUJOCO = "MuJoCo"

DURATION = 8.0
"""Length of the runs, s: twice the time in which the top turns over in MuJoCo's tutorial."""

READINGS = 2e-3
"""How often a run in MuJoCo is read, s: its longest step."""

PATCHES = (1e-4, 2e-4, 5e-4)
"""Radii of the contact patches, m."""


class TopSetting(NamedTuple):
    """A way to run the top in MuJoCo."""

    about: str
    step: float
    options: Mapping[str, Any] = {}
    """Fields of `MjModel.opt`."""
    contact: Mapping[str, Any] = {}
    """Fields of the geoms in the model: `solref`, `solimp`."""
    patch: float = 0.0
    """Radius of a patch whose drilling friction the contact has, m; 0 without."""


def _never(about: str, **options: Any) -> TopSetting:
    return TopSetting(f"RK4, {about}", 2e-3, options)


_ON_A_PATCH = {"cone": "ELLIPTIC", "impratio": 100.0}
_STIFF = {"solref": (2e-4, 1.0), "solimp": (0.99, 0.999, 1e-4, 0.5, 2.0)}

SETTINGS = (
    *(TopSetting("RK4, as the tutorial sets it", step) for step in (2e-3, 1e-3, 5e-4, 1e-4)),
    *(
        TopSetting("implicitfast", step, {"integrator": "IMPLICITFAST"})
        for step in (2e-3, 1e-3, 1e-4)
    ),
    TopSetting("RK4, elliptic cone", 2e-3, {"cone": "ELLIPTIC"}),
    _never("impratio 100", impratio=100.0),
    _never("elliptic cone, impratio 100", cone="ELLIPTIC", impratio=100.0),
    _never("noslip_iterations 20", noslip_iterations=20),
    *(
        TopSetting("RK4, condim 4, elliptic cone, impratio 100", 1e-4, _ON_A_PATCH, {}, patch)
        for patch in PATCHES
    ),
    *(
        TopSetting("the same, solref 0.0002 1, solimp 0.99 0.999", 1e-4, _ON_A_PATCH, _STIFF, patch)
        for patch in PATCHES
    ),
)
"""What is measured in MuJoCo."""


CREEPING = ("RK4, elliptic cone",)
"""Runs that are compared with exact runs on the film that their contact acts as."""


class TopRun(NamedTuple):
    """What became of the top in a run."""

    about: str
    step: float
    """Length of the steps, s; nan for an exact run."""
    patch: float
    """Radius of the contact patch, m; 0 without."""
    turnover_time: float
    """First time at which the tilt passes a right angle, s; nan where it does not."""
    max_tilt: float
    """Largest tilt until then, or to the end, rad."""
    energy_lost: float
    """Part of the energy that is lost until then, or to the end."""
    jellett_change: float
    """Relative change of Jellett's integral until then, or to the end."""
    film: float
    """Friction over slip speed and normal force, s/m, the median until then: the coefficient of the
    viscous film that the contact acts as; nan where it is not measured.
    """


def text() -> str:
    """Return the top as MJCF."""
    return (files(__package__) / FILE).read_text(encoding="utf-8")


def problem(friction: tt.Friction | None = None) -> tt.Problem:
    """Return the top as a problem, on the dry friction of its file or on another."""
    top = problem_of_mjcf(text())
    return top if friction is None else top.model_copy(update={"friction": friction})


# In MuJoCo


def in_mujoco(setting: TopSetting, duration: float = DURATION) -> TopRun:
    """Return what MuJoCo makes of the top; raise `Unavailable` if it is not installed."""
    mujoco, model, data = _loaded(setting)
    readings = [_reading(mujoco, model, data)]
    steps = round(READINGS / setting.step)
    films, probe = list[float](), mujoco.MjData(model)
    for _ in range(round(duration / READINGS)):
        mujoco.mj_step(model, data, nstep=steps)
        readings.append(_reading(mujoco, model, data))
        if len(readings) % PROBED == 0:
            mujoco.mj_copyData(probe, model, data)
            films += _film(mujoco, model, probe)
        if readings[-1][0][2] < 0.0:
            break
    vectors = [np.array(column) for column in zip(*readings, strict=True)]
    numbers = numbers_of(problem(), *vectors)
    tilts, energy, jellett = (numbers[name] for name in ("tilt", "energy", "jellett"))
    over = math.nan
    if tilts[-1] > math.pi / 2:
        part = (math.pi / 2 - tilts[-2]) / (tilts[-1] - tilts[-2])
        over = READINGS * (len(tilts) - 2 + float(part))
    return TopRun(
        setting.about,
        setting.step,
        setting.patch,
        over,
        float(tilts.max()),
        float(1.0 - energy[-1] / energy[0]),
        float(jellett[-1] / jellett[0] - 1.0),
        float(np.median(films)) if films and not setting.patch else math.nan,
    )


PROBED = 25
"""Number of readings between two at which the contact is probed."""


def _loaded(setting: TopSetting) -> tuple[Any, Any, Any]:
    """Return MuJoCo, the model at a setting, and its data at launch."""
    try:
        import mujoco  # noqa: PLC0415 - optional
    except ImportError:
        raise Unavailable("MuJoCo is not installed: pip install 'tippetop[engines]'") from None
    model = mujoco.MjModel.from_xml_string(text())
    model.opt.timestep = setting.step
    kinds = {"integrator": "mjtIntegrator.mjINT_", "cone": "mjtCone.mjCONE_"}
    for name, value in setting.options.items():
        if name in kinds:
            family, prefix = kinds[name].split(".")
            value = getattr(getattr(mujoco, family), f"{prefix}{value}")  # noqa: PLW2901
        setattr(model.opt, name, value)
    for name, value in setting.contact.items():
        getattr(model, f"geom_{name}")[:] = value
    if setting.patch:
        model.geom_condim[:] = 4
        model.geom_friction[:] = (1.0, ELLIPSOIDAL_RADIUS * setting.patch, 0.0)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    return mujoco, model, data


def _reading(mujoco: Any, model: Any, data: Any) -> tuple[Array, Array, Array, float]:
    """Return axis, angular velocity, and velocity and height of the centre of mass."""
    turn = np.zeros(9)
    mujoco.mju_quat2Mat(turn, data.qpos[3:7])
    omega = turn.reshape(3, 3) @ data.qvel[3:6]
    away = turn.reshape(3, 3) @ model.body_ipos[1]
    velocity = data.qvel[:3] + np.cross(omega, away)
    return axis_of(data.qpos[3:7]), omega, velocity, float(data.qpos[2] + away[2])


def _film(mujoco: Any, model: Any, data: Any) -> list[float]:
    """Return friction over slip speed and normal force, s/m, if there is one contact."""
    mujoco.mj_forward(model, data)
    if data.ncon != 1:
        return []
    contact, force = data.contact[0], np.zeros(6)
    mujoco.mj_contactForce(model, data, 0, force)
    turn = np.zeros(9)
    mujoco.mju_quat2Mat(turn, data.qpos[3:7])
    omega = turn.reshape(3, 3) @ data.qvel[3:6]
    velocity = data.qvel[:3] + np.cross(omega, contact.pos - data.qpos[:3])
    slip = contact.frame.reshape(3, 3)[1:] @ velocity
    return [float(np.linalg.norm(force[1:3]) / np.linalg.norm(slip) / force[0])]


# Exactly


def exactly(friction: tt.Friction | None = None, duration: float = DURATION) -> TopRun:
    """Return what the top does on a friction law; without one on the dry friction of its file."""
    top = problem(friction)
    run = tt.simulate(top, duration, samples=2)
    over = float(run["turnover_time"])
    if math.isfinite(over):
        run = tt.simulate(top, over, samples=2)
    match top.friction:
        case tt.ContensouFriction(patch_radius=patch, pressure=pressure):
            about = f"a drilling patch, {pressure}"
        case tt.ViscousFriction(mu=mu):
            patch, about = 0.0, f"a viscous film, {mu:.4g} s/m"
        case _:
            patch, about = 0.0, "dry friction, mu = 1"
    energy, jellett = run["energy"].values, run["jellett"].values
    return TopRun(
        about,
        math.nan,
        patch,
        over,
        float(run["max_tilt"]),
        float(1.0 - energy[-1] / energy[0]),
        float(jellett[-1] / jellett[0] - 1.0),
        math.nan,
    )


def first_stick(friction: tt.Friction | None = None) -> float:
    """Return when the contact first sticks, s; nan where it never does."""
    run = tt.simulate(problem(friction), DURATION, samples=2)
    sticks = run["event_time"].values[run["event_kind"].values == "stick"]
    return float(sticks[0]) if len(sticks) else math.nan


# What is measured


def _line(run: TopRun) -> str:
    turns = f"{run.turnover_time:.3f} s" if math.isfinite(run.turnover_time) else "never"
    step = "" if math.isnan(run.step) else f"{1e3 * run.step:g} ms"
    patch = f"{1e3 * run.patch:g} mm" if run.patch else ""
    film = "" if math.isnan(run.film) else f"{run.film:.4g} s/m"
    return (
        f"{run.about:<55}{step:>7}{patch:>8}{turns:>10}{run.max_tilt:>9.4f}"
        f"{run.energy_lost:>10.4f}{run.jellett_change:>+10.4f}{film:>11}"
    )


def _measured(program: str) -> Iterator[TopRun]:
    """Yield what MuJoCo makes of the top now."""
    return map(in_mujoco, SETTINGS)


TOP_RUNS = Measurements(
    about="What becomes of the tutorial's top in MuJoCo, and exactly.",
    file=STORED,
    row=TopRun,
    packages={MUJOCO: "mujoco"},
    measure=_measured,
    program_of=lambda run: MUJOCO,
    line=_line,
    heading=(
        f"{'':<55}{'step':>7}{'patch':>8}{'over at':>10}{'tilt':>9}{'energy':>10}{'Jellett':>10}"
    ),
)


def exact_runs(stored: Iterable[TopRun]) -> Iterator[TopRun]:
    """Yield exact runs: on dry friction, on the films of stored runs that creep, on patches."""
    yield exactly()
    for run in stored:
        if run.about in CREEPING:
            yield exactly(tt.ViscousFriction(mu=run.film))
    for pressure in ("hertz", "ellipsoidal"):
        for patch in PATCHES:
            yield exactly(tt.ContensouFriction(mu=1.0, patch_radius=patch, pressure=pressure))


def main(words: list[str]) -> None:
    """Print what becomes of the top in MuJoCo and exactly; with --write, store the first."""
    TOP_RUNS.run(words)
    for run in exact_runs(TOP_RUNS.stored().rows):
        print(_line(run))
    print(f"on dry friction it sticks after {1e3 * first_stick():.4g} ms")


if __name__ == "__main__":
    main(sys.argv[1:])
