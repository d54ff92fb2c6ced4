"""Exact derivatives of the mechanics, by a step along the imaginary axis.

The mechanics is written in plain operators, so it runs on complex numbers unchanged, and f(x + i h) = f(x) +
i h f'(x) + O(h^2). With a step whose square is nothing beside any number, the imaginary part over h is the
derivative to rounding: nothing is subtracted, and no formula is written a second time (Squire and Trapp, SIAM
Review 40 (1998) 110-112).
"""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from tippetop.integrators.base import Array

STEP = 1e-200


def derivative(function: Callable[[Any], Any], at: Any) -> Array:
    """Derivative of a function of one number, at a number or at an array of them, of whose shape it is."""
    return np.asarray(np.imag(function(np.asarray(at) + 1j * STEP)) / STEP)


def jacobian(function: Callable[[list[Any]], Sequence[Any]], point: Sequence[Any]) -> Array:
    """Matrix of the derivatives of a function at a point, or at many points at once.

    The function takes k numbers and returns r of them, by plain operators only; the point is k numbers, or k
    arrays of one shape. Shape (*shape, r, k): the derivative of each result by each variable.
    """
    values = np.array(np.broadcast_arrays(*point), dtype=float)
    directions = np.eye(len(values)).reshape(len(values), len(values), *(1,) * (values.ndim - 1))
    moved = values[:, None] + 1j * STEP * directions
    rows = [np.broadcast_to(np.imag(result), moved.shape[1:]) for result in function(list(moved))]
    return np.moveaxis(np.stack(rows) / STEP, (0, 1), (-2, -1))
