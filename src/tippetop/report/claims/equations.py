"""Claims that are equations: those that hold, and those that are misprinted."""

import math

import numpy as np
import xarray as xr

from tippetop.problem import Problem
from tippetop.report.claim import ROUNDING, STEADY, Chapter, Finding, Source, Tolerance
from tippetop.report.quoted import END_OF_FIG_5

CHAPTER = Chapter()


@CHAPTER.claim(
    "eq-2.16",
    Source("2.3", equation="(2.16)"),
    "In the steady state the first and fourth lines of (2.16) vanish (what is left, as a part of their "
    "terms).",
    "0",
    tolerance=STEADY,
    needs=("steady-bodies",),
    figure="fig05",
)
def _(steady: xr.Dataset) -> Finding:
    left = steady["residual_216"].values
    return Finding(
        None,
        float(left.max()),
        f"The largest of {len(left)} bodies after {steady.attrs['duration_s']:g} s; "
        f"{left[0]:.1e} for the report's.",
    )


@CHAPTER.claim(
    "eq-2.17",
    Source("3.1", "Fig. 5", "(2.17)"),
    "The end state of Fig. 5 satisfies omega3 = phi' (cos theta - alpha) (the value is the difference).",
    "0.000 rad/s",
    tolerance=Tolerance(0.0005, "half a unit of the last digit of the omega quoted there"),
    needs=("run-50",),
    figure="fig05",
)
def _(run: xr.Dataset) -> Finding:

    eccentricity = Problem.from_json(run.attrs["problem"]).body.shape.law.proportions[0]

    def left(theta: float, turning: float, spin: float) -> float:
        return spin - turning * (math.cos(theta) - float(eccentricity))

    def end(suffix: str) -> list[float]:
        return [float(run[f"end_{name}{suffix}"]) for name in END_OF_FIG_5]

    quoted = left(*END_OF_FIG_5.values())
    return Finding(
        left(*end("_listing")),
        left(*end("")),
        f"The three numbers that the report quotes are off by {quoted:+.3f} rad/s.",
    )


@CHAPTER.claim(
    "eq-2.17-any-body",
    Source("2.3", equation="(2.17)"),
    "(2.17) holds whatever the mass and the moments of inertia (largest relative difference).",
    "0",
    tolerance=STEADY,
    needs=("steady-bodies",),
)
def _(steady: xr.Dataset) -> Finding:
    left = abs(steady["residual_217"]) / abs(steady["phi_dot"])
    listed = ", ".join(
        f"{name!s} {value:.0e}" for name, value in zip(steady["body"].values, left, strict=True)
    )
    return Finding(None, float(left.max()), f"Differences over phi': {listed}.")


@CHAPTER.claim(
    "eq-2.16-third",
    Source("2.3", equation="(2.16)"),
    "The third line of (2.16) makes the rate of phi_3 zero (the value is the steady precession).",
    "0 rad/s",
    needs=("run-50",),
    figure="fig05",
)
def _(run: xr.Dataset) -> Finding:
    late = run.sel(time=slice(15.0, None))
    rate = float(np.ptp(late["omega3"].values) / (late["time"][-1] - late["time"][0]))
    return Finding(
        float(run["end_phi_dot_listing"]),
        float(run["end_phi_dot"]),
        "There is no angle phi_3; what vanishes is the rate of omega3 "
        f"(at most {rate:.1e} rad/s² on average over the last 5 s of Fig. 5), while the precession goes on.",
    )


@CHAPTER.claim(
    "eq-2.7",
    Source("2.2", equation="(2.7)"),
    "The torque of the contact force is M = F x a (the value is its axial part at 5 s of the run of Fig. 4).",
    unit="N m",
    tolerance=Tolerance(1e-9, "far below the torque, far above rounding"),
    needs=("printed-equations",),
)
def _(check: xr.Dataset) -> Finding:
    return Finding(
        float(check["torque_listing"]),
        float(check["torque"]),
        f"It is a x F: {check['torque_corrected']:.4e} N m, as (2.10) and the run have it. With F x a "
        f"the contact force would do work at {1e3 * float(check['power_printed']):+.2f} mW where friction "
        f"takes {1e3 * float(check['power']):+.2f} mW.",
        reported=float(check["torque_printed"]),
    )


@CHAPTER.claim(
    "eq-2.9",
    Source("2.2", equation="(2.9)"),
    "The rate of phi' is (2.9) as printed (its value at 5 s of the run of Fig. 4).",
    unit="rad/s²",
    tolerance=Tolerance(1e-3, "the accuracy of the derivative taken of the run"),
    needs=("printed-equations",),
)
def _(check: xr.Dataset) -> Finding:
    return Finding(
        float(check["precession_listing"]),
        float(check["precession"]),
        "An I1 stands too much in the numerator. Read as I1 over the bracket it gives "
        f"{check['precession_printed']:.4g}, read as a factor "
        f"{check['precession_printed_product']:.4g} (in wrong units either way); the listing has the "
        "right equation.",
        reported=float(check["precession_printed"]),
    )


@CHAPTER.claim(
    "eq-4.1",
    Source("4", equation="(4.1)"),
    "(4.1) is the energy (the value is the largest difference in the run of Fig. 4 from the energy at "
    "launch, as a part of it).",
    "0",
    tolerance=ROUNDING,
    needs=("run-155",),
    figure="fig04",
)
def _(run: xr.Dataset) -> Finding:
    launch = float(run["launch_energy"])
    difference = run["energy_published"] - run["energy"]
    k = int(np.argmax(np.abs(difference.values)))
    share = float(difference[k]) / launch
    return Finding(
        None,
        abs(share),
        "(4.1) leaves out what slip adds to the velocity of the centre of mass. At "
        f"{run['time'][k]:.2f} s it is {1e3 * float(difference[k]):+.3f} mJ off, {100 * share:+.1f} % "
        "of the energy at launch.",
    )
