"""Drift along the steady precessions of a smooth table: the slow flow once the nutation has died away.

On a smooth table a precession of constant tilt only needs its moments balanced, and may slip. In units of
mass, radius and gravity, with c = cos(theta), Jellett's integral fixes its rate by

    I1 (1 - alpha c) phi'^2 - lambda phi' - alpha (c - alpha) = 0,      L3 = I1 c phi' - alpha / phi',

a fast and a slow one (the other way round where lambda is negative). The friction of its slip turns L3 at
the rate -mu s^2 (omega3 - phi' (c - alpha)), N being the weight, and so moves the tilt, until the slip
vanishes in a steady state.
"""

import math
from typing import NamedTuple

import numpy as np

from tippetop.integrators.base import Array
from tippetop.mechanics.vectors import Scalar
from tippetop.theory.derivatives import derivative
from tippetop.theory.nutation import Numbers


class Drift(NamedTuple):
    """A drift of the tilt in time."""

    time: Array
    """mu t in natural units, from 0, shape (n,)."""
    tilt: Array
    """theta, rad, shape (n,), monotonic."""
    final_tilt: float
    """The steady tilt that it approaches, rad."""


def smooth_precession(c: Scalar, jellett: float, fast: bool, numbers: Numbers) -> Scalar:
    """Rate phi' of the fast or the slow precession on a smooth table with this Jellett's integral."""
    square = numbers.transverse * (1.0 - numbers.alpha * c)
    weight = 2.0 * numbers.alpha * (c - numbers.alpha)
    larger = jellett + math.copysign(1.0, jellett) * (jellett**2 + 2.0 * weight * square) ** 0.5
    return larger / (2.0 * square) if fast == (jellett >= 0.0) else -weight / larger


def axial_momentum(c: Scalar, precession: Scalar, numbers: Numbers) -> Scalar:
    """L3 of a precession on a smooth table."""
    return numbers.transverse * c * precession - numbers.alpha / precession


def slip_per_sine(c: Scalar, precession: Scalar, numbers: Numbers) -> Scalar:
    """Slip of a precession over sin(theta), omega3 - phi' (c - alpha): zero in a steady state."""
    spin = axial_momentum(c, precession, numbers) / numbers.axial
    return spin - precession * (c - numbers.alpha)


def drift(
    tilt: float, jellett: float, fast: bool, numbers: Numbers, steady_tilts: list[float], distance: float
) -> Drift | None:
    """The drift of the tilt from a precession to the steady state ahead, in natural units.

    It starts at a tilt, rad, in the fast or the slow precession, and is followed up to a distance, rad, from
    the steady state. Given are the tilts of all steady states with this Jellett's integral, vertical ones
    included. None where the precessions end or turn back on the way, so that the tilt alone does not describe
    it.

    Notes
    -----
    d(mu t) / d theta is integrated by Gauss's rule in ln((theta - start) / (end - theta)), between the steady
    states behind and ahead, in which it is smooth.
    """
    speed = float(_speeds(np.array([tilt]), jellett, fast, numbers)[0])
    if not math.isfinite(speed) or speed == 0.0:
        return None
    on_branch = [other for other in steady_tilts if _is_steady(other, jellett, fast, numbers)]
    ahead = [other for other in on_branch if (other - tilt) * speed > 0.0]
    behind = [other for other in on_branch if (other - tilt) * speed < 0.0]
    if not ahead:
        return None
    end = min(ahead, key=lambda other: abs(other - tilt))
    start = min(behind, key=lambda other: abs(other - tilt), default=tilt - math.copysign(1.0, speed))
    if abs(end - tilt) <= distance:
        return Drift(np.zeros(1), np.array([tilt]), end)

    first = math.log((tilt - start) / (end - tilt))
    last = math.log(abs(end - start) / distance - 1.0)
    edges = np.linspace(first, last, max(8, math.ceil((last - first) * _PANELS_PER_E_FOLD)) + 1)
    half = 0.5 * np.diff(edges)[:, None]
    nodes = 0.5 * (edges[1:] + edges[:-1])[:, None] + half * _GAUSS_NODES
    tilts = _between(nodes, start, end)
    speeds = _speeds(tilts, jellett, fast, numbers)
    if not np.all(speeds * math.copysign(1.0, speed) > 0.0):
        return None
    per_panel = (half * _GAUSS_WEIGHTS * (tilts - start) * (end - tilts) / ((end - start) * speeds)).sum(
        axis=1
    )
    time = np.concatenate([[0.0], np.cumsum(per_panel)])
    return Drift(time, _between(edges, start, end), end)


_GAUSS_NODES, _GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(4)
_PANELS_PER_E_FOLD = 8
_NO_SLIP = 1e-6


def _between(log_ratio: Array, start: float, end: float) -> Array:
    """The tilts with these values of ln((tilt - start) / (end - tilt))."""
    return np.asarray(end - (end - start) / (1.0 + np.exp(log_ratio)))


def _speeds(tilts: Array, jellett: float, fast: bool, numbers: Numbers) -> Array:
    """Speed d theta / d(mu t) in natural units; nan where there is no such precession."""

    def rate(c: Array) -> Scalar:
        return smooth_precession(c, jellett, fast, numbers)

    c = np.cos(tilts)
    with np.errstate(invalid="ignore", divide="ignore"):
        per_cosine = derivative(lambda c: axial_momentum(c, rate(c), numbers), c)
        speeds: Array = np.sin(tilts) * slip_per_sine(c, rate(c), numbers) / per_cosine
    return speeds


def _is_steady(tilt: float, jellett: float, fast: bool, numbers: Numbers) -> bool:
    """Whether a steady state's tilt is a steady state of these precessions, and not of the others."""
    if tilt in (0.0, math.pi):
        return True
    with np.errstate(invalid="ignore", divide="ignore"):
        c = np.float64(math.cos(tilt))
        rate = smooth_precession(c, jellett, fast, numbers)
        return bool(abs(slip_per_sine(c, rate, numbers)) < _NO_SLIP * abs(rate))
