"""Dual numbers: values with their derivatives in several directions, in plain operators."""

from typing import Any

import numpy as np

from tippetop.integrators.base import Array


class Dual:
    """A number and its derivatives, shape (directions,); comparisons are those of the number."""

    __array_ufunc__ = None
    __slots__ = ("parts", "value")

    def __init__(self, value: float, parts: Array) -> None:
        self.value, self.parts = value, parts

    def __add__(self, other: Any) -> "Dual":
        if isinstance(other, Dual):
            return Dual(self.value + other.value, self.parts + other.parts)
        return Dual(self.value + other, self.parts)

    __radd__ = __add__

    def __neg__(self) -> "Dual":
        return Dual(-self.value, -self.parts)

    def __sub__(self, other: Any) -> "Dual":
        if isinstance(other, Dual):
            return Dual(self.value - other.value, self.parts - other.parts)
        return Dual(self.value - other, self.parts)

    def __rsub__(self, other: Any) -> "Dual":
        return Dual(other - self.value, -self.parts)

    def __mul__(self, other: Any) -> "Dual":
        if isinstance(other, Dual):
            parts = self.parts * other.value + other.parts * self.value
            return Dual(self.value * other.value, parts)
        return Dual(self.value * other, self.parts * other)

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> "Dual":
        if isinstance(other, Dual):
            ratio = self.value / other.value
            return Dual(ratio, (self.parts - ratio * other.parts) / other.value)
        return Dual(self.value / other, self.parts / other)

    def __rtruediv__(self, other: Any) -> "Dual":
        ratio = other / self.value
        return Dual(ratio, -ratio / self.value * self.parts)

    def __pow__(self, exponent: float) -> "Dual":
        if exponent == 0:
            return Dual(1.0, 0.0 * self.parts)
        slope = exponent * self.value ** (exponent - 1.0)
        return Dual(self.value**exponent, slope * self.parts)

    def __abs__(self) -> "Dual":
        return self if self.value >= 0.0 else -self

    def __lt__(self, other: Any) -> bool:
        return bool(self.value < value_of(other))

    def __le__(self, other: Any) -> bool:
        return bool(self.value <= value_of(other))

    def __gt__(self, other: Any) -> bool:
        return bool(self.value > value_of(other))

    def __ge__(self, other: Any) -> bool:
        return bool(self.value >= value_of(other))

    def __eq__(self, other: object) -> bool:
        return bool(self.value == value_of(other))

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
