"""Python modules that are to be another language's: who is who in them."""

import ast
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field

RESERVED = " new function default delete var this typeof void switch case null arguments "
"""Words that are names in Python only."""

KINDS = {
    "NamedTuple": "py.NamedTuple",
    "Enum": "py.Enum",
    "StrEnum": "py.Enum",
    "IntEnum": "py.Thing",
    "Part": "Part",
    "Variant": "Part",
    "ArithmeticError": "py.ArithmeticError",
    "ValueError": "py.ValueError",
    "Protocol": "",
}
"""What classes of a base are in the other language; of a protocol nothing remains."""

RECORDS = ("py.NamedTuple", "py.Record")
"""Kinds whose fields are what they are made of, by their places."""

OWN = (ast.FunctionDef, ast.Lambda, ast.ListComp, ast.GeneratorExp, ast.SetComp, ast.DictComp)
"""What has names of its own."""

NOTHING = ast.Constant(None)


@dataclass
class Class:
    """A class."""

    name: str
    """What it is called."""
    node: ast.ClassDef
    """Its definition."""
    bases: list[str]
    """The classes it is of that are translated too, by name."""
    kind: str
    """One of `KINDS`, "py.Record" or "py.Thing"."""
    fields: dict[str, ast.expr | None] = field(default_factory=dict)
    """Names and defaults of its fields, those of its bases first."""


class Program:
    """Modules, and what their names stand for.

    Parameters
    ----------
    sources
        The modules' texts by their names, each after those it imports.
    given
        Modules that are written by hand: where they are, by the names of what they stand for.
    left
        What is left out: functions, and methods with their class.
    indexed
        Modules in which what is indexed may be an object of its own kind.
    plain
        Modules that do arithmetic with numbers alone, beside lists that are written there.
    numeric
        Modules of numbers and arrays of them alone, in which nothing is an error.

    Raises
    ------
    ValueError
        If what a module imports of one written by hand would be taken for something of another
        module.
    """

    def __init__(
        self,
        sources: Mapping[str, str],
        given: Mapping[str, str],
        left: Iterable[str],
        indexed: Iterable[str] = (),
        plain: Iterable[str] = (),
        numeric: Iterable[str] = (),
    ) -> None:
        self.trees = {name: ast.parse(text) for name, text in sources.items()}
        self.given, self.left, self.indexed = dict(given), frozenset(left), frozenset(indexed)
        self.numeric = frozenset(numeric)
        self.plain = self.numeric.union(plain)
        # What a module's names are called in all of the program.
        self.names: dict[tuple[str, str], str] = {}
        self.made: list[str] = []
        self.imported: dict[str, set[str]] = {}
        self.classes: dict[str, Class] = {}
        self.functions: dict[str, list[str]] = {}
        self.methods: dict[str, list[list[str]]] = {"model_copy": [["update"]]}
        self.values: set[str] = set()
        # Fields that are classes.
        self.makers: set[str] = set()
        for module, tree in self.trees.items():
            for node in tree.body:
                self._enter(module, node)
        for found in self.classes.values():
            self._describe(found)

    def is_method(self, name: str) -> bool:
        """Whether an attribute of this name is a method, whatever has it."""
        fields = any(name in known.fields for known in self.classes.values())
        return name in self.methods and name not in self.values and not fields

    def _enter(self, module: str, node: ast.stmt) -> None:
        match node:
            case ast.ImportFrom(module=where, names=names) if (
                where in self.trees or where in self.given
            ):
                for alias in names:
                    known = self.names.get((str(where), alias.name))
                    if where in self.given:
                        if alias.name in self.made and self.given[where]:
                            raise ValueError(
                                f"{module}: {alias.name} of {where} is another module's name"
                            )
                        self.imported.setdefault(self.given[where], set()).add(alias.name)
                        known = alias.name
                    # What a translated module leaves out is the runtime's.
                    if known is not None:
                        self.names[module, alias.asname or alias.name] = known
            case ast.ImportFrom(module="math", names=names):
                for alias in names:
                    self.names[module, alias.asname or alias.name] = f"py.math.{alias.name}"
            case ast.FunctionDef(name=name) if name not in self.left:
                self.functions[self._unique(module, name)] = parameters(node)
            case ast.ClassDef(name=name) if name not in self.left:
                above = [self.names.get((module, ast.unparse(one)), "") for one in node.bases]
                bases = [base for base in above if base in self.classes]
                kind = self._kind(node, bases)
                if kind:
                    own = self._unique(module, name)
                    self.classes[own] = Class(own, node, bases, kind)
            case ast.Assign() | ast.AnnAssign() if not is_type(node):
                for target in targets_of(node):
                    for name in names_in(target):
                        self._unique(module, name)

    def _unique(self, module: str, name: str) -> str:
        found = safe(name)
        if found in {*self.classes, *self.functions, *self.names.values()}:
            found = f"{name}_of_{module.rpartition('.')[2]}"
        self.names[module, name] = found
        self.made.append(found)
        return found

    def _kind(self, node: ast.ClassDef, bases: list[str]) -> str:
        for base in node.bases:
            if ast.unparse(base) in KINDS:
                return KINDS[ast.unparse(base)]
        inherited = {self.classes[base].kind for base in bases}
        if "Part" in inherited:
            return "Part"
        marked = any("dataclass" in ast.unparse(mark) for mark in node.decorator_list)
        return "py.Record" if marked or "py.Record" in inherited else "py.Thing"

    def _describe(self, found: Class) -> None:
        for one in ast.walk(found.node):
            if isinstance(one, ast.Attribute) and isinstance(one.ctx, ast.Store):
                self.values.add(one.attr)
        for base in found.bases:
            found.fields.update(self.classes[base].fields)
        for node in found.node.body:
            match node:
                case ast.AnnAssign(target=ast.Name(id=name)) if found.kind in (*RECORDS, "Part"):
                    if not ast.unparse(node.annotation).startswith("ClassVar"):
                        found.fields[name] = node.value
                    if ast.unparse(node.annotation).startswith("type["):
                        self.makers.add(name)
                case ast.FunctionDef(name="__init__"):
                    found.fields = dict.fromkeys(parameters(node))
                case ast.FunctionDef(name=name) if "property" in " ".join(marks_of(node)):
                    self.values.add(name)
                case ast.FunctionDef(name=name):
                    self.methods.setdefault(name, []).append(parameters(node))


def parameters(node: ast.FunctionDef | ast.Lambda) -> list[str]:
    """Names of the parameters, those by keyword last, without the object or class itself."""
    found = [one.arg for one in (*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs)]
    return found[1:] if found[:1] in (["self"], ["cls"]) else found


def given(node: ast.FunctionDef | ast.Lambda) -> set[str]:
    """The parameters of a function."""
    return {*parameters(node), *([node.args.vararg.arg] if node.args.vararg else [])}


def bound(node: ast.FunctionDef | ast.Lambda) -> set[str]:
    """Those, and the names that the function binds."""
    names = given(node)
    for inner in within(node):
        match inner:
            case ast.Name(id=name, ctx=ast.Store()) | ast.FunctionDef(name=name):
                names.add(name)
            case ast.ExceptHandler(name=str(name)):
                names.add(name)
    return names


def within(node: ast.AST) -> Iterator[ast.AST]:
    """All that is in a function, but not what is in others that are in it."""
    for child in ast.iter_child_nodes(node):
        yield child
        if not isinstance(child, OWN):
            yield from within(child)


def marks_of(node: ast.FunctionDef) -> list[str]:
    """The names of a function's decorators."""
    return [ast.unparse(mark).partition("(")[0].rpartition(".")[2] for mark in node.decorator_list]


def targets_of(node: ast.Assign | ast.AnnAssign) -> list[ast.expr]:
    """What an assignment binds."""
    return node.targets if isinstance(node, ast.Assign) else [node.target]


def names_in(target: ast.AST) -> list[str]:
    """The names that a target binds."""
    return [
        node.id
        for node in ast.walk(target)
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)
    ]


def is_type(node: ast.Assign | ast.AnnAssign) -> bool:
    """Whether an assignment at the top of a module names a type, or is there for what is written
    later.
    """
    if isinstance(node, ast.Assign):
        made = node.value.func if isinstance(node.value, ast.Call) else node.value
        return isinstance(made, ast.Subscript) or ast.unparse(made) == "TypeVar"
    return (
        ast.unparse(node.annotation) == "TypeAlias" or ast.unparse(node.value or NOTHING) == "None"
    )


def safe(name: str) -> str:
    """A name that is no word of the other language."""
    return f"{name}_" if f" {name} " in RESERVED else name
