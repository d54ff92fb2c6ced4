"""SciPy's integrators behind the seam."""

import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.integrate import BDF, DOP853, LSODA, RK45, Radau

from tippetop.integrators.base import NO_START, NO_STEP, NOT_FINITE, Array
from tippetop.integrators.rates import RightHandSide
from tippetop.integrators.sampling import Accepted, StepByStep

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
class SciPy(StepByStep):
    """One of SciPy's adaptive methods."""

    name: str
    """A key of `METHODS`."""
    tolerance: float
    """Relative tolerance per step."""
    absolute: float | None = None
    """Absolute tolerance per step; None for the same."""

    @property
    def degree(self) -> int:
        """Degree of the polynomials by which the solver interpolates."""
        return METHODS[self.name][1]

    def steps(
        self, rates: RightHandSide, start: tuple[float, Array], end: float
    ) -> Iterator[Accepted | str]:
        """Yield the steps; see `StepByStep`."""
        if not np.all(np.isfinite(rates(*start))):
            yield NO_START
            return
        solver = self._solver(rates, start, end)
        while solver.status == "running":
            before = float(solver.t), solver.y.copy()
            failure = _take_step(solver)
            reach = float(solver.t)
            if (
                not failure
                and reach - before[0] <= LEAST_STEP * max(1.0, abs(reach))
                and reach < end
            ):
                failure = NO_STEP
            if failure:
                yield failure
                return

            def advance(at: float, before: tuple[float, Array] = before) -> Array:
                return self._land(rates, before, at)

            yield Accepted(reach, solver.y.copy(), solver.dense_output(), advance)

    def _solver(self, rates: RightHandSide, start: tuple[float, Array], end: float) -> Any:
        absolute = self.tolerance if self.absolute is None else self.absolute
        return METHODS[self.name][0](
            rates, start[0], start[1], end, rtol=self.tolerance, atol=absolute
        )

    def _land(self, rates: RightHandSide, start: tuple[float, Array], end: float) -> Array:
        """Return the state after integrating afresh to exactly this time."""
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
        return str(message) if message else NO_STEP
    return None if np.all(np.isfinite(solver.y)) else NOT_FINITE
