"""Python's calls as JavaScript."""

import ast
from collections.abc import Sequence

from tippetop.emit.translator import ATOM, Translator, Untranslatable

STRINGS = {
    "startswith": "startsWith",
    "endswith": "endsWith",
    "lower": "toLowerCase",
    "append": "push",
    "index": "indexOf",
}
METHODS = {"removeprefix", "rpartition", "partition", "tolist", "join", "extend", "pop", "setdefault"}
"""Methods of Python's own types that are functions of the runtime."""


class Calls(Translator):
    """Translates the calls of a module."""

    def call(self, node: ast.Call) -> str:
        """A call."""
        func = node.func
        match func:
            case ast.Attribute(value=ast.Call(func=ast.Name(id="super")), attr=attr):
                return f"super{'' if attr == '__init__' else '.' + attr}({self._given(node)})"
            case ast.Attribute(value=value, attr=attr) if attr in METHODS and not self._is_module(value):
                return f"py.{attr}({self.arguments([value, *node.args])})"
            case ast.Attribute(value=value, attr=attr) if attr in STRINGS:
                return f"{self.text(value, ATOM)}.{STRINGS[attr]}({self.arguments(node.args)})"
            case ast.Attribute(value=value, attr="_replace"):
                return f"{self.text(value, ATOM)}._replace({self._named(node.keywords)})"
            case ast.Attribute(value=value, attr="model_copy"):
                return f"{self.text(value, ATOM)}.model_copy({self.text(node.keywords[0].value)})"
            case ast.Subscript(value=ast.Name(id="list" | "dict" | "set" as word)):
                return f"py.{word}({self.arguments(node.args)})"
            case ast.Name(id="replace"):
                return f"py.replace({self.text(node.args[0])}, {self._named(node.keywords)})"
            case ast.Name(
                id="bool",
            ) if len(node.args) == 1:
                return self.truth(node.args[0], ATOM)
            case ast.Name(id="abs" | "max" | "min" as word) if self.among_arrays(node):
                return f"Math.{word}({self.arguments(node.args)})"
            case ast.Name(id="len") if self.is_array(node.args[0]):
                return f"{self.text(node.args[0])}.length"
            case ast.Name(id="type"):
                return f"{self.text(node.args[0], ATOM)}.constructor"
            case ast.Name(id="cls"):
                return f"new {self.name('cls')}({self._given(node)})"
            case ast.Name(id=name) if self.name(name) in self.program.classes:
                known = self.program.classes[self.name(name)]
                if known.kind == "part":
                    return f"new {known.name}({self._named(node.keywords)})"
                if node.keywords and any(isinstance(one, ast.Starred) for one in node.args):
                    return f"{known.name}.made([{self.arguments(node.args)}], {self._named(node.keywords)})"
                return f"new {known.name}({self._given(node)})"
            case ast.Attribute(value=value, attr=attr):
                return f"{self.text(value, ATOM)}.{attr}({self._given(node)})"
            case ast.Name(id=name):
                own = self.name(name)
                made = "new " if is_class(own.rpartition(".")[2]) else ""
                return f"{made}{own}({self._given(node)})"
        return f"py.call({self.text(func)}{''.join(', ' + self.text(one) for one in node.args)})"

    def _is_module(self, value: ast.expr) -> bool:
        return isinstance(value, ast.Name) and self.name(value.id) == "py.math"

    def _named(self, keywords: Sequence[ast.keyword]) -> str:
        parts = [f"{word.arg}: {self.text(word.value)}" if word.arg else "" for word in keywords]
        return f"{{ {', '.join(parts)} }}"

    def _given(self, node: ast.Call) -> str:
        """The arguments of a call in order, those by name in their places."""
        found = [self.text(one) for one in node.args]
        words = {word.arg: word.value for word in node.keywords if word.arg != "strict"}
        if any(word.arg is None for word in node.keywords):
            raise Untranslatable(f"{self.module}: {ast.unparse(node)}")
        if not words:
            return ", ".join(found)
        if isinstance(node.func, ast.Name) and self.name(node.func.id) in ("py.max", "py.min", "py.sorted"):
            return ", ".join([*found, f"py.how({self._named(node.keywords)})"])
        order = self._order(node, set(map(str, words)))
        for name in order[len(found) :]:
            if not words:
                break
            found.append(self.text(words.pop(name)) if name in words else "undefined")
        if words:
            raise Untranslatable(f"{self.module}: {ast.unparse(node)}")
        return ", ".join(found)

    def _order(self, node: ast.Call, words: set[str]) -> list[str]:
        """The names of the parameters of what is called."""
        known: list[list[str]] = []
        match node.func:
            case ast.Name(id=name):
                own = self.name(name)
                if own in self.program.classes:
                    known = [list(self.program.classes[own].fields)]
                elif own in self.program.functions:
                    known = [self.program.functions[own]]
            case ast.Attribute(attr=attr):
                known = self.program.methods.get(attr, [])
        fitting = [order for order in known if words <= set(order)]
        if not fitting or len({tuple(order.index(word) for word in sorted(words)) for order in fitting}) > 1:
            raise Untranslatable(f"{self.module}: whose arguments are those of {ast.unparse(node)}?")
        return fitting[0]


def is_class(name: str) -> bool:
    """Whether a name is written like that of a class."""
    return name[:1].isupper() and not name.isupper()
