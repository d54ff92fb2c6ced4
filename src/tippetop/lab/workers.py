"""Processes that simulate for the page, so that it never waits for a run and can give up on one.

A job that takes too long is ended with its process, and a new one takes its place. So a launch that would
never finish costs others nothing but its deadline.
"""

import logging
import os
import queue
import tempfile
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, TypeVar

from tippetop.errors import InvalidInput, TippetopError, Unavailable, one_of
from tippetop.lab import jobs
from tippetop.lab.map_job import MapPart, map_parts, warm_up_map
from tippetop.lab.setup import Setup
from tippetop.processes import GLANCE, Worker

PATIENCE = 6.0
"""How long a run on the page may take to compute, s."""
FILE_PATIENCE = 30.0
"""How long making a file may take, s."""
MAP_PATIENCE = 120.0
"""How long a map may take, s."""
_Result = TypeVar("_Result")


class Workers:
    """A few workers for runs, one for files and one for maps, which take their time."""

    def __init__(self, count: int | None = None) -> None:
        self.count = count or max(1, min(4, (os.cpu_count() or 2) - 1))
        """How many runs can be under way at once."""
        self._closed = threading.Event()
        self._changing = threading.Lock()
        self._all = [Worker(jobs.warm_up) for _ in range(self.count)]
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
                worker = Worker(jobs.warm_up)
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
            with self._answered(setup, MAP_PATIENCE, "a map"):
                yield from self._mapper.results(
                    map_parts, setup, spins, frictions, patience=MAP_PATIENCE, stopped=stopped
                )
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
            with self._answered(setup, patience):
                (result,) = worker.results(job, *arguments, patience=patience)
        finally:
            workers.put(worker)
        return result  # type: ignore[no-any-return]

    @contextmanager
    def _answered(self, setup: Setup, patience: float, what: str = "a run") -> Iterator[None]:
        """Say in a sentence why there is no result."""
        try:
            yield
        except TimeoutError:
            raise _too_long(setup, patience, what) from None
        except Unavailable:
            self._check_open()
            raise
        except TippetopError:
            raise
        except Exception as error:
            logging.getLogger(__name__).exception("a job failed: %s", setup)
            raise InvalidInput("launch", "this one", f"one that can be computed ({error!r})") from None

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


def _too_long(setup: Setup, patience: float, what: str) -> InvalidInput:
    return InvalidInput(
        "duration",
        setup.duration,
        f"{what} that is computed within {patience:g} s, and this one is not: make it shorter, "
        "or take less spin, friction or restitution",
    )
