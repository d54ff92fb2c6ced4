"""The rates of a motion as arrays, and their derivatives."""

from collections.abc import Sequence

import numpy as np

from tippetop.integrators.base import Array, Motion
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

        The derivatives are taken along imaginary steps, which are exact however short
        (Squire and Trapp 1998).
        The parameters may be of shape (n,), too.
        """
        count, size = states.shape
        each = np.arange(size)
        moved = np.repeat(states[None].astype(complex), size, axis=0)
        moved[each, :, each] += 1j * SHIFT
        self.calls += size * count
        with np.errstate(all="ignore"):
            try:
                rates = self.motion.rates(list(np.moveaxis(moved, 2, 0)), self.parameters)
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
