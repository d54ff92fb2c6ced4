"""Translation of calls, and of the parameters of functions."""

import ast
from collections.abc import Sequence
from functools import reduce

from tippetop.translate.expressions import ATOM, Expressions
from tippetop.translate.runtime_names import ERRORS, FUNCTIONS, METHODS
from tippetop.translate.symbols import Class, Member, parameters, safe
from tippetop.translate.types import ROWS, Type, alternatives_of, is_only

BY_NAME = {"max": {"key", "default"}, "min": {"key", "default"}, "sorted": {"key"}}
"""Keyword arguments that the runtime takes in an object after the other arguments."""

OF_TWO = {"max": "larger", "min": "smaller"}
"""The runtime's functions of two values."""


class Calls(Expressions):
    """Translates the calls of a module, and the parameters of functions."""

    def call(self, node: ast.Call) -> str:
        """Return a call."""
        if any(word.arg is None for word in node.keywords):
            raise self.refusal(node, "arguments by ** are not translated")
        match node.func:
            case ast.Attribute(value=ast.Call(func=ast.Name(id="super")), attr=attr):
                return f"super{'' if attr == '__init__' else '.' + attr}({self._placed(node)})"
            case ast.Attribute(value=ast.Name(id="math" | "np" | "cmath" as name)) if (
                not self.is_local(name)
            ):
                if node.keywords:
                    raise self.refusal(node, f"functions of {name} take no keywords here")
                return f"{self.text(node.func)}({self._placed(node)})"
            case ast.Attribute():
                return self._method_call(node, node.func)
            case ast.Name(id=name) if not self.is_local(name) and name not in ("self", "cls"):
                text = self.name(node.func)
                if text.removeprefix("py.") in ERRORS:
                    return f"new {text}({self._placed(node)})"
                if text == f"py.{name}" or text == "py.replace":
                    return self._runtime_call(node, text.removeprefix("py."))
            case ast.Subscript(value=ast.Name(id="list" | "dict" | "set" as word)):
                return f"py.{word}({self.arguments(node.args)})"
        kinds = alternatives_of(self.type_of(node.func))
        classes = [kind.cls for kind in kinds if kind.kind == "class"]
        if classes and len(classes) < len(kinds):
            raise self.refusal(node, "either a class or a function is called")
        for one in classes:
            if one is not None and one.is_enumeration:
                raise self.refusal(node, f"{one.node.name} is looked up by value; name its member")
        if classes:
            return self._construction(node, [one for one in classes if one is not None])
        return f"{self.text(node.func, ATOM)}({self._placed(node)})"

    def function(self, node: ast.FunctionDef | ast.Lambda) -> str:
        """Return the parameters of a function; defaults are evaluated in the enclosing scope."""
        if node.args.kwarg:
            raise self.refusal(node, "parameters by ** are not translated")
        args = [*node.args.posonlyargs, *node.args.args]
        defaults: list[ast.expr | None] = [None] * (len(args) - len(node.args.defaults))
        pairs = [*zip(args, [*defaults, *node.args.defaults], strict=True)]
        pairs += zip(node.args.kwonlyargs, node.args.kw_defaults, strict=True)
        names = list[str]()
        for arg, default in pairs:
            if arg.arg not in ("self", "cls") or arg is not args[0]:
                name = safe(arg.arg) + ("_" if arg.arg in names else "")
                names.append(name if default is None else f"{name} = {self.default(default)}")
        if node.args.vararg:
            names.append(f"...{safe(node.args.vararg.arg)}")
        return f"({', '.join(names)})"

    def default(self, node: ast.expr) -> str:
        """Return a default value; JavaScript evaluates it at every call, Python once."""
        for inner in ast.walk(node):
            mutable = ast.List | ast.Dict | ast.Set | ast.ListComp | ast.DictComp | ast.SetComp
            is_made = isinstance(inner, ast.Call) and not self._makes_record(inner)
            if isinstance(inner, mutable) or is_made:
                raise self.refusal(node, "a default must be a constant, a tuple or a record")
            if isinstance(inner, ast.Name) and self.is_local(inner.id):
                reason = "a default that reads a name of a function is read at every call"
                raise self.refusal(node, reason)
        return self.text(node)

    def _makes_record(self, node: ast.Call) -> bool:
        cls = self.type_of(node.func).cls
        return cls is not None and cls.kind in ("py.NamedTuple", "py.Record")

    # ---- kinds of calls

    def _construction(self, node: ast.Call, classes: list[Class]) -> str:
        """Return an object of a class."""
        parts = [one for one in classes if one.kind == "Part"]
        if parts:
            if node.args:
                raise self.refusal(node, "the fields of a part are passed by name")
            return f"new {self.text(node.func)}({self._named(node.keywords)})"
        orders = [list(one.fields) for one in classes]
        is_name = isinstance(node.func, ast.Name | ast.Attribute)
        head = self.text(node.func) if is_name else f"({self.text(node.func)})"
        return f"new {head}({self._placed(node, orders)})"

    def _method_call(self, node: ast.Call, function: ast.Attribute) -> str:
        receiver, attr = self.type_of(function.value), function.attr
        value = self.text(function.value, ATOM)
        if attr == "_replace":
            return self._replacement(node, function.value)
        members = self.members(receiver, attr)
        is_builtin = is_only(
            receiver, *ROWS, "str", "set", "dict", "iterator", "array", "int", "float"
        )
        if attr in METHODS and (is_builtin or not members):
            return self._builtin_call(node, function)
        if not members:
            raise self.refusal(node, f"{self._described(receiver)} has no '{attr}'")
        makers = [self._makes(member, receiver) for member in members]
        if any(makers):
            if not all(makers):
                raise self.refusal(node, f"'{attr}' is a class of one class, a function of another")
            return f"new {value}.{attr}({self._placed(node)})"
        is_static = any(member.form == "static method" for member in members)
        if is_static and receiver.kind != "class":
            raise self.refusal(node, f"'{attr}' is called through an object, not its class")
        orders = [
            parameters(member.node)
            for member in members
            if member.node is not None and member.is_method
        ]
        return f"{value}.{attr}({self._placed(node, orders)})"

    def _makes(self, member: Member, receiver: Type) -> bool:
        """Return whether a member is a class."""
        owner = receiver.cls if receiver.cls and member.owner in _lineage(receiver.cls) else None
        return self._type_of_member(member, owner or member.owner).kind == "class"

    def _builtin_call(self, node: ast.Call, function: ast.Attribute) -> str:
        template, least, most = METHODS[function.attr]
        count = len(node.args)
        if node.keywords or not least <= count <= most:
            allowed = least if least == most else f"{least} to {most}"
            raise self.refusal(node, f"'{function.attr}' takes {allowed} arguments in JavaScript")
        value = self.text(function.value, ATOM)
        return template.format(value, self.arguments(node.args)).replace(", )", ")")

    def _replacement(self, node: ast.Call, value: ast.expr) -> str:
        """Return a copy of a record with new values of some fields."""
        kinds = [kind for kind in alternatives_of(self.type_of(value)) if kind.cls is not None]
        for word in node.keywords:
            if kinds and not any(self._has_field(kind.cls, str(word.arg)) for kind in kinds):
                raise self.refusal(node, f"{self._described(kinds[0])} has no '{word.arg}'")
        return f"py.replace({self.text(value)}, {self._named(node.keywords)})"

    def _has_field(self, one: Class | None, name: str) -> bool:
        """Return whether records of a class, or of a class derived from it, have a field."""
        return one is not None and (
            name in one.fields
            or any(derived.is_a(one) and name in derived.fields for derived in self.program.classes)
            or one.kind == "protocol"
        )

    def _runtime_call(self, node: ast.Call, name: str) -> str:
        """Return a call of one of Python's functions."""
        args, words = node.args, {str(word.arg) for word in node.keywords}
        match name:
            case "abs" if self.numbers:
                return f"Math.abs({self.arguments(args)})"
            case "replace":
                return self._replacement(node, args[0])
            case "len" if self.arrays:
                return f"{self.text(args[0])}.length"
            case "max" | "min" if are_separate(node):
                return reduce(lambda a, b: f"py.{OF_TWO[name]}({a}, {b})", map(self.text, args))
            case "isinstance":
                self._require_classes(node, args[1])
            case "str" | "repr":
                self.require_words(args[0])
            case "next" if isinstance(args[0], ast.Name):
                raise self.refusal(node, "a second value of an iterator cannot be asked for")
            case "zip":
                if words - {"strict"}:
                    raise self.refusal(node, "zip takes no keyword but strict")
                if any(ast.unparse(word.value) == "True" for word in node.keywords):
                    return f"py.zip_equal({self.arguments(args)})"
                return f"py.zip({self.arguments(args)})"
        if name in BY_NAME and words:
            if words - BY_NAME[name]:
                raise self.refusal(node, f"{name} takes {' and '.join(sorted(BY_NAME[name]))} only")
            return f"py.{name}({self.arguments(args)}, {self._named(node.keywords)})"
        order = FUNCTIONS.get(name) or self._order_of(name)
        return f"py.{name}({self._placed(node, [list(order)])})"

    def _order_of(self, name: str) -> list[str]:
        symbol = self.program.symbol(self.module, name)
        node = symbol.node if symbol else None
        return parameters(node) if isinstance(node, ast.FunctionDef) else []

    def _require_classes(self, node: ast.Call, classes: ast.expr) -> None:
        """Refuse type checks that JavaScript cannot make."""
        parts = classes.elts if isinstance(classes, ast.Tuple) else [classes]
        names = {ast.unparse(part) for part in parts}
        if isinstance(classes, ast.BinOp):
            raise self.refusal(node, "isinstance takes a class or a tuple of classes")
        if names & {"int", "float"} and not {"int", "float"} <= names:
            raise self.refusal(node, "JavaScript does not tell int from float; ask for both")
        if names & {"list"}:
            raise self.refusal(node, "JavaScript does not tell lists from tuples")

    # ---- arguments

    def _named(self, keywords: Sequence[ast.keyword]) -> str:
        """Return keyword arguments as an object."""
        return f"{{ {', '.join(f'{word.arg}: {self.text(word.value)}' for word in keywords)} }}"

    def _placed(self, node: ast.Call, orders: list[list[str]] | None = None) -> str:
        """Return the arguments of a call in order, those by name in their places.

        `orders` has the parameters of each function that may be called; without it they are
        inferred from the type of the function.
        """
        texts = [self.text(one) for one in node.args]
        words = {str(word.arg): word.value for word in node.keywords}
        if not words:
            return ", ".join(texts)
        if any(isinstance(one, ast.Starred) for one in node.args):
            raise self.refusal(node, "arguments by name after * are not translated")
        if orders is None:
            orders = [
                parameters(kind.node)
                for kind in alternatives_of(self.type_of(node.func))
                if kind.node is not None
            ]
        fitting = [order for order in orders if words.keys() <= set(order)]
        if not fitting or (len(fitting) < len(orders) and len(orders) == 1):
            raise self.refusal(node, f"nothing that is called takes {', '.join(sorted(words))}")
        if len({tuple(order.index(word) for word in sorted(words)) for order in fitting}) != 1:
            reason = "several classes have such a method, with parameters in different orders"
            raise self.refusal(node, f"{reason}; annotate the object")
        order = fitting[0]
        between = order[len(texts) : max(map(order.index, words)) + 1]
        texts += [self.text(words[one]) if one in words else "undefined" for one in between]
        return ", ".join(texts)


def _lineage(one: Class) -> list[Class]:
    """Return a class with all its bases."""
    return [one, *(above for base in one.bases for above in _lineage(base))]


def are_separate(node: ast.Call) -> bool:
    """Return whether a call has several arguments by position, and none by name or star."""
    return (
        len(node.args) > 1
        and not node.keywords
        and not any(isinstance(a, ast.Starred) for a in node.args)
    )
