"""Type inference for the expressions of a module."""

import ast
from collections.abc import Callable, Iterator
from functools import partial
from typing import TypeAlias

from tippetop.translate.refusal import Untranslatable
from tippetop.translate.runtime_names import METHODS, MODULES
from tippetop.translate.symbols import (
    Class,
    Member,
    Symbol,
    SymbolTable,
    within,
)
from tippetop.translate.types import (
    ANY,
    ARRAY,
    BASIC,
    BOOL,
    COLLECTIONS,
    FLOAT,
    INT,
    NEVER,
    NONE,
    NUMBERS,
    ROWS,
    STR,
    Type,
    alternatives_of,
    is_only,
    item_of,
    kinds_of,
    union,
)

Deferred: TypeAlias = Callable[[], Type]

PASSES = 8
"""Number of passes after which a name whose type still changes, as in a loop, may have any type."""


class Scope(dict[str, list[Deferred]]):
    """Names of a function or comprehension, each with functions that return the types bound to
    it.
    """

    def __init__(self) -> None:
        super().__init__()
        self.types: dict[str, Type] = {}


RETURNS = {
    "len": INT,
    "int": INT,
    "float": FLOAT,
    "str": STR,
    "repr": STR,
    "bool": BOOL,
    "isinstance": BOOL,
    "hasattr": BOOL,
    "any": BOOL,
    "all": BOOL,
    "range": Type("sequence", (INT,)),
    "dict": Type("dict"),
    "set": Type("set"),
}
"""Types that Python's functions return."""

RETURNS_OF_METHODS = {
    "index": INT,
    "isprintable": BOOL,
    "join": STR,
    "lower": STR,
    "removeprefix": STR,
    "split": Type("list", (STR,)),
    "startswith": BOOL,
    "tolist": Type("list"),
}


class Inference:
    """Infers the types of a module's expressions.

    Parameters
    ----------
    program
        All modules.
    module
        Name of the module.
    """

    def __init__(self, program: SymbolTable, module: str) -> None:
        self.program, self.module = program, module
        self.scopes = [Scope()]
        self.owner: Class | None = None
        # Expressions whose types are being inferred, the number of times that one depended on
        # itself, and the number of scopes that are being entered.
        self._pending, self._cuts, self._unsettled = set[ast.expr](), 0, 0
        self._types: dict[ast.expr, Type] = {}

    def refusal(self, node: ast.AST, reason: str) -> Untranslatable:
        """Return the error that refuses a part of the module."""
        return self.program.refusal(self.module, node, reason)

    # ---- names

    def is_local(self, name: str) -> bool:
        """Return whether a name belongs to an enclosing function or comprehension."""
        return any(name in scope for scope in self.scopes)

    def function_scope(self, node: ast.FunctionDef | ast.Lambda) -> Scope:
        """Return the names that a function binds."""
        scope = Scope()
        module, owner = self.module, self.owner
        args = [*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs]
        is_bound = args[:1] and args[0].arg in ("self", "cls")
        for arg in args[1:] if is_bound else args:
            scope[arg.arg] = [partial(self.annotated, arg.annotation, module, owner)]
        if node.args.vararg:
            kind = node.args.vararg.annotation
            scope[node.args.vararg.arg] = [
                lambda: Type("sequence", (self.annotated(kind, module, owner),))
            ]
        for inner in within(node) if isinstance(node, ast.FunctionDef) else ():
            match inner:
                case ast.Assign(targets=targets, value=value):
                    for target in targets:
                        self._bind(scope, target, self._deferred(value))
                case ast.AnnAssign(target=target, annotation=kind):
                    self._bind(scope, target, partial(self.annotated, kind, module, owner))
                case ast.AugAssign(target=target, op=op, value=value):
                    sum_ = ast.copy_location(ast.BinOp(target, op, value), inner)
                    self._bind(scope, target, self._deferred(sum_))
                case ast.For(target=target, iter=rows):
                    self._bind(scope, target, self._deferred(rows, iterated=True))
                case ast.FunctionDef(name=name):
                    function = Type("function", node=inner, module=module)
                    scope.setdefault(name, []).append(partial(union, [function]))
                case ast.ExceptHandler(name=str(name)):
                    scope.setdefault(name, []).append(lambda: ANY)
        return scope

    def comprehension_scope(self, generator: ast.comprehension) -> Scope:
        """Return the names that a part of a comprehension binds."""
        scope = Scope()
        self._bind(scope, generator.target, self._deferred(generator.iter, iterated=True))
        return scope

    def _deferred(self, node: ast.expr, *, iterated: bool = False) -> Deferred:
        """Return a function that infers the type of an expression, or of its items."""
        return lambda: self.item(self.type_of(node)) if iterated else self.type_of(node)

    def _bind(self, scope: Scope, target: ast.expr, kind: Deferred) -> None:
        """Enter the names of a target, whose value has the type that `kind` returns."""
        match target:
            case ast.Name(id=name):
                scope.setdefault(name, []).append(kind)
            case ast.Starred(value=value):
                self._bind(scope, value, lambda: Type("list", (self.item(kind()),)))
            case ast.Tuple(elts=parts):
                for place, part in enumerate(parts):
                    if isinstance(part, ast.Starred):
                        self._bind(scope, part.value, lambda: Type("list", (self.item(kind()),)))
                    else:
                        self._bind(scope, part, partial(self._item_later, kind, place))

    def _item_later(self, kind: Deferred, place: int) -> Type:
        return self.item(kind(), place)

    def item(self, kind: Type, place: int | None = None) -> Type:
        """Return the type of an item of a collection, or of a field of a named tuple."""
        items = list[Type]()
        for part in alternatives_of(kind):
            if part.kind == "instance" and part.cls and part.cls.kind == "py.NamedTuple":
                types = [self.member_type(part.cls, name) for name in part.cls.fields]
                has_place = place is not None and -len(types) <= place < len(types)
                items.append(types[place or 0] if has_place else union(types))
            else:
                items.append(item_of(part, place))
        return union(items)

    def enter(self, scope: Scope) -> None:
        """Enter a scope and infer the types of its names, which may depend on each other."""
        self.scopes.append(scope)
        scope.types = dict.fromkeys(scope, NEVER)
        before: dict[str, Type] = {}
        self._unsettled += 1
        for _ in range(PASSES):
            before = dict(scope.types)
            for name, kinds in scope.items():
                scope.types[name] = union([kind() for kind in kinds])
            if scope.types == before:
                break
        self._unsettled -= 1
        for name, kind in scope.types.items():
            if kind == NEVER or kind != before[name]:
                scope.types[name] = ANY

    def name_type(self, name: str) -> Type:
        """Return the type of a name."""
        for scope in reversed(self.scopes):
            if name in scope:
                return scope.types[name]
        if name == "self" and self.owner:
            return Type("instance", cls=self.owner)
        if name == "cls" and self.owner:
            return Type("class", cls=self.owner)
        if name in MODULES:
            return Type("module")
        symbol = self.program.symbol(self.module, name)
        return ANY if symbol is None else self.symbol_type(symbol)

    def symbol_type(self, symbol: Symbol) -> Type:
        """Return the type of a name at the top of a module."""
        match symbol.node:
            case Class() as one:
                return Type("class", cls=one)
            case ast.FunctionDef() as node:
                return Type("function", node=node, module=symbol.module)
            case ast.AnnAssign(annotation=kind) if ast.unparse(kind) != "TypeAlias":
                return self.annotated(kind, symbol.module, None)
            case ast.Assign(targets=[ast.Name()], value=value):
                return self._elsewhere(symbol.module, None, None, value)
        return ANY

    def _elsewhere(
        self, module: str, owner: Class | None, method: ast.FunctionDef | None, node: ast.expr
    ) -> Type:
        """Return the type of an expression in another module, or in a method of a class."""
        if node in self._types:
            return self._types[node]
        if node in self._pending:
            self._cuts += 1
            return NEVER
        before = self.module, self.owner, self.scopes, self._unsettled
        self.module, self.owner, self.scopes, self._unsettled = module, owner, [Scope()], 0
        self._pending.add(node)
        if method is not None:
            self.enter(self.function_scope(method))
        kind = self.type_of(node)
        self._pending.discard(node)
        self.module, self.owner, self.scopes, self._unsettled = before
        return kind

    # ---- annotations

    def annotated(self, node: ast.expr | None, module: str, owner: Class | None) -> Type:
        """Return the type that an annotation in a module, or in one of its classes, denotes."""
        match node:
            case ast.Constant(value=str(text)):
                return self.annotated(ast.parse(text, mode="eval").body, module, owner)
            case ast.Constant(value=None):
                return NONE
            case ast.Name(id="Self") if owner is not None:
                return Type("instance", cls=owner)
            case ast.Name(id=name) if name in BASIC:
                return BASIC[name]
            case ast.Name(id=name):
                symbol = self.program.symbol(module, name)
                return ANY if symbol is None else self._alias(symbol)
            case ast.BinOp(left=left, op=ast.BitOr(), right=right):
                return union([self.annotated(one, module, owner) for one in (left, right)])
            case ast.Subscript(value=value, slice=inside):
                word = ast.unparse(value).rpartition(".")[2]
                parts = inside.elts if isinstance(inside, ast.Tuple) else [inside]
                return self._generic(word, value, parts, module, owner)
        return ANY

    def _generic(
        self,
        word: str,
        value: ast.expr,
        parts: list[ast.expr],
        module: str,
        owner: Class | None,
    ) -> Type:
        if word in ("Annotated", "ClassVar"):
            return self.annotated(parts[0], module, owner)
        if word == "Literal":
            return union(
                [
                    BASIC.get(type(one.value).__name__, ANY)
                    for one in parts
                    if isinstance(one, ast.Constant)
                ]
            )
        if word == "Callable":
            return Type("function", (self.annotated(parts[-1], module, owner),))
        if word == "NDArray":
            return ARRAY
        if word == "type":
            inner = self.annotated(parts[0], module, owner)
            return Type("class", cls=inner.cls)
        if word in COLLECTIONS:
            is_long = ast.unparse(parts[-1]) == "..."
            items = [
                self.annotated(one, module, owner) for one in parts if ast.unparse(one) != "..."
            ]
            kind = COLLECTIONS[word]
            if kind == "iterator" or is_long:
                items = items[:1]
            return Type("sequence" if is_long else kind, tuple(items))
        return self.annotated(value, module, owner)

    def _alias(self, symbol: Symbol) -> Type:
        match symbol.node:
            case Class() as one:
                return Type("instance", cls=one)
            case ast.AnnAssign(value=ast.expr() as value):
                return self.annotated(value, symbol.module, None)
            case ast.Assign(value=value):
                return self.annotated(value, symbol.module, None)
        return ANY

    # ---- members and calls

    def members(self, kind: Type, name: str) -> list[Member]:
        """Return the members of this name that an object of a type may have.

        If the class has none, these are members of its derived classes, since code asks with
        `isinstance` before it uses them. If the class is unknown, these are the members of all
        classes.
        """
        members = list[Member]()
        for part in alternatives_of(kind) or (ANY,):
            if part.kind == "any" or (part.kind in ("instance", "class") and part.cls is None):
                members += [
                    one.members[name] for one in self.program.classes if name in one.members
                ]
            elif part.kind in ("instance", "class") and part.cls is not None:
                member = part.cls.member(name)
                members += [member] if member else self._derived(part.cls, name)
        return members

    def _derived(self, one: Class, name: str) -> list[Member]:
        is_protocol = one.kind == "protocol"
        return [
            derived.members[name]
            for derived in self.program.classes
            if name in derived.members and (is_protocol or derived.is_a(one))
        ]

    def member_type(self, one: Class, name: str) -> Type:
        """Return the type of a member of an object of a class."""
        member = one.member(name)
        return ANY if member is None else self._type_of_member(member, one)

    def _type_of_member(self, member: Member, one: Class) -> Type:
        owner = member.owner
        if member.is_method:
            return Type("function", cls=one, node=member.node, module=owner.module)
        if owner.is_enumeration and member.form == "constant":
            return INT if owner.kind == "py.IntEnum" else Type("instance", cls=owner)
        if member.annotation is not None:
            return self.annotated(member.annotation, owner.module, one)
        if member.value is not None:
            return self._elsewhere(owner.module, owner, member.node, member.value)
        return ANY

    def returned(self, kind: Type) -> Type:
        """Return the type of what a call to a function or class of a type returns."""
        match kind:
            case Type(kind="class", cls=Class() as one):
                return Type("instance", cls=one)
            case Type(kind="function", node=ast.FunctionDef() as node):
                return self.annotated(node.returns, kind.module, kind.cls)
            case Type(kind="function", parts=(result,)):
                return result
        return ANY

    # ---- expressions

    def type_of(self, node: ast.expr) -> Type:
        """Return the type of an expression."""
        if node in self._types:
            return self._types[node]
        before = self._cuts
        kind = self._type_of(node)
        # A type that depends on itself, or on names whose types are being inferred, may change.
        if self._cuts == before and not self._unsettled:
            self._types[node] = kind
        return kind

    def _type_of(self, node: ast.expr) -> Type:
        match node:
            case ast.Constant(value=None):
                return NONE
            case ast.Constant(value=value):
                return BASIC.get(type(value).__name__, ANY)
            case ast.JoinedStr():
                return STR
            case ast.Name(id=name):
                return self.name_type(name)
            case ast.Tuple(elts=parts):
                if any(isinstance(part, ast.Starred) for part in parts):
                    return Type("sequence", (union([*self._items(parts)]),))
                return Type("tuple", tuple(map(self.type_of, parts)))
            case ast.List(elts=parts):
                return Type("list", (union([*self._items(parts)]),) if parts else ())
            case ast.Set(elts=parts):
                return Type("set", (union([*self._items(parts)]),))
            case ast.ListComp() | ast.SetComp() | ast.GeneratorExp():
                kind = {"ListComp": "list", "SetComp": "set"}.get(type(node).__name__, "iterator")
                return Type(kind, (self._inside(node.generators, node.elt),))
            case ast.Dict(keys=keys, values=values):
                if None in keys:
                    return Type("dict")
                item_types = [
                    union([self.type_of(one) for one in ones if one]) for ones in (keys, values)
                ]
                return Type("dict", tuple(item_types) if keys else ())
            case ast.DictComp(key=key, value=value):
                parts_ = (self._inside(node.generators, key), self._inside(node.generators, value))
                return Type("dict", parts_)
            case ast.Attribute(value=value, attr=attr):
                return self._attribute_type(value, attr)
            case ast.Call():
                return self._call_type(node)
            case ast.BinOp(left=left, op=op, right=right):
                return self._operation_type(self.type_of(left), op, self.type_of(right))
            case ast.UnaryOp(op=ast.Not()):
                return BOOL
            case ast.UnaryOp(operand=operand):
                inner = self.type_of(operand)
                return inner if inner == NEVER or is_only(inner, "int", "float") else ANY
            case ast.Compare(left=left, ops=ops, comparators=sides):
                types = [self.type_of(one) for one in (left, *sides)]
                is_plain = all(is_only(one, *NUMBERS, "str") for one in types) or not any(
                    isinstance(op, ast.Eq | ast.NotEq | ast.Lt | ast.LtE | ast.Gt | ast.GtE)
                    for op in ops
                )
                return BOOL if is_plain else NEVER if NEVER in types else ANY
            case ast.BoolOp(values=values):
                return union([self.type_of(value) for value in values])
            case ast.IfExp(body=body, orelse=orelse):
                return union([self.type_of(body), self.type_of(orelse)])
            case ast.Lambda():
                return Type("function", node=node, module=self.module)
            case ast.Subscript(value=value, slice=place):
                return self._item_type(self.type_of(value), place)
        return ANY

    def _items(self, parts: list[ast.expr]) -> Iterator[Type]:
        for part in parts:
            if isinstance(part, ast.Starred):
                yield self.item(self.type_of(part.value))
            else:
                yield self.type_of(part)

    def _inside(self, generators: list[ast.comprehension], node: ast.expr) -> Type:
        """Return the type of an expression inside a comprehension."""
        for generator in generators:
            self.enter(self.comprehension_scope(generator))
        kind = self.type_of(node)
        del self.scopes[len(self.scopes) - len(generators) :]
        return kind

    def _attribute_type(self, value: ast.expr, attr: str) -> Type:
        receiver = self.type_of(value)
        if receiver.kind == "module":
            return FLOAT if attr in ("pi", "inf", "nan") else ANY
        types = list[Type]()
        for part in alternatives_of(receiver):
            if part.kind == "none":
                continue
            if part.cls is None:
                return ANY
            if part.cls.member(attr) is None and part.cls.is_enumeration:
                return STR if part.cls.kind != "py.IntEnum" else ANY
            member = part.cls.member(attr)
            if member is not None:
                types.append(self._type_of_member(member, part.cls))
            else:
                types += [
                    self._type_of_member(one, one.owner) for one in self._derived(part.cls, attr)
                ] or [ANY]
        return union(types)

    def _call_type(self, node: ast.Call) -> Type:
        match node.func:
            case ast.Subscript(value=ast.Name("list" | "dict" | "set")):
                return self.annotated(node.func, self.module, self.owner)
            case ast.Name(id="super") if self.owner and self.owner.bases:
                return Type("instance", cls=self.owner.bases[0])
            case ast.Name(id=name) if not self.is_local(name) and self._is_runtime(name):
                return self._runtime_type(name, node.args)
            case ast.Attribute(value=value, attr="_replace" | "model_copy"):
                return self.type_of(value)
            case ast.Attribute(value=ast.Name("math"), attr=attr) if not self.is_local("math"):
                return {"floor": INT, "ceil": INT, "isfinite": BOOL, "isinf": BOOL}.get(attr, FLOAT)
            case ast.Attribute(value=value, attr=attr) if attr in METHODS:
                receiver = self.type_of(value)
                if not is_only(receiver, "instance", "class", "any"):
                    return self._method_type(receiver, attr)
        return union([self.returned(one) for one in alternatives_of(self.type_of(node.func))])

    def _is_runtime(self, name: str) -> bool:
        return self.program.symbol(self.module, name) is None and name in (
            *RETURNS,
            *("abs", "max", "min", "sum", "enumerate", "zip", "sorted", "list", "tuple"),
            *("reversed", "map", "next", "replace", "pairwise", "type"),
        )

    def _runtime_type(self, name: str, args: list[ast.expr]) -> Type:
        """Return the type of the value of one of Python's functions."""
        if name in RETURNS:
            return RETURNS[name]
        types = [self.type_of(one) for one in args if not isinstance(one, ast.Starred)]
        if not types or len(types) < len(args):
            return Type({"list": "list", "tuple": "tuple"}.get(name, "any"))
        item = self.item(types[0])
        match name:
            case "abs" | "replace":
                return types[0]
            case "max" | "min":
                return union(types) if len(types) > 1 else item
            case "sum":
                return item if is_only(item, "int", "float") else ANY
            case "enumerate":
                return Type("iterator", (Type("tuple", (INT, item)),))
            case "zip":
                return Type("iterator", (Type("tuple", tuple(map(self.item, types))),))
            case "pairwise":
                return Type("iterator", (Type("tuple", (item, item)),))
            case "sorted" | "list":
                return Type("list", (item,))
            case "tuple":
                return Type("sequence", (item,))
            case "reversed":
                return Type("iterator", (item,))
            case "next":
                return union([item, *types[1:]])
            case "map":
                return Type("iterator", (self.returned(types[0]),))
            case "type":
                return Type("class", cls=types[0].cls)
        return ANY

    def _method_type(self, receiver: Type, attr: str) -> Type:
        if attr in RETURNS_OF_METHODS:
            return RETURNS_OF_METHODS[attr]
        if is_only(receiver, "dict") and receiver.parts:
            key, value = receiver.parts
            match attr:
                case "items":
                    return Type("iterator", (Type("tuple", (key, value)),))
                case "keys":
                    return Type("iterator", (key,))
                case "values":
                    return Type("iterator", (value,))
        return self.item(receiver) if attr == "pop" else ANY

    def _operation_type(self, left: Type, op: ast.operator, right: Type) -> Type:
        if NEVER in (left, right):
            return NEVER
        if is_only(left, *NUMBERS) and is_only(right, *NUMBERS):
            is_float = "float" in kinds_of(left) | kinds_of(right) or isinstance(op, ast.Div)
            return FLOAT if is_float else INT
        if isinstance(op, ast.Add):
            if is_only(left, "str"):
                return STR
            if is_only(left, "list") and is_only(right, "list"):
                return Type("list", (union([self.item(left), self.item(right)]),))
            if is_only(left, *ROWS) and is_only(right, *ROWS):
                return Type("sequence", (union([self.item(left), self.item(right)]),))
        if isinstance(op, ast.Mult):
            for one, count in ((left, right), (right, left)):
                if is_only(one, *ROWS) and is_only(count, "int"):
                    kind = "list" if is_only(one, "list") else "sequence"
                    return Type(kind, (self.item(one),))
                if is_only(one, "str"):
                    return STR
        return ANY

    def _item_type(self, receiver: Type, place: ast.expr) -> Type:
        if isinstance(place, ast.Slice):
            if is_only(receiver, "tuple", "sequence"):
                return Type("sequence", (self.item(receiver),))
            return receiver if is_only(receiver, "list", "str", "array") else ANY
        if is_only(receiver, "dict"):
            return receiver.parts[1] if receiver.parts else ANY
        try:
            number = ast.literal_eval(place)
        except ValueError:
            number = None
        number = number if isinstance(number, int) else None
        return self.item(receiver) if number is None else self.item(receiver, number)
