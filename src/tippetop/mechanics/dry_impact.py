"""Dry friction in an impact: slip, sticking, drilling and rolling with the normal impulse as time.

While the normal impulse p grows, slip zeta (see `stick_slip`) changes by d zeta / dp = A(e), which depends on
its direction e alone, as the configuration is fixed. Slip that ends stays ended if the limit surface admits
the impulse that keeps it so; else it goes on along a direction with A = R e, R > 0, which then is constant.
"""

import math
from typing import NamedTuple

from tippetop.mechanics.coulomb import RollingResistance
from tippetop.mechanics.friction import NO_TORQUE, FrictionLaw, Traction
from tippetop.mechanics.impulse import FUZZ, Impulse, Striking
from tippetop.mechanics.motion import angular_velocity
from tippetop.mechanics.rolling import (
    COUPLES,
    DRILLING,
    FORCES,
    ContactPoint,
    Slip,
    Wrench,
    flat,
    set_valued,
    sliding_law,
    solve,
    velocity_without_slip,
    without_drilling,
)
from tippetop.mechanics.state import State
from tippetop.mechanics.stick_slip import plus, scaled, size, slip_part
from tippetop.mechanics.vectors import add, length

ENDED = 10.0 * FUZZ
"""Slip, in units of the body's speed, that is none."""

ITERATIONS = 5000
"""Most iterations in search of a direction in which slip can go on."""


def is_dry(law: FrictionLaw) -> bool:
    """Whether slip or rolling can end under this law."""
    return isinstance(law, RollingResistance) or hasattr(law, "slip_length")


class DryContact(NamedTuple):
    """The contact of a struck body under dry friction, all floats.

    Attributes
    ----------
    body
        The body at the start of the impact.
    point
        Its contact point.
    speed
        Speed of the body's material, m/s: the measure of what is no slip.
    ended, stopped
        Whether slip, and rolling, have ended.
    way, rolling_way
        The direction in which they go on all the same; None if they are held.
    """

    body: Striking
    point: ContactPoint
    speed: float
    ended: bool = False
    stopped: bool = False
    way: Slip | None = None
    rolling_way: Slip | None = None

    @classmethod
    def of(cls, body: Striking) -> "DryContact":
        """The contact of this body."""
        point = ContactPoint.of(body.state.axis, body.state.momentum, body.top)
        return cls(body, point, length(body.state.velocity) + length(point.turning) * length(point.arm))

    @property
    def reach(self) -> float | None:
        """Slip length of the law; None if drilling is free."""
        length: float | None = getattr(sliding_law(self.body.top.friction), "slip_length", None)
        return length

    def velocities(self, impulse: Impulse) -> tuple[Slip, Slip]:
        """Slip zeta and horizontal angular velocity (times the arm's length) after an impulse, m/s."""
        omega = angular_velocity(self.body.state.axis, self.body.after(impulse).momentum, self.body.top)
        point = add(self.body.point, self.body.response(impulse))
        slip = slip_part((*point, *omega), self.reach)
        return slip, scaled(length(self.point.arm), omega[:2])

    def settled(self, impulse: Impulse) -> "DryContact":
        """The contact with what has ended after an impulse, and where that goes on if it cannot stay so."""
        slip, rolling = self.velocities(impulse)
        law = self.body.top.friction
        ended = self.is_set_valued and size(slip) <= ENDED * self.speed
        stopped = isinstance(law, RollingResistance) and size(rolling) <= ENDED * self.speed
        if not (ended or stopped):
            return self._replace(ended=False, stopped=False)
        first, second = None if ended else slip, None if stopped else rolling
        unit = self.unit(first, second)
        if ended and set_valued(law).reserve(1.0, unit.force[:2], unit.torque[2]) < 0.0:
            first = self.way_on(unit, second, slipping=True)
            unit = self.unit(first, second)
        if isinstance(law, RollingResistance) and stopped and law.reserve(1.0, unit.torque[:2]) < 0.0:
            second = self.way_on(unit, first, slipping=False)
        return self._replace(ended=ended, stopped=stopped, way=first, rolling_way=second)

    @property
    def is_set_valued(self) -> bool:
        """Whether slip can end under the law."""
        return hasattr(sliding_law(self.body.top.friction), "slip_length")

    def friction(self, impulse: Impulse) -> Traction:
        """Force and torque per unit normal impulse."""
        slip, rolling = self.velocities(impulse)
        unit = self.unit(self.way if self.ended else slip, self.rolling_way if self.stopped else rolling)
        return Traction((unit.force[0], unit.force[1]), unit.torque)

    def unit(self, slip: Slip | None, rolling: Slip | None) -> Wrench:
        """The wrench per unit normal impulse; None is held."""
        law = self.body.top.friction
        force, torque = (0.0, 0.0), NO_TORQUE
        held: list[tuple[int, Wrench]] = []
        if slip is None:
            held += [(0, FORCES[0]), (1, FORCES[1])]
            held += [] if self.reach is None else [(5, DRILLING)]
        else:
            w = self.point.turning[2] if self.reach is None else slip[2] / self.reach
            force, torque = sliding_law(law).traction((slip[0], slip[1]), (*self.point.turning[:2], w))
        if isinstance(law, RollingResistance):
            if rolling is None:
                held += [(3, COUPLES[0]), (4, COUPLES[1])]
            else:
                torque = add(torque, law.couple((rolling[0], rolling[1], 0.0)))
        unit = Wrench((force[0], force[1], 1.0), torque)
        columns = [flat(self.point.response(wrench)) for _, wrench in held]
        driven = flat(self.point.response(unit))
        parts = solve([[column[i] for column in columns] for i, _ in held], [-driven[i] for i, _ in held])
        total: Slip = (*unit.force, *unit.torque)
        for part, (_, wrench) in zip(parts, held, strict=True):
            total = plus(total, scaled(part, (*wrench.force, *wrench.torque)))
        return Wrench((total[0], total[1], 1.0), (total[3], total[4], total[5]))

    def way_on(self, holding: Wrench, other: Slip | None, *, slipping: bool) -> Slip:
        """Direction in which slip, or rolling, goes on where it cannot be held."""
        start: Slip = holding.force[:2] if slipping else holding.torque[:2]
        if slipping and self.reach is not None:
            start = (*start, holding.torque[2] / self.reach)
        direction = scaled(-1.0 / size(start), start)
        for _ in range(ITERATIONS):
            unit = self.unit(direction, other) if slipping else self.unit(other, direction)
            rates = flat(self.point.response(unit))
            rate = slip_part(rates, self.reach) if slipping else rates[3:5]
            strength = size(unit.force[:2]) / self.body.top.mass * 8.0 if slipping else 2.0 * size(rate)
            ahead = plus(scaled(strength + size(rate), direction), rate)
            new = scaled(1.0 / size(ahead), ahead)
            moved = size(plus(new, scaled(-1.0, direction)))
            direction = new
            if moved < 1e-15:
                break
        return direction

    def pace(self, impulse: Impulse, traction: Traction) -> float:
        """Normal impulse per unit of a clock in which slip that ends decays exponentially, m/s."""
        slip, rolling = self.velocities(impulse)
        rate = 1.0 / length(self.body.point)
        drilled = 0.0 if self.reach is None else traction.torque[2] / self.reach
        if not self.ended and size(slip) > 0.0:
            rate += math.hypot(*traction.force, drilled) / size(slip)
        if isinstance(self.body.top.friction, RollingResistance) and not self.stopped and size(rolling) > 0.0:
            rate += math.hypot(*traction.torque[:2]) / (length(self.point.arm) * size(rolling))
        return float(1.0 / rate)

    def at_rest(self, impulse: Impulse, after: State) -> State:
        """The state after an impulse, in which slip that has ended is exactly zero."""
        top = self.body.top
        if not self.is_set_valued or size(self.velocities(impulse)[0]) > ENDED * self.speed:
            return after
        momentum = after.momentum if self.reach is None else without_drilling(after.axis, after.momentum, top)
        velocity = velocity_without_slip(after.axis, momentum, top)
        return after._replace(momentum=momentum, velocity=(*velocity, after.velocity[2]))

    def doubt(self, here: Impulse, there: Impulse, error: Impulse) -> float:
        """Error of a step in slip and rolling, relative to them or to a millionth of the body's speed."""
        doubts = []
        still = self._replace(body=self.body._replace(point=NO_TORQUE, state=self.at_standstill()))
        for before, after, off in zip(
            self.velocities(here), self.velocities(there), still.velocities(error), strict=True
        ):
            doubts.append(size(off) / max(size(before), size(after), 1e-6 * self.speed))
        return max(doubts)

    def at_standstill(self) -> State:
        """The body without any motion."""
        return self.body.state._replace(momentum=NO_TORQUE, velocity=NO_TORQUE)
