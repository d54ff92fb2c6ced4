"""The fields that texts in JSON and TOML hold."""

# translate module: skip

import json
import tomllib
from collections.abc import Callable
from typing import Any

from tippetop.support.errors import InvalidInput, require
from tippetop.support.files import named

DEEPEST = 20
"""How deep tables and lists may be nested in a text; a problem's are three deep."""


def parse_json(text: str, field: str, file: str = "") -> dict[str, Any]:
    """The fields of a JSON text that states something, which is called a field in sentences.

    They show the text, or its file if it has one.

    Raises `InvalidInput` if it is no JSON object, is nested deeper than `DEEPEST`, or holds whole
    numbers of thousands of digits.
    """
    return _parsed("JSON", json.loads, text, field, file)


def parse_toml(text: str, field: str, file: str = "") -> dict[str, Any]:
    """The same of a TOML text."""
    return _parsed("TOML", tomllib.loads, text, field, file)


def _parsed(
    language: str, loads: Callable[[str], Any], text: str, field: str, file: str
) -> dict[str, Any]:
    require(field, text, str, f"a text in {language}")
    try:
        fields = loads(text)
        _refuse_depths(fields)
    except (ValueError, RecursionError) as error:
        told = _TOO_DEEP if isinstance(error, RecursionError) else error
        raise InvalidInput(
            field, file or text.strip(), "", f"is not {language}", str(told)
        ) from None
    if not isinstance(fields, dict):
        raise InvalidInput(field, fields, f"a {language} object", file=file and named(file))
    return fields


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
