"""Turned bodies as files for printing, in millimetres: STL for the body alone, 3MF for all of its parts."""

from importlib.util import find_spec
from pathlib import Path
from typing import Any

from tippetop.errors import InvalidInput, Unavailable
from tippetop.files import require_ending, written_beside
from tippetop.lathe.mesh import solids
from tippetop.lathe.workpiece import Workpiece

FACETS = 180
"""Facets around the axis: of a ball of 20 mm they leave out 3 micrometres."""

MM = 1e3


def write_solid(piece: Workpiece, path: Path | str, overwrite: bool = False, *, facets: int = FACETS) -> None:
    """Write a turned body as triangles, closed, in millimetres.

    Cavities and inserts are hollows in the body. In 3MF, the inserts that weigh something follow as objects
    of their own.

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
        If the name ends otherwise, the facets are too few, or an insert touches the surface of another part.
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
    suffix = Path(path).suffix.lower()
    require_ending("path", Path(path), (".stl", ".3mf"))
    if isinstance(facets, bool) or not isinstance(facets, int) or facets < 8:
        raise InvalidInput("facets", facets, "a whole number at least 8")
    trimesh = _trimesh()
    meshes = {
        name: trimesh.Trimesh(MM * points, triangles, process=False)
        for name, points, triangles in solids(piece, facets)
    }
    whole = meshes["body"] if suffix == ".stl" else trimesh.Scene(meshes)
    content = whole.export(file_type=suffix[1:])
    with written_beside(path, overwrite) as beside:
        beside.write_bytes(content)


def _trimesh() -> Any:
    if not all(find_spec(name) for name in ("trimesh", "lxml", "networkx")):
        raise Unavailable(
            'solids are written with trimesh, which is not installed: pip install "tippetop[lathe]"'
        )
    import trimesh  # noqa: PLC0415 - optional

    return trimesh
