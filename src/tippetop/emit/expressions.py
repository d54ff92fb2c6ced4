"""Python's expressions as JavaScript."""

import ast
import json
from collections.abc import Sequence

from tippetop.emit.calls import Calls
from tippetop.emit.program import safe
from tippetop.emit.scope import Scope
from tippetop.emit.translator import (
    AND,
    ARROW,
    ATOM,
    BITS,
    EQUAL,
    LESS,
    OR,
    PRODUCT,
    SUM,
    UNARY,
    Untranslatable,
)

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


class Expressions(Calls):
    """Translates the expressions of a module."""

    def text(self, node: ast.expr, binds: int = ARROW) -> str:
        """An expression, in parentheses where it binds less."""
        found, own = self._found(node)
        return f"({found})" if own < binds else found

    def truth(self, node: ast.expr, binds: int = ARROW) -> str:
        """Whether an expression is true."""
        match node:
            case (
                ast.Compare() | ast.UnaryOp(op=ast.Not()) | ast.Call(func=ast.Name(id="bool" | "isinstance"))
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
            case ast.Name(id=name):
                return self.name(name)
            case ast.Tuple(elts=parts) | ast.List(elts=parts):
                known = ["" if is_unused(part) else self.pattern(part) for part in parts]
                while known and not known[-1]:
                    known.pop()
                return f"[{', '.join(known)}]"
            case ast.Starred(value=value):
                return f"...{self.pattern(value)}"
        return self.text(node)

    def is_array(self, node: ast.expr) -> bool:
        """Whether an expression is an array of numbers."""
        return isinstance(node, ast.Name) and any(node.id in scope.arrays for scope in self.scopes[-1:])

    def among_arrays(self, node: ast.expr) -> bool:
        """Whether an expression is a number in a function of arrays of numbers, where nothing is an error."""
        return self._is_float(node) and any(scope.arrays for scope in self.scopes[-1:])

    def _is_float(self, node: ast.expr) -> bool:
        return any(scope.is_float(node) for scope in self.scopes[-1:]) or is_number(node)

    def _found(self, node: ast.expr) -> tuple[str, int]:
        """An expression, and how tightly it binds."""
        match node:
            case ast.Constant(value=value):
                return constant(value), ATOM
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
            case ast.BinOp(left=ast.Dict() as left, op=ast.BitOr(), right=right):
                return f"{self.text(left)}.__or__({self.text(right)})", ATOM
            case ast.BinOp():
                return self._arithmetic(node)
            case ast.UnaryOp(op=ast.Not(), operand=operand):
                return f"!{self.truth(operand, UNARY)}", UNARY
            case ast.UnaryOp(operand=operand):
                if self._is_float(operand):
                    return f"-{self.text(operand, ATOM)}", UNARY
                return f"py.neg({self.text(operand)})", ATOM
            case ast.BoolOp(op=op, values=values):
                word = "or" if isinstance(op, ast.Or) else "and"
                found = self.text(values[-1])
                for value in reversed(values[:-1]):
                    found = f"py.{word}({self.text(value)}, () => {found})"
                return found, ATOM
            case ast.Compare():
                return self._comparison(node)
            case ast.IfExp(test=test, body=body, orelse=orelse):
                return f"{self.truth(test, OR)} ? {self.text(body, OR)} : {self.text(orelse)}", ARROW
            case ast.NamedExpr(target=target, value=value):
                return f"({self.pattern(target)} = {self.text(value)})", ATOM
            case ast.JoinedStr(values=values):
                return self._formatted(values), ATOM
            case ast.Subscript():
                return self._item(node), ATOM
            case ast.Lambda(body=body):
                with_body = self.function(node)
                inner = self.inside(node, body)
                return f"{with_body} => {f'({inner})' if inner.startswith('{') else inner}", ARROW
            case ast.ListComp() | ast.GeneratorExp() | ast.DictComp() | ast.Dict():
                return self._collection(node), ATOM
            case ast.Call():
                return self.call(node), ATOM
            case ast.Yield(value=value):
                return f"yield {self.text(value) if value else ''}", ARROW
        raise Untranslatable(f"{self.module}: {ast.unparse(node)}")

    def _collection(self, node: ast.ListComp | ast.GeneratorExp | ast.DictComp | ast.Dict) -> str:
        match node:
            case ast.ListComp(elt=element) | ast.GeneratorExp(elt=element):
                return self._comprehension(node.generators, element)
            case ast.DictComp(key=key, value=value):
                pair = ast.Tuple([key, value], ast.Load())
                return f"new py.Dict({self._comprehension(node.generators, pair)})"
            case ast.Dict(keys=keys, values=values):
                pairs = [
                    f"[{self.text(k)}, {self.text(v)}]" if k else f"...{self.text(v, ATOM)}.items()"
                    for k, v in zip(keys, values, strict=True)
                ]
                return f"new py.Dict([{', '.join(pairs)}])"

    def function(self, node: ast.FunctionDef | ast.Lambda) -> str:
        """The parameters of a function, with their defaults, which are seen from outside."""
        given = [*node.args.posonlyargs, *node.args.args]
        defaults: list[ast.expr | None] = [None] * (len(given) - len(node.args.defaults))
        pairs = [*zip(given, [*defaults, *node.args.defaults], strict=True)]
        pairs += zip(node.args.kwonlyargs, node.args.kw_defaults, strict=True)
        names, seen = [], set[str]()
        for one, default in pairs:
            if one.arg in ("self", "cls") and one is given[0]:
                continue
            name = safe(one.arg) + ("_" if one.arg in seen else "")
            seen.add(one.arg)
            names.append(name if default is None else f"{name} = {self.text(default)}")
        if node.args.vararg:
            names.append(f"...{safe(node.args.vararg.arg)}")
        return f"({', '.join(names)})"

    def inside(self, node: ast.Lambda, body: ast.expr) -> str:
        """The value of a function of one expression."""
        self.scopes.append(Scope.of(node))
        found = self.text(body)
        self.scopes.pop()
        return found

    def _arithmetic(self, node: ast.BinOp) -> tuple[str, int]:
        word, sign, binds = ARITHMETIC[type(node.op)]
        plain = self._is_float(node.left) and self._is_float(node.right)
        if isinstance(node.op, ast.Div) and not self.among_arrays(node):
            plain = plain and isinstance(node.right, ast.Constant) and bool(node.right.value)
        if sign and (plain or binds == BITS):
            return f"{self.text(node.left, binds)} {sign} {self.text(node.right, binds + 1)}", binds
        return f"py.{word}({self.text(node.left)}, {self.text(node.right)})", ATOM

    def _comparison(self, node: ast.Compare) -> tuple[str, int]:
        sides = [node.left, *node.comparators]
        found = [self._compared(a, op, b) for a, op, b in zip(sides, node.ops, sides[1:], strict=False)]
        if len(found) == 1:
            return found[0]
        return " && ".join(f"({text})" if own < AND else text for text, own in found), AND

    def _compared(self, a: ast.expr, op: ast.cmpop, b: ast.expr) -> tuple[str, int]:
        if type(op) in COMPARISONS:
            return f"{self.text(a, SUM)} {COMPARISONS[type(op)]} {self.text(b, SUM)}", LESS
        left, right = self.text(a, LESS), self.text(b, LESS)
        plain = any(isinstance(one, ast.Constant) for one in (a, b)) or isinstance(op, (ast.Is, ast.IsNot))
        plain = plain or (self._is_float(a) and self._is_float(b))
        match op:
            case ast.Eq() | ast.Is():
                return (f"{left} === {right}", EQUAL) if plain else (f"py.eq({left}, {right})", ATOM)
            case ast.NotEq() | ast.IsNot():
                return (f"{left} !== {right}", EQUAL) if plain else (f"!py.eq({left}, {right})", UNARY)
            case ast.In():
                return f"py.contains({right}, {left})", ATOM
            case ast.NotIn():  # codespell:ignore
                return f"!py.contains({right}, {left})", UNARY
        raise Untranslatable(f"{self.module}: {ast.dump(op)}")

    def _formatted(self, values: Sequence[ast.expr]) -> str:
        found = []
        for value in values:
            match value:
                case ast.Constant(value=str(text)):
                    found.append(json.dumps(text)[1:-1].replace("`", "\\`").replace("${", "\\${"))
                case ast.FormattedValue(value=inner, format_spec=spec):
                    how = ast.unparse(spec)[2:-1] if spec else ""
                    said = f'py.format({self.text(inner)}, "{how}")' if how else f"py.str({self.text(inner)})"
                    found.append("${" + said + "}")
        return f"`{''.join(found)}`"

    def _item(self, node: ast.Subscript) -> str:
        whole = self.text(node.value, ATOM)
        match node.slice:
            case ast.Slice(lower=low, upper=high, step=step):
                if step is None and not any(negative(one) for one in (low, high)):
                    parts = [self.text(low) if low else "0", *([self.text(high)] if high else [])]
                    return f"{whole}.slice({', '.join(parts)})"
                parts = [self.text(one) if one else "null" for one in (low, high, step)]
                return f"py.slice({whole}, {', '.join(parts)})"
            case ast.Tuple(elts=places):
                row = f"{whole}[{self.text(places[0])}]"
                return self.rows.get(row, row) + "".join(f"[{self.text(place)}]" for place in places[1:])
            case _ if self.is_array(node.value):
                return f"{whole}[{self.text(node.slice)}]"
            case ast.Constant(value=int(number)) if self.module not in self.program.indexed:
                return f"{whole}[{number}]"
        return f"py.item({whole}, {self.text(node.slice)})"

    def _comprehension(self, generators: Sequence[ast.comprehension], element: ast.expr) -> str:
        first, rest = generators[0], generators[1:]
        whole = self.text(first.iter, ATOM)
        if not whole.startswith(("py.zip(", "py.range(", "py.enumerate(", "py.list(", "[")):
            whole = f"[...{whole}]"
        bound = {n.id for n in ast.walk(first.target) if isinstance(n, ast.Name)}
        self.hidden.append(bound)
        target = self.pattern(first.target)
        if isinstance(first.target, ast.Name):
            target = "" if is_unused(first.target) else target
        for test in first.ifs:
            whole = f"{whole}.filter(({target}) => {self.truth(test)})"
        if rest:
            whole = f"{whole}.flatMap(({target}) => {self._comprehension(rest, element)})"
        elif self.text(element) != target or first.ifs == []:
            inner = self.text(element)
            whole = whole if inner == target else f"{whole}.map(({target}) => {inner})"
        self.hidden.pop()
        return whole


def constant(value: object) -> str:
    """A constant."""
    match value:
        case None:
            return "null"
        case bool():
            return "true" if value else "false"
        case str():
            return json.dumps(value, ensure_ascii=False)
        case float():
            return repr(value)
    return str(value)


def is_number(node: ast.expr) -> bool:
    """Whether an expression is a number as it stands."""
    match node:
        case ast.Constant(value=value):
            return isinstance(value, (int, float)) and not isinstance(value, bool)
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            return is_number(operand)
        case ast.BinOp(left=left, right=right):
            return is_number(left) and is_number(right)
    return False


def negative(node: ast.expr | None) -> bool:
    """Whether an index may count from the end."""
    return not (node is None or isinstance(node, (ast.Constant, ast.Name, ast.Attribute)))


def is_unused(node: ast.expr) -> bool:
    """Whether it is the name of what nobody asks for."""
    return isinstance(node, ast.Name) and node.id == "_"
