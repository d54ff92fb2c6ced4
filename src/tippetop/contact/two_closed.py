"""What follows where two surfaces touch and have no normal velocities, and slip ends or begins at them."""

from dataclasses import dataclass, replace
from typing import Any

from tippetop.contact.double import SLOWEST_SLIP, on_two
from tippetop.contact.double_sticking import (
    SlipBeginningOnTwo,
    StickingAndSliding,
    StickingAndSlidingBack,
    StickingOnTwo,
)
from tippetop.contact.mode import Event, EventKind, Outcome, Transition
from tippetop.contact.passing import Resting
from tippetop.contact.rules import REST
from tippetop.contact.surfaces import number_of
from tippetop.mechanics.beginning import beginning
from tippetop.mechanics.contact_pair import (
    ContactPair,
    PairMotion,
    apart,
    pair_motion,
    slip_apart,
    slips_of,
    without_slips,
)
from tippetop.mechanics.coulomb import RollingResistance
from tippetop.mechanics.double_contact import Tops, without_tilting
from tippetop.mechanics.invariants import energy
from tippetop.mechanics.motion import along_table
from tippetop.mechanics.pair_resolver import (
    Resolution,
    both_letting_go,
    letting_go,
    resolution,
    turning_about,
)
from tippetop.mechanics.rolling import (
    ContactPoint,
    Slip,
    Wrench,
    contact_motion,
    is_set_valued,
    off_branch,
    on_branch,
    set_valued,
    slip_length,
    spun_up,
)
from tippetop.mechanics.state import State
from tippetop.mechanics.stick_slip import inner, least_slip, scaled, size, slip_of

TOGETHER = 30.0
"""How many times `SLOWEST_SLIP` the slip of the other contact may be where it ends on one to end with it."""

FIRST, SECOND, BOTH, NEITHER = "first", "second", "both", "neither"


@dataclass(frozen=True)
class TwoClosed:
    """Two contacts that are closed and have no normal velocities.

    Attributes
    ----------
    rules
        The rules of the body.
    tops
        The top with either surface active; if slip has ended on one, that comes first.
    state
        The state, in which slip that has ended is zero.
    ended
        On which contacts it has.
    """

    rules: Any
    tops: Tops
    state: State
    ended: tuple[bool, bool]

    @classmethod
    def of(cls, rules: Any, state: State, tops: Tops, ended: tuple[bool, bool] | None = None) -> "TwoClosed":
        """The contacts in a state that has slip, or tilts, by no more than what is taken for none."""
        state, tops = without_tilting(state, tops[0]), (off_branch(tops[0]), off_branch(tops[1]))
        ended = ended_slips(state, tops) if ended is None else ended
        if ended == (False, True):
            tops, ended = tops[::-1], ended[::-1]
        if any(ended):
            pair = ContactPair.of(state.axis, state.momentum, tops)
            momentum, velocity = without_slips(pair, state.velocity, ended)
            state = state._replace(momentum=momentum, velocity=velocity)
        return cls(rules, tops, state, ended)

    @property
    def pair(self) -> ContactPair:
        """The contact points."""
        return ContactPair.of(self.state.axis, self.state.momentum, self.tops)

    @property
    def xi(self) -> Slip:
        """How they slip."""
        if self.ended[0]:
            return (0.0, 0.0, 0.0 if self.ended[1] else slip_apart(self.pair))
        slip = slip_of(*along_table(self.state), self.tops[0])
        return (slip[0], slip[1], slip_apart(self.pair))

    def resolved(self) -> Resolution:
        """How both go on while they stay closed."""
        return resolution(self.pair, self.xi, self.ended)

    def consistent(self, found: Resolution) -> list[str]:
        """Which contacts may stay closed: exactly one answer is expected."""
        normal, free = found.motion.normal, self.pair.free
        answers = [BOTH] if normal[0] > 0.0 and normal[1] > 0.0 else []
        answers += [name for number, name in enumerate((FIRST, SECOND)) if self._stays_alone(number)]
        return answers + ([NEITHER] if free[0][2] >= 0.0 and free[1][2] >= 0.0 else [])

    def _stays_alone(self, number: int) -> bool:
        """Whether one contact is pressed onto the table, and the other opens."""
        point = self.pair[number]
        if point.free.point[2] >= 0.0:
            return False
        slip = None if self.ended[number] else slip_of(*along_table(self.state), self.tops[number])
        wrench = alone(point, slip)
        return bool(wrench.force[2] > 0.0 and self.pair.under([(number, wrench)])[1 - number][2] >= 0.0)

    def going_on(self, found: Resolution) -> Transition:
        """The mode in which both go on."""
        if found.begins is not None:
            return self.letting_go(found)
        if not any(found.sticks):
            return Transition(
                (), on_two(self.state, self.rules.on(number_of(self.tops[0])), self.tops[1]), self.state
            )
        if all(found.sticks):
            mode = StickingOnTwo(self.tops[0], self.rules, self.tops[1])
            rests = _rests(self.state, found.motion)
            return Transition((), Resting(self.tops[0], self.rules, mode) if rests else mode, self.state)
        return Transition((), self._turning(self.tops, self.xi[2]), self.state)

    def _turning(self, tops: Tops, zeta: float) -> StickingAndSliding:
        """The mode in which the first of these contacts sticks, and the second slips so."""
        return (StickingAndSliding if zeta >= 0.0 else StickingAndSlidingBack)(tops[0], self.rules, tops[1])

    def letting_go(self, found: Resolution) -> Transition:
        """The mode in which slip begins."""
        assert found.begins is not None
        least = 2.0 * least_slip(self.state.momentum, self.state.velocity[:2])
        if any(found.sticks):
            tops = self.tops if found.sticks[0] else self.tops[::-1]
            sign = found.begins[2] if found.sticks[0] else -found.begins[2]
            change = (0.0, 0.0, found.begins[2] * least / apart(self.pair))
            momentum = spun_up(self.state.axis, self.state.momentum, change, self.tops[0])
            turning = self._turning(tops, sign)
            return Transition((), turning, turning.state((*self.state.axis, *momentum)))
        v_x, v_y, zeta = scaled(least / size(found.begins), found.begins)
        zeta += self.xi[2]
        begin = (*self.state.axis, *self.state.momentum, v_x, v_y, zeta)
        slips = slips_of(self.pair, (v_x, v_y, zeta))
        one, other = (on_branch(top, slip) for top, slip in zip(self.tops, slips, strict=True))
        mode = SlipBeginningOnTwo(one, self.rules, other, begin)
        return Transition((), mode, mode.state(begin))


def alone(point: ContactPoint, slip: Slip | None) -> Wrench:
    """What the table does where one contact alone is closed."""
    rolling = point.turning[:2]
    wrench = contact_motion(point, slip, rolling)[0]
    if (
        slip is None
        and set_valued(point.top.friction).reserve(wrench.force[2], wrench.force[:2], wrench.torque[2]) < 0.0
    ):
        return beginning(point, None, rolling, (True, False)).wrench
    return wrench


def ended_slips(state: State, tops: Tops) -> tuple[bool, bool]:
    """On which contacts slip has ended: on both at once where drilling is resisted too."""
    if not is_set_valued(tops[0].friction):
        return False, False
    one, other = (size(slip_of(*along_table(state), top)) for top in tops)
    least, limit = min(one, other), (1.0 + 1e-6) * SLOWEST_SLIP
    if slip_length(tops[0].friction) is not None:
        return (True, True) if one * one + other * other <= limit * limit else (False, False)
    if least > limit:
        return False, False
    return one <= TOGETHER * limit, other <= TOGETHER * limit


def settled(
    rules: Any,
    time: float,
    state: State,
    tops: Tops,
    stuck: tuple[int, ...],
    events: tuple[Event, ...] = (),
    *,
    arrived: bool = False,
) -> Transition:
    """The resolver of two contacts, of which those of some surfaces have been sticking."""
    if isinstance(tops[0].friction, RollingResistance):
        detail = "two surfaces touch at once, which is not followed where rolling is resisted"
        return Transition(events, Outcome.FAILED, state, detail)
    here = TwoClosed.of(rules, state, tops)
    try:
        found = here.resolved()
        answers = here.consistent(found)
    except ArithmeticError as error:
        return Transition(events, Outcome.FAILED, state, str(error))
    if len(answers) != 1:
        detail = "not exactly one set of forces is consistent with two surfaces that touch"
        return Transition(events, Outcome.FAILED, state, detail)
    if answers == [BOTH]:
        if arrived:
            lost = float(energy(state, tops[0]) - energy(here.state, tops[0]))
            events = (*events, rules.event(EventKind.DOUBLE_CONTACT, time, 0.0, lost))
        events = (*events, *_marks(time + _left(state, tops), here, found.sticks, stuck))
        return replace(here.going_on(found), events=events)
    numbers = [number_of(top) for top in here.tops]
    left, kept = numbers if answers == [SECOND] else numbers[::-1]
    events = (*events, Event(EventKind.OPENING, time, surface=left))
    then: Transition = rules.on(kept).resting_alone(time, here.state, events)
    return then


def slipping(rules: Any, time: float, state: State, tops: Tops, which: str) -> Transition:
    """What follows where what both contacts need, or one of them, reaches the limit of what the table can.

    Of those that stick, that of this number slips, or "both"; where only the first does, it does.
    """
    alone = which == FIRST
    here = TwoClosed.of(rules, state, tops, (True, not alone))
    pair = here.pair
    try:
        if which == BOTH:
            found = both_letting_go(pair)
        elif alone:
            found = letting_go(pair, here.xi)
        else:
            number = int(which)
            needed = pair_motion(pair, (None, None)).needed(number)
            found = turning_about(pair, 1 - number, 1.0 if (needed > 0.0) == (number == 0) else -1.0)
    except ArithmeticError as error:
        return Transition((), Outcome.FAILED, state, str(error))
    before = (number_of(tops[0]),) if alone else (number_of(tops[0]), number_of(tops[1]))
    return replace(here.letting_go(found), events=_marks(time, here, found.sticks, before))


def _marks(
    time: float, here: TwoClosed, sticks: tuple[bool, bool], stuck: tuple[int, ...]
) -> tuple[Event, ...]:
    """What is told where a contact sticks that did not, or slips that stuck."""
    told = []
    for top, held in zip(here.tops, sticks, strict=True):
        surface = number_of(top)
        if held != (surface in stuck):
            told.append(Event(EventKind.STICK if held else EventKind.SLIP, time, surface=surface))
    return tuple(told)


def _left(state: State, tops: Tops) -> float:
    """Time to the end of slip that is followed no further, at its present rate."""
    slips = [slip_of(*along_table(state), top) for top in tops]
    number = 0 if size(slips[0]) <= size(slips[1]) else 1
    slip, speed = slips[number], size(slips[number])
    if not 0.0 < speed <= TOGETHER * SLOWEST_SLIP or not size(slips[1 - number]):
        return 0.0
    pair = ContactPair.of(state.axis, state.momentum, tops)
    found = pair_motion(pair, (slips[0], slips[1]))
    change: Slip = found.moving[number][:2]
    if slip_length(tops[0].friction) is not None:
        slip, change = (slips[0][0], slips[0][1], slip_apart(pair)), found.rate
    rate = inner(slip, change)
    return inner(slip, slip) / -rate if rate < 0.0 else 0.0


def _rests(state: State, motion: PairMotion) -> bool:
    """Whether a body in contact neither moves nor begins to."""
    rates = (*motion.moving[2], *state.momentum, *state.velocity)
    return bool(max(map(abs, rates)) <= REST)
