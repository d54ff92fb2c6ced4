"""Taylor's method for many launches at once, and its arithmetic on arrays."""

from collections.abc import Sequence
from functools import lru_cache
from typing import Any

import numpy as np

from tippetop.integrators.base import Array, Motion
from tippetop.interrupts import deferred
from tippetop.sweeps.stride import Stepper, order_for


class NumPyArithmetic:
    """Coefficients that are arrays."""

    def total(self, terms: Sequence[Array]) -> Array:
        """Sum of terms."""
        return sum(terms[1:], terms[0])

    def least(self, a: Array, b: Array) -> Array:
        """The smaller of two."""
        return np.where(a < b, a, b)

    def size(self, a: Array) -> Array:
        """Absolute value."""
        return np.abs(a)

    def below(self, a: Any, b: Any) -> Any:
        """1 where the first is less than the second, else 0."""
        return np.where(a < b, 1.0, 0.0)

    def choose(self, condition: Array, a: Any, b: Any) -> Any:
        """The first where a condition is not 0, else the second."""
        return np.where(condition != 0.0, a, b)

    rarely = choose


@lru_cache(maxsize=16)
def stepper(motion: Motion, tolerance: float) -> Stepper:
    """Taylor's method for a motion, compiled by LLVM."""
    # An interrupted import leaves a module in pieces.
    with deferred():
        from tippetop.sweeps.compiled import CompiledStepper  # noqa: PLC0415 - optional, and slow to import

    return CompiledStepper(motion, order_for(tolerance))
