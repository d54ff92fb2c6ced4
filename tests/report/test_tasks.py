"""Work handed to processes."""

import math
import operator
import os

import pytest

from tippetop.report.tasks import Task, carry_out
from tippetop.support.errors import TippetopError

TASKS = [
    Task("sum", 1.0, operator.add, (), after=("root", "power")),
    Task("root", 2.0, math.sqrt, (16.0,)),
    Task("power", 3.0, pow, (2, 5)),
]


@pytest.mark.parametrize("workers", [1, 2])
def test_results_of_tasks_that_depend_on_others(workers: int) -> None:
    told: list[tuple[float, float, str]] = []
    results = carry_out(TASKS, workers, lambda *news: told.append(news))
    assert results == {"root": 4.0, "power": 32, "sum": 36.0}
    assert [done for done, _, _ in told] == sorted(done for done, _, _ in told)
    assert told[-1] == (6.0, 6.0, "sum")


def test_longest_task_goes_first() -> None:
    told: list[str] = []
    carry_out(TASKS, 1, lambda done, total, name: told.append(name))
    assert told == ["power", "root", "sum"]


def test_error_of_a_task_is_raised() -> None:
    with pytest.raises(ValueError, match=r"math domain|nonnegative"):
        carry_out([Task("root", 1.0, math.sqrt, (-1.0,))], 1)


def test_killed_worker_is_reported_in_a_sentence() -> None:
    with pytest.raises(TippetopError, match="killed 4 times during exit"):
        carry_out([Task("exit", 1.0, os._exit, (1,))], 2)
