"""What a surface may be evaluated on besides numbers: power series in time, and discs of complex numbers."""

from operator import mul
from typing import Any, Self


class Algebra:
    """Arithmetic that follows from a sum, a product and a power, for what the mechanics may run on."""

    def __add__(self, other: Any) -> Self:
        raise NotImplementedError

    def __mul__(self, other: Any) -> Self:
        raise NotImplementedError

    def power(self, exponent: float) -> Self:
        """A power that is not a natural number."""
        raise NotImplementedError

    def __pow__(self, exponent: float) -> Self:
        if exponent < 1 or exponent != int(exponent):
            return self.power(exponent)
        return self if exponent == 1 else self * self ** (exponent - 1)

    def __neg__(self) -> Self:
        return self * -1.0

    def __sub__(self, other: Any) -> Self:
        return self.__add__(-other)

    def __truediv__(self, other: Any) -> Self:
        return self.__mul__(other**-1.0)

    def __radd__(self, other: float) -> Self:
        return self + other

    def __rsub__(self, other: float) -> Self:
        return -self + other

    def __rmul__(self, other: float) -> Self:
        return self * other

    def __rtruediv__(self, other: float) -> Self:
        return self**-1.0 * other


class TruncatedSeries(Algebra):
    """A power series in time, truncated after the degree of all others."""

    def __init__(self, terms: list[float]) -> None:
        self.terms = terms

    def __add__(self, other: Any) -> "TruncatedSeries":
        if isinstance(other, TruncatedSeries):
            return TruncatedSeries([a + b for a, b in zip(self.terms, other.terms, strict=True)])
        return TruncatedSeries([self.terms[0] + other, *self.terms[1:]])

    def __mul__(self, other: Any) -> "TruncatedSeries":
        a = self.terms
        if isinstance(other, TruncatedSeries):
            b = other.terms[::-1]
            last = len(a) - 1
            return TruncatedSeries([sum(map(mul, a, b[last - k :])) for k in range(last + 1)])
        return TruncatedSeries([other * term for term in a])

    def power(self, exponent: float) -> "TruncatedSeries":
        """A real power, term by term from y' a = exponent a' y."""
        a, y = self.terms, [self.terms[0] ** exponent]
        for k in range(1, len(a)):
            total = sum(((exponent + 1.0) * j - k) * a[j] * y[k - j] for j in range(1, k + 1))
            y.append(total / (k * a[0]))
        return TruncatedSeries(y)


class Disc(Algebra):
    """All complex numbers within a radius of a real centre, and what arithmetic can make of them."""

    def __init__(self, centre: float, radius: float) -> None:
        self.centre, self.radius = centre, radius

    def __add__(self, other: Any) -> "Disc":
        if isinstance(other, Disc):
            return Disc(self.centre + other.centre, self.radius + other.radius)
        return Disc(self.centre + other, self.radius)

    def __mul__(self, other: Any) -> "Disc":
        if isinstance(other, Disc):
            far = abs(other.centre) + other.radius
            return Disc(self.centre * other.centre, abs(self.centre) * other.radius + self.radius * far)
        return Disc(self.centre * other, self.radius * abs(other))

    def power(self, exponent: float) -> "Disc":
        """A real power, by the mean value theorem; the disc must lie right of zero for it to be analytic."""
        near, far = self.centre - self.radius, self.centre + self.radius
        if near <= 0.0:
            raise ArithmeticError("a power of a disc that touches zero")
        steepest = max(near ** (exponent - 1.0), far ** (exponent - 1.0))
        return Disc(self.centre**exponent, self.radius * abs(exponent) * steepest)
