"""Critical spins computed from the equations of motion: from spectra, and from runs of finite
length.
"""

import math
from collections.abc import Callable

import numpy as np
from scipy.optimize import brentq

from tippetop.integrators.base import Array
from tippetop.mechanics.motion import along_table
from tippetop.mechanics.top import Top, natural_units
from tippetop.problem.problem import Problem, top_of
from tippetop.support.errors import InvalidInput
from tippetop.theory.stability import linear_tilts, vertical_growth_rates
from tippetop.theory.steady import SteadyKind, vertical_spin
from tippetop.theory.thresholds import CriticalSpins, jellett_line, stability_limits

_SEARCH_FACTOR = 1.05
"""Ratio of neighbouring spins at which a root is sought."""


def critical_spin_from_spectrum(kind: SteadyKind, top: Top) -> float:
    """Return the axial spin, rad/s, at which the growth rate of a vertical spin vanishes; inf if
    none.

    Only the equations of motion and their derivatives are used, neither the energy nor Jellett's
    integral. The growth rate is sampled over spins up to 10^4 sqrt(g / size), and its first zero is
    refined.
    """
    unit = 1.0 / float(natural_units(top).time)
    spins = unit * np.geomspace(1e-2, 1e4, 241)
    growth = vertical_growth_rates(kind, top, spins)
    changes = np.flatnonzero(growth[:-1] * growth[1:] < 0.0)
    if changes.size == 0:
        return math.inf

    def growth_rate(spin: float) -> float:
        return float(vertical_growth_rates(kind, top, np.array([spin]))[0])

    first = int(changes[0])
    return float(brentq(growth_rate, spins[first], spins[first + 1], xtol=1e-14 * unit, rtol=1e-15))


def growth_rates_of_launches(kind: SteadyKind, problem: Problem, spins: Array) -> Array:
    """Return the growth rates, 1/s, of the vertical spins with the Jellett's integrals of launches.

    The launches are those of the problem with these spins, rad/s, shape (n,).
    """
    per_spin = vertical_spin(kind, top_of(problem), 1.0).jellett
    return vertical_growth_rates(
        kind, top_of(problem), jellett_line(problem).at(np.asarray(spins)) / per_spin
    )


def apparent_critical_spins(problem: Problem, window: float, visible: float) -> CriticalSpins:
    """Return the critical spins, rad/s, that runs of finite length show.

    Near its threshold a vertical spin attracts or repels slowly. A run that ends more than
    `visible` away from the vertical is counted as one that goes elsewhere. The upright spin
    therefore seems unstable already below its threshold (or only above it, if launches come closer
    than `visible` even at the threshold), and the inverted spin seems stable only above its own.

    The launch is near theta = 0, and its spin does not matter; `window` is the length of the runs,
    s, and `visible` the least distance from the vertical that is distinguished from 0, rad. Raises
    `InvalidInput` if it is not between 0 and the launch's tilt, or the window is not positive.

    Notes
    -----
    For the upright spin, the launch is followed in the linear motion about it. For the inverted
    spin, a distance of 1 rad at the start of the window decays at the growth rate of the inverted
    spin; the time of turning over is not counted, so this is a lower bound of the bias.
    """
    if not 0.0 < visible < problem.launch.tilt:
        raise InvalidInput("visible", visible, "a distance between 0 and the launch's tilt")
    if not window > 0.0:
        raise InvalidInput("window", window, "a positive time")
    real = stability_limits(problem)
    top, line = top_of(problem), jellett_line(problem)
    per_spin = vertical_spin(SteadyKind.UPRIGHT, top, 1.0).jellett

    def log_final_tilt(spin: float) -> float:
        upright = vertical_spin(SteadyKind.UPRIGHT, top, line.at(spin) / per_spin)
        start = along_table(problem.replace({"launch.spin": spin}).start())
        return math.log(float(linear_tilts(upright, top, start, np.array([window]))[0]) / visible)

    def log_final_distance(spin: float) -> float:
        rate = growth_rates_of_launches(SteadyKind.INVERTED, problem, np.array([spin]))
        return float(rate[0]) * window - math.log(visible)

    # If the motion at the threshold itself has come within `visible`, the bias is upward.
    settles = math.isfinite(real.upright) and log_final_tilt(real.upright) < 0.0
    upright = _nearest_root(log_final_tilt, real.upright, outward=settles)
    return CriticalSpins(upright, _nearest_root(log_final_distance, real.inverted, outward=True))


def _nearest_root(function: Callable[[float], float], start: float, outward: bool) -> float:
    """Return the first root above `start` or below it within a factor 100: inf or 0 if none."""
    if math.isinf(start):
        return start
    near, factor = start, _SEARCH_FACTOR if outward else 1.0 / _SEARCH_FACTOR
    for _ in range(95):
        far = near * factor
        if function(near) * function(far) <= 0.0:
            return float(brentq(function, near, far, rtol=1e-12))
        near = far
    return math.inf if outward else 0.0
