"""Discs of complex numbers, by which an analytic function is bounded: what a surface may be
evaluated on.
"""

from typing import Any


class Disc:
    """All complex numbers within a radius of a real centre, and what arithmetic can make of
    them.
    """

    def __init__(self, centre: float, radius: float) -> None:
        self.centre, self.radius = centre, radius

    def __add__(self, other: Any) -> "Disc":
        if isinstance(other, Disc):
            return Disc(self.centre + other.centre, self.radius + other.radius)
        return Disc(self.centre + other, self.radius)

    def __mul__(self, other: Any) -> "Disc":
        if isinstance(other, Disc):
            far = abs(other.centre) + other.radius
            return Disc(
                self.centre * other.centre, abs(self.centre) * other.radius + self.radius * far
            )
        return Disc(self.centre * other, self.radius * abs(other))

    def __pow__(self, exponent: float) -> "Disc":
        """A real power: a natural one by products, others by the mean value theorem.

        For these the disc must lie right of zero, where they are analytic.
        """
        if exponent >= 1 and exponent == int(exponent):
            return self if exponent == 1 else self * self ** (exponent - 1)
        near, far = self.centre - self.radius, self.centre + self.radius
        if near <= 0.0:
            raise ArithmeticError("a power of a disc that touches zero")
        steepest = max(near ** (exponent - 1.0), far ** (exponent - 1.0))
        return Disc(self.centre**exponent, self.radius * abs(exponent) * steepest)

    def __neg__(self) -> "Disc":
        return self * -1.0

    def __sub__(self, other: Any) -> "Disc":
        return self.__add__(-other)

    def __truediv__(self, other: Any) -> "Disc":
        return self.__mul__(other**-1.0)

    def __radd__(self, other: float) -> "Disc":
        return self + other

    def __rsub__(self, other: float) -> "Disc":
        return -self + other

    def __rmul__(self, other: float) -> "Disc":
        return self * other

    def __rtruediv__(self, other: float) -> "Disc":
        return self**-1.0 * other
