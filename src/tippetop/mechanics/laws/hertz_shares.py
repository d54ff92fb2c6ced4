"""Shares of force and torque under Hertz's pressure (see `contensou_hertz`)."""

from typing import Any

from tippetop.mechanics.laws.contensou import PI
from tippetop.mechanics.vectors import Scalar

# fmt: off
ABOVE = (
    1.5707963267948966, 3.881827558189307, 3.7302986673933276, 1.7319485839406856,
    0.3822634716370882, 0.031121258667402094,
)
BELOW = (
    1.0, 4.168900902778227, 6.952127871831827, 5.877944744228727, 2.6214376916842954,
    0.573386336009741, 0.046682203384759896,
)
# fmt: on
"""D in x = cos(sig), see `contensou_hertz.HertzSlidingLaw`, is the ratio of these polynomials;
relative error 1e-17.
"""

SHARE = BELOW[6] / BELOW[5]
"""Part of x^2 beside x in a factor of the latter."""

NEAR_BRANCH = 1e-24
"""Square of how near 1 - 1 / kappa^2 comes to 0, for what has a root there."""


def drilling_shares(square: Scalar) -> tuple[Scalar, Scalar]:
    """F / kappa and T where drilling prevails, at kappa^2."""
    force = (3.0 * PI / 32.0) * (4.0 - square)
    return force, (3.0 * PI / 16.0) * (1.0 - square + 0.375 * (square * square))


def sliding_shares(excess: Scalar) -> tuple[Scalar, Scalar]:
    """F and T kappa where slip prevails, at 1 - 1 / kappa^2, see `contensou_hertz.HertzSlidingLaw`.

    With few products of variables: where they are power series, these are what costs.
    """
    x4 = excess * excess + NEAR_BRANCH
    x2 = x4**0.5
    x = x2**0.5
    above = (
        ABOVE[0]
        + ABOVE[1] * x
        + ABOVE[2] * x2
        + ABOVE[4] * x4
        + x * (ABOVE[3] * x2 + ABOVE[5] * x4)
    )
    odd = (x + SHARE * x2) * (BELOW[3] * x2 + BELOW[5] * x4)
    below = BELOW[0] + BELOW[1] * x + BELOW[2] * x2 + (BELOW[4] - SHARE * BELOW[3]) * x4 + odd
    d, y = above / below, 1.0 - x2
    c = y * d
    less = y * ((2.0 / 3.0) * x + c)
    return x + 0.75 * less - 0.1875 * c, 0.125 * x + 0.375 * (less - c) + 0.140625 * d


def scaled_shares(
    patch: Any, larger: Scalar, drilling: Scalar, law: tuple[Scalar, Scalar]
) -> tuple[Scalar, Scalar]:
    """Force over slip, and torque, per unit normal force.

    Parameters
    ----------
    patch
        Its friction coefficient and radius.
    larger, drilling
        Square of what prevails, drilling or slip, m^2/s^2; and drilling R w, m/s.
    law
        F, and T, times what prevails over slip, and over drilling.
    """
    speed = larger**0.5
    return (
        -patch.mu * law[0] / speed,
        (-patch.mu * patch.patch_radius) * (drilling * law[1]) / speed,
    )
