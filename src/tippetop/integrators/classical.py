"""The classical Runge-Kutta method of fourth order with fixed step, as in the report's Appendix
B.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from tippetop.integrators.base import NOT_FINITE, Array
from tippetop.integrators.rates import RightHandSide
from tippetop.integrators.sampling import Accepted, StepByStep


@dataclass(frozen=True)
class ClassicalRK4(StepByStep):
    """Fourth-order Runge-Kutta: error h^5 in a step, h^4 in all."""

    step: float
    """Step size, in the units of time of the motion."""
    name: str = field(default="rk4", init=False)
    caution: ClassVar[str] = (
        "How far fixed steps are off is not known: compare a run of half the step."
    )
    degree: ClassVar[int] = 5
    """The polynomials' error is of higher order than the method's."""

    def steps(
        self, rates: RightHandSide, start: tuple[float, Array], end: float
    ) -> Iterator[Accepted | str]:
        """Yield the steps; see `StepByStep`."""
        time, state = start
        steps = max(1, int(np.ceil((end - start[0]) / self.step - 1e-9)))
        for count in range(1, steps + 1):
            reach = end if count == steps else start[0] + count * self.step

            def dense(at: float, before: float = time, base: Array = state) -> Array:
                return classical_step(rates, base, at - before)

            time, state = reach, dense(reach)
            if not np.all(np.isfinite(state)):
                yield NOT_FINITE
                return
            yield Accepted(time, state, dense, dense)


def classical_step(rates: RightHandSide, state: Array, step: float) -> Array:
    """Return the state after a step of the classical method, for a motion that does not depend on
    the time.
    """
    k1 = rates(0.0, state)
    k2 = rates(0.0, state + 0.5 * step * k1)
    k3 = rates(0.0, state + 0.5 * step * k2)
    k4 = rates(0.0, state + step * k3)
    return state + step / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
