"""Support functions of smooth parts of hulls: polynomials of the cosine of the tilt."""

# translate module: by hand in ovals.js

import numpy as np

from tippetop.lathe.hull import ConvexHull

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
    tilts it is below that of the hull, unless the surface `may_protrude` from the body.
    """
    from scipy.optimize import linprog  # noqa: PLC0415 - slow to import

    tilts = np.pi * np.arange(STEPS + 1) / STEPS
    c, s = np.cos(tilts), np.sin(tilts)
    support = np.array([hull.support(tilt) for tilt in tilts.tolist()]) + center * c
    size = float(support.max())
    chebyshev = np.polynomial.chebyshev
    basis = chebyshev.chebvander(c, degree)
    slopes, curvatures = (
        np.stack(
            [chebyshev.chebval(c, chebyshev.chebder(unit, order)) for unit in np.eye(degree + 1)],
            axis=1,
        )
        for order in (1, 2)
    )
    # Radii of curvature around the axis and along the meridian.
    across = basis - c[:, None] * slopes
    along = across + (s**2)[:, None] * curvatures
    is_between = (tilts >= low - 1e-9) & (tilts <= high + 1e-9)
    is_bounded = is_between if may_protrude else np.ones(len(tilts), dtype=bool)
    ones = np.ones((len(tilts), 1))
    rows = [
        np.hstack([basis[is_bounded], -ones[is_bounded]]),
        np.hstack([-basis[is_between], -ones[is_between]]),
        np.hstack([-across, 0.0 * ones]),
        np.hstack([-along, 0.0 * ones]),
    ]
    bounds = [
        support[is_bounded] / size,
        -support[is_between] / size,
        np.full(len(tilts), -SHARPEST),
        np.full(len(tilts), -SHARPEST),
    ]
    cost = np.append(np.zeros(degree + 1), 1.0)
    free = [(None, None)] * (degree + 1) + [(0.0, None)]
    solution = linprog(cost, np.vstack(rows), np.concatenate(bounds), bounds=free).x
    if solution is None:
        return [], np.inf
    coefficients = np.zeros(degree + 1)
    powers = chebyshev.cheb2poly(solution[:-1])
    coefficients[: len(powers)] = size * powers
    return coefficients.tolist(), size * float(solution[-1])
