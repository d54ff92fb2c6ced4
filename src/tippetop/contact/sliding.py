"""The top touches the table and slides, rolling or not."""

from dataclasses import dataclass
from typing import Any, ClassVar

from tippetop.contact.closed import BRANCH, LIFT_OFF, STOPPING, ClosedMode, GuardValue, motion_of
from tippetop.integrators.base import Motion
from tippetop.mechanics.contacts.contact_point import flat
from tippetop.mechanics.motion import sliding_rates
from tippetop.mechanics.rolling import is_set_valued, slip_length
from tippetop.mechanics.state import SlidingState
from tippetop.mechanics.stick_slip import (
    branch_guard,
    nearing_guard,
    parting_guard,
    remaining,
    rolling_stopping_guard,
    slip_of,
    slip_part,
)
from tippetop.mechanics.top import Kind
from tippetop.mechanics.vectors import Row, Scalar

NEARING, PARTING = "nearing", "parting"


@dataclass(frozen=True)
class SlidingMode(ClosedMode):
    """Sliding, as long as the normal force is positive or the table may pull, and slip does not
    end.
    """

    near: bool = False
    """Whether slip is so small that it may be about to end, which then is guarded."""
    pulls: bool = False
    """Whether the table may pull; else the mode ends where it would have to."""

    def guard_values(self) -> list[GuardValue]:
        """The guards of lift-off, of slip that ends, and of the branch of the law, too."""
        law, own = self.top.friction, list[GuardValue]()
        if not self.pulls:
            own.append((LIFT_OFF, lambda mode, y: mode.found(y)[2].force[2]))
        if is_set_valued(law) and self.near:
            own.append((STOPPING, lambda mode, y: mode.slip_left(y)))
            own.append((PARTING, lambda mode, y: parting_guard(SlidingState.unpack(y), mode.top)))
        elif is_set_valued(law):
            own.append((NEARING, lambda mode, y: nearing_guard(SlidingState.unpack(y), mode.top)))
        if hasattr(law, "branch_guard"):
            own.append((BRANCH, lambda mode, y: mode.on_branch(y)))
        return own + super().guard_values()

    def on_branch(self, y: Row) -> Scalar:
        """Positive as long as the branch of the law holds."""
        return branch_guard(slip_of(*SlidingState.unpack(y), self.top), self.top)

    def slip_left(self, y: Row) -> Scalar:
        """Positive while slip goes on for a while."""
        change = slip_part(flat(self.found(y)[3]), slip_length(self.top.friction))
        return remaining(slip_of(*SlidingState.unpack(y), self.top), change)


@dataclass(frozen=True)
class SlidingWithoutRolling(SlidingMode):
    """Sliding while rolling resistance holds the top: it turns about the vertical, or not at
    all.
    """

    name: ClassVar[str] = "sliding_without_rolling"
    held: ClassVar[bool] = True


@dataclass(frozen=True)
class Sliding(SlidingMode):
    """Sliding while rolling goes on, or is not resisted."""

    name: ClassVar[str] = "sliding"

    @property
    def lasting(self) -> bool:
        """A run may slide all along, but is not about to stick for long."""
        return not self.near

    def rates(self, y: Row) -> tuple[Scalar, ...]:
        """Time derivatives of the 8 numbers of a sliding state, in the fewest operations."""
        return sliding_rates(SlidingState.unpack(y), self.top).pack()

    def rolling_left(self, y: Row) -> Scalar:
        """Positive while rolling goes on for a while."""
        return rolling_stopping_guard(
            SlidingState.unpack(y), SlidingState.unpack(self.rates(y)), self.top
        )


def sliding_motion(kind: Kind, guarded: bool, held: bool = False) -> Motion:
    """Equations of motion of a sliding top of this kind, whose rolling may be held.

    If `guarded`, the first guard is of lift-off. Where slip can end, another tells whether it may
    be soon.
    """
    nothing: Any = None
    form = (SlidingWithoutRolling if held else Sliding)(nothing, False, not guarded)
    return motion_of(form, (kind,))
