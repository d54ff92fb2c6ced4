"""An impact with viscous friction, in closed form."""

# translate module: numbers

import math
from dataclasses import dataclass
from typing import NamedTuple

from tippetop.mechanics.impacts.process import ImpactProcess
from tippetop.mechanics.impacts.struck_body import NORMAL, Goal, Impulse, StruckBody, first_reach
from tippetop.mechanics.laws.friction import ViscousLaw
from tippetop.mechanics.vectors import Horizontal

ROUNDING = 1e-17
"""A term of a series of about 1/6 that changes it no more."""


class PrincipalDirection(NamedTuple):
    """A direction in which slip, v' = coupling - mu stiffness v, is driven by friction along itself
    only.
    """

    direction: Horizontal
    """A unit vector, horizontal."""
    stiffness: float
    coupling: float
    """Slip along it per unit impulse along it, and per unit normal impulse, 1/kg."""
    slip: float
    """Slip along it at the start, m/s."""


@dataclass(frozen=True)
class ViscousProcess(ImpactProcess):
    """An impact with viscous friction, in closed form.

    With phi_1(x) = (1 - exp(-x)) / x and phi_(k+1) = (1/k! - phi_k) / x at x = mu stiffness p, the
    slip of a mode is exp(-x) slip + coupling p phi_1, its impulse of friction -mu (slip p phi_1 +
    coupling p^2 phi_2), and the integral of that over p is -mu (slip p^2 phi_2 + coupling p^3
    phi_3).

    One mode lies across the plane of n and z and has no coupling, so that the slope of the normal
    velocity, M_nn - mu (coupling slip), is monotone with a positive limit: compression has one end,
    and the velocity keeps growing after it.
    """

    mu: float
    modes: tuple[PrincipalDirection, PrincipalDirection]

    @classmethod
    def of(cls, body: StruckBody, law: ViscousLaw) -> "ViscousProcess":
        """Return the process of this impact, from the principal directions of its tangential part
        of M.
        """
        east, north, up = body.response[:3]
        angle = 0.5 * math.atan2(2.0 * east[1], east[0] - north[1])
        cosine, sine = math.cos(angle), math.sin(angle)

        def mode(x: float, y: float) -> PrincipalDirection:
            stiffness = x * x * east[0] + 2.0 * x * y * east[1] + y * y * north[1]
            coupling, slip = x * up[0] + y * up[1], x * body.before[0] + y * body.before[1]
            return PrincipalDirection((x, y), stiffness, coupling, slip)

        return cls(body, law.mu, (mode(cosine, sine), mode(-sine, cosine)))

    def until(self, impulse: Impulse, goal: Goal, guess: float) -> tuple[Impulse, int]:
        """Return the first impulse from a given one on at which the goal is not negative; without
        steps.
        """
        return first_reach(lambda q: self.at(impulse[NORMAL] + q), goal, guess), 0

    def at(self, p: float) -> Impulse:
        """Return the impulse when the normal impulse is p."""
        east = north = 0.0
        work = p * (self.body.before[2] + 0.5 * p * self.body.response[2][2])
        for (x, y), stiffness, coupling, slip in self.modes:
            phi_1, phi_2, phi_3 = phis(self.mu * stiffness * p)
            along = -self.mu * p * (slip * phi_1 + coupling * p * phi_2)
            east, north = east + along * x, north + along * y
            work -= self.mu * p * p * coupling * (slip * phi_2 + coupling * p * phi_3)
        return (east, north, p, 0.0, 0.0, 0.0, work)


def phis(x: float) -> tuple[float, float, float]:
    """phi_1, phi_2 and phi_3 of x >= 0, where phi_k = sum of (-x)^j / (j + k)! over j."""
    if x < 1.0:
        phi_3 = term = 1.0 / 6.0
        for j in range(4, 20):
            term *= -x / j
            phi_3 += term
            if abs(term) < ROUNDING:
                break
        phi_2 = 0.5 - x * phi_3
        return 1.0 - x * phi_2, phi_2, phi_3
    phi_1 = -math.expm1(-x) / x
    phi_2 = (1.0 - phi_1) / x
    return phi_1, phi_2, (0.5 - phi_2) / x
