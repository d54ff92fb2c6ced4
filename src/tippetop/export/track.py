"""A run as the player in the browser takes it: one block of bytes.

Layout, little-endian: the letters TTRK, the length of the header (uint32), the header (JSON, padded with
blanks to a multiple of 8), the sample times (float64), then the header's columns (float32), each with all its
samples before the next. `player/track.js` reads it.
"""

import json
import struct
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from tippetop.catalogue import SAMPLED
from tippetop.export.poses import contact_path
from tippetop.export.words import tell
from tippetop.figures.looks import SCENES, size, toy_parts
from tippetop.problem import Problem

Array = NDArray[np.float64]

MAGIC = b"TTRK"
TURN_PER_SAMPLE = 0.6
"""Angle by which the body may turn between samples, rad."""
LEAST_RATE = 100.0
"""Samples per second of even the slowest run."""
MOST_SAMPLES = 40_000
"""Samples of a run at most: some 4 MB."""
SHADINGS = 200
"""Flights shaded at most; nearer ones are shaded together."""
PLOTTED = {
    "theta": "Tilt θ (rad)",
    "omega3": "Axial spin ω₃ (rad/s)",
    "phi_dot": "Precession φ′ (rad/s)",
    "slip": "Slip (m/s)",
    "energy": "Energy (mJ)",
    "normal_force": "Normal force N (N)",
    "jellett_error": "Relative error of Jellett's integral",
}
"""The plots by the name of their column, with their titles."""


def sample_count(problem: Problem, duration: float) -> int:
    """How many samples a run needs so that it can be played at any speed."""
    top, start = problem.top, problem.start()
    fastest = float(np.linalg.norm(start.momentum)) / min(top.transverse_inertia, top.axial_inertia)
    rate = max(LEAST_RATE, fastest / TURN_PER_SAMPLE)
    return int(min(duration * rate, MOST_SAMPLES - 1)) + 2


def pack_run(run: xr.Dataset) -> bytes:
    """The block of bytes of a run."""
    problem = Problem.from_json(run.attrs["problem"])
    columns = _columns(run, problem)
    header = {
        "samples": run.sizes["time"],
        "duration": float(run["time"].values[-1]),
        "columns": [[name, values.shape[1] if values.ndim > 1 else 1] for name, values in columns.items()],
        "plots": {
            name: {"title": title, "range": _range(columns[name], name)} for name, title in PLOTTED.items()
        },
        "flights": flights(run),
        "body": {
            "I1": problem.body.I1,
            "I3": problem.body.I3,
            "size": size(problem.body),
            "parts": [
                part._replace(profile=part.profile.round(9).tolist())._asdict()
                for part in toy_parts(problem.body)
            ],
        },
        "scenes": SCENES,
        "story": tell(run)._asdict(),
        "problem": json.loads(run.attrs["problem"]),
    }
    text = json.dumps(header, separators=(",", ":")).encode()
    text += b" " * (-(len(text) + 8) % 8)
    blocks = [np.ascontiguousarray(values, dtype="<f4").tobytes() for values in columns.values()]
    times = run["time"].values.astype("<f8").tobytes()
    return b"".join([MAGIC, struct.pack("<I", len(text)), text, times, *blocks])


def unpack_header(block: bytes) -> dict[str, Any]:
    """The header of a block of bytes."""
    (length,) = struct.unpack("<I", block[4:8])
    header: dict[str, Any] = json.loads(block[8 : 8 + length])
    return header


def flights(run: xr.Dataset) -> Any:
    """Begin and end of every flight, s, those too near each other to be told apart as one."""
    starts, ends = run["flight_start"].values, run["flight_end"].values
    if len(starts) > SHADINGS:
        apart = starts[1:] - ends[:-1] >= float(run["time"].values[-1]) / SHADINGS
        starts, ends = starts[np.append(True, apart)], ends[np.append(apart, True)]
    return np.stack([starts, ends], axis=1).tolist()


def _columns(run: xr.Dataset, problem: Problem) -> dict[str, Array]:
    moment = np.linalg.norm(run["angular_momentum"].values[0]) * float(run["height"].values[0])
    jellett = run["jellett"].values
    return {
        "orientation": run["orientation"].values,
        "momentum": run["angular_momentum"].values,
        "position": run[["x", "y", "height"]].to_array().values.T,
        "velocity": run["velocity"].values,
        "point": contact_path(run),
        "friction": run["contact_force"].values[:, :2],
        "touching": (run["normal_force"].values != 0.0).astype(float),
        "theta": run["theta"].values,
        "omega3": run["omega3"].values,
        "phi_dot": run["phi_dot"].values,
        "slip": np.hypot(run["slip_x"].values, run["slip_y"].values),
        "energy": 1e3 * run["energy"].values,
        "normal_force": run["normal_force"].values,
        "jellett_error": (jellett - jellett[0]) / moment if moment else 0.0 * jellett,
    }


def _range(values: Array, name: str) -> list[float]:
    """Lowest and highest value to show: without the peaks of a variable that has no bound at the vertical."""
    finite = values[np.isfinite(values)]
    if not len(finite):
        return [0.0, 1.0]
    low, high = np.quantile(finite, [0.005, 0.995]) if name == "phi_dot" else (finite.min(), finite.max())
    if name == "theta":
        low, high = 0.0, max(np.pi, high)
    margin = 0.06 * (high - low) or 1e-3 * max(abs(high), 1e-12)
    return [float(low - margin * (name != "theta")), float(high + margin * (name != "theta"))]


assert set(PLOTTED) - set(SAMPLED) == {"slip", "jellett_error"}, "plots are of variables of a run"
