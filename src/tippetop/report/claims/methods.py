"""Claims about numerical methods: accuracy, stiffness, and the listing itself."""

import numpy as np
import xarray as xr

from tippetop.report.claim import ROUNDING, Chapter, Finding, Source

CHAPTER = Chapter()


@CHAPTER.claim(
    "appendix-b-order",
    Source("Appendix B", equation="(B.1)"),
    "The classical Runge-Kutta method has an accuracy of order (dt)^5.",
    "5",
    needs=("order",),
    figure="order",
)
def _(order: xr.Dataset) -> Finding:
    step, whole = float(order["order_rk4_in_a_step"]), float(order["order_rk4_in_all"])
    return Finding(
        None,
        step,
        f"True of a single step, as measured ({step:.2f}). Over a given time the errors of the steps add up, "
        f"and the order is {whole:.2f}.",
    )


@CHAPTER.claim(
    "section-3-method",
    Source("3"),
    "The results are those of a 4-order Runge-Kutta method (order of the method used).",
    "4",
    needs=("order",),
    figure="order",
)
def _(data: xr.Dataset) -> Finding:
    order = float(data["order_ode45_in_all"])
    return Finding(
        order,
        order,
        "The listing calls ode45, which goes on with the fifth-order formula of Dormand and Prince in steps "
        "of its own choice; the method of Appendix B is used nowhere.",
    )


@CHAPTER.claim(
    "section-3-reliable",
    Source("3"),
    "The simulation is reliable (first zero of the normal force at 175 rad/s, within 1 % of its time).",
    needs=("run-175",),
    figure="fig12",
)
def _(run: xr.Dataset) -> Finding:
    ours = float(run["lift_off_time"])
    theirs = {"ode45": float(run["zero_of_force_listing"]), "SciPy's RK45": float(run["zero_of_force_scipy"])}
    good = all(abs(time / ours - 1.0) < 0.01 for time in theirs.values())
    listed = ", ".join(f"{time:.3f} s with {name}" for name, time in theirs.items())
    return Finding(
        None,
        good,
        f"At a relative tolerance of 1e-3 and an absolute one of 1e-6: {listed}; converged {ours:.6f} s. The "
        "two have formula and tolerances in common and differ only in how they weigh the error.",
    )


@CHAPTER.claim(
    "section-5-stiff",
    Source("5"),
    "Some launches are stiff: ode45 is slow on them and a method for stiff problems is not.",
    needs=("stiffness",),
    figure="stiffness",
)
def _(counts: xr.Dataset) -> Finding:
    ratio = counts["stiffness"].values
    listed = "; ".join(
        f"{spin:g} rad/s, mu = {mu:g} s/m: {value:.1f}"
        for spin, mu, value in zip(counts["launch_spin"], counts["launch_mu"], ratio, strict=True)
    )
    k = int(np.nanargmax(ratio))
    return Finding(
        None,
        bool(np.nanmax(ratio) > 2.0),
        "Evaluations of the right-hand side by the best explicit over the best implicit method (Jacobians "
        f"counted, {counts.attrs['span_s']:g} s, the report's tolerances): {listed}. What makes a launch "
        f"stiff is friction: the worst has mu = {counts['launch_mu'][k]:g} s/m. At mu = 0.3 s/m an "
        "explicit method is the cheaper.",
    )


@CHAPTER.claim(
    "listing-theta-mod-pi",
    Source("Appendix A.1, function tip, line 22"),
    "Replacing theta by theta modulo pi leaves the equations as they are (jump of the rate of v_y at the "
    "pole, as a part of that rate).",
    "0",
    tolerance=ROUNDING,
    needs=("theta-mod-pi", "run-mu-100", "run-155", "run-175"),
)
def _(check: xr.Dataset, *runs: xr.Dataset) -> Finding:
    size = float(check["size"])
    theirs = float(check["jump_listing"]) / size
    tilts = {run.attrs["experiment"]: run["theta_integrated_listing"] for run in runs}
    wraps = {name: int(((tilt < 0) | (tilt > np.pi)).sum()) for name, tilt in tilts.items()}
    outside = ", ".join(f"{count} in {name}" for name, count in wraps.items())
    return Finding(
        theirs,
        theirs,
        "Where theta passes a multiple of pi the listing takes a leaning top for one that is nearly the "
        f"other way up. Without the modulo the change is {float(check['jump']) / size:.0e}. It does harm "
        f"only if a step carries theta across; points of output outside 0 to pi: {outside}.",
    )
