"""Files meet links, devices, other writers, full disks and signals; what is there and what is
left.
"""

import contextlib
import csv
import multiprocessing
import os
import signal
import stat
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest

import tippetop as tt
from campaigns import seeds
from children import ended, posix_only, started
from misused import misused
from tippetop.export import bundle
from tippetop.export.glb import write_glb
from tippetop.export.html import write_html
from tippetop.export.movie import write_movie
from tippetop.export.tables import write_csv, write_parquet
from tippetop.support import files
from tippetop.support.files import MARK, put_in_place, written_beside


@pytest.fixture(scope="module")
def run():
    return tt.simulate(tt.presets.report_problem(), 0.2, samples=101)


@pytest.fixture(scope="module")
def long_run(tmp_path_factory):
    """A run whose file takes more than 128 KiB."""
    run = tt.simulate(tt.presets.report_problem(), 8.0)
    path = tt.write_run(run, tmp_path_factory.mktemp("long") / "run.nc")
    assert path.stat().st_size > 2**17
    return run


def write(path, content="new", overwrite=False):
    with written_beside(path, overwrite) as beside:
        beside.write_text(content)


def small_movie(run, path, overwrite=False):
    return write_movie(run, path, overwrite, frame_rate=5.0, pixels=(32, 32))


WRITERS = [
    (tt.write_run, "run.nc"),
    (write_csv, "run.csv"),
    (write_parquet, "run.parquet"),
    (write_glb, "run.glb"),
    (small_movie, "run.gif"),
]


def is_root():
    return hasattr(os, "geteuid") and os.geteuid() == 0


def permissions(path):
    return stat.S_IMODE(path.stat().st_mode)


# --- links, permissions, what is no file
# --------------------------------------------------------------------


@pytest.mark.parametrize(
    ("writer", "name"), WRITERS, ids=lambda value: getattr(value, "__name__", "")
)
class TestEveryWriter:
    @posix_only
    def test_follows_links(self, run, tmp_path, writer, name):
        folder = tmp_path / "folder"
        folder.mkdir()
        (folder / name).write_text("old")
        (tmp_path / name).symlink_to(folder / name)
        with pytest.raises(tt.FileTrouble, match="exists"):
            writer(run, tmp_path / name)
        assert (folder / name).read_text() == "old"
        writer(run, tmp_path / name, overwrite=True)
        assert (tmp_path / name).is_symlink()
        assert (folder / name).stat().st_size > 100
        assert [path.name for path in folder.iterdir()] == [name]

    @posix_only
    def test_leaves_a_link_to_nothing_alone_unless_asked(self, run, tmp_path, writer, name):
        (tmp_path / name).symlink_to(tmp_path / f"far-{name}")
        with pytest.raises(tt.FileTrouble, match="exists"):
            writer(run, tmp_path / name)
        assert [path.name for path in tmp_path.iterdir()] == [name]
        writer(run, tmp_path / name, overwrite=True)
        assert (tmp_path / name).is_symlink()
        assert (tmp_path / f"far-{name}").stat().st_size > 100

    @posix_only
    def test_keeps_permissions(self, run, tmp_path, writer, name):
        for mode in (0o640, 0o444):
            (tmp_path / name).write_text("old")
            (tmp_path / name).chmod(mode)
            writer(run, tmp_path / name, overwrite=True)
            assert permissions(tmp_path / name) == mode
            (tmp_path / name).unlink()

    @posix_only
    @pytest.mark.parametrize("overwrite", [False, True])
    def test_leaves_alone_what_is_no_regular_file(self, run, tmp_path, writer, name, overwrite):
        os.mkfifo(tmp_path / name)
        with pytest.raises(tt.FileTrouble, match="device, pipe or socket"):
            writer(run, tmp_path / name, overwrite=overwrite)
        assert stat.S_ISFIFO((tmp_path / name).lstat().st_mode)
        (tmp_path / name).unlink()
        (tmp_path / name).symlink_to(os.devnull)
        with pytest.raises(tt.FileTrouble, match="device, pipe or socket"):
            writer(run, tmp_path / name, overwrite=overwrite)
        assert stat.S_ISCHR(Path(os.devnull).stat().st_mode)

    def test_names_what_python_is_given(self, run, tmp_path, writer, name):
        """In Python one passes `overwrite`; only the command line has options."""
        (tmp_path / name).write_text("old")
        with pytest.raises(tt.FileTrouble, match="overwrite=True") as trouble:
            writer(run, tmp_path / name)
        assert "--" not in str(trouble.value).replace(str(tmp_path), "")

    @pytest.mark.parametrize("wrong", ["a\0b", "n" * 300, "no/such/folder/a"])
    def test_refuses_names_that_cannot_be(self, run, tmp_path, writer, name, wrong):
        with pytest.raises(tt.FileTrouble, match="cannot be written") as trouble:
            writer(run, tmp_path / f"{wrong}{Path(name).suffix}")
        assert str(trouble.value).isprintable()
        assert list(tmp_path.iterdir()) == []


@posix_only
def test_a_link_that_leads_in_a_circle_is_refused(tmp_path):
    (tmp_path / "a").symlink_to(tmp_path / "b")
    (tmp_path / "b").symlink_to(tmp_path / "a")
    for overwrite in (False, True):
        with pytest.raises(tt.FileTrouble):
            write(tmp_path / "a", overwrite=overwrite)
    assert (tmp_path / "a").is_symlink()


def test_what_is_not_yet_whole_is_nobody_elses(tmp_path):
    (tmp_path / "mine").write_text("old")
    (tmp_path / "mine").chmod(0o600)
    with written_beside(tmp_path / "mine", overwrite=True) as beside:
        assert permissions(beside) == 0o600


@posix_only
@pytest.mark.skipif(not is_root(), reason="only root gives files away")
def test_a_file_keeps_its_owner(tmp_path):
    (tmp_path / "theirs").write_text("old")
    os.chown(tmp_path / "theirs", 12345, 12345)
    write(tmp_path / "theirs", overwrite=True)
    status = (tmp_path / "theirs").stat()
    assert (status.st_uid, status.st_gid) == (12345, 12345)


# --- several writers
# ----------------------------------------------------------------------------------------


def compete(path, number, barrier, results):
    barrier.wait()
    try:
        write(path, str(number) * 10_000)
        results.put(number)
    except tt.FileTrouble as trouble:
        results.put(str(trouble))


@pytest.mark.parametrize("linked", [True, False], ids=["hard links", "no hard links"])
@pytest.mark.parametrize("attempt", seeds(check=1, sample=5, claim=100))
def test_of_writers_of_one_new_name_one_succeeds(tmp_path, monkeypatch, linked, attempt):
    if not linked:

        def no_link(*_):
            raise PermissionError(1, "Operation not permitted")

        monkeypatch.setattr(os, "link", no_link)
    context, writers = multiprocessing.get_context("fork"), 8
    path = tmp_path / f"{attempt}.txt"
    barrier, results = context.Barrier(writers), context.SimpleQueue()
    processes = [
        context.Process(target=compete, args=(path, n, barrier, results)) for n in range(writers)
    ]
    for process in processes:
        process.start()
    found = [results.get() for _ in processes]
    for process in processes:
        process.join()
    winners = [number for number in found if isinstance(number, int)]
    assert len(winners) == 1
    assert path.read_text() == str(winners[0]) * 10_000
    expected = f"{path} exists; it is overwritten only with overwrite=True"
    assert {text for text in found if isinstance(text, str)} == {expected}
    assert list(tmp_path.iterdir()) == [path]


def test_writers_of_many_names_do_not_disturb_each_other(tmp_path):
    """Each clears away what others left, and none of it is what others are writing."""
    failed = []

    def work(number):
        try:
            for k in range(10):
                write(tmp_path / f"{number}-{k}.txt", str(number))
        except tt.FileTrouble as trouble:
            failed.append(trouble)

    threads = [threading.Thread(target=work, args=(number,)) for number in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not failed
    assert len(list(tmp_path.iterdir())) == 80


# --- ended in the middle
# ------------------------------------------------------------------------------------

SLOW = """
import signal, sys, time
from tippetop.support.interrupts import ENDINGS
from tippetop.support.files import written_beside
for number in ENDINGS:
    signal.signal(number, signal.default_int_handler)
try:
    while True:
        with written_beside(sys.argv[1], overwrite=True) as beside:
            with beside.open("w") as file:
                for k in range(20):
                    file.write(str(k) * 10_000)
        print("round", flush=True)
except KeyboardInterrupt:
    sys.exit(130)
"""


@posix_only
@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM", "SIGHUP", "SIGKILL"])
@pytest.mark.parametrize("attempt", seeds(check=1, sample=5, claim=70))
def test_at_whatever_moment_a_writer_is_ended_the_file_is_whole(tmp_path, name, attempt):
    number = getattr(signal, name)
    whole = "".join(str(k) * 10_000 for k in range(20))
    path = tmp_path / "a.txt"
    with started([sys.executable, "-c", SLOW, str(path)]) as process:
        process.stdout.readline()
        time.sleep(np.random.default_rng(attempt).uniform(0.0, 0.1))
        process.send_signal(number)
        _, *told = ended(process)
    assert told == ["", -9 if number == signal.SIGKILL else 130]
    assert path.read_text() == whole
    if number != signal.SIGKILL:
        assert list(tmp_path.iterdir()) == [path]
    write(path, overwrite=True)
    assert list(tmp_path.iterdir()) == [path], (
        "what a killed writer left is cleared away by the next"
    )


@posix_only
def test_what_a_killed_writer_left_is_cleared_away_and_nothing_else(tmp_path):
    (tmp_path / f"{MARK}0123456789ab.nc").write_text("half a fi")
    (tmp_path / ".tippetop").write_text("mine")
    (tmp_path / f"{MARK}folder").mkdir()
    (tmp_path / f"{MARK}link").symlink_to(tmp_path / ".tippetop")
    with written_beside(tmp_path / "being-written") as beside:
        write(tmp_path / "a")
        assert beside.exists(), "what somebody still writes stays"
    names = {path.name for path in tmp_path.iterdir()}
    assert names == {".tippetop", f"{MARK}folder", f"{MARK}link", "a", "being-written"}


def test_where_files_cannot_be_held_they_are_written_all_the_same(tmp_path, monkeypatch):
    (tmp_path / f"{MARK}0123456789ab.nc").write_text("perhaps somebody's")

    def unknown(*_):
        raise OSError(95, "Operation not supported")

    monkeypatch.setattr(files.fcntl, "flock", unknown)
    write(tmp_path / "a")
    assert {path.name for path in tmp_path.iterdir()} == {f"{MARK}0123456789ab.nc", "a"}


def test_a_finished_file_moves_to_a_new_place_once(tmp_path):
    (tmp_path / "stage").mkdir()
    for content in "ab":
        (tmp_path / "stage" / content).write_text(content)
    put_in_place(tmp_path / "stage" / "a", tmp_path / "place", overwrite=False)
    with pytest.raises(tt.FileTrouble, match="exists"):
        put_in_place(tmp_path / "stage" / "b", tmp_path / "place", overwrite=False)
    assert (tmp_path / "place").read_text() == "a"
    assert [path.name for path in (tmp_path / "stage").iterdir()] == ["b"]


# --- full disks
# ---------------------------------------------------------------------------------------------


@contextlib.contextmanager
def limited(size):
    """No file grows past this many bytes, as on a disk that is full."""
    import resource  # noqa: PLC0415 - Windows has none

    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    handler = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
        signal.signal(signal.SIGXFSZ, handler)


@posix_only
@pytest.mark.parametrize("size", [0, 512])
def test_a_full_disk_ends_in_a_sentence_and_leaves_nothing(run, tmp_path, monkeypatch, size):
    monkeypatch.setattr(bundle, "built", lambda name: "/*!\nnotices\n*/\nplayer")
    for writer, name in [*WRITERS, (write_html, "run.html")]:
        sentence = r"cannot be written: .*File too large"
        with limited(size), pytest.raises(tt.FileTrouble, match=sentence):
            writer(run, tmp_path / name)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(not is_root(), reason="only root mounts disks")
@pytest.mark.parametrize("size", ["16k", "64k", "128k"])
def test_a_run_on_a_disk_too_small_is_refused(long_run, tmp_path, size):
    mount = ["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", str(tmp_path)]
    if subprocess.run(mount, capture_output=True, check=False).returncode:
        pytest.skip("no disk can be mounted here")
    try:
        with pytest.raises(tt.FileTrouble, match="cannot be written: No space left on device"):
            tt.write_run(long_run, tmp_path / "a.nc")
        left = list(tmp_path.iterdir())
    finally:
        subprocess.run(["umount", "-l", str(tmp_path)], check=True)
    assert left == []


@posix_only
def test_a_file_larger_than_the_disk_leaves_the_old_one(run, tmp_path):
    path = write_csv(run, tmp_path / "run.csv")
    before = path.read_bytes()
    with limited(1000), pytest.raises(tt.FileTrouble, match="File too large"):
        write_csv(run, path, overwrite=True)
    assert path.read_bytes() == before
    assert list(tmp_path.iterdir()) == [path]
    with path.open(newline="") as file:
        assert len(list(csv.reader(file))) == 102


# --- at the command line
# ------------------------------------------------------------------------------------


def test_the_command_line_names_its_option(tmp_path):
    (tmp_path / "a.csv").write_text("old")
    told = misused(tmp_path, "simulate", "--csv", "a.csv")
    assert told == "tippetop: a.csv exists; it is overwritten only with --force\n"
