"""Taylor's method for many launches at once, compiled where heyoka is installed."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from tippetop.integrators import has_taylor
from tippetop.integrators.base import Array, Motion
from tippetop.interrupts import deferred
from tippetop.sweeps.stride import Jet, Layout, Stepper, motion_series, order_for, stride


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


@dataclass(frozen=True)
class NumPyStepper:
    """Taylor's method without a compiler; see `Stepper`."""

    motion: Motion
    order: int

    @property
    def layout(self) -> Layout:
        """Which row holds what."""
        return Layout.of(self.motion)

    def step(self, before: Array, after: Array, numbers: Array) -> None:
        """Take a step."""
        with np.errstate(all="ignore"):
            kept = list(before[: self.layout.kept])
            rows = stride(self.motion, self.order, kept, list(numbers), NumPyArithmetic())
        for row, value in zip(after, rows, strict=True):
            row[:] = value

    def jet(self, before: Array, numbers: Array) -> Jet:
        """The polynomials of the steps."""
        with np.errstate(all="ignore"):
            start = list(before[: self.layout.size])
            y, guards = motion_series(self.motion, start, list(numbers), NumPyArithmetic())
            state = [[series[k] for k in range(self.order + 1)] for series in y]
            values = [[guard[k] for k in range(self.order)] for guard in guards]
        return Jet(np.array(state), np.array(values))


@lru_cache(maxsize=16)
def stepper(motion: Motion, tolerance: float) -> Stepper:
    """Taylor's method for a motion: compiled where heyoka is installed."""
    order = order_for(tolerance)
    if not has_taylor():
        return NumPyStepper(motion, order)
    # An interrupted import of heyoka leaves it in pieces.
    with deferred():
        from tippetop.sweeps.compiled import CompiledStepper  # noqa: PLC0415 - optional, and slow to import

    return CompiledStepper(motion, order)
