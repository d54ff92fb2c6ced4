"""Turned bodies as files for printing, in millimetres: STL for the body alone, 3MF for all of its
parts.
"""

import math
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

from tippetop.lathe.profile import Profile
from tippetop.lathe.workpiece import Workpiece
from tippetop.support.errors import Described, InvalidInput, Unavailable, is_whole, require
from tippetop.support.files import path_of, require_ending, written_beside

FACETS = 180
"""Facets around the axis: of a ball of 20 mm they leave out 3 micrometres."""

MOST_FACETS = 4096
"""Most facets around the axis: a solid of more is too large for memory."""

MM = 1e3


def write_solid(
    piece: Workpiece, path: Path | str, overwrite: bool = False, *, facets: int = FACETS
) -> None:
    """Write a turned body as triangles, closed, in millimetres.

    Cavities and inserts are hollows in the body. In 3MF, the inserts that weigh something follow as
    objects of their own.

    Parameters
    ----------
    piece
        What is turned.
    path
        File to write: .stl or .3mf.
    overwrite
        Whether the file may exist.
    facets
        Facets around the axis, and around a circle of the profile: at least 8.

    Raises
    ------
    InvalidInput
        If the name ends otherwise, the facets are too few, or an insert touches the surface of
        another part.
    FileTrouble
        If the file exists or cannot be written.
    Unavailable
        If trimesh is not installed.

    Examples
    --------
    >>> import tippetop as tt
    >>> ball = tt.Workpiece(profile=[(0, -20), (0, 20, 20)], density=700, unit="mm")
    >>> tt.write_solid(ball, "ball.stl")
    """
    require("piece", piece, Workpiece, "a Workpiece")
    place = path_of(path)
    suffix = require_ending("path", place, (".stl", ".3mf"))
    if not is_whole(facets) or not 8 <= facets <= MOST_FACETS:
        raise InvalidInput("facets", facets, f"a whole number from 8 to {MOST_FACETS}")
    meshes = solids(piece, facets)
    whole = meshes["body"] if suffix == ".stl" else _trimesh().Scene(meshes)
    content = whole.export(file_type=suffix[1:])
    with written_beside(path, overwrite) as beside:
        beside.write_bytes(content)


def solids(piece: Workpiece, facets: int) -> dict[str, Any]:
    """Return the body, and then the weights in it, by name, each with the hollows that the others
    leave.

    They are meshes of trimesh, in millimetres. Raises `InvalidInput` if an insert touches the
    surface of the body or another insert.
    """
    for number, inner in enumerate(piece.insides):
        if any("on" in inner.sides(other) for other in (piece.outline, *piece.insides[:number])):
            field = f"inserts.{number}.profile"
            raise InvalidInput(
                field,
                Described("an insert that touches a surface"),
                "one inside another part",
                "makes no solid",
            )
    trimesh = _trimesh()
    found = {"body": trimesh.creation.revolve(_line(piece.outline, facets), sections=facets)}
    for number, inner in enumerate(piece.insides, start=1):
        found[f"insert {number}"] = trimesh.creation.revolve(_line(inner, facets), sections=facets)
    shells = list(found.values())
    for shell, outer in zip(shells[1:], piece.around, strict=True):
        hollow = shell.copy()
        hollow.invert()
        name = "body" if outer is None else f"insert {outer + 1}"
        found[name] = trimesh.util.concatenate([found[name], hollow])
    weights = (piece.density, *(insert.density for insert in piece.inserts))
    return {
        name: solid for (name, solid), weight in zip(found.items(), weights, strict=True) if weight
    }


def _line(profile: Profile, facets: int) -> Any:
    """Return points along a profile, mm, shape (k, 2), so many around a circle."""
    steps = [math.ceil(abs(edge.turn) / math.tau * facets) or 1 for edge in profile.edges]
    points = [edge.points(np.arange(k) / k) for edge, k in zip(profile.edges, steps, strict=True)]
    line = MM * np.append(np.concatenate(points), profile.edges[-1].end)
    return np.stack([line.real, line.imag], axis=1)


def _trimesh() -> Any:
    if not all(find_spec(name) for name in ("trimesh", "lxml", "networkx")):
        raise Unavailable(
            'solids are written with trimesh, which is not installed: pip install "tippetop[lathe]"'
        )
    import trimesh.creation  # noqa: PLC0415 - optional

    return trimesh
