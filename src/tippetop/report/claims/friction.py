"""Claims about friction: Fig. 7, Fig. 8, and what is said of other values of mu."""

import numpy as np
import xarray as xr

from tippetop.report.claim import ARRIVED, Chapter, Finding, Source, Tolerance

CHAPTER = Chapter()

_LOST = 0.1


@CHAPTER.claim(
    "fig07-exponent",
    Source("3.3", "Fig. 7"),
    "For mu from 0.2 to 1 the flip time goes as mu^-0.985.",
    "-0.985",
    needs=("flip-times", "flip-times-spins"),
    figure="fig07",
)
def _(times: xr.Dataset, others: xr.Dataset) -> Finding:
    exponents = np.append(others["exponent_listing"].values, float(times["exponent_listing"]))
    listed = ", ".join(
        f"{b:.3f} at {spin:g}" for spin, b in zip(others["spin"], others["exponent"], strict=True)
    )
    return Finding(
        float(times["exponent_listing"]),
        float(times["exponent"]),
        f"The report does not say at which spin; here {times.attrs['spin_rad_per_s']:g} rad/s, fitted as a "
        f"curve (a straight line through the logarithms has {times['exponent_of_logarithms']:.3f}; "
        f"correlation {times['correlation']:.4f}). Converged at other spins (rad/s): {listed}. The "
        "exponent depends on the spin and jumps where the last swings of the nutation cross the 0.01 rad of "
        "the definition.",
        (float(np.nanmin(exponents)), float(np.nanmax(exponents))),
        f"the spin, {others['spin'].min():g} to {others['spin'].max():g} rad/s",
    )


@CHAPTER.claim(
    "fig07-correlation",
    Source("3.3", "Fig. 7"),
    "Flip time and friction are strongly correlated on a power law (Pearson's r of the logarithms near -1).",
    "-1",
    tolerance=Tolerance(0.01, "near: within 0.01, since the value in the figure is not in the text"),
    needs=("flip-times",),
    figure="fig07",
)
def _(times: xr.Dataset) -> Finding:
    return Finding(
        float(times["correlation_listing"]),
        float(times["correlation"]),
        f"Fit: {times['factor']:.3f} s x (mu m/s)^{times['exponent']:.3f} converged, "
        f"{times['factor_listing']:.3f} s x (mu m/s)^{times['exponent_listing']:.3f} by the "
        "report's method.",
    )


@CHAPTER.claim(
    "summary-large-mu",
    Source("3.3", "summary, point 6"),
    "For mu beyond 1 s/m the relation t ~ 1/mu no longer holds.",
    needs=("flip-times-wide",),
    figure="fig07",
)
def _(wide: xr.Dataset) -> Finding:
    product = wide["mu_wide"] * wide["flip_time_wide"]
    law = product.sel(mu_wide=wide["mu_wide"] <= 0.1001).mean("mu_wide")
    off = abs(product / law - 1.0).transpose("spin_wide", "mu_wide")
    beyond = off.sel(mu_wide=wide["mu_wide"] > 1.0)
    first = [float(wide["mu_wide"][int(np.argmax(row > _LOST))]) for row in off.values]
    named = " and ".join(
        f"{mu:.2f} s/m at {spin:g} rad/s" for mu, spin in zip(first, wide["spin_wide"], strict=True)
    )
    return Finding(
        None,
        bool(float(beyond.max()) > _LOST),
        f"mu t departs by up to a factor {1 + float(beyond.max()):.1f} between 1 and 10 s/m. It is first off "
        f"by more than {100 * _LOST:.0f} % at {named}: the law is already lost below 1 s/m.",
    )


@CHAPTER.claim(
    "section-5-small-mu",
    Source("5"),
    "The dependence t ~ mu^-1 is true even for mu = 0.01 s/m (exponent over 0.01 to 0.1 s/m).",
    "-1",
    tolerance=Tolerance(0.005, "the precision of the exponent quoted for Fig. 7, half a per cent"),
    needs=("flip-times-wide",),
    figure="fig07",
)
def _(wide: xr.Dataset) -> Finding:
    exponents = wide["small_exponent"].values
    limits = ", ".join(
        f"{0.01 * float(t):.4f} s²/m at {spin:g} rad/s"
        for spin, t in zip(wide["spin_wide"], wide["flip_time_wide"].isel(mu_wide=0), strict=True)
    )
    worst = exponents[int(np.argmax(np.abs(exponents + 1.0)))]
    return Finding(
        None,
        float(worst),
        f"In runs long enough to see it, mu t at mu = 0.01 s/m is {limits}. There the law is "
        "the limit of weak friction, in which the top goes through a series of almost frictionless motions.",
    )


@CHAPTER.claim(
    "fig08-around-pi",
    Source("3.3", "Fig. 8"),
    "At mu = 100 s/m the top nutates around theta = pi (mean tilt over the second half of the run).",
    "pi rad",
    tolerance=ARRIVED,
    needs=("run-mu-100",),
    figure="fig08",
)
def _(run: xr.Dataset) -> Finding:
    ours = run["theta"].sel(time=slice(10.0, None))
    theirs = run["theta_listing"].sel(time_listing=slice(10.0, None))
    return Finding(
        float(theirs.mean()),
        float(ours.mean()),
        f"The spin of Fig. 8 is not given; at 155 rad/s the tilt swings between {ours.min():.3f} and "
        f"{ours.max():.3f} rad after 10 s: below pi, which it touches, not around it.",
    )


@CHAPTER.claim(
    "fig08-settles",
    Source("3.3", "Fig. 8"),
    "At mu = 100 s/m the top finally stops nutating (swing of the tilt in the last second).",
    "0 rad",
    tolerance=ARRIVED,
    needs=("run-mu-100", "settling-mu-100"),
    figure="fig08",
)
def _(run: xr.Dataset, later: xr.Dataset) -> Finding:
    swing = later["swing"]
    return Finding(
        float(np.ptp(run["theta_listing"].sel(time_listing=slice(19.0, None)).values)),
        float(swing[-1]),
        "Converged swings in the second before: "
        + ", ".join(f"{s:.4f} rad at {t:g} s" for t, s in zip(swing["end"], swing, strict=True))
        + ".",
    )


@CHAPTER.claim(
    "fig08-block",
    Source("3.3", "Fig. 8"),
    "At mu = 100 s/m a block started with 1 m/s travels only 0.001 m.",
    "0.001 m",
    needs=("block",),
    figure="fig08",
)
def _(block: xr.Dataset) -> Finding:
    distance = float(block["distance"])
    return Finding(None, distance, f"It comes to rest after {1e3 * distance:.3f} mm.")


@CHAPTER.claim(
    "table-1-mu-unit",
    Source("3", "Table 1"),
    "Table 1: the unit of mu is m/s (the value is the power of length in it).",
    "1",
    needs=("unit-of-mu",),
)
def _(check: xr.Dataset) -> Finding:
    misses = abs(check["theta_in_centimetres"] - check["theta_in_metres"])
    right = int(misses.idxmin("power"))
    return Finding(
        right,
        right,
        "A launch computed in centimetres must give the same tilt as in metres. With mu converted as s/m it "
        f"differs by {misses.sel(power=-1):.1e} rad after 2 s, as m/s by "
        f"{misses.sel(power=1):.1e} rad. Section 2.2 of the report has it right.",
    )
