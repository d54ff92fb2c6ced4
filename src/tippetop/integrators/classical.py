"""The classical Runge-Kutta method of fourth order with fixed step, as in the report's Appendix B."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from tippetop.integrators.base import Arc, Array, Guard, Motion
from tippetop.integrators.sampling import RightHandSide, Samples, first_fall, polish


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
        self,
        motion: Motion,
        parameters: Sequence[float],
        start: tuple[float, Array],
        end: float,
        times: Array,
        guards: Sequence[Guard] = (),
    ) -> Arc:
        """Follow the motion; see `tippetop.integrators.base.Integrator`."""
        rates = RightHandSide(motion, parameters)

        def advance(state: Array, step: float) -> Array:
            return _step(rates, state, step)

        time, state = start
        samples = Samples(times, start)
        steps = max(1, int(np.ceil((end - start[0]) / self.step - 1e-9)))
        for count in range(1, steps + 1):
            reach = end if count == steps else start[0] + count * self.step
            before, base = time, state
            state = advance(base, reach - before)
            if not np.all(np.isfinite(state)):
                grid, states = samples.result(motion.size)
                failure = "the solution is no longer finite"
                return Arc(grid, states, before, base, None, failure, count - 1, rates.calls)

            def dense(at: float, before: float = before, base: Array = base) -> Array:
                return advance(base, at - before)

            if guards:
                fall = first_fall(guards, parameters, dense, dense, (before, reach))
                if fall is not None:
                    index, guess = fall
                    at, last = polish(guards[index], parameters, dense, (before, reach), guess)
                    samples.take(at, dense)
                    grid, states = samples.result(motion.size)
                    return Arc(grid, states, at, last, index, None, count, rates.calls)
            time = reach
            samples.take(time, dense)
        grid, states = samples.result(motion.size)
        return Arc(grid, states, time, state, None, None, steps, rates.calls)


def _step(rates: RightHandSide, state: Array, step: float) -> Array:
    """One step of the classical method, for a motion that does not depend on the time."""
    k1 = rates(0.0, state)
    k2 = rates(0.0, state + 0.5 * step * k1)
    k3 = rates(0.0, state + 0.5 * step * k2)
    k4 = rates(0.0, state + step * k3)
    return state + step / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
