"""What follows when contact begins or ends, for each way of treating lift-off."""

from dataclasses import dataclass, replace
from typing import ClassVar, Self

from tippetop.contact.flight import TOUCHING, Flight
from tippetop.contact.mode import Event, EventKind, Mode, Outcome, Transition
from tippetop.contact.sliding import Sliding, stopping
from tippetop.contact.sticking import SlipEnd, SlipOnset, Sticking
from tippetop.contact.surfaces import number_of
from tippetop.mechanics.flight import gap, gap_rate
from tippetop.mechanics.impact import Impact, impact
from tippetop.mechanics.motion import along_table, contact
from tippetop.mechanics.rolling import (
    ContactPoint,
    contact_wrench,
    is_set_valued,
    on_branch,
    on_limit_branch,
)
from tippetop.mechanics.state import State
from tippetop.mechanics.stick_slip import is_slipping, slip_guard, slip_of
from tippetop.mechanics.top import Top
from tippetop.mechanics.touchdown import Start

SLOWEST_REBOUND = 1e-6
"""Rebound velocity, in units of sqrt(g R), below which a rebound is none and the top stays on the table.

A rebound of this speed rises by half its square, 5e-13 radii. Without such an end, the bounces of a top with
restitution between 0 and 1 would be infinitely many in a finite time.
"""


@dataclass(frozen=True)
class ContactRules:
    """What all rules have in common: the resolver of a contact that is closed and has no normal velocity.

    Attributes
    ----------
    top
        The top in natural units.
    """

    top: Top

    pulls: ClassVar[bool] = False

    def on(self, surface: int) -> Self:
        """The rules with another surface active."""
        return replace(self, top=self.top.each[surface])

    def launch(self, state: State) -> Transition:
        """Go on from contact."""
        return self.resting(0.0, state)

    def lift_off(self, time: float, state: State) -> Transition:
        """Never happens: the table may pull."""
        raise NotImplementedError

    def touchdown(self, time: float, state: State) -> Transition:
        """Never happens: there are no flights."""
        raise NotImplementedError

    def touch(self, surface: int, time: float, state: State) -> Transition:
        """Never happens: a body of several surfaces may fly."""
        raise NotImplementedError

    def sliding(self, state: State) -> Mode:
        """Slide, or follow slip to its end where that is near already."""
        if not is_set_valued(self.top.friction):
            return Sliding(self.top, self)
        y = along_table(state)
        top = on_branch(self.top, slip_of(*y, self.top))
        near = stopping(y, top) <= 0.0
        return SlipEnd(top, self) if near else Sliding(top, self)

    def stopping(self, time: float, state: State) -> Transition:
        """Follow slip to its end."""
        top = on_branch(self.top, slip_of(*along_table(state), self.top))
        return Transition((), SlipEnd(top, self), state)

    def without_slip(self, time: float, state: State) -> Transition:
        """Stick, if the limit surface admits the forces that needs, or slip from rest."""
        if slip_guard(state.axis, state.momentum, self.top) < 0.0:
            return Transition((), SlipOnset(self.top, self, 1), state)
        point = ContactPoint.of(state.axis, state.momentum, self.top)
        mode = Sticking(on_limit_branch(self.top, contact_wrench(point, None, point.turning[:2])), self)
        numbers = mode.numbers(state)
        if mode.reaction(numbers).force[2] <= 0.0 and not self.pulls:
            return self.lift_off(time, state)
        return Transition((self.event(EventKind.STICK, time),), mode, mode.state(numbers))

    def resting(self, time: float, state: State, events: tuple[Event, ...] = ()) -> Transition:
        """Go on from contact without normal velocity: slide, stick, or leave a table that would have to pull.

        Where no normal force is consistent with the friction (Painleve's paradox), an impact without approach
        takes as much slip away as it needs to: Darboux's and Keller's way out.
        """
        sliding = along_table(state)
        if is_set_valued(self.top.friction) and not is_slipping(*sliding, self.top):
            found = self.without_slip(time, state)
            return replace(found, events=(*events, *found.events))
        touch = contact(sliding.axis, sliding.momentum, sliding.velocity, self.top)
        if touch.delassus <= 0 and not self.pulls:
            return self.inconsistent(time, state, events)
        if touch.free_acceleration < 0 or self.pulls:
            return Transition(events, self.sliding(state), state)
        found = self.lift_off(time, state)
        return replace(found, events=(*events, *found.events))

    def event(self, kind: EventKind, time: float, impulse: float = 0.0, lost: float = 0.0) -> Event:
        """Something that happens to the surface that is active."""
        return Event(kind, time, impulse, lost, number_of(self.top))

    def inconsistent(self, time: float, state: State, events: tuple[Event, ...]) -> Transition:
        """What follows where no contact force is consistent with the friction."""
        return Transition(events, Outcome.FAILED, state, "no contact force is consistent with the friction")


@dataclass(frozen=True)
class Bilateral(ContactRules):
    """The table may pull: the top never leaves it."""

    pulls: ClassVar[bool] = True


@dataclass(frozen=True)
class StopAtLiftOff(ContactRules):
    """The run ends where the table would have to pull."""

    def lift_off(self, time: float, state: State) -> Transition:
        """End the run."""
        return Transition((self.event(EventKind.LIFT_OFF, time),), Outcome.LIFTED_OFF, state)


@dataclass(frozen=True)
class FreeToFly(ContactRules):
    """The top leaves the table where that would have to pull, flies, and comes back with an impact.

    Attributes
    ----------
    restitution
        Ratio of the normal impulses of restitution and compression.
    """

    restitution: float

    def launch(self, state: State) -> Transition:
        """Fly from above the table or if thrown up, collide if thrown down, and else go on from contact."""
        if gap(state, self.top) > TOUCHING:
            return Transition((), self._flight(Start.AIRBORNE), state)
        rate = gap_rate(state, self.top)
        if rate > TOUCHING:
            return Transition((), self._flight(Start.REBOUND), state)
        if rate < -TOUCHING:
            return self.touchdown(0.0, state)
        return self.resting(0.0, state)

    def lift_off(self, time: float, state: State) -> Transition:
        """Fly from where the normal force reached zero."""
        return Transition((self.event(EventKind.LIFT_OFF, time),), self._flight(Start.LIFT_OFF), state)

    def touchdown(self, time: float, state: State) -> Transition:
        """Collide, and go on as the impact leaves the top."""
        return self._collide(time, state, (self.event(EventKind.TOUCHDOWN, time),), self.restitution)

    def resting(self, time: float, state: State, events: tuple[Event, ...] = ()) -> Transition:
        """As for all, but where the table would have to pull from now on, not from zero force, it lets go."""
        found = super().resting(time, state, events)
        if isinstance(found.then, Flight) and found.then.start is Start.LIFT_OFF:
            return replace(found, then=self._flight(Start.RELEASE))
        return found

    def inconsistent(self, time: float, state: State, events: tuple[Event, ...]) -> Transition:
        """Collide without approach, unless that has just left it so: then rounding decides, not friction."""
        if sum(event.kind is EventKind.IMPACT for event in events) > 1:
            return super().inconsistent(time, state, events)
        return self._collide(time, state, events, 0.0)

    def _collide(
        self, time: float, state: State, events: tuple[Event, ...], restitution: float
    ) -> Transition:
        try:
            collision = self._impact(state, restitution)
            rebounds = gap_rate(collision.state, self.top) > SLOWEST_REBOUND
            if restitution and not rebounds:
                collision = self._impact(state, 0.0)
        except ArithmeticError as error:
            return Transition(events, Outcome.FAILED, state, str(error))
        hit = self.event(EventKind.IMPACT, time, float(collision.impulse), float(collision.energy_lost))
        after = collision.state
        if not collision.impulse:
            # Nothing but rounding kept the contact from being a resting one.
            return self._untouched(time, after, events)
        if rebounds:
            return Transition((*events, hit), self._flight(Start.REBOUND), after)
        return self.resting(time, after, (*events, hit))

    def _impact(self, state: State, restitution: float) -> Impact:
        return impact(state, restitution, self.top)

    def _untouched(self, time: float, state: State, events: tuple[Event, ...]) -> Transition:
        return Transition(events, self.sliding(state), state)

    def _flight(self, start: Start) -> Flight:
        return Flight(self.top, self, start)
