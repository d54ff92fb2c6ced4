"""Nothing needs what Windows lacks, but tests that say so: asked of the sources, on any system."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
LACKING_MODULES = {"fcntl", "grp", "pty", "pwd", "resource", "termios"}
LACKING = re.compile(
    r"\bimport resource\b"
    r"|os\.(fork|killpg|setsid|mkfifo|chown|getuid|geteuid|kill)\b"
    r"|signal\.(SIG(KILL|HUP|XFSZ|ALRM|USR1)|pthread_sigmask|setitimer)\b"
    r"|symlink_to|send_signal|#!/bin/sh|\"/proc/"
)
"""What Windows has not, needs rights for, or means otherwise: `os.kill` ends a process there."""
MARKED = re.compile(r"posix_only|skipif")
SOURCES = sorted((ROOT / "src").rglob("*.py"))
TESTS = sorted((ROOT / "tests").rglob("*.py"))


def parsed(path: Path) -> tuple[str, ast.Module]:
    text = path.read_text(encoding="utf-8")
    return text, ast.parse(text)


def evaluated_at_import(body: list[ast.stmt]) -> Iterator[ast.AST]:
    """Iterate over all that importing a module evaluates, but what stands in an `if`."""
    for statement in body:
        if isinstance(statement, ast.FunctionDef):
            defaults = [value for value in statement.args.kw_defaults if value]
            for value in [*statement.decorator_list, *statement.args.defaults, *defaults]:
                yield from ast.walk(value)
        elif isinstance(statement, ast.ClassDef):
            for value in statement.decorator_list:
                yield from ast.walk(value)
            yield from evaluated_at_import(statement.body)
        elif not isinstance(statement, ast.If):
            yield from ast.walk(statement)


def lacking_at_import(tree: ast.Module) -> set[str]:
    """Return what importing a module asks of the system that Windows lacks."""
    found = set()
    for node in evaluated_at_import(tree.body):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names} & LACKING_MODULES
        elif isinstance(node, ast.ImportFrom) and node.module in LACKING_MODULES:
            found.add(node.module)
        elif isinstance(node, ast.Attribute) and LACKING.fullmatch(ast.unparse(node)):
            found.add(ast.unparse(node))
    return found


@pytest.mark.parametrize("folder", [SOURCES, TESTS], ids=["src", "tests"])
def test_no_module_needs_what_windows_lacks_to_be_imported(folder: list[Path]) -> None:
    found = {path.name: lacking_at_import(parsed(path)[1]) for path in folder}
    assert {name: lacking for name, lacking in found.items() if lacking} == {}


def definitions(body: list[ast.stmt]) -> Iterator[ast.stmt]:
    """Iterate over the statements of a module, with those of its classes in their place."""
    for statement in body:
        if isinstance(statement, ast.ClassDef):
            yield from definitions(statement.body)
        else:
            yield statement


def unmarked(path: Path) -> Iterator[str]:
    """Find the tests of a file that need what Windows lacks, themselves or by a program that they
    run, and do not say so.
    """
    text, tree = parsed(path)
    if any(
        isinstance(node, ast.Assign)
        and ast.unparse(node.targets[0]) == "pytestmark"
        and MARKED.search(ast.unparse(node))
        for node in tree.body
    ):
        return
    lines = text.splitlines()
    lacking: set[str] = set()
    tests = []
    for node in definitions(tree.body):
        segment = "\n".join(lines[node.lineno - 1 : node.end_lineno])
        names = {child.id for child in ast.walk(node) if isinstance(child, ast.Name)}
        needs = LACKING.search(segment) is not None or bool(names & lacking)
        if isinstance(node, ast.FunctionDef):
            marks = " ".join(ast.unparse(mark) for mark in node.decorator_list)
            if node.name.startswith("test_"):
                tests.append((node.name, needs, marks))
            elif needs:
                lacking.add(node.name)
        elif needs and isinstance(node, ast.Assign):
            lacking |= {ast.unparse(target) for target in node.targets}
    for name, needs, marks in tests:
        if needs and not MARKED.search(marks):
            yield f"{path.relative_to(ROOT).as_posix()}::{name}"


def test_what_needs_another_system_than_windows_says_so() -> None:
    found = [name for path in TESTS if path != Path(__file__) for name in unmarked(path)]
    assert found == []
