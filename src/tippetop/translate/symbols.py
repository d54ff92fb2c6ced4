"""Symbol table of the Python modules that are translated to JavaScript."""

import ast
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache

from tippetop.translate.declarations import declarations_of
from tippetop.translate.refusal import Untranslatable
from tippetop.translate.runtime_names import ERRORS, FUNCTIONS, IMPORTED, MATH, VALUES

RESERVED = " new function default delete var this typeof void switch case null arguments "
"""Reserved words of JavaScript that are names in Python."""

KINDS = {
    "NamedTuple": "py.NamedTuple",
    "Enum": "py.Enum",
    "StrEnum": "py.StrEnum",
    "IntEnum": "py.IntEnum",
    "Part": "Part",
    "Variant": "Part",
    "ArithmeticError": "py.ArithmeticError",
    "ValueError": "py.ValueError",
    "Protocol": "protocol",
}
"""JavaScript's class for each base class in Python; a protocol is not translated."""

RECORDS = ("py.NamedTuple", "py.Record")
"""Kinds of classes whose constructor takes the fields by position."""

ENUMERATIONS = ("py.Enum", "py.StrEnum", "py.IntEnum")
UNWRITTEN = ("protocol", "by hand")
"""Kinds of classes that the translation does not define."""

SCOPED = (ast.FunctionDef, ast.Lambda, ast.ListComp, ast.GeneratorExp, ast.SetComp, ast.DictComp)
"""Nodes that have a scope of names."""

FORMS_OF_CLASS = {"dataclass", "runtime_checkable"}
FORMS_OF_FUNCTION = {
    *("property", "cached_property", "classmethod", "staticmethod", "abstractmethod"),
    *("cache", "lru_cache", "model_validator"),
}
"""Decorators that are translated."""

OPERATORS = {
    f"__{prefix}{word}__"
    for prefix in ("", "r")
    for word in ("add", "sub", "mul", "truediv", "pow")
} | {f"__{word}__" for word in ("init", "neg", "abs", "getitem", "bool", "eq", "lt", "gt")}
"""Special methods that the runtime calls."""


@dataclass(eq=False)
class Class:
    """A class of a translated module, or of a module with a counterpart by hand, or a protocol."""

    name: str
    """Name in JavaScript."""
    module: str
    node: ast.ClassDef
    bases: list["Class"]
    """Bases among the translated classes."""
    kind: str
    """A value of `KINDS`, "py.Record", "py.Thing" or "by hand"."""
    fields: dict[str, ast.expr | None] = field(default_factory=dict)
    """Names and defaults of the constructor's parameters, those of its bases first."""
    members: dict[str, "Member"] = field(default_factory=dict)
    """Fields, properties, methods and constants, without those of the bases."""

    @property
    def is_enumeration(self) -> bool:
        """Whether the instances are named constants."""
        return self.kind in ENUMERATIONS

    def member(self, name: str) -> "Member | None":
        """Return a member of the class or of its bases."""
        if name in self.members:
            return self.members[name]
        return next((member for base in self.bases if (member := base.member(name))), None)

    def is_a(self, ancestor: "Class") -> bool:
        """Return whether the class is another one or derives from it."""
        return self is ancestor or any(base.is_a(ancestor) for base in self.bases)


@dataclass(eq=False)
class Member:
    """A field, property, method or constant of a class."""

    owner: Class
    form: str
    """"field", "property", "method", "class method", "static method" or "constant"."""
    annotation: ast.expr | None = None
    """Annotated type of a field, property or constant, or None."""
    node: ast.FunctionDef | None = None
    """The method, or the method that assigns to the field."""
    value: ast.expr | None = None
    """Value of a constant, or the value first assigned to a field."""

    @property
    def is_method(self) -> bool:
        """Whether the member is called with the object or class it belongs to."""
        return self.form.endswith("method")


@dataclass(eq=False)
class Symbol:
    """A name at the top of a module: a class, function, type alias or constant."""

    module: str
    node: Class | ast.FunctionDef | ast.Assign | ast.AnnAssign


class SymbolTable:
    """The translated modules and the meaning of their names.

    Parameters
    ----------
    sources
        Texts of the modules by their names, each after the modules that it imports.
    paths
        Files of the modules, for messages; a module without one is called by its name.

    Raises
    ------
    Untranslatable
        If a declaration does not hold or names clash.
    """

    def __init__(self, sources: Mapping[str, str], paths: Mapping[str, str] | None = None) -> None:
        self.paths = {name: (paths or {}).get(name, name) for name in sources}
        parsed = {name: ast.parse(text, self.paths[name]) for name, text in sources.items()}
        self.declared = {
            name: declarations_of(sources[name], tree, self.paths[name])
            for name, tree in parsed.items()
        }
        self.trees = {name: tree for name, tree in parsed.items() if self._is_translated(name)}
        # JavaScript's name for each module and name.
        self.names: dict[tuple[str, str], str] = {}
        self.made: list[str] = []
        # Names imported from JavaScript written by hand, by its file.
        self.imported: dict[str, set[str]] = {}
        self.symbols: dict[tuple[str, str], Symbol] = {}
        self.aliases: dict[tuple[str, str], tuple[str, str]] = {}
        self.classes: list[Class] = []
        self.class_of: dict[ast.ClassDef, Class] = {}
        self.runtime: set[str] = {*FUNCTIONS, *ERRORS, *VALUES}
        for module, tree in parsed.items():
            if "skip" not in self.declared[module].words:
                for node in tree.body:
                    self._enter(module, node)
        for one in self.classes:
            self._describe(one)

    def word(self, module: str, node: ast.stmt) -> str:
        """Return the declaration of a definition, "" without one."""
        return self.declared[module].definitions.get(node, "")

    def symbol(self, module: str, name: str) -> Symbol | None:
        """Return the symbol of a name at the top of a module, through imports."""
        place = (module, name)
        while place in self.aliases and place not in self.symbols:
            place = self.aliases[place]
        return self.symbols.get(place)

    def is_dropped(self, module: str, name: str) -> bool:
        """Return whether statements that only call this function are left out."""
        symbol = self.symbol(module, name)
        return (
            symbol is not None
            and isinstance(symbol.node, ast.stmt)
            and self.word(symbol.module, symbol.node) == "drop"
        )

    def refusal(self, module: str, node: ast.AST, reason: str) -> Untranslatable:
        """Return the error that refuses a part of a module."""
        code = "" if isinstance(node, ast.ClassDef | ast.FunctionDef) else ast.unparse(node)
        return Untranslatable(
            self.paths[module], getattr(node, "lineno", 1), reason, code.partition("\n")[0]
        )

    def _is_translated(self, module: str) -> bool:
        declared = self.declared[module]
        return not declared.file and "skip" not in declared.words

    def _enter(self, module: str, node: ast.stmt) -> None:
        match node:
            case ast.If(test=ast.Name("TYPE_CHECKING"), body=body):
                for one in body:
                    self._import_types(one, module)
            case ast.ImportFrom(module=str(source), names=aliases) if source in self.declared:
                self._import_types(node, module)
                for alias in aliases if self._is_translated(module) else ():
                    self._import(module, node, source, alias)
            case ast.ImportFrom(module="math", names=aliases):
                for alias in aliases:
                    if alias.name not in MATH:
                        raise self.refusal(module, node, f"the runtime has no math.{alias.name}")
                    self.names[module, alias.asname or alias.name] = f"py.math.{alias.name}"
            case ast.ImportFrom(module=str(source), names=aliases) if source in IMPORTED:
                for alias in aliases:
                    if alias.name in IMPORTED[source]:
                        self.names[module, alias.asname or alias.name] = f"py.{alias.name}"
            case ast.FunctionDef(name=name):
                self._define(module, name, node, node)
            case ast.ClassDef(name=name):
                self._enter_class(module, name, node)
            case ast.Assign() | ast.AnnAssign():
                for target in targets_of(node):
                    for name in names_in(target):
                        self._define(module, name, node, node)

    def _import_types(self, node: ast.stmt, module: str) -> None:
        if isinstance(node, ast.ImportFrom):
            for alias in node.names:
                self.aliases[module, alias.asname or alias.name] = (str(node.module), alias.name)

    def _import(self, module: str, node: ast.stmt, source: str, alias: ast.alias) -> None:
        name, file = alias.asname or alias.name, self.declared[source].file
        if file:
            if alias.name in self.made:
                reason = f"{alias.name} of {source}, written by hand, is another module's name"
                raise self.refusal(module, node, reason)
            if self._is_value(source, alias.name):
                self.imported.setdefault(f"./{file}", set()).add(alias.name)
                self.names[module, name] = alias.name
        elif (source, alias.name) in self.names:
            self.names[module, name] = self.names[source, alias.name]

    def _is_value(self, module: str, name: str) -> bool:
        symbol = self.symbol(module, name)
        return symbol is None or not (
            isinstance(symbol.node, ast.Assign | ast.AnnAssign) and is_type(symbol.node)
        )

    def _define(self, module: str, name: str, node: ast.stmt, meaning: Class | ast.stmt) -> None:
        word = self.word(module, node)
        if word in ("", "drop"):
            assert isinstance(meaning, Class | ast.FunctionDef | ast.Assign | ast.AnnAssign)
            self.symbols[module, name] = Symbol(module, meaning)
        if word == "runtime":
            self.runtime.add(name)
            self.names[module, name] = f"py.{name}"
        is_alias = isinstance(node, ast.Assign | ast.AnnAssign) and is_type(node)
        if word == "" and self._is_translated(module) and not is_alias:
            unique = safe(name)
            if unique in self.made or unique in self.names.values():
                unique = f"{name}_of_{module.rpartition('.')[2]}"
            if isinstance(meaning, Class):
                meaning.name = unique
                if meaning.kind in UNWRITTEN:
                    return
            self.names[module, name] = unique
            self.made.append(unique)

    def _enter_class(self, module: str, name: str, node: ast.ClassDef) -> None:
        bases = list[Class]()
        for base in node.bases:
            inner = base.value if isinstance(base, ast.Subscript) else base
            symbol = self.symbol(module, ast.unparse(inner))
            if symbol is not None and isinstance(symbol.node, Class):
                bases.append(symbol.node)
        kind = self._kind(module, node, bases)
        one = Class(name, module, node, bases, kind)
        self._define(module, name, node, one)
        if self.word(module, node) == "":
            self.classes.append(one)
            self.class_of[node] = one

    def _kind(self, module: str, node: ast.ClassDef, bases: list[Class]) -> str:
        if not self._is_translated(module):
            return "by hand"
        for base in node.bases:
            if ast.unparse(base) in KINDS:
                return KINDS[ast.unparse(base)]
        inherited = {base.kind for base in bases if base.kind not in UNWRITTEN}
        if self.word(module, node) == "" and len(inherited) > 1:
            raise self.refusal(module, node, f"class {node.name} has bases of several kinds")
        if "Part" in inherited:
            return "Part"
        marked = any("dataclass" in ast.unparse(mark) for mark in node.decorator_list)
        return "py.Record" if marked or "py.Record" in inherited else "py.Thing"

    def _describe(self, one: Class) -> None:
        """Enter the members and the constructor's parameters of a class, after those of its
        bases.
        """
        written = [base for base in one.bases if base.kind not in UNWRITTEN]
        if len(written) > 1 and one.kind not in UNWRITTEN:
            raise self.refusal(one.module, one.node, f"class {one.node.name} has several bases")
        for base in written:
            one.fields.update(base.fields)
        for node in one.node.body:
            if self.word(one.module, node) == "":
                self._describe_member(one, node)
        for node in one.node.body:
            if isinstance(node, ast.FunctionDef) and self.word(one.module, node) == "":
                for inner in ast.walk(node):
                    self._describe_assigned(one, node, inner)

    def _describe_member(self, one: Class, node: ast.stmt) -> None:
        match node:
            case ast.AnnAssign(target=ast.Name(id=name), annotation=kind, value=value):
                is_constant = ast.unparse(kind).startswith("ClassVar")
                form = "constant" if is_constant else "field"
                one.members[name] = Member(one, form, kind, value=value)
                if not is_constant and one.kind in (*RECORDS, "Part", "by hand"):
                    one.fields[name] = value
            case ast.Assign(targets=[target], value=value):
                for name in names_in(target):
                    one.members[name] = Member(one, "constant", value=value)
            case ast.FunctionDef(name="__init__"):
                one.fields = dict.fromkeys(parameters(node))
            case ast.FunctionDef(name=name):
                marks = set(marks_of(node))
                form = next(
                    (form for mark, form in FORMS_OF_METHODS.items() if mark in marks),
                    "method",
                )
                one.members[name] = Member(one, form, node.returns, node)

    def _describe_assigned(self, one: Class, method: ast.FunctionDef, node: ast.AST) -> None:
        """Enter the fields that a method assigns to."""
        match node:
            case ast.AnnAssign(target=ast.Attribute(ast.Name("self"), name), annotation=kind):
                one.members.setdefault(name, Member(one, "field", kind, method, node.value))
            case ast.Assign(targets=targets, value=value):
                for target in targets:
                    for place, part in _parts(target, value):
                        if isinstance(place, ast.Attribute) and ast.unparse(place.value) == "self":
                            member = Member(one, "field", None, method, part)
                            one.members.setdefault(place.attr, member)


FORMS_OF_METHODS = {
    "property": "property",
    "cached_property": "property",
    "classmethod": "class method",
    "staticmethod": "static method",
}


def _parts(target: ast.expr, value: ast.expr) -> Iterator[tuple[ast.expr, ast.expr | None]]:
    """Yield the targets of an assignment, each with its value if that is written separately."""
    if isinstance(target, ast.Tuple):
        values = value.elts if isinstance(value, ast.Tuple) else [None] * len(target.elts)
        is_plain = len(values) == len(target.elts) and not any(
            isinstance(one, ast.Starred) for one in (*target.elts, *values)
        )
        yield from zip(target.elts, values if is_plain else [None] * len(target.elts), strict=True)
    else:
        yield target, value


def parameters(node: ast.FunctionDef | ast.Lambda) -> list[str]:
    """Return the names of the parameters, without self or cls and without starred ones."""
    args = (*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs)
    names = [one.arg for one in args]
    return names[1:] if names[:1] in (["self"], ["cls"]) else names


def all_parameters(node: ast.FunctionDef | ast.Lambda) -> set[str]:
    """Return the names of all parameters, the starred one included."""
    return {*parameters(node), *([node.args.vararg.arg] if node.args.vararg else [])}


@cache
def within(node: ast.AST) -> tuple[ast.AST, ...]:
    """Return the nodes in a function, without those in functions inside it."""
    return tuple(_within(node))


def _within(node: ast.AST) -> Iterator[ast.AST]:
    for child in ast.iter_child_nodes(node):
        yield child
        if not isinstance(child, SCOPED):
            yield from _within(child)


def marks_of(node: ast.FunctionDef | ast.ClassDef) -> list[str]:
    """Return the names of the decorators."""
    return [ast.unparse(mark).partition("(")[0].rpartition(".")[2] for mark in node.decorator_list]


def targets_of(node: ast.Assign | ast.AnnAssign) -> list[ast.expr]:
    """Return the targets of an assignment."""
    return node.targets if isinstance(node, ast.Assign) else [node.target]


def names_in(target: ast.AST) -> list[str]:
    """Return the names that a target binds."""
    return [
        node.id
        for node in ast.walk(target)
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)
    ]


def is_type(node: ast.Assign | ast.AnnAssign) -> bool:
    """Return whether an assignment at the top of a module names a type."""
    if isinstance(node, ast.Assign):
        made = node.value.func if isinstance(node.value, ast.Call) else node.value
        return isinstance(made, ast.Subscript) or ast.unparse(made) == "TypeVar"
    return (
        ast.unparse(node.annotation) == "TypeAlias"
        or node.value is None
        or ast.unparse(node.value) == "None"
    )


def safe(name: str) -> str:
    """Return a name that is not reserved in JavaScript."""
    return f"{name}_" if f" {name} " in RESERVED else name


def all_of(nodes: Iterable[ast.AST]) -> Iterator[ast.AST]:
    """Yield all nodes in some nodes."""
    for node in nodes:
        yield from ast.walk(node)
