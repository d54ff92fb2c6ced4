"""Workpieces read from files: whole from TOML, or their profile from CSV or SVG."""

import csv
import xml.etree.ElementTree as ElementTree
from contextlib import ExitStack
from pathlib import Path
from typing import Any

from tippetop.lathe.workpiece import Workpiece
from tippetop.support.errors import InvalidInput, Unavailable
from tippetop.support.files import made_of, named, path_of, read_text
from tippetop.support.parsing import parse_toml

ACCEPTED = "a workpiece in TOML, or a profile in CSV or SVG"


STARTS = "0123456789+-."
"""What numbers begin with, also those with a slip further on: no cell of a heading begins so."""


def read_workpiece(path: Path | str, **fields: Any) -> Workpiece:
    """Read a workpiece from a .toml file, or its profile from a .csv or .svg file.

    In TOML a profile may be the name of such a file, beside this one. A CSV file has two or three
    columns, with or without a heading: distance from the axis, height and radius of the arc that
    ends there. An SVG file has one path, of lines and circular arcs, in no moved or turned group,
    with the axis at x = 0.

    Fields that are given are set, or are other than in the file. Raises `FileTrouble` if a file
    cannot be read, `InvalidInput` if it does not hold what it should, `Unavailable` if SVG cannot
    be read here.
    """
    path = path_of(path)
    whole = path.suffix.lower() == ".toml"
    told = (
        parse_toml(read_text(path, ACCEPTED), "workpiece", path.name)
        if whole
        else {"profile": path.name}
    )
    found = {**told, **fields}
    inserts = found.get("inserts")
    parts = {"": found}
    if isinstance(inserts, list):
        # What is read is put in, and not into what was given.
        found["inserts"] = inserts = [
            dict(part) if isinstance(part, dict) else part for part in inserts
        ]
        parts |= {f"inserts.{number}.": part for number, part in enumerate(inserts)}
    with ExitStack() as files:
        if whole:
            files.enter_context(made_of(path, fields))
        for name, part in parts.items():
            if isinstance(part, dict) and isinstance(part.get("profile"), str):
                beside = path.parent / part["profile"]
                part["profile"] = read_points(beside)
                files.enter_context(made_of(beside, part=f"{name}profile"))
        return Workpiece(**found)


def read_points(path: Path) -> list[list[float]]:
    """The points of the profile in a .csv or .svg file; see `read_workpiece`."""
    text = read_text(path, ACCEPTED)
    match path.suffix.lower():
        case ".csv":
            return _from_csv(text, path)
        case ".svg":
            return _from_svg(text, path)
    raise InvalidInput("file", named(path), "one whose name ends in .toml, .csv or .svg")


def _from_csv(text: str, path: Path) -> list[list[float]]:
    rows = [row for row in csv.reader(text.splitlines()) if any(cell.strip() for cell in row)]
    if rows and not any(cell.strip()[:1] in STARTS for cell in rows[0] if cell.strip()):
        rows = [[], *rows[1:]]
    return [_numbers(number, row, path) for number, row in enumerate(rows, 1) if row]


def _numbers(number: int, row: list[str], path: Path) -> list[float]:
    """The numbers of a row, which may end in empty cells, but has none between others."""
    cells = [cell.strip() for cell in row]
    while not cells[-1]:
        cells.pop()
    try:
        return [float(cell) for cell in cells]
    except ValueError:
        accepted = "two or three numbers, with commas between them"
        raise InvalidInput(f"row {number}", ",".join(row), accepted, file=named(path)) from None


def _from_svg(text: str, path: Path) -> list[list[float]]:
    try:
        from svg.path import parse_path  # noqa: PLC0415 - optional
    except ImportError:
        raise Unavailable(
            "SVG files are read with svg.path, which is not installed: pip install"
            ' "tippetop[lathe]"'
        ) from None
    try:
        elements = list(ElementTree.fromstring(text).iter())
    except ElementTree.ParseError as error:
        raise InvalidInput("SVG", named(path), f"XML; {error}") from None
    lines = [
        element.get("d", "") for element in elements if element.tag.rpartition("}")[2] == "path"
    ]
    if len(lines) != 1 or any("transform" in element.attrib for element in elements):
        raise InvalidInput(
            "SVG", f"{len(lines)} paths in {named(path)}", "one path, without transformations"
        )
    try:
        return _drawn(parse_path(lines[0]))
    except InvalidInput:
        raise
    except (ValueError, IndexError, TypeError):
        raise InvalidInput("path", lines[0], "a path of SVG") from None


def _drawn(line: Any) -> list[list[float]]:
    """The points of a line; up is less y there, so that arcs turn the other way."""
    found: list[list[float]] = []
    for segment in line:
        match type(segment).__name__:
            case "Move" if not found:
                ends = [(segment.end, 0.0)]
            case "Line" | "Close":
                ends = [(segment.end, 0.0)] if segment.end != segment.start else []
            case "Arc" if abs(segment.radius.real - segment.radius.imag) <= 1e-9 * abs(
                segment.radius
            ):
                radius = -segment.radius.real if segment.sweep else segment.radius.real
                halves = (0.5, 1.0) if segment.arc else (1.0,)
                ends = [(segment.point(share), radius) for share in halves]
            case kind:
                raise InvalidInput(
                    "path", kind, "one line of straight pieces and circular arcs (M L H V A Z)"
                )
        found += [[end.real, -end.imag, radius] for end, radius in ends]
    return found
