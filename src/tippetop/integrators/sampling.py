"""What the step-by-step integrators share: arcs of their steps, as polynomials, up to where a guard
falls.
"""

from abc import ABC, abstractmethod
from collections.abc import Iterator, Sequence
from typing import ClassVar, NamedTuple

import numpy as np

from tippetop.integrators.base import Arc, Array, Motion
from tippetop.integrators.dense import DenseSolution, chebyshev
from tippetop.integrators.guard_functions import guard_functions
from tippetop.integrators.rates import RightHandSide
from tippetop.integrators.zero_crossings import Dense, first_fall

ARC_STEPS = 512
"""Steps in an arc."""


class Accepted(NamedTuple):
    """A step that was taken: when it ends, the state there, and the solution within it (see
    `first_fall`).
    """

    end: float
    end_state: Array
    dense: Dense
    advance: Dense


class StepByStep(ABC):
    """An integrator that takes its steps in Python."""

    caution: ClassVar[str] = ""

    @property
    @abstractmethod
    def degree(self) -> int:
        """Degree of the polynomials that stand for a step."""

    @abstractmethod
    def steps(
        self, rates: RightHandSide, start: tuple[float, Array], end: float
    ) -> Iterator[Accepted | str]:
        """Steps that follow one another to the end, or at last why there are no more."""

    def integrate(
        self, motion: Motion, parameters: Sequence[float], start: tuple[float, Array], end: float
    ) -> Iterator[Arc]:
        """Follow the motion; see `tippetop.integrators.base.Integrator`."""
        rates, places = RightHandSide(motion, parameters), chebyshev(self.degree)[0].tolist()
        (begin, state), counted = start, 0
        knots, values = [begin], list[Array]()
        guards = guard_functions(motion, parameters)

        def keep(until: float, dense: Dense) -> None:
            values.append(
                np.array([dense(knots[-1] + place * (until - knots[-1])) for place in places])
            )
            knots.append(until)

        def arc(end_state: Array, guard: str | None = None, failure: str | None = None) -> Arc:
            nonlocal counted
            rows = np.array(values).reshape(-1, motion.size).T
            solution = DenseSolution.fitted(lambda _: rows, np.array(knots), self.degree)
            ended = Arc(solution, end_state, guard, failure, len(values), rates.calls - counted)
            del knots[:-1], values[:]
            counted = rates.calls
            return ended

        for step in self.steps(rates, start, end):
            if isinstance(step, str):
                yield arc(state, failure=step)
                return
            dense = between(step, (knots[-1], state))
            fall = first_fall(guards, dense, step.advance, (knots[-1], step.end))
            if fall is not None:
                number, at, last = fall
                keep(at, step.dense)
                yield arc(last, motion.guards[number].name)
                return
            keep(step.end, step.dense)
            state = step.end_state
            if len(values) == ARC_STEPS:
                yield arc(state)
        if values:
            yield arc(state)


def between(step: Accepted, start: tuple[float, Array]) -> Dense:
    """Return the solution within a step, with the states themselves at both ends.

    What interpolates there may differ from them, so that a guard would change its sign from one
    step to the next and fall in none.
    """

    def dense(time: float) -> Array:
        if time <= start[0]:
            return start[1]
        return step.end_state if time >= step.end else step.dense(time)

    return dense
