"""Which of two closed contacts stick, whether rolling is held, and how what cannot be goes on."""

from collections.abc import Callable, Sequence
from typing import NamedTuple, TypeAlias

from tippetop.mechanics.contacts.contact_forces import ContactForces, forces_on_two
from tippetop.mechanics.contacts.contact_point import contact_points
from tippetop.mechanics.contacts.forces import Slips, directions_of, slip_length
from tippetop.mechanics.contacts.pair import ContactPair, apart, slips_of, turning_along
from tippetop.mechanics.contacts.slip_direction import Resisted, directions, directions_near
from tippetop.mechanics.contacts.slip_variables import plus, scaled, size
from tippetop.mechanics.contacts.system import rates_added
from tippetop.mechanics.contacts.wrench import DRILLING, EAST, NORTH, Slip, Wrench
from tippetop.mechanics.laws.friction import NO_TORQUE
from tippetop.mechanics.roots import dip
from tippetop.mechanics.unsolved import Unsolved
from tippetop.mechanics.vectors import scale

CUTS = 50
"""Bounds of the rolling at which patches slip, at most: a few find it to rounding."""

LEAST_SPARE = 1e-3
"""Friction along e that is left beside the force across it, per unit normal force, at least: it
bounds the first guess of the direction in which slip begins, from which the search goes on.
"""


OnTwo: TypeAlias = Callable[[ContactPair, Slips, float], ContactForces]
"""From slips, None where they are held, and the sense of rolling to what the table does: in contact
(`forces_on_two`), or in an impact.
"""


class Resolution(NamedTuple):
    """How two contacts go on."""

    motion: ContactForces
    """What the table does, and how the contacts accelerate."""
    sticks: tuple[bool, bool]
    """Which of them stick."""
    rolls: float
    """Sign of omega_e; 0 where rolling is held, or not resisted."""
    begins: Slip | None = None
    """Direction of xi where slip begins; None where nothing does."""


def resolution(
    pair: ContactPair,
    xi: Slip,
    ended: tuple[bool, bool],
    rolls: float,
    moved: OnTwo = forces_on_two,
) -> Resolution:
    """Return how two contacts go on whose slip has ended: on both, on the first, or on none.

    What is tried first is to hold rolling, if that is resisted and has ended (rolls = 0), and then
    that it begins, one way or the other.

    Raises
    ------
    ArithmeticError
        If nothing can hold them, and there is no direction, or more than one, in which they can go
        on.
    """
    if rolls or not pair[0].top.resists_rolling:
        return of_slips(pair, xi, ended, rolls, moved)
    held = _without_rolling(pair, xi, ended, moved)
    if held is not None and held.motion.rolling_reserve >= 0.0:
        return held
    direction = 1.0 if held is None else rolling_direction(held.motion)
    for sign in (direction, -direction):
        trial = of_slips(pair, xi, ended, sign, moved)
        if trial.motion.rolling_rate * sign >= 0.0:
            return trial
    raise Unsolved("nothing can hold the rolling of two contacts, and it can begin neither way")


def _without_rolling(
    pair: ContactPair, xi: Slip, ended: tuple[bool, bool], moved: OnTwo
) -> Resolution | None:
    """Return the resolution with rolling held; None where rolling cannot be held."""
    try:
        return of_slips(pair, xi, ended, 0.0, moved)
    except ArithmeticError:
        return None


def rolling_direction(held: ContactForces) -> float:
    """Sign of omega_e where rolling begins: against the couple that would have held it."""
    return -1.0 if held.holding > 0.0 else 1.0


def of_slips(
    pair: ContactPair,
    xi: Slip,
    ended: tuple[bool, bool],
    rolls: float,
    moved: OnTwo = forces_on_two,
) -> Resolution:
    """Return the resolution for slips, and for a given sense of rolling.

    What is tried first is that all stick that can, then that one of them slips, and then both;
    where patches resist drilling, one does not slip alone.
    """
    first, second = slips_of(pair, xi)
    slips: Slips = (None if ended[0] else first, None if ended[1] else second)
    held = moved(pair, slips, rolls)
    if not any(ended):
        return Resolution(held, (False, False), rolls)
    if not all(ended):
        sticks = held.reserve(0) >= 0.0
        return (
            Resolution(held, (True, False), rolls)
            if sticks
            else first_begins_to_slip(pair, xi, rolls, moved)
        )
    if slip_length(pair[0].top.friction) is not None:
        return patches_begin_to_slip(pair, rolls, moved) or Resolution(held, (True, True), rolls)
    if held.is_held:
        return Resolution(held, (True, True), rolls)
    for number in (0, 1):
        for sign in (1.0, -1.0):
            trial = turning_about(pair, number, sign, rolls, moved)
            if trial.motion.rate[2] * sign >= 0.0 and trial.motion.reserve(number) >= 0.0:
                return trial
    return both_begin_to_slip(pair, rolls, moved)


def first_begins_to_slip(
    pair: ContactPair,
    xi: Slip,
    rolls: float,
    moved: OnTwo = forces_on_two,
    near: Slip | None = None,
) -> Resolution:
    """Return the resolution in which the first contact, which alone sticks, begins to slip; `near`
    is an approximate direction of xi, if that is known.

    Raises
    ------
    ArithmeticError
        If there is no direction for it, or more than one.
    """
    slip = slips_of(pair, xi)[1]
    stiffness = _stiffness(pair)

    def motion(direction: Slip | None) -> ContactForces:
        return moved(pair, (direction, slip), rolls)

    def response(ways: Sequence[Slip]) -> list[Resisted]:
        trial = motion(ways[0])
        return [Resisted(trial.rates.points[0][:2], stiffness * size(trial.wrenches[0].force[:2]))]

    (direction,) = (
        directions(response, [scaled(-1.0, motion(None).wrenches[0].force[:2])])
        if near is None
        else directions_near(response, [near[:2]])
    )
    return Resolution(motion(direction), (False, False), rolls, (*direction, 0.0))


def both_begin_to_slip(
    pair: ContactPair, rolls: float, moved: OnTwo = forces_on_two, near: Slip | None = None
) -> Resolution:
    """Return the resolution in which both contacts begin to slip, which cannot be held; `near` is
    an approximate direction of xi, if that is known.

    Raises
    ------
    ArithmeticError
        If there is no direction of xi for it, or more than one.
    """
    across, lever = directions_of(pair[0].axis)[1], float(apart(pair))
    turned = rates_added(pair, 1, Wrench(across, NO_TORQUE)).turning[2]
    stiffness = _stiffness(pair) + float(abs(lever * turned))
    drilled = abs(lever * float(rates_added(pair, 0, DRILLING).turning[2]))

    def motion(direction: Slip) -> ContactForces:
        return moved(pair, slips_of(pair, direction), rolls)

    def response(ways: Sequence[Slip]) -> list[Resisted]:
        trial = motion(ways[0])
        strength = sum(
            stiffness * size(wrench.force[:2]) + drilled * abs(wrench.torque[2])
            for wrench in trial.wrenches
        )
        return [Resisted(trial.rate, strength)]

    (direction,) = (
        directions(response, [against(moved(pair, (None, None), rolls))])
        if near is None
        else directions_near(response, [near])
    )
    return Resolution(motion(direction), (False, False), rolls, direction)


def _stiffness(pair: ContactPair) -> float:
    responses = [rates_added(pair, 0, Wrench(unit, NO_TORQUE)).points[0] for unit in (EAST, NORTH)]
    return float(abs(responses[0][0]) + abs(responses[1][1]))


def against(held: ContactForces) -> Slip:
    """Direction of xi against which friction exerts all it can along e, and what is needed across
    it.
    """
    along, across = directions_of(held.points[0].axis)
    sign = -1.0 if held.along >= 0.0 else 1.0
    ratios = []
    for number in (0, 1):
        across_force = held.needed(number)
        spare = max(held.sticking_reserve(number), (LEAST_SPARE * held.normal[number]) ** 2)
        ratios.append(across_force / spare**0.5)
    # Forces S_i e + T_i t act against v_e (e + T_i / S_i t), where S_i has the sign of S.
    v = plus(scaled(sign, along[:2]), scaled(-ratios[0], across[:2]))
    return (*v, -(ratios[1] - ratios[0]))


def patches_begin_to_slip(
    pair: ContactPair, rolls: float, moved: OnTwo = forces_on_two
) -> Resolution | None:
    """Return how patches begin to slip that both stick; None where they can be held.

    They can where forces alone hold them, without moments of drilling. If not, moments may help:
    either some do, or there is a direction in which slip begins, as both limit surfaces are convex.

    Raises
    ------
    ArithmeticError
        If nothing can hold them, and the search for such a direction fails.
    """
    held = moved(pair, (None, None), rolls)
    if held.is_held:
        return None
    try:
        return both_begin_to_slip(pair, rolls, moved)
    except ArithmeticError:
        if moments_hold(held):
            return None
        raise Unsolved("nothing holds two patches, and no direction is found") from None


def moments_hold(held: ContactForces) -> bool:
    """Return whether the table can hold two patches, with moments of drilling too; of floats.

    By the principle of virtual power it can if friction can take, in every direction xi of slip, at
    least the power of the forces that hold them. What it can take beyond that
    (`ContactForces.spare`) is convex in xi and grows with its size: on every face of a cube it has
    one least value.
    """

    def least_on(face: int, side: float) -> float:
        def least_beside(first: float) -> float:
            def spare(second: float) -> float:
                beside = [first, second]
                return float(held.spare((*beside[:face], side, *beside[face:])))

            return dip(spare, -1.0, 1.0)[1]

        return dip(least_beside, -1.0, 1.0)[1]

    return all(least_on(face, side) > 0.0 for face in range(3) for side in (1.0, -1.0))


def rolling_of_slip(pair: ContactPair, rolls: float) -> float:
    """Return the |omega_e|, less than the present one, at which patches that stick begin to slip;
    -1 for none.

    With q = omega_e^2 the needed forces and the normal ones change as a + b q: those that can be
    held fill an interval of q. From q = 0, where they may not, each direction in which slip begins
    bounds it from below.
    """
    axis, momentum, tops = pair[0].axis, pair[0].momentum, [point.top for point in pair]

    def at(q: float) -> ContactPair:
        return contact_points(axis, scale(q**0.5, momentum), tops)

    q, still = 0.0, at(0.0)
    for _ in range(CUTS):
        trial = patches_begin_to_slip(at(q), rolls)
        if trial is None:
            break
        assert trial.begins is not None
        least, most = (
            forces_on_two(one, (None, None), rolls).spare(trial.begins) for one in (still, pair)
        )
        bound = -least / (most - least)
        if not q < bound < 1.0:
            break
        q = bound
    return q**0.5 * float(abs(turning_along(pair))) if q else -1.0


def turning_about(
    pair: ContactPair, number: int, sign: float, rolls: float, moved: OnTwo = forces_on_two
) -> Resolution:
    """Return the resolution in which the body turns about one contact, and the other slips along
    sign.
    """
    across = scaled(sign if number == 0 else -sign, directions_of(pair[0].axis)[1][:2])
    slips: Slips = (None, across) if number == 0 else (across, None)
    motion = moved(pair, slips, rolls)
    return Resolution(motion, (number == 0, number == 1), rolls, (0.0, 0.0, sign))
