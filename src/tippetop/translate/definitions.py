"""Translation of modules and classes."""

import ast
import json
from collections.abc import Iterator

from tippetop.translate.statements import Statements, indented
from tippetop.translate.symbols import (
    FORMS_OF_CLASS,
    OPERATORS,
    RECORDS,
    UNWRITTEN,
    Class,
    is_type,
    marks_of,
    safe,
    targets_of,
)


class Definitions(Statements):
    """Translates the definitions of a module."""

    def module_lines(self) -> Iterator[str]:
        """Yield a module without its imports."""
        for node in self.program.trees[self.module].body:
            if self.program.word(self.module, node):
                continue
            match node:
                case ast.FunctionDef(name=name):
                    yield ""
                    yield from first_line(node)
                    unique = self.program.names[self.module, name]
                    yield from self.function_lines(node, f"function {unique}")
                case ast.ClassDef():
                    one = self.program.class_of[node]
                    if one.kind not in UNWRITTEN:
                        yield ""
                        yield from first_line(node)
                        yield from self._class(one)
                case ast.Assign() | ast.AnnAssign() if not is_type(node):
                    assert node.value is not None
                    target, *others = targets_of(node)
                    if others:
                        raise self.refusal(node, "a constant has one name")
                    yield f"const {self.pattern(target)} = {self.text(node.value)};"
                case (
                    ast.Import()
                    | ast.ImportFrom()
                    | ast.Assign()
                    | ast.AnnAssign()
                    | ast.Expr(value=ast.Constant())
                    | ast.If(test=ast.Name("TYPE_CHECKING"))
                ):
                    pass
                case _:
                    raise self.refusal(node, "such a statement of a module is not translated")

    def _class(self, one: Class) -> Iterator[str]:
        for mark in set(marks_of(one.node)) - FORMS_OF_CLASS:
            raise self.refusal(one.node, f"decorator {mark} is not translated")
        bases = [base.name for base in one.bases if base.kind not in UNWRITTEN]
        yield f"class {one.name} extends {[*bases, one.kind][0]} {{"
        self.owner = one
        yield from indented(self._members(one))
        self.owner = None
        yield "}"

    def _members(self, one: Class) -> Iterator[str]:
        if one.kind == "Part":
            yield f'static title = "{one.name}";'
        if one.kind in RECORDS:
            yield f"static fields = {json.dumps(list(one.fields))};"
        if one.kind == "py.NamedTuple":
            yield from (
                f"get {place}() {{ return this.{name}; }}" for place, name in enumerate(one.fields)
            )
        if one.kind in RECORDS and one.fields:
            yield from self._constructor(one)
        for node in one.node.body:
            if self.program.word(self.module, node) == "":
                yield from self._member(one, node)

    def _member(self, one: Class, node: ast.stmt) -> Iterator[str]:
        match node:
            case ast.FunctionDef():
                yield from self._method(node)
            case ast.Assign(targets=[ast.Name(id=name)], value=value) if one.kind in (
                "py.Enum",
                "py.StrEnum",
            ):
                yield f'static {name} = new this("{name}", {self.text(value)});'
            case ast.Assign(targets=[ast.Name(id=name)], value=value) if one.kind == "py.IntEnum":
                yield f"static {name} = {self.text(value)};"
            case ast.Assign(targets=[ast.Name(id=name)], value=value):
                yield f"static {name} = {self.text(value)};"
                yield f"get {name}() {{ return {one.name}.{name}; }}"
            case ast.AnnAssign(target=ast.Name(id=name), annotation=kind, value=value):
                if value is not None and ast.unparse(kind).startswith("ClassVar"):
                    yield f"get {name}() {{ return {self.text(value)}; }}"
                elif value is not None and one.kind not in (*RECORDS, "Part"):
                    raise self.refusal(node, "a constant of a class is annotated ClassVar")
            case ast.Pass() | ast.Expr(value=ast.Constant()):
                pass
            case _:
                raise self.refusal(node, "such a statement of a class is not translated")

    def _constructor(self, one: Class) -> Iterator[str]:
        """Yield the constructor of a record, with the fields of its bases first."""
        arguments = [
            safe(name) if value is None else f"{safe(name)} = {self.default(value)}"
            for name, value in one.fields.items()
        ]
        above = [name for base in one.bases if base.kind not in UNWRITTEN for name in base.fields]
        yield f"constructor({', '.join(arguments)}) {{"
        yield f"  super({', '.join(map(safe, above))});"
        yield from (f"  this.{name} = {safe(name)};" for name in one.fields if name not in above)
        yield "}"

    def _method(self, node: ast.FunctionDef) -> Iterator[str]:
        marks = set(marks_of(node))
        if node.name.startswith("__") and node.name not in OPERATORS:
            raise self.refusal(node, f"method {node.name} is not called by the runtime")
        if "abstractmethod" in marks:
            return
        yield from first_line(node)
        if self.numpy and "cached_property" in marks:
            yield f"get {safe(node.name)}() {{"
            remembered = f'return py.remembered(this, "{node.name}", () => {{'
            yield from indented(iter([remembered]))
            yield from indented(indented(self._body(node)))
            yield from ("  });", "}")
            return
        head = "constructor" if node.name == "__init__" else safe(node.name)
        if marks & {"property", "cached_property"}:
            head = f"get {head}"
        elif marks & {"classmethod", "staticmethod"}:
            head = f"static {head}"
        yield from self.function_lines(node, head)


def first_line(node: ast.FunctionDef | ast.ClassDef) -> Iterator[str]:
    """Yield the first line of a docstring."""
    text = ast.get_docstring(node)
    if text:
        yield f"/** {text.splitlines()[0]} */"
