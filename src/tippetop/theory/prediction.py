"""Prediction of the end of a launch: the stable steady states that have its Jellett's integral.

Friction without drilling torque conserves lambda and dissipates energy as long as there is slip, in
flights and impacts too. So a run ends in a steady state with the lambda of its launch, and in a
stable one unless it starts exactly in another. If two are stable, the energy may decide: the tilt
can only move where the least energy for this lambda is below the current energy, so that a steady
state behind a higher barrier cannot be reached.

This holds while the table only pushes. A bilateral contact that pulls can add energy.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from tippetop.mechanics.invariants import energy, jellett
from tippetop.mechanics.state import State
from tippetop.mechanics.surfaces.hull import Hull
from tippetop.mechanics.surfaces.surface import MeridianSurface
from tippetop.mechanics.top import Top, natural_units
from tippetop.mechanics.view import axis_sine
from tippetop.problem.implausible import warn_if_implausible
from tippetop.problem.problem import Problem, require_problem, top_of
from tippetop.problem.shapes import Sphere
from tippetop.support.errors import Described, InvalidInput
from tippetop.theory.requirements import require_creep, require_jellett
from tippetop.theory.series_roots import roots_between
from tippetop.theory.steady import (
    SteadyKind,
    SteadyState,
    gyroscopic_reaction,
    jellett_of_launch,
    least_energy,
    level_spin,
    precession_at,
    steady_states,
    vertical_spin,
    weight_moment,
)


@dataclass(frozen=True)
class Prediction:
    """Possible ends of a launch by Jellett's integral and the energy.

    Examples
    --------
    >>> import tippetop as tt
    >>> prediction = tt.predict(tt.presets.report_problem(spin=155.0))
    >>> prediction.final in prediction.reachable
    True
    """

    jellett: float
    """lambda of the launch, kg m^3/s."""
    stable: tuple[SteadyState[float], ...]
    """All stable steady states with this lambda, the one of least energy first."""
    reachable: tuple[SteadyState[float], ...]
    """Those of `stable` that the energy of the launch allows, in the same order."""
    surface: int = 0
    """Number of the body's surface that the launch ends on."""

    @property
    def final(self) -> SteadyState[float]:
        """Reachable stable state of least energy: the end of the launch if that is `is_certain`."""
        return self.reachable[0]

    @property
    def is_certain(self) -> bool:
        """Whether only one stable state can be reached; otherwise details of the launch decide."""
        return len(self.reachable) == 1


def predict(problem: Problem) -> Prediction:
    """Return the steady states that a launch of an eccentric sphere can end in.

    A body of several surfaces, or of arcs that continue each other, must be launched on a sphere,
    with too little energy for the others to touch. A launch exactly in an unstable steady state,
    such as one at tilt 0 without a perturbation, stays there; the prediction is that of a slightly
    perturbed one.

    Raises
    ------
    InvalidInput
        If Jellett's integral is not conserved, friction is dry friction of a point or zero, or
        another surface of the body can touch.

    Examples
    --------
    >>> import tippetop as tt
    >>> ahead = tt.predict(tt.presets.report_problem(spin=155.0))
    >>> str(ahead.final.kind), round(ahead.final.spin, 2), ahead.is_certain
    ('inverted', -82.87, True)
    """
    require_problem(problem)
    warn_if_implausible(problem)
    return predicted(problem)


def predicted(problem: Problem) -> Prediction:
    """Return the result of `predict` without its warning, also for a part of a body."""
    top = top_of(problem)
    if isinstance(top.surface, Hull):
        return _prediction_of_several_surfaces(problem, hull_of(problem))
    if isinstance(top.surface, MeridianSurface):
        return _prediction_on_arc(problem, top.surface)
    require_jellett(top)
    require_creep(top)
    if problem.friction.vanishes:
        raise InvalidInput("friction.mu", 0.0, "more than 0: without friction no launch settles")
    jellett = jellett_of_launch(problem)
    states = steady_states(top, jellett)
    minima = stable_by_energy(states)
    available = float(energy(problem.start(), top))
    low, high = _reachable_tilts(states, problem.launch.tilt, available)
    within = [state for state in minima if low <= state.tilt <= high]
    return Prediction(jellett, _by_energy(minima), _by_energy(within or minima))


def _prediction_of_several_surfaces(problem: Problem, hull: Hull) -> Prediction:
    """Return the end on the surface of the launch, if its energy excludes contact of all others.

    Jellett's integral is conserved on one surface. When another touches, its new value depends on
    the details of the motion. With enough energy for another surface to touch, these details also
    decide whether it does: only under weak friction does the tilt follow a path that the theory
    knows, with a nutation about it that depends on the launch and on friction.
    """
    single = on_surface(problem, hull.active)
    prediction = predicted(single)
    available = float(energy(single.start(), top_of(single)))
    ends = touching_tilts(hull, problem.launch.tilt)
    for tilt, number in ends.items():
        needed = float(least_energy(tilt, prediction.jellett, top_of(single), math))
        if needed <= available:
            shown = Described(f"one whose surface {number} can touch, at a tilt of {tilt:.4g} rad")
            accepted = (
                f"one surface, or a launch with less energy than the {needed:.4g} J for which"
                f" that surface can touch; this launch has {available:.4g} J, and no theory says"
                " how it goes on after the second surface touches: simulate it instead"
            )
            raise InvalidInput("body.shape", shown, accepted)
    low, high = single_contact_tilts(hull, problem.launch.tilt)
    stable = tuple(state for state in prediction.stable if low <= state.tilt <= high)
    return replace(prediction, stable=stable, surface=hull.active)


def _prediction_on_arc(problem: Problem, surface: MeridianSurface) -> Prediction:
    """Return the end on the arc of the launch, if that is of a sphere and its energy excludes
    contact of the arcs beside it; else raise `InvalidInput`.
    """
    cosine, number = math.cos(problem.launch.tilt), 0
    while number < len(surface.cosines) and cosine <= surface.cosines[number]:
        number += 1
    arc = surface.arcs[number]
    if not arc.is_sphere:
        require_jellett(top_of(problem))
    ball = Sphere(radius=float(arc.tube), center=float(arc.center))
    body = problem.body.model_copy(update={"shape": ball})
    single = problem.model_copy(update={"body": body})
    prediction, top = predicted(single), top_of(single)
    low, high = 0.0, math.pi
    if number > 0:
        low = math.acos(surface.cosines[number - 1])
    if number < len(surface.cosines):
        high = math.acos(surface.cosines[number])
    available = float(energy(single.start(), top))
    for tilt in (low, high):
        if tilt in (0.0, math.pi):
            continue
        needed = float(least_energy(tilt, prediction.jellett, top, math))
        if needed <= available:
            raise InvalidInput(
                "body.shape",
                Described(f"one that leaves its sphere at a tilt of {tilt:.4g} rad"),
                f"a launch with less energy than the {needed:.4g} J for that: this one has"
                f" {available:.4g} J, and no theory says how it goes on",
            )
    stable = tuple(state for state in prediction.stable if low <= state.tilt <= high)
    return replace(prediction, stable=stable)


def hull_of(problem: Problem) -> Hull:
    """Return the surfaces of a body that has several, with that of the launch active."""
    hull = problem.standing().surface
    assert isinstance(hull, Hull)
    return hull


def on_surface(problem: Problem, number: int) -> Problem:
    """Return the problem with only one of the body's surfaces."""
    body = problem.body.model_copy(update={"shape": problem.body.shapes[number]})
    return problem.model_copy(update={"body": body})


def single_contact_tilts(hull: Hull, tilt: float) -> tuple[float, float]:
    """Return the tilts around `tilt`, rad, between which only the active surface touches."""
    return nearest(touching_tilts(hull, tilt), tilt)


def nearest(tilts: Iterable[float], tilt: float) -> tuple[float, float]:
    """Return the last of some tilts up to `tilt`, or 0, and the first above it, or pi, rad."""
    below, above = [at for at in tilts if at <= tilt], [at for at in tilts if at > tilt]
    return max(below, default=0.0), min(above, default=math.pi)


def touching_tilts(hull: Hull, tilt: float) -> dict[float, int]:
    """Return the nearest tilts on both sides of `tilt`, rad, at which another surface touches too.

    The values are the numbers of these surfaces.
    """
    numbers: dict[float, int] = {}
    for number, second in enumerate(hull.each):
        if number != hull.active:
            for at in _common_tilts(hull, second):
                numbers[at] = number
    return {at: numbers[at] for at in nearest(numbers, tilt) if at in numbers}


def _common_tilts(first: Hull, second: Hull) -> list[float]:
    """Return the tilts, rad, at which two surfaces touch together and the lower one changes."""

    def gap(at: float) -> float:
        return float(first.height(math.cos(at)) - second.height(math.cos(at)))

    return roots_between(gap, 0.0, math.pi, ROUNDING * float(first.size))


# translate: skip
def steady_state_of_launch(problem: Problem) -> SteadyState[float] | None:
    """Return the steady state that a launch starts in, to rounding, or None.

    Only the azimuth of such a launch changes. Raises `InvalidInput` if it turns too fast for the
    theory.
    """
    top, launch, start = top_of(problem), problem.launch, problem.start()
    jellett, units = jellett_of_launch(problem), natural_units(top)
    if launch.tilt in (0.0, math.pi):
        steady = vertical_spin(
            SteadyKind.INVERTED if launch.tilt else SteadyKind.UPRIGHT, top, launch.spin
        )
        rates = [launch.tilt_rate]
    else:
        c = start.axis[2]
        level = abs(top.surface.slope(c)) <= ROUNDING * units.length
        steady = (
            level_spin(top, launch.precession)
            if level
            else precession_at(launch.tilt, jellett, top)
        )
        gyroscopic = gyroscopic_reaction(c, top) * steady.precession**2
        unbalanced = 0.0 if level else (gyroscopic - weight_moment(c, top)) / units.inertia
        rates = [
            launch.tilt_rate,
            launch.precession - steady.precession,
            launch.spin - steady.spin,
            unbalanced * units.time / (1.0 + abs(steady.precession) * units.time),
        ]
    off = [rate * units.time for rate in rates]
    off += [speed / units.speed for speed in start.velocity]
    off.append((start.height - top.surface.height(start.axis[2])) / units.length)
    quickest = 1.0 + units.time * max(abs(steady.spin), abs(steady.precession))
    return steady if max(map(abs, off)) <= ROUNDING * quickest else None


def is_held(state: State, top: Top, closeness: float) -> NDArray[np.bool_]:
    """Return whether the energy confines an eccentric sphere's tilt to within `closeness`, rad.

    It does so for ever if the least energy for its Jellett's integral is above the current energy
    at both bounds: the tilt cannot pass there, and a stable steady state lies between. A bound
    beyond a vertical axis needs no barrier.

    All numbers of the states have shape (n,); those of the top may have it too.
    """
    tilt = np.arctan2(axis_sine(state.axis), state.axis[2])
    available, integral = energy(state, top), jellett(state, top)
    below, above = tilt - closeness, tilt + closeness
    bars_below = (below < 0.0) | (
        least_energy(np.maximum(below, 0.0), integral, top, np) > available
    )
    bars_above = (above > math.pi) | (
        least_energy(np.minimum(above, math.pi), integral, top, np) > available
    )
    held: NDArray[np.bool_] = bars_below & bars_above
    return held


def stable_by_energy(states: list[SteadyState[float]]) -> list[SteadyState[float]]:
    """Return the steady states that are minima of the energy.

    `states` are all steady states with one Jellett's integral, by tilt. They are the extrema of the
    least energy over the tilt: minima and maxima in turn.
    """
    energies = [math.inf, *(state.energy for state in states), math.inf]
    minima = [
        state
        for state, before, after in zip(states, energies, energies[2:], strict=False)
        if before > state.energy < after
    ]
    return minima or [min(states, key=lambda state: state.energy)]


ROUNDING = 1e-12
"""Relative difference below which numbers are equal: above it steady launches would be missed, and
far below it rounding would hide them."""


def _by_energy(states: list[SteadyState[float]]) -> tuple[SteadyState[float], ...]:
    return tuple(sorted(states, key=lambda state: state.energy))


def _reachable_tilts(
    states: list[SteadyState[float]], tilt: float, available: float
) -> tuple[float, float]:
    """Return the tilts of the nearest barriers on both sides, rad.

    Barriers are steady states with more energy than is available. A minimum of the energy always
    lies between them.
    """
    rounding = ROUNDING * max(abs(state.energy) for state in states)
    return nearest([state.tilt for state in states if state.energy > available + rounding], tilt)
