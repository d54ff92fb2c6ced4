"""Taylor's method for many launches at once, compiled by LLVM, and its arithmetic on arrays."""

from collections.abc import Callable, Sequence
from functools import cached_property, lru_cache
from typing import Any

import numpy as np

from tippetop.emit.coefficients import NodeArithmetic
from tippetop.emit.llvm import ABREAST
from tippetop.emit.recording import record
from tippetop.integrators.base import Array, Motion, Rows
from tippetop.interrupts import deferred
from tippetop.mechanics.vectors import Scalar
from tippetop.sweeps.stride import LANES, Jet, Layout, motion_series, order_for, stride

NODES = NodeArithmetic()


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


class Stepper:
    """Taylor's method for one motion, of some order, as a pair of compiled functions."""

    def __init__(self, motion: Motion, order: int) -> None:
        self.motion, self.order, self.layout = motion, order, Layout.of(motion)

    def step(self, before: Array, after: Array, numbers: Array) -> None:
        """Take a step from the rows of `before` to those of `after`, both of shape (layout.rows, n).

        The numbers have shape (layout.numbers, n). A launch with no time left stays as it is.
        """
        self._step(before[: self.layout.kept], numbers, after)

    def jet(self, before: Array, numbers: Array) -> Jet:
        """The polynomials in time of the steps that start from `before`."""
        layout, order, count = self.layout, self.order, before.shape[1]
        start, given = padded(before[: layout.size]), padded(numbers[: layout.parameters])
        cut = layout.size * (order + 1)
        values = np.empty((cut + layout.guards * order, start.shape[1]))
        self._jet(start, given, values)
        guards = values[cut:, :count].reshape(layout.guards, order, count)
        return Jet(values[:cut, :count].reshape(layout.size, order + 1, count), guards)

    @cached_property
    def _step(self) -> Callable[[Array, Array, Array], None]:
        def rows(before: Sequence[Scalar], numbers: Sequence[Scalar]) -> list[Scalar]:
            return stride(self.motion, self.order, before, numbers, NODES)

        return compiled(rows, self.layout.kept, self.layout.numbers)

    @cached_property
    def _jet(self) -> Callable[[Array, Array, Array], None]:
        def rows(start: Sequence[Scalar], numbers: Sequence[Scalar]) -> list[Scalar]:
            y, guards = motion_series(self.motion, start, numbers, NODES)
            rows = [series[k] for series in y for k in range(self.order + 1)]
            return rows + [guard[k] for guard in guards for k in range(self.order)]

        return compiled(rows, self.layout.size, self.layout.parameters, effort=0)


@lru_cache(maxsize=16)
def stepper(motion: Motion, tolerance: float) -> Stepper:
    """Taylor's method for a motion, whose functions are compiled when first used."""
    return Stepper(motion, order_for(tolerance))


def compiled(
    function: Rows, size: int, parameters: int, **options: int
) -> Callable[[Array, Array, Array], None]:
    """A function of so many rows and parameters, compiled for launches abreast."""
    # An interrupted import leaves a module in pieces.
    with deferred():
        from tippetop.integrators.machine_code import machine_code  # noqa: PLC0415 - optional, slow to import

    return machine_code({"made": record(function, size, parameters)}, ABREAST, **options)["made"]


def padded(rows: Array) -> Array:
    """Rows filled up with copies of their last number to a multiple of `LANES`."""
    missing = -rows.shape[1] % LANES
    return np.ascontiguousarray(np.pad(rows, ((0, 0), (0, missing)), mode="edge"))
