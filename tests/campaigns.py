"""Sizes of the campaigns: what every check runs, what `make test-all` adds, and what is claimed.

A campaign follows random cases with the seeds 0, 1, 2 and so on. Each is a parameter of a test, and
its mark says who runs it: none, `slow` or `campaign`.
"""

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import pytest
from hypothesis import settings


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

    return [_marked(k, first(k), check, sample) for k in range(claim)]


def seed_ranges(check: int, sample: int, claim: int, size: int) -> list[Any]:
    """Return the same seeds in ranges of at most `size`, for tests that count over many."""
    bounds = (0, check, sample, claim)
    ranges = [
        range(first, min(first + size, end))
        for start, end in pairwise(bounds)
        for first in range(start, end, size)
    ]
    return [_marked(r, r.start, check, sample, id=f"{r.start}-{r.stop - 1}") for r in ranges]


def among(cases: Sequence[Any], check: int) -> list[Any]:
    """Return cases as parameters, of which every check runs `check`, evenly chosen.

    `make test-all` runs all of them.
    """
    chosen = {k * len(cases) // check for k in range(check)}
    return [
        case if k in chosen else pytest.param(*_values(case), marks=pytest.mark.slow)
        for k, case in enumerate(cases)
    ]


def _values(case: Any) -> tuple[Any, ...]:
    return case if isinstance(case, tuple) else (case,)


def examples(check: int, claim: int) -> int:
    """Return how many examples hypothesis tries: `check` with fixed seeds, `claim` at random."""
    return check if settings().derandomize else claim


def _marked(value: Any, first: int, check: int, sample: int, **options: Any) -> Any:
    """Return a parameter whose first seed says who runs it."""
    if first < check:
        return pytest.param(value, **options)
    mark = pytest.mark.slow if first < sample else pytest.mark.campaign
    return pytest.param(value, marks=mark, **options)
