"""Support functions of smooth parts of hulls: polynomials of the cosine of the tilt."""

# translate module: numpy

import math

import numpy as np

from tippetop.lathe.hull import ConvexHull
from tippetop.lathe.linear_programme import Array, lowest_point

STEPS = 360
"""Number of steps between tilts 0 and pi at which support functions are compared."""

SHARPEST = 1e-3
"""Smallest radius of curvature, in sizes of the body: an oval has a smooth surface."""


def polynomial_support(
    hull: ConvexHull, low: float, high: float, center: float, degree: int, may_protrude: bool
) -> tuple[list[float], float]:
    """Return the polynomial closest to a hull's support function between two tilts, and its error,
    m.

    The polynomial is the support function of a convex surface about the height `center`. At other
    tilts it is below that of the hull, unless the surface `may_protrude` from the body. The list
    is empty, and the error infinite, if there is no such surface.
    """
    tilts = np.pi * np.arange(STEPS + 1) / STEPS
    support = np.array([hull.support(tilt) for tilt in tilts.tolist()]) + center * np.cos(tilts)
    size = float(support.max())
    support = support / size
    is_between = (tilts >= low - 1e-9) & (tilts <= high + 1e-9)
    between = np.flatnonzero(is_between)
    bounded = between if may_protrude else np.arange(STEPS + 1)
    columns = [
        np.concatenate([harmonic[bounded], -harmonic[between], -across, -along, np.zeros(1)])
        for harmonic, across, along in _harmonics(tilts, degree)
    ]
    errors = np.concatenate(
        [
            np.full(len(bounded) + len(between), -1.0),
            np.zeros(2 * len(tilts)),
            np.full(1, -1.0),
        ]
    )
    bounds = np.concatenate(
        [
            support[bounded],
            -support[between],
            np.full(2 * len(tilts), -SHARPEST),
            np.zeros(1),
        ]
    )
    spread = [k * (len(bounded) - 1) // degree for k in range(degree + 1)]
    solution = lowest_point([*columns, errors], bounds, [len(bounds) - 1, *spread])
    if solution is None:
        return [], math.inf
    powers = _in_powers(solution[:-1])
    return [size * power for power in powers], size * solution[-1]


def _harmonics(tilts: Array, degree: int) -> list[tuple[Array, Array, Array]]:
    """Return Chebyshev's polynomials cos(k theta) of the cosine of tilts, up to a degree.

    With each come the radii of curvature around the axis, h - c h', and along the meridian,
    h + d^2h/dtheta^2, of the surface of which it is the support function h.
    """
    c = np.cos(tilts)
    # sin(k theta) / sin(theta), which has limits at the poles.
    before, ratio = np.zeros(len(tilts)), np.ones(len(tilts))
    rows = [(np.ones(len(tilts)), np.ones(len(tilts)), np.ones(len(tilts)))]
    for k in range(1, degree + 1):
        harmonic = np.cos(k * tilts)
        rows.append((harmonic, harmonic - k * c * ratio, (1 - k * k) * harmonic))
        before, ratio = ratio, 2.0 * c * ratio - before
    return rows


def _in_powers(shares: list[float]) -> list[float]:
    """Return a sum of Chebyshev's polynomials as coefficients of powers, from that of 1 on."""
    count = len(shares)
    total = [0.0] * count
    before, polynomial = [0.0] * count, [1.0] + [0.0] * (count - 1)
    for k, share in enumerate(shares):
        total = [one + share * term for one, term in zip(total, polynomial, strict=True)]
        # T_1 = c T_0, and then T_(k+1) = 2 c T_k - T_(k-1).
        factor = 2.0 if k else 1.0
        shifted = [0.0, *polynomial[:-1]]
        following = [factor * one - two for one, two in zip(shifted, before, strict=True)]
        before, polynomial = polynomial, following
    return total
