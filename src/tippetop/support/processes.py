"""Worker processes: `shared` runs jobs in several processes and yields their results.

Workers are fresh interpreters: this way of starting is the same on every system and safe beside
threads. They import this package but never the caller's script, have one thread each, ignore
Ctrl-C, which the parent handles, and end with the parent even if it is killed. A worker that is
killed is replaced.
"""

import multiprocessing
import os
import pickle
import signal
import sys
import threading
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from multiprocessing import connection, resource_tracker
from typing import Any, NamedTuple

from tippetop.support.errors import TippetopError, Unavailable
from tippetop.support.interrupts import deferred

RESTARTS = 3
"""Number of times that a job whose process was killed is repeated."""
THREADS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")

_SPAWN = multiprocessing.get_context("spawn")
_starting = threading.Lock()


def processors() -> int:
    """Return how many processors this process may use, limits of its container included."""
    from loky import cpu_count  # noqa: PLC0415 - slow to import

    return int(cpu_count())


class Job(NamedTuple):
    """Call to be made in another process: importable, with arguments that can be pickled."""

    name: Any
    call: Callable[..., Any]
    arguments: tuple[Any, ...]


class _Failed(NamedTuple):
    """Exception that a job raised, sent back to the parent."""

    error: Exception


class Worker:
    """Process that does one job at a time."""

    def __init__(self) -> None:
        self.end, theirs = _SPAWN.Pipe()
        self._process = _SPAWN.Process(
            target=_work, args=(theirs,), daemon=True, name="tippetop worker"
        )
        try:
            with _apart():
                self._process.start()
        except BaseException:
            # A delayed Ctrl-C is raised here, before the caller could close this process.
            if self._process.pid is not None:
                self.close()
            raise
        theirs.close()

    def give(self, job: Callable[..., Any], *arguments: Any) -> None:
        """Send a job to the process; if the process has ended, `take` raises."""
        with suppress(OSError):
            self.end.send((job, arguments))

    def take(self) -> Any:
        """Return the result of the job; raise `EOFError` if the process ended."""
        try:
            return self.end.recv()
        except OSError:
            raise EOFError from None

    def close(self) -> None:
        """Kill the process."""
        self._process.kill()
        self._process.join()
        self.end.close()


def shared(next_job: Callable[[], Job | None], count: int) -> Iterator[tuple[Any, Any]]:
    """Run jobs in `count` processes, and yield the name and the result of each as it ends.

    When a process is free, `next_job` returns a job, or None if there is none, or none before a
    further result. With a count of 1 all jobs run in this process.

    Raises `Unavailable` if the process of a job was killed more than `RESTARTS` times, and whatever
    a job raises.
    """
    if count == 1:
        while (job := next_job()) is not None:
            yield job.name, job.call(*job.arguments)
        return
    crew: list[Worker] = []
    try:
        crew += (Worker() for _ in range(count))
        idle, busy = list(crew), dict[Any, tuple[Worker, Job, int]]()

        def give(worker: Worker, job: Job, kills: int = 0) -> None:
            worker.give(job.call, *job.arguments)
            busy[worker.end] = worker, job, kills

        def hand_out() -> None:
            while idle and (job := next_job()) is not None:
                give(idle.pop(), job)

        hand_out()
        while busy:
            for end in connection.wait(busy):
                worker, job, kills = busy.pop(end)
                try:
                    result = worker.take()
                except EOFError:
                    if kills == RESTARTS:
                        raise Unavailable(
                            f"processes were killed {kills + 1} times during {job.name}, perhaps"
                            " for want of memory; try again, or with fewer workers"
                        ) from None
                    worker.close()
                    crew.append(Worker())
                    give(crew[-1], job, kills + 1)
                    continue
                if isinstance(result, _Failed):
                    raise result.error
                idle.append(worker)
                hand_out()  # the process works on while the caller uses its result
                yield job.name, result
                hand_out()
    finally:
        for worker in crew:
            worker.close()


@contextmanager
def _apart() -> Iterator[None]:
    """Hide the caller's script, and block Ctrl-C, while processes are started."""
    main = sys.modules["__main__"]
    with _starting, deferred():
        spec, main.__spec__ = getattr(main, "__spec__", None), None
        file = vars(main).pop("__file__", None)
        try:
            with _interrupts_blocked():
                yield
        finally:
            main.__spec__ = spec
            if file is not None:
                main.__file__ = file


@contextmanager
def _interrupts_blocked() -> Iterator[None]:
    """Block Ctrl-C in this thread, if the system can: processes started meanwhile inherit that."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    # Otherwise Python's resource tracker starts with the first process, and unblocks Ctrl-C.
    resource_tracker.ensure_running()
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _work(end: Any) -> None:
    """Do jobs from the other end of the pipe until it closes."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    os.environ.update(dict.fromkeys(THREADS, "1"))
    # A running job would not notice that its pipe has closed.
    threading.Thread(target=_follow_parent, daemon=True).start()
    with suppress(EOFError, OSError):
        while True:
            job, arguments = end.recv()
            try:
                end.send(job(*arguments))
            except Exception as error:  # noqa: BLE001 - handed over, not swallowed
                end.send(_Failed(_portable(error)))


def _follow_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
    os._exit(1)


def _portable(error: Exception) -> Exception:
    """Return an error that can be pickled, with its traceback as a note unless it is ours."""
    if not isinstance(error, TippetopError):
        error.add_note(traceback.format_exc())
    try:
        pickle.loads(pickle.dumps(error))
    except Exception:  # noqa: BLE001 - pickling may raise anything
        return RuntimeError(repr(error))
    return error
