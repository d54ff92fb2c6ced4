"""Numerical methods: their orders, and their cost for stiff launches."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr
from scipy.integrate import RK45

from tippetop.integrators.base import Array, Motion
from tippetop.integrators.scipy_methods import SciPy
from tippetop.mechanics.vectors import Scalar
from tippetop.problem.presets import report_problem
from tippetop.problem.problem import Problem
from tippetop.report.experiment import dataset, experiment
from tippetop.report.experiments.runs import on_table
from tippetop.report.listing import launch_state, listing_rates
from tippetop.report.ode45 import ABSOLUTE, RELATIVE, dormand_prince_step, ode45
from tippetop.report.printed_numbers import MU, ROUGH_FRICTION, SPIN, TILT
from tippetop.run import simulate

EXPLICIT, IMPLICIT = ("ode45", "dop853"), ("radau", "bdf", "lsoda")

LAUNCHES = (
    (10.0, TILT, MU),
    (SPIN, TILT, MU),
    (SPIN, 1.4, MU),
    (SPIN, 1e-6, MU),
    (SPIN, math.pi - 1e-3, MU),
    (SPIN, TILT, 10.0),
    (10.0, TILT, ROUGH_FRICTION),
    (SPIN, TILT, ROUGH_FRICTION),
)
"""Spins (rad/s), tilts (rad) and friction coefficients (s/m) of the launches that compare
methods.
"""

_SPAN = 3.0


@experiment("order", "order of accuracy of the two Runge-Kutta formulas", 1.0)
def _order(quick: bool) -> xr.Dataset:
    # This launch has no symmetry by which a term of an error could vanish.
    changes = {"launch.tilt_rate": 2.0, "launch.precession": 6.0, "launch.slip": (0.1, 0.05)}
    problem, span = on_table(report_problem(80.0, tilt=0.7).replace(changes)), 0.1
    steps = span / np.array([50, 100, 200] if quick else [50, 100, 200, 400])
    motion, start = listing_rates(problem, wrap=None), launch_state(problem)

    def rates(y: Array) -> Array:
        return np.array(motion.rates(y.tolist(), ()))

    def by_rk4(duration: float, step: float) -> Array:
        run = simulate(problem, duration, times=[duration], integrator="rk4", step=step)
        return np.asarray(run["axis"].values[-1])

    def by_taylor(duration: float) -> xr.Dataset:
        return simulate(problem, duration, times=[duration])

    def by_dormand_prince(duration: float, step: float, companion: bool = False) -> float:
        state = start
        for _ in range(round(duration / step)):
            state, stages = dormand_prince_step(rates, state, rates(state), step)
            if companion:
                state = state + step * (RK45.E @ stages)
        return float(state[0])

    final = by_taylor(span)
    tilt = float(final["tilt"][-1])
    errors = {
        "rk4_in_all": [_distance(by_rk4(span, h), final) for h in steps],
        "rk4_in_a_step": [_distance(by_rk4(h, h), by_taylor(float(h))) for h in steps],
        "ode45_in_all": [abs(by_dormand_prince(span, h) - tilt) for h in steps],
        "companion_in_all": [abs(by_dormand_prince(span, h, companion=True) - tilt) for h in steps],
    }
    coarse = 2.0 / np.array([20.0, 40.0, 80.0, 160.0])
    printed = {
        f"printed{suffix}_{part}": values
        for suffix, last in (("", 0.0), ("_mended", 1.0))
        for part, values in zip(
            _PARTS, np.array([_printed_errors(h, last) for h in coarse]).T, strict=True
        )
    }
    order = "power of the step in the error, between the two finest: "
    return dataset(
        {"step": steps, "step_printed": coarse},
        **{
            name: (each, "rad", f"error of the axis or tilt: {name}", "step")
            for name, each in errors.items()
        },
        **{
            name: (each, "1", f"error of (B.1): {name}", "step_printed")
            for name, each in printed.items()
        },
        **{
            f"order_{name}": (math.log(each[-1] / each[-2], over[-1] / over[-2]), "1", order + name)
            for over, kind in ((steps, errors), (coarse, printed))
            for name, each in kind.items()
        },
    )


_PARTS = ("in_all", "in_a_step")


def _printed_errors(step: float, last: float) -> tuple[float, float]:
    """Return the errors of (B.1) on y' = y cos(1 + t), y(0) = 1, after 2 s and after one step.

    `last` is the share of the step at which the last stage is evaluated: 0 as printed, 1 as it
    should be.
    """

    def rate(y: float, t: float) -> float:
        return y * math.cos(1.0 + t)

    y, errors = 1.0, []
    for k in range(round(2.0 / step)):
        t = k * step
        first = rate(y, t)
        second = rate(y + 0.5 * step * first, t + 0.5 * step)
        third = rate(y + 0.5 * step * second, t + 0.5 * step)
        fourth = rate(y + step * third, t + last * step)
        y += step / 6.0 * (first + 2.0 * second + 2.0 * third + fourth)
        errors.append(abs(y - math.exp(math.sin(1.0 + t + step) - math.sin(1.0))))
    return errors[-1], errors[0]


def _distance(axis: Array, run: xr.Dataset) -> float:
    return float(np.linalg.norm(axis - run["axis"].values[-1]))


class _Counted:
    """Right-hand side of the listing that counts its evaluations, those for Jacobians included."""

    def __init__(self, problem: Problem) -> None:
        self.motion = listing_rates(problem)
        self.count = 0

    def __call__(self, y: Sequence[Scalar], parameters: Sequence[Scalar]) -> Sequence[Scalar]:
        self.count += 1
        return self.motion.rates(y, parameters)


class Effort(NamedTuple):
    """Cost and result of a method at the report's tolerances."""

    evaluations: int
    """Number of evaluations of the right-hand side; -1 if the method gives up."""
    tilt: float
    """Tilt at the end, rad."""


def effort(problem: Problem, method: str, span: float) -> Effort:
    """Return the cost and the result of a method for a launch."""
    rates = _Counted(problem)
    start = launch_state(problem)
    if method == "ode45":
        solution = ode45(lambda y: np.array(rates(y.tolist(), ())), span, start)
        failure, end = solution.failure, solution.states[-1]
    else:
        motion = Motion(rates, size=7, parameters=0)
        *_, last = SciPy(method, RELATIVE, ABSOLUTE).integrate(motion, (), (0.0, start), span)
        failure, end = last.failure, last.end_state
    return Effort(rates.count if failure is None else -1, float(end[0] % math.pi))


@experiment("stiffness", "evaluations of explicit and implicit methods", 12.0)
def _stiffness(quick: bool) -> xr.Dataset:
    methods = (*EXPLICIT, *IMPLICIT)
    made = [
        [effort(report_problem(*launch), method, _SPAN) for method in methods]
        for launch in LAUNCHES
    ]
    counts = np.array([[one.evaluations for one in row] for row in made])
    runs = [simulate(on_table(report_problem(*launch)), _SPAN, samples=2) for launch in LAUNCHES]
    true = [float(run["final_tilt"]) for run in runs]
    bdf = np.array([row[methods.index("bdf")].tilt for row in made])
    spins, tilts, frictions = np.array(LAUNCHES).T
    counted = np.where(counts < 0, np.nan, counts)
    explicit = np.nanmin(counted[:, : len(EXPLICIT)], axis=1)
    implicit = np.nanmin(counted[:, len(EXPLICIT) :], axis=1)
    name = "evaluations of the best explicit method over those of the best implicit one"
    return dataset(
        {"integrator": list(methods)},
        {"span_s": _SPAN, "relative_tolerance": RELATIVE, "absolute_tolerance": ABSOLUTE},
        evaluations=(counts, "1", "evaluations of the right-hand side", "launch", "integrator"),
        bdf_miss=(abs(bdf - true), "rad", "difference of bdf's tilt at the end", "launch"),
        stiffness=(explicit / implicit, "1", name, "launch"),
        launch_spin=(spins, "rad s-1", "spin", "launch"),
        launch_tilt=(tilts, "rad", "tilt", "launch"),
        launch_mu=(frictions, "s m-1", "friction coefficient", "launch"),
    )


@experiment("theta-mod-pi", "the listing's right-hand side at the poles", 0.1)
def _jump(quick: bool) -> xr.Dataset:
    problem = report_problem()
    tiny, state = 1e-9, (3.0, 0.0, 10.0, SPIN, 0.05, 0.05)

    def beside(motion: Motion) -> list[float]:
        return [float(motion.rates((side * tiny, *state), ())[6]) for side in (-1, 1)]

    before, after = beside(listing_rates(problem))
    true = beside(listing_rates(problem, wrap=None))
    return dataset(
        {},
        {"state": f"theta = -/+{tiny:g}; theta', phi, phi', omega3, v_x, v_y = {state}"},
        jump_listing=(abs(after - before), "m s-2", "jump of the rate of v_y with theta modulo pi"),
        jump=(abs(true[1] - true[0]), "m s-2", "its change without the modulo"),
        size=(abs(after), "m s-2", "the rate of v_y itself"),
    )
