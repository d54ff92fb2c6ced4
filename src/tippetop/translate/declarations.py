"""Declarations about the translation of a module, read from its comments.

A comment on a line of its own declares something about the module, or about the function, method,
class or constant that begins on the next line::

    # translate module: numbers          one of `MODULE_WORDS`
    # translate module: by hand in dense.js

    # translate: skip                    one of `DEFINITION_WORDS`
    def from_toml(text: str) -> Problem: ...
"""

import ast
import re
from collections.abc import Iterator
from dataclasses import dataclass, field

from tippetop.translate.refusal import Untranslatable

MODULE_WORDS = ("numbers", "arrays", "numpy", "series", "skip")
"""Declarations of a module.

numbers: operands are numbers, so that JavaScript's operators do.
arrays: values are numbers and arrays of numbers, and no division by zero is an error.
numpy: values may be complex numbers and NumPy's arrays of one dimension, of any kind of number.
series: what is indexed may be an object with ``__getitem__``.
skip: nothing of the module is translated, and a use of it is refused.
by hand in <file>: the module has a counterpart written in JavaScript, in this file.
"""

DEFINITION_WORDS = ("skip", "runtime", "drop")
"""Declarations of a definition.

skip: it is not translated, and a use of it is refused.
runtime: the JavaScript runtime has a function of this name.
drop: statements that only call it are left out, as they check what JavaScript's caller checked.
"""

COMMENT = re.compile(r"^(?P<indent> *)# translate(?P<module> module)?: (?P<words>.*?) *$", re.M)
BY_HAND = re.compile(r"by hand in (?P<file>[\w.]+\.js)")

DEFINITIONS = (ast.FunctionDef, ast.ClassDef, ast.Assign, ast.AnnAssign)


@dataclass
class Declarations:
    """Declarations of one module."""

    words: set[str] = field(default_factory=set)
    """Words of `MODULE_WORDS`."""
    file: str = ""
    """Name of the JavaScript file that is the module's counterpart; "" without one."""
    definitions: dict[ast.stmt, str] = field(default_factory=dict)
    """Word of `DEFINITION_WORDS` for each definition that has one."""


def declarations_of(text: str, tree: ast.Module, path: str) -> Declarations:
    """Return the declarations of a module.

    Raises
    ------
    Untranslatable
        If a declaration has an unknown word or stands above no definition.
    """
    declarations = Declarations()
    starts: dict[int, ast.stmt] | None = None
    for comment in COMMENT.finditer(text):
        line, words = text.count("\n", 0, comment.start()) + 1, comment["words"]
        by_hand = BY_HAND.fullmatch(words)
        if comment["module"] and by_hand:
            declarations.file = by_hand["file"]
        elif comment["module"]:
            _require(words in MODULE_WORDS, f"a module cannot declare '{words}'", path, line)
            declarations.words.add(words)
        else:
            starts = dict(_first_lines(tree)) if starts is None else starts
            _require(words in DEFINITION_WORDS, f"a definition cannot be '{words}'", path, line)
            _require(line + 1 in starts, "no definition begins below this comment", path, line)
            declarations.definitions[starts[line + 1]] = words
    return declarations


def _require(holds: bool, reason: str, path: str, line: int) -> None:
    """Raise `Untranslatable` unless a condition holds."""
    if not holds:
        raise Untranslatable(path, line, reason)


def _first_lines(tree: ast.Module) -> Iterator[tuple[int, ast.stmt]]:
    """Yield the first line, decorators included, of every definition of a module and of its
    classes.
    """
    for node in tree.body:
        inner = node.body if isinstance(node, ast.ClassDef) else []
        for one in (node, *inner):
            if isinstance(one, DEFINITIONS):
                marks = getattr(one, "decorator_list", [])
                yield min([one.lineno, *(mark.lineno for mark in marks)]), one
