"""Classification of eccentric spheres by gamma = I1 / I3 and their eccentricity alpha.

The stable steady states are the minima over the tilt of the least energy at a given Jellett's
integral. For the eccentric sphere all of them follow from D(c) = alpha - (1 - gamma) c, c =
cos(theta):

- There is a steady precession at this tilt where D > 0.
- Its Jellett's integral is lambda^2 = m g R^3 I3 alpha P^2 / D with P = gamma (1 - c^2) + (c -
  alpha)^2.
- P' = -2 D, so that lambda turns back where 3 D^2 = gamma (1 - gamma - alpha^2): a fold. The
  precession is stable where D is larger than there, and everywhere if gamma >= 1 - alpha^2.

Three groups follow from the sign of D at the two ends: gamma = 1 - alpha and gamma = 1 + alpha are
their boundaries (Ebenfeld and Scheck 1995; Ueda, Sasaki and Watanabe 2005; Ciocci, Malengier,
Langerock and Grimonprez 2012). The place of the fold divides them further, into six kinds; the
letters are not those of the last of these papers, whose IIb is IIa here.
"""

import math
from enum import StrEnum
from typing import NamedTuple

from tippetop.mechanics.top import Top
from tippetop.support.errors import InvalidInput
from tippetop.theory.requirements import require_jellett
from tippetop.theory.steady import SteadyKind, branch_jellett
from tippetop.theory.thresholds import critical_jellett


class Group(StrEnum):
    """Group of eccentric spheres with the same behaviour as they are spun faster near theta = 0."""

    IA = "Ia"
    IB = "Ib"
    IIA = "IIa"
    IIB = "IIb"
    IIC = "IIc"
    III = "III"

    @property
    def description(self) -> str:
        """Behaviour of the group, in a sentence."""
        return _DESCRIPTIONS[self]

    @property
    def inverts(self) -> bool:
        """Whether the top, set upright, turns over completely when it spins fast enough."""
        return self in (Group.IIA, Group.IIB, Group.IIC)

    @property
    def leaves_upright(self) -> bool:
        """Whether the upright spin becomes unstable at some spin."""
        return self.inverts or self is Group.III

    @property
    def coexistence(self) -> bool:
        """Whether two steady states are stable at some spins, so that the launch decides the
        end.
        """
        return self not in (Group.IIA, Group.III)


_DESCRIPTIONS = {
    Group.IA: (
        "never inverts: the upright spin is stable at any spin; from some spin on, a tilted "
        "precession or the inverted spin is stable beside it"
    ),
    Group.IB: (
        "never inverts: the upright spin is stable at any spin; from some spin on, the inverted "
        "spin is stable beside it, and no precession is"
    ),
    Group.IIA: "inverts completely, and gradually: one steady state is stable at every spin",
    Group.IIB: (
        "inverts completely, with a jump: over a range of spins, the upright spin and another state"
        " are both stable"
    ),
    Group.IIC: (
        "inverts completely, in one jump: no precession is stable, and over a range of spins both "
        "vertical spins are"
    ),
    Group.III: "stops part-way: it leaves the upright spin, but the inverted spin is never stable",
}


class Fold(NamedTuple):
    """Precession with the least Jellett's integral, if that is inside the branch."""

    tilt: float
    """theta, rad."""
    jellett: float
    """lambda, kg m^3/s."""


def classify(gamma: float, alpha: float) -> Group:
    """Return the group of the eccentric sphere with gamma = I1 / I3 and eccentricity alpha.

    Raises `InvalidInput` if alpha is not between 0 and 1, or gamma is less than 1/2, which no body
    has.
    """
    if not 0.0 < alpha < 1.0:
        raise InvalidInput("alpha", alpha, "a number greater than 0 and less than 1")
    if not gamma >= 0.5:
        raise InvalidInput("gamma", gamma, "a number at least 0.5, as for any body")
    if gamma >= inverted_boundary(alpha):
        return Group.III
    no_stable_precession = _fold_measure(gamma, alpha) >= alpha + 1.0 - gamma
    if gamma <= upright_boundary(alpha):
        return Group.IB if no_stable_precession else Group.IA
    if no_stable_precession:
        return Group.IIC
    return Group.IIB if _fold_measure(gamma, alpha) > alpha - 1.0 + gamma else Group.IIA


def classify_top(top: Top) -> Group:
    """Return the group of an eccentric sphere.

    Raises `InvalidInput` if the top does not conserve Jellett's integral.
    """
    require_jellett(top)
    return classify(inertia_ratio(top), eccentricity(top))


def inertia_ratio(top: Top) -> float:
    """Return gamma = I1 / I3."""
    return float(top.transverse_inertia / top.axial_inertia)


def eccentricity(top: Top) -> float:
    """Return alpha of an eccentric sphere: its centre's height above the centre of mass, in
    radii.
    """
    return float(-top.surface.slope(0.0) / top.surface.size)


def upright_boundary(alpha: float) -> float:
    """Return gamma between groups I and II: below it the upright spin is stable at any spin."""
    return 1.0 - alpha


def inverted_boundary(alpha: float) -> float:
    """Return gamma between groups II and III: above it the inverted spin is stable at no spin."""
    return 1.0 + alpha


def jump_boundary(alpha: float) -> float:
    """Return gamma between groups IIb and IIa, where the fold enters at theta = 0.

    It is the larger root of 4 gamma^2 - (1 - alpha)(7 + alpha) gamma + 3 (1 - alpha)^2.
    """
    return (1.0 - alpha) / 8.0 * (7.0 + alpha + math.sqrt(1.0 + 14.0 * alpha + alpha**2))


def precession_boundaries(alpha: float) -> tuple[float, float]:
    """Return the values of gamma between which no precession is stable (groups Ib and IIc).

    There the fold leaves at theta = pi. They are the roots of 4 gamma^2 - (1 + alpha)(7 - alpha)
    gamma + 3 (1 + alpha)^2; (nan, nan) if there are none, for alpha > 7 - 4 sqrt(3) = 0.0718.
    """
    discriminant = 1.0 - 14.0 * alpha + alpha**2
    if discriminant < 0.0:
        return math.nan, math.nan
    middle, half = 7.0 - alpha, math.sqrt(discriminant)
    return (1.0 + alpha) / 8.0 * (middle - half), (1.0 + alpha) / 8.0 * (middle + half)


def equal_thresholds(alpha: float) -> float:
    """Return gamma in group II at which both vertical spins change stability at the same lambda.

    Below it both vertical spins are stable over a range of lambda, so that a top that leaves the
    upright spin turns over completely at once.
    """
    return (1.0 - alpha**2) * (1.0 + 3.0 * alpha**2) / (1.0 + 6.0 * alpha**2 + alpha**4)


def fold(top: Top) -> Fold | None:
    """Return the fold of the steady precessions of an eccentric sphere; None without one.

    Raises `InvalidInput` if the top does not conserve Jellett's integral.
    """
    if classify_top(top) not in (Group.IA, Group.IIB):
        return None
    gamma, alpha = inertia_ratio(top), eccentricity(top)
    cosine = (alpha - _fold_measure(gamma, alpha)) / (1.0 - gamma)
    tilt = math.acos(max(-1.0, min(1.0, cosine)))
    return Fold(tilt, branch_jellett(tilt, top))


def coexistence(top: Top) -> tuple[float, float] | None:
    """Return the sizes of Jellett's integral between which two steady states are stable.

    In natural units; None for groups in which that is never so.

    Raises `InvalidInput` if the top does not conserve Jellett's integral.
    """
    if not classify_top(top).coexistence:
        return None
    turning = fold(top)
    return (
        critical_jellett(SteadyKind.INVERTED, top) if turning is None else turning.jellett
    ), critical_jellett(SteadyKind.UPRIGHT, top)


def _fold_measure(gamma: float, alpha: float) -> float:
    """Return D at the fold, sqrt(gamma (1 - gamma - alpha^2) / 3); 0 if every D is larger."""
    return math.sqrt(max(gamma * (1.0 - gamma - alpha**2) / 3.0, 0.0))
