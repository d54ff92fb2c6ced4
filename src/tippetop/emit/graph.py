"""A function in plain operators as a graph of operations, each of them there once.

The function is run on nodes instead of numbers, and what it does to them is recorded. Constants are folded,
what is computed twice is computed once, and signs are taken out of products, so that a product and its
opposite share their work. All of that is exact in floating-point numbers; powers of halves and quarters
become products and roots.
"""

from dataclasses import dataclass, field
from typing import Any

STATE, PARAMETER, CONSTANT = "y", "p", "constant"
SUM, DIFFERENCE, PRODUCT, QUOTIENT = "+", "-", "*", "/"
NEGATIVE, LESS, SELECT = "negative", "less", "select"
SIZE, ROOT, POWER, SINE, COSINE = "abs", "sqrt", "pow", "sin", "cos"
"""What makes nodes."""

LARGEST_POWER = 16
"""Whole powers up to this are products."""


NO_CHOICE = "a choice that depends on the numbers is to be made by select"


class NotRecordable(TypeError):
    """A function asked of a node what only a number can tell."""


@dataclass(eq=False)
class Node:
    """A number that is to be computed, or given."""

    graph: "Graph" = field(repr=False)
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

    def __add__(self, other: Any) -> Any:
        return self.graph.sum(self, other)

    def __radd__(self, other: Any) -> Any:
        return self.graph.sum(other, self)

    def __sub__(self, other: Any) -> Any:
        return self.graph.sum(self, -other)

    def __rsub__(self, other: Any) -> Any:
        return self.graph.sum(other, -self)

    def __mul__(self, other: Any) -> Any:
        return self.graph.product(self, other)

    def __rmul__(self, other: Any) -> Any:
        return self.graph.product(other, self)

    def __truediv__(self, other: Any) -> Any:
        return self.graph.quotient(self, other)

    def __rtruediv__(self, other: Any) -> Any:
        return self.graph.quotient(other, self)

    def __pow__(self, exponent: Any) -> Any:
        return self.graph.power(self, exponent)

    def __neg__(self) -> Any:
        if self.name == NEGATIVE:
            return self.operands[0]
        return self.graph.node(NEGATIVE, (self,))

    def __abs__(self) -> Any:
        return self.graph.node(SIZE, (positive(self)[1],))

    def __lt__(self, other: Any) -> Any:
        return self.graph.node(LESS, (self, self.graph.taken(other)))

    def __gt__(self, other: Any) -> Any:
        return self.graph.node(LESS, (self.graph.taken(other), self))

    def __eq__(self, other: object) -> bool:
        if isinstance(other, Node):
            return self is other
        raise NotRecordable(NO_CHOICE)

    def __hash__(self) -> int:
        return self.place

    def __bool__(self) -> bool:
        raise NotRecordable(NO_CHOICE)


@dataclass(eq=False)
class Graph:
    """Nodes, each of which is there once."""

    nodes: list[Node] = field(default_factory=list)
    """All of them, operands before what is made of them."""
    known: dict[str, Node] = field(default_factory=dict)
    """The same by what they are."""

    def node(self, name: str, operands: tuple[Node, ...], value: float = 0.0) -> Node:
        """The node of this description, which is made if there is none."""
        key = key_of(name, operands, value)
        found = self.known.get(key)
        if found is None:
            found = Node(self, name, operands, value, len(self.nodes))
            self.nodes.append(found)
            self.known[key] = found
        return found

    def taken(self, number: Any) -> Node:
        """A number as a node."""
        if isinstance(number, Node):
            return number
        return self.node(CONSTANT, (), float(number))

    def sum(self, a: Any, b: Any) -> Any:
        """Sum of two, as a difference if one of them is negative."""
        if is_number(a, 0.0):
            return b
        if is_number(b, 0.0):
            return a
        first, second = negated(a), negated(b)
        if second is not None:
            if first is not None:
                return -(self.sum(first, second))
            return self._difference(a, second)
        if first is not None:
            return self._difference(b, first)
        return self.node(SUM, in_order(self.taken(a), self.taken(b)))

    def product(self, a: Any, b: Any) -> Any:
        """Product of two, with its sign outside."""
        if is_number(a, 0.0) or is_number(b, 0.0):
            return 0.0
        if is_number(a, 1.0):
            return b
        if is_number(b, 1.0):
            return a
        first, second = positive(a), positive(b)
        if is_number(first[1], 1.0) or is_number(second[1], 1.0):
            found = second[1] if is_number(first[1], 1.0) else first[1]
        else:
            found = self.node(PRODUCT, in_order(self.taken(first[1]), self.taken(second[1])))
        return found if first[0] == second[0] else -found

    def quotient(self, a: Any, b: Any) -> Any:
        """Quotient of two, with its sign outside."""
        if is_number(a, 0.0):
            return 0.0
        if is_number(b, 1.0):
            return a
        first, second = positive(a), positive(b)
        if is_number(second[1], 1.0):
            return -a
        found = self.node(QUOTIENT, (self.taken(first[1]), self.taken(second[1])))
        return found if first[0] == second[0] else -found

    def power(self, base: Node, exponent: Any) -> Any:
        """A power: by products and roots where the exponent is a whole number of quarters."""
        if not isinstance(exponent, (int, float)):
            raise NotRecordable("exponents are numbers")
        quarters = 4.0 * exponent
        if quarters != int(quarters) or abs(exponent) > LARGEST_POWER:
            return self.node(POWER, (base, self.taken(exponent)))
        if exponent < 0:
            return self.quotient(1.0, self.power(base, -exponent))
        whole, rest = int(quarters) // 4, int(quarters) % 4
        found: Any = 1.0
        if rest >= 2:
            found = self.node(ROOT, (base,))
        if rest % 2 == 1:
            found = found * self.node(ROOT, (self.node(ROOT, (base,)),))
        square: Any = base
        while whole > 0:
            if whole % 2 == 1:
                found = found * square
            whole = whole // 2
            if whole > 0:
                square = square * square
        return found

    def select(self, condition: Any, a: Any, b: Any) -> Any:
        """The first where a condition is not 0, else the second."""
        if not isinstance(condition, Node):
            return a if condition else b
        return self.node(SELECT, (condition, self.taken(a), self.taken(b)))

    def _difference(self, a: Any, b: Any) -> Any:
        if a is b:
            return 0.0
        first, second = self.taken(a), self.taken(b)
        opposite = self.known.get(key_of(DIFFERENCE, (second, first)))
        return self.node(DIFFERENCE, (first, second)) if opposite is None else -opposite


def key_of(name: str, operands: tuple[Node, ...], value: float = 0.0) -> str:
    """What tells a node from all others of its graph."""
    return " ".join([name, repr(value), *[str(operand.place) for operand in operands]])


def is_number(value: Any, number: float) -> bool:
    """Whether a value is a plain number, and this one."""
    return isinstance(value, (int, float)) and value == number


def negated(value: Any) -> Any:
    """That of which a value is the negative; None where it is not one."""
    if isinstance(value, Node):
        return value.operands[0] if value.name == NEGATIVE else None
    return -value if value < 0.0 else None


def positive(value: Any) -> tuple[bool, Any]:
    """Whether a value is negative, and what it is without its sign."""
    opposite = negated(value)
    return (False, value) if opposite is None else (True, opposite)


def in_order(a: Node, b: Node) -> tuple[Node, Node]:
    """Two operands whose order does not matter."""
    return (a, b) if a.place <= b.place else (b, a)
