"""Functions that make numbers of several values better again and again, compiled where they can
be.
"""

# translate module: by hand in compile.js

import ctypes
from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

import numpy as np

from tippetop.graph.recording import record
from tippetop.graph.unrolling import NodeValues
from tippetop.integrators import has_llvm
from tippetop.integrators.base import Array
from tippetop.mechanics.vectors import Scalar

Iteration: TypeAlias = Callable[[Any, Any, Any, float, int], int]
"""From room for numbers, parameters, and what is made besides: the numbers are made better, until
the last of what is made besides is less than something, or no number, or as many times as may be.
It tells how many.
"""

Improvement: TypeAlias = Callable[[Sequence[Scalar], Sequence[Scalar], Any], Sequence[Scalar]]
"""From numbers and parameters, and who spreads and adds up their values, to better ones, and more.
"""


def room(count: int) -> Any:
    """Room for so many numbers."""
    return (ctypes.c_double * count)()


def copied(numbers: Any) -> Any:
    """Room that holds the same numbers."""
    return type(numbers).from_buffer_copy(numbers)


def put_from(numbers: Any, first: int, values: Sequence[float]) -> None:
    """Put values into room for numbers, from one of them on."""
    numbers[first : first + len(values)] = values


def put_rows(numbers: Any, first: int, values: Sequence[float], abreast: int) -> None:
    """Put values into room for numbers, from one of them on, each for as many as there are
    abreast.
    """
    _rows(numbers, abreast)[first : first + len(values)] = np.array(values)[:, None]


def first_of(numbers: Any, count: int) -> Array:
    """An array of the first of some numbers."""
    return np.frombuffer(numbers, count=count).copy()


def iterated(function: Improvement, size: int, parameters: int, abreast: int) -> Iteration:
    """Compile an improvement.

    Raises `NotRecordable` if the function makes a choice that depends on the numbers.

    Parameters
    ----------
    function
        What is done.
    size, parameters
        How many numbers and parameters there are.
    abreast
        How many values each has, one after another in the room for them.
    """
    if not has_llvm():
        return _by_arrays(function, size, abreast)
    from tippetop.integrators.machine_code import iteration  # noqa: PLC0415 - optional

    values = NodeValues()
    return iteration(record(lambda y, p: function(y, p, values), size, parameters), abreast)


class _Lanes:
    """What is done with the values of arrays."""

    def spread(self, a: Any, lane: int) -> Any:
        """One of them, for all."""
        return a[lane] if np.ndim(a) else a

    def total(self, a: Any) -> Any:
        """Their sum, for all."""
        return np.sum(a)


def _by_arrays(function: Improvement, size: int, abreast: int) -> Iteration:
    """The same by arrays."""

    def iterate(y: Any, p: Any, out: Any, enough: float, most: int) -> int:
        rows = [_rows(numbers, abreast) for numbers in (y, p, out)]
        with np.errstate(all="ignore"):
            for turn in range(1, most + 1):
                found = function(list(rows[0][:size].copy()), list(rows[1]), _Lanes())
                rows[0][:size] = np.stack([np.broadcast_to(row, abreast) for row in found[:size]])
                rows[2][:] = np.stack([np.broadcast_to(row, abreast) for row in found[size:]])
                if not rows[2][-1, 0] >= enough:
                    return turn
        return most

    return iterate


def _rows(numbers: Any, abreast: int) -> Array:
    return np.frombuffer(numbers).reshape(-1, abreast)
