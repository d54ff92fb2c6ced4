"""Exact derivatives of the mechanics by complex steps.

The mechanics is written in plain operators, so it runs on complex numbers unchanged, and f(x + i h)
= f(x) + i h f'(x) + O(h^2). With a step whose square is negligible, the imaginary part over h is
the derivative to rounding: there is no cancellation, and no formula is written a second time
(Squire and Trapp, SIAM Review 40 (1998) 110-112).

Functions may use only analytic operations: sums, products, quotients, powers, sin, cos and the
like. An absolute value would lose the imaginary part, and is refused. A root of a negative number
gives nan, as for real numbers.
"""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from tippetop.integrators.base import Array

STEP = 1e-200
"""Step along the imaginary axis: its square underflows to 0, the step itself does not."""

_NOT_ANALYTIC = np.absolute, np.sign, np.conjugate
_PARTLY_DEFINED = np.power, np.sqrt, np.log, np.arcsin, np.arccos


class _ComplexStep(np.ndarray):
    """Array of numbers a step off the real axis."""

    def __array_ufunc__(self, ufunc: Any, method: Any, *inputs: Any, **settings: Any) -> Any:
        """Apply an analytic operation; raise `TypeError` for another."""
        if ufunc in _NOT_ANALYTIC:
            raise TypeError(
                f"{ufunc.__name__} cannot be differentiated: use analytic operations only"
            )
        if "out" in settings:
            settings["out"] = tuple(np.asarray(place) for place in settings["out"])
        plain = [np.asarray(number) for number in inputs]
        result = np.asarray(getattr(ufunc, method)(*plain, **settings))
        if ufunc in _PARTLY_DEFINED:
            with np.errstate(invalid="ignore", divide="ignore"):
                real = ufunc(*(number.real for number in plain))
            result = np.where(np.isnan(real), complex(np.nan, np.nan), result)
        return result.view(_ComplexStep)


def derivative(function: Callable[[Any], Any], at: Any) -> Array:
    """Return the derivative of a function of one number, at a number or an array; of its shape.

    Raises `TypeError` if the function uses an operation that is not analytic.
    """
    moved = np.asarray(np.asarray(at) + 1j * STEP).view(_ComplexStep)
    return np.asarray(np.imag(function(moved))) / STEP


def jacobian(function: Callable[[list[Any]], Sequence[Any]], point: Sequence[Any]) -> Array:
    """Return the Jacobian matrix of a function at a point, or at many points at once.

    The function takes k numbers and returns r of them, by plain operators only; the point is k
    numbers, or k arrays of one shape. Returns an array of shape (*shape, r, k): the derivative of
    each result by each variable.

    Raises `TypeError` if the function uses an operation that is not analytic.
    """
    values = np.array(np.broadcast_arrays(*point), dtype=float)
    directions = np.eye(len(values)).reshape(len(values), len(values), *(1,) * (values.ndim - 1))
    moved = values[:, None] + 1j * STEP * directions
    rows = [
        np.broadcast_to(np.imag(result), moved.shape[1:])
        for result in function(list(moved.view(_ComplexStep)))
    ]
    return np.moveaxis(np.stack(rows) / STEP, (0, 1), (-2, -1))
