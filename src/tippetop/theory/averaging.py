"""The slow flow: how a little friction carries a top from its launch to its steady state.

For small mu the tilt nutates as on a smooth table, lambda is constant, and what else the nutation
leaves alone, L3 and the energy, drifts at a rate proportional to mu: by friction's torque and power
averaged over one nutation (`tippetop.theory.dissipation`). Time enters only as mu t, which is why
the time to turn over goes as 1 / mu. The nutation dies away, and what is left follows the
precessions of the smooth table.

It is the limit of runs only while the nutation needs no pull of a table that pushes: beyond, they
fly.
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
from tippetop.problem.problem import Problem
from tippetop.support.errors import Described, InvalidInput, is_number, is_whole
from tippetop.theory.nutation import numbers_of
from tippetop.theory.nutation_decay import Goals, Nutation, Stage, follow_nutation, launched
from tippetop.theory.prediction import stable_by_energy
from tippetop.theory.steady import jellett_of_launch, steady_states


@dataclass(frozen=True)
class SlowFlow:
    """The tilt of a launch in the limit of small friction, as a function of mu t."""

    mu_time: Array
    """mu t, s^2/m, increasing, shape (n,)."""
    tilt_low: Array
    tilt_high: Array
    """Least and largest tilt of the nutation at that time, rad, shape (n,): equal once it has died
    away.
    """
    final_tilt: float
    """Tilt of the steady state the flow ends in, rad; nan if it cannot be followed that far: it
    ends where a table that only pushes does not hold so wide a nutation.
    """

    def tilts(self, mu_times: Array) -> tuple[Array, Array]:
        """Least and largest tilt at these values of mu t (s^2/m), rad: nan outside those
        followed.
        """
        low, high = (
            PchipInterpolator(self.mu_time, tilts, extrapolate=False)(mu_times)
            for tilts in (self.tilt_low, self.tilt_high)
        )
        return low, high


TOLERANCE = 1e-9
"""Error of the logarithms of the amplitudes in a step."""


def averaged_flow(
    problem: Problem, distance: float = 1e-6, samples: int = 200, tolerance: float = TOLERANCE
) -> SlowFlow:
    """The slow flow of a launch of an eccentric sphere with viscous friction; the size of mu does
    not matter.

    The horizontal velocity of its centre of mass has no part: it dies away by itself, unless one
    nutation brings the axis round just once (Limits in docs/theory/slow.md).

    The flow is followed to a `distance` from the final tilt, rad. Each of its parts, from one pole,
    and if it comes nearer, the other, is given at so many `samples` at least. The `tolerance` is
    the error of the logarithms of the amplitudes in a step.

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
    # Each begins where the one before ends.
    time, low, high = np.hstack([parts[0][:, :1], *(part[:, 1:] for part in parts)])
    return SlowFlow(time / float(problem.top.gravity), low, high, stages[-1].final_tilt)


def _stages(problem: Problem, distance: float, tolerance: float) -> list[Stage]:
    """The parts of the slow flow, each from the pole that the nutation is nearer to."""
    for field, value in {"distance": distance, "tolerance": tolerance}.items():
        if not (is_number(value) and value > 0.0):
            raise InvalidInput(field, value, "a finite number greater than 0")
    top = problem.top
    numbers = numbers_of(top)
    if numbers.alpha == 0.0:
        raise InvalidInput(
            "body.shape",
            Described("a centred sphere"),
            "an eccentric one: no other nutates by its weight",
        )
    if not isinstance(top.friction, ViscousLaw):
        raise InvalidInput(
            "friction", Described("this law"), "viscous friction; no other slip averages out"
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
    """The nutation that a launch of an eccentric sphere would keep on a smooth table, in natural
    units.

    Raises `InvalidInput` if the body is of another shape.
    """
    launch, time = problem.launch, float(natural_units(problem.top).time)
    rates = (launch.tilt_rate * time, 0.0, launch.precession * time, launch.spin * time)
    return launched(Angles(launch.tilt, *rates, (0.0, 0.0)), numbers_of(problem.top))


def flip_time_limit(problem: Problem, distance: float = 0.01) -> float:
    """Limit for small mu of mu times the flip time, s^2/m.

    The flip time is the first at which the tilt is within `distance` (rad) of its end. Raises
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
            return (begin + time) / float(problem.top.gravity)
        begin += float(stage.knots[-1])
    return begin / float(problem.top.gravity)


def _no_end(problem: Problem, stages: list[Stage]) -> InvalidInput:
    """The refusal of a launch whose slow flow is not followed to its end."""
    if stages[0].begin.grazes:
        other = (
            "far enough from the unstable vertical: here rounding decides how the nutation begins"
        )
        return InvalidInput("launch.tilt", problem.launch.tilt, other)
    pulled = stages[-1].pulled
    launch = (
        "one that needs a pull of the table"
        if pulled
        else "one whose nutation is not seen to die away"
    )
    return InvalidInput("launch", Described(launch), "one whose nutation dies away without a pull")


def _first_near(stage: Stage, final: float, distance: float) -> float | None:
    """First time at which a nutation is near its end, which it may pass long before it has died
    away.
    """

    def away(times: Array) -> Array:
        """How far the end is outside of the nutation, beyond what is near."""
        low, high = stage.tilts(times)
        return np.maximum(low - final, final - high) - distance

    def apart(times: Array) -> Array:
        fast, slow, _ = stage.points(times)
        return np.asarray(fast - slow)

    def beyond(times: Array) -> Array:
        low, high = stage.tilts(times)
        return low + high - 2.0 * final

    def of_one(function: Callable[[Array], Array]) -> Callable[[float], float]:
        return lambda time: float(function(np.array([time]))[0])

    shares = np.linspace(stage.knots[:-1], stage.knots[1:], _PER_STEP, endpoint=False).T.ravel()
    times = np.append(shares, stage.knots[-1])
    # It may be near for an instant only: where it goes through a vertical, or its middle through
    # the end.
    for through in (apart, beyond):
        ahead = through(times) > 0.0
        turns = np.flatnonzero(ahead[:-1] != ahead[1:])
        roots = [crossing(of_one(through), float(times[i]), float(times[i + 1])) for i in turns]
        times = np.union1d(times, roots)
    # Or where it comes near and turns back.
    values = away(times)
    around = np.pad(values, 1, constant_values=math.inf)
    lowest = (values <= 0.0) | (values <= np.minimum(around[:-2], around[2:]))
    for i in np.flatnonzero(lowest).tolist():
        before, here, after = times[[max(i - 1, 0), i, min(i + 1, len(times) - 1)]].tolist()
        least = values[i]
        if least > 0.0:
            here, least = dip(of_one(away), before, after)
        if least <= 0.0:
            return here if i == 0 and values[0] <= 0.0 else crossing(of_one(away), before, here)
    return None


def local_exponent(mu: Array, flip_time: Array) -> Array:
    """Exponent d ln t / d ln mu along a table of flip times, shape (n,): -1 where t goes as 1 /
    mu.
    """
    return np.asarray(np.gradient(np.log(flip_time), np.log(mu)))


_PER_STEP = 40
_MOST_STAGES = 20
