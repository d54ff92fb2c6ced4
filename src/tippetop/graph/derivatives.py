"""Derivatives of recorded functions: forward differentiation of an expression graph."""

from collections.abc import Mapping, Sequence
from typing import Any, TypeAlias

from tippetop.graph import graph
from tippetop.graph.graph import Node
from tippetop.graph.recording import needed
from tippetop.mechanics.vectors import Scalar

Tangent: TypeAlias = tuple[Scalar, ...]
"""Derivatives of one number in several directions."""


def derivatives(outputs: Sequence[Scalar], seeds: Mapping[int, Tangent]) -> list[Tangent]:
    """Return the derivatives of outputs, nodes or plain numbers, in several directions.

    Parameters
    ----------
    outputs
        Nodes of one graph, or plain numbers, whose derivatives are zero.
    seeds
        Derivatives of inputs, by the places of their nodes; other inputs do not change. All have
        the same number of directions.
    """
    nodes = [output for output in outputs if isinstance(output, Node)]
    directions = len(next(iter(seeds.values())))
    zero = (0.0,) * directions
    tangents = dict(seeds)
    for node in needed(nodes[0].graph, nodes) if nodes else ():
        if node.place not in tangents and node.operands:
            parts = [tangents.get(operand.place, zero) for operand in node.operands]
            if any(part is not zero for part in parts):
                tangents[node.place] = _derived(node, parts)
    return [
        tangents.get(output.place, zero) if isinstance(output, Node) else zero for output in outputs
    ]


def _derived(node: Node, parts: Sequence[Tangent]) -> Tangent:
    """Return the derivatives of an operation from those of its operands."""
    make, a, b = node.graph, node.operands[0], node.operands[-1]
    rows = list(zip(*parts, strict=True))
    match node.name:
        case graph.SUM:
            return tuple([da + db for da, db in rows])
        case graph.DIFFERENCE:
            return tuple([da - db for da, db in rows])
        case graph.NEGATIVE:
            return tuple([-da for (da,) in rows])
        case graph.PRODUCT:
            return tuple([_times(da, b) + _times(db, a) for da, db in rows])
        case graph.QUOTIENT:
            return tuple([_over(da - _times(db, node), b) for da, db in rows])
        case graph.ROOT:
            return tuple([_over(0.5 * da, node) for (da,) in rows])
        case graph.POWER:
            factor = b.value * node / a
            return tuple([_times(da, factor) for da, _ in rows])
        case graph.SINE:
            factor = make.node(graph.COSINE, (a,))
            return tuple([_times(da, factor) for (da,) in rows])
        case graph.COSINE:
            factor = -make.node(graph.SINE, (a,))
            return tuple([_times(da, factor) for (da,) in rows])
        case graph.EXPONENTIAL:
            return tuple([_times(da, node) for (da,) in rows])
        case graph.LOGARITHM:
            return tuple([_over(da, a) for (da,) in rows])
        case graph.HYPERBOLIC_TANGENT:
            factor = 1.0 - node * node
            return tuple([_times(da, factor) for (da,) in rows])
        case graph.SIZE:
            rises = make.as_node(0.0) < a
            return tuple([make.select(rises, da, -da) for (da,) in rows])
        case graph.SELECT | graph.RARELY:
            condition = node.operands[0]
            return tuple([make.select(condition, da, db) for _, da, db in rows])
        case graph.LESS:
            return (0.0,) * len(rows)
    raise graph.NotRecordable(f"{node.name} has no rule for derivatives")


def _times(derivative: Scalar, factor: Any) -> Any:
    return 0.0 if _is_zero(derivative) else derivative * factor


def _over(derivative: Scalar, divisor: Any) -> Any:
    return 0.0 if _is_zero(derivative) else derivative / divisor


def _is_zero(number: Any) -> bool:
    return isinstance(number, (int, float)) and number == 0.0
