"""Reading of JSON and TOML texts into tables of fields."""

# translate module: skip

import json
import re
import tomllib
from collections.abc import Callable
from typing import Any

from tippetop.support.errors import InvalidInput, require
from tippetop.support.files import named
from tippetop.support.units import DIGITS

DEEPEST = 20
"""Largest depth of nested tables and lists in a text; problems are three deep."""


def parse_json(text: str, field: str, file: str = "") -> dict[str, Any]:
    """Return the fields of a JSON text.

    Raises `InvalidInput`, with `field` as its field and with the text or its file as the value, if
    the text is no JSON object, is nested deeper than `DEEPEST`, or holds whole numbers of thousands
    of digits.
    """
    return _parsed("JSON", json.loads, text, field, file)


def parse_toml(text: str, field: str, file: str = "") -> dict[str, Any]:
    """Return the fields of a TOML text; raise `InvalidInput` as `parse_json` does."""
    return _parsed("TOML", tomllib.loads, text, field, file)


def _parsed(
    language: str, loads: Callable[[str], Any], text: str, field: str, file: str
) -> dict[str, Any]:
    require(field, text, str, f"a text in {language}")
    try:
        fields = loads(text)
        _refuse_depths(fields)
    except (ValueError, RecursionError) as error:
        reason = _TOO_DEEP if isinstance(error, RecursionError) else str(error)
        if language == "TOML" and (bare := BARE_UNIT.search(text)):
            reason = f'write "{bare[1].strip()}" in quotation marks: {reason}'
        raise InvalidInput(field, file or text.strip(), "", f"is not {language}", reason) from None
    if not isinstance(fields, dict):
        raise InvalidInput(field, fields, f"a {language} object", file=file and named(file))
    return fields


BARE_UNIT = re.compile(
    rf"^[^#\"'\n]*=\s*([+-]?{DIGITS}[ \t]*[A-Za-zµ°/%][^#\"'\n]*)$", re.MULTILINE
)
"""A line of TOML that ends in a number with a unit outside quotation marks."""

_TOO_DEEP = f"tables and lists at most {DEEPEST} deep"


def _refuse_depths(value: Any) -> None:
    layer = [value]
    for _ in range(DEEPEST):
        layer = [
            inner
            for outer in layer
            if isinstance(outer, dict | list)
            for inner in (outer.values() if isinstance(outer, dict) else outer)
        ]
    if layer:
        raise ValueError(_TOO_DEEP)
