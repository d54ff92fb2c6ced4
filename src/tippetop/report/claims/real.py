"""What was published of tops with stems, eggs, disks and balls, against exact runs."""

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


@examines("real-leine-stem", tolerance=_READ, event="stem", printed=1.5)
@examines("real-leine-back", tolerance=_READ, event="back", printed=4.5)
@examines("real-leine-both", tolerance=_READ, event="both", printed=4.6)
@examines("real-leine-apart", tolerance=_READ, event="apart", printed=5.4)
def _(data: xr.Dataset, *, event: str, printed: float) -> Finding:
    times = data[event]
    pressures, misses = data["pressure"].values, abs(times - printed)
    failing = [str(name) for name in pressures[(misses > _READ.value).values]]
    return Finding.unlisted(
        float(times[0]),
        "The paper does not say which pressure in the patch its figure is for. Judged is the"
        " ellipsoidal limit surface, the law of a code of its authors; it misses by"
        f" {float(misses[0]):.3f} s. By the pressure:"
        f" {listed('{:.4f} s ({})', times.values, pressures)}. "
        + (f"Too far off would be: {', '.join(failing)}. " if failing else "")
        + f"Energy and work balance to {float(data['energy_error'].max()):.0e} of the energy.",
    )


@examines("real-leine-stepping")
def _(data: xr.Dataset) -> Finding:
    events = ("stem", "back", "both", "apart")
    off = {name: data[name] - data[f"exact_{name}"] for name in (*events, "final_theta")}
    goes = all(abs(float(off[name][-1])) < 0.5 * abs(float(off[name][0])) for name in events)
    columns = (
        1e3 * data["step"],
        off["stem"],
        off["back"],
        off["both"],
        data["strikes"],
        off["final_theta"],
    )
    steps = listed(
        "{:g} ms: {:+.4f}, {:+.3f}, {:+.3f} s, {:.0f} strikes, {:+.3f} rad",
        *(column.values for column in columns),
        between="; ",
    )
    return Finding.unlisted(
        goes,
        "By its step, how far off are the stem's first touch, the fall back on the sphere and the"
        " beginning of double contact, of how many strikes the rocking before this consists, and"
        f" how far off the tilt is after 8 s: {steps}. There are {int(data['exact_strikes'])}"
        " strikes above the bound at which the rocking is cut off; those closer together than a"
        " step are one to it, so that both surfaces rest on the table too early.",
    )


@examines("real-stem-test")
def _(data: xr.Dataset) -> Finding:
    stands = (data["final_theta"] > np.pi - data.attrs["upright_rad"]).values
    enough = (data["jellett"] > data["jellett_needed"]).values
    share = (data["jellett"] / data["jellett_needed"]).values
    return Finding.unlisted(
        bool((stands == enough).all()),
        f"{int(stands.sum())} of {len(stands)} stems of the report's top, whose tips have radii of"
        f" {1e3 * float(data['radius'].min()):g} to {1e3 * float(data['radius'].max()):g} mm, are"
        f" stood upon after {data.attrs['window_s']:g} s. Jellett's integral is {share.min():.3f}"
        f" to {share.max():.3f} of the least as they touch. It does not change while the tip alone"
        " touches, and a top that lacks it falls back.",
    )


@examines("real-egg-rises")
def _(data: xr.Dataset) -> Finding:
    final = data["theta"].isel(time=-1)
    tilts = listed("{:g} rad/s: {:.3f}", data["rate"].values, final.values, between="; ")
    return Finding.unlisted(
        float(final.isel(rate=-1)) > np.pi - 0.1,
        f"Tilt after {float(data['time'][-1]):g} s, rad, by the rate at launch: {tilts}. Viscous"
        f" friction of {data.attrs['mu_s_per_m']:g} s/m.",
    )


@examines("real-egg-jumps")
def _(data: xr.Dataset) -> Finding:
    lifts = data["lift_off"].dropna("rate")
    times = listed("{:.3f} s at {:g} rad/s", lifts.values, lifts["rate"].values)
    return Finding.unlisted(bool(len(lifts)), f"First lift-offs: {times or 'none'}.")


@examines("real-disk-rate", tolerance=_THIN)
def _(data: xr.Dataset) -> Finding:
    near = data["disk_tilt"].values < 0.35
    ratio = (data["disk_measured"] / data["disk_thin"]).values[near]
    return Finding.unlisted(
        float(ratio[np.abs(ratio - 1.0).argmax()]),
        "The toy of 75 mm and 12.5 mm thickness, at tilts up to "
        f"{float(data['disk_tilt'].values[near].max()):g} rad. The tilt keeps to "
        f"{float(data['disk_drift'].max()):.0e} rad in runs on dry friction.",
    )


@examines("real-hurricane-balls", tolerance=ROUNDING)
def _(data: xr.Dataset) -> Finding:
    rate, tilt = data["balls_measured"].values, data["balls_tilt"].values
    off = np.cos(tilt) - 2 / 5 + data.attrs["gravity"] / (rate**2 * data.attrs["ball_radius_m"])
    return Finding.unlisted(
        float(np.abs(off).max()),
        f"Runs at {rate.min():.1f} to {rate.max():.1f} rad/s on dry friction, whose tilts keep to "
        f"{float(data['balls_drift'].max()):.0e} rad. Slower than sqrt(5 g / (2 R)) none is.",
    )
