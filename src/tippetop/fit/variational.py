"""Variational equations of a motion: how a solution moves with its start and its parameters."""

from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from tippetop.graph.derivatives import tangents
from tippetop.integrators.base import Array, Integrator, Motion
from tippetop.integrators.dense import DenseSolution
from tippetop.mechanics.vectors import Scalar

TOGETHER = 4
"""Directions that one compiled motion has at most: more take longer to compile than to follow."""


@lru_cache(maxsize=64)
def variational_motion(motion: Motion, directions: int) -> Motion:
    """Return the equations of a motion and of its derivatives in several directions.

    Its numbers are those of the motion, then their derivatives, direction by direction, and so are
    its parameters. The derivatives are those of the graph of the motion's rates, so that the
    equations can be recorded only.
    """
    size, count = motion.size, motion.parameters

    def rates(y: Sequence[Scalar], p: Sequence[Scalar]) -> list[Scalar]:
        outputs = list(motion.rates(y[:size], p[:count]))
        seeds = {
            numbers[i].place: tuple(
                [numbers[i + many * (1 + direction)] for direction in range(directions)]
            )
            for numbers, many in ((y, size), (p, count))
            for i in range(many)
        }
        derivatives = tangents(outputs, seeds)
        return outputs + [
            derivatives[i][direction] for direction in range(directions) for i in range(size)
        ]

    every = 1 + directions
    return Motion(rates, size * every, count * every, (), motion.lasting)


def followed(
    motion: Motion,
    parameters: Array,
    start: tuple[float, Array],
    end: float,
    integrator: Integrator,
) -> tuple[DenseSolution, Array] | None:
    """Follow a motion and its derivatives from a time to another; None where the integrator fails.

    Parameters
    ----------
    motion
        The motion; its guards are left aside.
    parameters
        Its parameters, and below them their derivatives, one direction a row.
    start
        Initial time, and the numbers with their derivatives in the same order.
    end
        Final time.
    integrator
        The method.

    Returns
    -------
    tuple
        The solution, with the derivatives after the numbers, and its last numbers, shape (1 +
        directions, size).
    """
    time, numbers = start
    equations = variational_motion(motion, len(numbers) - 1)
    parts, last = list[DenseSolution](), numbers.ravel()
    for arc in integrator.integrate(equations, parameters.ravel().tolist(), (time, last), end):
        if arc.failure is not None:
            return None
        parts.append(arc.solution)
        last = arc.end_state
    if not np.all(np.isfinite(last)):
        return None
    return DenseSolution.joined(parts), last.reshape(numbers.shape)
