"""A sweep is its runs: metrics, samples and events of every launch are those of a single run."""

from collections.abc import Callable, Mapping, Sequence
from itertools import product
from math import pi
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
import xarray as xr

import own_parts
import tippetop as tt
from test_laws_with_exponentials import LAWS as EXPONENTIALS
from tippetop.mechanics.top import natural_units
from tippetop.problem.problem import top_of
from tippetop.results.catalogue import LISTED, METRICS, MONITORS, SAMPLED, Variable
from tippetop.sweeps import ensemble
from tippetop.sweeps.single_launches import SINGLE

ROOT = Path(__file__).resolve().parents[2]
TOLERANCE = 1e-12
"""Relative error per step of the sweeps."""
CLOSENESS = 1e-8
"""Largest difference between a sweep and its runs, relative to the largest number of the same unit
in the run: the errors of some thousand steps, and what the motion makes of the first of them.
"""
SAMPLE_TIMES = np.array([0.0, 1e-5, 2e-5, 0.17, 0.33, 0.52, 0.71, 1.0])
"""Times of the samples over the duration: several within a step, and several steps between two."""


class Row(NamedTuple):
    """A sweep that is compared with its runs."""

    problem: tt.Problem
    over: Mapping[str, Sequence[float]]
    duration: float
    """s."""
    shows: str = ""
    """Events and outcomes that must be among those of the runs, or the row would not tell of them;
    in the words of a sweep.
    """
    keep: Sequence[str] = (*SAMPLED, "events")
    """Variables compared beside the metrics: without samples a sweep follows other numbers."""
    is_single: bool = False
    """Whether the sweep follows its launches one by one from the start."""
    most_events: int = 60
    integrator: str | None = None
    """Method of the runs."""


def report(changes: Mapping[str, Any] | None = None, **launch: float) -> tt.Problem:
    """Return the report's problem with another launch and with changes."""
    return tt.presets.report_problem(**launch).replace(dict(changes or {}))


def of(body: tt.Body, friction: tt.Friction, launch: tt.Launch, **others: Any) -> tt.Problem:
    """Return the problem of a body on a table of a law."""
    return tt.Problem(body=body, friction=friction, launch=launch, **others)


def thrown_without_spin(body: tt.Body) -> tt.Problem:
    """Return the problem of a body that falls leaning on a viscous table and rebounds."""
    launch = tt.Launch(tilt=1.2, spin=0.0, gap=0.01)
    return of(body, VISCOUS, launch, contact=tt.Contact(restitution=0.5))


HERTZ = tt.ContensouFriction(mu=0.3, patch_radius=1e-3, pressure="hertz")
ELLIPSOIDAL = tt.ContensouFriction(mu=0.3, patch_radius=1e-3, pressure="ellipsoidal")
COULOMB = tt.CoulombFriction(mu=0.3)
VISCOUS = tt.ViscousFriction(mu=0.3)
LAWS = {
    "viscous": VISCOUS,
    "regularized": tt.RegularizedCoulombFriction(mu=0.3, eps=0.01),
    "drilling": tt.ContensouFriction(mu=0.3, patch_radius=5e-4, pressure="ellipsoidal"),
    "hertz": tt.ContensouFriction(mu=0.3, patch_radius=5e-4, pressure="hertz"),
    "dry": COULOMB,
}
SLOPE = {"table": tt.Table(slope=0.1, azimuth=0.7)}
AIR = {
    "air": tt.Air(
        axial_linear=1e-7,
        axial_quadratic=1e-9,
        transverse_linear=2e-7,
        transverse_quadratic=1e-9,
        drag_linear=1e-3,
        drag_quadratic=1e-3,
    )
}
FIELDS: dict[str, dict[str, Any]] = {
    "level": {},
    "slope": SLOPE,
    "air": AIR,
    "slope and air": SLOPE | AIR,
}
RING = tt.Body(mass=0.05, shape=tt.Ring(radius=0.02), I1=5e-6, I3=1e-5)
EGG = tt.Body(mass=0.05, shape=tt.Spheroid(across=0.02, along=0.03), I1=9e-6, I3=5e-6)
DUMBBELL = tt.Body(
    mass=0.01,
    shape=[tt.Sphere(radius=0.005, center=0.02), tt.Sphere(radius=0.005, center=-0.02)],
    I1=2e-6,
    I3=1.25e-7,
)

SPINNING_EGG = of(EGG, LAWS["regularized"], tt.Launch(tilt=1.5, spin=0.0, precession=150.0))
LYING = tt.Launch(tilt=0.0, spin=20.0, slip=(0.3, 0.0), azimuth=0.4)

ROWS = {
    "lift-off, flight": Row(
        report(tilt=1.0),
        {"launch.spin": [90.0, 190.0], "friction.mu": [0.2, 1.0]},
        1.4,
        "liftoff touchdown impact moving_tilted",
    ),
    "lift-off, stop": Row(
        report({"contact.liftoff": "stop"}, tilt=1.0),
        {"launch.spin": [90.0, 190.0], "friction.mu": [0.2, 1.0]},
        1.4,
        "lifted_off moving_tilted",
    ),
    "lift-off, ignored": Row(
        report({"contact.liftoff": "ignore"}, tilt=1.0),
        {"launch.spin": [90.0, 190.0], "friction.mu": [0.2, 1.0]},
        1.4,
        "moving_tilted",
    ),
    "every end": Row(
        report(),
        {"launch.spin": [10.0, 50.0, 155.0, 180.0]},
        12.0,
        "upright tilted inverted moving_inverted liftoff",
        keep=("events", "tilt"),
        most_events=4,
    ),
    "dips that nearly tie": Row(
        report(),
        {"launch.tilt": [1.1, 1.44], "launch.spin": [140.0, 170.0, 200.0]},
        8.0,
        "moving_tilted moving_upright",
        keep=(),
    ),
    "steep launches": Row(
        report({"launch.precession": -40.0}),
        {"launch.tilt": [1.6, 2.0, 2.5], "launch.spin": [5.0, 155.0]},
        0.8,
        "liftoff",
    ),
    "steep launches that are held": Row(
        report({"launch.precession": -40.0, "contact.liftoff": "ignore"}, spin=5.0),
        {"launch.tilt": [1.6, 2.0, 2.5]},
        0.8,
    ),
    "thrown": Row(
        report(),
        {
            "launch.gap": [0.0, 0.003, 0.05],
            "launch.tilt": [0.5, 2.5],
            "contact.restitution": [0.0, 0.6],
        },
        0.3,
        "touchdown impact liftoff",
    ),
    "still in the air": Row(report(), {"launch.gap": [0.5, 50.0]}, 0.2, "moving_upright"),
    "at rest": Row(report(tilt=0.0), {"launch.spin": [0.0]}, 1.0, "upright"),
    "at the pole, elsewhere": Row(
        report(spin=175.0),
        {"launch.tilt": [0.0, 0.3, 2.0], "launch.azimuth": [0.0, 2.5]},
        3.0,
    ),
    "launched with a velocity": Row(
        report({"launch.tilt_rate": 3.0, "launch.velocity": (0.1, 0.0)}),
        {"launch.velocity.2": [-0.2, 0.0]},
        0.05,
        "impact",
    ),
    "settling, some without slope or air": Row(
        report(),
        {"table.slope": [0.0, 0.01], "air.axial_linear": [0.0, 1e-8]},
        10.0,
        "inverted moving_inverted",
        keep=(),
    ),
    "stiff": Row(report(spin=155.0), {"friction.mu": [0.3, 1e5]}, 0.3, "moving_upright"),
    "egg": Row(SPINNING_EGG, {"launch.precession": [60.0, 150.0]}, 0.6),
    "egg that is held": Row(
        SPINNING_EGG.replace({"contact.liftoff": "ignore"}),
        {"launch.precession": [60.0, 150.0]},
        0.6,
    ),
    "ring that falls flat": Row(
        of(RING, tt.ViscousFriction(mu=1.0), tt.Launch(tilt=0.3, spin=0.0)),
        {"launch.spin": [0.0, 40.0], "launch.tilt": [0.0, 0.3]},
        0.2,
        "lies_down",
    ),
    "ring thrown without spin": Row(
        thrown_without_spin(RING),
        {"launch.tilt": [0.8, 1.2, 1.9]},
        0.3,
        "lies_down impact",
    ),
    "coin thrown without spin": Row(
        thrown_without_spin(tt.presets.COIN),
        {"launch.tilt": [0.8, 1.2, 1.9]},
        0.3,
        "lies_down impact",
        is_single=True,
    ),
    "coin that slips until it lies flat": Row(
        of(
            tt.presets.COIN,
            tt.CoulombFriction(mu=0.1),
            tt.Launch(tilt=0.2, spin=0.0, tilt_rate=-40.0),
        ),
        {"launch.tilt": [0.18, 0.2]},
        0.1,
        "lies_down",
        is_single=True,
    ),
    "faces": Row(
        of(tt.presets.COIN, COULOMB, LYING, contact=tt.Contact(face_pressure="rim")),
        {"launch.spin": [0.0, 20.0], "launch.tilt": [0.0, pi]},
        5.0,
        "at_rest rests",
        is_single=True,
    ),
    "face that lands": Row(
        of(
            tt.presets.COIN,
            COULOMB,
            tt.Launch(tilt=0.0, spin=0.0, gap=0.01, velocity=(0.4, 0.1, 0.0)),
        ),
        {"launch.spin": [0.0, 30.0]},
        1.0,
        "at_rest lies_down impact",
        is_single=True,
    ),
    "static friction": Row(
        of(
            RING,
            tt.StaticCoulombFriction(mu=0.2, static_mu=0.3),
            tt.Launch(tilt=1.7, spin=0.0, precession=2.0),
        ),
        {"friction.static_mu": [0.25, 0.3, 0.4]},
        0.12,
        "slip",
    ),
    "rolling resistance": Row(
        report({"friction": VISCOUS, "rolling_resistance": 1e-5}, tilt=0.3),
        {"launch.spin": [5.0, 120.0]},
        0.4,
    ),
    "rolling that ends": Row(
        report({"friction": ELLIPSOIDAL, "rolling_resistance": 1e-4}, tilt=0.5, spin=5.0),
        {"rolling_resistance": [0.0, 4e-4]},
        1.2,
        "at_rest rolling_stops",
    ),
    "rolling on two surfaces": Row(
        of(
            DUMBBELL,
            COULOMB,
            tt.Launch(tilt=pi / 2, spin=0.0, velocity=(0.0, 0.2, 0.0)),
            rolling_resistance=2e-4,
        ),
        {"rolling_resistance": [2e-4, 2e-3]},
        0.4,
        "at_rest rolling_starts stick",
        is_single=True,
    ),
    "stem": Row(
        report({"body": tt.presets.REPORT_STEM}, tilt=2.3),
        {"body.shape.1.center": [0.002, 0.016, 0.02], "launch.spin": [40.0, 100.0]},
        0.5,
        "invalid touchdown",
        is_single=True,
    ),
    "stem of two patches": Row(
        of(tt.presets.LEINE_GLOCKER_STEM, LAWS["hertz"], tt.Launch(tilt=0.1, spin=180.0)),
        {"launch.spin": [120.0, 180.0]},
        0.3,
        is_single=True,
    ),
    "exponential": Row(
        report({"friction": EXPONENTIALS["exp"][0]}, tilt=0.3),
        {"launch.spin": [150.0, 155.0]},
        0.4,
    ),
    "beside another method": Row(
        report({"friction.mu": 0.5}, tilt=1.0, spin=190.0),
        {"launch.spin": [190.0]},
        0.4,
        integrator="dop853",
    ),
}
ROWS |= {
    f"{law}, stick and slip": Row(
        report({"friction": friction, "launch.slip": (0.3, 0.0)}),
        {"launch.spin": [60.0, 120.0]},
        0.4,
        "stick" if law == "dry" else "",
    )
    for law, friction in {"dry": COULOMB, "ellipsoidal": ELLIPSOIDAL, "hertz": HERTZ}.items()
}
ROWS |= {
    f"branches of hertz, {liftoff}": Row(
        report({"friction": HERTZ, "contact.liftoff": liftoff}),
        {"launch.spin": [100.0, 172.0, 185.0]},
        1.0,
        "" if liftoff == "ignore" else "liftoff",
    )
    for liftoff in ("stop", "ignore", "fly")
}
ROWS["branches of hertz, changed in the step in which the top turns over"] = Row(
    report(
        {"friction": HERTZ, "contact.liftoff": "ignore", "launch.precession": 100.0},
        tilt=1.57,
        spin=0.0,
    ).replace({"launch.tilt_rate": 10.0}),
    {"launch.slip.0": [0.105, 0.106]},
    0.005,
)
ROWS |= {
    f"own {part}": Row(
        problem,
        own_parts.OVER[part],
        0.6,
        is_single=part in ("law with a choice", "mode"),
    )
    for part, problem in own_parts.PROBLEMS.items()
}
FIELD_ROWS = {
    f"{law}, {field}": Row(
        report({"friction": friction, **changes}),
        {"launch.spin": [60.0, 150.0, 230.0], "launch.tilt": [0.1, 1.0]},
        0.5,
    )
    for (law, friction), (field, changes) in product(LAWS.items(), FIELDS.items())
}
"""Slides, flights and impacts, with every law of the lanes on every table."""
ROWS |= FIELD_ROWS
SLOW = {
    *(set(FIELD_ROWS) - {"drilling, slope and air", "dry, slope"}),
    "rolling resistance",
    "own law with rolling resistance",
    "own law with a choice",
    "own mode",
}
"""What only `make test-all` looks at."""


def words(names: xr.DataArray) -> list[str]:
    """Return the kinds of events of a run in the words of a sweep."""
    return [str(name).replace(" ", "_") for name in names.values]


def sizes_by_unit(problem: tt.Problem, run: xr.Dataset) -> dict[str, float]:
    """Return the largest number of a run in every unit, or the natural unit if that is larger."""
    natural = natural_units(top_of(problem))
    sizes = {"1": 1.0, "rad": 1.0, "rad s-1": 1.0 / natural.time, "m": natural.length}
    sizes |= {"s": natural.time, "m s-1": natural.speed, "J": natural.energy}
    sizes |= {"N": natural.energy / natural.length, "N m": natural.energy}
    sizes |= {"N s": natural.mass * natural.speed}
    sizes |= {"kg m2 s-1": natural.energy * natural.time}
    sizes |= {"kg m3 s-1": natural.energy * natural.time * natural.length}
    variables: dict[str, Variable] = {**METRICS, **SAMPLED, **MONITORS, **LISTED}
    for name, variable in variables.items():
        if variable.units:
            number = float(np.nan_to_num(np.abs(run[name].values)).max(initial=0.0))
            sizes[variable.units] = max(sizes[variable.units], number)
    return sizes


def differences(
    row: Row, cell: xr.Dataset, run: xr.Dataset, sizes: Mapping[str, float]
) -> dict[str, float]:
    """Return how much the variables of a launch differ, relative to the sizes of their units.

    What has no unit, and which numbers are missing, is asserted to be the same.
    """
    pairs = {name: (cell[name].values, run[name].values) for name in METRICS}
    del pairs["steps"]
    assert str(cell["outcome"].item()) == str(run["outcome"].item())
    if "events" in row.keep:
        kinds = words(run["event_kind"])
        assert int(cell["event_count"]) == len(kinds)
        listed = min(len(kinds), row.most_events)
        assert cell["event_kind"].values.tolist() == [
            *kinds[:listed],
            *[""] * (row.most_events - listed),
        ]
        for name in ("event_time", "event_impulse", "event_energy_lost", "event_surface"):
            assert np.all(np.isnan(cell[name][listed:]) | (cell[name][listed:] == -1)), name
            pairs[name] = cell[name].values[:listed], run[name].values[:listed]
    samples = [name for name in row.keep if name != "events"]
    if samples:
        times = row.duration * SAMPLE_TIMES
        lasts = times <= float(run["end_time"])
        assert np.array_equal(cell["is_sampled"], lasts)
        at = run.sel(time=times[lasts])
        for name in samples:
            assert np.isnan(cell[name].values[~lasts]).all(), name
            assert cell[name].dims == run[name].dims, name
            pairs[name] = cell[name].values[lasts], at[name].values
    units = {name: variable.units for name, variable in {**METRICS, **SAMPLED, **LISTED}.items()}
    found = {}
    for name, (got, expected) in pairs.items():
        if not units[name] or expected.dtype.kind != "f":
            assert np.array_equal(got, expected), name
            continue
        assert np.array_equal(np.isnan(got), np.isnan(expected)), name
        assert not np.isinf(got).any(), name
        assert not np.isinf(expected).any(), name
        apart = got - expected
        if name == "azimuth":
            apart = (apart + pi) % (2.0 * pi) - pi
        found[name] = float(np.nan_to_num(np.abs(apart)).max(initial=0.0)) / sizes[units[name]]
    return found


def swept(row: Row) -> xr.Dataset:
    """Carry out the sweep of a row."""
    options: dict[str, Any] = {"keep": list(row.keep)} if row.keep else {}
    if set(row.keep) - {"events"}:
        options["times"] = row.duration * SAMPLE_TIMES
    if "events" in row.keep:
        options["most_events"] = row.most_events
    return tt.sweep(
        row.problem, row.over, duration=row.duration, tolerance=TOLERANCE, workers=1, **options
    )


def compare(row: Row, cells: xr.Dataset) -> dict[str, float]:
    """Compare the launches of a sweep with single runs; return the largest differences by name."""
    largest: dict[str, float] = {}
    shown = set(cells["outcome"].values.ravel().tolist())
    for place in np.ndindex(*cells["outcome"].shape):
        cell = cells.isel(dict(zip(cells["outcome"].dims, place, strict=True)))
        fields = zip(row.over.items(), place, strict=True)
        changes = {field: numbers[k] for (field, numbers), k in fields}
        if cell["outcome"] == "invalid":
            with pytest.raises(tt.InvalidInput):
                row.problem.replace(changes)
            continue
        times, problem = row.duration * SAMPLE_TIMES, row.problem.replace(changes)
        run = tt.simulate(problem, row.duration, times=times, integrator=row.integrator)
        shown |= set(words(run["event_kind"]))
        sizes = sizes_by_unit(problem, run)
        for name, number in differences(row, cell, run, sizes).items():
            largest[name] = max(largest.get(name, 0.0), number)
    assert shown >= set(row.shows.split()), shown
    return largest


@pytest.mark.parametrize(
    "row",
    [
        pytest.param(row, id=name, marks=pytest.mark.slow if name in SLOW else ())
        for name, row in ROWS.items()
    ],
)
def test_a_sweep_is_its_runs(row: Row, monkeypatch: pytest.MonkeyPatch) -> None:
    follow_each: Callable[..., Any] = ensemble.follow_each
    followed: list[int] = []

    def noted(launches: Any, *options: Any) -> Any:
        followed.append(len(launches))
        return follow_each(launches, *options)

    monkeypatch.setattr(ensemble, "follow_each", noted)
    cells = swept(row)
    assert bool(followed) == row.is_single
    too_far = {name: far for name, far in compare(row, cells).items() if not far <= CLOSENESS}
    assert too_far == {}


def test_errors_are_below_1e_10_times_the_condition_of_the_launch() -> None:
    problem, step = report(), 1e-7
    spins = [60.0, 150.0, 250.0]
    found = tt.sweep(
        problem, {"launch.spin": spins}, duration=4.0, keep="axis", samples=200, workers=1
    )
    for spin in spins:
        launched = problem.replace({"launch.spin": spin})
        exact = tt.simulate(launched, 4.0, samples=200)["axis"].values
        condition = 0.0
        for field in ("launch.spin", "launch.tilt", "friction.mu"):
            shifted = launched.replace({field: launched.get(field) * (1.0 + step)})
            moved = tt.simulate(shifted, 4.0, samples=200)["axis"].values
            condition += np.abs(moved - exact).max() / step
        error = np.abs(found["axis"].sel(spin=spin).values - exact).max()
        assert error <= 1e-10 * condition


@pytest.mark.parametrize(
    "law", [pytest.param(law, marks=pytest.mark.slow if law != "viscous" else ()) for law in LAWS]
)
def test_errors_of_sums_are_below_1e_10_times_the_condition_of_the_launch(law: str) -> None:
    step, duration = 1e-7, 1.0
    problem = report(tilt=0.3, spin=150.0).replace({"friction": LAWS[law]})
    kept = ["x", "y", "orientation", "work"]
    options = {"duration": duration, "samples": 50}
    found = tt.sweep(problem, {"launch.spin": [150.0]}, keep=kept, workers=1, **options)
    exact = tt.simulate(problem, **options)[kept]
    condition = dict.fromkeys(kept, 0.0)
    for field in ("launch.spin", "launch.tilt", "friction.mu"):
        shifted = problem.replace({field: problem.get(field) * (1.0 + step)})
        moved = np.abs(tt.simulate(shifted, **options)[kept] - exact).max()
        condition = {name: condition[name] + float(moved[name]) / step for name in kept}
    error = np.abs(found[kept].isel(spin=0) - exact).max()
    for name in kept:
        assert float(error[name]) <= 1e-10 * condition[name], name


def test_the_documentation_says_what_is_followed_by_itself_from_the_start() -> None:
    page = " ".join((ROOT / "docs" / "howto" / "sweep.md").read_text("utf-8").split())
    assert [reason for reason in SINGLE if reason not in page] == []
