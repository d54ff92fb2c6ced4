"""Critical spins: where a vertical spin gains or loses its stability.

A vertical spin changes stability where the branch of steady precessions reaches the vertical, so its critical
Jellett's integral is the limit of the branch at the pole:

    lambda_up   = sqrt(m g R^3 I3 alpha) (1 - alpha)^2 / sqrt(alpha + gamma - 1)     at theta = 0,
    lambda_down = sqrt(m g R^3 I3 alpha) (1 + alpha)^2 / sqrt(1 + alpha - gamma)     at theta = pi

for the eccentric sphere, gamma = I1 / I3. Friction does not enter. The same numbers come out of the spectrum
of the vertical spin, with friction, as the zeros of its growth rate: see `critical_spin_from_spectrum`.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from tippetop.errors import InvalidInput
from tippetop.mechanics.motion import along_table
from tippetop.mechanics.top import Top, natural_units
from tippetop.mechanics.vectors import Scalar
from tippetop.problem import Problem
from tippetop.theory.dual import Array
from tippetop.theory.requirements import require_creep
from tippetop.theory.stability import linear_tilts, vertical_growth_rates
from tippetop.theory.steady import (
    VERTICAL_SPINS,
    SteadyKind,
    jellett_of_launch,
    precession_branch,
    vertical_spin,
)


@dataclass(frozen=True)
class CriticalSpins:
    """Spins of a launch, rad/s, at which the two vertical spins change stability.

    Attributes
    ----------
    upright
        omega_c1: an eccentric sphere launched with more spin leaves theta = 0; inf if it never does.
    inverted
        omega_c2: launched with more spin it stays at theta = pi once there; inf if it never does.
    """

    upright: float
    inverted: float


def critical_jellett(kind: SteadyKind, top: Top) -> float:
    """Jellett's integral at which a vertical spin changes stability, kg m^3/s: inf where it never does."""
    limit = float(precession_branch(top, np.array([vertical_spin(kind, top, 0.0).tilt])).jellett[0])
    return abs(limit) if math.isfinite(limit) else math.inf


def lambda_up(top: Top) -> float:
    """Jellett's integral below which the upright spin of an eccentric sphere is stable, kg m^3/s, or inf."""
    return critical_jellett(SteadyKind.UPRIGHT, top)


def lambda_down(top: Top) -> float:
    """Jellett's integral above which the inverted spin of an eccentric sphere is stable, kg m^3/s, or inf."""
    return critical_jellett(SteadyKind.INVERTED, top)


def critical_spin(kind: SteadyKind, top: Top) -> float:
    """Axial spin at which a vertical spin changes stability, by formula, rad/s; inf where it never does."""
    return critical_jellett(kind, top) / abs(vertical_spin(kind, top, 1.0).jellett)


def critical_spin_from_spectrum(kind: SteadyKind, top: Top) -> float:
    """Axial spin at which the growth rate of a vertical spin vanishes, rad/s; inf where it never does.

    Nothing but the equations of motion and their derivatives enters: no energy, no Jellett's integral. The
    growth rate is sampled over spins up to 10^4 sqrt(g / size), and its first zero is refined.
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


def critical_spins(problem: Problem) -> CriticalSpins:
    """Critical spins of a launch: with its tilt and its rates, and any axial spin.

    The Jellett's integral of a launch is linear in its spin; for one at rest in tilt it is
    R I3 spin (cos(tilt) - alpha). Its sign does not matter, and the larger of
    the two spins is returned. Where it is not conserved, they are those of the vertical spins themselves:
    under Contensou's friction, which takes spin from them, they change stability when that is left.

    Raises
    ------
    InvalidInput
        If a dry point rubs, or rolling is resisted: nothing is linear there.

    Examples
    --------
    >>> import tippetop as tt
    >>> spins = tt.critical_spins(tt.presets.report_problem())
    >>> round(spins.upright, 2), round(spins.inverted, 2)  # rad/s
    (27.84, 77.23)
    """
    require_creep(problem.top)
    if not problem.top.conserves_jellett:
        return CriticalSpins(*(critical_spin(kind, problem.top) for kind in VERTICAL_SPINS))
    line = _jellett_line(problem)
    return CriticalSpins(*(line.spin_at(critical_jellett(kind, problem.top)) for kind in VERTICAL_SPINS))


def vertical_spins_of_launches(kind: SteadyKind, problem: Problem, spins: Array) -> Array:
    """Axial spins, rad/s, of the vertical spins with the Jellett's integrals of launches with these spins."""
    line = _jellett_line(problem)
    found: Array = line.at(np.asarray(spins)) / vertical_spin(kind, problem.top, 1.0).jellett
    return found


def growth_rates_of_launches(kind: SteadyKind, problem: Problem, spins: Array) -> Array:
    """Growth rates, 1/s, of the vertical spins with the Jellett's integrals of launches with these spins."""
    return vertical_growth_rates(kind, problem.top, vertical_spins_of_launches(kind, problem, spins))


def apparent_critical_spins(problem: Problem, window: float, visible: float) -> CriticalSpins:
    """Critical spins as runs of finite length show them, rad/s.

    Near its threshold a vertical spin attracts or repels slowly. A run that ends `visible` away from the
    vertical passes for one that goes elsewhere: so the upright spin seems to be left below its threshold
    (or above, if launches have time to come closer than that even at it), and the inverted spin seems to be
    reached only above its own.

    Parameters
    ----------
    problem
        A launch near theta = 0; its spin does not matter.
    window
        Length of the runs, s.
    visible
        Least distance from the vertical that is told from none, rad; less than the launch's tilt.

    Notes
    -----
    The upright spin: the launch is followed in the linear motion about the upright spin. The inverted spin:
    a distance of 1 rad at the start of the window is let decay at the growth rate of the inverted spin; the
    time of turning over is not counted, so this is a lower bound of the bias.

    Raises
    ------
    InvalidInput
        If `visible` is not between 0 and the launch's tilt, or the window is not positive.
    """
    if not 0.0 < visible < problem.launch.tilt:
        raise InvalidInput("visible", visible, "a distance between 0 and the launch's tilt")
    if not window > 0.0:
        raise InvalidInput("window", window, "a positive time")
    real = critical_spins(problem)
    top, line = problem.top, _jellett_line(problem)

    def tilt_left(spin: float) -> float:
        upright = vertical_spin(
            SteadyKind.UPRIGHT, top, line.at(spin) / vertical_spin(SteadyKind.UPRIGHT, top, 1.0).jellett
        )
        start = along_table(problem.replace({"launch.spin": spin}).start())
        return math.log(float(linear_tilts(upright, top, start, np.array([window]))[0]) / visible)

    def distance_left(spin: float) -> float:
        rate = growth_rates_of_launches(SteadyKind.INVERTED, problem, np.array([spin]))
        return float(rate[0]) * window - math.log(visible)

    # Where even the threshold's own slow motion has come within `visible`, the bias is upward.
    settles = math.isfinite(real.upright) and tilt_left(real.upright) < 0.0
    upright = _walk(tilt_left, real.upright, outward=settles)
    return CriticalSpins(upright, _walk(distance_left, real.inverted, outward=True))


class _JellettLine(NamedTuple):
    """Jellett's integral of a launch as a function of its spin."""

    at_rest: float
    per_spin: float

    def at(self, spin: Scalar) -> Scalar:
        return self.at_rest + self.per_spin * spin

    def spin_at(self, critical: float) -> float:
        """The larger of the two spins at which the size of the integral is critical."""
        if self.per_spin == 0.0 or math.isinf(critical):
            return math.inf
        return critical / abs(self.per_spin) - self.at_rest / self.per_spin


_SEARCH = 1.05


def _jellett_line(problem: Problem) -> _JellettLine:
    still = {"spin": 0.0, "tilt_rate": 0.0, "precession": 0.0}
    at_rest, per_spin = (
        jellett_of_launch(problem.model_copy(update={"launch": problem.launch.model_copy(update=changes)}))
        for changes in ({"spin": 0.0}, {**still, "spin": 1.0})
    )
    return _JellettLine(at_rest, per_spin)


def _walk(function: Callable[[float], float], start: float, outward: bool) -> float:
    """First root above `start`, or below it, up to a factor 100: inf or 0 if there is none."""
    if math.isinf(start):
        return start
    near, factor = start, _SEARCH if outward else 1.0 / _SEARCH
    for _ in range(95):
        far = near * factor
        if function(near) * function(far) <= 0.0:
            return float(brentq(function, near, far, rtol=1e-12))
        near = far
    return math.inf if outward else 0.0
