"""Impact of the body on the table, with the friction impulse that follows from the friction law.

An impact is too short for the body to move, so that its configuration, and the arm a from the
centre of mass to the contact point, stay fixed while its velocities jump. The normal impulse p
plays the part of time (Routh 1905, Dynamics of a System of Rigid Bodies, Advanced Part, chapter 5;
Stronge 2018, Impact Mechanics, chapter 4): where the sliding body feels the force N (z + f) and the
torque N t, the struck one gains

    dP = (z + f) dp,        dL = (a x (z + f) + t) dp,        f, t = law(slip, angular velocity),

and the velocity v of its contact point changes by dv = M dP + (J t dp) x a, with J the inverse
inertia of the body and M that of the contact (Delassus matrix), symmetric and positive definite
(Glocker 2014, Meccanica 49, and Leine and Glocker 2003, Eur. J. Mech. A 22, treat set-valued laws
in the same setting). Slip that ends stays ended if friction can hold it, or goes on: see
`tippetop.mechanics.impacts.struck_status`.

*Compression* lasts until the normal velocity v_n returns to zero from below. It may sink first:
where friction presses the contact together more than p opens it (Painleve's paradox), an impact
starts even at v_n = 0 and ends only when the slip has changed. It always ends: while v_n < 0 the
kinetic energy falls, dT/dp = v_n + f.v + t.omega < 0, but the impulse would make it grow with p^2.

*Restitution* is Poisson's: it lasts while p grows from the impulse of compression p_c to (1 + e)
p_c, with friction going on. With friction, that hypothesis may create energy: the slope dv_n/dp can
be larger in restitution than in compression, and then the normal impulse gives back more work than
it took, even for e < 1 (Stronge 1990). The work of the normal impulse, the integral of v_n dp, is
therefore followed, and restitution ends at once should it reach zero, which is the most that
Stronge's energetic hypothesis allows. As friction only takes (f.v + t.omega <= 0), no impact gains
energy. Should v_n be negative at the end, which friction that turns during restitution might do,
the impact goes on until it is zero.

*A second contact* that is closed is pressed as soon as it would sink, and has the normal impulse
that keeps its normal velocity zero (see `tippetop.mechanics.impacts.unit_impulse`). Where both
strike at the same instant their normal velocities come to zero together, unless the impulse of one
opens the other. In restitution each has at least e times the normal impulse of its own compression,
both in proportion.

Jellett's integral is conserved on one contact without torque: P acts at the fixed arm, and a.(a x
P) = 0.
"""

# translate module: numbers

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from tippetop.contact.guards import BRANCH
from tippetop.contact.impact_motion import (
    BEGINS_SLIP,
    CLOSES,
    COMPRESSED,
    ENDS,
    JAMS,
    OPENS,
    RETURNED,
    RETURNS,
    ROLLING_BEGINS,
    ROLLING_ENDS,
    SETTLES,
    SPENT,
    StruckNumbers,
    form_of,
    impact_motion,
    settled_rate,
    settles,
    slip_rates,
)
from tippetop.contact.mode import BOTH, NUMBER_SIGN
from tippetop.integrators.base import Integrator
from tippetop.integrators.dense import as_array
from tippetop.integrators.unnamed import unnamed_integrator
from tippetop.mechanics.contacts.branches import on_branch, on_other_branch
from tippetop.mechanics.contacts.forces import is_set_valued
from tippetop.mechanics.contacts.slip_variables import come_to_rest, inner, size
from tippetop.mechanics.contacts.wrench import Slip
from tippetop.mechanics.impacts.struck_body import (
    FIRST,
    NO_IMPULSE,
    UPWARDS,
    WORK,
    Impulse,
    StruckBody,
)
from tippetop.mechanics.impacts.struck_status import (
    BEGINS,
    BOTH_END,
    HELD,
    SLIDES,
    StruckStatus,
    least_slip,
    slips_at,
    status_at,
)
from tippetop.mechanics.impacts.unit_impulse import (
    ALONE,
    DRIVEN,
    NORMAL,
    OPEN,
    PRESSED,
    SUNK,
    UnitImpulse,
    acting,
    at_first,
    at_second,
    changed,
    held_wrenches,
    unit_impulse,
)
from tippetop.mechanics.impacts.viscous_impact import ViscousImpact
from tippetop.mechanics.laws.friction import ViscousLaw
from tippetop.mechanics.motion import along_table
from tippetop.mechanics.state import State
from tippetop.mechanics.top import Top
from tippetop.mechanics.unsolved import Unsolved
from tippetop.mechanics.vectors import Scalar, solve

CLOCK_END = 1e12
"""Where the clock of an impact would end, which no impact reaches."""

MOST_IMPACT_STEPS = 200_000
"""Steps after which an impact is given up, within seconds; most take some ten."""

MOST_PHASES = 500
"""Phases that an impact may have, of one status and one branch of the law each."""

ONSET = 1e-9
"""Slip, in units of the impact, up to which it keeps the direction in which it begins: its turning
meanwhile is this squared.
"""

LONGEST_ONSET = 1e-7
"""Normal impulse, in units of the impact, in which slip begins at most, where it hardly grows."""

PAST = 1e-11
"""Normal impulse by which friction's limit is passed where it is reached, so that rounding does not
tell whether it is: what is held longer than it can be is this squared.
"""

ANY_WORK = 1e6
"""Work, in units of the impact, that no impulse of restitution does."""

SMALL_SLIP = 1e-12
"""Slip, in units of the impact, at which the stiffness of a law is taken: far below slip at which a
law bends, far above where its square underflows.
"""


class Impact(NamedTuple):
    """What an impact did."""

    state: State
    """The state after: same configuration, other velocities."""
    impulse: Scalar
    """Normal impulse of the table, N s: on all surfaces that touch."""
    energy_lost: Scalar
    """Energy that the impact took, J: never negative."""
    compression: Scalar
    """Normal impulse of compression p_c, N s: of the first contact."""
    steps: int = 0
    """How many steps it took to find them, where they are integrated."""


class ImpactPhase(NamedTuple):
    """An impulse, and what ended the phase of an impact that led to it."""

    impulse: Impulse
    cause: str
    contact: int
    steps: int


def impact(
    state: State,
    restitution: float,
    top: Top,
    beside: Top | None = None,
    integrator: Integrator | None = None,
    prior: float = 0.0,
) -> Impact:
    """Return the impact of a body that touches the table.

    Parameters
    ----------
    state
        The state before, floats.
    restitution
        Poisson's coefficient e between 0 and 1: normal impulse of restitution over that of
        compression.
    top
        The body and the friction law, floats.
    beside
        The same with another surface active that touches too, and strikes as well or is closed;
        None if none is.
    integrator
        What follows the equations; None for the one that runs have unless they name another.
    prior
        Normal impulse of compression that the contact has had already, N s: it is restored, too,
        and the work of restitution is not bounded then.

    Raises
    ------
    ValueError
        If the coefficient of restitution is not between 0 and 1.
    ArithmeticError
        If it takes too many steps, or friction can neither hold slip that has ended nor let it go
        on.
    """
    if not 0.0 <= restitution <= 1.0:
        raise ValueError(
            f"the coefficient of restitution must lie between 0 and 1, but is {restitution:g}"
        )
    body = StruckBody.of(state, (top,) if beside is None else (top, beside))
    law = body.contacts.laws[0]
    if beside is None and isinstance(law, ViscousLaw) and body.contacts.resistance is None:
        return _viscous_impact(body, law, restitution, prior)
    process = ImpactProcess(body, integrator or unnamed_integrator())
    status = process.start()
    if not process.is_struck(status):
        return Impact(state, 0.0, 0.0, 0.0)
    compressed, status, steps = process.until_compressed(NO_IMPULSE, status)
    impulse, compression = compressed, compressed[FIRST]
    if restitution > 0.0 and compression > 0.0:
        if prior:
            compressed = (*compressed[:WORK], compressed[WORK] - ANY_WORK)
        part = restitution * _all_compression(body, compression, prior)
        impulse, status, further_steps = process.restored(compressed, status, part)
        steps += further_steps
    return _impact_of(body, impulse, compression, steps, process.stilled(impulse, status))


def restored_impact(
    state: State, impulse: float, top: Top, integrator: Integrator | None = None
) -> Impact:
    """Return what a normal impulse of restitution does to a body that touches the table at one
    contact; it may do more work than compression took.

    Parameters
    ----------
    state
        The state before, floats.
    impulse
        The normal impulse, N s.
    top
        The body and the friction law, floats.
    integrator
        As `impact` takes it.

    Raises
    ------
    ArithmeticError
        If it takes too many steps, or friction can neither hold slip that has ended nor let it go
        on.
    """
    body = StruckBody.of(state, (top,))
    process = ImpactProcess(body, integrator or unnamed_integrator())
    full = impulse / (body.units.mass * body.units.speed)
    total, status, steps = process.driven(full)
    return _impact_of(body, total, 0.0, steps, process.stilled(total, status))


def begins_without_approach(
    state: State, top: Top, beside: Top, integrator: Integrator | None = None
) -> bool:
    """Return whether an impact begins at a contact without normal velocity that slips, while
    another contact is closed.

    With the Delassus matrix A of both, friction included, contact 1 sinks without approach where
    A_11 < 0 and A_21 >= 0, which opens contact 2; where A_21 < 0, A_22 > 0 and A_11 A_22 < A_12
    A_21, which holds it; or where A_21 < 0, A_22 <= 0 and A_12 < 0: both sink.
    """
    process = ImpactProcess(StruckBody.of(state, (top, beside)), integrator or unnamed_integrator())
    return process.is_struck(process.start())


def _all_compression(body: StruckBody, compression: float, prior: float) -> float:
    """Return the normal impulse of compression with a prior one, N s, in units of the first."""
    return 1.0 + prior / (float(body.units.mass * body.units.speed) * compression)


def _viscous_impact(body: StruckBody, law: ViscousLaw, restitution: float, prior: float) -> Impact:
    """Return the impact with viscous friction on one contact, in closed form."""
    process = ViscousImpact.of(body, law)
    if not process.is_struck:
        return Impact(body.state, 0.0, 0.0, 0.0)
    impulse = process.compressed()
    compression = impulse[FIRST]
    if restitution > 0.0 and compression > 0.0:
        part = restitution * _all_compression(body, compression, prior)
        impulse = process.restored(impulse, part)
    return _impact_of(body, impulse, compression, 0, body.after(impulse))


def _impact_of(
    body: StruckBody, impulse: Impulse, compression: float, steps: int, state: State
) -> Impact:
    unit = body.units.mass * body.units.speed
    lost = body.energy_lost(impulse)
    return Impact(state, unit * impulse[UPWARDS], lost, unit * compression, steps)


@dataclass(frozen=True)
class ImpactProcess:
    """An impact as a process over the normal impulse, on one contact or two."""

    body: StruckBody
    integrator: Integrator

    def start(self) -> StruckStatus:
        """Return the status at the start."""
        if len(self.body.points) == 1:
            return status_at(self.body, NO_IMPULSE, ALONE)
        before, beside = self.body.before[2], self.body.normal_beside
        if beside > 0.0:
            return status_at(self.body, NO_IMPULSE, OPEN)
        ratio = beside / before if before < 0.0 and beside < 0.0 else 0.0
        return self.pressed_or_open(NO_IMPULSE, ratio, 0.0)

    def is_struck(self, status: StruckStatus) -> bool:
        """Return whether the contact point sinks into the table, or would, if the impact did not
        begin.
        """
        before = self.body.before[2]
        if before != 0.0:
            return bool(before < 0.0)
        change = changed(self.body.contacts, self.unit(NO_IMPULSE, status).total)
        return bool(change[2] < 0.0)

    def until_compressed(
        self, impulse: Impulse, status: StruckStatus, full: float = 0.0
    ) -> tuple[Impulse, StruckStatus, int]:
        """Return the impulse at which the first contact stops sinking, the status then, and how
        many steps lead to it.
        """
        return self._until(impulse, status, (COMPRESSED,), full)

    def restored(
        self, compressed: Impulse, status: StruckStatus, restitution: float
    ) -> tuple[Impulse, StruckStatus, int]:
        """Return the impulse where restitution ends, by Poisson or the energy stored, but not
        before the body has stopped; the status then, and how many steps lead to it.
        """
        compression = compressed[FIRST]
        full, steps = compression + restitution * compression, 0
        least = 0.0
        if status.ratio > 0.0:
            least = (compressed[UPWARDS] - compression) / compressed[UPWARDS]
        if status.beside != ALONE:
            status = self.after_compression(compressed, least)
        impulse, status, steps = self._until(compressed, status, (SPENT, RETURNED), full)
        if self.body.normals(impulse)[0] < -least_slip(self.body):
            status = self.next_status(impulse, status)
            impulse, status, further_steps = self.until_compressed(impulse, status, full)
            steps += further_steps
        return impulse, status, steps

    def driven(self, full: float) -> tuple[Impulse, StruckStatus, int]:
        """Return the impulse whose normal part is `full`, the status then, and how many steps lead
        to it; the work that it may do is not bounded.
        """
        return self._until((*NO_IMPULSE[:WORK], -ANY_WORK), self.start(), (SPENT,), full)

    def after_compression(self, impulse: Impulse, least: float) -> StruckStatus:
        """Return the status of two contacts where restitution begins."""
        lifted = self.body.normals(impulse)[1]
        if lifted > least_slip(self.body):
            beside = DRIVEN if least > 0.0 else OPEN
            return status_at(self.body, impulse, beside, 0.0, least)
        return self.pressed_or_open(impulse, 0.0, least)

    def pressed_or_open(self, impulse: Impulse, ratio: float, least: float) -> StruckStatus:
        """Return the status of two contacts whose normal velocities have their ratio: the second is
        pressed as far as it would sink.
        """
        pressed = status_at(self.body, impulse, PRESSED, ratio, least)
        unit = self.unit(impulse, pressed)
        if unit.coupling < 0.0 and unit.direct <= 0.0:
            return status_at(self.body, impulse, SUNK, ratio, least)
        if -unit.coupling > least * (unit.direct - unit.coupling):
            return pressed
        return status_at(self.body, impulse, DRIVEN if least > 0.0 else OPEN, ratio, least)

    def unit(self, impulse: Impulse, status: StruckStatus) -> UnitImpulse:
        """Return the impulses per unit of the normal impulse."""
        velocities = self.body.velocities(impulse)
        slips = list[Slip | None]()
        for number, slip in enumerate(slips_at(self.body, velocities)):
            begins = status.slips[number] == BEGINS
            sliding = status.directions[number] if begins else slip
            slips.append(None if status.slips[number] == HELD else sliding)
        rolling: Slip | None = velocities[3:5]
        if status.rolling != SLIDES:
            rolling = status.directions[2] if status.rolling == BEGINS else None
        return unit_impulse(
            self.body.contacts,
            status.beside,
            slips,
            rolling,
            velocities[3:],
            status.ratio,
            status.least,
        )

    def next_status(self, impulse: Impulse, status: StruckStatus) -> StruckStatus:
        """Return the status from an impulse on, where slip or friction has changed."""
        if status.beside == PRESSED:
            return self.pressed_or_open(impulse, status.ratio, status.least)
        return status_at(self.body, impulse, status.beside, status.ratio, status.least)

    def _until(
        self, impulse: Impulse, status: StruckStatus, goals: tuple[str, ...], full: float
    ) -> tuple[Impulse, StruckStatus, int]:
        """Follow the process to one of some goals, phase by phase."""
        steps = 0
        for _ in range(MOST_PHASES):
            status = self.settled(impulse, status)
            phase = self._phase(impulse, status, goals, full)
            impulse, steps = phase.impulse, steps + phase.steps
            if phase.cause in goals:
                return impulse, status, steps
            if COMPRESSED in goals and self.body.normals(impulse)[0] >= 0.0:
                return impulse, status, steps
            if steps > MOST_IMPACT_STEPS:
                break
            status = self._after(phase, status)
        raise Unsolved("an impact does not come to its end")

    def _after(self, phase: ImpactPhase, status: StruckStatus) -> StruckStatus:
        """Return the status after a phase."""
        impulse, cause, ratio, least = phase.impulse, phase.cause, status.ratio, status.least
        if cause == OPENS:
            return status_at(self.body, impulse, DRIVEN if least > 0.0 else OPEN, ratio, least)
        if cause == JAMS:
            return status_at(self.body, impulse, SUNK, ratio, least)
        if cause == CLOSES:
            return self.pressed_or_open(impulse, ratio, least)
        if cause == RETURNS:
            return self.pressed_or_open(impulse, 0.0, least)
        if cause == SETTLES:
            return status._replace(slips=tuple([HELD for _ in status.slips]))
        return self.next_status(impulse, status)

    def settled(self, impulse: Impulse, status: StruckStatus) -> StruckStatus:
        """Return the status with slip held that friction has come to hold constant."""
        contacts, numbers = self.body.contacts, acting(status.beside)
        laws = [contacts.laws[number] for number in numbers]
        if status.is_straight or not settles(laws, contacts.resistance is not None):
            return status
        unit = self.unit(impulse, status)
        if not any(any(unit.wrenches[number][:2]) for number in numbers):
            return status  # What nothing resists is held by nothing.
        if size(slip_rates(unit, numbers, contacts)) > settled_rate(self.stiffness):
            return status
        return status._replace(slips=tuple([HELD for _ in status.slips]))

    @property
    def stiffness(self) -> float:
        """Friction over slip where slip is least, under a law whose friction depends on its
        speed.
        """
        law = self.body.contacts.laws[0]
        if is_set_valued(law):
            return 0.0
        turning = self.body.before
        force, _ = law.traction((SMALL_SLIP, 0.0), (turning[3], turning[4], turning[5]))
        return max(1.0, self.body.rounding / 1e-16) * size(force) / SMALL_SLIP

    def _phase(
        self, impulse: Impulse, status: StruckStatus, goals: tuple[str, ...], full: float
    ) -> ImpactPhase:
        """Return the phase of the process in one status."""
        if status.is_straight:
            return self._straight_phase(impulse, status, goals, full, math.inf)
        if status.begins:
            return self._straight_phase(impulse, status, goals, full, self._onset(impulse, status))
        return self._curved_phase(impulse, status, goals, full)

    def _straight_phase(
        self,
        impulse: Impulse,
        status: StruckStatus,
        goals: tuple[str, ...],
        full: float,
        longest: float,
    ) -> ImpactPhase:
        """Return a phase in which the impulses grow in a straight line, by `longest` at most."""
        unit = self.unit(impulse, status)
        change = changed(self.body.contacts, unit.total)
        first, second = self.body.normals(impulse)
        first_rate, second_rate = change[2], at_second(change, self.body.contacts.apart)[2]
        ends = [(longest, "")]
        if COMPRESSED in goals:
            ends.append((_rise(first, first_rate), COMPRESSED))
        else:
            ends.append((_rise(impulse[FIRST] - full, unit.shares[0]), SPENT))
            work_rate = unit.shares[0] * first + unit.shares[1] * second
            bend = unit.shares[0] * first_rate + unit.shares[1] * second_rate
            ends.append((_return(impulse[WORK], work_rate, bend), RETURNED))
        if status.beside in (OPEN, DRIVEN):
            lifted = second - status.ratio * first
            rate = second_rate - status.ratio * first_rate
            ends.append((_rise(-lifted, -rate), CLOSES))
        if status.beside == SUNK:
            ends.append((_rise(second, second_rate), RETURNS))
        length, cause = min(ends)
        if length == math.inf:
            raise Unsolved("an impact does not come to its end")
        return ImpactPhase(self._moved(impulse, unit, length), cause, BOTH, 1)

    def _moved(self, impulse: Impulse, unit: UnitImpulse, length: float) -> Impulse:
        """Return the impulse after a straight line of so much normal impulse."""
        middle = [a + 0.5 * length * b for a, b in zip(impulse, unit.total, strict=False)]
        first, second = self.body.normals(tuple(middle))
        rates = (
            *unit.total,
            unit.shares[0],
            unit.shares[0] * first + unit.shares[1] * second,
        )
        return tuple([a + length * b for a, b in zip(impulse, rates, strict=True)])

    def _onset(self, impulse: Impulse, status: StruckStatus) -> float:
        """Return the normal impulse in which slip, or rolling, begins in the directions of a
        status.
        """
        change = changed(self.body.contacts, self.unit(impulse, status).total)
        rates = list[float]()
        for number, slip in enumerate(slips_at(self.body, change)):
            if status.slips[number] == BEGINS:
                rates.append(size(slip))
        if status.rolling == BEGINS:
            rates.append(size(change[3:5]))
        return min(LONGEST_ONSET, ONSET / max(min(rates), ONSET))

    def _curved_phase(
        self, impulse: Impulse, status: StruckStatus, goals: tuple[str, ...], full: float
    ) -> ImpactPhase:
        """Return a phase in which friction turns, as the integrator follows it."""
        slips = slips_at(self.body, self.body.velocities(impulse))
        tops: list[Any] = [
            on_branch(point.top, slip) for point, slip in zip(self.body.points, slips, strict=True)
        ]
        steps = 0
        start = 0.0, as_array(impulse)
        while True:
            laws = [top.friction for top in tops]
            form = form_of(self.body, status, COMPRESSED not in goals, laws)
            numbers = StruckNumbers(
                self.body.contacts._replace(laws=tuple(laws)),
                self.body.before,
                self.body.normal_beside,
                status.ratio,
                status.least,
                full,
                least_slip(self.body),
                self.stiffness,
            )
            for arc in self.integrator.integrate(
                impact_motion(form), numbers.parameters, start, CLOCK_END
            ):
                start, steps = (arc.solution.end, arc.end_state), steps + arc.steps
                if arc.failure is not None:
                    raise Unsolved(f"in an impact {arc.failure}")
                if arc.guard is not None or steps > MOST_IMPACT_STEPS:
                    break
            moved = tuple(start[1].tolist())
            if arc.guard is None or steps > MOST_IMPACT_STEPS:
                raise Unsolved("an impact does not come to its end")
            cause, *contact = arc.guard.split(NUMBER_SIGN)
            number = int(contact[0]) if contact else BOTH
            if cause == BRANCH and self._has_ended(moved, number):
                cause = ENDS
            if cause != BRANCH:
                return ImpactPhase(self._landed(moved, status, cause, number), cause, number, steps)
            tops[number] = on_other_branch(tops[number])

    def _has_ended(self, impulse: Impulse, number: int) -> bool:
        """Return whether slip, with what a patch drills, is too slow to be followed: a patch that
        hardly drills has a branch of its law just before its slip ends.
        """
        slip = slips_at(self.body, self.body.velocities(impulse))[number]
        return bool(size(slip) <= max(BOTH_END, least_slip(self.body)))

    def _landed(self, impulse: Impulse, status: StruckStatus, cause: str, number: int) -> Impulse:
        """Return the impulse where slip, or rolling, has ended, or what held it has given way."""
        if cause in (BEGINS_SLIP, ROLLING_BEGINS):
            return self._moved(impulse, self.unit(impulse, status), PAST)
        if cause == ENDS:
            ended = (0, 1) if number == BOTH else (number,)
            return self._ended(impulse, status, ended, is_rolling=False)
        if cause == ROLLING_ENDS:
            return self._ended(impulse, status, (), is_rolling=True)
        return impulse

    def _ended(
        self, impulse: Impulse, status: StruckStatus, ended: Sequence[int], is_rolling: bool
    ) -> Impulse:
        """Return the impulse after the one that ends what is left of the slip of some contacts, or
        of rolling, and keeps the normal velocities and what is held.
        """
        contacts, acts = self.body.contacts, acting(status.beside)
        goes_on = (1.0, 0.0, 0.0)
        slips: list[Slip | None] = [
            None if number in ended or state == HELD else goes_on
            for number, state in enumerate(status.slips)
        ]
        rolling = None if is_rolling or status.rolling == HELD else goes_on
        held = held_wrenches(contacts, acts, slips, rolling)
        stopped = [at_first(contacts, number, wrench) for number, wrench in held]
        rows = [*stopped, *[at_first(contacts, number, NORMAL) for number in acts]]
        velocities = self.body.velocities(impulse)
        # Slip that friction which depends on its speed holds keeps its speed.
        keeps = not is_set_valued(contacts.laws[0])
        right = [
            0.0 if keeps and any(wrench[:3]) else -inner(row, velocities)
            for (_, wrench), row in zip(held, stopped, strict=True)
        ]
        columns = [changed(contacts, row) for row in rows]
        matrix = [[inner(row, column) for column in columns] for row in rows]
        sizes = solve(matrix, [*right, *[0.0 for _ in acts]])
        total = impulse[:6]
        for size_of, row in zip(sizes, rows, strict=True):
            total = tuple([a + size_of * b for a, b in zip(total, row, strict=True)])
        first = sizes[len(stopped)] if 0 in acts else 0.0
        return (*total, impulse[FIRST] + first, impulse[WORK])

    def stilled(self, impulse: Impulse, status: StruckStatus) -> State:
        """Return the state after an impulse, in which slip and rolling that are held on one contact
        are exactly zero.
        """
        state, top = self.body.after(impulse), self.body.points[0].top
        if acting(status.beside) != (0,):
            return state
        velocities, least = self.body.velocities(impulse), least_slip(self.body)
        slip = slips_at(self.body, velocities)[0]
        ended = is_set_valued(top.friction) and status.slips[0] == HELD and size(slip) <= least
        stopped = top.resists_rolling and size(velocities[3:5]) <= least
        return without_velocities(self.body, state, ended, stopped)


def without_velocities(body: StruckBody, state: State, slip: bool, rolling: bool) -> State:
    """Return a state in which slip, or rolling, that has ended is exactly zero."""
    if not (slip or rolling):
        return state
    still = come_to_rest(along_table(state), body.top, slip, rolling)
    return state._replace(momentum=still.momentum, velocity=(*still.velocity, state.velocity[2]))


def _rise(value: float, rate: float) -> float:
    """Return the normal impulse after which a negative number is zero; infinity if it never is."""
    return max(0.0, -value) / rate if rate > 0.0 else math.inf


def _return(work: float, rate: float, bend: float) -> float:
    """Return the normal impulse after which negative work is zero; infinity if it never is."""
    discriminant = rate * rate - 2.0 * work * bend
    if discriminant < 0.0:
        return math.inf
    speed = rate + math.sqrt(discriminant)
    return -2.0 * work / speed if speed > 0.0 else math.inf
