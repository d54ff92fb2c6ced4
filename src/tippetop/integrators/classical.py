"""The classical Runge-Kutta method of fourth order with fixed step, as in the report's Appendix B."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from tippetop.integrators.base import NOT_FINITE, Arc, Array, Motion
from tippetop.integrators.rates import RightHandSide
from tippetop.integrators.sampling import Steps

DEGREE = 5
"""Degree of the polynomials that stand for its steps: their error is of higher order than the method's."""

MANY = 512
"""Steps in an arc."""


@dataclass(frozen=True)
class ClassicalRK4:
    """Fourth-order Runge-Kutta: error h^5 in a step, h^4 in all."""

    step: float
    """Step size, in the units of time of the motion."""
    name: str = field(default="rk4", init=False)

    def integrate(
        self, motion: Motion, parameters: Sequence[float], start: tuple[float, Array], end: float
    ) -> Iterator[Arc]:
        """Follow the motion; see `tippetop.integrators.base.Integrator`."""
        rates = RightHandSide(motion, parameters)
        time, state = start
        taken = Steps(rates, time, DEGREE)
        steps = max(1, int(np.ceil((end - start[0]) / self.step - 1e-9)))
        for count in range(1, steps + 1):
            reach = end if count == steps else start[0] + count * self.step
            before, base = time, state
            time, state = reach, classical_step(rates, base, reach - before)
            if not np.all(np.isfinite(state)):
                yield taken.arc(base, failure=NOT_FINITE)
                return

            def dense(at: float, before: float = before, base: Array = base) -> Array:
                return classical_step(rates, base, at - before)

            last = taken.take(reach, dense, dense)
            if last is not None:
                yield last
                return
            if len(taken) == MANY or count == steps:
                yield taken.arc(state)


def classical_step(rates: RightHandSide, state: Array, step: float) -> Array:
    """One step of the classical method, for a motion that does not depend on the time."""
    k1 = rates(0.0, state)
    k2 = rates(0.0, state + 0.5 * step * k1)
    k3 = rates(0.0, state + 0.5 * step * k2)
    k4 = rates(0.0, state + step * k3)
    return state + step / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
