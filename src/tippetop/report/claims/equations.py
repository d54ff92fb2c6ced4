"""Claims that are equations: those that hold, and those that are misprinted."""

import numpy as np
import xarray as xr

from tippetop.report.claim import Finding, both, examines, listed
from tippetop.report.tolerance import ROUNDING, TRANSCRIBED, Tolerance, rounded


@examines("eq-2.1", "rotation", tolerance=ROUNDING)
def _(check: xr.Dataset) -> Finding:
    return _largest_miss(check.sel(equation=["(2.1)", "(2.2)"]), "at random angles and rates")


@examines("eq-2.6", "rotation", tolerance=ROUNDING)
def _(check: xr.Dataset) -> Finding:
    return _largest_miss(check.sel(equation=["(2.6)"]), "for a body with three different moments")


@examines("eq-2.8", "printed-equations", tolerance=ROUNDING)
def _(check: xr.Dataset) -> Finding:
    return _largest_miss(
        check, "from a run of Fig. 4's launch by equations without Euler angles, at five instants"
    )


def _largest_miss(check: xr.Dataset, words: str) -> Finding:
    """Return the largest difference of some equations as a finding."""
    miss = check["miss"]
    each = listed("{} {}", miss["equation"].values, map(rounded, miss.values))
    return Finding.unlisted(float(miss.max()), f"Differences {words}: {each}.")


@examines(
    "eq-2.7",
    "printed-equations",
    tolerance=Tolerance(1e-9, "the torque is a hundred thousand times larger"),
)
def _(check: xr.Dataset) -> Finding:
    return Finding(
        *both(check, "torque"),
        f"In the other order, a x F is {check['torque_turned']:.4e} N m: still wrong, because F"
        " includes the weight, which acts at the centre of mass and has no torque about it."
        f" Without the weight it is {check['torque_corrected']:.4e} N m, as in (2.8) and in the"
        " run. With the printed order the power of the contact force would be"
        f" {1e3 * float(check['power_printed']):+.2f} mW; the power of friction is"
        f" {1e3 * float(check['power']):+.2f} mW.",
        reported=float(check["torque_printed"]),
    )


@examines(
    "eq-2.9",
    "printed-equations",
    tolerance=Tolerance(1e-3, "the accuracy of the derivative taken of the run"),
)
def _(check: xr.Dataset) -> Finding:
    return Finding(
        *both(check, "precession"),
        "The I1 in the numerator is one too many. Read as I1 over the bracket, the formula gives"
        f" {check['precession_printed']:.4g}; read as a factor,"
        f" {check['precession_printed_product']:.4g} (both in wrong units). The listing has the"
        f" right equation. {TRANSCRIBED}",
        reported=float(check["precession_printed"]),
    )


@examines("eq-4.1", "run-155", tolerance=ROUNDING)
def _(run: xr.Dataset) -> Finding:
    launch = float(run["launch_energy"])
    difference = run["energy_published"] - run["energy"]
    k = int(np.argmax(np.abs(difference.values)))
    share = float(difference[k]) / launch
    return Finding.unlisted(
        abs(share),
        "(4.1) leaves out what slip adds to the velocity of the centre of mass. At"
        f" {run['time'][k]:.2f} s it is {1e3 * float(difference[k]):+.3f} mJ off,"
        f" {100 * share:+.1f} % of the energy at launch.",
    )
