"""A function in plain operators as a graph of operations, each of them there once.

The function is run on nodes instead of numbers, and what it does to them is recorded. What is
multiplied by 0 or 1 is left out, and what is computed twice is computed once. All of that is exact
in floating-point numbers; powers of halves and quarters become products and roots.
"""

from dataclasses import dataclass
from typing import Any

from tippetop.mechanics.series import Series, is_exactly
from tippetop.mechanics.vectors import whole_power

STATE, PARAMETER, CONSTANT = "y", "p", "constant"
SUM, DIFFERENCE, PRODUCT, QUOTIENT = "+", "-", "*", "/"
NEGATIVE, LESS, SELECT, RARELY = "negative", "less", "select", "rarely"
SIZE, ROOT, POWER, SINE, COSINE = "abs", "sqrt", "pow", "sin", "cos"
EXPONENTIAL, LOGARITHM, HYPERBOLIC_TANGENT = "exp", "log", "tanh"
SPREAD, TOTAL = "spread", "total"
"""Names of the operations of nodes. Where a node has a value for each of several lanes, `SPREAD`
gives every lane the value of one of them, and `TOTAL` gives every lane their sum.
"""

LARGEST_POWER = 16
"""Largest exponent, a number of halves or quarters, of a power that is made of roots and
products.
"""


NO_CHOICE = "a choice that depends on the numbers is to be made by select"


class NotRecordable(TypeError):
    """A function asked of a node what only a number can tell."""


@dataclass(eq=False, repr=False, slots=True)
class Node:
    """Node of the expression graph: input, constant or operation."""

    graph: "Graph"
    """Where it belongs."""
    name: str
    """What makes it: an operation, or `STATE`, `PARAMETER` or `CONSTANT`."""
    operands: "tuple[Node, ...]"
    """Of what it is made."""
    value: float
    """Which number of the state or the parameters it is, or the value of a constant."""
    place: int
    """Its number in the graph: greater than those of its operands."""

    __array_ufunc__ = None
    """Keeps NumPy from taking a node for an element of an array."""

    def __add__(self, operand: Any) -> Any:
        return NotImplemented if isinstance(operand, Series) else self.graph.sum(self, operand)

    def __radd__(self, operand: Any) -> Any:
        return self.graph.sum(operand, self)

    def __sub__(self, operand: Any) -> Any:
        if isinstance(operand, Series):
            return NotImplemented
        return self.graph.difference(self, operand)

    def __rsub__(self, operand: Any) -> Any:
        return self.graph.difference(operand, self)

    def __mul__(self, operand: Any) -> Any:
        return NotImplemented if isinstance(operand, Series) else self.graph.product(self, operand)

    def __rmul__(self, operand: Any) -> Any:
        return self.graph.product(operand, self)

    def __truediv__(self, operand: Any) -> Any:
        return NotImplemented if isinstance(operand, Series) else self.graph.quotient(self, operand)

    def __rtruediv__(self, operand: Any) -> Any:
        return self.graph.quotient(operand, self)

    def __pow__(self, exponent: Any) -> Any:
        return self.graph.power(self, exponent)

    def __neg__(self) -> Any:
        return self.operands[0] if self.name == NEGATIVE else self.graph.node(NEGATIVE, (self,))

    def __abs__(self) -> Any:
        return self.graph.node(SIZE, (self.operands[0] if self.name == NEGATIVE else self,))

    # translate: skip
    def exp(self) -> Any:
        """Return the exponential function."""
        return self.graph.node(EXPONENTIAL, (self,))

    # translate: skip
    def log(self) -> Any:
        """Return the natural logarithm."""
        return self.graph.node(LOGARITHM, (self,))

    # translate: skip
    def tanh(self) -> Any:
        """Return the hyperbolic tangent."""
        return self.graph.node(HYPERBOLIC_TANGENT, (self,))

    def __lt__(self, operand: Any) -> Any:
        return self.graph.node(LESS, (self, self.graph.as_node(operand)))

    def __gt__(self, operand: Any) -> Any:
        return self.graph.node(LESS, (self.graph.as_node(operand), self))

    def __eq__(self, operand: object) -> bool:
        if isinstance(operand, Node):
            return self is operand
        raise NotRecordable(NO_CHOICE)

    # translate: skip
    def __hash__(self) -> int:
        return self.place

    def __bool__(self) -> bool:
        raise NotRecordable(NO_CHOICE)


class Graph:
    """Nodes, each of which is there once.

    Attributes
    ----------
    nodes
        All of them, operands before what is made of them.
    """

    def __init__(self) -> None:
        self.nodes = list[Node]()
        # The same by what they are.
        self._by_description = dict[str, Node]()

    def node(self, name: str, operands: tuple[Node, ...], value: float = 0.0) -> Node:
        """Return the node of this description, made if there is none."""
        # Nearly all operations have the value 0.0, and to write it would take half of the time.
        key = f"{name} {value:.17g}" if value or not operands else name
        for operand in operands:
            key += f" {operand.place}"
        node = self._by_description.get(key)
        if node is None:
            node = Node(self, name, operands, value, len(self.nodes))
            self.nodes.append(node)
            self._by_description[key] = node
        return node

    def as_node(self, number: Any) -> Node:
        """Return a number as a node."""
        if isinstance(number, Node):
            return number
        return self.node(CONSTANT, (), float(number))

    def sum(self, a: Any, b: Any) -> Any:
        """Sum of two, as a difference if one of them is negative."""
        for first, second in ((a, b), (b, a)):
            if isinstance(second, Node):
                if second.name == NEGATIVE:
                    return self.difference(first, second.operands[0])
            elif second == 0.0:
                return first
        return self.node(SUM, in_order(self.as_node(a), self.as_node(b)))

    def difference(self, a: Any, b: Any) -> Any:
        """Difference of two."""
        if is_exactly(a, 0.0) or is_exactly(b, 0.0):
            return -b if is_exactly(a, 0.0) else a
        return 0.0 if a is b else self.node(DIFFERENCE, (self.as_node(a), self.as_node(b)))

    def product(self, a: Any, b: Any) -> Any:
        """Product of two."""
        for first, second in ((a, b), (b, a)):
            if not isinstance(first, Node):
                if first == 0.0:
                    return 0.0
                if abs(first) == 1.0:
                    return second if first > 0.0 else -second
        return self.node(PRODUCT, in_order(self.as_node(a), self.as_node(b)))

    def quotient(self, a: Any, b: Any) -> Any:
        """Quotient of two."""
        if is_exactly(a, 0.0) or is_exactly(b, 1.0):
            return a
        return self.node(QUOTIENT, (self.as_node(a), self.as_node(b)))

    def power(self, base: Node, exponent: Any) -> Any:
        """Return a power: products if the exponent is whole, and roots of halves and quarters."""
        if not isinstance(exponent, (int, float)):
            raise NotRecordable("exponents are numbers")
        fraction, integer = exponent % 1.0, exponent // 1.0
        if fraction == 0.0:
            power = whole_power(base, abs(integer))
            return power if exponent >= 0.0 else self.quotient(1.0, power)
        if (4.0 * exponent) % 1.0 != 0.0 or abs(exponent) > LARGEST_POWER:
            return self.node(POWER, (base, self.as_node(exponent)))
        if exponent < 0.0:
            return self.quotient(1.0, self.power(base, -exponent))
        return self.power(self.node(ROOT, (base,)), 2.0 * fraction) * whole_power(base, integer)

    def select(self, condition: Any, a: Any, b: Any) -> Any:
        """Return the first where a condition is not 0, else the second."""
        if not isinstance(condition, Node):
            return a if condition else b
        return self.node(SELECT, (condition, self.as_node(a), self.as_node(b)))

    # translate: skip
    def rarely(self, condition: Any, a: Any, b: Any) -> Any:
        """Return the same as `select`; the first is computed only if a launch abreast needs it."""
        return self.node(RARELY, (self.as_node(condition), self.as_node(a), self.as_node(b)))


def in_order(a: Node, b: Node) -> tuple[Node, Node]:
    """Two operands whose order does not matter."""
    return (a, b) if a.place <= b.place else (b, a)
