"""The slow flow while the top nutates: the two amplitudes of the nutation grow or decay by friction.

Near a vertical the logarithms of the amplitudes are linear in time, so that a few large steps of a method of
high order are enough. The amplitudes are those about the pole that the nutation is nearer to.
"""

import math
from contextlib import suppress
from typing import NamedTuple

import numpy as np
from scipy.integrate import DOP853, OdeSolution

from tippetop.integrators.base import Array
from tippetop.mechanics.view import Angles
from tippetop.theory.dissipation import AmplitudeRates, amplitude_rates
from tippetop.theory.drift import Drift, drift, smooth_precession
from tippetop.theory.nutation import (
    Amplitudes,
    Numbers,
    Orbit,
    amplitudes,
    orbit_of_amplitudes,
    orbit_of_angles,
    turning_tilts,
    upside_down,
)


class Nutation(NamedTuple):
    """A nutation at an instant, in natural units, seen from the pole that it is nearer to."""

    orbit: Orbit
    """As if that pole were theta = 0."""
    turned: bool
    """Whether it is theta = pi."""
    log_scale: float = 0.0
    """Logarithm of what the amplitudes are of those of `orbit`: for nutations so narrow that their squares
    are no numbers. They are linear."""

    @property
    def point(self) -> Array:
        """Logarithms of its amplitudes, and sqrt(|p3|): what is followed."""
        pair = amplitudes(self.orbit)
        least = _NO_AMPLITUDE * (pair.fast + pair.slow)
        logs = [math.log(max(amplitude, least)) + self.log_scale for amplitude in pair]
        return np.array([*logs, math.sqrt(abs(self.orbit.far))])

    def turn(self, numbers: Numbers) -> "Nutation":
        """The same seen from the other pole."""
        return Nutation(upside_down(self.orbit, numbers.turned if self.turned else numbers), not self.turned)

    @property
    def tilts(self) -> tuple[float, float]:
        """Its turning tilts, rad."""
        near, far = max(self.orbit.middle - self.orbit.half, 0.0), self.orbit.middle + self.orbit.half
        scale = math.exp(0.5 * self.log_scale)
        low, high = (2.0 * scale * math.asin(math.sqrt(min(0.5 * p, 1.0))) for p in (near, far))
        return (math.pi - high, math.pi - low) if self.turned else (low, high)


def launched(angles: Angles, numbers: Numbers) -> Nutation:
    """The nutation of a launch, both in natural units."""
    upright = orbit_of_angles(angles, numbers)
    turned = upright.middle > 1.0
    if turned:
        seen = upside_down(upright, numbers)
        numbers, tilt = numbers.turned, math.pi - angles.tilt
        if angles.tilt > 0.5 * math.pi:  # as exact as the tilt, but for pi itself, which is vertical
            tilt = math.asin(math.sin(angles.tilt)) if angles.tilt < math.pi else 0.0
        angles = angles._replace(tilt=tilt, spin=-angles.spin)
    width = max(angles.tilt, abs(angles.tilt_rate), abs(angles.tilt * angles.precession))
    wider = _NARROW / width if 0.0 < width < _NARROW else 1.0
    wide = angles._replace(tilt=wider * angles.tilt, tilt_rate=wider * angles.tilt_rate)
    orbit = orbit_of_angles(wide, numbers)
    if turned and not orbit.far < -_APART:  # where it just passes or just reaches the pole
        middle = max(seen.middle, seen.half, _APART)
        return Nutation(seen._replace(middle=middle, far=min(seen.far, -(_APART**2))), turned)
    return Nutation(orbit, turned, -2.0 * math.log(wider))


class Goals(NamedTuple):
    """Tilts of all and of the stable steady states, and how close the flow is to come to them, rad."""

    steady: list[float]
    stable: list[float]
    distance: float


class Stage(NamedTuple):
    """A part of the slow flow, in natural units."""

    time: Array
    """mu t from its begin, shape (n,)."""
    low: Array
    high: Array
    """Turning tilts of the nutation, rad, shape (n,)."""
    end: Nutation
    """The nutation at its end."""
    tail: Drift | None
    """The drift of the tilt that follows, or None."""
    final_tilt: float
    """Tilt of the steady state that it or its tail ends in, rad, or nan."""
    done: bool
    """Whether it leads to the end of the flow; otherwise the other pole has come nearer."""


def follow_nutation(
    begin: Nutation, jellett: float, numbers: Numbers, goals: Goals, samples: int, tolerance: float
) -> Stage:
    """Follow the amplitudes until the nutation has died away, is steady, or is nearer to the other pole.

    The turning tilts are given at so many `samples`. The `tolerance` is the error in a step, of the
    logarithms.
    """
    turned, seen = begin.turned, begin.orbit
    seen_numbers = numbers.turned if turned else numbers
    point = begin.point

    def rates(_: float, y: Array) -> Array:
        return np.array(_rates(_amplitudes_of(y), float(y[2]), jellett, seen_numbers))

    first = _LONGEST / max(1.0, _LONGEST * np.abs(rates(0.0, point)).max())
    solver = DOP853(rates, 0.0, point, _LONGEST, first_step=first, rtol=tolerance, atol=tolerance)
    knots, pieces = [0.0], []
    tail: Drift | None = None
    final, done = math.nan, True
    for _ in range(_MOST_STEPS):
        pair = _amplitudes_of(solver.y)
        seen = orbit_of_amplitudes(pair, float(solver.y[2]), jellett, seen_numbers)
        final = _reached(_seen_tilts(pair, turned), goals)
        if math.isfinite(final):
            break
        if _dies(seen, pair, AmplitudeRates(*solver.f)):
            path = upside_down(seen, seen_numbers) if turned else seen
            tail = _drift_from(path, jellett, numbers, goals)
            if tail is not None:
                final = tail.final_tilt
                break
        if seen.middle > _FAR_FROM_POLE:
            done = False
            break
        if solver.status == "finished" or solver.step() is not None:
            break
        knots.append(float(solver.t))
        pieces.append(solver.dense_output())
    times = np.linspace(0.0, knots[-1], samples if pieces else 1)
    points = OdeSolution(knots, pieces)(times) if pieces else point[:, None]
    low, high = _seen_tilts(Amplitudes(*np.exp(points[:2])), turned)
    return Stage(times, low, high, Nutation(seen, turned), tail, final, done)


_DEAD = 1e-3
"""Half-width of the nutation over sin^2(theta) below which the tilt alone is followed."""

_NEAR_POLE = 1e-10
"""sin^2(theta) below which the amplitudes are followed all the same: a tilt so near to pi is no number."""

_FAR_FROM_POLE = 1.3
"""Middle of the nutation, 1 - cos(theta), beyond which the other pole is clearly nearer."""

_NARROW = 1e-6
"""Amplitude of a nutation, rad, below which it is linear."""

_APART = 1e-6
"""Third root, 1 + cos(theta), that is told from the turning point at theta = pi."""

_NARROWEST = -55.0
"""Logarithm of amplitudes that are as good as any smaller ones."""

_LONGEST = 1e5
_MOST_STEPS = 400
_LEAST_AMPLITUDE = 1e-7
_NO_AMPLITUDE = 1e-16
_ROUNDING = 1e-12


def _rates(pair: Amplitudes, root: float, jellett: float, numbers: Numbers) -> AmplitudeRates:
    """Rates of the amplitudes; not a number where there is no nutation, so that the step is made smaller."""
    if math.sqrt(pair.fast) + math.sqrt(pair.slow) <= 1.0 + _ROUNDING:
        with suppress(ValueError, ZeroDivisionError):
            return amplitude_rates(pair, root, jellett, numbers)
    return AmplitudeRates(math.nan, math.nan, math.nan)


def _amplitudes_of(y: Array) -> Amplitudes:
    """The amplitudes with these logarithms, neither taken so small that its rate would be lost in rounding.

    The logarithmic rate of a small amplitude does not depend on its size, nor do those of two small ones.
    """
    lift = max(0.0, _NARROWEST - max(y[0], y[1]))
    fast, slow = math.exp(min(y[0] + lift, 0.0)), math.exp(min(y[1] + lift, 0.0))
    return Amplitudes(max(fast, _LEAST_AMPLITUDE * slow), max(slow, _LEAST_AMPLITUDE * fast))


def _seen_tilts(pair: Amplitudes, turned: bool) -> tuple[Array, Array]:
    """Turning tilts of a nutation seen from theta = 0, or from pi."""
    low, high = turning_tilts(pair)
    return (math.pi - high, math.pi - low) if turned else (low, high)


def _reached(tilts: tuple[Array, Array], goals: Goals) -> float:
    """Tilt of the stable steady state that the whole nutation is close to, or nan."""
    low, high = tilts
    for goal in goals.stable:
        if abs(low - goal) <= goals.distance and abs(high - goal) <= goals.distance:
            return goal
    return math.nan


def _dies(path: Orbit, pair: Amplitudes, rates: AmplitudeRates) -> bool:
    """Whether the nutation is small, and getting smaller, relative to the distance from the vertical."""
    sine_squared = path.middle * (2.0 - path.middle)
    if path.half > _DEAD * sine_squared or sine_squared < _NEAR_POLE:
        return False
    middle_rate = 2.0 * (pair.fast * rates.fast + pair.slow * rates.slow)
    widening = 0.5 * (rates.fast + rates.slow) - middle_rate * 2.0 * (1.0 - path.middle) / sine_squared
    return bool(widening < 0.0)


def _drift_from(path: Orbit, jellett: float, numbers: Numbers, goals: Goals) -> Drift | None:
    """The drift in the tilt alone from here on: along whichever precession the nutation goes about."""
    tilt = 2.0 * math.asin(math.sqrt(min(path.middle / 2.0, 1.0)))
    sine_squared = path.middle * (2.0 - path.middle)
    turning = (path.excess + path.axial * path.middle) / (numbers.transverse * sine_squared)
    c = np.float64(1.0 - path.middle)
    with np.errstate(invalid="ignore", divide="ignore"):
        fast, slow = (smooth_precession(c, jellett, which, numbers) for which in (True, False))
    if not math.isfinite(fast):
        return None
    nearer_fast = bool(abs(turning - fast) < abs(turning - slow))
    found = drift(tilt, jellett, nearer_fast, numbers, goals.steady, goals.distance)
    # On the way to an unstable state the nutation grows again.
    return found if found is not None and found.final_tilt in goals.stable else None
