"""Linear programmes of few unknowns and many bounds, by the dual simplex method.

The page solves the same programmes by the same steps: `scipy.optimize.linprog` is not translated.
"""

# translate module: numpy

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from tippetop.lathe.arcs import least_squares

Array = NDArray[np.float64]

WITHIN = 1e-11
"""Distance beyond a bound that is rounding, in the unit of the unknowns: sums of some ten numbers
of size 1 have a hundredth of it, and 1e-7 as in other solvers would show in the surfaces.
"""

LEAST_SHARE = 1e-10
"""Share of a bound in another one below which it is rounding: a corner with it would be a line."""

MOST_EXCHANGES = 2000
"""Most corners that are visited. Ovals take 20 to 300."""

TIE = 1e-9
"""Weight of the bounds of the first corner beside the height. Of all lowest points it chooses one,
and with none the search could return to a corner; the height is larger by about as much.
"""


def lowest_point(
    columns: Sequence[Array], bounds: Array, first_corner: Sequence[int]
) -> list[float] | None:
    """Return the point x with the smallest last coordinate that keeps all bounds.

    The bounds are ``sum(x[k] * columns[k]) <= bounds``, of shape (m,). The point of a corner, where
    as many bounds hold with equality as there are coordinates, is the lowest one that keeps these.
    While it breaks others, the one that it breaks most replaces one of the corner.

    Parameters
    ----------
    columns
        Coefficients of each coordinate in the bounds, each of shape (m,).
    bounds
        Upper bounds, of shape (m,).
    first_corner
        Numbers of bounds, as many as coordinates and independent of each other. The first is
        that the last coordinate is not negative.

    Returns
    -------
    The point, or None if no point keeps all bounds, or none is found in `MOST_EXCHANGES` exchanges.
    """
    squares = np.zeros(len(bounds))
    for column in columns:
        squares = squares + column * column
    sizes = np.sqrt(squares)
    planes, limits = [column / sizes for column in columns], bounds / sizes
    corner = list(first_corner)
    weights = [1.0] + [TIE * (1.0 + k / len(corner)) for k in range(1, len(corner))]
    for _ in range(MOST_EXCHANGES):
        places = np.array(corner)
        point = least_squares([plane[places] for plane in planes], limits[places])
        beyond = -limits
        for coordinate, plane in zip(point, planes, strict=True):
            beyond = beyond + coordinate * plane
        entering = int(np.argmin(-beyond))
        if beyond[entering] <= WITHIN:
            return list(point)
        normal = _normal(planes, entering)
        shares = least_squares([_normal(planes, place) for place in corner], normal)
        leaving = _leaving(weights, shares)
        if leaving < 0:
            return None
        step = max(weights[leaving], 0.0) / shares[leaving]
        weights = [weight - step * share for weight, share in zip(weights, shares, strict=True)]
        corner[leaving] = entering
        weights[leaving] = step
    return None


def _normal(planes: Sequence[Array], place: int) -> Array:
    """Return the normal of a bound, of shape (coordinates,)."""
    return np.array([float(plane[place]) for plane in planes])


def _leaving(weights: Sequence[float], shares: Sequence[float]) -> int:
    """Return the place in the corner of the bound that another one replaces; -1 if there is none.

    It is the first whose weight would become negative.
    """
    steps = [
        max(weight, 0.0) / share if share > LEAST_SHARE else math.inf
        for weight, share in zip(weights, shares, strict=True)
    ]
    least = min(steps)
    return -1 if least == math.inf else steps.index(least)
