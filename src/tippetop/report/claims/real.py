"""Published statements on tops with stems, eggs, disks and balls, against exact runs."""

import numpy as np
import xarray as xr

from tippetop.report.claim import Finding, examines, listed
from tippetop.report.tolerance import ROUNDING, Tolerance

_READ = Tolerance(
    0.13,
    "the time is read off a plot of 8 s here, to 1 % of it, and given to half a unit of its last"
    " digit",
)

_THIN = Tolerance(
    0.02, "2 %: the disk of the toy has a thickness, and the formula is for one that has none"
)


@examines("real-leine-stem", tolerance=_READ, takes_printed=True, event="stem")
@examines("real-leine-back", tolerance=_READ, takes_printed=True, event="back")
@examines("real-leine-both", tolerance=_READ, takes_printed=True, event="both")
@examines("real-leine-apart", tolerance=_READ, takes_printed=True, event="apart")
def _(data: xr.Dataset, *, printed: float, event: str) -> Finding:
    times = data[event]
    pressures, misses = data["pressure"].values, abs(times - printed)
    failing = [str(name) for name in pressures[(misses > _READ.value).values]]
    return Finding.unlisted(
        float(times[0]),
        "The paper does not state the pressure in the patch for its figure. The value is for the"
        " ellipsoidal limit surface, the law of a code of its authors; it differs by"
        f" {float(misses[0]):.3f} s. By the pressure:"
        f" {listed('{:.4f} s ({})', times.values, pressures)}. "
        + (f"Outside the tolerance: {', '.join(failing)}. " if failing else "")
        + f"Energy and work balance to {float(data['energy_error'].max()):.0e} of the energy.",
    )


@examines("real-leine-stepping")
def _(data: xr.Dataset) -> Finding:
    events = ("stem", "back", "both", "apart")
    off = {name: data[name] - data[f"exact_{name}"] for name in (*events, "final_tilt")}
    goes = all(abs(float(off[name][-1])) < 0.5 * abs(float(off[name][0])) for name in events)
    columns = (
        1e3 * data["step"],
        off["stem"],
        off["back"],
        off["both"],
        data["strikes"],
        off["final_tilt"],
    )
    steps = listed(
        "{:g} ms: {:+.4f}, {:+.3f}, {:+.3f} s, {:.0f} strikes, {:+.3f} rad",
        *(column.values for column in columns),
        between="; ",
    )
    return Finding.unlisted(
        goes,
        "For each step, the errors of the stem's first touch, of the fall back on the sphere and of"
        " the beginning of double contact, the number of strikes in the rocking before it, and the"
        f" error of the tilt after 8 s: {steps}. An exact run has {int(data['exact_strikes'])}"
        " strikes above the bound at which the rocking is cut off; time-stepping counts strikes"
        " within one step as one, so that both surfaces rest on the table too early.",
    )


@examines("real-stem-test")
def _(data: xr.Dataset) -> Finding:
    stands = (data["final_tilt"] > np.pi - data.attrs["upright_rad"]).values
    enough = (data["jellett"] > data["jellett_needed"]).values
    share = (data["jellett"] / data["jellett_needed"]).values
    return Finding.unlisted(
        bool((stands == enough).all()),
        f"{int(stands.sum())} of {len(stands)} stems of the report's top, whose tips have radii of"
        f" {1e3 * float(data['radius'].min()):g} to {1e3 * float(data['radius'].max()):g} mm, carry"
        f" the top after {data.attrs['window_s']:g} s. Jellett's integral at their first touch is"
        f" {share.min():.3f} to {share.max():.3f} of the least value. It does not change while the"
        " tip alone touches, and a top with less falls back.",
    )


@examines("real-egg-rises")
def _(data: xr.Dataset) -> Finding:
    final = data["tilt"].isel(time=-1)
    tilts = listed("{:g} rad/s: {:.3f}", data["rate"].values, final.values, between="; ")
    return Finding.unlisted(
        float(final.isel(rate=-1)) > np.pi - 0.1,
        f"Tilt after {float(data['time'][-1]):g} s, rad, by the rate at launch: {tilts}. Viscous"
        f" friction of {data.attrs['mu_s_per_m']:g} s/m.",
    )


@examines("real-egg-jumps")
def _(data: xr.Dataset) -> Finding:
    lifts = data["liftoff"].dropna("rate")
    times = listed("{:.3f} s at {:g} rad/s", lifts.values, lifts["rate"].values)
    return Finding.unlisted(bool(len(lifts)), f"First lift-offs: {times or 'none'}.")


@examines("real-disk-rate", tolerance=_THIN)
def _(data: xr.Dataset) -> Finding:
    near = data["disk_tilt"].values < 0.35
    ratio = (data["disk_measured"] / data["disk_thin"]).values[near]
    return Finding.unlisted(
        float(ratio[np.abs(ratio - 1.0).argmax()]),
        "The toy of 75 mm and 12.5 mm thickness, at tilts up to "
        f"{float(data['disk_tilt'].values[near].max()):g} rad. The tilt is constant to "
        f"{float(data['disk_drift'].max()):.0e} rad in runs on dry friction.",
    )


@examines("real-hurricane-balls", tolerance=ROUNDING)
def _(data: xr.Dataset) -> Finding:
    rate, tilt = data["balls_measured"].values, data["balls_tilt"].values
    off = np.cos(tilt) - 2 / 5 + data.attrs["gravity"] / (rate**2 * data.attrs["ball_radius_m"])
    return Finding.unlisted(
        float(np.abs(off).max()),
        f"Runs at {rate.min():.1f} to {rate.max():.1f} rad/s on dry friction; their tilts are"
        f" constant to {float(data['balls_drift'].max()):.0e} rad. The motion does not exist below"
        " sqrt(5 g / (2 R)).",
    )
