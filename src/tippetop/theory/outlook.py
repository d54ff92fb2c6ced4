"""Collection of all that the theory says of a launch: `outlook` returns an `Outlook`."""

import math
from dataclasses import dataclass, replace
from typing import Any

from tippetop.mechanics.surfaces.hull import Hull, lies_flat_at
from tippetop.mechanics.surfaces.surface import SphereSurface
from tippetop.mechanics.top import Top
from tippetop.problem.frictions import ViscousFriction
from tippetop.problem.problem import Problem, require_problem, top_of
from tippetop.support.errors import InvalidInput
from tippetop.theory.averaging import arrival_time_limit, nutation_of_launch
from tippetop.theory.drilling import standing_time
from tippetop.theory.groups import Group, classify_top, eccentricity, inertia_ratio
from tippetop.theory.level import Lying, lying
from tippetop.theory.prediction import (
    Prediction,
    hull_of,
    on_surface,
    predicted,
    single_contact_tilts,
    steady_state_of_launch,
)
from tippetop.theory.requirements import creeps, require_no_field, sticks
from tippetop.theory.resting_center import RestingCenter, resting_center_on
from tippetop.theory.rolling import rolling_states
from tippetop.theory.sleeping import Sleeping, sleeping
from tippetop.theory.stability import Spectrum, fastest_growth, has_spectrum, spectrum
from tippetop.theory.steady import (
    VERTICAL_SPINS,
    SteadyKind,
    SteadyState,
    end_of,
    has_level_spin,
    is_neutral,
    jellett_of_launch,
    level_spin,
    vertical_spin,
)
from tippetop.theory.steady import steady_states as all_steady_states
from tippetop.theory.thresholds import (
    CriticalSpins,
    can_stand,
    critical_jellett,
    critical_spin,
    stability_limits,
)


@dataclass(frozen=True)
class AnalysedState:
    """Steady state with the eigenvalues of its linear motion."""

    state: SteadyState[float]
    spectrum: Spectrum | None
    """None if the motion about it is not linear, or the state does not last."""

    @property
    def stable(self) -> bool:
        """Whether every small disturbance decays."""
        return self.spectrum is not None and self.spectrum.stable


NEAR_POLE = 0.5 * math.sqrt(2.0)
"""Sine of the tilt beyond which a launch is no attempt to stand the body on end."""


@dataclass(frozen=True)
class Standing:
    """Stability of a top-heavy body on its axis, at the end that the launch is nearer to."""

    kind: SteadyKind
    """The upright or the inverted spin."""
    smooth: Sleeping
    """Its gyroscopic threshold on a smooth table."""
    rolling: Sleeping
    """Its gyroscopic threshold where the contact rolls without slip."""
    pivot: Sleeping
    """Its gyroscopic threshold about a fixed point of contact, as in textbooks."""
    creep_spin: float
    """Axial spin, rad/s, above which creep does not tip it either; inf if there is none."""
    creep_time: float
    """Time in which creep makes a small tilt e times larger, s, under the viscous friction that
    does so fastest, at `creep_time_spin`; inf if it never does.
    """
    creep_time_spin: float
    """Spin of the launch if it is between the thresholds, and otherwise half-way between, rad/s."""


@dataclass(frozen=True)
class Outlook:
    """Theoretical results about a launch."""

    inertia_ratio: float | None
    eccentricity: float | None
    """gamma = I1 / I3 and alpha; None for a shape other than an eccentric sphere."""
    group: Group | None
    """Group of the eccentric sphere; None for other shapes, and for a centre of mass outside."""
    jellett_upright: float | None
    jellett_inverted: float | None
    """Jellett's integrals, kg m^3/s, at which the upright spin loses and the inverted spin gains
    stability; None without creep (see `creeps`).
    """
    critical_spins: CriticalSpins | None
    """Spins, rad/s, of launches with this tilt and rates that have these integrals; None without
    creep.
    """
    tilt: float
    """Tilt of this launch, rad."""
    jellett: float
    """Jellett's integral lambda of this launch, kg m^3/s."""
    stays: AnalysedState | None
    """Steady state that the launch starts in exactly, and stays in until disturbed, or None."""
    swings: tuple[float, float] | None
    """Least and largest tilt of an eccentric sphere without friction, rad; None for other
    shapes, and with friction.
    """
    prediction: Prediction | None
    """Possible ends of the launch, slightly disturbed if it starts in a steady state; None if
    Jellett's integral is not conserved, or there is no friction.
    """
    is_neutral: bool
    """Whether every tilt is a steady state with the same energy, as of a homogeneous ball."""
    steady: tuple[AnalysedState, ...]
    """Steady states, by tilt: all with the launch's lambda; for a shape that does not conserve it,
    both vertical spins with the launch's axial spin and the level spin with its precession.
    """
    mu_arrival_time: float | None
    """mu times the time (s^2/m) until within `averaging.ARRIVAL_DISTANCE` of the end, in the limit
    of small friction; None if there is no limit, or no friction.
    """
    arrival_time: float | None
    """`mu_arrival_time` divided by the problem's mu, s."""
    arrival_time_needs: str | None
    """Description of the launches that have these times; None if this one has, or friction is not
    viscous.
    """
    conserved: bool
    """Whether Jellett's integral is constant: for an eccentric sphere under friction without
    torque.
    """
    standing_time: float | None
    """Time for which drilling lets a vertical spin stand, s: the launch's own, or else the inverted
    one with its lambda; None without drilling, and for a tilted body that is no sphere.
    """
    creeps: bool
    """Whether friction is proportional to small slip: not under dry friction of a point, which
    sticks, not with rolling resistance, and not for a body that lies flat.
    """
    sticks: bool
    """Whether slip ends, under dry friction of a point; the top then rolls without loss."""
    standing: Standing | None
    """Stability on end of a body that is top-heavy at its nearer end; None for others."""
    lying: Lying | None
    """How the body lies, and when it rises from there; None if it does not lie."""
    resting_center: RestingCenter | None
    """Rolling at the launch's tilt with the centre of mass at rest; None if there is none."""
    surface: int = 0
    tilts: tuple[float, float] = (0.0, math.pi)
    """Number of the surface of the launch, to which all results apply, and the tilts, rad, between
    which no other surface touches.
    """


def outlook(problem: Problem) -> Outlook:
    """Return what the theory says of a launch, on the surface that it is launched on.

    Raises `InvalidInput` if the launch turns too fast for the theory, or hardly turns on dry
    friction of a patch, if the table slopes, or there is air.
    """
    top = top_of(problem)
    require_no_field(top)
    if isinstance(top.surface, Hull):
        return _outlook_of_several_surfaces(problem)
    jellett = jellett_of_launch(problem)
    sphere, vertical = top.conserves_jellett, problem.launch.tilt in (0.0, math.pi)
    drills, smooth = not top.torque_free, problem.friction.vanishes
    flat, creeping = lies_flat_at(top.surface, math.cos(problem.launch.tilt)), creeps(top)
    stays = None if drills or flat or sticks(top) else steady_state_of_launch(problem)
    grouped = sphere and 0.0 < eccentricity(top) < 1.0
    limit, time, needs = (
        _arrival_times(problem) if grouped and stays is None else (None, None, None)
    )
    return Outlook(
        inertia_ratio=inertia_ratio(top) if sphere else None,
        eccentricity=eccentricity(top) if sphere else None,
        group=classify_top(top) if grouped else None,
        jellett_upright=critical_jellett(SteadyKind.UPRIGHT, top) if creeping else None,
        jellett_inverted=critical_jellett(SteadyKind.INVERTED, top) if creeping else None,
        critical_spins=stability_limits(problem) if creeping else None,
        tilt=problem.launch.tilt,
        jellett=jellett,
        stays=None if stays is None else _analysed(stays, top),
        swings=_swings(problem) if top.surface.spherical and smooth else None,
        prediction=predicted(problem) if sphere and creeping and not smooth else None,
        is_neutral=is_neutral(top),
        steady=tuple(_analysed(state, top) for state in steady_states(problem)),
        mu_arrival_time=limit,
        arrival_time=time,
        arrival_time_needs=needs,
        conserved=sphere,
        standing_time=standing_time(problem)
        if creeping and drills and (vertical or top.surface.spherical)
        else None,
        creeps=creeping,
        sticks=sticks(top),
        standing=_standing(problem, top),
        lying=lying(top, problem.launch.tilt),
        resting_center=None if vertical else resting_center_on(problem.launch.tilt, top),
    )


def _analysed(state: SteadyState[float], top: Top) -> AnalysedState:
    return AnalysedState(state, spectrum(state, top) if has_spectrum(state.kind, top) else None)


def _standing(problem: Problem, top: Top) -> Standing | None:
    """Return the stability of a top-heavy body on the end that its launch is nearer to, or None."""
    launch, kind = problem.launch, SteadyKind.UPRIGHT
    if launch.tilt > math.pi / 2:
        kind = SteadyKind.INVERTED
    if not can_stand(kind, top):
        return None
    smooth, rolling = (sleeping(kind, top, launch.spin, rolls=rolls) for rolls in (False, True))
    if not rolling.spin or math.sin(launch.tilt) > NEAR_POLE:
        return None
    pole = end_of(kind)
    point = SphereSurface(0.0, -pole * float(top.surface.height(pole)))
    pivot = sleeping(kind, top.altered(surface=point), launch.spin, rolls=True)
    creep = critical_spin(kind, top)
    spin, time = abs(launch.spin), math.inf
    if rolling.spin < creep:
        if not rolling.spin < spin < creep:
            spin = 2.0 * rolling.spin if math.isinf(creep) else 0.5 * (rolling.spin + creep)
        growth = fastest_growth(kind, top, spin)
        time = 1.0 / growth if growth > 0.0 else math.inf
    return Standing(kind, smooth, rolling, pivot, creep, time, spin)


def _outlook_of_several_surfaces(problem: Problem) -> Outlook:
    """Return the outlook of a launch on one of several surfaces, for tilts where no other touches.

    It says nothing of the motion between two surfaces.
    """
    hull = hull_of(problem)
    single = outlook(on_surface(problem, hull.active))
    low, high = single_contact_tilts(hull, problem.launch.tilt)
    try:
        prediction = predicted(problem) if single.prediction else None
    except InvalidInput:
        prediction = None
    return replace(
        single,
        prediction=prediction,
        steady=tuple(judged for judged in single.steady if low <= judged.state.tilt <= high),
        mu_arrival_time=None,
        arrival_time=None,
        arrival_time_needs=None,
        standing=single.standing if low == 0.0 or high == math.pi else None,
        lying=lying(problem.standing(), problem.launch.tilt),
        surface=hull.active,
        tilts=(low, high),
    )


def steady_states(
    problem: Problem,
    *,
    tilt: Any = None,
    rate: Any = None,
    radius: Any = None,
    spin: Any = None,
) -> list[SteadyState[float]]:
    """Return the steady states that a launch might end in, or those with some numbers, by tilt.

    Without numbers they are all those with the launch's Jellett's integral or, if that is not
    conserved, both vertical spins with its axial spin and the level spin with its precession. Those
    of a body of several surfaces are on the surface that it is launched on, at tilts where no other
    touches. A body that lies flat when its axis is vertical has no vertical spin there, and one
    that does so at both ends has none of these.

    With one or two of the four numbers they are the motions in which the body rolls without slip
    at constant tilt, on any one of its surfaces, whatever the launch: its centre of mass rests
    where only one number is stated, and otherwise goes round a circle or straight on. A sharp tip
    stays at its place, and its states are the steady precessions of the heavy top.

    Parameters
    ----------
    problem
        The body, its friction and gravity, and the launch.
    tilt
        Tilt of the axis, rad, more than 0 and less than pi.
    rate
        Rate of the axis about the vertical (precession), rad/s; 0, beside a spin, for rolling
        straight.
    radius
        Radius of the circle of the centre of mass, m; 0 for one that rests, inf for rolling
        straight.
    spin
        Axial spin omega3, rad/s.

    Returns
    -------
    list of SteadyState
        With its tilt, precession and spin each is a launch. Beside every state with a tilt and a
        radius there is its mirror image, with the opposite rates.

    Raises
    ------
    InvalidInput
        If the launch turns too fast for the theory, the table slopes, or there is air. Of circles
        also if friction cannot hold the contact, and of numbers if they are no one or two of these.

    Notes
    -----
    Two of the four numbers determine the others by the balance of moments of
    `tippetop.theory.rolling` (E. J. Routh, Advanced Rigid Dynamics, 1905, sections 243-244).

    Examples
    --------
    >>> import tippetop as tt
    >>> for state in tt.steady_states(tt.presets.report_problem(spin=50.0)):
    ...     print(state.kind, round(state.tilt, 3), round(state.spin, 1))
    upright 0.0 49.6
    precession 1.504 -8.2
    inverted 3.142 -26.7

    A coin that rolls round a circle of 30 cm, in seconds a turn, and with what friction:

    >>> coin = tt.presets.report_problem().replace(
    ...     {"body": tt.presets.COIN, "friction": {"kind": "coulomb", "mu": 0.5}}
    ... )
    >>> (state,) = tt.steady_states(coin, tilt="70 deg", radius="30 cm")
    >>> round(6.2832 / state.precession, 3), round(state.friction, 3)
    (2.655, 0.171)
    """
    require_problem(problem)
    numbers = {"tilt": tilt, "rate": rate, "radius": radius, "spin": spin}
    if any(number is not None for number in numbers.values()):
        return rolling_states(problem, **numbers)
    require_no_field(top_of(problem))
    if isinstance(top_of(problem).surface, Hull):
        hull = hull_of(problem)
        low, high = single_contact_tilts(hull, problem.launch.tilt)
        states = steady_states(on_surface(problem, hull.active))
        return [state for state in states if low <= state.tilt <= high]
    top, launch = top_of(problem), problem.launch
    if top.conserves_jellett:
        return all_steady_states(top, jellett_of_launch(problem))
    kinds = [kind for kind in VERTICAL_SPINS if not lies_flat_at(top.surface, end_of(kind))]
    states = [vertical_spin(kind, top, launch.spin) for kind in kinds]
    if states and has_level_spin(top) and launch.precession:
        states.insert(1, level_spin(top, launch.precession))
    return states


def _swings(problem: Problem) -> tuple[float, float]:
    """Return the least and largest tilt on a smooth table, rad, including that of the launch."""
    low, high = nutation_of_launch(problem).tilts
    return min(low, problem.launch.tilt), max(high, problem.launch.tilt)


def _arrival_times(problem: Problem) -> tuple[float | None, float | None, str | None]:
    """Return the limit of mu times the flip time, the flip time, and which launches have them.

    The last is None if both are known. All are None for vertical spins and for friction that is not
    viscous.
    """
    launch, friction = problem.launch, problem.friction
    vertical = launch.tilt in (0.0, math.pi) and launch.tilt_rate == 0.0
    if vertical or friction.vanishes or not isinstance(friction, ViscousFriction):
        return None, None, None
    try:
        limit = arrival_time_limit(problem)
    except InvalidInput as refusal:
        return None, None, refusal.accepted
    return limit, limit / friction.mu, None
