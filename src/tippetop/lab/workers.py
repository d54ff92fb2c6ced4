"""Processes that simulate for the page, so that it never waits for a run and can give up on one.

Each worker does one job at a time; a job that takes too long is ended with its process, and a new one takes
its place. So a launch that would never finish costs others nothing but its deadline.
"""

import logging
import multiprocessing
import os
import queue
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any, TypeVar

from tippetop.errors import InvalidInput, TippetopError, Unavailable, one_of
from tippetop.interrupts import follow_parent
from tippetop.lab import jobs
from tippetop.lab.map_job import MapPart, map_parts, warm_up_map
from tippetop.lab.setup import Setup

PATIENCE = 6.0
"""How long a run on the page may take to compute, s."""
FILE_PATIENCE = 30.0
"""How long making a file may take, s."""
MAP_PATIENCE = 120.0
"""How long a map may take, s."""
GLANCE = 0.2
"""How often work that can be stopped looks whether it is, s."""

_Result = TypeVar("_Result")
_CONTEXT = multiprocessing.get_context("spawn")


class Worker:
    """A process that does one job at a time, once it has warmed up."""

    def __init__(self, warm_up: Callable[[], None] = jobs.warm_up) -> None:
        self._warm_up = warm_up
        self._closed = False
        self._changing = threading.Lock()
        self._start()

    def _start(self) -> None:
        self._end, theirs = _CONTEXT.Pipe()
        self._process = _CONTEXT.Process(
            target=_work, args=(theirs, self._warm_up), daemon=True, name="tippetop lab worker"
        )
        self._process.start()
        theirs.close()
        self._ready = False

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
        TippetopError
            What the job raises.
        """
        if not self._await_ready(stopped):
            return
        finished = False
        try:
            self._end.send((job, arguments))
            deadline = time.monotonic() + patience
            while True:
                if not self._heard(deadline, stopped):
                    return
                done, result = self._end.recv()
                finished = done
                if isinstance(result, TippetopError):
                    raise result
                if done and result is None:
                    return
                yield result
                if done:
                    return
        except (EOFError, OSError) as error:
            if isinstance(error, TippetopError | TimeoutError):
                raise
            raise self._ended() from error
        finally:
            if not finished:
                self._restart()

    def _heard(self, deadline: float, stopped: threading.Event | None) -> bool:
        """Wait for a result; False when stopped before there is one."""
        while not (stopped and stopped.is_set()):
            left = deadline - time.monotonic()
            if self._end.poll(max(0.0, left if stopped is None else min(left, GLANCE))):
                return True
            if left <= 0:
                raise TimeoutError
        return False

    def _await_ready(self, stopped: threading.Event | None) -> bool:
        """Wait until the process has warmed up; False when stopped, and nothing is to be sent."""
        try:
            while not (stopped and stopped.is_set()):
                if self._ready:
                    return True
                if self._end.poll(GLANCE):
                    self._end.recv()
                    self._ready = True
        except (EOFError, OSError) as error:
            self._restart()
            raise self._ended() from error
        return False

    def _ended(self) -> Unavailable:
        if self._closed:
            return Unavailable("the laboratory is being closed")
        return Unavailable("the process that computed this has ended, and another takes its place: try again")

    def _restart(self) -> None:
        """Put another process in the place of this one, unless it is closed."""
        with self._changing:
            if not self._closed:
                self._kill()
                self._end.close()
                self._start()

    def close(self) -> None:
        """End the process, whatever it does, for good; another thread that waits for it hears so."""
        with self._changing:
            self._closed = True
            self._kill()

    def _kill(self) -> None:
        self._process.kill()
        self._process.join()


class Workers:
    """A few workers for runs, one for files and one for maps, which take their time."""

    def __init__(self, count: int | None = None) -> None:
        self.count = count or max(1, min(4, (os.cpu_count() or 2) - 1))
        """How many runs can be under way at once."""
        self._closed = threading.Event()
        self._changing = threading.Lock()
        self._all = [Worker() for _ in range(self.count)]
        self._runners = _queue_of(self._all)
        self._filers: queue.SimpleQueue[Worker] | None = None
        self._mapping = threading.Lock()
        self._mapper = Worker(warm_up_map)
        self._all.append(self._mapper)

    def track(self, setup: Setup) -> bytes:
        """The run of a launch as the player takes it.

        Raises
        ------
        InvalidInput
            If it would take too long.
        """
        return self._one(self._runners, setup, jobs.track_of, setup, patience=PATIENCE)

    def file(self, setup: Setup, kind: str) -> bytes:
        """The run of a launch as a file.

        Raises
        ------
        InvalidInput
            If there is no such kind of file, or it would take too long.
        """
        if kind not in jobs.KINDS:
            raise InvalidInput("kind", kind, one_of(kind, list(jobs.KINDS)))
        # Its folder is looked after here, since the process that writes in it may have to be killed.
        with tempfile.TemporaryDirectory(prefix="tippetop-") as folder:
            return self._one(
                self._their_filers(), setup, jobs.file_of, setup, kind, Path(folder), patience=FILE_PATIENCE
            )

    def _their_filers(self) -> queue.SimpleQueue[Worker]:
        """The worker for files, which is started when the first file is asked for."""
        with self._changing:
            if self._filers is None:
                self._check_open()
                worker = Worker()
                self._all.append(worker)
                self._filers = _queue_of([worker])
            return self._filers

    def map_parts(
        self, setup: Setup, spins: list[float], frictions: list[float], stopped: threading.Event
    ) -> Iterator[MapPart]:
        """The parts of a map, as they are done, until it is `stopped`.

        Raises
        ------
        InvalidInput
            If it would take too long.
        """
        while not self._mapping.acquire(timeout=GLANCE):
            if stopped.is_set():
                return
            self._check_open()
        try:
            yield from self._mapper.results(
                map_parts, setup, spins, frictions, patience=MAP_PATIENCE, stopped=stopped
            )
        except TimeoutError:
            raise _too_long(setup, MAP_PATIENCE, "a map") from None
        finally:
            self._mapping.release()

    def _one(
        self,
        workers: queue.SimpleQueue[Worker],
        setup: Setup,
        job: Callable[..., _Result],
        *arguments: Any,
        patience: float,
    ) -> _Result:
        worker = self._wait_for(workers)
        try:
            (result,) = worker.results(job, *arguments, patience=patience)
        except TimeoutError:
            raise _too_long(setup, patience) from None
        finally:
            workers.put(worker)
        return result  # type: ignore[no-any-return]

    def _wait_for(self, workers: queue.SimpleQueue[Worker]) -> Worker:
        while True:
            self._check_open()
            with suppress(queue.Empty):
                return workers.get(timeout=GLANCE)

    def _check_open(self) -> None:
        if self._closed.is_set():
            raise Unavailable("the laboratory is being closed")

    def close(self) -> None:
        """End all processes; who waits for one is told so."""
        with self._changing:
            self._closed.set()
            for worker in self._all:
                worker.close()


def _queue_of(workers: list[Worker]) -> queue.SimpleQueue[Worker]:
    waiting: queue.SimpleQueue[Worker] = queue.SimpleQueue()
    for worker in workers:
        waiting.put(worker)
    return waiting


def _too_long(setup: Setup, patience: float, what: str = "a run") -> InvalidInput:
    return InvalidInput(
        "duration",
        setup.duration,
        f"{what} that is computed within {patience:g} s, and this one is not: make it shorter, "
        "or take less spin, friction or restitution",
    )


def _work(end: Connection, warm_up: Callable[[], None]) -> None:
    """The life of a worker: jobs from the other end of the pipe, until it closes."""
    # A job does not look at its pipe until it is done.
    follow_parent()
    with suppress(KeyboardInterrupt, EOFError, BrokenPipeError):
        warm_up()
        end.send("ready")
        while True:
            job, arguments = end.recv()
            try:
                result = job(*arguments)
                if isinstance(result, Iterator):
                    for item in result:
                        end.send((False, item))
                    result = None
            except TippetopError as error:
                result = error
            except Exception as error:
                logging.getLogger(__name__).exception("a job failed: %s", arguments)
                result = InvalidInput("launch", "this one", f"one that can be computed ({error!r})")
            end.send((True, result))
