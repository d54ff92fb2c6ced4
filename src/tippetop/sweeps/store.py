"""Store of a sweep on disk, in Zarr, that stays valid if the program that fills it is killed.

The array `is_done` says which tasks are done. Its chunk of a task is written last, once those of
the results are on disk, and every chunk is written beside its place and then moved there. A program
that is killed, even during a write, loses only the tasks under way. Tasks whose chunks were deleted
are computed again; Zarr reports a damaged chunk when it is read.
"""

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

from tippetop.results.cf_flags import decoded
from tippetop.support.errors import OTHER_OUT, OVERWRITE, RESUME, FileTrouble, Unavailable, require
from tippetop.support.files import in_words, path_of, require_ending
from tippetop.support.installation import install_command
from tippetop.support.interrupts import deferred
from tippetop.sweeps.contents import (
    CONTENTS,
    components_of,
    contents_of,
    coordinates_of,
)
from tippetop.sweeps.definition import Sweep, Task
from tippetop.sweeps.store_layout import (
    altered,
    lay_out,
    may_be_replaced,
    metadata_in_words,
    refuse_altered,
    refuse_another,
    refuse_existing,
    resumable_sweep,
    stored_sweep,
)
from tippetop.sweeps.store_lock import bring_to_disk, clear_away, identity, locked

REPAIR = f"{RESUME} computes missing results again; without a coordinate, use {OVERWRITE}"
"""What to do with a store in which a chunk is missing."""


class Store:
    """A sweep on disk, in a folder."""

    def __init__(self, path: Path, sweep: Sweep) -> None:
        import zarr  # noqa: PLC0415 - optional

        self.path, self.sweep, self._contents = path, sweep, contents_of(sweep)
        with in_words(path, "opened"):
            # Chunks of fill values are written too: a missing chunk was deleted.
            with zarr.config.set({"array.write_empty_chunks": True}), metadata_in_words(path):
                self._arrays = dict(zarr.open_group(path, mode="r+").arrays())
            self._identity = identity(path)
        self._is_new = False

    @classmethod
    def create(cls, path: Path | str, sweep: Sweep, overwrite: bool = False) -> "Store":
        """Make a store without results; it appears at its path in one move.

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
            exists = path.exists()
            if path.is_symlink() or (exists and not may_be_replaced(path)):
                raise FileTrouble(
                    f"{path} exists and is no sweep, so it is not overwritten; choose {OTHER_OUT}"
                )
            clear_away(path)
            beside = Path(tempfile.mkdtemp(dir=path.parent, prefix=f".{path.name}."))
            stack.callback(shutil.rmtree, beside, ignore_errors=True)
            stack.enter_context(locked(beside))
            if exists:
                stack.enter_context(locked(path))
            fresh = beside / path.name
            lay_out(fresh, sweep)
            cls(fresh, sweep)._write_first_values()
            bring_to_disk([fresh, *fresh.rglob("*")])
            if exists:
                path.rename(beside / "replaced")
            fresh.rename(path)
            bring_to_disk([path.parent])
        store = cls(path, sweep)
        store._is_new = True
        return store

    @classmethod
    def resume(cls, path: Path | str, sweep: Sweep | None = None) -> "Store":
        """Open a store to finish it, with a warning if it was begun on another processor.

        Raises `FileTrouble` if there is no store, or it is damaged, or it is of another sweep than
        `sweep`, or made by another version.
        """
        need_zarr()
        path = path_of(path)
        with in_words(path, "read"):
            stored = resumable_sweep(path)
        if sweep is not None:
            refuse_another(path, stored, sweep)
        store = cls(path, stored)
        with _damage_in_words(path):
            store._check_coordinates()
        return store

    @contextmanager
    def held(self) -> Iterator[None]:
        """Keep other processes from filling the store.

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
                yield
            except FileTrouble:
                if self._is_new and not self._done(self.is_done()):
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

    def _write_first_values(self) -> None:
        """Write the coordinates, and that no cell is done."""
        for name, (_, values) in coordinates_of(self.sweep).items():
            self._arrays[name][...] = values
        self._arrays["is_done"][...] = False

    @property
    def _results(self) -> list[str]:
        """Names of the variables that tasks compute."""
        return [name for name in self._contents if name != "is_done"]

    def is_done(self) -> NDArray[np.bool_]:
        """Return whether each cell is computed; those of chunks that cannot be read are not."""
        array = self._arrays["is_done"]
        if _can_be_read(array, ...):
            return np.asarray(array[...])
        done = np.full(self.sweep.grid.shape, False)
        for region in map(self.sweep.region, self.sweep.tasks):
            if _can_be_read(array, region):
                done[region] = array[region]
        return done

    def remaining(self) -> list[Task]:
        """Return the tasks that are not done, and those of which a chunk was deleted."""
        done = self._done(self.is_done())
        stored = [self._stored(name) for name in self._results]
        done.intersection_update(*stored)
        return [task for task in self.sweep.tasks if task not in done]

    def _done(self, done: NDArray[np.bool_]) -> set[Task]:
        sweep = self.sweep
        return {task for task in sweep.tasks if np.all(done[sweep.region(task)])}

    def _stored(self, name: str) -> set[Task]:
        """Return the tasks of which an array has a chunk on disk."""
        folder = self.path / name / "c"
        places = (file.relative_to(folder).parts for file in folder.rglob("*") if file.is_file())
        along = len(self.sweep.grid.shape)
        return {tuple(map(int, place[:along])) for place in places if all(map(str.isdigit, place))}

    def write(self, task: Task, variables: Mapping[str, NDArray[Any]]) -> None:
        """Write the results of a task, and that it is done once they are on disk.

        Raises `FileTrouble` if it cannot be written, and then the store stays good; or if it was
        replaced meanwhile.
        """
        region = self.sweep.region(task)
        shape = tuple(part.stop - part.start for part in region)
        self._check_identity()
        with in_words(self.path, "written"):
            for name, values in variables.items():
                self._arrays[name][region] = values.reshape(*shape, *values.shape[1:])
            self._bring_chunks_to_disk(variables, task)
            self._arrays["is_done"][region] = np.full(shape, True)
            self._bring_chunks_to_disk(["is_done"], task)

    def _bring_chunks_to_disk(self, names: Iterable[str], task: Task) -> None:
        chunks = [self._chunk(name, task) for name in names]
        folders = {
            folder for chunk in chunks for folder in chunk.parents if self.path in folder.parents
        }
        bring_to_disk([*chunks, *folders])

    def dataset(self) -> xr.Dataset:
        """Return the store as a dataset whose values are read when they are used.

        Zarr raises an error of its own for a damaged chunk then.

        Raises `FileTrouble` if a chunk is missing, or the metadata were altered.
        """
        return self._opened(self._results)

    def load(self, names: Collection[str], others: Collection[str] = ()) -> xr.Dataset:
        """Return some of the variables, read now, and others that are read when they are used.

        Raises `FileTrouble` if one of their chunks is damaged or missing, or the metadata were
        altered.
        """
        with _damage_in_words(self.path):
            dataset = self._opened([*names, *others])[[*names, *others]]
            try:
                return dataset.assign(dataset[list(names)].load().variables)
            except ZARR_ERRORS:
                self._name_damaged_chunk(names)
                raise

    def _opened(self, names: Collection[str]) -> xr.Dataset:
        with _damage_in_words(self.path):
            refuse_altered(self.path, self.sweep)
            self._check_coordinates()
            done = self._done(np.asarray(self._arrays["is_done"][...]))
            chunks = [("is_done", task) for task in self.sweep.tasks]
            chunks += [(name, task) for name in names if name in self._results for task in done]
            self._require_chunks(chunks)
            opened: xr.Dataset = xr.open_zarr(self.path)
        return opened.assign_coords(components_of(self.sweep))

    def _check_coordinates(self) -> None:
        """Raise an error unless the coordinates are stored and are those of the sweep."""
        coordinates = coordinates_of(self.sweep)
        self._require_chunks([(name, (0,)) for name in coordinates])
        for name, (_, values) in coordinates.items():
            # Other processors and libraries may round values that follow from a formula otherwise.
            if not np.allclose(self._arrays[name][...], values, rtol=1e-12, atol=0.0):
                raise altered(self.path)

    def _require_chunks(self, chunks: Collection[tuple[str, Task]]) -> None:
        """Raise `OSError` unless the files of these chunks exist."""
        for name, task in chunks:
            if not self._chunk(name, task).is_file():
                raise OSError(f"a chunk of {name} is missing")

    def _name_damaged_chunk(self, names: Collection[str]) -> None:
        """Raise `FileTrouble` with the first chunk that cannot be read, if there is one."""
        for name in names:
            for task in self._stored(name):
                if not _can_be_read(self._arrays[name], self.sweep.region(task)):
                    chunk = self._chunk(name, task).relative_to(self.path)
                    raise FileTrouble(
                        f"{self.path} is damaged: its chunk {chunk} cannot be read; delete the"
                        f" chunk, and {RESUME} computes it again"
                    )

    def _chunk(self, name: str, task: Task) -> Path:
        """Return the file of the chunk of a task: samples are not divided further."""
        shape = self._contents[name].shape if name in self._contents else ()
        return self.path.joinpath(name, "c", *map(str, task), *("0" for _ in shape))


def read_sweep(
    path: Path | str, names: Collection[str] | None = None, *, decode: bool = True
) -> xr.Dataset:
    """Return a stored sweep, or some of its variables.

    Flags are words, or numbers unless `decode`. Samples of trajectories may be more than
    fits into memory: they are read when they are used, unless they are named.

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
        sweep = stored_sweep(path)
    samples = [name for name in contents_of(sweep) if name not in CONTENTS]
    chosen = (list(CONTENTS), samples) if names is None else (names, [])
    dataset = Store(path, sweep).load(*chosen)
    return decoded(dataset) if decode else dataset


def need_zarr() -> None:
    """Raise `Unavailable` if zarr is not installed."""
    if find_spec("zarr") is None:
        raise Unavailable(
            f"a sweep is kept in a Zarr store; install it with: {install_command('sweep')}"
        )


ZARR_ERRORS = OSError, ValueError, RuntimeError, KeyError, TypeError
"""Errors that Zarr and its codecs raise for damaged chunks and metadata."""


def _can_be_read(array: Any, region: Any) -> bool:
    try:
        array[region]
    except ZARR_ERRORS:
        return False
    return True


@contextmanager
def _damage_in_words(path: Path) -> Iterator[None]:
    """Raise `FileTrouble` for errors that a damaged store raises."""
    try:
        yield
    except FileTrouble:
        raise
    except ZARR_ERRORS as error:
        raise FileTrouble(f"{path} is damaged and cannot be read ({error}); {REPAIR}") from None
