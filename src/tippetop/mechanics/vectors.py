"""Vectors as plain tuples of anything that has arithmetic, and a few linear equations."""

from math import nan
from typing import Any, Protocol, TypeAlias

Scalar: TypeAlias = Any
"""A float, a NumPy array, a compiled expression or an algebraic symbol: whatever has + - * / and
**.
"""

Row: TypeAlias = Any
"""Several of them: a sequence, or an array whose rows they are."""

Vector: TypeAlias = tuple[Scalar, Scalar, Scalar]
"""Components along the space axes x, y and z (up)."""

Horizontal: TypeAlias = tuple[Scalar, Scalar]
"""Components along x and y of a vector in the plane of the table."""

VERTICAL: Vector = (0.0, 0.0, 1.0)


class Functions(Protocol):
    """A module with elementary functions, such as `math`, `numpy` or `sympy`."""

    @property
    def sin(self) -> Any:
        """Sine of an angle in radians."""

    @property
    def cos(self) -> Any:
        """Cosine of an angle in radians."""


def dot(a: Vector, b: Vector) -> Scalar:
    """Scalar product of two vectors."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector, b: Vector) -> Vector:
    """Vector product of two vectors."""
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def add(a: Vector, b: Vector) -> Vector:
    """Sum of two vectors."""
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def scale(factor: Scalar, a: Vector) -> Vector:
    """Return a vector times a number."""
    return (factor * a[0], factor * a[1], factor * a[2])


def length(a: Vector) -> Scalar:
    """Euclidean length of a vector."""
    return dot(a, a) ** 0.5


def power(base: Scalar, exponent: float) -> Scalar:
    """Return a power that is not whole; nan of a negative float, of which Python makes a complex
    number.
    """
    return nan if isinstance(base, (int, float)) and base < 0.0 else base**exponent


def exceeds(first: Scalar, second: Scalar) -> Scalar:
    """Return whether a number is larger than another: of floats, arrays and expressions."""
    if hasattr(first, "graph"):
        return first.__gt__(second)  # JavaScript's operator does not ask the expression
    return first > second


def either(condition: Scalar, first: Scalar, second: Scalar) -> Scalar:
    """Return the first number where a condition holds, else the second: of floats, arrays and
    expressions.
    """
    if hasattr(condition, "graph"):
        return condition.graph.select(condition, first, second)
    if hasattr(condition, "choose"):
        return (1 * condition).choose((second, first))
    return first if condition else second


def whole_power(base: Scalar, exponent: float) -> Scalar:
    """Return a power by products, exponent 0, 1, 2, ...: analytic where the base is zero, too."""
    if exponent == 0.0:
        return 1.0
    half = whole_power(base, exponent // 2.0)
    return half * half * base if exponent % 2.0 == 1.0 else half * half


def solve(matrix: list[list[Scalar]], right: list[Scalar]) -> list[Scalar]:
    """Solution of a few linear equations, by elimination without pivots: nearly symmetric and
    definite.
    """
    if len(right) == 1:
        return [right[0] / matrix[0][0]]
    rows = [[*row, b] for row, b in zip(matrix, right, strict=True)]
    count = len(rows)
    for i, pivot in enumerate(rows):
        inverse = 1.0 / pivot[i]
        for row in rows[i + 1 :]:
            factor = row[i] * inverse
            for j in range(i + 1, count + 1):
                row[j] = row[j] - factor * pivot[j]
    for i in reversed(range(count)):
        value = rows[i][count]
        for j in range(i + 1, count):
            value = value - rows[i][j] * rows[j][count]
        rows[i][count] = value / rows[i][i]
    return [row[count] for row in rows]


def determinant(matrix: list[list[Scalar]]) -> Scalar:
    """Return the determinant of a few linear equations, of whose first pivots, all but two, none is
    zero.
    """
    rows, product = [[*row] for row in matrix], 1.0
    while len(rows) > 2:
        pivot, *others = rows
        product = product * pivot[0]
        rows = [
            [a - row[0] / pivot[0] * b for a, b in zip(row[1:], pivot[1:], strict=True)]
            for row in others
        ]
    if len(rows) == 1:
        return product * rows[0][0]
    return product * (rows[0][0] * rows[1][1] - rows[0][1] * rows[1][0])
