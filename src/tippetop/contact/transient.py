"""The moments in which slip, or rolling, ends or begins, under friction that is set-valued."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import ClassVar

from tippetop.contact.contact_mode import ContactMode
from tippetop.contact.mode import IntegratedMode, Mode, ModeEnd, Reaction, Segment, split
from tippetop.integrators.base import Integrator
from tippetop.integrators.dense import DenseSolution
from tippetop.mechanics.contacts.forces import velocity_without_slip, without_rolling
from tippetop.mechanics.contacts.slip_end import (
    SlipComponent,
    SlipEndState,
    rates_in_time,
    slip_beside,
)
from tippetop.mechanics.contacts.slip_variables import scaled, velocity_of
from tippetop.mechanics.contacts.wrench import Slip
from tippetop.mechanics.motion import angular_velocity, on_table
from tippetop.mechanics.state import SlidingState, State
from tippetop.mechanics.vectors import Row, Scalar, Vector, dot

AT_REST = "at rest"
"""Cause of the end of `Resting`."""

SETTLED = 1e-14
"""Error of the instant at which slip ends, in natural units, that counts as none."""

PROBES_OF_SLIP_END = 16
"""Intervals of the end of slip at whose ends it is asked whether another surface touches, or the
table would have to pull: then a mode with a guard takes over sooner.
"""

SHORT = 1e-14
"""How long a top at rest is followed, in natural units of time or relative to the time."""

DEGREE = 14
"""Degree of the polynomials that stand for the last moments in a solution."""


@dataclass(frozen=True)
class TransientMode(Mode):
    """A moment between two modes; a result reports the one of them in which something moves."""

    component: SlipComponent
    """The velocity xi that ends or begins, and whether the other is held."""
    pulls: bool = False
    """Whether the table may pull."""

    name: ClassVar[str] = "passing"

    @property
    def reported_mode(self) -> ContactMode:
        """The mode that a result reports for it."""
        slip, held = self.component
        return ContactMode(self.top, (not slip and held,), slip and held)

    @property
    def label(self) -> str:
        """The name of the reported mode."""
        return self.reported_mode.label

    @property
    def form(self) -> str:
        """What ends or begins decides how its numbers are read."""
        return f"{self.name}: slip {self.component.slip}, held {self.component.held}"

    def state(self, y: Row) -> State:
        """Return the state from axis, momentum, velocity where it is free, and xi."""
        axis, momentum, velocity, xi = self._parts(y)
        if self.component.slip:
            velocity = velocity_of(axis, momentum, xi, self.top)
            momentum = (
                without_rolling(axis, momentum, self.top) if self.component.held else momentum
            )
        elif self.component.held:
            velocity = velocity_without_slip(axis, momentum, self.top)
        return on_table(SlidingState(axis, momentum, (velocity[0], velocity[1])), self.top)

    def reaction(self, y: Row) -> Reaction:
        """Return the contact force and torque, from xi, of which a state has few digits."""
        axis, momentum, velocity, xi = self._parts(y)
        now = SlipEndState(axis, momentum, velocity, xi, 0.0, 0.0)
        force, torque = rates_in_time(now, self.component, self.top).wrench
        power = dot(torque, angular_velocity(axis, momentum, self.top))
        slip = xi if self.component.slip else slip_beside(now, self.component, self.top)
        if slip is not None:
            power = power + (force[0] * slip[0] + force[1] * slip[1])
        return Reaction(force, torque, power)

    @property
    def free(self) -> int:
        """How many numbers come before what ends or begins."""
        return 8 if self.component.moves else 6

    def _parts(self, y: Row) -> tuple[Vector, Vector, Slip, Slip]:
        return *split(y), tuple(y[6 : self.free]), tuple(y[self.free :])


@dataclass(frozen=True)
class Resting(Mode):
    """Every velocity has ended: an instant, so that a result has it, and then the run is over."""

    reported_mode: IntegratedMode
    """The mode that a result reports for it."""

    name: ClassVar[str] = "resting"

    def state(self, y: Row) -> State:
        """Return the state as the reported mode has it."""
        return self.reported_mode.state(y)

    def segments(
        self, time: float, state: State, end: float, integrator: Integrator
    ) -> Iterator[Segment]:
        """Stay as it is."""
        numbers = self.reported_mode.numbers(state)
        still = straight(numbers, numbers, time, time + SHORT * max(1.0, time))
        yield Segment(self.reported_mode, still, state, ModeEnd(AT_REST, state))


def straight(
    begin: Sequence[float], last: Sequence[float], start: float, end: float
) -> DenseSolution:
    """Numbers that go from some to others in a straight line."""
    rows = [[a, b - a] for a, b in zip(begin, last, strict=True)]
    return in_one_step(rows, 0.0, 1.0).moved(start, end)


def in_one_step(rows: Sequence[list[Scalar]], start: float, lasts: float) -> DenseSolution:
    """Numbers by coefficients in powers of the time since some time, for as long as that."""
    terms = [[*row, *[0.0] * (DEGREE + 1 - len(row))] for row in rows]
    return DenseSolution.in_time([0.0, lasts], [terms]).moved(start, start + lasts)


def pack_moment(now: SlipEndState) -> tuple[Scalar, ...]:
    """Return the numbers of a moment that passes: axis, momentum, velocity where it is free, and
    xi.
    """
    return (*now.axis, *now.momentum, *now.velocity, *scaled(now.speed, now.direction))
