"""Dry friction in an impact: slip, sticking, drilling and rolling with the normal impulse as time.

While the normal impulse p grows, slip zeta (see `stick_slip`) changes by d zeta / dp = A(e), which depends on
its direction e alone, as the configuration is fixed. Slip that ends stays ended if the limit surface admits
the impulse that keeps it so; else it goes on along a direction with A = R e, R > 0, which then is constant.
"""

import math
from collections.abc import Sequence
from operator import mul
from typing import NamedTuple

from tippetop.mechanics.beginning import CHOICES
from tippetop.mechanics.coulomb import RollingResistance
from tippetop.mechanics.direction import Resisted, directions
from tippetop.mechanics.friction import NO_TORQUE, FrictionLaw
from tippetop.mechanics.impulse import FUZZ, Impulse, Striking
from tippetop.mechanics.rolling import (
    COUPLES,
    DRILLING,
    FORCES,
    ContactPoint,
    Slip,
    branch_of,
    flat,
    is_set_valued,
    set_valued,
    slip_length,
    solve,
    velocity_without_slip,
    without_drilling,
    without_rolling,
)
from tippetop.mechanics.state import State
from tippetop.mechanics.stick_slip import plus, scaled, size, slip_part
from tippetop.mechanics.vectors import add, length

ENDED = 10.0 * FUZZ
"""Slip, in units of the body's speed, that is none."""

SLIPPING, ROLLING = "slipping", "rolling"


def is_dry(law: FrictionLaw) -> bool:
    """Whether slip or rolling can end under this law."""
    return isinstance(law, RollingResistance) or is_set_valued(law)


class DryContact(NamedTuple):
    """The contact of a struck body under dry friction, all floats."""

    body: Striking
    """The body at the start of the impact."""
    speed: float
    """Speed of the body's material, m/s: the measure of what is no slip."""
    before: Slip
    """Velocity of the contact point, m/s, and angular velocity, rad/s, at the start."""
    response: tuple[Slip, ...]
    """What an impulse adds to each of these six, per component of the impulse and of that of the torque."""
    resistance: RollingResistance | None
    """The resistance to rolling, if there is any."""
    is_set_valued: bool
    """Whether slip can end under the law."""
    reach: float | None
    """Slip length of the law; None if drilling is free."""
    arm: float
    """Length of the contact vector, m."""
    striking: float
    """Speed of the contact point at the start, m/s."""
    ended: bool = False
    stopped: bool = False
    """Whether slip, and rolling, have ended."""
    way: Slip | None = None
    rolling_way: Slip | None = None
    """The direction in which they go on all the same; None if they are held."""

    @classmethod
    def of(cls, body: Striking) -> "DryContact":
        """The contact of this body."""
        point = ContactPoint.of(body.state.axis, body.state.momentum, body.top)
        speed = length(body.state.velocity) + length(point.turning) * length(point.arm)
        columns = [flat(point.response(wrench)) for wrench in (*FORCES, *COUPLES, DRILLING)]
        law: FrictionLaw = body.top.friction
        resistance = law if isinstance(law, RollingResistance) else None
        before, response = (*body.point, *point.turning), tuple(zip(*columns, strict=True))
        of_law = (resistance, is_set_valued(law), slip_length(law))
        return cls(body, speed, before, response, *of_law, length(body.arm), length(body.point))

    @property
    def law(self) -> FrictionLaw:
        """The law of friction."""
        law: FrictionLaw = self.body.top.friction
        return law

    def change(self, impulse: Sequence[float]) -> Slip:
        """What an impulse and that of a torque, six numbers, add to the six velocities."""
        return tuple([sum(map(mul, row, impulse)) for row in self.response])

    def velocities(self, impulse: Impulse) -> tuple[Slip, Slip]:
        """Slip zeta and horizontal angular velocity (times the arm's length) after an impulse, m/s."""
        return self.parts(plus(self.before, self.change(components(impulse))))

    def parts(self, velocity: Slip) -> tuple[Slip, Slip]:
        """Slip zeta and horizontal angular velocity (times the arm's length) of six velocities, m/s."""
        return slip_part(velocity, self.reach), scaled(self.arm, velocity[3:5])

    def settled(self, impulse: Impulse) -> "DryContact":
        """The contact with what has ended after an impulse, and where that goes on if it cannot stay so."""
        slip, rolling = self.velocities(impulse)
        ended = self.is_set_valued and size(slip) <= ENDED * self.speed
        stopped = self.resistance is not None and size(rolling) <= ENDED * self.speed
        if not (ended or stopped):
            return self._replace(ended=False, stopped=False) if self.ended or self.stopped else self
        go_on = None if ended else slip, None if stopped else rolling
        for begins in CHOICES:
            if begins[0] > ended or begins[1] > stopped:
                continue
            try:
                ways = self.ways_on(*go_on, begins)
            except ArithmeticError:
                continue
            if self.admits(*ways):
                return self._replace(ended=ended, stopped=stopped, way=ways[0], rolling_way=ways[1])
        raise ArithmeticError(
            "nothing can hold the contact in an impact, and it cannot go on in any direction"
        )

    def admits(self, slip: Slip | None, rolling: Slip | None) -> bool:
        """Whether the table can hold those velocities that are None."""
        unit, resistance = self.unit(slip, rolling), self.resistance
        if slip is None and set_valued(self.law).reserve(1.0, unit[:2], unit[5]) < 0.0:
            return False
        if rolling is None and resistance is not None:
            return bool(resistance.reserve(1.0, (unit[3], unit[4])) >= 0.0)
        return True

    def friction(self, slip: Slip, rolling: Slip) -> Slip:
        """Force and torque per unit normal impulse at these velocities."""
        return self.unit(self.way if self.ended else slip, self.rolling_way if self.stopped else rolling)

    def unit(self, slip: Slip | None, rolling: Slip | None) -> Slip:
        """Force and torque per unit normal impulse, six numbers; a velocity that is None is held."""
        force, torque = (0.0, 0.0), NO_TORQUE
        held: list[int] = []
        if slip is None:
            held += [0, 1] if self.reach is None else [0, 1, 5]
        else:
            w = self.before[5] if self.reach is None else slip[2] / self.reach
            turning = (*self.before[3:5], w)
            law = branch_of(self.law, (slip[0], slip[1]), turning)
            force, torque = law.traction((slip[0], slip[1]), turning)
        if self.resistance is not None:
            if rolling is None:
                held += [3, 4]
            else:
                torque = add(torque, self.resistance.couple((rolling[0], rolling[1], 0.0)))
        unit = [*force, 1.0, *torque]
        if held:
            rows = [self.response[i] for i in held]
            right = [-sum(map(mul, row, unit)) for row in rows]
            for i, part in zip(held, solve([[row[j] for j in held] for row in rows], right), strict=True):
                unit[i] += part
        return tuple(unit)

    def ways_on(
        self, slip: Slip | None, rolling: Slip | None, begins: tuple[bool, bool]
    ) -> tuple[Slip | None, Slip | None]:
        """Slip and rolling, or the directions in which they begin; None where they are held."""
        parts = [part for part, wanted in zip((SLIPPING, ROLLING), begins, strict=True) if wanted]
        if not parts:
            return slip, rolling

        def both(ways: Sequence[Slip]) -> tuple[Slip | None, Slip | None]:
            found = dict(zip(parts, ways, strict=True))
            return found.get(SLIPPING, slip), found.get(ROLLING, rolling)

        def response(ways: Sequence[Slip]) -> list[Resisted]:
            unit = self.unit(*both(ways))
            velocities = self.change(unit)
            return [
                Resisted(self.part(part, velocities), self.stiffness(part) * size(self.resisting(part, unit)))
                for part in parts
            ]

        # Against what would have held it; slip, if both begin, against what holds it once rolling goes on.
        beside = self.ways_on(slip, rolling, (False, True)) if all(begins) else (slip, rolling)
        holding = self.unit(*beside)
        start = [scaled(-1.0, self.resisting(part, holding)) for part in parts]
        return both(directions(response, start))

    def part(self, part: str, velocities: Slip) -> Slip:
        """Slip zeta, or the horizontal angular velocity, of six velocities."""
        return slip_part(velocities, self.reach) if part == SLIPPING else velocities[3:5]

    def resisting(self, part: str, unit: Slip) -> Slip:
        """What resists it, per unit normal impulse: a drilling torque over the law's length."""
        if part == ROLLING:
            return unit[3:5]
        return unit[:2] if self.reach is None else (*unit[:2], unit[5] / self.reach)

    def stiffness(self, part: str) -> float:
        """How strongly it answers to that."""
        if part == ROLLING:
            return float(self.response[3][3] + self.response[4][4])
        drilling = 0.0 if self.reach is None else self.reach**2 * self.response[5][5]
        return float(self.response[0][0] + self.response[1][1] + drilling)

    def rates(self, impulse: Impulse) -> Slip:
        """Rates of the impulse and its normal work, in a clock in which slip that ends decays exponentially.

        The normal impulse grows by dp = ds / (1/v_0 + traction / slip), with both slip and rolling.
        """
        velocity = plus(self.before, self.change(components(impulse)))
        slip, rolling = self.parts(velocity)
        east, north, _, *torque = self.friction(slip, rolling)
        rate = 1.0 / self.striking
        drilled = 0.0 if self.reach is None else torque[2] / self.reach
        if not self.ended and size(slip) > 0.0:
            rate += math.hypot(east, north, drilled) / size(slip)
        if self.resistance is not None and not self.stopped and size(rolling) > 0.0:
            rate += math.hypot(torque[0], torque[1]) / (self.arm * size(rolling))
        return scaled(1.0 / rate, (1.0, east, north, *torque, velocity[2]))

    def at_rest(self, impulse: Impulse, after: State) -> State:
        """The state after an impulse, in which slip and rolling that have ended are exactly zero."""
        top = self.body.top
        slip, rolling = self.velocities(impulse)
        if isinstance(top.friction, RollingResistance) and size(rolling) <= ENDED * self.speed:
            after = after._replace(momentum=without_rolling(after.axis, after.momentum, top))
        if not self.is_set_valued or size(slip) > ENDED * self.speed:
            return after
        momentum = after.momentum if self.reach is None else without_drilling(after.axis, after.momentum, top)
        velocity = velocity_without_slip(after.axis, momentum, top)
        return after._replace(momentum=momentum, velocity=(*velocity, after.velocity[2]))

    def doubt(self, here: Impulse, there: Impulse, error: Impulse) -> float:
        """Error of a step in slip and rolling, relative to them or to a millionth of the body's speed."""
        off = self.parts(self.change(components(error)))
        return max(
            size(wrong) / max(size(before), size(after), 1e-6 * self.speed)
            for before, after, wrong in zip(self.velocities(here), self.velocities(there), off, strict=True)
        )


def components(impulse: Impulse) -> Slip:
    """Impulse along x, y and z, and that of the torque."""
    return (*impulse.tangential, impulse.normal, *impulse.angular)
