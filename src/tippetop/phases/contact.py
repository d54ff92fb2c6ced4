"""What follows when contact begins or ends, for each way of treating lift-off."""

from dataclasses import dataclass

import numpy as np

from tippetop.integrators.base import Array
from tippetop.mechanics.flight import gap_rate
from tippetop.mechanics.impact import impact
from tippetop.mechanics.motion import along_table, contact
from tippetop.mechanics.state import State
from tippetop.mechanics.top import Kind
from tippetop.mechanics.touchdown import Start
from tippetop.phases.base import Event, EventKind, Outcome, Transition
from tippetop.phases.flight import Flight
from tippetop.phases.sliding import Sliding

SLOWEST_REBOUND = 1e-6
"""Rebound velocity, in units of sqrt(g R), below which a rebound is none and the top stays on the table.

A rebound of this speed rises by half its square, 5e-13 radii. Without such an end, the bounces of a top with
restitution between 0 and 1 would be infinitely many in a finite time.
"""


@dataclass(frozen=True)
class StopAtLiftOff:
    """The run ends where the table would have to pull."""

    def lift_off(self, time: float, state: Array) -> Transition:
        """End the run."""
        return Transition((Event(EventKind.LIFT_OFF, time),), Outcome.LIFTED_OFF, state)

    def touchdown(self, time: float, state: Array) -> Transition:
        """Never happens: a run that stops at lift-off has no flights."""
        raise NotImplementedError


@dataclass(frozen=True)
class FreeToFly:
    """The top leaves the table where that would have to pull, flies, and comes back with an impact.

    Attributes
    ----------
    top
        What kind of top it is.
    numbers
        Its dimensionless numbers.
    restitution
        Ratio of the normal impulses of restitution and compression.
    """

    top: Kind
    numbers: tuple[float, ...]
    restitution: float

    def lift_off(self, time: float, state: Array) -> Transition:
        """Fly from where the normal force reached zero."""
        return Transition((Event(EventKind.LIFT_OFF, time),), self._flight(Start.LIFT_OFF), state)

    def touchdown(self, time: float, state: Array) -> Transition:
        """Collide, and go on as the impact leaves the top."""
        return self._collide(time, state, (Event(EventKind.TOUCHDOWN, time),), self.restitution)

    def resting(self, time: float, state: Array, events: tuple[Event, ...] = ()) -> Transition:
        """Go on from contact without normal velocity: slide, or leave a table that would have to pull.

        Where no normal force is consistent with the friction (Painleve's paradox), an impact without approach
        takes as much slip away as it needs to: Darboux's and Keller's way out.
        """
        sliding = along_table(State.unpack(state.tolist()))
        touch = contact(sliding.axis, sliding.momentum, sliding.velocity, self.top.top(self.numbers))
        if touch.resistance <= 0:
            return self._collide(time, state, events, 0.0)
        if touch.push > 0:
            return Transition(events, Sliding(self.top, self.numbers, self), state)
        lift_off = Event(EventKind.LIFT_OFF, time)
        return Transition((*events, lift_off), self._flight(Start.RELEASE), state)

    def _collide(
        self, time: float, state: Array, events: tuple[Event, ...], restitution: float
    ) -> Transition:
        top = self.top.top(self.numbers)
        before = State.unpack(state.tolist())
        collision = impact(before, restitution, top)
        rebounds = gap_rate(collision.state, top) > SLOWEST_REBOUND
        if restitution and not rebounds:
            collision = impact(before, 0.0, top)
        hit = Event(EventKind.IMPACT, time, float(collision.impulse), float(collision.energy_lost))
        after = np.array(collision.state.pack())
        if not collision.impulse:
            # Nothing but rounding kept the contact from being a resting one.
            return Transition(events, Sliding(self.top, self.numbers, self), after)
        if rebounds:
            return Transition((*events, hit), self._flight(Start.REBOUND), after)
        return self.resting(time, after, (*events, hit))

    def _flight(self, start: Start) -> Flight:
        return Flight(self.top, self.numbers, self, start)
