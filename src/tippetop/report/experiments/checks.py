"""Checks beside the equations: the units of Table 1, and the block of Fig. 8."""

import numpy as np
import xarray as xr

from tippetop.problem.frictions import ViscousFriction
from tippetop.problem.presets import report_problem
from tippetop.problem.problem import Problem
from tippetop.report.experiment import dataset, experiment
from tippetop.report.experiments.runs import on_table
from tippetop.report.printed_numbers import MU
from tippetop.run import simulate


@experiment("units", "the units of Table 1", 0.3)
def _units(quick: bool) -> xr.Dataset:
    """Return one launch in metres and seconds and in other units, converted by units of mu and
    g.
    """
    report = report_problem()
    seconds = 2.0
    length, time = np.array([-1, 1]), np.array([-2, 2])
    lengths = [_tilt_after(_in_centimetres(report, int(power)), seconds) for power in length]
    times = [_tilt_after(_in_tenths(report, int(power)), 10.0 * seconds) for power in time]
    return dataset(
        {"power_of_length": length, "power_of_time": time},
        tilt=(_tilt_after(report, seconds), "rad", "tilt after 2 s, in metres and seconds"),
        tilt_in_centimetres=(lengths, "rad", "the same in centimetres", "power_of_length"),
        tilt_in_tenths=(times, "rad", "the same in tenths of a second", "power_of_time"),
    )


def _in_tenths(problem: Problem, power: int) -> Problem:
    """Return the problem with times in tenths of a second, for g with this power of time in its
    unit.
    """
    unit = 10.0
    times = {"friction.mu": MU * unit, "launch.spin": problem.launch.spin / unit}
    return problem.replace({**times, "gravity": problem.gravity * unit**power})


def _in_centimetres(problem: Problem, power: int) -> Problem:
    """Return the problem with lengths in centimetres, for mu with this power of length in its
    unit.
    """
    body, unit = problem.body, 100.0
    return problem.replace(
        {
            "body.shape.radius": float(body.surface.size) * unit,
            "body.I1": body.I1 * unit**2,
            "body.I3": body.I3 * unit**2,
            "friction.mu": MU * unit**power,
            "gravity": problem.gravity * unit,
        }
    )


def _tilt_after(problem: Problem, duration: float) -> float:
    return float(simulate(on_table(problem), duration, samples=2)["tilt"].values[-1])


@experiment("block", "a block on the table of Fig. 8", 0.1)
def _block(quick: bool) -> xr.Dataset:
    """Return the distance that a block slides on the table of Fig. 8 from a speed of 1 m/s."""
    mu, gravity = 100.0, report_problem().gravity
    law = ViscousFriction(mu=mu).law
    # Equal steps of speed: dx = v dv / v', exact by the midpoint rule because v' is proportional to
    # v.
    edges = np.linspace(1.0, 0.0, 1001)
    speeds = 0.5 * (edges[:-1] + edges[1:])
    slowing = gravity * np.array([law.traction((v, 0.0), (0.0, 0.0, 0.0)).force[0] for v in speeds])
    distance = float(np.sum(speeds * np.diff(edges) / slowing))
    return dataset(
        {}, {"mu_s_per_m": mu, "speed_m_per_s": 1.0}, distance=(distance, "m", "distance to rest")
    )
