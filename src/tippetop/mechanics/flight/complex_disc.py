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

    def __add__(self, operand: Any) -> "Disc":
        if isinstance(operand, Disc):
            return Disc(self.centre + operand.centre, self.radius + operand.radius)
        return Disc(self.centre + operand, self.radius)

    def __mul__(self, operand: Any) -> "Disc":
        if isinstance(operand, Disc):
            far = abs(operand.centre) + operand.radius
            return Disc(
                self.centre * operand.centre, abs(self.centre) * operand.radius + self.radius * far
            )
        return Disc(self.centre * operand, self.radius * abs(operand))

    def __pow__(self, exponent: float) -> "Disc":
        """Return a disc with a real power of all numbers: by products, or by the mean value
        theorem.

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

    def __sub__(self, operand: Any) -> "Disc":
        return self.__add__(-operand)

    def __truediv__(self, operand: Any) -> "Disc":
        return self.__mul__(operand**-1.0)

    def __radd__(self, operand: float) -> "Disc":
        return self + operand

    def __rsub__(self, operand: float) -> "Disc":
        return -self + operand

    def __rmul__(self, operand: float) -> "Disc":
        return self * operand

    def __rtruediv__(self, operand: float) -> "Disc":
        return self**-1.0 * operand
