"""What every motion keeps, and how far a run is off it."""

import numpy as np

from tippetop.lowest import lowest_jellett
from tippetop.mechanics.hull import Hull, outer_height
from tippetop.mechanics.invariants import energy
from tippetop.mechanics.state import State
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Scalar, length

LEAST_MOMENT = 1e-6
"""Size |L| h of Jellett's integral at launch, in natural units, below which its drift says nothing."""

WORST, ACCUMULATED = 1e-6, 1e4
"""How far, relatively, a run may be off what every motion keeps: this, or this many times its tolerance."""


class Monitor:
    """How far a launch of a top goes off what it begins with, in natural units."""

    def __init__(self, top: Top, start: State) -> None:
        self.top = top
        jellett = float(lowest_jellett(start, top))
        self._energy = float(energy(start, top))
        self._moment = float(length(start.momentum) * outer_height(top.surface, start.axis[2]))
        self._imbalance, self._least, self._most = 0.0, jellett, jellett
        self._largest, self._off_unit, self._sunk = abs(self._energy), 0.0, 0.0

    @property
    def energy_error(self) -> float:
        """Largest error so far of the balance of energy and work, relative to the energy."""
        return self._imbalance / abs(self._energy)

    @property
    def jellett_drift(self) -> float:
        """Range so far of Jellett's integral, relative to |L| h at launch; nan where that is 0."""
        return (self._most - self._least) / self._moment if self._moment else float(np.nan)

    @property
    def inaccuracy(self) -> float:
        """How far, relatively, the run is off what every motion keeps: energy and work, |n|, lambda, gaps.

        No number if one of these is none.
        """
        drift = self.jellett_drift if self.top.conserves_jellett and self._moment > LEAST_MOMENT else 0.0
        return _worse(_worse(self._imbalance / self._largest, self._off_unit), _worse(drift, self._sunk))

    def is_trusted(self, tolerance: float) -> bool:
        """Whether that is little, for steps of a relative error."""
        return self.inaccuracy <= max(WORST, ACCUMULATED * tolerance)

    def see(
        self, size: Scalar, cosine: Scalar, height: Scalar, energy: Scalar, jellett: Scalar, work: Scalar
    ) -> None:
        """See some instants, numbers or arrays of one shape: |n|, n_z, and of work all since launch."""
        self._imbalance = _worse(self._imbalance, float(np.max(np.abs(energy - self._energy - work))))
        self._largest = _worse(self._largest, float(np.max(energy)))
        self._off_unit = _worse(self._off_unit, float(np.max(np.abs(size - 1.0))))
        self._least = min(self._least, float(np.min(jellett)))
        self._most = _worse(self._most, float(np.max(jellett)))
        if isinstance(self.top.surface, Hull):
            sunk = outer_height(self.top.surface, cosine) - height
            self._sunk = _worse(self._sunk, float(np.max(sunk)))


def _worse(one: float, other: float) -> float:
    """The larger of two; no number if one is none, which `max` would pass over."""
    return one if one >= other or one != one else other
