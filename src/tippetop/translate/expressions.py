"""Python's expressions as JavaScript."""

import ast
import json
from abc import ABC, abstractmethod
from collections.abc import Sequence

from tippetop.translate.program import Program, given, safe

ARROW, OR, AND, BITS, EQUAL, LESS, SUM, PRODUCT, UNARY, ATOM = range(10)
"""How tightly an expression binds."""

ARITHMETIC = {
    ast.Add: ("add", "+", SUM),
    ast.Sub: ("sub", "-", SUM),
    ast.Mult: ("mul", "*", PRODUCT),
    ast.Div: ("div", "/", PRODUCT),
    ast.Pow: ("pow", "", ATOM),
    ast.FloorDiv: ("floordiv", "", ATOM),
    ast.Mod: ("mod", "", ATOM),
    ast.BitOr: ("or", "|", BITS),
    ast.BitAnd: ("and", "&", BITS),
}
COMPARISONS = {ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">="}


class Untranslatable(SyntaxError):
    """Something of Python that the program does not use so far, and the translator does not
    know.
    """


class Expressions(ABC):
    """Translates the expressions of a module.

    Parameters
    ----------
    program
        All modules.
    module
        The name of this one.
    """

    def __init__(self, program: Program, module: str) -> None:
        self.program, self.module = program, module
        self.plain, self.numeric = module in program.plain, module in program.numeric
        self.scopes, self.declared, self.rows = [set[str]()], set[str](), dict[str, str]()

    @abstractmethod
    def call(self, node: ast.Call) -> str:
        """A call."""

    @abstractmethod
    def function(self, node: ast.FunctionDef | ast.Lambda) -> str:
        """The parameters of a function, with their defaults."""

    def refused(self, node: ast.AST) -> Untranslatable:
        """What is said of what is not known."""
        return Untranslatable(f"{self.module}: {ast.unparse(node)}")

    def name(self, name: str) -> str:
        """What a name is called."""
        if any(name in names for names in self.scopes):
            return safe(name)
        if name in ("self", "cls"):
            return "this"
        return self.program.names.get((self.module, name)) or f"py.{safe(name)}"

    def text(self, node: ast.expr, binds: int = ARROW) -> str:
        """An expression, in parentheses where it binds less."""
        found, own = self._found(node)
        return f"({found})" if own < binds else found

    def arguments(self, nodes: Sequence[ast.expr]) -> str:
        """Expressions in a row."""
        return ", ".join(self.text(node) for node in nodes)

    def truth(self, node: ast.expr, binds: int = ARROW) -> str:
        """Whether an expression is true."""
        match node:
            case (
                ast.Compare()
                | ast.UnaryOp(op=ast.Not())
                | ast.Call(func=ast.Name("bool" | "isinstance"))
            ):
                return self.text(node, binds)
            case ast.BoolOp(op=op, values=values):
                sign, own = ("||", OR) if isinstance(op, ast.Or) else ("&&", AND)
                found = f" {sign} ".join(self.truth(value, own + 1) for value in values)
                return f"({found})" if own < binds else found
        return f"py.truth({self.text(node)})"

    def pattern(self, node: ast.expr) -> str:
        """What is bound, or assigned to."""
        match node:
            case ast.Tuple(elts=parts):
                known = ["" if ast.unparse(part) == "_" else self.pattern(part) for part in parts]
                return f"[{', '.join(known).rstrip(', ')}]"
            case ast.Name() | ast.Attribute() | ast.Starred():
                return self.text(node)
        raise self.refused(node)

    def _found(self, node: ast.expr) -> tuple[str, int]:
        """An expression, and how tightly it binds."""
        match node:
            case ast.Constant(value=value):
                return json.dumps(value, ensure_ascii=False), ATOM
            case ast.Name(id=name):
                return self.name(name), ATOM
            case ast.Tuple(elts=parts) | ast.List(elts=parts):
                return f"[{self.arguments(parts)}]", ATOM
            case ast.Starred(value=value):
                return f"...{self.text(value, ATOM)}", ARROW
            case ast.Attribute(value=value, attr=attr) if self.program.is_method(attr):
                return f'py.bound({self.text(value)}, "{attr}")', ATOM
            case ast.Attribute(value=value, attr=attr):
                return f"{self.text(value, ATOM)}.{attr}", ATOM
            case ast.BinOp():
                return self._arithmetic(node)
            case ast.UnaryOp(op=ast.Not(), operand=operand):
                return f"!{self.truth(operand, UNARY)}", UNARY
            case ast.UnaryOp(operand=operand) if self.plain or isinstance(operand, ast.Constant):
                return f"-{self.text(operand, ATOM)}", UNARY
            case ast.UnaryOp(operand=operand):
                return f"py.neg({self.text(operand)})", ATOM
            case ast.BoolOp(op=op, values=values):
                word, found = "or" if isinstance(op, ast.Or) else "and", self.text(values[-1])
                for value in reversed(values[:-1]):
                    found = f"py.{word}({self.text(value)}, () => {found})"
                return found, ATOM
            case ast.Compare():
                return self._comparison(node)
            case ast.IfExp(test=test, body=body, orelse=orelse):
                return (
                    f"{self.truth(test, OR)} ? {self.text(body, OR)} : {self.text(orelse)}",
                    ARROW,
                )
            case ast.JoinedStr(values=values):
                return f"`{''.join(map(self._formatted, values))}`", ATOM
            case ast.Subscript():
                return self._item(node), ATOM
            case ast.Lambda(body=body):
                return f"{self.function(node)} => {self._inside(given(node), body)}", ARROW
            case ast.ListComp(elt=element) | ast.GeneratorExp(elt=element):
                return self._comprehension(node.generators, element), ATOM
            case ast.SetComp(elt=element):
                return f"new Set({self._comprehension(node.generators, element)})", ATOM
            case ast.DictComp(key=key, value=value):
                pair = ast.Tuple([key, value], ast.Load())
                return f"new py.Dict({self._comprehension(node.generators, pair)})", ATOM
            case ast.Dict(keys=keys, values=values):
                pairs = [
                    f"[{self.text(k)}, {self.text(v)}]"
                    if k
                    else f"...{self.text(v, ATOM)}.entries()"
                    for k, v in zip(keys, values, strict=True)
                ]
                return f"new py.Dict([{', '.join(pairs)}])", ATOM
            case ast.Call():
                return self.call(node), ATOM
            case ast.Yield(value=value):
                return f"yield {self.text(value) if value else ''}", ARROW
        raise self.refused(node)

    def _inside(self, names: set[str], body: ast.expr) -> str:
        """An expression where other names hold."""
        self.scopes.append(names)
        found = self.text(body)
        self.scopes.pop()
        return f"({found})" if found.startswith("{") else found

    def _arithmetic(self, node: ast.BinOp) -> tuple[str, int]:
        word, sign, binds = ARITHMETIC[type(node.op)]
        if sign and (binds == BITS or self.numeric or (self.plain and is_of_numbers(node))):
            return f"{self.text(node.left, binds)} {sign} {self.text(node.right, binds + 1)}", binds
        return f"py.{word}({self.text(node.left)}, {self.text(node.right)})", ATOM

    def _comparison(self, node: ast.Compare) -> tuple[str, int]:
        sides = [node.left, *node.comparators]
        found = [
            self._compared(a, op, b) for a, op, b in zip(sides, node.ops, sides[1:], strict=False)
        ]
        if len(found) == 1:
            return found[0]
        return " && ".join(f"({text})" if own < AND else text for text, own in found), AND

    def _compared(self, a: ast.expr, op: ast.cmpop, b: ast.expr) -> tuple[str, int]:
        if type(op) in COMPARISONS:
            return f"{self.text(a, SUM)} {COMPARISONS[type(op)]} {self.text(b, SUM)}", LESS
        left, right = self.text(a, LESS), self.text(b, LESS)
        negated = isinstance(op, ast.NotEq | ast.IsNot | ast.NotIn)  # codespell:ignore
        if isinstance(op, ast.In | ast.NotIn):  # codespell:ignore
            found = f"py.contains({right}, {left})"
        elif (
            self.numeric or isinstance(op, ast.Is | ast.IsNot) or ast.Constant in (type(a), type(b))
        ):
            return f"{left} {'!' if negated else '='}== {right}", EQUAL
        else:
            found = f"py.eq({left}, {right})"
        return (f"!{found}", UNARY) if negated else (found, ATOM)

    def _formatted(self, part: ast.expr) -> str:
        match part:
            case ast.FormattedValue(value=inner, format_spec=None):
                return f"${{py.str({self.text(inner)})}}"
            case ast.FormattedValue(value=inner, format_spec=ast.expr() as spec) if (
                "g'" in ast.unparse(spec)
            ):
                return f'${{py.format({self.text(inner)}, "{ast.unparse(spec)[2:-1]}")}}'
            case ast.Constant(value=text):
                return json.dumps(text)[1:-1].replace("`", "\\`").replace("${", "\\${")
        raise self.refused(part)

    def _item(self, node: ast.Subscript) -> str:
        whole = self.text(node.value, ATOM)
        match node.slice:
            case ast.Slice(lower=low, upper=high, step=None):
                parts = [self.text(low) if low else "0", *([self.text(high)] if high else [])]
                return f"{whole}.slice({', '.join(parts)})"
            case ast.Slice(lower=low, upper=high, step=step):
                parts = [self.text(one) if one else "null" for one in (low, high, step)]
                return f"py.slice({whole}, {', '.join(parts)})"
            case ast.Tuple(elts=places):
                row = f"{whole}[{self.text(places[0])}]"
                return self.rows.get(row, row) + "".join(
                    f"[{self.text(place)}]" for place in places[1:]
                )
            case _ if self.numeric:
                return f"{whole}[{self.text(node.slice)}]"
            case ast.Constant(value=int(number)) if self.module not in self.program.indexed:
                return f"{whole}[{number}]"
        return f"py.item({whole}, {self.text(node.slice)})"

    def _comprehension(self, generators: Sequence[ast.comprehension], element: ast.expr) -> str:
        first, *rest = generators
        whole = self.text(first.iter, ATOM)
        if not whole.startswith(ROWS):
            whole = f"[...{whole}]"
        bound = {n.id for n in ast.walk(first.target) if isinstance(n, ast.Name)}
        self.scopes.append(bound)
        target = self.pattern(first.target)
        for test in first.ifs:
            whole = f"{whole}.filter(({target}) => {self.truth(test)})"
        if rest:
            whole = f"{whole}.flatMap(({target}) => {self._comprehension(rest, element)})"
        elif (inner := self.text(element)) != target:
            whole = f"{whole}.map(({target}) => {inner})"
        self.scopes.pop()
        return whole


def is_of_numbers(node: ast.BinOp) -> bool:
    """Whether an operator means the same in both, of numbers; not of lists, nor where zero may
    divide.
    """
    if isinstance(node.op, ast.Div):
        return isinstance(node.right, ast.Constant)
    return not (is_list(node.left) or is_list(node.right))


def is_list(node: ast.expr) -> bool:
    """Whether an expression is a list that is written there, a part of one, or made of such."""
    if isinstance(node, ast.BinOp):
        return is_list(node.left) or is_list(node.right)
    if isinstance(node, ast.Subscript):
        return isinstance(node.slice, ast.Slice)
    return isinstance(node, ast.List | ast.ListComp | ast.Tuple)


ROWS = ("py.zip(", "py.range(", "py.enumerate(", "py.list(", "[")
"""How what is a list by itself begins."""
