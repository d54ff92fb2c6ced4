"""Taylor's method for many launches at once, compiled by LLVM, and its arithmetic on arrays."""

from collections.abc import Callable, Sequence
from functools import cached_property, lru_cache
from itertools import chain
from typing import Any

import numpy as np

from tippetop.graph.llvm import ABREAST
from tippetop.graph.recording import record
from tippetop.graph.taylor_coefficients import NodeArithmetic
from tippetop.integrators.base import Array, Motion, Rows
from tippetop.mechanics.vectors import Scalar
from tippetop.support.interrupts import deferred
from tippetop.sweeps.lane_sums import NO_SUMS, LaneSums
from tippetop.sweeps.taylor_step import LANES, Jet, Layout, expansion, order_for, stride

NODES = NodeArithmetic()


class NumPyArithmetic:
    """Coefficients that are arrays."""

    def total(self, terms: Sequence[Array]) -> Array:
        """Sum of terms."""
        return sum(terms[1:], terms[0])

    def least(self, a: Array, b: Array) -> Array:
        """Return the smaller of two."""
        return np.where(a < b, a, b)

    def size(self, a: Array) -> Array:
        """Absolute value."""
        return np.abs(a)

    def below(self, a: Any, b: Any) -> Any:
        """1 where the first is less than the second, else 0."""
        return np.where(a < b, 1.0, 0.0)

    def choose(self, condition: Array, a: Any, b: Any) -> Any:
        """Return the first where a condition is not 0, else the second."""
        return np.where(condition != 0.0, a, b)

    rarely = choose


class LaneStepper:
    """Taylor's method for one motion, of some order, compiled when first used.

    The last numbers of the motion are sums along it.
    """

    def __init__(
        self, motion: Motion, order: int, sums: LaneSums = NO_SUMS, *, sampled: bool = False
    ) -> None:
        self.motion, self.order, self.sums = motion, order, sums
        self.layout = Layout.of(motion, sampled=sampled)

    def step(self, before: Array, after: Array, numbers: Array) -> None:
        """Take a step from the rows of `before` to those of `after`, both of shape (layout.rows,
        n).

        The numbers have shape (layout.numbers, n). A launch with no time left stays as it is.
        """
        self._step(before[: self.layout.carried_rows], numbers, after)

    def jet(self, before: Array, numbers: Array) -> Jet:
        """Return the polynomials in time of the steps that start from `before`."""

        def made(start: Array, numbers: Array, terms: Array) -> None:
            self._step(start, numbers, np.empty((self.layout.rows, start.shape[1])), terms)

        return _expanded(made, before[: self.layout.carried_rows], numbers, self.motion, self.order)

    @cached_property
    def _step(self) -> Callable[..., None]:
        motion, order, layout = self.motion, self.order, self.layout

        def rows(before: Sequence[Scalar], numbers: Sequence[Scalar]) -> list[Scalar]:
            jet = expansion(motion, order, before[: layout.size], numbers, NODES)
            return [*stride(layout, jet, before, numbers, NODES), *chain(*chain(*jet))]

        return compiled(rows, layout.carried_rows, layout.numbers, _count(motion, order))


@lru_cache(maxsize=16)
def stepper(
    motion: Motion, tolerance: float, sums: LaneSums = NO_SUMS, *, sampled: bool = False
) -> LaneStepper:
    """Taylor's method for a motion with sums, which may be sampled."""
    return LaneStepper(motion, order_for(tolerance), sums, sampled=sampled)


@lru_cache(maxsize=16)
def polynomials(motion: Motion, tolerance: float) -> Callable[[Array, Array], Jet]:
    """Return the function that makes the polynomials of a motion, from numbers of shape (size, n)
    and parameters.
    """
    order = order_for(tolerance)

    def rows(start: Sequence[Scalar], numbers: Sequence[Scalar]) -> list[Scalar]:
        return [*chain(*chain(*expansion(motion, order, start, numbers, NODES)))]

    made = compiled(rows, motion.size, motion.parameters, effort=0)
    return lambda start, numbers: _expanded(made, start, numbers, motion, order)


def compiled(
    function: Rows, size: int, parameters: int, optional: int = 0, **options: int
) -> Callable[..., None]:
    """Compile a function of so many rows and parameters for launches abreast; see `record`."""
    # An interrupted import leaves a module in pieces.
    with deferred():
        from tippetop.integrators.machine_code import machine_code  # noqa: PLC0415 - optional, slow to import

    return machine_code({"made": record(function, size, parameters, optional)}, ABREAST, **options)[
        "made"
    ]


def _count(motion: Motion, order: int) -> int:
    """Return how many coefficients the polynomials of a motion have."""
    return motion.size * (order + 1) + len(motion.guards) * order


def _expanded(
    made: Callable[..., None], start: Array, numbers: Array, motion: Motion, order: int
) -> Jet:
    """Return the polynomials of a motion from compiled code, coefficients one after another."""
    count, padded_start = start.shape[1], padded(start)
    terms = np.empty((_count(motion, order), padded_start.shape[1]))
    made(padded_start, padded(numbers), terms)
    state, guards = np.split(terms[:, :count], [motion.size * (order + 1)])
    return Jet(state.reshape(motion.size, order + 1, count), guards.reshape(-1, order, count))


def padded(rows: Array) -> Array:
    """Rows filled up with copies of their last number to a multiple of `LANES`."""
    count = rows.shape[1]
    filled = np.empty((len(rows), count + -count % LANES))
    filled[:, :count], filled[:, count:] = rows, rows[:, -1:]
    return filled
