"""An implicit method that relieves an explicit one where the motion is stiff.

Where friction damps slip much faster than the top moves, slip follows the motion, and an explicit
method still takes steps as short as the damping: 7,500,000 of them for 2 s with mu = 1e6 s/m, where
an implicit method needs two hundred. So after as many steps as there are in a full arc of Taylor's
method it is looked whether they are long beside the fastest damping; if so, the implicit method
goes on while its steps are much longer.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from tippetop.integrators.base import TOLERANCES, Arc, Array, Integrator, Motion
from tippetop.integrators.rates import RightHandSide
from tippetop.integrators.taylor import STEPS_PER_ARC
from tippetop.mechanics.vectors import Scalar

STIFF = 3.0
"""Step times fastest damping from which a motion is stiff: what is damped is then gone within a
step, and a series of order 20 is as short as that only because of it.
"""

LONGER = 100.0
"""How much longer the steps of the implicit method must be: each costs as much as so many explicit
ones.
"""


@dataclass(frozen=True)
class Relieved:
    """An explicit method, and `Collocation` where the motion is stiff."""

    explicit: Integrator
    """The method that follows the motion elsewhere."""

    @property
    def name(self) -> str:
        """What users call it."""
        return self.explicit.name

    @property
    def caution(self) -> str:
        """What is to be said of a run, however it ended."""
        return self.explicit.caution

    @property
    def tolerance(self) -> float:
        """Relative error per step where the motion is not stiff."""
        return float(getattr(self.explicit, "tolerance", 0.0))

    def _implicit(self, shortest: float) -> Integrator:
        """Return the method for stiff motions."""
        # Slow to import, and seldom needed.
        from tippetop.integrators.collocation import Collocation  # noqa: PLC0415

        return Collocation(max(self.tolerance, TOLERANCES["collocation"]), shortest)

    def integrate(
        self, motion: Motion, parameters: Sequence[float], start: tuple[float, Array], end: float
    ) -> Iterator[Arc]:
        """Follow the motion; see `tippetop.integrators.base.Integrator`."""
        step = 0.0
        while start[0] < end:
            checked, steps = start[0], 0
            for arc in self.explicit.integrate(motion, parameters, start, end):
                yield arc
                start, steps = (arc.solution.end, arc.end_state), steps + arc.steps
                if arc.guard is not None or arc.failure is not None or start[0] >= end:
                    return
                if steps >= STEPS_PER_ARC:
                    step, checked, steps = (start[0] - checked) / steps, start[0], 0
                    if is_stiff(motion, parameters, start[1][None], np.array([step]))[0]:
                        break
            else:
                return
            implicit = self._implicit(LONGER * step)
            for arc in implicit.integrate(motion, parameters, start, end):
                start = arc.solution.end, arc.end_state
                if arc.steps:
                    yield replace(arc, failure=None, method=implicit)
                if arc.guard is not None:
                    return


def is_stiff(
    motion: Motion, parameters: Sequence[Scalar], states: Array, steps: Array
) -> NDArray[np.bool_]:
    """Return whether a motion is stiff in states, shape (n, size), about which it took steps, shape
    (n,).
    """
    stiff: NDArray[np.bool_] = steps * fastest_damping(motion, parameters, states) > STIFF
    return stiff


def fastest_damping(motion: Motion, parameters: Sequence[Scalar], states: Array) -> Array:
    """Return the largest rate at which a motion damps a disturbance of states, shape (n, size):
    negative where every one grows, and 0 where its derivatives are not finite.
    """
    slopes = RightHandSide(motion, parameters).linearized(states)[1]
    finite = np.all(np.isfinite(slopes), axis=(1, 2))
    damping: Array = -np.linalg.eigvals(np.where(finite[:, None, None], slopes, 0.0)).real.min(
        axis=1
    )
    return damping
