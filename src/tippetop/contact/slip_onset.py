"""The mode in which slip, or rolling, begins, and in which slip may end again."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from tippetop.contact.mode import COMPLETED, FAILURE, Mode, ModeEnd, Reaction, Segment, explanation
from tippetop.contact.onset_motion import SLIP_AND_ROLLING, onset_motion
from tippetop.contact.slip_phase import SlipPhase, follow_slip
from tippetop.contact.transient import TransientMode
from tippetop.integrators.base import Integrator
from tippetop.integrators.dense import DenseSolution
from tippetop.mechanics.contacts.branches import on_branch, on_limit_branch
from tippetop.mechanics.contacts.contact_point import ContactPoint
from tippetop.mechanics.contacts.forces import forces_and_accelerations, is_set_valued
from tippetop.mechanics.contacts.slip_end import SlipComponent
from tippetop.mechanics.contacts.slip_onset import find_onset
from tippetop.mechanics.contacts.slip_variables import inner, size, slip_of
from tippetop.mechanics.contacts.wrench import Slip, Wrench
from tippetop.mechanics.state import State
from tippetop.mechanics.vectors import Row, Vector, dot

PART = 0.25
"""Part of the time in which another velocity could end, at its first rate, that a step takes: in
planar motion that velocity passes through zero, where friction jumps.
"""

FIRST_SPEED = 1e-100
"""Speed of the first instant, in natural units, which gives a velocity of zero its direction."""

ONSET_OVER, ENDED = "onset over", "slip ended"
"""Causes of the end of such a mode: its onset is over, and an ordinary mode follows the motion; or
slip has ended.
"""

UNSEEN = "slip, or rolling, cannot be told from its beginning"
"""Detail of the outcome where rounding hides the velocities that begin."""


@dataclass(frozen=True)
class SlipOnset(TransientMode):
    """The mode from the instant at which slip, or rolling, begins."""

    wrench: Wrench | None = None
    """The wrench that held what begins, if that is known."""
    with_rolling: bool = False
    """Whether rolling begins at once with slip."""

    @property
    def begins(self) -> tuple[SlipComponent, ...]:
        """The velocities that begin."""
        return SLIP_AND_ROLLING if self.with_rolling else (self.component,)

    @property
    def clause(self) -> str:
        """Clause of a sentence that states what begins."""
        if self.with_rolling:
            return "slip and rolling begin"
        return "slip begins" if self.component.slip else "rolling begins"

    @property
    def form(self) -> str:
        """What begins decides how its numbers are read."""
        slip, held = self.component
        return f"{self.name}: {len(self.begins)} begin, slip {slip}, held {held}"

    def reaction(self, y: Row) -> Reaction:
        """Return the contact force and torque, from the velocities that begin."""
        if not self.with_rolling:
            return super().reaction(y)
        axis, momentum, _, slip = self._parts(y)
        rolling = y[len(y) - 2 :]
        point = ContactPoint.of(axis, momentum, self.top)
        (force, torque), _ = forces_and_accelerations(point, slip, (rolling[0], rolling[1]))
        turning: Vector = (rolling[0], rolling[1], point.turning[2])
        power = dot(torque, turning) + (force[0] * slip[0] + force[1] * slip[1])
        return Reaction(force, torque, power)

    def _parts(self, y: Row) -> tuple[Vector, Vector, Slip, Slip]:
        """Return axis, angular momentum, velocity where it is free, and slip or else rolling."""
        return super()._parts(y[: len(y) - 2] if self.with_rolling else y)

    def segments(
        self, time: float, state: State, end: float, integrator: Integrator
    ) -> Iterator[Segment]:
        """Follow what begins: to its end where it may end and begin many times a second."""
        try:
            mode, directions = self._with_directions(state)
        except ArithmeticError as error:
            why = explanation(f"The direction in which {self.clause}", error)
            yield failed_segment(self.reported_mode, time, state, why)
            return
        top = mode.top
        velocity = state.velocity[:2] if self.component.moves else ()
        numbers = [*state.axis, *state.momentum, *velocity]
        begin = [*numbers, *[0.0 for direction in directions for _ in direction]]
        phase = follow_slip(
            onset_motion(top.kind, self.begins, not self.pulls),
            top,
            (begin, directions),
            end - time,
            to_end=len(self.begins) == 1 and self.component.recurs(top),
            longest_step=mode.longest_step,
        )
        if not phase.rows:
            yield failed_segment(self.reported_mode, time, state, UNSEEN)
            return
        last = [*phase.last[: len(numbers)], 0.0, 0.0] if phase.ended else phase.last
        first = [FIRST_SPEED * number for direction in directions for number in direction]
        yield onset_segment(mode, phase, [*numbers, *first], last, (time, end))

    def longest_step(self, numbers: Row, direction: Slip) -> float:
        """Return how long a step may be: a part of the time in which the velocity beside this one
        could end, at its present rate; infinity where nothing can.
        """
        moves, slip = self.component.moves, None
        can_end = is_set_valued(self.top.friction) if moves else self.top.resists_rolling
        if self.with_rolling or not can_end:
            return math.inf
        axis, momentum, velocity, _ = self._parts(numbers)
        point = ContactPoint.of(axis, momentum, self.top)
        beside: Slip = () if self.component.held else point.turning[:2]
        if moves:
            slip = slip_of(axis, momentum, (velocity[0], velocity[1]), self.top)
            beside = slip
        if not beside or size(beside) == 0.0:
            return math.inf
        acceleration = self.component.contact(point, direction, slip)[1]
        change = SlipComponent(not self.component.slip).rate(acceleration, self.top)
        closing = inner(beside, change)
        return PART * inner(beside, beside) / -closing if closing < 0.0 else math.inf

    def _with_directions(self, state: State) -> "tuple[SlipOnset, list[Slip]]":
        """Return the mode on its law's branch, and the directions of what begins."""
        ending = self.component
        begins = ending.slip, not ending.slip or self.with_rolling
        point = ContactPoint.of(state.axis, state.momentum, self.top)
        slip, rolling = None, None
        if ending.moves:
            slip = slip_of(state.axis, state.momentum, state.velocity[:2], self.top)
        if not ending.held and not begins[1]:
            rolling = point.turning[:2]
        onset = find_onset(point, slip, rolling, begins, held=self.wrench)
        if onset.slip is None:
            top = on_limit_branch(self.top, onset.wrench)
        else:
            top = on_branch(self.top, onset.slip)
        directions = list[Slip]()
        for direction, new in zip((onset.slip, onset.rolling), begins, strict=True):
            if new:
                assert direction is not None
                directions.append(direction)
        return replace(self, top=top), directions

    @property
    def stuck(self) -> bool:
        """Whether the contact sticks meanwhile."""
        return not self.component.slip and self.component.held


def onset_segment(
    mode: Mode,
    phase: SlipPhase,
    start: Sequence[float],
    last: Sequence[float],
    times: tuple[float, float],
) -> Segment:
    """Return the segment in which slip, or rolling, begins.

    Parameters
    ----------
    mode
        The mode.
    phase
        Its motion, as far as it was followed.
    start, last
        The numbers at its start, which give a velocity of zero its direction, and at its end.
    times
        When it begins, and when the run ends.
    """
    time, end = times
    lasts = phase.knots[-1]
    reach = end if lasts >= end - time else min(time + lasts, end)
    solution = DenseSolution.of_rows(phase.knots, start, phase.rows).moved(time, reach)
    cause = COMPLETED if solution.end >= end else ONSET_OVER
    state = mode.state(last)
    how = ModeEnd(ENDED if phase.ended else cause, state)
    return Segment(mode, solution, state, how, len(phase.knots) - 1, phase.sweeps)


def failed_segment(mode: Mode, time: float, state: State, why: str) -> Segment:
    """Return a segment without any motion, after which a run fails."""
    return Segment(mode, DenseSolution.empty(time, 8), state, ModeEnd(FAILURE, state, detail=why))
