"""Animated model of a run (glTF 2.0, binary), for browsers, slide programs and Blender."""

import json
import struct
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from tippetop import __version__
from tippetop.export.geometry import Mesh, lathe
from tippetop.export.poses import poses_at
from tippetop.figures.appearance import SCENES, ToyPart, size, toy_parts
from tippetop.problem.bodies import Body
from tippetop.problem.problem import Problem
from tippetop.results.account_text import describe
from tippetop.results.dataset import require_run
from tippetop.results.samples import continuous
from tippetop.support.errors import InvalidInput
from tippetop.support.files import written_beside

TURN_PER_KEY = 0.5
"""Largest rotation of the body between two keys, rad: viewers interpolate along the shortest
way.
"""
LEAST_KEYS = 60.0
"""Smallest number of keys per second."""
MOST_KEYS = 100_000
"""Largest number of keys of an animation."""

_TYPES = {1: "SCALAR", 3: "VEC3", 4: "VEC4"}
_TABLE_RADII = 8.0
"""Radius of the table, in sizes of the toy."""


def write_glb(run: xr.Dataset, path: Path | str, overwrite: bool = False) -> Path:
    """Write a run as an animated .glb: the toy with its pattern on a table, in metres.

    Raises
    ------
    FileTrouble
        If the file exists and `overwrite` is false, or cannot be written.
    InvalidInput
        If `run` is no run or needs more than `MOST_KEYS` keys, or the path is no name of a file.

    Examples
    --------
    >>> import tippetop as tt
    >>> run = tt.simulate(tt.presets.report_problem(), duration=1.0, samples=501)
    >>> tt.write_glb(run, "run.glb").read_bytes()[:4]
    b'glTF'
    """
    require_run(run)
    with written_beside(path, overwrite) as beside:
        beside.write_bytes(glb_bytes(run))
    return Path(path)


def glb_bytes(run: xr.Dataset) -> bytes:
    """Return the animated model of a run as the bytes of a .glb file."""
    problem = Problem.from_json(run.attrs["problem"])
    times = key_times(run, problem.body)
    poses = poses_at(run, times)
    turns = continuous(poses.turns.as_quat())

    model = _Gltf()
    unit = size(problem.body)
    toy = model.mesh("toy", [(lathe(part, unit), part.opacity) for part in toy_parts(problem.body)])
    table = ToyPart(
        "table", np.array([(_TABLE_RADII, 0.0), (0.0, 0.0)]), (SCENES["light"]["table"],)
    )
    start = {"translation": poses.positions[0].tolist(), "rotation": turns[0].tolist()}
    # glTF has y up; the root turns z up into it.
    half = 0.5**0.5
    model.json["nodes"] = [
        {"name": "z up", "rotation": [-half, 0.0, 0.0, half], "children": [1, 2]},
        {"name": "toy", "mesh": toy, **start},
        {"name": "table", "mesh": model.mesh("table", [(lathe(table, unit), 1.0)])},
    ]
    # A run that ended at its launch stands still.
    if len(times) > 1:
        keys = model.accessor(times - times[0])
        outputs = {"translation": poses.positions, "rotation": turns}
        samplers = [
            {"input": keys, "output": model.accessor(values), "interpolation": "LINEAR"}
            for values in outputs.values()
        ]
        channels = [
            {"sampler": k, "target": {"node": 1, "path": path}} for k, path in enumerate(outputs)
        ]
        model.json["animations"] = [
            {"name": describe(run).headline, "samplers": samplers, "channels": channels}
        ]
    model.json["asset"]["extras"] = {"problem": json.loads(run.attrs["problem"])}
    return model.bytes()


def key_times(run: xr.Dataset, body: Body) -> NDArray[np.float64]:
    """Return the times of the animation's keys, s.

    Between two keys the body turns by at most `TURN_PER_KEY`. A run that ends at its launch has one
    key. Raises `InvalidInput` if there would be more than `MOST_KEYS`.
    """
    start, end = run["time"].values[[0, -1]].tolist()
    duration = end - start
    fastest = float(np.linalg.norm(run["angular_momentum"].values, axis=1).max()) / min(
        body.I1, body.I3
    )
    keys = int(np.ceil(duration * max(LEAST_KEYS, fastest / TURN_PER_KEY))) + 1
    if keys > MOST_KEYS:
        raise InvalidInput(
            "duration",
            duration,
            f"at most {duration * MOST_KEYS / keys:.3g} s",
            "is too long for so fast a top",
        )
    return np.linspace(start, end, keys)


class _Gltf:
    """A glTF document and its buffer, built up part by part."""

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

    def accessor(self, values: NDArray[Any]) -> int:
        """Add an array to the buffer and return the index of its accessor.

        Whole numbers are stored as 32-bit integers, others in single precision.
        """
        is_integer = values.dtype == np.uint32
        rows = values.reshape(len(values), -1).astype("<u4" if is_integer else "<f4")
        view = {"buffer": 0, "byteOffset": len(self.buffer), "byteLength": rows.nbytes}
        self.buffer += rows.tobytes()
        self.json["bufferViews"].append(view)
        accessor = {
            "bufferView": len(self.json["bufferViews"]) - 1,
            "componentType": 5125 if is_integer else 5126,
            "count": len(rows),
            "type": _TYPES[rows.shape[1]],
            "min": rows.min(axis=0).tolist(),
            "max": rows.max(axis=0).tolist(),
        }
        self.json["accessors"].append(accessor)
        return len(self.json["accessors"]) - 1

    def mesh(self, name: str, surfaces: list[tuple[Mesh, float]]) -> int:
        """Add a mesh of surfaces with opacities and return its index."""
        primitives = []
        for (points, normals, colours, triangles), opacity in surfaces:
            attributes = {"POSITION": points, "NORMAL": normals, "COLOR_0": colours}
            primitive = {
                "attributes": {key: self.accessor(values) for key, values in attributes.items()},
                "indices": self.accessor(triangles.ravel()),
                "material": self._material(opacity),
            }
            primitives.append(primitive)
        self.json["meshes"].append({"name": name, "primitives": primitives})
        return len(self.json["meshes"]) - 1

    def _material(self, opacity: float) -> int:
        """Return the index of the material of this opacity."""
        surface = {
            "baseColorFactor": [1.0, 1.0, 1.0, opacity],
            "metallicFactor": 0.0,
            "roughnessFactor": 0.5,
        }
        material: dict[str, Any] = {"pbrMetallicRoughness": surface}
        if opacity < 1:
            material["alphaMode"] = "BLEND"
        if material not in self.json["materials"]:
            self.json["materials"].append(material)
        return int(self.json["materials"].index(material))

    def bytes(self) -> bytes:
        """Return the document as the bytes of a .glb file."""
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
