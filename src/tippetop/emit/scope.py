"""Where the names of a function are declared, and which of them are numbers."""

import ast
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

from tippetop.emit.program import names_in, parameters

FLOATS = {"float", "int"}


@dataclass
class Scope:
    """The names of a function."""

    parameters: list[str] = field(default_factory=list)
    """Names of its parameters."""
    bindings: dict[str, list[ast.AST]] = field(default_factory=dict)
    """What binds other names, and binds parameters anew."""
    floats: set[str] = field(default_factory=set)
    arrays: set[str] = field(default_factory=set)
    """Names of numbers, and of arrays of them."""
    declared: dict[str, Sequence[ast.AST]] = field(default_factory=dict)
    """The statements that declare names; none for what is declared at the top."""

    @classmethod
    def of(cls, node: ast.FunctionDef | ast.Lambda) -> "Scope":
        """The scope of a function."""
        found = cls(parameters(node) + ([node.args.vararg.arg] if node.args.vararg else []))
        for given in (*node.args.args, *node.args.kwonlyargs):
            said = ast.unparse(given.annotation) if given.annotation else ""
            if said in FLOATS:
                found.floats.add(given.arg)
            if said == "Array":
                found.arrays.add(given.arg)
        if isinstance(node, ast.FunctionDef):
            for one in within(node):
                for name in bound_by(one):
                    found.bindings.setdefault(name, []).append(one)
                if isinstance(one, ast.Assign):
                    found.arrays |= {target.id for target, value in pairs_of(one) if is_room(target, value)}
            found._weigh()
            total = Counter(uses(node.body))
            for name, bindings in found.bindings.items():
                loops = [one for one in bindings if isinstance(one, ast.For)]
                if loops == bindings and Counter(uses(loops))[name] == total[name]:
                    found.declared[name] = loops
            found._place(node.body, total)
            found._settle()
        return found

    def fresh(self, node: ast.AST) -> bool:
        """Whether a statement declares the names that it binds."""
        return any(node in self.declared.get(name, ()) for name in bound_by(node))

    def word(self, node: ast.AST) -> str:
        """By what a statement declares the names that it binds; nothing if it does not."""
        if not self.fresh(node):
            return ""
        once = all(len(self.bindings[name]) == len(self.declared[name]) for name in bound_by(node))
        return "const " if once else "let "

    def _place(self, body: Sequence[ast.stmt], total: Counter[str]) -> None:
        """Find what declares the names that no other block knows: inner blocks first."""
        for node in body:
            for block in blocks(node):
                self._place(block, total)
        known = [(node, Counter(uses([node]))) for node in body]
        for name in self.bindings:
            where = [node for node, found in known if found[name]]
            if name in self.declared or sum(found[name] for _, found in known) < total[name]:
                continue
            self.declared[name] = []
            if name in self.parameters or name in ("self", "cls"):
                continue
            # A function may speak of what is only known when it is called.
            first = next(n for n in where if name in bound_by(n) or not isinstance(n, ast.FunctionDef))
            if isinstance(first, DECLARES) and name in bound_by(first):
                self.declared[name] = [first]

    def _settle(self) -> None:
        """Declare at the top what stands beside names that are declared elsewhere."""
        moved = True
        while moved:
            moved = False
            for name, where in self.declared.items():
                if any(node not in self.declared[other] for node in where for other in bound_by(node)):
                    self.declared[name], moved = [], True

    def _weigh(self) -> None:
        """Find the names that are bound to numbers alone: all that are not bound to anything else."""
        known = [name for name in self.bindings if name not in self.parameters]
        self.floats.update(known)
        before = -1
        while before != len(self.floats):
            before = len(self.floats)
            for name, bindings in self.bindings.items():
                if not all(self._is_number(name, node) for node in bindings):
                    self.floats.discard(name)

    def _is_number(self, name: str, node: ast.AST) -> bool:
        """Whether a statement binds a name to a number."""
        match node:
            case ast.Assign():
                pairs = [pair for pair in pairs_of(node) if name in names_in(pair[0])]
                return all(isinstance(target, ast.Name) and self.is_float(value) for target, value in pairs)
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
            case ast.IfExp(body=body, orelse=orelse):
                return self.is_float(body) and self.is_float(orelse)
            case ast.Subscript(value=ast.Name(id=name)):
                return name in self.arrays
            case ast.Call(func=ast.Name(id="len" | "float" | "int")):
                return True
            case ast.Call(func=ast.Name(id="abs" | "max" | "min"), args=args):
                return all(self.is_float(one) for one in args)
            case ast.Call(func=ast.Attribute(value=ast.Name(id="math"))):
                return True
        return False


def is_range(node: ast.expr) -> bool:
    """Whether an expression is a call of range."""
    return isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "range"


DECLARES = (ast.Assign, ast.AnnAssign, ast.FunctionDef)
"""What can declare names for the statements after it."""


def within(node: ast.AST) -> Iterator[ast.AST]:
    """All that is in a function, but not what is in functions that are in it."""
    for child in ast.iter_child_nodes(node):
        yield child
        if not isinstance(child, ast.FunctionDef | ast.Lambda):
            yield from within(child)


def bound_by(node: ast.AST) -> list[str]:
    """The names that a statement or expression itself binds."""
    found: list[str] = []
    match node:
        case ast.Assign(targets=targets):
            found = [name for target in targets for name in names_in(target)]
        case ast.AnnAssign(target=target) | ast.AugAssign(target=target) | ast.For(target=target):
            found = names_in(target)
        case ast.NamedExpr(target=target):
            found = names_in(target)
        case ast.FunctionDef(name=name):
            found = [name]
    return [name for name in found if name != "_"]


def pairs_of(node: ast.Assign) -> Iterator[tuple[Any, ast.expr]]:
    """What is bound, or assigned to, with its value: one by one where both are rows."""
    for target in node.targets:
        if isinstance(target, ast.Tuple) and isinstance(node.value, ast.Tuple):
            yield from zip(target.elts, node.value.elts, strict=False)
        else:
            yield target, node.value


def is_room(target: ast.expr, value: ast.expr) -> bool:
    """Whether a name is bound to an array that is to be filled."""
    return (
        isinstance(target, ast.Name) and isinstance(value, ast.Call) and ast.unparse(value.func) == "np.empty"
    )


def uses(nodes: Iterable[ast.AST], hidden: Sequence[str] = ()) -> Iterator[str]:
    """The names in statements and in all that is in them, as often as they are there."""
    for node in nodes:
        own = list(hidden)
        match node:
            case ast.Name(id=name) | ast.FunctionDef(name=name) if name not in hidden:
                yield name
        match node:
            case ast.Lambda() | ast.FunctionDef():
                own += [*parameters(node), *(name for one in within(node) for name in bound_by(one))]
            case ast.ListComp() | ast.GeneratorExp() | ast.DictComp():
                own += [name for one in node.generators for name in names_in(one.target)]
        yield from uses(ast.iter_child_nodes(node), own)


def blocks(node: ast.stmt) -> Iterator[list[ast.stmt]]:
    """The blocks of a statement."""
    if not isinstance(node, ast.FunctionDef):
        for part in [node, *getattr(node, "handlers", []), *getattr(node, "cases", [])]:
            yield from (getattr(part, name) for name in ("body", "orelse") if getattr(part, name, None))
