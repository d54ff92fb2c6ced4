"""Python's statements and functions as JavaScript."""

import ast
from collections.abc import Iterator, Sequence
from typing import Any

from tippetop.emit.expressions import Expressions
from tippetop.emit.program import names_in, safe
from tippetop.emit.scope import Scope, is_range
from tippetop.emit.translator import ATOM, LESS, Untranslatable


class Statements(Expressions):
    """Translates the statements and functions of a module."""

    def function_lines(self, node: ast.FunctionDef, head: str) -> Iterator[str]:
        """A function or method; what it yields makes it a generator."""
        given = self.function(node)
        scope = Scope.of(node)
        generator = any(isinstance(one, (ast.Yield, ast.YieldFrom)) for one in ast.walk(node))
        if generator:
            head = head.replace("function ", "function* ") if " " in head else f"*{head}"
        known = head.startswith("function") and any(
            "cache" in ast.unparse(mark) for mark in node.decorator_list
        )
        if known:
            yield f"const {head.split()[1]} = py.cached({given} => {{"
        else:
            yield f"{head}{given} {{"
        yield from indented(self._body(node, scope))
        yield "});" if known else "}"

    def _body(self, node: ast.FunctionDef, scope: Scope) -> Iterator[str]:
        scope.floats |= {
            name
            for outer in self.scopes
            for name in outer.floats
            if name not in scope.bindings and name not in scope.parameters
        }
        self.scopes.append(scope)
        own = [*scope.parameters, "self", "cls"]
        top = [safe(name) for name, where in scope.declared.items() if not where and name not in own]
        if self.rebound and len(self.scopes) == 1:
            yield "let self = this;"
        if node.name == "__init__" and "super().__init__" not in ast.unparse(node):
            yield "super();"
        if top:
            yield f"let {', '.join(top)};"
        yield from self._block(node.body)
        self.scopes.pop()

    def _block(self, body: Sequence[ast.stmt]) -> Iterator[str]:
        for node in body:
            yield from self._statement(node)

    def _statement(self, node: ast.stmt) -> Iterator[str]:
        match node:
            case ast.Expr(value=ast.Constant()) | ast.Pass() | ast.Import() | ast.ImportFrom():
                return
            case ast.Expr(value=value):
                yield f"{self.text(value)};"
            case ast.Return(value=value):
                yield "return null;" if value is None else f"return {self.text(value)};"
            case ast.Assign(targets=targets, value=value):
                yield from self._assignment(node, targets, self.text(value))
            case ast.AnnAssign(target=target, value=value):
                if value is not None:
                    yield from self._assignment(node, [target], self.text(value))
                elif self.scopes[-1].fresh(node):
                    yield f"let {self.text(target)};"
            case ast.AugAssign(target=target, op=op, value=value):
                load = ast.parse(ast.unparse(target), mode="eval").body
                whole = self.text(ast.BinOp(load, op, value))
                yield from self._assignment(node, [target], whole)
            case ast.If(test=test, body=body, orelse=orelse):
                yield f"if ({self.truth(test)}) {{"
                yield from indented(self._block(body))
                if len(orelse) == 1 and isinstance(orelse[0], ast.If):
                    first, *rest = self._statement(orelse[0])
                    yield f"}} else {first}"
                    yield from rest
                    return
                if orelse:
                    yield "} else {"
                    yield from indented(self._block(orelse))
                yield "}"
            case ast.While(test=test, body=body):
                yield f"while ({self.truth(test)}) {{"
                yield from indented(self._block(body))
                yield "}"
            case ast.For():
                yield from self._loop(node)
            case ast.FunctionDef(name=name):
                yield from self._nested(node, name)
            case ast.Raise(exc=None):
                yield "throw error;"
            case ast.Raise(exc=ast.Name() as error):
                yield f"throw new {self.text(error)}();"
            case ast.Raise(exc=ast.expr() as error):
                yield f"throw {self.text(error)};"
            case ast.Assert(test=test, msg=msg):
                yield f"py.assert({self.truth(test)}{', ' + self.text(msg) if msg else ''});"
            case ast.Break():
                yield "break;"
            case ast.Continue():
                yield "continue;"
            case ast.Try() | ast.With():
                yield from self._try(node)
            case ast.Match():
                yield from self._match(node)
            case ast.Delete(targets=[ast.Subscript(value=value, slice=ast.Slice(lower=ast.expr() as low))]):
                yield f"{self.text(value, ATOM)}.splice({self.text(low)});"
            case _:
                raise Untranslatable(f"{self.module}: {ast.unparse(node)}")

    def _assignment(self, node: ast.stmt, targets: Sequence[ast.expr], value: str) -> Iterator[str]:
        scope = self.scopes[-1]
        for target in targets:
            if isinstance(target, ast.Tuple) and any(isinstance(one, ast.Subscript) for one in target.elts):
                yield "{"
                yield f"  const parts = {value};"
                for number, one in enumerate(target.elts):
                    yield from indented(self._assignment(node, [one], f"parts[{number}]"))
                yield "}"
                continue
            if isinstance(target, ast.Subscript) and isinstance(target.slice, ast.Slice):
                low, high = (
                    self.text(one) if one else "null" for one in (target.slice.lower, target.slice.upper)
                )
                yield f"py.put_slice({self.text(target.value, ATOM)}, {low}, {high}, {value});"
                continue
            if isinstance(target, ast.Subscript) and (
                isinstance(target.slice, ast.Tuple) or self.is_array(target.value)
            ):
                yield f"{self.text(target)} = {value};"
                continue
            if isinstance(target, ast.Subscript):
                whole, place = self.text(target.value, ATOM), self.text(target.slice)
                yield f"py.put({whole}, {place}, {value});"
                continue
            yield f"{scope.word(node) if names_in(target) else ''}{self.pattern(target)} = {value};"

    def _loop(self, node: ast.For) -> Iterator[str]:
        word = self.scopes[-1].word(node)
        match node:
            case ast.For(target=ast.Name(id=name), iter=ast.Call(args=args)) if is_range(node.iter):
                i = self.name(name) if name != "_" else "turn"
                word = "let " if word or name == "_" else ""
                start = self.text(args[0]) if len(args) > 1 else "0"
                stop = self.text(args[1] if len(args) > 1 else args[0], LESS)
                step = self.text(args[2]) if len(args) > 2 else "1"
                sign, by = (
                    ("<", f"{i} += {step}") if not step.startswith("-") else (">", f"{i} -= {step[1:]}")
                )
                # Rows of arrays whose numbers are gone through are looked up once.
                rows: list[Any] = [one for inner in node.body for one in ast.walk(inner) if is_row(one, name)]
                found = sorted({(self.text(one.value), self.text(one.slice.elts[0])) for one in rows})
                self.rows = {f"{whole}[{place}]": f"{whole}{place}" for whole, place in found}
                known = "".join(f", {own} = {row}" for row, own in self.rows.items())
                yield f"for ({word}{i} = {start}{known}; {i} {sign} {stop}; {by}) {{"
            case _:
                yield f"for ({word}{self.pattern(node.target)} of {self.text(node.iter)}) {{"
        yield from indented(self._block(node.body))
        self.rows = {}
        yield "}"

    def _nested(self, node: ast.FunctionDef, name: str) -> Iterator[str]:
        yield f"{self.scopes[-1].word(node)}{self.name(name)} = {self.function(node)} => {{"
        yield from indented(self._body(node, Scope.of(node)))
        yield "};"

    def _try(self, node: ast.Try | ast.With) -> Iterator[str]:
        """What may fail; or, as in `numpy.errstate`, does not."""
        yield from ["py.heed(false);"] * isinstance(node, ast.With)
        yield "try {"
        yield from indented(self._block(node.body))
        if isinstance(node, ast.With):
            if not ast.unparse(node.items[0]).startswith("np.errstate("):
                raise Untranslatable(f"{self.module}: {ast.unparse(node)}")
            yield from ["} finally {", "  py.heed(true);", "}"]
            return
        handler, *others = node.handlers
        if others or handler.type is None or node.orelse or node.finalbody:
            raise Untranslatable(f"{self.module}: {ast.unparse(node)}")
        yield "} catch (error) {"
        yield f"  if (!(error instanceof {self.text(handler.type)})) throw error;"
        self.hidden.append({handler.name} if handler.name else set())
        yield from indented(self._block(handler.body))
        self.hidden.pop()
        yield "}"

    def _match(self, node: ast.Match) -> Iterator[str]:
        subject = self.text(node.subject)
        word = ""
        for case in node.cases:
            match case.pattern:
                case ast.MatchValue(value=value):
                    yield f"{word}if (py.eq({subject}, {self.text(value)})) {{"
                case _:
                    raise Untranslatable(f"{self.module}: {ast.unparse(case)}")
            yield from indented(self._block(case.body))
            word = "} else "
        yield "}"


def is_row(node: Any, index: str) -> bool:
    """Whether an expression is a number, of this index, of a row of an array."""
    match node:
        case ast.Subscript(slice=ast.Tuple(elts=[ast.Constant(), ast.Name(id=name)])):
            return name == index
    return False


def indented(lines: Iterator[str]) -> Iterator[str]:
    """Lines further in."""
    for line in lines:
        yield f"  {line}" if line else line
