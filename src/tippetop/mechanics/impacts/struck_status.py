"""What each contact of a struck body does at some instant of an impact: slip, stick, or begin.

The configuration is fixed, so that slip and rolling change per unit normal impulse at rates that
depend on their directions alone, as in contact (see `onset_forces` and `pair_resolution`), with
unit normal impulses for the forces that weight calls for.
"""

# translate module: numbers

from collections.abc import Callable, Sequence
from typing import NamedTuple

from tippetop.mechanics.contacts.consistent_answers import moved_under
from tippetop.mechanics.contacts.contact_forces import ContactForces
from tippetop.mechanics.contacts.contact_point import ContactPoint
from tippetop.mechanics.contacts.forces import (
    Slips,
    directions_of,
    is_set_valued,
    slip_length,
)
from tippetop.mechanics.contacts.onset_forces import contact_after_end
from tippetop.mechanics.contacts.pair import ContactPair, slip_apart, slips_of
from tippetop.mechanics.contacts.pair_resolution import OnTwo, Resolution, of_slips
from tippetop.mechanics.contacts.slip_direction import Resisted, directions
from tippetop.mechanics.contacts.slip_variables import LEFT_OVER, scaled, size, slip_part
from tippetop.mechanics.contacts.system import ContactRates
from tippetop.mechanics.contacts.wrench import Slip, Wrench
from tippetop.mechanics.impacts.struck_body import Impulse, StruckBody
from tippetop.mechanics.impacts.unit_impulse import (
    UnitImpulse,
    acting,
    at_second,
    changed,
    unit_impulse,
)
from tippetop.mechanics.vectors import Vector

SLIDES, HELD, BEGINS = "slides", "held", "begins"
"""What slip, or rolling, does: it goes on, is held, or begins in a direction that it keeps."""

NO_SLIP = 1e-13
"""Slip, and rolling, that has ended, in units of the impact, or less than the rounding of the
body's velocities: more leaves out of the impact what friction still takes.
"""

BOTH_END = 1e-10
"""Slip of two contacts together, in units of the impact, at which it ends on both: where both go to
zero at once rounding grows beside them, and decides below this which of them ends first.
"""


class StruckStatus(NamedTuple):
    """What the contacts do."""

    beside: str
    """What the second contact does: see `unit_impulse`."""
    ratio: float
    """Ratio of the normal velocities that both contacts keep, v_2 over v_1."""
    least: float
    """Share of the normal impulse that the second contact has at least, in restitution."""
    slips: tuple[str, ...]
    """What the slip of each contact does."""
    rolling: str
    """What rolling does, if it is resisted."""
    directions: tuple[Slip | None, ...]
    """Directions in which the slip of each contact begins, and last the one of rolling; None where
    it does not begin.
    """

    @property
    def is_straight(self) -> bool:
        """Whether the impulses grow in a straight line: nothing slides whose friction turns."""
        sliding = [self.slips[number] == SLIDES for number in acting(self.beside)]
        return not any(sliding) and self.rolling != SLIDES

    @property
    def begins(self) -> bool:
        """Whether slip, or rolling, begins."""
        return BEGINS in (*self.slips, self.rolling)


def least_slip(body: StruckBody) -> float:
    """Return the slip that has ended."""
    return max(NO_SLIP, body.rounding)


def slips_at(body: StruckBody, velocities: Slip) -> tuple[Slip, ...]:
    """Return the slips of all contacts, with drilling where the law resists it."""
    each = [velocities]
    if len(body.points) > 1:
        each.append(at_second(velocities, body.contacts.apart))
    laws = body.contacts.laws
    return tuple([slip_part(one, slip_length(law)) for one, law in zip(each, laws, strict=True)])


def status_at(
    body: StruckBody,
    impulse: Impulse,
    beside: str,
    ratio: float = 0.0,
    least: float = 0.0,
) -> StruckStatus:
    """Return what the contacts do after an impulse.

    Parameters
    ----------
    body, impulse
        The body, and the impulse.
    beside, ratio, least
        What the second contact does: see `StruckStatus`.

    Raises
    ------
    ArithmeticError
        If nothing can hold what has ended, and it can go on in no direction.
    """
    velocities = body.velocities(impulse)
    numbers, least_of = acting(beside), least_slip(body)
    slips = slips_at(body, velocities)
    ended = [
        is_set_valued(law) and size(slip) <= least_of
        for law, slip in zip(body.contacts.laws, slips, strict=True)
    ]
    if len(numbers) > 1 and any(ended):
        # What is left of the slip of one contact where that of the other ends with it is rounding.
        ended = [size(slip) <= max(LEFT_OVER * least_of, BOTH_END) for slip in slips]
        if slip_length(body.contacts.laws[0]) is not None:
            ended = [all(ended), all(ended)]
    rolling, resisted = velocities[3:5], body.contacts.resistance is not None
    stopped = resisted and size(rolling) <= least_of
    states = [SLIDES for _ in slips]
    plain = StruckStatus(
        beside, ratio, least, tuple(states), SLIDES if resisted else HELD, (None,) * 3
    )
    if not stopped and not any(ended[number] for number in numbers):
        return plain
    turning = (velocities[3], velocities[4], velocities[5])
    points = [point._replace(turning=turning) for point in body.points]
    if len(numbers) == 1:
        number = numbers[0]
        onset, _ = contact_after_end(
            points[number],
            None if ended[number] else slips[number],
            None if stopped else rolling,
            moved=moved_under(1.0, 0.0),
        )
        directions_begun: list[Slip | None] = [None, None, None]
        if ended[number]:
            states[number] = HELD if onset.slip is None else BEGINS
            directions_begun[number] = onset.slip
        rolls = plain.rolling
        if stopped:
            rolls = HELD if onset.rolling is None else BEGINS
            directions_begun[2] = onset.rolling
        return plain._replace(
            slips=tuple(states), rolling=rolls, directions=tuple(directions_begun)
        )
    return _status_on_two(body, plain, points, slips, ended, stopped)


def _status_on_two(
    body: StruckBody,
    plain: StruckStatus,
    points: Sequence[ContactPoint],
    slips: Sequence[Slip],
    ended: Sequence[bool],
    stopped: bool,
) -> StruckStatus:
    """Return the status of two contacts of which slip, or rolling, has ended."""
    turning = points[0].turning
    turned_round = bool(ended[1] and not ended[0])
    order = (1, 0) if turned_round else (0, 1)
    pair = (points[order[0]], points[order[1]])
    at_rest = bool(ended[order[0]]), bool(ended[order[1]])
    slip = (0.0, 0.0) if at_rest[0] else slips[0][:2]
    xi = (slip[0], slip[1], 0.0 if all(at_rest) else slip_apart(pair))

    def resolved(rolling: Slip | None) -> Resolution:
        def motion(points: ContactPair, slips: Slips, rolls: float) -> ContactForces:
            ordered = (slips[order[0]], slips[order[1]])
            unit = unit_impulse(
                body.contacts, plain.beside, ordered, rolling, turning, plain.ratio, plain.least
            )
            return _forces(body, unit, points, order)

        moved: OnTwo = motion
        return of_slips(pair, xi, at_rest, 0.0, moved)

    def slips_with(resolution: Resolution) -> list[Slip | None]:
        """Return the slip of each contact, or the direction in which it begins."""
        onsets = _onset_directions(pair, resolution)
        each: list[Slip | None] = [None, None]
        for place, number in enumerate(order):
            if not at_rest[place]:
                each[number] = slips[number]
            elif not resolution.sticks[place]:
                each[number] = onsets[place]
        return each

    rolling_onset: Slip | None = None
    resolution = resolved(None if stopped else (turning[0], turning[1]))
    if stopped:
        rolling_onset = _rolling_begins(body, plain, resolved, slips_with(resolution), turning)
        resolution = resolution if rolling_onset is None else resolved(rolling_onset)
    states, each = list(plain.slips), slips_with(resolution)
    onsets: list[Slip | None] = [None, None, rolling_onset]
    for place, number in enumerate(order):
        if at_rest[place]:
            states[number] = HELD if resolution.sticks[place] else BEGINS
            onsets[number] = each[number]
    rolls = plain.rolling
    if stopped:
        rolls = HELD if rolling_onset is None else BEGINS
    return plain._replace(slips=tuple(states), rolling=rolls, directions=tuple(onsets))


def _rolling_begins(
    body: StruckBody,
    plain: StruckStatus,
    resolved: Callable[[Slip | None], Resolution],
    slips: Slips,
    turning: Vector,
) -> Slip | None:
    """Return the direction in which rolling begins on two contacts; None where it is held."""
    resistance = body.contacts.resistance
    assert resistance is not None
    unit = unit_impulse(body.contacts, plain.beside, slips, None, turning, plain.ratio, plain.least)
    if resistance.reserve(1.0, unit.couple) >= 0.0:
        return None
    response = body.contacts.response
    strength = (response[3][3] + response[4][4]) * resistance.length

    def resisted(ways: Sequence[Slip]) -> list[Resisted]:
        x, y, _ = resolved(ways[0]).motion.rates.turning
        return [Resisted((x, y), strength)]

    return directions(resisted, [scaled(-1.0, unit.couple)])[0]


def _onset_directions(pair: ContactPair, resolution: Resolution) -> tuple[Slip, Slip]:
    """Return the directions in which the slips of two contacts begin."""
    begins = resolution.begins or (0.0, 0.0, 0.0)
    if any(resolution.sticks):
        sign = begins[2] if resolution.sticks[0] else -begins[2]
        across = scaled(sign, directions_of(pair[0].axis)[1][:2])
        return across, across
    return slips_of(pair, begins)


def _forces(
    body: StruckBody, unit: UnitImpulse, points: ContactPair, order: Sequence[int]
) -> ContactForces:
    """Return a unit impulse as the forces of two contacts in an order, and what it changes."""
    change = changed(body.contacts, unit.total)
    moved = change, at_second(change, body.contacts.apart)
    wrenches = [
        Wrench(_vector(unit.wrenches[number][:3]), _vector(unit.wrenches[number][3:]))
        for number in order
    ]
    velocities = [_vector(moved[number][:3]) for number in order]
    rates = ContactRates((velocities[0], velocities[1]), _vector(change[3:]))
    return ContactForces(points, (wrenches[0], wrenches[1]), rates)


def _vector(numbers: Slip) -> Vector:
    return (numbers[0], numbers[1], numbers[2])
