"""What follows when contact begins or ends, for each way of treating lift-off."""

from dataclasses import dataclass, replace
from typing import ClassVar, Self

from tippetop.contact.double import on_two
from tippetop.contact.flight import TOUCHING, Flight
from tippetop.contact.mode import Event, EventKind, Mode, Outcome, Rules, Transition
from tippetop.contact.sliding import Sliding, stopping
from tippetop.contact.sticking import SlipEnd, SlipOnset, Sticking
from tippetop.contact.surfaces import number_of
from tippetop.mechanics.double_contact import double_contact, without_tilting
from tippetop.mechanics.flight import gap, gap_rate
from tippetop.mechanics.hull import lowest_surface
from tippetop.mechanics.impact import impact
from tippetop.mechanics.invariants import energy
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


SLOWEST_ROCKING = 1e-7
"""Velocity, in units of sqrt(g R), below which rocking between two surfaces has come to its end.

Infinitely many impacts, now of one and now of the other, bring both to touch at once in a finite time. Where
a gap falls back with more than g, this is faster as the square root: hops stay out of reach of rounding.
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
        lowest = self.top._replace(surface=lowest_surface(self.top.surface, state.axis[2]))
        if lowest != self.top:
            return replace(self, top=lowest).launch(state)
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

    def touch(self, surface: int, time: float, state: State) -> Transition:
        """Collide with another surface, and go on as the impact leaves the top."""
        return self.on(surface).touchdown(time, state)

    def resting(self, time: float, state: State, events: tuple[Event, ...] = ()) -> Transition:
        """As for all, but where the table would have to pull from now on, not from zero force, it lets go.

        Another surface that touches too, and opens no faster than a rebound that is none, is part of it.
        """
        for other in self.top.each:
            if other != self.top and gap(state, other) <= TOUCHING:
                rate = gap_rate(state, other)
                if rate < -SLOWEST_ROCKING:
                    return replace(self, top=other)._collide(time, state, events, 0.0)
                if rate <= self._slowest(other, state):
                    return self._resting_on_two(other, time, state, events)
                events = (*events, Event(EventKind.OPENING, time, surface=number_of(other)))
        return self._resting_on_one(time, state, events)

    def _resting_on_one(self, time: float, state: State, events: tuple[Event, ...]) -> Transition:
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
        hit = self.event(EventKind.IMPACT, time, float(collision.impulse), float(collision.energy_lost))
        after = collision.state
        if not collision.impulse:
            # Nothing but rounding kept the contact from being a resting one.
            if len(self.top.each) > 1:
                return self.resting(time, after, events)
            return Transition(events, self.sliding(after), after)
        if rebounds:
            return Transition((*events, hit), self._flight(Start.REBOUND), after)
        return self.resting(time, after, (*events, hit))

    def _slowest(self, other: Top, state: State) -> float:
        """Velocity of another surface that touches too below which it stays, or comes back at once."""
        sliding = along_table(state)
        if is_set_valued(self.top.friction) and not is_slipping(*sliding, other):
            return SLOWEST_ROCKING
        back = abs(double_contact(sliding, (self.top, other)).acceleration[1])
        return float(SLOWEST_ROCKING * max(1.0, back) ** 0.5)

    def _resting_on_two(self, other: Top, time: float, state: State, events: tuple[Event, ...]) -> Transition:
        """The resolver of two contacts that are closed and have no normal velocities: who stays closed."""
        mine = without_tilting(state, self.top)
        if is_set_valued(self.top.friction):
            sliding = along_table(mine)
            if not all(is_slipping(*sliding, top) for top in (self.top, other)):
                detail = "two surfaces touch, and one does not slip: that is followed no further"
                return Transition(events, Outcome.FAILED, state, detail)
        pair = double_contact(along_table(mine), (self.top, other))
        lost = float(energy(state, self.top) - energy(mine, self.top))
        here = (pair.normal[0] > 0.0) & (pair.normal[1] > 0.0)
        alone = (pair.first.free_acceleration < 0.0) & (pair.acceleration[1] >= 0.0)
        another = (pair.second.free_acceleration < 0.0) & (pair.acceleration[0] >= 0.0)
        neither = (pair.first.free_acceleration >= 0.0) & (pair.second.free_acceleration >= 0.0)
        if here + alone + another + neither != 1:
            detail = "not exactly one set of forces is consistent with two surfaces that touch"
            return Transition(events, Outcome.FAILED, state, detail)
        if here:
            event = self.event(EventKind.DOUBLE_CONTACT, time, 0.0, lost)
            return Transition((*events, event), on_two(mine, self, other), mine)
        if another:
            return replace(self, top=other)._resting_on_one(time, state, events)
        return self._resting_on_one(time, state, events)

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
