"""Steps of Taylor's method compiled by heyoka."""

from collections.abc import Sequence
from typing import Any

import heyoka as hy
import numpy as np

from tippetop.integrators.base import Array, Motion
from tippetop.integrators.compile_cache import compiling
from tippetop.sweeps.stride import LANES, Jet, Layout, motion_series, stride


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
    """Taylor's method as a pair of compiled functions; see `tippetop.sweeps.stride.Stepper`."""

    def __init__(self, motion: Motion, order: int) -> None:
        # Launches are spread over processes; threads would only get in each other's way.
        hy.set_nthreads(1)
        self.motion, self.order, self.layout = motion, order, Layout.of(motion)
        self._kept = list(hy.make_vars(*(f"y{i}" for i in range(self.layout.kept))))
        self._numbers = [hy.par[i] for i in range(self.layout.numbers)]
        rows = stride(motion, order, self._kept, self._numbers, ExpressionArithmetic())
        with compiling():
            self._step = hy.cfunc([hy.expression(row) for row in rows], vars=self._kept)
        self._jet: Any = None

    def step(self, before: Array, after: Array, numbers: Array) -> None:
        """Take a step."""
        self._step(before[: self.layout.kept], outputs=after, pars=numbers)

    def jet(self, before: Array, numbers: Array) -> Jet:
        """The polynomials of the steps."""
        size, order = self.layout.size, self.order
        if self._jet is None:
            start = self._kept[:size]
            y, guards = motion_series(self.motion, start, self._numbers, ExpressionArithmetic())
            rows = [series[k] for series in y for k in range(order + 1)]
            rows += [guard[k] for guard in guards for k in range(order)]
            with compiling():
                self._jet = hy.cfunc([hy.expression(row) for row in rows], vars=start)
        count = before.shape[1]
        values = self._jet(padded(before[:size]), pars=padded(numbers[: self._jet.nparams]))[:, :count]
        cut = size * (order + 1)
        guards = values[cut:].reshape(self.layout.guards, order, count)
        return Jet(values[:cut].reshape(size, order + 1, count), guards)


def padded(rows: Array) -> Array:
    """Rows filled up with copies of their last number to a multiple of `LANES`."""
    missing = -rows.shape[1] % LANES
    return np.ascontiguousarray(np.pad(rows, ((0, 0), (0, missing)), mode="edge"))
