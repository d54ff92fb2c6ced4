"""The same sweep by one process, by several, and by a Dask cluster some of whose workers are
killed.
"""

import json
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import psutil
import pytest
from sweep_cases import lively, same, stored

from campaigns import among
from children import LONGEST, ended, posix_only, started
from tippetop.support.errors import InvalidInput, Unavailable
from tippetop.sweeps import SWEPT, Store, compute, fill, read_sweep, schedulers


def arrays(dataset):
    return {name: dataset[name].values for name in SWEPT}


def quick():
    return lively("fly", 6, 4, 0.1, 1e-9)


def test_several_processes_find_what_one_does(small_tasks):
    assert same(arrays(compute(quick(), workers=1)), arrays(compute(quick(), workers=2)))


def test_a_number_of_workers_that_cannot_be_is_refused():
    with pytest.raises(InvalidInput, match="workers"):
        compute(quick(), workers=0)


def test_workers_of_another_version_are_refused():
    with pytest.raises(Unavailable, match=r"the sweep is run by 99\.0"):
        schedulers.compute_region("{}", "99.0", (), (slice(0, 1),))


@posix_only
@pytest.mark.slow
@pytest.mark.filterwarnings("ignore")
def test_a_dask_cluster_finds_the_same_though_a_worker_is_killed(small_tasks, monkeypatch):
    distributed = pytest.importorskip("distributed")
    connected, connect = [], schedulers._cluster
    monkeypatch.setattr(schedulers, "_cluster", lambda at: connected.append(at) or connect(at))
    sweep = lively("fly", 6, 4, 0.3, 1e-9)
    alone = arrays(compute(sweep, workers=1))
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None, silence_logs=50
    ) as cluster:
        address = cluster.scheduler_address
        victims = [worker.pid for worker in cluster.workers.values()]
        done = threading.Event()

        def kill() -> None:
            while not done.is_set():
                if began.is_set():
                    os.kill(victims[0], signal.SIGKILL)
                    return
                time.sleep(0.01)

        began = threading.Event()
        killer = threading.Thread(target=kill)
        killer.start()
        try:
            together = compute(sweep, scheduler=address, callback=lambda _: began.set())
        finally:
            done.set()
            killer.join()
        assert not psutil.pid_exists(victims[0]) or psutil.Process(victims[0]).status() == "zombie"
    assert connected == [address]
    assert same(alone, arrays(together))
    assert np.all(together["is_done"].values)


@pytest.mark.filterwarnings("ignore")
def test_a_sweep_into_a_store_connects_to_the_cluster_once(monkeypatch, tmp_path):
    distributed = pytest.importorskip("distributed")
    made, client = [], distributed.Client
    monkeypatch.setattr(
        distributed, "Client", lambda *at, **how: made.append(at) or client(*at, **how)
    )
    with distributed.LocalCluster(
        n_workers=1,
        threads_per_worker=1,
        processes=False,
        protocol="tcp",
        dashboard_address=None,
        silence_logs=50,
    ) as cluster:
        made.clear()
        kept = stored(quick(), tmp_path / "a.zarr", scheduler=cluster.scheduler_address)
        assert made == [(cluster.scheduler_address,)]
        assert same(arrays(kept), arrays(compute(quick(), workers=1)))


@pytest.mark.filterwarnings("ignore")
def test_a_scheduler_that_is_not_there_is_refused(monkeypatch):
    monkeypatch.setattr(schedulers, "PATIENCE", 1.0)
    pytest.importorskip("distributed")
    with pytest.raises(InvalidInput, match="scheduler"):
        compute(quick(), scheduler="tcp://127.0.0.1:1")
    with pytest.raises(InvalidInput, match="scheduler"):
        compute(quick(), scheduler="nonsense://")


def test_a_missing_dask_is_reported(monkeypatch):
    monkeypatch.setattr(schedulers, "find_spec", lambda name: None)
    with pytest.raises(Unavailable, match=r"pip install '.*\[sweep\]'"):
        compute(quick(), scheduler="tcp://127.0.0.1:1")


@pytest.mark.filterwarnings("ignore")
def test_a_cluster_without_workers_is_refused_and_a_lost_one_is_reported(small_tasks):
    distributed = pytest.importorskip("distributed")
    quiet = {"dashboard_address": None, "silence_logs": 50}
    with (
        distributed.LocalCluster(n_workers=0, **quiet) as cluster,
        pytest.raises(InvalidInput, match="workers"),
    ):
        compute(quick(), scheduler=cluster.scheduler_address)
    cluster = distributed.LocalCluster(n_workers=1, threads_per_worker=1, **quiet)
    found = schedulers.results(quick(), quick().tasks, scheduler=cluster.scheduler_address)
    next(found)
    cluster.close()
    with pytest.raises(Unavailable, match="was lost"):
        list(found)


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize(
    ("raised_in", "expected"),
    among([("distributed.cfexecutor", Unavailable), ("tippetop.sweeps", ValueError)], check=1),
)
def test_an_error_inside_dask_is_reported_as_a_lost_cluster(monkeypatch, raised_in, expected):
    """Dask takes a result whose worker is lost for an error, and unpacks it as one."""
    distributed = pytest.importorskip("distributed")
    names = {"__name__": raised_in}
    exec("def stumble(*_):\n    raise ValueError('too many values to unpack')", names)
    monkeypatch.setattr(schedulers, "_first_done", names["stumble"])
    with (
        distributed.LocalCluster(
            n_workers=1,
            threads_per_worker=1,
            processes=False,
            protocol="tcp",
            dashboard_address=None,
            silence_logs=50,
        ) as cluster,
        pytest.raises(expected),
    ):
        list(schedulers.results(quick(), quick().tasks, scheduler=cluster.scheduler_address))


LOST = """
import sys, time
sys.path[:0] = {paths!r}
from sweep_cases import lively, stored
from tippetop.support.errors import Unavailable
from tippetop.sweeps import definition
from tippetop.sweeps import schedulers
definition.LEAST_CELLS_A_TASK, definition.TASKS, schedulers.LONELY = 4, 1000, 2.0
import os, signal
def kill(progress):
    if 8 <= progress.done < 12:
        os.kill({victim}, signal.SIGKILL)
        time.sleep({pause})
try:
    stored(lively("fly", 6, 4, 0.3, 1e-9), {out!r}, scheduler={address!r}, callback=kill)
except Unavailable as error:
    print(error)
"""


@pytest.fixture
def cluster(tmp_path):
    """A scheduler and a worker as they are started from a shell, and the scheduler's address."""
    file = tmp_path / "scheduler.json"

    def start(*arguments):
        command = [sys.executable, "-m", "dask", *arguments, "--scheduler-file", file]
        quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "cwd": tmp_path}
        return started([*command, "--no-dashboard"], **quiet)

    with start("scheduler", "--host", "127.0.0.1", "--port", "0") as scheduler:
        while not (file.exists() and file.read_text().endswith("}")):
            assert scheduler.poll() is None
            time.sleep(0.05)
        with start("worker", "--no-nanny", "--nthreads", "1") as worker:
            yield scheduler, worker, json.loads(file.read_text())["address"]


@posix_only
@pytest.mark.slow
@pytest.mark.parametrize(
    ("lost", "pause", "sentence"),
    [
        ("scheduler", 1.0, "was lost (CancelledError)"),
        ("worker", 0.0, "has had no workers for 2 s"),
    ],
)
def test_a_lost_cluster_is_reported_and_finished_tasks_are_kept(
    cluster, small_tasks, tmp_path, lost, pause, sentence
):
    """With a pause, more tasks are handed out to what is known to be gone."""
    distributed = pytest.importorskip("distributed")
    scheduler, worker, address = cluster
    with distributed.Client(address, set_as_default=False) as client:
        client.wait_for_workers(1, timeout=LONGEST)
    paths = [str(Path(__file__).parent), str(Path(__file__).parents[1])]
    out, victim = tmp_path / "a.zarr", scheduler.pid if lost == "scheduler" else worker.pid
    script = LOST.format(paths=paths, victim=victim, pause=pause, out=str(out), address=address)
    with started([sys.executable, "-c", script]) as process:
        printed, said, code = ended(process)
    told = f"the cluster at {address} {sentence}; what is done is kept, and resume=True goes on\n"
    assert (printed, code) == (told, 0), said
    warning = f"the cluster at {address} has no workers; the sweep waits for some, 2 s"
    assert set(said.splitlines()) == ({warning} if lost == "worker" else set())
    progress = fill(Store.resume(out), workers=1)
    assert 8 <= progress.before < progress.done == 24
    assert same(
        arrays(read_sweep(out, decode=False)), arrays(compute(lively("fly", 6, 4, 0.3, 1e-9)))
    )
