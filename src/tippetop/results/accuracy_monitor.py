"""Monitoring of what every motion keeps, which tells whether a run can be trusted: conserved
quantities, gaps that are not negative, normal forces that press, friction within its bounds.
"""

import numpy as np

from tippetop.contact.lowest_surface import lowest_jellett
from tippetop.contact.mode import Status
from tippetop.mechanics.invariants import energy
from tippetop.mechanics.state import State
from tippetop.mechanics.surfaces.hull import lowest_gap, outer_height
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Scalar, length

LEAST_MOMENT = 1e-6
"""Least size |L| h of Jellett's integral at launch, natural units, for which its relative drift is
used: below it the drift is rounding.
"""

LARGEST_ERROR, ERROR_PER_TOLERANCE = 1e-6, 1e4
"""Largest error of what a motion keeps in a run that is trusted: the first, or the second times
the tolerance of the steps. Correct runs stay well below both, defects exceed them. Errors of
conserved quantities are relative; gaps are compared with the size, and forces with the weight or
the largest normal force.
"""

BREACHES = (
    ("The body sinks into the table by", "of its size"),
    ("A contact stays closed though the table would have to pull with", "of the weight"),
    ("What friction holds needs more than it can exert, by", "of N^2"),
    ("The energy differs from that at launch and the work of the table by", "of itself"),
    ("The axis is no unit vector: its length is off by", "of itself"),
    ("Jellett's integral, which the motion keeps, drifts by", "of itself"),
)
"""Sentences that name each of `Monitor.errors`, before and after its number: causes come first."""

NEGATIVE = -1e-12
"""Least of `tippetop.contact.readings.conditions`, in natural units, from which on it is rounding,
and which of them it is does not matter.
"""

STATUSES_OF_MOTION = (
    Status.COMPLETED,
    Status.LIFTED_OFF,
    Status.AT_REST,
    Status.STOPPED,
)
"""Statuses that describe the motion, which a run that cannot be trusted does not have; all others
say why a run failed.
"""


def monitored_quantities(state: State, top: Top) -> tuple[Scalar, Scalar, Scalar]:
    """Return |n|, the energy and Jellett's integral of a state."""
    return length(state.axis), energy(state, top), lowest_jellett(state, top)


class Monitor:
    """Monitor of one launch, or of n with arrays, in natural units.

    Parameters
    ----------
    top, start
        The top, and the state at launch.
    pulls
        Whether the table may pull.
    """

    def __init__(self, top: Top, start: State, pulls: bool = False) -> None:
        self.top, self.pulls = top, pulls
        jellett = lowest_jellett(start, top)
        self._energy = energy(start, top)
        self._moment = length(start.momentum) * outer_height(top.surface, start.axis[2])
        self._imbalance, self._least, self._most = 0.0, jellett, jellett
        self._largest, self._off_unit = abs(self._energy), 0.0
        self._sunk, self._pulled, self._overdrawn, self._heaviest = 0.0, 0.0, 0.0, 1.0

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
    def errors(self) -> tuple[Scalar, ...]:
        """Depth in the table, pull, and friction beyond its bounds, and errors of energy and work,
        |n| and Jellett's integral; nan if one is.
        """
        is_large = self._moment > LEAST_MOMENT
        drift = np.where(is_large, self.jellett_drift, 0.0) if self.top.conserves_jellett else 0.0
        with np.errstate(invalid="ignore"):
            imbalance = self._imbalance / self._largest
        pulled = self._pulled / self._heaviest
        overdrawn = self._overdrawn / self._heaviest**2
        return self._sunk, pulled, overdrawn, imbalance, self._off_unit, drift

    @property
    def inaccuracy(self) -> Scalar:
        """Largest of the errors; nan if one is."""
        first, *others = self.errors
        for error in others:
            first = np.maximum(first, error)
        return first

    def is_trusted(self, tolerance: float) -> Scalar:
        """Return whether the inaccuracy is small enough for steps of a relative tolerance."""
        return self.inaccuracy <= max(LARGEST_ERROR, ERROR_PER_TOLERANCE * tolerance)

    def is_breached(self, tolerance: float) -> Scalar:
        """Return whether the inaccuracy is a number that is too large for such steps."""
        return self.inaccuracy > max(LARGEST_ERROR, ERROR_PER_TOLERANCE * tolerance)

    def breach(self, tolerance: float) -> str:
        """Return a sentence that names the first thing that one launch did not keep, in the order
        of causes; empty if it kept all.
        """
        allowed = max(LARGEST_ERROR, ERROR_PER_TOLERANCE * tolerance)
        for error, (subject, predicate) in zip(self.errors, BREACHES, strict=True):
            if not error <= allowed:
                return f"{subject} {float(error):.2g} {predicate}."
        return ""

    def trusted_status(self, status: Status, tolerance: float) -> Status:
        """Return the status of one launch, or INACCURATE if its run cannot be trusted.

        Of a run that failed, numbers that are not finite are no breach: they may be why it failed.
        """
        is_broken = not self.is_trusted(tolerance)
        if status not in STATUSES_OF_MOTION:
            is_broken = self.is_breached(tolerance)
        return Status.INACCURATE if is_broken else status

    def final_status(self, status: Status, state: State, work: Scalar, tolerance: float) -> Status:
        """Return `trusted_status` after checking the last state with all work since launch."""
        if status in STATUSES_OF_MOTION:
            self.check(*monitored_quantities(state, self.top), work)
            self.check_gap(lowest_gap(state.axis, state.height, self.top.surface))
        return self.trusted_status(status, tolerance)

    def check(self, size: Scalar, energy: Scalar, jellett: Scalar, work: Scalar) -> None:
        """Update the largest errors of conserved quantities by those at some instants.

        `size` is |n|, and `work` all work since launch. All are numbers, or arrays of one shape
        whose first axis is that of the instants.
        """
        imbalance = np.max(np.abs(energy - self._energy - work), 0)
        self._imbalance = np.maximum(self._imbalance, imbalance)
        self._largest = np.maximum(self._largest, np.max(energy, 0))
        self._off_unit = np.maximum(self._off_unit, np.max(np.abs(size - 1.0), 0))
        self._least = np.minimum(self._least, np.min(jellett, 0))
        self._most = np.maximum(self._most, np.max(jellett, 0))

    def check_gap(self, gap: Scalar) -> None:
        """Update the greatest depth by the gaps of the lowest surface at some instants."""
        self._sunk = np.maximum(self._sunk, -np.min(gap, 0))

    def check_force(self, force: Scalar) -> None:
        """Update the greatest pull by the normal forces at some instants."""
        if not self.pulls:
            self._pulled = np.maximum(self._pulled, -np.min(force, 0))
        self._heaviest = np.maximum(self._heaviest, np.max(force, 0))

    def check_reserve(self, reserve: Scalar) -> None:
        """Update by how much friction is beyond its bounds, by its reserves at some instants."""
        self._overdrawn = np.maximum(self._overdrawn, -np.min(reserve, 0))
