"""Processes that simulate for the page, so that it never waits for a run and can give up on one.

Each worker does one job at a time; a job that takes too long is ended with its process, and a new one takes
its place. So a launch that would never finish costs others nothing but its deadline.
"""

import logging
import multiprocessing
import os
import queue
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from multiprocessing.connection import Connection
from typing import Any, TypeVar

from tippetop.errors import InvalidInput, TippetopError, Unavailable, one_of
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
        finished = False
        try:
            self._await_ready()
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
            sentence = "the process that computed this has ended, and another takes its place: try again"
            raise Unavailable(sentence) from error
        finally:
            if not finished:
                self.close()
                self._start()

    def _heard(self, deadline: float, stopped: threading.Event | None) -> bool:
        """Wait for a result; False when stopped before there is one."""
        while not (stopped and stopped.is_set()):
            left = deadline - time.monotonic()
            if self._end.poll(max(0.0, left if stopped is None else min(left, GLANCE))):
                return True
            if left <= 0:
                raise TimeoutError
        return False

    def _await_ready(self) -> None:
        if not self._ready:
            self._end.recv()
            self._ready = True

    def close(self) -> None:
        """End the process, whatever it does."""
        self._process.kill()
        self._process.join()
        self._end.close()


class Workers:
    """A few workers for runs, and one for maps, which take their time."""

    def __init__(self, count: int | None = None) -> None:
        self._runners: queue.SimpleQueue[Worker] = queue.SimpleQueue()
        self._mapping = threading.Lock()
        self._all = [Worker() for _ in range(count or max(1, min(4, (os.cpu_count() or 2) - 1)))]
        for worker in self._all:
            self._runners.put(worker)
        self._mapper = Worker(warm_up_map)
        self._all.append(self._mapper)

    def track(self, setup: Setup) -> bytes:
        """The run of a launch as the player takes it.

        Raises
        ------
        InvalidInput
            If it would take too long.
        """
        return self._one(setup, jobs.track_of, setup, patience=PATIENCE)

    def file(self, setup: Setup, kind: str) -> bytes:
        """The run of a launch as a file.

        Raises
        ------
        InvalidInput
            If there is no such kind of file, or it would take too long.
        """
        if kind not in jobs.KINDS:
            raise InvalidInput("kind", kind, one_of(kind, list(jobs.KINDS)))
        return self._one(setup, jobs.file_of, setup, kind, patience=FILE_PATIENCE)

    def map_parts(
        self, setup: Setup, spins: list[float], frictions: list[float], stopped: threading.Event
    ) -> Iterator[MapPart]:
        """The parts of a map, as they are done, until it is `stopped`.

        Raises
        ------
        InvalidInput
            If it would take too long.
        """
        with self._mapping:
            try:
                yield from self._mapper.results(
                    map_parts, setup, spins, frictions, patience=MAP_PATIENCE, stopped=stopped
                )
            except TimeoutError:
                raise _too_long(setup, MAP_PATIENCE, "a map") from None

    def _one(self, setup: Setup, job: Callable[..., _Result], *arguments: Any, patience: float) -> _Result:
        worker = self._runners.get()
        try:
            (result,) = worker.results(job, *arguments, patience=patience)
        except TimeoutError:
            raise _too_long(setup, patience) from None
        finally:
            self._runners.put(worker)
        return result  # type: ignore[no-any-return]

    def close(self) -> None:
        """End all processes."""
        for worker in self._all:
            worker.close()


def _too_long(setup: Setup, patience: float, what: str = "a run") -> InvalidInput:
    return InvalidInput(
        "duration",
        setup.duration,
        f"{what} that is computed within {patience:g} s, and this one is not: make it shorter, "
        "or take less spin, friction or restitution",
    )


def _work(end: Connection, warm_up: Callable[[], None]) -> None:
    """The life of a worker: jobs from the other end of the pipe, until it closes."""
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
