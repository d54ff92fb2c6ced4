"""Dry friction in an impact: slip, sticking, drilling and rolling with the normal impulse as time.

While the normal impulse p grows, slip zeta (see `stick_slip`) changes by d zeta / dp = A(e), which depends on
its direction e alone, as the configuration is fixed. Slip that ends stays ended if the limit surface admits
the impulse that keeps it so; else it goes on along a direction with A = R e, R > 0, which then is constant:
as in contact (see `beginning`), with unit normal impulses for forces that weight calls for.
"""

import math
from typing import NamedTuple

from tippetop.mechanics.beginning import settling
from tippetop.mechanics.impulse import FUZZ, Impulse, Striking
from tippetop.mechanics.motion import along_table
from tippetop.mechanics.rolling import (
    Acceleration,
    ContactPoint,
    Slip,
    Wrench,
    is_set_valued,
    slip_length,
    struck_wrench,
)
from tippetop.mechanics.state import State
from tippetop.mechanics.stick_slip import come_to_rest, scaled, size, slip_part
from tippetop.mechanics.top import Top

ENDED = 10.0 * FUZZ
"""Slip, in units of the body's speed, that is none."""


def is_dry(top: Top) -> bool:
    """Whether slip or rolling can end under the law of a top."""
    return top.resists_rolling or is_set_valued(top.friction)


class DryContact(NamedTuple):
    """The contact of a struck body under dry friction, all floats."""

    body: Striking
    """The body at the start of the impact."""
    ended: bool = False
    stopped: bool = False
    """Whether slip, and rolling, have ended."""
    way: Slip | None = None
    rolling_way: Slip | None = None
    """The direction in which they go on all the same; None if they are held."""

    @property
    def top(self) -> Top:
        """The body and its law of friction."""
        return self.body.contact.top

    @property
    def reach(self) -> float | None:
        """Slip length of the law; None if drilling is free."""
        return slip_length(self.top.friction)

    def parts(self, velocity: Slip) -> tuple[Slip, Slip]:
        """Slip zeta and horizontal angular velocity (times the arm's length) of six velocities, m/s."""
        return slip_part(velocity, self.reach), scaled(self.body.lever, velocity[3:5])

    def zeros(self, slip: Slip, rolling: Slip) -> tuple[bool, bool]:
        """Whether slip, and rolling, of which there is so much have ended, if they can."""
        least = ENDED * self.body.speed
        ended = is_set_valued(self.top.friction) and size(slip) <= least
        return ended, self.top.resists_rolling and size(rolling) <= least

    def settled(self, impulse: Impulse) -> "DryContact":
        """The contact with what has ended after an impulse, and where that goes on if it cannot stay so."""
        slip, rolling = self.parts(self.body.velocities(impulse))
        ended, stopped = self.zeros(slip, rolling)
        if not (ended or stopped):
            return DryContact(self.body) if self.ended or self.stopped else self
        go_on = None if ended else slip, None if stopped else rolling
        found, _ = settling(self.body.contact, *go_on, struck_motion)
        return DryContact(self.body, ended, stopped, found.slip, found.rolling)

    def friction(self, slip: Slip, rolling: Slip) -> Slip:
        """Force and torque per unit normal impulse at these velocities, six numbers."""
        way = self.way if self.ended else slip
        wrench = struck_wrench(self.body.contact, way, self.rolling_way if self.stopped else rolling)
        return (*wrench.force, *wrench.torque)

    def rates(self, impulse: Impulse) -> Impulse:
        """Rates of the impulse and its normal work, in a clock in which slip that ends decays exponentially.

        The normal impulse grows by dp = ds / (1/v_0 + traction / slip), with both slip and rolling.
        """
        velocity = self.body.velocities(impulse)
        slip, rolling = self.parts(velocity)
        unit, reach = self.friction(slip, rolling), self.reach
        rate = 1.0 / self.body.striking
        if not self.ended and size(slip) > 0.0:
            rate += math.hypot(unit[0], unit[1], 0.0 if reach is None else unit[5] / reach) / size(slip)
        if self.top.resists_rolling and not self.stopped and size(rolling) > 0.0:
            rate += math.hypot(unit[3], unit[4]) / (self.body.lever * size(rolling))
        return scaled(1.0 / rate, (*unit, velocity[2]))

    def at_rest(self, impulse: Impulse, after: State) -> State:
        """The state after an impulse, in which slip and rolling that have ended are exactly zero."""
        zeros = self.zeros(*self.parts(self.body.velocities(impulse)))
        still = come_to_rest(along_table(after), self.top, *zeros)
        return after._replace(momentum=still.momentum, velocity=(*still.velocity, after.velocity[2]))

    def doubt(self, here: Slip, there: Slip, off: Slip) -> float:
        """Error in slip and rolling of a step, relative to them or to a millionth of the body's speed.

        Given the six velocities at its start and end, and their error.
        """
        parts = zip(self.parts(here), self.parts(there), self.parts(off), strict=True)
        least = 1e-6 * self.body.speed
        return max(size(wrong) / max(size(before), size(after), least) for before, after, wrong in parts)


def struck_motion(
    point: ContactPoint, slip: Slip | None, rolling: Slip | None
) -> tuple[Wrench, Acceleration]:
    """What a unit normal impulse brings with it, and how the velocities change."""
    wrench = struck_wrench(point, slip, rolling)
    return wrench, point.response(wrench)
