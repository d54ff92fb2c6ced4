"""What follows when contact begins or ends, for each way of treating lift-off."""

from dataclasses import dataclass, replace
from typing import ClassVar

from tippetop.contact.flight import Flight
from tippetop.contact.mode import Event, EventKind, Mode, Outcome, Rules, Transition
from tippetop.contact.sliding import Sliding, stopping
from tippetop.contact.sticking import SlipEnd, SlipOnset, Sticking
from tippetop.mechanics.flight import gap, gap_rate
from tippetop.mechanics.impact import impact
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
from tippetop.mechanics.units import Units
from tippetop.problem import Contact

SLOWEST_REBOUND = 1e-6
"""Rebound velocity, in units of sqrt(g R), below which a rebound is none and the top stays on the table.

A rebound of this speed rises by half its square, 5e-13 radii. Without such an end, the bounces of a top with
restitution between 0 and 1 would be infinitely many in a finite time.
"""

TOUCHING = 1e-12
"""Gap, and gap rate, in natural units, up to which a launch is one from rest on the table."""


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

    def launch(self, state: State) -> Transition:
        """Go on from contact."""
        return self.resting(0.0, state)

    def lift_off(self, time: float, state: State) -> Transition:
        """Never happens: the table may pull."""
        raise NotImplementedError

    def touchdown(self, time: float, state: State) -> Transition:
        """Never happens: there are no flights."""
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
        return Transition((Event(EventKind.STICK, time),), mode, mode.state(numbers))

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
        return Transition((Event(EventKind.LIFT_OFF, time),), Outcome.LIFTED_OFF, state)


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
        return Transition((Event(EventKind.LIFT_OFF, time),), self._flight(Start.LIFT_OFF), state)

    def touchdown(self, time: float, state: State) -> Transition:
        """Collide, and go on as the impact leaves the top."""
        return self._collide(time, state, (Event(EventKind.TOUCHDOWN, time),), self.restitution)

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
            collision = impact(state, restitution, self.top)
            rebounds = gap_rate(collision.state, self.top) > SLOWEST_REBOUND
            if restitution and not rebounds:
                collision = impact(state, 0.0, self.top)
        except ArithmeticError as error:
            return Transition(events, Outcome.FAILED, state, str(error))
        hit = Event(EventKind.IMPACT, time, float(collision.impulse), float(collision.energy_lost))
        after = collision.state
        if not collision.impulse:
            # Nothing but rounding kept the contact from being a resting one.
            return Transition(events, self.sliding(after), after)
        if rebounds:
            return Transition((*events, hit), self._flight(Start.REBOUND), after)
        return self.resting(time, after, (*events, hit))

    def _flight(self, start: Start) -> Flight:
        return Flight(self.top, self, start)


def rules_for(top: Top, liftoff: str, restitution: float) -> Rules:
    """The rules of a top in natural units.

    Parameters
    ----------
    top
        The top.
    liftoff
        "ignore", "stop" or "fly".
    restitution
        Ratio of the normal impulses of restitution and compression.
    """
    if liftoff == "fly":
        return FreeToFly(top, restitution)
    return StopAtLiftOff(top) if liftoff == "stop" else Bilateral(top)


def rules_of(way: Contact, top: Top, units: Units) -> Rules:
    """The rules of a top in natural units: those that its problem's contact brings, or the usual."""
    own: Rules | None = way.rules(top, units)
    return rules_for(top, way.liftoff, way.restitution) if own is None else own
