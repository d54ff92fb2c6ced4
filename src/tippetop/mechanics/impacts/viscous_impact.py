"""An impact with viscous friction, in closed form."""

# translate module: numbers

import math
from collections.abc import Callable
from dataclasses import dataclass
from operator import mul
from typing import NamedTuple, TypeAlias

from tippetop.mechanics.impacts.struck_body import FIRST, NO_IMPULSE, WORK, Impulse, StruckBody
from tippetop.mechanics.laws.friction import ViscousLaw
from tippetop.mechanics.roots import crossing
from tippetop.mechanics.vectors import Horizontal

Goal: TypeAlias = Callable[[Impulse], float]
"""Negative as long as a phase of the impact lasts."""

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
class ViscousImpact:
    """An impact with viscous friction, in closed form.

    With phi_1(x) = (1 - exp(-x)) / x and phi_(k+1) = (1/k! - phi_k) / x at x = mu stiffness p, the
    slip of a mode is exp(-x) slip + coupling p phi_1, its impulse of friction -mu (slip p phi_1 +
    coupling p^2 phi_2), and the integral of that over p is -mu (slip p^2 phi_2 + coupling p^3
    phi_3).

    One mode lies across the plane of n and z and has no coupling, so that the slope of the normal
    velocity, M_nn - mu (coupling slip), is monotone with a positive limit: compression has one end,
    and the velocity keeps growing after it.
    """

    body: StruckBody
    """The body at the start of the impact."""
    mu: float
    directions: tuple[PrincipalDirection, PrincipalDirection]

    @classmethod
    def of(cls, body: StruckBody, law: ViscousLaw) -> "ViscousImpact":
        """Return the impact of a body, from the principal directions of its tangential part
        of M.
        """
        east, north, up = body.contacts.response[:3]
        angle = 0.5 * math.atan2(2.0 * east[1], east[0] - north[1])
        cosine, sine = math.cos(angle), math.sin(angle)

        def mode(x: float, y: float) -> PrincipalDirection:
            stiffness = x * x * east[0] + 2.0 * x * y * east[1] + y * y * north[1]
            coupling, slip = x * up[0] + y * up[1], x * body.before[0] + y * body.before[1]
            return PrincipalDirection((x, y), stiffness, coupling, slip)

        return cls(body, law.mu, (mode(cosine, sine), mode(-sine, cosine)))

    @property
    def is_struck(self) -> bool:
        """Whether the contact point sinks into the table, or would, if the impact did not begin."""
        x, y, z = self.body.before[:3]
        if z != 0.0:
            return bool(z < 0.0)
        coupling = self.body.contacts.response[2]
        return bool(coupling[2] - self.mu * (coupling[0] * x + coupling[1] * y) < 0.0)

    def compressed(self) -> Impulse:
        """Return the impulse at which the contact point stops sinking."""
        frictionless = (-2.0 * self.body.before[2] or 1.0) / self.body.contacts.response[2][2]
        return self._first_reach(NO_IMPULSE, self._approach, frictionless)

    def restored(self, compressed: Impulse, restitution: float) -> Impulse:
        """Return the impulse where restitution ends, by Poisson or the energy stored, but not
        before the body has stopped.
        """
        compression, work = compressed[FIRST], compressed[WORK]
        full = compression + restitution * compression

        def goal(impulse: Impulse) -> float:
            spent, returned = (impulse[FIRST] - full) / compression, -impulse[WORK] / work
            return min(max(spent, returned), self._approach(impulse))

        return self._first_reach(compressed, goal, restitution * compression)

    def _approach(self, impulse: Impulse) -> float:
        """Return the normal velocity of the contact point after an impulse."""
        return float(self.body.before[2] + sum(map(mul, self.body.contacts.response[2], impulse)))

    def _first_reach(self, impulse: Impulse, goal: Goal, guess: float) -> Impulse:
        """Return the first impulse from a given one on at which the goal stops being negative,
        which it does once.

        Where the goal is zero at the start, it is about to become negative: that start is passed
        over. The guess, positive, is how much the normal impulse may have to grow.
        """
        start, high = impulse[FIRST], guess
        ahead = goal(self.at(start + high))
        while ahead < 0.0:
            high *= 2.0
            ahead = goal(self.at(start + high))
        if ahead == 0.0:
            return self.at(start + high)
        low = 0.0 if goal(impulse) < 0.0 else 0.5 * high
        while goal(self.at(start + low)) >= 0.0:
            low, high = 0.5 * low, low
        return self.at(start + crossing(lambda q: goal(self.at(start + q)), low, high))

    def at(self, p: float) -> Impulse:
        """Return the impulse when the normal impulse is p."""
        east = north = 0.0
        work = p * (self.body.before[2] + 0.5 * p * self.body.contacts.response[2][2])
        for (x, y), stiffness, coupling, slip in self.directions:
            phi_1, phi_2, phi_3 = phis(self.mu * stiffness * p)
            along = -self.mu * p * (slip * phi_1 + coupling * p * phi_2)
            east, north = east + along * x, north + along * y
            work -= self.mu * p * p * coupling * (slip * phi_2 + coupling * p * phi_3)
        return (east, north, p, 0.0, 0.0, 0.0, p, work)


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
