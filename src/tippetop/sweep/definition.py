"""A sweep: a base problem, the cells over it, and how they are computed."""

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from tippetop.errors import MISSING, InvalidInput, one_of
from tippetop.files import read_text
from tippetop.problem import Problem
from tippetop.sweep.cells import cells_of
from tippetop.sweep.grid import (
    GEOMETRIC,
    LINEAR,
    LISTED,
    Axis,
    Draws,
    Product,
    Range,
    grid_from,
)
from tippetop.theory.groups import eccentricity
from tippetop.validation import parse_toml

DEFAULT_TOLERANCE = 1e-9
SETTLED_RANGE = (1e-6, 1e-2)
"""Tilts, rad, that may count as settled: above rounding, and small enough that nothing more happens."""
LEAST_TOLERANCE = float(np.finfo(float).eps)

MOST_CELLS_A_TASK = 4096
LEAST_CELLS_A_TASK = 256
TASKS = 16
"""A task is a chunk of the store: about a 16th of the cells, within these bounds."""


@dataclass(frozen=True)
class Sweep:
    """What to compute.

    Attributes
    ----------
    problem
        The problem whose fields are changed.
    grid
        The cells: `Product` of axes, or `Draws`.
    duration
        Length of every run, s.
    tolerance
        Relative error per step.
    settled
        A run ends once its energy holds the tilt within this for good, rad (see
        `tippetop.theory.prediction.is_held`); None to follow every run for its whole duration.

    Raises
    ------
    InvalidInput
        If a field is none, the duration is not positive, or the tolerance is out of range; or if runs are to
        end when they have settled, and the tops are not eccentric spheres.
    """

    problem: Problem
    grid: Product | Draws
    duration: float = 20.0
    tolerance: float = DEFAULT_TOLERANCE
    settled: float | None = None

    def __post_init__(self) -> None:
        if not (math.isfinite(self.duration) and self.duration > 0):
            raise InvalidInput("duration", self.duration, "a finite number of seconds greater than 0")
        if not LEAST_TOLERANCE <= self.tolerance <= 1e-3:
            raise InvalidInput("tolerance", self.tolerance, f"a number from {LEAST_TOLERANCE:.2g} to 0.001")
        if self.settled is not None:
            least, most = SETTLED_RANGE
            if not least <= self.settled <= most:
                raise InvalidInput("settled", self.settled, f"a tilt from {least:g} to {most:g} rad")
            eccentricity(self.problem.top)
        cells_of(self.problem, self.grid.values(np.arange(1)))

    @property
    def cells(self) -> int:
        """How many cells there are."""
        return math.prod(self.grid.shape)

    @cached_property
    def chunk(self) -> tuple[int, ...]:
        """How many cells of every dimension make a task; it does not depend on who computes them."""
        target = min(max(self.cells // TASKS, LEAST_CELLS_A_TASK), MOST_CELLS_A_TASK)
        chunk = list(self.grid.shape)
        while math.prod(chunk) > target and max(chunk) > 1:
            longest = chunk.index(max(chunk))
            chunk[longest] = -(-chunk[longest] // 2)
        return tuple(chunk)

    @property
    def tasks(self) -> list[tuple[int, ...]]:
        """The places of all tasks, row by row."""
        counts = [-(-size // part) for size, part in zip(self.grid.shape, self.chunk, strict=True)]
        return [tuple(int(k) for k in place) for place in np.ndindex(*counts)]

    def region(self, task: tuple[int, ...]) -> tuple[slice, ...]:
        """The cells of a task along every dimension."""
        parts = zip(task, self.chunk, self.grid.shape, strict=True)
        return tuple(slice(k * part, min((k + 1) * part, size)) for k, part, size in parts)

    def numbers(self, task: tuple[int, ...]) -> Any:
        """The cells of a task, counted row by row over the whole sweep, in the shape of its region."""
        return self.numbers_in(tuple((part.start, part.stop) for part in self.region(task)))

    def numbers_in(self, block: tuple[tuple[int, int], ...]) -> Any:
        """The cells between first and last along every dimension, counted row by row, in that shape."""
        ranges = [np.arange(first, last) for first, last in block]
        return np.ravel_multi_index(np.ix_(*ranges), self.grid.shape)

    def describe(self) -> dict[str, Any]:
        """The sweep as plain numbers and words; see `sweep_from`."""
        return {
            "problem": json.loads(self.problem.to_json()),
            "grid": self.grid.describe(),
            "duration": self.duration,
            "tolerance": self.tolerance,
            "settled": self.settled,
        }

    @classmethod
    def read(cls, path: Path | str) -> "Sweep":
        """Read a sweep from a TOML file.

        Raises
        ------
        FileTrouble
            If the file cannot be read.
        InvalidInput
            If it does not hold a sweep.
        """
        text = read_text(path, "a sweep in TOML")
        try:
            fields = parse_toml(text)
        except ValueError as error:
            raise InvalidInput("sweep", str(path), f"TOML; {error}") from None
        return sweep_from_tables(fields, Path(path).parent)


def sweep_from(description: Mapping[str, Any]) -> Sweep:
    """The sweep of a description; see `Sweep.describe`."""
    return Sweep(
        Problem(**description["problem"]),
        grid_from(description["grid"]),
        description["duration"],
        description["tolerance"],
        description["settled"],
    )


def is_sweep(fields: Mapping[str, Any]) -> bool:
    """Whether the tables of a TOML file are those of a sweep rather than of a problem."""
    return bool({"axes", "draws", "duration"} & set(fields)) or isinstance(fields.get("problem"), dict | str)


def sweep_from_tables(fields: Mapping[str, Any], folder: Path = Path()) -> Sweep:
    """The sweep of a TOML file's tables: `problem` (or the name of a file that holds it), `axes` or `draws`.

    Raises
    ------
    InvalidInput, FileTrouble
        If the tables are not those of a sweep.
    """
    keys = ["problem", "axes", "draws", "duration", "tolerance", "settled"]
    for key in fields:
        if key not in keys:
            raise InvalidInput("sweep", key, "the keys " + one_of(key, keys))
    base = fields.get("problem", MISSING)
    if isinstance(base, str):
        problem = Problem.read(folder / base)
    elif isinstance(base, dict):
        problem = Problem(**base)
    else:
        raise InvalidInput("problem", base, "the table of a problem, or the name of a file that holds one")
    if ("axes" in fields) == ("draws" in fields):
        raise InvalidInput("sweep", "axes and draws", "one of them")
    if "axes" in fields:
        axes = _table("axes", fields["axes"])
        grid: Product | Draws = Product(tuple(_axis(field, entry) for field, entry in axes.items()))
    else:
        grid = _draws(_table("draws", fields["draws"]))
    limits = ("duration", "tolerance", "settled")
    settings = {name: _number(name, fields[name]) for name in limits if name in fields}
    return Sweep(problem, grid, **settings)


def _axis(field: str, entry: Any) -> Axis:
    accepted = "{ from, to, count, spacing } or { values }"
    entry = {"values": entry} if isinstance(entry, list) else entry
    if isinstance(entry, dict) and set(entry) == {"values"} and isinstance(entry["values"], list):
        return Axis(field, tuple(_number(field, v) for v in entry["values"]), len(entry["values"]), LISTED)
    if not isinstance(entry, dict) or not {"from", "to", "count"} <= set(entry) <= {
        "from",
        "to",
        "count",
        "spacing",
    }:
        raise InvalidInput(f"axes.{field}", entry, accepted)
    _check_whole(f"axes.{field}.count", entry["count"])
    spacing = str(entry.get("spacing", LINEAR))
    spacing = GEOMETRIC if spacing == "geo" else spacing
    return Axis(field, (_number(field, entry["from"]), _number(field, entry["to"])), entry["count"], spacing)


def _draws(table: Mapping[str, Any]) -> Draws:
    settings = dict(table)
    count, seed = settings.pop("count", MISSING), settings.pop("seed", 0)
    _check_whole("draws.count", count)
    _check_whole("draws.seed", seed)
    fields = _table("draws.fields", settings.pop("fields", None))
    if settings:
        raise InvalidInput("draws", next(iter(settings)), "the keys count, seed, fields")
    ranges = []
    for field, entry in fields.items():
        if not isinstance(entry, dict) or not {"from", "to"} <= set(entry) <= {"from", "to", "law"}:
            raise InvalidInput(f"draws.fields.{field}", entry, "{ from, to, law }")
        low, high = _number(field, entry["from"]), _number(field, entry["to"])
        ranges.append(Range(field, low, high, entry.get("law", "uniform")))
    return Draws(tuple(ranges), count, seed)


def _table(name: str, value: Any) -> Mapping[str, Any]:
    """A table of fields, whose names may be dotted keys of TOML or strings with dots."""
    if not isinstance(value, dict):
        raise InvalidInput(name, value, "a table of fields")
    if name == "draws":
        return value
    pairs = _flattened(value)
    if len(dict(pairs)) < len(pairs):
        raise InvalidInput(
            name, ", ".join(field for field, _ in pairs), "fields that differ from one another"
        )
    return dict(pairs)


def _flattened(table: Mapping[str, Any], prefix: str = "") -> list[tuple[str, Any]]:
    found: list[tuple[str, Any]] = []
    for key, value in table.items():
        if isinstance(value, dict) and not {"from", "values", "to"} & set(value):
            found += _flattened(value, f"{prefix}{key}.")
        else:
            found.append((f"{prefix}{key}", value))
    return found


def _number(name: str, value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise InvalidInput(name, value, "a number")
    try:
        return float(value)
    except OverflowError:
        raise InvalidInput(name, value, "a finite number") from None


def _check_whole(name: str, value: Any) -> None:
    if isinstance(value, bool) or not isinstance(value, int):
        raise InvalidInput(name, value, "a whole number")
