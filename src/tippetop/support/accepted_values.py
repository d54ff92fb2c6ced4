"""What fields accept, in words."""

import math
from collections.abc import Mapping
from typing import Any, get_args, get_origin

from pydantic.fields import FieldInfo
from pydantic_core import ErrorDetails

from tippetop.support.errors import one_of


def accepted_by(detail: ErrorDetails, fields: Mapping[str, FieldInfo]) -> str:
    """What some fields, by their names, would accept instead, from the kind of validation error.

    Without the field of a number that is out of its range, these are the limits that the error has.
    """
    place = [*map(str, detail["loc"]), ""]
    match detail["type"]:
        case "greater_than" | "greater_than_equal" | "less_than" | "less_than_equal":
            return range_of(fields[place[0]]) if place[0] in fields else _ranged(detail["ctx"])
        case "finite_number" | "float_type" | "float_parsing":
            return "a finite number"
        case "int_parsing":
            return "a whole number"
        case "missing":
            return "a value; it has no default"
        case "extra_forbidden":
            return "one of the keys " + one_of(place[-2], list(fields))
        case "literal_error":
            return str(detail["ctx"]["expected"])
        case "tuple_type" | "too_long" if count := _length(fields.get(place[-2])):
            return f"{count} numbers"
        case "tuple_type" | "list_type":
            return "a list"
        case "too_short":
            return f"at least {detail['ctx']['min_length']} of them"
        case "too_long":
            return f"at most {detail['ctx']['max_length']} of them"
        case "model_type" | "model_attributes_type":
            return "a table of its fields"
        case _:
            return detail["msg"][0].lower() + detail["msg"][1:]


def _length(info: FieldInfo | None) -> int:
    """How many numbers a field lists; 0 where that is not said."""
    kinds = (info.annotation, *get_args(info.annotation)) if info else ()
    listed = [get_args(kind) for kind in kinds if get_origin(kind) is tuple]
    return len(listed[0]) if listed and Ellipsis not in listed[0] else 0


def range_of(info: FieldInfo) -> str:
    """The constraints of a number in words: "a number greater than 0 and less than 1"."""
    limits = {
        name: getattr(constraint, name)
        for constraint in info.metadata
        for name in _LIMITS
        if getattr(constraint, name, None) is not None
    }
    return _ranged(limits, "a whole number" if info.annotation is int else "a number")


_LIMITS = {"gt": "greater than", "ge": "at least", "lt": "less than", "le": "at most"}


def _ranged(limits: Mapping[str, Any], kind: str = "a number") -> str:
    """A kind of number within some limits."""
    bounds = [
        f"{words} {'pi' if limits[name] == math.pi else format(limits[name], 'g')}"
        for name, words in _LIMITS.items()
        if name in limits
    ]
    return f"{kind} {' and '.join(bounds)}"
