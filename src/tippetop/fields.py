"""Fields in parts of parts, by their names with dots."""

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


def table_at(fields: dict[str, Any], where: str) -> dict[str, Any]:
    """The table of this name, with dots; an empty one where there is none."""
    for name in where.split(".") if where else ():
        found = fields.get(name)
        fields = found if isinstance(found, dict) else {}
    return fields


def part_at(whole: object, where: str) -> Any:
    """The part of this name, with dots; None where there is none."""
    found: Any = whole
    for name in where.split("."):
        found = getattr(found, name, None)
    return found


def dotted_names(fields: Mapping[str, Any], prefix: str = "") -> Iterator[str]:
    """Every field's name with dots, depth first."""
    for name, value in fields.items():
        if isinstance(value, dict):
            yield from dotted_names(value, f"{prefix}{name}.")
        else:
            yield f"{prefix}{name}"
