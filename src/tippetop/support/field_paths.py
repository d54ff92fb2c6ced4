"""Fields in parts of parts, by their names with dots."""

# translate module: by hand in part.js

from collections.abc import Iterator, Mapping
from typing import Any


def numbers_of(value: Any, name: str = "") -> Iterator[tuple[str, float]]:
    """Every number in the fields, with its name with dots."""
    match value:
        case dict():
            for field, inner in value.items():
                yield from numbers_of(inner, f"{name}.{field}" if name else field)
        case tuple():
            for index, inner in enumerate(value):
                yield from numbers_of(inner, f"{name}.{index}")
        case float():
            yield name, value


def part_at(whole: Any, where: str) -> Any:
    """What has this name, with dots, in tables, tuples and objects; None where there is nothing."""
    for name in where.split(".") if where else ():
        if isinstance(whole, dict):
            whole = whole.get(name)
        elif isinstance(whole, tuple) and is_place(name, whole):
            whole = whole[int(name)]
        else:
            whole = getattr(whole, name, None)
    return whole


def table_at(fields: dict[str, Any], where: str) -> dict[str, Any]:
    """The table of this name, with dots; an empty one where there is none."""
    found = part_at(fields, where)
    return found if isinstance(found, dict) else {}


def with_its_list(fields: dict[str, Any], name: str, value: Any) -> tuple[str, Any]:
    """A field and a value for it; of what is in a list, named by its place, the list with that in
    it.
    """
    where, _, place = name.rpartition(".")
    whole = part_at(fields, where)
    if not (isinstance(whole, tuple) and is_place(place, whole)):
        return name, value
    return with_its_list(fields, where, (*whole[: int(place)], value, *whole[int(place) + 1 :]))


def is_place(name: str, whole: tuple[Any, ...]) -> bool:
    """Whether a name counts a place that a list has: 0, 1, ..., written in one way."""
    return name in map(str, range(len(whole)))


def dotted_names(fields: Mapping[str, Any], prefix: str = "") -> Iterator[str]:
    """Every field's name with dots, depth first."""
    for name, value in fields.items():
        if isinstance(value, dict):
            yield from dotted_names(value, f"{prefix}{name}.")
        elif isinstance(value, tuple) and value and isinstance(value[0], dict):
            yield from dotted_names(
                {str(k): inner for k, inner in enumerate(value)}, f"{prefix}{name}."
            )
        else:
            yield f"{prefix}{name}"
