"""Layout of a sweep on disk: a Zarr group of arrays over the grid, a chunk of each for every task.

The group's attributes name the sweep, from which all metadata follow: `lay_out` writes them, and
`refuse_altered` compares those of a store with what `lay_out` makes. Every chunk has a checksum of
Zarr's.
"""

import json
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from threading import Lock
from typing import Any

from llvmlite.binding import get_host_cpu_name

from tippetop import __version__
from tippetop.problem.implausible import warn
from tippetop.results.dataset import CONVENTIONS
from tippetop.support.errors import OTHER_OUT, OVERWRITE, RESUME, FileTrouble, short
from tippetop.support.files import refuse_overwriting
from tippetop.sweeps.contents import (
    CONTENTS,
    contents_of,
    coordinate_attributes,
    coordinates_of,
)
from tippetop.sweeps.definition import Sweep

FORMAT = "tippetop sweep 5"
"""Name and version of the layout; a store of another is refused."""
METADATA = "zarr.json"

_warnings_lock = Lock()
"""Held while warnings are silenced, which affects all threads."""


def lay_out(store: Any, sweep: Sweep) -> Any:
    """Create the group and the arrays of a sweep, without values; return the `zarr.Group`.

    Parameters
    ----------
    store
        A path, or a store of Zarr's.
    sweep
        The sweep that is to be stored.
    """
    import zarr  # noqa: PLC0415 - optional
    from zarr.codecs import Crc32cCodec, ZstdCodec  # noqa: PLC0415 - optional

    compressors = ZstdCodec(level=0), Crc32cCodec()
    group = zarr.create_group(store, attributes=layout_attributes(sweep), zarr_format=3)
    for name, (dimension, values) in coordinates_of(sweep).items():
        group.create_array(
            name,
            shape=values.shape,
            chunks=values.shape,
            dtype=values.dtype.name,
            dimension_names=(dimension,),
            attributes=coordinate_attributes(sweep, name),
            compressors=compressors,
        )
    for name, content in contents_of(sweep).items():
        kind = content.variable
        group.create_array(
            name,
            shape=(*sweep.grid.shape, *content.shape),
            chunks=(*sweep.chunk, *content.shape),
            dtype=kind.dtype,
            fill_value=kind.missing,
            dimension_names=(*sweep.dimensions, *content.dimensions),
            attributes=_json_attributes(kind.attributes) | _coordinates(sweep),
            compressors=compressors,
        )
    with _warnings_lock, warnings.catch_warnings():
        # Zarr warns that readers other than Python's may ignore consolidated metadata; they then
        # read every array's metadata.
        warnings.simplefilter("ignore")
        return zarr.consolidate_metadata(store)


def _json_attributes(attributes: dict[str, Any]) -> dict[str, Any]:
    """Return attributes with lists in place of arrays, which JSON does not have."""
    return {
        name: value.tolist() if hasattr(value, "tolist") else value
        for name, value in attributes.items()
    }


def layout_attributes(sweep: Sweep) -> dict[str, Any]:
    """Return the attributes of a sweep's dataset."""
    return {
        "Conventions": CONVENTIONS,
        "title": "What becomes of many launches of a spinning top",
        "format": FORMAT,
        "sweep": json.dumps(sweep.to_fields()),
        "problem": sweep.problem.to_json(),
        "duration": sweep.duration,
        "tolerance": sweep.tolerance,
        "tippetop_version": __version__,
        "processor": get_host_cpu_name(),
        **({"seed": sweep.seed or 0} if sweep.draw is not None else {}),
    }


def _coordinates(sweep: Sweep) -> dict[str, str]:
    """Return the CF attribute that names the coordinates that are not dimensions."""
    others = [name for name, (dimension, _) in sweep.coordinates().items() if name != dimension]
    return {"coordinates": " ".join(others)} if others else {}


def read_attributes(path: Path) -> dict[str, Any]:
    """Return the attributes of a store that this version can read.

    Raises `FileTrouble` if there is no store, or it is of another layout, or damaged.
    """
    try:
        data = (path / METADATA).read_bytes()
    except OSError as error:
        if not _has_every_array(path):
            raise FileTrouble(
                f"{path} cannot be read: {error.strerror}; there is no sweep in it"
            ) from None
        raise altered(path) from None
    try:
        attributes: dict[str, Any] = json.loads(data)["attributes"]
        layout = attributes["format"]
    except (ValueError, KeyError, TypeError, RecursionError):
        if not _has_every_array(path):
            raise FileTrouble(f"{path} is not a sweep of this program") from None
        raise altered(path) from None
    if layout != FORMAT:
        raise FileTrouble(
            f"{path} is laid out as {short(layout)}, and this version reads {FORMAT!r}; "
            f"start afresh with {OVERWRITE}"
        )
    return attributes


def altered(path: Path) -> FileTrouble:
    """Return the error for metadata that are not those of the store's sweep."""
    return FileTrouble(
        f"{path} is damaged: its {METADATA} is not as it was written; start afresh with {OVERWRITE}"
    )


@contextmanager
def metadata_in_words(path: Path) -> Iterator[None]:
    """Raise `FileTrouble` for the errors that altered metadata raise."""
    try:
        yield
    except (ValueError, KeyError, TypeError):
        raise altered(path) from None


def stored_sweep(path: Path) -> Sweep:
    """Return the sweep that the metadata of a store describe.

    Raises `FileTrouble` as `read_attributes` does, and if they describe none.
    """
    attributes = read_attributes(path)
    with metadata_in_words(path):
        return Sweep(**json.loads(attributes["sweep"]))


def refuse_altered(path: Path, sweep: Sweep) -> None:
    """Raise `FileTrouble` if the metadata of a store do not follow from its sweep.

    Stores that another version made may have other metadata, and are not compared.
    """
    import zarr  # noqa: PLC0415 - optional

    if read_attributes(path).get("tippetop_version") != __version__:
        return
    with metadata_in_words(path):
        group = zarr.open_consolidated(path, mode="r")
        expected = lay_out(zarr.storage.MemoryStore(), sweep).metadata.to_dict()
        expected["attributes"]["processor"] = group.attrs["processor"]
        follows = group.metadata.to_dict() == expected
    if not follows:
        raise altered(path)


def resumable_sweep(path: Path) -> Sweep:
    """Return the sweep of a store that is to be finished.

    It warns if the store was begun on another kind of processor.

    Raises `FileTrouble` as `stored_sweep` and `refuse_altered` do, and if another version made the
    store.
    """
    attributes = read_attributes(path)
    version, processor = attributes.get("tippetop_version"), attributes.get("processor")
    if version != __version__:
        raise FileTrouble(
            f"{path} was made by version {version} of tippetop, and this is {__version__}, whose"
            f" results may differ; finish it with that version, or start afresh with {OVERWRITE}"
        )
    sweep = stored_sweep(path)
    refuse_altered(path, sweep)
    if processor != get_host_cpu_name():
        warn(
            f"{path} was begun on a processor {processor}, and this one is {get_host_cpu_name()}:"
            " its cells may differ from those computed here in the last digits",
            UserWarning,
        )
    return sweep


def refuse_existing(path: Path, overwrite: bool) -> None:
    """Raise `FileTrouble` if something is where a store is to be made, and may not be
    overwritten.
    """
    refuse_overwriting(path, overwrite, f"finished with {RESUME}, and ")


def may_be_replaced(path: Path) -> bool:
    """Return whether a folder is empty or holds a sweep, of any version and however damaged."""
    if not path.is_dir() or not any(path.iterdir()):
        return path.is_dir()
    try:
        layout = json.loads((path / METADATA).read_text(encoding="utf-8"))["attributes"]["format"]
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return _has_every_array(path)
    return str(layout).startswith(FORMAT.rstrip("0123456789"))


def _has_every_array(path: Path) -> bool:
    """Return whether a folder has a folder for every variable of a sweep."""
    return all((path / name).is_dir() for name in CONTENTS)


def refuse_another(path: Path, stored: Sweep, sweep: Sweep) -> None:
    """Refuse, with `FileTrouble`, to resume a store that holds another sweep."""
    difference = first_difference(stored.to_fields(), sweep.to_fields())
    if difference is not None:
        name, old, new = difference
        raise FileTrouble(
            f"{path} holds another sweep and cannot be resumed: {name} is {_stated(old)} in it,"
            f" and {_stated(new)} here; choose {OTHER_OUT}, or start afresh with {OVERWRITE}"
        )


def _stated(value: Any) -> str:
    return "not stated" if value is None else short(value)


def first_difference(a: Any, b: Any, name: str = "") -> tuple[str, Any, Any] | None:
    """Return the name and the two values of the first field in which two descriptions differ."""
    if isinstance(a, dict) and isinstance(b, dict):
        if set(a) == set(b) and list(a) != list(b):
            return name, list(a), list(b)
        for key in [*a, *(key for key in b if key not in a)]:
            inner = f"{name}.{key}" if name else str(key)
            difference = first_difference(a.get(key), b.get(key), inner)
            if difference is not None:
                return difference
        return None
    if isinstance(a, list) and isinstance(b, list) and len(a) == len(b):
        return first_difference(dict(enumerate(a)), dict(enumerate(b)), name)
    return None if a == b else (name, a, b)
