"""Work in processes beside this one: what they do, what they survive, and what they leave alone."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import psutil
import pytest

from campaigns import among
from children import ended, posix_only, started
from tippetop.support.errors import InvalidInput, Unavailable
from tippetop.support.processes import RESTARTS, Job, Worker, processors, shared


def jobs(*calls: tuple[Any, ...]) -> Callable[[], Job | None]:
    waiting = (Job(k, call, arguments) for k, (call, *arguments) in enumerate(calls))
    return lambda: next(waiting, None)


def elsewhere(call: Callable[..., Any], *arguments: Any) -> Any:
    """What a call returns in another process."""
    [(_, result)] = shared(jobs((call, *arguments)), 2)
    return result


class Odd(Exception):
    """An error that can be sent, but not be read."""

    def __init__(self, one: int, other: int) -> None:
        super().__init__("odd")


def be_odd() -> None:
    raise Odd(1, 2)


def refuse() -> None:
    raise InvalidInput("spin", -1, "more")


def die_once(path: str) -> str:
    """End the first process that does this."""
    if not Path(path).exists():
        Path(path).touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return "done"


@pytest.mark.parametrize("count", [1, 2, 3])
def test_results_come_with_the_names_of_their_jobs(count: int) -> None:
    found = dict(shared(jobs(*((pow, 2, k) for k in range(7))), count))
    assert found == {k: 2**k for k in range(7)}


def test_what_is_larger_than_a_pipe_goes_through() -> None:
    block = bytes(10**7)
    found = dict(shared(jobs(*((bytes, block) for _ in range(5))), 2))
    assert set(found.values()) == {block}


def test_a_job_may_wait_for_the_result_of_another() -> None:
    waiting, found = [Job("second", abs, (-2,)), Job("first", abs, (-1,))], []

    def next_job() -> Job | None:
        return waiting.pop() if len(waiting) == 2 or (waiting and found) else None

    for name, result in shared(next_job, 2):
        found.append((name, result))
    assert found == [("first", 1), ("second", 2)]


@posix_only
def test_a_job_whose_process_is_killed_is_done_again(tmp_path: Path) -> None:
    found = dict(shared(jobs((abs, -1), (die_once, str(tmp_path / "tried")), (abs, -2)), 2))
    assert found == {0: 1, 1: "done", 2: 2}


def test_a_job_that_kills_every_process_is_given_up() -> None:
    with pytest.raises(
        Unavailable, match=f"killed {RESTARTS + 1} times during 1, perhaps for want of memory"
    ):
        list(shared(jobs((abs, -1), (os._exit, 1)), 2))


@pytest.mark.parametrize(
    ("call", "kind", "match"),
    [
        (refuse, InvalidInput, "spin: -1 is not more"),
        (be_odd, RuntimeError, "Odd"),
        (divmod, TypeError, "divmod"),
    ],
)
def test_what_a_job_raises_is_raised_here(
    call: Callable[[], Any], kind: type[Exception], match: str
) -> None:
    with pytest.raises(kind, match=match):
        elsewhere(call)


def test_an_error_that_is_none_of_ours_says_where_it_was_raised() -> None:
    with pytest.raises(TypeError) as raised:
        elsewhere(sorted, 3)
    assert any("in _work" in note for note in raised.value.__notes__)


@posix_only
def test_a_process_goes_on_after_an_error_and_does_not_hear_ctrl_c() -> None:
    worker = Worker()
    try:
        worker.give(sorted, 3)
        assert isinstance(worker.take().error, TypeError)
        pid = worker._process.pid
        assert pid is not None
        os.kill(pid, signal.SIGINT)
        worker.give(os.getpid)
        assert worker.take() == pid
    finally:
        worker.close()
    assert not worker._process.is_alive()


def test_processes_have_one_thread_each() -> None:
    assert elsewhere(os.getenv, "OMP_NUM_THREADS") == "1"
    assert elsewhere(signal.getsignal, signal.SIGINT) == signal.SIG_IGN


def test_processes_are_gone_when_they_are_no_longer_asked_for() -> None:
    before = set(psutil.Process().children())
    results = shared(jobs(*((abs, -k) for k in range(9))), 2)
    next(results)
    started = set(psutil.Process().children()) - before
    started = {child for child in started if "resource_tracker" not in " ".join(child.cmdline())}
    assert len(started) == 2
    results.close()
    assert psutil.wait_procs(started, timeout=10)[1] == []


INTERRUPTED = """
import time
from tippetop.support.processes import Job, shared
waiting = (Job(k, time.sleep, (0.2,)) for k in range(10**6))
print("begun", flush=True)
try:
    for _ in shared(lambda: next(waiting, None), 2):
        pass
except KeyboardInterrupt:
    print("interrupted", flush=True)
"""


@posix_only
@pytest.mark.parametrize("wait", among([0.01, 0.1, 0.2, 1.0], check=2))
def test_ctrl_c_ends_all_of_it_without_a_traceback(wait: float) -> None:
    """Whenever it is pressed: processes that start just then hear it no more than others."""
    with started([sys.executable, "-c", INTERRUPTED]) as process:
        assert process.stdout.readline() == "begun\n"
        time.sleep(wait)
        os.killpg(process.pid, signal.SIGINT)
        assert ended(process)[:2] == ("interrupted\n", "")


BLOCKED = """
import signal
from tippetop.support.processes import Job, shared
waiting = [Job(k, signal.pthread_sigmask, (signal.SIG_BLOCK, ())) for k in range(2)]
for _, blocked in shared(lambda: waiting.pop() if waiting else None, 2):
    print(signal.SIGINT in blocked)
"""


@pytest.mark.skipif(
    not hasattr(signal, "pthread_sigmask"), reason="this system cannot block signals"
)
def test_processes_cannot_hear_ctrl_c_from_their_first_moment() -> None:
    """The very first of them neither, which Python starts together with a process of its own."""
    done = subprocess.run(
        [sys.executable, "-c", BLOCKED], capture_output=True, text=True, check=True
    )
    assert (done.stdout, done.stderr) == ("True\nTrue\n", "")


def test_no_more_workers_than_the_container_is_given_processors(monkeypatch):
    """Where a group of processes has the time of one processor, there is one worker."""
    monkeypatch.setattr("loky.backend.context._cpu_count_cgroup", lambda count: 1)
    assert processors() == 1
