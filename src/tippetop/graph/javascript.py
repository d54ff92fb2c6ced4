"""Recorded functions as JavaScript."""

from tippetop.graph.graph import CONSTANT, LESS, NEGATIVE, PARAMETER, SELECT, STATE, Node
from tippetop.graph.recording import Recorded


def javascript_source(recorded: Recorded, name: str) -> str:
    """Return a JavaScript function `name(y, p, out)` that puts the outputs for y and p into out."""
    lines = [f"  const t{node.place} = {_written(node)};" for node in recorded.nodes]
    lines += [f"  out[{number}] = t{node.place};" for number, node in enumerate(recorded.outputs)]
    return "\n".join([f"function {name}(y, p, out) {{", *lines, "}"])


def _written(node: Node) -> str:
    names = [f"t{operand.place}" for operand in node.operands]
    if node.name == CONSTANT:
        return f"{node.value:.17g}"
    if node.name in (STATE, PARAMETER):
        return f"{node.name}[{int(node.value)}]"
    if node.name in ("+", "-", "*", "/"):
        return f"{names[0]} {node.name} {names[1]}"
    if node.name == NEGATIVE:
        return f"-{names[0]}"
    if node.name == LESS:
        return f"{names[0]} < {names[1]} ? 1 : 0"
    if node.name == SELECT:
        return f"{names[0]} !== 0 ? {names[1]} : {names[2]}"
    return f"Math.{node.name}({', '.join(names)})"
