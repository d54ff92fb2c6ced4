"""The resolver of two contacts that are closed, and of slip that begins at them."""

from dataclasses import replace
from typing import TYPE_CHECKING

from tippetop.contact.double import SLOWEST_SLIP
from tippetop.contact.mode import Before, Event, EventKind, Outcome, Transition, failed
from tippetop.contact.surfaces import number_of
from tippetop.contact.two_closed import BOTH, FIRST, SECOND, TOGETHER, TwoClosed
from tippetop.mechanics.contact_pair import ContactPair, Tops, slip_apart
from tippetop.mechanics.invariants import energy
from tippetop.mechanics.motion import along_table
from tippetop.mechanics.pair_motion import pair_motion
from tippetop.mechanics.pair_resolver import Resolution, both_letting_go, letting_go, turning_about
from tippetop.mechanics.rolling import slip_length
from tippetop.mechanics.state import State
from tippetop.mechanics.stick_slip import inner, size, slip_of
from tippetop.mechanics.wrench import Slip

if TYPE_CHECKING:
    from tippetop.contact.several import OnSeveral


def settled(
    rules: "OnSeveral",
    time: float,
    state: State,
    tops: Tops,
    before: Before,
    rolls: float,
    events: tuple[Event, ...] = (),
    *,
    arrived: bool = False,
) -> Transition:
    """The resolver of two contacts, where the body rolls as signed, or not (0)."""
    here = TwoClosed.of(rules, state, tops, rolls)
    try:
        found = here.resolved()
        consistent = here.consistent(found)
    except ArithmeticError as error:
        return failed("The forces on two surfaces that touch", error, state, events)
    if len(consistent) != 1:
        detail = "not exactly one set of forces is consistent with two surfaces that touch"
        return Transition(events, Outcome.FAILED, state, detail)
    if consistent == [BOTH]:
        if arrived:
            lost = float(energy(state, tops[0]) - energy(here.state, tops[0]))
            events = (*events, rules.event(EventKind.DOUBLE_CONTACT, time, 0.0, lost))
        ended = time + _left(state, here)
        # Rolling that is let go now began when the slip ended that held it up.
        turned = ended if found.rolls != rolls else time
        events = (*events, *_marks((ended, turned), here, found, before))
        return replace(here.going_on(found), events=events)
    numbers = [number_of(top) for top in here.tops]
    left, kept = numbers if consistent == [SECOND] else numbers[::-1]
    events = (*events, Event(EventKind.OPENING, time, surface=left))
    return rules.on(kept).resting_alone(time, here.state, events)


def slipping(
    rules: "OnSeveral", time: float, state: State, tops: Tops, which: str, rolls: float
) -> Transition:
    """What follows where what both contacts need, or one of them, reaches the limit of what the
    table can.

    Of those that stick, that of this number slips, or "both"; where only the first does, it does.
    """
    alone = which == FIRST
    here = TwoClosed.of(rules, state, tops, rolls, (True, not alone))
    pair = here.pair
    try:
        if which == BOTH or slip_length(tops[0].friction) is not None:
            found = both_letting_go(pair, rolls)
        elif alone:
            found = letting_go(pair, here.xi, rolls)
        else:
            number = int(which)
            needed = pair_motion(pair, (None, None), rolls).needed(number)
            found = turning_about(
                pair, 1 - number, 1.0 if (needed > 0.0) == (number == 0) else -1.0, rolls
            )
    except ArithmeticError as error:
        return failed(
            "The direction in which slip, or rolling, begins on two surfaces", error, state
        )
    stuck = (number_of(tops[0]),) if alone else (number_of(tops[0]), number_of(tops[1]))
    marks = _marks((time, time), here, found, Before(stuck, bool(rolls)))
    return replace(here.letting_go(found, 2), events=marks)


def _marks(
    times: tuple[float, float], here: TwoClosed, found: Resolution, before: Before
) -> tuple[Event, ...]:
    """What is told where a contact sticks that did not, or slips that stuck; and the same of
    rolling.

    The times are that of slip's end, or beginning, and that of rolling's.
    """
    told = []
    for top, held in zip(here.tops, found.sticks, strict=True):
        surface = number_of(top)
        if held != (surface in before.stuck):
            told.append(
                Event(EventKind.STICK if held else EventKind.SLIP, times[0], surface=surface)
            )
    if before.rolled != bool(found.rolls):
        kind = EventKind.ROLL if found.rolls else EventKind.HALT
        told += [Event(kind, times[1], surface=number_of(top)) for top in here.tops]
    return tuple(sorted(told, key=lambda event: event.time))


def _left(state: State, here: TwoClosed) -> float:
    """Time to the end of slip that is followed no further, at its present rate."""
    if not any(here.ended):
        return 0.0
    tops = here.tops
    slips = [slip_of(*along_table(state), top) for top in tops]
    number = 0 if size(slips[0]) <= size(slips[1]) else 1
    slip, speed = slips[number], size(slips[number])
    if not 0.0 < speed <= TOGETHER * SLOWEST_SLIP or not size(slips[1 - number]):
        return 0.0
    pair = ContactPair.of(state.axis, state.momentum, tops)
    found = pair_motion(pair, (slips[0], slips[1]), here.rolls)
    change: Slip = found.rates.points[number][:2]
    if slip_length(tops[0].friction) is not None:
        slip, change = (slips[0][0], slips[0][1], slip_apart(pair)), found.rate
    rate = inner(slip, change)
    return inner(slip, slip) / -rate if rate < 0.0 else 0.0
