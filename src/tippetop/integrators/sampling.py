"""What the step-by-step integrators share: steps as polynomials."""

import numpy as np

from tippetop.integrators.base import Arc, Array
from tippetop.integrators.dense import DenseSolution, chebyshev
from tippetop.integrators.falls import Dense, first_fall
from tippetop.integrators.rates import RightHandSide


class Steps:
    """Collects the steps of an arc, each by the values of its solution at Chebyshev's points.

    Parameters
    ----------
    rates
        The rates of the motion.
    start
        Time at which the arc begins.
    degree
        Of the polynomials that are to stand for the solution.
    """

    def __init__(self, rates: RightHandSide, start: float, degree: int) -> None:
        self.rates, self.degree = rates, degree
        self.knots, self.values, self._counted = [start], list[Array](), rates.calls

    def __len__(self) -> int:
        return len(self.values)

    def take(self, end: float, dense: Dense, advance: Dense) -> Arc | None:
        """Take in a step up to a time, or the last arc if a guard falls through zero in it.

        Parameters
        ----------
        end
            Where the step ends.
        dense, advance
            The solution within it; see `first_fall`.
        """
        motion, parameters, step = self.rates.motion, self.rates.parameters, (self.knots[-1], end)
        fall = first_fall(motion.guards, parameters, dense, advance, step)
        if fall is None:
            self._keep(end, dense)
            return None
        number, at, last = fall
        self._keep(at, dense)
        return self.arc(last, motion.guards[number].name)

    def _keep(self, end: float, dense: Dense) -> None:
        start = self.knots[-1]
        places = chebyshev(self.degree)[0]
        self.values.append(np.array([dense(start + place * (end - start)) for place in places.tolist()]))
        self.knots.append(end)

    def arc(self, state: Array, guard: str | None = None, failure: str | None = None) -> Arc:
        """The steps as an arc that ends in a state; the next begins there."""
        values = np.array(self.values).reshape(-1, self.rates.motion.size)
        solution = DenseSolution.fitted(lambda _: values.T, np.array(self.knots), self.degree)
        arc = Arc(solution, state, guard, failure, len(self), self.rates.calls - self._counted)
        self.knots, self.values, self._counted = [self.knots[-1]], [], self.rates.calls
        return arc
