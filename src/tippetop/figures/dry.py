"""Figures of dry friction: what rolling needs, time-stepping, regularisation, contact patches."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

import tippetop.figures.annotation as mark
from tippetop.figures.style import ACCENT, CONVERGED, CYCLE, DASHED, FAINT, INK, MUTED, REPORT


@mark.drawn(5.6, 2, 1, height_ratios=[1.25, 1])
def rolling_figure(above: Axes, below: Axes, data: xr.Dataset) -> None:
    """Draw the least friction for rolling against spin, and the tilt above and below that
    friction.
    """
    for tilt, row in zip(data["tilt"], data["friction_needed"], strict=True):
        main = float(tilt) == data.attrs["tilt_rad"]
        above.plot(data["spin"], row, color=CONVERGED if main else MUTED)
        end = (float(data["spin"][-1]), float(row[-1]))
        mark.note(above, f"tilt {float(tilt):g}", end, (4, 0), CONVERGED if main else INK)
    needed, spin = float(data["needed_main"]), data.attrs["spin_rad_per_s"]
    above.plot(spin, needed, "o", color=ACCENT)
    mark.note(above, f"{needed:.4f}", (spin, needed), (0, -6), ACCENT)
    above.set_yscale("log")
    mark.plain_ticks(above.yaxis, (0.01, 0.02, 0.05, 0.1, 0.2))
    right = 1.12 * float(data["spin"][-1])
    above.set(xlabel="spin at launch (rad/s)", ylabel=r"least $\mu$ for rolling", xlim=(0, right))
    name = rf"$\mu$ = {data.attrs['slippery_mu']:g}"
    below.plot(data["time_slips"], data["tilt_slips"], color=REPORT, label=name)
    rolls = data.isel(held=0)
    name = rf"$\mu$ = {float(rolls['held']):.4f}"
    below.plot(rolls["time"], rolls["tilt_held"], color=CONVERGED, label=name)
    below.set(xlabel="time (s)", ylabel=mark.TILT, xlim=(0, float(data["time_slips"][-1])))
    below.set_ylim(0, 1.25 * max(float(data["tilt_slips"].max()), data.attrs["tilt_rad"]))
    below.legend(loc="upper left", ncols=2)


@mark.drawn(4.4)
def cohen_figure(axes: Axes, data: xr.Dataset) -> None:
    """Draw the tilt of Cohen's top by time-stepping with several steps, and exactly."""
    colors = (REPORT, *(CYCLE[k] for k in (3, 4, 2, 6, 5)))
    for step, tilt, color in zip(data["step"], data["tilt_stepped"], colors, strict=False):
        axes.plot(data["time"], tilt, color=color, lw=1.1, label=f"{1e3 * float(step):g} ms")
    axes.plot(data["time"], data["tilt"], color=CONVERGED, lw=2.2, label="exact")
    axes.set(xlabel="time (s)", xlim=(0, float(data["time"][-1])))
    mark.tilt_axis(axes, -0.05)
    mark.legend_above(axes, 7)


@mark.drawn(3.8)
def smoothed_figure(axes: Axes, data: xr.Dataset) -> None:
    """Draw the time of turning over on regularised Coulomb friction against the velocity scale."""
    eps, time = data["eps"].values, data["turning_time"].values
    axes.loglog(eps, time, "o-", color=CONVERGED)
    line = time[-1] * eps[-1] / eps
    near = line > 0.6 * time.min()
    axes.loglog(eps[near], line[near], color=MUTED, ls=DASHED)
    mark.note(axes, r"as $1/\varepsilon$", (eps[near][0], line[near][0]), (6, 0), INK)
    mark.plain_ticks(axes.yaxis, [tick for tick in (1, 2, 5, 10, 20) if tick < 1.6 * time.max()])
    axes.set(xlabel=r"$\varepsilon$ (m/s)", ylabel="turns over after (s)")


@mark.drawn(4.2)
def patch_figure(axes: Axes, data: xr.Dataset) -> None:
    """Draw the time of turning over against patch radius and spin; grey where the top does not
    turn.
    """
    axes.set_facecolor(FAINT)
    axes.grid(visible=False)
    times = np.ma.masked_invalid(data["turning_time"].values.T)
    image = axes.pcolormesh(
        1e3 * data["radius"], data["spin"], times, shading="nearest", rasterized=True
    )
    axes.set_xscale("log")
    mark.plain_ticks(axes.xaxis, (0.1, 0.2, 0.5, 1, 2, 5))
    axes.axhline(float(data["upright_limit"]), color=ACCENT, ls=DASHED, lw=1.2)
    axes.set(xlabel="radius of the contact patch (mm)", ylabel="spin at launch (rad/s)")
    bar = axes.figure.colorbar(image, pad=0.02, label="turns over after (s)")
    bar.outline.set_visible(False)


@mark.drawn(5.2, 2, 1, sharex=True, height_ratios=[1.4, 1])
def viscous_figure(above: Axes, below: Axes, data: xr.Dataset) -> None:
    """Draw times of turning over on patches and on viscous friction of the same small-slip
    coefficient.
    """
    coefficient = data["coefficient"].values
    above.loglog(coefficient, data["viscous_time"], "--", color=INK, label="viscous")
    below.axhline(1.0, color=INK, ls="--")
    for mu, times, color in zip(
        data["mu"], data["patch_time"], (CYCLE[2], CONVERGED, ACCENT), strict=True
    ):
        above.loglog(coefficient, times, "o-", color=color, label=rf"patch, $\mu$ = {float(mu):g}")
        below.semilogx(coefficient, times / data["viscous_time"], "o-", color=color)
    mark.plain_ticks(above.yaxis, (1, 2, 3))
    mark.plain_ticks(below.xaxis, (1, 2, 5, 10, 20, 40))
    above.set_ylabel("turns over after (s)")
    below.set(xlabel="viscous coefficient at launch (s/m)", ylabel="patch / viscous")
    mark.legend_above(above, 4)
