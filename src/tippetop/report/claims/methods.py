"""Claims about numerical methods: accuracy, stiffness, and the listing itself."""

import numpy as np
import xarray as xr

from tippetop.report.claim import ROUNDING, Chapter, Finding, Source, Tolerance
from tippetop.report.experiments.flights import MU

CHAPTER = Chapter()


@CHAPTER.claim(
    "appendix-b-order",
    Source("Appendix B", equation="(B.1)"),
    "The method (B.1) has an accuracy of order (dt)^5.",
    "5",
    needs=("order",),
    figure="order",
    right="f(Y4, t_n + dt) at the end; then a step is of order 5, a run of order 4",
)
def _(order: xr.Dataset) -> Finding:
    return Finding(
        None,
        float(order["order_printed_in_a_step"]),
        "As printed, (B.1) takes its last stage at t_n instead of t_n + dt: on an equation that depends on "
        f"time a single step is of order {order['order_printed_in_a_step']:.2f}, and a whole run of order "
        f"{order['order_printed_in_all']:.2f}. With t_n + dt a run is of order "
        f"{order['order_printed_mended_in_all']:.2f}; on the top, whose equations do not depend on time, a "
        f"step has order {order['order_rk4_in_a_step']:.2f} and a run {order['order_rk4_in_all']:.2f}, since "
        "the errors of the steps add up.",
    )


@CHAPTER.claim(
    "section-3-method",
    Source("3"),
    "The results are those of a 4-order Runge-Kutta method (order of the method used).",
    "4",
    needs=("order",),
    figure="order",
    right="ode45, of order 5, at a relative tolerance of 1e-3",
)
def _(data: xr.Dataset) -> Finding:
    order = float(data["order_ode45_in_all"])
    return Finding(
        order,
        order,
        "The listing calls ode45, as Appendix B says too; it goes on with the fifth-order formula of Dormand "
        "and Prince in steps of its own choice. (B.1) is used nowhere.",
    )


@CHAPTER.claim(
    "section-3-reliable",
    Source("3"),
    "The simulation is reliable (largest difference of what it gives from the converged value, in units of "
    "half the last digit that the report prints).",
    "0",
    tolerance=Tolerance(1.0, "then every printed digit is right: 0.05 s in times, 0.0005 rad in tilts"),
    needs=("run-155", "run-50", "run-10", "run-90", "run-120"),
    figure="fig04",
)
def _(*runs: xr.Dataset) -> Finding:
    times = {_name(run): abs(float(run["arrival_time_listing"][0] - run["arrival_time"][0])) for run in runs}
    tilts = {_name(run): abs(float(run["end_theta_listing"] - run["end_theta"])) for run in runs}
    # The report prints a time of turning over for the first two launches only.
    timed = [times[_name(run)] for run in runs[:2]]
    listed = ", ".join(f"{name} {times[name]:.3f} s and {tilts[name]:.0e} rad" for name in times)
    return Finding(
        None,
        max(max(timed) / 0.05, max(tilts.values()) / 0.0005),
        f"On the launches that stay on the table, times of arrival and final tilts differ by: {listed}. A "
        "tolerance of 1e-3 is good enough for what is printed of them. It is not where the table would have "
        "to pull: small errors grow there, and the lift-off at 175 rad/s comes late.",
    )


def _name(run: xr.Dataset) -> str:
    return str(run.attrs["experiment"])


@CHAPTER.claim(
    "section-5-stiff",
    Source("5"),
    "In some bad initial condition the equations are stiff: ode45 is slow, and a method for stiff problems "
    "is not.",
    needs=("stiffness",),
    figure="stiffness",
    right="large friction makes them stiff, no initial condition does",
)
def _(counts: xr.Dataset) -> Finding:
    own = counts["launch_mu"].values == MU
    ratio = counts["stiffness"].values
    words = [
        f"{spin:g} rad/s, {tilt:g} rad, {mu:g} s/m: {value:.1f}"
        for spin, tilt, mu, value in zip(
            counts["launch_spin"], counts["launch_tilt"], counts["launch_mu"], ratio, strict=True
        )
    ]
    return Finding(
        None,
        bool((ratio[own] > 1.0).any()),
        "A launch is stiff if an implicit method is the cheaper: evaluations of the right-hand side by the "
        f"best explicit over the best implicit one (Jacobians counted, {counts.attrs['span_s']:g} s, the "
        f"report's tolerances), by spin, tilt and mu: {'; '.join(words)}. The initial condition does not do "
        "it; friction does.",
    )


@CHAPTER.claim(
    "listing-theta-mod-pi",
    Source("Appendix A.1, function tip, line 22"),
    "Replacing theta by theta modulo pi leaves the equations as they are (jump of the rate of v_y at the "
    "pole, as a part of that rate).",
    "0",
    tolerance=ROUNDING,
    implied=True,
    needs=("theta-mod-pi", "run-mu-100", "run-155", "run-175"),
    right="no modulo",
)
def _(check: xr.Dataset, *runs: xr.Dataset) -> Finding:
    size = float(check["size"])
    theirs = float(check["jump_listing"]) / size
    tilts = {_name(run): run["theta_integrated_listing"] for run in runs}
    wraps = {name: int(((tilt < 0) | (tilt > np.pi)).sum()) for name, tilt in tilts.items()}
    outside = ", ".join(f"{count} in {name}" for name, count in wraps.items())
    return Finding(
        theirs,
        theirs,
        "Where theta passes a multiple of pi the listing takes a leaning top for one that is nearly the "
        f"other way up. Without the modulo the change is {float(check['jump']) / size:.0e}. It does harm "
        f"only if a step carries theta across; points of output outside 0 to pi: {outside}.",
    )
