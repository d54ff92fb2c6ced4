"""Where a launch ends: the stable steady states that have its Jellett's integral.

Friction without drilling torque leaves lambda alone and takes energy as long as there is slip, in flight
and in impacts too. So a run ends in a steady state with the lambda of its launch, and a stable one unless
it was put exactly on another. Where two are stable, energy may decide: the tilt can only move where the
least energy that goes with lambda is below what is left, and a steady state behind a barrier higher than
that is out of reach.

This holds while the table only pushes. A bilateral contact that pulls can give energy.
"""

import math
from dataclasses import dataclass

from tippetop.mechanics.invariants import energy
from tippetop.mechanics.top import Top
from tippetop.problem import Problem
from tippetop.theory.groups import eccentricity
from tippetop.theory.steady import SteadyState, jellett_of_launch, steady_states


@dataclass(frozen=True)
class Prediction:
    """What Jellett's integral and the energy say of the end of a launch.

    Attributes
    ----------
    jellett
        lambda of the launch, kg m^2/s.
    stable
        All stable steady states with this lambda, the one of least energy first.
    reachable
        Those among them that the energy of the launch does not bar, in the same order.
    """

    jellett: float
    stable: tuple[SteadyState, ...]
    reachable: tuple[SteadyState, ...]

    @property
    def final(self) -> SteadyState:
        """The reachable stable state of least energy: the end of the launch, if it is `certain`."""
        return self.reachable[0]

    @property
    def certain(self) -> bool:
        """Whether only one stable state is within reach; otherwise the launch's details decide."""
        return len(self.reachable) == 1


def predict(problem: Problem) -> Prediction:
    """The steady states a launch of an eccentric sphere can end in.

    A launch exactly on an unstable steady state, such as one at tilt 0 with no perturbation, stays there; the
    prediction is for one beside it.

    Raises
    ------
    InvalidInput
        If the body is not an eccentric sphere: for no other shape is Jellett's integral conserved.
    """
    top = problem.top
    eccentricity(top)
    jellett = jellett_of_launch(problem)
    states = steady_states(top, jellett)
    minima = stable_by_energy(states)
    available = float(energy(problem.start(), top))
    low, high = _reach(states, problem.launch.tilt, available)
    return Prediction(
        jellett, _by_energy(minima), _by_energy([state for state in minima if low <= state.tilt <= high])
    )


def final_states(top: Top, jellett: float) -> tuple[SteadyState, ...]:
    """The stable steady states of an eccentric sphere with this Jellett's integral, least energy first.

    Raises
    ------
    InvalidInput
        If the top is of another shape.
    """
    eccentricity(top)
    return _by_energy(stable_by_energy(steady_states(top, jellett)))


def stable_by_energy(states: list[SteadyState]) -> list[SteadyState]:
    """Those of all steady states with one Jellett's integral that are minima of the energy.

    Parameters
    ----------
    states
        All of them, by increasing tilt, as from `tippetop.theory.steady.steady_states`: the extrema of the
        least energy over the tilt, which are minima and maxima in turn.
    """
    energies = [math.inf, *(state.energy for state in states), math.inf]
    return [
        state
        for state, before, after in zip(states, energies, energies[2:], strict=False)
        if before > state.energy < after
    ]


def _by_energy(states: list[SteadyState]) -> tuple[SteadyState, ...]:
    return tuple(sorted(states, key=lambda state: state.energy))


def _reach(states: list[SteadyState], tilt: float, available: float) -> tuple[float, float]:
    """Tilts between the nearest barriers on both sides: steady states with more energy than is available."""
    barriers = [state.tilt for state in states if state.energy > available]
    below = [barrier for barrier in barriers if barrier <= tilt]
    above = [barrier for barrier in barriers if barrier >= tilt]
    return max(below, default=0.0), min(above, default=math.pi)
