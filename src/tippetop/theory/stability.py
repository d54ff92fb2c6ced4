"""Linear stability of steady states, in a frame that turns with the precession.

A steady precession is an equilibrium of the equations of motion written in the frame that turns
about the vertical at its rate phi'. There the linear motion has constant coefficients, and its
eigenvalues decide. Three of them have no meaning: one belongs to the length of the axis, which is
a unit vector, and two are zero by symmetry, those of the turned and of the neighbouring steady
states. They are divided out exactly, because they form a Jordan block, whose eigenvalues rounding
would spread over 1e-8 of the others.

The Jacobian is that of `tippetop.mechanics.motion.sliding_rates` itself, differentiated exactly.

A vertical spin that drills loses spin, but at a rate that a disturbance does not change to first
order: its spectrum is that of its current spin. Drilling makes dry friction viscous there, with
mu_viscous = (3 pi / 8) mu / (R omega) for a patch of radius R with Hertz's pressure and mu / (rho
omega) for an ellipsoidal limit surface.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import expm

from tippetop.integrators.base import Array
from tippetop.mechanics.contacts.branches import on_branch
from tippetop.mechanics.contacts.forces import is_set_valued
from tippetop.mechanics.laws.friction import ViscousLaw
from tippetop.mechanics.motion import sliding_rates
from tippetop.mechanics.natural_units import Units
from tippetop.mechanics.state import SlidingState
from tippetop.mechanics.surfaces.hull import lies_flat_at
from tippetop.mechanics.top import Top, natural, natural_units
from tippetop.mechanics.vectors import Scalar
from tippetop.mechanics.view import Angles, state_from_angles
from tippetop.support.errors import Described, InvalidInput
from tippetop.theory.derivatives import derivative, jacobian
from tippetop.theory.requirements import creeps, require_creep, require_smooth_friction, sticks
from tippetop.theory.steady import (
    VERTICAL_SPINS,
    SteadyKind,
    SteadyState,
    end_of,
    gyroscopic_reaction,
    rolling_spin,
    state_of,
    vertical_spin,
    weight_moment,
)

Complex: TypeAlias = NDArray[np.complex128]

TURNED = "the same state turned about the vertical"
NEIGHBOUR = "the neighbouring steady state, of another Jellett's integral"

NEUTRAL = {
    SteadyKind.UPRIGHT: (NEIGHBOUR,),
    SteadyKind.INVERTED: (NEIGHBOUR,),
    SteadyKind.PRECESSION: (TURNED, NEIGHBOUR),
    SteadyKind.LEVEL: (TURNED, NEIGHBOUR),
}
"""Motions of the zero eigenvalues of each kind of steady state, which a `Spectrum` omits."""

NEUTRAL_GROWTH = 1e-12
"""Growth rate, relative to the largest eigenvalue, that counts as zero: a few times the rounding of
eigenvalues, below which stable and unstable states could not be distinguished."""

LEAST_DRILLING = 1e-6
"""Least spin of a drilling dry patch, natural units: at a lower one friction is so strong that the
other terms of the Jacobian are lost in rounding.
"""


@dataclass(frozen=True)
class Spectrum:
    """Eigenvalues of the linear motion about a steady state, without its neutral directions.

    Examples
    --------
    >>> import tippetop as tt
    >>> top = tt.presets.report_problem(spin=155.0)
    >>> [(state.kind.value, tt.spectrum(top, state).stable) for state in tt.steady_states(top)]
    [('upright', False), ('inverted', True)]
    """

    eigenvalues: Complex
    """1/s, by decreasing real part: 5 for a precession, 6 for a vertical spin."""
    frame_rate: float
    """Angular velocity of the frame about the vertical, rad/s: in another frame the imaginary parts
    of a vertical spin's eigenvalues shift by the difference.
    """
    neutral: tuple[str, ...]
    """Motions of the zero eigenvalues that were divided out, which symmetry implies."""

    @property
    def growth_rate(self) -> float:
        """Largest real part, 1/s."""
        return float(self.eigenvalues[0].real)

    @property
    def stable(self) -> bool:
        """Whether every perturbation decays; False also where one neither grows nor decays."""
        return self.growth_rate < -self._rounding

    @property
    def unstable(self) -> bool:
        """Whether some perturbation grows; False also where one neither grows nor decays."""
        return self.growth_rate > self._rounding

    @property
    def _rounding(self) -> float:
        return NEUTRAL_GROWTH * float(np.abs(self.eigenvalues).max())


def spectrum(steady: SteadyState[float], top: Top, frame_rate: float | None = None) -> Spectrum:
    """Return the eigenvalues of the linear motion about a steady state, under the top's friction.

    The motion is that in a frame which turns about the vertical at `frame_rate`, rad/s, or by
    default at the state's precession, which for a vertical spin is 0. Only a vertical spin is
    steady in other frames; for other states `frame_rate` is ignored.

    Raises `InvalidInput` if there is no linear motion: under dry friction of a point, with rolling
    resistance, and with drilling unless the state is a vertical spin that turns fast enough.
    """
    rate = steady.precession
    if frame_rate is not None and steady.kind in VERTICAL_SPINS:
        rate = frame_rate
    return Spectrum(eigenvalues(steady, top, rate)[0], rate, NEUTRAL[steady.kind])


def eigenvalues(steady: SteadyState[Scalar], top: Top, frame_rate: Scalar = None) -> Complex:
    """Return the eigenvalues about n steady states of one kind, 1/s, shape (n, 5 or 6).

    They are those of `spectrum`, by decreasing real part; nan where there is no such state.
    """
    frame = steady.precession if frame_rate is None else frame_rate
    tilt, precession, spin, frame = (
        np.ravel(each).astype(float)
        for each in np.broadcast_arrays(steady.tilt, steady.precession, steady.spin, frame)
    )
    exists = np.isfinite(precession)
    linear = _linear(
        steady.kind, tilt[exists], precession[exists], spin[exists], frame[exists], top
    )
    values: Complex = np.linalg.eigvals(linear.matrix).astype(complex) / linear.units.time
    order = np.lexsort((values.imag, -values.real))
    ordered = np.full((tilt.size, values.shape[-1]), complex(math.nan, math.nan))
    ordered[exists] = np.take_along_axis(values, order, axis=-1)
    return ordered


def vertical_growth_rates(kind: SteadyKind, top: Top, spins: Array) -> Array:
    """Return the growth rates of a vertical spin, 1/s, at axial spins of shape (n,), rad/s."""
    return np.asarray(eigenvalues(vertical_spin(kind, top, spins), top)[:, 0].real)


def has_spectrum(kind: SteadyKind, top: Top) -> bool:
    """Return whether the motion about steady states of a kind is linear: see `spectrum`."""
    if kind in VERTICAL_SPINS:
        return creeps(top) and not lies_flat_at(top.surface, end_of(kind))
    return top.torque_free and not sticks(top)


def fastest_growth(kind: SteadyKind, top: Top, spin: float) -> float:
    """Return the largest growth rate of a vertical spin, 1/s, under viscous friction of any size.

    The result is not positive if no viscous friction tips the spin. Very weak friction does not,
    because there is no creep, nor does very strong friction, under which the contact rolls.
    """
    unit = natural_units(top)
    rates = [
        float(
            vertical_growth_rates(kind, top.altered(friction=ViscousLaw(mu)), np.array([spin]))[0]
        )
        for mu in np.geomspace(1e-3, 1e3, 61) / float(unit.speed)
    ]
    return max(rates)


def linear_tilts(steady: SteadyState[float], top: Top, start: SlidingState, times: Array) -> Array:
    """Return the angle of the axis to the vertical in the linear motion about a vertical spin, rad.

    The motion starts in a state close to the spin, SI; the times after it, s, have shape (n,), and
    so has the result.
    """
    point = (np.array([steady.tilt]), np.zeros(1), np.array([steady.spin]))
    linear = _linear(steady.kind, *point, np.zeros(1), top)
    units = linear.units
    vertical = state_of(steady, top)
    tipped = np.subtract(start.axis, vertical.axis)
    turned = np.subtract(start.momentum, vertical.momentum) / units.angular_momentum
    away = np.concatenate([tipped, turned, np.divide(start.velocity, units.speed)])
    steps = np.asarray(times, dtype=float)[:, None, None] / units.time
    later = expm(steps * linear.matrix) @ (linear.basis[0].T @ away)
    horizontal = later @ linear.basis[0].T[:, :2]
    return np.asarray(np.hypot(horizontal[:, 0], horizontal[:, 1]))


class _Linear(NamedTuple):
    """Linear motion about n steady states in natural units: its matrix on a basis of the directions
    that are not divided out.
    """

    basis: Array
    matrix: Array
    units: Units


def _linear(
    kind: SteadyKind, tilt: Array, precession: Array, spin: Array, frame: Array, top: Top
) -> _Linear:
    """Return the linear motion about n steady states of one kind, shapes (n, 8, k) and (n, k,
    k).
    """
    units = Units(*(float(unit) for unit in natural_units(top)))
    if kind not in VERTICAL_SPINS:
        require_smooth_friction(top)
        if not top.torque_free:
            accepted = "one without torque: no precession is steady under this one"
            raise InvalidInput("friction", Described("this law"), accepted)
    scaled = natural(drilling(top, spin) if kind in VERTICAL_SPINS else top)
    angles = Angles(tilt, 0.0, 0.0, precession * units.time, spin * units.time, (0.0, 0.0))
    state = state_from_angles(angles, scaled, np)
    eight = (*state.axis, *state.momentum, *state.velocity)
    point = [np.broadcast_to(np.asarray(number, dtype=float), tilt.shape) for number in eight]

    matrix = jacobian(_rates_in_frame(scaled, frame * units.time), point)
    excluded = _divided_out(kind, angles, point, scaled)
    basis = np.linalg.qr(excluded, mode="complete").Q[..., excluded.shape[-1] :]
    return _Linear(basis, np.swapaxes(basis, -1, -2) @ matrix @ basis, units)


def drilling(top: Top, turning: Array) -> Top:
    """Return the top with the branch of its law for drilling with hardly any slip.

    `turning` are its rates about the vertical, rad/s. Raises `InvalidInput` if friction has no
    linear motion about a vertical spin, or if the top hardly turns on dry friction.
    """
    require_creep(top)
    if not is_set_valued(top.friction):
        return top
    slowest, time = float(np.min(np.abs(turning))), float(natural_units(top).time)
    if slowest * time < LEAST_DRILLING:
        accepted = (
            f"at least {LEAST_DRILLING / time:.2g} rad/s: without drilling the contact sticks"
        )
        raise InvalidInput("spin", slowest, accepted)
    return on_branch(top, (0.0, 0.0, 1.0))


def _rates_in_frame(top: Top, frame: Array) -> Callable[[Sequence[Any]], list[Any]]:
    """Return the function of the 8 numbers n, L, u that gives their rates in a turning frame."""

    def rates(y: Sequence[Any]) -> list[Any]:
        seen = list(sliding_rates(SlidingState.unpack(y), top).pack())
        for i, turned in enumerate(_turned(y)):
            seen[i] = seen[i] - frame * turned
        return seen

    return rates


def _turned(y: Sequence[Scalar]) -> tuple[Scalar, ...]:
    """Return z x n, z x L and z x u: the change of the 8 numbers by a turn about the vertical."""
    return (-y[1], y[0], 0.0, -y[4], y[3], 0.0, -y[7], y[6])


def _divided_out(kind: SteadyKind, angles: Angles, point: list[Array], top: Top) -> Array:
    """Return the directions to divide out, shape (n, 8, 2 or 3): off the unit sphere, and
    neutral.
    """
    zero = np.zeros_like(point[0])
    off_sphere = [*point[:3], *[zero] * 5]
    if kind in VERTICAL_SPINS:
        directions = [off_sphere, [*[zero] * 3, *point[:3], zero, zero]]
    elif kind is SteadyKind.LEVEL:
        directions = [off_sphere, list(_turned(point)), [*[zero] * 5, zero + 1.0, zero, zero]]
    else:
        directions = [off_sphere, list(_turned(point)), _along_branch(angles, top)]
    columns = [
        np.stack([number + zero for number in direction], axis=-1) for direction in directions
    ]
    return np.stack(columns, axis=-1)


def _along_branch(angles: Angles, top: Top) -> list[Array]:
    """Return the derivative of the steady precession by its tilt.

    The derivative of its rate follows from the balance of the moments.
    """

    def unbalanced(tilt: Array) -> Scalar:
        return (
            weight_moment(np.cos(tilt), top)
            - gyroscopic_reaction(np.cos(tilt), top) * angles.precession**2
        )

    steepness = 2.0 * weight_moment(np.cos(angles.tilt), top) / angles.precession
    slope = derivative(unbalanced, angles.tilt) / steepness

    def eight(point: list[Array]) -> Sequence[Array]:
        (tilt,) = point
        rate = angles.precession + slope * (tilt - angles.tilt)
        spin = rate * rolling_spin(np.cos(tilt), top.surface)
        return state_from_angles(Angles(tilt, 0.0, 0.0, rate, spin, (0.0, 0.0)), top, np).pack()

    return list(jacobian(eight, [angles.tilt])[..., 0].T)
