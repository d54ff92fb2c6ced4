"""Steps of Taylor's method compiled by heyoka."""

from collections.abc import Sequence
from typing import Any

import heyoka as hy
import numpy as np

from tippetop.integrators.base import Array
from tippetop.integrators.compile_cache import compiling
from tippetop.mechanics.top import Kind
from tippetop.sweep.stepper import CARES, KEPT, LANES, SIZE, Jet, sliding_jet, stride


class ExpressionArithmetic:
    """Coefficients that are expressions to be compiled."""

    def total(self, terms: Sequence[Any]) -> Any:
        """Sum of terms."""
        return hy.sum([hy.expression(term) for term in terms])

    def least(self, a: Any, b: Any) -> Any:
        """The smaller of two."""
        return hy.select(hy.lt(a, b), a, b)

    def size(self, a: Any) -> Any:
        """Absolute value."""
        return hy.select(hy.lt(a, 0.0), -a, a)

    def below(self, a: Any, b: Any) -> Any:
        """1 where the first is less than the second, else 0."""
        return hy.lt(a, b)

    def choose(self, condition: Any, a: Any, b: Any) -> Any:
        """The first where a condition is not 0, else the second."""
        return hy.select(condition, a, b)


class CompiledStepper:
    """Taylor's method as a pair of compiled functions; see `tippetop.sweep.stepper.Stepper`."""

    def __init__(self, kind: Kind, order: int) -> None:
        # Launches are spread over processes; threads would only get in each other's way.
        hy.set_nthreads(1)
        self.kind, self.order = kind, order
        self._state = hy.make_vars(*(f"y{i}" for i in range(SIZE)))
        self._numbers = [hy.par[i] for i in range(kind.numbers + CARES)]
        others = hy.make_vars(*(f"k{i}" for i in range(SIZE, KEPT)))
        kept = [*self._state, *others]
        rows = stride(kind, order, kept, self._numbers, ExpressionArithmetic())
        with compiling():
            self._step = hy.cfunc([hy.expression(row) for row in rows], vars=kept)
        self._jet: Any = None

    def step(self, before: Array, after: Array, numbers: Array) -> None:
        """Take a step."""
        self._step(before[:KEPT], outputs=after, pars=numbers)

    def jet(self, before: Array, numbers: Array) -> Jet:
        """The polynomials of the steps."""
        if self._jet is None:
            y, normal = sliding_jet(self.kind, self._state, self._numbers, ExpressionArithmetic())
            rows = [series[k] for series in y for k in range(self.order + 1)]
            rows += [normal[k] for k in range(self.order)]
            with compiling():
                self._jet = hy.cfunc([hy.expression(row) for row in rows], vars=list(self._state))
        count = before.shape[1]
        values = self._jet(padded(before[:SIZE]), pars=padded(numbers[: self.kind.numbers]))[:, :count]
        cut = SIZE * (self.order + 1)
        return Jet(values[:cut].reshape(SIZE, self.order + 1, count), values[cut:])


def padded(rows: Array) -> Array:
    """Rows filled up with copies of their last number to a multiple of `LANES`."""
    missing = -rows.shape[1] % LANES
    return np.ascontiguousarray(np.pad(rows, ((0, 0), (0, missing)), mode="edge"))
