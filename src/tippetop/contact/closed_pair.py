"""Two closed contacts without normal velocities, as the resolver takes them; not in an impact."""

from dataclasses import dataclass
from typing import NamedTuple

from tippetop.contact.contact_mode import ContactMode
from tippetop.contact.impact import begins_without_approach
from tippetop.contact.mode import Event, EventKind
from tippetop.mechanics.contacts.branches import off_branch
from tippetop.mechanics.contacts.consistent_answers import Answer, answers
from tippetop.mechanics.contacts.contact_forces import forces_on_two
from tippetop.mechanics.contacts.contact_point import contact_points
from tippetop.mechanics.contacts.forces import directions_of, is_set_valued, slip_length
from tippetop.mechanics.contacts.pair import (
    ContactPair,
    Tops,
    at_rest,
    slip_apart,
    turning_along,
    without_tilting,
)
from tippetop.mechanics.contacts.pair_resolution import (
    Resolution,
    both_begin_to_slip,
    first_begins_to_slip,
    rolling_of_slip,
    turning_about,
)
from tippetop.mechanics.contacts.slip_variables import has_ended, is_rolling, scaled, slip_of
from tippetop.mechanics.contacts.wrench import Slip
from tippetop.mechanics.motion import along_table, on_table
from tippetop.mechanics.state import State
from tippetop.mechanics.top import Top


class Before(NamedTuple):
    """What two contacts did before something happened to them."""

    stuck: tuple[int, ...] = ()
    """Numbers of the surfaces that stuck."""
    rolled: bool = False
    """Whether the body rolled, if that is resisted."""

    @classmethod
    def of(cls, mode: ContactMode) -> "Before":
        """Return what they did in a mode."""
        return cls(mode.stuck, bool(mode.rolls))


@dataclass(frozen=True)
class ClosedPair:
    """Two contacts that are closed and have no normal velocities."""

    tops: Tops
    """The top with either surface active; if slip has ended on one, that comes first."""
    state: State
    """The state, in which slip, and rolling, that has ended is zero."""
    ended: tuple[bool, bool]
    """On which contacts it has."""
    rolls: float
    """Sign of omega_e; 0 where rolling has ended, or is not resisted."""
    pair: ContactPair
    """The contact points."""

    @classmethod
    def of(
        cls,
        state: State,
        tops: Tops,
        rolls: float,
        ended: tuple[bool, bool] | None = None,
    ) -> "ClosedPair":
        """Return the contacts in a state, with slip and tilting that have ended set to zero.

        Where a velocity ends, the impulse that ends it is applied. A contact that sticks comes
        first if only one does.
        """
        tops = off_branch(tops[0]), off_branch(tops[1])
        # What sticks does not slip because tilting has ended: that is held, too.
        ended = ended_slips(state, tops) if ended is None else ended
        state = without_tilting(state, tops[0])
        if ended == (False, True):
            tops, ended = tops[::-1], ended[::-1]
        pair = contact_points(state.axis, state.momentum, tops, state.velocity[:2])
        stopped = tops[0].resists_rolling and not rolls
        if any(ended) or stopped:
            momentum, velocity = at_rest(pair, state.velocity, ended, stopped=stopped)
            state = state._replace(momentum=momentum, velocity=velocity)
            pair = contact_points(state.axis, state.momentum, tops, state.velocity[:2])
        return cls(tops, state, ended, rolls, pair)

    @property
    def stopped(self) -> bool:
        """Whether rolling has ended."""
        return self.tops[0].resists_rolling and not self.rolls

    @property
    def xi(self) -> Slip:
        """How they slip."""
        if self.ended[0]:
            return (0.0, 0.0, 0.0 if self.ended[1] else slip_apart(self.pair))
        slip = slip_of(*along_table(self.state), self.tops[0])
        return (slip[0], slip[1], slip_apart(self.pair))

    def answers(self) -> list[Answer]:
        """Return every consistent answer."""
        pairs = zip(self.tops, self.ended, strict=True)
        slips = [None if ended else slip_of(*along_table(self.state), top) for top, ended in pairs]
        along = directions_of(self.state.axis)[0]
        rolling = None if self.stopped else scaled(self.rolls, along[:2])
        if not self.tops[0].resists_rolling:
            rolling = self.pair[0].turning[:2]
        return answers(self.pair, slips, rolling)

    @property
    def jammed(self) -> Top | None:
        """The first slipping contact where an impact without approach begins; None if neither."""
        for number, (top, beside) in enumerate((self.tops, self.tops[::-1])):
            touching = on_table(along_table(self.state), top)
            if not self.ended[number] and begins_without_approach(touching, top, beside):
                return top
        return None

    def slipping(self, contact: int | None) -> Resolution:
        """Return how slip begins at the limit of what the table can: on this of the contacts that
        stick, or on both (None).

        Raises
        ------
        ArithmeticError
            If there is no direction for it, or more than one.
        """
        if contact is None or slip_length(self.tops[0].friction) is not None:
            return both_begin_to_slip(self.pair, self.rolls)
        if not all(self.ended):
            return first_begins_to_slip(self.pair, self.xi, self.rolls)
        needed = forces_on_two(self.pair, (None, None), self.rolls).needed(contact)
        sign = 1.0 if (needed > 0.0) == (contact == 0) else -1.0
        return turning_about(self.pair, 1 - contact, sign, self.rolls)

    @property
    def slowest_rolling(self) -> float:
        """The |omega_e| to which rolling must fall before two patches that stick begin to slip; -1
        where they never do, nothing rolls, the law has no patch, or an outer field acts.
        """
        patches = self.rolls and slip_length(self.tops[0].friction) is not None
        patches = patches and self.tops[0].field is None
        return rolling_of_slip(self.pair, self.rolls) if patches else -1.0

    def changes(self, time: float, resolved: Resolution, before: Before) -> tuple[Event, ...]:
        """Return the events of contacts that stick and did not, or slip and stuck; and the same of
        rolling.
        """
        events = []
        for top, held in zip(self.tops, resolved.sticks, strict=True):
            surface = top.number
            if held != (surface in before.stuck):
                kind = EventKind.STICK if held else EventKind.SLIP
                events.append(Event(kind, time, surface=surface))
        if before.rolled != bool(resolved.rolls):
            kind = EventKind.ROLL if resolved.rolls else EventKind.HALT
            events += [Event(kind, time, surface=top.number) for top in self.tops]
        return tuple(events)


def rolling_of(state: State, top: Top) -> float:
    """Sign of omega_e where rolling is resisted and goes on; else 0."""
    if not top.resists_rolling or not is_rolling(state.axis, state.momentum, top):
        return 0.0
    return (
        1.0 if turning_along(contact_points(state.axis, state.momentum, (top, top))) > 0.0 else -1.0
    )


def ended_slips(state: State, tops: Tops) -> tuple[bool, bool]:
    """On which contacts slip has ended: on both at once where drilling is resisted too."""
    if not is_set_valued(tops[0].friction):
        return False, False
    first, second = (has_ended(*along_table(state), top) for top in tops)
    both = first and second
    return (both, both) if slip_length(tops[0].friction) is not None else (first, second)
