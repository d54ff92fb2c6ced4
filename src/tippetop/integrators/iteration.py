"""Fixed-point iterations on numbers of several values each, compiled."""

# translate module: by hand in compile.js

import ctypes
from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

import numpy as np

from tippetop.graph.recording import record
from tippetop.graph.unrolling import NodeValues
from tippetop.integrators.base import Array
from tippetop.mechanics.vectors import Scalar

Iteration: TypeAlias = Callable[[Any, Any, Any, float, int], int]
"""A function of buffers of unknowns, parameters and results, a tolerance and a limit of iterations.

It improves the unknowns in place until the last result is less than the tolerance or is not a
number, and returns the number of iterations.
"""

Improvement: TypeAlias = Callable[[Sequence[Scalar], Sequence[Scalar], Any], Sequence[Scalar]]
"""A function of unknowns, parameters and `NodeValues` that returns better unknowns and results."""


def room(count: int) -> Any:
    """Return room for so many numbers."""
    return (ctypes.c_double * count)()


def copied(numbers: Any) -> Any:
    """Return a copy of a room with its numbers."""
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
    """Return an array of the first numbers of a room."""
    return np.frombuffer(numbers, count=count).copy()


def iterated(
    function: Improvement, size: int, parameters: int, abreast: int, effort: int = 1
) -> Iteration:
    """Compile an improvement.

    Raises `NotRecordable` if the function makes a choice that depends on the numbers.

    Parameters
    ----------
    function
        The improvement.
    size, parameters
        How many numbers and parameters there are.
    abreast
        How many values each has, one after another in the room for them.
    effort
        How hard the compiler tries, see `tippetop.integrators.machine_code`; 0 for a function that
        is seldom called.
    """
    from tippetop.integrators.machine_code import iteration  # noqa: PLC0415 - slow to import

    values = NodeValues()
    recorded = record(lambda y, p: function(y, p, values), size, parameters)
    return iteration(recorded, abreast, effort)


def _rows(numbers: Any, abreast: int) -> Array:
    return np.frombuffer(numbers).reshape(-1, abreast)
