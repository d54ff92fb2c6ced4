"""Python's modules and classes as JavaScript."""

import ast
from collections.abc import Iterator

from tippetop.emit.program import Class, is_alias, names_in, safe
from tippetop.emit.statements import Statements, indented


class Definitions(Statements):
    """Translates what a module defines."""

    def module_lines(self) -> Iterator[str]:
        """All of a module, without its imports."""
        tree = self.program.trees[self.module]
        for node in tree.body:
            match node:
                case ast.FunctionDef(name=name) if name not in self.program.left:
                    yield from [
                        "",
                        *self._said(node),
                        *self.function_lines(node, f"function {self.name(name)}"),
                    ]
                case ast.ClassDef() if (known := self.program.classes.get(self.name(node.name))) is not None:
                    if known.node is node:
                        yield from ["", *self._class(known)]
                case ast.Assign(targets=targets, value=value) if names_in(targets[0]):
                    if all(self.program.resolve(self.module, name) for name in names_in(targets[0])):
                        yield f"const {self.pattern(targets[0])} = {self.text(value)};"
                case ast.AnnAssign(target=ast.Name(id=name), value=value) if value and not is_alias(node):
                    if self.program.resolve(self.module, name):
                        yield f"const {self.name(name)} = {self.text(value)};"

    def _said(self, node: ast.FunctionDef | ast.ClassDef) -> Iterator[str]:
        text = ast.get_docstring(node)
        if text:
            yield f"/** {text.splitlines()[0]} */"

    def _class(self, known: Class) -> Iterator[str]:
        node = known.node
        yield from self._said(node)
        if known.kind in ("enum", "number"):
            pairs = [
                (names_in(one.targets[0])[0], self.text(one.value))
                for one in node.body
                if isinstance(one, ast.Assign)
            ]
            inside = ", ".join(f"{name}: {value}" for name, value in pairs)
            if known.kind == "number":
                yield f"const {known.name} = Object.freeze({{ {inside} }});"
            else:
                yield f"class {known.name} extends py.Enum {{"
                yield from indented(self._members(known))
                yield "}"
                yield f"py.members({known.name}, {{ {inside} }});"
            return
        roots = {
            "tuple": "py.NamedTuple",
            "record": "py.Record",
            "part": "Part",
            "error": "py.ArithmeticError",
            "plain": "py.Thing",
        }
        base = known.bases[0] if known.bases else roots[known.kind]
        yield f"class {known.name} extends {base} {{"
        yield from indented(self._members(known))
        yield "}"
        names = ", ".join(f'"{name}"' for name in known.fields)
        if known.kind in ("tuple", "record"):
            yield f"py.fields({known.name}, [{names}]);"
        if known.kind == "part":
            yield f'Part.enter("{known.name}", {known.name});'

    def _members(self, known: Class) -> Iterator[str]:
        if known.kind in ("tuple", "record"):
            yield from self._constructor(known)
        for node in known.node.body:
            match node:
                case ast.AnnAssign(target=ast.Name(id=name), value=value) if value is not None:
                    if ast.unparse(node.annotation).startswith("ClassVar") and known.kind == "record":
                        yield f"get {name}() {{ return {self.text(value)}; }}"
                case ast.FunctionDef(name=name) if f"{known.name}.{name}" not in self.program.left:
                    if not is_abstract(node):
                        yield from self._said(node)
                        yield from self._method(node)

    def _constructor(self, known: Class) -> Iterator[str]:
        """The fields of the bases first, by their places."""
        names = [safe(name) for name in known.fields]
        pairs = zip(names, known.fields.values(), strict=True)
        self.hidden.append(set())
        given = [name if value is None else f"{name} = {self.text(value)}" for name, value in pairs]
        self.hidden.pop()
        above = [safe(name) for base in known.bases for name in self.program.classes[base].fields]
        if not names:
            return
        yield f"constructor({', '.join(given)}) {{"
        yield f"  super({', '.join(above)});"
        yield from (f"  this.{name} = {safe(name)};" for name in known.fields if safe(name) not in above)
        if any(
            isinstance(node, ast.FunctionDef) and node.name == "__post_init__" for node in known.node.body
        ):
            yield "  this.__post_init__();"
        yield "}"

    def _method(self, node: ast.FunctionDef) -> Iterator[str]:
        marks = {ast.unparse(mark).rpartition(".")[2].partition("(")[0] for mark in node.decorator_list}
        self.rebound = "self" in [n for one in ast.walk(node) for n in names_in(one) if n == "self"]
        head = "constructor" if node.name == "__init__" else safe(node.name)
        if marks & {"property", "cached_property"}:
            head = f"get {head}"
        elif marks & {"classmethod", "staticmethod"}:
            head = f"static {head}"
        yield from self.function_lines(node, head)
        self.rebound = False


def is_abstract(node: ast.FunctionDef) -> bool:
    """Whether a method says what others do, and does nothing."""
    marks = {ast.unparse(mark) for mark in node.decorator_list}
    return "abstractmethod" in marks
