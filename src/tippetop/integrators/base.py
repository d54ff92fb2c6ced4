"""The seam behind which every integrator stands: equations and guards in, arcs of the solution
out.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Protocol, TypeAlias

import numpy as np
from numpy.typing import NDArray

from tippetop.integrators.dense import DenseSolution
from tippetop.mechanics.vectors import Scalar
from tippetop.support.errors import InvalidInput, is_number

Array: TypeAlias = NDArray[np.float64]
Function: TypeAlias = Callable[[Sequence[Scalar], Sequence[Scalar]], Scalar]
"""A function of the state and the parameters, in plain operators."""

Rows: TypeAlias = Callable[[Sequence[Scalar], Sequence[Scalar]], Sequence[Scalar]]
"""Several of them."""

TOLERANCES = {
    "taylor": 2.0**-52,
    "collocation": 1e-13,
    "dop853": 1e-12,
    "rk45": 1e-10,
    "radau": 1e-9,
    "bdf": 1e-9,
    "lsoda": 1e-11,
}
"""The integrators that choose their steps, and the relative error per step of each where nobody
says.
"""

LEAST_TOLERANCE = 2.3e-14
"""Below this no solver but Taylor's honours a relative tolerance."""

NOT_FINITE = "the solution is no longer finite"
"""Why an integrator gives up where numbers grow beyond all bounds: its last state then means
nothing.
"""

NO_START, NO_STEP = "the motion is singular from the start", "the step size fell to nothing"
"""Why it finds no step at all, and none any more."""


@dataclass(frozen=True)
class Guard:
    """A condition that ends a motion: the first time its value falls through zero from above.

    It may start at zero, or below by rounding, and rise: however soon it falls again, that ends the
    motion.
    """

    name: str
    """What has happened then."""
    value: Function
    """A function of state and parameters, positive while the motion may go on."""

    # translate: skip
    def with_parameters(self, parameters: Sequence[Scalar]) -> Callable[[Array], float]:
        """Return the value as a function of the state alone."""
        return lambda state: float(self.value(state.tolist(), parameters))


@dataclass(frozen=True)
class Motion:
    """Autonomous equations of motion y' = rates(y, parameters), and what ends them."""

    rates: Rows
    """Time derivative of the state, in plain operators where a compiled integrator is to take it.
    """
    size: int
    """How many numbers the state has."""
    parameters: int
    """How many parameters there are."""
    guards: tuple[Guard, ...] = ()
    """Conditions that end the motion."""
    lasting: bool = True
    """Whether runs may spend most of their steps in it: worth compiling for speed."""
    varied: "Motion | None" = None
    """The motion whose variational equations these are: its numbers come first, and then their
    derivatives, direction by direction.
    """


@dataclass(frozen=True)
class Arc:
    """A piece of a solution."""

    solution: DenseSolution
    """The state as a function of time, from the start of the arc to its end."""
    end_state: Array
    """The state at its end, shape (size,)."""
    guard: str | None = None
    """Name of the guard that ended the motion there, or None."""
    failure: str | None = None
    """Why the integrator gave up there, or None."""
    steps: int = 0
    evaluations: int = 0
    """Steps accepted, and evaluations of the right-hand side (for the Taylor method: expansions).
    """
    method: "Integrator | None" = None
    """Who took them, if it is not the integrator that was asked."""


class Integrator(Protocol):
    """A way to follow equations of motion."""

    @property
    def name(self) -> str:
        """What users call it."""

    @property
    def caution(self) -> str:
        """What is to be said of a run, however it ended; nothing where errors are held in every
        step.
        """

    def integrate(
        self, motion: Motion, parameters: Sequence[float], start: tuple[float, Array], end: float
    ) -> Iterator[Arc]:
        """Follow the motion until a guard falls through zero or the end is reached.

        Parameters
        ----------
        motion, parameters
            The equations and guards, which are positive at the start, and the numbers in them.
        start
            Initial time and state, shape (size,).
        end
            Final time, after the initial one.

        Yields
        ------
        Arc
            Arcs that join, none longer than fits in memory; the last reaches the end, or names the
            guard that ended the motion, located to the integrator's tolerance, or says why there is
            no more.
        """


def require_tolerance(tolerance: Any, name: str) -> None:
    """Refuse, with `InvalidInput`, a relative error per step that the integrator of a name cannot
    keep to.
    """
    least = TOLERANCES["taylor"] if name == "taylor" else LEAST_TOLERANCE
    if not (is_number(tolerance) and least <= tolerance < 1):
        accepted = f"a number at least {least:.2g} and less than 1 with {name}"
        raise InvalidInput("tolerance", tolerance, accepted)
