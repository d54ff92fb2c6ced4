"""Where a sweep is kept: a Zarr store that is always whole, whatever becomes of the program that
fills it.

The array `status` alone says what is done. It has every chunk from the beginning: a missing one is
damage. The chunk of a task that is done is written last, once the others are on disk,
and every chunk is written beside its place and then moved there. So a program that dies, or a
machine, even in the middle of a write, loses only the tasks under way. What is lost or damaged
later is found, and done again.
"""

import json
import shutil
import tempfile
from collections.abc import Collection, Iterable, Iterator, Mapping
from contextlib import ExitStack, contextmanager, suppress
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from tippetop.results.catalogue import SWEPT
from tippetop.results.flags import decoded
from tippetop.support.errors import OTHER_OUT, OVERWRITE, RESUME, FileTrouble, Unavailable, require
from tippetop.support.files import in_words, path_of, require_ending
from tippetop.support.installation import install_command
from tippetop.support.interrupts import deferred
from tippetop.sweeps.definition import Sweep, Task
from tippetop.sweeps.store_layout import (
    CONTENTS,
    DIGEST,
    Status,
    kept_sweep,
    lay_out,
    may_be_replaced,
    mend_metadata,
    read_metadata,
    refuse_another,
    refuse_existing,
)
from tippetop.sweeps.store_lock import bring_to_disk, clear_away, identity, locked


class Store:
    """A sweep on disk, in a folder."""

    def __init__(self, path: Path, sweep: Sweep) -> None:
        import zarr  # noqa: PLC0415 - optional

        self.path, self.sweep = path, sweep
        with in_words(path, "opened"):
            # What is nowhere but where nothing is known has to be written too, to be seen to be
            # there.
            with zarr.config.set({"array.write_empty_chunks": True}):
                self._arrays = dict(zarr.open_group(path, mode="r+").arrays())
            self._identity = identity(path)
        self._created = False

    @classmethod
    def create(cls, path: Path | str, sweep: Sweep, overwrite: bool = False) -> "Store":
        """Make an empty store, whole from the moment it is there.

        Raises `InvalidInput` if the name ends as that of another kind of file; `FileTrouble` if
        something is there already and `overwrite` is false, or it is no sweep or being filled, or
        it cannot be written; `Unavailable` if zarr is not installed.
        """
        need_zarr()
        path = path_of(path)
        if path.suffix:
            require_ending("out", path, (".zarr",))
        # Zarr writes in a thread of its own, which Ctrl-C does not stop.
        with in_words(path, "written"), deferred(), ExitStack() as stack:
            refuse_existing(path, overwrite)
            there = path.exists()
            if path.is_symlink() or (there and not may_be_replaced(path)):
                raise FileTrouble(
                    f"{path} exists and is no sweep, so it is not overwritten; choose {OTHER_OUT}"
                )
            clear_away(path)
            beside = Path(tempfile.mkdtemp(dir=path.parent, prefix=f".{path.name}."))
            stack.callback(shutil.rmtree, beside, ignore_errors=True)
            stack.enter_context(locked(beside))
            if there:
                stack.enter_context(locked(path))
            fresh = beside / path.name
            lay_out(fresh, sweep)
            bring_to_disk([fresh, *fresh.rglob("*")])
            if there:
                path.rename(beside / "replaced")
            fresh.rename(path)
            bring_to_disk([path.parent])
        store = cls(path, sweep)
        store._created = True
        return store

    @classmethod
    def resume(cls, path: Path | str, sweep: Sweep | None = None) -> "Store":
        """Open a store to finish it.

        Raises `FileTrouble` if there is no store, or it is of another sweep than `sweep`, or made
        by another version.
        """
        need_zarr()
        path = path_of(path)
        with in_words(path, "read"):
            kept = kept_sweep(path)
        if sweep is not None:
            refuse_another(path, kept, sweep)
        store = cls(path, kept)
        if tuple(store._arrays["status"].chunks) != kept.chunk:
            raise FileTrouble(
                f"{path} has other chunks than this version makes; start afresh with {OVERWRITE}"
            )
        return store

    @contextmanager
    def held(self) -> Iterator[None]:
        """Keep other processes from filling the store meanwhile, and mend what is around its
        results.

        Raises `FileTrouble` if another process fills it or has replaced it, or it cannot be
        written. A store that was created by this object and in which nothing could be written yet
        is then removed.
        """
        self._check_identity()
        with locked(self.path):
            self._check_identity()
            try:
                with in_words(self.path, "written"):
                    for partial in self.path.rglob("*.partial"):
                        partial.unlink(missing_ok=True)
                    self._mend()
                yield
            except FileTrouble:
                if self._created and not self._done(self.status()):
                    self._remove()
                raise

    def _remove(self) -> None:
        """Remove the store, unless another one has taken its place."""
        with suppress(OSError):
            if identity(self.path) == self._identity:
                shutil.rmtree(self.path, ignore_errors=True)

    def _check_identity(self) -> None:
        with in_words(self.path, "written"):
            if identity(self.path) != self._identity:
                raise FileTrouble(
                    f"{self.path} was replaced by another sweep meanwhile; that is left as it is"
                )

    def _mend(self) -> None:
        """Write again what is missing or damaged of the arrays' own metadata, and of the
        coordinates.
        """
        mend_metadata(self.path)
        for name, (_, values) in self.sweep.grid.coordinates().items():
            if self._lost(name, [(0,)]):
                self._arrays[name][...] = values

    def status(self) -> NDArray[np.int8]:
        """Numbers of `Status` over the grid; what cannot be read counts as pending."""
        array = self._arrays["status"]
        if _can_be_read(array, ...):
            return np.asarray(array[...])
        found = np.full(self.sweep.grid.shape, Status.PENDING, dtype=np.int8)
        for region in map(self.sweep.region, self.sweep.tasks):
            if _can_be_read(array, region):
                found[region] = array[region]
        return found

    def remaining(self) -> list[Task]:
        """The tasks that are not done, or whose results are missing or damaged."""
        done = self._done(self.status())
        lost = {task for name in SWEPT for task in self._lost(name, done)}
        return [task for task in self.sweep.tasks if task not in done or task in lost]

    def _done(self, status: NDArray[np.int8]) -> set[Task]:
        sweep = self.sweep
        return {task for task in sweep.tasks if np.all(status[sweep.region(task)] == Status.DONE)}

    def _lost(self, name: str, tasks: Collection[Task]) -> set[Task]:
        """Those of some tasks whose chunk of an array is missing or damaged."""
        array = self._arrays[name]
        lost = {task for task in tasks if not self._chunk(name, task).is_file()}
        if not _can_be_read(array, ...):
            for task in tasks:
                places = zip(task, array.chunks, strict=True)
                if not _can_be_read(
                    array, tuple(slice(k * size, (k + 1) * size) for k, size in places)
                ):
                    lost.add(task)
        return lost

    def write(self, task: Task, variables: Mapping[str, NDArray[Any]]) -> None:
        """Keep what a task found, and, once that is on disk, note that it is done.

        Raises `FileTrouble` if it cannot be written, and then the store stays good; or if it was
        replaced meanwhile.
        """
        region = self.sweep.region(task)
        shape = tuple(part.stop - part.start for part in region)
        self._check_identity()
        with in_words(self.path, "written"):
            for name, values in variables.items():
                self._arrays[name][region] = values.reshape(shape)
            self._bring_chunks_to_disk(variables, task)
            self._arrays["status"][region] = np.full(shape, Status.DONE, dtype=np.int8)
            self._bring_chunks_to_disk(["status"], task)

    def _bring_chunks_to_disk(self, names: Iterable[str], task: Task) -> None:
        chunks = [self._chunk(name, task) for name in names]
        folders = {
            folder for chunk in chunks for folder in chunk.parents if self.path in folder.parents
        }
        bring_to_disk([*chunks, *folders])

    def dataset(self) -> xr.Dataset:
        """The store as a dataset, read when it is used; what is damaged then raises an error of
        Zarr's.

        Raises `FileTrouble` if something is missing.
        """
        return self._opened(SWEPT)

    def load(self, names: Collection[str]) -> xr.Dataset:
        """Some of the variables, read now.

        Raises `FileTrouble` if they are damaged, or something is missing of them.
        """
        with _damage_in_words(self.path):
            return self._opened(names)[list(names)].load()

    def _opened(self, names: Collection[str]) -> xr.Dataset:
        with _damage_in_words(self.path):
            read_metadata(self.path)
            done = self._done(np.asarray(self._arrays["status"][...]))
            needed = [("status", task) for task in self.sweep.tasks]
            needed += [(name, task) for name in names if name in SWEPT for task in done]
            needed += [(name, (0,)) for name in self.sweep.grid.coordinates()]
            for name, task in needed:
                if not self._chunk(name, task).is_file():
                    raise OSError(f"a chunk of {name} is missing")
            opened: xr.Dataset = xr.open_zarr(self.path)
            del opened.attrs[DIGEST]
        return opened

    def _chunk(self, name: str, task: Task) -> Path:
        return self.path.joinpath(name, "c", *map(str, task))


def read_sweep(
    path: Path | str, names: Collection[str] | None = None, *, decode: bool = True
) -> xr.Dataset:
    """Read a sweep, or some of its variables; flags as words, or as numbers unless `decode`.

    Raises
    ------
    FileTrouble
        If it cannot be read, is damaged or is no sweep.

    Examples
    --------
    >>> import tippetop as tt
    >>> spins = {"launch.spin": [50.0, 155.0]}
    >>> problem = tt.presets.report_problem()
    >>> found = tt.sweep(problem, spins, duration=0.1, out="spins.zarr", workers=1)
    >>> tt.read_sweep("spins.zarr").equals(found)
    True
    """
    require("decode", decode, bool, "True or False")
    need_zarr()
    path = path_of(path)
    with in_words(path, "read"):
        sweep = Sweep(**json.loads(read_metadata(path)["attributes"]["sweep"]))
    dataset = Store(path, sweep).load(list(CONTENTS) if names is None else names)
    return decoded(dataset) if decode else dataset


def need_zarr() -> None:
    """Raise `Unavailable` if zarr is not installed."""
    if find_spec("zarr") is None:
        raise Unavailable(
            f"a sweep is kept in a Zarr store; install it with: {install_command('sweep')}"
        )


def _can_be_read(array: Any, region: Any) -> bool:
    try:
        array[region]
    except Exception:  # noqa: BLE001 - whatever a damaged chunk raises
        return False
    return True


@contextmanager
def _damage_in_words(path: Path) -> Iterator[None]:
    """Say of whatever reading a damaged store raises that it is damaged."""
    try:
        yield
    except FileTrouble:
        raise
    except (OSError, ValueError, RuntimeError, KeyError, TypeError) as error:
        raise FileTrouble(
            f"{path} is damaged and cannot be read ({error}); {RESUME} mends it"
        ) from None
