"""Contact modes as data: what a mode of motion states, and what runs it.

All is in natural units (see `tippetop.mechanics.top`). A mode states how its numbers change and the
guards that end it by name, and it says what ended it. `tippetop.contact.automaton` decides what
follows. `tippetop.contact.trajectory` follows one launch from mode to mode, and the engine of
sweeps many; neither knows mechanics.
"""

from abc import ABC, abstractmethod
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from typing import Any, ClassVar, NamedTuple, Self

from tippetop.integrators.base import Arc, Integrator, Motion
from tippetop.integrators.dense import DenseSolution, as_array
from tippetop.mechanics.state import State
from tippetop.mechanics.surfaces.hull import Hull
from tippetop.mechanics.top import Top
from tippetop.mechanics.unsolved import Unsolved
from tippetop.mechanics.vectors import Row, Scalar, Vector

BROKEN = "a number on the way to it is too large for a computer, or zero where it divides"
"""Why something cannot be found where arithmetic breaks down."""


class Status(Enum):
    """How a run ended; the value is advice.

    Examples
    --------
    >>> import tippetop as tt
    >>> run = tt.simulate(tt.presets.report_problem(), duration=0.1)
    >>> tt.Status[run.attrs["status"].upper()] is tt.Status.COMPLETED
    True
    >>> tt.Status.COMPLETED.value
    'The run reached its end.'
    """

    COMPLETED = "The run reached its end."
    LIFTED_OFF = (
        "The table would have to pull from here on; "
        "with liftoff = ignore it does, and with fly the top leaves it."
    )
    AT_REST = "The top came to rest, and the table holds it so: nothing happens any more."
    STOPPED = "The run ended at the event that it was asked to end at."
    TOO_MANY_MODES = (
        "The top bounced and slid more often than the run allows; "
        "shorten the duration, lower the restitution, or raise mode_limit."
    )
    TOO_MANY_STEPS = (
        "The motion took more steps than the run allows: it is very fast, or stiff; shorten the"
        " duration, lessen the friction, try the integrator collocation, which is made for stiff"
        " friction, or raise the limit on steps."
    )
    INACCURATE = (
        "The numbers do not keep what the motion keeps: do not trust them; try another integrator"
        " or shorter steps, which a smaller tolerance makes where a method takes one."
    )
    FAILED = (
        "The run could not go on: it is not known what the table does from here on, or the"
        " integrator finds no step; try less friction, or, where the reason is the integrator's,"
        " another one."
    )


class EventKind(Enum):
    """What can happen to a top; the value is its name in a result."""

    LIFT_OFF = "liftoff"
    TOUCHDOWN = "touchdown"
    STICK = "stick"
    SLIP = "slip"
    HALT = "rolling stops"
    ROLL = "rolling starts"
    IMPACT = "impact"
    OPENING = "opening"
    DOUBLE_CONTACT = "double contact"
    INDETERMINATE = "indeterminate force"
    LIES_DOWN = "lies down"
    TIPS = "tips over its rim"
    PRESSED_AT_RIM = "pressure at the rim"
    ROLLS_ON_RIM = "rolls on its rim"
    RESTS = "rests"


@dataclass(frozen=True)
class Event:
    """Something that happened at an instant."""

    kind: EventKind
    """What happened."""
    time: float
    """When."""
    impulse: float = 0.0
    energy_lost: float = 0.0
    """Normal impulse of the table on all surfaces that touch, and energy that went with it."""
    surface: int = 0
    """Number of the body's surface to which it happened: that which struck, of an impact."""
    steps: int = 0
    """How many steps it took to find what it does."""


@dataclass(frozen=True)
class Transition:
    """What follows the end of a mode."""

    events: tuple[Event, ...]
    """What happened, in order."""
    next: "Mode | Status"
    """The next mode, or the status of the run."""
    state: State
    """The state in which it begins, floats."""
    detail: str = ""
    """More about the status, where there is more to say."""

    @property
    def energy_lost(self) -> float:
        """Energy that went with what happened."""
        return sum([event.energy_lost for event in self.events])


def ambiguity_of(events: Sequence[Event]) -> str:
    """Return a sentence on indeterminate contact forces among events; empty if there are none."""
    count = len([event for event in events if event.kind is EventKind.INDETERMINATE])
    if not count:
        return ""
    instants = "one instant" if count == 1 else f"{count} instants"
    return (
        f"At {instants} the contact force was indeterminate (Painleve's paradox): an impact and a"
        " lift-off both agree with the laws of rigid bodies and friction. The run took the one"
        " that contact.indeterminate names, 'impact' or 'liftoff'."
    )


COMPLETED, FAILURE = "completed", "failure"
"""Causes of a mode's end that are no guard: the run is over, or the mode cannot be followed."""

BOTH = -1
"""Number that stands for both contacts in the name of a guard."""


@dataclass(frozen=True)
class ModeEnd:
    """How a mode ended."""

    cause: str
    """Name of the guard that fell to zero, without a number, or one of the causes above."""
    state: State
    """The state at the end, floats."""
    contact: int = BOTH
    """Number of the contact, or of the surface, to which it happened, if a number is in the name.
    """
    detail: str = ""
    """More about a failure."""
    numbers: tuple[float, ...] = ()
    """The numbers of the mode at the end, where they say more than the state."""

    @classmethod
    def by_guard(cls, name: str, state: State, numbers: tuple[float, ...] = ()) -> "ModeEnd":
        """Return the end by a guard whose name may have a number."""
        cause, *contact = name.split(NUMBER_SIGN)
        return cls(cause, state, int(contact[0]) if contact else BOTH, numbers=numbers)


NUMBER_SIGN = " #"
"""What stands before the number in the name of a guard."""


def numbered(guard: str, contact: int) -> str:
    """Return the name of a guard of one contact, or surface, of several."""
    return f"{guard}{NUMBER_SIGN}{contact}"


def explanation(what: str, error: ArithmeticError) -> str:
    """Return a sentence that something cannot be found; arithmetic's own words say nothing of the
    motion.
    """
    why = str(error) if isinstance(error, Unsolved) else BROKEN
    return f"{what} cannot be found: {why}."


def failed(
    what: str, error: ArithmeticError, state: State, events: tuple[Event, ...] = ()
) -> Transition:
    """Return the end of a run where something cannot be found."""
    return Transition(events, Status.FAILED, state, explanation(what, error))


def split(y: Row) -> tuple[Vector, Vector]:
    """Return axis and angular momentum, the first numbers of every mode in contact."""
    return (y[0], y[1], y[2]), (y[3], y[4], y[5])


class Reaction(NamedTuple):
    """What the table does to the top at an instant."""

    force: Vector
    """Contact force."""
    torque: Vector
    """Torque about the contact point."""
    power: Scalar
    """Power of the contact force and torque."""
    couple: Vector | None = None
    """Torque of drilling and rolling friction alone; None if that is all of the torque."""
    pressing: Scalar | None = None
    """Least normal force of several contacts; None of one."""
    reserve: Scalar | None = None
    """Least reserve of what friction holds (see `tippetop.contact.conditions`), N^2; None where it
    holds nothing. Where it is negative, the table exerts more than it can.
    """

    @property
    def resistance(self) -> Vector:
        """Torque of drilling and rolling friction."""
        return self.torque if self.couple is None else self.couple


NO_REACTION = Reaction((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), 0.0)


@dataclass(frozen=True)
class Segment:
    """A piece of a trajectory within one mode."""

    mode: "Mode"
    """What the top was doing."""
    solution: DenseSolution
    """The numbers of the mode as functions of time."""
    end_state: State
    """The state at its end, floats."""
    mode_end: ModeEnd | None
    """How the mode ended; None where it goes on."""
    steps: int = 0
    evaluations: int = 0
    """Work done by the integrator."""
    method: Integrator | None = None
    """The integrator that took the steps, if it is not the one that was asked."""
    transition: Transition | None = None
    """What follows where the mode ended, once it is decided."""

    @property
    def end_time(self) -> float:
        """When it ended."""
        return self.solution.end

    # translate: skip
    def until(self, solution: DenseSolution, end_state: State) -> "Segment":
        """Return the segment that ends earlier, with the solution and the state up to there."""
        return replace(
            self,
            solution=solution,
            end_state=end_state,
            mode_end=None,
            transition=None,
            steps=min(self.steps, len(solution.terms)),
        )


@dataclass(frozen=True)
class Mode(ABC):
    """A way to move."""

    top: Top
    """The top in natural units."""

    name: ClassVar[str]
    """Its name in a result, unless `status` says more."""
    touching: ClassVar[bool] = True
    """Whether the top is in contact with the table."""

    @property
    def tops(self) -> tuple[Top, ...]:
        """The top with each surface active that touches: one, where a mode does not say
        otherwise.
        """
        return (self.top,)

    def on_tops(self, tops: Sequence[Top]) -> Self:
        """Return the mode of tops of the same kinds with other numbers."""
        return replace(self, top=tops[0])

    @property
    def status(self) -> str:
        """Name of the motion in a result, without the surfaces that touch."""
        return self.name

    @property
    def form(self) -> str:
        """Name of the equations of motion, of which a status may have several."""
        return self.status

    @property
    def reading_key(self) -> tuple[Any, ...]:
        """Modes of the same key and tops read the same from their numbers."""
        return (self.form,)

    @property
    def label(self) -> str:
        """Its name, with the numbers of the surfaces that touch if the body has several."""
        return self.status + self._place

    @property
    def torque_free(self) -> bool:
        """Whether the table's torque takes no energy in it."""
        return self.top.torque_free

    @property
    def _place(self) -> str:
        """The end of the label: the surfaces that touch, if the body has several."""
        if not self.touching or not isinstance(self.top.surface, Hull):
            return ""
        touching = sorted(top.number for top in self.tops)
        return f"_on_{'_and_'.join(map(str, touching))}"

    @abstractmethod
    def segments(
        self, time: float, state: State, end: float, integrator: Integrator
    ) -> Iterator[Segment]:
        """Move from a time and state until a guard ends the mode, or until `end`, piece by
        piece.
        """

    @abstractmethod
    def state(self, y: Row) -> State:
        """Return the state from the numbers of the mode, in plain operators."""

    def reaction(self, y: Row) -> Reaction:
        """Return the contact force and torque, from the numbers of the mode, in plain operators."""
        return NO_REACTION


@dataclass(frozen=True)
class IntegratedMode(Mode):
    """A mode stated by its equations of motion and guards."""

    @property
    def lasting(self) -> bool:
        """Whether runs may spend most of their steps in it."""
        return True

    def without_tops(self) -> Self:
        """Return the mode without its tops: modes of one form and law are equal then."""
        no_top: Any = None
        return replace(self, top=no_top)

    @property
    @abstractmethod
    def motion(self) -> Motion:
        """Equations of motion and guards; the same object for all tops of one kind."""

    @property
    def parameters(self) -> tuple[Scalar, ...]:
        """The parameters of the equations of motion."""
        return self.top.numbers

    @abstractmethod
    def numbers(self, state: State) -> tuple[Scalar, ...]:
        """Return the numbers that the equations move, from a state, in plain operators."""

    def segments(
        self, time: float, state: State, end: float, integrator: Integrator
    ) -> Iterator[Segment]:
        """Integrate the equations of motion."""
        begin = time, as_array(self.numbers(state))
        for arc in integrator.integrate(self.motion, self.parameters, begin, end):
            yield self.segment(arc, end)

    def segment(self, arc: Arc, end: float) -> Segment:
        """Return an arc of the motion as a segment of a run that lasts until `end`."""
        last = self.state(arc.end_state.tolist())
        how = None
        if arc.failure is not None:
            how = ModeEnd(FAILURE, last, detail=arc.failure)
        elif arc.guard is not None:
            how = self.end_by_guard(arc.guard, last)
        elif arc.solution.end >= end:
            how = ModeEnd(COMPLETED, last)
        solution = self.solution_of(arc)
        return Segment(self, solution, last, how, arc.steps, arc.evaluations, method=arc.method)

    def solution_of(self, arc: Arc) -> DenseSolution:
        """Return the solution of an arc, in steps that what is read off the mode is smooth in."""
        return arc.solution

    def end_by_guard(self, name: str, last: State) -> ModeEnd:
        """Return the end of the mode by a guard of some name, in a last state."""
        return ModeEnd.by_guard(name, last)
