"""The slow flow: how a little friction carries a top from its launch to its steady state.

For small mu the tilt nutates as on a smooth table, lambda is constant, and what else the nutation leaves
alone, L3 and the energy, drifts at a rate proportional to mu: by friction's torque and power averaged over
one nutation (`tippetop.theory.dissipation`). Time enters only as mu t, which is why the time to turn over
goes as 1 / mu.

When the nutation has died away, what is left is a drift along the steady precessions of the smooth table,
in the tilt alone, and time is an integral over the tilt (`tippetop.theory.drift`).
"""

import math
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import PchipInterpolator

from tippetop.errors import InvalidInput
from tippetop.integrators.base import Array
from tippetop.mechanics.friction import ViscousLaw
from tippetop.mechanics.top import natural_units
from tippetop.mechanics.view import Angles
from tippetop.problem import Problem
from tippetop.theory.nutation import numbers_of
from tippetop.theory.nutation_decay import Goals, Nutation, follow_nutation, launched
from tippetop.theory.prediction import stable_by_energy
from tippetop.theory.steady import jellett_of_launch, steady_states


@dataclass(frozen=True)
class SlowFlow:
    """The tilt of a launch in the limit of small friction, as a function of mu t."""

    mu_time: Array
    """mu t, s^2/m, increasing, shape (n,)."""
    tilt_low: Array
    tilt_high: Array
    """Least and largest tilt of the nutation at that time, rad, shape (n,): equal once it has died away."""
    final_tilt: float
    """Tilt of the steady state the flow ends in, rad; nan if it could not be followed that far, as where so
    wide a nutation would need a table that pulls."""

    def tilts(self, mu_times: Array) -> tuple[Array, Array]:
        """Least and largest tilt at these values of mu t (s^2/m), rad: nan outside those followed."""
        low, high = (
            PchipInterpolator(self.mu_time, tilts, extrapolate=False)(mu_times)
            for tilts in (self.tilt_low, self.tilt_high)
        )
        return low, high


def averaged_flow(
    problem: Problem, distance: float = 1e-6, samples: int = 200, tolerance: float = 1e-5
) -> SlowFlow:
    """The slow flow of a launch of an eccentric sphere with viscous friction; the size of mu does not matter.

    Parameters
    ----------
    problem
        The launch. The horizontal velocity of its centre of mass has no part: it dies away by itself.
    distance
        How far from the final tilt the flow is followed, rad.
    samples
        At how many times the nutating part is given.
    tolerance
        Error of the logarithms of the amplitudes in a step of the nutating part.

    Raises
    ------
    InvalidInput
        If the body is no eccentric sphere, its friction is not viscous, or the launch is exactly vertical.
    """
    top = problem.top
    numbers = numbers_of(top)
    if not isinstance(top.friction, ViscousLaw):
        raise InvalidInput("friction", top.friction, "viscous friction; no other slip averages out")
    if problem.launch.tilt in (0.0, math.pi) and problem.launch.tilt_rate == 0.0:
        raise InvalidInput("launch.tilt", problem.launch.tilt, "a tilted launch: a vertical spin is steady")
    jellett = jellett_of_launch(problem)
    states = steady_states(top, jellett)
    goals = Goals(
        [state.tilt for state in states], [state.tilt for state in stable_by_energy(states)], distance
    )
    jellett /= float(natural_units(top).jellett)
    nutation, begin, parts = nutation_of_launch(problem), 0.0, list[Array]()
    # From the pole that it is nearer to, until it has died away; then the tilt alone.
    for _ in range(_MOST_STAGES):
        stage = follow_nutation(nutation, jellett, numbers, goals, samples, tolerance)
        parts.append(np.array([begin + stage.time, stage.low, stage.high]))
        begin, nutation = float(parts[-1][0, -1]), stage.end.turn(numbers)
        if stage.done:
            break
    if stage.tail is not None:
        parts.append(np.array([begin + stage.tail.time, stage.tail.tilt, stage.tail.tilt]))
    # Each begins where the one before ends.
    time, low, high = np.hstack([parts[0][:, :1], *(part[:, 1:] for part in parts)])
    return SlowFlow(time / float(top.gravity), low, high, stage.final_tilt)


def nutation_of_launch(problem: Problem) -> Nutation:
    """The nutation that a launch of an eccentric sphere would keep on a smooth table, in natural units.

    Raises `InvalidInput` if the body is of another shape.
    """
    launch, time = problem.launch, float(natural_units(problem.top).time)
    rates = (launch.tilt_rate * time, 0.0, launch.precession * time, launch.spin * time)
    return launched(Angles(launch.tilt, *rates, (0.0, 0.0)), numbers_of(problem.top))


def flip_time_limit(problem: Problem, distance: float = 0.01) -> float:
    """Limit for small mu of mu times the flip time, s^2/m.

    The flip time is the first at which the tilt is within `distance` (rad) of its end; inf where the flow
    does not reach one.

    Raises
    ------
    InvalidInput
        As `averaged_flow`.
    """
    flow = averaged_flow(problem, distance=distance, samples=_FINE)
    if not math.isfinite(flow.final_tilt):
        return math.inf
    # How far the end is outside of the nutation, which may pass it long before it has died away.
    away = np.maximum(flow.tilt_low - flow.final_tilt, flow.final_tilt - flow.tilt_high)
    first = int(np.argmax(np.append(away[:-1] <= distance, True)))
    if first == 0:
        return 0.0
    share = (away[first - 1] - distance) / (away[first - 1] - away[first])
    return float(flow.mu_time[first - 1] + share * (flow.mu_time[first] - flow.mu_time[first - 1]))


def local_exponent(mu: Array, flip_time: Array) -> Array:
    """Exponent d ln t / d ln mu along a table of flip times, shape (n,): -1 where t goes as 1 / mu."""
    return np.asarray(np.gradient(np.log(flip_time), np.log(mu)))


_FINE = 4000
_MOST_STAGES = 20
