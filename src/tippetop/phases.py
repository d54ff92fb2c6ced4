"""The phases of a run as values: how the top moves in each, what ends it, and what comes next.

All is in natural units (see `tippetop.mechanics.top`). A phase follows its motion until a guard ends it and
then says what comes next: another phase, or the outcome of the run. The loop over phases knows no mechanics.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum, IntEnum
from functools import lru_cache
from typing import Protocol

import numpy as np

from tippetop.integrators.base import Array, Function, Guard, Integrator, Motion
from tippetop.mechanics.motion import along_table, contact, on_table, sliding_rates
from tippetop.mechanics.state import SlidingState, State
from tippetop.mechanics.top import Kind
from tippetop.mechanics.vectors import Scalar


class PhaseKind(IntEnum):
    """What the top is doing; the value marks samples in a result."""

    SLIDING = 0


class Outcome(Enum):
    """How a run ended; the value is advice."""

    COMPLETED = "The run reached its end."
    LIFTED_OFF = (
        "The table would have to pull from here on; "
        "with liftoff = ignore it does, and with fly the top leaves it."
    )
    FAILED = (
        "The integrator could not go on: the motion became singular or too stiff for it; "
        "try another integrator, or less friction."
    )


class EventKind(Enum):
    """What can happen to a top; the value is its name in a result."""

    LIFT_OFF = "lift-off"


@dataclass(frozen=True)
class Event:
    """Something that happened at an instant.

    Attributes
    ----------
    kind
        What happened.
    time
        When.
    """

    kind: EventKind
    time: float


@dataclass(frozen=True)
class Stretch:
    """What a phase made of its time.

    Attributes
    ----------
    times, states
        Sample times within the phase, shape (k,), and whole states there, shape (k, 16).
    end_time, end_state
        When it ended, and the whole state then, shape (16,).
    steps, evaluations
        Work done by the integrator.
    events
        What happened at the end.
    then
        The next phase, or the outcome of the run.
    next_state
        The state in which the next phase begins, shape (16,).
    detail
        More about the outcome, where there is more to say.
    """

    times: Array
    states: Array
    end_time: float
    end_state: Array
    steps: int
    evaluations: int
    events: tuple[Event, ...]
    then: "Phase | Outcome"
    next_state: Array
    detail: str = ""


class Phase(Protocol):
    """A way to move."""

    @property
    def kind(self) -> PhaseKind:
        """What the top is doing."""

    def follow(self, start: tuple[float, Array], end: float, times: Array, integrator: Integrator) -> Stretch:
        """Move from a time and whole state (shape (16,)) until the phase ends, or until `end`."""


@dataclass(frozen=True)
class Sliding:
    """The top touches the table and slides, as long as the normal force is positive or the table may pull.

    Attributes
    ----------
    top
        What kind of top it is.
    numbers
        Its dimensionless numbers.
    may_pull
        Whether the table holds the top when the normal force is negative.
    """

    top: Kind
    numbers: tuple[float, ...]
    may_pull: bool

    @property
    def kind(self) -> PhaseKind:
        """Sliding."""
        return PhaseKind.SLIDING

    def follow(self, start: tuple[float, Array], end: float, times: Array, integrator: Integrator) -> Stretch:
        """Integrate the equations of motion until the normal force falls through zero."""
        begin = np.array(along_table(State.unpack(start[1].tolist())).pack())
        guards = () if self.may_pull else lift_off_guard(self.top)
        if not self.may_pull and normal_force(self.top)(begin.tolist(), self.numbers) <= 0:
            event = Event(EventKind.LIFT_OFF, start[0])
            here = times[times <= start[0]]
            states = np.tile(start[1], (len(here), 1))
            return Stretch(here, states, *start, 0, 0, (event,), Outcome.LIFTED_OFF, start[1])
        motion = sliding_motion(self.top)
        arc = integrator.integrate(motion, self.numbers, (start[0], begin), end, times, guards)
        states = self._whole(arc.states)
        last = self._whole(arc.end_state[None])[0]
        then = Outcome.COMPLETED
        events: tuple[Event, ...] = ()
        if arc.failure is not None:
            then = Outcome.FAILED
        elif arc.guard is not None:
            then, events = Outcome.LIFTED_OFF, (Event(EventKind.LIFT_OFF, arc.end_time),)
        return Stretch(
            arc.times,
            states,
            arc.end_time,
            last,
            arc.steps,
            arc.evaluations,
            events,
            then,
            last,
            arc.failure or "",
        )

    def _whole(self, states: Array) -> Array:
        """Whole states, shape (k, 16), from those of a sliding top, shape (k, 14)."""
        whole = on_table(SlidingState.unpack(tuple(states.T)), self.top.top(self.numbers))
        return np.stack(whole.pack(), axis=1)


@lru_cache
def sliding_motion(kind: Kind) -> Motion:
    """Equations of motion of a sliding top of this kind."""

    def rates(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> tuple[Scalar, ...]:
        return sliding_rates(SlidingState.unpack(y), kind.top(tuple(numbers))).pack()

    return Motion(rates, size=14, parameters=kind.numbers)


@lru_cache
def normal_force(kind: Kind) -> Function:
    """Normal force on a sliding top of this kind as a function of its state and numbers."""

    def value(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> Scalar:
        state = SlidingState.unpack(y)
        return contact(state.axis, state.momentum, state.velocity, kind.top(tuple(numbers))).normal_force

    return value


@lru_cache
def lift_off_guard(kind: Kind) -> tuple[Guard, ...]:
    """The guard that ends sliding where the normal force falls through zero."""
    return (Guard("lift-off", normal_force(kind)),)
