"""Fields of nested parts, addressed by dotted names such as "body.shape.radius"."""

# translate module: by hand in part.js

from collections.abc import Iterator, Mapping
from typing import Any


def numbers_of(value: Any, name: str = "") -> Iterator[tuple[str, float]]:
    """Yield every number in the fields, with its dotted name."""
    match value:
        case dict():
            for field, inner in value.items():
                yield from numbers_of(inner, f"{name}.{field}" if name else field)
        case tuple():
            for index, inner in enumerate(value):
                yield from numbers_of(inner, f"{name}.{index}")
        case float():
            yield name, value


def part_at(value: Any, where: str) -> Any:
    """Return the value of a dotted name in nested tables, tuples and objects; None without one."""
    for name in where.split(".") if where else ():
        if isinstance(value, dict):
            value = value.get(name)
        elif isinstance(value, tuple) and is_place(name, value):
            value = value[int(name)]
        else:
            value = getattr(value, name, None)
    return value


def table_at(fields: dict[str, Any], where: str) -> dict[str, Any]:
    """Return the table of a dotted name; an empty one if there is none."""
    table = part_at(fields, where)
    return table if isinstance(table, dict) else {}


def with_its_list(fields: dict[str, Any], name: str, value: Any) -> tuple[str, Any]:
    """Return a field and its new value; for a place in a list, the list's field and the new
    list.
    """
    where, _, place = name.rpartition(".")
    values = part_at(fields, where)
    if not (isinstance(values, tuple) and is_place(place, values)):
        return name, value
    return with_its_list(fields, where, (*values[: int(place)], value, *values[int(place) + 1 :]))


def is_place(name: str, values: tuple[Any, ...]) -> bool:
    """Return whether a name is the number of a place in a list: "0", "1", ...."""
    return name in map(str, range(len(values)))


def dotted_names(fields: Mapping[str, Any], prefix: str = "") -> Iterator[str]:
    """Yield the dotted name of every field, depth first."""
    for name, value in fields.items():
        if isinstance(value, dict):
            yield from dotted_names(value, f"{prefix}{name}.")
        elif isinstance(value, tuple) and value and isinstance(value[0], dict):
            yield from dotted_names(
                {str(k): inner for k, inner in enumerate(value)}, f"{prefix}{name}."
            )
        else:
            yield f"{prefix}{name}"
