"""SciPy's integrators behind the seam."""

import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.integrate import BDF, DOP853, LSODA, RK45, Radau

from tippetop.integrators.base import NOT_FINITE, Arc, Array, Motion
from tippetop.integrators.rates import RightHandSide
from tippetop.integrators.sampling import Steps
from tippetop.integrators.stepping import MANY

METHODS: dict[str, tuple[Any, int]] = {
    "dop853": (DOP853, 7),
    "rk45": (RK45, 4),
    "radau": (Radau, 3),
    "bdf": (BDF, 5),
    "lsoda": (LSODA, 12),
}
"""The solvers, and the degrees of the polynomials by which they interpolate."""

LEAST_STEP = 1e-15
"""A step shorter than this part of the time gets nowhere."""


@dataclass(frozen=True)
class SciPy:
    """One of SciPy's adaptive methods."""

    name: str
    """A key of `METHODS`."""
    tolerance: float
    """Relative tolerance per step."""
    absolute: float | None = None
    """Absolute tolerance per step; None for the same."""

    def integrate(
        self, motion: Motion, parameters: Sequence[float], start: tuple[float, Array], end: float
    ) -> Iterator[Arc]:
        """Follow the motion; see `tippetop.integrators.base.Integrator`."""
        rates = RightHandSide(motion, parameters)
        steps = Steps(rates, start[0], METHODS[self.name][1])
        if not np.all(np.isfinite(rates(*start))):
            yield steps.arc(start[1], failure="the motion is singular from the start")
            return
        solver, failure = self._solver(rates, start, end), None
        while solver.status == "running":
            before, base = float(solver.t), solver.y.copy()
            failure = _take_step(solver)
            if failure is not None:
                break
            reach = float(solver.t)
            if reach - before <= LEAST_STEP * max(1.0, abs(reach)) and reach < end:
                failure = "the step size fell to nothing"
                break

            def advance(at: float, before: float = before, base: Array = base) -> Array:
                return self._land(rates, (before, base), at)

            last = steps.take(reach, solver.dense_output(), advance)
            if last is not None:
                yield last
                return
            if len(steps) == MANY:
                yield steps.arc(solver.y.copy())
        if len(steps) or failure is not None:
            yield steps.arc(base if failure is not None else solver.y.copy(), failure=failure)

    def _solver(self, rates: RightHandSide, start: tuple[float, Array], end: float) -> Any:
        absolute = self.tolerance if self.absolute is None else self.absolute
        return METHODS[self.name][0](rates, start[0], start[1], end, rtol=self.tolerance, atol=absolute)

    def _land(self, rates: RightHandSide, start: tuple[float, Array], end: float) -> Array:
        """The state after integrating afresh to exactly this time."""
        if end <= start[0]:
            return start[1]
        solver = self._solver(rates, start, end)
        while solver.status == "running":
            if _take_step(solver) is not None:
                break
        return np.array(solver.y)


def _take_step(solver: Any) -> str | None:
    """Take a step; say why there was none."""
    with warnings.catch_warnings():
        # LSODA reports trouble as a warning, and overflow on the way to it is no news.
        warnings.simplefilter("ignore")
        try:
            message = solver.step()
        except (ValueError, OverflowError, ZeroDivisionError, np.linalg.LinAlgError):
            return NOT_FINITE
    if solver.status == "failed":
        return str(message) if message else "the step size fell to nothing"
    return None if np.all(np.isfinite(solver.y)) else NOT_FINITE
