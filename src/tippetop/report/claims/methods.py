"""Claims about numerical methods: accuracy, stiffness, and the listing itself."""

import numpy as np
import xarray as xr

from tippetop.report.claim import Chapter, Finding, Source
from tippetop.report.claims.end_state import likely_end
from tippetop.report.experiments.flights import MU
from tippetop.report.quoted import END_OF_FIG_5
from tippetop.report.tolerance import ARRIVED, PLOTTED, ROUNDING, TRANSCRIBED

CHAPTER = Chapter()


@CHAPTER.claim(
    "appendix-b-order",
    Source("Appendix B", equation="(B.1)"),
    "The method has an accuracy of order 5 in a single step (order of its error in the length of the step).",
    "5",
    needs=("order",),
    figure="order",
)
def _(order: xr.Dataset) -> Finding:
    return Finding(
        None,
        float(order["order_rk4_in_a_step"]),
        "On the top, whose equations do not depend on time, so that the slip in the last stage of (B.1) "
        f"does not matter, a step is of order {order['order_rk4_in_a_step']:.2f} and a whole run, in which "
        f"the errors of the steps add up, of order {order['order_rk4_in_all']:.2f}.",
    )


@CHAPTER.claim(
    "eq-b.1",
    Source("Appendix B", equation="(B.1)"),
    "The last stage of (B.1) is f(Y4, t_n) (order of such a step on an equation that depends on time).",
    "5",
    needs=("order",),
    figure="order",
    right="f(Y4, t_n + dt)",
)
def _(order: xr.Dataset) -> Finding:
    return Finding(
        None,
        float(order["order_printed_in_a_step"]),
        "Taken at t_n instead of t_n + dt, it makes a single step of order "
        f"{order['order_printed_in_a_step']:.2f} and a whole run of order "
        f"{order['order_printed_in_all']:.2f}; at t_n + dt they are of order "
        f"{order['order_printed_mended_in_a_step']:.2f} and {order['order_printed_mended_in_all']:.2f}. "
        "The equation meant is y' = f(t, y), not y = f(t, y); a step has four stages. "
        f"{TRANSCRIBED}",
    )


@CHAPTER.claim(
    "section-3-method",
    Source("3"),
    "The results are those of a 4-order Runge-Kutta method (order of the method used).",
    "4",
    needs=("order",),
    figure="order",
    right="ode45, which goes on with a formula of order 5",
)
def _(data: xr.Dataset) -> Finding:
    order = float(data["order_ode45_in_all"])
    return Finding(
        order,
        order,
        "The listing calls ode45, as Appendix B says too: a pair of formulas by Dormand and Prince, which "
        f"goes on with the one of order {order:.1f} and takes the one of order "
        f"{data['order_companion_in_all']:.1f} to choose its steps. (B.1) is used nowhere.",
        float(data["order_companion_in_all"]),
        "the formula that it measures its error by is meant",
    )


@CHAPTER.claim(
    "section-3-reliable",
    Source("3"),
    "The simulation is reliable (largest difference from the converged value of what is read off it, as a "
    "part of what its plots span).",
    "0",
    tolerance=PLOTTED,
    needs=("run-155", "run-50", "run-10", "run-90", "run-120", "run-175", "run-50-windows"),
    figure="fig04",
)
def _(*data: xr.Dataset) -> Finding:
    *runs, fast, windows = data
    misses = {_name(run): _misses(run) for run in runs}
    worst = np.max(list(misses.values()), axis=0)
    late = float(fast["zero_of_force_listing"] - fast["lift_off_time"])
    end = likely_end(windows)
    digits = max(abs(float(end[f"{key}_listing"] - end[key])) for key in END_OF_FIG_5)
    return Finding(
        None,
        float(worst.max()),
        "On the launches that stay on the table, over their ends and their arrivals: at most "
        + ", ".join(f"{100 * part:.2f} % in {what}" for what, part in zip(_READ_OFF, worst, strict=True))
        + f". Not every printed digit is right: the end of Fig. 5, at {end['window']:g} s, is off by up to "
        f"{digits:.4f} rad or rad/s. At 175 rad/s small errors grow: the force falls through zero "
        f"{late:.2f} s late.",
    )


_READ_OFF = ("the tilt", "phi'", "omega3", "time")


def _misses(run: xr.Dataset) -> tuple[float, ...]:
    """Differences of tilt, precession, spin and arrival from converged ones, in parts of their plots."""
    ends = {
        "theta": np.pi,
        "phi_dot": 2.0 * float(abs(run["phi_dot"]).max()),
        "omega3": float(np.ptp(run["omega3"].values)),
    }
    parts = [abs(float(run[f"end_{key}_listing"] - run[f"end_{key}"])) / span for key, span in ends.items()]
    window = float(run["time"][-1])
    return (*parts, abs(float(run["arrival_time_listing"][0] - run["arrives"])) / window)


def _name(run: xr.Dataset) -> str:
    return str(run.attrs["experiment"])


@CHAPTER.claim(
    "section-5-stiff",
    Source("5"),
    "There are cases in which the equations are stiff: ode45 is slow, and a method for stiff problems is "
    "not.",
    needs=("stiffness",),
    figure="stiffness",
)
def _(counts: xr.Dataset) -> Finding:
    return Finding(
        None,
        bool((counts["stiffness"] > _STIFF).any()),
        f"A launch counts as stiff if the best implicit method needs less than 1/{_STIFF:g} of the "
        "evaluations of the right-hand side that the best explicit one needs: methods of different orders "
        f"differ by less anyway (Jacobians counted, {counts.attrs['span_s']:g} s, the report's tolerances). "
        f"The ratio, by spin, tilt and mu: {_ratios(counts)}.",
    )


_STIFF = 2.0
"""By how much an implicit method must be the cheaper in a stiff case."""


def _ratios(counts: xr.Dataset) -> str:
    columns = (counts[name].values for name in ("launch_spin", "launch_tilt", "launch_mu", "stiffness"))
    return "; ".join(
        f"{spin:g} rad/s, {tilt:.5g} rad, {mu:g} s/m: {value:.1f}"
        for spin, tilt, mu, value in zip(*columns, strict=True)
    )


@CHAPTER.claim(
    "section-5-cause",
    Source("5"),
    "A bad initial condition is enough to make them stiff.",
    needs=("stiffness",),
    figure="stiffness",
    right="it takes large friction as well",
)
def _(counts: xr.Dataset) -> Finding:
    own = counts["launch_mu"].values == MU
    ratio = counts["stiffness"].values
    return Finding(
        None,
        bool((ratio[own] > _STIFF).any()),
        f"At mu = {MU:g} s/m none of {own.sum()} launches is stiff, fast or slow, lying or next to a pole: "
        f"the ratio is at most {ratio[own].max():.1f}. With more friction the launch does matter: the ratio "
        f"is {ratio[~own].min():.1f} to {ratio[~own].max():.1f}.",
    )


@CHAPTER.claim(
    "section-5-ode15s",
    Source("5"),
    "In the stiff cases ode15s gives a reliable solution (largest difference of its tilt from the converged "
    "one at the end).",
    "0 rad",
    tolerance=ARRIVED,
    needs=("stiffness",),
    figure="stiffness",
)
def _(counts: xr.Dataset) -> Finding:
    stiff = counts["stiffness"].values > _STIFF
    miss = counts["bdf_miss"].values
    rest = (counts["launch_mu"].values > MU) & ~stiff
    k = int(np.argmax(np.where(rest, miss, -1.0)))
    return Finding(
        None,
        float(miss[stiff].max(initial=0.0)),
        "By SciPy's BDF, which has ode15s's formulas and its way to vary the order, at the default "
        f"tolerances and after {counts.attrs['span_s']:g} s, where the launch is stiff. Where it is less "
        f"so, the top turns over and errors grow: at {counts['launch_spin'][k]:g} rad/s and mu = "
        f"{counts['launch_mu'][k]:g} s/m it is off by {miss[k]:.3f} rad.",
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
