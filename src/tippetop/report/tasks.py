"""Work for several processes: experiments and drawings, handed out as soon as what they need is there."""

import multiprocessing
import signal
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

from tippetop.errors import TippetopError


@dataclass
class Task:
    """A call to be made once others have returned.

    Attributes
    ----------
    name
        What it is called; unique.
    cost
        About how long it takes, s.
    call
        Function of this module's kind: importable, so that another process can have it.
    arguments
        Makes its arguments from the results of the tasks it is after.
    after
        Names of tasks that come first.
    """

    name: str
    cost: float
    call: Callable[..., Any]
    arguments: Callable[[dict[str, Any]], tuple[Any, ...]]
    after: tuple[str, ...] = field(default=())


def carry_out(
    tasks: Sequence[Task], workers: int, progress: Callable[[float, float, str], None] | None = None
) -> dict[str, Any]:
    """Do the tasks, the longest first, and return their results by name.

    Parameters
    ----------
    tasks
        What there is to do.
    workers
        Number of processes; with 1 all is done in this one.
    progress
        Told the cost done, the cost of all, and the name of the task that was done last.

    Raises
    ------
    TippetopError
        If a process was killed.
    """
    total, done = sum(task.cost for task in tasks), 0.0
    waiting = sorted(tasks, key=lambda task: -task.cost)
    results: dict[str, Any] = {}
    running: dict[Future[Any], Task] = {}
    with _executor(workers) as executor:
        while waiting or running:
            for task in [task for task in waiting if all(name in results for name in task.after)]:
                if len(running) >= workers:
                    break
                waiting.remove(task)
                running[executor.submit(task.call, *task.arguments(results))] = task
            finished, _ = wait(running, return_when=FIRST_COMPLETED)
            for future in finished:
                task = running.pop(future)
                try:
                    results[task.name] = future.result()
                except BrokenProcessPool:
                    raise TippetopError(
                        f"a worker process was killed during {task.name}, perhaps for want of memory; "
                        "run it again, or with one worker"
                    ) from None
                done += task.cost
                if progress is not None:
                    progress(done, total, task.name)
    return results


@contextmanager
def _executor(workers: int) -> Iterator[Executor]:
    """Processes to work in; they are stopped at once when anything goes wrong, Ctrl-C included."""
    if workers == 1:
        yield _Here()
        return
    others = set(multiprocessing.active_children())
    # A fresh interpreter is the one way to start that is the same on every system and safe beside threads.
    executor = ProcessPoolExecutor(workers, multiprocessing.get_context("spawn"), _ignore_interrupts)
    try:
        yield executor
    except BaseException:
        for process in set(multiprocessing.active_children()) - others:
            process.terminate()
        executor.shutdown(cancel_futures=True)
        raise
    executor.shutdown()


def _ignore_interrupts() -> None:
    """Leave Ctrl-C to the parent, which stops its workers."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


class _Here(Executor):
    """Does what it is given in this process."""

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Call the function and return what came of it."""
        future: Future[Any] = Future()
        try:
            future.set_result(fn(*args, **kwargs))
        except Exception as error:  # noqa: BLE001 - handed over, not swallowed
            future.set_exception(error)
        return future
