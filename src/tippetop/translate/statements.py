"""Python's statements and functions as JavaScript."""

import ast
from collections.abc import Iterator, Sequence
from typing import Any

from tippetop.translate.calls import Calls
from tippetop.translate.expressions import ATOM, LESS
from tippetop.translate.program import bound, given, marks_of, names_in, targets_of, within


class Statements(Calls):
    """Translates the statements and functions of a module."""

    def function_lines(self, node: ast.FunctionDef, head: str) -> Iterator[str]:
        """A function or method; what it yields makes it a generator."""
        given, known = self.function(node), set(marks_of(node)) & {"cache", "lru_cache"}
        if any(isinstance(one, ast.Yield) for one in within(node)):
            head = head.replace("function ", "function* ") if " " in head else f"*{head}"
        yield f"const {head.split()[1]} = py.cached({given} => {{" if known else f"{head}{given} {{"
        yield from indented(self._body(node))
        yield "});" if known else "}"

    def _body(self, node: ast.FunctionDef) -> Iterator[str]:
        outer, self.declared = self.declared, given(node)
        self.scopes.append(bound(node))
        if node.name == "__init__" and "super().__init__" not in ast.unparse(node):
            yield "super();"
        yield from self._block(node.body)
        self.scopes.pop()
        self.declared = outer

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
            case ast.Expr(value=ast.Call(func=ast.Name(id=name))) if name in self.program.left:
                return
            case ast.Expr(value=value):
                yield f"{self.text(value)};"
            case ast.Return(value=value):
                yield "return null;" if value is None else f"return {self.text(value)};"
            case ast.Assign(targets=[ast.Tuple() as places], value=ast.Tuple() as given) if (
                is_each_its_own(places, given)
            ):
                for target, value in zip(places.elts, given.elts, strict=True):
                    yield self._assigned(target, self.text(value))
            case ast.Assign(value=value) | ast.AnnAssign(value=ast.expr() as value):
                said = self.text(value)
                for target in targets_of(node):
                    yield self._assigned(target, said)
            case ast.AugAssign(target=target, op=op, value=value):
                yield self._assigned(target, self.text(ast.BinOp(target, op, value)))
            case ast.If():
                yield from self._choice(node)
            case ast.While(test=test, body=body):
                yield f"while ({self.truth(test)}) {{"
                yield from indented(self._block(body))
                yield "}"
            case ast.For():
                yield from self._loop(node)
            case ast.FunctionDef(name=name):
                yield f"{self._var(name)}{self.name(name)} = {self.function(node)} => {{"
                yield from indented(self._body(node))
                yield "};"
            case ast.Raise(exc=ast.Name() as error):
                yield f"throw new {self.text(error)}();"
            case ast.Raise(exc=ast.expr() as error):
                yield f"throw {self.text(error)};"
            case ast.Break():
                yield "break;"
            case ast.Continue():
                yield "continue;"
            case ast.Try(handlers=[handler], orelse=[], finalbody=[]) if handler.type is not None:
                yield "try {"
                yield from indented(self._block(node.body))
                yield "} catch (error) {"
                yield f"  if (!(error instanceof {self.text(handler.type)})) throw error;"
                yield from indented(self._block(handler.body))
                yield "}"
            case ast.With(items=[place], body=body) if ast.unparse(place).startswith(
                "np.errstate("
            ):
                yield from ("py.heed(false);", "try {")
                yield from indented(self._block(body))
                yield from ("} finally {", "  py.heed(true);", "}")
            case _:
                raise self.refused(node)

    def _var(self, *names: str) -> str:
        """What declares names in all of a function, as Python does, before they are first written
        there.
        """
        new = not self.declared.issuperset(names)
        self.declared.update(names)
        return "var " if new else ""

    def _assigned(self, target: ast.expr, value: str) -> str:
        match target:
            case ast.Subscript(value=whole, slice=place):
                if self.numeric:
                    return f"{self.text(target)} = {value};"
                return f"py.put({self.text(whole, ATOM)}, {self.text(place)}, {value});"
        return f"{self._var(*names_in(target))}{self.pattern(target)} = {value};"

    def _choice(self, node: ast.If) -> Iterator[str]:
        yield f"if ({self.truth(node.test)}) {{"
        yield from indented(self._block(node.body))
        match node.orelse:
            case [ast.If() as other]:
                first, *rest = self._choice(other)
                yield from (f"}} else {first}", *rest)
            case []:
                yield "}"
            case _:
                yield "} else {"
                yield from indented(self._block(node.orelse))
                yield "}"

    def _loop(self, node: ast.For) -> Iterator[str]:
        match node:
            case ast.For(
                target=ast.Name(id=name), iter=ast.Call(func=ast.Name("range"), args=args)
            ):
                i = self.name(name) if name != "_" else "turn"
                start = self.text(args[0]) if len(args) > 1 else "0"
                stop = self.text(args[1] if len(args) > 1 else args[0], LESS)
                step = self.text(args[2]) if len(args) > 2 else "1"
                sign = ">" if step.startswith("-") else "<"
                # Rows of arrays whose numbers are gone through are looked up once.
                rows: list[Any] = [
                    one for inner in node.body for one in ast.walk(inner) if is_row(one, name)
                ]
                found = sorted(
                    {(self.text(one.value), self.text(one.slice.elts[0])) for one in rows}
                )
                self.rows = {f"{whole}[{place}]": f"{whole}{place}" for whole, place in found}
                yield from (f"var {own} = {row};" for row, own in self.rows.items())
                self._var(name)
                yield f"for (var {i} = {start}; {i} {sign} {stop}; {i} += {step}) {{"
            case _:
                self._var(*names_in(node.target))
                yield f"for (var {self.pattern(node.target)} of {self.text(node.iter)}) {{"
        yield from indented(self._block(node.body))
        self.rows = {}
        yield "}"


def is_each_its_own(places: ast.Tuple, values: ast.Tuple) -> bool:
    """Whether names are bound one after the other to values in which none of them is."""
    names = {
        node.id for place in places.elts for node in ast.walk(place) if isinstance(node, ast.Name)
    }
    read = {node.id for node in ast.walk(values) if isinstance(node, ast.Name)}
    plain = all(isinstance(place, ast.Name) for place in places.elts)
    starred = any(isinstance(value, ast.Starred) for value in values.elts)
    return plain and not starred and not names & read


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
