"""Reading of drawings in SVG with svgelements: every shape as strokes on the sheet, from which
`tippetop.lathe.sheet` takes the axis and the profile, and leaves out pages and frames.
"""

import math
import re
import xml.etree.ElementTree as ElementTree
from io import StringIO
from typing import Any

from tippetop.lathe.frames import Box, box_of
from tippetop.lathe.sheet import Sheet
from tippetop.lathe.strokes import Path, Stroke, bezier, ellipse, line
from tippetop.support.errors import InvalidInput

MM_PER_PIXEL = 25.4 / 96.0
"""Size of a pixel, mm: a 96th of an inch, as in CSS."""

LENGTHS = {
    "": MM_PER_PIXEL,
    "px": MM_PER_PIXEL,
    "mm": 1.0,
    "cm": 10.0,
    "q": 0.25,
    "in": 25.4,
    "pt": 25.4 / 72.0,
    "pc": 25.4 / 6.0,
}
"""Units of the size of a drawing, mm."""


def read_svg(text: str, unit: str | None, name: str) -> Sheet:
    """Return the sheet of an SVG file.

    Its numbers are mm of the drawing's physical size or, if a unit is stated, the file's own
    numbers in that unit. Raises `InvalidInput` if the file is no SVG.
    """
    import svgelements  # noqa: PLC0415 - slow to import

    try:
        root = ElementTree.fromstring(text)
    except ElementTree.ParseError as error:
        raise InvalidInput("SVG", name, f"XML; {error}") from None
    if root.tag.rpartition("}")[2] != "svg":
        raise InvalidInput("SVG", name, "a file whose outermost element is <svg>")
    scale, shift = _in_pixels(root)
    page = _page(root, 1.0 if unit else scale, shift)
    try:
        content = StringIO(ElementTree.tostring(root, encoding="unicode"))
        drawing = svgelements.SVG.parse(content, reify=True, ppi=96.0)
        shapes = [part for part in drawing.elements() if isinstance(part, svgelements.Shape)]
        paths = [
            (_called(shape, number, len(shapes)), path)
            for number, shape in enumerate(shapes, 1)
            for path in _paths(
                abs(svgelements.Path(shape)), 1.0 if unit else scale, shift, svgelements
            )
        ]
    except (ValueError, IndexError, TypeError, AttributeError, ArithmeticError, KeyError):
        raise InvalidInput("SVG", name, "elements as SVG defines them") from None
    return Sheet(paths, unit or "mm", is_y_down=True, page=page)


def _page(root: ElementTree.Element, scale: float, shift: complex) -> Box | None:
    """Return the page of a drawing in pixels, y up; None if it states no size."""
    width, height = (_length(root.get(name, "")) for name in ("width", "height"))
    if width is None or height is None:
        return None
    size = complex(width, height) / MM_PER_PIXEL
    corners = [scale * corner.conjugate() for corner in (shift, shift + size)]
    return box_of([line(*corners)])


def _in_pixels(root: ElementTree.Element) -> tuple[float, complex]:
    """Change a drawing's units to pixels; return the size of a pixel (mm) and the drawing's origin.

    svgelements has millimetres to seven digits only. A drawing without a physical size is in
    pixels.
    """
    try:
        x, y, *sides = (float(part) for part in root.get("viewBox", "").replace(",", " ").split())
    except ValueError:
        return MM_PER_PIXEL, 0j
    scales = [
        length / number
        for name, number in zip(("width", "height"), sides, strict=False)
        if number > 0.0 and (length := _length(root.get(name, ""))) is not None
    ]
    if len(sides) == 2:
        root.set("width", f"{sides[0]!r}px")
        root.set("height", f"{sides[1]!r}px")
    root.attrib.pop("preserveAspectRatio", None)
    return min(scales, default=MM_PER_PIXEL), complex(x, y)


def _length(text: str) -> float | None:
    """Return a length, mm; None if it is relative or missing."""
    parts = re.fullmatch(r"\s*([-+.\deE]+?)\s*([a-zA-Z]*)\s*", text)
    try:
        return float(parts[1]) * LENGTHS[parts[2].lower()] if parts else None
    except (ValueError, KeyError):
        return None


def _called(element: Any, number: int, count: int) -> str:
    """Return the name of an element in messages."""
    kind = type(element).__name__.lower()
    name = getattr(element, "id", None)
    return f"{kind} {name!r}" if name else f"{kind} {number} of {count}"


def _paths(path: Any, scale: float, shift: complex, svgelements: Any) -> list[Path]:
    """Return the subpaths of a path, y up."""
    paths: list[Path] = [[]]

    def place(point: complex) -> complex:
        return scale * (point + shift).conjugate()

    for segment in path:
        match segment:
            case svgelements.Move():
                paths.append([])
                continue
            case svgelements.Arc():
                stroke = _arc(segment).moved(place, scale)
            case svgelements.CubicBezier():
                stroke = bezier(
                    [
                        place(_number(point))
                        for point in (
                            segment.start,
                            segment.control1,
                            segment.control2,
                            segment.end,
                        )
                    ]
                )
            case svgelements.QuadraticBezier():
                stroke = bezier(
                    [
                        place(_number(point))
                        for point in (segment.start, segment.control, segment.end)
                    ]
                )
            case _:
                if segment.end is None:
                    continue
                stroke = line(place(_number(segment.start)), place(_number(segment.end)))
        if stroke.first != stroke.last or stroke.radius != math.inf:
            paths[-1].append(stroke)
    return [path for path in paths if path]


def _number(point: Any) -> complex:
    return complex(point.x, point.y)


def _arc(segment: Any) -> Stroke:
    """Return an arc of an ellipse, in the drawing's own numbers."""
    center = _number(segment.center)
    first = _number(segment.prx) - center
    # The direction of the second semi-axis is free; angles count from x to y, which is down.
    second = 1j * first / abs(first) * abs(_number(segment.pry) - center)
    arm = _number(segment.start) - center
    begin = math.atan2(
        (arm * second.conjugate()).real / abs(second) ** 2,
        (arm * first.conjugate()).real / abs(first) ** 2,
    )
    return ellipse(center, first, second, begin, begin + float(segment.sweep))
