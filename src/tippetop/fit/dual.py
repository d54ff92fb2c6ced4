"""Dual numbers: values with their derivatives in several directions, in plain operators."""

from typing import Any

import numpy as np

from tippetop.integrators.base import Array
from tippetop.mechanics import elementary


class Dual:
    """A number and its derivatives, shape (directions,); comparisons are those of the number.

    Or many numbers: an array of them, with derivatives of shape (directions, ...).
    """

    __array_ufunc__ = None
    __slots__ = ("parts", "value")

    def __init__(self, value: Any, parts: Array) -> None:
        self.value, self.parts = value, parts

    def __add__(self, operand: Any) -> "Dual":
        if isinstance(operand, Dual):
            return Dual(self.value + operand.value, self.parts + operand.parts)
        return Dual(self.value + operand, self.parts)

    __radd__ = __add__

    def __neg__(self) -> "Dual":
        return Dual(-self.value, -self.parts)

    def __sub__(self, operand: Any) -> "Dual":
        if isinstance(operand, Dual):
            return Dual(self.value - operand.value, self.parts - operand.parts)
        return Dual(self.value - operand, self.parts)

    def __rsub__(self, operand: Any) -> "Dual":
        return Dual(operand - self.value, -self.parts)

    def __mul__(self, operand: Any) -> "Dual":
        if isinstance(operand, Dual):
            parts = self.parts * operand.value + operand.parts * self.value
            return Dual(self.value * operand.value, parts)
        return Dual(self.value * operand, self.parts * operand)

    __rmul__ = __mul__

    def __truediv__(self, operand: Any) -> "Dual":
        if isinstance(operand, Dual):
            ratio = self.value / operand.value
            return Dual(ratio, (self.parts - ratio * operand.parts) / operand.value)
        return Dual(self.value / operand, self.parts / operand)

    def __rtruediv__(self, operand: Any) -> "Dual":
        ratio = operand / self.value
        return Dual(ratio, -ratio / self.value * self.parts)

    def __pow__(self, exponent: float) -> "Dual":
        if exponent == 0:
            return Dual(1.0, 0.0 * self.parts)
        slope = exponent * self.value ** (exponent - 1.0)
        return Dual(self.value**exponent, slope * self.parts)

    def exp(self) -> "Dual":
        """Return the exponential function."""
        value = elementary.exp(self.value)
        return Dual(value, value * self.parts)

    def log(self) -> "Dual":
        """Return the natural logarithm."""
        return Dual(elementary.log(self.value), self.parts / self.value)

    def tanh(self) -> "Dual":
        """Return the hyperbolic tangent."""
        value = elementary.tanh(self.value)
        return Dual(value, (1.0 - value * value) * self.parts)

    def __abs__(self) -> "Dual":
        return self if self.value >= 0.0 else -self

    def __lt__(self, operand: Any) -> bool:
        return bool(self.value < value_of(operand))

    def __le__(self, operand: Any) -> bool:
        return bool(self.value <= value_of(operand))

    def __gt__(self, operand: Any) -> bool:
        return bool(self.value > value_of(operand))

    def __ge__(self, operand: Any) -> bool:
        return bool(self.value >= value_of(operand))

    def __eq__(self, operand: object) -> bool:
        return bool(self.value == value_of(operand))

    __hash__ = None  # type: ignore[assignment]

    def __bool__(self) -> bool:
        return bool(self.value)


def value_of(number: Any) -> Any:
    """Return the value of a dual number, or a plain number itself."""
    return number.value if isinstance(number, Dual) else number


def parts_of(number: Any, directions: int) -> Array:
    """Return the derivatives of a number, which are zero for a plain one."""
    return number.parts if isinstance(number, Dual) else np.zeros(directions)


def duals(values: Any, parts: Array) -> list[Dual]:
    """Return numbers with their derivatives, shape (directions, count), as dual numbers."""
    return [Dual(float(value), row) for value, row in zip(values, parts.T, strict=True)]
