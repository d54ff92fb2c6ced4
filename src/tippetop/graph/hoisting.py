"""What a recorded function makes of its parameters alone, apart from the rest."""

import operator
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from tippetop.graph import graph
from tippetop.graph.recording import Recorded, needed
from tippetop.mechanics import elementary

OPERATIONS: Mapping[str, Callable[..., Any]] = {
    graph.SUM: operator.add,
    graph.DIFFERENCE: operator.sub,
    graph.PRODUCT: operator.mul,
    graph.QUOTIENT: operator.truediv,
    graph.NEGATIVE: operator.neg,
    graph.SIZE: abs,
    graph.LESS: lambda a, b: 1.0 * (a < b),
    graph.SELECT: lambda condition, a, b: a if condition else b,
    graph.ROOT: lambda number: number**0.5,
    graph.POWER: operator.pow,
    graph.EXPONENTIAL: elementary.exp,
    graph.LOGARITHM: elementary.log,
    graph.HYPERBOLIC_TANGENT: elementary.tanh,
}
"""What plain operators make a node."""


def hoisted(recorded: Recorded) -> tuple[Recorded, Recorded]:
    """Return a function of the parameters alone, and the rest, which has the results of the first
    as further parameters.
    """
    fixed = set[int]()
    for node in recorded.nodes:
        is_given = node.name in (graph.PARAMETER, graph.CONSTANT)
        if is_given or (
            node.operands and fixed.issuperset([operand.place for operand in node.operands])
        ):
            fixed.add(node.place)
    moving = [node for node in recorded.nodes if node.place not in fixed]
    asked = {operand.place for node in moving for operand in node.operands}
    asked.update([node.place for node in recorded.outputs])
    made = [node for node in recorded.nodes if node.operands and node.place in fixed & asked]
    further = {node.place: recorded.parameters + k for k, node in enumerate(made)}
    remainder, replaced = graph.Graph(), dict[int, graph.Node]()
    for node in recorded.nodes:
        if node.place in further:
            replaced[node.place] = remainder.node(graph.PARAMETER, (), further[node.place])
        elif node.place not in fixed or not node.operands:
            operands = tuple([replaced[operand.place] for operand in node.operands])
            replaced[node.place] = remainder.node(node.name, operands, node.value)
    outputs = tuple([replaced[node.place] for node in recorded.outputs])
    count = recorded.parameters + len(made)
    return (
        Recorded(needed(made[0].graph, made) if made else (), tuple(made), 0, recorded.parameters),
        Recorded(needed(remainder, outputs), outputs, recorded.size, count),
    )


def evaluated(recorded: Recorded, state: Sequence[Any], parameters: Sequence[Any]) -> list[Any]:
    """Return the outputs of a recorded function at a state and parameters, in their arithmetic."""
    values = dict[int, Any]()
    for node in recorded.nodes:
        match node.name:
            case graph.CONSTANT:
                value = node.value
            case graph.STATE:
                value = state[int(node.value)]
            case graph.PARAMETER:
                value = parameters[int(node.value)]
            case name:
                value = OPERATIONS[name](*[values[operand.place] for operand in node.operands])
        values[node.place] = value
    return [values[node.place] for node in recorded.outputs]
