"""Reading of workpieces from TOML, or of their profiles from points, drawings and meshes."""

import re
from contextlib import ExitStack
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

from tippetop.lathe.fitting import TOLERANCE
from tippetop.lathe.sheet import Reading, Sheet, read_sheet
from tippetop.lathe.strokes import line
from tippetop.lathe.workpiece import UNITS, Workpiece
from tippetop.support.errors import Described, FileTrouble, InvalidInput
from tippetop.support.files import in_words, made_of, named, path_of, read_text
from tippetop.support.parsing import parse_toml

MESHES = (".stl", ".obj", ".ply", ".off")
"""Suffixes of meshes."""

DRAWINGS = (".svg", ".dxf", *MESHES)
"""Suffixes of drawings and meshes, which have a unit of their own."""

ACCEPTED = "a workpiece in TOML, or a profile in CSV, SVG, DXF, STL, OBJ, PLY or OFF"

BRACKETED = re.compile(r"[(\[{]([^)\]}]*)([)\]}]?)")
"""Text in brackets in a heading, such as "r (mm)", "r [mm]" or "r (mm, outer)"; between commas that
ends in the next cell.
"""

STATED_UNIT = re.compile(r"(?:/\s*([^/]*?)|\sin\s+(\S+))$", re.IGNORECASE)
"""Unit at the end of a heading, such as "r/mm" or "r in mm"."""

LAST_WORD = re.compile(r"[_,\s]\s*([^\W\d_]+)$")
"""Last word of a heading, which may be a unit, as in "r_mm", or part of a name, as in "r_outer"."""

UNIT_NAMES = {
    **{unit: unit for unit in UNITS},
    **dict.fromkeys(("metre", "metres", "meter", "meters"), "m"),
    **dict.fromkeys(("centimetre", "centimetres", "centimeter", "centimeters"), "cm"),
    **dict.fromkeys(("zentimeter", "zentimetern"), "cm"),
    **dict.fromkeys(("millimetre", "millimetres", "millimeter", "millimeters"), "mm"),
    "millimetern": "mm",
    **dict.fromkeys(("inch", "inches", "zoll"), "in"),
}
"""Units of profiles by what headings call them, in lower case."""

OTHER_UNITS = {
    *("nm", "um", "\u00b5m", "\u03bcm", "micron", "microns", "micrometre", "micrometres"),
    *("micrometer", "micrometers", "mikrometer", "nanometre", "nanometer", "dm", "km", "mil"),
    *("mils", "thou", "ft", "yd", "yds", "yard", "yards", "furlong", "furlongs", "px", "pixel"),
    "pixels",
}
"""Units that profiles do not have, by what headings call them: short of names of parts such as
foot, point or hand.
"""

DIAMETER = re.compile(r"\s*(d|dia|diam|diameter|durchmesser|[ØøΦ⌀∅])\b", re.IGNORECASE)
"""Heading of a column of diameters, of which half are the distances from the axis."""

METRE = 1.0
"""Distance from the axis in a file without a unit beyond which a remark says that metres were
taken, m: no top is as wide.
"""

TAKEN_AS_METRES = (
    "The file has no unit, and metres were taken: write r (mm) as heading, or --unit mm."
)

STARTS = "0123456789+-."
"""First characters of numbers, also of mistyped ones; cells of a heading do not begin so."""


def read_workpiece(
    path: Path | str, *, axis: str | None = None, frame: bool | None = None, **fields: Any
) -> Workpiece:
    """Return the workpiece of a .toml file, or with the profile of another file.

    Profiles are in files of points (.csv), drawings (.svg, .dxf) and meshes (.stl, .obj, .ply,
    .off). In TOML a profile may be the name of such a file in the same folder. A CSV file has two
    or three columns, with or without a heading: distance from the axis, height and radius of the
    arc that ends there; a heading may have the unit, as in "r (mm)". A drawing shows half an
    outline from the axis to the axis, or a full one on both sides, and bores inside; its lengths
    are physical (a pixel is a 96th of an inch) unless `unit` states the unit of its numbers. A mesh
    is the surface of a body of revolution, in mm unless `unit` says otherwise.

    The axis of a drawing is x = 10 or y = 10, a place in its numbers, or x or y for its direction;
    that of a mesh x, y or z. By default it is sought. A rectangle around all else is left out as
    the page or a frame; if it may be a body with bores too, `frame` is to say what it is.

    Further fields replace those of the file. Raises `FileTrouble` if a file cannot be read,
    `InvalidInput` if its content is not accepted, `Unavailable` if a library that reads it is not
    installed.

    Examples
    --------
    >>> import tippetop as tt
    >>> from pathlib import Path
    >>> drawing = '<svg xmlns="http://www.w3.org/2000/svg" width="40mm" height="40mm"'
    >>> circle = ' viewBox="0 0 40 40"><circle cx="20" cy="20" r="15"/></svg>'
    >>> _ = Path("ball.svg").write_text(drawing + circle)
    >>> round(1e3 * tt.read_workpiece("ball.svg", density=700).mass_properties.mass, 3)  # g
    9.896
    """
    return read_with_remarks(path, axis=axis, frame=frame, **fields)[0]


def read_with_remarks(
    path: Path | str, *, axis: str | None = None, frame: bool | None = None, **fields: Any
) -> tuple[Workpiece, list[str]]:
    """Return the workpiece of `read_workpiece`, and sentences on how its drawings were read."""
    path = path_of(path)
    is_toml = path.suffix.lower() == ".toml"
    stated = (
        parse_toml(read_text(path, ACCEPTED), "workpiece", path.name)
        if is_toml
        else {"profile": path.name}
    )
    if is_toml and {"launch", "friction"} & set(stated):
        raise FileTrouble(
            f"{named(path)} is a problem, and not {ACCEPTED}: simulate and critical take it"
        )
    content = {**stated, **fields}
    inserts = content.get("inserts")
    parts = {"": content}
    if isinstance(inserts, list):
        # The inserts are copied, so that the caller's are not changed.
        content["inserts"] = inserts = [
            dict(part) if isinstance(part, dict) else part for part in inserts
        ]
        parts |= {f"inserts.{number}.": part for number, part in enumerate(inserts)}
    remarks: list[str] = []
    with ExitStack() as files:
        if is_toml:
            files.enter_context(made_of(path, fields))
        for prefix, part in parts.items():
            if isinstance(part, dict) and isinstance(part.get("profile"), str):
                beside = path.parent / part["profile"]
                field = f"{prefix}profile"
                reading = _read(beside, Hints(axis, frame), content, field, is_toml)
                part["profile"] = reading.profile
                remarks += reading.remarks
                if reading.cavities:
                    _add_cavities(content, reading, field)
                files.enter_context(made_of(beside, part=field))
        if axis is not None and not remarks:
            raise InvalidInput("axis", axis, "none: the profile is stated from the axis")
        return Workpiece(**content), remarks


def _add_cavities(content: dict[str, Any], reading: Reading, field: str) -> None:
    """Add the cavities of a drawing to the inserts in the fields of a workpiece."""
    if field != "profile":
        raise InvalidInput(
            field, Described("a drawing with bores"), "one outline: an insert has no bores"
        )
    cavities = [{"profile": points, "density": 0.0} for points in reading.cavities]
    content["inserts"] = [*(content.get("inserts") or ()), *cavities]


class Hints(NamedTuple):
    """What users state of a drawing or a mesh."""

    axis: str | None
    frame: bool | None


def _read(
    path: Path, hints: Hints, content: dict[str, Any], field: str, is_in_toml: bool
) -> Reading:
    """Return the profile in a file, and set the unit in the fields of the workpiece.

    Numbers of a drawing are physical lengths and those of a mesh mm, unless a unit is stated.
    """
    axis, frame = hints
    suffix = path.suffix.lower()
    if suffix not in (".csv", *DRAWINGS):
        endings = ", ".join((".toml", ".csv", *DRAWINGS[:-1]))
        raise InvalidInput(
            "file", named(path), f"one whose name ends in {endings} or {DRAWINGS[-1]}"
        )
    unit = content.get("unit")
    tolerance = content.get("tolerance", TOLERANCE)
    if not isinstance(tolerance, float | int) or not 0.0 <= tolerance <= 1.0:
        tolerance = TOLERANCE  # the workpiece will refuse the stated one
    if suffix == ".csv":
        points, written_unit = _from_csv(read_text(path, ACCEPTED), path)
        if written_unit is not None and unit not in (None, written_unit):
            raise InvalidInput(
                "unit", unit, written_unit, "is not the unit in the heading", file=named(path)
            )
        reading = _of_points(points, axis, written_unit or unit or "m", tolerance, field)
        if (written_unit or unit) is None and any(abs(point[0]) > METRE for point in points):
            reading.remarks.append(TAKEN_AS_METRES)
        return _in_unit(reading, written_unit or "m", content, is_in_toml)
    with in_words(path, "read"):
        if suffix in MESHES:
            from tippetop.lathe.scan import read_mesh  # noqa: PLC0415 - slow to import

            reading = read_mesh(path, axis, tolerance, named(path))
        elif suffix == ".dxf":
            from tippetop.lathe.dxf import read_dxf  # noqa: PLC0415 - slow to import

            reading = read_sheet(read_dxf(path, unit, named(path)), axis, tolerance, field, frame)
        else:
            from tippetop.lathe.svg import read_svg  # noqa: PLC0415 - slow to import

            sheet = read_svg(read_text(path, ACCEPTED), unit, named(path))
            reading = read_sheet(sheet, axis, tolerance, field, frame)
    return _in_unit(reading, "mm", content, is_in_toml)


def _in_unit(reading: Reading, unit: str, content: dict[str, Any], is_in_toml: bool) -> Reading:
    """Return a reading whose numbers are in a unit, in the unit of the workpiece.

    A file that is read alone states the unit of the workpiece; profiles in TOML are in m unless
    `unit` says otherwise.
    """
    if content.get("unit") is not None:
        return reading
    if not is_in_toml:
        content["unit"] = unit
        return reading
    scale = UNITS[unit] / UNITS["m"]
    if scale == 1.0:
        return reading
    return reading._replace(
        profile=_scaled(reading.profile, scale),
        cavities=[_scaled(points, scale) for points in reading.cavities],
    )


def _of_points(
    points: list[tuple[float, ...]], axis: str | None, unit: str, tolerance: float, field: str
) -> Reading:
    """Return the profile of points: as they are, or of a full outline around an axis."""
    if axis is None and not _are_on_both_sides(points):
        return Reading(points, [], [])
    # This closes a half outline along the axis.
    corners = [complex(*point[:2]) for point in [*points, *points[:1]]]
    outline = [line(*ends) for ends in pairwise(corners) if ends[0] != ends[1]]
    return read_sheet(Sheet([("the line of points", outline)], unit), axis, tolerance, field)


def _scaled(points: list[tuple[float, ...]], scale: float) -> list[tuple[float, ...]]:
    return [tuple(scale * number for number in point) for point in points]


def _are_on_both_sides(points: list[tuple[float, ...]]) -> bool:
    """Return whether points are a full outline, on both sides of the axis."""
    across = [point[0] for point in points]
    return all(len(point) == 2 for point in points) and min(across, default=0.0) < 0.0 < max(across)


class _Table(NamedTuple):
    """Points in a file, and the unit in its heading."""

    points: list[tuple[float, ...]]
    unit: str | None


def _from_csv(text: str, path: Path) -> _Table:
    """Return the points in rows of numbers separated by commas, semicolons, tabs or spaces.

    Between semicolons or tabs a comma is a decimal sign, as some spreadsheets write it.
    """
    lines = [line.partition("#")[0].strip() for line in text.splitlines()]
    between = next((mark for mark in ";\t," if any(mark in line for line in lines)), None)
    cells = [[cell.strip(' "') for cell in line.split(between)] for line in lines]
    if between in (";", "\t"):  # then a comma is a decimal sign
        cells = [[cell.replace(",", ".") for cell in row] for row in cells]
    rows = [(number, row) for number, row in enumerate(cells, 1) if any(row)]
    unit = None
    if rows and not any(cell[:1] in STARTS for cell in rows[0][1] if cell):
        unit = _unit_of(rows[0][1], path)
        rows = rows[1:]
    return _Table([_numbers(number, row, path) for number, row in rows], unit)


def _unit_of(heading: list[str], path: Path) -> str | None:
    """Return the unit of lengths in a heading, None if it has none; refuse several units."""
    for cell in heading:
        if DIAMETER.match(cell):
            accepted = "distances from the axis, half the diameters, in a column such as r (mm)"
            raise InvalidInput("heading", cell, accepted, file=named(path))
    texts = [(cell, _unit_text(cell)) for cell in heading]
    for cell, text in texts:
        if text and text not in UNIT_NAMES:
            accepted = "a heading with a unit of m, cm, mm or in, such as r (mm)"
            raise InvalidInput("heading", cell, accepted, file=named(path))
    units = {UNIT_NAMES[text] for _, text in texts if text}
    if len(units) > 1:
        raise InvalidInput(
            "heading",
            ",".join(heading),
            "one unit for all columns: m, cm, mm or in",
            file=named(path),
        )
    return units.pop() if units else None


def _unit_text(cell: str) -> str:
    """Return what stands in a heading where a unit stands, in lower case; empty for nothing."""
    for text, bracket in BRACKETED.findall(cell):
        unit = _bracketed_unit(text.strip(" .").lower(), bool(bracket))
        if unit:
            return unit
    outside = BRACKETED.sub(" ", f" {cell}").rstrip(" .,;:)]}")
    stated = STATED_UNIT.search(outside)
    if stated:
        return (stated[1] or stated[2] or "").lower()
    last = LAST_WORD.search(outside)
    word = last[1].lower() if last else ""
    return word if word in UNIT_NAMES or word in OTHER_UNITS else ""


def _bracketed_unit(text: str, is_closed: bool) -> str:
    """Return the unit in the text of a bracket, the whole text if it may have one in other words,
    or nothing for a remark, such as "from the axis".
    """
    if text.replace(" ", "") in UNIT_NAMES:
        return text.replace(" ", "")
    words: list[str] = re.findall(r"[^\s,;:.]+", text)
    has_digit = any(sign.isdigit() for sign in text)
    if words and words[0] in UNIT_NAMES and not has_digit:
        return words[0]
    names = (UNIT_NAMES.keys() | OTHER_UNITS) - {"in"}  # as a word, "in" is a preposition
    is_unclear = (is_closed and len(words) == 1) or has_digit or not names.isdisjoint(words)
    return text if is_unclear else ""


def _numbers(number: int, row: list[str], path: Path) -> tuple[float, ...]:
    """Return the numbers of a row; empty cells are accepted at its end only."""
    cells = list(row)
    while not cells[-1]:
        cells.pop()
    try:
        return tuple(float(cell) for cell in cells)
    except ValueError:
        accepted = "two or three numbers, with a decimal point and commas between them"
        raise InvalidInput(f"row {number}", ",".join(row), accepted, file=named(path)) from None
