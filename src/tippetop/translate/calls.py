"""Python's calls, and what is given to functions, as JavaScript."""

import ast
from collections.abc import Sequence
from functools import reduce

from tippetop.translate.expressions import ATOM, Expressions
from tippetop.translate.program import safe

RENAMED = {"startswith": "startsWith", "append": "push", "index": "indexOf", "items": "entries"}
"""Methods of Python's own types that have another name."""

METHODS = {"tolist": "list", "_replace": "replace"} | {
    word: word for word in ("removeprefix", "join", "isprintable")
}
"""Methods of Python's own types that are functions of the runtime."""

NAMED = ("_replace", "replace")
"""What takes fields by their names."""

CHOICES = ("py.max", "py.min", "py.sorted")
"""What is told by name how it chooses."""

OF_TWO = {"max": "larger", "min": "smaller"}
"""What chooses of two things, where they are given one by one."""


class Calls(Expressions):
    """Translates the calls of a module, and what functions take."""

    def call(self, node: ast.Call) -> str:
        """A call."""
        match node.func:
            case ast.Attribute(value=ast.Call(func=ast.Name(id="super")), attr=attr):
                return f"super{'' if attr == '__init__' else '.' + attr}({self._given(node)})"
            case ast.Attribute(value=value, attr=attr) if attr in METHODS:
                given = filter(None, [self.text(value), self._given(node)])
                return f"py.{METHODS[attr]}({', '.join(given)})"
            case ast.Attribute(attr=attr) if attr in self.program.makers:
                return f"new {self.text(node.func)}({self._given(node)})"
            case ast.Attribute(value=value, attr=attr):
                return f"{self.text(value, ATOM)}.{RENAMED.get(attr, attr)}({self._given(node)})"
            case ast.Subscript(value=ast.Name(id="list" | "dict" | "set" as word)):
                return f"py.{word}({self.arguments(node.args)})"
            case ast.Name(id="abs") if self.plain:
                return f"Math.abs({self.arguments(node.args)})"
            case ast.Name(id="max" | "min" as word) if are_given_singly(node):
                return reduce(
                    lambda a, b: f"py.{OF_TWO[word]}({a}, {b})", map(self.text, node.args)
                )
            case ast.Name(id="len") if self.numeric:
                return f"{self.text(node.args[0])}.length"
            case ast.Name(id=name):
                own = self.name(name)
                known = self.program.classes.get(own)
                if known is not None and known.kind == "Part":
                    return f"new {own}({self._named(node.keywords)})"
                made = known is not None or name == "cls" or is_class(own.rpartition(".")[2])
                return f"{'new ' if made else ''}{own}({self._given(node)})"
            case ast.IfExp(body=ast.Name(id=name)) if is_class(name):
                return f"new ({self.text(node.func)})({self._given(node)})"
            case ast.Call(func=ast.Name(id="type")):
                return f"new ({self.text(node.func)})({self._given(node)})"
        return f"{self.text(node.func, ATOM)}({self._given(node)})"

    def function(self, node: ast.FunctionDef | ast.Lambda) -> str:
        """The parameters of a function, with their defaults, which are seen from outside."""
        given = [*node.args.posonlyargs, *node.args.args]
        defaults: list[ast.expr | None] = [None] * (len(given) - len(node.args.defaults))
        pairs = [*zip(given, [*defaults, *node.args.defaults], strict=True)]
        pairs += zip(node.args.kwonlyargs, node.args.kw_defaults, strict=True)
        names = list[str]()
        for one, default in pairs:
            if one.arg not in ("self", "cls") or one is not given[0]:
                name = safe(one.arg) + ("_" if one.arg in names else "")
                names.append(name if default is None else f"{name} = {self.text(default)}")
        if node.args.vararg:
            names.append(f"...{safe(node.args.vararg.arg)}")
        return f"({', '.join(names)})"

    def _named(self, keywords: Sequence[ast.keyword]) -> str:
        return f"{{ {', '.join(f'{word.arg}: {self.text(word.value)}' for word in keywords)} }}"

    def _given(self, node: ast.Call) -> str:
        """The arguments of a call in order, those by name in their places."""
        found = [self.text(one) for one in node.args]
        words = {str(word.arg): word.value for word in node.keywords if word.arg != "strict"}
        if not words:
            return ", ".join(found)
        called = ast.unparse(node.func).rpartition(".")[2]
        if called in NAMED or self.name(called) in CHOICES:
            return ", ".join([*found, self._named(node.keywords)])
        order = self._order(node, set(words))
        rest = order[len(found) : max(map(order.index, words)) + 1]
        return ", ".join(
            [*found, *(self.text(words[one]) if one in words else "undefined" for one in rest)]
        )

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
        if len({tuple(order.index(word) for word in sorted(words)) for order in fitting}) != 1:
            raise self.refused(node)
        return fitting[0]


def are_given_singly(node: ast.Call) -> bool:
    """Whether a call gives several things one by one, and nothing by name."""
    return (
        len(node.args) > 1
        and not node.keywords
        and not any(isinstance(a, ast.Starred) for a in node.args)
    )


def is_class(name: str) -> bool:
    """Whether a name is written like that of a class."""
    return name[:1].isupper() and not name.isupper()
