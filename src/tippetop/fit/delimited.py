"""Tables of numbers from text as video analysis and spreadsheets export it."""

import re
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from tippetop.integrators.base import Array
from tippetop.support.errors import InvalidInput

HEADER = re.compile(r"(?P<name>[^(\[/]*?)\s*(?:[(\[](?P<unit>[^)\]]*)[)\]]|/\s*(?P<slash>\S+))?")
"""A column's name, and its unit as in "t (s)", "t [s]" or "t / s"."""

DECIMAL_COMMA = re.compile(r"[+-]?\d*,\d+(?:[eE][+-]?\d+)?")

EMPTY_CELLS = {"", "nan", "na", "n/a", "-", "--"}
"""What stands in the cells of frames in which nothing was marked."""

MULTIPLE_TRACKS = "#multi:"
"""First line of an export of Tracker that has several tracks side by side."""


class DataColumn(NamedTuple):
    """A column of a table."""

    name: str
    unit: str
    """As the header states it; empty if it states none."""
    cells: tuple[str, ...]
    lines: tuple[int, ...]
    """Number of each cell's line in the text, counted from 1."""

    def numbers(self) -> Array:
        """Return the numbers of the cells, NaN for empty ones; refuse text."""
        comma = any(DECIMAL_COMMA.fullmatch(cell) for cell in self.cells)
        return np.array([self._number(place, comma) for place in range(len(self.cells))])

    def _number(self, place: int, comma: bool) -> float:
        cell = self.cells[place]
        if cell.lower() in EMPTY_CELLS:
            return np.nan
        try:
            number = float(cell.replace(",", ".") if comma else cell)
        except ValueError:
            number = np.nan
        if not np.isfinite(number):
            field = f"column {self.name}, line {self.lines[place]}"
            raise InvalidInput(
                field, cell, "a number", hint="leave the cell empty if there is none"
            )
        return number


def read_columns(text: str, track: str | None = None) -> dict[str, DataColumn]:
    """Return the columns of a table by their names in lower case.

    Cells are separated by tabs, semicolons, commas or spaces; numbers have a point or, where commas
    do not separate cells, a comma. Lines that begin with # are left out. The header is the last
    line before the first number. Of several tracks in an export of Tracker, `track` names one.

    Raises
    ------
    InvalidInput
        If the text is empty, has no header, or lines of different lengths.
    """
    multiple = text.lstrip().lower().startswith(MULTIPLE_TRACKS)
    lines = [
        (number, line)
        for number, line in enumerate(text.splitlines(), 1)
        if line.strip() and not line.lstrip().startswith("#")
    ]
    first = next((place for place, (_, line) in enumerate(lines) if _has_number(line)), None)
    if first is None:
        raise InvalidInput("data", text[:40], "a table with a header and numbers", "has no numbers")
    if first == 0:
        hint = "write one above the numbers, such as t,tilt"
        raise InvalidInput("data", lines[0][1], "", "is the first line: there is no header", hint)
    separator = _separator(lines[first - 1][1], lines[first][1])
    names = _without_last_empty(_cells(lines[first - 1][1], separator))
    tracks = _cells(lines[first - 2][1], separator) if multiple and first > 1 else []
    places = _places_of_track(names, tracks, track)
    rows = [(number, _cells(line, separator)) for number, line in lines[first:]]
    width = len(names)
    for number, cells in rows:
        short = len(cells) < (width if separator in (None, ",") else 1)
        if short or any(cells[width:]):
            shown = f"{len(cells)} cells"
            raise InvalidInput(f"line {number}", shown, f"{width} cells, as the header has")
    columns = dict[str, DataColumn]()
    for place in places:
        name, unit = _name_and_unit(names[place])
        if name and name not in columns:
            column = tuple(cells[place] if place < len(cells) else "" for _, cells in rows)
            columns[name] = DataColumn(name, unit, column, tuple(number for number, _ in rows))
    return columns


def _has_number(line: str) -> bool:
    """Return whether a line has a number in its first or second cell."""
    cells = [cell for cell in re.split(r"[\t;, ]+", line.strip()) if cell][:3]
    return any(re.fullmatch(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", cell) for cell in cells)


def _separator(header: str, row: str) -> str | None:
    """Return what separates cells; None for spaces."""
    for separator in ("\t", ";"):
        if separator in header.strip() or separator in row.strip():
            return separator
    return "," if "," in header else None


def _cells(line: str, separator: str | None) -> list[str]:
    """Return the cells of a line."""
    if separator is None:
        # A unit stands apart from its column's name: "t (s)".
        return re.findall(r"[^\s(\[]+(?:\s*[(\[][^)\]]*[)\]])?", line)
    return [cell.strip().strip('"') for cell in line.rstrip("\r\n").split(separator)]


def _without_last_empty(names: Sequence[str]) -> list[str]:
    """Return the names without empty ones at the end, which a last separator makes."""
    return list(names[: max((place + 1 for place, name in enumerate(names) if name), default=0)])


def _places_of_track(names: Sequence[str], tracks: Sequence[str], track: str | None) -> list[int]:
    """Return the places of the columns of a track, and of the time, which all share."""
    starts = [place for place, name in enumerate(tracks) if name]
    if not starts:
        return list(range(len(names)))
    choices = [tracks[start] for start in starts]
    if track not in choices and len(choices) > 1:
        accepted = f"one of {', '.join(choices)}"
        raise InvalidInput("track", track, accepted, "is no track of this file")
    chosen = choices.index(track) if track in choices else 0
    end = starts[chosen + 1] if chosen + 1 < len(starts) else len(names)
    return [0, *(place for place in range(starts[chosen], end) if place)]


def _name_and_unit(header: str) -> tuple[str, str]:
    """Return the name of a column in lower case, and its unit."""
    match = HEADER.fullmatch(header.strip())
    if match is None:
        return header.strip().lower(), ""
    return match["name"].strip().lower(), (match["unit"] or match["slash"] or "").strip()
