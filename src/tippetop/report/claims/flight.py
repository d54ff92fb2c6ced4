"""Claims about the launch at 175 rad/s, where the table would have to pull: Figs. 9 to 12, and Fig. 16."""

import numpy as np

from tippetop.problem import Problem
from tippetop.report.claim import Chapter, Data, Finding, Source, Statement, half_last_digit
from tippetop.report.claims.launches import both_controls
from tippetop.report.quoted import ENERGY, ENERGY_TIME, FALL, STOP

CHAPTER = Chapter()


@CHAPTER.claim(
    Statement(
        "fig11-negative",
        Source("4", "Fig. 11"),
        "At 175 rad/s the normal force becomes negative.",
        holds=True,
    ),
    needs=("run-175",),
    figure="fig11",
)
def _(data: Data) -> Finding:
    run = data["run-175"]
    return Finding(
        float(run["least_force_listing"]) < 0,
        float(run["least_force"]) < 0,
        f"First at {float(run['lift_off_time']):.4f} s. On a table that pulls, the force reaches "
        f"{float(run['least_force']):.2f} N within 20 s, {float(run['least_force_listing']):.2f} N by the "
        "report's method.",
    )


@CHAPTER.claim(
    Statement(
        "fig10-energy",
        Source("4", "Fig. 10"),
        f"At 175 rad/s the energy reaches {ENERGY} J at t = {ENERGY_TIME} s.",
        ENERGY,
        "J",
    ),
    needs=("run-175",),
    figure="fig10",
)
def _(data: Data) -> Finding:
    run = data["run-175"]
    instant, half = float(ENERGY_TIME), half_last_digit(ENERGY_TIME)
    near = run["energy_listing"].sel(time_listing=slice(instant - half, instant + half))
    return Finding(
        float(np.interp(instant, run["time_listing"], run["energy_listing"])),
        float(np.interp(instant, run["time"], run["energy"])),
        "By (4.1) the report's energy swings with every nutation, so the value depends on the instant; its "
        f"largest is {float(run['largest_energy_listing']):.4f} J. The full energy on the table that pulls "
        f"exceeds that of the launch ({float(run['launch_energy']):.5f} J) by at most "
        f"{float(run['largest_energy'] - run['launch_energy']):.4f} J.",
        (float(near.min()), float(near.max())),
        f"the instant, {instant - half:g} to {instant + half:g} s",
    )


@CHAPTER.claim(
    Statement(
        "fig10-fall",
        Source("4", "Fig. 10"),
        f"To gain that energy the top would have to have fallen {FALL} radii.",
        FALL,
        "R",
    ),
    needs=("run-175",),
    figure="fig10",
)
def _(data: Data) -> Finding:
    run = data["run-175"]
    problem = Problem.from_json(run.attrs["problem"])
    weight = problem.body.mass * problem.gravity * problem.top.shape.size
    launch, reached = float(run["launch_energy"]), float(ENERGY)
    return Finding(
        reached / weight,
        (reached - launch) / weight,
        f"The 15 radii are all of the {reached:g} J; but the spin brings {launch / weight:.1f} radii' worth "
        "of it, and only the rest is a gain. The conclusion stands: while the table only pushes, nothing can "
        "be gained.",
    )


@CHAPTER.claim(
    Statement(
        "fig10-impossible",
        Source("4", "Fig. 10"),
        "A growing energy is impossible as long as the table does not pull.",
        holds=True,
    ),
    needs=("run-175",),
    figure="fig10",
)
def _(data: Data) -> Finding:
    run = data["run-175"]
    time, energy = run["time"].values, run["energy"].values
    before = energy[time <= float(run["lift_off_time"])]
    largest_rise = float(np.diff(before).max())
    pulling = (run["normal_force"].values < 0).mean()
    return Finding(
        None,
        largest_rise <= 1e-12 * float(run["launch_energy"]),
        f"Up to lift-off the energy never rises (largest change from sample to sample {largest_rise:.1e} J). "
        f"Later the force is negative at {100 * pulling:.0f} % of the samples, and there friction -mu g_n v "
        "pushes along the slip instead of against it: that is where the energy comes from.",
    )


@CHAPTER.claim(
    Statement(
        "fig12-stop-time",
        Source("4", "Fig. 12"),
        f"Stopping at t = {STOP} s is stopping before the top leaves the table.",
        STOP,
        "s",
    ),
    needs=("run-175",),
    figure="fig12",
)
def _(data: Data) -> Finding:
    run = data["run-175"]
    ours = float(run["lift_off_time"])
    return Finding(
        float(run["zero_of_force_listing"]),
        ours,
        f"The value is the first zero of the normal force. The tolerance of 1e-3 delays it; the stop comes "
        f"{float(STOP) - ours:.2f} s after the true lift-off.",
        both_controls(run, "zero_of_force"),
        "the step control: ode45's and SciPy's, at the same tolerances",
    )


@CHAPTER.claim(
    Statement(
        "fig16-stays",
        Source("Appendix C", "Fig. 16"),
        "Launched at 150 rad/s and theta = pi/4 the top stays on the table (drawn without a remark).",
        holds=True,
    ),
    needs=("run-150-pi-4",),
    figure="fig16",
)
def _(data: Data) -> Finding:
    run = data["run-150-pi-4"]
    return Finding(
        not float(run["least_force_listing"]) < 0,
        not np.isfinite(float(run["lift_off_time"])),
        f"It leaves the table at {float(run['lift_off_time']):.3f} s; on a table that pulls the force falls "
        f"to {float(run['least_force']):.3f} N. The report's method also finds a pull, from "
        f"{float(run['zero_of_force_listing']):.2f} s on.",
    )
