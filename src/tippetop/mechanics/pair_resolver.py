"""Which of two closed contacts stick, and how those go on that cannot."""

from typing import NamedTuple

from tippetop.mechanics.contact_pair import (
    ContactPair,
    PairMotion,
    Slips,
    directions_of,
    pair_motion,
    slips_of,
    way_of_both,
    way_of_one,
)
from tippetop.mechanics.rolling import Slip, slip_length
from tippetop.mechanics.stick_slip import scaled


class Resolution(NamedTuple):
    """How two contacts go on.

    Attributes
    ----------
    motion
        What the table does, and how the contacts accelerate.
    sticks
        Which of them stick.
    begins
        Direction of xi where slip begins; None where nothing does.
    """

    motion: PairMotion
    sticks: tuple[bool, bool]
    begins: Slip | None = None


def resolution(pair: ContactPair, xi: Slip, ended: tuple[bool, bool]) -> Resolution:
    """How two contacts go on that slip so, of which slip has ended on some; if on one, on the first.

    What is tried first is that all stick that can, then that one of them slips, and then both; where patches
    resist drilling, one does not slip alone.

    Raises
    ------
    ArithmeticError
        If nothing can hold them, and there is no direction, or more than one, in which they can slip.
    """
    one, other = slips_of(pair, xi)
    slips: Slips = (None if ended[0] else one, None if ended[1] else other)
    held = pair_motion(pair, slips)
    if not any(ended):
        return Resolution(held, (False, False))
    if not all(ended):
        return Resolution(held, (True, False)) if held.reserve(0) >= 0.0 else letting_go(pair, xi)
    if min(held.left(0), held.left(1)) >= 0.0 and held.both_reserve >= 0.0:
        return Resolution(held, (True, True))
    if slip_length(pair.first.top.friction) is not None:
        return both_letting_go(pair)
    for number in (0, 1):
        for sign in (1.0, -1.0):
            found = turning_about(pair, number, sign)
            if found.motion.rate[2] * sign >= 0.0 and found.motion.reserve(number) >= 0.0:
                return found
    return both_letting_go(pair)


def letting_go(pair: ContactPair, xi: Slip) -> Resolution:
    """The first contact, which alone sticks, begins to slip."""
    way, motion = way_of_one(pair, slips_of(pair, xi)[1])
    return Resolution(motion, (False, False), (*way, 0.0))


def both_letting_go(pair: ContactPair) -> Resolution:
    """Both contacts begin to slip."""
    way, motion = way_of_both(pair)
    return Resolution(motion, (False, False), way)


def turning_about(pair: ContactPair, number: int, sign: float) -> Resolution:
    """The body begins to turn about one of both contacts, and the other slips, xi_3 as signed."""
    across = scaled(sign if number == 0 else -sign, directions_of(pair.first.axis)[1][:2])
    slips: Slips = (None, across) if number == 0 else (across, None)
    return Resolution(pair_motion(pair, slips), (number == 0, number == 1), (0.0, 0.0, sign))
