"""A run as an animated model (glTF 2.0, binary): opens in browsers, slide programs, Blender."""

import json
import struct
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from tippetop import __version__
from tippetop.errors import InvalidInput
from tippetop.export.geometry import Mesh, lathe, size, toy_parts
from tippetop.export.poses import poses_at
from tippetop.export.words import tell
from tippetop.files import place_for, written_beside
from tippetop.problem import Body, Problem

TURN_PER_KEY = 0.5
"""Angle by which the body may turn between two keys, rad; a viewer goes the shortest way between them."""
LEAST_KEYS = 60.0
"""Keys per second at least."""
MOST_KEYS = 100_000

_FLOAT, _UNSIGNED = 5126, 5125
_VERTICES, _INDICES = 34962, 34963
_TABLE_RADII = 8.0
_TABLE_COLOUR = (0.74, 0.68, 0.56, 1.0)


def write_glb(run: xr.Dataset, path: Path | str, overwrite: bool = False) -> Path:
    """Write a run as an animated .glb: the toy with its pattern, on a table, in metres.

    Raises
    ------
    FileTrouble
        If the file exists and `overwrite` is false, or cannot be written.
    InvalidInput
        If the run would need too many keys.
    """
    path = Path(path)
    place_for(path, overwrite)
    content = glb_bytes(run)
    with written_beside(path, overwrite) as beside:
        beside.write_bytes(content)
    return path


def glb_bytes(run: xr.Dataset) -> bytes:
    """The animated model of a run."""
    problem = Problem.from_json(run.attrs["problem"])
    times = key_times(run, problem.body)
    poses = poses_at(run, times)
    quaternions = poses.quaternions / np.linalg.norm(poses.quaternions, axis=1)[:, None]
    flips = np.cumprod(np.where(np.einsum("ij,ij->i", quaternions[1:], quaternions[:-1]) < 0, -1.0, 1.0))
    quaternions[1:] *= flips[:, None]

    model = _Model()
    toy = model.mesh("toy", [(lathe(part), part.opacity) for part in toy_parts(problem.body)])
    table = model.mesh("table", [(_disc(_TABLE_RADII * size(problem.body)), 1.0)])
    start = {"translation": poses.positions[0].tolist(), "rotation": quaternions[0, [1, 2, 3, 0]].tolist()}
    # glTF has y up; the root turns z up into it.
    half = 0.5**0.5
    model.json["nodes"] = [
        {"name": "z up", "rotation": [-half, 0.0, 0.0, half], "children": [1, 2]},
        {"name": "toy", "mesh": toy, **start},
        {"name": "table", "mesh": table},
    ]
    # A run that ended at its launch stands still.
    if len(times) > 1:
        key = model.accessor(times.astype("<f4"), "SCALAR", bounds=True)
        moves = model.accessor(poses.positions.astype("<f4"), "VEC3")
        turns = model.accessor(quaternions[:, [1, 2, 3, 0]].astype("<f4"), "VEC4")
        model.json["animations"] = [_animation(tell(run).headline, key, moves, turns)]
    model.json["asset"]["extras"] = {"problem": json.loads(run.attrs["problem"])}
    return model.bytes()


def _animation(name: str, key: int, moves: int, turns: int) -> dict[str, Any]:
    """An animation of the toy, by the numbers of its accessors."""
    return {
        "name": name,
        "samplers": [
            {"input": key, "output": moves, "interpolation": "LINEAR"},
            {"input": key, "output": turns, "interpolation": "LINEAR"},
        ],
        "channels": [
            {"sampler": 0, "target": {"node": 1, "path": "translation"}},
            {"sampler": 1, "target": {"node": 1, "path": "rotation"}},
        ],
    }


def key_times(run: xr.Dataset, body: Body) -> NDArray[np.float64]:
    """Times of the animation's keys, s: so dense that the body turns little between them; one if it is still.

    Raises
    ------
    InvalidInput
        If the run would need too many keys.
    """
    duration = float(run["time"].values[-1])
    fastest = float(np.linalg.norm(run["angular_momentum"].values, axis=1).max()) / min(body.I1, body.I3)
    keys = int(np.ceil(duration * max(LEAST_KEYS, fastest / TURN_PER_KEY))) + 1
    if keys > MOST_KEYS:
        raise InvalidInput(
            "duration", duration, f"at most {duration * MOST_KEYS / keys:.3g} s for so fast a top"
        )
    return np.linspace(0.0, duration, keys)


def _disc(radius: float) -> Mesh:
    turn = np.linspace(0, 2 * np.pi, 65)[:-1]
    rim = np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1) * radius
    points = np.concatenate([np.zeros((1, 3)), rim])
    number = np.arange(64)
    triangles = np.stack([0 * number, 1 + number, 1 + (number + 1) % 64], axis=1)
    colours = np.tile(_TABLE_COLOUR[:3], (65, 1))
    return Mesh(points, np.tile([0.0, 0.0, 1.0], (65, 1)), colours, triangles.astype(np.uint32))


class _Model:
    """A glTF document and its one buffer, as they grow."""

    def __init__(self) -> None:
        self.buffer = bytearray()
        self.json: dict[str, Any] = {
            "asset": {"version": "2.0", "generator": f"tippetop {__version__}"},
            "scene": 0,
            "scenes": [{"nodes": [0]}],
            "meshes": [],
            "materials": [],
            "accessors": [],
            "bufferViews": [],
        }

    def accessor(
        self, values: NDArray[Any], kind: str, target: int | None = None, bounds: bool = False
    ) -> int:
        """Add an array to the buffer; its number."""
        view: dict[str, int] = {"buffer": 0, "byteOffset": len(self.buffer), "byteLength": values.nbytes}
        if target is not None:
            view["target"] = target
        self.buffer += values.tobytes()
        accessor = {
            "bufferView": len(self.json["bufferViews"]),
            "componentType": _UNSIGNED if values.dtype == np.uint32 else _FLOAT,
            "count": len(values),
            "type": kind,
        }
        if bounds:
            flat = values.reshape(len(values), -1)
            accessor["min"], accessor["max"] = flat.min(axis=0).tolist(), flat.max(axis=0).tolist()
        self.json["bufferViews"].append(view)
        self.json["accessors"].append(accessor)
        return len(self.json["accessors"]) - 1

    def mesh(self, name: str, surfaces: list[tuple[Mesh, float]]) -> int:
        """Add a mesh of surfaces with their opacities; its number."""
        primitives = []
        for surface, opacity in surfaces:
            attributes = {
                "POSITION": self.accessor(surface.points.astype("<f4"), "VEC3", _VERTICES, bounds=True),
                "NORMAL": self.accessor(surface.normals.astype("<f4"), "VEC3", _VERTICES),
                "COLOR_0": self.accessor(surface.colours.astype("<f4"), "VEC3", _VERTICES),
            }
            indices = self.accessor(surface.triangles.ravel().astype("<u4"), "SCALAR", _INDICES)
            material = self._material(opacity)
            primitives.append({"attributes": attributes, "indices": indices, "material": material})
        self.json["meshes"].append({"name": name, "primitives": primitives})
        return len(self.json["meshes"]) - 1

    def _material(self, opacity: float) -> int:
        surface = {"baseColorFactor": [1.0, 1.0, 1.0, opacity], "metallicFactor": 0.0, "roughnessFactor": 0.5}
        material: dict[str, Any] = {"pbrMetallicRoughness": surface}
        if opacity < 1:
            material["alphaMode"] = "BLEND"
        if material not in self.json["materials"]:
            self.json["materials"].append(material)
        return int(self.json["materials"].index(material))

    def bytes(self) -> bytes:
        """The document as a .glb file."""
        self.json["buffers"] = [{"byteLength": len(self.buffer)}]
        text = json.dumps(self.json, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        length = 12 + 8 + len(text) + 8 + len(self.buffer)
        return b"".join(
            [
                struct.pack("<4sII", b"glTF", 2, length),
                struct.pack("<I4s", len(text), b"JSON"),
                text,
                struct.pack("<I4s", len(self.buffer), b"BIN\0"),
                bytes(self.buffer),
            ]
        )
