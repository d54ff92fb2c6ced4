"""What follows where the table would have to pull: it may, or the run ends, or the top flies."""

from dataclasses import dataclass, replace
from typing import ClassVar

from tippetop.contact.flight import TOUCHING, Flight
from tippetop.contact.mode import Event, EventKind, Outcome, Transition, failed
from tippetop.contact.rules import Rules
from tippetop.contact.striking import impact_of_patch
from tippetop.contact.surfaces import lies_flat
from tippetop.integrators.base import Integrator
from tippetop.mechanics.flight import gap, gap_rate
from tippetop.mechanics.impact import Impact, impact
from tippetop.mechanics.motion import along_table
from tippetop.mechanics.rolling import is_set_valued
from tippetop.mechanics.state import State
from tippetop.mechanics.stick_slip import inner, slip_of
from tippetop.mechanics.touchdown import Start

SLOWEST_REBOUND = 1e-6
"""Rebound velocity, in units of sqrt(g R), below which a rebound is none and the top stays on the
table.

A rebound of this speed rises by half its square, 5e-13 radii. Without such an end, the bounces of a
top with restitution between 0 and 1 would be infinitely many in a finite time.
"""


@dataclass(frozen=True)
class Bilateral(Rules):
    """The table may pull: the top never leaves it."""

    pulls: ClassVar[bool] = True


@dataclass(frozen=True)
class StopAtLiftOff(Rules):
    """The run ends where the table would have to pull."""

    def _leaving(self, time: float, state: State) -> Transition:
        """End the run."""
        return Transition((self.event(EventKind.LIFT_OFF, time),), Outcome.LIFTED_OFF, state)


@dataclass(frozen=True)
class FreeToFly(Rules):
    """The top leaves the table where that would have to pull, flies, and comes back with an
    impact.
    """

    restitution: float
    """Ratio of the normal impulses of restitution and compression."""

    def launch(self, state: State) -> Transition:
        """Fly from above the table or if thrown up, collide if thrown down, and else go on from
        contact.
        """
        if gap(state, self.top) > TOUCHING:
            return Transition((), self._flight(Start.AIRBORNE), state)
        rate = gap_rate(state, self.top)
        if rate > TOUCHING:
            return Transition((), self._flight(Start.REBOUND), state)
        if rate < -TOUCHING:
            return self.touchdown(0.0, state)
        return self.resting(0.0, state)

    def _leaving(self, time: float, state: State) -> Transition:
        """Fly from where the normal force reached zero."""
        return Transition(
            (self.event(EventKind.LIFT_OFF, time),), self._flight(Start.LIFT_OFF), state
        )

    def touchdown(
        self, time: float, state: State, integrator: Integrator | None = None
    ) -> Transition:
        """Collide, unless with a face, and go on as the impact leaves the top."""
        told = (self.event(EventKind.TOUCHDOWN, time),)
        if lies_flat(self.top, state.axis):
            return Transition(told, Outcome.LYING_FLAT, state)
        return self._collide(time, state, told, self.restitution, integrator)

    def _let_go(self, time: float, state: State, events: tuple[Event, ...]) -> Transition:
        """Fly from where the table would have to pull from now on, not from zero force."""
        return replace(super()._let_go(time, state, events), then=self._flight(Start.RELEASE))

    def inconsistent(self, time: float, state: State, events: tuple[Event, ...]) -> Transition:
        """Collide without approach, unless that has just left it so: then rounding decides, not
        friction.
        """
        if sum(event.kind is EventKind.IMPACT for event in events) > 1:
            return super().inconsistent(time, state, events)
        return self._collide(time, state, events, 0.0)

    def _collide(
        self,
        time: float,
        state: State,
        events: tuple[Event, ...],
        restitution: float,
        integrator: Integrator | None = None,
    ) -> Transition:
        try:
            collision = self._impact(state, restitution, integrator)
            rebounds = gap_rate(collision.state, self.top) > SLOWEST_REBOUND
            if restitution and not rebounds:
                taken = collision.steps
                collision = self._impact(state, 0.0, integrator)
                collision = collision._replace(steps=taken + collision.steps)
        except ArithmeticError as error:
            return failed("The impulse of the impact", error, state, events)
        hit = replace(
            self.event(
                EventKind.IMPACT, time, float(collision.impulse), float(collision.energy_lost)
            ),
            steps=collision.steps,
        )
        after = collision.state
        if not collision.impulse:
            # Nothing but rounding kept the contact from being a resting one.
            return self._untouched(time, after, events)
        if rebounds:
            return Transition((*events, hit), self._flight(Start.REBOUND), after)
        return self.resting(time, after, (*events, hit))

    def _impact(self, state: State, restitution: float, integrator: Integrator | None) -> Impact:
        found = None if restitution else impact_of_patch(state, self.top, integrator)
        return impact(state, restitution, self.top) if found is None else found

    def _untouched(self, time: float, state: State, events: tuple[Event, ...]) -> Transition:
        slip = slip_of(*along_table(state), self.top)
        slips = not is_set_valued(self.top.friction) or inner(slip, slip) > 0.0
        return Transition(events, self.going_on(state, slips=slips), state)

    def _flight(self, start: Start) -> Flight:
        return Flight(self.top, self, start)
