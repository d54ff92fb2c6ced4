"""How a sweep is laid out on disk: a Zarr group that says what it holds, with a checksum over all
of it.

The grid's values are coordinates, every variable is an array over the grid, and a task is one chunk
of each. Every chunk ends in a checksum, and the group's metadata, in which those of all arrays are
repeated, hold a digest of themselves: what is damaged is seen when it is read.
"""

import hashlib
import json
import warnings
from enum import IntEnum
from pathlib import Path
from threading import Lock
from typing import Any

from tippetop import __version__
from tippetop.results.catalogue import SWEPT, Variable, meanings
from tippetop.results.dataset import CONVENTIONS
from tippetop.support.errors import OTHER_OUT, OVERWRITE, RESUME, FileTrouble, short
from tippetop.support.files import refuse_overwriting
from tippetop.sweeps.definition import Sweep
from tippetop.sweeps.grid import Product, field_paths

FORMAT = "tippetop sweep 3"
"""Name and version of the layout; a store of another is refused."""
METADATA = "zarr.json"
DIGEST = "digest"
"""The attribute of the group that holds the digest of its metadata without it."""


class Status(IntEnum):
    """Whether a cell is computed."""

    PENDING = 0
    DONE = 1


CONTENTS = {
    "status": Variable("whether the cell is computed", dtype="int8", flags=meanings(Status)),
    **SWEPT,
}
"""What a sweep's dataset has over the grid."""

_alone = Lock()
"""Warnings are silenced for all threads at once, which therefore do so one after another."""


def lay_out(path: Path, sweep: Sweep) -> None:
    """Write a store without results."""
    import zarr  # noqa: PLC0415 - optional
    from zarr.codecs import Crc32cCodec, ZstdCodec  # noqa: PLC0415 - optional

    checked = ZstdCodec(level=0), Crc32cCodec()
    grid = sweep.grid
    group = zarr.create_group(path, attributes=layout_attributes(sweep), zarr_format=3)
    for name, (dimension, values) in grid.coordinates().items():
        coordinate = group.create_array(
            name,
            shape=values.shape,
            chunks=values.shape,
            dtype=values.dtype.name,
            dimension_names=(dimension,),
            attributes=coordinate_attributes(sweep, name),
            config={"write_empty_chunks": True},
            compressors=checked,
        )
        coordinate[...] = values
    for name, kind in CONTENTS.items():
        array = group.create_array(
            name,
            shape=grid.shape,
            chunks=sweep.chunk,
            dtype=kind.dtype,
            fill_value=Status.PENDING if name == "status" else kind.missing,
            dimension_names=grid.dimensions,
            attributes=_plain(kind.attributes) | _coordinates(sweep),
            config={"write_empty_chunks": name == "status"},
            compressors=checked,
        )
        if name == "status":
            # Every chunk of it is there from the beginning: one that is missing was lost.
            array[...] = Status.PENDING
    with _alone, warnings.catch_warnings():
        # Zarr warns that readers other than Python's may pass over this; they then read every
        # array's own.
        warnings.simplefilter("ignore")
        zarr.consolidate_metadata(path)
    metadata = json.loads((path / METADATA).read_text(encoding="utf-8"))
    metadata["attributes"][DIGEST] = _digest(metadata)
    (path / METADATA).write_text(json.dumps(metadata, indent=2), encoding="utf-8")


def _plain(attributes: dict[str, Any]) -> dict[str, Any]:
    """Attributes with lists for arrays, as JSON has them."""
    return {
        name: value.tolist() if hasattr(value, "tolist") else value
        for name, value in attributes.items()
    }


def layout_attributes(sweep: Sweep) -> dict[str, Any]:
    """The attributes of a sweep's dataset."""
    return {
        "Conventions": CONVENTIONS,
        "title": "What becomes of many launches of a spinning top",
        "format": FORMAT,
        "sweep": json.dumps(sweep.to_fields()),
        "problem": sweep.problem.to_json(),
        "duration": sweep.duration,
        "tolerance": sweep.tolerance,
        "tippetop_version": __version__,
        **({} if isinstance(sweep.grid, Product) else {"seed": sweep.grid.seed}),
    }


def coordinate_attributes(sweep: Sweep, name: str) -> dict[str, Any]:
    """The attributes of a coordinate by the CF conventions, and the `path` of its field."""
    path = field_paths(sweep.grid.fields).get(name)
    if path is None:
        return Variable("number of the sample", "1").attributes
    kind = sweep.problem.quantity(path)
    return Variable(kind.long_name, kind.units).attributes | {"path": path}


def _coordinates(sweep: Sweep) -> dict[str, str]:
    """Coordinates that are not dimensions are named by the CF attribute."""
    others = [
        name for name, (dimension, _) in sweep.grid.coordinates().items() if name != dimension
    ]
    return {"coordinates": " ".join(others)} if others else {}


def _digest(metadata: dict[str, Any]) -> str:
    attributes = {name: value for name, value in metadata["attributes"].items() if name != DIGEST}
    text = json.dumps({**metadata, "attributes": attributes}, sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()


def read_metadata(path: Path) -> dict[str, Any]:
    """The metadata of a store that this version can read.

    Raises `FileTrouble` if there is no store, or it is of another layout, or damaged.
    """
    try:
        data = (path / METADATA).read_bytes()
    except OSError as error:
        if not _has_every_array(path):
            raise FileTrouble(
                f"{path} cannot be read: {error.strerror}; there is no sweep in it"
            ) from None
        data = b""
    try:
        metadata = json.loads(data)
        layout, whole = metadata["attributes"]["format"], metadata["attributes"].get(DIGEST)
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError):
        if not _has_every_array(path):
            raise FileTrouble(f"{path} is not a sweep of this program") from None
        layout, whole, metadata = FORMAT, None, {"attributes": {}}
    if layout != FORMAT:
        raise FileTrouble(
            f"{path} is laid out as {short(layout)}, and this version reads {FORMAT!r}; "
            f"start afresh with {OVERWRITE}"
        )
    if whole != _digest(metadata):
        raise FileTrouble(
            f"{path} is damaged: its {METADATA} is not as it was written; start afresh with"
            f" {OVERWRITE}"
        )
    return dict(metadata)


def mend_metadata(path: Path) -> None:
    """Write again what is missing or damaged of the arrays' own metadata in a store."""
    for name, metadata in read_metadata(path)["consolidated_metadata"]["metadata"].items():
        file = path / name / METADATA
        try:
            whole = json.loads(file.read_text(encoding="utf-8")) == metadata
        except (OSError, ValueError, RecursionError):
            whole = False
        if not whole:
            file.parent.mkdir(exist_ok=True)
            file.write_text(json.dumps(metadata), encoding="utf-8")


def refuse_existing(path: Path, overwrite: bool) -> None:
    """Raise `FileTrouble` if something is where a store is to be made, and may not be
    overwritten.
    """
    refuse_overwriting(path, overwrite, f"finished with {RESUME}, and ")


def kept_sweep(path: Path) -> Sweep:
    """The sweep that a store holds, to go on with it.

    Raises `FileTrouble` as `read_metadata` does, and if it was made by another version, also by one
    of the same name that had other flags.
    """
    metadata = read_metadata(path)
    attributes, arrays = metadata["attributes"], metadata["consolidated_metadata"]["metadata"]
    version = attributes["tippetop_version"]
    if version != __version__:
        raise FileTrouble(
            f"{path} was made by version {version} of tippetop, and this is {__version__}, whose"
            f" results may differ; finish it with that version, or start afresh with {OVERWRITE}"
        )
    for name, kind in CONTENTS.items():
        if arrays.get(name, {}).get("attributes", {}).get("flag_meanings", "") != " ".join(
            kind.flags
        ):
            raise FileTrouble(
                f"{path} was made by a version that tells {name} by other words than this one,"
                f" whose results may differ; what is done can still be read: choose {OTHER_OUT}, or"
                f" start afresh with {OVERWRITE}"
            )
    return Sweep(**json.loads(attributes["sweep"]))


def may_be_replaced(path: Path) -> bool:
    """Whether a folder is empty or holds a sweep, of whatever version and however damaged."""
    if not path.is_dir() or not any(path.iterdir()):
        return path.is_dir()
    try:
        layout = json.loads((path / METADATA).read_text(encoding="utf-8"))["attributes"]["format"]
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return _has_every_array(path)
    return str(layout).startswith(FORMAT.rstrip("0123456789"))


def _has_every_array(path: Path) -> bool:
    """Whether a folder that does not say what it holds is a sweep all the same: it has all that one
    has.
    """
    return all((path / name).is_dir() for name in CONTENTS)


def refuse_another(path: Path, kept: Sweep, sweep: Sweep) -> None:
    """Refuse, with `FileTrouble`, to resume a store that holds another sweep."""
    difference = first_difference(kept.to_fields(), sweep.to_fields())
    if difference is not None:
        name, there, here = difference
        raise FileTrouble(
            f"{path} holds another sweep and cannot be resumed: {name} is {short(there)} in it, and"
            f" {short(here)} here; choose {OTHER_OUT}, or start afresh with {OVERWRITE}"
        )


def first_difference(one: Any, other: Any, name: str = "") -> tuple[str, Any, Any] | None:
    """The name of the first field in which two descriptions differ, and what is there."""
    if isinstance(one, dict) and isinstance(other, dict):
        if set(one) == set(other) and list(one) != list(other):
            return name, list(one), list(other)
        for key in [*one, *(key for key in other if key not in one)]:
            inner = f"{name}.{key}" if name else str(key)
            found = first_difference(one.get(key), other.get(key), inner)
            if found is not None:
                return found
        return None
    if isinstance(one, list) and isinstance(other, list) and len(one) == len(other):
        return first_difference(dict(enumerate(one)), dict(enumerate(other)), name)
    return None if one == other else (name, one, other)
