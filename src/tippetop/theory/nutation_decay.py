"""Growth and decay of the two amplitudes of a nutation under weak friction.

Near a vertical the logarithms of the amplitudes are linear in time, so that a few large steps of a
method of high order are enough. The amplitudes are those about the nearer pole.
"""

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tippetop.integrators.base import Array
from tippetop.mechanics.runge_kutta import Point
from tippetop.mechanics.view import Angles
from tippetop.theory.dissipation import amplitude_rates, least_reaction
from tippetop.theory.nutation import (
    Amplitudes,
    Numbers,
    Orbit,
    amplitudes,
    orbit_of_amplitudes,
    orbit_of_angles,
    turned_orbit,
    turning_tilts,
)

if TYPE_CHECKING:
    from scipy.integrate import OdeSolution


class Nutation(NamedTuple):
    """Nutation at an instant, in natural units, described about the nearer pole."""

    orbit: Orbit
    """The nutation as if the nearer pole were theta = 0."""
    turned: bool
    """Whether the nearer pole is theta = pi."""
    log_scale: float = 0.0
    """Logarithm of the ratio of the amplitudes to those of `orbit`: the squares of very small
    amplitudes underflow, and such nutations are linear.
    """
    log_share: float = 0.0
    """Logarithm of a further factor of the smaller amplitude, if it is too small relative to the
    larger one to compute its rate.
    """

    @property
    def point(self) -> Point:
        """Integrated variables: logarithms of the amplitudes, and sqrt(|p3|)."""
        pair = amplitudes(self.orbit)
        least = _NO_AMPLITUDE * (pair.fast + pair.slow)
        fast = math.log(max(float(pair.fast), least)) + self.log_scale
        slow = math.log(max(float(pair.slow), least)) + self.log_scale
        if pair.fast > pair.slow:
            slow += self.log_share
        else:
            fast += self.log_share
        return (fast, slow, math.sqrt(abs(self.orbit.far)))

    @property
    def grazes(self) -> bool:
        """Whether it just reaches or just misses the other pole, so that rounding decides which."""
        return bool(abs(self.orbit.far) <= _SEPARATE**2)

    def turn(self, numbers: Numbers) -> "Nutation":
        """Return the nutation described about the other pole."""
        seen = turned_orbit(self.orbit, numbers.turned if self.turned else numbers)
        return Nutation(seen, not self.turned, log_share=self.log_share)

    @property
    def tilts(self) -> tuple[float, float]:
        """Least and largest tilt, rad."""
        near, far = (
            max(self.orbit.middle - self.orbit.half, 0.0),
            self.orbit.middle + self.orbit.half,
        )
        scale = math.exp(0.5 * self.log_scale)
        low, high = (2.0 * scale * math.asin(math.sqrt(min(0.5 * p, 1.0))) for p in (near, far))
        return (math.pi - high, math.pi - low) if self.turned else (low, high)


def nutation_of_angles(angles: Angles, numbers: Numbers) -> Nutation:
    """Return the nutation of a launch, in natural units."""
    seen = _exact_orbit(angles, numbers)
    turned = seen.middle > 1.0
    if turned:
        angles, numbers = _reversed_axis(angles), numbers.turned
        seen = _exact_orbit(angles, numbers)
    width = max(angles.tilt, abs(angles.tilt_rate), abs(angles.tilt * angles.precession))
    wider = _NARROW / width if 0.0 < width < _NARROW else 1.0
    wide = angles._replace(tilt=wider * angles.tilt, tilt_rate=wider * angles.tilt_rate)
    orbit = orbit_of_angles(wide, numbers)
    if (
        numbers.alpha < 0.0 and not orbit.far < -_SEPARATE
    ):  # it just reaches or just misses the other pole
        middle = max(seen.middle, seen.half, _SEPARATE)
        return Nutation(seen._replace(middle=middle, far=min(seen.far, -(_SEPARATE**2))), turned)
    return Nutation(orbit, turned, -2.0 * math.log(wider))


def _exact_orbit(angles: Angles, numbers: Numbers) -> Orbit:
    """Return the nutation of a motion, computed about the pole far from the third root."""
    if numbers.alpha > 0.0:
        return orbit_of_angles(angles, numbers)
    return turned_orbit(orbit_of_angles(_reversed_axis(angles), numbers.turned), numbers.turned)


def _reversed_axis(angles: Angles) -> Angles:
    """Return the same motion with the axis reversed."""
    tilt = math.pi - angles.tilt
    if tilt < 0.5 * math.pi:  # exact near pi; pi itself, as a float, means the vertical
        tilt = math.asin(math.sin(angles.tilt)) if angles.tilt < math.pi else 0.0
    return angles._replace(tilt=tilt, tilt_rate=-angles.tilt_rate, spin=-angles.spin)


class Goals(NamedTuple):
    """Possible ends of a flow."""

    tilts: list[float]
    """Tilts of the stable steady states, rad."""
    distance: float
    """Distance from one of them, rad, within which both turning points must come."""
    unilateral: bool
    """Whether the table only pushes, so that the flow ends where the table would have to pull."""


# translate: skip
class Stage(NamedTuple):
    """Part of the slow flow about one pole, in natural units."""

    knots: Array
    """mu t at the ends of its steps, from 0, shape (n,)."""
    path: "OdeSolution | None"
    """`Nutation.point` over mu t; None if there is no step."""
    begin: Nutation
    end: Nutation
    final_tilt: float
    """Tilt of the steady state that it ends in, rad, or nan."""
    done: bool
    """Whether the flow ends with it; otherwise the other pole has come nearer."""
    pulled: bool
    """Whether the flow ends there because the table would have to pull."""

    def tilts(self, times: Array) -> tuple[Array, Array]:
        """Return the least and largest tilt, rad, at times of shape (n,)."""
        return _tilts_of(self.points(times), self.begin.turned)

    def points(self, times: Array) -> Array:
        """Return `Nutation.point` at times of shape (n,), shape (3, n)."""
        if self.path is None:
            return np.array(self.begin.point)[:, None]
        return np.asarray(self.path(times))


# translate: skip
def follow_nutation(
    begin: Nutation, jellett: float, numbers: Numbers, goals: Goals, tolerance: float
) -> Stage:
    """Return a stage of the slow flow: it ends at a goal, near the other pole, or before a pull.

    The `tolerance` is the error of the logarithms of the amplitudes per step.
    """
    from scipy.integrate import DOP853, OdeSolution  # noqa: PLC0415 - slow to import

    turned, seen = begin.turned, begin.orbit
    seen_numbers = numbers.turned if turned else numbers
    point = np.array(begin.point)

    def rates(_: float, y: Array) -> Array:
        return np.array(rates_at((float(y[0]), float(y[1]), float(y[2])), jellett, seen_numbers))

    first = _LONGEST / max(1.0, _LONGEST * np.abs(rates(0.0, point)).max())
    solver = DOP853(rates, 0.0, point, _LONGEST, first_step=first, rtol=tolerance, atol=tolerance)
    knots, interpolants = [0.0], []
    final, done, pulled = math.nan, True, False
    for _ in range(_MOST_STEPS):
        fast, slow, root = solver.y.tolist()
        seen = orbit_of_amplitudes(amplitudes_of((fast, slow, root)), root, jellett, seen_numbers)
        pulled = goals.unilateral and least_reaction(seen, seen_numbers) < 0.0
        if pulled:
            break
        final = _reached(_tilts_of(solver.y, turned), goals)
        if math.isfinite(final):
            break
        if seen.middle > FAR_FROM_POLE:
            done = False
            break
        if solver.status == "finished" or solver.step() is not None:
            break
        knots.append(float(solver.t))
        interpolants.append(solver.dense_output())
    share = min(0.0, -abs(solver.y[0] - solver.y[1]) - math.log(LEAST_AMPLITUDE))
    path = OdeSolution(knots, interpolants) if interpolants else None
    return Stage(
        np.array(knots), path, begin, Nutation(seen, turned, log_share=share), final, done, pulled
    )


FAR_FROM_POLE = 1.3
"""Middle of the nutation, 1 - cos(theta), beyond which the other pole is clearly nearer."""

_NARROW = 1e-6
"""Amplitude of a nutation, rad, below which it is linear."""

_SEPARATE = 1e-6
"""Least third root, 1 + cos(theta), that is distinguished from a turning point at theta = pi."""

_NARROWEST = -55.0
"""Logarithm of the least amplitudes used: rates do not depend on smaller ones."""

_LONGEST = 1e5
"""Longest time followed, mu t in natural units: beyond it a flow is given up."""
_MOST_STEPS = 1000
LEAST_AMPLITUDE = 1e-7
"""Least ratio of an amplitude to the other at which rates are computed: below it the rate of the
smaller one is rounding.
"""

_NO_AMPLITUDE = 1e-16
"""Amplitude, relative to the sum, in place of 0, whose logarithm is infinite."""
_SUM_ROUNDING = 1e-12
"""Rounding by which the sum of the amplitudes' roots may exceed 1."""


def rates_at(point: Point, jellett: float, numbers: Numbers) -> Point:
    """Return the rates of a `Nutation.point` over mu t, in natural units.

    They are nan where there is no nutation, so that the step control rejects steps to there.
    """
    pair = amplitudes_of(point)
    if math.sqrt(pair.fast) + math.sqrt(pair.slow) <= 1.0 + _SUM_ROUNDING:
        try:
            rates = amplitude_rates(pair, point[2], jellett, numbers)
        except (ValueError, ZeroDivisionError):
            return (math.nan, math.nan, math.nan)
        return (rates.fast, rates.slow, rates.root)
    return (math.nan, math.nan, math.nan)


def amplitudes_of(point: Point) -> Amplitudes:
    """Return the amplitudes of a `Nutation.point`, enlarged if their rates would be rounding.

    The logarithmic rate of a small amplitude does not depend on its size, nor do the rates of two
    small ones.
    """
    lift = max(0.0, _NARROWEST - max(point[0], point[1]))
    fast, slow = math.exp(min(point[0] + lift, 0.0)), math.exp(min(point[1] + lift, 0.0))
    return Amplitudes(max(fast, LEAST_AMPLITUDE * slow), max(slow, LEAST_AMPLITUDE * fast))


# translate: skip
def _tilts_of(y: Array, turned: bool) -> tuple[Array, Array]:
    """Return the least and largest tilt of a `Nutation.point` about theta = 0, or about pi."""
    low, high = turning_tilts(Amplitudes(*np.exp(y[:2])))
    return (math.pi - high, math.pi - low) if turned else (low, high)


# translate: skip
def _reached(tilts: tuple[Array, Array], goals: Goals) -> float:
    """Return the tilt of the stable steady state that both turning points are close to, or nan."""
    low, high = tilts
    for goal in goals.tilts:
        if abs(low - goal) <= goals.distance and abs(high - goal) <= goals.distance:
            return goal
    return math.nan
