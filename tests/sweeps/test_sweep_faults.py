"""Stores that are damaged, fought over or torn away: nothing is read wrong, and lost results are
computed again.
"""

import contextlib
import errno
import os
import shutil
import signal
import subprocess
import sys
import threading
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from sweep_cases import lively, stored, wait_for_a_task

from campaigns import among, examples, seeds
from children import posix_only, started
from tippetop.problem.presets import report_problem
from tippetop.support.errors import FileTrouble
from tippetop.sweeps import (
    SWEPT,
    Store,
    Sweep,
    compute,
    definition,
    fill,
    read_sweep,
    store_layout,
    store_lock,
)
from tippetop.sweeps.draws import columns_of

zarr = pytest.importorskip("zarr")


DAMAGES = examples(check=8, claim=20)
"""In how many places a store is damaged, one after the other."""


def quick():
    """Seven rows, so that the chunks at the edge are cut."""
    return lively("fly", 7, 3, 0.05, 1e-9)


def flip(data, random):
    place = random.integers(len(data))
    return data[:place] + bytes([data[place] ^ 1 << random.integers(8)]) + data[place + 1 :]


def cut(data, random):
    return data[: random.integers(len(data))]


def blank(data, random):
    place = random.integers(len(data))
    return data[:place] + bytes(min(16, len(data) - place)) + data[place + 16 :]


def lose(data, random):
    return None


@pytest.mark.parametrize("seed", seeds(check=1, sample=4, claim=50))
def test_nothing_damaged_is_read_and_lost_results_are_computed_again(tmp_path, monkeypatch, seed):
    monkeypatch.setattr(definition, "LEAST_CELLS_A_TASK", 12)
    path, random = tmp_path / "a.zarr", np.random.default_rng(seed)
    truth = compute(quick())
    stored(quick(), path, workers=1)
    names = ["is_done", *SWEPT]
    xr.testing.assert_identical(read_sweep(path, decode=False)[names], truth[names])
    files = sorted(file for file in path.rglob("*") if file.is_file() and file.name != ".lock")

    def is_result(file):
        place = file.relative_to(path).parts
        return place[0] in names and place[1] == "c"

    refused = 0
    for attempt in range(DAMAGES):
        # One of the results and one of the other files in turn; any of them as likely as any
        # other, or any byte.
        some = [file for file in files if is_result(file) == (attempt % 2 == 0)]
        sizes = np.array([file.stat().st_size for file in some])
        file = random.choice(
            some, p=random.choice([sizes / sizes.sum(), np.full(len(some), 1 / len(some))])
        )
        data, place = file.read_bytes(), file.relative_to(path).parts
        damage = random.choice([flip, cut, blank, lose])(data, random)
        if damage is None:
            file.unlink()
        else:
            file.write_bytes(damage)
        where = f"{damage and len(damage)} of {len(data)} bytes of {file.relative_to(path)}"
        try:
            found = read_sweep(path, decode=False)[names]
        except FileTrouble:
            refused += 1
        else:
            # Metadata of an array, which the group's repeat, spaces between words, or a task that
            # counts as pending.
            done = found["is_done"]
            assert found.where(done).identical(truth[names].where(done)), where
            assert bool(done.all()) or place[:2] == ("is_done", "c"), where
        if is_result(file):
            file.unlink(missing_ok=True)
            fill(Store.resume(path), workers=1)
            assert file.is_file(), where
        else:
            if place[0] == "zarr.json" or place[1] == "c":
                with pytest.raises(FileTrouble) if damage != data else contextlib.nullcontext():
                    read_sweep(path)
            file.write_bytes(data)
        xr.testing.assert_identical(read_sweep(path, decode=False)[names], truth[names])
    assert refused >= DAMAGES // 4, "hardly any damage was noticed"


@pytest.mark.parametrize(
    ("there", "instead"),
    [
        ('"duration": 0.05', '"duration": 0.06'),
        ("rad s-1", "rad s-2"),
        ("upright inverted", "inverted upright"),
        (r"\"from\": 40.0", r"\"from\": 44.0"),
        ('"separator": "/"', '"separator": "."'),
    ],
)
def test_metadata_that_were_edited_are_refused(tmp_path, there, instead):
    path = tmp_path / "a.zarr"
    Store.create(path, quick())
    text = (path / "zarr.json").read_text()
    assert there in text
    (path / "zarr.json").write_text(text.replace(there, instead, 1))
    for read in (read_sweep, Store.resume):
        with pytest.raises(FileTrouble, match=r"zarr\.json is not as it was written"):
            read(path)


def test_resuming_does_again_what_is_missing_and_no_more(tmp_path, small_tasks):
    path = tmp_path / "a.zarr"
    stored(quick(), path, workers=1)
    first, *_, last = quick().tasks
    shutil.rmtree(path / "final_tilt" / "c" / str(first[0]))
    chunk = path.joinpath("steps", "c", *map(str, last))
    chunk.unlink()
    store = Store.resume(path)
    lost = {task for task in quick().tasks if task[0] == first[0]} | {last}
    assert set(store.remaining()) == lost
    with pytest.raises(FileTrouble, match="resume=True computes missing results again"):
        store.load(["final_tilt"])
    with pytest.raises(FileTrouble, match=r"a chunk of .* is missing"):
        store.dataset()
    progress = fill(store, workers=1)
    assert progress.done - progress.before == sum(
        store.sweep.numbers(store.sweep.region(task)).size for task in lost
    )
    xr.testing.assert_identical(store.dataset().load(), compute(quick()))


def test_a_damaged_chunk_is_named_and_is_computed_again_once_it_is_deleted(tmp_path, small_tasks):
    path = tmp_path / "a.zarr"
    stored(quick(), path, workers=1)
    chunk = path.joinpath("steps", "c", *map(str, quick().tasks[-1]))
    chunk.write_bytes(flip(chunk.read_bytes(), np.random.default_rng(1)))
    with pytest.raises(FileTrouble, match=rf"its chunk {chunk.relative_to(path)} cannot be read"):
        read_sweep(path)
    chunk.unlink()
    assert Store.resume(path).remaining() == [quick().tasks[-1]]
    xr.testing.assert_identical(
        stored(quick(), path, resume=True, workers=1).load(), compute(quick())
    )


def test_a_lost_coordinate_is_reported(tmp_path):
    fields = {"launch.spin": {"from": 10, "to": 200}, "friction.mu": {"from": 0, "to": 1}}
    sweep = Sweep(problem=report_problem(), draw=columns_of(fields), count=5, duration=0.05)
    fill(Store.create(tmp_path / "a.zarr", sweep), workers=1)
    shutil.rmtree(tmp_path / "a.zarr" / "mu")
    for read in (read_sweep, Store.resume):
        with pytest.raises(FileTrouble, match=r"a chunk of mu is missing.*overwrite=True"):
            read(tmp_path / "a.zarr")


def test_resuming_on_another_processor_says_that_cells_may_differ(tmp_path, monkeypatch):
    path = tmp_path / "a.zarr"
    monkeypatch.setattr(store_layout, "get_host_cpu_name", lambda: "abacus")
    Store.create(path, quick())
    monkeypatch.undo()
    with pytest.warns(UserWarning, match="begun on a processor abacus.* differ .* last digits"):
        stored(quick(), path, resume=True, workers=1)
    assert read_sweep(path).attrs["processor"] == "abacus"


def test_results_are_on_disk_before_their_status_says_so(tmp_path, small_tasks, monkeypatch):
    """What would be left if the power were cut after any step: files whose content was brought to
    store_lock.
    """
    store = Store.create(tmp_path / "a.zarr", quick())
    synced, task = set(), quick().tasks[0]
    chunks = {store.path.joinpath(name, "c", *map(str, task)) for name in ("is_done", *SWEPT)}
    status = store.path.joinpath("is_done", "c", *map(str, task))
    sync = store_lock._sync

    def recorded(path):
        if not status.exists():
            assert path != status
        synced.add(path)
        if path == status:
            others = chunks - {status}
            assert others | {folder for chunk in others for folder in chunk.parents[:3]} <= synced
        sync(path)

    monkeypatch.setattr(store_lock, "_sync", recorded)
    put = zarr.storage.LocalStore.set

    async def after_the_others(self, key, value):
        assert not key.startswith("status/c") or chunks - {status} <= synced
        await put(self, key, value)

    monkeypatch.setattr(zarr.storage.LocalStore, "set", after_the_others)
    numbers = store.sweep.numbers(store.sweep.region(task))
    store.write(
        task, {name: np.zeros(numbers.size, dtype=kind.dtype) for name, kind in SWEPT.items()}
    )
    assert chunks <= synced


def test_a_task_stays_pending_when_the_disk_is_full(tmp_path, small_tasks, monkeypatch):
    Store.create(tmp_path / "a.zarr", quick())
    store = Store.resume(tmp_path / "a.zarr")

    def full(path):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    with monkeypatch.context() as patch:
        patch.setattr(store_lock, "_sync", full)
        with pytest.raises(FileTrouble, match="No space left"):
            fill(store, workers=1)
    assert Store.resume(store.path).remaining() == quick().tasks


SLOW = """
import sys, time
sys.path.insert(0, {folder!r})
from sweep_cases import lively
from tippetop.sweeps import definition
from tippetop.sweeps import Store
from tippetop.sweeps import fill
definition.LEAST_CELLS_A_TASK, definition.TASKS = 4, 1000
store = Store.create({path!r}, lively("fly", 7, 3, 0.05, 1e-9))
print("filling", flush=True)
fill(store, workers=1, callback=lambda progress: progress.done and time.sleep(1e6))
"""


def test_a_sweep_that_is_being_filled_is_not_replaced(tmp_path, small_tasks):
    path = tmp_path / "a.zarr"
    script = SLOW.format(folder=str(Path(__file__).parent), path=str(path))
    other = lively("stop", 7, 3, 0.05, 1e-9)
    with started([sys.executable, "-c", script]) as process:
        assert process.stdout.readline() == "filling\n"
        wait_for_a_task(path, process)
        for overwrite in (True, False):
            with pytest.raises(
                FileTrouble, match="being filled by another process" if overwrite else "exists"
            ):
                stored(other, path, overwrite=overwrite, workers=1)
    assert [item.name for item in tmp_path.iterdir()] == ["a.zarr"]
    assert 0 < len(Store.resume(path, quick()).remaining()) < len(quick().tasks)
    stored(other, path, overwrite=True, workers=1)
    xr.testing.assert_identical(
        read_sweep(path, list(SWEPT), decode=False), compute(other)[list(SWEPT)]
    )


def test_a_writer_notices_that_its_store_was_replaced(tmp_path, small_tasks):
    path, other = tmp_path / "a.zarr", lively("stop", 7, 3, 0.05, 1e-9)

    def replace(progress):
        if progress.done and path.exists() and Store.resume(path).sweep == quick():
            shutil.rmtree(path)
            stored(other, path, workers=1)

    store = Store.create(path, quick())
    with pytest.raises(FileTrouble, match="replaced by another sweep"):
        fill(store, workers=1, callback=replace)
    xr.testing.assert_identical(
        read_sweep(path, list(SWEPT), decode=False), compute(other)[list(SWEPT)]
    )
    late = Store.resume(path)
    Store.create(path, quick(), overwrite=True)
    with pytest.raises(FileTrouble, match="replaced by another sweep"):
        fill(late, workers=1)
    shutil.rmtree(path)
    with pytest.raises(FileTrouble, match="No such file"):
        fill(late, workers=1)
    assert not path.exists()


def test_one_of_several_threads_creates_a_store(tmp_path, small_tasks):
    said, ready = [], threading.Barrier(4)

    def make():
        ready.wait()
        try:
            Store.create(tmp_path / "a.zarr", quick())
            said.append("made")
        except FileTrouble as error:
            said.append(str(error))

    threads = [threading.Thread(target=make) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert said.count("made") == 1
    assert [item.name for item in tmp_path.iterdir()] == ["a.zarr"]
    assert Store.resume(tmp_path / "a.zarr").remaining() == quick().tasks


KILLED = """
import os, signal, sys
sys.path.insert(0, {folder!r})
from sweep_cases import lively
from tippetop.sweeps import Store
from tippetop.sweeps import store
store.bring_to_disk = lambda paths: os.kill(os.getpid(), signal.SIGKILL)
Store.create({path!r}, lively("fly", 7, 3, 0.05, 1e-9))
"""


@posix_only
def test_what_a_killed_program_left_is_cleared_away_by_the_next(tmp_path):
    path = tmp_path / "a.zarr"
    script = KILLED.format(folder=str(Path(__file__).parent), path=str(path))
    assert subprocess.run([sys.executable, "-c", script], check=False).returncode == -signal.SIGKILL
    (left,) = tmp_path.iterdir()
    assert left.name.startswith(".a.zarr.")
    (tmp_path / ".a.zarr.theirs12").mkdir()
    with store_lock.locked(left):
        Store.create(path, quick())
        assert left.exists(), "it may be another's who is at work"
    Store.create(path, quick(), overwrite=True)
    assert sorted(item.name for item in tmp_path.iterdir()) == [".a.zarr.theirs12", "a.zarr"]


@pytest.mark.parametrize(
    "text", ["[]", "3", "null", "{", "", '{"attributes": []}', "[" * 9999, "\ud800"]
)
def test_invalid_metadata_are_refused(tmp_path, text):
    path = tmp_path / "a.zarr"
    path.mkdir()
    (path / "zarr.json").write_bytes(text.encode(errors="surrogatepass"))
    for read in (Store.resume, read_sweep):
        with pytest.raises(FileTrouble, match="is not a sweep"):
            read(path)
    with pytest.raises(FileTrouble, match="is no sweep"):
        Store.create(path, quick(), overwrite=True)


@pytest.mark.parametrize("text", among(["[]", "{", "", None], check=2))
def test_a_sweep_whose_own_metadata_are_lost_is_known_by_its_arrays_and_replaced(tmp_path, text):
    path = tmp_path / "a.zarr"
    Store.create(path, quick())
    if text is None:
        (path / "zarr.json").unlink()
    else:
        (path / "zarr.json").write_text(text)
    for read in (Store.resume, read_sweep):
        with pytest.raises(
            FileTrouble, match=r"is damaged: its zarr\.json .* start afresh with overwrite=True"
        ):
            read(path)
    Store.create(path, quick(), overwrite=True)
    assert len(Store.resume(path).remaining()) == len(quick().tasks)


@pytest.mark.parametrize("name", ["x" * 300, "x" * 250, "a\0b"])
def test_names_that_no_file_can_have_are_told_in_a_sentence(tmp_path, name):
    for use in (Store.create, Store.resume):
        with pytest.raises(FileTrouble, match="cannot be"):
            use(tmp_path / name, quick())
    with pytest.raises(FileTrouble, match="cannot be"):
        read_sweep(tmp_path / name)
    assert list(tmp_path.iterdir()) == []


def test_another_layout_is_refused(tmp_path, monkeypatch):
    Store.create(tmp_path / "a.zarr", quick())
    monkeypatch.setattr(store_layout, "FORMAT", "tippetop sweep 99")
    with pytest.raises(FileTrouble, match="laid out as 'tippetop sweep 5'"):
        read_sweep(tmp_path / "a.zarr")
