"""Where the names of a function are bound and used, so that each is declared where it is first bound."""

import ast
from collections.abc import Sequence
from dataclasses import dataclass, field

from tippetop.emit.program import names_in, parameters

FLOATS = {"float", "int"}


@dataclass
class Binding:
    """A statement that binds names.

    Attributes
    ----------
    node
        The statement.
    path
        The blocks it is in, outermost first, each by identity of its list.
    """

    node: ast.AST
    path: tuple[int, ...]


@dataclass
class Scope:
    """The names of a function.

    Attributes
    ----------
    parameters
        Names of its parameters.
    bindings
        Where other names are bound.
    uses
        The blocks in which they are used.
    floats
        Names of numbers.
    declared
        The statements that declare names; None for what is declared at the top.
    """

    parameters: list[str] = field(default_factory=list)
    bindings: dict[str, list[Binding]] = field(default_factory=dict)
    uses: dict[str, list[tuple[int, ...]]] = field(default_factory=dict)
    floats: set[str] = field(default_factory=set)
    declared: dict[str, ast.AST | None] = field(default_factory=dict)

    @classmethod
    def of(cls, node: ast.FunctionDef | ast.Lambda) -> "Scope":
        """The scope of a function."""
        found = cls(parameters(node))
        for one in (*node.args.args, *node.args.kwonlyargs):
            if one.annotation is not None and ast.unparse(one.annotation) in FLOATS:
                found.floats.add(one.arg)
        if node.args.vararg:
            found.parameters.append(node.args.vararg.arg)
        if isinstance(node, ast.FunctionDef):
            found._walk_block(node.body, ())
            found._weigh()
            found.declared = {name: found.declared_at(name) for name in found.bindings}
        return found

    def declared_at(self, name: str) -> ast.AST | None:
        """The statement that can declare a name; None if it is to be declared at the top."""
        bindings = self.bindings[name]
        if name in self.parameters:
            return bindings[0].node
        first = bindings[0]
        paths = [binding.path for binding in bindings] + self.uses.get(name, [])
        if isinstance(first.node, (ast.For, ast.NamedExpr)):
            inside = [*first.path, id(first.node.body)] if isinstance(first.node, ast.For) else None
            loops = {id(b.node.body) for b in bindings if isinstance(b.node, ast.For)}
            same = len(bindings) == len(loops)
            within = all(any(step in loops for step in path) for path in self.uses.get(name, []))
            return first.node if inside and same and within else None
        if not isinstance(first.node, (ast.Assign, ast.AnnAssign, ast.FunctionDef)):
            return None
        depth = len(first.path)
        return first.node if all(path[:depth] == first.path for path in paths) else None

    def _bind(self, name: str, node: ast.AST, path: tuple[int, ...]) -> None:
        self.bindings.setdefault(name, []).append(Binding(node, path))

    def _use(self, node: ast.AST, path: tuple[int, ...], hidden: frozenset[str] = frozenset()) -> None:
        """Note the names that an expression uses."""
        match node:
            case ast.Name(id=name):
                if name not in hidden and isinstance(node.ctx, ast.Load):
                    self.uses.setdefault(name, []).append(path)
                return
            case ast.NamedExpr(target=ast.Name(id=name)):
                self._bind(name, node, path)
            case ast.Lambda() | ast.FunctionDef():
                inner = Scope.of(node)
                hidden = hidden | {*inner.parameters, *inner.bindings}
            case ast.ListComp() | ast.GeneratorExp() | ast.DictComp() | ast.SetComp():
                hidden = hidden | {name for one in node.generators for name in names_in(one.target)}
        for child in ast.iter_child_nodes(node):
            self._use(child, path, hidden)

    def _walk_block(self, body: Sequence[ast.stmt], path: tuple[int, ...]) -> None:
        path = (*path, id(body))
        for node in body:
            self._walk(node, path)

    def _walk(self, node: ast.stmt, path: tuple[int, ...]) -> None:
        match node:
            case ast.FunctionDef(name=name):
                self._bind(name, node, path)
                self._use(node, path)
            case ast.Assign(targets=targets, value=value):
                self._use(value, path)
                for target in targets:
                    self._use(target, path)
                    for name in names_in(target):
                        self._bind(name, node, path)
            case ast.AnnAssign(target=target):
                if node.value is not None:
                    self._use(node.value, path)
                for name in names_in(target):
                    self._bind(name, node, path)
            case ast.AugAssign(target=target, value=value):
                self._use(value, path)
                if isinstance(target, ast.Name):
                    self._bind(target.id, node, path)
                    self.uses.setdefault(target.id, []).append(path)
                else:
                    self._use(target, path)
            case ast.For(target=target, iter=iterable, body=body, orelse=orelse):
                self._use(iterable, path)
                for name in names_in(target):
                    self._bind(name, node, (*path, id(body)))
                self._walk_block(body, path)
                self._walk_block(orelse, path)
            case ast.If(test=test, body=body, orelse=orelse) | ast.While(test=test, body=body, orelse=orelse):
                self._use(test, path)
                self._walk_block(body, path)
                self._walk_block(orelse, path)
            case ast.Try(body=body, handlers=handlers):
                self._walk_block(body, path)
                for handler in handlers:
                    self._walk_block(handler.body, path)
            case ast.Match(subject=subject, cases=cases):
                self._use(subject, path)
                for case in cases:
                    self._walk_block(case.body, path)
            case _:
                self._use(node, path)

    def _weigh(self) -> None:
        """Find the names that are bound to numbers alone: all that are not bound to anything else."""
        known = [name for name in self.bindings if name not in self.parameters]
        self.floats.update(known)
        before = -1
        while before != len(self.floats):
            before = len(self.floats)
            for name, bindings in self.bindings.items():
                if not all(self._is_number(name, binding.node) for binding in bindings):
                    self.floats.discard(name)

    def _is_number(self, name: str, node: ast.AST) -> bool:
        """Whether a statement binds a name to a number."""
        match node:
            case ast.Assign(targets=targets, value=value):
                for target in targets:
                    pairs = [(target, value)]
                    if isinstance(target, ast.Tuple) and isinstance(value, ast.Tuple):
                        pairs = list(zip(target.elts, value.elts, strict=False))
                    for one, part in pairs:
                        if name in names_in(one) and not (isinstance(one, ast.Name) and self.is_float(part)):
                            return False
                return True
            case ast.AnnAssign(annotation=annotation):
                return ast.unparse(annotation) in FLOATS
            case ast.AugAssign(value=value):
                return self.is_float(value)
            case ast.For(target=ast.Name(), iter=iterable):
                return is_range(iterable)
        return False

    def is_float(self, node: ast.expr) -> bool:
        """Whether an expression surely is a number, and neither a series nor a node."""
        match node:
            case ast.Constant(value=value):
                return isinstance(value, (int, float)) and not isinstance(value, bool)
            case ast.Name(id=name):
                return name in self.floats
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                return self.is_float(operand)
            case ast.BinOp(left=left, right=right):
                return self.is_float(left) and self.is_float(right)
            case ast.Call(func=ast.Name(id="len" | "float" | "int")):
                return True
            case ast.Call(func=ast.Attribute(value=ast.Name(id="math"))):
                return True
        return False


def is_range(node: ast.expr) -> bool:
    """Whether an expression is a call of range."""
    return isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "range"
