"""Claims about launches that the report calls abnormal: those faster than omega_a."""

import numpy as np
import xarray as xr

from tippetop.report.claim import Finding, examines, listed
from tippetop.report.claims.flight import ROUNDED
from tippetop.report.experiments.spins import TURNED
from tippetop.report.printed_numbers import ABNORMAL_SPIN, CRITICAL_SPINS, TILT


@examines("sec4-energy-falls", "run-175", "flights", "flights-bouncing")
def _(run: xr.Dataset, flights: xr.Dataset, bouncing: xr.Dataset) -> Finding:
    rises = [float(data["energy_rise"].max()) for data in (run, flights, bouncing)]
    launch, impacts = float(run["launch_energy"]), float(run["energy_in_impacts"])
    return Finding(
        not float(run["largest_energy_listing"]) > launch,
        max(rises) <= ROUNDED * launch,
        "On a table that only pushes the energy never rises, neither here nor in any launch of the"
        " figure"
        f" flights: the largest change from sample to sample is {max(rises):.0e} J. At 175 rad/s"
        f" the top loses {1e3 * (launch - float(run['energy_flight'][-1])):.1f} mJ of"
        f" {1e3 * launch:.1f} mJ, {1e3 * impacts:.2f} mJ of them in impacts. By the report's method"
        " and (4.1) the energy exceeds that of the launch: this shows the report that something is"
        " wrong.",
    )


@examines("sec4-huge-spin", "onset-tilt", "onset-mu", "run-175", "final-tilt")
def _(over_tilt: xr.Dataset, over_mu: xr.Dataset, run: xr.Dataset, sweep: xr.Dataset) -> Finding:
    at_report_tilt = over_tilt.sel(tilt=TILT)
    spins = at_report_tilt["spin"]
    huge = at_report_tilt["liftoff_time"].sel(spin=spins > float(ABNORMAL_SPIN))
    slippery, steep = over_mu["onset"].isel(window=-1), over_tilt["onset"].isel(window=0)
    at_mu = slippery.isel(mu=int(np.nanargmin(slippery.values)))
    at_tilt = steep.isel(tilt=int(np.nanargmin(steep.values)))
    stays = over_tilt["tilt"].values[~np.isfinite(over_tilt["liftoff_time"].values).any(axis=1)]
    never = (
        f" From a tilt of {stays.min():.2f} rad on no launch of the scan leaves the table."
        if len(stays)
        else ""
    )
    return Finding(
        bool(np.isfinite(run["zero_of_force_listing"])),
        bool(np.isfinite(huge).all()),
        f"At the report's tilt and friction every launch of the scan above {ABNORMAL_SPIN} rad/s,"
        f" up to {spins[-1]:g} rad/s, leaves the table within 20 s; the onset is"
        f" {sweep['lift_off_onset']:.2f} rad/s. For other launches it is lower: {at_tilt:.0f} rad/s"
        f" at a tilt of {at_tilt['tilt']:.2f} rad, {at_mu:.0f} rad/s at mu = {at_mu['mu']:.2g} s/m"
        f" in longer runs.{never}",
    )


@examines("sum-abnormal", "final-tilt", "flights", "flights-bouncing", "listing-capped")
def _(sweep: xr.Dataset, flights: xr.Dataset, bouncing: xr.Dataset, capped: xr.Dataset) -> Finding:
    true, spins = sweep["final_tilt_flight"].values, sweep["spin_flight"].values
    cured = not _turned(capped["final_tilt"]) and _turned(capped["final_tilt_capped"])
    columns = ("spin", "final_tilt", "final_tilt_capped")
    ends = listed("{:g} rad/s {:.2f} and {:.2f} rad", *(capped[name].values for name in columns))
    turned = all(_turned(data["final_tilt_flight"]) for data in (sweep, flights, bouncing))
    lost = float(sweep["lost"])
    return Finding(
        cured,
        turned and float(sweep["lift_off_onset"]) <= lost,
        f"The abnormal point is {'not' if turned else 'still'} a property of the top. On a table"
        f" that pulls, launches from {lost:g} rad/s on end anywhere; on one that only pushes, those"
        f" from {spins[0]:g} to {spins[-1]:g} rad/s end within {np.abs(true - np.pi).max():.1g} rad"
        f" of pi after {sweep.attrs['window_s']:g} s, and those up to {flights['spin'][-1]:g} rad/s"
        f" within {np.abs(flights['final_tilt_flight'].values - np.pi).max():.1g} rad after"
        f" {flights.attrs['window_s']:g} s. The report's listing has three lines commented out that"
        " set a negative normal force to zero; without and with them its method ends, by spin, at"
        f" {ends}.",
        news=(
            "Three lines of the report's listing, commented out, would have removed the abnormal"
            " point: they set a negative normal force to zero, which is close to letting the top"
            " hop, because the hops are low."
            if cured
            else ""
        ),
    )


@examines("sum-turns-over", "final-tilt-listing", "final-tilt", "flights", "flights-bouncing")
def _(listing: xr.Dataset, sweep: xr.Dataset, flights: xr.Dataset, bouncing: xr.Dataset) -> Finding:
    theirs = _inverting(listing, "_listing", float(ABNORMAL_SPIN))
    ours = _inverting(sweep, "", float(sweep["lift_off_onset"]))
    turned = _turned(ours) and all(_turned(run["final_tilt_flight"]) for run in (flights, bouncing))
    flights = flights.isel(restitution=0)
    flying = flights.sel(spin=flights["flights"] > 0)
    share = 100 * flying["airborne_time"] / flying["last_touchdown"]
    columns = (
        each.values for each in (flying["spin"], flying["flights"], share, flying["turning_time"])
    )
    described = listed("{:g}: {:.0f}, {:.0f} %, {:.1f} s", *columns, between="; ")
    return Finding(
        _turned(theirs),
        turned,
        "The model is a whole sphere: it has no stem to spin on; with one, see the figure"
        f" real-stems. On a table that only pushes {'all' if turned else 'not all'} launches tried"
        f" up to {flights['spin'][-1]:g} rad/s turn over. Without rebound, by spin in rad/s, the"
        " number of flights, the part of the time until the last touchdown that is spent in the"
        f" air, and when the axis passes the horizontal: {described}.",
    )


def _inverting(sweep: xr.Dataset, suffix: str, limit: float) -> np.ndarray:
    """Return the final tilts of the launches between omega_c2 and a limit, rad."""
    spins = sweep[f"spin{suffix}"].values
    return np.asarray(
        sweep[f"final_tilt{suffix}"].values[(spins > float(CRITICAL_SPINS[1])) & (spins < limit)]
    )


def _turned(tilts: xr.DataArray | np.ndarray) -> bool:
    """Return whether all tilts count as turned over."""
    return bool((np.abs(tilts - np.pi) < TURNED).all())
