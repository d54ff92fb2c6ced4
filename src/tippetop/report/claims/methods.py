"""Claims about numerical methods: accuracy, stiffness, and the listing itself."""

import numpy as np
import xarray as xr

from tippetop.report.claim import Finding, examines, listed
from tippetop.report.experiments.runs import likely_end
from tippetop.report.quoted import END_OF_FIG_5, MU, ROUGH_FRICTION
from tippetop.report.tolerance import PLOTTED, ROUNDING, TRANSCRIBED, Tolerance


@examines("appendix-b-order")
def _(order: xr.Dataset) -> Finding:
    return Finding.unlisted(
        float(order["order_rk4_in_a_step"]),
        "On the top, whose equations do not depend on time, so that the slip in the last stage of"
        f" (B.1) does not matter, a step is of order {order['order_rk4_in_a_step']:.2f} and a whole"
        f" run, in which the errors of the steps add up, of order {order['order_rk4_in_all']:.2f}.",
    )


@examines("eq-b.1")
def _(order: xr.Dataset) -> Finding:
    return Finding.unlisted(
        float(order["order_printed_in_a_step"]),
        "Taken at t_n instead of t_n + dt, it makes a single step of order"
        f" {order['order_printed_in_a_step']:.2f} and a whole run of order"
        f" {order['order_printed_in_all']:.2f}; at t_n + dt they are of order"
        f" {order['order_printed_mended_in_a_step']:.2f} and"
        f" {order['order_printed_mended_in_all']:.2f}. The equation meant is y' = f(t, y), not y ="
        f" f(t, y); a step has four stages. {TRANSCRIBED}",
    )


@examines("section-3-method")
def _(data: xr.Dataset) -> Finding:
    companion = float(data["order_companion_in_all"])
    return Finding(
        companion,
        companion,
        "Appendix B names ode45, and the listing calls it: a pair of formulas by Dormand and"
        f" Prince, which takes the one of order {companion:.1f} to choose its steps and goes on"
        f" with the one of order {data['order_ode45_in_all']:.1f}, after which one may name it as"
        " well. (B.1) is used nowhere.",
    )


@examines(
    "section-3-reliable",
    "run-155",
    "run-50",
    "run-10",
    "run-90",
    "run-120",
    "run-175",
    "run-50-windows",
    tolerance=PLOTTED,
)
def _(*data: xr.Dataset) -> Finding:
    *runs, fast, windows = data
    misses = {_name(run): _misses(run) for run in runs}
    worst = np.max(list(misses.values()), axis=0)
    late = float(fast["zero_of_force_listing"] - fast["lift_off_time"])
    end = likely_end(windows)
    digits = max(
        abs(float(end[f"{key}_after_listing"] - end[f"{key}_after"])) for key in END_OF_FIG_5
    )
    return Finding.unlisted(
        float(worst.max()),
        "On the launches that stay on the table, over their ends and their arrivals: at most"
        f" {listed('{:.2f} % in {}', 100 * worst, _READ_OFF)}. Not every printed digit is right:"
        f" the end of Fig. 5, at {end['window']:g} s, is off by up to {digits:.4f} rad or rad/s. At"
        f" 175 rad/s small errors grow: the force falls through zero {late:.2f} s late.",
    )


_READ_OFF = ("the tilt", "phi'", "omega3", "time")


def _misses(run: xr.Dataset) -> tuple[float, ...]:
    """Return differences of tilt, precession, spin and arrival from converged ones, in parts of
    their plots.
    """
    spans = (np.pi, 2.0 * float(abs(run["phi_dot"]).max()), float(np.ptp(run["omega3"].values)))
    ends = zip(("end_theta", "end_phi_dot", "end_omega3"), spans, strict=True)
    parts = [abs(float(run[f"{end}_listing"] - run[end])) / span for end, span in ends]
    window = float(run["time"][-1])
    return (*parts, abs(float(run["arrival_time_listing"][0] - run["arrives"])) / window)


def _name(run: xr.Dataset) -> str:
    return str(run.attrs["experiment"])


@examines("section-5-stiff")
def _(counts: xr.Dataset) -> Finding:
    columns = (
        counts[name].values for name in ("launch_spin", "launch_tilt", "launch_mu", "stiffness")
    )
    ratios = listed("{:g} rad/s, {:.5g} rad, {:g} s/m: {:.1f}", *columns, between="; ")
    return Finding.unlisted(
        bool((counts["stiffness"] > _STIFF).any()),
        f"A launch counts as stiff if the best implicit method needs less than 1/{_STIFF:g} of the"
        " evaluations of the right-hand side that the best explicit one needs: methods of"
        f" different orders differ by less anyway (Jacobians counted, {counts.attrs['span_s']:g} s,"
        f" the report's tolerances). The ratio, by spin, tilt and mu: {ratios}.",
    )


_STIFF = 2.0
"""By how much an implicit method must be the cheaper in a stiff case."""


@examines("section-5-cause")
def _(counts: xr.Dataset) -> Finding:
    friction, stiff = counts["launch_mu"].values, counts["stiffness"].values > _STIFF
    decided = [
        mu for mu in np.unique(friction) if 0 < stiff[friction == mu].sum() < (friction == mu).sum()
    ]
    named = " and ".join(f"{mu:g} s/m" for mu in decided)
    own, ratio = friction == MU, counts["stiffness"].values
    tried = "none is stiff" if not stiff[own].any() else f"{stiff[own].sum()} are stiff"
    return Finding.unlisted(
        bool(decided),
        f"It does so at mu = {named or 'none tried'}. What the report does not say is that friction"
        f" takes part: of {own.sum()} launches at mu = {MU:g} s/m, fast or slow, lying or next to a"
        f" pole, {tried}, with a ratio of at most {ratio[own].max():.1f}.",
    )


@examines(
    "section-5-ode15s",
    tolerance=Tolerance(
        PLOTTED.value * np.pi, "1 % of pi: what a plot can show, as where ode45 is judged"
    ),
)
def _(counts: xr.Dataset) -> Finding:
    rough = counts.isel(launch=counts["launch_mu"].values == ROUGH_FRICTION)
    columns = (rough[name].values for name in ("bdf_miss", "launch_spin", "stiffness"))
    misses = listed("{:.4f} rad at {:g} rad/s (ratio {:.1f})", *columns, between=" and ")
    return Finding.unlisted(
        float(rough["bdf_miss"].max()),
        "The report does not name its cases. These are its friction of Fig. 8, at which implicit"
        f" methods need fewer evaluations; after {counts.attrs['span_s']:g} s the difference is"
        f" {misses}. By SciPy's BDF, which has ode15s's formulas and its way to vary the order, at"
        " the default tolerances. Where the top turns over, errors grow; tighter tolerances are"
        " the cure.",
        right=f"at default tolerances it is off by {misses}",
    )


@examines(
    "listing-theta-mod-pi", "theta-mod-pi", "run-mu-100", "run-155", "run-175", tolerance=ROUNDING
)
def _(check: xr.Dataset, *runs: xr.Dataset) -> Finding:
    size = float(check["size"])
    theirs = float(check["jump_listing"]) / size
    tilts = {_name(run): run["theta_integrated_listing"] for run in runs}
    wraps = {name: int(((tilt < 0) | (tilt > np.pi)).sum()) for name, tilt in tilts.items()}
    outside = listed("{} in {}", wraps.values(), wraps)
    return Finding(
        theirs,
        theirs,
        "Where theta passes a multiple of pi the listing takes a leaning top for one that is"
        " nearly the other way up. Without the modulo the change is"
        f" {float(check['jump']) / size:.0e}. It does harm only if a step carries theta across;"
        f" points of output outside 0 to pi, in the {len(wraps)} runs looked at: {outside}.",
        right=(
            "it does not where theta passes a multiple of pi: a leaning top is taken for one nearly"
            " the other way up"
        )
        + ("" if any(wraps.values()) else f", though in none of {len(wraps)} runs"),
    )
