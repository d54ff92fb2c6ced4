"""Translation of expressions."""

import ast
import json
from abc import abstractmethod
from collections.abc import Sequence
from itertools import pairwise

from tippetop.translate.inference import Inference
from tippetop.translate.runtime_names import MODULES, NUMPY_ARRAYS
from tippetop.translate.symbols import ENUMERATIONS, SymbolTable, names_in, safe
from tippetop.translate.types import ROWS, Type, is_only, kinds_of

ARROW, OR, AND, BITS, EQUAL, LESS, SUM, PRODUCT, UNARY, ATOM = range(10)
"""Precedence of JavaScript's operators, loosest first."""

ARITHMETIC = {
    ast.Add: ("add", "+", SUM),
    ast.Sub: ("sub", "-", SUM),
    ast.Mult: ("mul", "*", PRODUCT),
    ast.Div: ("div", "/", PRODUCT),
    ast.Pow: ("pow", "", ATOM),
    ast.FloorDiv: ("floordiv", "", ATOM),
    ast.Mod: ("mod", "", ATOM),
    ast.BitOr: ("either", "", ATOM),
    ast.BitAnd: ("both", "", ATOM),
    ast.MatMult: ("matmul", "", ATOM),
}
COMPARISONS = {ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">="}
COMPARING = {ast.Lt: "lt", ast.LtE: "le", ast.Gt: "gt", ast.GtE: "ge"}
"""The runtime's functions of comparison, for operands that may be arrays."""

LARGEST = 2**53
"""Largest integer that is exact in JavaScript."""

PURE = {"abs", "float", "len"}
"""Functions that may be called twice where Python calls them once."""

ORDERED = ("any", "bool", "int", "float", "str", "instance", "array")
"""Kinds of types that JavaScript compares as Python does; instances have a check at run time."""

ROW_MAKERS = ("py.zip(", "py.zip_equal(", "py.range(", "py.enumerate(", "py.list(", "[")
"""Beginnings of JavaScript expressions that make a new array."""


class Expressions(Inference):
    """Translates the expressions of a module.

    Parameters
    ----------
    program
        All modules.
    module
        Name of the module.
    """

    def __init__(self, program: SymbolTable, module: str) -> None:
        super().__init__(program, module)
        words = program.declared[module].words
        self.arrays = "arrays" in words
        self.numbers = self.arrays or "numbers" in words
        self.series, self.numpy = "series" in words, "numpy" in words
        self.declared, self.rows = set[str](), dict[str, str]()

    @abstractmethod
    def call(self, node: ast.Call) -> str:
        """Return a call."""

    @abstractmethod
    def function(self, node: ast.FunctionDef | ast.Lambda) -> str:
        """Return the parameters of a function, with their defaults."""

    def name(self, node: ast.Name) -> str:
        """Return the JavaScript name of a name; refuse a name that nothing defines."""
        name = node.id
        if self.is_local(name):
            return safe(name)
        if name in ("self", "cls") and self.owner is not None:
            return "this"
        if (self.module, name) in self.program.names:
            return self.program.names[self.module, name]
        if name == "np" and self.numpy:
            return "py.numpy"
        if name in self.program.runtime or name in MODULES:
            return f"py.{safe(name)}"
        raise self.refusal(node, f"no translated module and not the runtime has '{name}'")

    def text(self, node: ast.expr, binds: int = ARROW) -> str:
        """Return an expression, in parentheses if its operator binds looser than `binds`."""
        text, precedence = self._text(node)
        return f"({text})" if precedence < binds else text

    def arguments(self, nodes: Sequence[ast.expr]) -> str:
        """Return expressions with commas between them."""
        return ", ".join(self.text(node) for node in nodes)

    def truth(self, node: ast.expr, binds: int = ARROW) -> str:
        """Return the truth value of an expression."""
        match node:
            case ast.UnaryOp(op=ast.Not()) | ast.Call(func=ast.Name("bool" | "isinstance")):
                return self.text(node, binds)
            case ast.Compare():
                return self.text(node, binds)
            case ast.BoolOp(op=op, values=values):
                sign, precedence = ("||", OR) if isinstance(op, ast.Or) else ("&&", AND)
                text = f" {sign} ".join(self.truth(value, precedence + 1) for value in values)
                return f"({text})" if precedence < binds else text
        return f"py.truth({self.text(node)})"

    def pattern(self, node: ast.expr) -> str:
        """Return a target of an assignment or of a loop."""
        match node:
            case ast.Tuple(elts=parts):
                if any(isinstance(part, ast.Starred) for part in parts[:-1]):
                    raise self.refusal(node, "only the last of several targets may be starred")
                texts = ["" if ast.unparse(part) == "_" else self.pattern(part) for part in parts]
                return f"[{', '.join(texts).rstrip(', ')}]"
            case ast.Name():
                return self.name(node)
            case ast.Attribute(value=value, attr=attr):
                return f"{self.text(value, ATOM)}.{attr}"
            case ast.Starred(value=value):
                return f"...{self.pattern(value)}"
        raise self.refusal(node, "such a target is not translated")

    def _text(self, node: ast.expr) -> tuple[str, int]:
        """Return an expression and its precedence."""
        match node:
            case ast.Constant():
                return self._constant(node), ATOM
            case ast.Name():
                return self.name(node), ATOM
            case ast.Tuple(elts=parts) | ast.List(elts=parts):
                return f"[{self.arguments(parts)}]", ATOM
            case ast.Starred(value=value):
                return f"...{self.text(value, ATOM)}", ARROW
            case ast.Attribute():
                return self._attribute(node), ATOM
            case ast.BinOp():
                return self._arithmetic(node)
            case ast.UnaryOp(op=ast.Not(), operand=operand):
                return f"!{self.truth(operand, UNARY)}", UNARY
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                is_real = isinstance(operand, ast.Constant) and not isinstance(
                    operand.value, complex
                )
                if self.numbers or is_real:
                    return f"-{self.text(operand, ATOM)}", UNARY
                return f"py.neg({self.text(operand)})", ATOM
            case ast.UnaryOp(op=ast.Invert(), operand=operand) if self.numpy:
                return f"py.invert({self.text(operand)})", ATOM
            case ast.BoolOp(op=op, values=values):
                word, text = "or" if isinstance(op, ast.Or) else "and", self.text(values[-1])
                for value in reversed(values[:-1]):
                    text = f"py.{word}({self.text(value)}, () => {text})"
                return text, ATOM
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
                text = f"{self.function(node)} => "
                self.enter(self.function_scope(node))
                inner = self.text(body)
                self.scopes.pop()
                return text + (f"({inner})" if inner.startswith("{") else inner), ARROW
            case ast.ListComp(elt=element) | ast.GeneratorExp(elt=element):
                return self._comprehension(node.generators, element), ATOM
            case ast.SetComp(elt=element):
                return f"py.set({self._comprehension(node.generators, element)})", ATOM
            case ast.Set(elts=parts):
                return f"py.set([{self.arguments(parts)}])", ATOM
            case ast.DictComp(key=key, value=value):
                pair = ast.Tuple([key, value], ast.Load())
                return f"py.dict({self._comprehension(node.generators, pair)})", ATOM
            case ast.Dict(keys=keys, values=values):
                pairs = [
                    f"[{self.text(key)}, {self.text(value)}]"
                    if key
                    else f"...{self.text(value, ATOM)}.entries()"
                    for key, value in zip(keys, values, strict=True)
                ]
                return f"py.dict([{', '.join(pairs)}])", ATOM
            case ast.Call():
                return self.call(node), ATOM
            case ast.Yield(value=value):
                return f"yield {self.text(value) if value else ''}", ARROW
        raise self.refusal(node, "such an expression is not translated")

    def _constant(self, node: ast.Constant) -> str:
        value = node.value
        if isinstance(value, complex) and self.numpy:
            return f"new py.Complex({value.real!r}, {value.imag!r})"
        if value is not None and not isinstance(value, bool | int | float | str):
            raise self.refusal(node, "such a constant is not translated")
        if isinstance(value, int) and abs(value) > LARGEST:
            raise self.refusal(node, "JavaScript's integers are exact up to 2**53 only")
        return json.dumps(value, ensure_ascii=False)

    def _attribute(self, node: ast.Attribute) -> str:
        """Return a field, a property, a member of `math` or NumPy, or a method with its object."""
        value, attr = node.value, node.attr
        if isinstance(value, ast.Name) and value.id in MODULES and not self.is_local(value.id):
            names = NUMPY_ARRAYS if value.id == "np" and self.numpy else MODULES[value.id]
            if attr not in names:
                raise self.refusal(node, f"the runtime has no {value.id}.{attr}")
            return f"{self.text(value)}.{attr}"
        receiver = self.type_of(value)
        members = self.members(receiver, attr)
        if self.numpy and attr in ("real", "imag") and not members:
            return f"{self.text(value, ATOM)}.{attr}"
        for one in {id(member.owner): member.owner for member in members}.values():
            if one.kind == "py.IntEnum" and attr in ("name", "value"):
                raise self.refusal(node, f"a member of {one.node.name} is a number in JavaScript")
        if not members:
            classes = {part for part in (receiver, *receiver.parts) if part.cls is not None}
            is_enumeration = any(
                one.cls and one.cls.kind in ENUMERATIONS[:2] for one in classes
            ) or is_only(receiver, "any")
            if not (attr in ("name", "value") and is_enumeration):
                raise self.refusal(node, f"{self._described(receiver)} has no '{attr}'")
        if any(member.is_method for member in members):
            # If the class decides whether it is a method, the runtime inspects the object.
            return f'py.member({self.text(value)}, "{attr}")'
        return f"{self.text(value, ATOM)}.{attr}"

    def _described(self, kind: Type) -> str:
        """Return a type in words."""
        if kind.cls is not None:
            return f"class {kind.cls.node.name}"
        article = "an" if kind.kind[0] in "aeiou" else "a"
        return "no class" if kind.kind in ("any", "union") else f"{article} {kind.kind}"

    def _arithmetic(self, node: ast.BinOp) -> tuple[str, int]:
        is_product = isinstance(node.op, ast.MatMult)
        if type(node.op) not in ARITHMETIC or (is_product and not self.numpy):
            raise self.refusal(node, "such an operator is not translated")
        word, sign, binds = ARITHMETIC[type(node.op)]
        left, right = self.type_of(node.left), self.type_of(node.right)
        for one in (left, right):
            if kinds_of(one) & {"set", "dict"}:
                raise self.refusal(node, "operators of sets and dicts are not translated")
        if isinstance(node.op, ast.Mod | ast.FloorDiv) and "str" in kinds_of(left):
            raise self.refusal(node, "formatting with % is not translated; write an f-string")
        if isinstance(node.op, ast.Pow) and isinstance(node.left, ast.Constant):
            self._require_exact(node)
        if sign and (self.arrays or (self.numbers and self._is_of_numbers(node))):
            return f"{self.text(node.left, binds)} {sign} {self.text(node.right, binds + 1)}", binds
        return f"py.{word}({self.text(node.left)}, {self.text(node.right)})", ATOM

    def _require_exact(self, node: ast.BinOp) -> None:
        match node.left, node.right:
            case ast.Constant(value=int(base)), ast.Constant(value=int(exponent)):
                if abs(base) > 1 and (exponent > 64 or abs(base**exponent) > LARGEST):
                    raise self.refusal(node, "JavaScript's integers are exact up to 2**53 only")

    def _is_of_numbers(self, node: ast.BinOp) -> bool:
        """Return whether JavaScript's operator means the same for the operands of an operation.

        Lists have operators too, and division by zero is an error in Python.
        """
        for one in (node.left, node.right):
            kind = self.type_of(one)
            if kinds_of(kind) & {"instance", "class", "function"}:
                reason = f"the module declares its operands numbers, but {self._described(kind)}"
                raise self.refusal(node, f"{reason} is none")
            if kinds_of(kind) & {*ROWS, "str", "iterator"} or is_list(one):
                return False
        return not isinstance(node.op, ast.Div) or isinstance(node.right, ast.Constant)

    def _comparison(self, node: ast.Compare) -> tuple[str, int]:
        sides = [node.left, *node.comparators]
        for side in sides[1:-1]:
            for inner in ast.walk(side):
                if isinstance(inner, ast.Call) and ast.unparse(inner.func) not in PURE:
                    reason = "a call between two comparisons would be made twice; name its value"
                    raise self.refusal(node, reason)
        texts = [
            self._compared(node, left, op, right)
            for (left, right), op in zip(pairwise(sides), node.ops, strict=True)
        ]
        if len(texts) == 1:
            return texts[0]
        return " && ".join(
            f"({text})" if precedence < AND else text for text, precedence in texts
        ), AND

    def _compared(
        self, node: ast.Compare, left: ast.expr, op: ast.cmpop, right: ast.expr
    ) -> tuple[str, int]:
        kinds = self.type_of(left), self.type_of(right)
        if self.numpy and type(op) in COMPARISONS:
            return f"py.{COMPARING[type(op)]}({self.text(left)}, {self.text(right)})", ATOM
        if type(op) in COMPARISONS:
            for side, kind in zip((left, right), kinds, strict=True):
                is_row = is_list(side) or not kinds_of(kind) <= {*ORDERED, "module"}
                if is_row or self._is_tuple(kind):
                    reason = f"the order of {self._described(kind)} is not translated"
                    raise self.refusal(node, f"{reason}; compare numbers or strings")
            return f"{self.text(left, SUM)} {COMPARISONS[type(op)]} {self.text(right, SUM)}", LESS
        a, b = self.text(left, LESS), self.text(right, LESS)
        negated = isinstance(op, ast.NotEq | ast.IsNot | ast.NotIn)  # codespell:ignore
        if isinstance(op, ast.In | ast.NotIn):  # codespell:ignore
            text = f"py.contains({b}, {a})"
        elif isinstance(op, ast.Is | ast.IsNot):
            self._require_identity(node, left, right)
            return f"{a} {'!' if negated else '='}== {b}", EQUAL
        elif self.arrays or self._is_equal_by_identity(left, right):
            return f"{a} {'!' if negated else '='}== {b}", EQUAL
        else:
            rows = [kinds_of(kind) & {"list", "tuple"} for kind in kinds]
            if rows[0] and rows[1] and not rows[0] & rows[1]:
                raise self.refusal(node, "a list never equals a tuple in Python")
            if (kinds_of(kinds[0]) | kinds_of(kinds[1])) & {"set", "dict"}:
                raise self.refusal(node, "equality of sets and dicts is not translated")
            text = f"py.eq({a}, {b})"
        return (f"!{text}", UNARY) if negated else (text, ATOM)

    def _is_tuple(self, kind: Type) -> bool:
        return kind.cls is not None and kind.cls.kind == "py.NamedTuple"

    def _is_equal_by_identity(self, left: ast.expr, right: ast.expr) -> bool:
        """Return whether JavaScript's `===` means Python's `==`."""
        kinds = [kinds_of(self.type_of(one)) for one in (left, right)]
        numbers = {"int", "float"}
        if kinds[0] and kinds[1] and kinds[0] | kinds[1] <= numbers:
            return True
        if kinds[0] == kinds[1] and kinds[0] in ({"str"}, {"bool"}):
            return True
        is_number = any(
            isinstance(one, ast.Constant) and type(one.value) in (int, float)
            for one in (left, right)
        )
        return self.numbers and is_number

    def _require_identity(self, node: ast.Compare, left: ast.expr, right: ast.expr) -> None:
        for one in (left, right):
            if isinstance(one, ast.Constant):
                if one.value is None or isinstance(one.value, bool):
                    return
                raise self.refusal(node, "identity of constants is not translated; write ==")
        for one in (left, right):
            if kinds_of(self.type_of(one)) & {"int", "float", "str", "bool", "function"}:
                reason = "identity of numbers, strings and methods is not translated"
                raise self.refusal(node, f"{reason}; write ==")

    def _formatted(self, part: ast.expr) -> str:
        match part:
            case ast.FormattedValue(value=inner, conversion=-1, format_spec=None):
                self.require_words(inner)
                return f"${{py.str({self.text(inner)})}}"
            case ast.FormattedValue(value=inner, conversion=114, format_spec=None):
                return f"${{py.repr({self.text(inner)})}}"
            case ast.FormattedValue(
                value=inner, conversion=-1, format_spec=ast.JoinedStr() as spec
            ):
                text = ast.unparse(spec)[2:-1]
                if text == "g" or (
                    text[:1] == "."
                    and text[-1:] == "g"
                    and text[1:-1].isdigit()
                    and int(text[1:-1])
                ):
                    return f'${{py.format({self.text(inner)}, "{text}")}}'
                raise self.refusal(part, f"format '{text}' is not translated; write 'g' or '.3g'")
            case ast.Constant(value=str(text)):
                return (
                    json.dumps(text, ensure_ascii=False)[1:-1]
                    .replace("`", "\\`")
                    .replace("${", "\\${")
                    .replace('\\"', '"')
                )
        raise self.refusal(part, "such a format is not translated")

    def require_words(self, node: ast.expr) -> None:
        """Refuse to write a value as text where JavaScript cannot tell what Python writes."""
        kinds = kinds_of(self.type_of(node))
        if "float" in kinds:
            raise self.refusal(node, "a float as text needs a format, such as {value:.6g}")
        if kinds & {*ROWS, "set", "dict", "iterator", "array", "class", "function"}:
            raise self.refusal(node, "only strings and integers are written as text")

    def _item(self, node: ast.Subscript) -> str:
        value = self.text(node.value, ATOM)
        match node.slice:
            case ast.Slice(lower=low, upper=high, step=None):
                if self._is_tuple(self.type_of(node.value)):
                    raise self.refusal(node, "parts of tuples with names are not translated")
                parts = [self.text(low) if low else "0", *([self.text(high)] if high else [])]
                return f"{value}.slice({', '.join(parts)})"
            case ast.Slice(lower=low, upper=high, step=step):
                parts = [self.text(one) if one else "null" for one in (low, high, step)]
                return f"py.slice({value}, {', '.join(parts)})"
            case ast.Tuple(elts=places):
                row = f"{value}[{self.text(places[0])}]"
                return self.rows.get(row, row) + "".join(
                    f"[{self.text(place)}]" for place in places[1:]
                )
            case ast.UnaryOp(op=ast.USub()) if self.arrays:
                raise self.refusal(node, "negative places are not translated in modules of arrays")
            case _ if self.arrays:
                return f"{value}[{self.text(node.slice)}]"
            case ast.Constant(value=int(number)) if not (self.series or self.numpy):
                if not is_only(self.type_of(node.value), "dict"):
                    return f"{value}[{number}]"
        return f"py.item({value}, {self.text(node.slice)})"

    def _comprehension(self, generators: Sequence[ast.comprehension], element: ast.expr) -> str:
        first, *others = generators
        rows = self.text(first.iter, ATOM)
        if not rows.startswith(ROW_MAKERS):
            rows = f"[...{rows}]"
        self._require_no_late_function(first, element)
        self.enter(self.comprehension_scope(first))
        target = self.pattern(first.target)
        for test in first.ifs:
            rows = f"{rows}.filter(({target}) => {self.truth(test)})"
        if others:
            rows = f"{rows}.flatMap(({target}) => {self._comprehension(others, element)})"
        elif (inner := self.text(element)) != target:
            rows = f"{rows}.map(({target}) => {f'({inner})' if inner.startswith('{') else inner})"
        self.scopes.pop()
        return rows

    def _require_no_late_function(self, first: ast.comprehension, element: ast.expr) -> None:
        """Refuse functions collected in a comprehension: in Python all of them read its last
        value.
        """
        parts = element.elts if isinstance(element, ast.Tuple | ast.List) else [element]
        bound = set(names_in(first.target))
        for part in parts:
            if isinstance(part, ast.Lambda):
                read = {one.id for one in ast.walk(part.body) if isinstance(one, ast.Name)}
                if bound & read:
                    reason = "functions collected in a comprehension would all read the last value"
                    raise self.refusal(part, f"{reason}; make them by a function that takes it")


def is_list(node: ast.expr) -> bool:
    """Return whether an expression is a list that is written out, a part of one, or a sum of
    such.
    """
    if isinstance(node, ast.BinOp):
        return is_list(node.left) or is_list(node.right)
    if isinstance(node, ast.Subscript):
        return isinstance(node.slice, ast.Slice)
    return isinstance(node, ast.List | ast.ListComp | ast.Tuple)
