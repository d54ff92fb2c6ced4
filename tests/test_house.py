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
"""Lines of code that one of them has at most; blank lines, comments and what is said of code do not count."""


def code_lines(node: ast.AST, lines: list[str]) -> int:
    """How many lines of code a module, class or function has."""
    said = {
        line
        for inner in ast.walk(node)
        if isinstance(inner, ast.Expr) and isinstance(inner.value, ast.Constant)
        for line in range(inner.lineno, (inner.end_lineno or inner.lineno) + 1)
    }
    first, last = getattr(node, "lineno", 1), getattr(node, "end_lineno", len(lines))
    return sum(
        number not in said
        and not lines[number - 1].lstrip().startswith("#")
        and bool(lines[number - 1].strip())
        for number in range(first, last + 1)
    )


def too_long(name: str, text: str) -> list[str]:
    """What has more lines than it may have."""
    tree, lines = ast.parse(text), text.splitlines()
    parts: list[tuple[str, ast.AST, int]] = [(name, tree, FILE)]
    for node in ast.walk(tree):
        if isinstance(node, (ast.ClassDef, ast.FunctionDef)):
            most = CLASS if isinstance(node, ast.ClassDef) else FUNCTION
            parts.append((f"{name}.{node.name}", node, most))
    return [part for part, node, most in parts if code_lines(node, lines) > most]


def test_no_file_class_or_function_is_too_long() -> None:
    found = (too_long(module, path.read_text(encoding="utf-8")) for module, path in MODULES.items())
    assert [part for parts in found for part in parts] == []


def test_what_is_too_long_is_found() -> None:
    line = '    """Said."""\n\n    # a comment\n' + "    x = 1\n" * FUNCTION
    assert too_long("a", f"def f():\n{line}") == ["a.f"]
    assert too_long("a", f"class A:\n{line}") == []
    assert too_long("a", "x = 1\n" * FILE) == []
    assert too_long("a", "x = 1\n" * (FILE + 1)) == ["a"]


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
