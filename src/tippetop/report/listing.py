"""The report's method with its errors: its equations, theta modulo pi, ode45 at default
tolerances.
"""

import math

import numpy as np
import xarray as xr

from tippetop.integrators.base import Array, Motion
from tippetop.mechanics.euler import published_energy, published_normal_force, published_rates
from tippetop.problem.problem import Problem, top_of
from tippetop.report.ode45 import ode45

VARIABLES = ("tilt", "tilt_rate", "azimuth", "precession", "spin", "slip_x", "slip_y")
"""The report's variables, in its order."""


def listing_run(problem: Problem, duration: float, *, unilateral: bool = False) -> xr.Dataset:
    """Return the run of an eccentric sphere on viscous friction by the report's listing.

    The sphere never leaves the table. With `unilateral`, the lines of the listing that set a
    negative normal force to zero, and that are commented out in the report, are executed.

    Returns
    -------
    xarray.Dataset
        Over `time`, the points of output of ode45: the report's variables (theta modulo pi, as
        plotted), `tilt_integrated` (not modulo pi), `normal_force` (2.15) and `energy` (4.1).
        Attributes: steps, evaluations, failure (empty if none).
    """
    motion, start = listing_rates(problem, unilateral=unilateral), launch_state(problem)
    solution = ode45(lambda y: np.array(motion.rates(y.tolist(), ())), duration, start)
    top = top_of(problem)
    y = solution.states.T
    wrapped = (np.mod(y[0], math.pi), *y[1:])
    values = dict(zip(VARIABLES, wrapped, strict=True))
    values["tilt_integrated"] = y[0]
    with np.errstate(all="ignore"):
        values["normal_force"] = published_normal_force(wrapped, top, np)
        values["energy"] = published_energy(wrapped, top, np)
    counts = {"steps": solution.steps, "evaluations": solution.evaluations}
    variables = {name: ("time", value) for name, value in values.items()}
    return xr.Dataset(
        variables, {"time": solution.times}, {**counts, "failure": solution.failure or ""}
    )


def listing_rates(
    problem: Problem, wrap: float | None = math.pi, *, unilateral: bool = False
) -> Motion:
    """Return the right-hand side of the report's listing as a motion without parameters."""
    top = top_of(problem)
    return Motion(
        lambda y, _: published_rates(y, top, math, wrap, unilateral=unilateral),
        size=7,
        parameters=0,
    )


def launch_state(problem: Problem) -> Array:
    """Return the launch in the report's variables, shape (7,)."""
    launch = problem.launch
    return np.array(
        [
            launch.tilt,
            launch.tilt_rate,
            launch.azimuth,
            launch.precession,
            launch.spin,
            *launch.slip,
        ]
    )
