"""Impact of a body that lands flat on its face.

As in every impact (see `tippetop.contact.impact`) the configuration is fixed and the normal impulse
p plays the part of time. The face is a contact with unilateral normal components (see
`tippetop.mechanics.face_motion`): the normal velocity v_n of its middle and the horizontal angular
velocity omega_h, with v_n >= a1 |omega_h| after the impact, dual to N >= 0 and a couple of at most
a1 N.

While the whole face sinks it is **pressed**: v_n and omega_h come to zero together, in proportion,

    v_n(p) = v_n (1 - p / p_c),     omega_h(p) = omega_h (1 - p / p_c),     p_c = -m v_n,

as two contacts that strike at the same instant do. The couple that this takes is that of the
pressure, and over the impulse it is how far the centre of pressure is from the middle. Slip and
drilling follow the law of the face meanwhile: they change as those of a body that slides on its
face for the time p / (m g), on a slope of the acceleration -omega_h' x a where it turns. In
restitution the same goes on to (1 + e) p_c.

Where the centre of pressure would leave the face, **the rim is struck**: at the point that sinks
fastest, or from omega_h = 0 at that over which friction tips the body. So a tall body that rocks
from one side of its rim to the other rocks on (Housner 1963, Bull. Seismol. Soc. Am. 53), and a
flat one comes to lie. What still approaches after that is struck in turn.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar, NamedTuple, Self

from tippetop.contact.collision import SLOWEST_REBOUND
from tippetop.contact.face_mode import TIPPING, FaceMode, PressedAtRim, mode_at_rim
from tippetop.contact.impact import Impact, impact, restored_impact
from tippetop.contact.mode import FAILURE
from tippetop.integrators.unnamed import unnamed_integrator
from tippetop.mechanics.contacts.forces import is_set_valued
from tippetop.mechanics.face_motion import (
    LEAN,
    FaceForces,
    can_hold,
    face_gap_rate,
    face_gap_rate_behind,
    face_speed,
    forces_on_face,
    leaning,
    leaning_direction,
    onto_face,
    pressure_reserve,
    rim_speed,
    sliding_on_face,
    slip_of_face,
    tipping_direction,
    turning_of_face,
)
from tippetop.mechanics.impacts.struck_body import FUZZ
from tippetop.mechanics.invariants import energy
from tippetop.mechanics.state import SlidingState, State
from tippetop.mechanics.surfaces.surface import support_at
from tippetop.mechanics.top import Kind, Top
from tippetop.mechanics.unsolved import Unsolved
from tippetop.mechanics.vectors import Horizontal, Row, Scalar, Vector

SLOWEST_ON_FACE = 1e-10
"""Velocity, in natural units, or in an impact relative to its approach, with which slip on a face
begins: its energy is below rounding.
"""

MOST_STRIKES = 200
"""Strikes of the rim in one impact, after which a run is given up."""

MOST_MODES = 200
"""Modes of a pressed face in one impact, after which a run is given up."""

NOT_TIPPED = (
    "friction has moved the pressure to a point of the rim at which slip only begins, and the slope"
    " of the table, or a torque of the air about the axis, makes that slip faster: it is not known"
    " how the body tips there; it goes on with table.slope = 0 and, in air, with air.axial_linear ="
    " 0 and air.axial_quadratic = 0"
)
"""Detail of the status where it is not known how a body goes on upon the rim of its face."""


class FaceImpact(NamedTuple):
    """What an impact of a face did."""

    state: State
    """The state after: axis vertical, other velocities."""
    impulse: float
    """Normal impulse of the table, N s."""
    energy_lost: float
    """Energy that the impact took, and a tilt that was left, J."""
    steps: int
    """How many steps it took to find them."""
    rebounds: bool
    """Whether the body leaves the table after it."""


class PressedFace(NamedTuple):
    """What the part of an impact did in which a face is pressed."""

    state: State
    elapsed: float
    compression: float
    """Normal impulse, and that of compression, over the weight."""
    steps: int
    tips: bool
    """Whether the centre of pressure has come to the rim."""


@dataclass(frozen=True)
class StruckFace(FaceMode):
    """A face that is pressed onto the table, while the body's horizontal angular velocity ends.

    Its velocity is the slip of the middle of the face.
    """

    turning: tuple[Scalar, ...] = (0.0, 0.0)
    """Rate of the horizontal angular velocity."""

    further: ClassVar[int] = 2

    @property
    def parameters(self) -> tuple[Scalar, ...]:
        """The numbers of the top, and the rate of the horizontal angular velocity."""
        return (*self.top.numbers, *self.turning)

    def without_tops(self) -> Self:
        """Return the mode without its parameters."""
        return replace(super().without_tops(), turning=(0.0, 0.0))

    def with_numbers(self, kind: Kind, numbers: Sequence[Scalar]) -> Self:
        """Return the mode of tops of a kind whose parameters are these numbers."""
        turning = (numbers[kind.numbers], numbers[kind.numbers + 1])
        return replace(super().with_numbers(kind, numbers), turning=turning)

    def carried(self, axis: Vector) -> Horizontal:
        """Rate at which the turning of the body changes the slip of the middle of its face."""
        height = support_at(axis, self.top.surface)[0]
        return (-height * self.turning[1], height * self.turning[0])

    def forces(self, y: Row) -> FaceForces:
        """Return what the table does: the couple of the pressure turns the body, too."""
        axis, momentum, velocity = SlidingState.unpack(y)
        if self.slips:
            forces = sliding_on_face(axis, momentum, velocity, self.law_type, self.top)
        else:
            u, v = self.carried(axis)
            held, normal = (
                (-self.top.mass * u, -self.top.mass * v),
                self.top.mass * self.top.gravity,
            )
            forces = forces_on_face(axis, held, normal, 0.0, self.top)
        inertia, (along, across) = self.top.transverse_inertia, forces.couple
        couple = (along + inertia * self.turning[0], across + inertia * self.turning[1])
        return forces._replace(couple=couple)

    def rates(self, y: Row) -> tuple[Scalar, ...]:
        """Rates of axis, angular momentum and slip."""
        forces, (u, v) = self.forces(y), self.carried(SlidingState.unpack(y).axis)
        east, north = forces.force[0] / self.top.mass + u, forces.force[1] / self.top.mass + v
        return (0.0, 0.0, 0.0, 0.0, 0.0, forces.torque, east, north)


@dataclass(frozen=True)
class FaceStrike:
    """The process of an impact of a body on its face, in natural units."""

    top: Top
    """The body, whose active surface is the edge of the face."""
    law_type: Any
    """The class of the law of the face."""

    def struck(self, state: State, restitution: float) -> FaceImpact:
        """Return what the impact does from a state with vertical axis."""
        before, impulse, steps = state, 0.0, 0
        fuzz, weight = FUZZ * self._speed(state), self.top.mass * self.top.gravity
        for _ in range(MOST_STRIKES):
            if face_gap_rate(state, self.top) >= -fuzz:
                lost = float(energy(before, self.top) - energy(state, self.top))
                return FaceImpact(state, impulse, max(0.0, lost), steps, rebounds=False)
            pressed = PressedFace(state, 0.0, math.inf, 0, tips=True)
            if state.velocity[2] < -fuzz and face_gap_rate_behind(state, self.top) <= fuzz:
                pressed = self.pressed(state, restitution)
            state = pressed.state
            impulse, steps = impulse + weight * pressed.elapsed, steps + pressed.steps
            if pressed.tips:
                struck = self.at_rim(pressed, restitution, float(energy(before, self.top)))
                state, steps = struck.state, steps + struck.steps
                impulse += float(struck.impulse)
        raise Unsolved("its face and its rim strike in turns for ever")

    def pressed(self, state: State, restitution: float) -> PressedFace:
        """Return what follows while the face is pressed: the whole impact, where the centre of
        pressure stays on it.
        """
        top, sinking = self.top, state.velocity[2]
        compression = -sinking / top.gravity
        span, turning = (1.0 + restitution) * compression, turning_of_face(state.momentum, top)
        mode = self._mode((-turning[0] / compression, -turning[1] / compression))
        slip = slip_of_face(state, top)
        moving = only_slipping(state, slip, state.momentum[2])
        elapsed, steps, tips = 0.0, 0, False
        for _ in range(MOST_MODES):
            if elapsed >= span or tips:
                part = 1.0 - elapsed / compression if tips else -restitution
                after = self._with_turning(state, moving, part)
                return PressedFace(after, elapsed, compression, steps, tips)
            if is_set_valued(top.friction) and self._rests(moving, -sinking):
                moving = only_slipping(state, (0.0, 0.0), 0.0)
                held = replace(mode, slips=False).forces(mode.numbers(moving))
                x, y, _ = held.force
                if can_hold(held.force, top):
                    tips = bool(pressure_reserve(held, top) <= 0.0)
                    elapsed = elapsed if tips else span
                    continue
                factor = SLOWEST_ON_FACE * sinking * (x * x + y * y) ** -0.5
                moving = only_slipping(state, (factor * x, factor * y), 0.0)
            at_rim = isinstance(mode, PressedAtRim)
            if not at_rim and mode.tipping(mode.numbers(moving)) <= 0.0:
                tips, mode = self._struck_or_goes_on(mode, moving)
                continue
            for segment in mode.segments(elapsed, moving, span, unnamed_integrator()):
                elapsed, moving, steps = segment.end_time, segment.end_state, steps + segment.steps
                if segment.mode_end is not None and segment.mode_end.cause == FAILURE:
                    raise Unsolved(f"in an impact of a face {segment.mode_end.detail}")
                if segment.mode_end is not None and segment.mode_end.cause == TIPPING:
                    tips, mode = self._struck_or_goes_on(mode, moving)
        raise Unsolved(
            "in an impact of a face the pressure comes to the rim and leaves it for ever"
        )

    def at_rim(self, pressed: PressedFace, restitution: float, most: float) -> Impact:
        """Return what an impulse at the rim does after one that has pressed the face.

        The impulse of restitution is that of all compression; there is none that would leave the
        body more than the energy `most`.
        """
        state, weight = pressed.state, self.top.mass * self.top.gravity
        tilted = leaning(state, self._lean(state), LEAN)
        prior = weight * pressed.elapsed
        if pressed.elapsed >= pressed.compression:
            lasts = (1.0 + restitution) * weight * pressed.compression - prior
            restored = restored_impact(tilted, lasts, self.top)
            unrestored = Impact(tilted, 0.0, 0.0, 0.0)
        elif prior == 0.0 or restitution == 0.0:
            return upright(impact(tilted, restitution, self.top))
        else:
            restored = impact(tilted, restitution, self.top, prior=prior)
            unrestored = impact(tilted, 0.0, self.top)
        gains = energy(upright(restored).state, self.top) > most
        return upright(unrestored if gains else restored)

    def _lean(self, state: State) -> Horizontal:
        """Return the direction into which the axis leans over the point of the rim that is struck:
        that which sinks fastest, or that over which friction tips the body.
        """
        if rim_speed(state.momentum, self.top) > FUZZ * self._speed(state):
            return leaning_direction(state, self.top)
        lean = tipping_direction(state, self.top)
        if lean is None:
            raise Unsolved(NOT_TIPPED)
        return lean

    def _struck_or_goes_on(self, mode: FaceMode, moving: State) -> tuple[bool, FaceMode]:
        """Return whether the rim is struck where the pressure has come to it, and the mode of the
        face from there on: the same one if the rim is struck, else that in which the pressure stays
        at the rim, as friction there could not tip the body.
        """
        if isinstance(mode, StruckFace):
            return True, mode
        following = mode_at_rim(mode, moving)
        return following is None, mode if following is None else following

    def _mode(self, turning: Horizontal) -> FaceMode:
        """Return the mode in which the face slips meanwhile, of which a body that does not turn has
        that of a face on a table.
        """
        if turning == (0.0, 0.0):
            return FaceMode(self.top, self.law_type)
        return StruckFace(self.top, self.law_type, turning=turning)

    def _rests(self, moving: State, approach: float) -> bool:
        """Return whether slip and drilling are rounding."""
        speed = face_speed(moving.velocity[:2], moving.momentum, self.top)
        return bool(speed <= FUZZ * (approach + 1.0))

    def _with_turning(self, before: State, moving: State, part: float) -> State:
        """Return the state in which the face slips as in another one, and of the normal velocity
        and the turning before a part is left.
        """
        inertia, height = self.top.transverse_inertia, before.height
        x, y = turning_of_face(before.momentum, self.top)
        x, y, (u, v) = part * x, part * y, moving.velocity[:2]
        velocity = (u + height * y, v - height * x, part * before.velocity[2])
        momentum = (inertia * x, inertia * y, moving.momentum[2])
        return before._replace(momentum=momentum, velocity=velocity)

    def _speed(self, state: State) -> float:
        """Return the size of the velocities of the face."""
        slip, sinking = slip_of_face(state, self.top), abs(float(state.velocity[2]))
        turning = float(rim_speed(state.momentum, self.top))
        return float(face_speed(slip, state.momentum, self.top)) + sinking + turning


def face_impact(state: State, restitution: float, top: Top, law_type: Any) -> FaceImpact:
    """Return what an impact does to a body that lands flat on its face; one that would hardly
    rebound has no restitution.

    Parameters
    ----------
    state
        The state before, in natural units, floats; its tilt is nearly zero.
    restitution
        Poisson's coefficient e between 0 and 1.
    top
        The body, whose active surface is the edge of the face.
    law_type
        The class of the face's law (see `tippetop.mechanics.face_motion.law_of_face`).

    Raises
    ------
    ArithmeticError
        If the impact cannot be followed, or friction moves the pressure to the rim and nothing tips
        the body.
    """
    body = top.body._replace(field=None)
    process, flat = FaceStrike(top._replace(body=body), law_type), onto_face(state, top)
    struck = process.struck(flat, restitution)
    rebounds = bool(face_gap_rate(struck.state, top) > SLOWEST_REBOUND)
    if restitution and not rebounds:
        steps = struck.steps
        struck = process.struck(flat, 0.0)
        struck = struck._replace(steps=steps + struck.steps)
        rebounds = bool(face_gap_rate(struck.state, top) > SLOWEST_REBOUND)
    lost = float(energy(state, top) - energy(flat, top)) + struck.energy_lost
    return struck._replace(energy_lost=lost, rebounds=rebounds)


def only_slipping(state: State, velocity: Horizontal, momentum: Scalar) -> State:
    """Return a state with this horizontal velocity and angular momentum about the vertical, and
    without normal velocity and tilting.
    """
    return state._replace(momentum=(0.0, 0.0, momentum), velocity=(*velocity, 0.0))


def upright(struck: Impact) -> Impact:
    """Return an impact with the axis vertical again."""
    state = struck.state
    axis = (0.0, 0.0, 1.0 if state.axis[2] > 0.0 else -1.0)
    return struck._replace(state=state._replace(axis=axis))
