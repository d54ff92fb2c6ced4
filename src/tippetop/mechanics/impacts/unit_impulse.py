"""The impulses of the table per unit of the normal impulse: the equations of every impact.

The configuration is fixed. A component of the velocity is the power of a unit wrench r about the
first contact point, six numbers, and a wrench c changes it by r.M c with the response M of the
body. Each contact has a unit normal impulse with the friction of its law where it slips; what is
held, slip or rolling, has multipliers so that it does not change. Both contacts then change the
normal velocities v_1 and v_2 by a matrix A per unit of their normal impulses q_1 and q_2,

    dv_1 = A_11 dq_1 + A_12 dq_2,        dv_2 = A_21 dq_1 + A_22 dq_2.

A second contact that is closed has dq_2 >= 0, dv_2 >= 0 and dq_2 dv_2 = 0. Where both strike at
once their normal velocities keep their ratio, v_2 = ratio v_1, by dq_2 >= 0 in the same way: the
closed contact is the case of ratio 0.
"""

from collections.abc import Sequence
from typing import NamedTuple

from tippetop.mechanics.contacts.forces import Slips, slip_length
from tippetop.mechanics.contacts.slip_variables import inner
from tippetop.mechanics.contacts.wrench import Slip
from tippetop.mechanics.laws.coulomb import RollingResistance
from tippetop.mechanics.laws.friction import FrictionLaw
from tippetop.mechanics.vectors import Horizontal, Scalar, solve

ALONE, OPEN, PRESSED, DRIVEN, SUNK = "alone", "open", "pressed", "driven", "sunk"
"""What the second contact does: there is none; it is open; it keeps its ratio to the first, closed
or striking; it has a given share of the normal impulse, in restitution; or friction jams it, so
that it has all of the normal impulse and sinks meanwhile.
"""

NORMAL: Slip = (0.0, 0.0, 1.0, 0.0, 0.0, 0.0)
DRILLING: Slip = (0.0, 0.0, 0.0, 0.0, 0.0, 1.0)
"""Unit wrenches: a force along the normal, and a couple about the vertical."""


class StruckContacts(NamedTuple):
    """The contacts of a struck body in units of the impact: see `struck_body`."""

    response: Sequence[Slip]
    """Changes of the six velocities of the first contact per unit wrench, shape (6, 6)."""
    apart: Horizontal
    """From the first contact point to the second one."""
    laws: tuple[FrictionLaw, ...]
    """The law of friction at each contact, or its branch there."""
    resistance: RollingResistance | None
    """What resists rolling."""


class UnitImpulse(NamedTuple):
    """The impulses per unit of the normal impulse of all contacts."""

    total: Slip
    """The wrench of all contacts about the first contact point."""
    shares: Horizontal
    """Parts of the normal impulse at the first contact and at the second."""
    wrenches: tuple[Slip, Slip]
    """The wrench at each contact about its own point; what holds rolling is at the first."""
    coupling: Scalar
    """How a unit normal impulse at the first contact changes v_2 - ratio v_1."""
    direct: Scalar
    """How one at the second contact does."""
    couple: Horizontal
    """The couple that holds rolling; zero where nothing does."""


def acting(beside: str) -> tuple[int, ...]:
    """Return the numbers of the contacts that have impulses."""
    if beside in (ALONE, OPEN):
        return (0,)
    return (1,) if beside == SUNK else (0, 1)


def at_second(velocities: Slip, apart: Horizontal) -> Slip:
    """Return the six velocities of the second contact from those of the first."""
    x, y, z, along, across, upright = velocities
    return (
        x - upright * apart[1],
        y + upright * apart[0],
        z + (along * apart[1] - across * apart[0]),
        along,
        across,
        upright,
    )


def normal_velocities(
    before: Slip, normal_beside: Scalar, change: Slip, contacts: StruckContacts
) -> Horizontal:
    """Return the normal velocities of both contacts where those of the first have changed so.

    The second's change is that of the first and of the turning, which keeps digits.
    """
    return before[2] + change[2], normal_beside + at_second(change, contacts.apart)[2]


def about_first(wrench: Slip, apart: Horizontal) -> Slip:
    """Return a wrench at the second contact as one about the first contact point."""
    x, y, z, along, across, upright = wrench
    return (
        x,
        y,
        z,
        along + apart[1] * z,
        across - apart[0] * z,
        upright + (apart[0] * y - apart[1] * x),
    )


def unit_impulse(
    contacts: StruckContacts,
    beside: str,
    slips: Slips,
    rolling: Slip | None,
    turning: Slip,
    ratio: Scalar,
    least: Scalar,
) -> UnitImpulse:
    """Return the impulses per unit of the normal impulse.

    Parameters
    ----------
    contacts
        The contacts.
    beside
        What the second contact does.
    slips
        Slip of each contact, or its direction; None where it is held.
    rolling
        The horizontal angular velocity, or its direction; None where it is held.
    turning
        The angular velocity.
    ratio
        Ratio of the normal velocities, v_2 over v_1.
    least
        Share of the second contact in the normal impulse where it is driven.
    """
    numbers = acting(beside)
    held = held_wrenches(contacts, numbers, slips, rolling)
    placed = [at_first(contacts, number, wrench) for number, wrench in held]
    moved = [changed(contacts, wrench) for wrench in placed]
    matrix = [[inner(row, column) for column in moved] for row in placed]
    zero = 0.0 * turning[0]
    normals: list[Slip] = [(), ()]
    multipliers: list[list[Scalar]] = [[], []]
    changes: list[Slip] = [(), ()]
    for number in numbers:
        normals[number] = normal_wrench(contacts, number, slips[number], rolling, turning)
        column = at_first(contacts, number, normals[number])
        change = changed(contacts, column)
        if placed:
            right = [-inner(row, change) for row in placed]
            multipliers[number] = solve(matrix, right)
            for size, motion in zip(multipliers[number], moved, strict=True):
                change = tuple([a + size * b for a, b in zip(change, motion, strict=True)])
        changes[number] = change
    coupling, direct = zero, zero
    if beside != ALONE:
        coupling = _lifted(changes[0], contacts.apart, ratio) if changes[0] else zero
        direct = _lifted(changes[1], contacts.apart, ratio) if changes[1] else zero
    shares = _shares(beside, coupling, direct, least)
    wrenches = [(zero,) * 6, (zero,) * 6]
    for number in numbers:
        share = shares[number] if len(numbers) > 1 else 1.0
        wrenches[number] = _plus(wrenches[number], share, normals[number])
        for (place, wrench), size in zip(held, multipliers[number], strict=True):
            wrenches[place] = _plus(wrenches[place], share * size, wrench)
    couple = (zero, zero)
    if rolling is None and contacts.resistance is not None:
        count = 1 if len(numbers) > 1 else 2
        for number in numbers:
            share = shares[number] if len(numbers) > 1 else 1.0
            sizes = multipliers[number][-count:]
            for (_, wrench), size in zip(held[-count:], sizes, strict=True):
                couple = (
                    couple[0] + share * size * wrench[3],
                    couple[1] + share * size * wrench[4],
                )
    total = wrenches[0]
    if 1 in numbers:
        total = _plus(total, 1.0, about_first(wrenches[1], contacts.apart))
    return UnitImpulse(total, shares, (wrenches[0], wrenches[1]), coupling, direct, couple)


def _shares(beside: str, coupling: Scalar, direct: Scalar, least: Scalar) -> Horizontal:
    """Return the parts of the normal impulse at the first contact and at the second."""
    if beside in (ALONE, OPEN):
        return 1.0, 0.0
    if beside == SUNK:
        return 0.0, 1.0
    if beside == DRIVEN:
        return 1.0 - least, least
    inverse = 1.0 / (direct - coupling)
    return direct * inverse, -coupling * inverse


def _lifted(change: Slip, apart: Horizontal, ratio: Scalar) -> Scalar:
    """Return a change of v_2 - ratio v_1."""
    return at_second(change, apart)[2] - ratio * change[2]


def held_wrenches(
    contacts: StruckContacts, numbers: Sequence[int], slips: Slips, rolling: Slip | None
) -> list[tuple[int, Slip]]:
    """Return the unit wrenches that hold slip and rolling, and the contact at which each acts.

    Two contacts that are held have the same velocity along the line that joins them. Their normal
    impulses tell how the body turns across it: no couple holds that.
    """
    sticking = [number for number in numbers if slips[number] is None]
    held: list[tuple[int, Slip]] = []
    if len(sticking) > 1:
        x, y = line_of(contacts)
        along, across = (x, y, 0.0, 0.0, 0.0, 0.0), (-y, x, 0.0, 0.0, 0.0, 0.0)
        held += [(0, along), (0, across), (1, across)]
    elif sticking:
        number = sticking[0]
        held += [
            (number, (1.0, 0.0, 0.0, 0.0, 0.0, 0.0)),
            (number, (0.0, 1.0, 0.0, 0.0, 0.0, 0.0)),
        ]
        if slip_length(contacts.laws[number]) is not None:
            held.append((number, DRILLING))
    if rolling is None and contacts.resistance is not None:
        x, y = line_of(contacts) if len(numbers) > 1 else (1.0, 0.0)
        held.append((numbers[0], (0.0, 0.0, 0.0, x, y, 0.0)))
        if len(numbers) == 1:
            held.append((numbers[0], (0.0, 0.0, 0.0, -y, x, 0.0)))
    return held


def line_of(contacts: StruckContacts) -> Horizontal:
    """Return the direction from the first contact point to the second one."""
    x, y = contacts.apart
    inverse = (x * x + y * y) ** -0.5
    return x * inverse, y * inverse


def normal_wrench(
    contacts: StruckContacts, number: int, slip: Slip | None, rolling: Slip | None, turning: Slip
) -> Slip:
    """Return a unit normal impulse at a contact with its friction, and the couple of rolling
    resistance.
    """
    x, y, along, across, upright = 0.0, 0.0, 0.0, 0.0, 0.0
    if slip is not None:
        law = contacts.laws[number]
        reach = slip_length(law)
        drilling = turning[2] if reach is None else slip[2] / reach
        force, torque = law.traction((slip[0], slip[1]), (turning[0], turning[1], drilling))
        x, y, (along, across, upright) = force[0], force[1], torque
    if contacts.resistance is not None and rolling is not None:
        couple = contacts.resistance.couple((rolling[0], rolling[1], 0.0))
        along, across = along + couple[0], across + couple[1]
    return (x, y, 1.0, along, across, upright)


def at_first(contacts: StruckContacts, number: int, wrench: Slip) -> Slip:
    """Return a wrench at a contact as one about the first contact point."""
    return about_first(wrench, contacts.apart) if number else wrench


def changed(contacts: StruckContacts, wrench: Slip) -> Slip:
    """Return the changes of the six velocities of the first contact by a wrench about its point."""
    return tuple([inner(row, wrench) for row in contacts.response])


def _plus(a: Slip, factor: Scalar, b: Slip) -> Slip:
    return tuple([x + factor * y for x, y in zip(a, b, strict=True)])
