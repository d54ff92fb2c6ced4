"""The guards of a motion as functions of the state alone, compiled where they can be."""

# translate module: by hand in dense.js

import math
from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from tippetop.integrators.base import Array, Motion, Rows
from tippetop.integrators.evaluation import compiled_evaluation
from tippetop.integrators.zero_crossings import StateFunction, value_of
from tippetop.mechanics.vectors import Row, Scalar

RECENT = 64
"""States whose values are kept: more than a search looks at before it asks the next guard."""


def guard_values(
    motion: Motion, parameters: Sequence[Scalar], states: Sequence[Row]
) -> list[list[float]]:
    """Return the values of each guard of a motion in several states, not finite at a pole."""
    evaluated = _evaluated(motion, parameters, np.array(states, dtype=float).T)
    if evaluated is not None:
        return evaluated
    plain = [guard.with_parameters(parameters) for guard in motion.guards]
    arrays = [np.array(state, dtype=float) for state in states]
    return [[value_of(guard, state) for state in arrays] for guard in plain]


def guard_functions(motion: Motion, parameters: Sequence[Scalar]) -> list[StateFunction]:
    """Return the guards of a motion as functions of the state, infinite at a pole.

    Compiled code evaluates all guards at once, and a search asks them one after another at the same
    states: so the values at recent states are kept.
    """

    @lru_cache(maxsize=RECENT)
    def values(content: bytes) -> list[list[float]] | None:
        return _evaluated(motion, parameters, np.frombuffer(content)[:, None])

    def function_of(number: int) -> StateFunction:
        plain = motion.guards[number].with_parameters(parameters)

        def value(state: Array) -> float:
            every = values(state.tobytes())
            if every is None:
                return value_of(plain, state)
            return every[number][0] if math.isfinite(every[number][0]) else math.inf

        return value

    return [function_of(number) for number in range(len(motion.guards))]


def _evaluated(
    motion: Motion, parameters: Sequence[Scalar], states: Array
) -> list[list[float]] | None:
    """Return the values of guards in states, shape (size, n), by compiled code; None without it."""
    evaluate = compiled_evaluation(_all_guards(motion), motion.size, motion.parameters)
    if evaluate is None:
        return None
    values: list[list[float]] = evaluate(states, parameters).tolist()
    return values


@lru_cache(maxsize=64)
def _all_guards(motion: Motion) -> Rows:
    """Return all guards as one function, the same one for the same motion."""
    return lambda y, p: [guard.value(y, p) for guard in motion.guards]
