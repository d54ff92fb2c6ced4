"""The moments in which slip, or rolling, ends or begins, under friction that is set-valued."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import ClassVar, Self

from tippetop.contact.closed_contacts import ClosedContacts, Directed
from tippetop.contact.contact_mode import ContactMode
from tippetop.contact.mode import IntegratedMode, Mode, ModeEnd, Reaction, Segment
from tippetop.integrators.base import Integrator
from tippetop.integrators.dense import DenseSolution
from tippetop.mechanics.contacts.slip_clock import SlipComponent
from tippetop.mechanics.contacts.wrench import Slip
from tippetop.mechanics.state import State
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Row

AT_REST = "at rest"
"""Cause of the end of `Resting`."""

SHORT = 1e-14
"""How long a top at rest is followed, in natural units of time or relative to the time."""

DEGREE = 14
"""Degree of the polynomials that stand for the last moments in a solution."""

SLIP_AND_ROLLING = (SlipComponent(slip=True), SlipComponent(slip=False))
"""Slip and rolling, which begin together."""


@dataclass(frozen=True)
class TransientMode(Mode):
    """A moment between two modes, in which velocities of a contact mode begin or end.

    Its numbers are those of the contact mode, and then these velocities: the state has few digits
    of them. Of two contacts that slip it is the slip of the first, or of both where the law resists
    drilling.
    """

    contact_mode: ContactMode
    """The mode in which they move, which a result reports."""
    components: tuple[SlipComponent, ...]
    """The velocities that begin or end."""

    name: ClassVar[str] = "passing"

    @property
    def tops(self) -> tuple[Top, ...]:
        """The top with each surface active that touches."""
        return self.contact_mode.tops

    def on_tops(self, tops: Sequence[Top]) -> Self:
        """Return the mode of tops of the same kinds with other numbers."""
        return replace(self, top=tops[0], contact_mode=self.contact_mode.on_tops(tops))

    @property
    def label(self) -> str:
        """The name of the contact mode."""
        return self.contact_mode.label

    @property
    def form(self) -> str:
        """What ends or begins decides how its numbers are read."""
        names = ["slip" if component.slip else "rolling" for component in self.components]
        return f"{self.name}: {' and '.join(names)}, {self.contact_mode.form}"

    def state(self, y: Row) -> State:
        """Return the state as the contact mode has it."""
        return self.contact_mode.state(y)

    def reaction(self, y: Row) -> Reaction:
        """Return the contact force and torque."""
        count = self.contact_mode.count
        velocities = self.split_velocities(y[count:])
        return self.contacts(y[:count], velocities, velocities).reaction()

    def split_velocities(self, numbers: Row) -> list[Slip]:
        """Return the velocities that begin or end, or their directions, from their numbers."""
        velocities, first = list[Slip](), 0
        for component in self.components:
            last = first + component.count(self.top)
            velocities.append(tuple(numbers[first:last]))
            first = last
        return velocities

    def contacts(
        self, numbers: Row, directions: Sequence[Slip], velocities: Sequence[Slip]
    ) -> ClosedContacts:
        """Return the closed contacts at the numbers of the contact mode, where the velocities that
        begin or end have some directions.
        """
        return directed_contacts(
            self.contact_mode, self.components, numbers, directions, velocities
        )


def directed_contacts(
    mode: ContactMode,
    components: Sequence[SlipComponent],
    numbers: Row,
    directions: Sequence[Slip],
    velocities: Sequence[Slip],
) -> ClosedContacts:
    """Return the closed contacts of a mode of which some velocities have directions of their own.

    Parameters
    ----------
    mode
        The mode.
    components
        The velocities that begin or end.
    numbers
        The numbers of the mode.
    directions, velocities
        Direction of each of these velocities, and itself.
    """
    slip: Slip | None = None
    velocity: Slip = ()
    rolling: Slip | None = None
    for number, component in enumerate(components):
        if component.slip:
            slip, velocity = directions[number], velocities[number]
        else:
            rolling = directions[number]
    return mode.contacts(numbers, Directed(slip, velocity, rolling))


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
    terms = [[a, b - a, *[0.0] * (DEGREE - 1)] for a, b in zip(begin, last, strict=True)]
    return DenseSolution.in_time([0.0, 1.0], [terms]).moved(start, end)
