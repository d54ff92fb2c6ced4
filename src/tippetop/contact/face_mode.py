"""The mode of a body that lies on a flat face: it slides and drills there, or rests."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, ClassVar, Self

from tippetop.contact.mode import (
    COMPLETED,
    FAILURE,
    IntegratedMode,
    ModeEnd,
    Reaction,
    Segment,
    numbered,
)
from tippetop.contact.transient import straight
from tippetop.integrators.base import Arc, Guard, Integrator, Motion
from tippetop.integrators.dense import as_array
from tippetop.mechanics.contacts.forces import is_set_valued
from tippetop.mechanics.face_motion import (
    FaceForces,
    PressureSplit,
    drilling_rate,
    face_field,
    face_radii,
    face_speed,
    held_at_rim,
    lying_flat,
    outward_square,
    pressure_reserve,
    resting_on_face,
    rim_reserve,
    sliding_on_face,
    slip_that_tips,
    tipping_direction,
)
from tippetop.mechanics.state import SlidingState, State
from tippetop.mechanics.surfaces.surface import support_at
from tippetop.mechanics.top import Kind
from tippetop.mechanics.vectors import Row, Scalar

TIPPING = "tipping"
"""Guard: the centre of pressure reaches the rim of the face."""

STOPPED = "stopped"
"""Cause of the end of the mode: slip and drilling have ended, together."""

SLOWED = "slowed"
"""Guard that ends a stage of the motion, which goes on in smaller units."""

STAGE = 1e-3
"""Speed at the end of a stage, over that at its start. Near its end the motion keeps its form if
velocities and times shrink alike. Steps are as accurate as their first speed: over a much longer
stage the ratio of slip and drilling would lose digits; a much shorter one costs steps.
"""

AT_LIMIT = 1e-10
"""Part of its terms by which a reserve of the rim may differ from zero by rounding where the
outward slip has come to that at which a body tips: the slip is a difference of squares. Far above
it slip that has not come there yet would count as come; below it a guard that has just fallen
through zero would fall again.
"""

LEAST_TIME = 1e-12
"""Time that slip and drilling have left at which they are followed no further, in natural units, or
of the time of the run: they fall in a straight line, and the place is known to its square. Steps
need more digits of the time than there are below it.
"""


@dataclass(frozen=True)
class FaceMode(IntegratedMode):
    """The body lies on the face that its active surface bounds, with its axis vertical."""

    law_type: Any = None
    """The class of the law of the face (see `tippetop.mechanics.face_motion.law_of_face`)."""
    slips: bool = True
    """Whether the face slips or drills; else friction holds it."""

    name: ClassVar[str] = "face"
    further: ClassVar[int] = 0
    """How many parameters it has beside the numbers of the top."""

    @property
    def status(self) -> str:
        """Name of the motion in a result, without the surface that touches."""
        return "sliding_flat" if self.slips else "resting_flat"

    @property
    def reading_key(self) -> tuple[Any, ...]:
        """Modes of the same key and tops read the same from their numbers."""
        return (self.form, self.law_type)

    @property
    def lasting(self) -> bool:
        """Whether runs may spend most of their steps in it."""
        return self.slips

    @property
    def torque_free(self) -> bool:
        """Whether nothing but the contact force takes energy: a face resists drilling."""
        return False

    @property
    def motion(self) -> Motion:
        """Equations of motion and guards, in units of velocity and time that are a parameter."""
        return face_motion(self.without_tops(), self.top.kind)

    def with_numbers(self, kind: Kind, numbers: Sequence[Scalar]) -> Self:
        """Return the mode of tops of a kind whose parameters are these numbers."""
        return self.on_tops((kind.top(tuple(numbers[: kind.numbers])),))

    def numbers(self, state: State) -> tuple[Scalar, ...]:
        """Return axis, angular momentum and velocity."""
        return SlidingState(state.axis, state.momentum, state.velocity[:2]).pack()

    def state(self, y: Row) -> State:
        """Return the state, whose height is that of the face."""
        axis, momentum, velocity = SlidingState.unpack(y)
        return State(axis, momentum, (*velocity, 0.0), support_at(axis, self.top.surface)[0])

    def forces(self, y: Row) -> FaceForces:
        """Return what the table does."""
        axis, momentum, velocity = SlidingState.unpack(y)
        if not self.slips:
            return resting_on_face(axis, self.top)
        return sliding_on_face(axis, momentum, velocity, self.law_type, self.top)

    def tipping(self, y: Row) -> Scalar:
        """Return what falls through zero where the face holds the body no longer."""
        return pressure_reserve(self.forces(y), self.top)

    def rates(self, y: Row) -> tuple[Scalar, ...]:
        """Rates of axis, angular momentum and velocity."""
        forces, (axis, momentum, velocity) = self.forces(y), SlidingState.unpack(y)
        outer = face_field(axis, momentum, velocity, self.top)
        east = (forces.force[0] + outer.force[0]) / self.top.mass
        north = (forces.force[1] + outer.force[1]) / self.top.mass
        return (0.0, 0.0, 0.0, 0.0, 0.0, forces.torque + outer.couple[2], east, north)

    def reaction(self, y: Row) -> Reaction:
        """Return the contact force, and the torque about the middle of the face."""
        forces, now = self.forces(y), SlidingState.unpack(y)
        (u, v), (p, q, _) = now.velocity, forces.force
        power = p * u + q * v + forces.torque * drilling_rate(now.momentum, self.top)
        torque, couple = (*forces.couple, forces.torque), (0.0, 0.0, forces.torque)
        reserve = pressure_reserve(forces, self.top)
        return Reaction(forces.force, torque, power, couple, reserve=reserve)

    def segments(
        self, time: float, state: State, end: float, integrator: Integrator
    ) -> Iterator[Segment]:
        """Integrate the equations of motion, in stages where slip and drilling end.

        In each the unit of velocity and time is the speed at its start, so that steps are as
        accurate relatively.
        """
        goes_on = True
        while goes_on:
            goes_on, unit = False, 1.0
            if is_set_valued(self.top.friction):
                unit, remaining = self._speed(state), self._time_left(state)
                if remaining <= min(LEAST_TIME * max(1.0, time), end - time):
                    yield self._last_moment(time, state, remaining)
                    return
            begin = 0.0, as_array(in_units(self.numbers(state), unit))
            longest, parameters = (end - time) / unit, (*self.parameters, unit)
            for arc in integrator.integrate(self.motion, parameters, begin, longest):
                segment = self._stage(arc, (time, unit), longest, end)
                yield segment
                if arc.guard == SLOWED:
                    time, state, goes_on = segment.end_time, segment.end_state, True

    def _speed(self, state: State) -> float:
        return float(face_speed(state.velocity[:2], state.momentum, self.top))

    def _time_left(self, state: State) -> float:
        """Return the time that slip and drilling have left at the present rate of their speed;
        infinity where it grows.
        """
        rates = SlidingState.unpack(self.rates(self.numbers(state)))
        (u, v), (p, q) = state.velocity[:2], rates.velocity
        outer = face_radii(self.top.surface)[1]
        turning = drilling_rate(state.momentum, self.top) * drilling_rate(rates.momentum, self.top)
        slowing = -float(u * p + v * q + outer * outer * turning)
        return self._speed(state) ** 2 / slowing if slowing > 0.0 else math.inf

    def _stage(self, arc: Arc, start: tuple[float, float], longest: float, end: float) -> Segment:
        """Return an arc of a stage that has begun at some time, in some unit."""
        time, unit = start
        at_end = arc.solution.end >= longest
        until = end if at_end else time + unit * arc.solution.end
        units = in_units([1.0] * len(arc.end_state), 1.0 / unit)
        solution = arc.solution.in_units(time, unit, units, until)
        last = self.state(list(in_units(arc.end_state.tolist(), 1.0 / unit)))
        how = None
        if arc.failure is not None:
            how = ModeEnd(FAILURE, last, detail=arc.failure)
        elif arc.guard is not None and arc.guard != SLOWED:
            how = self.end_by_guard(arc.guard, last)
        elif at_end:
            how = ModeEnd(COMPLETED, last)
        return Segment(self, solution, last, how, arc.steps, arc.evaluations, method=arc.method)

    def _last_moment(self, time: float, state: State, remaining: float) -> Segment:
        """Return the last moment, in which slip and drilling fall to zero in a straight line."""
        ended = lying_flat(state, self.top)._replace(
            momentum=(0.0, 0.0, 0.0), velocity=(0.0, 0.0, 0.0)
        )
        solution = straight(self.numbers(state), self.numbers(ended), time, time + remaining)
        return Segment(self, solution, ended, ModeEnd(STOPPED, ended))


@dataclass(frozen=True)
class PressedAtRim(FaceMode):
    """A face that slides where its friction has moved the pressure to the rim, but no friction at
    the rim could tip the body over it.

    The centre of pressure is taken to stay at the rim, and friction to be that of the whole face,
    which it overstates.
    """

    slip: Scalar = 1.0
    """The outward slip of a point of the rim at which the body would tip (`slip_that_tips`), m/s.

    It is found once, with the drilling at which the mode begins: a law that depends on the angular
    velocity is not asked again while drilling changes.
    """

    further: ClassVar[int] = 1

    @classmethod
    def of(cls, mode: FaceMode, state: State) -> "PressedAtRim":
        """Return the mode that follows a face that slides, in a state."""
        speed = face_speed(state.velocity[:2], state.momentum, mode.top)
        drilling = float(drilling_rate(state.momentum, mode.top))
        slip = slip_that_tips(state.axis, drilling, float(speed), mode.top)
        return cls(mode.top, mode.law_type, slip=slip)

    @property
    def form(self) -> str:
        """Name of the equations of motion."""
        return f"{self.status} at rim"

    @property
    def reading_key(self) -> tuple[Any, ...]:
        """Modes of the same key and tops read the same from their numbers."""
        return (self.form, self.law_type, self.slip)

    @property
    def parameters(self) -> tuple[Scalar, ...]:
        """The numbers of the top, and the slip."""
        return (*self.top.numbers, self.slip)

    def without_tops(self) -> Self:
        """Return the mode without its parameters."""
        return replace(super().without_tops(), slip=1.0)

    def with_numbers(self, kind: Kind, numbers: Sequence[Scalar]) -> Self:
        """Return the mode of tops of a kind whose parameters are these numbers."""
        return replace(super().with_numbers(kind, numbers), slip=numbers[kind.numbers])

    def tipping(self, y: Row) -> Scalar:
        """Return what falls through zero where friction at the rim could tip the body."""
        return rim_reserve(SlidingState.unpack(y), self.slip, self.top)

    def reaction(self, y: Row) -> Reaction:
        """Return the contact force and torque; the friction of the whole face needs more couple
        than there is.
        """
        return super().reaction(y)._replace(reserve=None)


@dataclass(frozen=True)
class HeldAtRim(PressedAtRim):
    """A body on its face that keeps the outward slip of a point of its rim at which friction there
    could just tip it (see `tippetop.mechanics.face_motion.held_at_rim`).

    Under dry friction that point rests, and the body rolls on its rim with its axis vertical,
    without loss: the limit of rolling on the rim at a small tilt. The slip is that with which the
    mode begins: a law that depends on the angular velocity is not asked again.
    """

    @property
    def status(self) -> str:
        """Name of the motion in a result, without the surface that touches."""
        return "rolling_flat"

    def split(self, y: Row) -> PressureSplit:
        """Return how the pressure is shared."""
        return held_at_rim(SlidingState.unpack(y), self.slip, self.law_type, self.top)

    def forces(self, y: Row) -> FaceForces:
        """Return what the table does."""
        return self.split(y).forces

    def tipping(self, y: Row) -> Scalar:
        """Return what falls through zero where friction of the face makes the slip no faster."""
        return self.split(y).on_face

    def holding(self, y: Row) -> Scalar:
        """Return what falls through zero where the pressure at the point makes the slip faster."""
        return -self.split(y).at_point


def mode_at_rim(mode: FaceMode, state: State) -> FaceMode | None:
    """Return the mode of a body that stays on its face where friction has moved the pressure to the
    rim; None if it tips over its rim, or it is not known that it stays.

    From a slip at which friction at the rim could just tip it, a body tips only if that friction
    makes the slip faster.
    """
    at_rim, y, top = PressedAtRim.of(mode, state), mode.numbers(state), mode.top
    speed, is_dry = face_speed(state.velocity[:2], state.momentum, top), is_set_valued(top.friction)
    terms = speed * speed if is_dry else face_radii(top.surface)[1]
    if at_rim.tipping(y) > AT_LIMIT * terms:
        return at_rim
    if not isinstance(mode, PressedAtRim) and tipping_direction(state, top) is not None:
        return None
    outward = max(0.0, float(outward_square(SlidingState.unpack(y), top)))
    held = HeldAtRim(top, mode.law_type, slip=0.0 if is_dry else outward**0.5)
    split = held.split(y)
    if split.on_face <= AT_LIMIT * split.terms:
        return at_rim
    return held if split.at_point <= 0.0 else None


def in_units(numbers: Sequence[Scalar], unit: Scalar) -> tuple[Scalar, ...]:
    """Return the numbers of a face's motion in a unit of velocity and time, with lengths as they
    are.
    """
    return tuple([each if number < 3 else each / unit for number, each in enumerate(numbers)])


@lru_cache
def face_motion(form: Any, kind: Kind) -> Motion:
    """Return the equations of motion of a mode without tops, for tops of a kind.

    The last parameter is the unit of velocity and time. Rates of velocities have no unit then.
    """
    count = kind.numbers + form.further

    def mode(numbers: Sequence[Scalar]) -> Any:
        return form.with_numbers(kind, numbers)

    def in_natural_units(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> Row:
        unit = numbers[count]
        return tuple([each if number < 3 else unit * each for number, each in enumerate(y)])

    def rates(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> tuple[Scalar, ...]:
        values: tuple[Scalar, ...] = mode(numbers).rates(in_natural_units(y, numbers))
        return values

    def tipping(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> Scalar:
        reserve: Scalar = mode(numbers).tipping(in_natural_units(y, numbers))
        return reserve

    def slowed(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> Scalar:
        state = SlidingState.unpack(y)
        return face_speed(state.velocity, state.momentum, mode(numbers).top) - STAGE

    def holding(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> Scalar:
        rate: Scalar = mode(numbers).holding(in_natural_units(y, numbers))
        return rate

    guards = [Guard(TIPPING, tipping)]
    if isinstance(form, HeldAtRim):
        guards.append(Guard(numbered(TIPPING, 0), holding))
    if is_set_valued(kind.example.friction):
        guards.append(Guard(SLOWED, slowed))
    size = len(SlidingState((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0)).pack())
    return Motion(rates, size, count + 1, tuple(guards), form.lasting)
