"""Claims about single launches that leave the table: Figs. 9 to 12 and 16."""

import numpy as np
import xarray as xr

from tippetop.mechanics.euler import published_parameters
from tippetop.problem.presets import REPORT
from tippetop.problem.problem import Problem, top_of
from tippetop.report.claim import Finding, examines
from tippetop.report.printed_numbers import ENERGY, ENERGY_TIME, STOP
from tippetop.report.readings import turning_points
from tippetop.report.tolerance import PLOTTED, rounded


@examines("fig11-negative", "run-175")
def _(run: xr.Dataset) -> Finding:
    return Finding(
        float(run["least_force_listing"]) < 0,
        float(run["least_force"]) < 0,
        f"First at {run['lift_off_time']:.4f} s. On a table that pulls, the force reaches"
        f" {run['least_force']:.2f} N within 20 s, {run['least_force_listing']:.2f} N by the"
        " report's method. A table that only pushes lets go there: its force is never less than"
        " zero.",
    )


@examines("fig10-gain", "run-175")
def _(run: xr.Dataset) -> Finding:
    theirs, ours = _gains(run, "_listing"), _gains(run, "")
    weight = _weight(run)
    later = run["energy_flight"].sel(time=slice(float(ENERGY_TIME), None)).values
    gained = float(later.max() - later[0])
    return Finding(
        theirs["the launch"],
        gained,
        "The report does not state from which time the gain counts. By its method and (4.1) the"
        " energy gains "
        + _listed(theirs, weight)
        + "; the full energy of the converged motion, on a table that pulls as well, gains "
        + _listed(ours, weight)
        + f". On a table that only pushes it gains {rounded(gained)} J after {_NAMED}, and"
        " falls by "
        f"{1e3 * float(later[0] - later[-1]):.1f} mJ instead.",
        theirs[_NAMED],
        f"the gain is counted from {_NAMED}, the time that the report names",
        right=(
            f"{'nothing' if gained <= ROUNDED * later[0] else f'{gained:.4f} J'}; on a table that"
            f" pulls, as in the report, {ours[_NAMED]:.4f} J"
        ),
    )


_NAMED = f"{ENERGY_TIME} s"
"""Time at which the report states the energy."""


def _gains(run: xr.Dataset, suffix: str) -> dict[str, float]:
    """Return the gains of energy up to its largest value, J.

    They are counted from the launch, from the time that the report names, and from the least energy
    before the largest.
    """
    energy, times = run[f"energy{suffix}"].values, run[f"time{suffix}"].values
    top = int(np.argmax(energy))
    since = {
        "the launch": energy[0],
        _NAMED: np.interp(float(ENERGY_TIME), times, energy),
        "the trough before": energy[:top].min(),
    }
    return {name: float(energy[top] - start) for name, start in since.items()}


def _listed(gains: dict[str, float], weight: float) -> str:
    return ", ".join(
        f"{1e3 * gain:.1f} mJ ({gain / weight:.1f} R) from {name}" for name, gain in gains.items()
    )


def _weight(run: xr.Dataset) -> float:
    """Return the work of the weight in a fall by one radius, J."""
    problem = Problem.from_json(run.attrs["problem"])
    return float(problem.body.mass * problem.gravity * float(problem.body.surface.size))


@examines("fig10-fall", "run-175")
def _(run: xr.Dataset) -> Finding:
    fall = float(ENERGY) / _weight(run)
    return Finding.unlisted(
        fall,
        "The arithmetic is right. What it is meant to show, that a fall could increase the energy,"
        " is another claim (fig10-by-falling).",
    )


@examines("fig10-by-falling", "run-175")
def _(run: xr.Dataset) -> Finding:
    change, height = _change_in_flight(run)
    work = _weight(run) / float(REPORT.surface.size) * height
    none = change < 1e-6 * work  # far above rounding, far below any part of it
    return Finding.unlisted(
        not none,
        "The report argues that the top cannot gain the energy, because it would have to fall so"
        " far. But (4.1) includes the potential energy, m g R (1 - alpha cos theta): a fall turns"
        " it into kinetic energy. In its flights the top falls by up to"
        f" {1e3 * height:.2f} mm, by which its weight does {1e6 * work:.0f} µJ of work, and its"
        f" energy changes by {rounded(change)} J. The report's conclusion, that a growing energy is"
        " not physical, is right for a simpler reason: neither the weight nor a table that only"
        " pushes nor friction increases it.",
        right=(
            "a fall of any height changes the energy by"
            f" {'nothing' if none else f'{change:.1e} J'}: (4.1) includes the potential energy"
        ),
    )


def _change_in_flight(run: xr.Dataset) -> tuple[float, float]:
    """Return the largest change of the energy within a flight, J, and the greatest height of a
    flight, m.
    """
    spans = zip(run["flight_start"].values, run["flight_end"].values, strict=True)
    inside = [run["energy_flight"].sel(time=slice(start, end)).values for start, end in spans]
    return max(float(np.ptp(part)) for part in inside if len(part) > 1), float(run["max_gap"])


@examines("fig10-impossible", "run-175")
def _(run: xr.Dataset) -> Finding:
    energy, launch = run["energy"], float(run["launch_energy"])
    largest_rise = float(
        np.diff(energy.sel(time=slice(None, float(run["lift_off_time"]))).values).max()
    )
    after = run["normal_force"].sel(time=slice(float(run["lift_off_time"]), None))
    rising = np.diff(energy.sel(time=after["time"]).values) > ROUNDED * launch
    pulled = (after.values[1:] < 0) | (after.values[:-1] < 0)
    only = "only there" if not (rising & ~pulled).any() else "not only there"
    return Finding.unlisted(
        largest_rise <= ROUNDED * launch and not (rising & ~pulled).any(),
        "Up to lift-off the energy never rises (largest change from sample to sample"
        f" {largest_rise:.1e} J). Later the force is negative at"
        f" {100 * float((after < 0).mean()):.0f} % of the samples, and {only} does the energy rise:"
        " friction -mu g_n v then pushes along the slip instead of against it. On a table that"
        f" only pushes it falls to {run['energy_flight'][-1]:.4f} J. Formula (4.1) swings with"
        " every nutation, before lift-off too, because it leaves out slip. Gravity is no"
        " exception: the energy includes its potential (fig10-by-falling).",
    )


ROUNDED = 1e-12
"""Largest rise of the energy, relative to that at launch, that is rounding: the tolerance of
runs.
"""


@examines("fig12-stop-time", "run-175")
def _(run: xr.Dataset) -> Finding:
    stop, theirs, ours = (
        float(STOP),
        float(run["zero_of_force_listing"]),
        float(run["lift_off_time"]),
    )
    visible = float(run["visible_pull_listing"])
    return Finding(
        stop < theirs,
        stop < ours,
        f"Converged, the force falls through zero at {ours:.3f} s, {stop - ours:.2f} s before the"
        " stop, and there the top leaves the table. By the report's method it does so at"
        f" {theirs:.3f} s, where a plot does not show it yet: the pull passes 1 % of the largest"
        f" force only at {visible:.3f} s. Nor is there a need to stop: after {run['flights']:.0f}"
        f" flights the top slides again, from {run['last_touchdown']:.2f} s on.",
    )


@examines("fig09-two-motions", "run-175")
def _(run: xr.Dataset) -> Finding:
    theirs, ours = (_swing_by_second(run, suffix) for suffix in ("_listing", ""))
    visible = PLOTTED.value * np.pi
    return Finding(
        bool(theirs.min() < visible < theirs.max()),
        bool(ours.min() < visible < ours.max()),
        "Both words are qualitative; a motion counts as smooth while a plot does not show its"
        f" swings. In the first second the median swing of the tilt is {ours[0]:.3f} rad, less than"
        f" the {visible:.2f} rad that a plot from 0 to pi shows; in second"
        f" {np.argmax(ours) + 1:.0f} it is {ours.max():.2f} rad.",
    )


def _swing_by_second(run: xr.Dataset, suffix: str) -> np.ndarray:
    """Return the median swing of the tilt between turning points, rad, in every second of a run."""
    theta, times = run[f"tilt{suffix}"].values, run[f"time{suffix}"].values
    turns = turning_points(theta)
    second, size = times[turns][1:].astype(int), np.abs(np.diff(theta[turns]))
    return np.array([np.median(size[second == k]) for k in np.unique(second)])


@examines("sec2-large-spin", "run-175")
def _(run: xr.Dataset) -> Finding:
    theirs, ours = (_numerator(run, suffix) for suffix in ("_listing", ""))
    return Finding(
        bool(min(theirs) == theirs[2] < 0),
        bool(min(ours) == ours[2] < 0),
        "Where the force is first negative at 175 rad/s, the terms of the numerator, in parts of"
        f" the first (the weight), are 1, {ours[1] / ours[0]:.2f} (the turning axis) and"
        f" {ours[2] / ours[0]:.2f} (the spin). The third alone is negative there.",
    )


def _numerator(run: xr.Dataset, suffix: str) -> tuple[float, float, float]:
    """Return the three terms of the numerator of (2.15) where the force is first negative, N kg
    m2.
    """
    k = int(np.argmax(run[f"normal_force{suffix}"].values < 0))
    theta, theta_dot, phi_dot, omega3 = (
        float(run[f"{name}{suffix}"][k]) for name in ("tilt", "tilt_rate", "precession", "spin")
    )
    m, I1, I3, R, alpha, _, g = published_parameters(
        top_of(Problem.from_json(run.attrs["problem"]))
    )
    s, c = np.sin(theta), np.cos(theta)
    turning = I1 * c * (phi_dot**2 * s**2 + theta_dot**2)
    return m * g * I1, m * R * alpha * turning, -m * R * alpha * I3 * phi_dot * omega3 * s**2


@examines("fig16-stays", "run-150-pi-4")
def _(run: xr.Dataset) -> Finding:
    return Finding(
        not float(run["least_force_listing"]) < 0,
        not np.isfinite(float(run["lift_off_time"])),
        f"It leaves the table at {run['lift_off_time']:.3f} s; on a table that pulls the force"
        f" falls to {run['least_force']:.3f} N. The report's method also finds a pull, from"
        f" {run['zero_of_force_listing']:.2f} s on. {_hopping(run)}",
    )


@examines("sec4-may-fly", "run-175")
def _(run: xr.Dataset) -> Finding:
    return Finding.unlisted(
        float(run["max_gap"]) > PLOTTED.value * float(REPORT.surface.size),
        f"It leaves the table first after {run['lift_off_time']:.2f} s, and rises higher than the 1"
        f" % of its radius that a drawing could show. {_hopping(run)} The report calls the motion"
        " hard to discuss; it can be computed.",
    )


def _hopping(run: xr.Dataset) -> str:
    """Return a sentence on the flights of a launch on a table that only pushes."""
    return (
        f"When the table only pushes, the top makes {int(run['flights'])} flights, the highest of"
        f" {1e3 * float(run['max_gap']):.2f} mm, with {run['airborne_time']:.2f} s in the air"
        f" until the last touchdown at {run['last_touchdown']:.2f} s; its axis passes the"
        f" horizontal at {run['turning_time']:.1f} s, and it ends at"
        f" {run['final_tilt_flight']:.3f} rad."
    )
