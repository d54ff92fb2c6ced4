"""Claims that are equations: those that hold, and those that are misprinted."""

import math

import numpy as np
import xarray as xr

from tippetop.presets import REPORT
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


_ALPHA = float(REPORT.surface.proportions[0])


def _left_of_217(theta: float, phi_dot: float, omega3: float) -> float:
    """What is left of (2.17), rad/s."""
    return omega3 - phi_dot * (math.cos(theta) - _ALPHA)


def _rounding_of_217(theta: float, phi_dot: float, omega3: float) -> float:
    """How far three numbers that satisfy (2.17) may miss it when each is rounded to three decimals, rad/s."""
    return 0.0005 * (abs(phi_dot * math.sin(theta)) + abs(math.cos(theta) - _ALPHA) + 1.0)


@CHAPTER.claim(
    "eq-2.17",
    Source("3.1", "Fig. 5", "(2.17)"),
    "The end state of Fig. 5 satisfies omega3 = phi' (cos theta - alpha) (the value is the difference).",
    "0 rad/s",
    tolerance=Tolerance(
        _rounding_of_217(**END_OF_FIG_5),
        "what rounding the three quoted numbers to their last digit makes of it",
    ),
    needs=("run-50",),
    figure="fig05",
)
def _(run: xr.Dataset) -> Finding:
    listed, ours = (
        _left_of_217(*(float(run[f"end_{name}{suffix}"]) for name in END_OF_FIG_5))
        for suffix in ("_listing", "")
    )
    return Finding(
        _left_of_217(**END_OF_FIG_5),
        ours,
        "The report's value is that of the three numbers it quotes; almost all of it is the rounding of "
        f"theta and phi'. Its method leaves {listed:+.4f} rad/s after 20 s.",
    )


@CHAPTER.claim(
    "eq-2.17-exception",
    Source("2.3", equation="(2.17)"),
    "In a steady state (2.17) holds if theta is not pi (what is left of it for a top that spins upright, as "
    "a part of omega3).",
    "0",
    tolerance=STEADY,
    needs=("run-10",),
    figure="fig13",
    right="if theta is neither 0 nor pi",
)
def _(run: xr.Dataset) -> Finding:
    late = run.sel(time=slice(15.0, None))
    left = late["omega3"] - late["phi_dot"] * (np.cos(late["theta"]) - _ALPHA)
    return Finding(
        None,
        float((abs(left) / abs(late["omega3"])).max()),
        "theta = 0 is an exception too: the derivation divides by sin(theta). An upright top spins steadily "
        f"at any omega3, and what is left of its nutation turns at {late['phi_dot'].mean():.2f} rad/s where "
        f"(2.17) would have {float(late['omega3'].mean()) / (1.0 - _ALPHA):.2f} rad/s.",
    )


@CHAPTER.claim(
    "eq-2.14-no-nutation",
    Source("2.3", equation="(2.14)"),
    "Without slip (2.14) leads to theta' = 0.",
    needs=("why-groups",),
)
def _(chart: xr.Dataset) -> Finding:
    # The bracket over I3 is alpha + (gamma - 1) cos(theta): it has a zero where |gamma - 1| reaches alpha.
    bracket = chart["top_alpha"] - abs(chart["top_gamma"] - 1.0)
    listed = float(bracket[0])
    return Finding(
        None,
        listed > 0,
        "It leads to omega3 theta' times a bracket being zero, and so leaves out two other ways: omega3 = 0, "
        "and a zero of the bracket, at cos(theta) = alpha / (1 - I1/I3). The latter exists for tops with "
        f"|I1/I3 - 1| of alpha or more only; for the report's top the bracket is "
        f"at least {listed:.2f} I3.",
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
    "The third line of (2.16) makes the rate of an angle phi_3 zero in the steady state.",
    "0 rad/s",
    needs=("steady-bodies",),
    figure="fig05",
    right="omega3' = 0",
)
def _(steady: xr.Dataset) -> Finding:
    precession, spin = steady["phi_dot"], steady["omega3"]
    rotation = spin - precession * np.cos(steady["theta"])
    slowest = min(float(abs(rate).min()) for rate in (precession, rotation))
    return Finding(
        None,
        slowest,
        "No angle of that name is introduced. The precession and the rotation about the axis both go on, in "
        f"the steady states of {steady.sizes['body']} bodies at {slowest:.2f} rad/s and more; what vanishes "
        f"is the rate of omega3 (at most {steady['omega3_rate'].max():.0e} rad/s²).",
    )


@CHAPTER.claim(
    "eq-2.1",
    Source("2.1", equation="(2.1) and (2.2)"),
    "(2.1) and (2.2) are the angular velocity (largest relative difference from rotations themselves).",
    "0",
    tolerance=ROUNDING,
    needs=("rotation",),
    figure="fig02",
)
def _(check: xr.Dataset) -> Finding:
    return _largest_miss(check.sel(equation=["(2.1)", "(2.2)"]), "at random angles and rates")


@CHAPTER.claim(
    "eq-2.6",
    Source("2.1", equation="(2.3) to (2.6)"),
    "(2.3) to (2.6) are the equations of rotation (how far the angular momentum in space gains the torque).",
    "0",
    tolerance=ROUNDING,
    needs=("rotation",),
    figure="fig02",
)
def _(check: xr.Dataset) -> Finding:
    return _largest_miss(check.sel(equation=["(2.6)"]), "for a body with three different moments")


@CHAPTER.claim(
    "eq-2.8",
    Source("2.2", equation="(2.8), (2.10) to (2.15), and a"),
    "a, (2.8) and (2.10) to (2.15) are the equations of motion (largest relative difference from a run by "
    "others).",
    "0",
    tolerance=ROUNDING,
    needs=("printed-equations",),
    figure="fig03",
)
def _(check: xr.Dataset) -> Finding:
    return _largest_miss(
        check, "from a run of Fig. 4's launch by equations without Euler angles, at five instants"
    )


def _largest_miss(check: xr.Dataset, words: str) -> Finding:
    miss = check["miss"]
    listed = ", ".join(
        f"{name} {value:.0e}" for name, value in zip(miss["equation"].values, miss, strict=True)
    )
    return Finding(None, float(miss.max()), f"Differences {words}: {listed}.")


@CHAPTER.claim(
    "eq-2.7",
    Source("2.2", equation="(2.7)"),
    "The torque is M = F x a with F = (g_n - mg) z + f (the value is its second component at 5 s of the run "
    "of Fig. 4).",
    unit="N m",
    tolerance=Tolerance(1e-9, "far below the torque, far above rounding"),
    needs=("printed-equations",),
    figure="fig03",
    right="M = a x (g_n z + f)",
)
def _(check: xr.Dataset) -> Finding:
    return Finding(
        float(check["torque_listing"]),
        float(check["torque"]),
        f"Turned round, a x F has {check['torque_turned']:.4e} N m: wrong still, because F counts the "
        "weight, which acts at the centre of mass and has no torque about it. Without the weight it is "
        f"{check['torque_corrected']:.4e} N m, as (2.8) and the run have it. In the printed order the "
        f"contact force would do work at {1e3 * float(check['power_printed']):+.2f} mW where friction takes "
        f"{1e3 * float(check['power']):+.2f} mW.",
        reported=float(check["torque_printed"]),
    )


@CHAPTER.claim(
    "eq-2.9",
    Source("2.2", equation="(2.9)"),
    "The rate of phi' is (2.9) as printed (its value at 5 s of the run of Fig. 4).",
    unit="rad/s²",
    tolerance=Tolerance(1e-3, "the accuracy of the derivative taken of the run"),
    needs=("printed-equations",),
    right="phi'' = (I3 theta' omega3 - 2 I1 theta' phi' cos theta - mu g_n v_y R (alpha - "
    "cos theta)) / (I1 sin theta)",
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
    right="add m (v_A . w + v_A^2 / 2), with w the velocity that the centre of mass has without slip",
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
