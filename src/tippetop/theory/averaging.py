"""Slow flow: the averaged motion under weak viscous friction, from a launch to its steady state.

For small mu the tilt nutates as on a smooth table and lambda is constant. The other constants of
the nutation, L3 and the energy, drift at rates proportional to mu: by the torque and the power of
friction averaged over one nutation (`tippetop.theory.dissipation`). Time enters only as mu t, so
the time to turn over is proportional to 1 / mu. The nutation decays, and the flow then follows the
steady precessions of the smooth table.

The flow is the limit of runs only while the table need not pull: beyond that, the top takes off.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import PchipInterpolator

from tippetop.integrators.base import Array
from tippetop.mechanics.laws.friction import ViscousLaw
from tippetop.mechanics.roots import crossing, dip
from tippetop.mechanics.top import natural_units
from tippetop.mechanics.view import Angles
from tippetop.problem.problem import Problem, top_of
from tippetop.support.errors import Described, InvalidInput, is_number, is_whole
from tippetop.theory.nutation import numbers_of
from tippetop.theory.nutation_decay import (
    Goals,
    Nutation,
    Stage,
    follow_nutation,
    nutation_of_angles,
)
from tippetop.theory.prediction import stable_by_energy
from tippetop.theory.steady import jellett_of_launch, steady_states


@dataclass(frozen=True)
class SlowFlow:
    """Tilt of a launch in the limit of small friction, as a function of mu t."""

    mu_time: Array
    """mu t, s^2/m, increasing, shape (n,)."""
    tilt_low: Array
    tilt_high: Array
    """Least and largest tilt of the nutation at that time, rad, shape (n,): equal once the nutation
    has decayed.
    """
    final_tilt: float
    """Tilt of the steady state that the flow ends in, rad; nan if the flow ends before, because the
    table would have to pull.
    """

    def tilts(self, mu_times: Array) -> tuple[Array, Array]:
        """Return the least and largest tilt, rad, at values of mu t, s^2/m; nan outside
        `mu_time`.
        """
        low, high = (
            PchipInterpolator(self.mu_time, tilts, extrapolate=False)(mu_times)
            for tilts in (self.tilt_low, self.tilt_high)
        )
        return low, high


TOLERANCE = 1e-9
"""Error of the logarithms of the amplitudes per step: far below what a plot or a test resolves, and
reached in a few tens of steps.
"""


def averaged_flow(
    problem: Problem, distance: float = 1e-6, samples: int = 200, tolerance: float = TOLERANCE
) -> SlowFlow:
    """Return the slow flow of a launch of an eccentric sphere with viscous friction.

    The value of mu does not matter. The horizontal velocity of the centre of mass is neglected: it
    decays by itself, unless the axis turns exactly once in one nutation (Limits in
    docs/theory/slow.md).

    The flow is followed to a `distance` from the final tilt, rad. Each of its stages, about one
    pole and, if that comes nearer, about the other, is sampled at least `samples` times. The
    `tolerance` is the error of the logarithms of the amplitudes per step.

    Raises `InvalidInput` if the body is no eccentric sphere, its friction is not viscous, the
    launch is exactly vertical, or a setting is refused.
    """
    if not is_whole(samples) or samples < 2:
        raise InvalidInput("samples", samples, "a whole number, at least 2")
    parts, begin = list[Array](), 0.0
    stages = _stages(problem, distance, tolerance)
    for stage in stages:
        even = np.linspace(0.0, stage.knots[-1], samples)
        times = np.union1d(even, stage.knots)
        parts.append(np.array([begin + times, *np.broadcast_arrays(*stage.tilts(times))]))
        begin = float(parts[-1][0, -1])
    # The first instant of each stage is the last one of the stage before.
    time, low, high = np.hstack([parts[0][:, :1], *(part[:, 1:] for part in parts)])
    return SlowFlow(time / float(top_of(problem).gravity), low, high, stages[-1].final_tilt)


def _stages(problem: Problem, distance: float, tolerance: float) -> list[Stage]:
    """Return the stages of the slow flow, each about the pole that the nutation is nearer to."""
    for field, value in {"distance": distance, "tolerance": tolerance}.items():
        if not (is_number(value) and value > 0.0):
            raise InvalidInput(field, value, "a finite number greater than 0")
    top = top_of(problem)
    numbers = numbers_of(top)
    if numbers.alpha == 0.0:
        raise InvalidInput(
            "body.shape",
            Described("a centred sphere"),
            "an eccentric sphere: the weight makes no other nutate",
        )
    if not isinstance(top.friction, ViscousLaw):
        raise InvalidInput(
            "friction", Described("this law"), "viscous friction: the average exists for no other"
        )
    if problem.launch.tilt in (0.0, math.pi) and problem.launch.tilt_rate == 0.0:
        raise InvalidInput(
            "launch.tilt", problem.launch.tilt, "another", "makes a vertical spin, which is steady"
        )
    jellett = jellett_of_launch(problem)
    stable = [state.tilt for state in stable_by_energy(steady_states(top, jellett))]
    goals = Goals(stable, distance, problem.contact.liftoff != "ignore")
    jellett /= float(natural_units(top).jellett)
    nutation, stages = nutation_of_launch(problem), list[Stage]()
    for _ in range(_MOST_STAGES):
        stages.append(follow_nutation(nutation, jellett, numbers, goals, tolerance))
        if stages[-1].done:
            break
        nutation = stages[-1].end.turn(numbers)
    return stages


def nutation_of_launch(problem: Problem) -> Nutation:
    """Return the nutation of a launch of an eccentric sphere on a smooth table, natural units.

    Raises `InvalidInput` if the body is of another shape.
    """
    launch, time = problem.launch, float(natural_units(top_of(problem)).time)
    rates = (launch.tilt_rate * time, 0.0, launch.precession * time, launch.spin * time)
    return nutation_of_angles(Angles(launch.tilt, *rates, (0.0, 0.0)), numbers_of(top_of(problem)))


ARRIVAL_DISTANCE = 0.01
"""Distance from its end within which the tilt counts as arrived, rad: that of `arrival_time` of
runs, to which the limit is compared.
"""


def arrival_time_limit(problem: Problem, distance: float = ARRIVAL_DISTANCE) -> float:
    """Return the limit of mu times the flip time for small mu, s^2/m.

    The flip time is the first instant with the tilt within `distance` (rad) of its end. Raises
    `InvalidInput` as `averaged_flow`, and if the flow cannot be followed to its end.
    """
    stages = _stages(problem, distance, TOLERANCE)
    final = stages[-1].final_tilt
    if not math.isfinite(final):
        raise _no_end(problem, stages)
    begin = 0.0
    for stage in stages:
        time = _first_near(stage, final, distance)
        if time is not None:
            return (begin + time) / float(top_of(problem).gravity)
        begin += float(stage.knots[-1])
    return begin / float(top_of(problem).gravity)


def _no_end(problem: Problem, stages: list[Stage]) -> InvalidInput:
    """Return the refusal of a launch whose slow flow cannot be followed to its end."""
    if stages[0].begin.grazes:
        accepted = "far enough from the unstable vertical: so near, rounding decides the nutation"
        return InvalidInput("launch.tilt", problem.launch.tilt, accepted)
    pulled = stages[-1].pulled
    launch = (
        "one for which the table would have to pull"
        if pulled
        else "one whose nutation does not decay in the time followed"
    )
    return InvalidInput(
        "launch", Described(launch), "one whose nutation decays on a table that only pushes"
    )


def _first_near(stage: Stage, final: float, distance: float) -> float | None:
    """Return the first time at which the tilt is near its end, or None.

    A wide nutation may pass its end long before it has decayed.
    """

    def excess(times: Array) -> Array:
        """Return the distance of the final tilt from the range of the nutation, less `distance`."""
        low, high = stage.tilts(times)
        return np.maximum(low - final, final - high) - distance

    def amplitude_difference(times: Array) -> Array:
        fast, slow, _ = stage.points(times)
        return np.asarray(fast - slow)

    def middle_offset(times: Array) -> Array:
        low, high = stage.tilts(times)
        return low + high - 2.0 * final

    def of_one(function: Callable[[Array], Array]) -> Callable[[float], float]:
        return lambda time: float(function(np.array([time]))[0])

    shares = np.linspace(stage.knots[:-1], stage.knots[1:], _PER_STEP, endpoint=False).T.ravel()
    times = np.append(shares, stage.knots[-1])
    # The tilt may be near its end for an instant only: where the nutation passes a vertical, or its
    # middle passes the final tilt.
    for through in (amplitude_difference, middle_offset):
        ahead = through(times) > 0.0
        turns = np.flatnonzero(ahead[:-1] != ahead[1:])
        roots = [crossing(of_one(through), float(times[i]), float(times[i + 1])) for i in turns]
        times = np.union1d(times, roots)
    # Or where it comes near and turns back.
    values = excess(times)
    around = np.pad(values, 1, constant_values=math.inf)
    lowest = (values <= 0.0) | (values <= np.minimum(around[:-2], around[2:]))
    for i in np.flatnonzero(lowest).tolist():
        before, middle, after = times[[max(i - 1, 0), i, min(i + 1, len(times) - 1)]].tolist()
        least = values[i]
        if least > 0.0:
            middle, least = dip(of_one(excess), before, after)
        if least <= 0.0:
            return (
                middle if i == 0 and values[0] <= 0.0 else crossing(of_one(excess), before, middle)
            )
    return None


def local_exponent(mu: Array, arrival_time: Array) -> Array:
    """Return the exponent d ln t / d ln mu of flip times, shape (n,): -1 where t ~ 1 / mu."""
    return np.asarray(np.gradient(np.log(arrival_time), np.log(mu)))


_PER_STEP = 40
"""Instants per step at which it is checked whether the end is near."""
_MOST_STAGES = 20
"""Changes of the pole after which the flow is given up: real launches change once or twice."""
