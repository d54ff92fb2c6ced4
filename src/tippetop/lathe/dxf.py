"""Reading of drawings in DXF with ezdxf: lines, polylines, arcs, circles, ellipses, splines."""

import math
from itertools import pairwise
from pathlib import Path as FilePath
from typing import Any

from tippetop.lathe.sheet import Sheet
from tippetop.lathe.strokes import Path, Stroke, ellipse, line
from tippetop.support.errors import InvalidInput, Unavailable
from tippetop.support.installation import install_command

MM = {1: 25.4, 4: 1.0, 5: 10.0, 6: 1000.0, 13: 1e-3, 14: 100.0}
"""Units that a DXF file may state, by their codes, mm."""

MM_CODE = 4
"""Code of mm, the unit of files that state none."""


def read_dxf(path: FilePath, unit: str | None, name: str) -> Sheet:
    """Return the sheet of a DXF file.

    Its numbers are mm or, if a unit is stated, the file's own numbers in that unit. Raises
    `InvalidInput` if the file is no DXF, `Unavailable` if ezdxf is not installed.
    """
    try:
        import ezdxf  # noqa: PLC0415 - optional
        import ezdxf.recover  # noqa: PLC0415
    except ImportError:
        raise Unavailable(
            f"DXF files are read with ezdxf, which is not installed: {install_command('lathe')}"
        ) from None
    try:
        # `recover` accepts what some exporters write: coordinates in the order x, x, y, y.
        document, _ = ezdxf.recover.readfile(path)
    except Exception:  # noqa: BLE001 - ezdxf raises what its parsers do
        raise InvalidInput("DXF", name, "a drawing in the format DXF") from None
    scale = 1.0 if unit else MM.get(document.units, 1.0)
    paths = [
        (f"{entity.dxftype().lower()} {entity.dxf.handle or ''}".strip(), path)
        for entity in _simple(_visible(document))
        for path in _paths(entity, scale, ezdxf)
    ]
    return Sheet(paths, unit or "mm")


def _visible(document: Any) -> Any:
    """Yield the entities of the model space whose layer is shown."""
    hidden = {
        layer.dxf.name.lower() for layer in document.layers if layer.is_off() or layer.is_frozen()
    }
    for entity in document.modelspace():
        if entity.dxf.get("layer", "0").lower() not in hidden:
            yield entity


def _simple(entities: Any) -> Any:
    """Yield the entities, with polylines and blocks resolved into theirs."""
    for entity in entities:
        if entity.dxftype() in ("LWPOLYLINE", "POLYLINE", "INSERT"):
            yield from _simple(entity.virtual_entities())
        else:
            yield entity


def _paths(entity: Any, scale: float, ezdxf: Any) -> list[Path]:
    """Return the paths of an entity; none for texts, dimensions and other entities without
    lines.
    """

    def place(point: Any) -> complex:
        return scale * complex(point[0], point[1])

    dxf = entity.dxf
    match entity.dxftype():
        case "LINE":
            return [[line(place(dxf.start), place(dxf.end))]]
        case "CIRCLE" | "ARC" | "ELLIPSE":
            arc = entity if entity.dxftype() == "ELLIPSE" else entity.copy()
            if entity.dxftype() != "ELLIPSE":
                arc = ezdxf.entities.Ellipse.from_arc(entity)
            center, one = place(arc.dxf.center), place(arc.dxf.major_axis)
            turn = 1j if arc.dxf.extrusion[2] > 0.0 else -1j
            begin, end = float(arc.dxf.start_param), float(arc.dxf.end_param)
            end += math.tau if end <= begin else 0.0
            return [[ellipse(center, one, turn * arc.dxf.ratio * one, begin, end)]]
        case "SPLINE":
            spline = entity.construction_tool()
            knots = sorted({float(knot) for knot in spline.knots()})
            spans = [(low, high) for low, high in pairwise(knots) if high <= spline.max_t]
            return [[Stroke(lambda t: place(spline.point(t)), *span) for span in spans]]
    return []
