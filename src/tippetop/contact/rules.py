"""What follows when contact begins or ends, for each way of treating lift-off."""

from dataclasses import dataclass, replace
from typing import ClassVar, Self

from tippetop.contact.loosening import BothLoosening, Loosening
from tippetop.contact.mode import (
    Event,
    EventKind,
    IntegratedMode,
    Mode,
    Outcome,
    Transition,
    failed,
)
from tippetop.contact.passing import Resting
from tippetop.contact.sliding import Sliding, SlidingWithoutRolling
from tippetop.contact.sticking import Sticking, StickingWithoutRolling
from tippetop.contact.stopping import Stopping
from tippetop.contact.surfaces import lies_flat, number_of
from tippetop.integrators.base import Integrator
from tippetop.mechanics.beginning import Beginning, settling
from tippetop.mechanics.branches import is_branched, on_branch, on_limit_branch
from tippetop.mechanics.contacts.contact_point import ContactPoint
from tippetop.mechanics.ending import Vanishing
from tippetop.mechanics.jamming import past_jamming, stuck_at_once
from tippetop.mechanics.motion import along_table, contact, on_table, presses
from tippetop.mechanics.rolling import contact_motion, is_set_valued
from tippetop.mechanics.state import State
from tippetop.mechanics.stick_slip import (
    HORIZON,
    come_to_rest,
    inner,
    is_near,
    is_rolling,
    is_slipping,
    slip_of,
)
from tippetop.mechanics.top import Top
from tippetop.mechanics.unsolved import Unsolved
from tippetop.mechanics.vectors import Scalar
from tippetop.mechanics.wrench import Wrench

REST = 1e-13
"""Velocities and accelerations, in natural units, that are rounding in a body at rest."""


@dataclass(frozen=True)
class Rules:
    """What all rules have in common: the resolver of a contact that is closed and has no normal
    velocity.
    """

    top: Top
    """The top in natural units."""

    pulls: ClassVar[bool] = False
    """Whether the table may pull, so that contact does not end."""

    def on(self, surface: int) -> Self:
        """The rules of the top with another of its surfaces active."""
        return replace(self, top=self.top.each[surface])

    def launch(self, state: State) -> Transition:
        """Go on from contact."""
        return self.resting(0.0, state)

    def event(self, kind: EventKind, time: float, impulse: float = 0.0, lost: float = 0.0) -> Event:
        """Something that happens to the surface that is active."""
        return Event(kind, time, impulse, lost, number_of(self.top))

    def going_on(self, state: State, *, slips: bool) -> Mode:
        """Slide, or stick; or follow slip, or rolling, to its end where that is near already."""
        ending, left = self._next_to_end(state, slips)
        if ending is not None and left <= HORIZON:
            return Stopping(self._branched(state, slips), self, ending)
        rolls = self._rolls(state)
        if slips:
            top, sliding = self._branched(state, slips), along_table(state)
            near = is_set_valued(top.friction) and bool(is_near(sliding, top))
            return (Sliding if rolls else SlidingWithoutRolling)(top, self, near)
        return (Sticking if rolls else StickingWithoutRolling)(self._branched(state, slips), self)

    def stopping(self, state: State, *, slips: bool) -> Transition:
        """Follow what ends first to its end; where a guard was touched by rounding, nothing
        does.
        """
        ending, _ = self._next_to_end(state, slips)
        if ending is None:
            return Transition((), self.going_on(state, slips=slips), state)
        return Transition((), Stopping(self._branched(state, slips), self, ending), state)

    def settled(
        self,
        time: float,
        state: State,
        new: tuple[bool, bool],
        *,
        held: bool = False,
        events: tuple[Event, ...] = (),
    ) -> Transition:
        """Hold what has ended, slip or rolling (new) or what was held already, if the table can; or
        let go.

        What is tried first is to hold everything, then to let slip begin, rolling, and both.
        """
        ended = (new[0] or (held and new[1]), new[1] or (held and new[0]))
        state = on_table(come_to_rest(along_table(state), self.top, *ended), self.top)
        point = ContactPoint.of(state.axis, state.momentum, self.top)
        slip = None if ended[0] else slip_of(*along_table(state), self.top)
        rolling = None if ended[1] else point.turning[:2]
        try:
            found, begins = settling(point, slip, rolling)
        except ArithmeticError as error:
            return failed("The force that holds the contact", error, state, events)
        events = (*events, *_marks(self, time, new, begins))
        return self._settle(time, state, found, begins, ended, events)

    def beside_others(self, time: float, found: Transition) -> Transition:
        """What follows on this contact, of which else touches: it alone, where no rules say
        otherwise.
        """
        return found

    def giving_way(
        self,
        state: State,
        events: tuple[Event, ...],
        beginning: Vanishing,
        wrench: Wrench | None = None,
    ) -> Transition:
        """Slip, or rolling, begins from the limit of what the table can hold, which is a wrench."""
        return Transition(events, Loosening(self.top, self, beginning, 2, wrench), state)

    def _settle(
        self,
        time: float,
        state: State,
        found: Beginning,
        begins: tuple[bool, bool],
        ended: tuple[bool, bool],
        events: tuple[Event, ...],
    ) -> Transition:
        """The mode that follows where it is known what is held and what begins."""
        if found.wrench.force[2] <= 0.0 and not self.pulls:
            return self._let_go(time, state, events)
        if all(begins):
            return Transition(events, BothLoosening(self.top, self), state)
        if any(begins):
            ending = Vanishing(begins[0], held=ended[1] if begins[0] else ended[0])
            return Transition(events, Loosening(self.top, self, ending, 1), state)
        mode = self.going_on(state, slips=not ended[0])
        at, turning = found.acceleration
        if isinstance(mode, IntegratedMode) and rests(state, *turning, *at[:2]):
            return Transition(events, Resting(self.top, self, mode), state)
        return Transition(events, mode, state)

    def _rolls(self, state: State) -> bool:
        """Whether nothing holds rolling."""
        return not self.top.resists_rolling or bool(
            is_rolling(state.axis, state.momentum, self.top)
        )

    def _branched(self, state: State, slips: bool) -> Top:
        """The top with the branch of its law that holds."""
        if not is_branched(self.top.friction):
            return self.top
        if slips:
            return on_branch(self.top, slip_of(*along_table(state), self.top))
        point = ContactPoint.of(state.axis, state.momentum, self.top)
        rolling = point.turning[:2] if self._rolls(state) else None
        return on_limit_branch(self.top, contact_motion(point, None, rolling)[0])

    def _next_to_end(self, state: State, slips: bool) -> tuple[Vanishing | None, float]:
        """Which velocity ends first at present rates, and the time left; none if all grow or none
        can end.
        """
        rolls, ends = self._rolls(state), slips and is_set_valued(self.top.friction)
        possible = [Vanishing(slip=True, held=not rolls)] if ends else []
        possible += (
            [Vanishing(slip=False, held=not slips)] if rolls and self.top.resists_rolling else []
        )
        if not possible:
            return None, float("inf")
        sliding, top = along_table(state), self._branched(state, slips)
        point = ContactPoint.of(state.axis, state.momentum, top)
        slip = slip_of(*sliding, top) if slips else None
        acceleration = contact_motion(point, slip, point.turning[:2] if rolls else None)[1]
        found, least = None, float("inf")
        for ending in possible:
            xi = ending.of(*sliding, top)
            change = inner(xi, ending.rate(acceleration, top))
            left = inner(xi, xi) / -change if change < 0.0 else float("inf")
            if left < least:
                found, least = ending, left
        return found, least

    def resting(self, time: float, state: State, events: tuple[Event, ...] = ()) -> Transition:
        """Go on from contact without normal velocity: slide, stick, or leave a table that would
        have to pull; or lie flat.

        Where no normal force is consistent with the friction (Painleve's paradox), an impact
        without approach takes as much slip away as it needs to: Darboux's and Keller's way out.
        """
        if lies_flat(self.top, state.axis):
            return Transition(events, Outcome.LYING_FLAT, state)
        sliding = along_table(state)
        stuck = is_set_valued(self.top.friction) and not is_slipping(*sliding, self.top)
        held = not self._rolls(state)
        if stuck or held:
            return self.settled(time, state, (stuck, held), events=events)
        touch = contact(sliding.axis, sliding.momentum, sliding.velocity, self.top)
        if touch.delassus <= 0 and not self.pulls:
            return self.inconsistent(time, state, events)
        if touch.free_acceleration < 0 or self.pulls:
            return Transition(events, self.going_on(state, slips=True), state)
        return self._let_go(time, state, events)

    def lift_off(self, time: float, state: State) -> Transition:
        """Leave the table, unless the normal force changed its sign by way of infinity.

        Then it is decided anew how contact goes on: Painleve's paradox begins, or the motion is so
        stiff that errors of an explicit method look like that.
        """
        if presses(state.axis, state.momentum, self.top):
            return self.resting(time, state)
        return self._leaving(time, state)

    def jammed(self, time: float, state: State) -> Transition | None:
        """What follows where friction that turns made the normal force grow beyond all bounds, if
        it did.
        """
        try:
            past = past_jamming(state, self.top)
        except ArithmeticError as error:
            what = "What follows where friction jams the contact"
            return failed(what, error, state) if isinstance(error, Unsolved) else None
        if past is None:
            return None
        beyond, *taken = past
        found = self.inconsistent(time, beyond, ())
        if not found.events and isinstance(found.then, Mode):
            # Slip is so little that by rounding nothing strikes, and slipping on it would jam at
            # once.
            found = self.settled(time, stuck_at_once(beyond, self.top), (True, False))
        return begun_with(found, state, *taken)

    def _leaving(self, time: float, state: State) -> Transition:
        """What follows when the normal force falls to zero."""
        raise NotImplementedError

    def touchdown(
        self, time: float, state: State, integrator: Integrator | None = None
    ) -> Transition:
        """What follows when the top reaches the table; the integrator may follow the impact too."""
        raise NotImplementedError

    def touch(
        self, surface: int, time: float, state: State, integrator: Integrator | None = None
    ) -> Transition:
        """What follows when another surface of the top, of this number, reaches the table too."""
        raise NotImplementedError

    def _let_go(self, time: float, state: State, events: tuple[Event, ...]) -> Transition:
        """Lift-off after some events."""
        found = self._leaving(time, state)
        return replace(found, events=(*events, *found.events))

    def inconsistent(self, time: float, state: State, events: tuple[Event, ...]) -> Transition:
        """What follows where no contact force is consistent with the friction."""
        return Transition(
            events, Outcome.FAILED, state, "no contact force is consistent with the friction"
        )


def _marks(
    rules: Rules, time: float, new: tuple[bool, bool], begins: tuple[bool, bool]
) -> tuple[Event, ...]:
    """What is told where slip, or rolling, has newly ended and is held, or was held and begins."""
    told = []
    for ended, starts, stop, start in zip(
        new,
        begins,
        (EventKind.STICK, EventKind.HALT),
        (EventKind.SLIP, EventKind.ROLL),
        strict=True,
    ):
        if ended and not starts:
            told.append(rules.event(stop, time))
        elif starts and not ended:
            told.append(rules.event(start, time))
    return tuple(told)


def begun_with(found: Transition, before: State, impulse: float, lost: float) -> Transition:
    """What follows with an impact that had begun with some normal impulse, which took energy.

    A run that ends without one ends in the state before.
    """
    if not found.events and isinstance(found.then, Outcome):
        return replace(found, state=before)
    hit = [
        replace(event, impulse=event.impulse + impulse, energy_lost=event.energy_lost + lost)
        for event in found.events[:1]
        if event.kind is EventKind.IMPACT
    ]
    return replace(found, events=(*hit, *found.events[len(hit) :]))


def rests(state: State, *rates: Scalar) -> bool:
    """Whether a body in contact neither moves nor begins to, by the rates of its velocities."""
    return bool(max(map(abs, (*rates, *state.momentum, *state.velocity))) <= REST)
