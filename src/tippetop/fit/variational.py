"""Variational equations of a motion: how a solution moves with its start and its parameters."""

from collections.abc import Callable, Sequence
from functools import lru_cache
from operator import attrgetter
from typing import Any

import numpy as np

from tippetop.fit.dual import Dual, value_of
from tippetop.graph.derivatives import Tangent, derivatives
from tippetop.graph.graph import Node
from tippetop.integrators.base import Arc, Array, Integrator, Motion
from tippetop.integrators.dense import DenseSolution
from tippetop.mechanics.vectors import Scalar

TOGETHER = 4
"""Directions that one compiled motion has at most: more take longer to compile than to follow."""


@lru_cache(maxsize=64)
def variational_motion(motion: Motion, directions: int) -> Motion:
    """Return the equations of a motion and of its derivatives in several directions.

    Its numbers are those of the motion, then their derivatives, direction by direction, and so are
    its parameters. It is recorded by differentiating the graph of the motion's rates, and evaluated
    by dual numbers.
    """
    size, count = motion.size, motion.parameters

    def rates(y: Sequence[Scalar], p: Sequence[Scalar]) -> list[Scalar]:
        numbers = [*y[:size], *p[:count]]
        tangents = [tuple(y[size + i :: size]) for i in range(size)]
        tangents += [tuple(p[count + i :: count]) for i in range(count)]
        changes = recorded if isinstance(y[0], Node) else evaluated
        outputs, slopes = changes(numbers, tangents)
        return outputs + [slope[direction] for direction in range(directions) for slope in slopes]

    def recorded(numbers: list[Any], tangents: list[Tangent]) -> tuple[list[Any], list[Tangent]]:
        outputs = list(motion.rates(numbers[:size], numbers[size:]))
        places = [node.place for node in numbers]
        return outputs, derivatives(outputs, dict(zip(places, tangents, strict=True)))

    def evaluated(numbers: list[Any], tangents: list[Tangent]) -> tuple[list[Any], list[Tangent]]:
        instants = np.ones(np.shape(numbers[0]))
        duals = [
            Dual(number * instants, np.array([part * instants for part in tangent]))
            for number, tangent in zip(numbers, tangents, strict=True)
        ]
        outputs = list(motion.rates(duals[:size], duals[size:]))
        constant = np.zeros((directions, *instants.shape))
        slopes = [tuple(one.parts if isinstance(one, Dual) else constant) for one in outputs]
        return [value_of(one) for one in outputs], slopes

    every = 1 + directions
    return Motion(rates, size * every, count * every, (), motion.lasting, motion)


def followed(
    motion: Motion,
    parameters: Array,
    start: tuple[float, Array],
    end: float,
    integrator: Integrator,
    solution_of: Callable[[Arc], DenseSolution] = attrgetter("solution"),
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
    solution_of
        The solution of an arc, in steps that what is read off it needs.

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
        parts.append(solution_of(arc))
        last = arc.end_state
    if not np.all(np.isfinite(last)):
        return None
    solution = DenseSolution.joined(parts) if parts else DenseSolution.empty(time, len(last))
    return solution, last.reshape(numbers.shape)
