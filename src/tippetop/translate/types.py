"""Types of expressions, as far as annotations and constructors determine them."""

import ast
from typing import NamedTuple

from tippetop.translate.symbols import Class


class Type(NamedTuple):
    """The type of an expression."""

    kind: str
    """"any" if it is unknown, "union", "none", "bool", "int", "float", "str", "list", "tuple",
    "sequence", "set", "dict", "iterator", "array", "instance", "class", "function" or "module".
    """
    parts: tuple["Type", ...] = ()
    """Alternatives of a union, items of a tuple, the item of another collection, key and value of a
    dict, or the value that a function returns.
    """
    cls: Class | None = None
    """The class of an instance, or the class itself, or the owner of a method."""
    node: ast.FunctionDef | ast.Lambda | None = None
    """Definition of a function."""
    module: str = ""
    """Module of the definition."""


ANY, NONE, BOOL, INT, FLOAT, STR, ARRAY = map(
    Type, ("any", "none", "bool", "int", "float", "str", "array")
)
NEVER = Type("union")
"""Type of a value that does not occur as far as inference has come."""

BASIC = {
    "bool": BOOL,
    "int": INT,
    "float": FLOAT,
    "str": STR,
    "list": Type("list"),
    "tuple": Type("tuple"),
    "dict": Type("dict"),
    "set": Type("set"),
}

COLLECTIONS = {
    "list": "list",
    "set": "set",
    "frozenset": "set",
    "AbstractSet": "set",
    "dict": "dict",
    "Mapping": "dict",
    "tuple": "tuple",
    "Sequence": "sequence",
    "Iterable": "iterator",
    "Iterator": "iterator",
    "Generator": "iterator",
}
"""Kind of collection per name in an annotation."""

NUMBERS = ("bool", "int", "float")
ROWS = ("list", "tuple", "sequence")


def union(types: list[Type]) -> Type:
    """Return the type of a value that has one of some types."""
    alternatives = list[Type]()
    for one in types:
        alternatives += [part for part in alternatives_of(one) if part not in alternatives]
    if ANY in alternatives:
        return ANY
    return alternatives[0] if len(alternatives) == 1 else Type("union", tuple(alternatives))


def alternatives_of(one: Type) -> tuple[Type, ...]:
    """Return the types of a union, or the type itself."""
    return one.parts if one.kind == "union" else (one,)


def kinds_of(one: Type) -> set[str]:
    """Return the kinds of a type's alternatives, without none."""
    return {part.kind for part in alternatives_of(one)} - {"none"}


def is_only(one: Type, *kinds: str) -> bool:
    """Return whether a type is certainly one of some kinds."""
    possible = kinds_of(one)
    return bool(possible) and possible <= set(kinds)


def item_of(one: Type, place: int | None = None) -> Type:
    """Return the type of an item of a collection, at a place if it is given."""
    items = list[Type]()
    for part in alternatives_of(one):
        if part.kind == "tuple" and place is not None and -len(part.parts) <= place:
            items.append(part.parts[place] if place < len(part.parts) else ANY)
        elif part.kind in ("list", "tuple", "sequence", "set", "iterator") and part.parts:
            items.append(union(list(part.parts)))
        elif part.kind == "dict" and part.parts:
            items.append(part.parts[0])
        elif part.kind == "str":
            items.append(STR)
        elif part.kind != "none":
            return ANY
    return union(items)
