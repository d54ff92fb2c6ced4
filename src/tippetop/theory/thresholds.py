"""Critical spins: where a vertical spin gains or loses its stability.

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

from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Scalar
from tippetop.problem.implausible import warn_if_implausible
from tippetop.problem.problem import Problem, require_problem
from tippetop.theory.requirements import require_creep
from tippetop.theory.steady import (
    VERTICAL_SPINS,
    SteadyKind,
    branch_jellett,
    jellett_of_launch,
    vertical_spin,
)

ROUNDING = 1e-14
"""Height of the centre of mass above the table, in sizes, that is none."""


@dataclass(frozen=True)
class CriticalSpins:
    """Spins of a launch, rad/s, at which the two vertical spins change stability."""

    upright: float
    """omega_c1: an eccentric sphere launched with more spin leaves theta = 0; inf if it never does.
    """
    inverted: float
    """omega_c2: launched with more spin it stays at theta = pi once there; inf if it never does."""


def critical_jellett(kind: SteadyKind, top: Top) -> float:
    """Jellett's integral at which a vertical spin changes stability, kg m^3/s: inf where it never
    does.

    Nor does it where the centre of mass is not above the table: as of one of two balls on top of
    the other. An eccentric sphere's upright spin is stable below, lambda_up, and its inverted one
    above, lambda_down.
    """
    return (
        branch_jellett(vertical_spin(kind, top, 0.0).tilt, top) if stands(kind, top) else math.inf
    )


def stands(kind: SteadyKind, top: Top) -> bool:
    """Whether the centre of mass is above the table when the axis is vertical."""
    height = float(top.surface.height(1.0 if kind is SteadyKind.UPRIGHT else -1.0))
    return height > ROUNDING * float(top.surface.size)


def critical_spin(kind: SteadyKind, top: Top) -> float:
    """Axial spin at which a vertical spin changes stability, by formula, rad/s; inf where it never
    does.
    """
    critical = critical_jellett(kind, top)
    return (
        critical if math.isinf(critical) else critical / abs(vertical_spin(kind, top, 1.0).jellett)
    )


def critical_spins(problem: Problem) -> CriticalSpins:
    """Critical spins of a launch: with its tilt and its rates, and any axial spin.

    The Jellett's integral of a launch is linear in its spin; for one at rest in tilt it is R I3
    spin (cos(tilt) - alpha). Its sign does not matter, and the larger of the two spins is returned.
    Where it is not conserved, they are those of the vertical spins themselves: under Contensou's
    friction, which takes spin from them, they change stability when that is left.

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
    require_problem(problem)
    warn_if_implausible(problem)
    return stability_limits(problem)


def stability_limits(problem: Problem) -> CriticalSpins:
    """Return what `critical_spins` does, also of a part of a body, and without a warning."""
    require_creep(problem.top)
    if not problem.top.conserves_jellett:
        return CriticalSpins(*(critical_spin(kind, problem.top) for kind in VERTICAL_SPINS))
    line = jellett_line(problem)
    return CriticalSpins(
        *(line.spin_at(critical_jellett(kind, problem.top)) for kind in VERTICAL_SPINS)
    )


class JellettLine(NamedTuple):
    """Jellett's integral of a launch as a function of its spin."""

    at_rest: float
    per_spin: float

    def at(self, spin: Scalar) -> Scalar:
        """The integral at a spin, rad/s."""
        return self.at_rest + self.per_spin * spin

    def spin_at(self, critical: float) -> float:
        """The larger of the two spins at which the size of the integral is critical."""
        if self.per_spin == 0.0 or math.isinf(critical):
            return math.inf
        return critical / abs(self.per_spin) - self.at_rest / self.per_spin


def jellett_line(problem: Problem) -> JellettLine:
    """Jellett's integral over the spin of a launch whose other numbers are kept."""
    still = {"spin": 0.0, "tilt_rate": 0.0, "precession": 0.0}
    at_rest, per_spin = (
        jellett_of_launch(
            problem.model_copy(update={"launch": problem.launch.model_copy(update=changes)})
        )
        for changes in ({"spin": 0.0}, {**still, "spin": 1.0})
    )
    return JellettLine(at_rest, per_spin)
