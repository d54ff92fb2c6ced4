"""Python's expressions as JavaScript."""

import ast
import json
from collections.abc import Sequence

from tippetop.emit.program import Program, safe
from tippetop.emit.scope import Scope

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
STRINGS = {
    "startswith": "startsWith",
    "endswith": "endsWith",
    "lower": "toLowerCase",
    "append": "push",
    "index": "indexOf",
}
METHODS = {"removeprefix", "rpartition", "partition", "tolist", "join", "extend", "pop", "setdefault"}
"""Methods of Python's own types that are functions of the runtime."""


class Untranslatable(SyntaxError):
    """Something of Python that the program does not use so far, and the translator does not know."""


class Expressions:
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
        self.scopes: list[Scope] = []
        self.hidden: list[set[str]] = []
        self.locals: dict[str, list[str]] = {}
        self.rebound = False

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

    def name(self, name: str) -> str:
        """What a name is called."""
        if any(name in hidden for hidden in self.hidden) or any(
            name in scope.bindings or name in scope.parameters for scope in self.scopes
        ):
            return safe(name)
        if name in ("self", "cls"):
            return "self" if self.rebound else "this"
        known = self.program.resolve(self.module, name)
        return known if known is not None else f"py.{safe(name)}"

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

    def arguments(self, nodes: Sequence[ast.expr]) -> str:
        """Expressions in a row."""
        return ", ".join(self.text(node) for node in nodes)

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
            case ast.ListComp(elt=element) | ast.GeneratorExp(elt=element):
                return self._comprehension(node.generators, element), ATOM
            case ast.SetComp(elt=element):
                return f"new py.Dict({self._comprehension(node.generators, element)})", ATOM
            case ast.DictComp(key=key, value=value):
                pair = ast.Tuple([key, value], ast.Load())
                return f"new py.Dict({self._comprehension(node.generators, pair)})", ATOM
            case ast.Dict(keys=keys, values=values):
                pairs = [
                    f"[{self.text(k)}, {self.text(v)}]" if k else f"...{self.text(v, ATOM)}.items()"
                    for k, v in zip(keys, values, strict=True)
                ]
                return f"new py.Dict([{', '.join(pairs)}])", ATOM
            case ast.Call():
                return self._call(node), ATOM
            case ast.Yield(value=value):
                return f"yield {self.text(value) if value else ''}", ARROW
            case ast.YieldFrom(value=value):
                return f"yield* {self.text(value)}", ARROW
        raise Untranslatable(f"{self.module}: {ast.unparse(node)}")

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
        if isinstance(node.op, ast.Div):
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
            case ast.Constant(value=str(key)):
                return f"py.item({whole}, {json.dumps(key)})"
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

    def _call(self, node: ast.Call) -> str:
        func = node.func
        match func:
            case ast.Attribute(value=ast.Call(func=ast.Name(id="super"), args=[base, whom]), attr=attr):
                inner = self.arguments([whom, *node.args])
                return f"Object.getPrototypeOf({self.text(base)}.prototype).{attr}.call({inner})"
            case ast.Attribute(value=ast.Call(func=ast.Name(id="super")), attr=attr):
                return f"super{'' if attr == '__init__' else '.' + attr}({self._given(node)})"
            case ast.Attribute(value=value, attr=attr) if attr in METHODS and not self._is_module(value):
                return f"py.{attr}({self.arguments([value, *node.args])})"
            case ast.Attribute(value=value, attr=attr) if attr in STRINGS:
                return f"{self.text(value, ATOM)}.{STRINGS[attr]}({self.arguments(node.args)})"
            case ast.Attribute(value=value, attr="_replace"):
                return f"{self.text(value, ATOM)}._replace({self._named(node.keywords)})"
            case ast.Attribute(value=value, attr="model_copy"):
                return f"{self.text(value, ATOM)}.model_copy({self.text(node.keywords[0].value)})"
            case ast.Subscript(value=ast.Name(id="list" | "dict" | "set" as word)):
                return f"py.{word}({self.arguments(node.args)})"
            case ast.Name(id="replace"):
                return f"py.replace({self.text(node.args[0])}, {self._named(node.keywords)})"
            case ast.Name(
                id="bool",
            ) if len(node.args) == 1:
                return self.truth(node.args[0], ATOM)
            case ast.Name(id="type"):
                return f"{self.text(node.args[0], ATOM)}.constructor"
            case ast.Name(id="cls"):
                return f"new {self.name('cls')}({self._given(node)})"
            case ast.Name(id=name) if self.name(name) in self.program.classes:
                known = self.program.classes[self.name(name)]
                if known.kind == "part":
                    return f"new {known.name}({self._named(node.keywords)})"
                if node.keywords and any(isinstance(one, ast.Starred) for one in node.args):
                    return f"{known.name}.made([{self.arguments(node.args)}], {self._named(node.keywords)})"
                return f"new {known.name}({self._given(node)})"
            case ast.Attribute(value=value, attr=attr):
                return f"{self.text(value, ATOM)}.{attr}({self._given(node)})"
            case ast.Name(id=name):
                own = self.name(name)
                made = "new " if is_class(own.rpartition(".")[2]) else ""
                return f"{made}{own}({self._given(node)})"
        return f"py.call({self.text(func)}{''.join(', ' + self.text(one) for one in node.args)})"

    def _is_module(self, value: ast.expr) -> bool:
        return isinstance(value, ast.Name) and self.name(value.id) == "py.math"

    def _named(self, keywords: Sequence[ast.keyword]) -> str:
        parts = [f"{word.arg}: {self.text(word.value)}" if word.arg else "" for word in keywords]
        return f"{{ {', '.join(parts)} }}"

    def _given(self, node: ast.Call) -> str:
        """The arguments of a call in order, those by name in their places."""
        found = [self.text(one) for one in node.args]
        words = {word.arg: word.value for word in node.keywords if word.arg != "strict"}
        if any(word.arg is None for word in node.keywords):
            raise Untranslatable(f"{self.module}: {ast.unparse(node)}")
        if not words:
            return ", ".join(found)
        if isinstance(node.func, ast.Name) and self.name(node.func.id) in ("py.max", "py.min", "py.sorted"):
            return ", ".join([*found, f"py.how({self._named(node.keywords)})"])
        order = self._order(node, set(map(str, words)))
        for name in order[len(found) :]:
            if not words:
                break
            found.append(self.text(words.pop(name)) if name in words else "undefined")
        if words:
            raise Untranslatable(f"{self.module}: {ast.unparse(node)}")
        return ", ".join(found)

    def _order(self, node: ast.Call, words: set[str]) -> list[str]:
        """The names of the parameters of what is called."""
        known: list[list[str]] = []
        match node.func:
            case ast.Name(id=name):
                own = self.name(name)
                if own in self.locals:
                    known = [self.locals[own]]
                elif own in self.program.classes:
                    known = [list(self.program.classes[own].fields)]
                elif own in self.program.functions:
                    known = [self.program.functions[own]]
            case ast.Attribute(attr=attr):
                known = self.program.methods.get(attr, [])
        fitting = [order for order in known if words <= set(order)]
        if not fitting or len({tuple(order.index(word) for word in sorted(words)) for order in fitting}) > 1:
            raise Untranslatable(f"{self.module}: whose arguments are those of {ast.unparse(node)}?")
        return fitting[0]


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


def is_class(name: str) -> bool:
    """Whether a name is written like that of a class."""
    return name[:1].isupper() and not name.isupper()


def negative(node: ast.expr | None) -> bool:
    """Whether an index may count from the end."""
    return not (node is None or isinstance(node, (ast.Constant, ast.Name, ast.Attribute)))


def is_unused(node: ast.expr) -> bool:
    """Whether it is the name of what nobody asks for."""
    return isinstance(node, ast.Name) and node.id == "_"
