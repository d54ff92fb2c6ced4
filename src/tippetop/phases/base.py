"""What every phase has in common.

All is in natural units (see `tippetop.mechanics.top`). A phase follows its motion until something ends it,
and then says what comes next: another phase, or the outcome of the run. The loop knows no mechanics.
"""

from dataclasses import dataclass
from enum import Enum, IntEnum
from typing import Protocol

from tippetop.integrators.base import Array, Integrator


class PhaseKind(IntEnum):
    """What the top is doing; the value marks samples in a result."""

    SLIDING = 0
    FLIGHT = 1


class Outcome(Enum):
    """How a run ended; the value is advice."""

    COMPLETED = "The run reached its end."
    LIFTED_OFF = (
        "The table would have to pull from here on; "
        "with liftoff = ignore it does, and with fly the top leaves it."
    )
    TOO_MANY_PHASES = (
        "The top bounced and slid more often than the run allows; "
        "shorten the duration, lower the restitution, or raise the limit on phases."
    )
    FAILED = (
        "The integrator could not go on: the motion became singular or too stiff for it; "
        "try another integrator, or less friction."
    )


class EventKind(Enum):
    """What can happen to a top; the value is its name in a result."""

    LIFT_OFF = "lift-off"
    TOUCHDOWN = "touchdown"
    IMPACT = "impact"


@dataclass(frozen=True)
class Event:
    """Something that happened at an instant.

    Attributes
    ----------
    kind
        What happened.
    time
        When.
    impulse, energy_lost
        Normal impulse of the table, and energy that went with it.
    """

    kind: EventKind
    time: float
    impulse: float = 0.0
    energy_lost: float = 0.0


@dataclass(frozen=True)
class Transition:
    """What follows the end of a phase.

    Attributes
    ----------
    events
        What happened, in order.
    then
        The next phase, or the outcome of the run.
    state
        The whole state in which the next phase begins, shape (16,).
    detail
        More about the outcome, where there is more to say.
    """

    events: tuple[Event, ...]
    then: "Phase | Outcome"
    state: Array
    detail: str = ""


@dataclass(frozen=True)
class Stretch:
    """What a phase made of its time.

    Attributes
    ----------
    kind
        What the top was doing.
    times, states
        Sample times within the phase, shape (k,), and whole states there, shape (k, 16).
    end_time, end_state
        When it ended, and the whole state then, shape (16,).
    transition
        What follows.
    steps, evaluations
        Work done by the integrator.
    highest_gap
        How high the top's lowest point rose above the table.
    """

    kind: PhaseKind
    times: Array
    states: Array
    end_time: float
    end_state: Array
    transition: Transition
    steps: int = 0
    evaluations: int = 0
    highest_gap: float = 0.0


class Phase(Protocol):
    """A way to move."""

    def follow(self, start: tuple[float, Array], end: float, times: Array, integrator: Integrator) -> Stretch:
        """Move from a time and whole state (shape (16,)) until the phase ends, or until `end`.

        Parameters
        ----------
        start
            Time and whole state, shape (16,), in which the phase begins.
        end
            When the run ends.
        times
            Increasing sample times from the start to the end of the run, shape (k,).
        integrator
            The method, for phases that need one.
        """


class Transitions(Protocol):
    """What follows when a phase ends before the run does."""

    def lift_off(self, time: float, state: Array) -> Transition:
        """What follows when the normal force falls to zero."""

    def touchdown(self, time: float, state: Array) -> Transition:
        """What follows when the top reaches the table."""
