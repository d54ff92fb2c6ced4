"""An impact as a motion, in which the normal impulse plays the part of time.

The numbers are those of an `Impulse`. Near the end of slip, or of rolling, their clock is slower
than the normal impulse: slip decays exponentially by it, as in
`tippetop.mechanics.contacts.slip_clock`. The executors of motions, of one launch and of many,
follow it (see `impact`).
"""

from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import Any, NamedTuple

from tippetop.contact.guards import BRANCH
from tippetop.contact.mode import numbered
from tippetop.integrators.base import Guard, Motion
from tippetop.mechanics.contacts.branches import is_branched
from tippetop.mechanics.contacts.forces import is_set_valued, slip_length
from tippetop.mechanics.contacts.slip_variables import inner, plus, slip_part
from tippetop.mechanics.contacts.wrench import Slip
from tippetop.mechanics.impacts.struck_body import FIRST, WORK, StruckBody
from tippetop.mechanics.impacts.struck_status import BOTH_END, HELD, SLIDES, StruckStatus
from tippetop.mechanics.impacts.unit_impulse import (
    DRIVEN,
    OPEN,
    PRESSED,
    SUNK,
    StruckContacts,
    UnitImpulse,
    acting,
    at_second,
    changed,
    normal_velocities,
    unit_impulse,
)
from tippetop.mechanics.laws.coulomb import RollingResistance
from tippetop.mechanics.laws.friction import FrictionLaw
from tippetop.mechanics.natural_units import Units
from tippetop.mechanics.vectors import Horizontal, Row, Scalar

COMPRESSED, SPENT, RETURNED = "compressed", "spent", "returned"
"""The first contact stops sinking; it has the normal impulse that restitution is to give it; or the
normal impulses have given back the work that compression took.
"""

CLOSES, OPENS, JAMS, RETURNS = "closes", "opens", "jams", "returns"
"""The second contact meets the first's ratio again; it needs no normal impulse any more, or no more
than its share; friction presses it as much as its normal impulse opens it; or it has come back.
"""

ENDS, BEGINS_SLIP, SETTLES = "slip ends", "slip begins", "slip settles"
ROLLING_ENDS, ROLLING_BEGINS = "rolling ends", "rolling begins"
"""Slip, or rolling, ends, or can be held no longer; or friction has come to hold slip constant."""

JAMMING = 1e-9
"""Response of the second contact to its own normal impulse, over that without friction, at which it
jams: nearer, its share of the normal impulse is rounding.
"""

STEADY_SLIP, NOISE = 1e-14, 2e-15
"""Rate of slip, in units of the impact, that is none; and the same over the friction that rounding
of slip makes: slip is as far from what friction holds it at as that over its stiffness.
"""

UNITS = Units(1.0, 1.0, 1.0)
"""The units of an impact, in which the numbers of its laws are those of its laws."""

TINY = 1e-300
"""Added to the square of a rate of slip, so that it has a root where it is zero."""


class ImpactForm(NamedTuple):
    """What the equations of an impact are made of, but for their numbers."""

    laws: tuple[type[Any], ...]
    """Law of friction of each contact, or its branch."""
    coefficients: tuple[int, ...]
    """How many numbers each has."""
    resists_rolling: bool
    beside: str
    slips: tuple[str, ...]
    rolling: str
    """What the second contact does, and slip and rolling: see `StruckStatus`."""
    restores: bool
    """Whether it is restitution, which ends with a given normal impulse."""
    ending: bool = True
    """Whether slip that ends, or settles, ends the motion."""


class StruckNumbers(NamedTuple):
    """The parameters of the equations of an impact."""

    contacts: StruckContacts
    before: Slip
    """The six velocities of the first contact at the start."""
    normal_beside: Scalar
    ratio: Scalar
    least: Scalar
    """Normal velocity of the second contact then, and how it is to act: see `StruckStatus`."""
    full: Scalar
    """Normal impulse of the first contact where restitution ends."""
    least_slip: Scalar
    """Slip that has ended."""
    stiffness: Scalar
    """Friction over slip where slip is least: see `NOISE`."""

    @property
    def parameters(self) -> tuple[Scalar, ...]:
        """The parameters in a row."""
        laws = [number for law in self.contacts.laws for number in law.coefficients(UNITS)]
        resistance = self.contacts.resistance
        return (
            *laws,
            *(() if resistance is None else (resistance.length,)),
            *[number for row in self.contacts.response for number in row],
            *self.contacts.apart,
            *self.before,
            self.normal_beside,
            self.ratio,
            self.least,
            self.full,
            self.least_slip,
            self.stiffness,
        )

    @classmethod
    def of(cls, numbers: Row, form: ImpactForm) -> "StruckNumbers":
        """Return the parameters from a row."""
        laws, place = list[FrictionLaw](), 0
        for law, count in zip(form.laws, form.coefficients, strict=True):
            laws.append(law(*numbers[place : place + count]))
            place += count
        resistance = RollingResistance(numbers[place]) if form.resists_rolling else None
        place += int(form.resists_rolling)
        response = [tuple(numbers[place + 6 * i : place + 6 * (i + 1)]) for i in range(6)]
        place += 36
        apart = (numbers[place], numbers[place + 1])
        before = tuple(numbers[place + 2 : place + 8])
        return cls(
            StruckContacts(tuple(response), apart, tuple(laws), resistance),
            before,
            *numbers[place + 8 : place + 14],
        )


class Struck(NamedTuple):
    """A body within an impact."""

    velocities: Slip
    """The six velocities of the first contact."""
    normals: Horizontal
    """Normal velocities of both contacts."""
    slips: tuple[Slip | None, ...]
    """Slip of each contact, None where it is held."""
    rolling: Slip | None
    """The horizontal angular velocity, None where it is held."""
    unit: UnitImpulse
    """The impulses per unit of the normal impulse."""

    @classmethod
    def of(cls, y: Row, form: ImpactForm, numbers: StruckNumbers) -> "Struck":
        """Return the body after an impulse."""
        contacts = numbers.contacts
        change = changed(contacts, tuple(y[:6]))
        velocities = plus(numbers.before, change)
        normals = normal_velocities(numbers.before, numbers.normal_beside, change, contacts)
        each = (velocities, at_second(velocities, contacts.apart))
        slips = tuple(
            [
                None if status == HELD else slip_part(one, slip_length(law))
                for status, one, law in zip(form.slips, each, contacts.laws, strict=False)
            ]
        )
        rolling = None if form.rolling == HELD else velocities[3:5]
        unit = unit_impulse(
            contacts, form.beside, slips, rolling, velocities[3:], numbers.ratio, numbers.least
        )
        return cls(velocities, normals, slips, rolling, unit)

    def impulse_rate(self) -> tuple[Scalar, ...]:
        """Return the rate of the impulse with the normal impulse."""
        first, second = self.unit.shares
        work = first * self.normals[0] + second * self.normals[1]
        return (*self.unit.total, first, work)


def rate_of_clock(struck: Struck, form: ImpactForm, numbers: StruckNumbers) -> Scalar:
    """Return the rate of the clock with the normal impulse.

    Slip that ends is slower by it the less is left: by as much as friction is over slip.
    """
    rate: Scalar = 1.0
    for number in sliding(form):
        law, slip = numbers.contacts.laws[number], struck.slips[number]
        if is_set_valued(law) and slip is not None:
            traction = friction_at(struck, number, law)
            grip = inner(traction, traction) / inner(slip, slip)
            rate = rate + struck.unit.shares[number] * grip**0.5
    resistance = numbers.contacts.resistance
    if resistance is not None and form.rolling == SLIDES and struck.rolling is not None:
        rate = rate + resistance.length * inner(struck.rolling, struck.rolling) ** -0.5
    return rate


def settles(laws: Sequence[FrictionLaw], resists_rolling: bool) -> bool:
    """Return whether slip may come to where friction holds it constant, and impulses then grow in a
    straight line.
    """
    forces = all(law.torque_free and not is_set_valued(law) for law in laws)
    return forces and not resists_rolling


def sliding(form: ImpactForm) -> list[int]:
    """Return the numbers of the contacts that have impulses and slide."""
    return [number for number in acting(form.beside) if form.slips[number] == SLIDES]


def friction_at(struck: Struck, number: int, law: FrictionLaw) -> Slip:
    """Return the friction at a contact per unit normal impulse, over the law's length as drilling
    is.
    """
    slip, reach = struck.slips[number], slip_length(law)
    assert slip is not None
    drilling = struck.velocities[5] if reach is None else slip[2] / reach
    turning = (struck.velocities[3], struck.velocities[4], drilling)
    force, torque = law.traction((slip[0], slip[1]), turning)
    return force if reach is None else (*force, torque[2] / reach)


def form_of(
    body: StruckBody, status: StruckStatus, restores: bool, laws: Sequence[Any]
) -> ImpactForm:
    """Return the form of the equations of a body in a status, with these laws or branches."""
    return ImpactForm(
        tuple([type(law) for law in laws]),
        tuple([len(law.coefficients(UNITS)) for law in laws]),
        body.contacts.resistance is not None,
        status.beside,
        status.slips,
        status.rolling,
        restores,
    )


@lru_cache(maxsize=256)
def impact_motion(form: ImpactForm) -> Motion:
    """Return the equations of an impact of a form, which `StruckNumbers` parametrizes."""

    def guard(
        name: str, value: Callable[[Struck, StruckNumbers], Scalar], turned: float = 1.0
    ) -> Guard:
        def of_numbers(y: Row, row: Row) -> Scalar:
            numbers = StruckNumbers.of(row, form)
            return turned * value(Struck.of(y, form, numbers), numbers)

        return Guard(name, of_numbers)

    def rates(y: Sequence[Scalar], row: Sequence[Scalar]) -> tuple[Scalar, ...]:
        numbers = StruckNumbers.of(row, form)
        struck = Struck.of(y, form, numbers)
        slowness = 1.0 / rate_of_clock(struck, form, numbers)
        return tuple([slowness * rate for rate in struck.impulse_rate()])

    laws = [law(*(1.0,) * count) for law, count in zip(form.laws, form.coefficients, strict=True)]
    guards: list[Guard] = []
    if form.restores:
        guards.append(Guard(SPENT, lambda y, row: StruckNumbers.of(row, form).full - y[FIRST]))
        guards.append(Guard(RETURNED, lambda y, row: -y[WORK]))
    else:
        guards.append(guard(COMPRESSED, lambda struck, _: struck.normals[0], -1.0))
    if form.beside == PRESSED:
        guards.append(guard(OPENS, _pressing))
        guards.append(guard(JAMS, _not_jammed))
    elif form.beside in (OPEN, DRIVEN):
        guards.append(guard(CLOSES, _lifted))
    elif form.beside == SUNK:
        guards.append(guard(RETURNS, lambda struck, _: struck.normals[1], -1.0))
    for number in acting(form.beside):
        guards += [guard(name, value) for name, value in _guards_of(form, number, laws[number])]
    if form.ending and len(sliding(form)) > 1 and is_set_valued(laws[0]):
        guards.append(guard(ENDS, _both_slips_left))
    if form.ending and settles(
        [laws[number] for number in acting(form.beside)], form.resists_rolling
    ):
        guards.append(guard(SETTLES, _slip_rates(form)))
    if form.resists_rolling and form.ending:
        if form.rolling == SLIDES:
            guards.append(guard(ROLLING_ENDS, _rolling_left))
        else:
            guards.append(guard(ROLLING_BEGINS, _rolling_reserve))
    count = sum(form.coefficients) + int(form.resists_rolling) + 36 + 2 + 6 + 6
    return Motion(rates, size=8, parameters=count, guards=tuple(guards), lasting=False)


def _pressing(struck: Struck, numbers: StruckNumbers) -> Scalar:
    """Positive while the second contact has more than its least share of the normal impulse."""
    coupling, direct = struck.unit.coupling, struck.unit.direct
    return -coupling - numbers.least * (direct - coupling)


def _not_jammed(struck: Struck, numbers: StruckNumbers) -> Scalar:
    """Positive while the normal impulse of the second contact opens it."""
    upwards = about_second_normal(numbers.contacts)
    return struck.unit.direct - JAMMING * upwards


def about_second_normal(contacts: StruckContacts) -> Scalar:
    """Return how the second contact responds to its own normal impulse without friction."""
    x, y = contacts.apart
    wrench = (0.0, 0.0, 1.0, y, -x, 0.0)
    return inner(wrench, changed(contacts, wrench))


def _lifted(struck: Struck, numbers: StruckNumbers) -> Scalar:
    """v_2 - ratio v_1."""
    first, second = struck.normals
    return second - numbers.ratio * first


def _both_slips_left(struck: Struck, numbers: StruckNumbers) -> Scalar:
    total: Scalar = -BOTH_END
    for slip in struck.slips:
        assert slip is not None
        total = total + inner(slip, slip) ** 0.5
    return total


def _rolling_left(struck: Struck, numbers: StruckNumbers) -> Scalar:
    assert struck.rolling is not None
    return inner(struck.rolling, struck.rolling) ** 0.5 - numbers.least_slip


def _rolling_reserve(struck: Struck, numbers: StruckNumbers) -> Scalar:
    resistance: Any = numbers.contacts.resistance
    return resistance.reserve(1.0, struck.unit.couple)


def _guards_of(
    form: ImpactForm, number: int, law: FrictionLaw
) -> list[tuple[str, Callable[[Struck, StruckNumbers], Scalar]]]:
    """Return the guards of the slip of a contact."""
    guards: list[tuple[str, Callable[[Struck, StruckNumbers], Scalar]]] = []
    if form.slips[number] == SLIDES:
        if is_branched(law):
            guards.append((numbered(BRANCH, number), _branch(number)))
        if not form.ending:
            return guards
        if is_set_valued(law):
            guards.append((numbered(ENDS, number), _slip_left(number)))
        return guards
    if not is_set_valued(law) or not form.ending:
        return guards
    both = len([one for one in acting(form.beside) if form.slips[one] == HELD]) > 1
    if not both:
        guards.append((numbered(BEGINS_SLIP, number), _reserve(number)))
    elif slip_length(law) is None:
        guards.append((numbered(BEGINS_SLIP, number), _reserve_across(number)))
        if number:
            guards.append((BEGINS_SLIP, _reserve_along))
    return guards


def _branch(number: int) -> Callable[[Struck, StruckNumbers], Scalar]:
    def value(struck: Struck, numbers: StruckNumbers) -> Scalar:
        law: Any = numbers.contacts.laws[number]
        return law.branch_guard(struck.slips[number])

    return value


def _slip_left(number: int) -> Callable[[Struck, StruckNumbers], Scalar]:
    def value(struck: Struck, numbers: StruckNumbers) -> Scalar:
        slip = struck.slips[number]
        assert slip is not None
        return inner(slip, slip) ** 0.5 - numbers.least_slip

    return value


def _slip_rates(form: ImpactForm) -> Callable[[Struck, StruckNumbers], Scalar]:
    def value(struck: Struck, numbers: StruckNumbers) -> Scalar:
        rates = slip_rates(struck.unit, acting(form.beside), numbers.contacts)
        return (inner(rates, rates) + TINY) ** 0.5 - settled_rate(numbers.stiffness)

    return value


def settled_rate(stiffness: Scalar) -> Scalar:
    """Return the rate of slip below which friction holds it constant, but for rounding."""
    return STEADY_SLIP + NOISE * stiffness


def slip_rates(unit: UnitImpulse, numbers: Sequence[int], contacts: StruckContacts) -> Slip:
    """Return the rates of the slips of some contacts with the normal impulse."""
    change = changed(contacts, unit.total)
    rates: Slip = ()
    for number in numbers:
        moved = at_second(change, contacts.apart) if number else change
        rates = (*rates, moved[0], moved[1])
    return rates


def _reserve(number: int) -> Callable[[Struck, StruckNumbers], Scalar]:
    def value(struck: Struck, numbers: StruckNumbers) -> Scalar:
        law: Any = numbers.contacts.laws[number]
        x, y, normal, _, _, drilling = struck.unit.wrenches[number]
        return law.reserve(normal, (x, y), drilling)

    return value


def _reserve_across(number: int) -> Callable[[Struck, StruckNumbers], Scalar]:
    def value(struck: Struck, numbers: StruckNumbers) -> Scalar:
        return across_reserve(struck.unit, number, numbers.contacts)

    return value


def across_reserve(unit: UnitImpulse, number: int, contacts: StruckContacts) -> Scalar:
    """Return the reserve of a contact of two that stick, without what acts along both."""
    law: Any = contacts.laws[number]
    across = across_line(unit.wrenches[number], contacts.apart)
    return law.reserve(unit.wrenches[number][2], (across, 0.0), 0.0)


def across_line(wrench: Slip, apart: Horizontal) -> Scalar:
    """Return the part of a force across the line that joins both contacts."""
    return (wrench[1] * apart[0] - wrench[0] * apart[1]) * inner(apart, apart) ** -0.5


def _reserve_along(struck: Struck, numbers: StruckNumbers) -> Scalar:
    """Return the reserve of the force along both contacts that stick."""
    contacts, unit = numbers.contacts, struck.unit
    first, second = (across_reserve(unit, number, contacts) for number in (0, 1))
    inverse = inner(contacts.apart, contacts.apart) ** -0.5
    along: Scalar = 0.0
    for wrench in unit.wrenches:
        along = along + inner(wrench[:2], contacts.apart) * inverse
    product = first * second
    return first + second + 2.0 * (product * product + TINY) ** 0.25 - along * along
