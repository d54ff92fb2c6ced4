"""Power series in time whose coefficients are made when they are asked for.

Equations of motion written in plain operators, evaluated on such series, give every coefficient of
their own solution, each from those before it: Taylor's method (Moore 1966, Interval Analysis,
chapter 11; Jorba and Zou 2005, Experimental Mathematics 14). The coefficients may be arrays, one
number a launch, or expressions that are compiled for such arrays.
"""

# translate module: series

from collections.abc import Callable, Sequence
from operator import mul
from typing import Any, Protocol

from tippetop.mechanics import elementary
from tippetop.mechanics.vectors import Scalar, whole_power


class Sums(Protocol):
    """How coefficients are added up."""

    def total(self, terms: Sequence[Scalar]) -> Scalar:
        """Sum of terms."""


class Arithmetic(Sums, Protocol):
    """What else is done to coefficients beside plain operators."""

    def least(self, a: Scalar, b: Scalar) -> Scalar:
        """Return the smaller of two, element by element; the second where one is not a number."""

    def size(self, a: Scalar) -> Scalar:
        """Absolute value."""

    def below(self, a: Scalar, b: Scalar) -> Scalar:
        """1 where the first is less than the second, else 0."""

    def choose(self, condition: Scalar, a: Scalar, b: Scalar) -> Scalar:
        """Return the first where a condition is not 0, else the second."""

    def rarely(self, condition: Scalar, a: Scalar, b: Scalar) -> Scalar:
        """Return the first where a condition is not 0, else the second, which is the usual case."""


class PlainArithmetic:
    """Coefficients that have plain operators, such as floats."""

    def total(self, terms: Sequence[Scalar]) -> Scalar:
        """Sum of terms."""
        return sum(terms[1:], terms[0])


PLAIN = PlainArithmetic()


class Series:
    """A power series in time, by a rule for its k-th coefficient.

    Parameters
    ----------
    rule
        From k to the coefficient of t^k; it is called once for every k, in increasing order, and
        may use earlier coefficients of the series itself.
    arithmetic
        How coefficients are added up.
    """

    __array_ufunc__ = None
    """Keeps NumPy from taking a series for an element of an array."""

    def __init__(self, rule: Callable[[int], Scalar], arithmetic: Sums) -> None:
        self.rule = rule
        self.arithmetic = arithmetic
        self.coefficients: list[Scalar] = []

    def __getitem__(self, k: int) -> Scalar:
        return self.up_to(k)[k]

    def up_to(self, k: int) -> list[Scalar]:
        """Coefficients, at least as many as up to the k-th."""
        coefficients = self.coefficients
        while len(coefficients) <= k:
            coefficients.append(self.rule(len(coefficients)))
        return coefficients

    def _made(self, rule: Callable[[int], Scalar]) -> "Series":
        return Series(rule, self.arithmetic)

    def __add__(self, operand: Any) -> "Series":
        if isinstance(operand, Series):
            return self._made(lambda k: self[k] + operand[k])
        if is_exactly(operand, 0.0):
            return self
        return self._made(lambda k: self[k] if k else self[0] + operand)

    def __mul__(self, operand: Any) -> Any:
        if isinstance(operand, Series):
            if operand is self:
                return self._squared()
            return self._made(lambda k: self._product(operand, k))
        if is_exactly(operand, 0.0):
            return 0.0
        if is_exactly(operand, 1.0):
            return self
        return self._made(lambda k: operand * self[k])

    def _product(self, operand: "Series", k: int) -> Scalar:
        ours, theirs = self.up_to(k), operand.up_to(k)
        return self.arithmetic.total(list(map(mul, ours, theirs[k::-1])))

    def _squared(self) -> "Series":
        def rule(k: int) -> Scalar:
            coefficients = self.up_to(k)
            middle = coefficients[k // 2] * coefficients[k // 2] if k % 2 == 0 else 0.0
            return self._twice(coefficients, range((k + 1) // 2), k) + middle

        return self._made(rule)

    def _twice(self, coefficients: list[Scalar], places: range, k: int) -> Scalar:
        """Products of coefficients that come twice in the k-th of a square."""
        terms = [coefficients[j] * coefficients[k - j] for j in places]
        return 2.0 * self.arithmetic.total(terms) if terms else 0.0

    def _root(self) -> "Series":
        """Return the square root, at half the cost of other powers."""
        half: list[Scalar] = []

        def rule(k: int) -> Scalar:
            if k == 0:
                first = self[0] ** 0.5
                half.append(0.5 / first)
                return first
            coefficients = root.coefficients
            middle = coefficients[k // 2] * coefficients[k // 2] if k % 2 == 0 else 0.0
            return (
                self[k] - (self._twice(coefficients, range(1, (k + 1) // 2), k) + middle)
            ) * half[0]

        root = self._made(rule)
        return root

    def __truediv__(self, operand: Any) -> Any:
        if not isinstance(operand, Series):
            return self * (1.0 / operand)
        inverse: list[Scalar] = []

        def rule(k: int) -> Scalar:
            if k == 0:
                inverse.append(1.0 / operand[0])
                return self[0] * inverse[0]
            divisor = operand.up_to(k)
            coefficients = self.arithmetic.total(
                list(map(mul, quotient.coefficients, divisor[k:0:-1]))
            )
            return (self[k] - coefficients) * inverse[0]

        quotient = self._made(rule)
        return quotient

    def __pow__(self, exponent: float) -> Any:
        if exponent >= 0.0 and exponent % 1.0 == 0.0:
            return whole_power(self, exponent)  # the rule below divides by the base
        if exponent in (0.5, -0.5, 0.25):
            return self._root() if exponent == 0.5 else self._root() ** (2.0 * exponent)
        inverse: list[Scalar] = []

        def rule(k: int) -> Scalar:
            # y' a = exponent a' y, term by term.
            if k == 0:
                inverse.append(1.0 / self[0])
                return self[0] ** exponent
            base, made = self.up_to(k), power.coefficients
            factors = [((exponent + 1.0) * j - k) / k for j in range(1, k + 1)]
            terms = list(map(mul, factors, map(mul, base[1:], made[k - 1 :: -1])))
            return self.arithmetic.total(terms) * inverse[0]

        power = self._made(rule)
        return power

    # translate: skip
    def exp(self) -> "Series":
        """Return the exponential function, by e' = a' e, term by term."""

        def rule(k: int) -> Scalar:
            return self._integral(made.coefficients, k) if k else elementary.exp(self[0])

        made = self._made(rule)
        return made

    # translate: skip
    def log(self) -> "Series":
        """Return the natural logarithm, by a l' = a', term by term."""

        def rule(k: int) -> Scalar:
            if k == 0:
                return elementary.log(self[0])
            base, coefficients = self.up_to(k), made.coefficients
            factors = [-j / k for j in range(1, k)]
            terms = list(map(mul, factors, map(mul, coefficients[1:], base[k - 1 : 0 : -1])))
            return self.arithmetic.total([base[k], *terms]) / base[0]

        made = self._made(rule)
        return made

    # translate: skip
    def tanh(self) -> "Series":
        """Return the hyperbolic tangent, by t' = a' (1 - t^2), term by term."""

        def rule(k: int) -> Scalar:
            return self._integral(slope.up_to(k - 1), k) if k else elementary.tanh(self[0])

        made = self._made(rule)
        slope = 1.0 - made * made
        return made

    # translate: skip
    def _integral(self, slope: list[Scalar], k: int) -> Scalar:
        """Return the k-th coefficient, from 1, of a function of the series whose derivative has
        these coefficients.
        """
        factors = [j / k for j in range(1, k + 1)]
        terms = map(mul, factors, map(mul, self.up_to(k)[1:], slope[k - 1 :: -1]))
        return self.arithmetic.total(list(terms))

    def __neg__(self) -> "Series":
        return self._made(lambda k: -self[k])

    def __sub__(self, operand: Any) -> "Series":
        return self.__add__(-operand)

    def __radd__(self, operand: Any) -> "Series":
        return self.__add__(operand)

    def __rsub__(self, operand: Any) -> "Series":
        return (-self).__add__(operand)

    def __rmul__(self, operand: Any) -> Any:
        return self * operand

    def __rtruediv__(self, operand: Any) -> Any:
        return self**-1.0 * operand


def is_exactly(value: object, number: float) -> bool:
    """Return whether a value is a plain number, and this one."""
    return isinstance(value, (int, float)) and value == number


def solved(
    series: list[Series],
    start: Sequence[Scalar],
    rates: Callable[[Sequence[Series]], Sequence[Any]],
) -> list[Series]:
    """Series that are unknown, made the solution of y' = rates(y) that starts at y = start."""

    def rule(first: Scalar, slope: Any) -> Callable[[int], Scalar]:
        if not isinstance(slope, Series):
            return lambda k: (first, 0.0 * first + slope)[k] if k < 2 else 0.0 * first
        return lambda k: slope[k - 1] * (1.0 / k) if k else first

    for one, first, slope in zip(series, start, rates(series), strict=True):
        one.rule = rule(first, slope)
    return series


def unknown(k: int) -> Scalar:
    """Refuse to give a coefficient of a series without a rule."""
    raise AssertionError(f"a series is asked for its coefficient {k} before that is known")


def horner(coefficients: Sequence[Scalar], time: Scalar) -> Scalar:
    """Value of a polynomial, its coefficients in increasing order, at a time."""
    value = coefficients[-1]
    for coefficient in reversed(coefficients[:-1]):
        value = coefficient + value * time
    return value
