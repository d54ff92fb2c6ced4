"""Tasks that depend on each other, carried out in several processes."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from tippetop.support.processes import Job, shared


@dataclass
class Task:
    """A call that is made after some other tasks."""

    name: str
    """Unique name."""
    cost: float
    """Approximate duration, s."""
    call: Callable[..., Any]
    """Function to be called; it is importable, so that another process can call it."""
    arguments: tuple[Any, ...]
    """First arguments of the call."""
    after: tuple[str, ...] = ()
    """Names of the tasks whose results are the last arguments."""


def carry_out(
    tasks: Sequence[Task], workers: int, progress: Callable[[float, float, str], None] | None = None
) -> dict[str, Any]:
    """Return the results of all tasks by name.

    Tasks run in `workers` processes, the longest first; with one worker all run in this process.
    `progress` is called with the cost done, the cost of all tasks, and the name of the task that
    was done last. Raises `Unavailable` if the process of a task was killed again and again.
    """
    total, done = sum(task.cost for task in tasks), 0.0
    costs = {task.name: task.cost for task in tasks}
    waiting = sorted(tasks, key=lambda task: -task.cost)
    results: dict[str, Any] = {}

    def longest() -> Job | None:
        """Return the longest task that does not wait for results, or None."""
        for task in waiting:
            if all(name in results for name in task.after):
                waiting.remove(task)
                return Job(
                    task.name, task.call, (*task.arguments, *(results[name] for name in task.after))
                )
        return None

    for name, result in shared(longest, workers):
        results[name] = result
        done += costs[name]
        if progress is not None:
            progress(done, total, name)
    return results
