"""Claims that are equations: those that hold, and those that are misprinted."""

import numpy as np
import xarray as xr

from tippetop.report.claim import Chapter, Finding, Source, both, listed
from tippetop.report.tolerance import ROUNDING, TRANSCRIBED, Tolerance, rounded

CHAPTER = Chapter()


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
    Source("2.2", equation="(2.8), (2.10) to (2.15), a, and the constraint"),
    "a, the constraint (s + a).z = 0, (2.8) and (2.10) to (2.15) are the equations of motion (largest "
    "relative difference from a run by others).",
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
    each = listed("{} {}", miss["equation"].values, map(rounded, miss.values))
    return Finding.unlisted(float(miss.max()), f"Differences {words}: {each}.")


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
        *both(check, "torque"),
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
        *both(check, "precession"),
        "An I1 stands too much in the numerator. Read as I1 over the bracket it gives "
        f"{check['precession_printed']:.4g}, read as a factor "
        f"{check['precession_printed_product']:.4g} (in wrong units either way); the listing has the "
        f"right equation. {TRANSCRIBED}",
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
    return Finding.unlisted(
        abs(share),
        "(4.1) leaves out what slip adds to the velocity of the centre of mass. At "
        f"{run['time'][k]:.2f} s it is {1e3 * float(difference[k]):+.3f} mJ off, {100 * share:+.1f} % "
        "of the energy at launch.",
    )
