"""What follows when a surface of a body that has several touches the table, or leaves it."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Self

from tippetop.contact.double import SLOWEST_SLIP
from tippetop.contact.flight import TOUCHING
from tippetop.contact.liftoff import FreeToFly
from tippetop.contact.mode import Before, Event, EventKind, IntegratedMode, Outcome, Transition
from tippetop.contact.surfaces import lies_flat, number_of
from tippetop.contact.two_closed import rolling_of
from tippetop.contact.two_resolver import settled, slipping
from tippetop.integrators.base import Integrator
from tippetop.mechanics.contact_pair import ContactPair, Tops, without_tilting
from tippetop.mechanics.contacts.system import free_rates, rates_under
from tippetop.mechanics.flight import gap, gap_rate
from tippetop.mechanics.hull import lowest_surface
from tippetop.mechanics.impact import Impact, impact
from tippetop.mechanics.impact_on_two import SlipEnds
from tippetop.mechanics.motion import along_table
from tippetop.mechanics.rolling import contact_motion, is_set_valued
from tippetop.mechanics.state import State
from tippetop.mechanics.stick_slip import size, slip_of
from tippetop.mechanics.surface import support_at
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Vector
from tippetop.mechanics.wrench import Wrench

SLOWEST_ROCKING = 1e-7
"""Velocity, in units of sqrt(g R), below which rocking between two surfaces has come to its end.

Infinitely many impacts, now of one and now of the other, bring both to touch at once in a finite
time. Where a gap falls back with more than g, this is faster as the square root: rebounds stay out
of reach of rounding.
"""

MOST_IN_TURNS = 200
"""Impacts at one instant, now of one surface and now of another, after which a run is given up."""


@dataclass(frozen=True)
class OnSeveral(FreeToFly):
    """The rules of a body of several surfaces, of which one is active: it may fly, and rock."""

    def launch(self, state: State) -> Transition:
        """As for one surface: that which reaches lowest."""
        lowest = self.top._replace(surface=lowest_surface(self.top.surface, state.axis[2]))
        return self._of(lowest)._launch(state)

    def _launch(self, state: State) -> Transition:
        return super().launch(state)

    def _of(self, top: Top) -> Self:
        return replace(self, top=top)

    def _beside(self, state: State) -> list[Top]:
        """The top with each of the other surfaces active that touch, what sinks fastest first."""
        others = [
            other for other in self.top.each if other != self.top and gap(state, other) <= TOUCHING
        ]
        return sorted(others, key=lambda other: float(gap_rate(state, other)))

    def touch(
        self, surface: int, time: float, state: State, integrator: Integrator | None = None
    ) -> Transition:
        """Collide with another surface, and go on as the impact leaves the top.

        Where more come to the table at once, the outermost strikes: what lies between sinks more
        slowly.
        """
        striking = self.on(surface)
        faster = [
            other
            for other in self._beside(state)[:1]
            if gap_rate(state, other) < gap_rate(state, striking.top)
        ]
        return (self._of(faster[0]) if faster else striking).touchdown(time, state, integrator)

    def resting(self, time: float, state: State, events: tuple[Event, ...] = ()) -> Transition:
        """As for one surface, unless others touch too, and open no faster than rocking that has
        ended.

        Where one of them stays, the tilt does, and all do that touch: the body rests on the
        outermost.
        """
        closed, told, beside = False, events, self._beside(state)
        if any(lies_flat(other, state.axis) for other in beside):
            return Transition(events, Outcome.LYING_FLAT, state)
        for other in beside:
            rate = gap_rate(state, other)
            if rate < -SLOWEST_ROCKING:
                if sum(event.kind is EventKind.IMPACT for event in events) >= MOST_IN_TURNS:
                    return Transition(
                        events, Outcome.FAILED, state, "surfaces strike in turns for ever"
                    )
                return self._of(other)._collide(time, state, told, 0.0)
            if self._stays(other, state):
                closed = True
            else:
                told = (*told, Event(EventKind.OPENING, time, surface=number_of(other)))
        if not closed:
            return self.resting_alone(time, state, told)
        tops = outermost((self.top, *beside), state.axis)
        before = Before((), bool(rolling_of(state, self.top)))
        rolls = rolling_of(without_tilting(state, self.top), self.top)
        return settled(self._of(tops[0]), time, state, tops, before, rolls, events, arrived=True)

    def beside_others(self, time: float, found: Transition) -> Transition:
        """As it is, unless it presses another surface that touches onto the table: then both are
        resolved.
        """
        mode = found.then
        if isinstance(mode, IntegratedMode) and self._presses(mode, found.state):
            # What sticks is told anew.
            halts = [event for event in found.events if event.kind is EventKind.HALT]
            return self.resting(time, found.state, tuple(halts))
        return found

    def _presses(self, mode: IntegratedMode, state: State) -> bool:
        """Whether one of the others that touch, and open no faster than what stays, is drawn to the
        table.
        """
        reaction = mode.reaction(mode.numbers(state))
        wrench = Wrench(reaction.force, reaction.torque)
        return any(
            self._stays(other, state) and self._opening(other, state, wrench) < 0.0
            for other in self._beside(state)
        )

    def _opening(self, other: Top, state: State, wrench: Wrench) -> float:
        """Return the acceleration of another surface's gap under a wrench at the active one."""
        pair = ContactPair.of(state.axis, state.momentum, (self.top, other))
        return float(rates_under(pair, [(0, wrench)], free_rates(pair)).points[1][2])

    def _impact(self, state: State, restitution: float, integrator: Integrator | None) -> Impact:
        """That of the active surface alone, unless it presses another that touches onto the table.

        Where slip ends meanwhile, under a law that leaves the force open then, the surfaces strike
        in turns.
        """
        alone = super()._impact(state, restitution, integrator)
        for other in self._beside(alone.state):
            pressed = gap_rate(alone.state, other) < -SLOWEST_ROCKING
            if pressed and abs(gap_rate(state, other)) <= SLOWEST_ROCKING:
                try:
                    found = impact(state, restitution, self.top, other)
                except SlipEnds:
                    return alone
                return found._replace(steps=alone.steps + found.steps)
        return alone

    def _untouched(self, time: float, state: State, events: tuple[Event, ...]) -> Transition:
        return self.resting(time, state, events)

    def _stays(self, other: Top, state: State) -> bool:
        """Whether another surface that touches too stays, or comes back at once.

        Or does not come out of the table, in which it is by no more than what is taken for
        touching.
        """
        back, depth = 1.0, max(0.0, float(gap(state, self.top) - gap(state, other)))
        if self._slips(other, state):
            pair = ContactPair.of(state.axis, state.momentum, (self.top, other))
            slip = slip_of(*along_table(state), self.top)
            wrench = contact_motion(pair.first, slip, pair.first.turning[:2])[0]
            back = float(abs(self._opening(other, state, wrench)))
        slowest = max(SLOWEST_ROCKING * max(1.0, back) ** 0.5, (2.0 * back * depth) ** 0.5)
        return bool(gap_rate(state, other) <= slowest)

    def _slips(self, other: Top, state: State) -> bool:
        """Whether both contacts slip, faster than where slip on two contacts ends, if it can end at
        all.
        """
        if not is_set_valued(self.top.friction):
            return True
        return all(
            size(slip_of(*along_table(state), top)) > SLOWEST_SLIP for top in (self.top, other)
        )

    def resting_alone(self, time: float, state: State, events: tuple[Event, ...]) -> Transition:
        """As for one surface, whatever else touches."""
        return super().resting(time, state, events)

    def settled_on_two(
        self, time: float, state: State, tops: Tops, before: Before, rolls: float
    ) -> Transition:
        """As the resolver of two contacts finds."""
        return settled(self, time, state, tops, before, rolls)

    def slipping_on_two(
        self, time: float, state: State, tops: Tops, which: str, rolls: float
    ) -> Transition:
        """Slip begins at the limit of what the table can hold."""
        return slipping(self, time, state, tops, which, rolls)


def outermost(touching: Sequence[Top], axis: Vector) -> Tops:
    """The two of some tops that touch farthest apart, in their order: a surface touches at -h' s
    along e.

    What lies between them touches without force: all contact points are in a line, on which a rigid
    body rests on two. How three would share its weight is not told by what they do to it, but where
    it slides and turns at once.
    """
    places = [float(support_at(axis, top.surface)[1]) for top in touching]
    first, second = sorted((places.index(min(places)), places.index(max(places))))
    return touching[first], touching[second]
