"""Claims about launches that leave the table: Figs. 9 to 12 and 16, the abnormal point, and what is true."""

import numpy as np
import xarray as xr

from tippetop.problem import Problem
from tippetop.report.claim import Chapter, Finding, Source, half_last_digit
from tippetop.report.claims.launches import both_controls
from tippetop.report.experiments.spins import TURNED
from tippetop.report.quoted import ABNORMAL_SPIN, ENERGY, ENERGY_TIME, FALL, STOP

CHAPTER = Chapter()


@CHAPTER.claim(
    "fig11-negative",
    Source("4", "Fig. 11"),
    "At 175 rad/s the normal force becomes negative.",
    needs=("run-175",),
    figure="fig11",
)
def _(run: xr.Dataset) -> Finding:
    return Finding(
        float(run["least_force_listing"]) < 0,
        float(run["least_force"]) < 0,
        f"First at {run['lift_off_time']:.4f} s. On a table that pulls, the force reaches "
        f"{run['least_force']:.2f} N within 20 s, {run['least_force_listing']:.2f} N by the "
        "report's method. A table that only pushes lets go there: its force is never less than zero.",
    )


@CHAPTER.claim(
    "fig10-energy",
    Source("4", "Fig. 10"),
    f"At 175 rad/s the energy reaches {ENERGY} J at t = {ENERGY_TIME} s.",
    f"{ENERGY} J",
    needs=("run-175",),
    figure="fig10",
)
def _(run: xr.Dataset) -> Finding:
    instant, half = float(ENERGY_TIME), half_last_digit(ENERGY_TIME).value
    near = run["energy_listing"].sel(time_listing=slice(instant - half, instant + half))
    return Finding(
        float(np.interp(instant, run["time_listing"], run["energy_listing"])),
        float(np.interp(instant, run["time"], run["energy"])),
        "By (4.1) the report's energy swings with every nutation, so the value depends on the instant; its "
        f"largest is {run['largest_energy_listing']:.4f} J. The full energy on the table that pulls "
        f"exceeds that of the launch ({run['launch_energy']:.5f} J) by at most "
        f"{run['largest_energy'] - run['launch_energy']:.4f} J.",
        (float(near.min()), float(near.max())),
        f"the instant, {instant - half:g} to {instant + half:g} s",
    )


@CHAPTER.claim(
    "fig10-fall",
    Source("4", "Fig. 10"),
    f"To gain that energy the top would have to have fallen {FALL} radii.",
    f"{FALL} R",
    needs=("run-175",),
    figure="fig10",
)
def _(run: xr.Dataset) -> Finding:
    problem = Problem.from_json(run.attrs["problem"])
    weight = problem.body.mass * problem.gravity * problem.top.shape.size
    launch, reached = float(run["launch_energy"]), float(ENERGY)
    return Finding(
        reached / weight,
        (reached - launch) / weight,
        f"The 15 radii are all of the {reached:g} J; but the spin brings {launch / weight:.1f} radii' worth "
        "of it, and only the rest is a gain. The conclusion stands: while the table only pushes, nothing can "
        "be gained.",
    )


@CHAPTER.claim(
    "fig10-impossible",
    Source("4", "Fig. 10"),
    "A growing energy is impossible as long as the table does not pull.",
    needs=("run-175",),
    figure="fig10",
)
def _(run: xr.Dataset) -> Finding:
    time, energy = run["time"].values, run["energy"].values
    before = energy[time <= float(run["lift_off_time"])]
    largest_rise = float(np.diff(before).max())
    pulling = (run["normal_force"].values < 0).mean()
    return Finding(
        None,
        largest_rise <= 1e-12 * float(run["launch_energy"]),
        f"Up to lift-off the energy never rises (largest change from sample to sample {largest_rise:.1e} J). "
        f"Later the force is negative at {100 * pulling:.0f} % of the samples, and there friction -mu g_n v "
        "pushes along the slip instead of against it: that is where the energy comes from. On a table that "
        f"only pushes the energy has no such source: it falls to {run['energy_flight'][-1]:.4f} J.",
    )


@CHAPTER.claim(
    "fig12-stop-time",
    Source("4", "Fig. 12"),
    f"Stopping at t = {STOP} s is stopping before the top leaves the table.",
    f"{STOP} s",
    needs=("run-175",),
    figure="fig12",
)
def _(run: xr.Dataset) -> Finding:
    ours = float(run["lift_off_time"])
    return Finding(
        float(run["zero_of_force_listing"]),
        ours,
        f"The value is the first zero of the normal force. The tolerance of 1e-3 delays it; the stop comes "
        f"{float(STOP) - ours:.2f} s after the true lift-off. Nor is there a need to stop: after "
        f"{int(run['flights'])} flights the top slides on from {run['last_touchdown']:.2f} s.",
        both_controls(run, "zero_of_force"),
        "the step control: ode45's and SciPy's, at the same tolerances",
    )


@CHAPTER.claim(
    "fig16-stays",
    Source("Appendix C", "Fig. 16"),
    "Launched at 150 rad/s and theta = pi/4 the top stays on the table (drawn without a remark).",
    needs=("run-150-pi-4",),
    figure="fig16",
)
def _(run: xr.Dataset) -> Finding:
    return Finding(
        not float(run["least_force_listing"]) < 0,
        not np.isfinite(float(run["lift_off_time"])),
        f"It leaves the table at {run['lift_off_time']:.3f} s; on a table that pulls the force falls "
        f"to {run['least_force']:.3f} N. The report's method also finds a pull, from "
        f"{run['zero_of_force_listing']:.2f} s on. {_hopping(run)}",
    )


@CHAPTER.claim(
    "sec4-may-fly",
    Source("4", "Fig. 11"),
    "At 175 rad/s the top may fly off the surface.",
    needs=("run-175",),
    figure="fig12",
)
def _(run: xr.Dataset) -> Finding:
    return Finding(
        None,
        int(run["flights"]) > 0,
        f"First at {run['lift_off_time']:.6f} s. {_hopping(run)} That the motion is hard to discuss, "
        "as the report has it, does not keep it from being computed.",
    )


@CHAPTER.claim(
    "sec4-energy-falls",
    Source("4", "Fig. 10"),
    "The top loses energy during its motion; nothing adds to it.",
    needs=("run-175", "hops", "hops-bouncing"),
    figure="fig10",
)
def _(run: xr.Dataset, hops: xr.Dataset, bouncing: xr.Dataset) -> Finding:
    rises = [float(data["energy_rise"].max()) for data in (run, hops, bouncing)]
    launch, impacts = float(run["launch_energy"]), float(run["energy_in_impacts"])
    return Finding(
        not float(run["largest_energy_listing"]) > launch,
        max(rises) <= 1e-12 * launch,
        "On a table that only pushes it never rises, neither here nor in any launch of the figure hops: the "
        f"largest change from sample to sample is {max(rises):.0e} J. At 175 rad/s the top loses "
        f"{1e3 * (launch - float(run['energy_flight'][-1])):.1f} mJ of {1e3 * launch:.1f} mJ, "
        f"{1e3 * impacts:.2f} mJ of them in impacts.",
    )


@CHAPTER.claim(
    "sec4-huge-spin",
    Source("4"),
    f"It is at huge spins, above {ABNORMAL_SPIN} rad/s, that the top cannot be held on the surface.",
    needs=("onset-mu", "onset-tilt"),
    figure="onset-tilt",
)
def _(over_mu: xr.Dataset, over_tilt: xr.Dataset) -> Finding:
    slippery, steep = over_mu["onset"].isel(window=-1), over_tilt["onset"].isel(window=0)
    at_mu = slippery.isel(mu=int(np.nanargmin(slippery.values)))
    at_tilt = steep.isel(tilt=int(np.nanargmin(steep.values)))
    stays = over_tilt["tilt"].values[~np.isfinite(over_tilt["first_lift_off"].values).any(axis=1)]
    never = (
        f" From a tilt of {stays.min():.2f} rad on no launch of the scan, up to "
        f"{over_tilt['spin'][-1]:g} rad/s, leaves the table."
        if len(stays)
        else ""
    )
    return Finding(
        None,
        min(float(at_mu), float(at_tilt)) > float(ABNORMAL_SPIN),
        f"How huge depends on tilt and friction. With the tilt the onset falls to {at_tilt:.0f} rad/s "
        f"(at {at_tilt['tilt']:.2f} rad, mu = {over_tilt.attrs['mu_s_per_m']:g} s/m), with the "
        f"friction to {at_mu:.0f} rad/s (at mu = {at_mu['mu']:.2g} s/m, tilt "
        f"{over_mu.attrs['tilt_rad']:g} rad).{never}",
    )


@CHAPTER.claim(
    "sum-abnormal",
    Source("3.3", "Fig. 6"),
    f"Above {ABNORMAL_SPIN} rad/s the top behaves abnormally; a negative normal force causes that, and "
    "it is not physical.",
    needs=("final-tilt", "hops", "hops-bouncing"),
    figure="hops",
)
def _(sweep: xr.Dataset, hops: xr.Dataset, bouncing: xr.Dataset) -> Finding:
    true, spins = sweep["final_theta_flight"].values, sweep["spin_flight"].values
    turned = all(_turned(data["final_theta_flight"]) for data in (sweep, hops, bouncing))
    lost = float(sweep["lost"])
    return Finding(
        None,
        turned and float(sweep["lift_off_onset"]) <= lost,
        f"The abnormal point is {'no' if turned else 'still a'} property of the top. On a table that pulls, "
        f"launches from {lost:g} rad/s on end anywhere; on one that only pushes, those from {spins[0]:g} to "
        f"{spins[-1]:g} rad/s end within {np.abs(true - np.pi).max():.1g} rad of pi after "
        f"{sweep.attrs['window_s']:g} s, and those up to {hops['spin'][-1]:g} rad/s within "
        f"{np.abs(hops['final_theta_flight'].values - np.pi).max():.1g} rad after "
        f"{hops.attrs['window_s']:g} s.",
    )


@CHAPTER.claim(
    "sum-turns-over",
    Source("3.3"),
    "Above omega_c2 the top turns over completely and spins on its stem (the report excepts the spins "
    f"above {ABNORMAL_SPIN} rad/s).",
    needs=("hops", "hops-bouncing"),
    figure="hops",
)
def _(hops: xr.Dataset, bouncing: xr.Dataset) -> Finding:
    turned = all(_turned(data["final_theta_flight"]) for data in (hops, bouncing))
    hops = hops.isel(restitution=0)
    flying = hops.sel(spin=hops["flights"] > 0)
    share = 100 * flying["airborne_time"] / flying["last_touchdown"]
    columns = (flying["spin"], flying["flights"], share, flying["turning_time"])
    described = "; ".join(
        f"{spin:g}: {count:.0f}, {part:.0f} %, {passed:.1f} s"
        for spin, count, part, passed in zip(*(column.values for column in columns), strict=True)
    )
    return Finding(
        None,
        turned,
        f"On a table that only pushes {'all' if turned else 'not all'} launches tried up to "
        f"{hops['spin'][-1]:g} rad/s turn over. Without rebound, by spin in rad/s, the number of "
        "flights, the part of the time until the last touchdown that is spent in the air, and when the axis "
        f"passes the horizontal: {described}.",
    )


def _turned(tilts: xr.DataArray) -> bool:
    """Whether all of the tilts count as turned over."""
    return bool((abs(tilts - np.pi) < TURNED).all())


def _hopping(run: xr.Dataset) -> str:
    """How a launch goes on when the table only pushes, in a sentence."""
    return (
        f"When the table only pushes, the top makes {int(run['flights'])} flights, the highest of "
        f"{1e3 * float(run['highest_gap']):.2f} mm, with {run['airborne_time']:.2f} s in the air "
        f"until the last touchdown at {run['last_touchdown']:.2f} s; its axis passes the horizontal "
        f"at {run['turning_time']:.1f} s, and it ends at {run['final_theta_flight']:.3f} rad."
    )
