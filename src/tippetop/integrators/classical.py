"""The classical Runge-Kutta method of fourth order with fixed step, as in the report's Appendix B."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from tippetop.integrators.base import NOT_FINITE, Arc, Array, Motion
from tippetop.integrators.sampling import RightHandSide, Steps, first_fall, polish

DEGREE = 5
"""Degree of the polynomials that stand for its steps: their error is of higher order than the method's."""

MANY = 512
"""Steps in an arc."""


@dataclass(frozen=True)
class ClassicalRK4:
    """Fourth-order Runge-Kutta: error h^5 in a step, h^4 in all.

    Attributes
    ----------
    step
        Step size, in the units of time of the motion.
    """

    step: float
    name: str = field(default="rk4", init=False)

    def integrate(
        self, motion: Motion, parameters: Sequence[float], start: tuple[float, Array], end: float
    ) -> Iterator[Arc]:
        """Follow the motion; see `tippetop.integrators.base.Integrator`."""
        rates = RightHandSide(motion, parameters)
        time, state = start
        taken, counted = Steps(time, motion.size, DEGREE), 0
        steps = max(1, int(np.ceil((end - start[0]) / self.step - 1e-9)))
        for count in range(1, steps + 1):
            reach = end if count == steps else start[0] + count * self.step
            before, base = time, state
            time, state = reach, classical_step(rates, base, reach - before)
            if not np.all(np.isfinite(state)):
                failure = NOT_FINITE
                yield Arc(taken.solution(), base, None, failure, len(taken), rates.calls - counted)
                return

            def dense(at: float, before: float = before, base: Array = base) -> Array:
                return classical_step(rates, base, at - before)

            fall = first_fall(motion.guards, parameters, dense, dense, (before, reach))
            if fall is not None:
                guard = motion.guards[fall[0]]
                at, last = polish(guard, parameters, dense, (before, reach), fall[1])
                taken.take(at, dense)
                yield Arc(taken.solution(), last, guard.name, None, len(taken), rates.calls - counted)
                return
            taken.take(reach, dense)
            if len(taken) == MANY or count == steps:
                yield Arc(taken.solution(), state, None, None, len(taken), rates.calls - counted)
                taken, counted = Steps(reach, motion.size, DEGREE), rates.calls


def classical_step(rates: RightHandSide, state: Array, step: float) -> Array:
    """One step of the classical method, for a motion that does not depend on the time."""
    k1 = rates(0.0, state)
    k2 = rates(0.0, state + 0.5 * step * k1)
    k3 = rates(0.0, state + 0.5 * step * k2)
    k4 = rates(0.0, state + step * k3)
    return state + step / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
