"""Published statements on tippe tops on dry friction, against exact runs."""

import numpy as np
import xarray as xr

from tippetop.report.claim import Finding, both, examines, listed
from tippetop.report.experiments.dry import COHEN_STEP, COHEN_WINDOW
from tippetop.report.printed_numbers import NORMAL_FRICTION, ROUGH_FRICTION, SPIN
from tippetop.report.tolerance import ROUNDING

_EQUAL = 1e-6
"""Difference of tilts (rad) and relative difference of energies below which runs are equal: far
above rounding, far below any motion.
"""

_OVER = np.pi / 2
"""Tilt above which a top has turned over, rad."""

_DRY = (0.1, 1.0)
"""Range of Coulomb friction coefficients of dry solids, polished to rough, as in the claim
dry-normal-mu.
"""


@examines("dry-tilting-rate")
def _(data: xr.Dataset) -> Finding:
    tilt = data["tilt_held"]
    same = float(abs(tilt - tilt.isel(held=0)).max()) < _EQUAL
    rolls = same and int(data["slips_held"].sum()) == 0 and float(data["lost_held"].max()) < _EQUAL
    needed, shown = float(data["needed_main"]), data["held"].values
    return Finding.unlisted(
        not rolls,
        f"At {data.attrs['spin_rad_per_s']:g} rad/s and {data.attrs['tilt_rad']:g} rad the report's"
        f" top needs mu = {needed:.5f} to roll. On mu = {shown.min():.5f} to {shown.max():g} its"
        f" motion is the same for {float(data['time'][-1]):g} s: it never slips, its tilt is at"
        f" most {float(tilt.max()):.4f} rad and its energy is constant to"
        f" {float(data['lost_held'].max()):.0e}. With 0.1 % less friction it slips after"
        f" {1e3 * float(data['held_below']):.1f} ms. The law can hold while a top slips, for then"
        " friction is proportional to mu; the top judged is set down without slip, as the report's"
        " are.",
    )


@examines("dry-cohen-inversion")
def _(data: xr.Dataset) -> Finding:
    window = data.sel(time=slice(0.0, COHEN_WINDOW + 1e-9))
    highest = data["tilt_stepped"].max("time")
    tilts = listed("{:g} ms {:.2f}", 1e3 * data["step"].values, highest.values)
    longest = window["tilt_stepped"].isel(step=0)
    ends = [float(longest.sel(time=t, method="nearest")) for t in (1.0, 1.5, 2.0)]
    return Finding(
        bool(window["tilt_stepped"].sel(step=COHEN_STEP, method="nearest").max() > _OVER),
        bool(data["tilt"].max() > _OVER),
        f"With steps of {1e3 * COHEN_STEP:g} ms the classical Runge-Kutta method gives"
        f" {ends[0]:.2f}, {ends[1]:.2f} and {ends[2]:.2f} rad at 1, 1.5 and 2 s. Largest tilts"
        f" within {float(data['time'][-1]):g} s by the step (rad): {tilts}. Exactly, slip ends"
        f" after {float(data['sticks']):.6f} s, the top rolls from then on, and its tilt is at most"
        f" {float(data['tilt'].max()):.3f} rad.",
    )


@examines("dry-cohen-sliding")
def _(data: xr.Dataset) -> Finding:
    least = float(data["slowest"].sel(step=COHEN_STEP, method="nearest"))
    return Finding(
        least > 0.0,
        bool(not np.isfinite(data["sticks"]) or data["slips_again"] > 0),
        f"Steps of {1e3 * COHEN_STEP:g} ms jump over the end of slip: the least slip speed at any"
        f" of them is {1e3 * least:.1f} mm/s. Exactly it is zero from {float(data['sticks']):.6f} s"
        f" on, and the energy is then constant to {float(data['energy_kept']):.0e}.",
    )


@examines("dry-coulomb-weaker")
def _(data: xr.Dataset) -> Finding:
    eps, times = data["eps"].values, data["turning_time"].values
    return Finding.unlisted(
        bool(np.isfinite(data["exact_turns"])),
        f"Regularised below eps = {eps[0]:g} m/s, friction of mu = {data.attrs['mu']:g} turns the"
        f" top over in {times[0]:.2f} s, below {eps[-1]:g} m/s in {times[-1]:.2f} s; at the least"
        f" eps the time goes as eps to the power {float(data['last_exponent']):.2f}. On Coulomb's"
        f" law itself the tilt is at most {float(data['highest']):.4f} rad for"
        f" {float(data['followed']):g} s: small eps and long times do not commute.",
        bool(np.isfinite(times).all()),
        "the friction is regularised",
    )


@examines("dry-patch-inversion")
def _(data: xr.Dataset) -> Finding:
    turned = data["turning_time"].notnull()
    fast = data.isel(spin=-1)
    quickest = fast.isel(radius=int(fast["turning_time"].argmin("radius")))
    never = fast["radius"].where(
        fast["turning_time"].isnull() & (fast["radius"] > quickest["radius"])
    )
    slowest = float(data["spin"].where(turned.any("radius")).min())
    return Finding.unlisted(
        bool(np.isfinite(data["theirs_turns"])),
        f"Their top passes the horizontal after {float(data['theirs_turns']):.5f} s (ellipsoidal"
        f" limit surface). The report's, on mu = {data.attrs['mu']:g} at {float(fast['spin']):g}"
        f" rad/s, is quickest of those tried with a patch of {1e3 * float(quickest['radius']):.2g}"
        f" mm, {float(quickest['turning_time']):.2f} s, and does not turn over with one of"
        f" {1e3 * float(never.min()):.2g} mm or more: drilling takes the spin first. Within"
        f" {data.attrs['window_s']:g} s it takes at least {slowest:.0f} rad/s at the spins tried.",
    )


@examines("dry-viscous-limit", tolerance=ROUNDING)
def _(data: xr.Dataset) -> Finding:
    ratio = data["patch_time"] / data["viscous_time"]
    least, most = ratio.min("coefficient").values, ratio.max("coefficient").values
    spans = listed("mu = {:g}: {:.2f} to {:.2f}", data["mu"].values, least, most, between="; ")
    worst = data["growth_ratio"].values.ravel()
    return Finding.unlisted(
        float(worst[np.abs(worst - 1.0).argmax()]),
        "The coefficient is (3 pi / 8) mu / (R omega) with Hertz's pressure and mu / (rho omega)"
        " with an ellipsoidal limit surface. The ratio of the times to the horizontal, for"
        f" coefficients from {float(data['coefficient'][0]):g} to"
        f" {float(data['coefficient'][-1]):g} s/m, shows how far it holds for large tilts: {spans}."
        " With little friction the slip becomes too large for the limit; with much, drilling takes"
        " spin.",
    )


@examines("dry-normal-mu", "dry-viscous", "run-155")
def _(data: xr.Dataset, run: xr.Dataset) -> Finding:
    theirs, ours = ([mu * slip for mu in NORMAL_FRICTION] for slip in both(run, "largest_slip"))
    return Finding(
        _is_dry(theirs),
        _is_dry(ours),
        f"Slipping at {float(run['largest_slip']):.2f} m/s, a top with these coefficients has as"
        f" much friction as on dry friction of {ours[0]:.2f} to {ours[1]:.2f}. This is normal for"
        f" fast slip, and little for slow slip. {_surfaces(data)}",
    )


def _is_dry(ratios: list[float]) -> bool:
    """Return whether ratios of friction and normal force are within the range of dry solids."""
    return _DRY[0] <= min(ratios) and max(ratios) <= _DRY[1]


@examines("dry-rough-mu")
def _(data: xr.Dataset) -> Finding:
    slowest = float((data["hertz_coefficient"].max() / ROUGH_FRICTION) * SPIN)
    return Finding.unlisted(
        bool((data["hertz_coefficient"] < ROUGH_FRICTION).all()),
        f"{_surfaces(data)} None reaches {ROUGH_FRICTION:g} s/m at this spin, but the coefficient"
        f" is inversely proportional to the spin: below {slowest:.0f} rad/s the hardest of them"
        " does.",
    )


def _surfaces(data: xr.Dataset) -> str:
    """Return a sentence on the viscous friction that is equivalent to patches of common
    materials.
    """
    names, radii, coefficients = (
        data[name].values for name in ("material", "hertz_radius", "hertz_coefficient")
    )
    each = listed("{} {:.0f} µm and {:.0f} s/m", names, 1e6 * radii, coefficients)
    return (
        "Dry friction of mu = 0.3 on the elastic patch under the weight of the report's top, table"
        f" of the same material, creeps at {SPIN:g} rad/s as viscous friction would with this"
        f" coefficient: {each}."
    )
