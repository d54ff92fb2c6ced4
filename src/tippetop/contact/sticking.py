"""The contact sticks: the top rolls without slipping, or is held altogether."""

from dataclasses import dataclass
from typing import ClassVar

from tippetop.contact.closed import LIMIT_BRANCH, SLIP, ClosedMode, GuardValue
from tippetop.mechanics.branches import has_limit_branches, limit_guard
from tippetop.mechanics.rolling import slip_reserve


@dataclass(frozen=True)
class Sticking(ClosedMode):
    """Rolling without slipping, and without drilling where the law resists that."""

    name: ClassVar[str] = "sticking"
    size: ClassVar[int] = 6
    sticks: ClassVar[bool] = True

    def guard_values(self) -> list[GuardValue]:
        """The guards of what holds the contact, too."""
        own: list[GuardValue] = [(SLIP, lambda mode, y: slip_reserve(mode.top, mode.found(y)[2]))]
        if has_limit_branches(self.top.friction):
            own.append((LIMIT_BRANCH, lambda mode, y: limit_guard(mode.top, mode.found(y)[2])))
        return own + super().guard_values()


@dataclass(frozen=True)
class StickingWithoutRolling(Sticking):
    """Neither slip nor rolling: the top turns about the vertical, or not at all."""

    name: ClassVar[str] = "sticking_without_rolling"
    held: ClassVar[bool] = True
