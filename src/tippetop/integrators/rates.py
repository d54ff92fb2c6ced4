"""The rates of a motion as arrays, and their derivatives."""

from collections.abc import Sequence
from functools import lru_cache
from typing import Any

import numpy as np

from tippetop.graph.derivatives import derivatives
from tippetop.integrators.base import Array, Motion, Rows
from tippetop.integrators.evaluation import compiled_evaluation
from tippetop.mechanics.vectors import Scalar

SHIFT = 1e-100
"""Imaginary steps along which derivatives are taken: their squares vanish."""


class RightHandSide:
    """A motion's rates as the step-by-step methods take them, with a count of how often they were
    asked.

    Where the arithmetic breaks down, the rates are not numbers, and the method finds no step.
    """

    def __init__(self, motion: Motion, parameters: Sequence[Scalar]) -> None:
        self.motion, self.parameters, self.calls = motion, parameters, 0

    def __call__(self, _: float, state: Array) -> Array:
        """Return the rates at a state, whatever the time."""
        self.calls += 1
        try:
            rates = np.array(self.motion.rates(state.tolist(), self.parameters))
        except ArithmeticError:
            return np.full(self.motion.size, np.nan)
        # Python takes the root of a negative number for a complex one.
        return np.full(self.motion.size, np.nan) if np.iscomplexobj(rates) else rates

    def linearized(self, states: Array) -> tuple[Array, Array]:
        """Return the rates at n states, shape (n, size), and their derivatives, shape (n, size,
        size).

        Of variational equations the derivatives of the varied motion alone are returned: every
        direction by itself has the same ones. The parameters may be of shape (n,), too.
        """
        count, size = states.shape
        self.calls += size * count
        varied = self.motion.varied
        if varied is None:
            return _linearized_at(self.motion, self.parameters, states)
        parameters, numbers = self.parameters[: varied.parameters], states[:, : varied.size]
        return self._at(states), _linearized_at(varied, parameters, numbers)[1]

    def _at(self, states: Array) -> Array:
        """Return the rates at n states, shape (n, size)."""
        evaluate = compiled_evaluation(self.motion.rates, self.motion.size, self.motion.parameters)
        if evaluate is None:
            return np.array([self(0.0, state) for state in states])
        return evaluate(states.T, self.parameters).T


def _linearized_at(
    motion: Motion, parameters: Sequence[Scalar], states: Array
) -> tuple[Array, Array]:
    """Return the rates of a motion at n states and their derivatives.

    The derivatives are compiled. Those of motions that cannot be recorded are taken along imaginary
    steps, which are exact however short (Squire and Trapp 1998).
    """
    count, size = states.shape
    evaluate = compiled_evaluation(_linearized(motion), size, motion.parameters)
    if evaluate is not None:
        numbers = evaluate(states.T, parameters)
        slopes = numbers[size:].reshape(size, size, count)
        return np.ascontiguousarray(numbers[:size].T), np.moveaxis(slopes, 2, 0)
    each = np.arange(size)
    moved = np.repeat(states[None].astype(complex), size, axis=0)
    moved[each, :, each] += 1j * SHIFT
    with np.errstate(all="ignore"):
        try:
            rates = motion.rates(list(np.moveaxis(moved, 2, 0)), parameters)
        except (
            ArithmeticError,
            TypeError,
            ValueError,
        ):  # A law of one's own may not take them.
            rates = [np.nan] * size
    values = np.stack(
        [np.broadcast_to(np.asarray(rate), moved.shape[:2]) for rate in rates], axis=-1
    )
    return np.ascontiguousarray(values[0].real), np.transpose(values.imag, (1, 2, 0)) / SHIFT


@lru_cache(maxsize=64)
def _linearized(motion: Motion) -> Rows:
    """Return the rates of a motion and then the rows of their derivatives, as one function that can
    be recorded.
    """

    def values(y: Sequence[Any], p: Sequence[Any]) -> list[Scalar]:
        rates, size = list(motion.rates(y, p)), len(y)
        seeds = {
            one.place: tuple(map(float, row)) for one, row in zip(y, np.eye(size), strict=True)
        }
        return rates + [slope for row in derivatives(rates, seeds) for slope in row]

    return values
