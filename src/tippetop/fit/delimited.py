"""Tables of numbers from text as video analysis and spreadsheets export it."""

import contextlib
import re
from collections.abc import Sequence
from importlib import import_module
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from tippetop.fit.headings import NAMES, heading_of
from tippetop.integrators.base import Array
from tippetop.support.errors import InvalidInput, Unavailable
from tippetop.support.files import in_words

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
    line before the first number. Of several tracks in an export of Tracker, `track` names one;
    places in such a file are in metres.

    Raises
    ------
    InvalidInput
        If the text is empty, has no header, or lines of different lengths.
    """
    is_multiple = text.lstrip().lower().startswith(MULTIPLE_TRACKS)
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
    tracks = _cells(lines[first - 2][1], separator) if first > 1 else []
    is_of_tracker = is_multiple or sum(map(bool, tracks)) == 1
    places = _places_of_track(names, tracks if is_of_tracker else [], track)
    rows = [(number, _cells(line, separator)) for number, line in lines[first:]]
    width = len(names)
    for number, cells in rows:
        short = len(cells) < (width if separator in (None, ",") else 1)
        if short or any(cells[width:]):
            shown = f"{len(cells)} cells"
            raise InvalidInput(f"line {number}", shown, f"{width} cells, as the header has")
    columns = dict[str, DataColumn]()
    for place in places:
        name, unit = heading_of(names[place])
        if is_of_tracker and name in ("x", "y") and not unit:
            unit = "m"  # What Tracker's calibration made of its pixels.
        if name and name not in columns:
            column = tuple(cells[place] if place < len(cells) else "" for _, cells in rows)
            columns[name] = DataColumn(name, unit, column, tuple(number for number, _ in rows))
    return columns


def _has_number(line: str) -> bool:
    """Return whether a line has a number in one of its first three cells."""
    separators = next((each for each in ("\t;", ",") if set(each) & set(line.strip())), " ")
    cells = re.split(f"[{separators}]+", line.strip())[:3]
    return any(
        re.fullmatch(r"[+-]?(\d+[.,]?\d*|[.,]\d+)([eE][+-]?\d+)?", cell.strip()) for cell in cells
    )


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
    """Return the places of the columns of a track, and of the time, which all share.

    Tracks without names are numbered from 1.
    """
    titles = [heading_of(name).name for name in names]
    starts = [place for place, name in enumerate(tracks) if name]
    choices = [tracks[start] for start in starts]
    if len(starts) <= 1:
        starts = [place for place, title in enumerate(titles) if place and title == "x"]
        choices = (
            choices if len(starts) <= 1 else [str(number + 1) for number in range(len(starts))]
        )
    if track is None and len(choices) <= 1:
        return list(range(len(names)))
    if track not in choices:
        accepted = f"one of {', '.join(choices)}" if choices else "none: the file has one, unnamed"
        raise InvalidInput("track", track, accepted, "is no track of this file")
    if len(choices) == 1:
        return list(range(len(names)))
    chosen = choices.index(track)
    end = starts[chosen + 1] if chosen + 1 < len(starts) else len(names)
    return [0, *(place for place in range(starts[chosen], end) if place)]


def columns_of_frame(frame: Any) -> dict[str, DataColumn]:
    """Return the columns of a pandas DataFrame, or of a mapping of headings to numbers."""
    columns = dict[str, DataColumn]()
    for heading in frame:
        values = np.asarray(frame[heading])
        if values.ndim != 1:
            raise InvalidInput(str(heading), f"an array of {values.ndim} dimensions", "numbers")
        cells = tuple("" if value is None else str(value) for value in values.tolist())
        name, unit = heading_of(str(heading))
        columns.setdefault(name, DataColumn(name, unit, cells, tuple(range(1, len(cells) + 1))))
    lengths = {len(column.cells) for column in columns.values()}
    if len(lengths) > 1:
        shown = ", ".join(map(str, sorted(lengths)))
        raise InvalidInput("data", f"columns of {shown} numbers", "columns of one length")
    return columns


def text_of_bytes(content: bytes) -> str | None:
    """Return the text of a table in the encodings of Excel and Tracker; None if it is no text.

    They are UTF-8 and UTF-16, and where Windows is set to German or Chinese, its code pages. Of
    these the one is taken in which more headings are known.
    """
    if content[:2] in (b"\xff\xfe", b"\xfe\xff"):
        return content.decode("utf-16", errors="replace")
    with contextlib.suppress(UnicodeDecodeError):
        return content.decode("utf-8-sig")
    if b"\0" in content:
        return None
    texts = list[str]()
    for encoding in ("cp1252", "gbk", "latin-1"):
        with contextlib.suppress(UnicodeDecodeError):
            texts.append(content.decode(encoding))
    return max(texts, key=_known_headings)


def _known_headings(text: str) -> int:
    """Return how many headings and events in the first lines of a text are known."""
    cells = [cell for line in text.splitlines()[:9] for cell in re.split(r"[\t;,]", line)]
    return sum(heading_of(cell).name in NAMES.values() for cell in cells)


def text_of_workbook(path: Path | str) -> str:
    """Return the first sheet of a workbook of Excel as text, cells apart by tabs.

    Raises
    ------
    Unavailable
        If openpyxl is not installed.
    """
    try:
        openpyxl = import_module("openpyxl")
    except ImportError:
        raise Unavailable(
            f"{path} is a workbook of Excel, and openpyxl, which reads it, is not installed:"
            " install openpyxl, or save the sheet as .csv"
        ) from None
    with in_words(path, "read"):
        sheet = openpyxl.load_workbook(path, read_only=True, data_only=True).worksheets[0]
        rows = [["" if cell is None else str(cell) for cell in row] for row in sheet.values]
    return "\n".join("\t".join(row) for row in rows)
