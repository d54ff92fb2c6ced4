"""Recorded functions of numbers with several values as such of single numbers."""

from typing import Any

from tippetop.graph.graph import CONSTANT, PARAMETER, SPREAD, STATE, TOTAL, Graph, Node
from tippetop.graph.recording import Recorded, needed


class NodeValues:
    """Operations between the lanes of nodes that have a value for each."""

    def spread(self, a: Any, lane: int) -> Any:
        """Return a node that has the value of one lane in every lane."""
        return a.graph.node(SPREAD, (a,), lane) if isinstance(a, Node) else a

    def total(self, a: Any) -> Any:
        """Return a node that has the sum over the lanes in every lane."""
        return a.graph.node(TOTAL, (a,))


def unrolled(recorded: Recorded, abreast: int) -> Recorded:
    """Return a function of single numbers that does the same with each of so many values, which lie
    one after another in state and parameters.
    """
    graph, values = Graph(), dict[int, list[Node]]()
    for node in recorded.nodes:
        operands = [values[operand.place] for operand in node.operands]
        if node.name == CONSTANT:
            lanes = [graph.as_node(node.value)] * abreast
        elif node.name in (STATE, PARAMETER):
            lanes = [
                graph.node(node.name, (), int(node.value) * abreast + lane)
                for lane in range(abreast)
            ]
        elif node.name == SPREAD:
            lanes = [operands[0][int(node.value)]] * abreast
        elif node.name == TOTAL:
            total = operands[0][0]
            for number in operands[0][1:]:
                total = total + number
            lanes = [total] * abreast
        else:
            lanes = [
                graph.node(node.name, tuple([operand[lane] for operand in operands]), node.value)
                for lane in range(abreast)
            ]
        values[node.place] = lanes
    outputs = [number for output in recorded.outputs for number in values[output.place]]
    size, parameters = recorded.size * abreast, recorded.parameters * abreast
    return Recorded(needed(graph, outputs), tuple(outputs), size, parameters)
