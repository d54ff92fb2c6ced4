"""The names of a function."""

import ast
from collections.abc import Iterator

from tippetop.emit.program import parameters

OWN = (ast.FunctionDef, ast.Lambda, ast.ListComp, ast.GeneratorExp, ast.DictComp)
"""What has names of its own."""


def given(node: ast.FunctionDef | ast.Lambda) -> set[str]:
    """The parameters of a function."""
    return {*parameters(node), *([node.args.vararg.arg] if node.args.vararg else [])}


def bound(node: ast.FunctionDef | ast.Lambda) -> set[str]:
    """Those, and the names that the function binds."""
    names = given(node)
    for inner in within(node):
        match inner:
            case (
                ast.Name(id=name, ctx=ast.Store())
                | ast.FunctionDef(name=name)
                | ast.ExceptHandler(name=str(name))
            ):
                names.add(name)
    return names


def within(node: ast.AST) -> Iterator[ast.AST]:
    """All that is in a function, but not what is in others that are in it."""
    for child in ast.iter_child_nodes(node):
        yield child
        if not isinstance(child, OWN):
            yield from within(child)
