"""The names of a function, and which of them are numbers."""

import ast
from collections.abc import Iterator
from dataclasses import dataclass, field

from tippetop.emit.program import names_in, parameters

FLOATS = ("float", "int")
NUMBER = ast.Constant(0.0)
"""Stands for what is a number as it is bound."""


@dataclass
class Scope:
    """The names of a function."""

    names: set[str] = field(default_factory=set)
    """Its parameters, and what it binds."""
    floats: set[str] = field(default_factory=set)
    arrays: set[str] = field(default_factory=set)
    """Names of numbers, and of arrays of them."""
    declared: set[str] = field(default_factory=set)
    """Names that have been declared so far."""

    @classmethod
    def of(cls, node: ast.FunctionDef | ast.Lambda, outer: "Scope") -> "Scope":
        """The scope of a function in another."""
        given = parameters(node) + ([node.args.vararg.arg] if node.args.vararg else [])
        found = cls(set(given), declared=set(given))
        for one in (*node.args.args, *node.args.kwonlyargs):
            said = ast.unparse(one.annotation) if one.annotation else ""
            (found.floats if said in FLOATS else found.arrays if said == "Array" else set()).add(one.arg)
        bound: dict[str, list[ast.expr | None]] = {}
        for inner in within(node) if isinstance(node, ast.FunctionDef) else ():
            for name, value in bindings(inner):
                bound.setdefault(name, []).append(value)
                if isinstance(value, ast.Call) and ast.unparse(value.func) == "np.empty":
                    found.arrays.add(name)
        found.names |= set(bound)
        found.floats |= {name for name in bound if name not in given} | (outer.floats - found.names)
        # All that are not bound to anything but numbers.
        wrong = {""}
        while wrong:
            wrong = {
                name
                for name in found.floats
                if not all(value is not None and found.is_float(value) for value in bound.get(name, ()))
            }
            found.floats -= wrong
        return found

    def with_names(self, names: set[str]) -> "Scope":
        """The scope with other names beside its own."""
        return Scope(self.names | names, self.floats - names, self.arrays - names)

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


def bindings(node: ast.AST) -> Iterator[tuple[str, ast.expr | None]]:
    """The names that a statement itself binds, each with its value, if that may be a number."""
    pairs: list[tuple[ast.expr, ast.expr | None]] = []
    match node:
        case ast.Assign(targets=targets, value=value):
            for target in targets:
                if isinstance(target, ast.Tuple) and isinstance(value, ast.Tuple):
                    pairs += zip(target.elts, value.elts, strict=False)
                else:
                    pairs.append((target, value))
        case ast.AnnAssign(target=target, annotation=annotation):
            pairs = [(target, NUMBER if ast.unparse(annotation) in FLOATS else None)]
        case ast.AugAssign(target=target, value=value):
            pairs = [(target, value)]
        case ast.For(target=target, iter=iterable):
            pairs = [(target, NUMBER if is_range(iterable) else None)]
        case ast.FunctionDef(name=name) | ast.ExceptHandler(name=str(name)):
            pairs = [(ast.Name(name, ast.Store()), None)]
    for target, found in pairs:
        yield from ((name, found if isinstance(target, ast.Name) else None) for name in names_in(target))


def is_range(node: ast.expr) -> bool:
    """Whether an expression is a call of range."""
    return isinstance(node, ast.Call) and ast.unparse(node.func) == "range"


def within(node: ast.AST) -> Iterator[ast.AST]:
    """All that is in a function, but not what is in functions that are in it."""
    for child in ast.iter_child_nodes(node):
        yield child
        if not isinstance(child, ast.FunctionDef | ast.Lambda):
            yield from within(child)
