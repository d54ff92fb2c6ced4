"""Solids of turned bodies for printing, in millimetres: STL of the body, 3MF of all its parts."""

import math
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

from tippetop.lathe.profile import Profile
from tippetop.lathe.workpiece import Workpiece
from tippetop.support.errors import Described, InvalidInput, Unavailable, is_whole, require
from tippetop.support.files import path_of, require_ending, written_beside
from tippetop.support.installation import install_command

FACETS = 180
"""Default number of facets around the axis: 3 micrometres inside a ball of 20 mm."""

MOST_FACETS = 4096
"""Largest number of facets around the axis: solids with more do not fit in memory."""

MM = 1e3
"""Millimetres in a metre."""


def write_solid(
    piece: Workpiece, path: Path | str, overwrite: bool = False, *, facets: int = FACETS
) -> Path:
    """Write a turned body as triangles, closed, in millimetres, and return the path.

    Cavities and inserts are hollows in the body. In 3MF, each insert with a density is another
    object.

    Parameters
    ----------
    piece
        Turned body.
    path
        File to write: .stl or .3mf.
    overwrite
        Whether an existing file is replaced.
    facets
        Facets around the axis, and around a circle of the profile: at least 8.

    Raises
    ------
    InvalidInput
        If the suffix is another, the number of facets is not accepted, or an insert touches the
        surface of another part.
    FileTrouble
        If the file exists or cannot be written.
    Unavailable
        If trimesh is not installed.

    Examples
    --------
    >>> import tippetop as tt
    >>> ball = tt.Workpiece(profile=[(0, -20), (0, 20, 20)], density=700, unit="mm")
    >>> tt.write_solid(ball, "ball.stl").name
    'ball.stl'
    """
    require("piece", piece, Workpiece, "a Workpiece")
    place = path_of(path)
    suffix = require_ending("path", place, (".stl", ".3mf"))
    if not is_whole(facets) or not 8 <= facets <= MOST_FACETS:
        raise InvalidInput("facets", facets, f"a whole number from 8 to {MOST_FACETS}")
    meshes = solids(piece, facets)
    exported = meshes["body"] if suffix == ".stl" else _trimesh().Scene(meshes)
    content = exported.export(file_type=suffix[1:])
    with written_beside(path, overwrite) as beside:
        beside.write_bytes(content)
    return place


def solids(piece: Workpiece, facets: int) -> dict[str, Any]:
    """Return trimesh meshes (mm) of the body and of the inserts with a density, by name.

    Each mesh has hollows for the parts inside it. Raises `InvalidInput` if an insert touches the
    surface of the body or of another insert.
    """
    for number, inner in enumerate(piece.insides):
        surfaces = (piece.outline, *piece.insides[:number])
        if any("on" in inner.sides(surface) for surface in surfaces):
            field = f"inserts.{number}.profile"
            raise InvalidInput(
                field,
                Described("an insert that touches a surface"),
                "one inside another part",
                "cannot be made a solid",
            )
    trimesh = _trimesh()
    meshes = {"body": trimesh.creation.revolve(_line(piece.outline, facets), sections=facets)}
    for number, inner in enumerate(piece.insides, start=1):
        meshes[f"insert {number}"] = trimesh.creation.revolve(_line(inner, facets), sections=facets)
    shells = list(meshes.values())
    for shell, outer in zip(shells[1:], piece.around, strict=True):
        hollow = shell.copy()
        hollow.invert()
        name = "body" if outer is None else f"insert {outer + 1}"
        meshes[name] = trimesh.util.concatenate([meshes[name], hollow])
    weights = (piece.density, *(insert.density for insert in piece.inserts))
    return {
        name: solid for (name, solid), weight in zip(meshes.items(), weights, strict=True) if weight
    }


def _line(profile: Profile, facets: int) -> Any:
    """Return points along a profile, mm, shape (k, 2); a full circle would have `facets` of
    them.
    """
    steps = [math.ceil(abs(edge.turn) / math.tau * facets) or 1 for edge in profile.edges]
    points = [edge.points(np.arange(k) / k) for edge, k in zip(profile.edges, steps, strict=True)]
    line = MM * np.append(np.concatenate(points), profile.edges[-1].end)
    return np.stack([line.real, line.imag], axis=1)


def _trimesh() -> Any:
    """Return the module trimesh; raise `Unavailable` if it is not installed."""
    if not all(find_spec(name) for name in ("trimesh", "lxml", "networkx")):
        raise Unavailable(
            f"solids are written with trimesh, which is not installed: {install_command('lathe')}"
        )
    import trimesh.creation  # noqa: PLC0415 - optional

    return trimesh
