"""Coefficients of power series as nodes: what Taylor's method computes, recorded number by number."""

from typing import Any

from tippetop.emit.graph import Node
from tippetop.mechanics.series import PlainArithmetic


class NodeArithmetic(PlainArithmetic):
    """Coefficients that are nodes, or numbers."""

    def least(self, a: Any, b: Any) -> Any:
        """The smaller of two; the second where one is not a number."""
        return self.choose(self.below(a, b), a, b)

    def size(self, a: Any) -> Any:
        """Absolute value."""
        return abs(a)

    def below(self, a: Any, b: Any) -> Any:
        """1 where the first is less than the second, else 0."""
        return 1.0 * (a < b)

    def choose(self, condition: Any, a: Any, b: Any) -> Any:
        """The first where a condition is not 0, else the second."""
        if isinstance(condition, Node):
            return condition.graph.select(condition, a, b)
        return a if condition else b

    def rarely(self, condition: Any, a: Any, b: Any) -> Any:
        """The same, where it is the second mostly; one condition for all that a function computes rarely."""
        return condition.graph.rarely(condition, a, b)
