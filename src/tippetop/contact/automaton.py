"""The automaton of contact modes: it decides which mode follows where one ends.

A mode says what ended it (`ModeEnd`); the automaton says what follows (`Transition`). No other file
names next modes. Read `RULES` first: one rule for every cause of a mode's end. What comes to rest
normally on the table goes through `Automaton.resting`, and from there to one contact
(`Automaton.resolve`) or two (`Automaton.resolve_two`). Both ask the resolver for every consistent
answer (`tippetop.mechanics.contacts.consistent_answers`), and `Automaton._chosen` takes one.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, TypeAlias

from tippetop.contact.closed_contacts import ClosedContacts
from tippetop.contact.closed_pair import Before, ClosedPair, rolling_of
from tippetop.contact.collision import SLOWEST_REBOUND, collision
from tippetop.contact.contact_mode import ContactMode, mode_on_two, sliding_on_two
from tippetop.contact.face_impact import NOT_TIPPED, SLOWEST_ON_FACE, face_impact
from tippetop.contact.face_mode import (
    STOPPED,
    TIPPING,
    FaceMode,
    HeldAtRim,
    PressedAtRim,
    mode_at_rim,
)
from tippetop.contact.flight import LANDING, TOUCHING, Flight, Start
from tippetop.contact.guards import (
    BRANCH,
    ENDING,
    LIFT_OFF,
    LIMIT_BRANCH,
    OPENING,
    ROLLING,
    ROLLING_STOPPING,
    SLIP,
    SLIP_LARGE,
    SLIP_SMALL,
    STOPPING,
)
from tippetop.contact.mode import (
    COMPLETED,
    FAILURE,
    Event,
    EventKind,
    IntegratedMode,
    Mode,
    ModeEnd,
    Status,
    Transition,
    failed,
)
from tippetop.contact.settling_flat import FLAT, SettlingFlat, settling_flat
from tippetop.contact.slip_end_mode import SlipEnd, clock_at
from tippetop.contact.slip_end_motion import (
    JAMMED,
    OVERTAKEN,
    REACHED_ZERO,
    REOPENING,
    contacts_in_clock,
)
from tippetop.contact.slip_onset import ENDED, ONSET_OVER, UNSEEN, SlipOnset
from tippetop.contact.soonest_end import on_present_branch, rolls_freely, soonest_end
from tippetop.contact.surfaces import (
    FACE,
    FLAT_END,
    TOUCH,
    WOBBLE,
    lands_flat,
    lies_flat,
    lies_on_flat_end,
)
from tippetop.contact.tip_onset import TILTED, TipOnset
from tippetop.contact.touching import (
    SLOWEST_ROCKING,
    gap_acceleration,
    other_touching,
    outermost,
    stays_closed,
)
from tippetop.contact.transient import AT_REST, SLIP_AND_ROLLING, Resting, TransientMode
from tippetop.mechanics.contacts.branches import (
    off_branch,
    on_branch,
    on_limit_branch,
    on_other_branch,
)
from tippetop.mechanics.contacts.consistent_answers import Answer, answers
from tippetop.mechanics.contacts.contact_point import ContactPoint
from tippetop.mechanics.contacts.forces import is_set_valued
from tippetop.mechanics.contacts.onset_forces import Onset, contact_after_end, find_onset
from tippetop.mechanics.contacts.pair import Tops, slips_of, without_tilting
from tippetop.mechanics.contacts.pair_resolution import Resolution, rolling_direction
from tippetop.mechanics.contacts.slip_clock import SlipComponent
from tippetop.mechanics.contacts.slip_variables import (
    HORIZON,
    come_to_rest,
    is_near,
    is_slipping,
    slip_of,
)
from tippetop.mechanics.contacts.wrench import Slip, Wrench
from tippetop.mechanics.face_motion import (
    BARELY_TILTED,
    LEAN,
    direction_against,
    face_gap_rate,
    face_speed,
    is_held_on_face,
    law_of_face,
    leaning,
    leaning_direction,
    lying_flat,
    onto_face,
    pressure_reserve,
    rim_speed,
    tipping_direction,
)
from tippetop.mechanics.flight.free_motion import gap, gap_rate
from tippetop.mechanics.impacts.jamming import past_jamming, stuck_at_once
from tippetop.mechanics.invariants import energy
from tippetop.mechanics.motion import along_table, falls_by_zero, on_table, sliding_contact
from tippetop.mechanics.state import State
from tippetop.mechanics.surfaces.hull import Hull, is_edge
from tippetop.mechanics.top import Top
from tippetop.mechanics.unsolved import Unsolved
from tippetop.mechanics.vectors import Horizontal, Scalar
from tippetop.support.errors import Described, InvalidInput

REST = 1e-13
"""Velocities and accelerations, in natural units, that are rounding in a body at rest."""

MOST_IN_TURNS = 200
"""Impacts at one instant, now of one surface and now of another, after which a run is given up."""

ON_FLAT_END = (
    "The body comes to lie on the flat end of a surface of arcs, on which no motion is simulated."
)
"""Detail of the status of a run that ends there."""


@dataclass(frozen=True)
class Automaton:
    """The rules of what follows each mode, for a body and a treatment of lift-off.

    A contact is the body with the surface active that touches (see `tippetop.mechanics.top.Top`).
    """

    top: Top
    """The body in natural units, with any of its surfaces active."""
    liftoff: str
    """Where the table would have to pull: "ignore" (it pulls), "stop" (the run ends) or "fly"."""
    restitution: float
    """Ratio of the normal impulses of restitution and compression."""
    indeterminate: str = "impact"
    """Where the contact force is indeterminate: "impact" or "liftoff"."""
    face_pressure: str = "uniform"
    """Pressure under a face: "uniform", "rim" or "ellipsoidal"."""

    @property
    def pulls(self) -> bool:
        """Whether the table may pull, so that contact does not end."""
        return self.liftoff == "ignore"

    # Launch, and the one decision of what follows a mode.

    def launch(self, state: State) -> Transition:
        """Return the first mode: flight, what follows an impact, or contact."""
        lowest = self.top.body.lowest_at(state.axis[2])
        if lies_flat(lowest, state.axis) and rim_speed(state.momentum, lowest) > SLOWEST_REBOUND:
            launched = self._launch_from_face(lowest, state)
            if launched is not None:
                return launched
        if self.liftoff != "fly":
            return self.resting(lowest, 0.0, state)
        if gap(state, lowest) > TOUCHING:
            return Transition((), Flight(lowest, Start.AIRBORNE), state)
        rate = gap_rate(state, lowest)
        if rate > TOUCHING:
            return Transition((), Flight(lowest, Start.REBOUND), state)
        if rate < -TOUCHING:
            return self.touchdown(lowest, 0.0, state)
        return self.resting(lowest, 0.0, state)

    def _launch_from_face(self, contact: Top, state: State) -> Transition | None:
        """Return the first mode of a body that starts flat with a rate of tilt, if it touches: its
        rim leaves the table, strikes it, or stays on it while the body tips.
        """
        if gap(state, contact) > TOUCHING:
            return None
        rate = face_gap_rate(state, contact)
        if rate < -TOUCHING:
            return self.touchdown(contact, 0.0, state)
        if rate > TOUCHING and self.liftoff == "fly":
            return Transition((), Flight(contact, Start.REBOUND), state)
        return self._tip(contact, 0.0, state, leaning_direction(state, contact), ())

    def follow(self, mode: Mode, end: ModeEnd, time: float) -> Transition:
        """Return what follows the end of a mode, by the rule of its cause in `RULES`."""
        rule = RULES.get(end.cause)
        if rule is None:
            raise without_rule(mode, end)
        return rule(self, mode, end, time)

    def _after_failure(self, mode: Mode, end: ModeEnd, time: float) -> Transition:
        """Return what follows where a mode cannot be followed: friction that turns may have jammed
        the contact, where no step is short enough.
        """
        failure = Transition((), Status.FAILED, end.state, end.detail)
        moving = mode.contact_mode if isinstance(mode, SlipEnd) else mode
        if isinstance(moving, ContactMode) and moving.slides_freely:
            return self.jammed(off_branch(mode.top), time, end.state) or failure
        return failure

    def _settle_flat(self, mode: Mode, end: ModeEnd, *, slaps: bool) -> Transition:
        """Return the mode in which a face closes onto the table, slapping or wobbling down."""
        moving = contact_mode_of(mode, end)
        return Transition((), SettlingFlat(moving.top, moving, slaps=slaps), end.state)

    def _after_settling(self, mode: Mode, end: ModeEnd, time: float) -> Transition:
        """Return what follows where a face has come down onto the table."""
        assert isinstance(mode, SettlingFlat)
        contact = off_branch(mode.top)
        if mode.slaps:
            return self.strike_face(contact, time, end.state, ())
        return self.lie_down(contact, time, end.state, (), lands=True)

    def _after_flight(self, contact: Top, end: ModeEnd, time: float) -> Transition:
        """Return what follows where a surface lands."""
        if end.contact == contact.number:
            return self.touchdown(contact, time, end.state)
        return self.touch(contact, end.contact, time, end.state)

    def _overtaken(self, mode: Mode, end: ModeEnd, _: float) -> Transition:
        """Return the end of the other velocity, which comes before that of the first."""
        assert isinstance(mode, SlipEnd)
        return Transition((), mode.of_second(), end.state)

    def _go_on(self, ended: Mode, end: ModeEnd, _: float) -> Transition:
        """Return the contact mode as it goes on, near an end of its velocities or not."""
        mode = contact_mode_of(ended, end)
        try:
            if mode.is_single:
                slips = not mode.sticks[0]
                following = self.mode_for(off_branch(mode.top), end.state, slips=slips)
            else:
                following = self._slides_on_two(end.state, mode.tops, mode.rolls)
        except ArithmeticError:
            return Transition((), Status.FAILED, end.state, UNSEEN)
        return Transition((), following, end.state)

    def _follow_to_end(self, ended: Mode, end: ModeEnd, time: float) -> Transition:
        """Return the clock of the velocity that ends first; where a guard was touched by rounding,
        none does.

        The rolling of two contacts ends as its guard says.
        """
        mode = contact_mode_of(ended, end)
        if not mode.is_single and end.cause == ROLLING_STOPPING:
            return self.resolve_two(time, end.state, mode.tops, Before.of(mode), 0.0)
        if mode.is_single:
            mode = self._contact_mode(off_branch(mode.top), end.state, slips=not mode.sticks[0])
        ending, _ = soonest_end(mode, end.state)
        if ending is None:
            return self._go_on(mode, end, time)
        return Transition((), ending, end.state)

    def _after_end(self, transient: Mode, end: ModeEnd, time: float) -> Transition:
        """Return what follows where a velocity has ended."""
        assert isinstance(transient, TransientMode)
        mode = transient.contact_mode
        if not mode.is_single:
            return self.resolve_two(time, end.state, mode.tops, Before.of(mode), mode.rolls)
        contact, slip = off_branch(mode.top), transient.components[0].slip
        held = mode.prevents_rolling if slip else mode.sticks[0]
        resolved = self.resolve(contact, time, end.state, (slip, not slip), held=held)
        return self._with_other_surfaces(contact, time, resolved)

    def _after_jam(self, ended: Mode, end: ModeEnd, time: float) -> Transition:
        """Return what follows where friction has jammed contacts that slip."""
        mode = contact_mode_of(ended, end)
        contact, state = off_branch(mode.top), end.state
        if mode.is_single:
            return self.jammed(contact, time, state) or self._strike(contact, time, state)
        jammed = ClosedPair.of(state, mode.tops, mode.rolls).jammed or contact
        return self.inconsistent(jammed, time, on_table(along_table(state), jammed), ())

    def _on_other_branch(self, ended: Mode, end: ModeEnd, _: float) -> Transition:
        """Return the mode on the branch of the law, or of its limit surface, that takes over."""
        mode = contact_mode_of(ended, end)
        tops = list(mode.tops)
        number = max(end.contact, 0)
        tops[number] = on_other_branch(tops[number])
        following = mode.with_tops(tops, mode.further)
        if isinstance(ended, SlipEnd):
            clock = SlipEnd.of(following, ended.component, clock_at(end))
            return Transition((), clock, end.state)
        return Transition((), following, end.state)

    def _open_one(self, ended: Mode, end: ModeEnd, time: float) -> Transition:
        """Return what follows where the normal force of one of two contacts changes its sign."""
        mode = contact_mode_of(ended, end)
        opening, stays = (mode.tops, mode.tops[::-1])[end.contact]
        state, slips = end.state, not mode.sticks[1 - end.contact]
        if not opens_by_zero(ended, end, opening) or (slips and _jams_alone(stays, state)):
            return self.resolve_two(time, state, mode.tops, Before.of(mode), mode.rolls)
        event = Event(EventKind.OPENING, time, surface=opening.number)
        state = state._replace(momentum=mode.stilled(state.axis, state.momentum))
        return Transition((event,), self.mode_for(off_branch(stays), state, slips=slips), state)

    def _slips(self, ended: Mode, end: ModeEnd, time: float) -> Transition:
        """Return what follows where the table can no longer hold slip."""
        mode = contact_mode_of(ended, end)
        if mode.is_single:
            return self._begins_on_one(mode, ended, end, time, SlipComponent(slip=True))
        return self.slip_on_two(time, end.state, mode, end.contact)

    def _rolls(self, ended: Mode, end: ModeEnd, time: float) -> Transition:
        """Return what follows where the table can no longer hold rolling."""
        mode = contact_mode_of(ended, end)
        if mode.is_single:
            return self._begins_on_one(mode, ended, end, time, SlipComponent(slip=False))
        rolls = rolling_direction(mode.contacts(mode.numbers(end.state)).forces)
        return self.resolve_two(time, end.state, mode.tops, Before.of(mode), rolls)

    def _turning_ends(self, ended: Mode, end: ModeEnd, time: float) -> Transition:
        """Return what follows where the body has stopped turning about one of two contacts.

        What the guard has ended is over, however much of it the error of a step leaves.
        """
        mode = contact_mode_of(ended, end)
        state, before = end.state, Before.of(mode)
        return self.resolve_two(time, state, mode.tops, before, mode.rolls, ended=(True, True))

    def _begins_on_one(
        self, mode: ContactMode, ended: Mode, end: ModeEnd, time: float, begins: SlipComponent
    ) -> Transition:
        """Return what follows where the table can no longer hold slip, or rolling, on one
        contact.
        """
        contact, state = off_branch(mode.top), end.state
        wrench: Wrench | None = None
        if ended is mode:
            wrench = mode.contacts(mode.numbers(state)).forces.wrenches[0]
            if wrench.force[2] <= 0.0 and not self.pulls:
                return self.lift_off(contact, time, mode, end)
        held = mode.prevents_rolling if begins.slip else mode.sticks[0]
        # A velocity that was about to end goes on beside one that begins.
        return self._begin(contact, time, state, begins, held and ended is mode, wrench)

    # One contact.

    def mode_for(self, contact: Top, state: State, *, slips: bool) -> Mode:
        """Return the mode of one contact that slips or sticks.

        Where the end of slip, or of rolling, is near already, that is followed in its clock.
        """
        mode = self._contact_mode(contact, state, slips=slips)
        settling = settling_flat(mode, state) if is_edge(mode.top.surface) else None
        if settling is not None:
            return settling
        ending, time_left = soonest_end(mode, state)
        return ending if ending is not None and time_left <= HORIZON else mode

    def _contact_mode(self, contact: Top, state: State, *, slips: bool) -> ContactMode:
        """Return the mode of one contact that slips or sticks, on the present branch of its law."""
        top = on_present_branch(contact, state, slips)
        rolls = rolls_freely(contact, state)
        near = slips and is_set_valued(top.friction) and bool(is_near(along_table(state), top))
        return ContactMode(top, (not slips,), not rolls, near, self.pulls and slips)

    def _begin(
        self,
        contact: Top,
        time: float,
        state: State,
        begins: SlipComponent,
        held: bool,
        wrench: Wrench | None,
    ) -> Transition:
        """Return what follows at the limit of what can be held: slip, or rolling, begins while the
        other goes on or is held.

        Or the contact opens, if strong friction alone has held it closed.
        """
        rolls = rolls_freely(contact, state)
        if begins.slip and rolls and self._opens_without_force(contact, state):
            return self._release(contact, time, state, ())
        kind = EventKind.SLIP if begins.slip else EventKind.ROLL
        event = Event(kind, time, surface=contact.number)
        point = ContactPoint.of(state.axis, state.momentum, contact, state.velocity[:2])
        slip = None if begins.slip or held else slip_of(*along_table(state), contact)
        rolling = None if held or not begins.slip else point.turning[:2]
        try:
            which = (begins.slip, not begins.slip)
            onset = find_onset(point, slip, rolling, which, held=wrench)
        except ArithmeticError as error:
            what = f"The direction in which {'slip' if begins.slip else 'rolling'} begins"
            return failed(what, error, state, (event,))
        return self._onset(contact, state, (begins,), held, (event,), onset)

    def _onset(
        self,
        contact: Top,
        state: State,
        components: tuple[SlipComponent, ...],
        held: bool,
        events: tuple[Event, ...],
        onset: Onset,
    ) -> Transition:
        """Return the mode in which velocities of one contact begin as `onset` says; `held` says
        whether the other is held, if only one begins.
        """
        slip_begins, rolling_begins = (
            any(component.slip for component in components),
            not all(component.slip for component in components),
        )
        sticks, still = held and not slip_begins, held and not rolling_begins
        top = (
            on_limit_branch(contact, onset.wrench)
            if onset.slip is None
            else on_branch(contact, onset.slip)
        )
        both: tuple[Any, Any] = onset.slip, onset.rolling
        directions = [both[0] if component.slip else both[1] for component in components]
        held_rolling = still and contact.resists_rolling
        mode = ContactMode(top, (sticks,), held_rolling, pulls=self.pulls and not sticks)
        return Transition(events, SlipOnset.of(mode, components, directions), state)

    def _opens_without_force(self, contact: Top, state: State) -> bool:
        """Return whether a contact would open without a force, b > 0, if the table cannot pull.

        Then friction alone holds one that sticks closed. Where it reaches its limit and nothing
        resists rolling, slip would need N = -b / A > 0, hence A < 0, and would at once be driven
        against its own direction: the contact opens.
        """
        point = ContactPoint.of(state.axis, state.momentum, contact, state.velocity[:2])
        return bool(point.free.point[2] > 0.0) and not self.pulls

    def resolve(
        self,
        contact: Top,
        time: float,
        state: State,
        new: tuple[bool, bool],
        *,
        held: bool = False,
        events: tuple[Event, ...] = (),
    ) -> Transition:
        """Go on on one contact: hold what has ended, slip or rolling (new) or what was held
        already, if the table can, or let it begin again; or open, or be struck.
        """
        ended = (new[0] or (held and new[1]), new[1] or (held and new[0]))
        if any(ended):
            state = on_table(come_to_rest(along_table(state), contact, *ended), contact)
        elif self.pulls:
            return Transition(events, self.mode_for(contact, state, slips=True), state)
        point = ContactPoint.of(state.axis, state.momentum, contact, state.velocity[:2])
        slip = None if ended[0] else slip_of(*along_table(state), contact)
        rolling = None if ended[1] else point.turning[:2]
        try:
            if self.pulls:
                consistent = [Answer((0,), *contact_after_end(point, slip, rolling))]
            else:
                consistent = answers((point,), (slip,), rolling)
        except ArithmeticError as error:
            return failed("The force that holds the contact", error, state, events)
        jams = not ended[0] and _jams_alone(contact, state)
        chosen = self._chosen(consistent, jams=jams)
        events = (*events, *_indeterminate(contact, time, consistent))
        if chosen is None:
            return self.inconsistent(contact, time, state, events)
        if not chosen.closed:
            return self._release(contact, time, state, events)
        return self._after_resolving(contact, time, state, chosen, new, ended, events)

    def _after_resolving(
        self,
        contact: Top,
        time: float,
        state: State,
        answer: Answer,
        new: tuple[bool, bool],
        ended: tuple[bool, bool],
        events: tuple[Event, ...],
    ) -> Transition:
        """Return the mode of a contact that goes on as an answer says."""
        onset, begins = answer.onset, answer.begins
        assert onset is not None
        events = (*events, *self._changes(contact, time, new, begins))
        if any(ended):
            state = on_table(come_to_rest(along_table(state), contact, *ended), contact)
        rolls = not (ended[1] and contact.resists_rolling)
        if begins[0] and rolls and self._opens_without_force(contact, state):
            return self._release(contact, time, state, events)
        if any(begins):
            components = SLIP_AND_ROLLING if all(begins) else (SlipComponent(begins[0]),)
            held = not all(begins) and (ended[1] if begins[0] else ended[0])
            return self._onset(contact, state, components, held, events, onset)
        mode = self.mode_for(contact, state, slips=not ended[0])
        at, turning = onset.acceleration
        if any(ended) and isinstance(mode, IntegratedMode) and rests(state, *turning, *at[:2]):
            return Transition(events, Resting(contact, mode), state)
        return Transition(events, mode, state)

    def _changes(
        self, contact: Top, time: float, new: tuple[bool, bool], begins: tuple[bool, bool]
    ) -> tuple[Event, ...]:
        """Return the events of slip, or rolling, that has newly ended and is held, or begins."""
        events = []
        for ended, starts, stop, start in zip(
            new,
            begins,
            (EventKind.STICK, EventKind.HALT),
            (EventKind.SLIP, EventKind.ROLL),
            strict=True,
        ):
            if ended and not starts:
                events.append(Event(stop, time, surface=contact.number))
            elif starts and not ended:
                events.append(Event(start, time, surface=contact.number))
        return tuple(events)

    def resting(
        self, contact: Top, time: float, state: State, events: tuple[Event, ...] = ()
    ) -> Transition:
        """Go on from contact without normal velocity, on one surface or on all that stay closed.

        Where another surface stays, the tilt does, and all do that touch: the body rests on the
        outermost two. One that sinks faster than rocking that has ended strikes.
        """
        if lies_on_flat_end(contact, state.axis):
            return Transition(events, Status.FAILED, state, ON_FLAT_END)
        beside = other_touching(contact, state)
        closed, reported = False, events
        for neighbour in beside:
            if lands_flat(neighbour, state.axis):
                return self.lie_down(neighbour, time, state, events)
        for neighbour in beside:
            if gap_rate(state, neighbour) < -SLOWEST_ROCKING:
                if sum(event.kind is EventKind.IMPACT for event in events) >= MOST_IN_TURNS:
                    detail = "surfaces strike in turns for ever"
                    return Transition(events, Status.FAILED, state, detail)
                return self._collide(neighbour, time, state, reported, 0.0)
            if stays_closed(contact, neighbour, state):
                closed = True
            else:
                reported = (*reported, Event(EventKind.OPENING, time, surface=neighbour.number))
        if not closed:
            return self.resting_alone(contact, time, state, reported)
        tops = outermost((contact, *beside), state.axis)
        before = Before((), bool(rolling_of(state, contact)))
        rolls = rolling_of(without_tilting(state, contact), contact)
        return self.resolve_two(time, state, tops, before, rolls, events, arrived=True)

    def resting_alone(
        self, contact: Top, time: float, state: State, events: tuple[Event, ...]
    ) -> Transition:
        """Go on on the active surface, whatever else touches: slide, stick, leave or lie flat.

        With A <= 0 the moment of friction closes the gap at least as fast as the normal force opens
        it (Painleve's paradox). If the contact would close without a force, no force is consistent,
        and an impact without approach takes as much slip away as it needs to, as Darboux and Keller
        propose. If it would open, the case is indeterminate: the contact may open, too, and the
        normal force -b / A is consistent as well, but the least disturbance grows without bound
        under it. `_chosen` decides, for two contacts as for one.
        """
        if lies_flat(contact, state.axis):
            return self.lie_down(contact, time, state, events)
        stuck = is_set_valued(contact.friction) and not is_slipping(*along_table(state), contact)
        held = not rolls_freely(contact, state)
        return self.resolve(contact, time, state, (stuck, held), events=events)

    def _chosen(self, consistent: Sequence[Answer], *, jams: bool) -> Answer | None:
        """Return the answer that the body takes; None where an impact without approach follows, or
        it is not known.

        What was closed before stays closed, and what is held stays so, where that is consistent.

        Parameters
        ----------
        consistent
            The answers that are consistent, of which those with the most closed contacts, and of
            these those with the fewest velocities that begin, come first.
        jams
            Whether an impact without approach begins at one of the contacts. Under a force that is
            consistent there, too, the least disturbance grows without bound.
        """
        if len(consistent) == 1:
            return consistent[0]
        if self.indeterminate == "liftoff" and consistent and not consistent[-1].closed:
            return consistent[-1]
        if jams or not consistent:
            return None
        first = consistent[0]
        is_largest = all(number in first.closed for each in consistent for number in each.closed)
        return first if is_largest else None

    # A face.

    def lie_down(
        self,
        contact: Top,
        time: float,
        state: State,
        events: tuple[Event, ...],
        *,
        lands: bool = False,
    ) -> Transition:
        """Go on on the face of the active edge, on which the body lies, or comes to lie if it
        `lands` there.
        """
        flat = lying_flat(state, contact)
        if flat == state and not lands:
            return self.on_face(contact, time, flat, events)
        lost = float(energy(state, contact) - energy(flat, contact))
        event = Event(EventKind.LIES_DOWN, time, energy_lost=lost, surface=contact.number)
        return self.on_face(contact, time, flat, (*events, event))

    def strike_face(
        self, contact: Top, time: float, state: State, events: tuple[Event, ...]
    ) -> Transition:
        """Collide with the face of the active edge, and go on as the impact leaves the body."""
        law_type = law_of_face(contact, self.face_pressure)
        if law_type is None:
            return self.lie_down(contact, time, state, events)
        try:
            struck = face_impact(state, self.restitution, contact, law_type)
        except ArithmeticError as error:
            return failed("The impulse of the impact", error, state, events)
        hit = Event(
            EventKind.IMPACT, time, struck.impulse, struck.energy_lost, contact.number, struck.steps
        )
        if struck.rebounds:
            return Transition((*events, hit), Flight(contact, Start.REBOUND), struck.state)
        return self.from_flat(contact, time, struck.state, (*events, hit))

    def from_flat(
        self, contact: Top, time: float, state: State, events: tuple[Event, ...]
    ) -> Transition:
        """Go on from an impact of a face without rebound: rock on over the rim, or lie down."""
        if rim_speed(state.momentum, contact) <= SLOWEST_REBOUND:
            return self.lie_down(contact, time, state, events, lands=True)
        direction = leaning_direction(state, contact)
        return self._onto_rim(contact, time, state, direction, events)

    def on_face(
        self, contact: Top, time: float, state: State, events: tuple[Event, ...]
    ) -> Transition:
        """Go on on the face of the active edge: slide and drill, or rest."""
        law_type = law_of_face(contact, self.face_pressure)
        if law_type is None:
            detail = "the friction law has no form for a flat face, on which the body lies"
            return Transition(events, Status.FAILED, state, detail)
        moves = bool(face_speed(state.velocity[:2], state.momentum, contact) > REST)
        if not moves and is_set_valued(contact.friction):
            return self._from_rest_on_face(contact, time, state, events)
        return self._slide_on_face(contact, time, state, events)

    def _from_rest_on_face(
        self, contact: Top, time: float, state: State, events: tuple[Event, ...]
    ) -> Transition:
        """Return what follows at rest on a face: the end of the run, slip down the slope, or where
        the face cannot hold the pressure tipping over its rim, which may stick.

        Slip begins with `SLOWEST_ON_FACE`, which has a direction.
        """
        law_type = law_of_face(contact, self.face_pressure)
        held = FaceMode(contact, law_type, slips=False)
        forces = held.forces(held.numbers(state))
        x, y, _ = forces.force
        holds = is_held_on_face(state.axis, contact)
        slips = state
        if not holds:
            factor = -SLOWEST_ON_FACE * (x * x + y * y) ** -0.5
            slips = state._replace(velocity=(factor * x, factor * y, 0.0))
        mode = held if holds else FaceMode(contact, law_type)
        if pressure_reserve(mode.forces(mode.numbers(slips)), contact) <= 0.0:
            return self._tip(contact, time, state, direction_against(x, y, state.axis[2]), events)
        if holds:
            event = Event(EventKind.RESTS, time, surface=contact.number)
            return Transition((*events, event), Resting(contact, held), state)
        event = Event(EventKind.SLIP, time, surface=contact.number)
        return Transition((*events, event), mode, slips)

    def _slide_on_face(
        self, contact: Top, time: float, state: State, events: tuple[Event, ...]
    ) -> Transition:
        """Return the mode in which a face slides, or where it cannot hold the pressure tips."""
        mode = FaceMode(contact, law_of_face(contact, self.face_pressure))
        if mode.tipping(mode.numbers(state)) <= 0.0:
            return self._tip_sliding(mode, time, state, events)
        return Transition(events, mode, state)

    def _after_sliding(self, mode: Mode, end: ModeEnd, time: float) -> Transition:
        """Return what follows where the pressure has come to the rim of a face that slides."""
        assert isinstance(mode, FaceMode)
        face = FaceMode(mode.top, mode.law_type)
        if mode != face and face.tipping(face.numbers(end.state)) > 0.0:
            slips = Event(EventKind.SLIP, time, surface=mode.top.number)
            return Transition((slips,) if isinstance(mode, HeldAtRim) else (), face, end.state)
        return self._tip_sliding(mode, time, end.state, ())

    def _tip_sliding(
        self, mode: FaceMode, time: float, state: State, events: tuple[Event, ...]
    ) -> Transition:
        """Return the mode in which a body that slides on its face begins to tip over its rim, or
        goes on upon its face where friction at the rim could not tip it.
        """
        following = mode_at_rim(mode, state)
        if following is None:
            direction = tipping_direction(state, mode.top)
            if direction is None:
                return Transition(events, Status.FAILED, state, NOT_TIPPED)
            return self._tip(mode.top, time, state, direction, events)
        if isinstance(following, HeldAtRim):
            event = Event(EventKind.ROLLS_ON_RIM, time, surface=mode.top.number)
            return Transition((*events, event), following, state)
        if isinstance(mode, HeldAtRim) or not isinstance(mode, PressedAtRim):
            event = Event(EventKind.PRESSED_AT_RIM, time, surface=mode.top.number)
            events = (*events, event)
        return Transition(events, following, state)

    def _tip(
        self,
        contact: Top,
        time: float,
        state: State,
        direction: Horizontal,
        events: tuple[Event, ...],
    ) -> Transition:
        """Return the mode in which the body begins to tip over its rim into a direction."""
        event = Event(EventKind.TIPS, time, surface=contact.number)
        return self._onto_rim(contact, time, state, direction, (*events, event))

    def _onto_rim(
        self,
        contact: Top,
        time: float,
        state: State,
        direction: Horizontal,
        events: tuple[Event, ...],
    ) -> Transition:
        """Return the mode in which the axis begins to lean into a direction: the rim slips, or
        sticks if friction can hold it. Or what follows where it does not stay on the table.

        At zero tilt the rim's point that touches is undefined: the forces are those of a body that
        is barely tilted.
        """
        x, y = direction
        touching = leaning(state, direction, LEAN)
        slips = bool(is_slipping(*along_table(touching), contact))
        sticks = is_set_valued(contact.friction) and not slips
        barely = leaning(state, direction, BARELY_TILTED)
        resolved = self.resolve(contact, time, barely, (sticks, False), events=events)
        following, edge = resolved.next, ContactMode(contact, pulls=self.pulls)
        later = resolved.events[len(events) :]
        if any(event.kind is EventKind.IMPACT for event in later):
            undecided = [event for event in later if event.kind is EventKind.INDETERMINATE]
            return self._strike_rim(contact, time, touching, (*events, *undecided))
        if isinstance(following, (Flight, Status)):
            return replace(resolved, state=state)
        if not sticks:
            return replace(resolved, next=TipOnset(contact, edge, direction), state=state)
        if isinstance(following, ContactMode):
            onset = TipOnset(contact, following, direction)
            return replace(resolved, next=onset, state=state)
        if isinstance(following, SlipOnset):
            u, v, sinking = state.velocity
            p, q = following.directions[0][:2]
            planar = not state.momentum[2] and abs(p * y - q * x) <= BARELY_TILTED
            p, q = ((p * x + q * y) * x, (p * x + q * y) * y) if planar else (p, q)
            velocity = (u + SLOWEST_ON_FACE * p, v + SLOWEST_ON_FACE * q, sinking)
            onset = TipOnset(contact, edge, direction, planar)
            return replace(resolved, next=onset, state=state._replace(velocity=velocity))
        return resolved

    def _strike_rim(
        self, contact: Top, time: float, state: State, events: tuple[Event, ...]
    ) -> Transition:
        """Collide without approach where friction has jammed the rim of a face; `state` leans onto
        the rim.
        """
        try:
            struck, rebounds = collision(state, 0.0, contact)
        except ArithmeticError as error:
            return failed("The impulse of the impact", error, state, events)
        impulse, lost = float(struck.impulse), float(struck.energy_lost)
        hit = Event(EventKind.IMPACT, time, impulse, lost, contact.number, struck.steps)
        flat = onto_face(struck.state, contact)
        if rebounds:
            return Transition((*events, hit), Flight(contact, Start.REBOUND), flat)
        return self.from_flat(contact, time, flat, (*events, hit))

    def _after_tipping(self, mode: Mode, end: ModeEnd, _: float) -> Transition:
        """Return the mode of a body that has tipped over its rim."""
        assert isinstance(mode, TipOnset)
        slips = not mode.contact_mode.sticks[0]
        following = self.mode_for(off_branch(mode.top), end.state, slips=slips)
        return Transition((), following, end.state)

    # Leaving the table, and impacts.

    def lift_off(self, contact: Top, time: float, mode: Mode, end: ModeEnd) -> Transition:
        """Leave the table, unless the normal force changed its sign by way of infinity.

        Then it is decided anew how contact goes on: Painleve's paradox begins, or the motion is so
        stiff that errors of an explicit method look like that.
        """
        if opens_by_zero(mode, end, contact):
            return self._leave(contact, time, end.state, (), Start.LIFT_OFF)
        return self.resting(contact, time, end.state)

    def _release(
        self, contact: Top, time: float, state: State, events: tuple[Event, ...]
    ) -> Transition:
        """Leave a table that would have to pull from now on, not from zero force."""
        return self._leave(contact, time, state, events, Start.RELEASE)

    def _leave(
        self, contact: Top, time: float, state: State, events: tuple[Event, ...], start: Start
    ) -> Transition:
        """End the run, or fly."""
        following = Flight(contact, start) if self.liftoff == "fly" else Status.LIFTED_OFF
        event = Event(EventKind.LIFT_OFF, time, surface=contact.number)
        return Transition((*events, event), following, state)

    def touchdown(self, contact: Top, time: float, state: State) -> Transition:
        """Collide, unless with a face, and go on as the impact leaves the top."""
        reported = (Event(EventKind.TOUCHDOWN, time, surface=contact.number),)
        if lands_flat(contact, state.axis):
            return self.strike_face(contact, time, state, reported)
        if lies_on_flat_end(contact, state.axis):
            return Transition(reported, Status.FAILED, state, ON_FLAT_END)
        return self._collide(contact, time, state, reported, self.restitution)

    def touch(
        self,
        contact: Top,
        surface: int,
        time: float,
        state: State,
    ) -> Transition:
        """Collide with another surface, and go on as the impact leaves the top.

        Where more come to the table at once, the outermost strikes: what lies between sinks more
        slowly.
        """
        striking = contact.body.contacts[surface]
        faster = [
            neighbour
            for neighbour in other_touching(contact, state)[:1]
            if gap_rate(state, neighbour) < gap_rate(state, striking)
        ]
        return self.touchdown(faster[0] if faster else striking, time, state)

    def inconsistent(
        self, contact: Top, time: float, state: State, events: tuple[Event, ...]
    ) -> Transition:
        """Collide without approach where no contact force is consistent with the friction.

        The run fails where bodies are held to the table, and where two impacts at this instant have
        left it so: then rounding decides, not friction.
        """
        struck = sum(event.kind is EventKind.IMPACT for event in events)
        if self.liftoff == "fly" and struck <= 1:
            return self._collide(contact, time, state, events, 0.0, approaches=False)
        detail = "no contact force is consistent with the friction"
        if any(event.kind is EventKind.INDETERMINATE for event in events):
            detail = "the impact that contact.indeterminate names needs contact.liftoff = fly"
        return Transition(events, Status.FAILED, state, detail)

    def _collide(
        self,
        contact: Top,
        time: float,
        state: State,
        events: tuple[Event, ...],
        restitution: float,
        *,
        approaches: bool = True,
    ) -> Transition:
        try:
            struck, rebounds = collision(state, restitution, contact)
        except ArithmeticError as error:
            return failed("The impulse of the impact", error, state, events)
        impulse, lost = float(struck.impulse), float(struck.energy_lost)
        hit = Event(EventKind.IMPACT, time, impulse, lost, contact.number, struck.steps)
        if not struck.impulse:
            # Nothing but rounding kept the contact from being a resting one.
            return self._untouched(contact, time, struck.state, events, approaches=approaches)
        if rebounds:
            return Transition((*events, hit), Flight(contact, Start.REBOUND), struck.state)
        return self.resting(contact, time, struck.state, (*events, hit))

    def _untouched(
        self,
        contact: Top,
        time: float,
        state: State,
        events: tuple[Event, ...],
        *,
        approaches: bool,
    ) -> Transition:
        """Go on where an impact had no impulse; one without approach is not tried again.

        What does not slip sticks only if friction can hold it.
        """
        if isinstance(contact.surface, Hull) and approaches:
            return self.resting(contact, time, state, events)
        stuck = is_set_valued(contact.friction) and not is_slipping(*along_table(state), contact)
        held = not rolls_freely(contact, state)
        if stuck or (held and not _jams_alone(contact, state)):
            return self.resolve(contact, time, state, (stuck, held), events=events)
        return Transition(events, self.mode_for(contact, state, slips=True), state)

    def jammed(self, contact: Top, time: float, state: State) -> Transition | None:
        """Return what follows where friction that turns made the normal force grow beyond all
        bounds, if it did.
        """
        try:
            past = past_jamming(state, contact)
        except ArithmeticError as error:
            what = "What follows where friction jams the contact"
            return failed(what, error, state) if isinstance(error, Unsolved) else None
        if past is None:
            return None
        beyond, *prior = past
        return add_prior_impulse(self._strike(contact, time, beyond), state, *prior)

    def _strike(self, contact: Top, time: float, state: State) -> Transition:
        """Collide without approach where friction has jammed a contact, or stick where slip is so
        little that by rounding nothing strikes: slipping on, it would jam at once.
        """
        following = self.inconsistent(contact, time, state, ())
        if following.events or not isinstance(following.next, Mode):
            return following
        return self.resolve(contact, time, stuck_at_once(state, contact), (True, False))

    # Two contacts.

    def _with_other_surfaces(self, contact: Top, time: float, following: Transition) -> Transition:
        """Return what follows on one contact, unless it presses another surface that touches onto
        the table: then both are resolved.
        """
        mode, state = following.next, following.state
        if not isinstance(contact.surface, Hull) or not isinstance(mode, IntegratedMode):
            return following
        reaction = mode.reaction(mode.numbers(state))
        wrench = Wrench(reaction.force, reaction.torque)
        for neighbour in other_touching(contact, state):
            closes = stays_closed(contact, neighbour, state)
            if closes and gap_acceleration(contact, neighbour, state, wrench) < 0.0:
                # The resolver of both reports what sticks.
                halts = [event for event in following.events if event.kind is EventKind.HALT]
                return self.resting(contact, time, state, tuple(halts))
        return following

    def resolve_two(
        self,
        time: float,
        state: State,
        tops: Tops,
        before: Before,
        rolls: float,
        events: tuple[Event, ...] = (),
        *,
        arrived: bool = False,
        ended: tuple[bool, bool] | None = None,
    ) -> Transition:
        """Return what two contacts do, where the body rolls as signed, or not (0).

        `ended` says on which of them slip has ended; None where its size is to tell.

        Friction may jam one contact, and the other, which it presses, lift it again. No impact
        begins then: the force on both is finite and stable, and they stay closed where that is
        consistent. Where no impact begins the run ends if each contact can carry the body alone.
        """
        contacts = ClosedPair.of(state, tops, rolls, ended)
        try:
            consistent = contacts.answers()
            jammed = contacts.jammed if len(consistent) != 1 else None
        except ArithmeticError as error:
            return failed("The forces on two surfaces that touch", error, state, events)
        chosen = self._chosen(consistent, jams=jammed is not None)
        events = (*events, *_indeterminate(contacts.tops[0], time, consistent))
        if chosen is None:
            if consistent and jammed is None:
                detail = "each of two surfaces that touch can carry the body alone"
                return Transition(events, Status.FAILED, contacts.state, detail)
            struck = jammed or contacts.tops[0]
            touching = on_table(along_table(contacts.state), struck)
            return self.inconsistent(struck, time, touching, events)
        if not chosen.closed:
            return self._release(contacts.tops[0], time, contacts.state, events)
        if chosen.resolution is not None:
            if arrived:
                lost = float(energy(state, tops[0]) - energy(contacts.state, tops[0]))
                event = Event(EventKind.DOUBLE_CONTACT, time, 0.0, lost, tops[0].number)
                events = (*events, event)
            events = (*events, *contacts.changes(time, chosen.resolution, before))
            return replace(self._mode_on_two(contacts, chosen.resolution), events=events)
        (number,) = chosen.closed
        stays, opens = contacts.tops[number], contacts.tops[1 - number]
        events = (*events, Event(EventKind.OPENING, time, surface=opens.number))
        ended = (contacts.ended[number], contacts.stopped)
        return self._after_resolving(stays, time, contacts.state, chosen, ended, ended, events)

    def slip_on_two(self, time: float, state: State, mode: ContactMode, contact: int) -> Transition:
        """Return the mode in which a contact of two begins to slip at the limit of what the table
        can, or both do (-1).
        """
        first, second = mode.sticks
        contacts = ClosedPair.of(state, mode.tops, mode.rolls, (first, second))
        try:
            resolved = contacts.slipping(None if contact < 0 else contact)
        except ArithmeticError as error:
            what = "The direction in which slip, or rolling, begins on two surfaces"
            return failed(what, error, state)
        events = contacts.changes(time, resolved, Before.of(mode))
        return replace(self._slip_begins(contacts, resolved), events=events)

    def _mode_on_two(self, contacts: ClosedPair, resolved: Resolution) -> Transition:
        """Return the mode in which both contacts go on."""
        if resolved.rolls != contacts.rolls:
            return self._mode_on_two(replace(contacts, rolls=resolved.rolls), resolved)
        if resolved.begins is not None:
            return self._slip_begins(contacts, resolved)
        if not any(resolved.sticks):
            mode = self._slides_on_two(contacts.state, contacts.tops, contacts.rolls)
            return Transition((), mode, contacts.state)
        if all(resolved.sticks):
            slowest = contacts.slowest_rolling
            mode = mode_on_two(contacts.tops, contacts.rolls, (True, True), slowest_rolling=slowest)
            still = rests(contacts.state, *resolved.motion.rates.turning)
            return Transition(
                (), Resting(contacts.tops[0], mode) if still else mode, contacts.state
            )
        return Transition(
            (), self._turning(contacts.tops, contacts.xi[2], contacts.rolls), contacts.state
        )

    def _slides_on_two(self, state: State, tops: Tops, rolls: float) -> Mode:
        """Return the mode of two contacts that slip; where that is about to end, in its clock."""
        mode = sliding_on_two(state, tops, rolls)
        ending, time_left = soonest_end(mode, state)
        return ending if ending is not None and time_left <= HORIZON else mode

    def _turning(self, tops: Tops, zeta: float, rolls: float) -> ContactMode:
        """Return the mode in which the first contact sticks, and the second slips so."""
        sense = 1.0 if zeta >= 0.0 else -1.0
        return mode_on_two(tops, rolls, (True, False), sense=sense)

    def _slip_begins(self, contacts: ClosedPair, resolved: Resolution) -> Transition:
        """Return the mode in which slip begins on two contacts."""
        begins: Slip = resolved.begins or ()
        if any(resolved.sticks):
            tops = contacts.tops if resolved.sticks[0] else contacts.tops[::-1]
            sign = begins[2] if resolved.sticks[0] else -begins[2]
            return Transition((), self._turning(tops, sign, contacts.rolls), contacts.state)
        slips = slips_of(contacts.pair, begins)
        first, second = (
            on_branch(top, slip) for top, slip in zip(contacts.tops, slips, strict=True)
        )
        both = all(contacts.ended)
        onset = SlipOnset.of(
            mode_on_two((first, second), contacts.rolls),
            (SlipComponent(slip=True, turns=both),),
            (begins if both else begins[:2],),
        )
        return Transition((), onset, contacts.state)


Rule: TypeAlias = Callable[[Automaton, Mode, ModeEnd, float], Transition]
"""What follows the end of a mode at a time."""

RULES: dict[str, Rule] = {
    COMPLETED: lambda rules, mode, end, time: Transition((), Status.COMPLETED, end.state),
    FAILURE: lambda rules, mode, end, time: rules._after_failure(mode, end, time),
    FLAT: lambda rules, mode, end, time: rules._after_settling(mode, end, time),
    STOPPED: lambda rules, mode, end, time: rules._from_rest_on_face(mode.top, time, end.state, ()),
    TILTED: lambda rules, mode, end, time: rules._after_tipping(mode, end, time),
    TIPPING: lambda rules, mode, end, time: rules._after_sliding(mode, end, time),
    AT_REST: lambda rules, mode, end, time: Transition((), Status.AT_REST, end.state),
    LANDING: lambda rules, mode, end, time: rules._after_flight(off_branch(mode.top), end, time),
    TOUCH: lambda rules, mode, end, time: rules.touch(
        off_branch(mode.top), end.contact, time, end.state
    ),
    FACE: lambda rules, mode, end, time: rules._settle_flat(mode, end, slaps=True),
    WOBBLE: lambda rules, mode, end, time: rules._settle_flat(mode, end, slaps=False),
    FLAT_END: lambda rules, mode, end, time: Transition((), Status.FAILED, end.state, ON_FLAT_END),
    LIFT_OFF: lambda rules, mode, end, time: rules.lift_off(
        off_branch(contact_mode_of(mode, end).top), time, mode, end
    ),
    OPENING: lambda rules, mode, end, time: rules._open_one(mode, end, time),
    SLIP: lambda rules, mode, end, time: rules._slips(mode, end, time),
    ROLLING: lambda rules, mode, end, time: rules._rolls(mode, end, time),
    ENDING: lambda rules, mode, end, time: rules._turning_ends(mode, end, time),
    STOPPING: lambda rules, mode, end, time: rules._follow_to_end(mode, end, time),
    ROLLING_STOPPING: lambda rules, mode, end, time: rules._follow_to_end(mode, end, time),
    SLIP_SMALL: lambda rules, mode, end, time: rules._go_on(mode, end, time),
    SLIP_LARGE: lambda rules, mode, end, time: rules._go_on(mode, end, time),
    BRANCH: lambda rules, mode, end, time: rules._on_other_branch(mode, end, time),
    LIMIT_BRANCH: lambda rules, mode, end, time: rules._on_other_branch(mode, end, time),
    ONSET_OVER: lambda rules, mode, end, time: rules._go_on(mode, end, time),
    REOPENING: lambda rules, mode, end, time: rules._go_on(mode, end, time),
    OVERTAKEN: lambda rules, mode, end, time: rules._overtaken(mode, end, time),
    JAMMED: lambda rules, mode, end, time: rules._after_jam(mode, end, time),
    REACHED_ZERO: lambda rules, mode, end, time: rules._after_end(mode, end, time),
    ENDED: lambda rules, mode, end, time: rules._after_end(mode, end, time),
}
"""The rule of each cause of a mode's end, which runs and sweeps ask."""


def contact_mode_of(mode: Mode, end: ModeEnd) -> ContactMode:
    """Return the contact mode that has ended, or in which velocities began or ended."""
    moving = mode.contact_mode if isinstance(mode, TransientMode) else mode
    if not isinstance(moving, ContactMode):  # one that a user defined
        raise without_rule(mode, end)
    return moving


def without_rule(mode: Mode, end: ModeEnd) -> InvalidInput:
    """Return the refusal of the end of a mode that no rule follows."""
    return InvalidInput(
        "contact",
        Described(f"the mode {mode.name}, ended by '{end.cause}',"),
        "",
        "has no rule for what follows",
        "return a Transition for this guard from the automaton's method follow",
    )


def _indeterminate(contact: Top, time: float, consistent: Sequence[Answer]) -> tuple[Event, ...]:
    """Return the event of an indeterminate contact force, if several answers are consistent."""
    if len(consistent) <= 1:
        return ()
    return (Event(EventKind.INDETERMINATE, time, surface=contact.number),)


def _jams_alone(contact: Top, state: State) -> bool:
    """Return whether friction jams a contact that slips, whatever else touches: A <= 0."""
    return bool(sliding_contact(*along_table(state), contact).delassus <= 0.0)


def opens_by_zero(mode: Mode, end: ModeEnd, contact: Top) -> bool:
    """Return whether a normal force that changes its sign at the end of a mode does so by zero, so
    that its contact opens, and not by way of infinity.
    """
    state = end.state
    try:
        normal = _contacts_at(mode, end).normal(max(end.contact, 0))
    except ArithmeticError:
        return False
    return bool(falls_by_zero(normal, state.axis, state.momentum, contact))


def _contacts_at(mode: Mode, end: ModeEnd) -> ClosedContacts:
    """Return the closed contacts where a mode has ended."""
    if isinstance(mode, SlipEnd):
        now = mode.state_in_clock(end.numbers)
        return contacts_in_clock(now, mode.contact_mode, mode.component)
    assert isinstance(mode, ContactMode)
    return mode.contacts(mode.numbers(end.state))


def add_prior_impulse(
    following: Transition, before: State, impulse: float, lost: float
) -> Transition:
    """Return what follows an impact that had begun with some normal impulse, which took energy.

    A run that ends without one ends in the state before.
    """
    if not following.events and isinstance(following.next, Status):
        return replace(following, state=before)
    hit = [
        replace(event, impulse=event.impulse + impulse, energy_lost=event.energy_lost + lost)
        for event in following.events[:1]
        if event.kind is EventKind.IMPACT
    ]
    return replace(following, events=(*hit, *following.events[len(hit) :]))


def rests(state: State, *rates: Scalar) -> bool:
    """Return whether a body in contact neither moves nor begins to, by the rates of its
    velocities.
    """
    return bool(max(map(abs, (*rates, *state.momentum, *state.velocity))) <= REST)
