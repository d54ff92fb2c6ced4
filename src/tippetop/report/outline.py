"""The order of the page: the story it opens with, the report's own sections, then ours."""

import tomllib
from pathlib import Path

REPORT_TITLE = "The Dynamics of Tippe Top and Numerical Simulation"
"""The title of the report, a student's project report."""

_TOLD = tomllib.loads(Path(__file__).with_name("outline.toml").read_text(encoding="utf-8"))

SECTIONS: dict[str, tuple[str, str]] = {
    one["name"]: (one["title"], one.get("words", "")) for one in _TOLD["sections"]
}
"""Titles and opening words of the page's sections, by what the report calls them; those without a
claim or a figure are left out.
"""

STORY: list[dict[str, str]] = _TOLD["story"]
"""What was found, in five parts: each has the name of a figure, a title, and a text in which
{claims[NAME][FIELD]} stands for a field of a claim in words and {quoted.NAME} for a constant.
"""

OWN = ("Why", "Friction", "Real tops")
"""The sections that are not the report's."""

UNCHECKED: list[dict[str, str]] = _TOLD["unchecked"]
"""Statements of the report without a verdict, in its order: their places, and the reasons."""


def section_of(place: str) -> str:
    """Return the section of the page that a section of the report is in: the one named most
    closely.

    Raises `LookupError` if there is none.
    """
    found = [key for key in SECTIONS if place.startswith(key)]
    if not found:
        raise LookupError(f"the page has no section for {place!r}")
    return max(found, key=len)
