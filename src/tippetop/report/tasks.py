"""Work for several processes: experiments and drawings, handed out as soon as what they need is
there.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from tippetop.support.processes import Job, shared


@dataclass
class Task:
    """A call to be made once others have returned."""

    name: str
    """What it is called; unique."""
    cost: float
    """About how long it takes, s."""
    call: Callable[..., Any]
    """Function of this module's kind: importable, so that another process can have it."""
    arguments: tuple[Any, ...]
    """What it is called with."""
    after: tuple[str, ...] = ()
    """Names of tasks that come first; it is called with their results, too."""


def carry_out(
    tasks: Sequence[Task], workers: int, progress: Callable[[float, float, str], None] | None = None
) -> dict[str, Any]:
    """Do the tasks, the longest first, in so many processes, and return their results by name.

    With one worker all is done in this process. `progress` is told the cost done, the cost of all,
    and the name of the task that was done last. Raises `Unavailable` if the process of a task was
    killed again and again.
    """
    total, done = sum(task.cost for task in tasks), 0.0
    costs = {task.name: task.cost for task in tasks}
    waiting = sorted(tasks, key=lambda task: -task.cost)
    results: dict[str, Any] = {}

    def longest() -> Job | None:
        """Return the longest task that has all it needs."""
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
