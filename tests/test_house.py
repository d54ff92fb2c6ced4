"""The source as a whole: no circles among its imports, and no class name used twice."""

import ast
import importlib.util
from collections import Counter
from collections.abc import Iterator
from graphlib import CycleError, TopologicalSorter
from pathlib import Path
from typing import TypeGuard

import tippetop

SOURCE = Path(tippetop.__file__).parent
MODULES = {
    ".".join(path.relative_to(SOURCE.parent).with_suffix("").parts).removesuffix(".__init__"): path
    for path in SOURCE.rglob("*.py")
}


def is_for_types(node: ast.AST) -> TypeGuard[ast.If]:
    return isinstance(node, ast.If) and ast.unparse(node.test).endswith("TYPE_CHECKING")


def run_nodes(node: ast.AST) -> Iterator[ast.AST]:
    """Everything below a node but what only type checkers read."""
    children = node.orelse if is_for_types(node) else ast.iter_child_nodes(node)
    for child in children:
        yield child
        yield from run_nodes(child)


def imported(module: str, path: Path) -> set[str]:
    """The modules of the package that a module imports, wherever in it."""
    package = module if path.stem == "__init__" else module.rpartition(".")[0]
    return imported_by(module, package, path.read_text(encoding="utf-8"))


def imported_by(module: str, package: str, text: str) -> set[str]:
    """The same of a module's text."""
    found = set()
    for node in run_nodes(ast.parse(text)):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            home = importlib.util.resolve_name("." * node.level + (node.module or ""), package)
            for alias in node.names:
                name = f"{home}.{alias.name}"
                found.add(name if name in MODULES else home)
    return found & set(MODULES) - {module}


def circle(graph: dict[str, set[str]]) -> list[str]:
    """One of the circles of a graph, if there is any."""
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        return list(error.args[1])
    return []


def test_no_module_imports_itself_by_way_of_others() -> None:
    graph = {module: imported(module, path) for module, path in MODULES.items()}
    assert sum(map(len, graph.values())) > len(graph), "they do import each other"
    assert circle(graph) == []


def test_no_two_classes_share_a_name() -> None:
    names = Counter(
        node.name
        for path in MODULES.values()
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.ClassDef)
    )
    assert {name for name, count in names.items() if count > 1} == set()


def test_a_circle_is_found_wherever_it_hides() -> None:
    """Inside functions and classes, but not where only type checkers look."""
    hidden = """
if TYPE_CHECKING:
    from tippetop.problem.bodies import Body
else:
    import tippetop.problem.presets
class Deep:
    def inside(self):
        from tippetop.support import errors
        from .support.files import written_beside
"""
    found = imported_by("tippetop.deep", "tippetop", hidden)
    assert found == {
        "tippetop.problem.presets",
        "tippetop.support.errors",
        "tippetop.support.files",
    }
    assert circle({"a": {"b"}, "b": {"c"}, "c": {"a"}})
    assert circle({"a": {"b", "c"}, "b": {"c"}, "c": set()}) == []
