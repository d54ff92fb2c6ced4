"""What follows when contact begins or ends, for each way of treating lift-off."""

from dataclasses import dataclass

from tippetop.contact.flight import Flight
from tippetop.contact.mode import Event, EventKind, Outcome, Rules, Transition
from tippetop.contact.sliding import Sliding
from tippetop.mechanics.flight import gap, gap_rate
from tippetop.mechanics.impact import impact
from tippetop.mechanics.motion import along_table, contact
from tippetop.mechanics.state import State
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
class Bilateral:
    """The table may pull: the top slides all the time.

    Attributes
    ----------
    top
        The top in natural units.
    """

    top: Top

    def launch(self, state: State) -> Transition:
        """Slide."""
        return Transition((), Sliding(self.top, None), state)

    def lift_off(self, time: float, state: State) -> Transition:
        """Never happens."""
        raise NotImplementedError

    def touchdown(self, time: float, state: State) -> Transition:
        """Never happens."""
        raise NotImplementedError


@dataclass(frozen=True)
class StopAtLiftOff:
    """The run ends where the table would have to pull.

    Attributes
    ----------
    top
        The top in natural units.
    """

    top: Top

    def launch(self, state: State) -> Transition:
        """Slide, if the table need not pull."""
        sliding = along_table(state)
        if contact(sliding.axis, sliding.momentum, sliding.velocity, self.top).free_acceleration >= 0:
            return self.lift_off(0.0, state)
        return Transition((), Sliding(self.top, self), state)

    def lift_off(self, time: float, state: State) -> Transition:
        """End the run."""
        return Transition((Event(EventKind.LIFT_OFF, time),), Outcome.LIFTED_OFF, state)

    def touchdown(self, time: float, state: State) -> Transition:
        """Never happens: a run that stops at lift-off has no flights."""
        raise NotImplementedError


@dataclass(frozen=True)
class FreeToFly:
    """The top leaves the table where that would have to pull, flies, and comes back with an impact.

    Attributes
    ----------
    top
        The top in natural units.
    restitution
        Ratio of the normal impulses of restitution and compression.
    """

    top: Top
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
        return self._resting(0.0, state)

    def lift_off(self, time: float, state: State) -> Transition:
        """Fly from where the normal force reached zero."""
        return Transition((Event(EventKind.LIFT_OFF, time),), self._flight(Start.LIFT_OFF), state)

    def touchdown(self, time: float, state: State) -> Transition:
        """Collide, and go on as the impact leaves the top."""
        return self._collide(time, state, (Event(EventKind.TOUCHDOWN, time),), self.restitution)

    def _resting(self, time: float, state: State, events: tuple[Event, ...] = ()) -> Transition:
        """Go on from contact without normal velocity: slide, or leave a table that would have to pull.

        Where no normal force is consistent with the friction (Painleve's paradox), an impact without approach
        takes as much slip away as it needs to: Darboux's and Keller's way out.
        """
        sliding = along_table(state)
        touch = contact(sliding.axis, sliding.momentum, sliding.velocity, self.top)
        if touch.delassus <= 0:
            return self._collide(time, state, events, 0.0)
        if touch.free_acceleration < 0:
            return Transition(events, Sliding(self.top, self), state)
        lift_off = Event(EventKind.LIFT_OFF, time)
        return Transition((*events, lift_off), self._flight(Start.RELEASE), state)

    def _collide(
        self, time: float, state: State, events: tuple[Event, ...], restitution: float
    ) -> Transition:
        collision = impact(state, restitution, self.top)
        rebounds = gap_rate(collision.state, self.top) > SLOWEST_REBOUND
        if restitution and not rebounds:
            collision = impact(state, 0.0, self.top)
        hit = Event(EventKind.IMPACT, time, float(collision.impulse), float(collision.energy_lost))
        after = collision.state
        if not collision.impulse:
            # Nothing but rounding kept the contact from being a resting one.
            return Transition(events, Sliding(self.top, self), after)
        if rebounds:
            return Transition((*events, hit), self._flight(Start.REBOUND), after)
        return self._resting(time, after, (*events, hit))

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
