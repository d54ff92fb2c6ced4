"""Critical spins, at which a vertical spin gains or loses its stability.

A vertical spin changes stability where the branch of steady precessions reaches the vertical, so
its critical Jellett's integral is the limit of the branch at the pole:

    lambda_up   = sqrt(m g R^3 I3 alpha) (1 - alpha)^2 / sqrt(alpha + gamma - 1)     at theta = 0,
    lambda_down = sqrt(m g R^3 I3 alpha) (1 + alpha)^2 / sqrt(1 + alpha - gamma)     at theta = pi

for the eccentric sphere, gamma = I1 / I3. Friction does not enter. The same numbers come out of the
spectrum of the vertical spin, with friction, as the zeros of its growth rate: see
`tippetop.theory.apparent`.
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

from tippetop.mechanics.surfaces.hull import lies_flat_at
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Scalar
from tippetop.problem.implausible import warn_if_implausible
from tippetop.problem.problem import Problem, require_problem, top_of
from tippetop.theory.requirements import require_creep
from tippetop.theory.steady import (
    VERTICAL_SPINS,
    SteadyKind,
    branch_jellett,
    end_of,
    jellett_of_launch,
    vertical_spin,
)

ZERO_HEIGHT = 1e-14
"""Height of the centre of mass above the table, in sizes, that counts as zero: rounding of a body
whose centre of mass is on the table."""


@dataclass(frozen=True)
class CriticalSpins:
    """Spins of a launch, rad/s, at which the two vertical spins change stability.

    Examples
    --------
    >>> import tippetop as tt
    >>> spins = tt.critical_spins(tt.presets.report_problem())
    >>> 0.0 < spins.upright < spins.inverted
    True
    """

    upright: float
    """omega_c1: an eccentric sphere launched with more spin leaves theta = 0; inf if it never
    does.
    """
    inverted: float
    """omega_c2: launched with more spin it stays at theta = pi once it is there; inf if it never
    does.
    """


def critical_jellett(kind: SteadyKind, top: Top) -> float:
    """Return Jellett's integral at which a vertical spin changes stability, kg m^3/s; inf if none.

    An eccentric sphere's upright spin is stable below lambda_up, and its inverted spin above
    lambda_down. The result is inf if the body cannot stand there: see `can_stand`.
    """
    return (
        branch_jellett(vertical_spin(kind, top, 0.0).tilt, top)
        if can_stand(kind, top)
        else math.inf
    )


def can_stand(kind: SteadyKind, top: Top) -> bool:
    """Return whether the body touches in one point when its axis is vertical, and its centre of
    mass is above the table.
    """
    end = end_of(kind)
    height = float(top.surface.height(end))
    return height > ZERO_HEIGHT * float(top.surface.size) and not lies_flat_at(top.surface, end)


def critical_spin(kind: SteadyKind, top: Top) -> float:
    """Return the axial spin at which a vertical spin changes stability, rad/s; inf if none."""
    critical = critical_jellett(kind, top)
    return (
        critical if math.isinf(critical) else critical / abs(vertical_spin(kind, top, 1.0).jellett)
    )


def critical_spins(problem: Problem) -> CriticalSpins:
    """Return the critical spins of launches with the tilt and the rates of this one.

    Jellett's integral of a launch is linear in its spin; without tilt rate and precession it is R
    I3 spin (cos(tilt) - alpha). Its sign does not matter, and the larger of the two spins is
    returned. If it is not conserved, the critical spins are those of the vertical spins themselves:
    under Contensou's friction, which reduces their spin, they change stability at that value.

    Raises
    ------
    InvalidInput
        If friction is dry friction of a point, or rolling is resisted: there is no linear motion.
        If the table slopes, or there is air: no spin is steady.

    Examples
    --------
    >>> import tippetop as tt
    >>> spins = tt.critical_spins(tt.presets.report_problem())
    >>> round(spins.upright, 2), round(spins.inverted, 2)  # rad/s
    (27.84, 77.23)
    """
    require_problem(problem)
    warn_if_implausible(problem)
    return stability_limits(problem)


def stability_limits(problem: Problem) -> CriticalSpins:
    """Return the result of `critical_spins` without its warning, also for a part of a body."""
    require_creep(top_of(problem))
    if not top_of(problem).conserves_jellett:
        return CriticalSpins(*(critical_spin(kind, top_of(problem)) for kind in VERTICAL_SPINS))
    line = jellett_line(problem)
    return CriticalSpins(
        *(line.spin_at(critical_jellett(kind, top_of(problem))) for kind in VERTICAL_SPINS)
    )


class JellettLine(NamedTuple):
    """Jellett's integral of a launch as a linear function of its spin."""

    at_rest: float
    per_spin: float

    def at(self, spin: Scalar) -> Scalar:
        """Return the integral at a spin, rad/s."""
        return self.at_rest + self.per_spin * spin

    def spin_at(self, critical: float) -> float:
        """Return the larger of the two spins at which the integral's size is critical, rad/s."""
        if self.per_spin == 0.0 or math.isinf(critical):
            return math.inf
        return critical / abs(self.per_spin) - self.at_rest / self.per_spin


def jellett_line(problem: Problem) -> JellettLine:
    """Return Jellett's integral of launches that differ from this one only in their spin."""
    still = {"spin": 0.0, "tilt_rate": 0.0, "precession": 0.0}
    at_rest, per_spin = (
        jellett_of_launch(
            problem.model_copy(update={"launch": problem.launch.model_copy(update=changes)})
        )
        for changes in ({"spin": 0.0}, {**still, "spin": 1.0})
    )
    return JellettLine(at_rest, per_spin)
