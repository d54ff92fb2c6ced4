"""Stores: what they hold, what they survive, and what they refuse."""

import errno
import json
import os
import shutil
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from sweep_cases import lively, same, stored

from campaigns import among, seeds
from children import posix_only, started
from tippetop.problem.presets import report_problem
from tippetop.support.errors import FileTrouble, InvalidInput
from tippetop.sweeps import (
    SWEPT,
    Product,
    Store,
    Sweep,
    compute,
    definition,
    fill,
    read_sweep,
    store_layout,
)
from tippetop.sweeps.axes import Spaced
from tippetop.sweeps.draws import columns_of

zarr = pytest.importorskip("zarr")


def quick(cells=24, **options):
    return lively("fly", cells // 4, 4, options.pop("duration", 0.1), 1e-9)


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """A store of the quick sweep in tasks of four cells, and the same in memory."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(definition, "LEAST_CELLS_A_TASK", 4)
        patch.setattr(definition, "TASKS", 1000)
        path = tmp_path_factory.mktemp("finished") / "a.zarr"
        stored(quick(), path, workers=1)
        return path, compute(quick())


@pytest.fixture
def path(finished, tmp_path, small_tasks):
    """A copy of the store of the quick sweep."""
    return shutil.copytree(finished[0], tmp_path / "a.zarr")


@pytest.mark.parametrize(
    "sweep",
    [
        quick(),
        Sweep(
            problem=report_problem(),
            draw=columns_of(
                {"launch.spin": {"from": 10, "to": 200}, "launch.tilt": {"from": 0, "to": 4}}
            ),
            count=9,
            seed=5,
            duration=0.1,
        ),
    ],
)
def test_a_store_is_the_sweep_in_memory(tmp_path, sweep):
    store = Store.create(tmp_path / "a.zarr", sweep)
    fill(store, workers=1)
    xr.testing.assert_identical(store.dataset().load(), compute(sweep))


def test_a_store_opens_with_plain_xarray(path):
    opened = xr.open_zarr(path)
    assert opened["final_tilt"].dims == ("spin", "mu")
    assert opened["mu"].values == pytest.approx(np.geomspace(0.2, 1, 4))
    assert set(SWEPT) < set(opened)
    assert json.loads(opened.attrs["problem"])["launch"]["tilt"] == 1.0
    assert opened["is_done"].dtype == bool
    assert opened.sel(spin=240.0).sizes == {"mu": 4}


def test_a_task_is_a_chunk_and_there_are_no_shards(path):
    for name in ("is_done", *SWEPT):
        array = zarr.open_array(path / name, mode="r")
        assert array.chunks == quick().chunk
        assert array.shards is None
        assert array.metadata.zarr_format == 3


def test_the_status_alone_decides_what_remains(path, finished):
    sweep = quick()
    store = Store.resume(path, sweep)
    assert store.remaining() == []
    status = zarr.open_array(path / "is_done", mode="r+")
    task = sweep.tasks[2]
    status[sweep.region(task)] = False
    assert Store.resume(path, sweep).remaining() == [task]
    theta = zarr.open_array(path / "final_tilt", mode="r+")
    theta[sweep.region(task)] = 99.0
    xr.testing.assert_identical(stored(sweep, path, resume=True, workers=1).load(), finished[1])


@pytest.mark.parametrize("damage", among([b"", b"\x00", b"garbage that is no chunk"], check=1))
def test_a_task_with_a_damaged_status_is_computed_again(path, finished, damage):
    (path / "is_done" / "c" / "0" / "0").write_bytes(damage)
    store = Store.resume(path, quick())
    assert store.remaining() == [(0, 0)]
    fill(store, workers=1)
    xr.testing.assert_identical(store.dataset().load(), finished[1])


@pytest.mark.parametrize(
    ("other", "named"),
    [
        (
            Sweep(quick().problem.replace({"friction.mu": 0.5}), quick().grid, 0.1, 1e-9),
            "problem.friction.mu",
        ),
        (Sweep(quick().problem, quick().grid, 0.2, 1e-9), "duration"),
        pytest.param(
            Sweep(quick().problem, quick().grid, 0.1, 1e-8), "tolerance", marks=pytest.mark.slow
        ),
        (lively("fly", 7, 4, 0.1, 1e-9), r"over\.launch\.spin\.count"),
        (Sweep(quick().problem, Product(quick().grid.axes[::-1]), 0.1, 1e-9), "over"),
        pytest.param(
            lively("stop", 6, 4, 0.1, 1e-9), "problem.contact.liftoff", marks=pytest.mark.slow
        ),
    ],
)
def test_another_sweep_is_refused_by_what_differs(tmp_path, other, named):
    Store.create(tmp_path / "a.zarr", quick())
    with pytest.raises(FileTrouble, match=rf"another sweep.*{named} is .* in it, and .* here"):
        Store.resume(tmp_path / "a.zarr", other)


def test_another_version_is_refused(tmp_path, monkeypatch):
    Store.create(tmp_path / "a.zarr", quick())
    monkeypatch.setattr(store_layout, "__version__", "99.0")
    with pytest.raises(FileTrouble, match=r"made by version .* of tippetop, and this is 99\.0"):
        Store.resume(tmp_path / "a.zarr", quick())


def test_a_store_of_another_version_with_fewer_endings_is_read(tmp_path, monkeypatch):
    fewer = store_layout.CONTENTS["outcome"]._replace(
        flags=store_layout.CONTENTS["outcome"].flags[:-1]
    )
    with monkeypatch.context() as patch:
        patch.setattr(store_layout, "CONTENTS", {**store_layout.CONTENTS, "outcome": fewer})
        patch.setattr(store_layout, "__version__", "0.1")
        Store.create(tmp_path / "a.zarr", quick())
    assert set(read_sweep(tmp_path / "a.zarr")) == set(store_layout.CONTENTS)


def test_an_existing_store_is_not_overwritten_unasked(path, tmp_path):
    with pytest.raises(FileTrouble, match="overwrite=True"):
        Store.create(tmp_path / "a.zarr", quick())
    assert Store.resume(tmp_path / "a.zarr").remaining() == []
    Store.create(tmp_path / "a.zarr", quick(), overwrite=True)
    assert len(Store.resume(tmp_path / "a.zarr").remaining()) == len(quick().tasks)
    assert [path.name for path in tmp_path.iterdir()] == ["a.zarr"]


def test_a_folder_that_is_not_a_store_is_refused(tmp_path):
    with pytest.raises(FileTrouble, match="there is no sweep in it"):
        Store.resume(tmp_path / "nothing.zarr")
    (tmp_path / "b.zarr").mkdir()
    (tmp_path / "b.zarr" / "zarr.json").write_text("{}")
    with pytest.raises(FileTrouble, match="not a sweep of this program"):
        Store.resume(tmp_path / "b.zarr")


@posix_only
@pytest.mark.parametrize("kind", ["folder", "file", "link", "other store"])
def test_files_that_are_not_sweeps_are_never_overwritten(tmp_path, kind):
    there = tmp_path / "a.zarr"
    keep = tmp_path / "mine"
    keep.mkdir()
    (keep / "thesis.txt").write_text("years of work")
    if kind == "folder":
        keep.rename(there)
    elif kind == "file":
        there.write_text("years of work")
    elif kind == "link":
        there.symlink_to(keep)
    else:
        zarr.create_group(there, attributes={"format": "somebody else's"}, zarr_format=3)
    before = sorted(str(path) for path in tmp_path.rglob("*"))
    with pytest.raises(FileTrouble, match="is no sweep"):
        Store.create(there, quick(), overwrite=True)
    assert sorted(str(path) for path in tmp_path.rglob("*")) == before


def test_an_empty_folder_and_a_sweep_of_another_version_may_be_overwritten(tmp_path):
    path = tmp_path / "a.zarr"
    path.mkdir()
    Store.create(path, quick(), overwrite=True)
    zarr.open_group(path).attrs["format"] = "tippetop sweep 99"
    assert len(Store.create(path, quick(), overwrite=True).remaining()) == len(quick().tasks)


def test_a_store_is_filled_by_one_process_at_a_time(tmp_path, small_tasks):
    store = Store.create(tmp_path / "a.zarr", quick())
    with store.held(), pytest.raises(FileTrouble, match="is being filled by another process"):
        fill(Store.resume(store.path), workers=1)
    left = store.path / "final_tilt" / "c" / "0" / "0.1234.partial"
    left.parent.mkdir(parents=True)
    left.write_text("half a chunk")
    fill(Store.resume(store.path), workers=1)
    assert not left.exists()
    assert not store.remaining()


def test_a_damaged_chunk_is_reported(path):
    chunk = next(chunk for chunk in (path / "flights" / "c").rglob("*") if chunk.is_file())
    chunk.write_bytes(chunk.read_bytes()[:5])
    store = Store.resume(path)
    assert store.load(["outcome"])["outcome"].shape == quick().grid.shape
    with pytest.raises(FileTrouble, match=r"a\.zarr is damaged"):
        store.load(["flights"])


def test_nothing_is_written_where_nobody_can_compute(path, tmp_path):
    for options in ({"workers": 0}, {"scheduler": "nonsense://"}):
        with pytest.raises(InvalidInput):
            stored(quick(), tmp_path / "a.zarr", overwrite=True, **options)
        with pytest.raises(InvalidInput):
            stored(quick(), tmp_path / "b.zarr", **options)
    assert not Store.resume(tmp_path / "a.zarr").remaining()
    assert not (tmp_path / "b.zarr").exists()


def test_a_full_disk_leaves_a_store_that_resumes(tmp_path, small_tasks, monkeypatch, finished):
    sweep = quick()
    path = tmp_path / "a.zarr"
    original = zarr.storage.LocalStore.set
    written = []

    async def set_until_full(self, key, value):
        written.append(key)
        if len(written) > 40:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        await original(self, key, value)

    store = Store.create(path, sweep)
    with monkeypatch.context() as patch:
        patch.setattr(zarr.storage.LocalStore, "set", set_until_full)
        with pytest.raises(
            FileTrouble, match=r"a\.zarr cannot be written: No space left on device"
        ):
            fill(store, workers=1)
    left = len(Store.resume(path).remaining())
    assert 0 < left < len(sweep.tasks)
    xr.testing.assert_identical(stored(sweep, path, resume=True, workers=1).load(), finished[1])


@pytest.mark.skipif(
    not Path("/sys/kernel").is_dir(), reason="a folder in which not even root may write"
)
def test_a_folder_in_which_nothing_can_be_written_is_said_to_be(tmp_path):
    with pytest.raises(FileTrouble, match="cannot be written"):
        Store.create("/sys/kernel/a.zarr", quick())
    with pytest.raises(FileTrouble, match="cannot be written"):
        Store.create(tmp_path / "missing" / "a.zarr", quick())


FILL = """
import sys
sys.path.insert(0, {folder!r})
from sweep_cases import lively
from tippetop.sweeps import definition
definition.LEAST_CELLS_A_TASK, definition.TASKS = 4, 1000
from tippetop.sweeps import Store
from tippetop.sweeps import fill
from pathlib import Path
if __name__ == "__main__":
    path, sweep = Path({path!r}), lively("fly", 20, 4, 0.1, 1e-9)
    store = Store.create(path, sweep)
    print("filling", flush=True)
    fill(store, workers=1)
"""


@pytest.mark.parametrize("seed", seeds(check=0, sample=2, claim=20))
def test_a_sweep_killed_at_random_moments_loses_nothing(tmp_path, small_tasks, seed):
    path = tmp_path / "a.zarr"
    script = tmp_path / "fill.py"
    script.write_text(FILL.format(folder=str(Path(__file__).parent), path=str(path)))
    random = np.random.default_rng(seed)
    with started([sys.executable, script]) as process:
        assert process.stdout.readline() == "filling\n"
        time.sleep(random.uniform(0.0, 0.4))
    fill(Store.resume(path), workers=1)
    found, whole = read_sweep(path, decode=False), compute(quick(80))
    xr.testing.assert_identical(found, whole)
    assert not list(path.rglob("*.partial"))
    assert same(
        {name: found[name].values for name in SWEPT}, {name: whole[name].values for name in SWEPT}
    )


def test_progress_is_reported_and_counts_finished_tasks(tmp_path, small_tasks):
    sweep = quick()
    seen = []
    stored(sweep, tmp_path / "a.zarr", workers=1, callback=seen.append)
    assert [progress.done for progress in seen] == list(range(0, 25, 4))
    assert seen[-1].rate > 0
    again = []
    stored(sweep, tmp_path / "a.zarr", resume=True, workers=1, callback=again.append)
    assert [(progress.before, progress.done) for progress in again] == [(24, 24)]
    assert again[0].rate == 0.0


def test_a_small_axis_is_one_task():
    assert Sweep(report_problem(), Product((Spaced("launch.spin", 1, 2, 100),))).chunk == (100,)
