"""Sizes of the campaigns: what every check runs, what `make test-all` adds, and what is claimed.

A campaign follows random cases with the seeds 0, 1, 2 and so on. Each is a parameter of a test, and
its mark says who runs it: none, `slow` or `campaign`. Parameters that this run of pytest would only
deselect are not made: there are thousands.
"""

from collections.abc import Iterable, Sequence
from itertools import pairwise
from typing import Any

import pytest
from _pytest.mark.expression import Expression
from hypothesis import settings

left_out: set[str] = set()
"""Marks whose parameters this run of pytest leaves out."""


def note_marks(expression: str) -> None:
    """Note which marks an expression, as of the option -m, leaves out, whatever marks are beside
    them.
    """
    if not expression:
        return
    compiled = Expression.compile(expression)

    def selects(*marks: str) -> bool:
        return compiled.evaluate(lambda name, **_: name in marks)

    left_out.update(
        mark for mark in ("slow", "campaign") if not (selects(mark) or selects(mark, "browser"))
    )


def seeds(
    check: int,
    sample: int,
    claim: int,
    always: Sequence[int] = (),
    sampled: Sequence[int] = (),
) -> list[Any]:
    """Return the seeds of a campaign as parameters.

    Every check runs those below `check` and those of `always`, `make test-all` those below
    `sample`, which is more, and those of `sampled`, and `make campaigns` those below `claim`.
    """

    def first(seed: int) -> int:
        return -1 if seed in always else check if seed in sampled else seed

    return _asked(_marked(k, first(k), check, sample) for k in range(claim))


def seed_ranges(check: int, sample: int, claim: int, size: int) -> list[Any]:
    """Return the same seeds in ranges of at most `size`, for tests that count over many."""
    bounds = (0, check, sample, claim)
    ranges = [
        range(first, min(first + size, end))
        for start, end in pairwise(bounds)
        for first in range(start, end, size)
    ]
    return _asked(_marked(r, r.start, check, sample, id=f"{r.start}-{r.stop - 1}") for r in ranges)


def among(cases: Sequence[Any], check: int) -> list[Any]:
    """Return cases as parameters, of which every check runs `check`, evenly chosen.

    `make test-all` runs all of them.
    """
    chosen = {k * len(cases) // check for k in range(check)}
    return _asked(
        pytest.param(*_values(case), marks=() if k in chosen else pytest.mark.slow)
        for k, case in enumerate(cases)
    )


def _values(case: Any) -> tuple[Any, ...]:
    return case if isinstance(case, tuple) else (case,)


def _asked(parameters: Iterable[Any]) -> list[Any]:
    """Return the parameters of which no mark is left out.

    Where none is, the first stays, to be deselected: pytest would report a test without parameters.
    """
    every = list(parameters)
    return [one for one in every if not any(mark.name in left_out for mark in one.marks)] or every[
        :1
    ]


def examples(check: int, claim: int) -> int:
    """Return how many examples are tried: `claim` at random; `check` with fixed seeds by `make
    test-all`, and the first two fifths of them by every check.
    """
    if not settings().derandomize:
        return claim
    return max(2, 2 * check // 5) if "slow" in left_out else check


def _marked(value: Any, first: int, check: int, sample: int, **options: Any) -> Any:
    """Return a parameter whose first seed says who runs it."""
    if first < check:
        return pytest.param(value, **options)
    mark = pytest.mark.slow if first < sample else pytest.mark.campaign
    return pytest.param(value, marks=mark, **options)
