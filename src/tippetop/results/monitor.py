"""What every motion keeps, and how far a run is off it: the same for one launch and for many."""

import numpy as np

from tippetop.contact.lowest_surface import lowest_jellett
from tippetop.contact.mode import Outcome
from tippetop.mechanics.invariants import energy
from tippetop.mechanics.state import State
from tippetop.mechanics.surfaces.hull import Hull, outer_height
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Scalar, length

LEAST_MOMENT = 1e-6
"""Size |L| h of Jellett's integral at launch, in natural units, below which its drift says nothing.
"""

WORST, ACCUMULATED = 1e-6, 1e4
"""How far, relatively, a run may be off what every motion keeps: this, or this many times its
tolerance.
"""

WAYS_TO_END = (
    Outcome.COMPLETED,
    Outcome.LIFTED_OFF,
    Outcome.AT_REST,
    Outcome.LYING_FLAT,
    Outcome.STOPPED,
)
"""Outcomes that tell what the motion came to, which is not known of a run that cannot be trusted;
the others say why it is not told.
"""


def kept(state: State, top: Top) -> tuple[Scalar, Scalar, Scalar, Scalar, Scalar]:
    """What `Monitor.see` sees of a state but the work: |n|, n_z, height, energy and Jellett's
    integral.
    """
    return (
        length(state.axis),
        state.axis[2],
        state.height,
        energy(state, top),
        lowest_jellett(state, top),
    )


class Monitor:
    """How far launches go off what they begin with, in natural units: one, or n with arrays for
    numbers.
    """

    def __init__(self, top: Top, start: State) -> None:
        self.top = top
        jellett = lowest_jellett(start, top)
        self._energy = energy(start, top)
        self._moment = length(start.momentum) * outer_height(top.surface, start.axis[2])
        self._imbalance, self._least, self._most = 0.0, jellett, jellett
        self._largest, self._off_unit, self._sunk = abs(self._energy), 0.0, 0.0

    # translate: skip
    @property
    def energy_error(self) -> Scalar:
        """Largest error so far of the balance of energy and work, relative to the energy."""
        return self._imbalance / abs(self._energy)

    @property
    def jellett_drift(self) -> Scalar:
        """Range so far of Jellett's integral, relative to |L| h at launch; nan where that is 0."""
        return (self._most - self._least) / np.where(self._moment > 0.0, self._moment, np.nan)

    @property
    def inaccuracy(self) -> Scalar:
        """How far, relatively, the run is off what every motion keeps: energy and work, |n|,
        lambda, gaps.

        No number if one of these is none.
        """
        telling = self._moment > LEAST_MOMENT
        drift = np.where(telling, self.jellett_drift, 0.0) if self.top.conserves_jellett else 0.0
        with np.errstate(invalid="ignore"):
            imbalance = self._imbalance / self._largest
        return np.maximum(np.maximum(imbalance, self._off_unit), np.maximum(drift, self._sunk))

    def is_trusted(self, tolerance: float) -> Scalar:
        """Whether that is little, for steps of a relative error: a truth value, or an array of
        them.
        """
        return self.inaccuracy <= max(WORST, ACCUMULATED * tolerance)

    def judged(self, outcome: Outcome, tolerance: float) -> Outcome:
        """How one launch ended: as its motion came to end only if it can be trusted."""
        return (
            Outcome.INACCURATE
            if outcome in WAYS_TO_END and not self.is_trusted(tolerance)
            else outcome
        )

    def concluded(self, outcome: Outcome, state: State, work: Scalar, tolerance: float) -> Outcome:
        """How one launch ended, by its last state, too, and all work since launch; see `judged`."""
        if outcome in WAYS_TO_END:
            self.see(*kept(state, self.top), work)
        return self.judged(outcome, tolerance)

    def see(
        self,
        size: Scalar,
        cosine: Scalar,
        height: Scalar,
        energy: Scalar,
        jellett: Scalar,
        work: Scalar,
    ) -> None:
        """See some instants: |n|, n_z, and of work all since launch.

        Numbers, or arrays of one shape whose first axis is that of the instants.
        """
        imbalance = np.max(np.abs(energy - self._energy - work), 0)
        self._imbalance = np.maximum(self._imbalance, imbalance)
        self._largest = np.maximum(self._largest, np.max(energy, 0))
        self._off_unit = np.maximum(self._off_unit, np.max(np.abs(size - 1.0), 0))
        self._least = np.minimum(self._least, np.min(jellett, 0))
        self._most = np.maximum(self._most, np.max(jellett, 0))
        if isinstance(self.top.surface, Hull):
            # The axis is a unit vector to rounding, and its cosine may be beyond 1.
            cosine = np.minimum(np.maximum(cosine, -1.0), 1.0)
            sunk = outer_height(self.top.surface, cosine) - height
            self._sunk = np.maximum(self._sunk, np.max(sunk, 0))
