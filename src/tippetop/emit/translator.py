"""What every part of the translator from Python to JavaScript knows: the names that hold where it is."""

import ast
from abc import ABC, abstractmethod
from collections.abc import Sequence

from tippetop.emit.program import Program, safe
from tippetop.emit.scope import Scope

ARROW, OR, AND, BITS, EQUAL, LESS, SUM, PRODUCT, UNARY, ATOM = range(10)
"""How tightly an expression binds."""


class Untranslatable(SyntaxError):
    """Something of Python that the program does not use so far, and the translator does not know."""


class Translator(ABC):
    """A translator at some place of a module.

    Parameters
    ----------
    program
        All modules.
    module
        The name of this one.
    """

    def __init__(self, program: Program, module: str) -> None:
        self.program, self.module = program, module
        self.scopes: list[Scope] = []
        self.hidden: list[set[str]] = []
        self.rows: dict[str, str] = {}
        self.rebound = False

    @abstractmethod
    def text(self, node: ast.expr, binds: int = ARROW) -> str:
        """An expression, in parentheses where it binds less."""

    @abstractmethod
    def truth(self, node: ast.expr, binds: int = ARROW) -> str:
        """Whether an expression is true."""

    @abstractmethod
    def among_arrays(self, node: ast.expr) -> bool:
        """Whether an expression is a number in a function of arrays of numbers, where nothing is an error."""

    @abstractmethod
    def is_array(self, node: ast.expr) -> bool:
        """Whether an expression is an array of numbers."""

    def arguments(self, nodes: Sequence[ast.expr]) -> str:
        """Expressions in a row."""
        return ", ".join(self.text(node) for node in nodes)

    def name(self, name: str) -> str:
        """What a name is called."""
        if any(name in hidden for hidden in self.hidden) or any(
            name in scope.bindings or name in scope.parameters for scope in self.scopes
        ):
            return safe(name)
        if name in ("self", "cls"):
            return "self" if self.rebound else "this"
        known = self.program.resolve(self.module, name)
        return known if known is not None else f"py.{safe(name)}"
