"""Steady states of a body of revolution on a table: no slip, no friction, constant tilt.

In a steady precession the axis turns about the vertical at the rate phi' with constant tilt and
axial spin omega3, the centre of mass rests and the contact point does not slip. Zero slip gives
omega3 = phi' (c + h' / (h - h' c)), and the balance of the moments phi'^2 (I3 omega3 / phi' - I1 c)
= m g h', with c = cos(theta) and the support function h(c). For the eccentric sphere these are
equation (2.17) of the report, omega3 = phi' (c - alpha), and phi'^2 = m g R alpha / (I1 c + I3
(alpha - c)).

Friction does not enter: the states are the same under every friction law. Jellett's integral labels
them.
"""

import math
from dataclasses import dataclass
from enum import StrEnum
from typing import Generic, NamedTuple, TypeVar

import numpy as np

from tippetop.integrators.base import Array
from tippetop.mechanics.invariants import energy, jellett
from tippetop.mechanics.state import SlidingState, State
from tippetop.mechanics.surfaces.surface import Surface, contact_vector
from tippetop.mechanics.top import Top, natural, natural_units
from tippetop.mechanics.vectors import VERTICAL, Functions, Scalar, Vector, add, dot, scale
from tippetop.mechanics.view import Angles, state_from_angles
from tippetop.problem.problem import Problem, top_of
from tippetop.support.errors import InvalidInput
from tippetop.theory.series_roots import roots_between

Number = TypeVar("Number", float, Array)
"""One number, or many."""


class SteadyKind(StrEnum):
    """Kind of a steady state."""

    UPRIGHT = "upright"
    INVERTED = "inverted"
    PRECESSION = "precession"
    LEVEL = "level"
    """Axis horizontal, no axial spin, any precession: for shapes that are the same at both ends."""
    CIRCLE = "circle"
    """Rolling without slip while the centre of mass goes round a circle."""
    STRAIGHT = "straight"
    """Rolling without slip along a straight line."""


VERTICAL_SPINS = (SteadyKind.UPRIGHT, SteadyKind.INVERTED)


@dataclass(frozen=True)
class SteadyState(Generic[Number]):
    """Motion without slip that friction does not change, or many of one kind.

    The numbers are floats, or arrays of one shape; states with arrays cannot be compared.

    Examples
    --------
    >>> import tippetop as tt
    >>> tt.predict(tt.presets.report_problem(spin=155.0)).final.kind.value
    'inverted'
    """

    kind: SteadyKind
    """Vertical spin at theta = 0 or pi, steady precession, or level spin."""
    tilt: Number
    """theta, rad."""
    precession: Number
    """phi', rad/s; 0 by convention for a vertical spin, where only the axial spin has a meaning. It
    and the following numbers are nan where no precession at this tilt is steady.
    """
    spin: Number
    """Axial spin omega3, rad/s."""
    jellett: Number
    """Jellett's integral lambda, kg m^3/s."""
    energy: Number
    """Energy, J, in the convention of `tippetop.mechanics.invariants.energy`."""
    radius: float = 0.0
    """Radius of the circle of the centre of mass, m: 0 where it rests, inf where it moves straight.
    """
    friction: float = 0.0
    """Least coefficient of static friction that holds the contact; 0 where no friction acts."""


class RollingPrecession(NamedTuple):
    """Precession without slip, per unit precession, whether steady or not."""

    axis: Vector
    """Axis n."""
    momentum: Vector
    """L / phi', kg m^2."""
    jellett: Scalar
    """lambda / phi', kg m^3."""


def rolling_precession(tilt: Scalar, top: Top, functions: Functions) -> RollingPrecession:
    """Return the precession without slip at a tilt, rad, with the axis in the xz plane.

    Its angular momentum is L = phi' I1 (z - c n) + I3 omega3 n.
    """
    axis = (functions.sin(tilt), 0.0, functions.cos(tilt))
    along = scale(gyroscopic_reaction(axis[2], top), axis)
    momentum = add(scale(top.transverse_inertia, VERTICAL), along)
    return RollingPrecession(axis, momentum, jellett(_at_rest(axis, momentum, top), top))


def rolling_spin(c: Scalar, surface: Surface) -> Scalar:
    """Return omega3 / phi' of a precession without slip, c + h' / (h - h' c): (2.17) for the
    sphere.
    """
    slope = surface.slope(c)
    return c + slope / (surface.height(c) - slope * c)


def has_precession(top: Top) -> bool:
    """Return whether the body has precessions without slip: a sharp tip has none, since only a spin
    about its axis leaves it at rest.
    """
    return not (top.surface.spherical and top.surface.height(0.0) == 0.0)


def is_neutral(top: Top) -> bool:
    """Return whether every tilt is a steady state with the same energy: of a ball whose centre of
    mass is in its middle and whose moments of inertia are equal.
    """
    scale_of_moments = HOMOGENEOUS * top.transverse_inertia
    return bool(
        top.surface.spherical
        and abs(top.surface.slope(1.0)) <= HOMOGENEOUS * top.surface.size
        and abs(top.transverse_inertia - top.axial_inertia) <= scale_of_moments
    )


HOMOGENEOUS = 1e-12
"""Eccentricity, and relative difference of moments of inertia, up to which a ball is homogeneous:
rounding of numbers that were computed from a profile.
"""


def gyroscopic_reaction(c: Scalar, top: Top) -> Scalar:
    """Return the gyroscopic moment of a precession without slip over phi'^2 sin(theta), kg m^2.

    It is I3 omega3 / phi' - I1 c.
    """
    return top.axial_inertia * rolling_spin(c, top.surface) - top.transverse_inertia * c


def weight_moment(c: Scalar, top: Top) -> Scalar:
    """Return the moment of the weight over sin(theta), m g h', J."""
    return top.mass * top.gravity * top.surface.slope(c)


def balance_of_moments(tilt: Scalar, jellett: Scalar, top: Top, functions: Functions) -> Scalar:
    """Return lambda^2 (I3 omega3 / phi' - I1 c) - m g h' (lambda / phi')^2, the balance of moments.

    It vanishes where the precession without slip at a tilt, rad, with this Jellett's integral is
    steady. It is regular where phi' is infinite, and changes sign at the extrema of `least_energy`.
    """
    c = functions.cos(tilt)
    rolling = rolling_precession(tilt, top, functions).jellett
    return jellett**2 * gyroscopic_reaction(c, top) - weight_moment(c, top) * rolling**2


def precession_rate_squared(c: Scalar, top: Top) -> Scalar:
    """Return phi'^2 of the steady precession, rad^2/s^2; there is none if this is not positive."""
    return weight_moment(c, top) / gyroscopic_reaction(c, top)


# translate: skip
def precession_branch(top: Top, tilts: Array) -> SteadyState[Array]:
    """Return the steady precessions with phi' > 0 at tilts of any shape, rad; 0 and pi as limits.

    Those with phi' < 0 are their mirror images. Where there is none, all numbers but the tilt are
    nan.
    """
    tilts = np.asarray(tilts, dtype=float)
    rolling = rolling_precession(tilts, top, np)
    with np.errstate(divide="ignore", invalid="ignore"):
        squared = precession_rate_squared(rolling.axis[2], top)
        rate = np.sqrt(np.where(np.isfinite(squared) & (squared > 0), squared, np.nan))
    return _precession(tilts, rate, rolling, top)


def branch_jellett(tilt: float, top: Top) -> float:
    """Return the size of Jellett's integral of the steady precession at a tilt, kg m^3/s; inf if
    there is none.
    """
    if not has_precession(top):
        return math.inf
    rolling = rolling_precession(tilt, top, math)
    try:
        squared = precession_rate_squared(rolling.axis[2], top)
    except ZeroDivisionError:
        return math.inf
    return abs(squared**0.5 * rolling.jellett) if squared > 0.0 else math.inf


def end_of(kind: SteadyKind) -> float:
    """Return the cosine of the tilt of a vertical spin."""
    return 1.0 if kind is SteadyKind.UPRIGHT else -1.0


def vertical_spin(kind: SteadyKind, top: Top, spin: Number) -> SteadyState[Number]:
    """Return the vertical spin at theta = 0 or pi with a finite axial spin omega3, rad/s."""
    c = end_of(kind)
    still = 0.0 * abs(spin)
    tilt = still if kind is SteadyKind.UPRIGHT else still + math.pi
    return _steady(
        kind, tilt, still, spin, (0.0, 0.0, c), (0.0, 0.0, c * top.axial_inertia * spin), top
    )


def level_spin(top: Top, precession: float) -> SteadyState[float]:
    """Return the spin with horizontal axis at a precession, rad/s, of a shape that has one."""
    momentum = (0.0, 0.0, top.transverse_inertia * precession)
    return _steady(SteadyKind.LEVEL, math.pi / 2, precession, 0.0, (1.0, 0.0, 0.0), momentum, top)


def steady_states(top: Top, jellett: float) -> list[SteadyState[float]]:
    """Return all steady states with a Jellett's integral lambda, kg m^3/s, by increasing tilt.

    For an eccentric sphere it is conserved, and these are all the states that a motion can end in;
    for other shapes it only labels them. Friction does not matter.

    Notes
    -----
    With lambda = phi' Lambda(theta), a steady precession is a root of lambda^2 (I3 omega3/phi' - I1
    c) - m g h' Lambda^2, which is regular everywhere (a polynomial of degree 4 in c for the
    eccentric sphere).
    """
    units = [vertical_spin(kind, top, 1.0) for kind in VERTICAL_SPINS]
    # With the centre of mass on the table, lambda of every vertical spin is 0.
    least = ZERO_JELLETT * top.axial_inertia * top.surface.size
    vertical = [
        vertical_spin(unit.kind, top, jellett / unit.jellett)
        for unit in units
        if abs(unit.jellett) > least
    ]
    between = [precession_at(tilt, jellett, top) for tilt in _precession_tilts(top, jellett)]
    if has_level_spin(top):
        between.append(level_spin(top, jellett / level_spin(top, 1.0).jellett))
    return sorted([*vertical, *between], key=lambda state: state.tilt)


ZERO_JELLETT = 1e-13
"""Jellett's integral of a unit spin, over I3 and the size, that counts as zero: rounding of a
centre of mass on the table.
"""


def has_level_spin(top: Top) -> bool:
    """Return whether the body can spin with its axis horizontal at any rate."""
    return bool(top.surface.slope(0.0) == 0.0)


def jellett_of_launch(problem: Problem) -> float:
    """Return Jellett's integral of a launch, kg m^3/s.

    Raises `InvalidInput` if it turns so fast that the weight is lost in rounding.
    """
    fastest = FASTEST / float(natural_units(top_of(problem)).time)
    for name in ("spin", "tilt_rate", "precession"):
        rate = getattr(problem.launch, name)
        if abs(rate) > fastest:
            raise InvalidInput(
                f"launch.{name}", rate, f"at most {fastest:.3g} rad/s", "is too fast for the theory"
            )
    return float(jellett(problem.start(), top_of(problem)))


def least_energy(tilt: Scalar, jellett: Scalar, top: Top, functions: Functions) -> Scalar:
    """Return the least energy, J, of a body with a tilt, rad, and a Jellett's integral, kg m^3/s.

    It is lambda^2 / (2 a.I a) + m g h. Its minima over the tilt are the stable steady states,
    because friction only dissipates energy and conserves lambda (Bou-Rabee, Marsden and Romero
    2004; Ebenfeld and Scheck 1995).
    """
    axis = (functions.sin(tilt), 0.0, functions.cos(tilt))
    potential = energy(_at_rest(axis, (0.0, 0.0, 0.0), top), top)
    arm = contact_vector(axis, top.surface)
    along = dot(arm, axis)
    inertia = top.transverse_inertia * (dot(arm, arm) - along**2) + top.axial_inertia * along**2
    return potential + 0.5 * jellett**2 / inertia


# translate: skip
def state_of(steady: SteadyState[float], top: Top) -> SlidingState:
    """Return the mechanical state of a steady state, with the axis in the xz plane."""
    angles = Angles(steady.tilt, 0.0, 0.0, steady.precession, steady.spin, (0.0, 0.0))
    return state_from_angles(angles, top, math)


def _at_rest(axis: Vector, momentum: Vector, top: Top) -> State:
    """Return the state of the body on the table with its centre of mass at rest."""
    zero = (0.0, 0.0, 0.0)
    return State(axis, momentum, zero, top.surface.height(axis[2]))


def precession_at(tilt: float, jellett: float, top: Top) -> SteadyState[float]:
    """Return the steady precession at a tilt at which there is one with this Jellett's integral."""
    rolling = rolling_precession(tilt, top, math)
    return _precession(tilt, jellett / rolling.jellett, rolling, top)


def _precession(
    tilt: Number, rate: Number, rolling: RollingPrecession, top: Top
) -> SteadyState[Number]:
    """Return the steady precession at a tilt and rate, from the rolling one at this tilt."""
    spin, momentum = (
        rate * rolling_spin(rolling.axis[2], top.surface),
        scale(rate, rolling.momentum),
    )
    return _steady(SteadyKind.PRECESSION, tilt, rate, spin, rolling.axis, momentum, top)


def _steady(
    kind: SteadyKind,
    tilt: Number,
    precession: Number,
    spin: Number,
    axis: Vector,
    momentum: Vector,
    top: Top,
) -> SteadyState[Number]:
    """Return the steady state with these angles, rates, axis and angular momentum."""
    state = _at_rest(axis, momentum, top)
    return SteadyState(kind, tilt, precession, spin, jellett(state, top), energy(state, top))


FASTEST = 1e8
"""Largest angular velocity of the theory, natural units: at higher ones the weight is lost in
rounding.
"""


def _precession_tilts(top: Top, jellett: float) -> list[float]:
    """Return the tilts of the steady precessions with a Jellett's integral."""
    if not has_precession(top):
        return []
    scaled, integral = natural(top), jellett / float(natural_units(top).jellett)
    square = integral**2

    def balance(c: float) -> float:
        return float(balance_of_moments(math.acos(c), integral, scaled, math) / (1.0 + square))

    inertias = scaled.transverse_inertia + scaled.axial_inertia
    noise = 1e-15 * inertias * square / (1.0 + square)
    cosines = roots_between(balance, -1.0, 1.0, noise)
    level = 1e-9 * top.surface.size
    return [math.acos(c) for c in cosines if abs(top.surface.slope(c)) > level]
