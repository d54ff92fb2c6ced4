"""Coefficients of power series as nodes: what Taylor's method computes, recorded number by
number.
"""

from collections.abc import Callable
from typing import Any

from tippetop.graph.graph import Node
from tippetop.mechanics.series import PlainArithmetic, Series, Sums
from tippetop.mechanics.vectors import Scalar


class NodeArithmetic(PlainArithmetic):
    """Coefficients that are nodes, or numbers."""

    def least(self, a: Any, b: Any) -> Any:
        """Return the smaller of two; the second where one is not a number."""
        return self.choose(self.below(a, b), a, b)

    def size(self, a: Any) -> Any:
        """Absolute value."""
        return abs(a)

    def below(self, a: Any, b: Any) -> Any:
        """1 where the first is less than the second, else 0."""
        return 1.0 * (a < b)

    def choose(self, condition: Any, a: Any, b: Any) -> Any:
        """Return the first where a condition is not 0, else the second."""
        if isinstance(condition, Node):
            return condition.graph.select(condition, a, b)
        return a if condition else b

    def rarely(self, condition: Any, a: Any, b: Any) -> Any:
        """Return the same as `choose`, where that is mostly the second; a function has one such
        condition.
        """
        return condition.graph.rarely(condition, a, b)


class SharedSeries(Series):
    """A power series; what is made of it and the same other series, or number, is made once.

    Equations of motion and guards ask for the same forces, each for itself.
    """

    def __init__(self, rule: Callable[[int], Scalar], arithmetic: Sums) -> None:
        super().__init__(rule, arithmetic)
        self.shared = dict[Any, Any]()

    def _made(self, rule: Callable[[int], Scalar]) -> "SharedSeries":
        return SharedSeries(rule, self.arithmetic)


def _once(operation: Callable[..., Any]) -> Callable[..., Any]:
    def shared(series: SharedSeries, *operands: Any) -> Any:
        if not all(isinstance(one, (Series, float, int)) for one in operands):
            return operation(series, *operands)
        if (operation, *operands) not in series.shared:
            series.shared[operation, *operands] = operation(series, *operands)
        return series.shared[operation, *operands]

    return shared


for name in ("__add__", "__mul__", "__truediv__", "__pow__", "__neg__", "exp", "log", "tanh"):
    setattr(SharedSeries, name, _once(getattr(Series, name)))
