"""Single launches, by the report's method and converged."""

import math
from collections.abc import Mapping

import numpy as np
import xarray as xr

from tippetop.mechanics.euler import published_energy
from tippetop.problem.presets import REPORT_TABLE_1, report_problem
from tippetop.problem.problem import Problem, top_of
from tippetop.report.experiment import dataset, experiment, variable
from tippetop.report.listing import VARIABLES, listing_run
from tippetop.report.printed_numbers import END_OF_FIG_5, ROUGH_FRICTION, SPIN, TILT
from tippetop.report.readings import (
    SETTLED,
    SHOWN,
    crossings,
    first_below_zero,
    flip_time,
    longest_quiet,
    turning_points,
)
from tippetop.run import simulate
from tippetop.sweeps import Outcome, Product, Sweep, compute

WINDOW = 20.0
"""Length of the report's runs, s (its listing, line 13)."""

ARRIVALS = np.linspace(SETTLED, 0.1, 46)
"""Distances from the last tilt within which a top may have arrived, rad; the report's is the
first.
"""

WINDOWS = np.arange(9.0, WINDOW + 0.5)
"""Lengths of runs that may have given the end of the report's Fig. 5, s: from its arrival on."""

CAPPED_SPINS = (165.0, 175.0, 200.0)
"""Spins of launches for which the commented-out lines of the listing are tried, rad/s."""

SLOW_SPINS = (10.0, 20.0, 25.0)
"""Spins of launches below omega_c1, rad/s."""

SERIES = ("tilt", "tilt_rate", "precession", "spin", "slip_x", "slip_y", "normal_force", "energy")
"""Variables that are compared over time."""

_DRAWN = 10_000
"""Smallest number of points in a series that figures show."""


def on_table(problem: Problem) -> Problem:
    """Return the problem with a table that also pulls, as in the report."""
    return problem.replace({"contact.liftoff": "ignore"})


def stopping(problem: Problem) -> Problem:
    """Return the problem with a run that ends where the table would have to pull."""
    return problem.replace({"contact.liftoff": "stop"})


def unilateral(problem: Problem, restitution: float = 0.0) -> Problem:
    """Return the problem with a table that only pushes: the top flies, falls back and hits it."""
    return problem.replace({"contact.liftoff": "fly", "contact.restitution": restitution})


SWEPT = 1e-12
"""Relative error per step of sweeps, the same as of single runs."""


def swept(problem: Problem, values: Mapping[str, np.ndarray], window: float = WINDOW) -> xr.Dataset:
    """Return the sweep of a problem over the crossed values of fields.

    Results of launches that failed, were inaccurate or could not be set up are nan.
    """
    sweep = compute(Sweep(problem, Product.of(values), window, SWEPT))
    return sweep.where(
        ~sweep["outcome"].isin([Outcome.FAILED, Outcome.INACCURATE, Outcome.INVALID])
    )


def event_times(run: xr.Dataset, kind: str, surface: int | None = None) -> np.ndarray:
    """Return the times of all events of a kind, on one surface or on any, s."""
    which = run["event_kind"].values == kind
    if surface is not None:
        which &= run["event_surface"].values == surface
    times: np.ndarray = run["event_time"].values[which]
    return times


_FLIGHT = {
    "turnover_time": "turning_time",
    "energy_lost_impacts": "energy_in_impacts",
    "final_tilt": "final_tilt_flight",
}
"""Names in experiments of some numbers of a run on a table that only pushes."""


def flight_readings(run: xr.Dataset) -> xr.Dataset:
    """Return numbers of a run on a table that only pushes."""
    readings = run[["flights", "airborne_time", "max_gap", *_FLIGHT]].rename(_FLIGHT)
    last, rise = max(run["flight_end"].values, default=0.0), np.diff(run["energy"].values).max()
    readings["last_touchdown"] = variable(last, "s", "end of the last flight; 0 without one")
    readings["energy_rise"] = variable(
        rise, "J", "largest rise of the energy from sample to sample"
    )
    return readings


def comparison(problem: Problem, quick: bool) -> xr.Dataset:
    """Return one launch by the report's method and converged, with readings of both runs.

    Variables over `time` are converged, for a table that pulls. Variables over `time_listing`,
    named ``..._listing``, are by the report's method, at its points of output. If the table would
    have to pull, variables over `time` named ``..._flight`` are converged for a table that only
    pushes, and there are readings of that run.
    """
    problem = on_table(problem)
    true = simulate(problem, WINDOW, samples=20_001 if quick else 40_001)
    listing = listing_run(problem, WINDOW)
    with np.errstate(all="ignore"):
        published = published_energy([true[name].values for name in VARIABLES], top_of(problem), np)
    true = true.assign(energy_published=("time", np.asarray(published)))
    data = _series(true, listing).assign(_readings(true, "")).assign(_readings(listing, "_listing"))
    stopped = float(simulate(stopping(problem), WINDOW, samples=2)["liftoff_time"])
    data["lift_off_time"] = variable(stopped, "s", "when the table would first have to pull")
    data["arrival_time"] = true["arrival_time"]
    if math.isfinite(stopped):
        data = data.assign(_continuation(problem, data["time"].values))
    data.attrs = {"problem": problem.to_json(), "status": true.attrs["status"]}
    return data


def _series(true: xr.Dataset, listing: xr.Dataset) -> xr.Dataset:
    """Return the variables that are drawn, thinned to the number of points that a figure can
    show.
    """

    def thin(run: xr.Dataset) -> xr.Dataset:
        return run.isel(time=slice(None, None, max(1, math.ceil(run.sizes["time"] / _DRAWN))))

    data = thin(true[[*SERIES, "energy_published"]]).drop_attrs(deep=False)
    thinned = thin(listing)
    published = "energy by the report's equation (4.1)"
    data["energy_published"].attrs = {
        "units": "J",
        "long_name": f"{published}, along the converged motion",
    }
    every = math.ceil(listing.sizes["time"] / thinned.sizes["time"])
    label = "time of the report's method"
    if every > 1:
        label += f", one in {every} of its points of output"
    data["time_listing"] = variable(thinned["time"].values, "s", label, "time_listing")
    labels = {
        "energy": f"{published} and its method",
        "tilt_integrated": "theta before it is wrapped",
    }
    for name in (*SERIES, "tilt_integrated"):
        attrs = data["tilt" if name not in data else name].attrs
        label = labels.get(name, f"{attrs['long_name']}, by the report's method")
        data[f"{name}_listing"] = variable(
            thinned[name].values, attrs["units"], label, "time_listing"
        )
    return data


def _continuation(problem: Problem, times: np.ndarray) -> dict[str, object]:
    """Return the launch on a table that only pushes: its series, its flights and its readings."""
    run = simulate(unilateral(problem), WINDOW, times=times)
    drawn: dict[str, object] = {}
    for name in ("tilt", "normal_force", "energy"):
        label = f"{run[name].attrs['long_name']}, on a table that only pushes"
        drawn[f"{name}_flight"] = variable(
            run[name].values, run[name].attrs["units"], label, "time"
        )
    for name in ("flight_start", "flight_end", "flight_max_gap"):
        drawn[name] = run[name]
    return drawn | {str(name): value for name, value in flight_readings(run).items()}


def _readings(run: xr.Dataset, suffix: str) -> dict[str, object]:
    """Return the readings of a run; see `tippetop.report.readings`."""
    times, theta, turning = run["time"].values, run["tilt"].values, run["precession"].values
    changes = crossings(times, turning)
    quiet = longest_quiet(times, turning)
    slip = np.hypot(run["slip_x"].values, run["slip_y"].values)
    force, energy = run["normal_force"].values, run["energy"].values
    arrivals, seen = (
        [flip_time(times, theta, within) for within in ARRIVALS],
        force + SHOWN * force.max(),
    )
    arrived = "first time at which the tilt is within this of its last value"
    values = {
        "arrivals": variable(arrivals, "s", arrived, "within"),
        "reversals": variable(len(changes), "1", "how often the precession changes sign"),
        "quiet_start": variable(quiet[0], "s", "start of the longest time between two reversals"),
        "quiet_end": variable(quiet[1], "s", "end of the longest time between two reversals"),
        "last_reversal": variable(changes[-1] if len(changes) else np.nan, "s", "last reversal"),
        "end_tilt": variable(theta[-1], "rad", "tilt at the end"),
        "end_precession": variable(turning[-1], "rad s-1", "precession at the end"),
        "end_spin": variable(run["spin"].values[-1], "rad s-1", "axial spin at the end"),
        "end_slip": variable(slip[-1], "m s-1", "slip speed at the end"),
        "largest_slip": variable(slip.max(), "m s-1", "largest slip speed"),
        "least_force": variable(force.min(), "N", "least normal force"),
        "zero_of_force": variable(
            first_below_zero(times, force), "s", "first time with a pulling table"
        ),
        "visible_pull": variable(
            first_below_zero(times, seen), "s", "first pull that a plot shows"
        ),
        "launch_energy": variable(energy[0], "J", "energy at launch"),
        "largest_energy": variable(energy.max(), "J", "largest energy"),
    }
    readings: dict[str, object] = {f"{name}{suffix}": value for name, value in values.items()}
    readings["within"] = variable(ARRIVALS, "rad", "distance from the last tilt", "within")
    return readings


def _launch(name: str, cost: float, title: str, *numbers: float) -> None:
    """Register the comparison of a launch of the report's top.

    `numbers` are the arguments of `report_problem`: a spin, and a tilt and a friction other than
    usual.
    """
    experiment(name, title, cost)(lambda quick: comparison(report_problem(*numbers), quick))


@experiment("run-50-table-1", "launch at 50 rad/s of the body that Table 1 prints", 0.8)
def _table_1(quick: bool) -> xr.Dataset:
    return comparison(report_problem(50.0).replace({"body": REPORT_TABLE_1.model_dump()}), quick)


@experiment("settling-mu-100", "how the nutation of Fig. 8 dies away", 0.8)
def _settling(quick: bool) -> xr.Dataset:
    """Return the swing of the tilt in the second before several times, on the table of Fig. 8."""
    ends = np.array([20.0, 40.0] if quick else [20.0, 40.0, 80.0])
    run = simulate(
        on_table(report_problem(SPIN, mu=ROUGH_FRICTION)),
        float(ends[-1]),
        samples=int(200 * ends[-1]) + 1,
    )
    swings = [float(np.ptp(run["tilt"].sel(time=slice(end - 1.0, end)).values)) for end in ends]
    return dataset(
        {"end": (ends, "s", "end of that second")},
        swing=(swings, "rad", "swing of the tilt in the second before", "end"),
    )


@experiment("run-50-windows", "the end of Fig. 5 against the length of the run", 1.5)
def _windows(quick: bool) -> xr.Dataset:
    windows, problem = WINDOWS[3::4] if quick else WINDOWS, report_problem(50.0)
    ends = [listing_run(problem, float(window)).isel(time=-1) for window in windows]
    true = simulate(on_table(problem), float(windows[-1]), times=windows)
    data = dataset({"window": (windows, "s", "length of the run")})
    for name, units in (("tilt", "rad"), ("precession", "rad s-1"), ("spin", "rad s-1")):
        theirs, label = [float(end[name]) for end in ends], "at the end of a run of this length"
        data[f"{name}_after_listing"] = variable(
            theirs, units, f"{label}, by the report's method", "window"
        )
        data[f"{name}_after"] = variable(true[name].values, units, label, "window")
    return data


def likely_end(windows: xr.Dataset) -> xr.Dataset:
    """Return the run, among those of several lengths, whose end is nearest to the one printed of
    Fig. 5.
    """
    misses = [
        abs(windows[f"{key}_after_listing"].values - value) for key, value in END_OF_FIG_5.items()
    ]
    return windows.isel(window=int(np.argmin(np.max(misses, axis=0))))


@experiment("listing-capped", "the listing with what it has commented out", 2.5)
def _capped(quick: bool) -> xr.Dataset:
    """Return final tilts by the report's method, with and without a cap of the normal force at
    zero.
    """
    spins = CAPPED_SPINS[1:2] if quick else CAPPED_SPINS

    def ends(unilateral: bool) -> list[float]:
        runs = [listing_run(report_problem(spin), WINDOW, unilateral=unilateral) for spin in spins]
        return [float(run["tilt"][-1]) for run in runs]

    return dataset(
        {"spin": list(spins)},
        final_tilt=(ends(unilateral=False), "rad", "tilt at the end", "spin"),
        final_tilt_capped=(ends(unilateral=True), "rad", "the same, g_n >= 0", "spin"),
    )


@experiment("slow-spins", "launches below the first critical spin", 1.5)
def _slow(quick: bool) -> xr.Dataset:
    """Return the largest and the final tilts of launches below omega_c1, by both methods."""
    columns: dict[str, list[float]] = {}
    for spin in SLOW_SPINS:
        problem = report_problem(spin)
        true = simulate(on_table(problem), WINDOW, samples=2_001 if quick else 20_001)
        for suffix, run in (("", true), ("_listing", listing_run(problem, WINDOW))):
            theta = run["tilt"].values
            turns = turning_points(theta)
            swings = int((np.abs(np.diff(theta[[0, *turns]])) > SETTLED).sum())
            for name, value in (("highest", theta.max()), ("final", theta[-1]), ("swings", swings)):
                columns.setdefault(f"{name}{suffix}", []).append(float(value))
    meanings = {
        "highest": ("rad", "largest tilt"),
        "final": ("rad", "tilt at the end"),
        "swings": ("1", f"swings of the tilt by more than {SETTLED:g} rad"),
    }
    return dataset(
        {"spin": list(SLOW_SPINS)},
        **{
            name: (values, *meanings[name.removesuffix("_listing")], "spin")
            for name, values in columns.items()
        },
    )


_launch("run-155", 1.4, f"launch at {SPIN:g} rad/s", SPIN)
_launch("run-50", 0.8, "launch at 50 rad/s", 50.0)
_launch("run-mu-100", 4.0, "launch on an impossible table", SPIN, TILT, ROUGH_FRICTION)
_launch("run-175", 2.0, "launch at 175 rad/s", 175.0)
_launch("run-10", 0.5, "launch at 10 rad/s", 10.0)
_launch("run-90", 1.0, "launch at 90 rad/s", 90.0)
_launch("run-120", 1.1, "launch at 120 rad/s", 120.0)
_launch("run-150-pi-4", 1.2, "launch at 150 rad/s and pi/4", 150.0, math.pi / 4)
