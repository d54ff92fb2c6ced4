"""Functions of a state and parameters recorded as graphs."""

from collections.abc import Callable, Sequence
from typing import NamedTuple, TypeAlias

from tippetop.graph.graph import PARAMETER, STATE, Graph, Node
from tippetop.mechanics.vectors import Scalar

Function: TypeAlias = Callable[[Sequence[Scalar], Sequence[Scalar]], Sequence[Scalar]]
"""Of a state and parameters."""


class Recorded(NamedTuple):
    """What a function does."""

    nodes: tuple[Node, ...]
    """What it computes with, operands first, and nothing else."""
    outputs: tuple[Node, ...]
    """What it returns."""
    size: int
    parameters: int
    """How many numbers the state has, and how many parameters there are."""
    optional: tuple[Node, ...] = ()
    """Some of what it computes on the way, to be had where it is asked for."""


def record(function: Function, size: int, parameters: int, optional: int = 0) -> Recorded:
    """Record what a function of a state and parameters does.

    Parameters
    ----------
    function
        It returns a sequence of numbers, and asks nothing of its arguments but operators.
    size, parameters
        How many numbers the state has, and how many parameters there are.
    optional
        How many of the last numbers it returns are not always asked for.

    Raises
    ------
    NotRecordable
        If the function makes a choice that depends on the numbers.
    """
    graph = Graph()
    state = [graph.node(STATE, (), i) for i in range(size)]
    numbers = [graph.node(PARAMETER, (), i) for i in range(parameters)]
    outputs = [graph.as_node(output) for output in function(state, numbers)]
    always = len(outputs) - optional
    return Recorded(
        needed(graph, outputs), tuple(outputs[:always]), size, parameters, tuple(outputs[always:])
    )


# translate: skip
def recordable(function: Function, size: int, parameters: int) -> Recorded | None:
    """Return what `record` does; None where the function asks of nodes what only numbers have."""
    try:
        return record(function, size, parameters)
    except (TypeError, ValueError, ArithmeticError, AttributeError):
        return None


def needed(graph: Graph, outputs: Sequence[Node]) -> tuple[Node, ...]:
    """Return the nodes of a graph from which some nodes are computed."""
    places = {node.place for node in outputs}
    for node in reversed(graph.nodes):
        if node.place in places:
            for operand in node.operands:
                places.add(operand.place)
    return tuple([node for node in graph.nodes if node.place in places])
