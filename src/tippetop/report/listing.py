"""The report's method, errors and all: its equations with theta modulo pi, by ode45 at default tolerances."""

import math

import numpy as np
import xarray as xr

from tippetop.integrators.base import Array, Motion
from tippetop.integrators.dense import DenseSolution
from tippetop.integrators.scipy_methods import SciPy
from tippetop.mechanics.euler import published_energy, published_normal_force, published_rates
from tippetop.problem import Problem
from tippetop.report.ode45 import ABSOLUTE, RELATIVE, Solution, ode45

CONTROLS = ("ode45", "scipy")
"""Ways to choose the step: as ode45 does, and as SciPy's RK45 does with the same formula and tolerances."""

_NAMES = ("theta", "theta_dot", "phi", "phi_dot", "omega3", "slip_x", "slip_y")


def listing_run(
    problem: Problem, duration: float, control: str = "ode45", samples: int = 20001
) -> xr.Dataset:
    """Run a problem as the report's listing does: on the table whatever its force (no lift-off).

    Parameters
    ----------
    problem
        An eccentric sphere with viscous friction.
    duration
        Length of the run, s.
    control
        One of `CONTROLS`.
    samples
        Number of samples with "scipy"; ode45 has its own points of output.

    Returns
    -------
    xarray.Dataset
        Over `time`: the report's variables (theta modulo pi, as plotted), `theta_integrated` without that,
        `normal_force` (2.15) and `energy` (4.1). Attributes: steps, evaluations, failure (empty if none).
    """
    solution = _integrate(problem, duration, control, samples)
    top = problem.top
    y = solution.states.T
    wrapped = (np.mod(y[0], math.pi), *y[1:])
    values = dict(zip(_NAMES, wrapped, strict=True))
    values["theta_integrated"] = y[0]
    with np.errstate(all="ignore"):
        values["normal_force"] = published_normal_force(wrapped, top, np)
        values["energy"] = published_energy(wrapped, top, np)
    attributes = {
        "steps": solution.steps,
        "evaluations": solution.evaluations,
        "failure": solution.failure or "",
    }
    variables = {name: ("time", value) for name, value in values.items()}
    return xr.Dataset(variables, {"time": solution.times}, attributes)


def listing_rates(problem: Problem, wrap: float | None = math.pi) -> Motion:
    """The right-hand side of the report's listing as a motion without parameters."""
    top = problem.top
    return Motion(lambda y, _: published_rates(y, top, math, wrap), size=7, parameters=0)


def launch_state(problem: Problem) -> Array:
    """The launch in the report's variables, shape (7,)."""
    launch = problem.launch
    return np.array(
        [launch.tilt, launch.tilt_rate, launch.azimuth, launch.precession, launch.spin, *launch.slip]
    )


def _integrate(problem: Problem, duration: float, control: str, samples: int) -> Solution:
    motion, start = listing_rates(problem), launch_state(problem)
    if control == "ode45":
        return ode45(lambda y: np.array(motion.rates(y.tolist(), ())), duration, start)
    method = SciPy("rk45", RELATIVE, ABSOLUTE)
    arcs = list(method.integrate(motion, (), (0.0, start), duration))
    solution = DenseSolution.joined([arc.solution for arc in arcs])
    times = np.linspace(0.0, duration, samples)
    times = times[times <= solution.end]
    steps, evaluations = sum(arc.steps for arc in arcs), sum(arc.evaluations for arc in arcs)
    return Solution(times, solution(times), steps, evaluations, arcs[-1].failure)
