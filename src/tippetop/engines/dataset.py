"""A data set of many runs for those who learn from motion: states, events, modes, derivatives."""

import json
import shutil
from collections.abc import Callable, Iterator
from importlib.resources import files
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

import tippetop as tt
from tippetop.contact.mode import EventKind
from tippetop.engines.families import FAMILIES, SHARES, drawn_problem
from tippetop.fit.end_slopes import known_end_slopes
from tippetop.fit.problem_numbers import Direction
from tippetop.mechanics.motion import angular_velocity
from tippetop.mechanics.natural_units import Units
from tippetop.mechanics.state import State
from tippetop.mechanics.top import Top, natural_units
from tippetop.mechanics.vectors import scale
from tippetop.problem.problem import top_of
from tippetop.support.errors import FileTrouble, InvalidInput, Unavailable, is_number, is_whole
from tippetop.support.files import (
    in_words,
    named,
    path_of,
    refuse_overwriting,
    require_ending,
    written_beside,
)
from tippetop.support.processes import Job, processors, shared
from tippetop.support.units import number_in

DATASET_VERSION = "1.0"
"""Version of the families: other ranges are another version."""

CARD = "dataset_card.md"
"""File of this package with the data card."""

CHUNK = 100
"""Problems in a job and in a chunk of the store; the first of each has derivatives."""

STATES = {
    "axis": ("1", 3, "unit vector along the axis of symmetry"),
    "angular_velocity": ("rad s-1", 3, "angular velocity, along the table's axes"),
    "velocity": ("m s-1", 3, "velocity of the centre of mass"),
    "height": ("m", 0, "height of the centre of mass above the table"),
}
"""Variables over time: units, components and meaning."""

NUMBERS = tuple(
    f"{name}_{letter}" if count else name
    for name, (_, count, _) in STATES.items()
    for letter in ("xyz" if count else "x")
)
"""Numbers of a state of which there are derivatives."""

FIELDS = tuple(
    dict.fromkeys(
        name for number in range(len(FAMILIES)) for name in drawn_problem(0, number).fields
    )
)
"""Fields that are drawn in any family."""

MODES = (
    *("sliding", "sticking", "sliding_without_rolling", "sticking_without_rolling", "flight"),
    "another",
)
"""Words whose places stand for contact modes; the last one stands for all others."""

EVENT_KINDS = tuple(kind.value for kind in EventKind)
"""Words whose places stand for kinds of events."""

STATUSES = tuple(status.name.lower() for status in tt.Status)
"""Words whose places stand for how runs end."""

Array = NDArray[Any]
Progress = Callable[[float, float], None]


class Chunk(NamedTuple):
    """What the problems of a chunk come to."""

    arrays: dict[str, Array]
    """By variables over problems."""
    events: list[list[tuple[float, int, int]]]
    """Time, kind and surface of each problem's events."""
    derivatives: Array
    """Of the last state of the first problem: by field and number; nan where there is none."""


def write_dataset(
    path: Path | str,
    count: int,
    seed: int = 0,
    *,
    duration: Any = 4.0,
    samples: int = 200,
    overwrite: bool = False,
    workers: int | None = None,
    progress: Progress = lambda *_: None,
) -> Path:
    """Write a data set of random problems as a Zarr store, with a data card beside it.

    Raises
    ------
    InvalidInput
        If a number cannot be, or the name does not end in .zarr.
    FileTrouble
        If the store exists and `overwrite` is false, or cannot be written.
    Unavailable
        If zarr is not installed.
    """
    place = path_of(path)
    require_ending("path", place, (".zarr",))
    seconds = number_in("duration", duration, "s")
    if not (is_number(seconds) and seconds > 0.0):
        raise InvalidInput("duration", duration, "a positive number of seconds")
    for name, value, least in (("count", count, 1), ("seed", seed, 0), ("samples", samples, 2)):
        if not is_whole(value) or value < least:
            raise InvalidInput(name, value, f"a whole number of at least {least}")
    if workers is not None and (not is_whole(workers) or workers < 1):
        raise InvalidInput("workers", workers, "a whole number of at least 1")
    card = place.with_suffix(".md")
    for one in (place, card):
        refuse_overwriting(one, overwrite)
    if place.exists() and not _is_dataset(place):
        raise FileTrouble(f"{named(place)} is no data set of random problems, and not replaced")
    times = np.linspace(0.0, float(seconds), samples)
    beside = place.with_name(f".{place.name}.part")
    with in_words(place, "written"):
        place.parent.stat()  # a folder that is missing may be a mistyped one
        shutil.rmtree(beside, ignore_errors=True)
        try:
            _fill(beside, count, seed, times, workers or processors(), progress)
            if place.exists():
                shutil.rmtree(place)
            beside.rename(place)
        finally:
            shutil.rmtree(beside, ignore_errors=True)
    with written_beside(card, overwrite) as unfinished:
        unfinished.write_text(_card(count, seed, times), encoding="utf-8")
    return place


def _is_dataset(place: Path) -> bool:
    """Return whether a folder is a data set that this module wrote."""
    try:
        attributes = json.loads((place / "zarr.json").read_text(encoding="utf-8"))["attributes"]
    except (OSError, ValueError, KeyError, TypeError):
        return False
    return isinstance(attributes, dict) and "dataset" in attributes


def _fill(
    folder: Path, count: int, seed: int, times: Array, workers: int, progress: Progress
) -> None:
    """Compute all chunks and write them into a store."""
    try:
        import zarr  # noqa: PLC0415 - optional
    except ImportError:
        raise Unavailable("zarr is not installed: pip install 'tippetop[sweep]'") from None
    group = zarr.open_group(folder, mode="w-", zarr_format=3, attributes=_attributes(seed, times))
    _write_coordinates(group, times)
    chunks = list(range(0, count, CHUNK))
    todo = iter(chunks)

    def next_job() -> Job | None:
        first = next(todo, None)
        if first is None:
            return None
        return Job(first, compute_chunk, (seed, first, min(first + CHUNK, count), times))

    events: dict[int, list[list[tuple[float, int, int]]]] = {}
    derived = np.full((len(chunks), len(FIELDS), len(NUMBERS)), np.nan)
    arrays: dict[str, Any] = {}
    done = 0
    for first, chunk in shared(next_job, min(workers, len(chunks))):
        for name, values in chunk.arrays.items():
            if name not in arrays:
                arrays[name] = _created(group, name, (count, *values.shape[1:]), values.dtype)
            arrays[name][first : first + len(values)] = values
        events[first], derived[first // CHUNK] = chunk.events, chunk.derivatives
        done += len(chunk.events)
        progress(done, count)
    listed = [one for first in chunks for one in events[first]]
    _write_array(
        group, "event_count", ("problem",), np.array([len(one) for one in listed], np.int32)
    )
    flat = [event for one in listed for event in one]
    columns = np.array(flat, float).reshape(-1, 3).T
    for name, values, dtype in zip(
        ("event_time", "event_kind", "event_surface"),
        columns,
        (float, np.int8, np.int8),
        strict=True,
    ):
        _write_array(group, name, ("event",), values.astype(dtype))
    _write_array(group, "derivative", ("derived", "field", "number"), derived)
    _write_array(group, "derived_problem", ("derived",), np.array(chunks, np.int32))


ATTRIBUTES: dict[str, dict[str, Any]] = {
    **{name: {"units": unit, "long_name": text} for name, (unit, _, text) in STATES.items()},
    "fields": {"long_name": "values of the fields in `field`, SI; nan where a family has none"},
    "family": {"long_name": "family", "flag_meanings": " ".join(one.name for one in FAMILIES)},
    "split": {"long_name": "part of the data set", "flag_meanings": " ".join(SHARES)},
    "status": {"long_name": "how the run ended", "words": list(STATUSES)},
    "mode": {"long_name": "contact mode; -1 after the end of the run", "words": list(MODES)},
    "end_time": {"units": "s", "long_name": "end of the run: later states are nan"},
    "turnover_time": {"units": "s", "long_name": "first time of a tilt of 90 degrees, or nan"},
    "energy_error": {"units": "1", "long_name": "relative error of the balance of energy"},
    "event_count": {"long_name": "number of events of a problem; they follow one another"},
    "event_time": {"units": "s", "long_name": "time of the event"},
    "event_kind": {"long_name": "kind of the event", "words": list(EVENT_KINDS)},
    "event_surface": {"long_name": "number of the surface"},
    "derivative": {"long_name": "derivative of the state at end_time by a field; nan if not known"},
    "derived_problem": {"long_name": "number of the problem that has the derivatives"},
}
DIMENSIONS = {
    **{
        name: ("problem", "time", "space") if size else ("problem", "time")
        for name, (_, size, _) in STATES.items()
    },
    "mode": ("problem", "time"),
    "fields": ("problem", "field"),
}


def _created(group: Any, name: str, shape: tuple[int, ...], dtype: Any) -> Any:
    """Return a new array over problems."""
    return group.create_array(
        name,
        shape=shape,
        chunks=(min(CHUNK, shape[0]), *shape[1:]),
        dtype=dtype,
        dimension_names=DIMENSIONS.get(name, ("problem",)),
        attributes=ATTRIBUTES.get(name, {}),
    )


def _write_array(group: Any, name: str, dimensions: tuple[str, ...], values: Array) -> None:
    """Write an array that is one chunk."""
    array = group.create_array(
        name,
        shape=values.shape,
        chunks=tuple(max(1, size) for size in values.shape),
        dtype=values.dtype,
        dimension_names=dimensions,
        attributes=ATTRIBUTES.get(name, {}),
    )
    if values.size:
        array[...] = values


def _write_coordinates(group: Any, times: Array) -> None:
    _write_array(group, "time", ("time",), times)


def _attributes(seed: int, times: Array) -> dict[str, Any]:
    """Return what the store says of itself."""
    return {
        "title": "Runs of random problems of spinning bodies on a table",
        "dataset": DATASET_VERSION,
        "program": f"tippetop {tt.__version__}",
        "seed": seed,
        "duration": float(times[-1]),
        "fields": list(FIELDS),
        "numbers": list(NUMBERS),
        "families": {
            one.name: {"about": one.about, "problem": json.loads(one.base.to_json())}
            for one in FAMILIES
        },
    }


# The runs


def compute_chunk(seed: int, first: int, end: int, times: Array) -> Chunk:
    """Return what the problems from a first to before an end come to."""
    size, instants = end - first, len(times)
    arrays: dict[str, Array] = {
        name: np.full((size, instants, *((width,) if width else ())), np.nan)
        for name, (_, width, _) in STATES.items()
    }
    arrays["mode"] = np.full((size, instants), -1, np.int8)
    arrays["fields"] = np.full((size, len(FIELDS)), np.nan)
    for name in ("family", "split", "status"):
        arrays[name] = np.zeros(size, np.int8)
    for name in ("end_time", "turnover_time", "energy_error"):
        arrays[name] = np.full(size, np.nan)
    events = []
    for row in range(size):
        drawn = drawn_problem(seed, first + row)
        run = tt.simulate(drawn.problem, float(times[-1]), times=times)
        count = run.sizes["time"]
        for name in STATES:
            arrays[name][row, :count] = run[name].values
        words = run["mode"].values.tolist()
        arrays["mode"][row, :count] = [
            MODES.index(word) if word in MODES else len(MODES) - 1 for word in words
        ]
        for name, value in drawn.fields.items():
            arrays["fields"][row, FIELDS.index(name)] = value
        arrays["family"][row], arrays["split"][row] = drawn.family, drawn.split
        arrays["status"][row] = STATUSES.index(run.attrs["status"])
        for name in ("end_time", "turnover_time", "energy_error"):
            arrays[name][row] = float(run[name])
        events.append(list(_events(run)))
    return Chunk(arrays, events, _derivatives(seed, first, times))


def _events(run: Any) -> Iterator[tuple[float, int, int]]:
    names = ("event_time", "event_kind", "event_surface")
    for time, kind, surface in zip(*(run[name].values.tolist() for name in names), strict=True):
        yield time, EVENT_KINDS.index(kind), surface


def _derivatives(seed: int, number: int, times: Array) -> Array:
    """Return the derivatives of the last state of a problem by its fields."""
    drawn, end = drawn_problem(seed, number), float(times[-1])
    directions = [Direction.of(drawn.problem, name) for name in drawn.fields]
    units = natural_units(top_of(drawn.problem))
    naturals = np.repeat([1.0, 1.0 / units.time, units.speed, units.length], [3, 3, 3, 1])
    table = np.full((len(FIELDS), len(NUMBERS)), np.nan)
    rows = [FIELDS.index(name) for name in drawn.fields]
    table[rows] = known_end_slopes(drawn.problem, end, directions, _numbers_of, naturals)
    return table


def _numbers_of(state: State, top: Top, units: Units) -> Array:
    """Return the numbers of a state in natural units, in SI and in the order of `NUMBERS`."""
    omega = angular_velocity(state.axis, state.momentum, top)
    return np.array(
        [
            *state.axis,
            *scale(1.0 / units.time, omega),
            *scale(units.speed, state.velocity),
            units.length * state.height,
        ]
    )


def _card(count: int, seed: int, times: Array) -> str:
    """Return the data card."""
    families = "\n".join(f"| `{one.name}` | {one.about} |" for one in FAMILIES)
    shares = ", ".join(f"{name} {100 * part:.0f} %" for name, part in SHARES.items())
    numbers = f"{count} problems, {len(times)} equal times from 0 to {times[-1]:g} s"
    text = (files(__package__) / CARD).read_text(encoding="utf-8")
    return text.format(
        version=DATASET_VERSION,
        program=tt.__version__,
        numbers=numbers,
        seed=seed,
        shares=shares,
        families=families,
        each=CHUNK,
        fields=", ".join(f"`{name}`" for name in FIELDS),
    )
