"""What holds of the source as a whole: no circles among its imports, names and sizes of what is in it."""

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


FILE, CLASS, FUNCTION = 300, 200, 60
"""Lines that one of them has at most; the docstring of a function that users call does not count."""


def lines_of(node: ast.AST) -> int:
    """How many lines there are from the first to the last of a part of a module."""
    return int(getattr(node, "end_lineno", 0)) - int(getattr(node, "lineno", 0)) + 1


def too_long(name: str, text: str) -> list[str]:
    """What has more lines than it may have."""
    found = [name] * (len(text.splitlines()) > FILE)
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.ClassDef) and lines_of(node) > CLASS:
            found.append(f"{name}.{node.name}")
        elif isinstance(node, ast.FunctionDef):
            said = lines_of(node.body[0]) if node.name in tippetop.__all__ and ast.get_docstring(node) else 0
            found += [f"{name}.{node.name}"] * (lines_of(node) - said > FUNCTION)
    return found


def test_no_file_class_or_function_is_too_long() -> None:
    found = (too_long(module, path.read_text(encoding="utf-8")) for module, path in MODULES.items())
    assert [part for parts in found for part in parts] == []


def test_what_is_too_long_is_found() -> None:
    said, line = '    """Said."""\n', "    x = 1\n"
    assert too_long("a", "def f():\n" + line * (FUNCTION - 1)) == []
    assert too_long("a", "def f():\n" + said + line * (FUNCTION - 1)) == ["a.f"]
    assert too_long("a", "def sweep():\n" + said + line * (FUNCTION - 1)) == []
    assert too_long("a", "def sweep():\n" + line * FUNCTION) == ["a.sweep"]
    assert too_long("a", "class A:\n" + line * (CLASS - 1)) == []
    assert too_long("a", "class A:\n" + line * CLASS) == ["a.A"]
    assert too_long("a", "\n" * FILE) == []
    assert too_long("a", "\n" * (FILE + 1)) == ["a"]


def test_a_circle_is_found_wherever_it_hides() -> None:
    """Inside functions and classes, but not where only type checkers look."""
    hidden = """
if TYPE_CHECKING:
    from tippetop.bodies import Body
else:
    import tippetop.presets
class Deep:
    def inside(self):
        from tippetop import errors
        from .files import written_beside
"""
    found = imported_by("tippetop.deep", "tippetop", hidden)
    assert found == {"tippetop.presets", "tippetop.errors", "tippetop.files"}
    assert circle({"a": {"b"}, "b": {"c"}, "c": {"a"}})
    assert circle({"a": {"b", "c"}, "b": {"c"}, "c": set()}) == []
