"""Order of the page: the opening story, the report's sections, and the sections added to them."""

import tomllib
from pathlib import Path

REPORT_TITLE = "The Dynamics of Tippe Top and Numerical Simulation"
"""Title of the report, a student's project report."""

_TABLES = tomllib.loads(Path(__file__).with_name("outline.toml").read_text(encoding="utf-8"))

SECTIONS: dict[str, tuple[str, str]] = {
    section["name"]: (section["title"], section.get("words", "")) for section in _TABLES["sections"]
}
"""Titles and opening texts of the page's sections, by name; a section without content is left
out.
"""

STORY: list[dict[str, str]] = _TABLES["story"]
"""The story that opens the page: for each part the name of a figure, a title and a text.

In the texts, {claims[NAME][FIELD]} stands for a field of a claim in words, and
{printed_numbers.NAME} for a constant.
"""

ADDED_SECTIONS = ("Why", "Friction", "Real tops")
"""Sections of the page that the report does not have."""

UNCHECKED: list[dict[str, str]] = _TABLES["unchecked"]
"""Statements of the report that are not judged, in its order: places and reasons."""


def section_of(place: str) -> str:
    """Return the section of the page for a section of the report: the one with the longest matching
    name.

    Raises `LookupError` if there is none.
    """
    matching = [key for key in SECTIONS if place.startswith(key)]
    if not matching:
        raise LookupError(f"the page has no section for {place!r}")
    return max(matching, key=len)
