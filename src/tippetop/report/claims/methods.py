"""Claims about numerical methods: accuracy, stiffness, and the listing itself."""

import numpy as np
import xarray as xr

from tippetop.report.claim import Finding, examines, listed
from tippetop.report.experiments.runs import likely_end
from tippetop.report.printed_numbers import END_OF_FIG_5, MU, ROUGH_FRICTION
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
        f" Prince, of which the one of order {companion:.1f} controls the step and the one of order"
        f" {data['order_ode45_in_all']:.1f} gives the solution; the method is often named after"
        " the second. (B.1) is not used.",
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
        "In the ends and the arrivals of the launches that stay on the table it is at most"
        f" {listed('{:.2f} % in {}', 100 * worst, _READ_OFF)}. Not every printed digit is right:"
        f" the end of Fig. 5, at {end['window']:g} s, is off by up to {digits:.4f} rad or rad/s. At"
        f" 175 rad/s small errors grow: the force falls through zero {late:.2f} s late.",
    )


_READ_OFF = ("the tilt", "phi'", "omega3", "time")
"""Names of the values of `_misses`."""


def _misses(run: xr.Dataset) -> tuple[float, ...]:
    """Return the errors of final tilt, precession, spin and of arrival, as shares of their
    plots.
    """
    spans = (np.pi, 2.0 * float(abs(run["precession"]).max()), float(np.ptp(run["spin"].values)))
    ends = zip(("end_tilt", "end_precession", "end_spin"), spans, strict=True)
    parts = [abs(float(run[f"{end}_listing"] - run[end])) / span for end, span in ends]
    window = float(run["time"][-1])
    return (*parts, abs(float(run["arrivals_listing"][0] - run["arrival_time"])) / window)


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
"""Ratio of evaluations, best explicit over best implicit method, above which a launch is stiff."""


@examines("section-5-cause")
def _(counts: xr.Dataset) -> Finding:
    friction, stiff = counts["launch_mu"].values, counts["stiffness"].values > _STIFF
    decided = [
        mu for mu in np.unique(friction) if 0 < stiff[friction == mu].sum() < (friction == mu).sum()
    ]
    named = " and ".join(f"{mu:g} s/m" for mu in decided)
    usual, ratio = friction == MU, counts["stiffness"].values
    tried = "none is stiff" if not stiff[usual].any() else f"{stiff[usual].sum()} are stiff"
    return Finding.unlisted(
        bool(decided),
        f"The launch decides at mu = {named or 'none tried'}. The report does not mention that"
        f" friction matters too: of {usual.sum()} launches at mu = {MU:g} s/m, fast or slow, lying"
        f" or next to a pole, {tried}, with a ratio of at most {ratio[usual].max():.1f}.",
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
        "The report does not state its cases. Those tried have its friction of Fig. 8, at which"
        f" implicit methods need fewer evaluations; after {counts.attrs['span_s']:g} s the"
        f" difference is {misses}, by SciPy's BDF, which has the formulas and the order control of"
        " ode15s, at the default tolerances. Where the top turns over, errors grow; tighter"
        " tolerances reduce them.",
        right=f"at default tolerances it is off by {misses}",
    )


@examines(
    "listing-theta-mod-pi", "theta-mod-pi", "run-mu-100", "run-155", "run-175", tolerance=ROUNDING
)
def _(check: xr.Dataset, *runs: xr.Dataset) -> Finding:
    size = float(check["size"])
    theirs = float(check["jump_listing"]) / size
    tilts = {_name(run): run["tilt_integrated_listing"] for run in runs}
    wraps = {name: int(((tilt < 0) | (tilt > np.pi)).sum()) for name, tilt in tilts.items()}
    outside = listed("{} in {}", wraps.values(), wraps)
    return Finding(
        theirs,
        theirs,
        "Where theta passes a multiple of pi, the listing replaces an upright top by an inverted"
        " one, and the rates jump. Without the modulo the change is"
        f" {float(check['jump']) / size:.0e}. The jump matters only if a step carries theta across"
        f" the pole; points of output outside 0 to pi, in {len(wraps)} runs: {outside}.",
        right=(
            "it does not where theta passes a multiple of pi: an upright top is replaced by an"
            " inverted one"
        )
        + ("" if any(wraps.values()) else f", though in none of {len(wraps)} runs"),
    )
