"""The seam behind which every integrator stands: equations and guards in, an arc of the solution out."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol, TypeAlias

import numpy as np
from numpy.typing import NDArray

from tippetop.mechanics.vectors import Scalar

Array: TypeAlias = NDArray[np.float64]
Function: TypeAlias = Callable[[Sequence[Scalar], Sequence[Scalar]], Scalar]
"""A function of the state and the parameters, in plain operators."""


@dataclass(frozen=True)
class Motion:
    """Autonomous equations of motion y' = rates(y, parameters).

    Attributes
    ----------
    rates
        Time derivative of the state, in plain operators where a compiled integrator is to take it.
    size
        How many numbers the state has.
    parameters
        How many parameters there are.
    """

    rates: Callable[[Sequence[Scalar], Sequence[Scalar]], Sequence[Scalar]]
    size: int
    parameters: int


@dataclass(frozen=True)
class Guard:
    """A condition that ends the motion: the first time its value falls through zero from above.

    Attributes
    ----------
    name
        What has happened then.
    value
        A function of state and parameters, positive while the motion may go on.
    """

    name: str
    value: Function


@dataclass(frozen=True)
class Arc:
    """A piece of a solution.

    Attributes
    ----------
    times, states
        The sample times reached, shape (k,), and the states there, shape (k, size).
    end_time, end_state
        Where the arc ends, state of shape (size,).
    guard
        Index of the guard that ended it, or None when it reached the end asked for.
    failure
        Why the integrator gave up, or None.
    steps, evaluations
        Steps accepted, and evaluations of the right-hand side (for the Taylor method: expansions).
    """

    times: Array
    states: Array
    end_time: float
    end_state: Array
    guard: int | None = None
    failure: str | None = None
    steps: int = 0
    evaluations: int = 0


class Integrator(Protocol):
    """A way to follow equations of motion."""

    @property
    def name(self) -> str:
        """What users call it."""

    def integrate(
        self,
        motion: Motion,
        parameters: Sequence[float],
        start: tuple[float, Array],
        end: float,
        times: Array,
        guards: Sequence[Guard] = (),
    ) -> Arc:
        """Follow the motion until a guard falls through zero or the end is reached.

        Parameters
        ----------
        motion, parameters
            The equations and the numbers in them.
        start
            Initial time and state, shape (size,).
        end
            Final time, after the initial one.
        times
            Increasing sample times from the initial to the final time, shape (k,).
        guards
            Conditions that end the motion, positive at the start; located to the integrator's tolerance.
        """
