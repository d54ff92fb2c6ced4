"""The one way to run work in processes beside this one.

They are fresh interpreters, which is the one way to start that is the same on every system and safe beside
threads. They run this package alone and never the caller's script, have one thread each, leave Ctrl-C to this
process, and end with it even if it is killed. One that is killed is replaced.
"""

import multiprocessing
import os
import pickle
import signal
import sys
import threading
import time
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from multiprocessing import connection, resource_tracker
from typing import Any, NamedTuple

from tippetop.errors import TippetopError, Unavailable
from tippetop.interrupts import deferred

RESTARTS = 3
"""How often a job is done again whose process was killed."""
GLANCE = 0.2
"""How often one who waits for a process looks whether to stop, s."""
THREADS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")

_SPAWN = multiprocessing.get_context("spawn")
_starting = threading.Lock()


class Job(NamedTuple):
    """A call to be made in another process: importable, with arguments that can be sent."""

    name: Any
    call: Callable[..., Any]
    arguments: tuple[Any, ...]


class _Failed(NamedTuple):
    """What a job raised."""

    error: Exception


class Worker:
    """A process that does one job at a time; another takes its place when it is killed or takes too long.

    It does what is to `warm_up` first, so that its first job is as fast as the next.
    """

    def __init__(self, warm_up: Callable[[], object] | None = None) -> None:
        self._warm_up = warm_up
        self._closed = False
        self._changing = threading.Lock()
        self._start()

    def _start(self) -> None:
        self.end, theirs = _SPAWN.Pipe()
        self._process = _SPAWN.Process(target=_work, args=(theirs,), daemon=True, name="tippetop worker")
        try:
            with _apart():
                self._process.start()
        except BaseException:
            # Ctrl-C that had to wait: nobody else knows of this process.
            if self._process.pid is not None:
                self._kill()
            raise
        theirs.close()
        self._ready = self._warm_up is None
        if self._warm_up is not None:
            self.give(self._warm_up)

    def give(self, job: Callable[..., Any], *arguments: Any) -> None:
        """Have a job done; if the process has ended, `take` tells."""
        with suppress(OSError):
            self.end.send((job, arguments))

    def take(self) -> tuple[bool, Any]:
        """Whether there is more to come of the job, and what has come; an `EOFError` if the process ended."""
        try:
            more, result = self.end.recv()
        except OSError:
            raise EOFError from None
        return more, result

    def results(
        self,
        job: Callable[..., Any],
        *arguments: Any,
        patience: float,
        stopped: threading.Event | None = None,
    ) -> Iterator[Any]:
        """What a job yields, one after the other, or the one thing it returns, until it is `stopped`.

        Raises
        ------
        TimeoutError
            If it takes longer than `patience` seconds; its process is then replaced.
        Unavailable
            If its process ends meanwhile; it is then replaced, too.
        Exception
            What the job raises.
        """
        busy = False
        try:
            if not self._await_ready(stopped):
                return
            self.give(job, *arguments)
            busy, deadline = True, time.monotonic() + patience
            while busy and self._heard(deadline, stopped):
                busy, result = self.take()
                if result is not None:
                    yield _or_raise(result)
        except EOFError:
            busy = True
            raise Unavailable(
                "the process that computed this has ended, and another takes its place: try again"
            ) from None
        finally:
            if busy:
                self.restart()

    def _heard(self, deadline: float, stopped: threading.Event | None) -> bool:
        """Wait for a result; False when stopped before there is one."""
        while not (stopped and stopped.is_set()):
            left = deadline - time.monotonic()
            if self.end.poll(max(0.0, left if stopped is None else min(left, GLANCE))):
                return True
            if left <= 0:
                raise TimeoutError
        return False

    def _await_ready(self, stopped: threading.Event | None) -> bool:
        """Wait until the process has warmed up; False when stopped, and nothing is to be sent."""
        while not (stopped and stopped.is_set()):
            if not self._ready and self.end.poll(GLANCE):
                self.take()
                self._ready = True
            if self._ready:
                return True
        return False

    def restart(self) -> None:
        """Put another process in the place of this one, unless it is closed."""
        with self._changing:
            if not self._closed:
                self._kill()
                self.end.close()
                self._start()

    def close(self) -> None:
        """End the process, whatever it does, for good; another thread that waits for it hears so."""
        with self._changing:
            self._closed = True
            self._kill()

    def _kill(self) -> None:
        self._process.kill()
        self._process.join()


def shared(next_job: Callable[[], Job | None], count: int) -> Iterator[tuple[Any, Any]]:
    """Do jobs in so many processes, and give the name and the result of each as it comes.

    When a process is free, `next_job` gives another, or None if there is none, or none before another result.
    With a count of 1 all is done in this process.

    Raises
    ------
    Unavailable
        If the process of a job was killed, again and again.
    Exception
        What a job raises.
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
                    _, result = worker.take()
                except EOFError:
                    if kills == RESTARTS:
                        raise Unavailable(
                            f"processes were killed {kills + 1} times during {job.name}, perhaps for want of "
                            "memory; try again, or with fewer workers"
                        ) from None
                    worker.restart()
                    give(worker, job, kills + 1)
                    continue
                idle.append(worker)
                hand_out()  # a process need not wait for what is done with its result
                yield job.name, _or_raise(result)
                hand_out()
    finally:
        for worker in crew:
            worker.close()


def _or_raise(result: Any) -> Any:
    if isinstance(result, _Failed):
        raise result.error
    return result


@contextmanager
def _apart() -> Iterator[None]:
    """Keep the caller's script, and Ctrl-C, from processes that are started meanwhile."""
    main = sys.modules["__main__"]
    with _starting, deferred():
        spec, main.__spec__ = getattr(main, "__spec__", None), None
        file = vars(main).pop("__file__", None)
        try:
            with _unheard():
                yield
        finally:
            main.__spec__ = spec
            if file is not None:
                main.__file__ = file


@contextmanager
def _unheard() -> Iterator[None]:
    """Block Ctrl-C in this thread, where a system can: what is started meanwhile inherits that, for good."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    # Python's tracker of resources would be started with the first process, and unblock it.
    resource_tracker.ensure_running()
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _work(end: Any) -> None:
    """The life of a worker: jobs from the other end of the pipe, until it closes."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    os.environ.update(dict.fromkeys(THREADS, "1"))
    # A job does not look at its pipe until it is done.
    threading.Thread(target=_follow_parent, daemon=True).start()
    with suppress(EOFError, OSError):
        while True:
            job, arguments = end.recv()
            try:
                result = job(*arguments)
                if isinstance(result, Iterator):
                    for item in result:
                        end.send((True, item))
                    result = None
                end.send((False, result))
            except Exception as error:  # noqa: BLE001 - handed over, not swallowed
                end.send((False, _Failed(_portable(error))))


def _follow_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
    os._exit(1)


def _portable(error: Exception) -> Exception:
    """An error as it can be sent: with where it was raised, unless it is one that is raised on purpose."""
    if not isinstance(error, TippetopError):
        error.add_note(traceback.format_exc())
    try:
        pickle.loads(pickle.dumps(error))
    except Exception:  # noqa: BLE001 - whatever it is that does not go through
        return RuntimeError(repr(error))
    return error
