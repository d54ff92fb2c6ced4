"""Accepted values of fields in words, and the refusals of all others."""

import inspect
import math
from collections.abc import Mapping
from typing import Any, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo
from pydantic_core import ErrorDetails

from tippetop.support.errors import MISSING, InvalidInput, short
from tippetop.support.suggestions import not_one_of
from tippetop.support.units import number_hint, written


def refusal_of(detail: ErrorDetails, fields: Mapping[str, FieldInfo]) -> InvalidInput:
    """Return the refusal of a field's value, made of an error of pydantic.

    `fields` are the declared fields by their names. For a number out of range whose field is not
    among them, the limits are taken from pydantic's error.
    """
    place = [*map(str, detail["loc"]), ""]
    field, value = ".".join(place[:-1]), detail["input"]
    info = fields.get(place[0])
    match detail["type"]:
        case "greater_than" | "greater_than_equal" | "less_than" | "less_than_equal":
            accepted = range_of(info) if info else _ranged(detail["ctx"])
            return InvalidInput(field, value, accepted, hint=degrees_hint(value, accepted))
        case "finite_number" | "float_type" | "float_parsing":
            hint = number_hint(value) if isinstance(value, str) else ""
            return InvalidInput(field, value, "a finite number", hint=hint)
        case "int_parsing" | "int_type":
            return InvalidInput(field, value, "a whole number")
        case "missing" if len(detail["loc"]) > 1 and (count := count_of(info)):
            return InvalidInput(place[0], value, f"{count} numbers")
        case "missing":
            return InvalidInput(field, MISSING, _accepted_values(info))
        case "literal_error":
            words = get_args(info.annotation) if info and len(place) == 2 else ()
            if words:
                return not_one_of(field, value, list(words))
            return InvalidInput(field, value, str(detail["ctx"]["expected"]))
        case "tuple_type" | "too_long" if count := count_of(fields.get(place[-2])):
            return InvalidInput(field, value, f"{count} numbers")
        case "tuple_type" | "list_type":
            return InvalidInput(field, value, "a list")
        case "too_short":
            return InvalidInput(field, value, f"a list of at least {detail['ctx']['min_length']}")
        case "too_long":
            return InvalidInput(field, value, f"a list of at most {detail['ctx']['max_length']}")
        case "model_type" | "model_attributes_type":
            return InvalidInput(field, value, "a table of its fields")
        case _:
            return InvalidInput(field, value, detail["msg"][0].lower() + detail["msg"][1:])


def degrees_hint(value: Any, accepted: str) -> str:
    """Return how to write an angle in degrees.

    "" unless the accepted values end at pi and the value lies between pi and 180.
    """
    angle = accepted.endswith("at most pi") and isinstance(value, float | int)
    if angle and math.pi < value <= 180.0:
        degrees = short(value)
        return f'for {degrees} degrees write {math.radians(value):.4g}, or "{degrees} deg"'
    return ""


def _accepted_values(info: FieldInfo | None) -> str:
    """Return in words what a field without a default takes."""
    kinds = (info.annotation, *get_args(info.annotation)) if info else ()
    if any(inspect.isclass(kind) and issubclass(kind, BaseModel) for kind in kinds):
        return "a table of its fields"
    if any(get_origin(kind) is tuple for kind in kinds):
        return f"{count_of(info)} numbers" if count_of(info) else "a list"
    declared = [item.units for item in info.metadata if hasattr(item, "units")] if info else []
    units = declared[0] if declared else ""
    return f"a number in {written(units)}" if units not in ("", "1") else "a value"


def count_of(info: FieldInfo | None) -> str:
    """Return how many numbers a field lists, in words; "" if it is no list of fixed length."""
    kinds = (info.annotation, *get_args(info.annotation)) if info else ()
    listed = [get_args(kind) for kind in kinds if get_origin(kind) is tuple]
    if not info or not listed or Ellipsis in listed[0]:
        return ""
    least = [f"{item.least} or " for item in info.metadata if hasattr(item, "least")]
    return f"{''.join(least)}{len(listed[0])}"


def range_of(info: FieldInfo) -> str:
    """Return the limits of a number in words: "a number greater than 0 and less than 1"."""
    # Of a field that may be omitted, the limits are those of one of its types.
    kinds = (info.annotation, *get_args(info.annotation))
    inner = [item for kind in kinds for item in getattr(kind, "__metadata__", ())]
    limits = {
        name: getattr(constraint, name)
        for constraint in (*info.metadata, *inner, *[one for item in inner for one in stated(item)])
        for name in _LIMITS
        if getattr(constraint, name, None) is not None
    }
    is_whole = any(int in (kind, getattr(kind, "__origin__", None)) for kind in kinds)
    return _ranged(limits, "a whole number" if is_whole else "a number")


def stated(item: Any) -> list[Any]:
    """Return the constraints that an item of a type's metadata states."""
    return item.metadata if isinstance(item, FieldInfo) else []


_LIMITS = {"gt": "greater than", "ge": "at least", "lt": "less than", "le": "at most"}


def _ranged(limits: Mapping[str, Any], kind: str = "a number") -> str:
    """Return a kind of number with its limits, in words."""
    bounds = [
        f"{words} {'pi' if limits[name] == math.pi else format(limits[name], 'g')}"
        for name, words in _LIMITS.items()
        if name in limits
    ]
    return f"{kind} {' and '.join(bounds)}"
