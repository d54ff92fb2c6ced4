"""Functions of states and parameters for many states at once, compiled."""

# translate module: skip

from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import Any, TypeAlias

import numpy as np

from tippetop.graph.llvm import ABREAST
from tippetop.graph.recording import recordable
from tippetop.integrators.base import Array, Rows

Evaluation: TypeAlias = Callable[[Array, Sequence[Any]], Array]
"""From n states, shape (size, ...), and parameters, each of a shape that becomes theirs, to numbers
of each, shape (numbers, ...).
"""


@lru_cache(maxsize=64)
def compiled_evaluation(function: Rows, size: int, parameters: int) -> Evaluation | None:
    """Compile a function of so many numbers and parameters; None where that cannot be."""
    recorded = recordable(function, size, parameters)
    if recorded is None:
        return None
    from tippetop.integrators.machine_code import machine_code  # noqa: PLC0415 - slow to import

    compiled, count = machine_code({"values": recorded}, ABREAST)["values"], len(recorded.outputs)

    def evaluate(y: Array, numbers: Sequence[Any]) -> Array:
        shape = y.shape[1:]
        number = int(np.prod(shape))
        padded = -(-number // ABREAST) * ABREAST
        if padded == number:
            states = np.ascontiguousarray(y).reshape(size, number)
        else:
            states = np.empty((size, padded))
            states[:, :number] = y.reshape(size, number)
        rows = np.empty((parameters, padded))
        for row, value in zip(rows[:, :number].reshape(parameters, *shape), numbers, strict=True):
            row[...] = value
        results = np.empty((count, padded))
        compiled(states, rows, results)
        return results[:, :number].reshape(count, *shape)

    return evaluate
