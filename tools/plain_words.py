"""Check that names, docstrings and constants of the package are plain.

It refuses names that say nothing (`BANNED`), first lines of docstrings of functions that state
neither what is returned nor what is done, and constants of one name with several values within a
folder. Public names that stay are in `PUBLIC`, each with its reason.
"""

import ast
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[1]
SOURCE = ROOT / "src" / "tippetop"

BANNED = {
    *("found", "given", "known", "taken", "told", "said", "own", "kept", "left", "here", "there"),
    *("then", "rest", "way", "whole", "more", "other", "alone", "begun", "wanted", "heard"),
    *("played", "piece", "thing", "look", "looks", "nothing"),
}
"""Names that say nothing of what they stand for."""

PUBLIC = {
    ("problem/bodies.py", "whole"): "keyword of `Body.turned`",
    ("cli/body.py", "whole"): "option --whole",
    ("fit/improve.py", "whole"): "keyword of `improve`, as of `Body.turned`",
    ("lathe/design.py", "piece"): "argument of `design_insert`",
    ("export/solid.py", "piece"): "argument of `write_solid`",
}
"""Public names that stay, by their file."""

NO_STATEMENT = {
    *("A", "All", "An", "As", "How", "In", "It", "Its", "One", "Some", "That", "The", "Those"),
    *("What", "When", "Where", "Whether", "Which", "Why"),
}
"""Words that begin no statement of what a function returns or does."""


def faults_of(path: Path, tree: ast.Module) -> Iterator[str]:
    """Yield the faults of a module, each with its line."""
    sides = _lines_with_sides(tree)
    for node in ast.walk(tree):
        for name in _names(node):
            is_side = name == "left" and node.lineno in sides
            if name.strip("_") in BANNED and not is_side and (_place(path), name) not in PUBLIC:
                yield f"{path}:{node.lineno}: the name '{name}' says nothing"
        if isinstance(node, ast.FunctionDef) and not _is_property(node):
            first = (ast.get_docstring(node) or "").partition(" ")[0]
            if first in NO_STATEMENT:
                yield f"{path}:{node.lineno}: the docstring of {node.name} begins with '{first}'"


def _lines_with_sides(tree: ast.Module) -> set[int]:
    """Return the lines of functions that define `right`: `left` is the opposite side there."""
    lines = set[int]()
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef) and any(
            "right" in _names(inner) for inner in ast.walk(node)
        ):
            lines |= set(range(node.lineno, (node.end_lineno or node.lineno) + 1))
    return lines


def _place(path: Path) -> str:
    """Return the path of a module within the package."""
    return "/".join(path.parts[2:])


def _names(node: ast.AST) -> Iterator[str]:
    """Yield the names that a node defines."""
    match node:
        case ast.FunctionDef(name=name) | ast.ClassDef(name=name) | ast.arg(arg=name):
            yield name
        case ast.Name(id=name, ctx=ast.Store()) | ast.Attribute(attr=name, ctx=ast.Store()):
            yield name


def _is_property(node: ast.FunctionDef) -> bool:
    marks = {mark.id for mark in node.decorator_list if isinstance(mark, ast.Name)}
    return bool(marks & {"property", "cached_property"})


def clashes(trees: dict[Path, ast.Module]) -> Iterator[str]:
    """Yield the constants of one name that have several values within a folder."""
    values: dict[tuple[Path, str], dict[str, Path]] = defaultdict(dict)
    for path, tree in trees.items():
        for node in tree.body:
            for name, value in _assigned(node):
                if name.isupper():
                    values[path.parent, name].setdefault(ast.unparse(value), path)
    for (folder, name), places in values.items():
        if len(places) > 1:
            yield f"{folder}: {name} is {' and '.join(sorted(places))}"


def _assigned(node: ast.stmt) -> Iterator[tuple[str, ast.expr]]:
    """Yield the names that a statement assigns to, each with its value: several, of tuples."""
    match node:
        case ast.AnnAssign(target=ast.Name(id=name), value=ast.expr() as value):
            yield name, value
        case ast.Assign(targets=targets, value=value):
            for target in targets:
                yield from _paired(target, value)


def _paired(target: ast.expr, value: ast.expr) -> Iterator[tuple[str, ast.expr]]:
    match target, value:
        case ast.Name(id=name), _:
            yield name, value
        case ast.Tuple(elts=names), ast.Tuple(elts=parts):
            for name, part in zip(names, parts, strict=False):
                yield from _paired(name, part)


def main() -> int:
    """Print the faults of the package; return the exit code."""
    trees = {
        path.relative_to(ROOT): ast.parse(path.read_text(encoding="utf-8"))
        for path in sorted(SOURCE.rglob("*.py"))
    }
    faults = [fault for path, tree in trees.items() for fault in faults_of(path, tree)]
    faults += clashes(trees)
    for fault in faults:
        print(fault)
    return int(bool(faults))


if __name__ == "__main__":
    raise SystemExit(main())
