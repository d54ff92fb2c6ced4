"""Exact derivatives of the mechanics: numbers that carry their gradient.

The mechanics is written in plain operators, so it runs on these numbers unchanged, and its derivatives come
out exact to rounding: no step to choose, and no formula written a second time (Griewank and Walther,
*Evaluating Derivatives*, 2008, chapter 3).
"""

from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from tippetop.mechanics.algebra import Algebra

Array: TypeAlias = NDArray[np.float64]


class Dual(Algebra):
    """A number, or an array of any shape, with its gradient along k directions, shape (k, *value.shape)."""

    __array_ufunc__ = None  # so that an array on the left leaves the operation to this class

    def __init__(self, value: Any, gradient: Any) -> None:
        self.value = value
        self.gradient = gradient

    def __repr__(self) -> str:
        return f"Dual({self.value!r}, {self.gradient!r})"

    def __add__(self, other: Any) -> "Dual":
        if isinstance(other, Dual):
            return Dual(self.value + other.value, self.gradient + other.gradient)
        return Dual(self.value + other, self.gradient)

    def __mul__(self, other: Any) -> "Dual":
        if isinstance(other, Dual):
            gradient = self.value * other.gradient + other.value * self.gradient
            return Dual(self.value * other.value, gradient)
        return Dual(self.value * other, self.gradient * other)

    def power(self, exponent: float) -> "Dual":
        """A real power."""
        return Dual(self.value**exponent, exponent * self.value ** (exponent - 1.0) * self.gradient)


def sin(angle: Any) -> Any:
    """Sine of a number, an array or a dual number."""
    if isinstance(angle, Dual):
        return Dual(np.sin(angle.value), np.cos(angle.value) * angle.gradient)
    return np.sin(angle)


def cos(angle: Any) -> Any:
    """Cosine of a number, an array or a dual number."""
    if isinstance(angle, Dual):
        return Dual(np.cos(angle.value), -np.sin(angle.value) * angle.gradient)
    return np.cos(angle)


def variable(value: Any) -> Dual:
    """A number, or an array of them, as the one variable to differentiate by: gradient of shape (1, ...)."""
    value = np.asarray(value, dtype=float)
    return Dual(value, np.ones((1, *value.shape)))


def variables(point: Sequence[Any]) -> list[Dual]:
    """The numbers, or arrays of one shape, of a point as independent variables."""
    values = np.asarray(np.broadcast_arrays(*point), dtype=float)
    directions = np.eye(len(values)).reshape(len(values), len(values), *(1,) * (values.ndim - 1))
    return [
        Dual(value, direction * np.ones_like(values))
        for value, direction in zip(values, directions, strict=True)
    ]


def derivative(quantity: Any, like: Dual) -> Array:
    """Gradient of a quantity, shape (k, *value.shape); zero where it is a plain number.

    `like` is one of the variables that the quantity was computed of, for the shape of a zero.
    """
    gradient = quantity.gradient if isinstance(quantity, Dual) else 0.0
    whole: Array = gradient + np.zeros_like(like.gradient)
    return whole


def jacobian(function: Callable[[list[Dual]], Sequence[Any]], point: Sequence[Any]) -> Array:
    """Matrix of the derivatives of a function at a point, or at many points at once.

    The function takes k dual numbers and returns r of them, by plain operators only; the point is k numbers,
    or k arrays of one shape. Shape (*shape, r, k): the derivative of each result by each variable.
    """
    seeds = variables(point)
    rows = np.stack([derivative(result, seeds[0]) for result in function(seeds)])
    return np.moveaxis(rows, (0, 1), (-2, -1))
