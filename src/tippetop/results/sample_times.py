"""Sample times of runs, checked."""

import numpy as np
import psutil
from numpy.typing import ArrayLike

from tippetop.integrators.base import Array
from tippetop.support.errors import InvalidInput, is_whole

BYTES_PER_SAMPLE = 1600
"""Memory that a sample takes at most while a result is being made."""

SURELY_FIT = 10_000
"""Samples for which nobody needs to ask how much memory there is."""


def sample_times(duration: float, samples: int, times: ArrayLike | None) -> Array:
    """Sample times, s, checked; see `simulate`."""
    if times is None:
        if not is_whole(samples) or samples < 2:
            raise InvalidInput("samples", samples, "a whole number, at least 2")
        _check_memory(samples)
        return np.linspace(0.0, duration, int(samples))
    try:
        grid = np.array(times, dtype=float)
    except Exception:  # noqa: BLE001 - objects may raise anything on their way to numbers
        raise InvalidInput("times", times, "a list of increasing finite numbers") from None
    if (
        grid.ndim != 1
        or not len(grid)
        or not np.all(np.isfinite(grid))
        or np.any(np.diff(grid) <= 0)
    ):
        raise InvalidInput("times", times, "a list of increasing finite numbers")
    if grid[0] < 0 or grid[-1] > duration:
        raise InvalidInput("times", times, f"times from 0 to the duration, {duration:g} s")
    _check_memory(len(grid))
    return grid


def _check_memory(samples: int) -> None:
    if samples <= SURELY_FIT:
        return
    free = psutil.virtual_memory().available
    if samples * BYTES_PER_SAMPLE > free:
        limit = free // BYTES_PER_SAMPLE
        raise InvalidInput(
            "samples", samples, f"at most {limit}", "is more than there is memory for"
        )
