"""Everything the theory says of a launch, in one record."""

import math
from dataclasses import dataclass

from tippetop.mechanics.friction import ViscousLaw
from tippetop.problem import Problem
from tippetop.theory.averaging import flip_time_limit
from tippetop.theory.groups import Group, classify_top, eccentricity, inertia_ratio
from tippetop.theory.prediction import Prediction, predict
from tippetop.theory.stability import Spectrum, spectrum
from tippetop.theory.steady import SteadyKind, SteadyState, jellett_of_launch, steady_states, vertical_spin
from tippetop.theory.thresholds import CriticalSpins, critical_spins, lambda_down, lambda_up


@dataclass(frozen=True)
class Judged:
    """A steady state with the eigenvalues of its linear motion."""

    state: SteadyState
    spectrum: Spectrum


@dataclass(frozen=True)
class Outlook:
    """What can be said of a launch without simulating it.

    Attributes
    ----------
    inertia_ratio, eccentricity
        gamma = I1 / I3 and alpha; None for a shape other than an eccentric sphere.
    group
        How such tops behave, or None.
    lambda_up, lambda_down
        Jellett's integrals, kg m^3/s, at which the upright spin loses and the inverted spin gains stability.
    critical_spins
        The spins of launches like this one, rad/s, that have those integrals.
    jellett
        lambda of this launch, kg m^3/s.
    prediction
        Where it can end, or None where nothing conserved says so.
    steady
        Steady states, by tilt: all with the launch's lambda, or for a shape that does not conserve it, the
        two vertical spins at the launch's axial spin.
    mu_flip_time
        mu times the time (s^2/m) until within 0.01 rad of the end, in the limit of small friction; None
        where there is none.
    flip_time
        The same divided by the problem's mu, s.
    """

    inertia_ratio: float | None
    eccentricity: float | None
    group: Group | None
    lambda_up: float
    lambda_down: float
    critical_spins: CriticalSpins
    jellett: float
    prediction: Prediction | None
    steady: tuple[Judged, ...]
    mu_flip_time: float | None
    flip_time: float | None


def outlook(problem: Problem) -> Outlook:
    """What the theory says of a launch."""
    top = problem.top
    jellett = jellett_of_launch(problem)
    sphere = top.conserves_jellett
    states = (
        steady_states(top, jellett)
        if sphere
        else [
            vertical_spin(kind, top, problem.launch.spin)
            for kind in (SteadyKind.UPRIGHT, SteadyKind.INVERTED)
        ]
    )
    limit = _flip_time_limit(problem) if sphere else None
    mu = problem.friction.mu
    return Outlook(
        inertia_ratio=inertia_ratio(top) if sphere else None,
        eccentricity=eccentricity(top) if sphere else None,
        group=classify_top(top) if sphere else None,
        lambda_up=lambda_up(top),
        lambda_down=lambda_down(top),
        critical_spins=critical_spins(problem),
        jellett=jellett,
        prediction=predict(problem) if sphere else None,
        steady=tuple(Judged(state, spectrum(state, top)) for state in states),
        mu_flip_time=limit,
        flip_time=limit / mu if limit is not None and mu > 0 else None,
    )


def _flip_time_limit(problem: Problem) -> float | None:
    """Limit of mu times the flip time, where friction is viscous and the launch is not itself steady."""
    launch = problem.launch
    vertical = launch.tilt in (0.0, math.pi) and launch.tilt_rate == 0.0
    if vertical or not isinstance(problem.top.friction, ViscousLaw):
        return None
    limit = flip_time_limit(problem)
    return limit if math.isfinite(limit) else None
