"""Claims about the steady state: section 2.3, and the end of Fig. 5."""

import math

import numpy as np
import xarray as xr

from tippetop.problem.presets import REPORT
from tippetop.report.claim import Finding, examines, listed
from tippetop.report.experiments.equations import residual_of_217
from tippetop.report.printed_numbers import END_OF_FIG_5
from tippetop.report.tolerance import STEADY, TRANSCRIBED, Tolerance, rounded


@examines("sec2-no-slip", "steady-bodies", "run-155", "run-50", tolerance=STEADY)
def _(steady: xr.Dataset, *runs: xr.Dataset) -> Finding:
    slip = np.maximum(steady["slip"], steady["slip_rate"])
    theirs = max(float(run["end_slip_listing"] / run["largest_slip_listing"]) for run in runs)
    return Finding.unlisted(
        float(slip.max()),
        f"After {steady.attrs['duration_s']:g} s, for {steady.sizes['body']} bodies. After the 20 s"
        f" of Figs. 4 and 5 the slip by the report's method is at most {theirs:.0e} of its largest"
        " value. The report's reason, that friction would otherwise slow the top down, is right:"
        " friction takes energy as long as there is slip.",
    )


@examines("eq-2.16", "steady-bodies", tolerance=STEADY)
def _(steady: xr.Dataset) -> Finding:
    residual = np.maximum(steady["residual_216"].values, steady["azimuth_ddot"].values)
    return Finding.unlisted(
        float(residual.max()),
        f"The largest of {len(residual)} bodies after {steady.attrs['duration_s']:g} s;"
        f" {residual[0]:.1e} for the report's. The second line, phi'' = 0, is relative to phi'^2.",
    )


_ALPHA = float(REPORT.surface.proportions[0])


def _rounding_of_217(tilt: float, precession: float, spin: float) -> float:
    """Return the residual (rad/s) of (2.17) that rounding its three numbers to three decimals can
    cause.
    """
    return 0.0005 * (abs(precession * math.sin(tilt)) + abs(math.cos(tilt) - _ALPHA) + 1.0)


@examines(
    "eq-2.17",
    "run-50",
    tolerance=Tolerance(
        _rounding_of_217(**END_OF_FIG_5),
        "what rounding the three quoted numbers to their last digit makes of it",
    ),
)
def _(run: xr.Dataset) -> Finding:
    by_method, ours = (
        float(
            residual_of_217(
                **{name: run[f"end_{name}{suffix}"] for name in END_OF_FIG_5}, alpha=_ALPHA
            )
        )
        for suffix in ("_listing", "")
    )
    quoted = float(residual_of_217(**END_OF_FIG_5, alpha=_ALPHA))
    return Finding(
        by_method,
        ours,
        f"The three numbers that the report quotes give {quoted:+.4f} rad/s, almost all of it from"
        " the rounding of theta and phi'. The other values are after 20 s.",
        reported=quoted,
    )


@examines("eq-2.17-range", tolerance=STEADY)
def _(states: xr.Dataset) -> Finding:
    low, high = (float(limit) for limit in states["limits"])
    inside = states.isel(run=((states["run_spin"] > low) & (states["run_spin"] < high)).values)
    residual = inside["run_left"]
    shown = ", ".join(f"{spin:g}" for spin in inside["run_spin"].values)
    return Finding.unlisted(
        float(residual.max()),
        f"In runs of {states.attrs['long_run_s']:g} s launched at {shown} rad/s, which end at tilts"
        f" from {inside['run_end'].min():.2f} to {inside['run_end'].max():.2f} rad.",
    )


@examines("eq-2.17-exception", "run-10", tolerance=STEADY)
def _(run: xr.Dataset) -> Finding:
    late = run.sel(time=slice(15.0, None))
    residual = residual_of_217(late["tilt"], late["precession"], late["spin"], _ALPHA)
    return Finding.unlisted(
        float((abs(residual) / abs(late["spin"])).max()),
        "Judged, like (2.14), over all the states in which the report's top can end. theta = 0 is"
        " one of them and another exception: the derivation divides by sin(theta). An upright top"
        " spins steadily at any omega3, and its remaining nutation turns at"
        f" {late['precession'].mean():.2f} rad/s, where (2.17) would give"
        f" {float(late['spin'].mean()) / (1.0 - _ALPHA):.2f} rad/s.",
    )


@examines("eq-2.14-no-nutation", "why-groups", "steady-bodies")
def _(chart: xr.Dataset, steady: xr.Dataset) -> Finding:
    # The bracket over I3 is alpha + (gamma - 1) cos(theta): it has a zero where |gamma - 1| reaches
    # alpha.
    bracket = chart["top_alpha"] - abs(chart["top_gamma"] - 1.0)
    least, tilting = float(bracket[0]), float(steady["tilt_rate"].max())
    return Finding.unlisted(
        least > 0 and tilting < STEADY.value,
        "Judged, like (2.17), over all the states in which the report's top can end: in them the"
        f" bracket is at least {least:.2f} I3, and theta' is at most {rounded(tilting)} phi'. In"
        " general (2.14) has two other solutions: omega3 = 0, and a zero of the bracket, at"
        " cos(theta) = alpha / (1 - I1/I3), for tops with |I1/I3 - 1| of alpha or more.",
    )


@examines("eq-2.17-any-body", "steady-bodies", tolerance=STEADY)
def _(steady: xr.Dataset) -> Finding:
    residual = abs(steady["residual_217"]) / abs(steady["precession"])
    each = listed("{} {}", steady["body"].values, map(rounded, residual.values))
    return Finding.unlisted(float(residual.max()), f"Differences over phi': {each}.")


@examines("eq-2.16-third", "steady-bodies", tolerance=STEADY)
def _(steady: xr.Dataset) -> Finding:
    precession, spin = steady["precession"], steady["spin"]
    rotation = spin - precession * np.cos(steady["tilt"])
    slowest = min(float(abs(rate).min()) for rate in (precession, rotation))
    return Finding.unlisted(
        slowest,
        f"A misprint for omega3' = 0, which holds: in the steady states of {steady.sizes['body']}"
        f" bodies it is at most {steady['spin_rate'].max():.0e} rad/s². The report introduces no"
        " angle phi_3, and as printed the equation would be wrong for either angle: the precession"
        f" and the rotation about the axis both go on, at {slowest:.2f} rad/s or faster."
        f" {TRANSCRIBED}",
    )
