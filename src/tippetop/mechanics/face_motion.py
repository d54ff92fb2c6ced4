"""Motion of a body that lies on a flat face, which slips and drills.

The axis stays vertical. The face is a contact at its middle with unilateral normal components: the
normal velocity v_n and the horizontal angular velocity omega_h, with v_n >= a1 |omega_h| for the
outer radius a1. Dual to them are the normal force N >= 0 and a horizontal couple of at most a1 N.
The couple is pressure, no friction: it is held, dissipates nothing, and over N it is how far the
centre of pressure has moved from the middle. Where that would leave the face, the body tips over
its rim.
"""

from typing import Any, NamedTuple

from tippetop.mechanics.contacts.forces import is_set_valued
from tippetop.mechanics.field import OuterForces
from tippetop.mechanics.laws.face_friction import face_law_type
from tippetop.mechanics.motion import angular_velocity, outer_forces_in
from tippetop.mechanics.state import SlidingState, State
from tippetop.mechanics.surfaces.hull import Hull, acting
from tippetop.mechanics.surfaces.surface import Surface, support_at
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Horizontal, Scalar, Vector

AT_RIM = 1e-12
"""Part of its radius by which the centre of pressure may be within the rim, by rounding, where its
guard says that it has come there. Or part of its squared slip that may be left by rounding at a
point of the rim that rests.
"""

SLIPS_TRIED, BISECTIONS = 40, 60
"""How often the slips at which a law is asked whether its force tips a body are halved from the
fastest: more slowly nothing tips. And how often the interval is halved in which it begins to.
"""


LEAN = 1e-60
"""Sine of the tilt that gives the rim its point that is struck: its square is far above that at
which the contact point is undefined, and far below rounding.
"""

BARELY_TILTED = 1e-8
"""Sine of the tilt at which the rates are those at first, to as much: at `LEAN` their terms with
its inverse, which cancel, would leave no digits.
"""


class FaceForces(NamedTuple):
    """What the table does to a body on its face."""

    force: Vector
    """Contact force, N."""
    couple: Horizontal
    """Horizontal couple of the pressure about the middle of the face, N m."""
    torque: Scalar
    """Torque of drilling friction about the vertical, N m."""


def face_radii(surface: Surface) -> tuple[Scalar, Scalar]:
    """Return the inner and outer radius of the face that the active surface, an edge, bounds, m."""
    edge: Any = acting(surface)
    size = surface.sizes[surface.active] if isinstance(surface, Hull) else 1.0
    return size * edge.inner_radius, size * edge.radius


def law_of_face(top: Top, pressure: str) -> Any:
    """Return the class of the friction law of a body's face (see `face_law_type`); of floats."""
    return face_law_type(top.friction, face_radii(top.surface)[0], pressure)


def drilling_rate(momentum: Vector, top: Top) -> Scalar:
    """Angular velocity about the vertical of a body whose axis is vertical, rad/s."""
    return momentum[2] / top.axial_inertia


def turning_of_face(momentum: Vector, top: Top) -> Horizontal:
    """Horizontal angular velocity of a body whose axis is vertical, rad/s."""
    return (momentum[0] / top.transverse_inertia, momentum[1] / top.transverse_inertia)


def rim_speed(momentum: Vector, top: Top) -> Scalar:
    """Return a1 |omega_h|, m/s: how much faster than the middle that point of the rim sinks which
    sinks fastest.
    """
    x, y = turning_of_face(momentum, top)
    return face_radii(top.surface)[1] * (x * x + y * y) ** 0.5


def face_gap_rate(state: State, top: Top) -> Scalar:
    """Return v_n - a1 |omega_h|, the normal velocity of that point of the face which sinks fastest,
    m/s; the axis is vertical.
    """
    return state.velocity[2] - rim_speed(state.momentum, top)


def face_gap_rate_behind(state: State, top: Top) -> Scalar:
    """Return v_n + a1 |omega_h|, the normal velocity of that point of the face which sinks least,
    m/s; the axis is vertical.
    """
    return state.velocity[2] + rim_speed(state.momentum, top)


def sinking_rim(turning: Horizontal) -> Horizontal:
    """Return the direction of that point of the rim which sinks fastest, of floats."""
    x, y = turning
    size = (x * x + y * y) ** 0.5
    return (y / size, -x / size)


def slip_of_face(state: State, top: Top) -> Horizontal:
    """Return the slip velocity of the middle of the face, m/s; the axis is vertical."""
    (x, y), (u, v) = turning_of_face(state.momentum, top), state.velocity[:2]
    height = support_at(state.axis, top.surface)[0]
    return (u - height * y, v + height * x)


def face_speed(velocity: Horizontal, momentum: Vector, top: Top) -> Scalar:
    """Return sqrt(v^2 + (a1 w)^2), m/s: zero where neither slip nor drilling goes on."""
    drilled = face_radii(top.surface)[1] * drilling_rate(momentum, top)
    return (velocity[0] * velocity[0] + velocity[1] * velocity[1] + drilled * drilled) ** 0.5


def lying_flat(state: State, top: Top) -> State:
    """Return the state on the face: axis vertical, tilting and normal velocity ended, floats.

    The slip of the face is that of its middle before: what stuck sticks.
    """
    flat = onto_face(state, top)
    momentum, (u, v) = (0.0, 0.0, flat.momentum[2]), slip_of_face(flat, top)
    return flat._replace(momentum=momentum, velocity=(u, v, 0.0))


def onto_face(state: State, top: Top) -> State:
    """Return the state of a body that comes to its face: axis vertical, with the horizontal angular
    velocity and the angular momentum about the vertical that it has, floats.
    """
    axis = (0.0, 0.0, 1.0 if state.axis[2] > 0.0 else -1.0)
    x, y, _ = angular_velocity(state.axis, state.momentum, top)
    inertia = top.transverse_inertia
    momentum = (inertia * x, inertia * y, state.momentum[2])
    return State(axis, momentum, state.velocity, support_at(axis, top.surface)[0])


def resting_on_face(axis: Vector, top: Top) -> FaceForces:
    """Return the forces on a body at rest on its face: they hold it against the outer field."""
    outer = face_field(axis, (0.0, 0.0, 0.0), (0.0, 0.0), top)
    x, y = -outer.force[0], -outer.force[1]
    return forces_on_face(axis, (x, y), top.mass * top.gravity, 0.0, top)


def is_held_on_face(axis: Vector, top: Top) -> bool:
    """Return whether dry friction holds a body at rest on its face, of floats."""
    return can_hold(resting_on_face(axis, top).force, top)


def can_hold(force: Vector, top: Top) -> bool:
    """Return whether dry friction can exert a force on a face that does not drill, of floats."""
    x, y, normal = force
    friction: Any = top.friction
    return bool(friction.reserve(normal, (x, y), 0.0) >= 0.0)


def face_field(axis: Vector, momentum: Vector, velocity: Horizontal, top: Top) -> OuterForces:
    """Return what the outer field does to a body on its face."""
    outer = outer_forces_in(axis, momentum, (velocity[0], velocity[1], 0.0), top)
    return OuterForces((0.0, 0.0, 0.0), (0.0, 0.0, 0.0)) if outer is None else outer


def forces_on_face(
    axis: Vector, friction: Horizontal, normal: Scalar, torque: Scalar, top: Top
) -> FaceForces:
    """Return the forces with the couple of the pressure that balances the moment of friction."""
    (x, y), height = friction, support_at(axis, top.surface)[0]
    return FaceForces((x, y, normal), (-height * y, height * x), torque)


def sliding_on_face(
    axis: Vector, momentum: Vector, velocity: Horizontal, law_type: Any, top: Top
) -> FaceForces:
    """Return the forces on a body that slips, or drills, on its face.

    Friction acts at the depth h below the centre of mass, and the couple of the pressure balances
    its moment about that.

    Parameters
    ----------
    axis, momentum, velocity
        Axis, along or against the vertical, angular momentum (kg m^2/s) and horizontal velocity of
        the centre of mass (m/s).
    law_type
        The class of the face's law, of `law_of_face`.
    top
        The body; its active surface is an edge.
    """
    inner, outer = face_radii(top.surface)
    law = law_type.of(top.friction, inner, outer)
    normal = top.mass * top.gravity
    traction = law.traction(velocity, drilling_rate(momentum, top))
    friction = normal * traction.force[0], normal * traction.force[1]
    return forces_on_face(axis, friction, normal, normal * traction.torque, top)


def leaning(state: State, direction: Horizontal, sine: float) -> State:
    """Return the state of a body on its face with its axis leaning into a direction, by the sine of
    a tilt so small that nothing else changes: a point of the rim touches, not the face.
    """
    return state._replace(axis=(sine * direction[0], sine * direction[1], state.axis[2]))


def leaning_direction(state: State, top: Top) -> Horizontal:
    """Return the direction into which the axis of a body on its face begins to lean, of floats."""
    x, y = sinking_rim(turning_of_face(state.momentum, top))
    up = 1.0 if state.axis[2] > 0.0 else -1.0
    return (up * x, up * y)


def direction_against(x: float, y: float, up: float) -> Horizontal:
    """Return the direction into which the axis leans over the rim that a force moves the pressure
    to, for an axis up (1) or down (-1).
    """
    factor = -up * (x * x + y * y) ** -0.5
    return (factor * x, factor * y)


def tipping_direction(state: State, top: Top) -> Horizontal | None:
    """Return the direction into which the axis leans where a body tips over its rim, of floats;
    None where it does not.

    It tips over the point of the rim that slips outwards, at e with v.e_t = -w a1, if the law at a
    point moves the centre of pressure to that or beyond it: to it where the pressure has come to
    the rim by a force that grows.
    """
    (u, v), outer = state.velocity[:2], float(face_radii(top.surface)[1])
    height = float(support_at(state.axis, top.surface)[0])
    drilled = outer * float(drilling_rate(state.momentum, top))
    square = float(u * u + v * v)
    outward = square - drilled * drilled
    if not outward > AT_RIM * square:
        return None
    slip = outward**0.5
    x, y = (slip * u - drilled * v) / square, (slip * v + drilled * u) / square
    turning = (0.0, 0.0, drilled / outer)
    force = top.friction.traction((slip * x, slip * y), turning)[0]
    moved = height * float(-(force[0] * x + force[1] * y))
    if not moved >= (1.0 - AT_RIM) * outer:
        return None
    up = 1.0 if state.axis[2] > 0.0 else -1.0
    return (up * x, up * y)


def pressure_reserve(forces: FaceForces, top: Top) -> Scalar:
    """Return N^2 - (couple / a1)^2, N^2: positive while the centre of pressure is on the face."""
    outer, normal = face_radii(top.surface)[1], forces.force[2]
    x, y = forces.couple
    return normal * normal - (x * x + y * y) / (outer * outer)


def slip_that_tips(axis: Vector, drilling: float, fastest: float, top: Top) -> float:
    """Return the least outward slip of a point of the rim at which friction there moves the
    pressure to the rim, m/s, of floats; the fastest if there is none up to that.

    Parameters
    ----------
    axis
        Axis, along or against the vertical.
    drilling
        Angular velocity about the vertical, rad/s: the law may depend on it.
    fastest
        The largest slip that is tried, m/s.
    top
        The body.
    """
    outer, height = float(face_radii(top.surface)[1]), float(support_at(axis, top.surface)[0])

    def tips(slip: float) -> bool:
        force = top.friction.traction((slip, 0.0), (0.0, 0.0, drilling))[0]
        return bool(-height * force[0] >= outer)

    slips = [fastest * 2.0 ** (number - SLIPS_TRIED) for number in range(SLIPS_TRIED + 1)]
    largest = next((slip for slip in slips if tips(slip)), None)
    if largest is None:
        return fastest
    least = 0.5 * largest if largest > slips[0] else 0.0
    for _ in range(BISECTIONS):
        middle = 0.5 * (least + largest)
        least, largest = (least, middle) if tips(middle) else (middle, largest)
    return largest


def outward_square(state: SlidingState, top: Top) -> Scalar:
    """Return v^2 - (a1 w)^2, m^2/s^2: of the slip at the point of the rim that slips straight
    outwards, if it is positive; else there is no such point.
    """
    (u, v), outer = state.velocity, face_radii(top.surface)[1]
    drilled = outer * drilling_rate(state.momentum, top)
    return u * u + v * v - drilled * drilled


def rim_reserve(state: SlidingState, slip: Scalar, top: Top) -> Scalar:
    """Return what is positive while no point of the rim slips outwards so fast that friction there
    could hold the pressure at the rim, where that of the face has come to the rim.

    Dry friction can from the start of that slip, s. Other laws are asked for their force at a slip
    without a root, (s0 + s^2 / s0) / 2: it is s at s = s0, and above it elsewhere. Under a law
    whose force falls again at faster slip, a slip that falls from beyond its peak therefore reaches
    the upper limit of the slips that tip the body later than it should.

    Parameters
    ----------
    state
        The state.
    slip
        A slip s0, m/s: the one of `slip_that_tips`.
    top
        The body.
    """
    outward = outward_square(state, top)
    if is_set_valued(top.friction):
        return -outward
    turning = (0.0, 0.0, drilling_rate(state.momentum, top))
    force = top.friction.traction((0.5 * (slip + outward / slip), 0.0), turning)[0]
    height = support_at(state.axis, top.surface)[0]
    return face_radii(top.surface)[1] + height * force[0]


class PressureSplit(NamedTuple):
    """How the outward slip changes where the pressure is at one point of the rim, and elsewhere."""

    at_point: Scalar
    """Rate of `outward_square` where all the pressure is at the point that slips outwards, m^2/s^3.
    """
    on_face: Scalar
    """The same where the pressure is that of the face."""
    terms: Scalar
    """Sum of the sizes of the terms of `on_face`, m^2/s^3."""
    forces: FaceForces
    """The forces that keep the outward slip: a share of each."""


def held_at_rim(state: SlidingState, slip: Scalar, law_type: Any, top: Top) -> PressureSplit:
    """Return the forces on a body at whose rim friction at one point could just hold the pressure,
    and what they follow from.

    At the point that slips straight outwards friction is a1 N / h then, towards the middle, and its
    moment balances that of the pressure there. Such a force slows that slip down; friction of the
    whole face makes it faster. A share of the pressure at the point and the rest on the face keep
    it as it is. Under dry friction the slip is zero, and all the pressure is there: the body rolls
    on its rim with its axis vertical, without loss.

    Parameters
    ----------
    state
        The state.
    slip
        The outward slip, sqrt(v^2 - (a1 w)^2), m/s.
    law_type
        The class of the face's law, of `law_of_face`.
    top
        The body.
    """
    axis, momentum, (u, v) = state
    outer, drilling = face_radii(top.surface)[1], drilling_rate(momentum, top)
    drilled, square = outer * drilling, u * u + v * v
    normal, height = top.mass * top.gravity, support_at(axis, top.surface)[0]
    factor = -outer * normal / (height * square)
    point = factor * (slip * u - drilled * v), factor * (slip * v + drilled * u)
    field = face_field(axis, momentum, (u, v), top)
    (p, q, _), couple = field.force, field.couple[2]

    def rate(power: Scalar, torque: Scalar) -> Scalar:
        return 2.0 * (power / top.mass - outer * drilled * torque / top.axial_inertia)

    face = sliding_on_face(axis, momentum, (u, v), law_type, top)
    free = u * p + v * q
    at_point = rate(free - slip * (outer * normal / height), couple)
    power = u * face.force[0] + v * face.force[1]
    on_face = rate(free + power, couple + face.torque)
    terms = abs(rate(free, 0.0)) + abs(rate(power, 0.0))
    terms = terms + abs(rate(0.0, couple)) + abs(rate(0.0, face.torque))
    share = at_point / (at_point - on_face)
    east = share * face.force[0] + (1.0 - share) * point[0]
    north = share * face.force[1] + (1.0 - share) * point[1]
    forces = forces_on_face(axis, (east, north), normal, share * face.torque, top)
    return PressureSplit(at_point, on_face, terms, forces)
