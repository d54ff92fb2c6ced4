"""Why things are as the report finds them: its statements against steady states and the slow flow."""

import numpy as np
import xarray as xr

from tippetop.report.claim import Chapter, Finding, Source, Tolerance
from tippetop.report.experiments.theory import QUOTED_SPINS, VISIBLE
from tippetop.report.experiments.theory_runs import SPIN
from tippetop.report.quoted import CRITICAL_SPINS
from tippetop.report.readings import SETTLED

CHAPTER = Chapter()

_AGREED = 1e-9
_NEAR_LIMIT = 1e-3
_TENTH = 0.1
_NORMAL = (0.2, 1.0)


def _critical(symbol: str, name: str, printed: str, loses: str, far_off: str) -> None:
    @CHAPTER.claim(
        f"why-{symbol}",
        Source("3.2", "Fig. 6"),
        f"The critical point is omega_{symbol} = {printed} rad/s, the spin at which stability changes.",
        f"{printed} rad/s",
        needs=("why-critical", "critical-spins"),
        figure="why-growth",
    )
    def _(theory: xr.Dataset, sweep: xr.Dataset) -> Finding:
        runs = sweep.isel(window=-1)
        exact = theory.sel(vertical=name)
        seen = theory[f"apparent_{name}"].values
        limit = float(exact["critical_launch"])
        return Finding(
            None,
            limit,
            f"There {loses}, at {exact['critical_formula']:.4f} rad/s of vertical spin, by formula "
            f"and from the spectrum of the linear motion; runs of {runs['window']:g} s put it at "
            f"{runs[f'{name}_by_window']:.2f} rad/s. Nearby the growth rate is so small that "
            f"{theory.attrs['apparent_window_s']:g} s do not suffice: {far_off}",
            (float(seen.min()), float(seen.max())),
            f"the least tilt told from none, {VISIBLE[0]:g} to {VISIBLE[-1]:g} rad, by growth rates alone",
        )


_critical(
    "c1",
    "upright",
    CRITICAL_SPINS[0],
    "the upright spin loses its stability",
    "below it the launch tilt has not died away yet.",
)
_critical(
    "c2",
    "inverted",
    CRITICAL_SPINS[1],
    "the inverted spin gains stability",
    "above it the last distance to pi has not died away yet.",
)


@CHAPTER.claim(
    "why-stability",
    Source("1", "question 3"),
    "The stability of the solution can be discussed (largest relative difference between critical spins "
    "from the energy and from the linear motion).",
    "0",
    tolerance=Tolerance(_AGREED, "two computations of the same number in double precision"),
    needs=("why-critical",),
    figure="why-growth",
)
def _(theory: xr.Dataset) -> Finding:
    listed = " and ".join(f"{value:.6f}" for value in theory["critical_formula"])
    return Finding(
        None,
        _spectral_miss(theory),
        f"The vertical spins change stability at {listed} rad/s. The formula takes the limit of the steady "
        "precessions at the pole; the spectrum is that of the equations of motion, differentiated.",
    )


@CHAPTER.claim(
    "why-final-tilt",
    Source("2.3"),
    "After a long time the top spins steadily and loses no energy (largest difference between the tilt "
    "of a long run and the steady state of the same lambda).",
    "0 rad",
    tolerance=Tolerance(1e-6, "far below what the report's figures can show"),
    needs=("why-bifurcation",),
    figure="why-bifurcation",
)
def _(states: xr.Dataset) -> Finding:
    quoted = [states.isel(run=int(np.argmin(abs(states["run_spin"].values - s)))) for s in QUOTED_SPINS]
    listed = "; ".join(
        f"{one['run_spin']:g} rad/s: {one['run_predicted']:.6f} rad "
        f"({abs(one['run_end'] - one['run_predicted']):.0e} off)"
        for one in quoted
    )
    return Finding(
        None,
        _tilt_miss(states),
        "Friction leaves Jellett's integral lambda alone, and only one stable steady state has the lambda of "
        f"the launch. Predicted from lambda, against runs of {states.attrs['long_run_s']:g} s: {listed}.",
    )


@CHAPTER.claim(
    "why-regimes",
    Source("3.3", "summary, points 1 to 3"),
    "Below omega_c1 the top ends upright, between omega_c1 and omega_c2 at a constant tilt, above "
    "omega_c2 inverted.",
    needs=("why-bifurcation", "why-groups"),
    figure="why-bifurcation",
)
def _(states: xr.Dataset, chart: xr.Dataset) -> Finding:
    upright, inverted = (float(limit) for limit in states["limits"])
    spin, end = states["run_spin"].values, states["run_end"].values
    expected_upright, expected_inverted = spin < upright, spin > inverted
    as_said = (
        np.array_equal(end < SETTLED, expected_upright)
        and np.array_equal(np.pi - end < SETTLED, expected_inverted)
        and bool((states["run_stable"] == 1).all())
    )
    both = int((states["run_stable_jump"] == 2).sum())
    group = str(chart["top_group"].values[0])
    return Finding(
        None,
        as_said,
        f"With {upright:.2f} and {inverted:.2f} rad/s for the critical spins. It is so because this top is "
        f"in group {group}: at every spin one steady state is stable. A top with I1 / I3 = "
        f"{states.attrs['inertia_ratio_jump']:g} has two at {both} of {states.sizes['run_jump']} launches, "
        "and its launch decides between them.",
    )


@CHAPTER.claim(
    "why-flip-law",
    Source("5"),
    "A more fundamental rule guarantees that the flip time goes as 1/mu.",
    needs=("why-exponent",),
    figure="why-collapse",
)
def _(times: xr.Dataset) -> Finding:
    misses = _law_misses(times)
    return Finding(
        None,
        max(misses) < _NEAR_LIMIT,
        "Weak friction acts on a nutation that it hardly disturbs: averaged over one, its torque and power "
        "are proportional to mu, so that mu t is the only time there is. The averaged flow has mu t_flip = "
        f"{times['limit_arrival']:.4f} s²/m at {times.attrs['spin_rad_per_s']:g} rad/s without one "
        f"full run; runs at mu = {times['mu_flip'][0]:g} s/m differ from it by {misses[0]:.1e} of it, "
        f"and by {misses[1]:.1e} in the time to pi/2. The rule is one for small mu and says nothing of mu "
        "near 1 s/m.",
    )


@CHAPTER.claim(
    "why-flip-exponent",
    Source("5"),
    "The flip time goes as mu^-1 (local exponent at the least mu).",
    "-1",
    tolerance=Tolerance(0.001, "a fifth of the precision of the exponent quoted for Fig. 7"),
    needs=("why-exponent",),
    figure="why-exponent",
)
def _(times: xr.Dataset) -> Finding:
    some = times.sel(mu_flip=[0.1, 0.3, 1.0, 3.0], method="nearest")
    listed = ", ".join(
        f"{exponent:.3f} at {mu:.2g}"
        for mu, exponent in zip(some["mu_flip"], some["exponent_crossing_time"], strict=True)
    )
    return Finding(
        None,
        float(times["exponent_arrival_time_end"][0]),
        f"At mu = {times['mu_flip'][0]:g} s/m. The exponent of the time to the first tilt of more "
        f"than pi/2 leaves -1 as mu grows (s/m): {listed}.",
    )


@CHAPTER.claim(
    "why-flip-definition",
    Source("3.3", "summary, point 5"),
    f"For mu up to {_NORMAL[1]:g} s/m the flip time, defined by the last {SETTLED:g} rad, goes as 1/mu "
    f"(within a tenth of the law, from {_NORMAL[0]:g} s/m, at {SPIN:g} rad/s).",
    needs=("why-exponent",),
    figure="why-exponent",
)
def _(times: xr.Dataset) -> Finding:
    inside = times.sel(mu_flip=slice(_NORMAL[0] * 0.999, _NORMAL[1] * 1.001))
    arrival = inside["mu_flip"] * inside["arrival_time_end"] / times["limit_arrival"]
    crossing = inside["mu_flip"] * inside["crossing_time"] / times["limit_crossing"]
    late = inside["mu_flip"].values[np.abs(arrival.values - 1.0) > _TENTH]
    first = f", and more than a tenth off from {late[0]:.2f} s/m on" if len(late) else ""
    rate = times["decay_rate"]
    slow, fast = float(rate.sel(mu_flip=1.0, method="nearest")), float(rate.max())
    return Finding(
        None,
        bool((abs(arrival - 1.0) <= _TENTH).all()),
        f"mu t is up to {arrival.max():.1f} times its limit{first}. The last oscillation about pi "
        f"decays at {slow:.2f} per second near mu = 1 s/m, against at most {fast:.2f}: whether it misses or "
        "meets the 0.01 rad in its first swings makes the time jump. The first tilt of more than pi/2 has no "
        f"such jumps, and its mu t is at most {crossing.max():.2f} times its limit.",
    )


@CHAPTER.claim(
    "why-only-simulation",
    Source("1"),
    "The only possible approach to the dynamics is numerical simulation.",
    needs=("why-critical", "why-bifurcation", "why-exponent"),
    figure="why-bifurcation",
)
def _(theory: xr.Dataset, states: xr.Dataset, times: xr.Dataset) -> Finding:
    tilt, law = _tilt_miss(states), max(_law_misses(times))
    known = _spectral_miss(theory) < _AGREED and tilt < SETTLED and law < _NEAR_LIMIT
    return Finding(
        None,
        not known,
        "Without a simulation one has the critical spins, the final tilt (runs differ from it by at most "
        f"{tilt:.0e} rad) and for small mu the time to turn over (by {law:.0e} of it). The single swings of "
        "a launch do take a simulation.",
    )


def _spectral_miss(theory: xr.Dataset) -> float:
    """Largest relative difference between critical spins by formula and by spectrum."""
    return float(abs(theory["critical_spectrum"] / theory["critical_formula"] - 1.0).max())


def _tilt_miss(states: xr.Dataset) -> float:
    """Largest difference between predicted and simulated final tilts of the report's top, rad."""
    return float(abs(states["run_end"] - states["run_predicted"]).max())


def _law_misses(times: xr.Dataset) -> tuple[float, float]:
    """Relative differences from the limit of mu t at the least mu, for the arrival and for pi/2."""
    least = times.isel(mu_flip=0)
    mu = float(least["mu_flip"])
    arrival = mu * float(least["arrival_time_end"]) / float(times["limit_arrival"])
    crossing = mu * float(least["crossing_time"]) / float(times["limit_crossing"])
    return abs(arrival - 1.0), abs(crossing - 1.0)
