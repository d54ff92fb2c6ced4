"""Python modules that are to be another language's: who is who in them, and in which order they come."""

import ast
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property

RESERVED = {
    "new",
    "function",
    "default",
    "delete",
    "var",
    "this",
    "typeof",
    "void",
    "switch",
    "case",
    "null",
    "arguments",
}
"""Words that are names in Python only."""

TYPES = {"tuple", "list", "dict", "Callable", "Annotated", "Any", "Literal", "NDArray", "type"}
"""What a name for a type is made of."""


@dataclass
class Class:
    """A class."""

    name: str
    """What it is called."""
    node: ast.ClassDef
    """Its definition."""
    module: str
    """Where that is."""
    bases: list[str]
    """The classes it is of that are translated too, by name."""
    kind: str
    """"tuple", "record", "enum", "number" (an enum of numbers), "part", "error" (of arithmetic), "plain", or
    "" if nothing remains."""
    fields: dict[str, ast.expr | None] = field(default_factory=dict)
    """Names and defaults of its fields, those of its bases first."""


class Program:
    """Modules, and what their names stand for.

    Parameters
    ----------
    sources
        The modules' texts by their names.
    given
        Modules that are written by hand: where they are, by the names of what they stand for.
    left
        What is left out: functions, and methods with their class.
    indexed
        Modules in which what is indexed may be an object of its own kind.
    """

    def __init__(
        self,
        sources: Mapping[str, str],
        given: Mapping[str, str],
        left: Iterable[str],
        indexed: Iterable[str] = (),
    ) -> None:
        self.trees = {name: ast.parse(text) for name, text in sources.items()}
        self.given, self.left = dict(given), frozenset(left)
        self.names: dict[tuple[str, str], str] = {}
        self.made: list[str] = []
        self.imported: dict[str, set[str]] = {}
        self.indexed = frozenset(indexed)
        self.classes: dict[str, Class] = {}
        self.functions: dict[str, list[str]] = {}
        self.methods: dict[str, list[list[str]]] = {"__getitem__": []}
        self.values: dict[str, list[list[str]]] = {}
        for module in self.order:
            for node in self.trees[module].body:
                self._enter(module, node)
        for found in self.classes.values():
            self._describe(found)

    @cached_property
    def order(self) -> list[str]:
        """The modules, each after those it imports."""
        found: list[str] = []

        def visit(module: str) -> None:
            for node in self.trees[module].body:
                if isinstance(node, ast.ImportFrom) and node.module in self.trees:
                    visit(node.module)
            if module not in found:
                found.append(module)

        for module in self.trees:
            visit(module)
        return found

    def resolve(self, module: str, name: str) -> str | None:
        """What a name at the top of a module is called in the program; None if it is not there."""
        return self.names.get((module, name))

    def class_of(self, module: str, node: ast.expr) -> Class | None:
        """The class that an expression names."""
        name = self.resolve(module, node.id) if isinstance(node, ast.Name) else None
        return self.classes.get(name or "")

    def is_method(self, name: str) -> bool:
        """Whether an attribute of this name is a method, whatever has it."""
        fields = any(name in known.fields for known in self.classes.values())
        return name in self.methods and name not in self.values and not fields

    def _enter(self, module: str, node: ast.stmt) -> None:
        match node:
            case ast.ImportFrom(module=where, names=names) if where in self.trees or where in self.given:
                for alias in names:
                    if where in self.given:
                        self.imported.setdefault(self.given[where], set()).add(alias.name)
                    known = self.names.get((str(where), alias.name), alias.name)
                    self.names[module, alias.asname or alias.name] = known
            case ast.FunctionDef(name=name) if name not in self.left:
                self.functions[self._unique(module, name)] = parameters(node)
            case ast.ClassDef(name=name) if name not in self.left:
                kind = self._kind(module, node)
                if kind:
                    own = self._unique(module, name)
                    bases = [base.name for one in node.bases if (base := self.class_of(module, one))]
                    self.classes[own] = Class(own, node, module, bases, kind)
            case ast.Assign(targets=targets) if not is_type(node.value):
                for target in targets:
                    for name in names_in(target):
                        self._unique(module, name)
            case ast.AnnAssign(target=ast.Name(id=name)) if node.value and not is_alias(node):
                self._unique(module, name)

    def _unique(self, module: str, name: str) -> str:
        taken = {*self.classes, *self.functions, *self.names.values()}
        found = safe(name)
        if found in taken:
            found = f"{name}_of_{module.rpartition('.')[2]}"
        self.names[module, name] = found
        self.made.append(found)
        return found

    def _kind(self, module: str, node: ast.ClassDef) -> str:
        words = {base.id for base in node.bases if isinstance(base, ast.Name)}
        inherited = {base.kind for one in node.bases if (base := self.class_of(module, one))}
        if "Protocol" in words:
            return ""
        for word, kind in {
            "NamedTuple": "tuple",
            "Enum": "enum",
            "StrEnum": "enum",
            "IntEnum": "number",
            "Part": "part",
            "Variant": "part",
            "ArithmeticError": "error",
        }.items():
            if word in words:
                return kind
        if "part" in inherited:
            return "part"
        marks = {ast.unparse(mark).partition("(")[0] for mark in node.decorator_list}
        return "record" if "dataclass" in marks or "record" in inherited else "plain"

    def _describe(self, found: Class) -> None:
        for one in ast.walk(found.node):
            if isinstance(one, ast.Attribute) and isinstance(one.ctx, ast.Store):
                self.values.setdefault(one.attr, [])
        for base in found.bases:
            found.fields.update(self.classes[base].fields)
        for node in found.node.body:
            match node:
                case ast.AnnAssign(target=ast.Name(id=name)) if found.kind in ("tuple", "record", "part"):
                    if not ast.unparse(node.annotation).startswith("ClassVar"):
                        found.fields[name] = default_of(node.value)
                case ast.FunctionDef(name="__init__"):
                    found.fields = dict.fromkeys(parameters(node))
                case ast.FunctionDef(name=name):
                    known = self.values if is_property(node) else self.methods
                    known.setdefault(name, []).append(parameters(node))


def parameters(node: ast.FunctionDef | ast.Lambda) -> list[str]:
    """Names of the parameters, those by keyword last, without the object or class itself."""
    found = [one.arg for one in (*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs)]
    return found[1:] if found[:1] in (["self"], ["cls"]) else found


def is_property(node: ast.FunctionDef) -> bool:
    """Whether a method is asked for like a field."""
    return any("property" in ast.unparse(mark) for mark in node.decorator_list)


def default_of(value: ast.expr | None) -> ast.expr | None:
    """The default of a field."""
    if isinstance(value, ast.Call) and ast.unparse(value.func) == "field":
        for keyword in value.keywords:
            if keyword.arg == "default_factory":
                return ast.Call(keyword.value, [], [])
        return None
    return value


def names_in(target: ast.AST) -> list[str]:
    """The names that a target binds."""
    return [
        node.id for node in ast.walk(target) if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)
    ]


def is_type(value: ast.expr) -> bool:
    """Whether an expression is one of types."""
    return (
        isinstance(value, ast.Subscript) and isinstance(value.value, ast.Name) and value.value.id in TYPES
    ) or (isinstance(value, ast.Name) and value.id in TYPES)


def is_alias(node: ast.AnnAssign) -> bool:
    """Whether an assignment gives a type another name, or holds a name free for what is written later."""
    return ast.unparse(node.annotation).endswith("TypeAlias") or ast.unparse(node.value or node) == "None"


def safe(name: str) -> str:
    """A name that is no word of the other language."""
    return f"{name}_" if name in RESERVED else name
