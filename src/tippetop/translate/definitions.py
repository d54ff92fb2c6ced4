"""Python's modules and classes as JavaScript."""

import ast
import json
from collections.abc import Iterator

from tippetop.translate.program import RECORDS, Class, is_type, marks_of, safe, targets_of
from tippetop.translate.statements import Statements, indented


class Definitions(Statements):
    """Translates what a module defines."""

    def module_lines(self) -> Iterator[str]:
        """All of a module, without its imports."""
        for node in self.program.trees[self.module].body:
            match node:
                case ast.FunctionDef(name=name) if name not in self.program.left:
                    yield ""
                    yield from said(node)
                    yield from self.function_lines(node, f"function {self.name(name)}")
                case ast.ClassDef() if (
                    known := self.program.classes.get(self.name(node.name))
                ) is not None:
                    if known.node is node:
                        yield ""
                        yield from said(node)
                        yield from self._class(known)
                case ast.Assign(value=value) | ast.AnnAssign(value=ast.expr() as value) if (
                    not is_type(node)
                ):
                    yield f"const {self.pattern(targets_of(node)[0])} = {self.text(value)};"

    def _class(self, known: Class) -> Iterator[str]:
        yield f"class {known.name} extends {[*known.bases, known.kind][0]} {{"
        yield from indented(self._members(known))
        yield "}"

    def _members(self, known: Class) -> Iterator[str]:
        if known.kind == "Part":
            yield f'static title = "{known.name}";'
        if known.kind in RECORDS:
            yield f"static fields = {json.dumps(list(known.fields))};"
        if known.kind == "py.NamedTuple":
            yield from (
                f"get {place}() {{ return this.{name}; }}"
                for place, name in enumerate(known.fields)
            )
        if known.kind in RECORDS and known.fields:
            yield from self._constructor(known)
        for node in known.node.body:
            match node:
                case ast.Assign(targets=[ast.Name(id=name)], value=value) if (
                    known.kind == "py.Enum"
                ):
                    yield f'static {name} = new this("{name}", {self.text(value)});'
                case ast.Assign(targets=[ast.Name(id=name)], value=value) if (
                    known.kind == "py.Thing"
                ):
                    yield f"static {name} = {self.text(value)};"
                case ast.AnnAssign(target=ast.Name(id=name), value=ast.expr() as value):
                    if (
                        ast.unparse(node.annotation).startswith("ClassVar")
                        and known.kind == "py.Record"
                    ):
                        yield f"get {name}() {{ return {self.text(value)}; }}"
                case ast.FunctionDef(name=name) if f"{known.name}.{name}" not in self.program.left:
                    yield from self._method(node)

    def _constructor(self, known: Class) -> Iterator[str]:
        """The fields of the bases first, by their places."""
        given = [
            safe(name) if value is None else f"{safe(name)} = {self.text(value)}"
            for name, value in known.fields.items()
        ]
        above = [name for base in known.bases for name in self.program.classes[base].fields]
        yield f"constructor({', '.join(given)}) {{"
        yield f"  super({', '.join(map(safe, above))});"
        yield from (f"  this.{name} = {safe(name)};" for name in known.fields if name not in above)
        yield "}"

    def _method(self, node: ast.FunctionDef) -> Iterator[str]:
        marks = set(marks_of(node))
        if "abstractmethod" in marks:
            return
        yield from said(node)
        head = "constructor" if node.name == "__init__" else safe(node.name)
        if marks & {"property", "cached_property"}:
            head = f"get {head}"
        elif marks & {"classmethod", "staticmethod"}:
            head = f"static {head}"
        yield from self.function_lines(node, head)


def said(node: ast.FunctionDef | ast.ClassDef) -> Iterator[str]:
    """The first line of a docstring."""
    text = ast.get_docstring(node)
    if text:
        yield f"/** {text.splitlines()[0]} */"
