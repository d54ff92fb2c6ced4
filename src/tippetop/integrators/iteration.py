"""Functions that make numbers of several values better again and again, compiled where they can be."""

import ctypes
import math
from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

import numpy as np

from tippetop.emit.recording import record
from tippetop.emit.unrolling import NodeValues
from tippetop.integrators import has_llvm
from tippetop.integrators.base import Array
from tippetop.mechanics.vectors import Scalar

Iteration: TypeAlias = Callable[[Any, Any, Any, float, int], int]
"""From room for numbers, parameters, and what is made besides: the numbers are made better, until the last of
what is made besides is less than something, or no number, or as many times as may be. It tells how many."""

Improvement: TypeAlias = Callable[[Sequence[Scalar], Sequence[Scalar], Any], Sequence[Scalar]]
"""From numbers and parameters, and who spreads and adds up their values, to better ones, and more."""


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
    """Put values into room for numbers, from one of them on, each for as many as there are abreast."""
    _rows(numbers, abreast)[first : first + len(values)] = np.array(values)[:, None]


def pieces_of(numbers: Any, size: int, degree: int, count: float) -> Array:
    """The first of some pieces of polynomials, of which the last may be a share.

    Parameters
    ----------
    numbers
        Coefficients of piece after piece, and of one number after the other, from the first power on.
    size, degree
        How many numbers there are, and the degree of their polynomials.
    count
        How many pieces are wanted, more than none: what a fraction is over is a share of the last one.
    """
    whole = math.ceil(count)
    found = np.frombuffer(numbers, count=whole * size * degree).copy()
    if count < whole:
        share = count - (whole - 1)
        found[-size * degree :].reshape(size, degree)[:] *= share ** np.arange(1, degree + 1)
    return found


def change_over(pieces: Array, size: int, degree: int) -> list[float]:
    """By how much numbers change over pieces."""
    found: list[float] = pieces.reshape(-1, size, degree).sum(axis=(0, 2)).tolist()
    return found


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
