"""Vectors as plain tuples of anything that has arithmetic."""

from math import nan
from typing import Any, Protocol, TypeAlias

Scalar: TypeAlias = Any
"""A float, a NumPy array, a compiled expression or an algebraic symbol: whatever has + - * / and **."""

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
    """A vector times a number."""
    return (factor * a[0], factor * a[1], factor * a[2])


def length(a: Vector) -> Scalar:
    """Euclidean length of a vector."""
    return dot(a, a) ** 0.5


def power(base: Scalar, exponent: float) -> Scalar:
    """A power that is not whole; no number of a negative float, of which Python makes a complex number."""
    return nan if isinstance(base, float) and base < 0.0 else base**exponent
