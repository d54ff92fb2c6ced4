"""Validation of sample times."""

from typing import Any

import numpy as np
import psutil
from numpy.typing import ArrayLike

from tippetop.integrators.base import Array
from tippetop.support.errors import InvalidInput, is_whole
from tippetop.support.units import has_unit, number_in

BYTES_PER_SAMPLE = 1600
"""Largest memory of a sample while a result is made, bytes."""

UNCHECKED_SAMPLES = 10_000
"""Number of samples up to which the free memory is not checked: 16 MB are always free."""


def sample_times(duration: float, samples: int, times: ArrayLike | None) -> Array:
    """Return the sample times of `simulate`, s; raise `InvalidInput` for arguments not accepted."""
    if times is None:
        if not is_whole(samples) or samples < 2:
            raise InvalidInput("samples", samples, "a whole number, at least 2")
        _check_memory(samples)
        return np.linspace(0.0, duration, int(samples))
    grid = listed_times(times)
    if grid[0] < 0 or grid[-1] > duration:
        raise InvalidInput("times", times, f"times from 0 to the duration, {duration:g} s")
    _check_memory(len(grid))
    return grid


def listed_times(times: ArrayLike) -> Array:
    """Return listed sample times, s; raise `InvalidInput` unless they are finite and increase."""
    seconds = _in_seconds(times)
    try:
        grid = np.array(seconds, dtype=float)
    except Exception:  # noqa: BLE001 - conversion of an object may raise anything
        raise InvalidInput("times", times, "a list of increasing finite numbers") from None
    if (
        grid.ndim != 1
        or not len(grid)
        or not np.all(np.isfinite(grid))
        or np.any(np.diff(grid) <= 0)
    ):
        raise InvalidInput("times", times, "a list of increasing finite numbers")
    return grid


def _in_seconds(times: ArrayLike) -> Any:
    """Return times in s: those of a quantity, or of a list with texts or quantities in it."""
    if has_unit(times):
        return number_in("times", times, "s")
    if isinstance(times, np.ndarray) and times.dtype.kind in "OU":
        times = times.tolist()
    if isinstance(times, list | tuple):
        return [number_in(f"times.{place}", time, "s") for place, time in enumerate(times)]
    return times


def _check_memory(samples: int) -> None:
    if samples <= UNCHECKED_SAMPLES:
        return
    free = psutil.virtual_memory().available
    if samples * BYTES_PER_SAMPLE > free:
        limit = free // BYTES_PER_SAMPLE
        raise InvalidInput(
            "samples", samples, f"at most {limit}", "is more than fits into the free memory"
        )
