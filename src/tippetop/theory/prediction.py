"""Where a launch ends: the stable steady states that have its Jellett's integral.

Friction without drilling torque leaves lambda alone and takes energy as long as there is slip, in
flight and in impacts too. So a run ends in a steady state with the lambda of its launch, and a
stable one unless it was put exactly on another. Where two are stable, energy may decide: the tilt
can only move where the least energy that goes with lambda is below what is left, and a steady state
behind a barrier higher than that is out of reach.

This holds while the table only pushes. A bilateral contact that pulls can give energy.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from tippetop.mechanics.invariants import energy, jellett
from tippetop.mechanics.state import State
from tippetop.mechanics.surfaces.hull import Hull
from tippetop.mechanics.top import Top, natural_units
from tippetop.mechanics.view import axis_sine
from tippetop.problem.implausible import warn_if_implausible
from tippetop.problem.problem import Problem, require_problem
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
    """What Jellett's integral and the energy say of the end of a launch."""

    jellett: float
    """lambda of the launch, kg m^3/s."""
    stable: tuple[SteadyState[float], ...]
    """All stable steady states with this lambda, the one of least energy first."""
    reachable: tuple[SteadyState[float], ...]
    """Those among them that the energy of the launch does not bar, in the same order."""
    surface: int = 0
    """Number of the body's surface that it ends on."""

    @property
    def final(self) -> SteadyState[float]:
        """The reachable stable state of least energy: the end of the launch, if it is `certain`."""
        return self.reachable[0]

    @property
    def certain(self) -> bool:
        """Whether only one stable state is within reach; otherwise the launch's details decide."""
        return len(self.reachable) == 1


def predict(problem: Problem) -> Prediction:
    """The steady states a launch of an eccentric sphere can end in.

    Of a body of several surfaces it tells the end on the one that it is launched on, if that is a
    sphere and the energy keeps the others off the table. A launch exactly on an unstable steady
    state, such as one at tilt 0 with no perturbation, stays there; the prediction is for one beside
    it.

    Raises
    ------
    InvalidInput
        If Jellett's integral is not conserved, a dry point rubs, there is no friction, or another
        surface of the body can touch.

    Examples
    --------
    >>> import tippetop as tt
    >>> ahead = tt.predict(tt.presets.report_problem(spin=155.0))
    >>> str(ahead.final.kind), round(ahead.final.spin, 2), ahead.certain
    ('inverted', -82.87, True)
    """
    require_problem(problem)
    warn_if_implausible(problem)
    return predicted(problem)


def predicted(problem: Problem) -> Prediction:
    """Return what `predict` does, also of a part of a body, and without a warning."""
    top = problem.top
    if isinstance(top.surface, Hull):
        return _on_one_of_several(problem, hull_of(problem))
    require_jellett(top)
    require_creep(top)
    if problem.friction.vanishes:
        raise InvalidInput("friction.mu", 0.0, "more than 0: without friction no launch settles")
    jellett = jellett_of_launch(problem)
    states = steady_states(top, jellett)
    minima = stable_by_energy(states)
    available = float(energy(problem.start(), top))
    low, high = _reach(states, problem.launch.tilt, available)
    within = [state for state in minima if low <= state.tilt <= high]
    return Prediction(jellett, _by_energy(minima), _by_energy(within or minima))


def _on_one_of_several(problem: Problem, hull: Hull) -> Prediction:
    """The end on the surface of the launch, where the energy of the launch keeps all others off the
    table.

    Jellett's integral holds on one surface. When another touches, it begins anew with a number that
    the whole motion decides. So does, with more energy than that takes, whether it touches at all:
    only where friction is weak does the tilt follow a path that the theory knows, and how far it
    nods beside that path goes with the launch and the friction.
    """
    alone = on_surface(problem, hull.active)
    found = predicted(alone)
    available = float(energy(alone.start(), alone.top))
    ends = touching_tilts(hull, problem.launch.tilt)
    for tilt, number in ends.items():
        needed = float(least_energy(tilt, found.jellett, alone.top, math))
        if needed <= available:
            shown = Described(f"one whose surface {number} can touch, at a tilt of {tilt:.4g} rad")
            accepted = (
                f"one surface, or a launch of less than the {needed:.4g} J that this takes; it has"
                f" {available:.4g} J, with which the whole motion decides whether that surface"
                " touches, and with what Jellett's integral the top goes on then: run it instead"
            )
            raise InvalidInput("body.shape", shown, accepted)
    low, high = tilts_held(hull, problem.launch.tilt)
    stable = tuple(state for state in found.stable if low <= state.tilt <= high)
    return replace(found, stable=stable, surface=hull.active)


def hull_of(problem: Problem) -> Hull:
    """The surfaces of a body that has several; that of the launch is active."""
    hull = problem.standing().surface
    assert isinstance(hull, Hull)
    return hull


def on_surface(problem: Problem, number: int) -> Problem:
    """The problem with one of the body's surfaces alone."""
    body = problem.body.model_copy(update={"shape": problem.body.shapes[number]})
    return problem.model_copy(update={"body": body})


def tilts_held(hull: Hull, tilt: float) -> tuple[float, float]:
    """The tilts around one, rad, between which no other surface touches beside the active one."""
    return nearest(touching_tilts(hull, tilt), tilt)


def nearest(tilts: Iterable[float], tilt: float) -> tuple[float, float]:
    """The last of some tilts up to one, and the first above it, rad; 0 and pi where there is
    none.
    """
    below, above = [at for at in tilts if at <= tilt], [at for at in tilts if at > tilt]
    return max(below, default=0.0), min(above, default=math.pi)


def touching_tilts(hull: Hull, tilt: float) -> dict[float, int]:
    """The tilts next to one, rad, at which another surface touches beside the active one, and its
    number.
    """
    found: dict[float, int] = {}
    for number, other in enumerate(hull.each):
        if number != hull.active:
            for at in _meetings(hull, other):
                found[at] = number
    return {at: found[at] for at in nearest(found, tilt) if at in found}


def _meetings(one: Hull, other: Hull) -> list[float]:
    """The tilts at which two surfaces touch together, rad, and change places, however soon
    again.
    """

    def gap(at: float) -> float:
        return float(one.height(math.cos(at)) - other.height(math.cos(at)))

    return roots_between(gap, 0.0, math.pi, ROUNDING * float(one.size))


# translate: skip
def steady_launch(problem: Problem) -> SteadyState[float] | None:
    """The steady state that a launch is exactly on, to rounding, or None: nothing but its azimuth
    changes.

    Raises `InvalidInput` if it turns too fast for the theory.
    """
    top, launch, start = problem.top, problem.launch, problem.start()
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
    """Whether the energy that is left holds an eccentric sphere's tilt within `closeness`, rad, for
    good.

    It does where the least energy that goes with Jellett's integral is above it on both sides: the
    tilt cannot pass there, and a stable steady state lies between. Beyond a vertical axis there is
    nothing to bar.

    Every number of the states is of shape (n,); the top has numbers or arrays of that shape.
    """
    tilt = np.arctan2(axis_sine(state.axis), state.axis[2])
    left, integral = energy(state, top), jellett(state, top)
    below, above = tilt - closeness, tilt + closeness
    bars_below = (below < 0.0) | (least_energy(np.maximum(below, 0.0), integral, top, np) > left)
    bars_above = (above > math.pi) | (
        least_energy(np.minimum(above, math.pi), integral, top, np) > left
    )
    held: NDArray[np.bool_] = bars_below & bars_above
    return held


def stable_by_energy(states: list[SteadyState[float]]) -> list[SteadyState[float]]:
    """Those of all steady states with one Jellett's integral, by their tilts, that are minima of
    the energy.

    They are the extrema of the least energy over the tilt, which are minima and maxima in turn.
    """
    energies = [math.inf, *(state.energy for state in states), math.inf]
    minima = [
        state
        for state, before, after in zip(states, energies, energies[2:], strict=False)
        if before > state.energy < after
    ]
    return minima or [min(states, key=lambda state: state.energy)]


ROUNDING = 1e-12
"""What counts as the same number, relative to the largest it is made of."""


def _by_energy(states: list[SteadyState[float]]) -> tuple[SteadyState[float], ...]:
    return tuple(sorted(states, key=lambda state: state.energy))


def _reach(states: list[SteadyState[float]], tilt: float, available: float) -> tuple[float, float]:
    """Tilts between the nearest barriers on both sides: steady states with more energy than is
    available.

    A minimum of the energy is between them, the lowest if nothing else.
    """
    rounding = ROUNDING * max(abs(state.energy) for state in states)
    return nearest([state.tilt for state in states if state.energy > available + rounding], tilt)
