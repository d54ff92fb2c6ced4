"""Packed run for the player in the browser: one block of bytes.

Layout, little-endian: the letters TTRK, the length of the header (uint32), the header (JSON, padded
with blanks to a multiple of 8), the sample times (float64), then the header's columns (float32),
each with all its samples before the next. `web/src/player/track.js` reads it.
"""

import json
import struct
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from tippetop.export.poses import contact_path
from tippetop.figures.appearance import SCENES, size, toy_parts
from tippetop.problem.problem import Problem
from tippetop.results.account_text import describe
from tippetop.results.cf_flags import encoded

Array = NDArray[np.float64]

MAGIC = b"TTRK"
"""First bytes of a block."""

SHADINGS = 200
"""Largest number of shaded flights; flights that follow each other closely are shaded as one."""


def pack_run(run: xr.Dataset) -> bytes:
    """Return the block of bytes of a run."""
    problem, (begin, end) = Problem.from_json(run.attrs["problem"]), _ends(run)
    columns, turnover_time, account = _columns(run), float(run["turnover_time"]), describe(run)
    header = {
        "samples": run.sizes["time"],
        "duration": end,
        "columns": [
            [name, values.shape[1] if values.ndim > 1 else 1] for name, values in columns.items()
        ],
        "flights": flights(run),
        "turnover_time": turnover_time if begin <= turnover_time <= end else None,
        "modes": [str(word) for word in run["mode"].attrs["flag_meanings"].split()],
        "body": {
            "I1": problem.body.I1,
            "I3": problem.body.I3,
            "size": size(problem.body),
            "parts": [part.plain() for part in toy_parts(problem.body)],
        },
        "scenes": SCENES,
        "account": account.plain(),
        "story": {"headline": account.headline, "details": account.details},
        "problem": json.loads(run.attrs["problem"]),
    }
    text = json.dumps(header, separators=(",", ":")).encode()
    text += b" " * (-(len(text) + 8) % 8)
    blocks = [np.ascontiguousarray(values, dtype="<f4").tobytes() for values in columns.values()]
    times = run["time"].values.astype("<f8").tobytes()
    return b"".join([MAGIC, struct.pack("<I", len(text)), text, times, *blocks])


def unpack_header(block: bytes) -> dict[str, Any]:
    """Return the header of a block of bytes."""
    (length,) = struct.unpack("<I", block[4:8])
    header: dict[str, Any] = json.loads(block[8 : 8 + length])
    return header


def flights(run: xr.Dataset) -> Any:
    """Return start and end (s) of the flights of a run, with flights merged that look like one."""
    (begin, end), starts, ends = _ends(run), run["flight_start"].values, run["flight_end"].values
    seen = (starts < end) & (ends > begin)
    starts, ends = starts[seen].clip(begin), ends[seen].clip(max=end)
    if len(starts) > SHADINGS:
        apart = starts[1:] - ends[:-1] >= (end - begin) / SHADINGS
        starts, ends = starts[np.append(True, apart)], ends[np.append(apart, True)]
    return np.stack([starts, ends], axis=1).tolist()


def _ends(run: xr.Dataset) -> tuple[float, float]:
    """Return the times of the first and the last sample, s."""
    return float(run["time"].values[0]), float(run["time"].values[-1])


def _columns(run: xr.Dataset) -> dict[str, Array]:
    return {
        "orientation": run["orientation"].values,
        "momentum": run["angular_momentum"].values,
        "position": run[["x", "y", "height"]].to_array().values.T,
        "velocity": run["velocity"].values,
        "point": contact_path(run),
        "friction": run["contact_force"].values[:, :2],
        "touching": (run["normal_force"].values != 0.0).astype(float),
        "mode": encoded(run[["mode"]])["mode"].values.astype(float),
        "tilt": run["tilt"].values,
        "spin": run["spin"].values,
    }
