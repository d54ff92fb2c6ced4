"""Monitoring of conserved quantities, which tells whether a run can be trusted."""

import numpy as np

from tippetop.contact.lowest_surface import lowest_jellett
from tippetop.contact.mode import Outcome
from tippetop.mechanics.invariants import energy
from tippetop.mechanics.state import State
from tippetop.mechanics.surfaces.hull import Hull, outer_height
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Scalar, length

LEAST_MOMENT = 1e-6
"""Least size |L| h of Jellett's integral at launch, natural units, for which its relative drift is
used: below it the drift is rounding.
"""

LARGEST_ERROR, ERROR_PER_TOLERANCE = 1e-6, 1e4
"""Largest relative error of conserved quantities in a run that is trusted: the first, or the second
times the tolerance of the steps. Correct runs stay well below both, defects exceed them.
"""

OUTCOMES_OF_MOTION = (
    Outcome.COMPLETED,
    Outcome.LIFTED_OFF,
    Outcome.AT_REST,
    Outcome.LYING_FLAT,
    Outcome.STOPPED,
)
"""Outcomes that describe the motion, which a run that cannot be trusted does not have; all others
say why a run failed.
"""


def monitored_quantities(state: State, top: Top) -> tuple[Scalar, Scalar, Scalar, Scalar, Scalar]:
    """Return |n|, n_z, the height, the energy and Jellett's integral of a state."""
    return (
        length(state.axis),
        state.axis[2],
        state.height,
        energy(state, top),
        lowest_jellett(state, top),
    )


class Monitor:
    """Monitor of conserved quantities of one launch, or of n with arrays, in natural units."""

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
        """Largest relative error of energy and work, |n|, lambda and penetration; nan if one is."""
        is_large = self._moment > LEAST_MOMENT
        drift = np.where(is_large, self.jellett_drift, 0.0) if self.top.conserves_jellett else 0.0
        with np.errstate(invalid="ignore"):
            imbalance = self._imbalance / self._largest
        return np.maximum(np.maximum(imbalance, self._off_unit), np.maximum(drift, self._sunk))

    def is_trusted(self, tolerance: float) -> Scalar:
        """Return whether the inaccuracy is small enough for steps of a relative tolerance."""
        return self.inaccuracy <= max(LARGEST_ERROR, ERROR_PER_TOLERANCE * tolerance)

    def trusted_outcome(self, outcome: Outcome, tolerance: float) -> Outcome:
        """Return the outcome of one launch, or INACCURATE if its run cannot be trusted."""
        return (
            Outcome.INACCURATE
            if outcome in OUTCOMES_OF_MOTION and not self.is_trusted(tolerance)
            else outcome
        )

    def final_outcome(
        self, outcome: Outcome, state: State, work: Scalar, tolerance: float
    ) -> Outcome:
        """Return `trusted_outcome` after checking the last state with all work since launch."""
        if outcome in OUTCOMES_OF_MOTION:
            self.check(*monitored_quantities(state, self.top), work)
        return self.trusted_outcome(outcome, tolerance)

    def check(
        self,
        size: Scalar,
        cosine: Scalar,
        height: Scalar,
        energy: Scalar,
        jellett: Scalar,
        work: Scalar,
    ) -> None:
        """Update the largest errors by the quantities at some instants.

        `size` is |n|, `cosine` n_z, and `work` all work since launch. All are numbers, or arrays
        of one shape whose first axis is that of the instants.
        """
        imbalance = np.max(np.abs(energy - self._energy - work), 0)
        self._imbalance = np.maximum(self._imbalance, imbalance)
        self._largest = np.maximum(self._largest, np.max(energy, 0))
        self._off_unit = np.maximum(self._off_unit, np.max(np.abs(size - 1.0), 0))
        self._least = np.minimum(self._least, np.min(jellett, 0))
        self._most = np.maximum(self._most, np.max(jellett, 0))
        if isinstance(self.top.surface, Hull):
            # The axis is a unit vector only to rounding, so that |n_z| may exceed 1.
            cosine = np.minimum(np.maximum(cosine, -1.0), 1.0)
            sunk = outer_height(self.top.surface, cosine) - height
            self._sunk = np.maximum(self._sunk, np.max(sunk, 0))
