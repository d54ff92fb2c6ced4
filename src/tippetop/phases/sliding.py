"""The top touches the table and slides."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from tippetop.integrators.base import Array, Function, Guard, Integrator, Motion
from tippetop.mechanics.motion import along_table, contact, on_table, sliding_rates
from tippetop.mechanics.state import SlidingState, State
from tippetop.mechanics.top import Kind
from tippetop.mechanics.vectors import Scalar
from tippetop.phases.base import Outcome, PhaseKind, Stretch, Transition, Transitions


@dataclass(frozen=True)
class Sliding:
    """Sliding, as long as the normal force is positive or the table may pull.

    Attributes
    ----------
    top
        What kind of top it is.
    numbers
        Its dimensionless numbers.
    transitions
        What follows when the normal force falls to zero; None where the table may pull.
    """

    top: Kind
    numbers: tuple[float, ...]
    transitions: Transitions | None

    def follow(self, start: tuple[float, Array], end: float, times: Array, integrator: Integrator) -> Stretch:
        """Integrate the equations of motion; see `tippetop.phases.base.Phase`."""
        begin = np.array(along_table(State.unpack(start[1].tolist())).pack())
        guards = lift_off_guard(self.top) if self.transitions else ()
        motion = sliding_motion(self.top)
        arc = integrator.integrate(motion, self.numbers, (start[0], begin), end, times, guards)
        last = self._whole(arc.end_state[None])[0]
        if arc.failure is not None:
            transition = Transition((), Outcome.FAILED, last, arc.failure)
        elif arc.guard is not None and self.transitions is not None:
            transition = self.transitions.lift_off(arc.end_time, last)
        else:
            transition = Transition((), Outcome.COMPLETED, last)
        return Stretch(
            PhaseKind.SLIDING,
            arc.times,
            self._whole(arc.states),
            arc.end_time,
            last,
            transition,
            arc.steps,
            arc.evaluations,
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
