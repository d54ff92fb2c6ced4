"""Figures of numerical methods: their orders, and their cost for stiff launches."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

import tippetop.figures.annotation as mark
from tippetop.figures.style import ACCENT, CONVERGED, CYCLE, REPORT, UNILATERAL

_LABELS = {
    "ode45": "ode45 (explicit)",
    "dop853": "DOP853 (explicit)",
    "radau": "Radau (implicit)",
    "bdf": "BDF (implicit)",
    "lsoda": "LSODA (switches)",
}


@mark.drawn(3.4)
def order_figure(axes: Axes, errors: xr.Dataset) -> None:
    """Draw errors against step length, over a fixed time and in one step."""
    series = (
        ("printed_in_all", "(B.1) as printed, time in f", ACCENT, "^-"),
        ("printed_mended_in_all", "(B.1) mended, time in f", UNILATERAL, "v-"),
        ("rk4_in_all", "Appendix B, the top", CONVERGED, "o-"),
        ("rk4_in_a_step", "Appendix B, one step", CONVERGED, "o--"),
        ("ode45_in_all", "the formula of ode45", REPORT, "s-"),
    )
    for name, label, color, marker in series:
        values, order = errors[name], float(errors[f"order_{name}"])
        named = f"{label}: order {order:.2f}"
        axes.loglog(1e3 * errors[values.dims[0]], values, marker, color=color, label=named)
    axes.set(xlabel="length of a step (ms)", ylabel="error (rad; of a value near 1)")
    mark.plain_ticks(axes.xaxis, [0.25, 1, 5, 25, 100])
    mark.legend_above(axes, 2)


@mark.drawn(3.7)
def stiffness_figure(axes: Axes, counts: xr.Dataset) -> None:
    """Draw the number of evaluations of the right-hand side by every method, for each launch."""
    methods = [str(name) for name in counts["integrator"].values]
    launches = np.arange(counts.sizes["launch"])
    width = 0.8 / len(methods)
    colors = (REPORT, CYCLE[6], CONVERGED, CYCLE[4], CYCLE[2])
    for k, (method, color) in enumerate(zip(methods, colors, strict=True)):
        height = counts["evaluations"].sel(integrator=method).values / 1e3
        place = launches + (k - (len(methods) - 1) / 2) * width
        axes.bar(
            place,
            np.maximum(height, 0),
            0.9 * width,
            color=color,
            label=_LABELS.get(method, method),
        )
        for x in place[height < 0]:
            axes.annotate("gave up", (x, 0), rotation=90, size=8, color=ACCENT, ha="center")
    names = [
        f"{spin:g} rad/s\n{tilt:.5g} rad\n$\\mu$ = {mu:g} s/m"
        for spin, tilt, mu in zip(
            *(counts[f"launch_{name}"].values for name in ("spin", "tilt", "mu")), strict=True
        )
    ]
    axes.set_xticks(launches, names)
    axes.tick_params(axis="x", length=0, labelsize=8)
    axes.grid(visible=False, axis="x")
    axes.set_ylabel("evaluations (thousands)")
    axes.legend(loc="upper left")
