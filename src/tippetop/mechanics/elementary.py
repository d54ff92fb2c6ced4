"""Elementary functions of floats, arrays, power series, dual numbers and expression graphs.

Friction laws that users define are written with them: each law runs on all of these. Series, dual
numbers and nodes have a method for each function; an array names the library that has its
functions (the method `__array_namespace__` of the array API standard).
"""

import math

from tippetop.mechanics.vectors import Scalar


def exp(number: Scalar) -> Scalar:
    """Return the exponential function of a number; infinity where it is larger than any float."""
    if isinstance(number, (int, float)):
        try:
            return math.exp(number)
        except OverflowError:
            return math.inf
    if hasattr(number, "exp"):
        return number.exp()
    return number.__array_namespace__().exp(number)


def log(number: Scalar) -> Scalar:
    """Return the natural logarithm of a number; minus infinity of 0, and no number of a negative
    one.
    """
    if isinstance(number, (int, float)):
        if number > 0.0:
            return math.log(number)
        return -math.inf if number == 0.0 else math.nan
    if hasattr(number, "log"):
        return number.log()
    return number.__array_namespace__().log(number)


def tanh(number: Scalar) -> Scalar:
    """Return the hyperbolic tangent of a number."""
    if isinstance(number, (int, float)):
        return math.tanh(number)
    if hasattr(number, "tanh"):
        return number.tanh()
    return number.__array_namespace__().tanh(number)
