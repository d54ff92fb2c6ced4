"""Dry friction at a point: tops that roll, Cohen's top step by step, and regularised friction."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr

from tippetop.contact.contact_mode import sliding_motion
from tippetop.contact.natural_launch import NaturalLaunch
from tippetop.integrators.classical import classical_step
from tippetop.integrators.rates import RightHandSide
from tippetop.mechanics.contacts.forces import velocity_without_slip
from tippetop.mechanics.motion import along_table
from tippetop.mechanics.state import SlidingState
from tippetop.mechanics.top import natural, natural_units
from tippetop.problem import presets
from tippetop.problem.contact_rules import Contact
from tippetop.problem.frictions import CoulombFriction, RegularizedCoulombFriction
from tippetop.problem.launch import Launch
from tippetop.problem.presets import report_problem
from tippetop.problem.problem import Problem, top_of
from tippetop.report.experiment import dataset, experiment
from tippetop.report.experiments.runs import event_times, stopping
from tippetop.report.printed_numbers import SPIN, TILT
from tippetop.run import simulate

SLIPPERY = 0.028
"""Friction coefficient a little below the least for rolling at the report's main launch."""

ROLLED = 1.5
"""Length of the runs that find the least friction for rolling, s: several periods of the
nutation.
"""

WITHOUT_COMPILING: Any = {"integrator": "dop853", "tolerance": 1e-11}
"""Options of single runs that slip and stick: compiling them would take longer than the runs."""

COHEN = Problem(
    body=presets.COHEN,
    friction=CoulombFriction(mu=0.3),
    launch=Launch(tilt=0.1, spin=100.0, slip=(0.0, 2.5 * math.sin(0.1))),
    contact=Contact(liftoff="stop"),
    gravity=9.81,
)
"""Cohen's top, set down with its centre of mass at rest; Am. J. Phys. 45 (1977) 12."""

COHEN_STEP, COHEN_WINDOW = 0.01, 2.0
"""Step of Cohen's method, and length of the run in his figure 5, s."""

FOLLOWED = 4.0
"""Length of the runs of Cohen's top, s."""

SMOOTHED, SMOOTHED_SPIN = 0.3, 100.0
"""Friction coefficient and spin (rad/s) of the tops on regularised Coulomb friction."""


def with_friction(problem: Problem, friction: object) -> Problem:
    """Return the problem with another friction; its run ends where the top leaves the table."""
    return stopping(problem.model_copy(update={"friction": friction}))


def friction_needed(spin: float, tilt: float) -> float:
    """Return the least mu on which the report's top, set down without slip, rolls; nan if there is
    none.

    This is the largest ratio of friction and normal force along the run, from a parabola through
    the largest sample and its neighbours.
    """
    # On this mu every top of the map rolls, and no contact force is inconsistent.
    problem = with_friction(report_problem(spin, tilt), CoulombFriction(mu=1.4))
    run = simulate(problem, ROLLED, samples=3001)
    force = run["contact_force"].values
    if list(run["event_kind"].values) != ["stick"] or force[:, 2].min() <= 0.0:
        return math.nan
    ratio = np.hypot(force[:, 0], force[:, 1]) / force[:, 2]
    k = min(max(int(ratio.argmax()), 1), len(ratio) - 2)
    before, largest, after = ratio[k - 1 : k + 2]
    return float(largest + (after - before) ** 2 / (8.0 * (2.0 * largest - before - after)))


@experiment("dry-rolling", "the friction that rolling needs", 4.0)
def _rolling(quick: bool) -> xr.Dataset:
    """Return the friction that rolling needs, and launches with a little more and a little less."""
    spins = np.linspace(10.0, 250.0, 5 if quick else 17)
    tilts = np.array([0.1, 0.2, 0.8] if quick else [0.05, 0.1, 0.2, 0.4, 0.8])
    least = np.array([[friction_needed(float(s), float(t)) for s in spins] for t in tilts])
    needed = friction_needed(SPIN, TILT)
    main = report_problem(SPIN, TILT)
    times = np.linspace(0.0, 20.0, 2001)
    coefficients = [1.001 * needed, *((1.0,) if quick else (0.3, 1.0))]
    rolling = [
        simulate(with_friction(main, CoulombFriction(mu=mu)), 20.0, times=times)
        for mu in coefficients
    ]
    lost = [float(abs(run["energy_lost"] / run["initial_energy"])) for run in rolling]
    slips = [len(event_times(run, "slip")) for run in rolling]
    less = with_friction(main, CoulombFriction(mu=0.999 * needed))
    below = simulate(less, 0.1, samples=2, mode_limit=1)  # for more than a period of the nutation
    slipping = with_friction(main, CoulombFriction(mu=SLIPPERY))
    slippery = simulate(slipping, 0.3 if quick else 3.0, **WITHOUT_COMPILING)
    return dataset(
        {
            "tilt": tilts,
            "spin": spins,
            "time": times,
            "time_slips": slippery["time"].values,
            "held": (coefficients, "1", "friction coefficient"),
        },
        {"spin_rad_per_s": SPIN, "tilt_rad": TILT, "slippery_mu": SLIPPERY},
        friction_needed=(least, "1", "least mu for rolling", "tilt", "spin"),
        needed_main=(needed, "1", "least mu for rolling, main launch"),
        tilt_held=([run["tilt"].values for run in rolling], "rad", "tilt", "held", "time"),
        slips_held=(slips, "1", "times of slipping", "held"),
        lost_held=(lost, "1", "energy lost, relative", "held"),
        held_below=(float(below["end_time"]), "s", "how long a little less holds it"),
        tilt_slips=(slippery["tilt"].values, "rad", "tilt", "time_slips"),
    )


def stepped(problem: Problem, step: float, duration: float) -> SlidingState:
    """Return the steps of a sliding top by the classical Runge-Kutta method with fixed step.

    The method goes on sliding when slip ends. The state is in natural units, with numbers of shape
    (steps + 1,).
    """
    launch = NaturalLaunch.of(problem)
    motion = replace(sliding_motion(launch.top.kind, False), guards=())
    rates = RightHandSide(motion, launch.top.numbers)
    y = np.array(along_table(launch.state).pack(), dtype=float)
    rows = [y]
    for _ in range(round(duration / step)):
        y = classical_step(rates, y, step / launch.units.time)
        rows.append(y)
    return SlidingState.unpack(np.array(rows).T)


@experiment("dry-cohen", "Cohen's top by his method and exactly", 4.0)
def _cohen(quick: bool) -> xr.Dataset:
    steps = np.array([10.0, 2.0, 0.5] if quick else [10.0, 5.0, 2.0, 1.0, 0.5, 0.2]) * 1e-3
    times = np.linspace(0.0, FOLLOWED, round(FOLLOWED / COHEN_STEP) + 1)
    tilts, slowest = [], []
    top, units = natural(top_of(COHEN)), natural_units(top_of(COHEN))
    for step in steps:
        state = stepped(COHEN, float(step), FOLLOWED)
        tilt = np.arctan2(np.hypot(state.axis[0], state.axis[1]), state.axis[2])
        tilts.append(tilt[:: round(COHEN_STEP / step)])
        rolling = velocity_without_slip(state.axis, state.momentum, top)
        slip = np.hypot(*(u - v for u, v in zip(state.velocity, rolling, strict=True)))
        slowest.append(float(slip.min()) * units.speed)
    exact = simulate(COHEN, FOLLOWED, times=times, **WITHOUT_COMPILING)
    stick = float(event_times(exact, "stick")[0])
    sticking = exact["energy"].values[times > stick]
    energy_change = float(np.ptp(sticking) / sticking[-1])
    return dataset(
        {"step": steps, "time": times},
        tilt_stepped=(tilts, "rad", "tilt, stepped", "step", "time"),
        slowest=(slowest, "m s-1", "least slip speed at a step", "step"),
        tilt=(exact["tilt"].values, "rad", "tilt, exact", "time"),
        sticks=(stick, "s", "when slip ends"),
        slips_again=(len(event_times(exact, "slip")), "1", "how often it slips again"),
        energy_kept=(energy_change, "1", "largest relative change of the energy while it sticks"),
    )


def turning_time(problem: Problem, window: float) -> float:
    """Return when the axis first passes the horizontal, s.

    nan is returned if it does not do so within the window, or before the top sticks.
    """
    return float(simulate(problem, window, samples=2, mode_limit=1)["turnover_time"])


@experiment("dry-smoothed", "smoothed Coulomb friction as the smoothing goes away", 4.0)
def _smoothed(quick: bool) -> xr.Dataset:
    eps = np.geomspace(0.1, 5e-3, 5) if quick else np.geomspace(0.1, 1e-3, 11)
    windows = np.maximum(4.0, 0.02 / eps)
    base = report_problem(SMOOTHED_SPIN)
    times = [
        turning_time(
            with_friction(base, RegularizedCoulombFriction(mu=SMOOTHED, eps=float(e))), float(w)
        )
        for e, w in zip(eps, windows, strict=True)
    ]
    exact = simulate(
        with_friction(base, CoulombFriction(mu=SMOOTHED)), float(windows.max()), samples=2001
    )
    turns, slopes = float(exact["turnover_time"]), np.diff(np.log(times)) / np.diff(np.log(eps))
    return dataset(
        {"eps": (eps, "m s-1", "slip speed below which friction falls to zero")},
        {"mu": SMOOTHED, "spin_rad_per_s": SMOOTHED_SPIN},
        turning_time=(times, "s", "first tilt of more than pi/2", "eps"),
        last_exponent=(slopes[-1], "1", "d ln t / d ln eps at the least eps"),
        highest=(float(exact["tilt"].max()), "rad", "largest tilt on exact Coulomb friction"),
        followed=(float(exact["end_time"]), "s", "how long that top was followed"),
        exact_turns=(turns, "s", "when that top turns over; nan if never"),
    )
