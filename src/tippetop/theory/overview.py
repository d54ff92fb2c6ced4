"""Everything the theory says of a launch, in one record."""

import math
from dataclasses import dataclass, replace

from tippetop.mechanics.hull import Hull
from tippetop.problem.frictions import ViscousFriction
from tippetop.problem.problem import Problem, require_problem
from tippetop.support.errors import InvalidInput
from tippetop.theory.averaging import flip_time_limit, nutation_of_launch
from tippetop.theory.drilling import standing_time
from tippetop.theory.groups import Group, classify_top, eccentricity, inertia_ratio
from tippetop.theory.prediction import (
    Prediction,
    hull_of,
    on_surface,
    predict,
    steady_launch,
    tilts_held,
)
from tippetop.theory.requirements import require_creep
from tippetop.theory.stability import Spectrum, spectrum
from tippetop.theory.steady import (
    VERTICAL_SPINS,
    SteadyKind,
    SteadyState,
    jellett_of_launch,
    vertical_spin,
)
from tippetop.theory.steady import steady_states as all_steady_states
from tippetop.theory.thresholds import CriticalSpins, critical_jellett, critical_spins


@dataclass(frozen=True)
class Judged:
    """A steady state with the eigenvalues of its linear motion."""

    state: SteadyState[float]
    spectrum: Spectrum


@dataclass(frozen=True)
class Outlook:
    """What can be said of a launch without simulating it."""

    inertia_ratio: float | None
    eccentricity: float | None
    """gamma = I1 / I3 and alpha; None for a shape other than an eccentric sphere."""
    group: Group | None
    """How such tops behave, or None; also on a tip that the centre of mass is outside of."""
    lambda_up: float
    lambda_down: float
    """Jellett's integrals, kg m^3/s, at which the upright spin loses and the inverted gains
    stability.
    """
    critical_spins: CriticalSpins
    """The spins of launches with this one's tilt and rates, rad/s, that have those integrals."""
    tilt: float
    """Tilt of this launch, rad."""
    jellett: float
    """lambda of this launch, kg m^3/s."""
    stays: Judged | None
    """The steady state that it is exactly on, and so stays in until it is disturbed, or None."""
    swings: tuple[float, float] | None
    """Without friction, the least and the largest tilt between which it swings for ever, rad, if it
    is of an eccentric sphere; None with friction.
    """
    prediction: Prediction | None
    """Where it can end, from beside a steady state if it is on one; None where nothing conserved
    says so, or nothing takes energy.
    """
    steady: tuple[Judged, ...]
    """Steady states, by tilt: all with the launch's lambda, or for a shape that does not conserve
    it, the two vertical spins at the launch's axial spin.
    """
    mu_flip_time: float | None
    """mu times the time (s^2/m) until within 0.01 rad of the end, in the limit of small friction;
    None where there is none, or no friction.
    """
    flip_time: float | None
    """The same divided by the problem's mu, s."""
    flip_time_needs: str | None
    """What a launch must be for these to be known, where it moves on viscous friction and they are
    not.
    """
    conserved: bool
    """Whether Jellett's integral is constant: for an eccentric sphere under friction without
    torque.
    """
    standing_time: float | None
    """Under friction that drills, how long a vertical spin stands, s: that of the launch, or else
    the inverted one with its lambda; None without drilling, and for a body that leans and is no
    sphere.
    """
    surface: int = 0
    tilts: tuple[float, float] = (0.0, math.pi)
    """Number of the surface that it is launched on, which alone all this is of, and the tilts, rad,
    between which no other touches.
    """


def outlook(problem: Problem) -> Outlook:
    """What the theory says of a launch: of a body of several surfaces, on the one that it is
    launched on.

    Raises `InvalidInput` if it turns so fast that the theory cannot tell, or hardly on dry
    friction; if a dry point rubs, or rolling is resisted.
    """
    top = problem.top
    if isinstance(top.surface, Hull):
        return _on_one_of_several(problem)
    require_creep(top)
    jellett = jellett_of_launch(problem)
    sphere, vertical = top.conserves_jellett, problem.launch.tilt in (0.0, math.pi)
    drills, smooth = not top.torque_free, problem.friction.vanishes
    stays = None if drills else steady_launch(problem)
    grouped = sphere and 0.0 < eccentricity(top) < 1.0
    limit, time, known_of = (
        _flip_times(problem) if grouped and stays is None else (None, None, None)
    )
    return Outlook(
        inertia_ratio=inertia_ratio(top) if sphere else None,
        eccentricity=eccentricity(top) if sphere else None,
        group=classify_top(top) if grouped else None,
        lambda_up=critical_jellett(SteadyKind.UPRIGHT, top),
        lambda_down=critical_jellett(SteadyKind.INVERTED, top),
        critical_spins=critical_spins(problem),
        tilt=problem.launch.tilt,
        jellett=jellett,
        stays=None if stays is None else Judged(stays, spectrum(stays, top)),
        swings=_swings(problem) if top.surface.spherical and smooth else None,
        prediction=predict(problem) if sphere and not smooth else None,
        steady=tuple(Judged(state, spectrum(state, top)) for state in steady_states(problem)),
        mu_flip_time=limit,
        flip_time=time,
        flip_time_needs=known_of,
        conserved=sphere,
        standing_time=standing_time(problem)
        if drills and (vertical or top.surface.spherical)
        else None,
    )


def _on_one_of_several(problem: Problem) -> Outlook:
    """The outlook on one of several surfaces, as far as no other touches.

    How it gets there is not told: another surface may touch on the way.
    """
    hull = hull_of(problem)
    found = outlook(on_surface(problem, hull.active))
    low, high = tilts_held(hull, problem.launch.tilt)
    try:
        prediction = predict(problem) if found.prediction else None
    except InvalidInput:
        prediction = None
    return replace(
        found,
        prediction=prediction,
        steady=tuple(judged for judged in found.steady if low <= judged.state.tilt <= high),
        mu_flip_time=None,
        flip_time=None,
        flip_time_needs=None,
        surface=hull.active,
        tilts=(low, high),
    )


def steady_states(problem: Problem) -> list[SteadyState[float]]:
    """Steady states that a launch might end in, by increasing tilt.

    All with its Jellett's integral, or where that is not conserved, both vertical spins at its
    axial spin. Of a body of several surfaces, those on the one that it is launched on, at tilts
    where no other touches.

    Raises
    ------
    InvalidInput
        If it turns so fast that the theory cannot tell, or hardly on dry friction; if a dry point
        rubs, or rolling is resisted.

    Examples
    --------
    >>> import tippetop as tt
    >>> for state in tt.steady_states(tt.presets.report_problem(spin=50.0)):
    ...     print(state.kind, round(state.tilt, 3), round(state.spin, 1))
    upright 0.0 49.6
    precession 1.504 -8.2
    inverted 3.142 -26.7
    """
    require_problem(problem)
    if isinstance(problem.top.surface, Hull):
        hull = hull_of(problem)
        low, high = tilts_held(hull, problem.launch.tilt)
        states = steady_states(on_surface(problem, hull.active))
        return [state for state in states if low <= state.tilt <= high]
    require_creep(problem.top)
    if problem.top.conserves_jellett:
        return all_steady_states(problem.top, jellett_of_launch(problem))
    return [vertical_spin(kind, problem.top, problem.launch.spin) for kind in VERTICAL_SPINS]


def _swings(problem: Problem) -> tuple[float, float]:
    """Turning tilts on a smooth table, rad; that of the launch is between them, whatever rounding
    says.
    """
    low, high = nutation_of_launch(problem).tilts
    return min(low, problem.launch.tilt), max(high, problem.launch.tilt)


def _flip_times(problem: Problem) -> tuple[float | None, float | None, str | None]:
    """Limit of mu times the flip time, and the flip time, where friction is viscous and the axis
    moves.

    And, where the limit is not known, what a launch must be for that.
    """
    launch, friction = problem.launch, problem.friction
    vertical = launch.tilt in (0.0, math.pi) and launch.tilt_rate == 0.0
    if vertical or friction.vanishes or not isinstance(friction, ViscousFriction):
        return None, None, None
    try:
        limit = flip_time_limit(problem)
    except InvalidInput as refusal:
        return None, None, refusal.accepted
    return limit, limit / friction.mu, None
