"""Where a sweep is kept: a Zarr store that is always whole, whatever becomes of the program that fills it.

The grid's values are coordinates, every variable is an array over the grid, and a task is one chunk of each.
The array `status` alone says what is done: its chunk is written last, and every chunk is written beside its
place and then moved there. So a program that dies, even in the middle of a write, loses only the tasks under
way.
"""

import json
import shutil
import tempfile
import warnings
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from enum import IntEnum
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from tippetop import __version__
from tippetop.dataset import CONVENTIONS
from tippetop.errors import FileTrouble, InvalidInput, Unavailable, short
from tippetop.files import refuse_overwriting
from tippetop.interrupts import deferred
from tippetop.sweep.definition import Sweep
from tippetop.sweep.observe import VARIABLES, Variable
from tippetop.validation import Quantity

FORMAT = "tippetop sweep 1"
"""Name and version of the layout; a store of another is refused."""


class Status(IntEnum):
    """Whether a cell is computed."""

    PENDING = 0
    DONE = 1


STATUS = Variable("whether the cell is computed", "", "int8", tuple(flag.name.lower() for flag in Status))


class Store:
    """A sweep on disk.

    Parameters
    ----------
    path
        Its folder.
    sweep
        The sweep that it holds.
    """

    def __init__(self, path: Path, sweep: Sweep) -> None:
        import zarr  # noqa: PLC0415 - optional

        self.path, self.sweep = path, sweep
        with in_words(path, "opened"):
            self._group = zarr.open_group(path, mode="r+")

    @classmethod
    def create(cls, path: Path | str, sweep: Sweep, overwrite: bool = False) -> "Store":
        """Make an empty store, whole from the moment it is there.

        Raises
        ------
        FileTrouble
            If something is there already and `overwrite` is false or it is no sweep, or it cannot be written.
        Unavailable
            If zarr is not installed.
        """
        need_zarr()
        path = Path(path)
        refuse_overwriting(path, overwrite)
        if path.is_symlink() or (path.exists() and not _may_be_replaced(path)):
            raise FileTrouble(
                f"{path} exists and is no sweep, so it is not overwritten; choose another --out"
            )
        # Zarr writes in a thread of its own, which Ctrl-C does not stop.
        with in_words(path, "written"), deferred():
            beside = Path(tempfile.mkdtemp(dir=path.parent, prefix=f".{path.name}."))
            try:
                fresh = beside / path.name
                _lay_out(fresh, sweep)
                if path.exists():
                    path.rename(beside / "replaced")
                fresh.rename(path)
            finally:
                shutil.rmtree(beside, ignore_errors=True)
        return cls(path, sweep)

    @classmethod
    def resume(cls, path: Path | str, sweep: Sweep | None = None) -> "Store":
        """Open a store to finish it.

        Raises
        ------
        FileTrouble
            If there is no store, or it is of another sweep than `sweep`, or made by another version.
        """
        need_zarr()
        path = Path(path)
        kept = read_sweep(path)
        if sweep is not None:
            difference = first_difference(kept.describe(), sweep.describe())
            if difference is not None:
                name, there, here = difference
                raise FileTrouble(
                    f"{path} holds another sweep and cannot be resumed: {name} is {short(there)} in it, and "
                    f"{short(here)} here; choose another --out, or start afresh with --force"
                )
        store = cls(path, kept)
        if tuple(store._array("status").chunks) != kept.chunk:
            raise FileTrouble(f"{path} has other chunks than this version makes; start afresh with --force")
        return store

    @contextmanager
    def held(self) -> Iterator[None]:
        """Keep other processes from filling the store meanwhile, and clear away what a killed one left.

        Raises
        ------
        FileTrouble
            If another process fills it, or it cannot be written.
        """
        from filelock import FileLock, Timeout  # noqa: PLC0415 - optional

        lock = FileLock(self.path / ".lock", blocking=False)
        with in_words(self.path, "written"):
            try:
                lock.acquire()
            except Timeout:
                raise FileTrouble(f"{self.path} is being filled by another process") from None
        try:
            with in_words(self.path, "written"):
                for partial in self.path.rglob("*.partial"):
                    partial.unlink(missing_ok=True)
            yield
        finally:
            lock.release()

    def status(self) -> NDArray[np.int8]:
        """Numbers of `Status` over the grid; what cannot be read counts as pending."""
        found = np.full(self.sweep.grid.shape, Status.PENDING, dtype=np.int8)
        for task in self.sweep.tasks:
            region = self.sweep.region(task)
            try:
                found[region] = self._array("status")[region]
            except Exception:  # noqa: BLE001 - whatever a damaged chunk raises, it is done again
                continue
        return found

    def remaining(self) -> list[tuple[int, ...]]:
        """The tasks that are not done."""
        status = self.status()
        return [
            task for task in self.sweep.tasks if not np.all(status[self.sweep.region(task)] == Status.DONE)
        ]

    def write(self, task: tuple[int, ...], variables: Mapping[str, NDArray[Any]]) -> None:
        """Keep what a task found, and then note that it is done.

        Raises
        ------
        FileTrouble
            If it cannot be written; the store stays good.
        """
        region = self.sweep.region(task)
        shape = tuple(part.stop - part.start for part in region)
        with in_words(self.path, "written"):
            for name, values in variables.items():
                self._array(name)[region] = values.reshape(shape)
            self._array("status")[region] = np.full(shape, Status.DONE, dtype=np.int8)

    def dataset(self) -> xr.Dataset:
        """The store as a dataset, read when it is used."""
        opened: xr.Dataset = xr.open_zarr(self.path)
        return opened

    def load(self, names: list[str]) -> xr.Dataset:
        """Some of the variables, read now.

        Raises
        ------
        FileTrouble
            If they cannot be read.
        """
        try:
            loaded: xr.Dataset = self.dataset()[names].load()
        except (OSError, ValueError, RuntimeError) as error:
            raise FileTrouble(
                f"{self.path} is damaged and cannot be read ({error}); start afresh with --force"
            ) from None
        return loaded

    def _array(self, name: str) -> Any:
        return self._group[name]


def need_zarr() -> None:
    """Raise `Unavailable` if zarr is not installed."""
    if find_spec("zarr") is None:
        raise Unavailable("a sweep is kept in a Zarr store; install it with: pip install 'tippetop[sweep]'")


def _may_be_replaced(path: Path) -> bool:
    """Whether a folder is empty or holds a sweep, of whatever version."""
    if not path.is_dir() or not any(path.iterdir()):
        return path.is_dir()
    try:
        layout = json.loads((path / "zarr.json").read_text(encoding="utf-8"))["attributes"]["format"]
    except (OSError, ValueError, KeyError, TypeError):
        return False
    return str(layout).startswith(FORMAT.rstrip("0123456789"))


def read_sweep(path: Path | str) -> Sweep:
    """The sweep that a store holds.

    Raises
    ------
    FileTrouble
        If there is no store, or it was made by another version.
    """
    path = Path(path)
    try:
        attributes = json.loads((path / "zarr.json").read_text(encoding="utf-8"))["attributes"]
        layout, version = attributes["format"], attributes["tippetop_version"]
    except OSError as error:
        raise FileTrouble(f"{path} cannot be read: {error.strerror}; there is no sweep to resume") from None
    except (ValueError, KeyError):
        raise FileTrouble(f"{path} is not a sweep of this program") from None
    if layout != FORMAT or version != __version__:
        raise FileTrouble(
            f"{path} was made by version {version} of tippetop, and this is {__version__}, whose results may "
            "differ; finish it with that version, or start afresh with --force"
        )
    try:
        return Sweep(**json.loads(attributes["sweep"]))
    except (ValueError, KeyError, TypeError, InvalidInput) as error:
        raise FileTrouble(f"{path} is damaged: its sweep cannot be read ({error})") from None


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


def layout_attributes(sweep: Sweep) -> dict[str, Any]:
    """The attributes of a sweep's dataset."""
    return {
        "Conventions": CONVENTIONS,
        "title": "What becomes of many launches of a spinning top",
        "format": FORMAT,
        "sweep": json.dumps(sweep.describe()),
        "problem": sweep.problem.to_json(),
        "duration": sweep.duration,
        "tolerance": sweep.tolerance,
        "tippetop_version": __version__,
    }


def coordinate_attributes(sweep: Sweep, name: str) -> dict[str, Any]:
    """The attributes of a coordinate by the CF conventions."""
    kind = Quantity("1", "number of the draw") if name == "draw" else sweep.problem.quantity(name)
    return {"long_name": kind.long_name} | ({"units": kind.units} if kind.units else {})


def _lay_out(path: Path, sweep: Sweep) -> None:
    """Write a store without results."""
    import zarr  # noqa: PLC0415 - optional

    grid = sweep.grid
    group = zarr.create_group(path, attributes=layout_attributes(sweep), zarr_format=3)
    for name, (dimension, values) in grid.coordinates().items():
        kept = group.create_array(
            name,
            shape=values.shape,
            chunks=values.shape,
            dtype=values.dtype.name,
            dimension_names=(dimension,),
            attributes=coordinate_attributes(sweep, name),
        )
        kept[...] = values
    for name, kind in {"status": STATUS, **VARIABLES}.items():
        attributes = kind.attributes | _coordinates(sweep)
        group.create_array(
            name,
            shape=grid.shape,
            chunks=sweep.chunk,
            dtype=kind.dtype,
            fill_value=Status.PENDING if name == "status" else kind.missing,
            dimension_names=grid.dimensions,
            attributes=attributes,
        )
    with warnings.catch_warnings():
        # Zarr warns that readers other than Python's may pass over this; they then read every array's own.
        warnings.simplefilter("ignore")
        zarr.consolidate_metadata(path)


def _coordinates(sweep: Sweep) -> dict[str, str]:
    """Coordinates that are not dimensions are named by the CF attribute."""
    others = [name for name, (dimension, _) in sweep.grid.coordinates().items() if name != dimension]
    return {"coordinates": " ".join(others)} if others else {}


@contextmanager
def in_words(path: Path, done: str) -> Iterator[None]:
    """Turn what the file system says into one sentence."""
    try:
        yield
    except FileTrouble:
        raise
    except OSError as error:
        raise FileTrouble(f"{path} cannot be {done}: {error.strerror or error}") from None
