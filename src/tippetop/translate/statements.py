"""Translation of statements and functions."""

import ast
from collections.abc import Iterator, Sequence
from typing import Any

from tippetop.translate.calls import Calls
from tippetop.translate.expressions import ATOM, LESS, is_list
from tippetop.translate.symbols import (
    FORMS_OF_FUNCTION,
    all_of,
    all_parameters,
    marks_of,
    names_in,
    targets_of,
    within,
)
from tippetop.translate.types import NUMBERS, is_only, kinds_of

ONCE = ("map", "zip", "enumerate", "reversed", "pairwise")
"""Functions whose result can be iterated only once in Python, and again in JavaScript."""


class Statements(Calls):
    """Translates the statements and functions of a module."""

    _function: ast.FunctionDef | None = None
    """Function whose statements are being translated."""
    _views: frozenset[str] = frozenset()
    """Names of array slices in that function."""

    def function_lines(self, node: ast.FunctionDef, head: str) -> Iterator[str]:
        """Yield a function or method; a function that yields becomes a generator."""
        unknown = set(marks_of(node)) - FORMS_OF_FUNCTION
        if unknown:
            raise self.refusal(node, f"decorator {unknown.pop()} is not translated")
        arguments, is_cached = self.function(node), set(marks_of(node)) & {"cache", "lru_cache"}
        if is_cached and not head.startswith("function "):
            raise self.refusal(node, f"only functions of modules are cached, not {node.name}")
        if any(isinstance(one, ast.Yield) for one in within(node)):
            head = head.replace("function ", "function* ") if " " in head else f"*{head}"
        if is_cached:
            yield f"const {head.split()[1]} = py.cached({arguments} => {{"
        else:
            yield f"{head}{arguments} {{"
        yield from indented(self._body(node))
        yield "});" if is_cached else "}"

    def _body(self, node: ast.FunctionDef) -> Iterator[str]:
        outer, self.declared = self.declared, all_parameters(node)
        function, self._function, views = self._function, node, self._views
        self.enter(self.function_scope(node))
        self._enter_views(node)
        if node.name == "__init__" and "super().__init__" not in ast.unparse(node):
            yield "super();"
        yield from self._block(node.body)
        self.scopes.pop()
        self.declared, self._function, self._views = outer, function, views

    def _enter_views(self, node: ast.FunctionDef) -> None:
        """Enter the names of array slices, and refuse iterators that are read twice.

        A second reading of an iterator has no values in Python, but has them in JavaScript.
        """
        views = set[str]()
        for one in within(node):
            match one:
                case ast.Assign(targets=[ast.Name(id=name)], value=value) if is_consumed(value):
                    reads = [
                        inner
                        for inner in ast.walk(node)
                        if isinstance(inner, ast.Name)
                        and inner.id == name
                        and isinstance(inner.ctx, ast.Load)
                    ]
                    if len(reads) > 1:
                        raise self.refusal(one, "it is empty at second use in Python; make a list")
                case ast.Assign(
                    targets=[ast.Name(id=name)],
                    value=ast.Subscript(value=array, slice=ast.Slice()),
                ) if not self.numpy and (self.arrays or is_only(self.type_of(array), "array")):
                    views.add(name)
        self._views = frozenset(views)

    def _block(self, body: Sequence[ast.stmt]) -> Iterator[str]:
        for node in body:
            yield from self._statement(node)

    def _statement(self, node: ast.stmt) -> Iterator[str]:
        match node:
            case (
                ast.Expr(value=ast.Constant())
                | ast.Pass()
                | ast.Assert()
                | ast.AnnAssign(value=None)
            ):
                return
            case ast.Expr(value=ast.Call(func=ast.Name(id=name))) if self.program.is_dropped(
                self.module, name
            ):
                return
            case ast.Expr(value=value):
                yield f"{self.text(value)};"
            case ast.Return(value=value):
                yield "return null;" if value is None else f"return {self.text(value)};"
            case ast.Assign(targets=[ast.Tuple() as places], value=ast.Tuple() as values) if (
                are_independent(places, values)
            ):
                for target, value in zip(places.elts, values.elts, strict=True):
                    yield self._assigned(target, self.text(value))
            case ast.Assign(value=value) | ast.AnnAssign(value=ast.expr() as value):
                yield from self._assignment(targets_of(node), value)
            case ast.AugAssign():
                yield self._augmented(node)
            case ast.If():
                yield from self._choice(node)
            case ast.While(test=test, body=body, orelse=[]):
                yield f"while ({self.truth(test)}) {{"
                yield from indented(self._block(body))
                yield "}"
            case ast.For(orelse=[]):
                yield from self._loop(node)
            case ast.FunctionDef():
                yield from self._inner_function(node)
            case ast.Raise(exc=ast.Name() as error):
                yield f"throw new {self.text(error)}();"
            case ast.Raise(exc=ast.expr() as error):
                yield f"throw {self.text(error)};"
            case ast.Break():
                yield "break;"
            case ast.Continue():
                yield "continue;"
            case ast.Try(handlers=[handler], orelse=[], finalbody=[]) if handler.type is not None:
                yield from self._try(node.body, handler, handler.type)
            case ast.With(items=[place], body=body) if ast.unparse(place).startswith(
                "np.errstate("
            ):
                yield from ("py.heed(false);", "try {")
                yield from indented(self._block(body))
                yield from ("} finally {", "  py.heed(true);", "}")
            case _:
                raise self.refusal(node, "such a statement is not translated")

    def _var(self, *names: str) -> str:
        """Return "var " if one of the names is not yet declared in the function, and declare
        all.
        """
        new = not self.declared.issuperset(names)
        self.declared.update(names)
        return "var " if new else ""

    def _assignment(self, targets: list[ast.expr], value: ast.expr) -> Iterator[str]:
        """Yield an assignment; a value that several targets share is computed once."""
        names = [target for target in targets if isinstance(target, ast.Name)]
        if len(targets) == 1 or isinstance(value, ast.Constant):
            for target in targets:
                yield self._assigned(target, self.text(value))
            return
        if not names:
            raise self.refusal(value, "one of several targets of a value must be a name")
        yield self._assigned(names[0], self.text(value))
        for target in targets:
            if target is not names[0]:
                yield self._assigned(target, self.text(names[0]))

    def _assigned(self, target: ast.expr, value: str) -> str:
        match target:
            case ast.Subscript(value=row, slice=place):
                self._require_no_view(target, row)
                if isinstance(place, ast.Slice) and self.numpy:
                    bounds = [
                        self.text(one) if one else "null" for one in (place.lower, place.upper)
                    ]
                    return f"py.put_slice({self.text(row, ATOM)}, {', '.join(bounds)}, {value});"
                if self.arrays:
                    return f"{self.text(target)} = {value};"
                return f"py.put({self.text(row, ATOM)}, {self.text(place)}, {value});"
        return f"{self._var(*names_in(target))}{self.pattern(target)} = {value};"

    def _require_no_view(self, target: ast.expr, row: ast.expr) -> None:
        """Refuse an assignment to an array slice, which in Python shares the array's numbers."""
        if isinstance(row, ast.Name) and row.id in self._views:
            raise self.refusal(target, "a part of an array shares its numbers in Python")

    def _augmented(self, node: ast.AugAssign) -> str:
        """Return an augmented assignment; lists are extended in place, as in Python."""
        target, value = node.target, node.value
        if any(isinstance(one, ast.Call) for one in ast.walk(target)):
            raise self.refusal(node, "the call in the target would be made twice; name its value")
        left, right = self.type_of(target), self.type_of(value)
        if "list" in kinds_of(left) or is_only(right, "list"):
            if not isinstance(node.op, ast.Add):
                raise self.refusal(node, "lists are extended in place by += only")
            if not kinds_of(left) <= {"list", "any"}:
                raise self.refusal(node, "a list is extended in place, a tuple is not; annotate it")
            return f"py.extend({self.text(target)}, {self.text(value)});"
        if kinds_of(left) & {"set", "dict", "array", "sequence"}:
            raise self.refusal(node, "only lists are changed in place")
        sum_ = ast.copy_location(ast.BinOp(target, node.op, value), node)
        is_number = is_only(left, *NUMBERS, "str", "tuple") or is_only(right, *NUMBERS, "str")
        if isinstance(node.op, ast.Add) and not (is_number or self.numbers or is_list(value)):
            added = f"py.add_in_place({self.text(target)}, {self.text(value)})"
            return self._assigned(target, added)
        return self._assigned(target, self.text(sum_))

    def _choice(self, node: ast.If) -> Iterator[str]:
        yield f"if ({self.truth(node.test)}) {{"
        yield from indented(self._block(node.body))
        match node.orelse:
            case [ast.If() as alternative]:
                first, *others = self._choice(alternative)
                yield from (f"}} else {first}", *others)
            case []:
                yield "}"
            case _:
                yield "} else {"
                yield from indented(self._block(node.orelse))
                yield "}"

    def _try(
        self, body: list[ast.stmt], handler: ast.ExceptHandler, kind: ast.expr
    ) -> Iterator[str]:
        name = handler.name or "error"
        kinds = kind.elts if isinstance(kind, ast.Tuple) else [kind]
        test = " || ".join(f"{name} instanceof {self.text(one)}" for one in kinds)
        yield "try {"
        yield from indented(self._block(body))
        yield f"}} catch ({name}) {{"
        yield f"  if (!({test})) throw {name};"
        yield from indented(self._block(handler.body))
        yield "}"

    def _inner_function(self, node: ast.FunctionDef) -> Iterator[str]:
        if node.decorator_list:
            raise self.refusal(
                node, f"decorators of {node.name}, in a function, are not translated"
            )
        if any(isinstance(one, ast.Yield) for one in within(node)):
            raise self.refusal(node, f"{node.name}, in a function, cannot yield")
        name = self.name(ast.Name(node.name, ast.Load()))
        yield f"{self._var(node.name)}{name} = {self.function(node)} => {{"
        yield from indented(self._body(node))
        yield "};"

    def _loop(self, node: ast.For) -> Iterator[str]:
        match node:
            case ast.For(
                target=ast.Name() as target, iter=ast.Call(func=ast.Name("range"), args=args)
            ) if not any(isinstance(one, ast.Starred) for one in args):
                yield from self._counted(node, target, args)
                return
        self._var(*names_in(node.target))
        yield f"for (var {self.pattern(node.target)} of {self.text(node.iter)}) {{"
        yield from indented(self._block(node.body))
        yield "}"

    def _counted(self, node: ast.For, target: ast.Name, args: list[ast.expr]) -> Iterator[str]:
        """Yield a loop over a range.

        Python evaluates the end of the range once and sets the variable at the start of every turn.
        If the loop may change what the end depends on, the end gets a variable. If the loop's
        variable is read after the loop, changed in it or captured by a function, the count gets
        another variable.
        """
        start = self.text(args[0]) if len(args) > 1 else "0"
        stop = args[1] if len(args) > 1 else args[0]
        step = self.text(args[2]) if len(args) > 2 else "1"
        sign = "<" if len(args) < 3 else self._sign_of(args[2])
        variable = self.name(target) if target.id != "_" else "turn"
        begin = f"var {variable} = {start}"
        counter, assigned = variable, ""
        if not self._counts_alone(node, target.id):
            counter = f"{variable}_turn"
            begin, assigned = (
                f"var {counter} = {start}",
                f"  {self._var(target.id)}{variable} = {counter};",
            )
        end = self.text(stop, LESS)
        if not self._is_steady(stop, node):
            end = f"{counter}_end"
            begin += f", {end} = {self.text(stop)}"
        # Rows of arrays whose numbers are gone through are looked up once.
        rows: list[Any] = [
            one
            for one in all_of(node.body)
            if isinstance(one, ast.Subscript) and is_row(one, target.id)
        ]
        texts = sorted({(self.text(one.value), self.text(one.slice.elts[0])) for one in rows})
        self.rows = {f"{row}[{place}]": f"{row}{place}" for row, place in texts}
        yield from (f"var {short} = {row};" for row, short in self.rows.items())
        self._var(target.id)
        yield f"for ({begin}; {counter} {sign} {end}; {counter} += {step}) {{"
        if assigned:
            yield assigned
        yield from indented(self._block(node.body))
        self.rows = {}
        yield "}"

    def _sign_of(self, step: ast.expr) -> str:
        """Return the comparison of a loop's variable with the end of its range.

        The step must be a number that is written out, or a constant of a module.
        """
        match step:
            case ast.Constant(value=int(number)) if number > 0:
                return "<"
            case ast.UnaryOp(op=ast.USub(), operand=ast.Constant(value=int(number))) if number > 0:
                return ">"
            case ast.Name(id=name) if not self.is_local(name):
                symbol = self.program.symbol(self.module, name)
                if symbol is not None and isinstance(symbol.node, ast.Assign):
                    return self._sign_of(symbol.node.value)
        raise self.refusal(step, "the step of a range must be a constant other than zero")

    def _is_steady(self, stop: ast.expr, loop: ast.For) -> bool:
        """Return whether the end of a range cannot change within its loop."""
        bound = {name for one in loop.body for name in names_in(one)}
        match stop:
            case ast.Constant():
                return True
            case ast.Name(id=name):
                return name not in bound
            case ast.Call(func=ast.Name("len"), args=[ast.Name(id=name)]) if self.arrays:
                return name not in bound
            case ast.BinOp(left=left, right=right) if self.numbers:
                return self._is_steady(left, loop) and self._is_steady(right, loop)
        return False

    def _counts_alone(self, loop: ast.For, name: str) -> bool:
        """Return whether a loop's variable is read only in the loop and never changed in it."""
        function = self._function
        if function is None or name == "_":
            return True
        inside = {id(one) for one in all_of(loop.body)}
        loops = [
            one
            for one in ast.walk(function)
            if isinstance(one, ast.For) and one is not loop and ast.unparse(one.target) == name
        ]
        elsewhere = {id(one) for one in all_of(part for one in loops for part in one.body)}
        elsewhere |= {
            id(inner)
            for one in ast.walk(function)
            if isinstance(one, ast.ListComp | ast.GeneratorExp | ast.SetComp | ast.DictComp)
            and any(name in names_in(part.target) for part in one.generators)
            for inner in ast.walk(one)
        }
        for one in all_of(loop.body):
            if name in names_in(one) and isinstance(one, ast.Name) and id(one) not in elsewhere:
                return False
            if isinstance(one, ast.FunctionDef | ast.Lambda) and self._reads(one, name):
                return False
        return not any(
            isinstance(one, ast.Name)
            and one.id == name
            and isinstance(one.ctx, ast.Load)
            and id(one) not in inside
            and id(one) not in elsewhere
            for one in ast.walk(function)
        )

    def _reads(self, function: ast.FunctionDef | ast.Lambda, name: str) -> bool:
        if name in all_parameters(function):
            return False
        return any(isinstance(one, ast.Name) and one.id == name for one in ast.walk(function))


def is_consumed(node: ast.expr) -> bool:
    """Return whether the values of an expression can be iterated only once in Python."""
    match node:
        case ast.GeneratorExp():
            return True
        case ast.Call(func=ast.Name(id=name)):
            return name in ONCE
    return False


def are_independent(places: ast.Tuple, values: ast.Tuple) -> bool:
    """Return whether an assignment of a tuple can be made name by name: no name occurs in the
    values.
    """
    names = {
        node.id for place in places.elts for node in ast.walk(place) if isinstance(node, ast.Name)
    }
    read = {node.id for node in ast.walk(values) if isinstance(node, ast.Name)}
    are_names = all(isinstance(place, ast.Name) for place in places.elts)
    is_starred = any(isinstance(value, ast.Starred) for value in values.elts)
    return (
        are_names and not is_starred and not names & read and len(places.elts) == len(values.elts)
    )


def is_row(node: ast.Subscript, index: str) -> bool:
    """Return whether an expression is the number at this index of a row of an array."""
    match node.slice:
        case ast.Tuple(elts=[ast.Constant(), ast.Name(id=name)]):
            return name == index
    return False


def indented(lines: Iterator[str]) -> Iterator[str]:
    """Yield lines indented further."""
    for line in lines:
        yield f"  {line}" if line else line
