"""Steady states of the report's top and of others, computed without a simulation, and runs."""

import math
from dataclasses import astuple

import numpy as np
import xarray as xr

from tippetop.integrators.base import Array
from tippetop.problem.bodies import Body
from tippetop.problem.presets import LEINE_GLOCKER, REPORT, REPORT_TABLE_1, report_problem
from tippetop.problem.problem import Problem, top_of
from tippetop.report.experiment import dataset, experiment
from tippetop.report.experiments.equations import residual_of_217
from tippetop.report.experiments.runs import WINDOW
from tippetop.report.readings import SETTLED
from tippetop.run import simulate
from tippetop.theory import groups
from tippetop.theory.apparent import (
    apparent_critical_spins,
    critical_spin_from_spectrum,
    growth_rates_of_launches,
)
from tippetop.theory.prediction import predict
from tippetop.theory.stability import eigenvalues
from tippetop.theory.steady import VERTICAL_SPINS, precession_branch
from tippetop.theory.thresholds import critical_spin, critical_spins, jellett_line

QUOTED_SPINS = (50.0, 60.0, 100.0)
"""Spins at which a claim's text compares the predicted final tilt with a run, rad/s."""

JUMP_RATIO = 0.75
"""I1 / I3 of a top that jumps, otherwise like the report's: with alpha = 0.3 it is in group IIb."""

LONG_RUN = 400.0
"""Length of the runs whose ends are compared with steady states, s."""


@experiment("why-critical", "critical spins without a simulation", 1.0)
def _critical(quick: bool) -> xr.Dataset:
    """Return the critical spins by formula and by the spectrum, and those that short runs show."""
    problem = report_problem()
    top = top_of(problem)
    spins = np.linspace(10.0, 105.0, 39 if quick else 191)
    visible = np.array([0.001, 0.002, 0.005, SETTLED])
    launches = critical_spins(problem)
    seen = [apparent_critical_spins(problem, WINDOW, float(least)) for least in visible]
    formula = [critical_spin(kind, top) for kind in VERTICAL_SPINS]
    spectrum = [critical_spin_from_spectrum(kind, top) for kind in VERTICAL_SPINS]
    rates = [growth_rates_of_launches(kind, problem, spins) for kind in VERTICAL_SPINS]
    each, zero = "vertical", "critical axial spin, where the growth rate vanishes"
    apparent = "critical spin of the {} spin as the window shows it"
    return dataset(
        {
            "vertical": [kind.value for kind in VERTICAL_SPINS],
            "growth_spin": (spins, "rad s-1", "spin at launch"),
            "visible": (visible, "rad", "least tilt told from none"),
        },
        {"apparent_window_s": WINDOW},
        critical_launch=(list(astuple(launches)), "rad s-1", "critical spin at launch", each),
        critical_formula=(formula, "rad s-1", "critical axial spin, by formula", each),
        critical_spectrum=(spectrum, "rad s-1", zero, each),
        growth_rate=(rates, "s-1", "growth rate of the vertical spin", each, "growth_spin"),
        apparent_upright=(
            [one.upright for one in seen],
            "rad s-1",
            apparent.format("upright"),
            "visible",
        ),
        apparent_inverted=(
            [one.inverted for one in seen],
            "rad s-1",
            apparent.format("inverted"),
            "visible",
        ),
    )


@experiment("why-bifurcation", "steady states against spin, and long runs", 5.0)
def _bifurcation(quick: bool) -> xr.Dataset:
    """Return steady states against spin with their stability, and the ends of long runs, of two
    bodies.
    """
    jumping = REPORT.model_copy(update={"I1": JUMP_RATIO * REPORT.I3})
    gradual = [10.0, 24.0, 35.0, *QUOTED_SPINS]
    if not quick:
        gradual = sorted([*gradual, 17.0, 31.0, 42.0, 70.0, 74.0, 110.0, 120.0])
    sudden = [20.0, 50.0, 110.0] if quick else [10.0, 30.0, 42.0, 49.0, 56.0, 70.0, 105.0]
    tilts = np.linspace(0.0, math.pi, 181 if quick else 721)
    parts = [
        _diagram("", REPORT, tilts, [(spin, 0.1) for spin in gradual]),
        _diagram(
            "_jump",
            jumping,
            tilts,
            [(spin, tilt) for spin in sudden for tilt in (0.1, math.pi - 0.1)],
        ),
    ]
    merged = xr.merge(parts, compat="no_conflicts", join="exact", combine_attrs="drop_conflicts")
    merged.attrs = {"long_run_s": LONG_RUN, "inertia_ratio_jump": JUMP_RATIO}
    return merged


_OF_RUNS = {
    "spin": ("rad s-1", "spin near theta = 0 of the same lambda"),
    "tilt": ("rad", "tilt at launch"),
    "end": ("rad", "tilt at the end of a long run"),
    "left": ("1", "what is left there of the report's (2.17), over the precession"),
    "predicted": ("rad", "reachable stable steady tilt of least energy"),
    "stable": ("1", "number of stable steady states"),
}


def _diagram(
    suffix: str, body: Body, tilts: Array, launches: list[tuple[float, float]]
) -> xr.Dataset:
    """Return steady states of a body against the spin of a launch near theta = 0, and ends of runs.

    A launch is a spin (rad/s) and a tilt (rad): its Jellett's integral is that of a launch near
    theta = 0 with this spin.
    """
    base = report_problem().replace({"body": body.model_dump()})
    branch = precession_branch(top_of(base), tilts)
    rates = np.max(eigenvalues(branch, top_of(base)).real, axis=1)
    spins = branch.jellett / jellett_line(base).per_spin
    problems = [_launched(base, spin, tilt) for spin, tilt in launches]
    runs = [simulate(problem, LONG_RUN, samples=2).isel(time=-1) for problem in problems]
    ends = [float(run["tilt"]) for run in runs]
    predicted = [predict(problem) for problem in problems]
    of_runs = {
        "spin": [spin for spin, _ in launches],
        "tilt": [tilt for _, tilt in launches],
        "end": ends,
        "left": [_relative_residual_217(run, base) for run in runs],
        "predicted": [one.final.tilt for one in predicted],
        "stable": [len(one.stable) for one in predicted],
    }
    limits = list(astuple(critical_spins(base)))
    run, over = f"run{suffix}", f"branch_tilt{suffix}"
    return dataset(
        {
            over: (branch.tilt, "rad", "tilt of the steady precession"),
            "vertical": [kind.value for kind in VERTICAL_SPINS],
        },
        **{
            f"branch_spin{suffix}": (spins, "rad s-1", "spin of launches that can end there", over),
            f"branch_growth{suffix}": (rates, "s-1", "growth rate of the steady precession", over),
            **{
                f"run_{name}{suffix}": (values, *_OF_RUNS[name], run)
                for name, values in of_runs.items()
            },
            f"limits{suffix}": (limits, "rad s-1", "critical spins at launch", "vertical"),
        },
    )


def _relative_residual_217(end: xr.Dataset, problem: Problem) -> float:
    """Return the residual of (2.17) at the end of a run over phi'."""
    residual = residual_of_217(
        end["tilt"], end["precession"], end["spin"], groups.eccentricity(top_of(problem))
    )
    return float(abs(residual / end["precession"]))


def _launched(base: Problem, spin: float, tilt: float) -> Problem:
    """Return the launch at a tilt whose Jellett's integral is that of this spin at the usual
    tilt.
    """
    tilted = base.replace({"launch.tilt": tilt})
    return tilted.replace(
        {"launch.spin": spin * jellett_line(base).per_spin / jellett_line(tilted).per_spin}
    )


@experiment("why-groups", "which tops turn over", 0.3)
def _groups(quick: bool) -> xr.Dataset:
    """Return the map of the groups over gamma and alpha, and some tops on it."""
    alpha = np.linspace(1e-3, 0.6, 121 if quick else 601)
    bodies = {"report, listing": REPORT, "report, Table 1": REPORT_TABLE_1}
    bodies["Leine and Glocker 2003"] = LEINE_GLOCKER
    tops = [
        top_of(report_problem().replace({"body": body.model_dump()})) for body in bodies.values()
    ]
    lines = {
        "upright_boundary": [groups.upright_boundary(a) for a in alpha],
        "inverted_boundary": [groups.inverted_boundary(a) for a in alpha],
        "jump_boundary": [groups.jump_boundary(a) for a in alpha],
        "equal_thresholds": [groups.equal_thresholds(a) for a in alpha],
        "no_precession_from": [groups.precession_boundaries(a)[0] for a in alpha],
        "no_precession_to": [groups.precession_boundaries(a)[1] for a in alpha],
    }
    gamma = np.linspace(0.5, 1.6, 111 if quick else 441)
    letters = sorted(
        {groups.classify(float(g), float(a)).value for g in gamma[::10] for a in alpha[::10]}
    )
    names = {name: name.replace("_", " ") for name in lines}
    return dataset(
        {"alpha": (alpha, "1", "eccentricity"), "top": list(bodies)},
        {
            "groups": ", ".join(letters),
            "gamma_least": float(gamma[0]),
            "gamma_greatest": float(gamma[-1]),
        },
        **{name: (lines[name], "1", f"gamma at the {names[name]}", "alpha") for name in lines},
        top_gamma=([groups.inertia_ratio(top) for top in tops], "1", "I1 / I3", "top"),
        top_alpha=([groups.eccentricity(top) for top in tops], "1", "eccentricity", "top"),
        top_group=([groups.classify_top(top).value for top in tops], None, "group", "top"),
    )
